// Kind of fault: what a user of another program writes gets a message that leads elsewhere. Each message names the cure
// first, in one line, and at most eight names. Siblings: every table and key, inputs of seven programs, words of six
// programs, four ways to write sigma and epsilon, capitals, units without quotes in tables, arrays and inline tables.
#include "tests/cases/case.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann::words_test {
namespace {

using test::bzm;
using test::Case;

std::string const start = R"([units]
base = "custom"
length = "1 nm"
mass = "1 amu"
time = "1 ps"

[box]
low = [0, 0]
high = ["10 nm", "10 nm"]
boundary = "periodic"

[run]
step = "2 fs"
steps = 1
cutoff = "1 nm"

[[ensembles]]
name = "a"
class = "Newton"
mass = "40 amu"
load = { kind = "positions", positions = [["1 nm", "1 nm"], ["1.4 nm", "1 nm"]] }
)";
std::string const law = R"(
[[influences]]
law = "lennard-jones"
on = "a"
epsilon = "1 kJ/mol"
sigma = "0.34 nm"
)";

std::string with(std::string text, std::string const& from, std::string const& to) {
  auto const at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// The lines of `bzm check`.
std::string told_of(std::string const& text) {
  auto const outcome = Case("case", text).check();
  EXPECT_EQ(outcome.status, 2) << outcome.out << outcome.err;
  return outcome.err;
}

void expect(std::string const& text, std::string const& wanted) {
  auto const told = told_of(text);
  EXPECT_NE(told.find(wanted), std::string::npos) << told << "\nwanted: " << wanted;
}

TEST(Words, AQuantityWithoutQuotesIsShownWithThem) {
  std::string const all = start + law;
  for (auto const& [from, to, wanted] : std::vector<std::array<std::string, 3>>{
           {"step = \"2 fs\"", "step = 5 fs", "write a quantity with a unit as text: step = \"5 fs\""},
           {"step = \"2 fs\"", "step = 5fs", "write a quantity with a unit as text: step = \"5fs\""},
           {"step = \"2 fs\"", "step = 2.5e-3 ps  # short",
            "write a quantity with a unit as text: step = \"2.5e-3 ps\""},
           {"mass = \"40 amu\"", "mass = 40 amu", "write a quantity with a unit as text: mass = \"40 amu\""},
           {"[\"10 nm\", \"10 nm\"]", "[10 nm, 10 nm]", "write a quantity with a unit as text: \"10 nm\""},
           {"[[\"1 nm\", \"1 nm\"]", "[[1 nm, \"1 nm\"]", "write a quantity with a unit as text: \"1 nm\""},
           {"boundary = \"periodic\"", "boundary = periodic", "write a text in quotes: boundary = \"periodic\""},
           {"kind = \"positions\"", "kind = positions", "write a text in quotes: kind = \"positions\""},
           {"steps = 1", "steps = 1\nshifted = False", "write it in small letters: shifted = false"},
           {"sigma = \"0.34 nm\"", "sigma = 0.34 nm", "write a quantity with a unit as text: sigma = \"0.34 nm\""}})
    expect(with(all, from, to), wanted);
}

TEST(Words, InputsOfOtherProgramsAreNamed) {
  for (auto const& [text, wanted] : std::vector<std::pair<std::string, std::string>>{
           {"# 3d melt\nunits lj\natom_style atomic\nlattice fcc 0.8442\nregion box block 0 10 0 10 0 10\n"
            "pair_style lj/cut 2.5\nrun 250\n",
            "this is a LAMMPS input; docs/how-to/from-lammps.md translates its commands"},
           {"variable x index 1\nunits\t\tmetal\nboundary p p p\ntimestep 0.001\n", "this is a LAMMPS input"},
           {"LAMMPS data\n\n2 atoms\n1 atom types\n\nAtoms # atomic\n\n1 1 0 0 0\n2 1 1 1 1\n", "LAMMPS data file"},
           {"; run control\nintegrator = md\ndt = 0.002\nnsteps = 1000\ntcoupl = v-rescale\n", "GROMACS .mdp"},
           {"import hoomd\nsim = hoomd.Simulation(device=hoomd.device.CPU())\n", "a Python program for HOOMD-blue"},
           {"import rebound\nsim = rebound.Simulation()\nsim.add(m=1)\n", "a Python program for REBOUND"},
           {"from pysph.base.kernels import CubicSpline\nx = 1\n", "a Python program for PySPH"},
           {"ATOM      1  N   ALA A   1      11.1  6.1  -6.5\nATOM      2  CA  ALA A   1      11.6  6.1  -5.1\n",
            "a PDB file"},
           {"{\n  \"step\": 5,\n  \"box\": [1, 2]\n}\n", "this is JSON"},
           {"box:\n  low: [0, 0]\nrun:\n  step: 1\n", "this is YAML"},
           {"max_step = 100\namr.n_cell = 64 64\ngeometry.dims = 2\n", "a WarpX input"},
           {std::string("\x89HDF\r\n\x1a\n\0\0", 10), "an HDF5 file"}}) {
    auto const told = told_of(text);
    EXPECT_NE(told.find(wanted), std::string::npos) << told << "\nwanted: " << wanted;
    EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 1) << told;
  }
}

