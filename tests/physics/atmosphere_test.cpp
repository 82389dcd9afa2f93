// The isothermal atmosphere (section 5.1.3): a gravity load stays exp(-m g h / k T) under free fall and reflection.
#include "shipped.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace boltzmann::atmosphere_test {
namespace {

TEST(Atmosphere, StaysExponential) {
  auto const run = shipped("atmosphere");
  auto& air = *run->ensembles.front();
  Box const& box = run->box();
  int const up = air.dimension() - 1;
  Field const &mass = air.field("mass"), &velocity = air.field("velocity");
  double const k = run->units(constants::boltzmann);
  double const m = air.row(0)[mass.offset];
  double const height = box.length(up), g = run->units(constants::standard_gravity);
  // The temperature that was loaded, from the velocities across.
  auto const temperature = [&] {
    double square = 0;
    for (std::size_t i = 0; i < air.size(); ++i) square += air.row(i)[velocity.offset] * air.row(i)[velocity.offset];
    return m * square / static_cast<double>(air.size()) / k;
  };
  double const loaded = 250;
  double const deviations = loaded * std::sqrt(2.0 / static_cast<double>(air.size()));
  auto const check = [&](char const* when) {
    EXPECT_NEAR(temperature(), loaded, 5 * deviations) << when;
    // Kolmogorov and Smirnov against the truncated exponential.
    std::vector<double> h(air.size());
    for (std::size_t i = 0; i < air.size(); ++i) h[i] = air.row(i)[up] - box.low(up);
    std::sort(h.begin(), h.end());
    double const rate = m * g / (k * loaded), all = 1 - std::exp(-rate * height);
    double distance = 0;
    for (std::size_t i = 0; i < h.size(); ++i) {
      double const expected = (1 - std::exp(-rate * h[i])) / all;
      distance =
          std::max(distance, std::abs(expected - (static_cast<double>(i) + 0.5) / static_cast<double>(h.size())));
    }
    EXPECT_LT(distance, 2.74 / std::sqrt(static_cast<double>(h.size()))) << when;  // 2 exp(-2 x^2): once in 2 million
  };
  check("at the start");
  double const start = total_energy(*run);
  run->simulation->run(run->steps);
  check("at the end");
  EXPECT_NEAR(total_energy(*run) / start, 1, 1e-3);
}

}  // namespace
}  // namespace boltzmann::atmosphere_test
