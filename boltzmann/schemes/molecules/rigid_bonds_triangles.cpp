// Molecules of three particles at three distances, the most frequent kind. RigidTriangle is 1.5 times as fast as the
// general body.
#include <boltzmann/schemes/molecules/rigid_bonds.hpp>
#include <boltzmann/schemes/molecules/rigid_triangle.hpp>

namespace boltzmann {

bool RigidBonds::correct_triangle(Molecule const& molecule, double dt) {
  int const D = box_.dimension();
  double const per_time = dt != 0 ? 1 / dt : 0;
  std::size_t const begin = molecule.bonds;
  auto triangle = RigidTriangle::of({bonds_.data() + begin, 3});
  if (!triangle) return false;
  RigidTriangle::Bonds now;
  for (std::size_t i = 0; i < 3; ++i) {
    now[i] = between(bonds_[begin + i][0], bonds_[begin + i][1]);
    triangle->inverse_masses[i] = member(triangle->particles[i]).inverse_mass;
  }
  RigidTriangle::Bonds const was{before_[begin], before_[begin + 1], before_[begin + 2]};
  auto const push = triangle->pushes(was, now, {length_[begin], length_[begin + 1], length_[begin + 2]}, tolerance_);
  for (std::size_t i = 0; push && i < 3; ++i) {
    Member const p = member(triangle->particles[i]);
    auto const change = triangle->momentum(i, was, *push) * p.inverse_mass;
    for (int a = 0; a < D; ++a) p.position[a] += change[a], p.velocity[a] += change[a] * per_time;
  }
  return push.has_value();
}

std::optional<double> RigidBonds::correct_triangle_velocities(Molecule const& molecule) {
  int const D = box_.dimension();
  std::size_t const begin = molecule.bonds;
  auto triangle = RigidTriangle::of({bonds_.data() + begin, 3});
  if (!triangle) return {};
  RigidTriangle::Numbers along{};
  RigidTriangle::Bonds now;
  for (std::size_t i = 0; i < 3; ++i) {
    now[i] = between(bonds_[begin + i][0], bonds_[begin + i][1]);
    triangle->inverse_masses[i] = member(triangle->particles[i]).inverse_mass;
    Member const p = member(bonds_[begin + i][0]), q = member(bonds_[begin + i][1]);
    for (int a = 0; a < D; ++a) along[i] += now[i][a] * (q.velocity[a] - p.velocity[a]);
  }
  auto const push = triangle->impulses(now, along);
  double added = 0;
  for (std::size_t i = 0; push && i < 3; ++i) {
    Member const p = member(triangle->particles[i]);
    auto const change = triangle->momentum(i, now, *push) * p.inverse_mass;
    for (int a = 0; a < D; ++a) p.velocity[a] += change[a];
    added -= 0.5 * (*push)[i] * along[i];  // the bonds' rates are zero afterwards
  }
  return push ? std::optional(added) : std::nullopt;
}

}  // namespace boltzmann
