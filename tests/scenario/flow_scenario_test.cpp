// Flows in scenarios: streams, walls, a cylinder, dye, single precision; the same as a program's, and what is refused.
#include <boltzmann/scenario/classes.hpp>
#include <boltzmann/schemes/cylinder/cylinder_flow.hpp>
#include <boltzmann/schemes/flow_classes.hpp>
#include <boltzmann/schemes/pair/single_precision.hpp>
#include <boltzmann/simulation/dye.hpp>
#include <boltzmann/simulation/simulation.hpp>
#include <tests/message.hpp>
#include <tests/same_rows.hpp>
#include <tests/scenario/mistakes.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>

namespace boltzmann::flow_scenario_test {
namespace {

std::string const start =
    "[units]\nbase = \"reduced\"\n[box]\nlow = [-5, -5]\nhigh = [5, 5]\n[run]\nstep = 0.05\nsteps = 40\n";
std::string const vortices =
    "[[ensembles]]\nname = \"vortices\"\nclass = \"Vortex\"\n"
    "load = { kind = \"positions\", positions = [[2, 0.5], [2, -0.5], [-2, 1]] }\nvorticity = [-1, 1.5, 2]\ncore = "
    "0.1\n"
    "[[influences]]\nlaw = \"biot-savart\"\non = \"vortices\"\n";
std::string const tracers =
    "[[ensembles]]\nname = \"dye\"\nclass = \"Tracer\"\nload = { kind = \"positions\", positions = [[-3, 0.1]] }\n";
std::string const carried = "[[influences]]\nlaw = \"biot-savart\"\non = \"dye\"\nby = \"vortices\"\n";
std::string const cylinder = "[cylinder_flow]\nradius = 1\nstream = [0.5, 0]\ncirculation = 0.3\n";
std::string const dye = "[[dye]]\non = \"dye\"\nfrom = [-3, 0]\nto = [-3, 1]\nplaces = 3\nevery = 4\nlimit = 20\n";

std::unique_ptr<ScenarioSimulation> read(std::string const& text) { return parse_scenario(text, "flow.toml"); }
std::string line(std::string const& text) {
  return message([&] { read(text); });
}
using test::ensemble;
using test::replaced;

TEST(FlowScenario, ACylinderAndDyeAreThoseOfAProgram) {
  auto const scenario = read(start + cylinder + vortices + tracers + carried + dye);
  Ensemble<Vortex<2>> three("vortices", 3);
  for (std::size_t i = 0; i < 3; ++i) {
    three[i].position = i == 2 ? Vector{-2., 1.} : Vector{2., i == 0 ? 0.5 : -0.5};
    three[i].vorticity = {i == 0 ? -1. : i == 1 ? 1.5 : 2.}, three[i].core = 0.1;
  }
  Ensemble<Tracer<2>> released("dye", 1);
  released[0].position = {-3, 0.1};
  Box const box({-5, -5}, {5, 5});
  CylinderFlow images(box, {.stream = {0.5, 0}, .radius = 1, .circulation = 0.3});
  images.add(three), images.add(released);
  PairScheme pairs(box);
  pairs.internal(three, BiotSavart{});
  pairs.between(released, three, one_way(BiotSavart{}));
  Simulation simulation(images, 0.05);
  simulation.add(pairs);
  simulation.adapt(
      4, DyeSource(released, {.from = {-3, 0}, .to = std::array<double, 3>{-3, 1}, .places = 3, .limit = 20}));
  simulation.run(40);
  scenario->simulation->run(40);
  EXPECT_EQ(released.size(), 19U) << "six releases; a seventh would be beyond the limit";
  auto const same_place = [](AnyEnsemble const& a, AnyEnsemble const& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
      for (int k = 0; k < 2; ++k) EXPECT_NEAR(a.row(i)[k], b.row(i)[k], 1e-13);  // kernels of two instruction sets
  };
  same_place(three, ensemble(*scenario, "vortices"));
  same_place(released, ensemble(*scenario, "dye"));
  EXPECT_EQ(scenario->simulation->adaptations().front()->report(UnitSystem::reduced()),
            "'dye': 18 released, 19 now, which is the limit");
}

// A streakline in a shear is straight; and what is resumed goes on to the bit.
TEST(FlowScenario, StreaklinesAreExactAndGoOn) {
  std::string const text =
      start + tracers +
      "[[influences]]\nlaw = \"shear-flow\"\non = \"dye\"\ndirection = [1, 0]\ngradient = [0, 0.5]\n"
      "origin = [0, -1]\n" +
      dye;
  auto const whole = read(text), first = read(text), second = read(first->resolved);
  whole->simulation->run(22);
  first->simulation->run(10);
  auto &from = ensemble(*first, "dye"), &to = ensemble(*second, "dye");
  EXPECT_EQ(from.size(), 7U);
  to.resize(from.size());
  std::memcpy(to.row(0), from.row(0), from.size() * from.stride() * sizeof(double));
  second->simulation->restore(10, 0.05, 1, first->simulation->state());
  second->simulation->run(12);
  auto const& all = ensemble(*whole, "dye");
  expect_same_rows(all, to);
  ASSERT_EQ(all.size(), 16U);
  for (std::size_t i = 1; i < all.size(); ++i) {
    double const y = 0.5 * static_cast<double>((i - 1) % 3),
                 age = 0.05 * (22 - 4 * static_cast<double>((i - 1) / 3 + 1));
    EXPECT_NEAR(all.row(i)[1], y, 1e-14) << i;
    EXPECT_NEAR(all.row(i)[0], -3 + 0.5 * (y + 1) * age, 1e-13) << i;
  }
  EXPECT_EQ(second->simulation->adaptations().front()->report(UnitSystem::reduced()), "'dye': 15 released, 16 now");
}

// Two sources of one ensemble, whose places are numbered through; what leaves takes its numbers with it, and a resume
// goes on with them.
TEST(FlowScenario, DyeRemembersPlaceAndRelease) {
  std::string const text = start + replaced(tracers, "Tracer", "Dye") + replaced(dye, "limit = 20\n", "") +
                           "[[dye]]\non = \"dye\"\nfrom = [-4, 2]\nevery = 5\n"
                           "[[influences]]\nlaw = \"uniform-flow\"\non = \"dye\"\nvelocity = [1, 0]\n"
                           "[[outflow]]\non = \"dye\"\nfrom = [-2.5, 0]\ndirection = [1, 0]\n"
                           "[[output.pictures]]\ndrawing = \"cartesian\"\nstreaklines = true\ngap = 0.3\n";
  auto const whole = read(text), first = read(text), second = read(first->resolved);
  whole->simulation->run(22);
  first->simulation->run(10);
  auto &from = ensemble(*first, "dye"), &to = ensemble(*second, "dye");
  to.resize(from.size());
  std::memcpy(to.row(0), from.row(0), from.size() * from.stride() * sizeof(double));
  second->simulation->restore(10, 0.05, 1, first->simulation->state());
  second->simulation->run(12);
  auto const& all = ensemble(*whole, "dye");
  expect_same_rows(all, to);
  int const place = all.field("place").offset, release = all.field("release").offset;
  std::size_t of_line = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    double const* const row = all.row(i);
    double const number = row[place], age = 0.05 * (22 - (number == 4 ? 5 : 4) * row[release]);
    EXPECT_NEAR(row[0], (number == 4 ? -4 : -3) + age, 1e-13) << i;
    EXPECT_NEAR(row[1], number == 4 ? 2 : (number - 1) / 2, 1e-13) << i;
    of_line += number < 4;
  }
  EXPECT_EQ(of_line, 9U) << "releases 3, 4 and 5 of three places: the others are beyond the plane";
  EXPECT_EQ(all.size(), 13U);
}

TEST(FlowScenario, WallsAreMirrorsWithOneOpenEnd) {
  auto const walled = replaced(start, "high = [5, 5]\n", "high = [5, 5]\nboundary = [\"open\", \"mirror\"]\n");
  auto const opened = walled + "[[box.walls]]\naxis = \"y\"\nend = \"high\"\nopen = true\n";
  EXPECT_NE(line(walled + vortices).find("axis y has walls at both ends"), std::string::npos)
      << line(walled + vortices);
  auto const run =
      read(replaced(opened, "steps = 40", "steps = 10") +
           "[[ensembles]]\nname = \"one\"\nclass = \"Vortex\"\nload = { kind = \"positions\", positions = "
           "[[0, -4]] }\nvorticity = 2\ncore = 0.1\n[[influences]]\nlaw = \"biot-savart\"\non = \"one\"\n");
  run->simulation->run(10);
  EXPECT_NEAR(ensemble(*run, "one").row(0)[0], 2 / (4 * std::acos(-1.0)) * 0.5, 1e-13);
  auto const channel = read(walled + "[multipole]\nlaw = \"biot-savart\"\ntolerance = 1e-6\n" +
                            vortices.substr(0, vortices.find("[[influences]]")));
  channel->simulation->run(2);
}

double most_difference(AnyEnsemble const& a, AnyEnsemble const& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int k = 0; k < 2; ++k) most = std::max(most, std::abs(a.row(i)[k] - b.row(i)[k]));
  return most;
}

