// Kind of fault: a hint that predicts a number which is not measured. What too long a step with friction makes of the
// temperature, with and without the corrector, in a fluid without forces (these add their own error).
#include "tests/cases/case.hpp"

#include <fmt/format.h>

#include <cmath>

namespace boltzmann::dpd_hint_test {
namespace {

using namespace test;

Case fluid(double step, bool corrector) {
  return Case("dpd", fmt::format(R"(
[units]
base = "reduced"
[box]
low = [0, 0, 0]
high = [5, 5, 5]
boundary = "periodic"
[run]
step = {}
steps = 2200
cutoff = 1
[[ensembles]]
name = "fluid"
class = "Newton"
mass = 1
number = 375
load = {{ kind = "random" }}
temperature = 1
[[influences]]
law = "soft"
on = "fluid"
repulsion = 1e-9
range = 1
[[dissipation]]
kind = "dpd"
on = "fluid"
convention = "fixed-temperature"
temperature = 1
friction = 4.5
range = 1
corrector = {}
[[diagnoses]]
kind = "temperature"
[output]
diagnoses = 2
)",
                                 step, corrector));
}

}  // namespace

TEST(HintOfFriction, PredictsTheTemperature) {
  struct Point {
    double step;
    bool corrector;
  };
  for (auto const& [step, corrector] :
       {Point{0.02, false}, Point{0.045, false}, Point{0.067, true}, Point{0.1, true}}) {
    Case const run = fluid(step, corrector);
    auto const outcome = run.run({"--quiet"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    std::size_t const at = outcome.err.find("about ");
    ASSERT_NE(at, std::string::npos) << outcome.err;
    double const predicted =
        (outcome.err.find("too low") == std::string::npos ? 1 : -1) * std::stod(outcome.err.substr(at + 6)) / 100;
    EXPECT_EQ(predicted < 0, corrector) << outcome.err;
    auto const temperature = run.column("temperature");
    double mean = 0, squares = 0;
    std::size_t const first = 100, blocks = 20, length = (temperature.size() - first) / blocks;
    for (std::size_t b = 0; b < blocks; ++b) {
      double block = 0;
      for (std::size_t i = 0; i < length; ++i)
        block += temperature[first + b * length + i] / static_cast<double>(length);
      mean += block / static_cast<double>(blocks);
      squares += block * block / static_cast<double>(blocks);
    }
    double const error = std::sqrt(std::max(0.0, squares - mean * mean) / (static_cast<double>(blocks) - 1));
    EXPECT_NEAR(mean - 1, predicted, 0.25 * std::abs(predicted) + 5 * error) << step << outcome.err;
    EXPECT_LT(error, 0.006);
  }
}

}  // namespace boltzmann::dpd_hint_test
