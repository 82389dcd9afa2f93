// Mesoparticles in equilibrium, and on their way to it: temperatures, distributions, rates and conserved quantities
// against what is known exactly.
#include <tests/physics/mesoparticle_gas.hpp>
#include <tests/physics/pvdf.hpp>
#include <tests/physics/statistics.hpp>
#include <tests/seed.hpp>

#include <boltzmann/diagnoses/measures.hpp>

#include <gtest/gtest.h>

#include <numbers>

namespace boltzmann::dpde_equilibrium_test {
namespace {

struct Case {
  Convention convention;
  bool projected, unequal;
  DissipationMethod method;
  bool metropolis;

  std::string name() const {
    return to_string(convention) + (projected ? ", projected" : "") + (unequal ? ", unequal masses, " : ", ") +
           to_string(method) + (metropolis ? ", metropolis" : "");
  }
};

/// The density of internal energies in equilibrium is proportional to eps^shape exp(-eps / kT): a Gamma distribution.
Tabulated gamma_law(double shape, double kt) {
  double const peak = shape * kt, width = std::sqrt(shape + 1) * kt;
  return Tabulated([=](double e) { return e <= 0 ? 0 : std::exp(shape * std::log(e / peak) - (e - peak) / kt); },
                   std::max(0.0, peak - 12 * width), peak + 20 * width);
}

double normal_distribution(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

/// Runs a gas to equilibrium, from equal internal energies or (`loaded`) from those of another temperature, and
/// compares it with the exact law of its total energy. Standard errors (of 22 runs): of the kinetic temperature, which
/// varies by sqrt(1/N) and forgets within half a unit of time, 0.6 % in 14 units; of the internal one, which forgets
/// slowly, a third of what its samples have, 1/sqrt((C - 1) N).
void check_equilibrium(Case const& c, std::size_t count, double heat_capacity, double dt, bool loaded, double rest,
                       std::uint64_t samples) {
  MesoparticleGas<2> g(count, 1.5, 1.6);
  if (c.unequal)
    for (std::size_t i = 0; i < count; ++i) g.gas[i].mass = i % 3 == 0 ? 2.0 : 0.7;
  g.kinetic_temperature(1.1);
  for (auto& p : g.gas) p.internal_energy = heat_capacity * 0.9;
  if (loaded) internal_energy_load(g.gas, StateLaw(heat_capacity), {.temperature = 0.9, .seed = test_seed(6)});
  g.dpd.state(g.gas, StateLaw(heat_capacity));
  g.dpd.internal(g.gas, {.convention = c.convention,
                         .friction = c.projected ? 2.0 : 1,  // of one direction of two
                         .temperature = c.convention == Convention::constant_noise ? 1.0 : 0,
                         .range = 1.6,
                         .projected = c.projected});
  g.dpd.method(c.method);
  g.dpd.corrector(c.method == DissipationMethod::simultaneous);
  g.dpd.metropolis(c.metropolis);
  Simulation simulation(g.scheme, dt);
  simulation.seed(test_seed(1));
  simulation.add(g.dpd);
  simulation.integrate(g.gas, Method::leap_frog);
  double const total = g.kinetic_energy() + g.internal_energy();
  // Each particle has k T of motion in two dimensions, and (C + k) T of heat.
  double const kt = total / (g.size() - 1 + g.size() * (heat_capacity + 1));
  simulation.run(static_cast<std::uint64_t>(std::lround(rest / dt)));
  std::vector<double> kinetic, harmonic;
  for (std::uint64_t sample = 0; sample < samples; ++sample) {
    simulation.run(static_cast<std::uint64_t>(std::lround(0.1 / dt)));
    kinetic.push_back(g.kinetic_temperature());
    harmonic.push_back(g.harmonic_temperature([&](double e) { return e / heat_capacity; }));
  }
  auto const t = estimate(kinetic, 14), t_int = estimate(harmonic, 14);
  std::string const name = c.name();
  SCOPED_TRACE(name);
  std::printf("%s: T_kin %.4f(%.4f) T_int %.4f(%.4f)\n", name.c_str(), t.mean / kt, t.error / kt, t_int.mean / kt,
              t_int.error / kt);
  EXPECT_NEAR(t.mean / kt, 1, 0.035);
  EXPECT_NEAR(t_int.mean / kt, 1, 2 / std::sqrt((heat_capacity - 1) * g.size()));
  // Its motion varies by k T / sqrt(N) of each particle, and what is inside by as much.
  EXPECT_NEAR(g.internal_energy() / g.size() / heat_capacity / kt, 1 + 1 / heat_capacity,
              5 / (heat_capacity * std::sqrt(g.size())));
  std::vector<double> energies, velocities;
  for (auto const& p : g.gas) {
    energies.push_back(p.internal_energy);
    velocities.push_back(p.velocity[0] * std::sqrt(p.mass / kt));
  }
  EXPECT_LT(kolmogorov_smirnov(energies, gamma_law(heat_capacity, kt)), kolmogorov_smirnov_limit);
  EXPECT_LT(kolmogorov_smirnov(velocities, normal_distribution), kolmogorov_smirnov_limit);
  // Conserved to rounding.
  EXPECT_NEAR((g.kinetic_energy() + g.internal_energy()) / total, 1, 1e-12);
  auto const p = momentum(g.gas);
  EXPECT_LT(std::hypot(p[0], p[1]), 1e-11 * g.size());
  if (c.unequal) {  // as warm as each other
    double light = 0, heavy = 0;
    for (std::size_t i = 0; i < count; ++i) (i % 3 == 0 ? heavy : light) += g.gas[i].internal_energy;
    double const n = std::ceil(g.size() / 3);
    EXPECT_NEAR(heavy / n / (light / (g.size() - n)), 1, 5 * std::sqrt(4.5 / (heat_capacity + 1) / g.size()));
  }
}

TEST(DpdeEquilibrium, EveryKindOfDissipationHasTheSame) {
  for (auto const convention : {Convention::constant_noise, Convention::constant_friction})
    for (bool const projected : {false, true})
      for (auto const method : {DissipationMethod::simultaneous, DissipationMethod::shardlow})
        check_equilibrium({convention, projected, true, method, false}, 1200, 12,
                          method == DissipationMethod::simultaneous ? 0.01 : 0.02, true, 6, 140);
}

TEST(DpdeEquilibrium, MolecularHeatCapacityFromEqualEnergies) {
  for (auto const convention : {Convention::constant_noise, Convention::constant_friction})
    check_equilibrium({convention, false, false, DissipationMethod::simultaneous, false}, 1200, 16, 0.02, false, 32,
                      140);
}

TEST(DpdeEquilibrium, AcceptedOrRefusedStepsMayBeLong) {
  check_equilibrium({Convention::constant_friction, true, true, DissipationMethod::shardlow, true}, 1200, 5, 0.1, false,
                    20, 140);
}

// At the start the rate at which motion warms what is inside is a sum over pairs: of gamma' chi^2 v_ij^2, what friction
// takes, less 2 sigma^2 chi^2 / m, what noise gives in two dimensions. Once motion is so hot that all is friction, and
// once it rests: noise. On the average this is d T_kin / dt = -2 (G / m) (T_kin - T_int), G = gamma <sum chi^2>.
TEST(DpdeRelaxation, TwoTemperaturesApproachAtTheKnownRate) {
  for (auto const convention : {Convention::constant_noise, Convention::constant_friction})
    for (double const hot : {1000.0, 0.0}) {
      double const c = 160, friction = 1.7, range = 1.6, mass = 1.4;
      bool const constant_noise = convention == Convention::constant_noise;
      MesoparticleGas<2> g(12000, 1.5, range);
      for (auto& p : g.gas) {
        p.mass = mass;
        p.internal_energy = c;
      }
      if (hot > 0) g.kinetic_temperature(hot);
      g.dpd.state(g.gas, StateLaw(c));
      g.dpd.internal(g.gas, {.convention = convention,
                             .friction = friction,
                             .temperature = constant_noise ? 1.1 : 0,
                             .range = range,
                             .exponent = 2,
                             .projected = false});
      g.dpd.corrector(true);
      double weights = 0, squares = 0;
      for (std::size_t i = 0; i < g.gas.size(); ++i)
        for (std::size_t j = i + 1; j < g.gas.size(); ++j) {
          auto d = g.gas[i].position - g.gas[j].position;
          g.scheme.box().nearest_image(&d[0]);
          double const r2 = norm2(d);
          if (r2 >= range * range) continue;
          double const chi = (1 - std::sqrt(r2) / range) * (1 - std::sqrt(r2) / range);
          weights += chi * chi;
          squares += chi * chi * norm2(g.gas[i].velocity - g.gas[j].velocity);
        }
      // <sum chi^2> = 2 pi n range^2 B(2, 5).
      double const sum = 2 * std::numbers::pi * 1.5 * range * range / 30;
      EXPECT_NEAR(2 * weights / g.size() / sum, 1, 0.04);
      double const drag = friction * (constant_noise ? 1.1 : 1 + 1 / (2 * c)),
                   noise2 = friction * (constant_noise ? 2.2 : 2);
      double const rate = drag * squares - 2 * noise2 * weights / mass;
      double const time = 0.004 * mass / (2 * sum * friction), before = g.internal_energy();
      Simulation simulation(g.scheme, time / 2);
      simulation.seed(test_seed(1));
      simulation.add(g.dpd);
      simulation.integrate(g.gas, Method::leap_frog);
      simulation.run(2);
      double const found = (g.internal_energy() - before) / time / rate;
      std::printf("%s from %g: %.4f of the known rate\n", to_string(convention).c_str(), hot, found);
      // Convention A's friction falls as 1 / T_int, which rises: (eps / eps_0)^2 = 1 + 2x.
      double const x = rate * time / before, expected = constant_noise ? (std::sqrt(1 + 2 * x) - 1) / x : 1;
      // Noise makes an error of sqrt(2 T / (gamma time sum chi^2 v^2)), 0.6 %, where it is hot, of 0.8 % where not.
      EXPECT_NEAR(found / expected, 1, 0.045) << to_string(convention) << " from " << hot;
    }
}

/// Two halves of different internal temperature (1 + or - step), at rest, without friction: heat flows along the
/// gradient.
struct Halves {
  static constexpr std::size_t nx = 24;
  static constexpr double conduction = 2.5, range = 2.3, exponent = 0.5, q = 2 * std::numbers::pi / nx;
  double capacity, n, dt, rate;
  Ensemble<Meso<2>> lattice;
  PairScheme scheme;
  PairDissipation dpd;
  Simulation simulation;

  Halves(double capacity, double step, std::size_t ny)
      : capacity(capacity),
        n(static_cast<double>(nx * ny)),
        lattice("lattice", nx * ny),
        scheme(Box(Vector{0.0, 0.0}, Vector{double(nx), double(ny)}, Boundary::periodic), range),
        dpd(scheme, 1),
        simulation(scheme, 1) {
    block_load(lattice, {Lattice::square, 1, {nx, ny, 1}, {0.5, 0.5, 0}});
    scheme.add(lattice);
    dpd.state(lattice, StateLaw(capacity));
    dpd.internal(lattice, {.range = range, .exponent = exponent, .conduction = conduction});
    for (auto& p : lattice) p.internal_energy = capacity * (p.position[0] < nx / 2.0 ? 1 + step : 1 - step);
    double sum = 0, all = 0;  // over the neighbours of a site
    for (int x = -3; x <= 3; ++x)
      for (int y = -3; y <= 3; ++y) {
        double const r = std::hypot(x, y);
        if (r == 0 || r >= range) continue;
        sum += std::pow(1 - r / range, 2 * exponent) * (1 - std::cos(q * x));
        all += std::pow(1 - r / range, 2 * exponent);
      }
    rate = conduction / capacity * sum;
    dt = 0.02 * capacity / (conduction * all);  // short beside the exchange of a particle with its neighbours
    simulation.step_size(dt);
    simulation.add(dpd);
    simulation.seed(test_seed(1));
    simulation.integrate(lattice, Method::leap_frog);
  }
  double wave() const {
    double amplitude = 0;
    for (auto const& p : lattice) amplitude += p.internal_energy * std::sin(q * p.position[0]);
    return amplitude / n;
  }
  double total() const {
    double energy = 0;
    for (auto const& p : lattice) energy += p.internal_energy;
    return energy;
  }
  void run(double times) { simulation.run(static_cast<std::uint64_t>(times / rate / dt)); }
};

// The lowest wave of temperature decays at kappa / (C T^2) sum_j chi^2 (1 - cos q x_ij), exactly, where amplitudes are
// small; with so large a heat capacity those of chance are smaller yet: sigma^2 of waves in equilibrium is k C T^2 /
// 2N.
TEST(DpdeConduction, HalvesBecomeEqualAtTheKnownRate) {
  Halves halves(16000, 0.15, 40);
  double const start = halves.wave(), chance = std::sqrt(halves.capacity / (2 * halves.n)) / std::abs(start);
  halves.run(0.7);
  double const expected = std::exp(-halves.rate * halves.simulation.time());
  EXPECT_LT(chance, 0.002);
  EXPECT_NEAR(halves.wave() / start / expected, 1, 5 * chance / expected + 0.01);
}

TEST(DpdeConduction, HalvesComeToEquilibrium) {
  Halves halves(16, 0.4, 80);
  double const energy = halves.total();
  halves.run(3.5);
  EXPECT_NEAR(halves.total() / energy, 1, 1e-12);
  std::vector<double> energies;
  for (auto const& p : halves.lattice) energies.push_back(p.internal_energy);
  double const kt = energy / halves.n / (halves.capacity + 1);
  EXPECT_LT(kolmogorov_smirnov(energies, gamma_law(halves.capacity, kt)), kolmogorov_smirnov_limit);
  for (auto const& p : halves.lattice) ASSERT_EQ(magnitude(p.velocity), 0);
}

// A heat capacity that doubles within the range of energies: its own exact law, found here by quadrature from Cv alone.
// Energies near 0 have a density of energy^4, and noise may take what is not there of any of them, however short the
// step: once in 2000 steps of 0.02 with 2000 particles. So steps are accepted or refused, which is exact.
TEST(DpdeEquilibrium, HeatCapacityByATable) {
  std::vector<double> const temperatures{0.5, 0.8, 1.3, 2.0}, capacities{4, 5, 9, 10};
  StateLaw const law(temperatures, capacities);
  auto const capacity = [&](double t) {
    if (t <= 0.5) return 4.0;
    if (t >= 2) return 10.0;
    std::size_t i = 0;
    while (t > temperatures[i + 1]) ++i;
    return capacities[i] +
           (capacities[i + 1] - capacities[i]) * (t - temperatures[i]) / (temperatures[i + 1] - temperatures[i]);
  };
  // With T as the variable: d eps = Cv dT, ds = Cv dT / T.
  std::size_t const n = 40000;
  double const step = 5.0 / n;
  std::vector<double> energy(n + 1, 0.0), entropy(n + 1, 0.0);
  for (std::size_t i = 1; i <= n; ++i) {
    double const t = step * (static_cast<double>(i) - 0.5);
    energy[i] = energy[i - 1] + capacity(t) * step;
    entropy[i] = entropy[i - 1] + capacity(t) * step / t;
  }
  auto const place = [&](double t) { return std::min(static_cast<std::size_t>(std::lround(t / step)), n); };
  auto const density = [&](double t, double kt) {  // of T
    return t < step ? 0
                    : capacity(t) *
                          std::exp(entropy[place(t)] - entropy[place(1)] - (energy[place(t)] - energy[place(1)]) / kt);
  };
  auto const mean = [&](double kt) {
    double all = 0, weighted = 0;
    for (std::size_t i = 1; i < n; ++i) {
      double const t = step * static_cast<double>(i), w = density(t, kt);
      all += w;
      weighted += w * energy[i];
    }
    return weighted / all;
  };
  MesoparticleGas<2> g(2000, 1.5, 1.6);
  g.kinetic_temperature(1.3);
  for (auto& p : g.gas) p.internal_energy = energy[place(0.95)];
  g.dpd.state(g.gas, law);
  g.dpd.internal(g.gas, {.friction = 1, .range = 1.6});
  g.dpd.method(DissipationMethod::shardlow);
  g.dpd.metropolis(true);
  Simulation simulation(g.scheme, 0.04);
  simulation.seed(test_seed(1));
  simulation.add(g.dpd);
  simulation.integrate(g.gas, Method::leap_frog);
  double const total = g.kinetic_energy() / g.size() + g.internal_energy() / g.size();
  double low = 0.5, high = 2;
  for (int i = 0; i < 40; ++i) {
    double const middle = (low + high) / 2;
    (middle + mean(middle) < total ? low : high) = middle;
  }
  double const kt = low;
  simulation.run(700);
  std::vector<double> kinetic, harmonic;
  for (int sample = 0; sample < 200; ++sample) {
    simulation.run(3);
    kinetic.push_back(g.kinetic_temperature());
    harmonic.push_back(g.harmonic_temperature([&](double e) { return law.temperature(e); }));
  }
  auto const t = estimate(kinetic, 20), t_int = estimate(harmonic, 20);
  // As in check_equilibrium: standard errors are 0.4 % and 0.4 %.
  EXPECT_NEAR(t.mean / kt, 1, 0.03);
  EXPECT_NEAR(t_int.mean / kt, 1, 0.025);
  std::vector<double> found;
  for (auto const& p : g.gas) {
    auto const i =
        static_cast<std::size_t>(std::lower_bound(energy.begin(), energy.end(), p.internal_energy) - energy.begin());
    found.push_back(step * static_cast<double>(i));
  }
  EXPECT_LT(kolmogorov_smirnov(found, Tabulated([&](double x) { return density(x, kt); }, 0, 4)),
            kolmogorov_smirnov_limit);
  EXPECT_NEAR(g.kinetic_energy() / g.size() + g.internal_energy() / g.size(), total, 1e-11);
}

// ---- The crystal of the source ----

double total_energy(Simulation const& simulation, AnyEnsemble const& molecules) {
  auto const measures = simulation.measure();
  return kinetic_energy(molecules) + measures.potential + measures.internal;
}

double harmonic_temperature(Ensemble<Meso<2>> const& molecules) {
  double sum = 0;
  for (auto const& p : molecules) sum += pvdf::heat_capacity / p.internal_energy;
  return static_cast<double>(molecules.size()) / sum;
}

TEST(DpdeCrystal, AtThreeHundredKelvin) {
  std::size_t const nx = 30, ny = 32;
  pvdf::Crystal crystal(nx, ny);
  auto& molecules = crystal.molecules;
  internal_energy_load(molecules, StateLaw(pvdf::heat_capacity),
                       {.temperature = 300, .boltzmann_constant = pvdf::boltzmann_constant, .seed = test_seed(3)});
  crystal.dpd.internal(molecules, pvdf::dissipation(10));
  crystal.dpd.corrector(true);
  Simulation simulation(crystal.scheme, 0.005);
  simulation.seed(test_seed(1));
  simulation.add(crystal.dpd);
  simulation.integrate(molecules, Method::leap_frog);
  auto const bath = std::make_shared<LangevinBath>(300, 2, pvdf::boltzmann_constant);
  bath->on(molecules);
  simulation.equilibrate(bath, 800);
  double const n = static_cast<double>(nx * ny);
  std::vector<double> kinetic, internal, pressure;
  for (int sample = 0; sample < 800; ++sample) {
    simulation.run(10);
    if (sample < 100) continue;
    kinetic.push_back(temperature(molecules, pvdf::boltzmann_constant, {.subtract_drift = true}).total);
    internal.push_back(harmonic_temperature(molecules));
    auto const p = pressure_tensor(molecules, simulation.measure(), crystal.scheme.box());
    pressure.push_back((p[0][0] + p[1][1]) / 2 / pvdf::newton_per_metre);
  }
  auto const t_kin = estimate(kinetic, 14), t_int = estimate(internal, 14), p = estimate(pressure, 14);
  // Standard errors: 0.25 % of the two temperatures' ratio; of the temperature itself what n energies make that are
  // loaded with a spread of sqrt(17)/16; 0.0015 N/m of the pressure, most by that.
  EXPECT_NEAR(t_kin.mean / t_int.mean, 1, 0.02);
  EXPECT_NEAR(t_int.mean, 300, 5 * 300 * std::sqrt(17 / n) / 16);
  EXPECT_NEAR(p.mean, 0, 0.01);
  std::printf("T_kin %.2f(%.2f) T_int %.2f(%.2f) pressure %.5f(%.5f) N/m\n", t_kin.mean, t_kin.error, t_int.mean,
              t_int.error, p.mean, p.error);
  double arithmetic = 0;
  std::vector<double> energies;
  for (auto const& m : molecules) {
    arithmetic += m.internal_energy / pvdf::heat_capacity / n;
    energies.push_back(m.internal_energy);
  }
  EXPECT_NEAR(arithmetic / t_int.mean, 1 + 1.0 / 16, 0.018);  // motion takes and gives sqrt(2 / n) / 16: 0.3 %
  EXPECT_LT(kolmogorov_smirnov(energies, gamma_law(16, pvdf::boltzmann_constant * t_int.mean)),
            kolmogorov_smirnov_limit);
  auto const momentum_left = momentum(molecules);
  EXPECT_LT(std::hypot(momentum_left[0], momentum_left[1]), 1e-9 * n * pvdf::mass);
}

TEST(DpdeCrystal, EnergyErrorIsOfSecondOrder) {
  std::vector<double> error;
  for (double const dt : {0.0025, 0.005, 0.01}) {
    pvdf::Crystal crystal(16, 16);
    auto& molecules = crystal.molecules;
    internal_energy_load(molecules, StateLaw(pvdf::heat_capacity),
                         {.temperature = 300, .boltzmann_constant = pvdf::boltzmann_constant, .seed = test_seed(3)});
    crystal.dpd.internal(molecules, pvdf::dissipation());
    Simulation simulation(crystal.scheme, dt);
    simulation.seed(test_seed(1));
    simulation.add(crystal.dpd);
    simulation.integrate(molecules, Method::leap_frog);
    auto const bath = std::make_shared<LangevinBath>(300, 2, pvdf::boltzmann_constant);
    bath->on(molecules);
    simulation.equilibrate(bath, static_cast<std::uint64_t>(std::lround(3 / dt)));
    simulation.run(1);
    auto const before = momentum(molecules);
    // The motion within 0.05 ps changes the error, not its size; over 20 ps it stays bounded.
    double const start = total_energy(simulation, molecules);
    double square = 0, largest = 0, last = 0;
    int const looks = 400;
    for (int look = 0; look < looks; ++look) {
      simulation.run(static_cast<std::uint64_t>(std::lround(20 / dt / looks)));
      double const off = (total_energy(simulation, molecules) - start) / 256 / pvdf::boltzmann_constant;
      square += (off - last) * (off - last) / looks;
      last = off;
      largest = std::max(largest, std::abs(off));
    }
    error.push_back(std::sqrt(square));
    EXPECT_LT(largest, 0.2 * (dt / 0.004) * (dt / 0.004));  // kelvin
    auto const after = momentum(molecules);
    EXPECT_LT(std::hypot(after[0] - before[0], after[1] - before[1]), 1e-9 * 256 * pvdf::mass);
  }
  std::printf("energy errors %.5f %.5f %.5f K\n", error[0], error[1], error[2]);
  // Each error is known to 5 %, so that the order has a standard error of 0.05.
  EXPECT_NEAR(std::log2(error[2] / error[0]) / 2, 2, 0.3);
}

// Without noise: hotter motion warms what is inside and the other way round, until both are equal, but for the two
// percent by which velocities are not quite Maxwell's then (more where friction is stronger).
TEST(DpdeDeterministic, TemperaturesMeet) {
  for (double const warm : {480.0, 150.0}) {
    pvdf::Crystal crystal(16, 16);
    auto& molecules = crystal.molecules;
    for (auto& p : molecules) p.internal_energy = pvdf::heat_capacity * 300;
    auto d = pvdf::dissipation(2);
    d.convention = Convention::deterministic;
    d.temperature = 300;
    crystal.dpd.internal(molecules, d);
    Simulation simulation(crystal.scheme, 0.005);
    simulation.seed(test_seed(1));
    simulation.add(crystal.dpd);
    simulation.integrate(molecules, Method::leap_frog);
    auto const bath = std::make_shared<LangevinBath>(warm, 2, pvdf::boltzmann_constant);
    bath->on(molecules);
    simulation.equilibrate(bath, 600);
    simulation.run(1);
    EXPECT_NEAR(temperature(molecules, pvdf::boltzmann_constant, {.subtract_drift = true}).total, warm,
                5 * warm / std::sqrt(256.0));
    double const start = total_energy(simulation, molecules);
    simulation.run(5000);
    std::vector<double> kinetic, internal;
    for (int sample = 0; sample < 400; ++sample) {
      simulation.run(10);
      kinetic.push_back(temperature(molecules, pvdf::boltzmann_constant, {.subtract_drift = true}).total);
      internal.push_back(harmonic_temperature(molecules));
    }
    auto const t_kin = estimate(kinetic, 10), t_int = estimate(internal, 10);
    std::printf("deterministic: T_kin %.2f(%.2f) T_int %.2f(%.2f)\n", t_kin.mean, t_kin.error, t_int.mean, t_int.error);
    EXPECT_NEAR(t_kin.mean / t_int.mean, 1.02, 0.03);
    EXPECT_GT(std::abs(t_int.mean - 300), 5);
    EXPECT_NEAR((total_energy(simulation, molecules) - start) / 256 / pvdf::boltzmann_constant, 0,
                1);  // kelvin; one end is off by 0.15
  }
}

}  // namespace
}  // namespace boltzmann::dpde_equilibrium_test