TEST(FlowScenario, SumsInSinglePrecisionWhereItMay) {
  auto const single = replaced(vortices, "on = \"vortices\"\n", "on = \"vortices\"\nprecision = \"single\"\n");
  auto const exact = read(start + vortices), rough = read(start + single);
  exact->simulation->run(40), rough->simulation->run(40);
  double const difference = most_difference(ensemble(*exact, "vortices"), ensemble(*rough, "vortices"));
  EXPECT_LT(difference, 1e-6);
  EXPECT_GT(difference, 1e-12) << "it is another sum";
  auto const same = read(start + replaced(single, "single", "full"));
  same->simulation->run(40);
  EXPECT_EQ(most_difference(ensemble(*exact, "vortices"), ensemble(*same, "vortices")), 0);
  EXPECT_NE(
      line(start + replaced(single, "biot-savart", "biot-savart-gaussian")).find("has no single precision; laws with"),
      std::string::npos);
  EXPECT_NE(line(start + single + "cutoff = 1\n").find("leave out the cut-off"), std::string::npos);
  EXPECT_NE(line(start + replaced(single, "\"single\"", "\"half\"")).find("precision"), std::string::npos);
}

TEST(FlowScenario, SinglePrecisionIsRightAndHasTheSameBitsForAnyThreads) {
  auto const run = [](int threads, bool single, Ensemble<Vortex<2>>& all, Ensemble<Tracer<2>>& felt) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      double const k = static_cast<double>(i);
      all[i].position = {100 + std::sin(12.9898 * k), std::cos(78.233 * k * k)};
      all[i].vorticity = {std::sin(k)}, all[i].core = 0.02;
    }
    for (std::size_t i = 0; i < felt.size(); ++i) felt[i].position = all[i].position + Vector{0.01, 0.02};
    PairScheme scheme(Box({-200, -200}, {200, 200}));
    scheme.threads(threads);
    if (single) {
      add_in_single_precision(scheme, all, all, AlgebraicBiotSavart{});
      add_in_single_precision(scheme, felt, all, AlgebraicBiotSavart{});
    } else {
      scheme.internal(all, AlgebraicBiotSavart{});
      scheme.between(felt, all, one_way(AlgebraicBiotSavart{}));
    }
    scheme.calculate();
  };
  for (std::size_t const count : {1U, 7U, 64U, 1000U, 1700U}) {
    Ensemble<Vortex<2>> exact("vortices", count), one("vortices", count), three("vortices", count);
    Ensemble<Tracer<2>> exact_felt("felt", count), one_felt("felt", count), three_felt("felt", count);
    run(1, false, exact, exact_felt), run(1, true, one, one_felt), run(3, true, three, three_felt);
    double errors = 0, all = 1e-300;
    for (std::size_t i = 0; i < count; ++i) {
      errors += norm2(one.influence_on(i) - exact.influence_on(i)) +
                norm2(one_felt.influence_on(i) - exact_felt.influence_on(i));
      all += norm2(exact.influence_on(i)) + norm2(exact_felt.influence_on(i));
    }
    EXPECT_LT(std::sqrt(errors / all), 5e-6) << count;
    EXPECT_EQ(std::memcmp(one.influence(0), three.influence(0), 2 * count * sizeof(double)), 0) << count;
    EXPECT_EQ(std::memcmp(one_felt.influence(0), three_felt.influence(0), 2 * count * sizeof(double)), 0) << count;
  }
}

