// Mistakes in scenarios: one table of what users get wrong, and what they are told.
#include "mistakes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann::mistakes_test {
namespace {

using test::Mistake;
using test::mistake_name;
using test::mistakes_of;

// A scenario without mistakes; the numbers on the right are those of the lines.
std::string const good =
    "title = \"a test\"\n"                                                                                // 1
    "[units]\n"                                                                                           // 2
    "base = \"custom\"\n"                                                                                 // 3
    "length = \"1 angstrom\"\n"                                                                           // 4
    "mass = \"1 amu\"\n"                                                                                  // 5
    "time = \"1 ps\"\n"                                                                                   // 6
    "[box]\n"                                                                                             // 7
    "low = [0, 0]\n"                                                                                      // 8
    "high = [\"20 angstrom\", 20]\n"                                                                      // 9
    "boundary = \"periodic\"\n"                                                                           // 10
    "[run]\n"                                                                                             // 11
    "step = 0.01\n"                                                                                       // 12
    "steps = 20\n"                                                                                        // 13
    "cutoff = 6\n"                                                                                        // 14
    "[[ensembles]]\n"                                                                                     // 15
    "name = \"atoms\"\n"                                                                                  // 16
    "class = \"Newton\"\n"                                                                                // 17
    "integrator = \"leap-frog\"\n"                                                                        // 18
    "mass = \"40 amu\"\n"                                                                                 // 19
    "load = { kind = \"block\", lattice = \"square\", spacing = 4, counts = [4, 4], origin = [2, 2] }\n"  // 20
    "colour = \"red\"\n"                                                                                  // 21
    "[[ensembles.set]]\n"                                                                                 // 22
    "particles = [3]\n"                                                                                   // 23
    "velocity = [0.1, 0.2]\n"                                                                             // 24
    "[[influences]]\n"                                                                                    // 25
    "law = \"lennard-jones\"\n"                                                                           // 26
    "on = \"atoms\"\n"                                                                                    // 27
    "r0 = 4\n"                                                                                            // 28
    "depth = \"0.01 eV\"\n"                                                                               // 29
    "[[diagnoses]]\n"                                                                                     // 30
    "kind = \"energies\"\n"                                                                               // 31
    "[output]\n"                                                                                          // 32
    "diagnoses = 5\n"                                                                                     // 33
    "[[output.pictures]]\n"                                                                               // 34
    "colour = \"speed\"\n"                                                                                // 35
    "file = \"picture.png\"\n";                                                                           // 36

/// The scenario with one piece replaced by another; further pairs are replaced after it.
std::string with(std::string const& old, std::string const& now, std::string text = good) {
  return test::replaced(std::move(text), old, now);
}

std::string const block = "{ kind = \"block\", lattice = \"square\", spacing = 4, counts = [4, 4], origin = [2, 2] }";
std::string load(std::string const& table) { return with(block, table); }
/// With a second ensemble and more at the end.
std::string plus(std::string const& more) { return good + more; }
std::string const vortices =
    "[[ensembles]]\n"                                                  // 37
    "name = \"vortices\"\n"                                            // 38
    "class = \"Vortex\"\n"                                             // 39
    "load = { kind = \"positions\", positions = [[1, 1], [2, 3]] }\n"  // 40
    "vorticity = 1\n";                                                 // 41

/// A mesh and all that looks at it, without mistakes.
std::string const plasma =
    "[units]\n"                                                                           // 1
    "base = \"reduced\"\n"                                                                // 2
    "[box]\n"                                                                             // 3
    "low = [0, 0]\n"                                                                      // 4
    "high = [8, 8]\n"                                                                     // 5
    "boundary = \"periodic\"\n"                                                           // 6
    "[run]\n"                                                                             // 7
    "step = 0.1\n"                                                                        // 8
    "steps = 20\n"                                                                        // 9
    "[mesh]\n"                                                                            // 10
    "law = \"coulomb\"\n"                                                                 // 11
    "k = 0.08\n"                                                                          // 12
    "cells = [8, 8]\n"                                                                    // 13
    "assignment = \"cic\"\n"                                                              // 14
    "poisson = \"spectral\"\n"                                                            // 15
    "boundary = \"periodic\" # field\n"                                                   // 16
    "background = true\n"                                                                 // 17
    "precision = \"full\"\n"                                                              // 18
    "on = \"electrons\"\n"                                                                // 19
    "[[ensembles]]\n"                                                                     // 20
    "name = \"electrons\"\n"                                                              // 21
    "class = \"Coulomb\"\n"                                                               // 22
    "number = 64\n"                                                                       // 23
    "charge = -1\n"                                                                       // 24
    "load = { kind = \"sinusoidal\", mode = 1, amplitude = 0.1, quiet = true }\n"         // 25
    "temperature = 0.1\n"                                                                 // 26
    "quiet = true\n"                                                                      // 27
    "velocity_ripple = { axis = \"y\", mode = 1, amplitude = 0.1, component = \"x\" }\n"  // 28
    "[[influences]]\n"                                                                    // 29
    "law = \"uniform-magnetic-field\"\n"                                                  // 30
    "on = \"electrons\"\n"                                                                // 31
    "field = 0.5\n"                                                                       // 32
    "[[diagnoses]]\n"                                                                     // 33
    "kind = \"field-energy\"\n"                                                           // 34
    "[[diagnoses]]\n"                                                                     // 35
    "kind = \"field-mode\"\n"                                                             // 36
    "mode = [1, 0]\n"                                                                     // 37
    "quantity = \"field.y\"\n"                                                            // 38
    "[[diagnoses]]\n"                                                                     // 39
    "kind = \"wave-spectrum\"\n"                                                          // 40
    "quantity = \"field.x\"\n"                                                            // 41
    "axis = \"x\"\n"                                                                      // 42
    "modes = 3\n"                                                                         // 43
    "[output]\n"                                                                          // 44
    "diagnoses = 5\n"                                                                     // 45
    "mesh = 10\n"                                                                         // 46
    "[[output.pictures]]\n"                                                               // 47
    "drawing = \"mesh\"\n"                                                                // 48
    "y = \"potential\"\n"                                                                 // 49
    "[[output.pictures]]\n"                                                               // 50
    "drawing = \"wave-spectrum\"\n"                                                       // 51
    "curve = { frequency = 1, speed = 1 }\n"                                              // 52
    "file = \"waves.png\"\n"                                                              // 53
    "[[output.pictures]]\n"                                                               // 54
    "drawing = \"time-series\"\n"                                                         // 55
    "y = \"field energy\"\n"                                                              // 56
    "logarithmic = true\n"                                                                // 57
    "file = \"energy.png\"\n";                                                            // 58

/// The plasma with one piece replaced by another.
std::string plasma_with(std::string const& old, std::string const& now) { return with(old, now, plasma); }
std::string plasma_load(std::string const& table) {
  return plasma_with("{ kind = \"sinusoidal\", mode = 1, amplitude = 0.1, quiet = true }", table);
}
std::string cells(std::string const& value) { return plasma_with("[8, 8]\nass", value + "\nass"); }
std::string field_boundary(std::string const& value) { return plasma_with("\"periodic\" # field", value); }
std::string const mesh_table =
    plasma.substr(plasma.find("[mesh]"), plasma.find("[[ensembles]]") - plasma.find("[mesh]"));
std::string accuracy(std::string const& value) {
  return plasma_with(mesh_table, "[mesh]\nlaw = \"coulomb\"\nk = 1\nbackground = true\naccuracy = " + value + "\n");
}
std::string const magnet =
    plasma.substr(plasma.find("[[influences]]"), plasma.find("[[diagnoses]]") - plasma.find("[[influences]]"));
/// The plasma in 3D.
std::string in_space(std::string const& old, std::string const& now) {
  std::string text = with("low = [0, 0]", "low = [0, 0, 0]", plasma);
  text = with("high = [8, 8]", "high = [8, 8, 8]", text);
  text = with("cells = [8, 8]", "cells = 8", text);
  text = with("field = 0.5", "field = [0, 0, 0.5]", text);
  text = with("mode = [1, 0]", "mode = [1, 0, 0]", text);
  return with(old, now, text);
}

Overrides set(std::string const& assignment) { return {{assignment}, {}, {}, {}}; }

std::vector<Mistake> const rows{
    // Not TOML.
    {"empty file", "", "1:1", {"empty", "[box]"}},
    {"blank file", "\n  \n", "1:1", {"empty"}},
    {"not UTF-8", "title = \"ab\"\nx = \"\xff\"\n", "2:6", {"0xff", "UTF-8"}},
    {"overlong UTF-8", "a = \"\xc0\x80\"\n", "1:6", {"0xc0", "UTF-8"}},
    {"no value", with("step = 0.01", "step = "), "12:8", {"not TOML", "expected value"}},
    {"no quotes", with("base = \"custom\"", "base = custom"), "3:8", {"quotes"}},
    {"unclosed bracket", with("low = [0, 0]", "low = [0, 0"), "9:1", {"not TOML"}},
    {"duplicate key", with("steps = 20", "step = 20"), "13:8", {"duplicate key 'step'"}},
    {"duplicate table", plus("[run]\n"), "37:1", {"duplicate table 'run'"}},
    {"huge integer", with("steps = 20", "steps = 99999999999999999999"), "13:29", {"64 bits"}},
    // Keys and tables.
    {"unknown key",
     with("step = 0.01", "step = 0.01\nsede = 3"),
     "13:1",
     {"unknown key 'sede' in [run]", "Allowed are step, steps, time, seed", "did you mean 'seed'?"}},
    {"unknown table", plus("[putput]\nx = 1\n"), "37:2", {"unknown table 'putput'", "did you mean 'output'?"}},
    {"unknown key of a law",
     with("r0 = 4", "r0 = 4\nwidth = 1"),
     "29:1",
     {"unknown key 'width'", "'lennard-jones'", "bzm show influences"}},
    {"unknown field",
     with("mass = \"40 amu\"", "mass = 40\ncharge = 1"),
     "20:1",
     {"unknown key 'charge'", "it is a key of class Coulomb"}},
    {"unknown key of a loader", load("{ kind = \"random\", spacing = 1 }"), "20:27", {"unknown key 'spacing' in load"}},
    {"lattice constant and spacing",
     load("{ kind = \"block\", spacing = 4, lattice_constant = 4, counts = [4, 4] }"),
     "20:58",
     {"lattice_constant: 'spacing' sets it, too"}},
    {"key of another table", load("{ kind = \"random\", number = 3 }"), "20:27", {"it is a key of [[ensembles]]"}},
    {"key of a table at the top", "steps = 3\n" + good, "1:1", {"unknown key 'steps'", "it is a key of [run], [minim"}},
    {"field of another class", with("mass = \"40 amu\"", "charge = 1"), "19:1", {"; it is a key of class Coulomb"}},
    {"key of another program", with("step = 0.01", "step = 0.01\ndt = 1"), "13:1", {"it is called 'step' here"}},
    {"begin of a word", with("kind = \"energies\"", "kind = \"temp\""), "31:8", {"did you mean 'temperature'?"}},
    {"unknown key of a diagnosis",
     with("kind = \"energies\"", "kind = \"energies\"\nlabel = \"x\""),
     "32:1",
     {"unknown key 'label'", "'energies'"}},
    {"missing step", with("step = 0.01\n", ""), "11:1", {"[run] has no 'step'", "step = 0.01"}},
    {"missing box",
     with("[box]\nlow = [0, 0]\nhigh = [\"20 angstrom\", 20]\nboundary = \"periodic\"\n", ""),
     "1:1",
     {"no [box]"}},
    {"missing ensembles", "[box]\nlow = [0]\nhigh = [1]\n[run]\nstep = 1\nsteps = 1\n", "1:1", {"no [[ensembles]]"}},
    {"missing class", with("class = \"Newton\"\n", ""), "15:1", {"no 'class'", "Newton"}},
    {"missing parameter", with("r0 = 4\n", ""), "25:1", {"'lennard-jones' needs 'r0'", "distance of the minimum"}},
    {"missing load", with("load = " + block + "\n", ""), "15:1", {"no 'load'"}},
    {"single bracket", with("[[influences]]", "[influences]"), "25:1", {"[[influences]]", "two brackets"}},
    {"double bracket", with("[run]", "[[run]]"), "11:1", {"[run]"}},
    // Types.
    {"text for a number of steps", with("steps = 20", "steps = \"many\""), "13:9", {"whole number", "'many'"}},
    {"fraction of a step", with("steps = 20", "steps = 2.5"), "13:9", {"whole number", "2.5"}},
    {"number for a text", with("name = \"atoms\"", "name = 7"), "16:8", {"text is needed", "7"}},
    {"array for a quantity", with("step = 0.01", "step = [1]"), "12:8", {"step", "an array"}},
    {"text for a flag",
     with("colour = \"red\"", "remove_drift = \"yes\"\ntemperature = 3"),
     "21:16",
     {"true or false"}},
    {"scalar for a vector", with("velocity = [0.1, 0.2]", "velocity = 3"), "24:12", {"array of 2 numbers"}},
    {"table for a number", with("r0 = 4", "r0 = { a = 1 }"), "28:6", {"a table"}},
    {"load is a text", with(block, "\"block\""), "20:8", {"load: a table is needed"}},
    // Units.
    {"wrong dimension",
     with("mass = \"40 amu\"", "mass = \"2.551 angstrom\""),
     "19:8",
     {"'2.551 angstrom' is a length, a mass is needed", "kg"}},
    {"unknown unit", with("\"20 angstrom\"", "\"20 angstom\""), "9:9", {"angstom", "did you mean 'angstrom'?"}},
    {"unit without a number", with("\"0.01 eV\"", "\"eV\""), "29:9", {"depth"}},
    {"time in lengths", with("step = 0.01", "step = \"0.01 nm\""), "12:8", {"length", "time"}},
    {"unit in a reduced base",
     with("base = \"custom\"\nlength = \"1 angstrom\"\nmass = \"1 amu\"\ntime = \"1 ps\"\n", "base = \"reduced\"\n",
          with("mass = \"40 amu\"", "mass = 40", with("\"0.01 eV\"", "1"))),
     "6:9",
     {"20 angstrom"}},
    {"unknown base",
     with("base = \"custom\"", "base = \"costum\""),
     "3:8",
     {"unknown base 'costum'", "lennard-jones", "did you mean 'custom'?"}},
    {"base without its time", with("time = \"1 ps\"\n", ""), "2:1", {"no 'time'"}},
    {"base of length zero", with("\"1 angstrom\"", "\"0 angstrom\""), "2:1", {"positive"}},
    // Ranges.
    {"negative steps", with("steps = 20", "steps = -1"), "13:9", {"-1", "zero or more"}},
    {"zero step", with("step = 0.01", "step = 0"), "12:8", {"step", "positive"}},
    {"step is not a number", with("step = 0.01", "step = nan"), "12:8", {"finite"}},
    {"infinite step", with("step = 0.01", "step = inf"), "12:8", {"finite"}},
    {"negative seed", with("cutoff = 6", "cutoff = 6\nseed = -3"), "15:8", {"seed", "-3", "zero or more"}},
    {"negative cut-off", with("cutoff = 6", "cutoff = -6"), "14:10", {"cutoff", "positive"}},
    {"endless skin", with("cutoff = 6", "cutoff = 6\nskin = 1e16"), "15:8", {"skin 1e+16", "4 cut-offs of 6"}},
    {"massless", with("mass = \"40 amu\"", "mass = 0"), "19:8", {"mass", "positive"}},
    {"range of a parameter", with("r0 = 4", "r0 = -4"), "28:6", {"r0", "-4", "positive"}},
    {"too many", load("{ kind = \"random\" }\nnumber = 2000000000"), "21:10", {"2000000000", "GiB", "1000000000"}},
    {"a block longer than its periodic axis",
     load("{ kind = \"block\", lattice = \"square\", spacing = 4, counts = [6, 4] }"),
     "20:68",
     {"the block is 24 angstrom long along x, the periodic axis 20 angstrom", "overlap"}},
    {"too many sites",
     load("{ kind = \"block\", lattice = \"square\", spacing = 4, counts = [1000000, 1000000] }"),
     "20:8",
     {"1000000000000 particles", "GiB"}},
    {"no particles", load("{ kind = \"random\" }\nnumber = -1"), "21:10", {"number", "zero or more"}},
    {"negative temperature",
     with("colour = \"red\"", "temperature = \"-3 K\""),
     "21:15",
     {"temperature", "zero or more"}},
    {"negative interval", with("diagnoses = 5", "diagnoses = -5"), "33:13", {"-5", "zero or more"}},
    // Words.
    {"law that could be typed",
     with("lennard-jones", "yukawa"),
     "26:7",
     {"unknown law 'yukawa'", "write it as a formula: [[influences]] with energy"}},
    {"no cut-off", with("cutoff = 6\n", ""), "24:1", {"axis x is periodic", "of at most 20 angstrom"}},
    {"unknown law",
     with("law = \"lennard-jones\"", "law = \"lennard-jons\""),
     "26:7",
     {"unknown law 'lennard-jons'", "morse", "did you mean 'lennard-jones'?"}},
    {"unknown class",
     with("class = \"Newton\"", "class = \"Newtn\""),
     "17:9",
     {"unknown class 'Newtn'", "Coulomb", "did you mean 'Newton'?"}},
    {"unknown integrator",
     with("\"leap-frog\"", "\"leapfrog\""),
     "18:14",
     {"unknown integrator 'leapfrog'", "rk4", "did you mean 'leap-frog'?"}},
    {"unknown loader", load("{ kind = \"blck\" }"), "20:17", {"'blck'", "random", "did you mean 'block'?"}},
    {"unknown lattice",
     load("{ kind = \"block\", lattice = \"square2\", spacing = 4, counts = [4, 4] }"),
     "20:36",
     {"unknown lattice", "triangular", "did you mean 'square'?"}},
    {"unknown diagnosis",
     with("\"energies\"", "\"energy\""),
     "31:8",
     {"unknown diagnosis 'energy'", "temperature", "did you mean 'energies'?"}},
    {"unknown colour", with("\"red\"", "\"rad\""), "21:10", {"rad", "red"}},
    {"unknown colour of a picture", with("\"speed\"", "\"sped\""), "35:10", {"sped", "did you mean 'speed'?"}},
    {"unknown boundary",
     with("\"periodic\"", "\"periodical\""),
     "10:12",
     {"unknown boundary 'periodical'", "reflecting", "did you mean 'periodic'?"}},
    {"unknown ensemble",
     with("on = \"atoms\"", "on = \"atom\""),
     "27:6",
     {"no ensemble 'atom'", "did you mean 'atoms'?"}},
    {"unknown drawing",
     with("colour = \"speed\"", "drawing = \"cartesean\""),
     "35:11",
     {"unknown drawing", "phase-space", "did you mean 'cartesian'?"}},
    {"unknown column",
     with("colour = \"speed\"", "drawing = \"time-series\"\ny = \"kinetic enrgy\""),
     "36:5",
     {"kinetic enrgy", "did you mean 'kinetic energy'?"}},
    {"unknown kind of picture", with("picture.png", "picture.gif"), "36:8", {"picture.gif", ".svg"}},
    // Pictures.
    {"tracks without a trajectory", with("colour = \"speed\"", "trace = true"), "35:9", {"trace", "trajectory = 10"}},
    {"spectrum over a velocity",
     with("colour = \"speed\"", "drawing = \"spectrum\"\nx = \"velocity.x\""),
     "36:5",
     {"position.x", "time", "'velocity.x'"}},
    {"unknown x of a picture",
     with("colour = \"speed\"", "drawing = \"phase-space\"\nx = \"potision.x\"\ny = \"velocity.x\""),
     "36:5",
     {"'potision.x'", "did you mean 'position.x'?"}},
    {"picture of what an unknown diagnosis records",
     with("colour = \"speed\"", "drawing = \"time-series\"\ny = \"kinetic energy\"",
          with("\"energies\"", "\"energy\"")),
     "31:8",
     {"unknown diagnosis 'energy'"}},
    // Names.
    {"two ensembles of one name",
     plus("[[ensembles]]\nname = \"atoms\"\nclass = \"Newton\"\n"
          "load = { kind = \"positions\", positions = [[1, 1]] }\n"),
     "38:8",
     {"'atoms' already", "line 15"}},
    {"two columns of one name", plus("[[diagnoses]]\nkind = \"energies\"\n"), "38:8", {"column", "kinetic energy"}},
    {"two pictures of one name",
     plus("[[output.pictures]]\nfile = \"picture.png\"\n"),
     "38:8",
     {"'picture.png' already"}},
    {"on whom", with("on = \"atoms\"\n", ""), "25:1", {"does not name its ensembles", "between", "by"}},
    {"on and between",
     with("on = \"atoms\"", "on = \"atoms\"\nbetween = [\"atoms\", \"atoms\"]"),
     "28:11",
     {"needs 'on', or 'on' and 'by', or 'between'"}},
    {"by without on",
     with("on = \"atoms\"", "by = \"atoms\""),
     "27:6",
     {"by: it names the ensemble that acts", "'on'"}},
    {"by itself", with("on = \"atoms\"", "on = \"atoms\"\nby = \"atoms\""), "28:6", {"twice", "on = \"atoms\""}},
    {"one way as before", with("on = \"atoms\"", "one_way = [\"atoms\", \"atoms\"]"), "27:1", {"it is 'by' now"}},
    {"a boundary as before",
     with("\"periodic\"", "\"bounded\""),
     "10:12",
     {"unknown boundary 'bounded'", "it is 'reflecting' now"}},
    {"friction as before",
     plus("[[flows]]\nkind = \"dissipative\"\n"),
     "37:3",
     {"unknown key 'flows'", "it is 'dissipation' now"}},
    {"between one", with("on = \"atoms\"", "between = [\"atoms\"]"), "27:11", {"two ensembles", "of 1"}},
    {"between itself",
     with("on = \"atoms\"", "between = [\"atoms\", \"atoms\"]"),
     "27:21",
     {"twice", "on = \"atoms\""}},
    // Shapes.
    {"three lengths in two dimensions",
     with("velocity = [0.1, 0.2]", "velocity = [0.1, 0.2, 0.3]"),
     "24:12",
     {"velocity", "3 components", "2 are needed"}},
    {"edges of different dimension", with("low = [0, 0]", "low = [0, 0, 0]"), "9:8", {"high", "2 components", "3"}},
    {"four dimensions", with("low = [0, 0]", "low = [0, 0, 0, 0]"), "8:7", {"1, 2 or 3"}},
    {"counts of another dimension",
     load("{ kind = \"block\", lattice = \"square\", spacing = 4, counts = [4] }"),
     "20:68",
     {"counts", "array of 2", "of 1"}},
    {"one value for each, but not for all",
     with("mass = \"40 amu\"", "mass = [1, 2, 3]"),
     "19:8",
     {"3 values for 16 particles", "one for each"}},
    {"boundaries of another dimension",
     with("\"periodic\"", "[\"periodic\", \"open\", \"open\"]"),
     "10:12",
     {"3 words for 2 axes"}},
    {"upside down", with("low = [0, 0]", "low = [30, 0]"), "9:8", {"low edge 30"}},
    {"an empty list",
     with("title = \"a test\"", "ensembles = []", good.substr(0, good.find("[[ensembles]]"))),
     "1:13",
     {"no [[ensembles]]"}},
    {"class in another dimension",
     "[box]\nlow = [0]\nhigh = [1]\n[run]\nstep = 1\nsteps = 1\n[[ensembles]]\nname = \"v\"\nclass = \"Vortex\"\n"
     "load = { kind = \"positions\", positions = [[0.5]] }\n",
     "9:9",
     {"Vortex", "2D or 3D", "1 dimension"}},
    {"lattice in another dimension",
     load("{ kind = \"block\", lattice = \"fcc\", spacing = 1, counts = [2, 2] }"),
     "20:8",
     {"fcc", "3D"}},
    {"number and places differ", with("mass = \"40 amu\"", "mass = 40\nnumber = 15"), "20:10", {"15", "16"}},
    {"random without a number", load("{ kind = \"random\" }"), "20:8", {"needs 'number'"}},
    // The box.
    {"cut-off longer than a periodic axis",
     with("cutoff = 6", "cutoff = 21"),
     "14:10",
     {"21", "periodic axis x", "20"}},
    {"a law's cut-off longer than a periodic axis",
     with("r0 = 4", "r0 = 4\ncutoff = 30"),
     "29:10",
     {"30", "periodic axis x"}},
    {"no cut-off on a periodic axis", with("cutoff = 6\n", ""), "24:1", {"periodic", "cut-off", "20"}},
    {"outside a reflecting box",
     with("\"periodic\"", "\"reflecting\"", with("origin = [2, 2]", "origin = [12, 2]")),
     "20:8",
     {"particle 3 of 'atoms' is outside the box"}},
    {"inside a region that keeps out",
     with("[run]", "[[box.regions]]\nlow = [1, 1]\nhigh = [3, 3]\nside = \"keep-out\"\n[run]"),
     "24:8",
     {"particle 0", "keeps particles out"}},
    {"region without a side",
     with("[run]", "[[box.regions]]\nlow = [1, 1]\nhigh = [1.5, 3]\n[run]"),
     "11:1",
     {"'side'"}},
    {"random nowhere", load("{ kind = \"random\", where = \"x < 0\" }\nnumber = 5"), "20:8", {"'where'", "particle 0"}},
    {"random in a block that is none",
     load("{ kind = \"random\", low = [5, 5], high = [4, 9] }\nnumber = 5"),
     "20:48",
     {"high: 4 must be above 5 along x"}},
    {"too full", load("{ kind = \"random\", minimum_distance = 10 }\nnumber = 100"), "20:8", {"100"}},
    {"two particles at one place",
     load("{ kind = \"positions\", positions = [[1, 1], [5, 5], [1, 1], [9, 9]] }"),
     "20:8",
     {"particle 0", "particle 2", "same place"}},
    // What does not go together.
    {"a law that needs a charge",
     with("law = \"lennard-jones\"", "law = \"coulomb\"", with("r0 = 4\ndepth = \"0.01 eV\"\n", "")),
     "26:7",
     {"law 'coulomb' needs a charge; class Newton has none; classes with one: Coulomb"}},
    {"a force on vortices",
     plus(vortices + "[[influences]]\nlaw = \"spring\"\nstiffness = 1\non = \"vortices\"\n"),
     "43:7",
     {"'spring' gives a force", "Vortex", "flow"}},
    {"a flow on atoms",
     plus("[[influences]]\nlaw = \"uniform-flow\"\nvelocity = [1, 0]\non = \"atoms\"\n"),
     "38:7",
     {"'uniform-flow'", "Newton", "forces"}},
    {"a law of another space",
     plus("[[influences]]\nlaw = \"pendulum-gravity\"\nacceleration = 1\non = \"atoms\"\n"),
     "38:7",
     {"1D only", "is 2D"}},
    {"leap-frog for vortices",
     plus(with("class = \"Vortex\"", "class = \"Vortex\"\nintegrator = \"leap-frog\"", vortices)),
     "40:14",
     {"Vortex", "no velocity", "rk4"}},
    {"random walk of atoms", with("\"leap-frog\"", "\"random-walk\""), "18:14", {"no viscosity"}},
    {"external law between",
     plus("[[influences]]\nlaw = \"drag\"\nfriction = 1\non = \"atoms\"\nbetween = 3\n"),
     "41:1",
     {"unknown key 'between'"}},
    {"external law on nobody", plus("[[influences]]\nlaw = \"drag\"\nfriction = 1\n"), "37:1", {"'drag'", "on = "}},
    {"velocity and temperature",
     with("colour = \"red\"", "temperature = \"300 K\"\nvelocity = [0, 0]"),
     "22:12",
     {"'temperature' gives the velocities", "drift"}},
    {"positions as a field", with("colour = \"red\"", "position = [1, 1]"), "21:1", {"positions are loaded", "load"}},
    // Particles by number.
    {"no such particle", with("particles = [3]", "particles = [16]"), "23:14", {"no particle 16", "0 to 15"}},
    {"particles by a word",
     with("particles = [3]", "particles = \"edges\""),
     "23:13",
     {"'edges'", "did you mean 'edge'?"}},
    {"edge without margin", with("particles = [3]", "particles = \"edge\""), "23:13", {"margin"}},
    {"set on nobody", with("particles = [3]\n", ""), "22:1", {"no 'particles'"}},
    {"connection out of range",
     with("r0 = 4", "r0 = 4\nconnect = [[0, 16, 1]]"),
     "29:12",
     {"no particle 16", "0 to 15"}},
    {"connection backwards", with("r0 = 4", "r0 = 4\nconnect = [[9, 3, 1]]"), "29:12", {"9 back to 3"}},
    {"connection without interval", with("r0 = 4", "r0 = 4\nconnect = [[3, 9, 0]]"), "29:19", {"connect", "1"}},
    {"connection of one number", with("r0 = 4", "r0 = 4\nconnect = [3, 9]"), "29:12", {"[[first, last, interval]]"}},
    {"file that is not there", load("{ kind = \"file\", path = \"no/such.xyz\" }"), "20:32", {"no/such.xyz"}},
    // The command line.
    {"override of a wrong value", good, "--set run.step=-1", {"step", "-1", "positive"}, set("run.step=-1")},
    {"override of an unknown key",
     good,
     "--set run.stpe=1",
     {"unknown key 'stpe'", "did you mean 'step'?"},
     set("run.stpe=1")},
    {"override without a value", good, "--set run.step", {"key=value"}, set("run.step")},
    {"override of an unknown ensemble",
     good,
     "--set ensembles.atom.mass=1",
     {"no 'atom'", "did you mean 'atoms'?"},
     set("ensembles.atom.mass=1")},
    {"override of an ensemble out of range", good, "--set ensembles.1.mass=1", {"no '1'"}, set("ensembles.1.mass=1")},
    {"override into a number", good, "--set run.step.x=1", {"run.step", "no 'x'"}, set("run.step.x=1")},
    {"override with a wrong unit",
     good,
     "--set ensembles.0.mass=3 nm",
     {"length", "mass"},
     set("ensembles.0.mass=3 nm")},
    {"negative steps on the command line", good, "--steps=-5", {"steps", "zero or more"}, {{}, -5, {}, {}}},
};

// Mistakes around a mesh. One mistake is one line: what would have looked at the mesh says nothing more.
std::vector<Mistake> const mesh_rows{
    {"mesh without a law", plasma_with("law = \"coulomb\"\n", ""), "10:1", {"[mesh] has no 'law'", "coulomb"}},
    {"mesh with an unknown law",
     plasma_with("\"coulomb\"", "\"columb\""),
     "11:7",
     {"unknown law 'columb'", "gravity", "did you mean 'coulomb'?"}},
    {"mesh with the law of atoms", plasma_with("\"coulomb\"", "\"morse\""), "11:7", {"'morse'", "coulomb, gravity"}},
    {"mesh without k", plasma_with("k = 0.08\n", ""), "10:1", {"'coulomb' needs 'k'", "k = 1"}},
    {"mesh with a negative k", plasma_with("k = 0.08", "k = -1"), "12:5", {"k: -1", "positive"}},
    {"mesh with a softening",
     plasma_with("k = 0.08", "k = 0.08\nsoftening = 1"),
     "13:1",
     {"unknown key 'softening' in [mesh]", "cells"}},
    {"unknown key of a mesh",
     plasma_with("precision = \"full\"", "precison = \"full\""),
     "18:1",
     {"unknown key 'precison' in [mesh]", "did you mean 'precision'?"}},
    {"mesh without cells", plasma_with("cells = [8, 8]\n", ""), "10:1", {"[mesh] has no 'cells'", "cells = 64"}},
    {"cells as a text", cells("\"64\""), "13:9", {"cells", "whole number", "'64'"}},
    {"cells with a fraction", cells("64.5"), "13:9", {"cells", "whole number", "64.5"}},
    {"no cells", cells("0"), "13:9", {"cells: 0", "between 1"}},
    {"no cells on one axis", cells("[8, 0]"), "13:13", {"cells: 0", "between 1"}},
    {"cells of another dimension", cells("[8, 8, 8]"), "13:9", {"3 numbers for 2 axes", "one for all"}},
    {"cells beyond the memory", cells("1000000000"), "13:9", {"1e+18 nodes", "GiB", "this machine has"}},
    {"cells beyond the memory in 3D",
     in_space("cells = 8\n", "cells = 100000\n"),
     "13:9",
     {"1e+15 nodes", "GiB", "this machine has"}},
    {"unknown assignment",
     plasma_with("\"cic\"", "\"tcs\""),
     "14:14",
     {"unknown assignment 'tcs'", "ngp, cic, tsc", "did you mean 'tsc'?"}},
    {"assignment as a number", plasma_with("\"cic\"", "2"), "14:14", {"assignment: a text", "2"}},
    {"unknown poisson",
     plasma_with("\"spectral\"", "\"spectrl\""),
     "15:11",
     {"unknown poisson 'spectrl'", "finite-difference", "did you mean 'spectral'?"}},
    {"unknown boundary of a field",
     field_boundary("\"peroidic\""),
     "16:12",
     {"unknown boundary 'peroidic'", "dirichlet", "did you mean 'periodic'?"}},
    {"open field in a periodic box",
     field_boundary("\"open\""),
     "16:12",
     {"axis x of the box is periodic", "not open"}},
    {"one end periodic", field_boundary("[[\"periodic\", \"open\"], \"periodic\"]"), "16:13", {"axis x", "periodic"}},
    {"one end of a field", field_boundary("[[\"periodic\"], \"periodic\"]"), "16:13", {"two ends", "[low, high]"}},
    {"boundaries of a field in another dimension",
     field_boundary("[\"periodic\"]"),
     "16:12",
     {"2 axes", "an array of 1"}},
    {"boundary of a field as a number", field_boundary("3"), "16:12", {"boundary", "word", "3"}},
    {"background as a text",
     plasma_with("background = true", "background = \"yes\""),
     "17:14",
     {"true or false", "'yes'"}},
    {"not neutral",
     plasma_with("background = true", "background = false"),
     "17:14",
     {"sum to -64", "periodic", "background = true"}},
    {"not neutral without the key",
     plasma_with("background = true\n", ""),
     "10:1",
     {"sum to -64", "background = true"}},
    {"unknown precision",
     plasma_with("\"full\"", "\"singel\""),
     "18:13",
     {"unknown precision 'singel'", "full, single", "did you mean 'single'?"}},
    {"mesh on nobody", plasma_with("on = \"electrons\"\n[[e", "on = []\n[[e"), "19:6", {"on: no ensemble"}},
    {"mesh on a stranger",
     plasma_with("on = \"electrons\"\n[[e", "on = \"electron\"\n[[e"),
     "19:6",
     {"no ensemble 'electron'", "did you mean 'electrons'?"}},
    {"mesh twice on one",
     plasma_with("on = \"electrons\"\n[[e", "on = [\"electrons\", \"electrons\"]\n[[e"),
     "19:20",
     {"'electrons' twice"}},
    {"mesh on a class without charge",
     with("charge = -1\n", "", with("\"Coulomb\"", "\"Newton\"", plasma_with(magnet, ""))),
     "19:6",
     {"'electrons' is of class Newton", "'coulomb' does not act on", "Coulomb"}},
    {"mesh for nobody",
     with("charge = -1\n", "",
          with("\"Coulomb\"", "\"Newton\"", with("on = \"electrons\"\n[[e", "[[e", plasma_with(magnet, "")))),
     "10:1",
     {"no ensemble makes a field", "Coulomb"}},
    {"charges on a mesh of gravity",
     plasma_with("law = \"coulomb\"\nk", "law = \"gravity\"\nG"),
     "19:6",
     {"class Coulomb", "'gravity' does not act on", "law = \"coulomb\"", "Kepler"}},
    {"accuracy as a text", accuracy("\"high\""), "14:12", {"accuracy", "'high'"}},
    {"too low an accuracy", accuracy("0.5"), "14:12", {"0.5", "between 1e-10 and 0.1"}},
    {"negative accuracy", accuracy("-1e-4"), "14:12", {"accuracy: -0.0001", "positive"}},
    {"accuracy and cells", accuracy("1e-3\ncells = 8"), "15:9", {"cells: with 'accuracy' it is chosen"}},
    {"no mesh", plasma_with(mesh_table, ""), "24:8", {"'field-energy' needs a mesh", "no [mesh]"}},
    {"a list of meshes", plasma_with("[mesh]", "[[mesh]]"), "10:1", {"mesh: a table is needed, [mesh]"}},
    {"a mesh among regions",
     with("{ kind = \"sinusoidal\", mode = 1, amplitude = 0.1, quiet = true }", "{ kind = \"random\" }",
          plasma_with("[run]", "[[box.regions]]\nlow = [1, 1]\nhigh = [2, 2]\nside = \"keep-out\"\n[run]")),
     "17:9",
     {"the box has regions"}},
    // Loads.
    {"unknown load of a plasma",
     plasma_load("{ kind = \"sinusoid\" }"),
     "25:17",
     {"'sinusoid'", "did you mean 'sinusoidal'?"}},
    {"quiet load with a wave", plasma_load("{ kind = \"quiet\", mode = 1 }"), "25:26", {"unknown key 'mode' in load"}},
    {"ripple without an amplitude", plasma_load("{ kind = \"sinusoidal\", mode = 1 }"), "25:8", {"no 'amplitude'"}},
    {"ripple without a wave",
     plasma_load("{ kind = \"sinusoidal\", amplitude = 0.1 }"),
     "25:8",
     {"'mode'", "'wave_number'"}},
    {"ripple with two waves",
     plasma_load("{ kind = \"sinusoidal\", mode = 1, wave_number = 1, amplitude = 0.1 }"),
     "25:55",
     {"'mode'", "'wave_number'", "one of them"}},
    {"ripple of no period",
     plasma_load("{ kind = \"sinusoidal\", mode = 0, amplitude = 0.1 }"),
     "25:38",
     {"mode: 0", "1 or more"}},
    {"ripple of no wave number",
     plasma_load("{ kind = \"sinusoidal\", wave_number = 0, amplitude = 0.1 }"),
     "25:45",
     {"wave_number: 0", "positive"}},
    {"ripple of half a period",
     plasma_load("{ kind = \"sinusoidal\", mode = 1.5, amplitude = 0.1 }"),
     "25:38",
     {"mode", "whole number", "1.5"}},
    {"ripple above one",
     plasma_load("{ kind = \"sinusoidal\", mode = 1, amplitude = 1.5 }"),
     "25:53",
     {"amplitude: 1.5", "between -1 and 1"}},
    {"ripple along no axis",
     plasma_load("{ kind = \"sinusoidal\", axis = \"z\", mode = 1, amplitude = 0.1 }"),
     "25:38",
     {"unknown axis 'z'", "x, y"}},
    {"quiet ripple as a number",
     plasma_load("{ kind = \"sinusoidal\", mode = 1, amplitude = 0.1, quiet = 1 }"),
     "25:66",
     {"quiet: true or false"}},
    {"quiet load without a number", plasma_with("number = 64\n", ""), "24:8", {"load \"sinusoidal\" needs 'number'"}},
    {"quiet velocities without a temperature",
     plasma_with("temperature = 0.1\n", ""),
     "26:9",
     {"quiet: it belongs to 'temperature'"}},
    {"velocity ripple as a number",
     plasma_with("{ axis = \"y\", mode = 1, amplitude = 0.1, component = \"x\" }", "3"),
     "28:19",
     {"velocity_ripple: a table is needed", "3"}},
    {"velocity ripple with a unit",
     plasma_with("0.1, component", "\"0.1 m\", component"),
     "28:55",
     {"amplitude", "length", "velocity"}},
    {"velocity ripple of no component",
     plasma_with("component = \"x\"", "component = \"z\""),
     "28:72",
     {"unknown component 'z'", "x, y"}},
    {"unknown key of a velocity ripple",
     plasma_with("component = \"x\"", "componet = \"x\""),
     "28:60",
     {"unknown key 'componet' in velocity_ripple", "did you mean 'component'?"}},
    // The magnetic field.
    {"magnetic field without a field", plasma_with("field = 0.5\n", ""), "29:1", {"needs 'field'", "in 2D one number"}},
    {"magnetic field in the plane",
     plasma_with("field = 0.5", "field = [0, 0, 1]"),
     "32:9",
     {"3 components", "1 is needed"}},
    {"magnetic field as a number in 3D",
     in_space("field = [0, 0, 0.5]", "field = 0.5"),
     "32:9",
     {"array of 3 numbers", "0.5"}},
    {"magnetic field on the reversible leap-frog",
     plasma_with("number = 64", "integrator = \"reversible-leap-frog\"\nnumber = 64"),
     "26:8",
     {"reversible", "velocities", "use leap-frog"}},
    {"pressure of a mesh whose field continues beyond its ends",
     test::replaced(
         test::replaced(plasma_with("\"field-energy\"", "\"field-energy\"\n[[diagnoses]]\nkind = \"pressure\""),
                        "boundary = \"periodic\"\n", "boundary = [\"periodic\", \"open\"]\n"),
         "boundary = \"periodic\" # field\n", "\n"),
     "35:1",
     {"'pressure' needs the virial", "axis y is not periodic"}},
    // Diagnoses.
    {"unknown diagnosis of a mesh",
     plasma_with("\"field-energy\"", "\"field-enery\""),
     "34:8",
     {"unknown diagnosis 'field-enery'", "did you mean 'field-energy'?"}},
    {"field energy of an ensemble",
     plasma_with("\"field-energy\"", "\"field-energy\"\nensembles = \"electrons\""),
     "35:1",
     {"unknown key 'ensembles'", "'field-energy'"}},
    {"mode without a mode", plasma_with("mode = [1, 0]\n", ""), "35:1", {"no 'mode'", "mode = [3]"}},
    {"mode of another dimension", plasma_with("mode = [1, 0]", "mode = 1"), "37:8", {"1 number", "2 axes"}},
    {"mode with a fraction", plasma_with("mode = [1, 0]", "mode = [1.5, 0]"), "37:9", {"mode", "whole number"}},
    {"mode beyond the mesh",
     plasma_with("mode = [1, 0]", "mode = [5, 0]"),
     "37:8",
     {"mode 5 along x", "8 nodes", "up to 4"}},
    {"unknown quantity of a mode",
     plasma_with("\"field.y\"", "\"field.z\""),
     "38:12",
     {"no 'field.z'", "density, potential, field.x, field.y"}},
    {"waves along no axis", plasma_with("axis = \"x\"", "axis = \"z\""), "42:8", {"unknown axis 'z'"}},
    {"no waves", plasma_with("modes = 3", "modes = 0"), "43:9", {"modes: 0", "1 or more"}},
    {"unknown quantity of waves",
     plasma_with("\"field.x\"", "\"feld.x\""),
     "41:12",
     {"'feld.x'", "did you mean 'field.x'?"}},
    // Frames and pictures.
    {"mesh frames as a text", plasma_with("mesh = 10", "mesh = \"all\""), "46:8", {"mesh: a whole number", "'all'"}},
    {"negative interval of mesh frames", plasma_with("mesh = 10", "mesh = -1"), "46:8", {"-1", "zero or more"}},
    {"unknown quantity of a mesh picture",
     plasma_with("\"potential\"", "\"potental\""),
     "49:5",
     {"no 'potental'", "did you mean 'potential'?"}},
    {"mesh picture of particles",
     plasma_with("y = \"potential\"", "colour = \"speed\""),
     "49:1",
     {"unknown key 'colour' in [[output.pictures]] 'mesh'", "slice"}},
    {"slice of a plane", plasma_with("y = \"potential\"", "slice = \"x\""), "49:9", {"slice", "3D", "2D"}},
    {"slice along no axis", in_space("y = \"potential\"", "slice = \"w\""), "49:9", {"unknown slice 'w'", "x, y, z"}},
    {"slice outside the box", in_space("y = \"potential\"", "at = 9"), "49:6", {"at: 9", "from 0 to 8 along z"}},
    {"ends of a mesh picture with a unit",
     plasma_with("y = \"potential\"", "low = \"1 m\""),
     "49:7",
     {"low", "length", "electric potential"}},
    {"waves that nobody records",
     with("[[diagnoses]]\nkind = \"wave-spectrum\"\nquantity = \"field.x\"\naxis = \"x\"\nmodes = 3\n", "", plasma),
     "45:1",
     {"needs the diagnosis wave-spectrum"}},
    {"waves of another quantity",
     plasma_with("curve =", "y = \"density\"\ncurve ="),
     "52:5",
     {"'density'", "recorded is field.x"}},
    {"curve as a number", plasma_with("{ frequency = 1, speed = 1 }", "1"), "52:9", {"curve: a table is needed", "1"}},
    {"curve of nothing", plasma_with("{ frequency = 1, speed = 1 }", "{}"), "52:9", {"it may have frequency, speed"}},
    {"unknown key of a curve",
     plasma_with("{ frequency = 1, speed = 1 }", "{ frequenzy = 1 }"),
     "52:11",
     {"unknown key 'frequenzy' in curve", "did you mean 'frequency'?"}},
    {"logarithmic as a text",
     plasma_with("logarithmic = true", "logarithmic = \"yes\""),
     "57:15",
     {"logarithmic: true or false"}},
    {"logarithmic mesh",
     plasma_with("y = \"potential\"", "logarithmic = true"),
     "49:1",
     {"unknown key 'logarithmic' in [[output.pictures]] 'mesh'"}},
    {"diagnoses that are never taken",
     with("drawing = \"wave-spectrum\"\ncurve = { frequency = 1, speed = 1 }\n", "",
          plasma_with("diagnoses = 5", "diagnoses = 0")),
     "53:11",
     {"'time-series'", "diagnoses = 0"}},
};

TEST(Mistakes, TheGoodScenarioHasNone) {
  for (auto const& line : mistakes_of(good)) ADD_FAILURE() << line;
}

TEST(Mistakes, TheGoodPlasmaHasNone) {
  for (auto const& line : mistakes_of(plasma)) ADD_FAILURE() << line;
  for (auto const& line : mistakes_of(in_space("y = \"potential\"", "slice = \"x\"\nat = 2\nlow = -1\nhigh = 1")))
    ADD_FAILURE() << line;
  for (auto const& line : mistakes_of(accuracy("1e-3"))) ADD_FAILURE() << line;
}

TEST(Mistakes, SeveralOfAMeshAreTold) {
  std::string text = with("\"cic\"", "\"cci\"", plasma);    // 14:14
  text = with("\"sinusoidal\"", "\"sinusoid\"", text);      // 25:17
  text = with("mode = [1, 0]", "mode = [\"a\", 0]", text);  // 37:9
  text = with("frequency = 1", "frequenzy = 1", text);      // 52:11
  auto const lines = mistakes_of(text);
  ASSERT_EQ(lines.size(), 4U) << testing::PrintToString(lines);
  std::vector<std::string> const places{"14:14", "25:17", "37:9", "52:11"};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(lines[i].find("test.toml:" + places[i] + ": "), 0U) << lines[i];
}

TEST(Mistakes, ParticlesOutsideAnOpenMeshAreTold) {
  std::string text =
      with("boundary = \"periodic\"\n", "boundary = \"open\"\n", plasma.substr(0, plasma.find("[[influences]]")));
  text = with("\"periodic\" # field", "\"open\"", text);
  text = with("number = 64\n", "", text);
  text = with("{ kind = \"sinusoidal\", mode = 1, amplitude = 0.1, quiet = true }",
              "{ kind = \"positions\", positions = [[4, 4], [9, 4]] }", text);
  for (std::string const more : {"", "[[diagnoses]]\nkind = \"field-energy\"\n"}) {
    auto const lines = mistakes_of(text + more);
    ASSERT_EQ(lines.size(), 1U) << testing::PrintToString(lines);
    EXPECT_EQ(lines[0],
              "test.toml:24:8: particle 1 of 'electrons' is outside the mesh: x = 9, the box goes from 0 to 8");
  }
}

TEST(Mistakes, TheGoodScenarioWithVorticesHasNone) {
  for (auto const& line : mistakes_of(good + vortices)) ADD_FAILURE() << line;
}

class MistakesTable : public testing::TestWithParam<Mistake> {};

TEST_P(MistakesTable, IsToldInOneLine) { test::expect_one_line(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Scenario, MistakesTable, testing::ValuesIn(rows), mistake_name);
INSTANTIATE_TEST_SUITE_P(Mesh, MistakesTable, testing::ValuesIn(mesh_rows), mistake_name);

TEST(Mistakes, AreAllToldInTheOrderOfTheFile) {
  std::string text = with("base = \"custom\"", "base = \"custom\"\nlenght = 1");  // 4:1
  text = with("step = 0.01", "step = -1", text);                                  // 13:8
  text = with("class = \"Newton\"", "class = \"Newtn\"", text);                   // 18:9
  text = with("law = \"lennard-jones\"", "law = \"lennard\"", text);              // 27:7
  text = with("kind = \"energies\"", "kind = \"energy\"", text);                  // 32:8
  auto const lines = mistakes_of(text);
  ASSERT_EQ(lines.size(), 5U) << testing::PrintToString(lines);
  std::vector<std::string> const places{"4:1", "13:8", "18:9", "27:7", "32:8"};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(lines[i].find("test.toml:" + places[i] + ": "), 0U) << lines[i];
  try {
    parse_scenario(text, "test.toml");
    FAIL();
  } catch (Error const& error) {
    EXPECT_EQ(std::count(error.what(), error.what() + std::string(error.what()).size(), '\n'), 4);
  }
}

// Whatever is missing or cut off: mistakes in one go, nothing else.
TEST(Mistakes, OfAnyMissingLineAreTold) { test::expect_mistakes_of_what_is_missing(good + vortices, 500, 10); }

TEST(Mistakes, OfTheFileSystem) {
  auto const message = [](std::string const& path) -> std::string {
    try {
      load_scenario(path);
    } catch (Error const& error) {
      return error.what();
    }
    return "";
  };
  std::string const folder = testing::TempDir();
  EXPECT_NE(message(folder).find("is a directory"), std::string::npos);
  EXPECT_NE(message(folder + "/no-such-file.toml").find("No such file"), std::string::npos);
  try {
    find_scenario("coper");
    FAIL();
  } catch (Error const& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'copper'?"), std::string::npos) << error.what();
  }
  EXPECT_THROW(find_scenario(""), Error);
  EXPECT_THROW(find_scenario(folder), Error);
  // Paths of other files are relative to the scenario.
  std::string const path = folder + "/boltzmann_mistakes_test.toml";
  std::ofstream(path) << load("{ kind = \"file\", path = \"boltzmann_mistakes_test.xyz\" }");
  std::ofstream(folder + "/boltzmann_mistakes_test.xyz") << "4\n\nCu 1 1 0\nCu 5 1 0\nCu 9 1 0\nCu 13 1 0\n";
  auto const scenario = load_scenario(path);
  EXPECT_EQ(scenario->ensembles[0]->size(), 4U);
  EXPECT_EQ(scenario->ensembles[0]->row(2)[0], 9);
  EXPECT_EQ(parse_scenario(scenario->resolved, "elsewhere.toml")->ensembles[0]->size(), 4U);
  // A species that the file lacks.
  std::ofstream(path) << load("{ kind = \"file\", path = \"boltzmann_mistakes_test.xyz\", species = \"Ag\" }");
  EXPECT_NE(message(path).find("the file has no particle of species 'Ag'; it has Cu"), std::string::npos);
  // A lattice that is not the box.
  std::ofstream(path) << load("{ kind = \"file\", path = \"boltzmann_mistakes_test.xyz\" }");
  std::ofstream(folder + "/boltzmann_mistakes_test.xyz") << "2\nLattice=\"19 0 0 0 20 0 0 0 1\"\nCu 1 1 0\nCu 5 1 0\n";
  EXPECT_NE(message(path).find("path: the file's lattice is 19 angstrom long along x, the periodic box 20"),
            std::string::npos)
      << message(path);
  std::filesystem::remove(path);
  std::filesystem::remove(folder + "/boltzmann_mistakes_test.xyz");
}

}  // namespace
}  // namespace boltzmann::mistakes_test
