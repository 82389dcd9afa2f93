// bzm new: writes a small scenario with a comment on every line that users often change.
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/scenario/schema.hpp>

#include <fmt/format.h>

#include <filesystem>

namespace boltzmann::bzm {
namespace {

// Argon at 2/3 of the triple-point density, in two dimensions.
constexpr char const* starter = R"toml(#:schema ./boltzmann.schema.json
# A scenario of Boltzmann. Change what you like, then
#   bzm check @name.toml    lists all mistakes without running
#   bzm run @name.toml      writes results to results/@name
# `bzm list` shows all classes, laws, integrators and diagnoses; `bzm show lennard-jones` explains one.

title = "A gas of argon atoms"

[units]                       # units of plain numbers and of results
base = "custom"               # or si, cgs, reduced (no units), lennard-jones, gravitational, plasma
length = "1 angstrom"
mass = "1 amu"
time = "1 ps"

[box]
low = [0, 0]                  # as many numbers as the space has dimensions
high = ["80 angstrom", "80 angstrom"]
boundary = "periodic"         # or "open", "reflecting", "mirror"; or one for each axis: ["periodic", "reflecting"]

[run]
step = "10 fs"
steps = 2000
cutoff = "8.5 angstrom"       # atoms further apart than this do not interact
seed = 1                      # of all random numbers

[[ensembles]]                 # particles of one class; write as many of these as you need
name = "atoms"
class = "Newton"              # moved by forces
integrator = "leap-frog"
load = { kind = "block", lattice = "square", spacing = "5 angstrom", counts = [16, 16], origin = "centred" }
mass = "39.948 amu"
temperature = "120 K"         # velocities from the Maxwell distribution
remove_drift = true           # no total momentum
diameter = "3.4 angstrom"     # for pictures

[[influences]]                # an interaction
law = "lennard-jones"
on = "atoms"                  # within one ensemble; between = ["a", "b"] for two of them
depth = "0.01032 eV"
r0 = "3.822 angstrom"

[[diagnoses]]                 # columns of diagnoses.csv
kind = "energies"
[[diagnoses]]
kind = "temperature"

[output]                      # intervals in steps
diagnoses = 20
trajectory = 50
checkpoint = 500

[[output.pictures]]
colour = "speed"
file = "picture.png"

[[output.pictures]]
drawing = "time-series"
y = "kinetic energy, potential energy, total energy"
file = "energies.png"
)toml";

// Grains that charge up, touch and spin, in two dimensions.
constexpr char const* starter_of_class = R"toml(#:schema ./boltzmann.schema.json
# A scenario of Boltzmann with a class of its own. Change what you like, then
#   bzm check @name.toml    lists all mistakes without running
#   bzm run @name.toml      writes results to results/@name
# `bzm show classes` and `bzm show classes.fields` explain the keys; `bzm list classes` lists the base classes.

title = "Grains that charge up"

[units]                       # units of plain numbers and of results
base = "custom"
length = "1 mm"
mass = "1 pg"
time = "1 s"

[box]
low = [-5, -5]
high = [5, 5]
boundary = "reflecting"

[run]
step = "2 ms"
time = "2 s"

[[classes]]
name = "Grain"
base = "Newton"               # gives the motion and the first fields: position, velocity, mass
fields = [                    # kind = "vector" for one number per axis; period = "2 pi" for angles
  { name = "charge", unit = "e", default = 0, doc = "collected charge" },
  { name = "glow", doc = "exposure to neighbours" },
]
rate.charge = "(full - charge)/tau"     # rate of change, from fields of the particle: charge per time
rate.glow = "-glow/tau"
diffusion.glow = "0.001 1/s"            # noise: a random walk of variance 2 D t; optional
parameters = { full = "2000 e", tau = "0.5 s" }

[[ensembles]]
name = "grains"
class = "Grain"
mass = "8 pg"
load = { kind = "block", lattice = "square", spacing = 0.7, counts = [9, 9], origin = "centred" }
charge = "10 e"               # at the start; formulas = { charge = "..." } if it depends on the position
diameter = 0.4                # for pictures

[[influences]]                # laws may read the fields of both particles
energy = "k*p.charge*q.charge/r"
parameters = { k = "8.9875517923e9 N m^2/C^2" }
on = "grains"

[[influences]]                # exerts no force: its value is added to the rate of a field
changes = "glow"
influence = "strength*exp(-r/reach)"
parameters = { strength = "0.5 1/s", reach = "1 mm" }
on = "grains"

[[diagnoses]]
kind = "extremes"
quantity = "charge"
[[diagnoses]]
kind = "extremes"
quantity = "glow"

[output]                      # intervals in steps
diagnoses = 10
trajectory = 20

[[output.pictures]]
colour = "glow"
file = "picture.png"
)toml";

