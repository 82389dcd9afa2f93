// Viscosity of vortices against what heat does: Lamb and Oseen's vortex, a blob in space.
#include "shipped.hpp"

#include <boltzmann/boltzmann.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace boltzmann::vortex_viscosity_test {
namespace {

constexpr double viscosity = 0.01;

/// A Gaussian of vorticity of this variance around the origin on a lattice, of which each particle stands for its volume.
template <int D>
void load_gaussian(Ensemble<Diffusive<D>>& vortices, Box const& box, double spacing, double variance) {
  fill_load(vortices, box, {.spacing = spacing});
  for (auto& p : vortices) {
    p.volume = std::pow(spacing, D), p.viscosity = viscosity;
    p.vorticity[cross_dimension<D> - 1] =
        p.volume * std::exp(-norm2(p.position) / (2 * variance)) / std::pow(2 * pi * variance, 0.5 * D);
  }
}

template <int D>
double mean_square_radius(Ensemble<Diffusive<D>> const& vortices) {
  double sum = 0, squares = 0;
  for (auto const& p : vortices) {
    double const gamma = p.vorticity[cross_dimension<D> - 1];
    sum += gamma, squares += gamma * norm2(p.position);
  }
  return squares / sum;
}

/// The largest difference of the vorticity from a profile, in parts of the profile's maximum.
template <int D, class Profile>
double error_of_profile(Ensemble<Diffusive<D>> const& vortices, Profile const& profile) {
  double largest = 0;
  for (auto const& p : vortices)
    largest = std::max(largest, std::abs(p.vorticity[cross_dimension<D> - 1] / p.volume - profile(norm2(p.position))));
  return largest / profile(0.0);
}

template <int D>
auto gaussian(double variance) {
  return [=](double square) { return std::exp(-square / (2 * variance)) / std::pow(2 * pi * variance, 0.5 * D); };
}
/// What the exchange makes of such a Gaussian: vorticity jumps by a Gaussian of the width, 2 nu t / width^2 times in the
/// mean.
template <int D>
auto jumping(double variance, double time, double width) {
  return [=](double square) {
    double const mean = 2 * viscosity * time / (width * width);
    double sum = 0, probability = std::exp(-mean);
    for (int jumps = 0; jumps < 60; ++jumps) {
      sum += probability * gaussian<D>(variance + jumps * width * width)(square);
      probability *= mean / (jumps + 1);
    }
    return sum;
  };
}

// Without a flow: the mean square radius grows by 4 nu t, and the profile is that of Lamb and Oseen to second order in
// the width at a fixed overlap.
TEST(VorticityExchange, SpreadsAsHeatDoesToSecondOrder) {
  double const start = 0.01, time = 0.5, end = start + 2 * viscosity * time;
  std::vector<double> errors;
  for (double const spacing : {0.04, 0.02}) {
    Ensemble<Diffusive<2>> vortices("vortices");
    PairScheme scheme(Box({-0.8, -0.8}, {0.8, 0.8}));
    load_gaussian<2>(vortices, scheme.box(), spacing, start);
    scheme.internal(vortices, VorticityExchange{.width = spacing}, 6 * spacing);
    double const before = mean_square_radius(vortices);
    Simulation simulation(scheme, time / 20);
    simulation.run(20);
    EXPECT_NEAR((mean_square_radius(vortices) - before) / (4 * viscosity * time), 1, 1e-4);
    EXPECT_LT(error_of_profile(vortices, jumping<2>(start, time, spacing)), 1e-3);
    errors.push_back(error_of_profile(vortices, gaussian<2>(end)));
  }
  EXPECT_LT(errors[1], 0.012);
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.4) << errors[0] << ", " << errors[1];
}

// In space 6 nu t, and the vector of vorticity keeps its direction.
TEST(VorticityExchange, SpreadsInSpace) {
  double const start = 0.0225, time = 0.5, width = 0.075;
  Ensemble<Diffusive<3>> vortices("vortices");
  PairScheme scheme(Box({-0.9, -0.9, -0.9}, {0.9, 0.9, 0.9}));
  load_gaussian<3>(vortices, scheme.box(), width, start);
  for (auto& p : vortices) p.core = width, p.vorticity[0] = 0.5 * p.vorticity[2];
  scheme.internal(vortices, VorticityExchange{}, 6 * width);
  double const before = mean_square_radius(vortices);
  Simulation simulation(scheme, time / 10);
  simulation.integrate(vortices, Method::rk2);
  simulation.run(10);
  EXPECT_NEAR((mean_square_radius(vortices) - before) / (6 * viscosity * time), 1, 1e-3);
  EXPECT_LT(error_of_profile(vortices, jumping<3>(start, time, width)), 2e-3);
  for (auto const& p : vortices) EXPECT_NEAR(p.vorticity[0], 0.5 * p.vorticity[2], 1e-12 * p.volume);
}

}  // namespace
}  // namespace boltzmann::vortex_viscosity_test
