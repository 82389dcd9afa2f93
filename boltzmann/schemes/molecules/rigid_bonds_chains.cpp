// Flexible molecules: solves their bonds in turn, until all of them hold.
#include <boltzmann/schemes/molecules/rigid_bonds.hpp>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr int max_turns = 1000;

}  // namespace

bool RigidBonds::correct_bonds(Molecule const& chain, double dt) {
  int const D = box_.dimension();
  double const per_time = dt != 0 ? 1 / dt : 0;
  bool holds = false;
  for (int turn = 0; turn < max_turns && !holds; ++turn) {
    holds = true;
    for (std::size_t k = chain.bonds; k < chain.solved; ++k) {
      Vector<3> const now = between(bonds_[k][0], bonds_[k][1]);
      double const square = length_[k] * length_[k], off = dot(now, now) - square;
      if (std::abs(off) <= 2 * tolerance_ * square) continue;
      holds = false;
      Member const p = member(bonds_[k][0]), q = member(bonds_[k][1]);
      double const along = dot(now, before_[k]);
      if (!(along > 1e-3 * square)) return false;  // it has rotated by a right angle in one step
      double const push = off / (2 * (p.inverse_mass + q.inverse_mass) * along);
      for (int a = 0; a < D; ++a) {
        double const part = push * before_[k][a];
        p.position[a] += p.inverse_mass * part;
        q.position[a] -= q.inverse_mass * part;
        p.velocity[a] += p.inverse_mass * part * per_time;
        q.velocity[a] -= q.inverse_mass * part * per_time;
      }
    }
  }
  return holds;
}

std::optional<double> RigidBonds::correct_bond_velocities(Molecule const& chain) {
  int const D = box_.dimension();
  for (std::size_t k = chain.bonds; k < chain.solved; ++k)
    before_[k] = between(bonds_[k][0], bonds_[k][1]);  // its old value is no longer needed
  double added = 0;
  bool holds = false;
  for (int turn = 0; turn < max_turns && !holds; ++turn) {
    holds = true;
    for (std::size_t k = chain.bonds; k < chain.solved; ++k) {
      Member const p = member(bonds_[k][0]), q = member(bonds_[k][1]);
      Vector<3> const d = before_[k];
      double along = 0, speed = 0;
      for (int a = 0; a < D; ++a) {
        along += d[a] * (q.velocity[a] - p.velocity[a]);
        speed = std::max({speed, std::abs(p.velocity[a]), std::abs(q.velocity[a])});
      }
      if (!(std::abs(along) > tolerance_ * length_[k] * speed)) continue;
      holds = false;
      double const inverse = p.inverse_mass + q.inverse_mass, push = along / (inverse * dot(d, d));
      // The change of the kinetic energy: the work of the impulse at the mean velocity.
      added -= push * along - 0.5 * push * push * inverse * dot(d, d);
      for (int a = 0; a < D; ++a) {
        p.velocity[a] += p.inverse_mass * push * d[a];
        q.velocity[a] -= q.inverse_mass * push * d[a];
      }
    }
  }
  return holds ? std::optional(added) : std::nullopt;
}

/// The forces for which the second derivatives of all squared lengths vanish: r.(a_q - a_p) + |v_q - v_p|^2 = 0.
void RigidBonds::add_bond_virial(Molecule const& chain, std::vector<Vector<3>>& acceleration,
                                 std::vector<double>& per_particle) const {
  int const D = box_.dimension();
  std::vector<double> tension(chain.solved - chain.bonds, 0.0);  // q pulls p with tension times the vector from p to q
  for (int turn = 0; turn < max_turns; ++turn) {
    double largest = 0, greatest = 0;
    for (std::size_t k = chain.bonds; k < chain.solved; ++k) {
      auto const [i, j] = bonds_[k];
      Member const p = member(i), q = member(j);
      Vector<3> const d = between(i, j);
      double off = dot(d, acceleration[j] - acceleration[i]);
      for (int a = 0; a < D; ++a) off += (q.velocity[a] - p.velocity[a]) * (q.velocity[a] - p.velocity[a]);
      double const more = off / ((p.inverse_mass + q.inverse_mass) * dot(d, d));
      tension[k - chain.bonds] += more;
      acceleration[i] += d * (more * p.inverse_mass);
      acceleration[j] -= d * (more * q.inverse_mass);
      largest = std::max(largest, std::abs(more));
      greatest = std::max(greatest, std::abs(tension[k - chain.bonds]));
    }
    if (largest <= 1e-13 * greatest) break;
  }
  for (std::size_t k = chain.bonds; k < chain.solved; ++k) {
    Vector<3> const d = between(bonds_[k][0], bonds_[k][1]);
    for (auto const i : bonds_[k])
      for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) per_particle[9 * i + 3 * a + b] -= 0.5 * tension[k - chain.bonds] * d[a] * d[b];
  }
}

}  // namespace boltzmann
