// Embedded atoms against plain loops: energies, forces by differences, the virial by scaling the box; several elements,
// threads, resume, reversal, and what is refused.
#include "many_body_oracle.hpp"

#include <boltzmann/boltzmann.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>

namespace boltzmann::embedded_atoms_test {
namespace {

using many_body_oracle::Sample;
using many_body_oracle::take;
using many_body_oracle::total;

constexpr Boundary periodic = Boundary::periodic, open = Boundary::open, reflecting = Boundary::reflecting;
constexpr double reach = 4.2, spacing = 2.4, shake = 0.35;
// A repulsion and densities with no special form, in units of nothing.
constexpr auto repulsion = [](double r) { return 40 * std::exp(-2.2 * r); };
constexpr auto density = [](double r) { return 3 * std::exp(-1.1 * r) * r; };
constexpr auto embedding = [](auto const& rho) { return 0.1 * rho * rho - 0.9 * sqrt(rho); };

EmbeddedAtoms metal() { return EmbeddedAtoms(repulsion, density, embedding, {reach}); }

/// Two elements that differ in all.
EmbeddedAtoms alloy() {
  auto const root = [](auto const& rho) { return -1.3 * sqrt(rho); };
  return EmbeddedAtoms(
      {{"A", std::make_shared<EmbeddingFunction<decltype(embedding)>>(embedding)},
       {"B", std::make_shared<EmbeddingFunction<decltype(root)>>(root)}},
      [](std::size_t a, std::size_t b, double r) { return (1 + 0.2 * double(a + b)) * repulsion(r); },
      [](std::size_t, std::size_t b, double r) { return b == 0 ? density(r) : 2 * std::exp(-0.8 * r); }, {reach});
}

/// The energies by loops; `kind`: the element of each atom.
template <int D>
std::vector<double> by_loops(Sample<D> const& sample, EmbeddedAtoms const& atoms,
                             std::function<std::size_t(std::size_t)> const& kind) {
  return many_body_oracle::embedded<D>(
      sample, reach, [&](double r, std::size_t i, std::size_t j) { return atoms.pair_energy(r, kind(i), kind(j)); },
      [&](double r, std::size_t i, std::size_t j) { return atoms.density(r, kind(i), kind(j)); },
      [&](double rho, std::size_t i) {
        double energy = 0, slope = 0;
        atoms.elements()[kind(i)].embedding->at(&rho, 1, &energy, &slope);
        return energy;
      });
}

template <int D>
struct Case {
  int cells;
  std::array<Boundary, D> kinds;
  double lattice = spacing;
};

/// Scheme and loops agree on the energy of each atom and on forces, momenta don't change, the virial is what scaling says.
template <int D>
void agrees(Case<D> const& one, bool two_elements) {
  Sample<D> const sample(one.cells, one.lattice, shake, one.kinds);
  EmbeddedAtoms const law = two_elements ? alloy() : metal();
  std::size_t const first = two_elements ? sample.places.size() / 3 : sample.places.size();
  auto const kind = [&](std::size_t i) { return i < first ? std::size_t{0} : std::size_t{1}; };
  auto const energies = by_loops<D>(sample, law, kind);
  Ensemble<Newton<D>> a("a"), b("b");
  auto const middle = sample.places.begin() + static_cast<std::ptrdiff_t>(first);
  take(a, std::vector<Vector<D>>(sample.places.begin(), middle));
  take(b, std::vector<Vector<D>>(middle, sample.places.end()));
  EmbeddedAtomScheme scheme(sample.box, law);
  scheme.add(a, two_elements ? "A" : "");
  if (two_elements) scheme.add(b, "B");
  auto const measures = scheme.measure();
  EXPECT_NEAR(measures.potential, total(energies), 1e-12 * std::abs(total(energies)) * double(energies.size()));
  scheme.calculate();
  Vector<D> sum{}, size{};
  for (std::size_t i = 0; i < energies.size(); ++i) {
    bool const in_a = i < first;
    EXPECT_NEAR(measures.per_particle[in_a ? 0 : 1][in_a ? i : i - first], energies[i], 1e-11);
    auto const force = in_a ? a.influence_on(i) : b.influence_on(i - first);
    for (int k = 0; k < D; ++k) sum[k] += force[k], size[k] += std::abs(force[k]);
  }
  for (int k = 0; k < D; ++k) EXPECT_LT(std::abs(sum[k]), 1e-14 * double(energies.size()) * size[k]);
  for (std::size_t const i : {std::size_t{0}, energies.size() / 2}) {
    auto const force = many_body_oracle::force_by_differences<D>(
        sample, i, 5e-4, [&](Sample<D> const& moved) { return total(by_loops<D>(moved, law, kind)); });
    auto const found = i < first ? a.influence_on(i) : b.influence_on(i - first);
    for (int k = 0; k < D; ++k) EXPECT_NEAR(found[k], force[k], 1e-7 * (1 + std::abs(force[k])));
  }
  for (int axis = 0; axis < D; ++axis) {
    auto const at = [&](double strain) {
      std::array<double, 3> factor{1, 1, 1};
      factor[static_cast<std::size_t>(axis)] += strain;
      return total(by_loops<D>(sample.scaled(factor), law, kind));
    };
    double const h = 1e-4, slope = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
    EXPECT_NEAR(measures.virial[axis][axis], -slope, 1e-6 * (1 + std::abs(slope)));
  }
}

TEST(EmbeddedAtoms, AgreeWithLoopsInAnySpace) {
  agrees<1>({9, {periodic}}, false);
  agrees<1>({7, {open}}, true);
  agrees<2>({5, {periodic, reflecting}}, false);
  agrees<2>({4, {periodic, periodic}}, true);
  agrees<3>({3, {periodic, open, periodic}}, false);
  agrees<3>({3, {periodic, periodic, reflecting}}, true);
}

TEST(EmbeddedAtoms, AgreeWithLoopsWhereEachHasAHundredNeighbours) {
  agrees<3>({6, {open, open, open}, 1.3}, false);
  agrees<3>({5, {open, open, open}, 1.3}, true);
}

// Closer than the first distance energies are straight lines in r^2, with the slopes that functions have there.
TEST(EmbeddedAtoms, GoOnAsStraightLinesWhereTheyAreClose) {
  auto const law = metal();
  double const first = law.first(), slope = -2.2 * repulsion(first) / (2 * first);
  for (double const r : {0.0, 0.3 * first, 0.8 * first})
    EXPECT_NEAR(law.pair_energy(r), repulsion(first) + slope * (r * r - first * first),
                1e-3 * std::abs(slope) * r * r + 1e-2);
  double const r = 0.4 * first, e0 = law.pair_energy(0), rho0 = law.density(0);
  EXPECT_NEAR((law.pair_energy(r) - e0) / (r * r), (law.pair_energy(2 * r) - e0) / (4 * r * r), 1e-9 * std::abs(slope));
  EXPECT_NEAR((law.density(r) - rho0) / (r * r), (law.density(2 * r) - rho0) / (4 * r * r), 1e-9);
  Ensemble<Newton<3>> atoms("atoms", 2);
  EmbeddedAtomScheme scheme(Box({-9, -9, -9}, {9, 9, 9}), law);
  scheme.add(atoms);
  auto const energy = [&](double x) {
    atoms[1].position = {x, 0, 0};
    return scheme.measure().potential;
  };
  double const h = 1e-3 * r, by_differences = -(energy(r + h) - energy(r - h)) / (2 * h);
  atoms[1].position = {r, 0, 0};
  scheme.calculate();
  EXPECT_NEAR(atoms.influence_on(1)[0], by_differences, 1e-6 * std::abs(by_differences));
}

TEST(EmbeddedAtoms, SplinesAreTheFunctionsAndEndSmoothly) {
  auto const law = metal();
  EXPECT_LT(law.error(), 1e-6);
  for (double r = 0.5; r < 0.9 * reach; r += 0.0137) {
    EXPECT_NEAR(law.pair_energy(r), repulsion(r), 1e-6 * (1 + repulsion(r)));
    EXPECT_NEAR(law.density(r), density(r), 1e-6);
  }
  EXPECT_NEAR(law.density(reach * (1 - 1e-4)), 0, 1e-9);
  EXPECT_EQ(law.density(reach), 0);
  EXPECT_LT(law.density(0.95 * reach), 0.6 * density(0.95 * reach));
  // Halfway along the switch the factor is a half.
  EXPECT_NEAR(law.density(0.95 * reach), 0.5 * density(0.95 * reach), 1e-6);
}

/// Atoms of a crystal that has been shaken, in 3D.
struct Crystal {
  Sample<3> sample;
  Ensemble<Newton<3>> atoms{"atoms"};
  EmbeddedAtomScheme scheme;
  explicit Crystal(int cells = 6)
      : sample(cells, spacing, 0.2, {periodic, periodic, periodic}), scheme(sample.box, metal()) {
    take(atoms, sample.places);
    for (std::size_t i = 0; i < atoms.size(); ++i)
      atoms[i].velocity = {0.05 * std::sin(double(i)), 0.05 * std::cos(2.0 * double(i)),
                           0.05 * std::sin(3.0 * double(i))};
    scheme.add(atoms);
  }
  std::vector<double> rows() const { return {atoms.row(0), atoms.row(0) + atoms.size() * atoms.stride()}; }
};

// So many that every loop is shared among threads.
TEST(EmbeddedAtoms, HaveTheSameBitsForAnyThreads) { many_body_oracle::same_bits_for_any_threads<Crystal>(21, 0.02); }

TEST(EmbeddedAtoms, KeepTheEnergyAndGoOnAfterAResume) { many_body_oracle::keeps_its_energy_and_goes_on<Crystal>(2e-4); }

TEST(EmbeddedAtoms, GoBackTheWayTheyCame) {
  Crystal one;
  Simulation simulation(one.scheme, 0.02);
  simulation.integrate(one.atoms, Method::reversible_leap_frog);
  simulation.run(1);
  simulation.rewind(1);
  auto const start = one.rows();  // rounded to the grid
  simulation.run(60);
  EXPECT_NE(one.rows(), start);
  simulation.rewind(60);
  EXPECT_EQ(one.rows(), start);
}

/// A class of a user's own.
template <class Real>
struct Marked : Newton<3, Real> {
  static constexpr char const* class_name = "Marked";
  Real mark;
};

TEST(EmbeddedAtoms, AreOfAnyClassOfForcesAndInAnyEnsembles) {
  Crystal one;
  one.scheme.calculate();
  Ensemble<Newton<3>> a("a");
  Ensemble<Marked<double>> b("b", 100);
  EmbeddedAtomScheme scheme(one.sample.box, metal());
  std::size_t const first = one.atoms.size() - b.size();
  take(a, std::vector<Vector<3>>(one.sample.places.begin(), one.sample.places.end() - 100));
  for (std::size_t i = 0; i < b.size(); ++i) b[i].position = one.sample.places[first + i];
  scheme.add(a);
  scheme.add(b);
  scheme.calculate();
  for (std::size_t i = 0; i < one.atoms.size(); ++i) {
    auto const force = i < first ? a.influence_on(i) : b.influence_on(i - first);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(force[k], one.atoms.influence_on(i)[k], 1e-12);
  }
  EXPECT_NEAR(scheme.measure().potential, one.scheme.measure().potential, 1e-9);
}

TEST(EmbeddedAtoms, FollowABoxThatIsStretched) {
  Crystal one;
  one.scheme.calculate();
  std::array<double, 3> const factor{1.02, 0.97, 1.05};
  auto const stretched = one.sample.scaled(factor);
  auto edges = one.scheme.box().edges();
  for (std::size_t a = 0; a < 3; ++a) edges[a] *= factor[a], edges[3 + a] *= factor[a];
  ASSERT_TRUE(one.scheme.follows_box());
  one.scheme.box().edges(edges);
  take(one.atoms, stretched.places);
  one.scheme.box_changed();
  Ensemble<Newton<3>> fresh("fresh");
  take(fresh, stretched.places);
  EmbeddedAtomScheme scheme(stretched.box, metal());
  scheme.add(fresh);
  EXPECT_NEAR(one.scheme.measure().potential, scheme.measure().potential, 1e-9);
  one.scheme.calculate();
  scheme.calculate();
  for (std::size_t i = 0; i < fresh.size(); ++i)
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(one.atoms.influence_on(i)[k], fresh.influence_on(i)[k], 1e-11);
}

TEST(EmbeddedAtoms, AloneTheyFeelNothing) {
  Ensemble<Newton<3>> atoms("atoms", 2);
  atoms[1].position = {3 * reach, 0, 0};
  EmbeddedAtomScheme scheme(Box({-50, -50, -50}, {50, 50, 50}), metal());
  scheme.add(atoms);
  scheme.calculate();
  for (int a = 0; a < 3; ++a) EXPECT_EQ(atoms.influence_on(0)[a], 0);
  EXPECT_EQ(scheme.measure().potential, 0);
}

TEST(EmbeddedAtoms, RefuseWhatTheyCannotBe) {
  Box const box({0, 0, 0}, {10, 10, 10}, periodic);
  EXPECT_EQ(message([&] {
              EmbeddedAtomScheme(Box({0, 0, 0}, {10, 4, 10}, periodic), metal());
            }),
            "the cut-off 4.2 of the atoms is longer than the periodic axis y, which allows at most 4");
  EXPECT_EQ(message([&] {
              EmbeddedAtomScheme(Box({0, 0, 0}, {10, 10, 10}, Boundary::mirror), metal());
            }),
            "axis x is a mirror: atoms need a reflecting, periodic or open axis there");
  EmbeddedAtomScheme scheme(box, alloy());
  Ensemble<Newton<3>> atoms("atoms", 2);
  Ensemble<Tracer<3>> tracers("tracers", 2);
  EXPECT_EQ(message([&] { scheme.add(atoms); }), "which element is 'atoms'? These are known: A, B");
  EXPECT_EQ(message([&] { scheme.add(atoms, "C"); }), "'atoms' is of element C, which is not among those known: A, B");
  EXPECT_EQ(message([&] { scheme.add(tracers, "A"); }),
            "'tracers' is of class Tracer, which no force moves; atoms are of class Newton or derived from it");
  scheme.add(atoms, "A");
  EXPECT_EQ(message([&] { scheme.add(atoms, "B"); }), "ensemble 'atoms' is added twice");
  EXPECT_EQ(message([&] {
              EmbeddedAtoms(repulsion, density, embedding, {4, 5});
            }),
            "embedded atoms: first = 0.2, switch_from = 5, cutoff = 4: the first must be positive, each no more than "
            "the next");
  EXPECT_EQ(message([&] { EmbeddedAtoms(SuttonChen{1, 1, 9, -6, 3}, {2}); }), "Sutton-Chen: m = -6 must be positive");
  atoms[1].position[2] = std::nan("");
  EXPECT_EQ(message<PhysicsFailure>([&] { scheme.calculate(); }),
            "particle 1 of 'atoms' is at a position that is not finite");
}

}  // namespace
}  // namespace boltzmann::embedded_atoms_test
