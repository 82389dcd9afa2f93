// [embedded_atoms] and [stillinger_weber]: what they read is what a program would say, and what is wrong is told.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include <tests/scenario/mistakes.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace boltzmann::many_body_scenario_test {
namespace {

using test::ensemble;
using test::expect_one_line;
using test::Mistake;
using test::mistake_name;
using test::mistakes_of;
using test::replaced;

std::string const head =
    "[units]\nbase = \"custom\"\nlength = \"1 angstrom\"\nmass = \"1 amu\"\ntime = \"1 ps\"\n"
    "[box]\nlow = [0, 0, 0]\nhigh = [14.44, 14.44, 14.44]\nboundary = \"periodic\"\n[run]\nstep = \"2 fs\"\nsteps = "
    "10\n";
std::string const atoms =
    "[[ensembles]]\nname = \"atoms\"\nclass = \"Newton\"\nmass = 63.546\nload = { kind = \"block\", lattice = \"fcc\", "
    "spacing = 2.5526555, counts = [4, 4, 4], origin = \"centred\" }\ntemperature = \"300 K\"\n";
std::string const metal =
    "[embedded_atoms]\npotential = \"sutton-chen\"\nepsilon = \"12.382 meV\"\na = \"3.61 angstrom\"\nn = 9\nm = 6\nc = "
    "39.432\ncutoff = \"5.5 angstrom\"\n";
std::string const semiconductor = "[stillinger_weber]\nepsilon = \"2.1683 eV\"\nsigma = \"2.0951 angstrom\"\n";

std::unique_ptr<ScenarioSimulation> read(std::string const& text) { return parse_scenario(text, "test.toml"); }

double eV() { return UnitSystem(1 * units::angstrom, 1 * units::amu, 1 * units::picosecond)(1 * units::electronvolt); }

class ManyBodyMistakes : public testing::TestWithParam<Mistake> {};
TEST_P(ManyBodyMistakes, AreToldInOneLine) { expect_one_line(GetParam()); }

TEST(ManyBodyScenario, SaysWhatAProgramSays) {
  auto const run = read(head + metal + "skin = \"0.4 angstrom\"\nswitch_from = \"5 angstrom\"\n" + atoms);
  Ensemble<Newton<3>> same("same");
  AnyEnsemble const& loaded = ensemble(*run, "atoms");
  same.resize(loaded.size());
  for (std::size_t i = 0; i < same.size(); ++i)
    for (int a = 0; a < 3; ++a) same[i].position[a] = loaded.row(i)[a] + 0.1 * std::sin(double(3 * i) + a);
  EmbeddedAtomScheme scheme(Box({0, 0, 0}, {14.44, 14.44, 14.44}, Boundary::periodic),
                            EmbeddedAtoms(SuttonChen{0.012382 * eV(), 3.61, 9, 6, 39.432}, {5.5, 5}));
  scheme.add(same);
  for (std::size_t i = 0; i < same.size(); ++i)
    for (int a = 0; a < 3; ++a) ensemble(*run, "atoms").row(i)[a] = same[i].position[a];
  EXPECT_NEAR(run->simulation->measure().potential / scheme.measure().potential, 1, 1e-12);
  EXPECT_LT(scheme.measure().potential / eV() / double(same.size()), -3);
  run->simulation->run(10);
}

TEST(ManyBodyScenario, AddsToWhatPairsDo) {
  std::string const pairs =
      "[[influences]]\nlaw = \"soft\"\non = \"atoms\"\nrepulsion = \"1 eV/angstrom\"\nrange = 3.2\ncutoff = 3.2\n";
  auto const both = read(head + metal + atoms + pairs), one = read(head + metal + atoms),
             other = read(head + atoms + pairs);
  auto const energy = [](auto const& run) { return run->simulation->measure().potential; };
  EXPECT_NEAR(energy(both), energy(one) + energy(other), 1e-9 * std::abs(energy(both)));
  EXPECT_GT(energy(other), 0.01 * std::abs(energy(one)));
  both->simulation->run(5);
}

TEST(ManyBodyScenario, ReadsFormulas) {
  std::string const
      cutoff = "cutoff = \"6 angstrom\"\n",
      shipped =
          "[embedded_atoms]\npotential = \"gupta\"\nA = \"85.5 meV\"\nxi = \"1.224 eV\"\np = 10.96\nq = "
          "2.278\nr0 = \"2.556 angstrom\"\n" +
          cutoff,
      typed =
          "[embedded_atoms]\npotential = \"formulas\"\npair = \"2*A*exp(-p*(r/r0 - 1))\"\ndensity = "
          "\"exp(-2*q*(r/r0 - 1))\"\nembedding = \"-xi*sqrt(rho)\"\nparameters = { A = \"85.5 meV\", xi = "
          "\"1.224 eV\", p = 10.96, q = 2.278, r0 = \"2.556 angstrom\" }\n" +
          cutoff;
  auto const a = read(head + shipped + atoms), b = read(head + typed + atoms);
  double const energy = a->simulation->measure().potential;
  EXPECT_NEAR(b->simulation->measure().potential / energy, 1, 1e-5);
  EXPECT_NEAR(energy / eV() / 256, -3.5, 0.1);  // copper, but for what is beyond the cut-off
  auto const lines = mistakes_of(head + replaced(typed, "-xi*sqrt(rho)", "-A*sqrt(r)") + atoms);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].find("test.toml:17:"), 0u) << lines[0];
}

