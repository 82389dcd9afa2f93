// The Lennard-Jones fluid of NIST's Standard Reference Simulation Website: energies of a configuration, and states of the
// fluid, with the tails of a potential that is cut at 3 sigma.
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/schemes/pair/tail_correction.hpp>
#include <tests/physics/statistics.hpp>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace boltzmann::lennard_jones_reference_test {
namespace {

// Lennard-Jones Fluid Reference Calculations, configuration 4: 30 atoms in a cube of side 8
// (lj_sample_config_periodic4, also in usnistgov/feasst).
constexpr double configuration[30][3] = {
    {1.077169909511, -1.020988125886, -1.348259447733},    {0.1830884592213, -1.557698231574, -1.782405485883},
    {-2.060346185437, 3.927378276290, 3.889555115290},     {1.936298049102, 0.7181973326223, 3.715169082037},
    {-0.7514139041700, -0.4184139469527, -3.250183630687}, {2.257391305584, -1.126577405146, -2.291542913197},
    {0.1208868721243, -1.395611520000, 2.003709382777},    {3.327427055092, -1.476502868105, 3.394023898450},
    {2.130927328546, -1.106827632561, -0.1972896367169},   {2.117442019559, -0.1844743512029, 0.9301638993772},
    {-1.459378119580, 2.382882188329, -3.788199401470},    {2.432313424884, -1.118537915440, -1.224088264651},
    {2.416845366530, 1.845499053895, 2.906107003288},      {2.515247912050, 0.03580976978134, -2.445590080636},
    {1.113585242376, -2.478011342991, -0.008092189527960}, {1.261664073561, 1.075432348722, -2.751715752259},
    {-0.5811873476022, -2.429378395199, 2.668996832737},   {-1.533182296119, 2.319699660489, 1.762429379767},
    {2.639946585704, -0.7847515599358, 2.251233247739},    {-1.927486378623, -1.432729425739, -2.439226375584},
    {0.9212801355440, -2.427925517025, 2.150024430246},    {2.114172305774, 0.9586575168591, -1.790678078404},
    {-0.7312380271746, -3.366157234697, 0.1376597954432},  {1.612569300954, -0.9233415846164, 2.037484769332},
    {3.967911812136, 0.2002508998947, 2.659432175592},     {1.188751191387, -0.05955638413419, -0.7363070447875},
    {3.789497702433, 1.570674334424, 0.7265918374820},     {2.786625773109, -1.524167484397, 0.8358187540631},
    {-1.629362446504, -1.139061532617, -0.7654084051377},  {2.592655226763, 3.786335083587, -1.252452130644}};

struct Measured {
  double energy, virial;
};
Measured of(EnergyAndVirial const& all) {
  return {all.potential, all.virial[0][0] + all.virial[1][1] + all.virial[2][2]};
}

class Configuration : public testing::Test {
 protected:
  Configuration() {
    for (std::size_t i = 0; i < 30; ++i)
      for (int a = 0; a < 3; ++a) atoms[i].position[a] = configuration[i][a];
  }
  Measured pairs(FormulaLaw const& law, double cutoff) {
    PairScheme scheme(box, cutoff);
    scheme.shifted(false);
    scheme.internal(atoms, law);
    return of(scheme.measure());
  }
  Ensemble<Newton<3>> atoms{"atoms", 30};
  Box const box{{-4, -4, -4}, {4, 4, 4}, Boundary::periodic};
  FormulaLaw const law = FormulaLaw::energy("4*((1/r)^12 - (1/r)^6)");
};

// The energies to all digits that feasst's tests have of them; of others NIST tells five.
TEST_F(Configuration, HasTheEnergiesOfNist) {
  PairScheme compiled(box, 3);
  compiled.shifted(false);
  compiled.internal(atoms, LennardJones{1, std::pow(2.0, 1.0 / 6)});
  EXPECT_NEAR(compiled.measure().potential, -16.790321304625856, 1e-11);
  EXPECT_NEAR(pairs(law, 3).energy, -16.790321304625856, 1e-11);
  EXPECT_NEAR(pairs(law, 3).virial, -46.249, 0.0005);
  EXPECT_NEAR(pairs(law, 4).energy, -17.060, 0.0005);
  EXPECT_NEAR(pairs(law, 4).virial, -47.869, 0.0005);
  TailCorrection three(box), four(box);
  three.internal(atoms, law, 3);
  four.internal(atoms, law, 4);
  EXPECT_NEAR(three.measure().potential, -0.5451660014945704, 1e-13);
  EXPECT_NEAR(four.measure().potential, -0.23008, 0.000005);
  // Linear force shift: at_cutoff = "shift".
  auto shifted = law;
  shifted.at_cutoff = FormulaLaw::AtCutoff::shift;
  EXPECT_NEAR(pairs(shifted, 3).energy, -15.001, 0.0005);
  EXPECT_NEAR(pairs(shifted, 3).virial, -43.096, 0.0005);
}

struct State {
  double temperature, density, energy, pressure;
};

/// Means of a run, with their errors: energies are those between atoms, of one.
struct Means {
  Estimate temperature, energy, pressure;
};

/// 500 atoms from a lattice in `more` (a bath, or none behind an equilibration), of which as many samples are taken.
class Liquid {
 public:
  Liquid(double temperature, double density, double cutoff, bool tail, std::string const& more)
      : volume_(n / density), scenario_(parse_scenario(text(temperature, density, cutoff, tail, more), "fluid.toml")) {}

