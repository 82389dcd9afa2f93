// Molten salt (scenarios/molten-salt.toml): the crystal it begins as has Madelung's energy, and it melts.
#include <tests/physics/shipped.hpp>

#include <boltzmann/core/units.hpp>

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

namespace boltzmann::molten_salt_test {
namespace {

/// |mean of exp(i G.r)| with G = 2 pi / (half of a cell's edge) along x: 1 for the fcc lattice, 1/sqrt(N) for a liquid.
double order(AnyEnsemble const& ions, double cell) {
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < ions.size(); ++i) sum += std::polar(1.0, 4 * std::numbers::pi / cell * ions.row(i)[0]);
  return std::abs(sum) / static_cast<double>(ions.size());
}

TEST(MoltenSalt, BeginsAsACrystalAndMelts) {
  auto const run = shipped("molten-salt");
  auto const &sodium = ensemble(*run, "sodium"), &chloride = ensemble(*run, "chloride");
  ASSERT_EQ(sodium.size(), 256u);
  ASSERT_EQ(chloride.size(), 256u);
  double const cell = 25.49037 / 4, neighbours = cell * std::sqrt(3) / 4;

  // Madelung's constant of zinc blende, and of each Lennard-Jones law its shells to 9 angstrom less what is left there.
  UnitSystem const& units = run->units;
  double const electronvolt = units(units::electronvolt);
  double const coulomb = -1.638055053389 * 14.3996454 * electronvolt / neighbours;  // of a pair; e^2 in eV angstrom
  auto const phi = [&](double r, double r0, double depth) {
    auto const at = [&](double s) { return std::pow(r0 / s, 12) - 2 * std::pow(r0 / s, 6); };
    return r < 9 ? depth * electronvolt * (at(r) - at(9)) : 0;
  };
  double lennard_jones = 0;  // of a sodium ion with all others, and half of a chloride ion with its like
  for (int i = -4; i <= 4; ++i)
    for (int j = -4; j <= 4; ++j)
      for (int k = -4; k <= 4; ++k) {
        if ((i + j + k) % 2 != 0) continue;  // the fcc lattice
        double const like = cell / 2 * std::sqrt(i * i + j * j + k * k), h = 0.5;
        double const unlike = cell / 2 * std::sqrt((i + h) * (i + h) + (j + h) * (j + h) + (k + h) * (k + h));
        if (like > 0) lennard_jones += 0.5 * (phi(like, 2.4245, 0.015292) + phi(like, 5.4220, 5.545e-4));
        lennard_jones += phi(unlike, 3.9232, 2.912e-3);
      }
  double const expected = 256 * (coulomb + lennard_jones);
  EXPECT_GT(std::abs(lennard_jones), 1e-3 * std::abs(coulomb));
  EXPECT_NEAR(run->simulation->measure().potential / expected, 1, 2e-4);
  EXPECT_NEAR(order(sodium, cell), 1, 1e-9);

  double const start = total_energy(*run), kinetic = kinetic_energy(*run);
  run->simulation->run(400);
  double mean = 0;
  for (int look = 0; look < 20; ++look) {
    run->simulation->run(10);
    mean += kinetic_energy(*run) / 20;
  }
  EXPECT_NEAR(total_energy(*run), start, 2e-3 * kinetic);
  // The motion of 512 ions whose energy is conserved varies by 2.5 %, its mean over a few vibrations by 1.1 %.
  EXPECT_NEAR(mean / kinetic, 1250.0 / 3000, 0.03);
  // The square of either has the mean 1/256, or twice that, and an exponential distribution.
  EXPECT_LT(order(sodium, cell), 0.35);
  EXPECT_LT(order(chloride, cell), 0.35);
}

}  // namespace
}  // namespace boltzmann::molten_salt_test
