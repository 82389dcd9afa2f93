// Diffusion: random walks of known coefficient, through periodic axes, and straight flight.
#include "tests/bzm/command.hpp"

#include <boltzmann/core/random.hpp>
#include <boltzmann/diagnoses/diffusion.hpp>
#include <boltzmann/particles/newton.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <cmath>
#include <vector>

namespace boltzmann::diffusion_test {
namespace {

std::vector<double> look(Diffusion& diffusion, std::vector<AnyEnsemble*> const& ensembles, Box const& box,
                         double time) {
  std::vector<double> values;
  diffusion.measure({ensembles, box, nullptr, 1, time, 0}, values);
  return values;
}

TEST(Diffusion, OfARandomWalkIsItsCoefficient) {
  Box const box(Vector{0.0, 0.0}, Vector{3.0, 5.0}, {Boundary::periodic, Boundary::open});
  Ensemble<Newton<2>> walkers("walkers", 12000);
  for (std::size_t i = 0; i < walkers.size(); ++i) walkers[i].position = {1.5, 2.5};
  std::vector<AnyEnsemble*> const all{&walkers};
  Diffusion diffusion({&walkers}, {}, 1);
  EXPECT_EQ(diffusion.columns()[1].name, "diffusion coefficient");
  double const coefficient = 0.7, dt = 0.04;
  std::vector<double> values;
  for (int step = 0; step <= 125; ++step) {
    values = look(diffusion, all, box, step * dt);
    if (step < 25) {
      EXPECT_TRUE(std::isnan(values[0]));
    }
    if (step == 75) {  // a restart in between changes nothing
      auto const state = diffusion.state();
      Diffusion again({&walkers}, {}, 1);
      again.restore(state);
      EXPECT_EQ(again.state(), state);
      EXPECT_THROW(again.restore(std::span(state).first(100)), Error);
    }
    for (std::size_t i = 0; i < walkers.size(); ++i) {
      Stream stream(test_seed(1), step, i, Purpose::random_walk);
      for (int a = 0; a < 2; ++a)
        walkers[i].position[a] += std::sqrt(2 * coefficient * dt) * stream.normal() + (a == 0 ? 0.08 : 0);  // and drift
    }
    box.wrap(walkers);
  }
  // <r^2> = 4 D t after 4 time units; its relative standard error is 1 / sqrt(N); five of it.
  EXPECT_NEAR(values[0], 4 * coefficient * 4, 5 * 4 * coefficient * 4 / std::sqrt(12000.0));
  EXPECT_NEAR(values[1], coefficient, 0.05 * coefficient);
}

TEST(Diffusion, OfFlightIsQuadraticAndOfNothingUnknown) {
  Box const box(Vector{0.0}, Vector{10.0}, Boundary::periodic);
  Ensemble<Newton<1>> pair("pair", 2), nobody("nobody");
  std::vector<AnyEnsemble*> const all{&pair, &nobody};
  Diffusion diffusion({&pair, &nobody}, {}, 0);
  EXPECT_EQ(diffusion.columns()[2].name, "nobody mean square displacement");
  for (int n = 0; n < 20; ++n) {  // one to the right, one to the left, around the box and on
    pair[0].position = {box.wrapped(1.0 * n, 0)};
    pair[1].position = {box.wrapped(-1.0 * n, 0)};
    auto const values = look(diffusion, all, box, n);
    EXPECT_DOUBLE_EQ(values[0], 1.0 * n * n);
    EXPECT_TRUE(std::isnan(values[2]) && std::isnan(values[3]));
  }
  pair.resize(3);
  EXPECT_THROW(look(diffusion, all, box, 20), Error);
  EXPECT_THROW(Diffusion({&pair}, {"pear"}, 0), Error);
}

// Two particles that fly apart, round and round: between two rows each has crossed the box four times.
TEST(Diffusion, FollowsParticlesBetweenRows) {
  auto const last_row = [](char const* rows) {
    test::Folder folder;
    test::write_text(folder / "flight.toml", std::string(R"([units]
base = "reduced"
[box]
low = [0, 0]
high = [10, 10]
boundary = "periodic"
[run]
step = 0.01
steps = 4000
[[ensembles]]
name = "pair"
class = "Newton"
integrator = "leap-frog"
mass = 1
load = { kind = "positions", positions = [[1, 1], [9, 9]] }
formulas = { velocity = ["x - 5", 0] }
[[influences]]
law = "uniform-gravity"
on = "pair"
acceleration = [0, 0]
[[diagnoses]]
kind = "diffusion"
[output]
diagnoses = )") + rows);
    auto const run = test::bzm({"run", "flight.toml", "--out", "run", "--quiet"}, folder.string());
    EXPECT_EQ(run.status, 0) << run.err;
    // And with a stop in between.
    EXPECT_EQ(test::bzm({"run", "flight.toml", "--out", "parts", "--quiet", "--steps", "1234"}, folder.string()).status,
              0);
    EXPECT_EQ(test::bzm({"resume", "parts", "--quiet", "--steps", "2766"}, folder.string()).status, 0);
    std::string const table = test::text_of(folder / "run/diagnoses.csv");
    EXPECT_EQ(test::text_of(folder / "parts/diagnoses.csv"), table);
    std::string const line = table.substr(table.rfind('\n', table.size() - 2) + 1);
    return std::stod(line.substr(line.find(',', line.find(',') + 1) + 1));  // behind step and time
  };
  for (auto const* rows : {"10", "1000"}) EXPECT_NEAR(last_row(rows), 160.0 * 160.0, 1e-6) << rows;
}

}  // namespace
}  // namespace boltzmann::diffusion_test
