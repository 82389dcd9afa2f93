// Assigns bonds to molecules, classifies each molecule, and has the loop over molecules.
#include <boltzmann/schemes/molecules/rigid_bonds.hpp>

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/molecules/bond_rank.hpp>
#include <boltzmann/schemes/molecules/rigid_groups.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace boltzmann {
namespace {

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
  refuse_repeated(
      bonds_, [&](std::size_t k) { return fmt::format("of length {}", length_[k]); },
      "rigid bonds of '" + ensemble_.name() + "'");
  find_molecules();
}

/// Sorts bonds such that those connected directly or through others are contiguous, in the order in which they were
/// added.
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
  for (auto const k : order) bonds.push_back(bonds_[k]), lengths.push_back(length_[k]);
  bonds_ = std::move(bonds);
  length_ = std::move(lengths);
  first_of_.resize(particles_);
  for (std::uint32_t i = 0; i < particles_; ++i) first_of_[i] = find(i);
  RigidGroups const groups(ensemble_, bonds_);
  molecules_.clear(), member_.clear(), anchor_.clear();
  molecule_.assign(particles_, no_molecule);
  std::size_t bond = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    auto const members = groups.members(g), anchors = groups.anchors(g);
    if (members.size() == 1) continue;
    molecule_[members[0]] = static_cast<std::uint32_t>(molecules_.size());
    std::size_t end = bond;
    while (end < bonds_.size() && first_of_[bonds_[end][0]] == members[0]) ++end;
    molecules_.push_back({bond, end, end, member_.size(), members.size(), no_molecule});
    member_.insert(member_.end(), members.begin(), members.end());
    anchor_.insert(anchor_.end(), anchors.begin(), anchors.end());
    bond = end;
  }
  before_.assign(bonds_.size(), Vector<3>{0, 0, 0});
  arms_.assign(member_.size(), Vector<3>{0, 0, 0});
  prepared_ = false;
}

RigidBonds::Member RigidBonds::member(std::uint32_t i) const {
  double* const row = ensemble_.row(i);
  return {row, row + velocity_, 1 / row[mass_]};
}

