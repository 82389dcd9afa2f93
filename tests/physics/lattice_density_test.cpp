// Study 3 (examples/lattice_density.cpp): how even the density of a perfect lattice is, and what SmoothScheme finds as
// the gradient of a linear field on it.
#include <tests/physics/shipped.hpp>
#include <tests/physics/smooth_gas.hpp>

#include <boltzmann/diagnoses/smooth_field.hpp>
#include <boltzmann/laws/material.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

namespace boltzmann::lattice_density_test {
namespace {

struct Extremes {
  double range, least_1d, greatest_1d, least_2d, greatest_2d;
};

TEST(LatticeDensity, HasTheExactExtremes) {
  for (Extremes const& exact : {Extremes{1.5, 80.0 / 81, 55.0 / 54, 0.9895344336, 1.0237617202},
                                Extremes{2.0, 505.0 / 512, 65.0 / 64, 0.9845683531, 1.0200672007},
                                Extremes{3.0, 0.9972993827, 1.0030864198, 0.9980326487, 1.0029300344},
                                Extremes{4.0, 0.9991455078, 1.0009765625, 0.9993662677, 1.0006325056},
                                Extremes{6.0, 0.9998312114, 1.0001929012, 0.9999144588, 1.0000897784}}) {
    DensityExtremes const line = lattice_density_extremes(1, WeightShape::lucy, exact.range);
    DensityExtremes const square = lattice_density_extremes(2, WeightShape::lucy, exact.range);
    EXPECT_NEAR(line.least, exact.least_1d, 1e-10) << exact.range;
    EXPECT_NEAR(line.greatest, exact.greatest_1d, 1e-10) << exact.range;
    EXPECT_NEAR(square.least, exact.least_2d, 1e-10) << exact.range;
    EXPECT_NEAR(square.greatest, exact.greatest_2d, 1e-10) << exact.range;
  }
}

/// Nothing but mass.
struct Dust {
  State state(auto const&) const { return {}; }
};

// The scheme's own density at the particles of a periodic lattice: one of these points.
TEST(LatticeDensity, IsThatOfTheScheme) {
  Ensemble<Smooth<2>> gas("gas");
  fill<2>(gas, Vector{0.0, 0.0}, 1, {12, 12});
  for (double const range : {1.5, 2.0, 3.0, 4.0, 6.0}) {
    for (auto& p : gas) p.mass = 1, p.range = range;
    SmoothScheme scheme(Box(Vector{0.0, 0.0}, Vector{12.0, 12.0}, Boundary::periodic));
    scheme.material(gas, Dust{});
    scheme.complete(0);
    DensityExtremes const extremes = lattice_density_extremes(2, WeightShape::lucy, range);
    double const here = SmoothField({gas}, scheme.box()).density(std::array{5.5, 5.5}).value[0];
    for (auto const& p : gas) EXPECT_NEAR(p.density, here, 1e-13);
    EXPECT_GE(here, extremes.least - 1e-12);
    EXPECT_LE(here, extremes.greatest + 1e-12);
  }
}

/// A material that writes down the gradients that it is given at one place.
struct Recorder {
  Vector<2> place;
  Gradients<2>* seen;
  State state(auto const& p) const { return {0, p.specific_energy, 0}; }
  Fluxes<2> fluxes(auto const& p, Gradients<2> const& gradients) const {
    if (magnitude(p.position - place) < 0.1) *seen = gradients;
    return {};
  }
};

// In the middle of a block, at density one: Eq 18 and 19 of velocities and temperatures that are linear in space.
TEST(LatticeDensity, GradientsOfLinearFieldsAreTheScheme) {
  constexpr std::array ranges{1.5, 2.0, 3.0, 6.0}, shares{0.867100, 0.986632, 0.997898, 1.000285};
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    Ensemble<Smooth<2>> gas("gas");
    fill<2>(gas, Vector{-0.5, -0.5}, 1, {31, 31});
    for (auto& p : gas) {
      auto const [x, y] = p.position.component;
      p.mass = 1, p.range = ranges[k];
      p.velocity = {0.3 * x - 0.2 * y, 0.5 * x + 0.7 * y};
      p.specific_energy = 100 + 1.1 * x - 0.9 * y;
    }
    Gradients<2> seen{};
    SmoothScheme scheme(Box(Vector{-1.0, -1.0}, Vector{31.0, 31.0}));
    scheme.material(gas, Recorder{Vector{15.0, 15.0}, &seen});
    scheme.calculate(0);
    double const share = shares[k], precision = 6e-7;
    EXPECT_NEAR(seen.velocity[0][0] / 0.3, share, precision) << ranges[k];
    EXPECT_NEAR(seen.velocity[1][0] / -0.2, share, precision) << ranges[k];  // [a][b] = d v_b / d x_a
    EXPECT_NEAR(seen.velocity[0][1] / 0.5, share, precision) << ranges[k];
    EXPECT_NEAR(seen.velocity[1][1] / 0.7, share, precision) << ranges[k];
    EXPECT_NEAR(seen.temperature[0] / 1.1, share, precision) << ranges[k];
    EXPECT_NEAR(seen.temperature[1] / -0.9, share, precision) << ranges[k];
  }
}

// Forces cancel: the lattice stays, with the greatest density at its particles.
TEST(LatticeDensity, AsItIsShipped) {
  auto const run = shipped("lattice-density");
  auto& lattice = dynamic_cast<Ensemble<Smooth<2>>&>(ensemble(*run, "lattice"));
  run->simulation->run(1);
  run->simulation->schemes().front()->complete(0);
  for (auto const& p : lattice) {
    EXPECT_NEAR(p.density, 1.0200672007, 1e-10);
    EXPECT_LT(magnitude(p.velocity), 1e-15);
  }
}

}  // namespace
}  // namespace boltzmann::lattice_density_test