TEST(Words, AMisspeltLineOfTomlIsNotTakenForAnotherProgram) {
  auto const told = told_of(with(start, "step = \"2 fs\"", "step = "));
  EXPECT_NE(told.find("this is not TOML"), std::string::npos) << told;
}

// Lennard-Jones in its two conventions: 4 epsilon [(sigma/r)^12 - (sigma/r)^6] at r = 0.4 nm is -0.9399 kJ/mol.
TEST(Words, SigmaAndEpsilonAreTaken) {
  std::string const diagnoses =
      "\n[[diagnoses]]\nkind = \"energies\"\n\n[output]\ndiagnoses = 1\nunits = { energy = \"kJ/mol\" }\n";
  double const s6 = std::pow(0.34 / 0.4, 6), exact = 4 * (s6 * s6 - s6);
  std::string const r0 = "r0 = \"0.381637096425187 nm\"";
  for (auto const& text : {law, with(law, "epsilon", "depth"), with(law, "sigma = \"0.34 nm\"", r0),
                           with(with(law, "epsilon", "depth"), "sigma = \"0.34 nm\"", r0)}) {
    Case const one("case", with(start, "cutoff = \"1 nm\"", "cutoff = \"1 nm\"\nshifted = false") + text + diagnoses);
    auto const outcome = one.run();
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NEAR(one.column("potential energy (kJ/mol)").front(), exact, 1e-9 * std::abs(exact)) << text;
  }
  expect(start + law + "depth = \"1 kJ/mol\"\n", "epsilon: 'depth' is given, too; leave one of them out");
  expect(start + law + "r0 = \"0.3 nm\"\n", "sigma: 'r0' is given, too; leave one of them out");
  expect(start + with(law, "0.34 nm", "-0.34 nm"), "sigma: '-0.34 nm' is out of range; it must be positive");
  expect(start + with(law, "sigma = \"0.34 nm\"\n", ""), "needs 'r0' (or 'sigma')");
  auto const shown = bzm({"show", "lennard-jones"}, "/");
  EXPECT_NE(shown.out.find("sigma"), std::string::npos) << shown.out;
  EXPECT_NE(shown.out.find("epsilon"), std::string::npos) << shown.out;
}

TEST(Words, SigmaOfSeveralSpeciesIsMixed) {
  std::string const two = start +
                          "\n[[ensembles]]\nname = \"b\"\nclass = \"Newton\"\nmass = \"40 amu\"\n"
                          "load = { kind = \"positions\", positions = [[\"1 nm\", \"1.5 nm\"]] }\n";
  std::string const among =
      "\n[[influences]]\nlaw = \"lennard-jones\"\namong = [\"a\", \"b\"]\n"
      "epsilon = { a = \"1 kJ/mol\", b = \"2 kJ/mol\" }\nsigma = { a = \"0.34 nm\", b = "
      "\"0.3 nm\" }\nmixing = { epsilon = \"geometric\", sigma = \"arithmetic\" }\n";
  auto const outcome = Case("case", two + among).check();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
}

