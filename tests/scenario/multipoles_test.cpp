// [multipole] in scenarios: vortices and what they carry, grids, checkpoints, and what users get wrong.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <tests/message.hpp>
#include <tests/scenario/mistakes.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace boltzmann::scenario_multipoles_test {
namespace {

using test::ensemble;
using test::expect_one_line;
using test::Mistake;
using test::mistake_name;
using test::replaced;

std::unique_ptr<ScenarioSimulation> read(std::string const& text) { return parse_scenario(text, "flow.toml"); }

/// A lump of particles of a class, of which `schemes` are told. Its first line is the tenth.
std::string lump(int dimension, std::string const& boundary, std::string const& schemes, std::string const& kind,
                 std::string const& values) {
  std::string low = "-2", high = "2";
  for (int a = 1; a < dimension; ++a) low += ", -2", high += ", 2";
  return "[units]\nbase = \"reduced\"\n[box]\nlow = [" + low + "]\nhigh = [" + high + "]\nboundary = \"" + boundary +
         "\"\n[run]\nstep = 0.001\nsteps = 20\n" + schemes + "[[ensembles]]\nname = \"gas\"\nclass = \"" + kind +
         "\"\nload = { kind = \"fill\", spacing = 0.25, where = \"r < 1\" }\n" + values;
}
std::string stars(std::string const& boundary, std::string const& more, std::string const& law = "\"gravity\"\nG = 1") {
  return lump(2, boundary, "[multipole]\nlaw = " + law + "\n" + more, "Kepler", "mass = 0.02\n");
}
std::string vortices(int dimension, std::string const& more, std::string const& boundary = "open",
                     std::string const& kind = "Inviscid") {
  return lump(dimension, boundary, "[multipole]\nlaw = \"biot-savart\"\n" + more, kind,
              std::string("core = 0.1\nformulas = { ") +
                  (dimension == 2 ? "vorticity = \"1 + x\"" : "vorticity = [\"y\", \"-x\", \"0.1\"]") + " }\n");
}
std::string const others =
    "[[ensembles]]\nname = \"heavy\"\nclass = \"Vortex\"\ncore = 0.2\nload = { kind = \"fill\", spacing = 0.4, where = "
    "\"(r < 1.8)*(r > 1)\" }\nformulas = { vorticity = \"-0.3\" }\n"
    "[[ensembles]]\nname = \"dust\"\nclass = \"Tracer\"\nload = { kind = \"fill\", spacing = 0.3, where = \"r < 1.9\" "
    "}\n";

// What a vortex does to all others, and to dust that does nothing, by the law of pairs.
TEST(MultipolesOfScenarios, CarryVorticesOfSeveralEnsemblesAndDust) {
  auto const run = read(vortices(2, "tolerance = 1e-6\ntest_particles = \"dust\"\ngrid = [8, 12]\n") + others);
  AnyEnsemble const &gas = ensemble(*run, "gas"), &heavy = ensemble(*run, "heavy"), &dust = ensemble(*run, "dust");
  ASSERT_GT(gas.size(), 40U);
  ASSERT_GT(heavy.size(), 20U);
  ASSERT_GT(dust.size(), 60U);
  auto const velocity = [&](Vector<2> const& place, void const* self) {
    Vector<2> sum{};
    Inviscid<2> here{};
    here.position = place;
    for (AnyEnsemble const* from : {&gas, &heavy})
      for (std::size_t j = 0; j < from->size(); ++j) {
        if (from->row(j) == self) continue;
        Vortex<2> p{};
        p.position = {from->row(j)[0], from->row(j)[1]};
        p.vorticity[0] = from == &gas ? 1 + p.position[0] : -0.3;
        p.core = from == &gas ? 0.1 : 0.2;
        sum += BiotSavart{}(static_cast<Vortex<2> const&>(here), p);
      }
    return sum;
  };
  for (AnyEnsemble const* of : {&gas, &heavy, &dust})
    for (std::size_t i = 0; i < of->size(); ++i) {
      auto const exact = velocity({of->row(i)[0], of->row(i)[1]}, of->row(i));
      for (int a = 0; a < 2; ++a) EXPECT_NEAR(of->influence(i)[a], exact[a], 1e-5) << of->name() << i;
    }
  auto const fields = run->scheme<MultipoleScheme>()->mesh_fields();
  ASSERT_EQ(fields.size(), 1U);
  EXPECT_EQ(fields[0]->name, "velocity");
  MeshGrid const& grid = fields[0]->grid;
  ASSERT_EQ(grid.size(), 9U * 13);
  for (std::size_t n = 0; n < grid.size(); ++n) {
    auto const exact = velocity({grid.position(0, n % 9), grid.position(1, n / 9)}, nullptr);
    for (std::size_t a = 0; a < 2; ++a) EXPECT_NEAR(fields[0]->components[a][n], exact[static_cast<int>(a)], 1e-5) << n;
  }
}

// Classes that add to Inviscid are carried and stretched as it is, and the step goes on from a checkpoint to the bit.
TEST(MultipolesOfScenarios, GoOnFromACheckpointWithViscousVortices) {
  std::string const text =
      replaced(vortices(3, "tolerance = 1e-3\n", "open", "Viscous"), "spacing = 0.25", "spacing = 0.12") +
      "viscosity = 0\n";
  auto const whole = read(text), first = read(text), second = read(text);
  ASSERT_GT(ensemble(*whole, "gas").size(), 1600U) << "fewer are summed directly";
  whole->simulation->threads(2);
  whole->simulation->run(9);
  first->simulation->run(4);
  AnyEnsemble &from = ensemble(*first, "gas"), &to = ensemble(*second, "gas"), &all = ensemble(*whole, "gas");
  for (std::size_t i = 0; i < from.size(); ++i) std::copy_n(from.row(i), from.stride(), to.row(i));
  second->simulation->restore(4, 0.001, 1, first->simulation->state());
  second->simulation->run(5);
  double turned = 0;
  for (std::size_t i = 0; i < to.size(); ++i)
    for (std::size_t k = 0; k < to.stride(); ++k) ASSERT_EQ(to.row(i)[k], all.row(i)[k]) << i << ", " << k;
  auto const start = read(text);
  for (std::size_t i = 0; i < all.size(); ++i)
    turned = std::max(turned, std::abs(all.row(i)[3] - ensemble(*start, "gas").row(i)[3]));
  EXPECT_GT(turned, 0) << "vorticity is stretched";
}

Mistake const rows[] = {
    {"a tolerance of nothing", stars("open", "tolerance = 0\n"), "13:13", {"tolerance: 0", "between 1e-10 and 0.1"}},
    {"stars alone in a periodic box",
     stars("periodic", ""),
     "10:1",
     {"the strengths sum to 1.04", "background = true"}},
    {"multipoles between mirrors", stars("mirror", ""), "10:1", {"axis x is mirror", "use [mesh]"}},
    {"a grid of multipoles for one axis", stars("open", "grid = [4]\n"), "13:8", {"grid: 1 number for 2 axes"}},
    {"test particles that are not there",
     stars("open", "test_particles = \"gass\"\n"),
     "13:18",
     {"test_particles: there is no ensemble 'gass'", "did you mean 'gas'"}},
    {"multipoles without a source",
     stars("open", "", "\"coulomb\"\nk = 1"),
     "10:1",
     {"[multipole]: no ensemble makes a field", "Coulomb"}},
    {"a softening below zero", stars("open", "softening = -1\n"), "13:13", {"softening", "zero or more"}},
    {"a background of open space",
     stars("open", "background = true\n"),
     "13:14",
     {"a uniform background is for a box that is periodic along all axes", "axis x is open"}},
    {"a background of vorticity",
     vortices(3, "background = true\n", "periodic"),
     "12:14",
     {"vorticity has no uniform background in 3D"}},
    {"vortices that don't cancel",
     vortices(3, "", "periodic"),
     "10:1",
     {"the strengths sum to ", "close the vortex lines"}},
    {"another law", stars("open", "", "\"biot-savert\"\nG = 1"), "11:7", {"did you mean 'biot-savart'"}},
    {"a constant of vortices", vortices(2, "k = 1\n"), "12:5", {"the law 'biot-savart' has none"}},
    {"a softening of vortices",
     vortices(2, "softening = 0.1\n"),
     "12:13",
     {"the law 'biot-savart' has none (each vortex has a core)"}},
    {"half of a form", vortices(3, "transposed = 2\n"), "12:14", {"transposed", "between 0 and 1"}},
    {"a form of stretching of stars", stars("open", "transposed = 0\n"), "13:1", {"unknown key 'transposed'"}},
    {"a ring in a plane with a normal",
     replaced(vortices(2, ""), "{ kind = \"fill\", spacing = 0.25, where = \"r < 1\" }",
              "{ kind = \"ring\", radius = 1, normal = [0, 1] }\nnumber = 4"),
     "15:46",
     {"normal: a ring in a plane has none"}},
    {"a ripple without a mode",
     replaced(vortices(2, ""), "{ kind = \"fill\", spacing = 0.25, where = \"r < 1\" }",
              "{ kind = \"ring\", radius = 1, ripple = 0.1 }\nnumber = 4"),
     "15:46",
     {"a ripple has a mode"}},
    {"a flow on stars",
     stars("open", "on = \"gas\"\n", "\"biot-savart\""),
     "12:6",
     {"on: 'gas' is of class Kepler, which has no vorticity", "Vortex, Inviscid, Viscous"}},
    {"a flow without a vortex", stars("open", "", "\"biot-savart\""), "10:1", {"no ensemble makes a flow"}},
    {"vortices as test particles",
     vortices(2, "test_particles = \"gas\"\n"),
     "12:18",
     {"'gas' is of class Inviscid, which feels no flow without making one; class Tracer does"}},
    {"a field on dust",
     stars("open", "test_particles = \"dust\"\n") + others.substr(others.rfind("[[ensembles]]")),
     "13:18",
     {"test_particles: 'dust' is of class Tracer, which makes no field"}},
    {"the energy of a field that has no density",
     stars("open", "grid = 8\n") + "[[diagnoses]]\nkind = \"field-energy\"\n",
     "20:8",
     {"the mesh has no density, only potential, field.x, field.y"}},
};
class MultipoleMistakes : public testing::TestWithParam<Mistake> {};
TEST_P(MultipoleMistakes, AreToldInOneLine) { expect_one_line(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Scenario, MultipoleMistakes, testing::ValuesIn(rows), mistake_name);

}  // namespace
}  // namespace boltzmann::scenario_multipoles_test
