// Kind of fault: a relative drift of a conserved quantity that is itself rounding. Momentum, angular momentum and energy of
// what stays at rest, and an energy that starts at zero; real drifts are still told.
#include "tests/cases/case.hpp"

#include <fmt/format.h>

namespace boltzmann::drift_test {
namespace {

using namespace test;

std::string const units = "[units]\nbase = \"reduced\"\n";

}  // namespace

TEST(DriftOfRounding, ASquareAtRest) {
  Case const run("square-at-rest");
  auto const outcome = run.run();
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err.find("warning"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("nothing moves"), std::string::npos) << outcome.out;
}

// A lattice of springs at its rest length: energy, momentum and angular momentum are all zero but for rounding.
TEST(DriftOfRounding, SpringsAtRest) {
  Case const run("springs", units + R"(
[box]
low = [-5, -5]
high = [5, 5]
boundary = "open"
[run]
step = 0.01
steps = 2000
cutoff = 0.37
[[ensembles]]
name = "atoms"
class = "Newton"
load = { kind = "fill", lattice = "triangular", spacing = 0.3, where = "r < 2" }
mass = 1
[[influences]]
law = "lennard-jones"
on = "atoms"
depth = 1
r0 = 0.3
[[diagnoses]]
kind = "energies"
)");
  auto const outcome = run.run();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err.find("warning: momentum"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("warning: energy"), std::string::npos) << outcome.err;
}

// A body that falls from where its energy is zero: its drift is measured by kinetic and external energy.
TEST(DriftOfRounding, AnEnergyThatStartsAtZero) {
  Case const run("fall", units + R"(
[box]
low = [-100]
high = [100]
boundary = "open"
[run]
step = 0.01
steps = 500
[[ensembles]]
name = "stone"
class = "Newton"
number = 1
mass = 1
load = { kind = "positions", positions = [[0]] }
[[influences]]
law = "uniform-gravity"
on = "stone"
acceleration = [-1]
[[diagnoses]]
kind = "energies"
)");
  auto const outcome = run.run();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("of kinetic + |potential|"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("of itself"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.err.find("warning"), std::string::npos) << outcome.err;
}

}  // namespace boltzmann::drift_test