TEST(Words, ThermostatsAndOtherTablesAreNamedWhereTheyAreMissed) {
  auto const in_ensemble = [](std::string const& key) {
    return with(start, "mass = \"40 amu\"", key + "\nmass = \"40 amu\"");
  };
  for (char const* key : {"thermostat = \"nose-hoover\"", "thermostat = { tau = 1 }", "bussi = 1", "tcoupl = \"yes\""})
    expect(in_ensemble(key), "in [[ensembles]] 'a'; a thermostat is a table of its own: [[dissipation]]");
  expect(in_ensemble("barostat = \"mtk\""), "a pressure is held by a table of its own: [barostat]");
  expect(in_ensemble("setforce = [0, 0]"), "freeze");
  expect(with(start, "steps = 1", "steps = 1\nthermostat = \"csvr\""), "[[dissipation]]");
  expect(with(start, "steps = 1", "steps = 1\nbarostat = \"csvr\""), "[barostat]");
}

TEST(Words, OtherCapitalsAreTheOnlyMistake) {
  std::string const all = start + law;
  for (auto const& [from, to, wanted] :
       std::vector<std::array<std::string, 3>>{{"[box]", "[Box]", "unknown table 'Box'"},
                                               {"[run]", "[RUN]", "unknown table 'RUN'"},
                                               {"[[ensembles]]", "[[Ensembles]]", "did you mean 'ensembles'?"},
                                               {"low = ", "Low = ", "unknown key 'Low' in [box]; did you mean 'low'?"},
                                               {"class = ", "Class = ", "did you mean 'class'?"}}) {
    auto const told = told_of(with(all, from, to));
    EXPECT_NE(told.substr(0, told.find('\n')).find(wanted), std::string::npos) << told;
    EXPECT_EQ(told.find("there is no ["), std::string::npos) << told;
    EXPECT_EQ(told.find("has no '"), std::string::npos) << told;
  }
}

TEST(Words, DimensionsAreNamedByWhatPeopleKnow) {
  auto const typed = [](std::string const& energy) {
    return start + "\n[[influences]]\non = \"a\"\nenergy = \"" + energy +
           "\"\nparameters = { eps = \"1 kJ/mol\", t = \"1 ps\", f = \"1 nN\" }\n";
  };
  expect(typed("eps*r"), "an energy is needed; this is an energy times a length");
  expect(typed("eps/t"), "an energy is needed; this is a power");
  expect(typed("eps*t"), "an energy is needed; this is ");
  expect(typed("f*r^3"), "this is an energy times an area");
  expect(typed("eps*r^6"), "this is an energy times length^6");
  for (char const* energy : {"eps*r", "f*r^3", "eps/r^2", "f/t", "eps*t/r", "eps^2"})
    EXPECT_EQ(told_of(typed(energy)).find("^-2"), std::string::npos) << told_of(typed(energy));
}

/// How many names a line lists behind "there are" or "allowed are".
std::size_t names_in(std::string const& line) {
  auto const at = std::min(line.find("here are "), line.find("llowed are "));
  if (at == std::string::npos) return 0;
  return static_cast<std::size_t>(std::count(line.begin() + static_cast<std::ptrdiff_t>(at), line.end(), ',')) + 1;
}

TEST(Words, TheHintComesFirstAndListsAreShort) {
  auto const diagnosis = told_of(start + "\n[[diagnoses]]\nkind = \"temprature\"\n");
  EXPECT_NE(diagnosis.find("unknown diagnosis 'temprature'; did you mean 'temperature'? There are "), std::string::npos)
      << diagnosis;
  EXPECT_LE(names_in(diagnosis), 8U) << diagnosis;
  EXPECT_NE(diagnosis.find(" more (bzm list diagnoses"), std::string::npos) << diagnosis;
  for (auto const& told :
       {told_of(start + "\n[[influences]]\nlaw = \"morze\"\non = \"a\"\n"), told_of(with(start, "Newton", "Neuton")),
        told_of(with(start, "kind = \"positions\"", "kind = \"random_\"")),
        told_of(with(start, "steps = 1", "stps = 1")), bzm({"rnu", "copper"}, "/").err,
        bzm({"run", "--stpes", "3", "copper"}, "/").err,
        told_of(start + "\n[[dissipation]]\nkind = \"langevine\"\non = \"a\"\n"),
        told_of(start + "\n[[diagnoses]]\nkind = \"nothing-like-it\"\n")}) {
    for (std::size_t at = 0; at < told.size();) {
      std::size_t const end = std::min(told.find('\n', at), told.size());
      EXPECT_LE(names_in(told.substr(at, end - at)), 9U) << told.substr(at, end - at);
      at = end + 1;
    }
  }
}

