// Scenarios whose classes are derived in them, against exact solutions and published transitions.
#include "shipped.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace boltzmann::own_classes_test {
namespace {

double field(AnyEnsemble const& particles, std::size_t i, char const* name, int component = 0) {
  return particles.row(i)[particles.field(name).offset + component];
}

std::complex<double> order_of(AnyEnsemble const& particles) {
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) sum += std::polar(1.0, field(particles, i, "angle"));
  return sum / static_cast<double>(particles.size());
}

/// The same as the scenario's diagnosis has it.
double typed_order_of(ScenarioSimulation const& run) {
  std::vector<AnyEnsemble*> const all{run.ensembles[0].get()};
  std::vector<double> values;
  run.diagnoses.at(0)->measure({all, run.simulation->schemes().front()->box(), nullptr, 1, 0, 0}, values);
  return values.at(0);
}

TEST(ChargingGrains, ChargesGrowExponentiallyAndTheClusterComesToRest) {
  auto const run = shipped("charging-grains");
  auto const& grains = *run->ensembles[0];
  auto& simulation = *run->simulation;
  double const e = 1.602176634e-19, k = 8.9875517923e9;
  for (int part = 0; part < 4; ++part) {
    simulation.run(500);
    for (std::size_t i = 0; i < grains.size(); ++i) {
      double const radius = field(grains, i, "radius") * 1e-3;  // m
      double const full = radius * 5 / k / e, tau = 1e-6 / radius;
      EXPECT_NEAR(field(grains, i, "charge"), full * (1 - std::exp(-simulation.time() / tau)), 2e-6 * full) << i;
    }
  }
  // Forces in the bowl, proportional to r, balance those between charges: sum of r . F = 0 says 2 U_bowl = U_charges.
  auto const energies = simulation.measure();
  EXPECT_NEAR(energies.potential / (2 * energies.external), 1, 2e-3);
  EXPECT_GT(energies.external, 0);
}

/// Of Kuramoto's oscillators, coupled so.
std::unique_ptr<ScenarioSimulation> oscillators(double coupling, int count, double time) {
  Overrides few;
  few.set = {fmt::format("influences.0.parameters.K={}", coupling),
             fmt::format("influences.0.parameters.N={}", count),
             fmt::format("ensembles.oscillators.load.counts=[{}]", count),
             fmt::format("ensembles.oscillators.load.spacing={}", 1.0 / count),
             fmt::format("ensembles.oscillators.load.origin=[{}]", 0.5 / count),
             fmt::format("run.time={}", time)};
  return shipped("kuramoto", few);
}

// Y. Kuramoto (1975): r = sqrt(1 - Kc / K) above Kc = 2 gamma = 1, and no order below.
TEST(Kuramoto, OscillatorsFindTogetherAsTheoryHas) {
  for (double const K : {0.6, 1.25, 2.0, 3.0}) {
    auto const run = oscillators(K, 400, 100);
    auto const& all = *run->ensembles[0];
    double const exact = K > 1 ? std::sqrt(1 - 1 / K) : 0;
    run->simulation->run(K < 2 ? 600 : 250);
    double mean = 0;
    for (int step = 0; step < 200; ++step) {
      run->simulation->run(1);
      mean += typed_order_of(*run) / 200;
    }
    EXPECT_NEAR(typed_order_of(*run), std::abs(order_of(all)), 1e-12);
    std::printf("[ KURAMOTO ] K = %.2f: order %.4f (%.4f)\n", K, mean, exact);
    if (K > 1)
      EXPECT_NEAR(mean, exact, 0.03 * exact);
    else
      EXPECT_LT(mean, 0.1);
  }
}

