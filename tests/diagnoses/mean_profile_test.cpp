// Mean profiles: a gas that is denser and hotter to the right, and moves.
#include <boltzmann/diagnoses/mean_profile.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/tracer.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <cmath>
#include <random>
#include <vector>

namespace boltzmann::mean_profile_test {
namespace {

/// Pressures are no numbers here.
bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

std::vector<double> look(MeanProfile& diagnosis, AnyEnsemble& ensemble, Box const& box, double time) {
  std::vector<AnyEnsemble*> const all{&ensemble};
  std::vector<double> values;
  diagnosis.measure({all, box, nullptr, 1, time, 0}, values);
  return values;
}

template <int D>
void expect_profile() {
  std::mt19937_64 random(test_seed(11));
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  Vector<D> low{}, high{};
  for (int a = 0; a < D; ++a) high[a] = 2;
  Box const box(low, high, Boundary::reflecting);
  constexpr int last = D - 1;
  Ensemble<Newton<D>> gas("gas", 3000);
  MeanProfile diagnosis(
      {&gas}, {.quantities = "density, kinetic-temperature, velocity.x, number", .axis = last, .count = 4, .since = 1});
  std::vector<double> values;
  for (int n = 0; n < 20; ++n) {
    for (auto& p : gas) {
      p.mass = 0.5;
      for (int a = 0; a < D; ++a) p.position[a] = 2 * uniform(random);
      double& x = p.position[last];
      x = 2 * std::sqrt(uniform(random));  // a density that grows as x
      for (int a = 0; a < D; ++a) p.velocity[a] = std::sqrt((1 + x) / 0.5) * normal(random);
      p.velocity[0] += 3;
    }
    values = look(diagnosis, gas, box, n);
    if (n == 10) {
      auto const state = diagnosis.state();
      diagnosis.restore(state);
      auto const again = diagnosis.state();
      EXPECT_TRUE(std::equal(state.begin(), state.end(), again.begin(), again.end(), same));
      EXPECT_THROW(diagnosis.restore(std::span(state).first(9)), Error);
      diagnosis.restore(state);
    }
  }
  EXPECT_EQ(diagnosis.looks(), 19U);
  auto const tables = diagnosis.tables();
  auto const& table = tables[0];
  ASSERT_EQ(table.values.size(), 5U);
  ASSERT_EQ(diagnosis.columns().size(), 8U);
  for (int b = 0; b < 4; ++b) {
    double const from = 0.5 * b, to = from + 0.5, part = (to * to - from * from) / 4;
    double const x = 2.0 / 3 * (to * to * to - from * from * from) / (to * to - from * from);  // where they are
    double const count = 19 * 3000 * part;
    EXPECT_NEAR(table.values[0][b], from + 0.25, 1e-12);
    EXPECT_NEAR(table.values[1][b] / (0.5 * 3000 * part / (0.5 * box.volume() / 2)), 1, 5 / std::sqrt(count)) << D;
    EXPECT_NEAR(table.values[2][b] / (1 + x), 1, 6 * std::sqrt(2 / (D * count)) + 1e-3) << D;
    EXPECT_NEAR(table.values[3][b], 3, 6 * std::sqrt(2 * (1 + x) / count));
    EXPECT_NEAR(table.values[4][b], 3000 * part, 5 * std::sqrt(3000 * part / 19));
  }
  EXPECT_EQ(values[0], table.values[1][0]);
  EXPECT_EQ(values[1], table.values[1][3]);
}

TEST(MeanProfile, IsOfAllLooks) {
  expect_profile<1>();
  expect_profile<2>();
  expect_profile<3>();
}

TEST(MeanProfile, RefusesWhatItCantBeOf) {
  Ensemble<Newton<2>> gas("gas", 1);
  Ensemble<Tracer<2>> dye("dye", 1);
  Box const open(Vector{0.0, 0.0}, Vector{1.0, 1.0}, {Boundary::open, Boundary::periodic});
  EXPECT_NE(message([&] { MeanProfile({&gas}, {}).check(open); }).find("axis x is open"), std::string::npos);
  EXPECT_NO_THROW(MeanProfile({&gas}, {.from = 0, .to = 1}).check(open));
  EXPECT_NO_THROW(MeanProfile({&gas}, {.axis = 1}).check(open));
  EXPECT_THROW(MeanProfile({&gas}, {.axis = 2}), Error);
  EXPECT_THROW(MeanProfile({&gas}, {.from = 1, .to = 0}), Error);
  EXPECT_THROW(MeanProfile({&dye}, {}), Error);
  EXPECT_NE(message([&] { MeanProfile({&gas}, {.quantities = "densty"}); }).find("did you mean 'density'?"),
            std::string::npos);
  MeanProfile pressures({&gas}, {.quantities = "pressure.xx", .axis = 1});
  EXPECT_TRUE(pressures.needs_virial());
  EXPECT_NE(message([&] { look(pressures, gas, open, 0); }).find("only where all influences are pairs"),
            std::string::npos);
}

}  // namespace
}  // namespace boltzmann::mean_profile_test
