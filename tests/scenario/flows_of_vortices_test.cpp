// What scenarios say of flows of vortices: relaxation, rings with a core, energies, pictures; and what is wrong with it.
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/schemes/vortices/vortex_flow.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace boltzmann::flows_of_vortices_test {
namespace {

std::string const space =
    "[units]\nbase = \"reduced\"\n[box]\nlow = [-2, -2, -2]\nhigh = [2, 2, 2]\n[run]\nstep = 0.1\nsteps = 2\n";
std::string const ring =
    "[[ensembles]]\nname = \"ring\"\nclass = \"Inviscid\"\nload = { kind = \"ring-tube\", radius = 1, core_radius = "
    "0.3, layers = 1 }\n";
std::string const law = "[[influences]]\nlaw = \"biot-savart-gaussian\"\non = \"ring\"\n";
std::string const multipole = "[multipole]\nlaw = \"biot-savart-gaussian\"\ntolerance = 1e-4\n";

std::string said(std::string const& text) {
  try {
    parse_scenario(text, "test.toml");
  } catch (Error const& error) {
    return error.what();
  }
  return "";
}

TEST(FlowsOfVortices, AreReadWithAllThatBelongsToThem) {
  for (auto const& scheme : {law, multipole}) {
    bool const pairs = scheme == law;
    auto const run =
        parse_scenario(space + (pairs ? "" : scheme) + "[relaxation]\nevery = 1\nfraction = 0.2\ncorrected = false\n" +
                           ring + (pairs ? scheme : "") +
                           "[[diagnoses]]\nkind = \"vortex-energy\"\n[output]\n"
                           "[[output.pictures]]\ndrawing = \"flow\"\ny = \"Q\"\nslice = \"y\"\nat = 0.1\nhigh = "
                           "2\ncells = 50\nfile = \"q.png\"\n",
                       "test.toml");
    ASSERT_EQ(run->simulation->adaptations().size(), 1U);
    EXPECT_FALSE(run->simulation->numbers_change());
    ASSERT_EQ(run->diagnoses.size(), 1U);
    EXPECT_EQ(run->diagnoses[0]->columns().size(), 4U);
    EXPECT_EQ(run->diagnoses[0]->columns()[0].name, "vortex energy");
    EXPECT_EQ(run->output.pictures.at(0).high, 2);
    EXPECT_EQ(run->ensembles[0]->size() % 9, 0U);
    run->simulation->run(2);
    EXPECT_NE(run->simulation->adaptations()[0]->report(UnitSystem::reduced()).find("relaxed 2 times"),
              std::string::npos);
    auto const energy = VortexFlow(vortex_sources(run->simulation->schemes()), run->box()).measure().energy;
    EXPECT_NEAR(energy / (0.5 * (std::log(8 / 0.3) - 2.058)), 1, 0.05);
  }
}

TEST(FlowsOfVortices, SayWhatIsWrong) {
  auto const expect = [](std::string const& text, std::string const& what) {
    EXPECT_NE(said(text).find(what), std::string::npos) << said(text) << "\n should say: " << what;
  };
  EXPECT_EQ(said(space + ring + law), "");
  expect(space + "[relaxation]\nfraction = 0.5\n" + ring + law, "every");
  expect(space + "[relaxation]\nevery = 5\nfraction = 1.5\n" + ring + law, "fraction");
  expect(space + "[relaxation]\nevery = 5\n" + ring, "there are no vortices that act");
  expect(space + ring + law + "[[diagnoses]]\nkind = \"vortex-energy\"\nensembles = [\"ring\"]\n",
         "unknown key 'ensembles'");
  expect(space + ring + "[[diagnoses]]\nkind = \"vortex-energy\"\n", "no vortices that make a flow");
  std::string flat = space;
  flat.replace(flat.find("low = [-2, -2, -2]\nhigh = [2, 2, 2]"), 35, "low = [-2, -2]\nhigh = [2, 2]");
  std::string const pair =
      "[[ensembles]]\nname = \"ring\"\nclass = \"Vortex\"\nload = { kind = \"positions\", positions = [[0, 1], [0, "
      "-1]] }\n"
      "vorticity = [1, -1]\ncore = 0.1\n";
  EXPECT_EQ(said(flat + pair + law + "[[diagnoses]]\nkind = \"vortex-energy\"\n"), "");
  expect(flat + "[relaxation]\nevery = 5\n" + pair + law, "in a plane vorticity has no divergence");
  expect(flat + ring + law, "three dimensions");
  expect(flat + pair + law + "[output]\n[[output.pictures]]\ndrawing = \"flow\"\ny = \"Q\"\n", "a flow has no 'Q'");
  std::string wide = ring, dust = ring;
  wide.replace(wide.find("core_radius = 0.3"), 17, "core_radius = 3.0");
  expect(space + wide + law, "wider than a ring");
  dust.replace(dust.find("Inviscid"), 8, "Tracer");
  expect(space + dust, "has no vorticity");
  // Along a periodic axis there is no energy.
  std::string periodic = flat;
  periodic.replace(periodic.find("high = [2, 2]"), 13, "high = [2, 2]\nboundary = [\"periodic\", \"open\"]");
  expect(periodic + "[multipole]\nlaw = \"biot-savart\"\ntolerance = 1e-3\n" + pair +
             "[[diagnoses]]\nkind = \"vortex-energy\"\n",
         "axis x is periodic");
  // Nor, so far, beside a wall.
  std::string wall = flat;
  wall.replace(
      wall.find("high = [2, 2]"), 13,
      "high = [2, 2]\nboundary = [\"mirror\", \"open\"]\n[[box.walls]]\naxis = \"x\"\nend = \"high\"\nopen = true");
  expect(wall + pair + law + "[[diagnoses]]\nkind = \"vortex-energy\"\n", "axis x is a mirror");
}

}  // namespace
}  // namespace boltzmann::flows_of_vortices_test
