// Kind of fault: found only after a run had begun, or never. What bzm check (and the start of a run) finds: particles that
// will leave a mesh, atoms that overlap where forces cancel, correlators and spectra that need more looks than a run has,
// gas that falls together with a fixed step. And one number where a failure names a step.
#include "tests/cases/case.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann::check_before_run_test {
namespace {

using namespace test;

bool has(std::string const& text, std::string const& part) { return text.find(part) != std::string::npos; }

std::string plasma(std::string const& box, std::string const& field, std::string const& more = "") {
  return fmt::format(R"(
[units]
base = "reduced"
[box]
low = [0]
high = [1]
boundary = "{}"
[run]
step = 0.001
steps = 5
[mesh]
law = "coulomb"
k = 1
cells = 20
{}
[[ensembles]]
name = "ions"
class = "Coulomb"
number = 100
mass = 1
charge = 0.001
load = {{ kind = "fill" }}
{}
)",
                     box, field.empty() ? "" : "boundary = [\"" + field + "\"]", more);
}

std::string argon(std::string const& lattice, std::string const& law, std::string const& spacing) {
  return fmt::format(R"(
[box]
low = ["0 nm", "0 nm", "0 nm"]
high = ["4 nm", "4 nm", "4 nm"]
boundary = "periodic"
[run]
step = "5 fs"
steps = 10
cutoff = "0.95 nm"
[[ensembles]]
name = "argon"
class = "Newton"
mass = "39.948 u"
load = {{ kind = "fill", lattice = "{}", spacing = "{}" }}
[[influences]]
law = "{}"
on = "argon"
depth = "0.0104 eV"
r0 = "0.3822 nm"
{}
)",
                     lattice, spacing, law, law == "morse" ? "a = \"30 1/nm\"" : "");
}

std::string gas(std::string const& diagnosis, int steps, int rows) {
  return fmt::format(R"(
[units]
base = "reduced"
[box]
low = [0, 0]
high = [10, 10]
boundary = "periodic"
[run]
step = 0.01
steps = {}
cutoff = 2.5
[[ensembles]]
name = "atoms"
class = "Newton"
mass = 1
temperature = 1
load = {{ kind = "fill", spacing = 1.2 }}
[[influences]]
law = "lennard-jones"
on = "atoms"
depth = 1
r0 = 1.12
[[diagnoses]]
{}
[output]
diagnoses = {}
)",
                     steps, diagnosis, rows);
}

}  // namespace

TEST(CheckBeforeRun, AnOpenBoxWithAMesh) {
  for (std::string const field : {"dirichlet", "neumann"}) {
    Case const open("open", plasma("open", field, field == "neumann" ? "" : ""));
    if (field == "neumann") continue;
    EXPECT_TRUE(has(open.check().err, "ends the run")) << open.check().err;
    EXPECT_TRUE(has(open.check().err, "boundary = \"reflecting\""));
    EXPECT_FALSE(has(Case("closed", plasma("reflecting", field)).check().err, "ends the run"));
  }
  // An open field: only where some leave at once.
  EXPECT_FALSE(has(Case("slow", plasma("open", "", "")).check().err, "ends the run"));
  for (std::string const field : {"", "dirichlet"}) {
    Case const fast("fast", plasma("open", field, "temperature = 1\ndrift = [50]"));
    EXPECT_TRUE(has(fast.check().err, "will leave the mesh in step 1")) << fast.check().err;
  }
}

// Neighbours on a lattice push from all sides: no force shows the overlap.
TEST(CheckBeforeRun, AtomsOfALatticeThatOverlap) {
  for (std::string const lattice : {"square", "fcc", "bcc"})
    for (std::string const law : {"lennard-jones", "morse"}) {
      Case const near("near", argon(lattice, law, "0.2 nm"));
      auto const outcome = near.check();
      EXPECT_EQ(outcome.status, 2) << lattice << law << outcome.err;
      EXPECT_TRUE(has(outcome.err, "overlap")) << lattice << law << outcome.err;
      if (lattice == "square") {
        EXPECT_TRUE(has(outcome.err, "only 2e-10 m apart")) << outcome.err;
      }
      Case const far("far", argon(lattice, law, "0.38 nm"));
      EXPECT_EQ(far.check().status, 0) << lattice << law << far.check().err;
    }
}