Vector<3> RigidBonds::between(std::uint32_t i, std::uint32_t j) const {
  Vector<3> d{0, 0, 0};
  bool across = false;  // rarely true: nearest images would cost more than everything else
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

std::size_t RigidBonds::rank() {
  prepare(false);
  ExactSum sum;
  for (double const taken : taken_) sum += taken;
  return static_cast<std::size_t>(std::lround(sum.value()));
}

std::span<double const> RigidBonds::taken_freedom() {
  prepare(false);
  return taken_;
}

template <class Function>
void RigidBonds::each_molecule(int threads, Function const& function) const {
  check_size();
  int const used = threads_for(molecules_.size(), 8, threads);
  if (Share const* const share = ensemble_.share())
    return for_stretches(share->stretches, used, [&](Stretch const* one, Stretch const* last) {
      for (; one != last; ++one)
        for (std::size_t i = one->begin; i < one->end; ++i)
          if (auto const m = molecule_[i]; m != no_molecule) function(m);
    });
  for_ranges(molecules_.size(), molecules_grain, used, [&](std::size_t begin, std::size_t end) {
    for (std::size_t m = begin; m < end; ++m) function(m);
  });
}

void RigidBonds::check_lengths() const {
  for (std::size_t k = 0; k < bonds_.size(); ++k)
    if (double const length = magnitude(between(bonds_[k][0], bonds_[k][1]));
        !(std::abs(length - length_[k]) <= 0.25 * length_[k]))
      throw Error(fmt::format("the rigid bond between particles {} and {} of '{}' begins {} long, and is to be {}",
                              bonds_[k][0], bonds_[k][1], ensemble_.name(), length, length_[k]));
}

/// Classifies each molecule, for positions near its lengths; `move`: moves bodies to their exact shape.
void RigidBonds::prepare(bool move) {
  if (prepared_ && !move) return;
  check_size();
  check_lengths();
  taken_.assign(particles_, 0.0);
  shapes_.clear();
  for (auto& molecule : molecules_) examine(molecule, move);
  prepared_ = true;
}

void RigidBonds::examine(Molecule& molecule, bool move) {
  std::span const members(member_.data() + molecule.members, molecule.size);
  BondedMolecule of{.dimension = box_.dimension()};
  std::vector<std::pair<std::uint32_t, std::uint32_t>> number;  // for each particle: its number in the molecule
  for (std::uint32_t k = 0; k < members.size(); ++k) {
    std::uint32_t const anchor = anchor_[molecule.members + k];
    of.places.push_back(k == 0 ? Vector<3>{0, 0, 0} : of.places[anchor] + between(members[anchor], members[k]));
    of.masses.push_back(1 / member(members[k]).inverse_mass);
    of.numbers.push_back(members[k]);
    number.emplace_back(members[k], k);
  }
  std::sort(number.begin(), number.end());
  auto const own = [&](std::uint32_t i) {
    return std::lower_bound(number.begin(), number.end(), std::pair{i, 0U})->second;
  };
  for (std::size_t k = molecule.bonds; k < molecule.end; ++k) {
    of.bonds.push_back({own(bonds_[k][0]), own(bonds_[k][1])});
    of.lengths.push_back(length_[k]);
  }
  BondRank found;
  try {
    found = rank_of_bonds(of);
  } catch (Error const& error) {
    throw Error(fmt::format("the rigid bonds of the molecule of particle {} of '{}' {}", members[0], ensemble_.name(),
                            error.what()));
  }
  for (std::size_t k = 0; k < members.size(); ++k) taken_[members[k]] = found.taken[k];
  molecule.shape = found.body ? shapes_.size() : no_molecule;
  if (found.body) {
    shapes_.push_back(shape_of(found.places, of.dimension));
    molecule.triangle = of.bonds.size() == 3 && of.places.size() == 3 && !shapes_.back().line;
    for (std::size_t k = 0; move && k < members.size(); ++k)
      for (std::size_t a = 0; a < static_cast<std::size_t>(of.dimension); ++a)
        member(members[k]).position[a] += found.places[k][a] - of.places[k][a];
    return;
  }
  // The bonds that are solved first, in their order.
  std::vector<BondMembers> bonds;
  std::vector<double> lengths;
  std::vector<bool> solved(of.bonds.size(), false);
  for (auto const k : found.independent) solved[k] = true;
  for (bool const one : {true, false})
    for (std::size_t k = 0; k < solved.size(); ++k)
      if (solved[k] == one) {
        bonds.push_back(bonds_[molecule.bonds + k]);
        lengths.push_back(length_[molecule.bonds + k]);
      }
  std::copy(bonds.begin(), bonds.end(), bonds_.begin() + static_cast<std::ptrdiff_t>(molecule.bonds));
  std::copy(lengths.begin(), lengths.end(), length_.begin() + static_cast<std::ptrdiff_t>(molecule.bonds));
  molecule.solved = molecule.bonds + found.independent.size();
}

void RigidBonds::begin_step(int threads) {
  prepare(false);
  each_molecule(threads, [&](std::size_t m) {
    Molecule const& one = molecules_[m];
    if (one.shape != no_molecule && !one.triangle) return arms_of(one, noted_arms(one));
    for (std::size_t k = one.bonds; k < one.solved; ++k) before_[k] = between(bonds_[k][0], bonds_[k][1]);
  });
}

void RigidBonds::correct_positions(double dt, int threads) {
  each_molecule(threads, [&](std::size_t m) {
    Molecule const& one = molecules_[m];
    bool const done = one.triangle               ? correct_triangle(one, dt) || correct_bonds(one, dt)
                      : one.shape != no_molecule ? correct_body(one, dt)
                                                 : correct_bonds(one, dt);
    if (done) return;
    throw PhysicsFailure(
        fmt::format("the rigid bonds of the molecule of particle {} of '{}' can't be kept in this "
                    "step; take a shorter one",
                    bonds_[one.bonds][0], ensemble_.name()));
  });
}

double RigidBonds::correct_velocities(int threads, Division* division) {
  prepare(false);
  std::vector<double> added(molecules_.size(), 0.0);
  each_molecule(threads, [&](std::size_t m) {
    Molecule const& one = molecules_[m];
    std::optional<double> more;
    if (one.triangle) more = correct_triangle_velocities(one);
    if (!more) more = one.shape != no_molecule ? correct_body_velocities(one) : correct_bond_velocities(one);
    if (!more)
      throw PhysicsFailure(
          fmt::format("the velocities of the molecule of particle {} of '{}' can't be brought in line "
                      "with its rigid bonds",
                      bonds_[one.bonds][0], ensemble_.name()));
    added[m] = *more;
  });
  ExactSum work;
  work.add(added);
  if (division) division->sum(work);
  return work.value();
}

void RigidBonds::settle(int threads) {
  prepare(true);
  begin_step(threads);
  correct_positions(0, threads);
  correct_velocities(threads);
}

void RigidBonds::add_virial(std::vector<double>& per_particle) const {
  check_size();
  std::vector<Vector<3>> acceleration(particles_, Vector<3>{0, 0, 0});
  for (std::uint32_t i = 0; i < particles_; ++i)
    for (int a = 0; a < box_.dimension(); ++a) acceleration[i][a] = ensemble_.influence(i)[a] * member(i).inverse_mass;
  for (auto const& molecule : molecules_)
    if (molecule.shape != no_molecule)
      add_body_virial(molecule, acceleration, per_particle);
    else
      add_bond_virial(molecule, acceleration, per_particle);
}

}  // namespace boltzmann
