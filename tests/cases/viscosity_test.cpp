// Kind of fault: a discrete viscosity that does not see velocities which alternate from particle to particle, so that
// walls excite them and nothing damps them. Siblings: weights, ways to know the density, 3D, solids with viscosity,
// variable ranges, disordered starts; the same for temperatures. The operator's own tests are in tests/schemes/transport_test.cpp,
// series solutions in tests/physics/viscous_flow_test.cpp.
#include "tests/cases/case.hpp"

#include <cmath>
#include <numbers>

namespace boltzmann::viscosity_test {
namespace {

using test::Case;

std::string file(std::string const& name) {
  return test::text_of(test::fs::path(BOLTZMANN_SOURCE) / "tests/cases/files" / (name + ".toml"));
}

/// The text with every `from` replaced; fails if there is none.
std::string changed(std::string text, std::string const& from, std::string const& to) {
  EXPECT_NE(text.find(from), std::string::npos) << from;
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

struct Channel {
  double largest, mean;
};
/// At the end, of flow against x.
Channel channel(std::string const& text) {
  Case const one("channel", text);
  auto const run = one.run();
  EXPECT_EQ(run.status, 0) << run.err;
  return {-one.column("fluid velocity x minimum").back(), -one.column("fluid mean velocity x").back()};
}

TEST(Viscosity, PoiseuilleFlowHasItsParabola) {
  std::string const text = file("poiseuille");
  std::vector<std::string> const siblings{text, changed(text, "weight = \"wendland\"", "weight = \"quintic-spline\""),
                                          changed(text, "density = \"continuity\"", "density = \"volumes\""),
                                          changed(text, "spacing = 0.04 }", "spacing = 0.04, jitter = 0.1 }")};
  for (auto const& sibling : siblings) {
    auto const [largest, mean] = channel(sibling);
    EXPECT_NEAR(largest, 0.25, 0.005) << sibling;
    EXPECT_NEAR(mean, 1.0 / 6, 0.0035) << sibling;
  }
}

/// The kinetic energies of rows that slide, and the times.
std::pair<std::vector<double>, std::vector<double>> sliding(std::string const& text) {
  Case const one("sliding", text);
  auto const run = one.run();
  EXPECT_EQ(run.status, 0) << run.err;
  return {one.column("time"), one.column("kinetic energy")};
}

TEST(Viscosity, RowsThatSlideComeToRest) {
  std::string text =
      changed(changed(file("rows-that-slide"), "time = 0.02", "time = 0.001"), "diagnoses = 20", "diagnoses = 1");
  std::string const solid = changed(changed(text, "class = \"Smooth\"", "class = \"Solid\""), "shear_viscosity = 0.5",
                                    "shear_viscosity = 0.5, elastic = { shear_modulus = 0.001 }");
  std::vector<std::string> const siblings{
      text, changed(text, "weight = \"wendland\"", "weight = \"lucy\"\ndensity = \"continuity\""),
      changed(text, "weight = \"wendland\"", "weight = \"cubic-spline\"\nvariable_range = { spacings = 3 }"), solid};
  for (auto const& sibling : siblings) {
    auto const [times, energies] = sliding(sibling);
    ASSERT_NEAR(energies.front(), 0.0008, 1e-8);
    EXPECT_LT(energies.back(), 2e-3 * energies.front()) << sibling;
  }
}

// A wave of 20 spacings: the rate of a continuum, kinetic energy ~ exp(-2 nu k^2 t).
TEST(Viscosity, AShearWaveDecaysAtItsRate) {
  std::string text = changed(file("rows-that-slide"), "cos(pi*(y/0.02 - 0.5))", "cos(2*pi*y/0.4)");
  text = changed(text, "spacing = 0.02", "spacing = 0.0125");
  text = changed(text, "range = 0.06", "range = 0.0375");
  text = changed(text, "time = 0.02", "time = 0.01");
  auto const [times, energies] = sliding(text);
  double const rate = std::log(energies.front() / energies.back()) / (times.back() - times.front());
  EXPECT_NEAR(rate / (2 * 0.5 * std::pow(2 * std::numbers::pi / 0.4, 2)), 1, 0.02);
}

}  // namespace
}  // namespace boltzmann::viscosity_test
