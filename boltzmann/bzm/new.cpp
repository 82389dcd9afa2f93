// bzm new: a small scenario with a comment on every line that one would want to change.
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
#   bzm check @name.toml    shows all mistakes, and runs nothing
#   bzm run @name.toml      leaves its results in results/@name
# `bzm list` shows all classes, laws, integrators and diagnoses; `bzm show lennard-jones` explains one.

title = "A gas of argon atoms"

[units]                       # what plain numbers mean, and the units of the results
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
cutoff = "8.5 angstrom"       # influences between atoms further apart than this are left out
seed = 1                      # of all random numbers

[[ensembles]]                 # particles of one class; write as many of these as you need
name = "atoms"
class = "Newton"              # moved by forces
integrator = "leap-frog"
load = { kind = "block", lattice = "square", spacing = "5 angstrom", counts = [16, 16], origin = "centred" }
mass = "39.948 amu"
temperature = "120 K"         # velocities from the Maxwell distribution
remove_drift = true           # so that all atoms together are at rest
diameter = "3.4 angstrom"     # for pictures

[[influences]]                # who acts on whom
law = "lennard-jones"
on = "atoms"                  # within one ensemble; between = ["a", "b"] for two of them
depth = "0.01032 eV"
r0 = "3.822 angstrom"

[[diagnoses]]                 # columns of diagnoses.csv
kind = "energies"
[[diagnoses]]
kind = "temperature"

[output]                      # every so many steps
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

}  // namespace

int new_scenario(std::string const& word) {
  namespace fs = std::filesystem;
  std::string const name = word.ends_with(".toml") ? word.substr(0, word.size() - 5) : word;
  if (name.empty() || name.ends_with('/')) throw Error("a new scenario needs a name");
  std::string const path = name + ".toml";
  std::error_code ignored;
  if (fs::exists(path, ignored)) throw Error("'" + path + "' is there already; it stays as it is");
  std::string text = starter;
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