TEST(CheckBeforeRun, CorrelatorsThatNeedALongerRun) {
  struct Kind {
    std::string keys, found;
  };
  for (auto const& [keys, found] : {Kind{"kind = \"mean-square-displacement\"\nevery = 10", "no diffusion coefficient"},
                                    Kind{"kind = \"velocity-autocorrelation\"\nevery = 10", "no diffusion coefficient"},
                                    Kind{"kind = \"green-kubo\"\nquantity = \"viscosity\"", "no viscosity"}}) {
    Case const brief("brief", gas(keys, 1000, 10));
    for (auto const& outcome : {brief.check(), brief.run({"--quiet"})}) {
      EXPECT_EQ(outcome.status, 0);
      EXPECT_TRUE(has(outcome.err, found)) << keys << outcome.err;
      EXPECT_TRUE(has(outcome.err, "the longest lag is 20, the run has 10")) << keys << outcome.err;
      EXPECT_TRUE(has(outcome.err, "count = 50")) << keys << outcome.err;
    }
    // With what it advises there is a number, and no warning.
    Case const cured("cured", gas(keys + "\ncount = 50", 1000, 10));
    EXPECT_EQ(cured.check().err, "") << keys;
    EXPECT_EQ(Case("long", gas(keys, 2000, 10)).check().err, "") << keys;
    EXPECT_TRUE(has(Case("late", gas(keys + "\nsince = 15\ncount = 50", 2000, 10)).check().err, "")) << keys;
    EXPECT_TRUE(has(Case("later", gas(keys + "\nsince = 18\ncount = 50", 2000, 10)).check().err, found)) << keys;
  }
}

TEST(CheckBeforeRun, NothingIsMeasuredAfterTheEnd) {
  for (std::string const kind : {"radial-distribution", "structure-factor", "velocity-diffusion"}) {
    Case const late("late", gas("kind = \"" + kind + "\"\nsince = 100", 100, 10));
    auto const outcome = late.check();
    if (outcome.status != 0) continue;  // a kind without this key
    EXPECT_TRUE(has(outcome.err, "nothing is measured")) << kind << outcome.err;
  }
}

// Gas that its gravity pulls together needs ever shorter steps: what is said before the run and when it fails names those
// that are divided.
TEST(CheckBeforeRun, GasThatFallsTogether) {
  std::string const evrard = R"(
[units]
base = "reduced"
[box]
low = [-2, -2, -2]
high = [2, 2, 2]
boundary = "open"
[run]
step = { courant = COURANT }
steps = 200
SUBSTEPS
[smooth]
weight = "wendland"
artificial_viscosity = { alpha = 1, beta = 2 }
[mesh]
law = "gravity"
G = STRENGTH
on = "gas"
cells = 16
[[ensembles]]
name = "gas"
class = "Smooth"
load = { kind = "fill", spacing = 0.2, where = "r < 1" }
density = 0.2387
range = 0.5
specific_energy = 0.05
material = { kind = "ideal-gas", gamma = 1.6666666666666667 }
)";
  auto const with = [&](std::string const& strength, std::string const& courant, std::string const& substeps) {
    std::string text = evrard;
    text.replace(text.find("COURANT"), 7, courant);
    text.replace(text.find("STRENGTH"), 8, strength);
    return text.replace(text.find("SUBSTEPS"), 8, substeps);
  };
  std::string const cure = "substeps = { courant = 0.4 }", foreseen = "falls together";
  // So strong that it is refused at once.
  auto const refused = Case("strong", with("30", "0.9", "")).run({"--quiet"});
  EXPECT_EQ(refused.status, 2) << refused.err;
  EXPECT_TRUE(has(refused.err, cure)) << refused.err;
  auto const divided = Case("divided", with("30", "0.9", cure)).run({"--quiet", "--steps", "20"});
  EXPECT_EQ(divided.status, 0) << divided.err;
  for (std::string const strength : {"1", "3"}) {
    Case const fixed("fixed", with(strength, "0.9", ""));
    auto const failed = fixed.run({"--quiet"});
    EXPECT_EQ(failed.status, 3) << failed.err;
    EXPECT_TRUE(has(failed.err.substr(failed.err.find("step ")), cure)) << failed.err;
  }
  // A step that suits the sound of the start: the free fall tells.
  auto const slow = Case("slow", with("1", "0.3", "")).check();
  EXPECT_EQ(slow.status, 0) << slow.err;
  EXPECT_TRUE(has(slow.err, foreseen) && has(slow.err, cure)) << slow.err;
  EXPECT_FALSE(has(Case("with", with("1", "0.3", cure)).check().err, foreseen));
  EXPECT_FALSE(has(Case("brief", with("1", "0.01", "")).check().err, foreseen));  // over before it falls
  EXPECT_FALSE(has(Case("held", with("0.1", "0.3", "")).check().err, foreseen));  // by its pressure
}

// One number, the one to type: a failure names no second step.
TEST(CheckBeforeRun, AFailureNamesOneStep) {
  std::string text = gas("kind = \"energies\"", 2000, 100);
  text.replace(text.find("temperature = 1"), 15, "temperature = 400");
  text.replace(text.find("step = 0.01"), 11, "step = 0.03");
  Case const hot("hot", text);
  auto const outcome = hot.run({"--quiet"});
  if (outcome.status == 0) GTEST_FAIL() << "the run should fail";
  std::size_t steps = 0;
  for (std::string const words : {"a step above", "a step below", "step of at most"})
    for (std::size_t at = outcome.err.find(words, outcome.err.rfind("particle")); at != std::string::npos;
         at = outcome.err.find(words, at + 1))
      ++steps;
  EXPECT_LE(steps, 1U) << outcome.err;
}

}  // namespace boltzmann::check_before_run_test