TEST(FlowScenario, RefusesWhatCantBe) {
  struct Case {
    std::string text, part;
  };
  std::string const space = replaced(replaced(start, "[-5, -5]", "[-5, -5, -5]"), "[5, 5]", "[5, 5, 5]");
  std::string const in_space =
      "[[ensembles]]\nname = \"v\"\nclass = \"Inviscid\"\nload = { kind = \"positions\", positions = [[0, 0, 0]] }\n"
      "vorticity = [[0, 0, 1]]\ncore = 0.1\n[[influences]]\non = \"v\"\n";
  for (auto const& [text, part] : std::vector<Case>{
           {start + "[cylinder_flow]\nstream = [1, 0]\n" + vortices, "[cylinder_flow] has no 'radius'"},
           {start + "[cylinder_flow]\nradius = 3\n" + vortices, "vortex 0 of 'vortices' is inside"},
           {start + cylinder + vortices +
                "[[bodies]]\nname = \"b\"\nshape = \"circle\"\ncentre = [3, 3]\nradius = 0.5\n",
            "make the cylinder one of the [[bodies]]"},
           {start + "[cylinder_flow]\nradius = 1\n[[ensembles]]\nname = \"a\"\nclass = \"Newton\"\nload = { kind = "
                    "\"positions\", "
                    "positions = [[2, 2]] }\n",
            "no ensemble is carried by a flow"},
           {replaced(start, "high = [5, 5]\n", "high = [5, 5]\nboundary = \"periodic\"\n") + cylinder + tracers,
            "axis x is periodic"},
           {space + "[cylinder_flow]\nradius = 1\n" + in_space + "law = \"uniform-flow\"\nvelocity = [1, 0, 0]\n",
            "images in a circle are of 2D"},
           {start + vortices + replaced(dye, "on = \"dye\"", "on = \"vortices\""),
            "what is released is of class Dye or Tracer"},
           {start + tracers + replaced(dye, "to = [-3, 1]\n", ""), "a line has both ends"},
           {start + tracers + replaced(dye, "on = \"dye\"", "on = \"die\""), "there is no ensemble 'die'"},
           {start + tracers + replaced(dye, "every = 4", "every = 0"), "every"},
           {replaced(start, "high = [5, 5]\n", "high = [5, 5]\nboundary = \"periodic\"\n") + tracers +
                replaced(dye, "from = [-3, 0]", "from = [-6, 0]"),
            "from: x = -6 is outside the box"},
           {start + tracers +
                "[[influences]]\nlaw = \"shear-flow\"\non = \"dye\"\ndirection = [1, 0]\ngradient = [1, 1]\n",
            "direction . gradient is 1"},
           {start + tracers + "[[influences]]\nlaw = \"strain-flow\"\non = \"dye\"\nrates = [1, 1]\n",
            "the sum of the rates is 2"},
           {space + in_space + "law = \"shear-flow\"\ndirection = [1, 0, 0]\ngradient = [0, 1, 0]\n",
            "can't act on class Inviscid, whose vorticity is stretched"}})
    EXPECT_NE(line(text).find(part), std::string::npos) << line(text) << "\nhas no: " << part;
  auto const swinging =
      read(space + in_space + "law = \"oscillating-flow\"\nvelocity = [1, 0, 0]\nangular_frequency = 2\n");
  swinging->simulation->run(20);
  EXPECT_NEAR(ensemble(*swinging, "v").row(0)[0], (1 - std::cos(2.0)) / 2,
              4e-8);  // Simpson's rule errs by less than (2 dt)^4 / 2880
}

// What messages offer are the classes that there are.
TEST(FlowClasses, ThatMessagesNameAreAll) {
  std::string vorticity, carried;
  auto const add = [](std::string& list, std::string const& name) { list += (list.empty() ? "" : ", ") + name; };
  for (auto const& one : particle_classes()) {
    SourceKind const kind = one.variants.front().source;
    if (kind.carried) add(carried, one.name);
    if (kind.vorticity >= 0) add(vorticity, one.name);
  }
  for (auto* list : {&vorticity, &carried}) list->replace(list->rfind(","), 1, " and");
  EXPECT_EQ(vorticity, classes_with_vorticity);
  EXPECT_EQ(carried, classes_carried_by_flows);
}

}  // namespace
}  // namespace boltzmann::flow_scenario_test
