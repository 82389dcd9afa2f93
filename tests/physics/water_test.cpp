// Water (scenarios/water.toml): energies and forces of SPC/E against sums of the test's own, the rigid molecule, energy
// that is conserved, and the structure that others have found.
//
// H. J. C. Berendsen, J. R. Grigera and T. P. Straatsma, J. Phys. Chem. 91, 6269 (1987), have -41.4 kJ/mol with the 5.22
// that it costs to polarise a molecule, so -46.6 as simulated. P. Mark and L. Nilsson, J. Phys. Chem. A 105, 9954 (2001),
// have the first peak of g(r) between oxygens at 2.75 angstrom. At 1 bar SPC/E has 0.998 g/cm^3
// (Berendsen and others, at 306 K).
#include <tests/physics/shipped.hpp>
#include <tests/physics/statistics.hpp>

#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/diagnoses/radial_distribution.hpp>
#include <boltzmann/simulation/barostat.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>

namespace boltzmann::water_test {
namespace {

using Place = std::array<double, 3>;

constexpr double edge = 18.643, pi = std::numbers::pi;
constexpr double kJ = 100;              // per mol, in amu angstrom^2 / ps^2
constexpr double coulomb = 138935.458;  // e^2 / (4 pi epsilon_0) in amu angstrom^3 / ps^2
constexpr double charge[3] = {-0.8476, 0.4238, 0.4238};

double nearest(double d) { return d - edge * std::round(d / edge); }

double distance(Place const& p, Place const& q) {
  return std::hypot(nearest(q[0] - p[0]), nearest(q[1] - p[1]), nearest(q[2] - p[2]));
}

std::vector<Place> places_of(AnyEnsemble const& water) {
  std::vector<Place> places;
  for (std::size_t i = 0; i < water.size(); ++i) places.push_back({water.row(i)[0], water.row(i)[1], water.row(i)[2]});
  return places;
}

/// Lennard and Jones between oxygens within 9 angstrom.
double lennard_jones(std::vector<Place> const& x, std::size_t i) {
  double energy = 0;
  if (i % 3 != 0) return 0;
  for (std::size_t j = 0; j < x.size(); j += 3) {
    double const r = distance(x[i], x[j]);
    if (j == i || r > 9) continue;
    double const s = std::pow(3.166 / r, 6);
    energy += 4 * 0.650 * kJ * (s * s - s);
  }
  return energy;
}

/// Ewald's sums: of all charges, without pairs of one molecule.
class Ewald {
 public:
  explicit Ewald(std::vector<Place> const& x) : x_(x) {
    constexpr int most = 16;
    for (int a = 0; a <= most; ++a)
      for (int b = a == 0 ? 0 : -most; b <= most; ++b)
        for (int c = a == 0 && b == 0 ? 1 : -most; c <= most; ++c)
          if (a * a + b * b + c * c <= most * most) waves_.push_back({a, b, c});
    for (auto const& wave : waves_) {
      std::complex<double> sum = 0;
      for (std::size_t i = 0; i < x.size(); ++i) sum += charge[i % 3] * phase(wave, x[i]);
      amplitudes_.push_back(sum);
    }
  }
  double energy() const {
    double sum = 0;
    for (std::size_t w = 0; w < waves_.size(); ++w) sum += 2 * factor(waves_[w]) * std::norm(amplitudes_[w]);
    for (std::size_t i = 0; i < x_.size(); ++i)
      sum += 0.5 * near(i, x_[i]) - alpha / std::sqrt(pi) * charge[i % 3] * charge[i % 3];
    return coulomb * sum;
  }
  /// By how much it changes if one goes elsewhere.
  double change(std::size_t i, Place const& to) const {
    double sum = near(i, to) - near(i, x_[i]);
    for (std::size_t w = 0; w < waves_.size(); ++w) {
      auto const moved = charge[i % 3] * (phase(waves_[w], to) - phase(waves_[w], x_[i]));
      sum += 2 * factor(waves_[w]) * (std::norm(amplitudes_[w] + moved) - std::norm(amplitudes_[w]));
    }
    return coulomb * sum;
  }

