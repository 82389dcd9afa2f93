// Each molecule's bonds in turn, until all of them hold; those of a triangle all at once.
#include <boltzmann/schemes/molecules/rigid_bonds.hpp>

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/molecules/rigid_triangle.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace boltzmann {
namespace {

constexpr int max_turns = 1000;
constexpr std::size_t molecules_grain = 256;
constexpr std::uint32_t no_molecule = ~std::uint32_t{0};

}  // namespace

RigidBonds::RigidBonds(AnyEnsemble& ensemble, Box const& box, std::vector<BondMembers> const& bonds, double length,
                       double tolerance)
    : ensemble_(ensemble), box_(box), tolerance_(tolerance), particles_(ensemble.size()) {
  Field const *velocity = ensemble.find_field("velocity"), *mass = ensemble.find_field("mass");
  if (!velocity || !mass || ensemble.influence_size() != static_cast<std::size_t>(ensemble.dimension()))
    throw Error(
        fmt::format("rigid bonds join particles that forces move; those of class {} are not", ensemble.class_name()));
  velocity_ = velocity->offset;
  mass_ = mass->offset;
  if (!(tolerance > 0 && tolerance < 0.1))
    throw Error(fmt::format("the tolerance of rigid bonds is between 0 and 0.1, not {}", tolerance));
  for (int a = 0; a < box.dimension(); ++a)
    if (box.boundary(a) != Boundary::open && box.boundary(a) != Boundary::periodic)
      throw Error(
          fmt::format("rigid bonds would be bent by the walls of axis {}; it must be open or periodic", "xyz"[a]));
  if (!box.regions().empty()) throw Error("rigid bonds would be bent by the faces of regions; leave these out");
  add(bonds, length);
}

void RigidBonds::add(std::vector<BondMembers> const& bonds, double length) {
  if (!(length > 0 && std::isfinite(length)))
    throw Error(fmt::format("the length of a rigid bond is positive, not {}", length));
  for (auto const& bond : bonds) {
    for (auto const i : bond)
      if (i >= particles_)
        throw Error(fmt::format("a rigid bond names particle {}, but '{}' has {}", i, ensemble_.name(), particles_));
    if (bond[0] == bond[1]) throw Error(fmt::format("a rigid bond joins particle {} to itself", bond[0]));
    bonds_.push_back(bond);
    length_.push_back(length);
  }
  find_molecules();
}

/// Bonds that share a particle, directly or by others, stand side by side, in the order in which they were named.
void RigidBonds::find_molecules() {
  std::vector<std::uint32_t> root(particles_);
  std::iota(root.begin(), root.end(), 0U);
  auto const find = [&](std::uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (auto const& bond : bonds_) {
    auto const a = find(bond[0]), b = find(bond[1]);
    root[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::size_t> order(bonds_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return find(bonds_[a][0]) < find(bonds_[b][0]); });
  std::vector<BondMembers> bonds;
  std::vector<double> lengths;
  start_.clear();
  first_of_.resize(particles_);
  for (std::uint32_t i = 0; i < particles_; ++i) first_of_[i] = find(i);
  molecule_.assign(particles_, no_molecule);
  for (auto const k : order) {
    auto const first = first_of_[bonds_[k][0]];
    if (molecule_[first] == no_molecule) {
      molecule_[first] = static_cast<std::uint32_t>(start_.size());
      start_.push_back(bonds.size());
    }
    bonds.push_back(bonds_[k]);
    lengths.push_back(length_[k]);
  }
  start_.push_back(bonds.size());
  bonds_ = std::move(bonds);
  length_ = std::move(lengths);
  before_.assign(bonds_.size(), Vector<3>{0, 0, 0});
}

RigidBonds::Member RigidBonds::member(std::uint32_t i) const {
  double* const row = ensemble_.row(i);
  return {row, row + velocity_, 1 / row[mass_]};
}

Vector<3> RigidBonds::between(std::uint32_t i, std::uint32_t j) const {
  Vector<3> d{0, 0, 0};
  bool across = false;  // seldom: nearest images cost more than all else
  for (int a = 0; a < box_.dimension(); ++a) {
    d[a] = ensemble_.row(j)[a] - ensemble_.row(i)[a];
    across = across || std::abs(d[a]) > 0.5 * box_.length(a);
  }
  if (across) box_.nearest_image(d.component);
  return d;
}

void RigidBonds::check_size() const {
  if (ensemble_.size() != particles_)
    throw Error(fmt::format("ensemble '{}' had {} particles when it got rigid bonds, now it has {}", ensemble_.name(),
                            particles_, ensemble_.size()));
}

void RigidBonds::keep_together(Division& division) const {
  check_size();
  division.keep_together(ensemble_, first_of_);
}

template <class Function>
void RigidBonds::each_molecule(int threads, Function const& function) const {
  check_size();
  std::size_t const molecules = start_.size() - 1;
  int const used = threads_for(molecules, 8, threads);
  if (Share const* const share = ensemble_.share())
    return for_stretches(share->stretches, used, [&](Stretch const* one, Stretch const* last) {
      for (; one != last; ++one)
        for (std::size_t i = one->begin; i < one->end; ++i)
          if (auto const m = molecule_[i]; m != no_molecule) function(start_[m], start_[m + 1]);
    });
  for_ranges(molecules, molecules_grain, used, [&](std::size_t begin, std::size_t end) {
    for (std::size_t m = begin; m < end; ++m) function(start_[m], start_[m + 1]);
  });
}

void RigidBonds::begin_step(int threads) {
  each_molecule(threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) before_[k] = between(bonds_[k][0], bonds_[k][1]);
  });
}

void RigidBonds::correct_positions(double dt, int threads) {
  int const D = box_.dimension();
  double const per_time = dt != 0 ? 1 / dt : 0;
  auto const triangle_is_corrected = [&](std::size_t begin, std::size_t end) {
    auto triangle = RigidTriangle::of({bonds_.data() + begin, end - begin});
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
  };
  each_molecule(threads, [&](std::size_t begin, std::size_t end) {
    if (triangle_is_corrected(begin, end)) return;
    bool holds = false;
    for (int turn = 0; turn < max_turns && !holds; ++turn) {
      holds = true;
      for (std::size_t k = begin; k < end; ++k) {
        Vector<3> const now = between(bonds_[k][0], bonds_[k][1]);
        double const square = length_[k] * length_[k], off = dot(now, now) - square;
        if (std::abs(off) <= 2 * tolerance_ * square) continue;
        holds = false;
        Member const p = member(bonds_[k][0]), q = member(bonds_[k][1]);
        double const along = dot(now, before_[k]);
        if (!(along > 1e-3 * square)) {
          turn = max_turns;  // it has turned by a right angle in one step
          break;
        }
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
    if (!holds)
      throw PhysicsFailure(
          fmt::format("the rigid bonds of the molecule of particle {} of '{}' can't be kept in this "
                      "step; take a shorter one",
                      bonds_[begin][0], ensemble_.name()));
  });
}

double RigidBonds::correct_velocities(int threads, Division* division) {
  int const D = box_.dimension();
  std::vector<double> added(bonds_.size(), 0.0);
  auto const triangle_is_corrected = [&](std::size_t begin, std::size_t end) {
    auto triangle = RigidTriangle::of({bonds_.data() + begin, end - begin});
    if (!triangle) return false;
    RigidTriangle::Numbers along{};
    RigidTriangle::Bonds const now{before_[begin], before_[begin + 1], before_[begin + 2]};
    for (std::size_t i = 0; i < 3; ++i) {
      triangle->inverse_masses[i] = member(triangle->particles[i]).inverse_mass;
      Member const p = member(bonds_[begin + i][0]), q = member(bonds_[begin + i][1]);
      for (int a = 0; a < D; ++a) along[i] += now[i][a] * (q.velocity[a] - p.velocity[a]);
    }
    auto const push = triangle->impulses(now, along);
    for (std::size_t i = 0; push && i < 3; ++i) {
      Member const p = member(triangle->particles[i]);
      auto const change = triangle->momentum(i, now, *push) * p.inverse_mass;
      for (int a = 0; a < D; ++a) p.velocity[a] += change[a];
      added[begin + i] = -0.5 * (*push)[i] * along[i];  // the bonds' rates are zero after it
    }
    return push.has_value();
  };
  each_molecule(threads, [&](std::size_t begin, std::size_t end) {
    bool holds = false;
    for (std::size_t k = begin; k < end; ++k) before_[k] = between(bonds_[k][0], bonds_[k][1]);  // no more needed
    if (triangle_is_corrected(begin, end)) return;
    for (int turn = 0; turn < max_turns && !holds; ++turn) {
      holds = true;
      for (std::size_t k = begin; k < end; ++k) {
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
        // What it does to the kinetic energy: the work of the impulse at the mean velocity.
        added[k] -= push * along - 0.5 * push * push * inverse * dot(d, d);
        for (int a = 0; a < D; ++a) {
          p.velocity[a] += p.inverse_mass * push * d[a];
          q.velocity[a] -= q.inverse_mass * push * d[a];
        }
      }
    }
    if (!holds)
      throw PhysicsFailure(
          fmt::format("the velocities of the molecule of particle {} of '{}' can't be brought in line "
                      "with its rigid bonds",
                      bonds_[begin][0], ensemble_.name()));
  });
  ExactSum work;
  work.add(added);
  if (division) division->sum(work);
  return work.value();
}

void RigidBonds::settle(int threads) {
  begin_step(threads);
  for (std::size_t k = 0; k < bonds_.size(); ++k)
    if (double const length = magnitude(before_[k]); !(std::abs(length - length_[k]) <= 0.25 * length_[k]))
      throw Error(fmt::format("the rigid bond between particles {} and {} of '{}' begins {} long, and is to be {}",
                              bonds_[k][0], bonds_[k][1], ensemble_.name(), length, length_[k]));
  correct_positions(0, threads);
  correct_velocities(threads);
}

/// The forces that keep the second derivatives of all squares zero: r.(a_q - a_p) + |v_q - v_p|^2 = 0.
void RigidBonds::add_virial(std::vector<double>& per_particle) const {
  int const D = box_.dimension();
  std::vector<Vector<3>> acceleration(particles_, Vector<3>{0, 0, 0});
  for (std::uint32_t i = 0; i < particles_; ++i)
    for (int a = 0; a < D; ++a) acceleration[i][a] = ensemble_.influence(i)[a] * member(i).inverse_mass;
  std::vector<double> tension(bonds_.size(), 0.0);  // q pulls p with tension times the vector from p to q
  check_size();
  for (std::size_t m = 0; m + 1 < start_.size(); ++m) {
    std::size_t const begin = start_[m], end = start_[m + 1];
    for (int turn = 0; turn < max_turns; ++turn) {
      double largest = 0, greatest = 0;
      for (std::size_t k = begin; k < end; ++k) {
        auto const [i, j] = bonds_[k];
        Member const p = member(i), q = member(j);
        Vector<3> const d = between(i, j);
        double off = dot(d, acceleration[j] - acceleration[i]);
        for (int a = 0; a < D; ++a) off += (q.velocity[a] - p.velocity[a]) * (q.velocity[a] - p.velocity[a]);
        double const more = off / ((p.inverse_mass + q.inverse_mass) * dot(d, d));
        tension[k] += more;
        acceleration[i] += d * (more * p.inverse_mass);
        acceleration[j] -= d * (more * q.inverse_mass);
        largest = std::max(largest, std::abs(more));
        greatest = std::max(greatest, std::abs(tension[k]));
      }
      if (largest <= 1e-13 * greatest) break;
    }
  }
  for (std::size_t k = 0; k < bonds_.size(); ++k) {
    Vector<3> const d = between(bonds_[k][0], bonds_[k][1]);
    for (auto const i : bonds_[k])
      for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) per_particle[9 * i + 3 * a + b] -= 0.5 * tension[k] * d[a] * d[b];
  }
}

}  // namespace boltzmann