TEST(ActiveMatter, SwimmersWithoutNeighboursWalkPersistently) {
  Overrides alone;
  alone.set = {"influences.1.parameters.turning=0", "ensembles.swimmers.number=2000", "box.boundary='open'"};
  auto const run = shipped("active-matter", alone);
  auto const& swimmers = *run->ensembles[0];
  std::vector<double> start;
  for (std::size_t i = 0; i < swimmers.size(); ++i) start.insert(start.end(), {swimmers.row(i)[0], swimmers.row(i)[1]});
  run->simulation->run(400);
  double const t = 20, D = 0.1, v = 0.5, n = static_cast<double>(swimmers.size());
  double square = 0, fourth = 0;
  for (std::size_t i = 0; i < swimmers.size(); ++i) {
    double const x = swimmers.row(i)[0] - start[2 * i], y = swimmers.row(i)[1] - start[2 * i + 1], d2 = x * x + y * y;
    square += d2 / n, fourth += d2 * d2 / n;
  }
  double const exact = 2 * v * v / (D * D) * (D * t - 1 + std::exp(-D * t));
  EXPECT_NEAR(square, exact, 5 * std::sqrt((fourth - square * square) / n));
}

/// I1(z) / I0(z) by their integrals over a circle, which the rule of rectangles gives to rounding.
double bessel_ratio(double z) {
  double zero = 0, one = 0;
  for (int k = 0; k < 64; ++k) {
    double const angle = 2 * pi * k / 64, weight = std::exp(z * (std::cos(angle) - 1));
    zero += weight, one += weight * std::cos(angle);
  }
  return one / zero;
}

// All with all, and noise D: the order is that of r = I1(K r / D) / I0(K r / D), above K = 2 D.
TEST(ActiveMatter, NoiseAndAlignmentOfAllWithAllGiveTheOrderOfTheMeanField) {
  std::string const text =
      "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0]\nhigh = [1, 1]\n[run]\nstep = 0.02\nsteps = "
      "1\n[[classes]]\nname = "
      "\"Spin\"\nbase = \"Tracer\"\nfields = [{ name = \"angle\", period = \"2 pi\" }]\nrate.angle = "
      "0\ndiffusion.angle = "
      "1\n[[ensembles]]\nname = \"a\"\nclass = \"Spin\"\nintegrator = \"rk2\"\nload = { kind = \"random\" }\nnumber = "
      "500\n[[influences]]\nchanges = \"angle\"\ninfluence = \"3/500*sin(q.angle - p.angle)\"\non = \"a\"\n";
  auto const run = parse_scenario(text, "spins.toml");
  double exact = 1;
  for (int k = 0; k < 200; ++k) exact = bessel_ratio(3 * exact);
  run->simulation->run(400);
  double mean = 0;
  for (int part = 0; part < 200; ++part) {
    run->simulation->run(8);
    mean += std::abs(order_of(*run->ensembles[0])) / 200;
  }
  std::printf("[ SPINS    ] order %.4f, mean field %.4f\n", mean, exact);
  EXPECT_NEAR(mean, exact, 0.03 * exact);
}

TEST(ActiveMatter, FlocksFormBelowAThresholdOfNoise) {
  auto const polarisation = [](double noise) {
    Overrides with;
    with.set = {fmt::format("classes.Swimmer.parameters.noise={}", noise)};
    auto const run = shipped("active-matter", with);
    run->simulation->run(600);
    double const order = typed_order_of(*run);
    EXPECT_NEAR(order, std::abs(order_of(*run->ensembles[0])), 1e-12);
    return order;
  };
  EXPECT_GT(polarisation(0.02), 0.7);
  EXPECT_LT(polarisation(2), 0.2);
}

