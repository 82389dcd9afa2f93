// One function for each way in.
#include "targets.hpp"
#include "formula_target.hpp"

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/nesting.hpp>
#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/files/csv.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/recording/run_file.hpp>
#include <boltzmann/scenario/parameters.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/scenario/stored_run.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#ifdef BOLTZMANN_WITH_WINDOW
#include <boltzmann/window/gallery_source.hpp>
#include <boltzmann/window/live_run.hpp>
#endif

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace boltzmann::fuzz {
namespace {

namespace fs = std::filesystem;

/// A folder of this process in memory, where there is one.
std::string const& folder() {
  struct Place {
    std::string path;
    Place() {
      std::error_code ignored;
      fs::path const root = fs::is_directory("/dev/shm", ignored) ? "/dev/shm" : fs::temp_directory_path();
      path = (root / ("boltzmann-fuzz-" + std::to_string(getpid()))).string();
      fs::create_directories(path);
    }
    ~Place() {
      std::error_code ignored;
      fs::remove_all(path, ignored);
    }
  };
  static Place const place;
  return place.path;
}

std::string file_of(std::string const& name, std::string const& bytes) {
  std::string path = folder() + "/" + name;
  TextFile(path, TextFile::Mode::replace).write(bytes);
  return path;
}

/// `file:line:column: what`.
void need_places(std::vector<std::string> const& lines, std::string const& file) {
  for (auto const& line : lines) {
    auto const rest = line.starts_with(file + ":") ? line.substr(file.size() + 1) : "";
    auto const digits = rest.find_first_not_of("0123456789");
    if (digits == 0 || digits == std::string::npos || rest[digits] != ':' || line.find('\n') != std::string::npos)
      throw std::logic_error("a mistake without its place: " + line);
  }
}

constexpr std::size_t most_particles = 300;

void read_scenario_text(std::string const& text) {
  std::string const file = "fuzz.toml";
  try {
    auto const outline = outline_scenario(text, file);
    // What is told to be large may be.
    if (!outline.particles || *outline.particles > most_particles || text.find("[mesh]") != std::string::npos ||
        text.find("sweep") != std::string::npos)
      return;
    parse_scenario(text, file);
  } catch (ScenarioErrors const& errors) {
    need_places(errors.lines, file);
  } catch (Error const&) {
    // a file that it names, memory
  }
}

std::vector<std::string> scenario_seeds() {
  std::vector<std::string> seeds;
  for (auto const& name : shipped_scenarios()) {
    auto text = read_text(find_scenario(name));
    // Of their particles a few.
    for (auto at = text.find("counts = ["); at != std::string::npos; at = text.find("counts = [", at + 1)) {
      auto const end = text.find(']', at);
      auto const axes = std::count(text.begin() + static_cast<std::ptrdiff_t>(at),
                                   text.begin() + static_cast<std::ptrdiff_t>(end), ',');
      text.replace(at, end - at, axes == 0 ? "counts = [9" : axes == 1 ? "counts = [4, 4" : "counts = [2, 2, 2");
    }
    for (auto at = text.find("\ncount = "); at != std::string::npos; at = text.find("\ncount = ", at + 1))
      text.replace(at, text.find_first_of(" \n", at + 9) - at, "\ncount = 20");
    seeds.push_back(std::move(text));
  }
  return seeds;
}

struct Pair {
  Ensemble<Newton<2>> atoms{"atoms", 2};
  PairScheme scheme{Box(Vector{-5., -5.}, Vector{5., 5.}, Boundary::periodic), 4.0};
  Simulation simulation{scheme, 0.01};
  Pair() {
    atoms[1].position = {1., 1.5};
    scheme.internal(atoms, [](auto const& p, auto const& q) { return q.position - p.position; });
    simulation.integrate(atoms, Method::leap_frog);
  }
};

/// The files of a small run.
std::string file_of_run(std::string const& name) {
  static std::string const place = [] {
    std::string path = folder() + "/run";
    Pair pair;
    Recording recording(pair.simulation, UnitSystem::reduced(), path, {.overwrite = true});
    recording.diagnoses(5, {"momentum"});
    recording.trajectory(5);
    recording.picture({.colour = "speed"});
    run_with_progress(recording, 20, {.quiet = true});
    return path;
  }();
  return read_text(place + "/" + name);
}

void read_run_file(std::string const& text) {
  auto const path = file_of(run_file, text);
  try {
    load_stored_run(folder());
  } catch (ScenarioErrors const& errors) {
    need_places(errors.lines, path);
  } catch (Error const&) {
  }
}
std::vector<std::string> run_file_seeds() { return {file_of_run(run_file)}; }

/// By one of the readers, which the text's length chooses.
void read_particles_of(std::string const& text) {
  auto const path = file_of("fuzz.xyz", text);
  auto const formats = particle_file_formats();
  std::string const format(formats[text.size() % formats.size()].name);
  Box const box({0, 0, 0}, {4, 4, 4}, Boundary::periodic);
  for (std::size_t frame = 0; frame < 3; ++frame) try {
      // The last time by what the file looks like.
      auto const found = from_particle_file(path, {.frame = frame % 2, .format = frame < 2 ? format : ""});
      Ensemble<Newton<3>> atoms("atoms");
      frame_load(atoms, found, {.units = UnitSystem::si(), .resize = true});
      left_aside(atoms, found);
      element_masses(found, "", UnitSystem::si());
      lattice_misfit(found, box, {.units = UnitSystem::si()});
      for (auto const& column : found.columns)
        if (column.values.size() != found.size() * static_cast<std::size_t>(column.components))
          throw std::logic_error("a column has not a number for each particle: " + column.name);
    } catch (Error const& error) {
      if (std::string(error.what()).find('\n') != std::string::npos)
        throw std::logic_error(std::string("not one line: ") + error.what());
    }
}
/// Blanks behind a text until its length chooses this reader.
std::string for_format(std::size_t number, std::string text) {
  while (text.size() % particle_file_formats().size() != number) text += '\n';
  return text;
}
std::vector<std::string> particle_seeds() {
  return {
      for_format(0, "2\nplain\nCu 0 0 0\nCu 1 2 3\n"),
      for_format(0,
                 "1\nLattice=\"5 0 0 0 5 0 0 0 5\" Properties=species:S:1:pos:R:3:velo:R:3:charge:R:1 pbc=\"T T "
                 "F\"\nAr 1 2 3 0.5 0 0 -1\n1\nsecond\nAr 1e-3 +2 -3.5\n"),
      for_format(1,
                 "units = real\n\n2 atoms\n1 atom types\n0 9 xlo xhi\n0 9 ylo yhi\n0 9 zlo zhi\n\nMasses\n\n1 40 # "
                 "Ar\n\nAtoms # charge\n\n2 1 0.5 1 2 3\n1 1 -1 3 2 1\n\nVelocities\n\n1 0 0 0\n2 1 1 1\n"),
      for_format(
          1,
          "c\n\n1 atoms\n1 atom types\n4 0 0 avec\n0 4 0 bvec\n0 0 4 cvec\n0 0 0 abc origin\n\nAtom Type Labels\n\n"
          "1 Ar\n\nAtoms # sphere\n\n1 Ar 1 1 1 2 3 0 0 1\n\nVelocities\n\n1 0 0 0 1 1 1\n\nCMAP\n\n1 2 3\n"),
      for_format(2,
                 "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS xy xz yz pp pp ff\n0 4 1\n0 4 0\n0 4 "
                 "0\nITEM: ATOMS id type xs ys zs vx vy vz\n1 1 0.5 0.5 0.5 1 2 3\n"),
      for_format(3,
                 "CRYST1   18.774   18.774   18.774  90.00  80.00  90.00 P 1           1\nMODEL        1\n"
                 "ATOM      1  OW  SOL     1       5.690  12.751  11.651  1.00  0.00           O  \nENDMDL\nCONECT    "
                 "1    2\n"),
      for_format(4, "t\n1\n    1WATER  OW1    1   0.126   1.624   1.679  0.1227 -0.0580  0.0434\n   1.8   1.8   1.8\n"),
      for_format(5,
                 "t\n-64\n1 0 0\n0 1 0\n0 0 1\nNa Cl\n1 1\nSelective\nDirect\n0 0 0 T T F\n0.5 0.5 0.5 T T T\n"
                 "Lattice velocities\n1\n0 0 0\n0 0 0\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n\n1 0 0\n0 1 0\n\n1\n")};
}

void read_table(std::string const& text) {
  auto const path = file_of("fuzz.csv", text);
  try {
    read_csv(path);
  } catch (Error const&) {
  }
  try {
    CsvFile::append_to(path, {"step", "time", "momentum x", "momentum y"}, 3);
  } catch (Error const&) {
  }
}
std::vector<std::string> table_seeds() {
  return {file_of_run("diagnoses.csv"), "step,time,total energy\n0,0,1.5\n5,0.05,nan\n"};
}

void read_checkpoint_file(std::string const& bytes) {
  auto const path = file_of("fuzz-checkpoint.h5", bytes);
  try {
    read_checkpoint(path);
  } catch (Error const&) {
  }
}
std::vector<std::string> checkpoint_seeds() { return {file_of_run("checkpoint.h5")}; }

void read_trajectory(std::string const& bytes) {
  auto const path = file_of("fuzz-trajectory.h5", bytes);
  try {
    TrajectoryReader const reader(path);
    Ensemble<Newton<2>> atoms("atoms");
    for (std::size_t frame = 0; frame < std::min<std::size_t>(reader.frames(), 3); ++frame) {
      reader.box(frame);
      if (reader.size(frame, "atoms") < 10'000) reader.load(frame, atoms);
    }
  } catch (Error const&) {
  }
}
std::vector<std::string> trajectory_seeds() { return {file_of_run("trajectory.h5")}; }

#ifdef BOLTZMANN_WITH_WINDOW
using nlohmann::json;

void read_message(std::string const& text) {
  struct Shows {
    std::string before = fs::current_path();
    Pair pair;
    Clients clients;
    Gallery gallery{folder()};
    GallerySource list{gallery, clients};
    Views views{pair.simulation, UnitSystem::reduced(), "two", ""};
    LiveRun live{views, clients, nullptr};
    Shows() { pair.simulation.check(), views.add_usual(); }
  };
  static Shows shows;
  json const request = nested_too_deep(text) ? json() : json::parse(text, nullptr, false);
  if (!request.is_object() || !request.contains("do") || !request["do"].is_string()) return;
  for (Source* show : {static_cast<Source*>(&shows.list), static_cast<Source*>(&shows.live)}) try {
      if (request["do"] == "picture")
        show->picture(request);
      else if (request["do"] == "views")
        for (auto const& view : request.value("views", json::array())) show->draw(view);
      else
        show->perform(request).dump(-1, ' ', false, json::error_handler_t::replace);
    } catch (Error const& error) {
      // a line for the page
    } catch (json::exception const&) {
      // which the clients answers, too
    }
}
std::vector<std::string> message_seeds() {
  return {R"({"do":"views","views":[{"id":1,"diagnosis":"Particles","colour":"speed","low":0,"high":2,"most":5}]})",
          R"({"do":"views","views":[{"id":2,"diagnosis":"Phase space","x":"position.x","region":[[0,1],[0,1]]}]})",
          R"({"do":"views","views":[{"id":3,"diagnosis":"Histogram","x":"speed","cells":10,"logarithmic":true}]})",
          R"({"do":"picture","view":{"diagnosis":"Particles"},"format":"svg","width":300,"height":200,"scale":1})",
          R"({"do":"set","step_size":"0.5","steps_per_frame":3})",
          R"({"do":"step","steps":-3,"id":7})",
          R"({"do":"select","ensemble":"atoms","particle":1})",
          R"({"do":"scenario","name":"three-body"})",
          R"({"do":"check","name":"three-body","set":{"run.steps":"100","run.step":"1 s"}})",
          R"({"do":"save","name":"three-body","set":{"run.steps":"7"},"as":"mine","replace":true})",
          R"({"do":"run","name":"three-body","set":{},"out":"results/x"})"};
}
#endif

std::vector<std::string> const toml_words{"1e308",
                                          "-1",
                                          "nan",
                                          "inf",
                                          "9223372036854775807",
                                          "0",
                                          "[[ensembles]]",
                                          "[box]",
                                          "\"",
                                          "\"\"\"",
                                          "[",
                                          "]",
                                          "{",
                                          "}",
                                          "=",
                                          "true",
                                          "\"1 kg\"",
                                          "...",
                                          "'''",
                                          "\\u0000",
                                          "#",
                                          ".",
                                          "\n",
                                          ",",
                                          "steps",
                                          "counts",
                                          "load",
                                          "\"periodic\"",
                                          "boundary",
                                          "skin",
                                          "cutoff",
                                          "stop"};
std::vector<std::string> const json_words{"{",    "}",    "[",       "]",      "\"",      ":",      ",",     "null",
                                          "true", "-1",   "1e308",   "1e-320", "9e99",    "\"do\"", "views", "view",
                                          "set",  "../x", "\\u0000", "x",      "drawing", "mesh"};
std::vector<std::string> const number_words{
    "1e308", "-1", "nan", "inf", "99999999999", "Properties=", "Lattice=\"", ":R:3", ",", "\n", " ", "\""};

}  // namespace

std::vector<Target> const& targets() {
  static std::vector<Target> const all{
      {"scenario", read_scenario_text, scenario_seeds, toml_words},
      {"formula", read_formula_of_any_text, formula_seeds, formula_words()},
      {"run_file", read_run_file, run_file_seeds, toml_words},
      {"particles", read_particles_of, particle_seeds, number_words},
      {"table", read_table, table_seeds, number_words},
      {"checkpoint", read_checkpoint_file, checkpoint_seeds, {}},
      {"trajectory", read_trajectory, trajectory_seeds, {}},
#ifdef BOLTZMANN_WITH_WINDOW
      {"message", read_message, message_seeds, json_words},
#endif
  };
  return all;
}

Target const& target(std::string const& name) {
  for (auto const& one : targets())
    if (one.name == name) return one;
  throw Error("there is no target '" + name + "'");
}

}  // namespace boltzmann::fuzz

// What HDF5 can't close again of damaged files, and the caches of Cairo's libraries, are no leaks of ours.
// NOLINTNEXTLINE(bugprone-reserved-identifier)
extern "C" char const* __lsan_default_suppressions() {
  return "leak:libhdf5\nleak:libfontconfig\nleak:libcairo\nleak:libexpat\n";
}
