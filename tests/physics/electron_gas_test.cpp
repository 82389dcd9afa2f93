// A gas of electrons in thermal equilibrium (scenarios/electron-gas-2d.toml): how much energy each wave of its field
// has.
#include <tests/physics/shipped.hpp>
#include <tests/physics/waves.hpp>
#include <tests/seed.hpp>

#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <map>

namespace boltzmann::electron_gas_test {
namespace {

constexpr double pi = std::numbers::pi;

/// (1/2) / (1 + k^2 lambda_D^2) of kT on a mesh: the energy of a wave of density is v |n_k|^2 / 2 with v = C q^2
/// S^2/K^2, and the force on it kappa.k/k^2 times what that energy would make. Normal fluctuations have |n_k|^2 = N /
/// (1 + n v (kappa.k/k^2) / kT).
double mean_energy(std::array<int, 3> const& mode, std::size_t cells, double edge, int order, bool spectral) {
  double shape = 1, laplacian = 0, square = 0, along = 0;
  for (std::size_t a = 0; a < 2; ++a) {
    double const q = pi * mode[a] / static_cast<double>(cells), k = 2 * pi * mode[a] / edge;
    double const sinc = q == 0 ? 1 : std::sin(q) / q;
    shape *= std::pow(sinc, 2 * order);
    square += k * k;
    laplacian += k * k * (spectral ? 1 : sinc * sinc);
    along += k * k * (spectral ? 1 : sinc * std::cos(q));
  }
  return 0.5 / (laplacian / shape + along / square);
}

// Spectral form and TSC, 2 cells a Debye length, 16 electrons a Debye square. Of the 56 waves with up to 6 periods each
// is seen for 240/wp after 60/wp of settling; waves forget within 1/gamma of a few plasma times, so there are some 1500
// independent values of an exponential distribution: 3 % on the mean over all, and on the groups 8 % (long waves, which
// are remembered longest) and 4 %. What 2D with 16 electrons has beyond the mean field is of the order of 1/16/(4 pi).
TEST(ElectronGas, WavesHaveTheEnergyOfEquilibrium) {
  std::size_t const cells = 32;
  double const edge = 16, step = 0.15;
  Box const box(Vector{0.0, 0.0}, Vector{edge, edge}, Boundary::periodic);
  Ensemble<Coulomb<2>> electrons("electrons", 4096);
  reduced_plasma(electrons, box);
  random_load(electrons, box, {.seed = test_seed(3)});
  maxwellian_load(electrons, {.temperature = electrons[0].mass, .seed = test_seed(3), .exact_temperature = true});
  MeshScheme mesh(box, {cells, cells}, reduced_law());
  mesh.assignment(Assignment::tsc);
  mesh.form(PoissonForm::spectral);
  mesh.background(true);
  mesh.add(electrons);
  Simulation simulation(mesh, step);
  simulation.integrate(electrons, Method::leap_frog);
  simulation.run(400);

  double looks = 0, temperature = 0;
  std::map<std::array<int, 3>, double> energy;
  for (int i = 0; i <= 6; ++i)
    for (int j = i == 0 ? 1 : -6; j <= 6; ++j)
      if (i * i + j * j <= 36) energy[{i, j, 0}] = 0;
  EXPECT_EQ(energy.size(), 56u);
  simulation.observe(8, [&](Simulation const&) {
    ++looks;
    auto const& field = mesh_field(mesh, "field");
    for (auto& [mode, sum] : energy)
      for (std::size_t a = 0; a < 2; ++a) sum += 0.5 * box.volume() * std::norm(mode_of(field, a, mode));
    for (auto const& p : electrons) temperature += 0.5 * p.mass * norm2(p.velocity);
  });
  simulation.run(1600);
  temperature /= looks * static_cast<double>(electrons.size());
  EXPECT_NEAR(temperature / electrons[0].mass, 1, 0.02);

  double all = 0, in_long = 0, in_short = 0, long_ones = 0, short_ones = 0;
  for (auto const& [mode, sum] : energy) {
    double const ratio = sum / looks / temperature / mean_energy(mode, cells, edge, 3, true);
    bool const is_long = mode[0] * mode[0] + mode[1] * mode[1] <= 5;
    all += ratio / static_cast<double>(energy.size());
    (is_long ? in_long : in_short) += ratio;
    (is_long ? long_ones : short_ones) += 1;
  }
  EXPECT_NEAR(all, 1, 0.1);
  EXPECT_NEAR(in_long / long_ones, 1, 0.25);
  EXPECT_NEAR(in_short / short_ones, 1, 0.12);
}

// The shipped run: energy is conserved, and the field's comes down to what its waves have together in equilibrium,
// 0.42.
TEST(ElectronGas, TheShippedRunSettles) {
  auto const run = shipped("electron-gas-2d");
  double expected = 0;
  for (int i = -16; i < 16; ++i)
    for (int j = -16; j < 16; ++j)
      if (i != 0 || j != 0) expected += mean_energy({i, j, 0}, 32, 16, 3, false) / 64;
  double const start = total_energy(*run);
  EXPECT_GT(run->simulation->measure().potential, 1.2 * expected);
  run->simulation->run(500);
  double mean = 0;
  for (int k = 0; k < 25; ++k) {
    run->simulation->run(20);
    mean += run->simulation->measure().potential / 25;
  }
  EXPECT_NEAR(total_energy(*run) / start, 1, 1e-3);
  EXPECT_NEAR(mean / expected, 1, 0.13);  // five standard errors of 2.2 % (3 runs), and 1.6 %
}

}  // namespace
}  // namespace boltzmann::electron_gas_test