  Simulation& simulation() { return *scenario_->simulation; }
  EnergyAndVirial tail() {
    for (auto const& scheme : scenario_->schemes)
      if (auto* tail = dynamic_cast<TailCorrection*>(scheme.get())) return tail->measure();
    return EnergyAndVirial::known();
  }
  double kinetic() {
    double sum = 0;
    auto const& field = scenario_->ensembles[0]->field("velocity");
    for (std::size_t i = 0; i < scenario_->ensembles[0]->size(); ++i)
      for (int c = 0; c < 3; ++c) sum += 0.5 * std::pow(scenario_->ensembles[0]->row(i)[field.offset + c], 2);
    return sum;
  }
  /// Velocities are scaled so that an atom has this energy, kinetic and of pairs.
  void give_energy(double energy) {
    auto const& field = scenario_->ensembles[0]->field("velocity");
    double const factor = std::sqrt((energy * n - of(simulation().measure()).energy) / kinetic());
    for (std::size_t i = 0; i < scenario_->ensembles[0]->size(); ++i)
      for (int c = 0; c < 3; ++c) scenario_->ensembles[0]->row(i)[field.offset + c] *= factor;
  }
  /// `freedoms`: of the kinetic energy.
  Means run(int samples, double freedoms) {
    std::vector<double> temperatures, energies, pressures;
    for (int sample = 0; sample < samples; ++sample) {
      simulation().run(10);
      auto const now = of(simulation().measure());
      temperatures.push_back(2 * kinetic() / freedoms);
      energies.push_back(now.energy / n);
      pressures.push_back((2 * kinetic() + now.virial) / (3 * volume_));
    }
    return {estimate(temperatures, 10), estimate(energies, 10), estimate(pressures, 10)};
  }

  static constexpr double n = 500;

 private:
  static std::string text(double temperature, double density, double cutoff, bool tail, std::string const& more) {
    double const side = std::cbrt(n / density);
    return fmt::format(
        "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0, 0]\nhigh = [{0}, {0}, {0}]\nboundary = \"periodic\"\n"
        "[run]\nstep = 0.005\nsteps = 1\ncutoff = {3}\nshifted = {4}\nseed = 5\n[[ensembles]]\nname = \"atoms\"\n"
        "class = \"Newton\"\ntemperature = {1}\nremove_drift = true\nload = {{ kind = \"block\", lattice = \"fcc\", "
        "spacing = {2}, counts = [5, 5, 5], jitter = 0.05 }}\n[[influences]]\non = \"atoms\"\nlaw = "
        "\"lennard-jones\"\ndepth = 1\nr0 = 1.122462048309373\ntail = {5}\n{6}",
        side, temperature, side / 5 / std::sqrt(2.0), cutoff, !tail, tail, more);
  }