 private:
  static constexpr double alpha =
      0.42;  // erfc(3.9) at half of the edge; exp(-k^2 / 4 alpha^2) is 3e-9 at the last wave
  static std::complex<double> phase(std::array<int, 3> const& wave, Place const& x) {
    return std::polar(1.0, 2 * pi / edge * (wave[0] * x[0] + wave[1] * x[1] + wave[2] * x[2]));
  }
  static double factor(std::array<int, 3> const& wave) {
    double const k2 = 4 * pi * pi / (edge * edge) * (wave[0] * wave[0] + wave[1] * wave[1] + wave[2] * wave[2]);
    return 2 * pi / (edge * edge * edge) * std::exp(-k2 / (4 * alpha * alpha)) / k2;
  }
  double near(std::size_t i, Place const& at) const {
    double sum = 0;
    for (std::size_t j = 0; j < x_.size(); ++j) {
      if (j == i) continue;
      double const r = distance(at, x_[j]);
      bool const mates = i / 3 == j / 3;  // waves have them, and they are not to be
      if (mates || r < edge / 2)
        sum += charge[i % 3] * charge[j % 3] * (mates ? -std::erf(alpha * r) : std::erfc(alpha * r)) / r;
    }
    return sum;
  }

  std::vector<Place> x_;
  std::vector<std::array<int, 3>> waves_;
  std::vector<std::complex<double>> amplitudes_;
};

TEST(Water, HasTheEnergyAndTheForcesOfAnEwaldSum) {
  Overrides exact;
  exact.set = {"mesh.accuracy=1e-6"};
  auto const run = shipped("water", exact);
  AnyEnsemble const& water = ensemble(*run, "water");
  ASSERT_EQ(water.size(), 648u);
  run->simulation->run(1);
  auto const x = places_of(water);
  Ewald const charges(x);
  double pairs = 0, dipole = 0;
  for (std::size_t i = 0; i < x.size(); i += 3) {
    pairs += 0.5 * lennard_jones(x, i);
    EXPECT_NEAR(distance(x[i], x[i + 1]), 1, 1e-9);
    EXPECT_NEAR(distance(x[i], x[i + 2]), 1, 1e-9);
    EXPECT_NEAR(distance(x[i + 1], x[i + 2]), 2 * std::sin(109.47 / 360 * pi), 1e-6);
    Place d{};
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t k = 1; k < 3; ++k) d[a] += charge[k] * nearest(x[i + k][a] - x[i][a]);
    dipole += std::hypot(d[0], d[1], d[2]) / 216;
  }
  EXPECT_NEAR(dipole * 4.80320, 2.351, 0.001);  // debye in e angstrom
  double const energy = run->simulation->measure().potential;
  EXPECT_NEAR(energy, pairs + charges.energy(), 2e-5 * std::abs(energy));
  // An oxygen and a hydrogen, pushed along each axis; rigid bonds don't know of it.
  double constexpr h = 1e-3;
  for (std::size_t const i : {30, 31, 302, 600})
    for (std::size_t a = 0; a < 3; ++a) {
      double up = 0, down = 0;
      for (double const way : {h, -h}) {
        auto moved = x;
        moved[i][a] += way;
        (way > 0 ? up : down) = charges.change(i, moved[i]) + lennard_jones(moved, i) - lennard_jones(x, i);
      }
      EXPECT_NEAR(water.influence(i)[a], -(up - down) / (2 * h), 5) << i << ", axis " << a;  // rms 11,500
    }
}

TEST(Water, ItsPressureIsTheSlopeOfItsEnergyWithMoleculesThatStayRigid) {
  Overrides exact;
  exact.set = {"mesh.accuracy=1e-7", "run.shifted=true"};  // no jumps where pairs cross the cut-off
  auto const run = shipped("water", exact);
  Simulation& simulation = *run->simulation;
  simulation.run(1);
  AnyEnsemble& water = ensemble(*run, "water");
  std::vector<Scheme*> const schemes = simulation.schemes();
  std::vector<AnyEnsemble*> const all{&water};
  StretchedSystem const system{schemes, all, {true, true, true}, [&] { return simulation.measure(); }};
  auto const here = measure_stretch(system, {0, 1, 2});
  std::vector<double> const rows(water.row(0), water.row(0) + water.size() * water.stride());
  auto const edges = run->box().edges();
  auto const energy = [&](double factor) {
    stretch(system, {factor, factor, factor});
    auto const x = places_of(water);
    double const l = run->box().length(0);
    double const oxygen = (std::remainder(x[4][0] - x[3][0], l)),
                 length =
                     std::hypot(oxygen, std::remainder(x[4][1] - x[3][1], l), std::remainder(x[4][2] - x[3][2], l));
    EXPECT_NEAR(length, 1, 1e-9);
    double const potential = simulation.measure().potential;
    for (auto* scheme : schemes) {
      scheme->box().edges(edges);
      scheme->box_changed();
    }
    std::copy(rows.begin(), rows.end(), water.row(0));
    return potential;
  };
  double constexpr h = 5e-5;
  double const slope = (energy(1 + h) - energy(1 - h)) / (2 * h);
  EXPECT_NEAR(here.kinetic / (1.5 * 215 * 2.4789 * kJ), 1, 0.25);
  double const expected =
      (2 * here.kinetic - slope) / (3 * edge * edge * edge);  // parts of it are a hundred times as much
  EXPECT_NEAR(here.pressure, expected, 1e-4 * std::abs(expected));
}

TEST(Water, HasItsDensityAtOneBar) {
  Overrides held;
  held.set = {"barostat.pressure=\"1 bar\"", "barostat.temperature=\"298.15 K\"",
              "barostat.rate=\"2 / ps\"",    "barostat.compressibility=\"4.5e-10 1/Pa\"",
              "influences.0.tail=true",      "mesh.accuracy=1e-3"};
  auto const run = shipped("water", held);
  run->simulation->run(500);
  std::vector<double> densities;
  for (int look = 0; look < 400; ++look) {
    run->simulation->run(10);
    densities.push_back(total_mass(run->simulation->ensembles()) / run->box().volume() * 1.66053907);
  }
  auto const density = estimate(densities, 8);
  auto const& barostat = *run->simulation->barostats().front();
  std::printf("density %.4f +- %.4f, %zu of %zu moves accepted\n", density.mean, density.error, barostat.accepted(),
              barostat.moves());
  EXPECT_NEAR(density.mean, 0.998, 0.03);
  EXPECT_GT(barostat.accepted(), barostat.moves() * 9 / 10);
}

/// How far the energy strays from its mean (rms) in 80 fs without a bath, looked at every 2 fs.
double straying(double step, int steps) {
  Overrides alone;
  alone.without = {"dissipation"};
  // As it is shipped the energy also strays by what no step can help, which is as much as leap-frog's part at 1 fs: by the
  // mesh's forces, which have no energy, and by jumps where oxygens cross the cut-off.
  alone.set = {"run.step=" + std::to_string(step), "mesh.accuracy=1e-6", "run.shifted=true"};
  auto const run = shipped("water", alone);
  constexpr int looks = 40;
  std::vector<double> energies;
  for (int look = 0; look < looks; ++look) {
    run->simulation->run(static_cast<std::uint64_t>(steps));
    energies.push_back(total_energy(*run));
  }
  AnyEnsemble const& water = ensemble(*run, "water");
  auto const x = places_of(water);
  for (std::size_t i = 0; i < x.size(); i += 3) EXPECT_NEAR(distance(x[i + 1], x[i + 2]), 1.632981, 1e-9);
  return estimate(energies).error * std::sqrt(looks);
}

TEST(Water, ConservesItsEnergy) {
  double const long_steps = straying(0.002, 1), short_steps = straying(0.001, 2);
  double const kinetic = 3 * 215 * 2.4789 * kJ;  // of six degrees of freedom a molecule
  EXPECT_LT(long_steps, 0.001 * kinetic);
  EXPECT_NEAR(long_steps / short_steps, 4, 0.6);  // second order: 3.92 to 4.14 in eleven seeds
}

/// Mean temperatures of motion at full steps: of centres of mass, and about them.
struct Temperatures {
  double translation = 0, rotation = 0;
};

Temperatures temperatures_of_motion(AnyEnsemble const& water) {
  int const mass = water.field("mass").offset, velocity = water.field("velocity").offset;
  double all = 0, translation = 0;  // m v^2
  for (std::size_t i = 0; i < water.size(); i += 3) {
    double total = 0;
    Place momentum{};
    for (std::size_t k = i; k < i + 3; ++k) {
      double const* const row = water.row(k);
      total += row[mass];
      for (std::size_t a = 0; a < 3; ++a) {
        double const v = row[static_cast<std::size_t>(velocity) + a];
        momentum[a] += row[mass] * v;
        all += row[mass] * v * v;
      }
    }
    for (double const p : momentum) translation += p * p / total;
  }
  constexpr double k = 0.83144626, degrees = 3 * 216;
  return {translation / (degrees * k), (all - translation) / (degrees * k)};
}

Temperatures mean_temperatures(std::vector<std::string> const& bath) {
  Overrides overrides;
  overrides.set = bath;
  overrides.set.insert(overrides.set.end(), {"output.trajectory=0", "mesh.accuracy=1e-3"});
  auto const run = shipped("water", overrides);
  run->simulation->run(100);
  constexpr int steps = 1200;
  Temperatures mean;
  for (int step = 0; step < steps; ++step) {
    run->simulation->run(1);
    auto const now = temperatures_of_motion(ensemble(*run, "water"));
    mean.translation += now.translation / steps;
    mean.rotation += now.rotation / steps;
  }
  return mean;
}

// How well the mean temperature is known does not depend on the water: the bath's noise alone moves it by
// 2 T / sqrt(degrees of freedom * rate * time), 1.7 K in 100 ps at 1 / ps. So baths are so fast here that they draw
// velocities anew in each step, and means are known to T sqrt(2 / (degrees of freedom * steps)): 0.34 K of all, 0.48 K of
// translation and of rotation. What a slow bath would have to make up for is in the test of its heat below: 1 % would be
// 16 kJ/mol in each ps.
TEST(Water, IsAsWarmAsItsBath) {
  auto const all = mean_temperatures({"dissipation.0.rate=\"2000 / ps\""});
  // The momentum of the whole is zero: 645 degrees of freedom of 648 are left to the motion of molecules.
  EXPECT_NEAR((all.translation + all.rotation) * 648 / 1293, 298.15, 1.8);  // five standard errors
  // Noise on each atom, from which rigid bonds take their part: what is left has the same temperature everywhere.
  auto const each = mean_temperatures({"dissipation.0.kind=\"langevin\"", "dissipation.0.rate=\"2000 / ps\""});
  EXPECT_NEAR(each.translation, 298.15, 3);
  EXPECT_NEAR(each.rotation, 298.15, 3);
}

TEST(Water, LosesToTheBathWhatTheBathGets) {
  Overrides hot;
  hot.set = {"ensembles.water.temperature=\"400 K\"", "output.trajectory=0"};
  auto const run = shipped("water", hot);
  auto const less_heat = [&] { return total_energy(*run) - run->simulation->measure().heat; };
  run->simulation->run(100);
  double const before = less_heat(), heat = run->simulation->measure().heat;
  run->simulation->run(900);
  EXPECT_LT((run->simulation->measure().heat - heat) / kJ, -100);  // and 5 % of it would be seen
  // The mesh's forces have no energy: by 1e-4 the energy walks 0.4 kJ/mol times the root of the picoseconds, leap-frog
  // has it rise and fall by 0.6.
  EXPECT_NEAR(less_heat() / kJ, before / kJ, 4);
}

TEST(Water, HasTheStructureAndTheEnergyThatOthersHave) {
  Overrides overrides;
  overrides.set = {"output.trajectory=0", "dissipation.0.rate=\"50 / ps\""};  // the mean temperature to 1.4 K
  auto const run = shipped("water", overrides);
  AnyEnsemble& water = ensemble(*run, "water");
  std::vector<std::uint32_t> oxygens, hydrogens;
  for (std::uint32_t i = 0; i < water.size(); ++i) (i % 3 == 0 ? oxygens : hydrogens).push_back(i);
  RadialDistribution oo({&water}, {.to = 6, .count = 120, .particles = oxygens}),
      oh({&water}, {.to = 6, .count = 120, .particles = oxygens, .partners = hydrogens});
  std::vector<AnyEnsemble*> const all{&water};
  std::vector<double> energies, temperatures;
  run->simulation->run(250);
  for (int look = 0; look < 80; ++look) {
    run->simulation->run(25);
    energies.push_back(run->simulation->measure().potential / kJ / 216);
    temperatures.push_back(2 * kinetic_energy(*run) / (6 * 216 - 3) / 0.83144626);
    std::vector<double> values;
    for (auto* one : {&oo, &oh}) one->measure({all, run->box(), nullptr, 1, 0, 0}, values);
  }
  EXPECT_NEAR(estimate(energies, 8).mean, -46.6 + 0.25, 0.7);  // without what lies beyond 9 angstrom
  EXPECT_NEAR(estimate(temperatures, 8).mean, 298.15, 6);
  std::vector<double> values;
  oo.measure({all, run->box(), nullptr, 1, 1, 0}, values);
  EXPECT_NEAR(values[0], 3.05, 0.15);
  EXPECT_NEAR(values[1], 2.75, 0.03);
  auto const r = oo.distances(), g = oo.g(), around = oo.coordination(), of_bonds = oh.coordination();
  auto const bin = [&](double distance) { return static_cast<std::size_t>(distance / 0.05); };
  EXPECT_NEAR(r[bin(3.32)], 3.325, 1e-12);
  EXPECT_NEAR(g[bin(3.32)], 0.82, 0.1);       // the minimum
  EXPECT_NEAR(around[bin(3.32)], 4.4, 0.25);  // neighbours
  EXPECT_NEAR(g[bin(4.52)], 1.12, 0.08);
  EXPECT_NEAR(of_bonds[bin(1.32)], 2, 1e-9);        // the molecule's own
  EXPECT_NEAR(of_bonds[bin(2.42)] - 2, 1.9, 0.15);  // and about two of others
}

}  // namespace
}  // namespace boltzmann::water_test