// A ripple on the state in which prey and predators stay as they are grows or decays at the eigenvalue of the linear
// equations, with the lattice's laplace, -2 (1 - cos(2 pi m / n)) for a wave of m lengths along n sites.
TEST(PredatorPrey, RipplesGrowAndDecayAsLinearTheoryHas) {
  double const F = 0.05, k = 0.06, prey = 0.5 * (1 - std::sqrt(1 - 4 * square(F + k) / F)),
               predators = (1 - prey) * F / (F + k);
  int const n = 24, m = 2;
  double const laplace = -2 * (1 - std::cos(2 * pi * m / n));
  double const a = -square(predators) - F + 0.16 * laplace, b = -2 * prey * predators, c = square(predators),
               d = 2 * prey * predators - F - k + 0.08 * laplace;
  std::complex<double> const root = std::sqrt(std::complex<double>(square(a - d) / 4 + b * c)),
                             fast = (a + d) / 2 + root, slow = (a + d) / 2 - root;
  Overrides ripple;
  ripple.set = {fmt::format("box.high=[{},4]", n),
                fmt::format("ensembles.sites.load.counts=[{},4]", n),
                fmt::format("classes.Site.parameters={{F={}, k={}}}", F, k),
                fmt::format("ensembles.sites.formulas={{prey='{:.17g} + 1e-7*cos(2*pi*{}*x/{})', predators='{:.17g}'}}",
                            prey, m, n, predators),
                "ensembles.sites.integrator='rk4'",
                "run.step=0.1"};
  auto const run = shipped("predator-prey", ripple);
  auto const& sites = *run->ensembles[0];
  auto const mode = [&](char const* name) {
    double sum = 0;
    for (std::size_t i = 0; i < sites.size(); ++i)
      sum += field(sites, i, name) * std::cos(2 * pi * m * sites.row(i)[0] / n) * 2 / static_cast<double>(sites.size());
    return sum;
  };
  double const start = mode("prey"), t = 20;
  run->simulation->run(200);
  // (u, v)' = M (u, v) from (start, 0).
  auto const exact_prey = ((fast - d) * std::exp(fast * t) - (slow - d) * std::exp(slow * t)) / (fast - slow) * start;
  auto const exact_predators = c * (std::exp(fast * t) - std::exp(slow * t)) / (fast - slow) * start;
  EXPECT_NEAR(mode("prey"), exact_prey.real(), 1e-4 * start);
  EXPECT_NEAR(mode("predators"), exact_predators.real(), 1e-4 * start);
}

TEST(PredatorPrey, SpotsDivideAsTheyAreShipped) {
  Overrides small;
  small.set = {"run.time=1200"};
  auto const run = shipped("predator-prey", small);
  auto const& sites = *run->ensembles[0];
  auto const covered = [&] {
    std::size_t count = 0;
    for (std::size_t i = 0; i < sites.size(); ++i) count += field(sites, i, "predators") > 0.15 ? 1 : 0;
    return count;
  };
  run->simulation->run(300);
  std::size_t const before = covered();
  run->simulation->run(900);
  EXPECT_GT(before, 20U);
  EXPECT_GT(covered(), before * 3 / 2);
}

// F. Cucker and S. Smale (2007): all with all, velocities about their mean fall like exp(-K t), and the mean stays.
TEST(Boids, FlyAlikeAsCuckerAndSmaleHave) {
  Overrides alone;
  alone.set = {"influences.0.parameters.push=0",
               "influences.1.influence='K/N*velocity'",
               "influences.1.parameters={K=0.5, N=60}",
               "influences.1.cutoff=1000",
               "box.boundary='open'",
               "influences.2.parameters.together=0",
               "influences.3.parameters.drive=0",
               "ensembles.birds.number=60",
               "ensembles.birds.integrator='rk4'"};
  auto const run = shipped("boids", alone);
  auto const& birds = *run->ensembles[0];
  auto const mean = [&](int a) {
    double sum = 0;
    for (std::size_t i = 0; i < birds.size(); ++i) sum += field(birds, i, "velocity", a) / 60;
    return sum;
  };
  std::vector<double> start;
  double const drift[] = {mean(0), mean(1), mean(2)};
  for (std::size_t i = 0; i < birds.size(); ++i)
    for (int a = 0; a < 3; ++a) start.push_back(field(birds, i, "velocity", a) - drift[a]);
  run->simulation->run(200);
  for (std::size_t i = 0; i < birds.size(); ++i)
    for (int a = 0; a < 3; ++a)
      EXPECT_NEAR(field(birds, i, "velocity", a),
                  drift[a] + start[3 * i + static_cast<std::size_t>(a)] * std::exp(-2.0), 1e-4);
}

TEST(Boids, BecomeAFlockAtTheSpeedTheyLike) {
  auto const run = shipped("boids");
  run->simulation->run(1500);
  auto const& birds = *run->ensembles[0];
  double sum[3] = {}, speeds = 0;
  for (std::size_t i = 0; i < birds.size(); ++i) {
    double square = 0;
    for (int a = 0; a < 3; ++a) {
      double const v = field(birds, i, "velocity", a);
      sum[a] += v / 600, square += v * v;
    }
    speeds += std::sqrt(square) / 600;
  }
  EXPECT_NEAR(speeds, 1, 0.01);
  EXPECT_GT(std::hypot(sum[0], sum[1], sum[2]) / speeds, 0.98);
}