TEST(ManyBodyScenario, TakesClassesOfItsOwnAndSeveralEnsembles) {
  std::string const marked = "[[classes]]\nname = \"Marked\"\nbase = \"Newton\"\n[[classes.fields]]\nname = \"mark\"\n";
  auto const run = read(head + marked + semiconductor + replaced(atoms, "\"Newton\"", "\"Marked\"") +
                        "[[ensembles]]\nname = \"more\"\nclass = \"Newton\"\nmass = 28\nload = { kind = \"positions\", "
                        "positions = [[7, 7, 7]] }\n");
  run->simulation->run(1);
  auto const alone = read(head + semiconductor + atoms);
  EXPECT_NE(run->simulation->measure().potential, alone->simulation->measure().potential);
}

TEST(ManyBodyScenario, ReadsFilesOfSeveralElements) {
  auto const folder = std::filesystem::temp_directory_path() / ("many_body_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  {
    std::ofstream file(folder / "alloy.eam");
    file << "one\ntwo\nthree\n2 Aa Bb\n6 10 12 0.5 5.5\n";
    for (double const strength : {1.0, 2.0}) {
      file << "29 63.5 3.6 fcc\n0 -1 -1.4 -1.7 -2 -2.2\n";
      for (int k = 0; k < 12; ++k) file << strength * (11 - k) * (11 - k) << (k < 11 ? " " : "\n");
    }
    for (double const strength : {1.0, 1.5, 2.0})
      for (int k = 0; k < 12; ++k) file << strength * (11 - k) * (11 - k) * 0.01 << (k < 11 ? " " : "\n");
  }
  auto const text = [&](std::string const& more) {
    return head + "[embedded_atoms]\npotential = \"file\"\nfile = \"" + (folder / "alloy.eam").string() + "\"\n" +
           more + atoms;
  };
  double const a = read(text("elements = { atoms = \"Aa\" }\n"))->simulation->measure().potential,
               b = read(text("elements = { atoms = \"Bb\" }\n"))->simulation->measure().potential;
  EXPECT_NE(a, b);
  // A name that is that of an element says it, too.
  EXPECT_EQ(read(replaced(text(""), "\"atoms\"", "\"Bb\""))->simulation->measure().potential, b);
  auto const lines = mistakes_of(text(""));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("which element is 'atoms'? These are known: Aa, Bb"), std::string::npos) << lines[0];
  auto const stranger = mistakes_of(text("elements = { atom = \"Aa\" }\n"));
  ASSERT_FALSE(stranger.empty());
  EXPECT_NE(stranger[0].find("there is no ensemble 'atom'; did you mean 'atoms'?"), std::string::npos) << stranger[0];
  std::filesystem::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(
    ManyBody, ManyBodyMistakes,
    testing::Values(
        Mistake{"no potential",
                head + replaced(metal, "potential = \"sutton-chen\"\n", "") + atoms,
                "13:1",
                {"potential = \"sutton-chen\""}},
        Mistake{"unknown potential",
                head + replaced(metal, "sutton-chen", "sutton-chan") + atoms,
                "14:13",
                {"'sutton-chan'", "sutton-chen", "gupta", "file"}},
        Mistake{"a key of another", head + metal + "xi = 3\n" + atoms, "21:1", {"xi"}},
        Mistake{"no length", head + replaced(metal, "\"3.61 angstrom\"", "\"3.61 eV\"") + atoms, "16:5", {"a"}},
        Mistake{"a cut-off beyond the box",
                head + replaced(metal, "5.5 angstrom", "15 angstrom") + atoms,
                "13:1",
                {"the cut-off 15", "at most 14.44"}},
        Mistake{"a switch behind the cut-off",
                head + metal + "switch_from = 6\n" + atoms,
                "13:1",
                {"switch_from = 6", "cutoff = 5.5"}},
        Mistake{"nobody is moved by forces",
                head + metal +
                    replaced(replaced(replaced(atoms, "Newton", "Tracer"), "mass = 63.546\n", ""),
                             "temperature = \"300 K\"\n", ""),
                "13:1",
                {"[embedded_atoms]: no ensemble"}},
        Mistake{"nobody of that name", head + semiconductor + "on = \"atom\"\n" + atoms, "16:6", {"atom", "atoms"}},
        Mistake{
            "mirrors", replaced(head, "periodic", "mirror") + semiconductor + atoms, "13:1", {"axis x is a mirror"}},
        Mistake{"no such file",
                head + "[embedded_atoms]\npotential = \"file\"\nfile = \"nowhere.eam\"\n" + atoms,
                "15:8",
                {"nowhere.eam: can't open the file"}}),
    mistake_name);

}  // namespace
}  // namespace boltzmann::many_body_scenario_test