TEST(Words, ShowKnowsOtherProgramsWords) {
  for (auto const& [word, wanted] : std::vector<std::pair<std::string, std::string>>{
           {"fix setforce", "`freeze`"},
           {"fix langevin", "langevin"},
           {"fix nvt", "[[dissipation]]"},
           {"fix npt", "[barostat]"},
           {"fix shake", "[[rigid_bonds]]"},
           {"fix nve", "leap-frog"},
           {"granular", "no granular contacts"},
           {"pair_style gran/hooke/history", "no granular contacts"},
           {"meam", "does not have it"},
           {"pair_style meam/c", "does not have it"},
           {"pair_style eam", "[embedded_atoms]"},
           {"pair_style eam/alloy", "[embedded_atoms]"},
           {"pair_style tersoff", "does not have it"},
           {"compute msd", "mean-square-displacement"},
           {"compute rdf", "radial-distribution"},
           {"compute stress/atom", "pressure"},
           {"pair_style lj/cut", "lennard-jones"},
           {"hoomd.md.pair.LJ", "lennard-jones"},
           {"hoomd.md.methods.ConstantVolume", "[[dissipation]]"},
           {"rebound.whfast", "does not have it"},
           {"ias15", "gauss-radau"},
           {"wcsph", "[smooth]"},
           {"pml", "does not have it"},
           {"mdp", "nothing is called"},
           {"fix something/unknown", "nothing is called 'fix something/unknown'"}}) {
    auto const shown = bzm({"show", word}, "/");
    std::string const said = shown.out + shown.err;
    EXPECT_NE(said.find(wanted), std::string::npos) << word << ": " << said;
    EXPECT_EQ(said.find("triangular"), std::string::npos) << word << ": " << said;
  }
}

// The picture of a region shows that region, and its numbers are those of the axes: here of nm, where the base is SI.
TEST(Words, ARegionOfAPictureIsInTheUnitsOfItsAxes) {
  std::string const si = R"([units]
base = "si"
[box]
low = ["0 nm", "0 nm"]
high = ["100 nm", "100 nm"]
boundary = "periodic"
[run]
step = "1 fs"
steps = 1
[[ensembles]]
name = "a"
class = "Newton"
mass = "40 amu"
load = { kind = "block", lattice = "square", spacing = "10 nm", counts = [10, 10] }
[output]
trajectory = 1
)";
  Case const one("case", si);
  ASSERT_EQ(one.run().status, 0);
  auto const whole = bzm({"render", "run", "-o", "whole.svg"}, one.string());
  ASSERT_EQ(whole.status, 0) << whole.err;
  bool const nanometres = test::text_of(one / "whole.svg").find("(nm)") != std::string::npos;
  std::string const region = nanometres ? "[[30,70],[35,65]]" : "[[30e-9,70e-9],[35e-9,65e-9]]";
  auto const part = bzm({"render", "run", "-o", "part.svg", "--region", region}, one.string());
  ASSERT_EQ(part.status, 0) << part.err;
  auto const with_units =
      bzm({"render", "run", "-o", "units.svg", "--region", "[['30 nm','70 nm'],['35 nm','65 nm']]"}, one.string());
  ASSERT_EQ(with_units.status, 0) << with_units.err;
  std::string const drawn = test::text_of(one / "part.svg");
  EXPECT_EQ(drawn, test::text_of(one / "units.svg"));
  EXPECT_NE(drawn, test::text_of(one / "whole.svg"));
}