// Two discs that rest at a distance r: twice the angle between their axes is a pendulum, of the frequency
// w = sqrt(8 J (1 - r/R)^2 / inertia), whose period is 4 K(sin(swing/2)) / w, K by the arithmetic-geometric mean.
TEST(NematicDiscs, TwoOfThemSwingLikeAPendulum) {
  double const swing = 1.5;
  Overrides two;
  two.set = {"ensembles.discs.load={kind='positions', positions=[[10,10],[11.3,10]]}",
             "ensembles.discs.temperature=0",
             "dissipation.0.temperature=0",
             "influences.0.parameters.push=0",
             "influences.1.parameters.J=0",
             "classes.Disc.parameters={friction=0, T=0, inertia=0.1}",
             fmt::format("ensembles.discs.formulas={{angle='{}*step(x - 11)'}}", swing / 2),
             "run.step=0.001"};
  auto const run = shipped("nematic-discs", two);
  auto const& discs = *run->ensembles[0];
  double one = 1, other = std::cos(swing / 2);
  for (int k = 0; k < 10; ++k) {
    double const mean = 0.5 * (one + other);
    other = std::sqrt(one * other);
    one = mean;
  }
  double const period = 2 * pi / (one * std::sqrt(8 * 2 * square(1 - 1.3 / 1.8) / 0.1));
  auto const angle = [&] { return 2 * (field(discs, 1, "angle") - field(discs, 0, "angle")); };
  double before = angle(), turned = 0;
  for (int step = 1; turned == 0; ++step) {  // until it is half way, and through zero
    ASSERT_LT(step, 5000);
    run->simulation->run(1);
    double const now = angle();
    if (now <= 0) turned = (step - 1 + before / (before - now)) * 0.001;
    before = now;
  }
  EXPECT_NEAR(4 * turned / period, 1, 1e-4);
}

// Axes keep the temperature of their noise, I <spin^2> = T, and near ones become parallel. Small angles d between two of
// them cost 2 k d^2, k = J (1 - r/R)^2; of the three bonds to a disc equipartition gives <cos 2 d> = 1 - T / (6 k), but
// for the few at defects.
TEST(NematicDiscs, AreParallelToTheirNeighboursAsTheTemperatureOfTheirNoiseLets) {
  auto const run = shipped("nematic-discs");
  auto const& discs = *run->ensembles[0];
  double bond = 0;  // mean of k
  auto const alignment = [&] {
    double sum = 0, bonds = 0;
    bond = 0;
    for (std::size_t i = 0; i < discs.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        double d[3] = {discs.row(j)[0] - discs.row(i)[0], discs.row(j)[1] - discs.row(i)[1], 0};
        run->box().nearest_image(d);
        double const r = std::hypot(d[0], d[1]);
        if (r > 1.4) continue;
        sum += std::cos(2 * (field(discs, i, "angle") - field(discs, j, "angle")));
        bond += 2 * square(1 - r / 1.8);
        ++bonds;
      }
    bond /= bonds;
    return sum / bonds;
  };
  EXPECT_NEAR(alignment(), 0, 0.1);
  run->simulation->run(4000);
  double temperature = 0;
  for (int part = 0; part < 150; ++part) {
    run->simulation->run(20);
    for (std::size_t i = 0; i < discs.size(); ++i)
      temperature += 0.1 * square(field(discs, i, "spin")) / static_cast<double>(discs.size()) / 150;
  }
  EXPECT_NEAR(temperature, 0.05, 0.002);
  double const parallel = alignment(), expected = 1 - 0.05 / (6 * bond);
  std::printf("[ NEMATIC  ] cos 2d %.4f, by equipartition %.4f, temperature %.4f\n", parallel, expected, temperature);
  EXPECT_NEAR(parallel, expected, 0.02);
}

}  // namespace
}  // namespace boltzmann::own_classes_test
