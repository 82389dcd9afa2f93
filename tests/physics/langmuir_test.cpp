// Plasma oscillations (scenarios/langmuir.toml): the frequency of a cold plasma is wp, on a mesh times known factors;
// of a warm one that of Bohm and Gross, corrected by kinetic theory.
#include <tests/physics/mesh_factor.hpp>
#include <tests/physics/shipped.hpp>
#include <tests/physics/waves.hpp>

#include <boltzmann/exact/plasma.hpp>
#include <boltzmann/laws/magnetic.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/loaders/sinusoidal_load.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

namespace boltzmann::langmuir_test {
namespace {

constexpr double pi = std::numbers::pi;
using Complex = std::complex<double>;

/// A cold plasma, so many electrons along each edge of a cell, set off by a small displacement along the wave; the
/// frequency of its field.
template <int D>
Swing cold_oscillation(std::array<std::size_t, 3> const& cells, Vector<D> const& spacing,
                       std::array<int, 3> const& mode, std::size_t per_edge, int order, PoissonForm form, double step) {
  Vector<D> edges;
  std::size_t count = 1;
  for (int a = 0; a < D; ++a) {
    edges[a] = spacing[a] * static_cast<double>(cells[static_cast<std::size_t>(a)]);
    count *= per_edge * cells[static_cast<std::size_t>(a)];
  }
  Box const box(Vector<D>{}, edges, Boundary::periodic);
  Ensemble<Coulomb<D>> electrons("electrons", count);
  reduced_plasma(electrons, box);
  Vector<D> k;
  for (int a = 0; a < D; ++a) k[a] = 2 * pi * mode[static_cast<std::size_t>(a)] / edges[a];
  for (std::size_t i = 0; i < count; ++i) {
    Vector<D> x;
    std::size_t rest = i;
    for (int a = 0; a < D; ++a) {
      std::size_t const n = per_edge * cells[static_cast<std::size_t>(a)];
      x[a] = (static_cast<double>(rest % n) + 0.5) * spacing[a] / static_cast<double>(per_edge);
      rest /= n;
    }
    electrons[i].position = x + k * (1e-4 / norm2(k) * std::sin(dot(k, x)));
    for (int a = 0; a < D; ++a) electrons[i].position[a] -= edges[a] * std::floor(electrons[i].position[a] / edges[a]);
  }
  MeshScheme mesh(box, std::vector<std::size_t>(cells.begin(), cells.begin() + D), reduced_law());
  mesh.assignment(order);
  mesh.form(form);
  mesh.background(true);
  mesh.add(electrons);
  Simulation simulation(mesh, step);
  simulation.integrate(electrons, Method::leap_frog);
  std::size_t component = 0;
  while (mode[component] == 0) ++component;
  std::vector<double> times, field;
  simulation.observe(1, [&](Simulation const& s) {
    times.push_back(s.time());
    field.push_back(mode_of(mesh_field(mesh, "field"), component, mode).imag());
  });
  simulation.run(static_cast<std::uint64_t>(6 * 2 * pi / step));
  return swing_of(times, field, 0, 1000);
}

/// The lattice of the electrons itself shifts frequencies by a part that falls as 1 / per_edge^2: two lattices tell
/// what is without.
template <int D>
void expect_cold(std::array<std::size_t, 3> const& cells, Vector<D> const& spacing, std::array<int, 3> const& mode) {
  std::vector<double> q, h;
  for (int a = 0; a < D; ++a) {
    auto const b = static_cast<std::size_t>(a);
    q.push_back(pi * mode[b] / static_cast<double>(cells[b]));
    h.push_back(spacing[a]);
  }
  double const step = 0.2;
  for (int const order : {2, 3})
    for (auto const form : {PoissonForm::finite_difference, PoissonForm::spectral}) {
      auto const coarse = cold_oscillation<D>(cells, spacing, mode, 2, order, form, step);
      auto const fine = cold_oscillation<D>(cells, spacing, mode, 4, order, form, step);
      double const found = (4 * fine.frequency - coarse.frequency) / 3;
      double const factor = mesh_factor(order, form == PoissonForm::spectral, q, h, 10);
      double const expected = leap_frog_frequency(std::sqrt(factor), step);
      EXPECT_GE(fine.peaks, 9u);
      EXPECT_NEAR(fine.frequency / expected, 1, 3e-3) << D << "D, order " << order;
      EXPECT_NEAR(found / expected, 1, 2e-4) << D << "D, order " << order << ", factor " << factor;
      EXPECT_NEAR(fine.growth, 0, 1e-5) << D << "D, order " << order;
    }
}

// The formulas of the mesh in one dimension, from the literature.
TEST(Langmuir, FactorsOfTheMesh) {
  double const q = 0.4, c = std::sin(q) / q;
  EXPECT_NEAR(mesh_factor(2, false, {q}, {0.7}), std::cos(q) * std::pow(c, 3), 1e-14);
  EXPECT_NEAR(mesh_factor(2, true, {q}, {0.7}), std::pow(c, 4), 1e-14);
  EXPECT_NEAR(mesh_factor(3, false, {q}, {0.7}), std::cos(q) * std::pow(c, 5), 1e-14);
}

// 8 cells a wave: the factors are 4 to 14 % of wp.
TEST(Langmuir, ColdPlasmaOnAMesh) {
  expect_cold<1>({32, 1, 1}, {0.25}, {4, 0, 0});
  expect_cold<2>({16, 24, 1}, {0.25, 0.2}, {2, 0, 0});
  expect_cold<2>({16, 24, 1}, {0.25, 0.2}, {1, 2, 0});
  expect_cold<3>({8, 12, 8}, {0.25, 0.2, 0.3}, {1, 1, 1});
}

// 32 cells a wave: wp itself.
TEST(Langmuir, ColdPlasmaIsAtThePlasmaFrequency) {
  for (auto const form : {PoissonForm::finite_difference, PoissonForm::spectral}) {
    EXPECT_NEAR(cold_oscillation<1>({64, 1, 1}, {1.0}, {2, 0, 0}, 4, 2, form, 0.1).frequency, 1, 0.005);
    EXPECT_NEAR(cold_oscillation<2>({32, 16, 1}, {1.0, 1.0}, {1, 0, 0}, 4, 2, form, 0.1).frequency, 1, 0.005);
  }
}

// A warm plasma, k lambda_D = 0.2: kinetic theory gives 1.0641 wp (and no damping to speak of), Bohm and Gross 1.0583.
template <int D>
void expect_warm(std::array<std::size_t, 3> const& cells, Vector<D> const& edges, std::size_t count) {
  Box const box(Vector<D>{}, edges, Boundary::periodic);
  double const k = 2 * pi / edges[0], step = 0.1;
  Ensemble<Coulomb<D>> electrons("electrons", count);
  reduced_plasma(electrons, box);
  quiet_load(electrons, box, {.wave = wave_of_mode(box, 0, 1), .amplitude = 0.02});
  double const thermal = 0.2 / k;
  maxwellian_load(electrons, {.temperature = electrons[0].mass * thermal * thermal, .quiet = true});
  MeshScheme mesh(box, std::vector<std::size_t>(cells.begin(), cells.begin() + D), reduced_law());
  mesh.background(true);
  mesh.add(electrons);
  Simulation simulation(mesh, step);
  simulation.integrate(electrons, Method::leap_frog);
  std::vector<double> times, field;
  simulation.observe(2, [&](Simulation const& s) {
    times.push_back(s.time());
    field.push_back(mode_of(mesh_field(mesh, "field"), 0, {1, 0, 0}).real());
  });
  simulation.run(static_cast<std::uint64_t>(40 / step));
  auto const swing = swing_of(times, field, 1, 40);
  double const factor =
      mesh_factor(2, false, {pi / static_cast<double>(cells[0])}, {edges[0] / static_cast<double>(cells[0])});
  auto const wave = exact::langmuir(std::sqrt(factor), thermal, k);
  EXPECT_NEAR(swing.frequency / wave.frequency, 1, 0.005) << D << "D";
  EXPECT_GT(swing.frequency, 1.04) << D << "D";
  EXPECT_NEAR(swing.growth, wave.growth, 0.003) << D << "D";
}

TEST(Langmuir, WarmPlasmaFollowsBohmAndGross) {
  EXPECT_NEAR(exact::langmuir(1, 1, 0.2).frequency, exact::bohm_gross(1, 1, 0.2), 0.007);
  expect_warm<1>({64, 1, 1}, {64.0}, 50000);
  expect_warm<2>({64, 4, 1}, {64.0, 4.0}, 100000);
  expect_warm<3>({32, 4, 4}, {32.0, 4.0, 4.0}, 100000);
}

// In a magnetic field across the wave: the upper hybrid frequency, wp^2 + wc^2.
TEST(Langmuir, UpperHybridOscillation) {
  std::size_t const n = 32;
  Box const box(Vector{0.0, 0.0}, Vector{32.0, 8.0}, Boundary::periodic);
  Ensemble<Coulomb<2>> electrons("electrons", 16 * n * 8);
  reduced_plasma(electrons, box);
  for (std::size_t i = 0; i < electrons.size(); ++i) {
    double const x = (static_cast<double>(i % (4 * n)) + 0.5) / 4;
    electrons[i].position = {x + 1e-3 * std::sin(2 * pi * x / 32), (static_cast<double>(i / (4 * n)) + 0.5) / 4};
  }
  double const cyclotron = 0.75, step = 0.05;
  MeshScheme mesh(box, {32, 8}, reduced_law());
  mesh.background(true);
  mesh.add(electrons);
  mesh.external(electrons, UniformMagneticField<2>{{cyclotron}});
  Simulation simulation(mesh, step);
  simulation.integrate(electrons, Method::leap_frog);
  std::vector<double> times, field;
  simulation.observe(1, [&](Simulation const& s) {
    times.push_back(s.time());
    field.push_back(mode_of(mesh_field(mesh, "field"), 0, {1, 0, 0}).imag());
  });
  simulation.run(1200);
  // The field swings about what the electrons' displaced centres of gyration make: wc^2 / (wp^2 + wc^2) of the start.
  double const factor = mesh_factor(2, false, {pi / 32, 0}, {1, 1});
  double const hybrid2 = factor + cyclotron * cyclotron, mean = field[0] * cyclotron * cyclotron / hybrid2;
  for (double& f : field) f -= mean;
  auto const swing = swing_of(times, field, 0, 60);
  EXPECT_NEAR(swing.frequency / std::sqrt(hybrid2), 1, 1e-3);
  EXPECT_NEAR(swing.growth, 0, 1e-3);
}

// The shipped run shows the branch of Bohm and Gross in its noise: of each wave the mean frequency, weighted by the
// square of its power, among steps of 0.005, where 300/wp resolve 0.01. (Which single one has the largest power is a
// matter of chance that leaves the line.)
TEST(Langmuir, TheShippedRunShowsTheBranch) {
  auto const run = shipped("langmuir");
  std::vector<std::vector<Complex>> waves(6);
  run->simulation->observe(10, [&](Simulation const&) {
    auto const& field = mesh_field(*run->schemes.front(), "field");
    for (int mode : {3, 4, 5}) waves[static_cast<std::size_t>(mode)].push_back(mode_of(field, 0, {mode, 0, 0}));
  });
  run->simulation->run(3000);
  for (int mode : {3, 4, 5}) {
    auto const& wave = waves[static_cast<std::size_t>(mode)];
    double weights = 0, frequency = 0;
    for (double omega = 0.5; omega < 2; omega += 0.005)
      for (double const sign : {1.0, -1.0}) {
        Complex sum = 0;
        for (std::size_t i = 0; i < wave.size(); ++i) {
          double const at = static_cast<double>(i) / static_cast<double>(wave.size());
          sum += wave[i] * std::pow(std::sin(pi * at), 2) * std::polar(1.0, sign * omega * static_cast<double>(i));
        }
        double const weight = square(std::norm(sum));
        weights += weight;
        frequency += omega * weight;
      }
    frequency /= weights;
    double const k = 2 * pi * mode / 128;
    // The standard error is 0.5 % (of 21 runs); the formula itself is off by 1 % at most.
    EXPECT_NEAR(frequency / exact::bohm_gross(1, 1, k), 1, 0.037) << "k " << k;
    EXPECT_NEAR(frequency / exact::langmuir(1, 1, k).frequency, 1, 0.026) << "k " << k;
  }
}

}  // namespace
}  // namespace boltzmann::langmuir_test
