// A wave in a metal rod (section 6.2) against the exact motion of the chain: one end free, one fixed.
#include "shipped.hpp"

#include <gtest/gtest.h>

namespace boltzmann::rod_test {
namespace {

TEST(Rod, FollowsTheExactChain) {
  auto const run = shipped("rod");
  AnyEnsemble* rod = nullptr;
  std::vector<double> positions;
  for (auto& e : run->ensembles) {
    if (!rod) rod = e.get();
    for (std::size_t i = 0; i < e->size(); ++i) positions.push_back(e->row(i)[0]);
  }
  ASSERT_EQ(positions.size(), 100u);
  // Section 6.2: kappa / m = Y / (rho l^2).
  double const spacing = 0.05, omega0 = std::sqrt(12e10 / 8.96e3) / spacing;
  std::size_t const moving = 99;
  std::vector<double> u(moving);
  for (std::size_t p = 0; p < moving; ++p) u[p] = positions[p] - (2 + spacing * static_cast<double>(p));
  EXPECT_NEAR(u[0], 0.01, 1e-12);
  auto const exact = [&](std::size_t p, double t) {
    double sum = 0;
    for (std::size_t k = 0; k < moving; ++k) {
      double const theta = pi * (static_cast<double>(k) + 0.5) / (static_cast<double>(moving) + 0.5);
      double amplitude = 0;
      for (std::size_t q = 0; q < moving; ++q) amplitude += u[q] * std::cos((static_cast<double>(q) + 0.5) * theta);
      amplitude *= 2 / (static_cast<double>(moving) + 0.5);
      sum +=
          amplitude * std::cos((static_cast<double>(p) + 0.5) * theta) * std::cos(2 * omega0 * std::sin(theta / 2) * t);
    }
    return sum;
  };
  for (int part = 0; part < 2; ++part) {
    run->simulation->run(run->steps / 2);
    double largest = 0, scale = 0;
    for (std::size_t p = 0; p < moving; ++p) {
      double const moved = rod->row(p)[0] - (2 + spacing * static_cast<double>(p));
      double const expected = exact(p, run->units.to_si(run->simulation->time(), dimensions::time));
      largest = std::max(largest, std::abs(moved - expected));
      scale = std::max(scale, std::abs(expected));
    }
    std::printf("[  ROD     ] largest error %.2g of %.2g at t = %.3g s\n", largest, scale, run->simulation->time());
    EXPECT_GT(scale, 1e-3);
    EXPECT_LT(largest / scale, 0.01);
  }
}

}  // namespace
}  // namespace boltzmann::rod_test