  double volume_;
  std::unique_ptr<ScenarioSimulation> scenario_;
};

class Fluid : public testing::TestWithParam<State> {};

// NIST's table of Monte Carlo runs of 500 atoms at constant volume, with tails; here by Langevin's bath.
TEST_P(Fluid, HasTheEnergyAndThePressureOfNist) {
  auto const [temperature, density, energy, pressure] = GetParam();
  Liquid liquid(
      temperature, density, 3, true,
      fmt::format("[[dissipation]]\nkind = \"langevin\"\non = \"atoms\"\ntemperature = {}\nrate = 1\n", temperature));
  liquid.simulation().run(1500);
  auto const means = liquid.run(600, 3 * Liquid::n);
  EXPECT_NEAR(means.energy.mean, energy, 5 * std::hypot(means.energy.error, 0.0005));
  EXPECT_NEAR(means.pressure.mean, pressure, 5 * std::hypot(means.pressure.error, 0.002));
  // The tails are far more than what is left to chance.
  EXPECT_LT(means.energy.error, 0.015);
  EXPECT_LT(means.pressure.error, 0.05);
  // Without them there is less by as much: a uniform fluid beyond 3 sigma.
  auto const tail = of(liquid.tail());
  double const x = std::pow(3.0, -3), pi = std::numbers::pi;
  EXPECT_NEAR(tail.energy / Liquid::n, 8 * pi / 3 * density * (x * x * x / 3 - x), 1e-12);
  EXPECT_NEAR(tail.virial / Liquid::n, 16 * pi * density * (2 * x * x * x / 3 - x), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(OfNist, Fluid,
                         testing::Values(State{0.85, 0.776, -5.5121, 0.0067714}, State{0.90, 0.820, -5.7456, 0.82386},
                                         State{0.85, 0.820, -5.7947, 0.55355}, State{0.90, 0.776, -5.4689, 0.24056}),
                         [](auto const& info) { return fmt::format("State{}", info.index); });

std::string bath_before(double temperature) {
  return fmt::format("[equilibrate]\ntemperature = {}\nrate = 1\ntime = 7.5\n", temperature);
}

// At constant energy, between two of these states: whatever temperature comes of it, energy and pressure are on the line
// between theirs (which is 1e-4 from the curve).
TEST(FluidOfConstantEnergy, HasTheEnergyAndThePressureOfNist) {
  State const cold{0.85, 0.820, -5.7947, 0.55355}, warm{0.90, 0.820, -5.7456, 0.82386};
  Liquid liquid(0.875, cold.density, 3, true, bath_before(0.875));
  auto const means = liquid.run(600, 3 * (Liquid::n - 1));
  auto const at = [&](double low, double high) { return (high - low) / (warm.temperature - cold.temperature); };
  double const above = means.temperature.mean - cold.temperature, du = at(cold.energy, warm.energy),
               dp = at(cold.pressure, warm.pressure);
  EXPECT_NEAR(means.temperature.mean, 0.875, 0.05);
  EXPECT_NEAR(means.energy.mean, cold.energy + du * above,
              5 * std::hypot(means.energy.error, du * means.temperature.error, 0.0005));
  EXPECT_NEAR(means.pressure.mean, cold.pressure + dp * above,
              5 * std::hypot(means.pressure.error, dp * means.temperature.error, 0.002));
  EXPECT_LT(means.energy.error, 0.015);
  EXPECT_LT(means.pressure.error, 0.05);
}

// Without tails: the fluid that is cut and shifted at 2.5 sigma, at constant energy. The equation of state of M. Thol, G.
// Rutkai, R. Span, J. Vrabec and R. Lustig, Int. J. Thermophys. 36, 25 (2015), has E = -2.9280 and p = 0.9909 at a density
// of 0.75 and a temperature of 1 (Allen and Tildesley's guide to their programs).
TEST(FluidOfConstantEnergy, HasTheTemperatureAndThePressureOfAShiftedLaw) {
  Liquid liquid(1.0, 0.75, 2.5, false, bath_before(1.0));
  liquid.simulation().run(1);
  liquid.give_energy(-2.9280);
  liquid.simulation().run(500);
  auto const means = liquid.run(600, 3 * (Liquid::n - 1));
  EXPECT_NEAR(means.temperature.mean, 1, 5 * std::hypot(means.temperature.error, 0.001));
  EXPECT_NEAR(means.energy.mean, -2.9280 - 1.5, 5 * std::hypot(means.energy.error, 0.001));
  EXPECT_NEAR(means.pressure.mean, 0.9909, 5 * std::hypot(means.pressure.error, 0.002));
  EXPECT_LT(means.temperature.error, 0.005);
  EXPECT_LT(means.energy.error, 0.01);
  EXPECT_LT(means.pressure.error, 0.03);
}

}  // namespace
}  // namespace boltzmann::lennard_jones_reference_test
