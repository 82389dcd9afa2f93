// Metals and silicon: energies of perfect crystals are lattice sums, elastic constants those of the papers or of exact
// sums, and what the shipped scenarios show.
#include "shipped.hpp"

#include <boltzmann/boltzmann.hpp>

#include <gtest/gtest.h>

#include <functional>

namespace boltzmann::metals_test {
namespace {

UnitSystem const atomic(1 * units::angstrom, 1 * units::amu, 1 * units::picosecond);
double const eV = atomic(1 * units::electronvolt), GPa = atomic(1e9 * units::pascal);

/// A homogeneous strain of the crystal: x -> x + strain x.
using Strain = std::array<std::array<double, 3>, 3>;

/// The vectors from one atom of fcc to all others nearer than `cutoff`, of a cube with this edge.
std::vector<Vector<3>> fcc_around(double edge, double cutoff, Strain const& strain) {
  std::vector<Vector<3>> all;
  int const most = static_cast<int>(2.2 * cutoff / edge) + 2;
  for (int i = -most; i <= most; ++i)
    for (int j = -most; j <= most; ++j)
      for (int k = -most; k <= most; ++k) {
        if ((i + j + k) % 2 != 0 || (i == 0 && j == 0 && k == 0)) continue;
        Vector<3> const x{i * edge / 2, j * edge / 2, k * edge / 2};
        Vector<3> moved = x;
        for (int a = 0; a < 3; ++a)
          for (int b = 0; b < 3; ++b) moved[a] += strain[a][b] * x[b];
        if (magnitude(moved) < cutoff) all.push_back(moved);
      }
  return all;
}

constexpr double a0 = 3.61, cohesive = 3.50;
SuttonChen copper() { return {0.012382 * eV, a0, 9, 6, 39.432}; }

/// The energy of an atom by direct sums, with the factor that ends them.
double by_sums(double cutoff, Strain const& strain) {
  SuttonChen const law = copper();
  double pairs = 0, density = 0;
  for (auto const& r : fcc_around(a0, cutoff, strain)) {
    double const distance = magnitude(r), x = std::max(0.0, (distance / cutoff - 0.9) / 0.1);
    double const factor = 1 - x * x * x * x * (35 - 84 * x + 70 * x * x - 20 * x * x * x);
    pairs += factor * std::pow(law.a / distance, law.n);
    density += factor * std::pow(law.a / distance, law.m);
  }
  return law.epsilon * (pairs / 2 - law.c * std::sqrt(density));
}

using Energy = std::function<double(Strain const&)>;

/// The second derivative of the energy of an atom by the size of a strain along the axes.
double curvature(Energy const& energy, std::array<double, 3> const& way) {
  double const h = 2e-3;
  auto const at = [&](double s) {
    Strain strain{};
    for (std::size_t a = 0; a < 3; ++a) strain[a][a] = s * way[a];
    return energy(strain);
  };
  return (-at(2 * h) + 16 * at(h) - 30 * at(0) + 16 * at(-h) - at(-2 * h)) / (12 * h * h);
}
// All axes by e: E'' = 9 B V, B = (C11 + 2 C12) / 3. Two axes by e and -e, at zero pressure: E'' = 2 (C11 - C12) V, and
// where these are [110] and [1-10] 4 C44 V.
double bulk(Energy const& energy, double volume) { return curvature(energy, {1, 1, 1}) / (9 * volume); }
double difference(Energy const& energy, double volume) { return curvature(energy, {1, -1, 0}) / (2 * volume); }
double shear(Energy const& turned, double volume) { return curvature(turned, {1, -1, 0}) / (4 * volume); }

/// A cell and the sites in it, in parts of its edges.
struct Cell {
  std::array<double, 3> edges;
  std::vector<std::array<double, 3>> sites;
  std::array<int, 3> counts;
};
/// fcc and diamond with x and y along [110] and [1-10]: strains of these axes are shears of the cube.
Cell turned_fcc(double a, int n) {
  double const h = a / std::sqrt(2);
  return {{h, h, a}, {{0, 0, 0}, {0.5, 0.5, 0.5}}, {7 * n / 5, 7 * n / 5, n}};
}
Cell turned_diamond(double a, int n) {
  double const h = a / std::sqrt(2);
  return {{h, h, a}, {{0, 0, 0}, {0.5, 0.5, 0.5}, {0.5, 0, 0.25}, {0, 0.5, 0.75}}, {n, n, n}};
}

/// A crystal in a box that is strained along its axes.
class Crystal {
 public:
  Crystal(Lattice kind, double spacing, std::size_t cells) {
    LatticeBlock const block{kind, spacing, {cells, cells, cells}};
    sites_ = lattice_sites(block, 3);
    lengths_ = repeat_lengths(block, 3);
    atoms_.resize(sites_.size());
  }
  explicit Crystal(Cell const& cell) {
    for (int a = 0; a < 3; ++a) lengths_[a] = cell.edges[a] * cell.counts[a];
    for (int i = 0; i < cell.counts[0]; ++i)
      for (int j = 0; j < cell.counts[1]; ++j)
        for (int k = 0; k < cell.counts[2]; ++k)
          for (auto const& site : cell.sites)
            sites_.push_back(
                {(i + site[0]) * cell.edges[0], (j + site[1]) * cell.edges[1], (k + site[2]) * cell.edges[2]});
    atoms_.resize(sites_.size());
  }
  template <class Scheme, class Law>
  double energy_per_atom(Law const& law, Strain const& strain, double between = 0) {
    Vector<3> high;
    for (int a = 0; a < 3; ++a) {
      high[a] = lengths_[a] * (1 + strain[a][a]);
      for (std::size_t i = 0; i < sites_.size(); ++i) atoms_[i].position[a] = sites_[i][a] * (1 + strain[a][a]);
    }
    for (std::size_t i = 0; i < sites_.size(); ++i)
      if (i % 4 >= 2) atoms_[i].position[2] += between;
    Scheme scheme(Box(Vector<3>{0, 0, 0}, high, Boundary::periodic), law);
    scheme.add(atoms_);
    auto const measures = scheme.measure();
    scheme.calculate();
    // Where nothing is strained no atom is pushed.
    for (std::size_t i = 0; i < atoms_.size() && strain == Strain{} && between == 0; i += 7)
      EXPECT_LT(magnitude(atoms_.influence_on(i)), 1e-9 * eV);
    pressure_ = measures.virial[0][0] / (high[0] * high[1] * high[2]);
    return measures.potential / static_cast<double>(atoms_.size());
  }
  double pressure() const { return pressure_; }

