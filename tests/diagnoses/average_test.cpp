// Averages of columns: a series whose error of the mean is known exactly, and files of a run.
#include "tests/bzm/command.hpp"

#include <boltzmann/diagnoses/average.hpp>
#include <boltzmann/files/csv.hpp>
#include <boltzmann/particles/newton.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <cmath>
#include <random>
#include <vector>

namespace boltzmann::average_test {
namespace {

// x_{n+1} = a x_n + noise: the variance of the mean of N is s^2 / N (1 + a) / (1 - a) (1 - ...), s^2 that of x.
TEST(BlockSums, KnowTheErrorOfASeriesThatRemembers) {
  std::mt19937_64 random(test_seed(5));
  std::normal_distribution<double> normal;
  for (double const a : {0.0, 0.6, 0.9}) {
    constexpr int tries = 300, length = 8192;
    double const exact = std::sqrt((1 + a) / (1 - a) / length);
    double errors = 0, means = 0;
    for (int t = 0; t < tries; ++t) {
      BlockSums sums;
      double x = normal(random);
      for (int n = 0; n < length; ++n) {
        sums.add(3 + x);
        x = a * x + std::sqrt(1 - a * a) * normal(random);
      }
      auto const mean = sums.mean();
      ASSERT_GE(mean.count, 8U);
      errors += mean.error * mean.error / tries;
      means += (mean.mean - 3) * (mean.mean - 3) / tries;
    }
    // Blocks that are long enough miss a few per cent of what lies across their ends.
    EXPECT_NEAR(std::sqrt(errors) / exact, 0.98, 0.05) << a;
    EXPECT_NEAR(std::sqrt(means) / exact, 1, 5 / std::sqrt(2.0 * tries)) << a;
  }
}

TEST(BlockSums, SayWhereTheyAreTooShort) {
  BlockSums sums;
  EXPECT_TRUE(std::isnan(sums.mean().mean));
  for (int n = 0; n < 15; ++n) sums.add(n % 2);
  EXPECT_NEAR(sums.mean().mean, 7.0 / 15, 1e-15);
  EXPECT_TRUE(std::isnan(sums.mean().error));
  BlockSums ramp;  // one long memory
  for (int n = 0; n < 5000; ++n) ramp.add(n);
  EXPECT_NEAR(ramp.mean().mean, 2499.5, 1e-9);
  EXPECT_TRUE(std::isnan(ramp.mean().error));
  auto const blocks = ramp.blocks();
  EXPECT_EQ(blocks[3].length, 8U);
  EXPECT_EQ(blocks[3].number, 625U);
  BlockSums again;
  again.restore(ramp.state());
  again.add(7), ramp.add(7);
  EXPECT_EQ(again.state(), ramp.state());
  EXPECT_THROW(again.restore(std::vector<double>(7)), Error);
}

TEST(Average, IsOfColumnsBefore) {
  std::vector<Column> const before{{"time lag", dimensions::time}, {"pressure", dimensions::pressure}};
  EXPECT_NE(message([&] { Average(before, {.columns = "presure"}); }).find("did you mean 'pressure'?"),
            std::string::npos);
  EXPECT_THROW(Average({}, {}), Error);
  Average average(before, {.columns = "pressure", .since = 2});
  EXPECT_EQ(average.columns().size(), 3U);
  EXPECT_EQ(average.columns()[2].name, "pressure relative error");
  EXPECT_EQ(average.columns()[1].dimension, dimensions::pressure);
  EXPECT_EQ(average.report(UnitSystem::reduced())[0], "pressure: no row has a number since 2");
  Ensemble<Newton<1>> atoms("atoms");
  std::vector<AnyEnsemble*> const all{&atoms};
  Box const box(Vector{0.0}, Vector{1.0});
  std::vector<double> row;
  for (int n = 0; n < 1002; ++n) {
    row = {1.0 * n, -5.0, n == 500 ? std::nan("") : n % 4 + 1.0};
    average.measure({all, box, nullptr, 1, 1.0 * n, n}, row);
  }
  ASSERT_EQ(row.size(), 6U);
  EXPECT_NEAR(row[3], 2.5, 0.003);
  EXPECT_EQ(average.mean(0).mean, row[3]);
  EXPECT_NEAR(row[5], row[4] / row[3], 1e-15);
  EXPECT_NE(average.report(UnitSystem::reduced())[0].find("pressure 2.5"), std::string::npos);
  EXPECT_EQ(average.tables()[0].columns[1].name, "pressure error");
}

char const* const walkers = R"(
[units]
base = "reduced"
[box]
low = [0, 0]
high = [10, 10]
boundary = "periodic"
[run]
step = 0.1
steps = 4000
stop = "temperature relative error < 0.02"
cutoff = 1
[[ensembles]]
name = "gas"
class = "Newton"
integrator = "leap-frog"
mass = 1
number = 40
load = { kind = "random" }
temperature = 1
[[influences]]
law = "soft"
on = "gas"
repulsion = 1
range = 1
[[dissipation]]
kind = "langevin"
on = "gas"
temperature = 1
rate = 1
[[diagnoses]]
kind = "temperature"
[[diagnoses]]
kind = "radial-distribution"
[[diagnoses]]
kind = "structure-factor"
modes = 5
[[diagnoses]]
kind = "structure-factor"
label = "meshed"
modes = 5
by = "mesh"
[[diagnoses]]
kind = "bond-order"
range = 1.5
[[diagnoses]]
kind = "velocity-autocorrelation"
count = 30
[[diagnoses]]
kind = "mean-square-displacement"
every = 3
count = 30
[[diagnoses]]
kind = "green-kubo"
quantity = "viscosity"
count = 20
[[diagnoses]]
kind = "green-kubo"
quantity = "heat-conductivity"
count = 20
[[diagnoses]]
kind = "mean-profile"
quantity = "density, pressure.xx"
[[diagnoses]]
kind = "average"
columns = "temperature"
[output]
diagnoses = 4
checkpoint = 100
[[output.pictures]]
drawing = "curves"
y = "radial-distribution"
file = "g.png"
[[output.pictures]]
drawing = "curves"
y = "average: temperature error"
file = "blocks.png"
logarithmic = true
)";

// A run ends when its error is small enough, says so, and is the same in two parts.
TEST(Average, EndsARunAndIsTold) {
  test::Folder folder;
  test::write_text(folder / "walkers.toml", walkers);
  auto const run = test::bzm({"run", "walkers.toml", "--out", "run"}, folder.string());
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("  mean     temperature "), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("blocks)"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("stop     temperature relative error < 0.02: true at step"), std::string::npos) << run.out;
  std::vector<std::string> const gathered{"radial-distribution.csv",          "structure-factor.csv",
                                          "velocity-autocorrelation.csv",     "velocity-spectrum.csv",
                                          "mean-square-displacement.csv",     "mean-profile.csv",
                                          "green-kubo-heat-conductivity.csv", "average.csv",
                                          "green-kubo-viscosity.csv",         "structure-factor-meshed.csv"};
  for (auto const& file : gathered) EXPECT_TRUE(std::filesystem::exists(folder / ("run/" + file))) << file;
  for (char const* file : {"g.png", "blocks.png"})
    EXPECT_TRUE(std::filesystem::exists(folder / ("run/" + std::string(file)))) << file;
  auto const rows = read_csv((folder / "run/diagnoses.csv").string());
  auto const& relative = rows.column("temperature relative error");
  EXPECT_LT(relative.back(), 0.02);
  EXPECT_FALSE(relative[relative.size() - 2] < 0.02);
  EXPECT_NEAR(rows.column("temperature mean").back(), 1, 0.1);
  EXPECT_EQ(read_csv((folder / "run/radial-distribution.csv").string()).header[2], "coordination number");
  auto const waves = read_csv((folder / "run/structure-factor.csv").string()).column("S"),
             meshed = read_csv((folder / "run/structure-factor-meshed.csv").string()).column("S");
  ASSERT_EQ(waves.size(), meshed.size());
  for (std::size_t k = 0; k < waves.size(); ++k) EXPECT_NEAR(meshed[k], waves[k], 40 * 2.2e-5) << k;

  ASSERT_EQ(test::bzm({"run", "walkers.toml", "--out", "parts", "--quiet", "--steps", "123"}, folder.string()).status,
            0);
  ASSERT_EQ(test::bzm({"resume", "parts", "--quiet", "--threads", "2", "--steps", "4000"}, folder.string()).status, 0);
  EXPECT_EQ(test::text_of(folder / "parts/diagnoses.csv"), test::text_of(folder / "run/diagnoses.csv"));
  for (auto const& file : gathered)
    EXPECT_EQ(test::text_of(folder / ("parts/" + file)), test::text_of(folder / ("run/" + file))) << file;

  // What was gathered can be drawn again from its file.
  auto const again = test::bzm({"render", "run", "--drawing", "curves", "-o", "again.png"}, folder.string());
  EXPECT_EQ(again.status, 2);  // without a trajectory there is no frame
  auto const wrong = test::bzm(
      {"run", "walkers.toml", "--out", "wrong", "--set", "output.pictures.0.y=radial-distributon"}, folder.string());
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("did you mean 'radial-distribution'"), std::string::npos) << wrong.err;
}

}  // namespace
}  // namespace boltzmann::average_test