// 100 more particles among 400 in a plane: without a distance some overlap and the run ends with a line that names the key.
TEST(Words, WhatIsAddedKeepsADistance) {
  std::string const text = R"([units]
base = "reduced"
[box]
low = [0, 0]
high = [40, 40]
boundary = "periodic"
[run]
step = 0.002
steps = 30
cutoff = 2.5
[[ensembles]]
name = "a"
class = "Newton"
load = { kind = "random", minimum_distance = 1.1 }
number = 400
temperature = 0.5
[[influences]]
law = "lennard-jones"
on = "a"
depth = 1
r0 = 1.1
[[events]]
at = 0.02
on = "a"
add = { load = { kind = "random", minimum_distance = 1.0 }, number = 100 }
keep_distance = 1.0
[[diagnoses]]
kind = "number"
[output]
diagnoses = 30
)";
  Case const apart("case", text);
  auto const outcome = apart.run();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(apart.column("number").back(), 500);
  auto const near = Case("case", with(text, "keep_distance = 1.0\n", "")).run();
  EXPECT_NE(near.status, 0);
  EXPECT_NE(near.err.find("keep_distance"), std::string::npos) << near.err;
  auto const full = Case("case", with(text, "keep_distance = 1.0", "keep_distance = 6")).run();
  EXPECT_EQ(full.status, 2) << full.err;
  EXPECT_NE(full.err.find("in 20000 draws no place was found"), std::string::npos) << full.err;
  expect(with(text, "load = { kind = \"random\", minimum_distance = 1.0 }, number = 100",
              "load = { kind = \"positions\", positions = [[1, 1]] }"),
         "keep_distance: it is of particles at random");
  Case const stopped("case", text);
  ASSERT_EQ(stopped.run({"--steps", "5"}).status, 0);
  ASSERT_EQ(bzm({"resume", "run", "--steps", "25", "--threads", "1"}, stopped.string()).status, 0);
  EXPECT_EQ(test::text_of(stopped / "run/diagnoses.csv").substr(0, 60),
            test::text_of(apart / "run/diagnoses.csv").substr(0, 60));
  EXPECT_EQ(stopped.column("number").back(), 500);
}

TEST(Words, AnOpenAxisOfAMeanProfileIsToldInASentence) {
  std::string const open = with(start, "boundary = \"periodic\"", "boundary = [\"periodic\", \"open\"]");
  expect(open + "\n[[diagnoses]]\nkind = \"mean-profile\"\nquantity = \"density\"\naxis = \"y\"\n",
         "axis y is open, so the ends of its bins are not known; write 'from' and 'to'");
}

// The file for pkg-config finds what is installed wherever that is.
TEST(Words, PkgConfigPointsToWhereItsFileIs) {
  test::Folder const folder;
  std::string const text = test::text_of(BOLTZMANN_BUILD "/boltzmann.pc");
  auto const prefix = text.find("prefix=${pcfiledir}/");
  ASSERT_NE(prefix, std::string::npos) << text;
  std::string const up = text.substr(prefix + 20, text.find('\n', prefix) - prefix - 20);
  auto const levels = static_cast<std::size_t>(std::count(up.begin(), up.end(), '/')) + 1;
  auto const place = folder / (levels == 3 ? "elsewhere/lib/x86_64-linux-gnu/pkgconfig" : "elsewhere/lib/pkgconfig");
  test::fs::create_directories(place);
  test::fs::copy(BOLTZMANN_BUILD "/boltzmann.pc", place / "boltzmann.pc");
  auto const told = test::Process({"/usr/bin/pkg-config", "--variable=includedir", (place / "boltzmann.pc").string()},
                                  folder.string())
                        .wait();
  ASSERT_EQ(told.status, 0) << told.err;
  auto const includes = test::fs::path(told.out.substr(0, told.out.find('\n'))).lexically_normal();
  EXPECT_EQ(includes, (folder / "elsewhere/include").lexically_normal());
}

}  // namespace
}  // namespace boltzmann::words_test