 private:
  std::vector<std::array<double, 3>> sites_;
  std::array<double, 3> lengths_{};
  Ensemble<Newton<3>> atoms_{"atoms"};
  double pressure_ = 0;
};

TEST(Metals, CopperOfSuttonAndChenHasItsCohesionAndBulkModulus) {
  double const cutoff = 4.5 * a0, volume = a0 * a0 * a0 / 4;
  EmbeddedAtoms const law(copper(), {cutoff});
  Crystal crystal(Lattice::fcc, a0 / std::sqrt(2), 5);
  auto const energy = [&](Strain const& strain) { return crystal.energy_per_atom<EmbeddedAtomScheme>(law, strain); };
  EXPECT_NEAR(energy({}), by_sums(cutoff, {}), 1e-6 * eV);
  EXPECT_NEAR(energy({}) / eV, -cohesive, 0.01);  // of the paper; tails beyond the cut-off are 0.006
  EXPECT_NEAR(crystal.pressure() / GPa, 0, 0.5);  // at its lattice constant
  Energy const sums = [&](Strain const& strain) { return by_sums(cutoff, strain); };
  EXPECT_NEAR(bulk(energy, volume) / bulk(sums, volume), 1, 1e-4);
  EXPECT_NEAR(difference(energy, volume) / difference(sums, volume), 1, 1e-4);
  // Exact without a cut-off: B = E n m / (18 V).
  EXPECT_NEAR(bulk(energy, volume) / (cohesive * eV * 9 * 6 / (18 * volume)), 1, 0.01);
  // The shear of the cube, summed in axes of its own.
  Energy const sheared = [&](Strain const& strain) {
    Strain of_cube{};  // of [110] by e and of [1-10] by -e: xy
    of_cube[0][1] = of_cube[1][0] = strain[0][0];
    return by_sums(cutoff, of_cube);
  };
  Crystal turned(turned_fcc(a0, 5));
  auto const of_turned = [&](Strain const& strain) { return turned.energy_per_atom<EmbeddedAtomScheme>(law, strain); };
  EXPECT_NEAR(shear(of_turned, volume) / shear(sheared, volume), 1, 1e-4);
}

TEST(Metals, SiliconOfStillingerAndWeberHasItsCohesionAndElasticConstants) {
  auto const law = StillingerWeber::silicon(atomic);
  double const spacing = std::pow(2, 1.0 / 6) * law.sigma, edge = 4 / std::sqrt(3) * spacing;
  EXPECT_NEAR(edge, 5.431, 1e-3);
  Crystal crystal(Lattice::diamond, spacing, 2);
  auto const energy = [&](Strain const& strain) { return crystal.energy_per_atom<StillingerWeberScheme>(law, strain); };
  // Two bonds an atom, each of depth epsilon.
  EXPECT_NEAR(energy({}) / law.epsilon, -2, 1e-9);
  EXPECT_NEAR(crystal.pressure() / GPa, 0, 1e-6);
  double const volume = edge * edge * edge / 8;
  // C11 = 151.4, C12 = 76.4, C44 = 56.4 GPa (E. R. Cowley, Phys. Rev. Lett. 60, 2379, 1988; LAMMPS' examples/ELASTIC quotes them).
  double const B = bulk(energy, volume), across = difference(energy, volume);
  EXPECT_NEAR(B / GPa, (151.4 + 2 * 76.4) / 3, 0.5);
  EXPECT_NEAR(across / GPa, 151.4 - 76.4, 0.5);
  Crystal turned(turned_diamond(edge, 2));
  double between = 0;  // how far one fcc lattice is moved against the other, along z
  Energy const of_turned = [&](Strain const& s) {
    return turned.energy_per_atom<StillingerWeberScheme>(law, s, between);
  };
  // Where atoms stay in their places in the cell stretching alone makes B, bending alone C11 - C12, both C44.
  double const held = shear(of_turned, volume);
  EXPECT_NEAR(held / (B + across / 9), 1, 1e-3);
  // They don't: the energy is least for a shift in proportion to the shear.
  double const e = 1e-3, u = 1e-3 * spacing;
  auto const at = [&](double strain, double shift) {
    between = shift;
    return of_turned({{{strain, 0, 0}, {0, -strain, 0}, {0, 0, 0}}});
  };
  double const mixed = (at(e, u) - at(e, -u) - at(-e, u) + at(-e, -u)) / (4 * e * u);
  double const stiffness = (at(0, u) - 2 * at(0, 0) + at(0, -u)) / (u * u);
  EXPECT_NEAR((held - mixed * mixed / (4 * volume * stiffness)) / GPa, 56.4, 0.5);
}

TEST(Metals, TheCopperCrystalVibratesAndKeepsItsEnergy) {
  auto const run = shipped("copper-3d");
  double const start = total_energy(*run), motion = kinetic_energy(*run);
  double const bound = run->simulation->measure().potential / eV / 864;
  EXPECT_NEAR(bound, -3.448, 0.001);
  run->simulation->run(400);
  double mean = 0;
  for (int k = 0; k < 20; ++k) {
    run->simulation->run(20);
    mean += kinetic_energy(*run) / 20;
  }
  // Of leap-frog (omega dt)^2 / 8 at most, omega = 2 pi 7.2 / ps.
  EXPECT_LT(std::abs(total_energy(*run) - start) / motion, 1e-3);
  // Springs take half (equipartition; a little more, since they soften).
  EXPECT_NEAR(mean / motion, 0.5, 0.03);
}

TEST(Metals, TheSiliconCrystalVibratesAndKeepsItsEnergy) {
  auto const run = shipped("silicon");
  double const start = total_energy(*run), motion = kinetic_energy(*run);
  EXPECT_NEAR(run->simulation->measure().potential / eV / 512, -4.3366, 1e-4);
  run->simulation->run(400);
  double mean = 0;
  for (int k = 0; k < 20; ++k) {
    run->simulation->run(30);
    mean += kinetic_energy(*run) / 20;
  }
  // As above, omega = 2 pi 18 / ps.
  EXPECT_LT(std::abs(total_energy(*run) - start) / motion, 1.6e-3);
  EXPECT_NEAR(mean / motion, 0.5, 0.03);
}

/// q6 of all bonds (0.57 in a perfect crystal, 0 in a melt), in the mean over some looks.
double crystalline(ScenarioSimulation& run, int looks, int steps) {
  std::vector<AnyEnsemble*> const all{&ensemble(run, "crystal"), &ensemble(run, "melt")};
  BondOrder order({all[0], all[1]}, {.range = 3.3});
  double sum = 0;
  for (int look = 0; look < looks; ++look) {
    run.simulation->run(static_cast<std::uint64_t>(steps));
    std::vector<double> values;
    order.measure({all, run.box(), nullptr, 1, 0, 0}, values);
    sum += values[1] / looks;
  }
  return sum;
}

/// Crystal and melt side by side, at first and 3 ps later.
std::pair<double, double> side_by_side(std::string const& temperature) {
  Overrides overrides;
  overrides.set = {"equilibrate.temperature=\"max(" + temperature + ", 3000 K - 1500 K/ps*time)\"",
                   "dissipation.0.temperature=\"" + temperature + "\"", "barostat.temperature=\"" + temperature + "\"",
                   "output.trajectory=0"};
  auto const run = shipped("copper-melting", overrides);
  EXPECT_EQ(ensemble(*run, "crystal").size() + ensemble(*run, "melt").size(), 1200u);
  double const first = crystalline(*run, 10, 10);
  run->simulation->run(900);
  double const last = crystalline(*run, 10, 20);
  std::printf("%s: q6 %.3f, then %.3f\n", temperature.c_str(), first, last);
  return {first, last};
}

// This potential melts between 920 and 1000 K: long runs (docs/explanation/validation.md), by which that of Mishin and others
// melts between 1310 and 1350 K (published: 1380 K, from the speeds of fronts that melt a surface, H.-L. Wang,
// X.-X. Wang and H.-Y. Liang, Acta Phys. Sin. 54, 4836, 2005; about 1285 K, from free energies, calphy's documentation).
TEST(Metals, ACopperCrystalGrowsBelowItsMeltingPointAndMeltsAboveIt) {
  auto const [half, grown] = side_by_side("720 K");
  EXPECT_NEAR(half, 0.24, 0.06);
  EXPECT_GT(grown, half + 0.02);
  auto const [other_half, molten] = side_by_side("1200 K");
  EXPECT_GT(other_half, 0.13);
  EXPECT_LT(molten, 0.7 * other_half);
}

TEST(Metals, AKnockOnDisplacesAtomsAndItsEnergyStaysInTheCrystal) {
  auto const run = shipped("copper-cascade");
  auto& atoms = ensemble(*run, "copper");
  ASSERT_EQ(atoms.size(), 4000u);
  int const position = atoms.field("position").offset, anchor = atoms.field("anchor").offset;
  auto const displaced = [&] {
    int count = 0;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
      double const* row = atoms.row(i);
      double square = 0;
      for (int a = 0; a < 3; ++a) square += std::pow(row[position + a] - row[anchor + a], 2);
      if (std::sqrt(square) > a0 / std::sqrt(8)) ++count;
    }
    return count;
  };
  EXPECT_EQ(displaced(), 0);
  double const start = total_energy(*run), thermal = 3999 * 1.5 * 100 * atomic(constants::boltzmann * units::kelvin);
  EXPECT_NEAR((kinetic_energy(*run) - thermal) / eV, 250, 3.5);  // 5 standard errors of the thermal motion
  run->simulation->run(60);
  EXPECT_LT(std::abs(total_energy(*run) - start) / eV, 0.25);
  EXPECT_GE(displaced(), 4);
  EXPECT_LE(displaced(), 40);
}

}  // namespace
}  // namespace boltzmann::metals_test