// Dust in a plasma: two species with screened interaction, and an external law that confines them.
constexpr char const* starter_of_law = R"toml(#:schema ./boltzmann.schema.json
# A scenario of Boltzmann with laws of its own. Change what you like, then
#   bzm check @name.toml    lists all mistakes without running; it also samples the laws
#   bzm run @name.toml      writes results to results/@name
# `bzm show lennard-jones` prints a shipped law as a formula to begin with; `bzm show influences` explains the keys.

title = "Dust behind a screen"

[units]                       # units of plain numbers and of results
base = "reduced"              # pure numbers; with "si", "custom", ... formulas have units, which are checked

[box]
low = [-8, -8]
high = [8, 8]

[run]
step = 0.01
steps = 3000
seed = 1                      # of all random numbers

[[ensembles]]
name = "light"
class = "Coulomb"             # fields: position, velocity, mass, charge
mass = 1
charge = 1
load = { kind = "block", lattice = "square", spacing = 0.9, counts = [8, 8], origin = "centred" }
diameter = 0.3                # for pictures

[[ensembles]]
name = "heavy"
class = "Coulomb"
mass = 4
charge = 2
load = { kind = "positions", positions = [[-5, 0], [5, 0], [0, 5], [0, -5]] }
diameter = 0.6

[[influences]]                # between pairs: an energy; forces are its derivative
energy = "k*p.charge*q.charge*screen/r"       # r: distance; p.charge, q.charge: fields of both
where = { screen = "exp(-r/length)" }         # named parts
among = ["light", "heavy"]                    # within each and between both; on = "light": within one
parameters = { k = 1, length = { light = 1, heavy = 1.5 } }
mixing = { length = "arithmetic" }            # between light and heavy; or { ..., "light-heavy" = 1.2 }

[[influences]]                # external: a formula of position (x, y, z), velocity, time and fields
energy = "0.1*mass*(x^2 + y^2)"
from_outside = true
on = "light"

[[influences]]
energy = "0.1*mass*(x^2 + y^2)"
from_outside = true
on = "heavy"

[[influences]]                # an influence is a force (for tracers a velocity); here friction
influence = "-0.05*mass*velocity"
from_outside = true
on = "light"

[[diagnoses]]                 # columns of diagnoses.csv
kind = "energies"

[output]                      # intervals in steps
diagnoses = 20
trajectory = 50

[[output.pictures]]
colour = "charge"
file = "picture.png"

[[output.pictures]]
drawing = "time-series"
y = "kinetic energy, potential energy, total energy"
file = "energies.png"
)toml";

char const* text_of(NewScenario kind) {
  switch (kind) {
    case NewScenario::of_class:
      return starter_of_class;
    case NewScenario::of_law:
      return starter_of_law;
    case NewScenario::plain:
      break;
  }
  return starter;
}

}  // namespace

int new_scenario(std::string const& word, NewScenario kind) {
  namespace fs = std::filesystem;
  std::string const name = word.ends_with(".toml") ? word.substr(0, word.size() - 5) : word;
  if (name.empty() || name.ends_with('/')) throw Error("a new scenario needs a name");
  std::string const path = name + ".toml";
  std::error_code ignored;
  if (fs::exists(path, ignored)) throw Error("'" + path + "' is there already; it stays as it is");
  std::string text = text_of(kind);
  std::string const stem = fs::path(name).filename().string();
  for (std::size_t at = 0; (at = text.find("@name", at)) != std::string::npos;) {
    std::string const replacement = text.compare(at + 5, 5, ".toml") == 0 ? name : stem;
    text.replace(at, 5, replacement);
    at += replacement.size();
  }
  write_whole(path, text);
  write_whole((fs::path(path).parent_path() / "boltzmann.schema.json").string(), scenario_schema());
  fmt::print("{} is written, and boltzmann.schema.json, with which editors complete and mark; next: bzm run {}\n", path,
             path);
  return 0;
}

}  // namespace boltzmann::bzm
