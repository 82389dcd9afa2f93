// Time correlations: oscillators, Langevin particles and Green and Kubo's integrals against exact ones.
#include <boltzmann/core/units.hpp>
#include <boltzmann/diagnoses/green_kubo.hpp>
#include <boltzmann/diagnoses/time_correlation.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/newton.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace boltzmann::time_correlation_test {
namespace {

using std::numbers::pi;

std::vector<double> look(Diagnosis& diagnosis, AnyEnsemble& ensemble, Box const& box, int step, double dt,
                         EnergyAndVirial const* measures = nullptr) {
  std::vector<AnyEnsemble*> const all{&ensemble};
  std::vector<double> values;
  diagnosis.measure({all, box, measures, 1, step * dt, step}, values);
  return values;
}

// x = A sin(w t + phase) for evenly spread phases: <v(0).v(t)> = (A w)^2 / 2 cos(w t), <|r(t) - r(0)|^2> =
// A^2 (1 - cos(w t)), exactly.
template <int D>
void expect_oscillators() {
  double const amplitude = 1.3, w = 0.7, dt = 0.05;
  Vector<D> low{}, high{};
  for (int a = 0; a < D; ++a) high[a] = 4;
  Box const box(low, high, Boundary::periodic);
  Ensemble<Newton<D>> atoms("atoms", 24);
  TimeCorrelationOptions const options{.every = 2, .count = 90, .origins = 7};
  VelocityAutocorrelation velocities({&atoms}, options);
  MeanSquareDisplacement places({&atoms}, options);
  std::vector<double> of_velocities, of_places;
  for (int step = 0; step <= 2 * 400; ++step) {
    for (std::size_t i = 0; i < atoms.size(); ++i) {
      double const phase = w * step * dt + 2 * pi * static_cast<double>(i) / 24;
      atoms[i].position[D - 1] = box.wrapped(3.5 + amplitude * std::sin(phase), D - 1);  // across the end of the box
      atoms[i].velocity[D - 1] = amplitude * w * std::cos(phase);
    }
    std::vector<AnyEnsemble*> const all{&atoms};
    for (Diagnosis* one : {static_cast<Diagnosis*>(&velocities), static_cast<Diagnosis*>(&places)})
      one->follow({all, box, nullptr, 1, step * dt, step});
    if (step % 10 != 0) continue;
    of_velocities = look(velocities, atoms, box, step, dt);  // a second look at a step counts once
    of_places = look(places, atoms, box, step, dt);
    if (step == 400)
      for (Diagnosis* one : {static_cast<Diagnosis*>(&velocities), static_cast<Diagnosis*>(&places)}) {
        auto const state = one->state();
        one->restore(state);
        EXPECT_EQ(one->state(), state);
        EXPECT_THROW(one->restore(std::span(state).first(state.size() - 1)), Error);
        one->restore(state);
      }
  }
  auto const c = velocities.autocorrelation(), r2 = places.displacement();
  ASSERT_EQ(c.size(), 91U);
  for (std::size_t k = 0; k < c.size(); ++k) {
    double const cosine = std::cos(w * 2 * dt * static_cast<double>(k));
    EXPECT_NEAR(c[k], amplitude * amplitude * w * w / 2 * cosine, 1e-12) << k;
    EXPECT_NEAR(r2[k], amplitude * amplitude * (1 - cosine), 1e-12) << k;
  }
  // D = the integral of the cosine over D dimensions.
  EXPECT_NEAR(of_velocities[0], amplitude * amplitude * w / 2 * std::sin(w * 9.0) / D, 2e-3);
  // One line at the frequency of the oscillators, with the mean square velocity below it.
  auto const tables = velocities.tables();
  auto const &frequency = tables[1].values[0], &density = tables[1].values[1];
  double sum = 0;
  std::size_t highest = 0;
  for (std::size_t k = 0; k < density.size(); ++k) {
    sum += (k == 0 || k + 1 == density.size() ? 0.5 : 1) * density[k] * frequency[1];
    if (density[k] > density[highest]) highest = k;
  }
  EXPECT_NEAR(sum, c[0], 1e-10);
  EXPECT_NEAR(frequency[highest], w / (2 * pi), 0.6 * frequency[1]);
}

TEST(TimeCorrelation, OfOscillatorsIsExact) {
  expect_oscillators<1>();
  expect_oscillators<2>();
  expect_oscillators<3>();
}

// Particles with friction g and noise, moved exactly: C = d s^2 exp(-g t), <r^2> = 2 d s^2 (g t - 1 + exp(-g t)) / g^2,
// s^2 = k T / m, and displacements are Gaussian.
TEST(TimeCorrelation, OfLangevinParticlesIsTheirs) {
  double const g = 1.7, s2 = 0.6, dt = 0.1, decay = std::exp(-g * dt);
  Box const box(Vector{0.0, 0.0}, Vector{3.0, 3.0}, Boundary::periodic);
  Ensemble<Newton<2>> walkers("walkers", 1500);
  std::mt19937_64 random(test_seed(6));
  std::normal_distribution<double> normal;
  for (auto& p : walkers) {
    p.position = {1, 2};
    for (int a = 0; a < 2; ++a) p.velocity[a] = std::sqrt(s2) * normal(random);
  }
  // The joint Gaussian of the increments of velocity and place (Chandrasekhar 1943).
  double const vv = s2 * (1 - decay * decay), vr = s2 / g * (1 - decay) * (1 - decay),
               rr = s2 / (g * g) * (2 * g * dt - 3 + 4 * decay - decay * decay);
  TimeCorrelationOptions const options{.count = 40, .origins = 20};
  VelocityAutocorrelation velocities({&walkers}, options);
  MeanSquareDisplacement places({&walkers}, options);
  std::vector<double> from_velocities, from_places;
  for (int step = 0; step <= 400; ++step) {
    from_velocities = look(velocities, walkers, box, step, dt);
    from_places = look(places, walkers, box, step, dt);
    for (auto& p : walkers)
      for (int a = 0; a < 2; ++a) {
        double const one = normal(random), two = normal(random);
        p.position[a] +=
            p.velocity[a] * (1 - decay) / g + vr / std::sqrt(vv) * one + std::sqrt(rr - vr * vr / vv) * two;
        p.velocity[a] = p.velocity[a] * decay + std::sqrt(vv) * one;
      }
    box.wrap(walkers);
  }
  // 3000 components, 400 steps of which some 20 are independent: 1 % of <v^2>.
  auto const c = velocities.autocorrelation(), r2 = places.displacement(), shape = places.tables()[0].values[2];
  for (std::size_t k = 1; k < c.size(); ++k) {
    double const t = dt * static_cast<double>(k);
    EXPECT_NEAR(c[k], 2 * s2 * std::exp(-g * t), 0.02 * 2 * s2) << k;
    EXPECT_NEAR(r2[k] / (4 * s2 * (g * t - 1 + std::exp(-g * t)) / (g * g)), 1, 0.04) << k;
    EXPECT_NEAR(shape[k], 0, 0.05) << k;
  }
  EXPECT_NEAR(from_velocities[0], s2 / g * (1 - std::exp(-g * 4)), 0.04 * s2 / g);
  EXPECT_NEAR(from_places[0], s2 / g, 0.05 * s2 / g);
}

TEST(TimeCorrelation, RefusesWhatItCantFollow) {
  Ensemble<Newton<2>> atoms("atoms", 3);
  Box const box(Vector{0.0, 0.0}, Vector{1.0, 1.0});
  MeanSquareDisplacement places({&atoms}, {});
  look(places, atoms, box, 0, 1);
  look(places, atoms, box, 1, 1);
  EXPECT_NE(message([&] { look(places, atoms, box, 4, 1); }).find("equal sampling intervals"), std::string::npos);
  atoms.resize(4);
  EXPECT_NE(message([&] { look(places, atoms, box, 2, 1); }).find("follows the 3 particles"), std::string::npos);
  EXPECT_THROW(VelocityAutocorrelation({&atoms}, {.ensembles = {"atom"}}), Error);
  EXPECT_THROW(MeanSquareDisplacement({&atoms}, {.count = 0}), Error);
  Ensemble<Newton<1>> line("line", 1);
  EXPECT_NE(message([&] { GreenKubo({&line}, {}); }).find("no shear in 1D"), std::string::npos);
  EXPECT_NE(message([&] { GreenKubo({&atoms}, {Transport::conductivity}); }).find("no ensemble has a charge"),
            std::string::npos);
}

/// The integral of exp(-rate t) up to `count` steps as the trapezoidal rule has it.
double decaying(double rate, double dt, int count) {
  double sum = 0;
  for (int k = 0; k <= count; ++k) sum += (k == 0 || k == count ? 0.5 : 1) * dt * std::exp(-rate * dt * k);
  return sum;
}

// A gas of charges that friction g and noise keep at a temperature, and that do not meet: the current forgets itself with
// g, the stress with 2 g, the heat with 3 g. n the density: sigma = n q^2 / (m g) (Drude), eta = n k T / (2 g), and the
// conductivity of heat n k (D + 2) k T / (m 2 3 g).
template <int D>
void expect_gas() {
  double const g = 2, temperature = 1.5, mass = 0.7, charge = 0.4, k = 1, dt = 0.2;
  constexpr int count = 12, rows = 100000;
  Vector<D> low{}, high{};
  for (int a = 0; a < D; ++a) high[a] = 2;
  Box const box(low, high, Boundary::periodic);
  Ensemble<Coulomb<D>> ions("ions", 8);
  std::mt19937_64 random(test_seed(8));
  std::normal_distribution<double> normal;
  double const speed = std::sqrt(k * temperature / mass), decay = std::exp(-g * dt);
  for (auto& p : ions) {
    p.mass = mass;
    p.charge = charge;
    for (int a = 0; a < D; ++a) p.velocity[a] = speed * normal(random);
  }
  GreenKubo stress({&ions}, {Transport::viscosity, count}), current({&ions}, {Transport::conductivity, count}),
      heat({&ions}, {Transport::heat_conductivity, count});
  auto measures = EnergyAndVirial::known();
  measures.per_particle = {std::vector<double>(8, 0.0)};
  measures.virial_per_particle = {std::vector<double>(9 * 8, 0.0)};
  std::vector<double> of_stress, of_current, of_heat;
  for (int row = 0; row < rows; ++row) {
    of_stress = look(stress, ions, box, row, dt, &measures);
    of_current = look(current, ions, box, row, dt, &measures);
    of_heat = look(heat, ions, box, row, dt, &measures);
    if (row < count) {
      EXPECT_TRUE(std::isnan(of_heat[0]));
    }
    if (row == 100)
      for (auto* one : {&stress, &current, &heat}) {
        auto const state = one->state();
        one->restore(state);
        EXPECT_EQ(one->state(), state);
        EXPECT_THROW(one->restore(std::span(state).first(state.size() - 2)), Error);
        one->restore(state);
      }
    for (auto& p : ions)
      for (int a = 0; a < D; ++a)
        p.velocity[a] = decay * p.velocity[a] + speed * std::sqrt(1 - decay * decay) * normal(random);
  }
  double const n = 8 / box.volume();
  // The error of such an integral is about sqrt(2 window / time) by the number of components.
  auto const tolerance = [&](int components) { return 5 * std::sqrt(2.0 * count / rows / components); };
  EXPECT_NEAR(of_stress[0] / (n * k * temperature * decaying(2 * g, dt, count)), 1, tolerance((D - 1) * (D + 2) / 2));
  EXPECT_NEAR(of_current[0] / (n * charge * charge / mass * decaying(g, dt, count)), 1, tolerance(D));
  // Velocities relative to the common one of N particles vary less, by 1 - 1/N, and are correlated by -1/N.
  double const fewer = std::pow(1 - 1.0 / 8, 3) - 7.0 / (8 * 8 * 8);
  EXPECT_NEAR(of_heat[0] / (fewer * n * k * k * temperature / mass * (D + 2) / 2 * decaying(3 * g, dt, count)), 1,
              tolerance(D));
}

TEST(GreenKubo, OfGasesWithFrictionIsExact) {
  expect_gas<2>();
  expect_gas<3>();
}

TEST(TimeCorrelation, OfAGroupIsThatOfAnEnsemble) {
  Box const box(Vector{0.0, 0.0}, Vector{4.0, 4.0}, Boundary::periodic);
  Ensemble<Newton<2>> all("all", 9), some("some", 3);
  std::mt19937_64 random(test_seed(3));
  std::normal_distribution<double> normal;
  for (auto& p : all) p.velocity = {normal(random), normal(random)};
  TimeCorrelationOptions const of_group{
      .count = 8, .origins = 4, .subtract_drift = true, .label = "O", .particles = {7, 1, 4}},
      of_all{.count = 8, .origins = 4, .subtract_drift = true};
  MeanSquareDisplacement way({&all}, of_group), its_way({&some}, of_all);
  VelocityAutocorrelation memory({&all}, of_group), its_memory({&some}, of_all);
  for (int step = 0; step < 30; ++step) {
    for (auto& p : all)
      for (int a = 0; a < 2; ++a) {
        p.velocity[a] += 0.1 * normal(random);
        p.position[a] = box.wrapped(p.position[a] + 0.3 * p.velocity[a], a);
      }
    for (std::size_t k = 0; k < 3; ++k) some[k] = all[std::array{7, 1, 4}[k]];
    auto const found = look(way, all, box, step, 1), its = look(its_way, some, box, step, 1);
    auto const kept = look(memory, all, box, step, 1), its_kept = look(its_memory, some, box, step, 1);
    if (step < 10) continue;  // until all lags are there
    EXPECT_EQ(found, its);
    EXPECT_EQ(kept, its_kept);
  }
  EXPECT_GT(way.displacement()[5], 0.1);
  EXPECT_EQ(way.displacement(), its_way.displacement());
  EXPECT_EQ(way.columns()[0].name, "O diffusion coefficient from displacements");
  EXPECT_EQ(way.tables()[0].name, "mean-square-displacement-O");
  EXPECT_EQ(message([&] {
              MeanSquareDisplacement({&all, &some}, of_group);
            }),
            "a group of chosen particles belongs to one ensemble; name one of all, some");
}

}  // namespace
}  // namespace boltzmann::time_correlation_test
