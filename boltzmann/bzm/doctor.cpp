// bzm doctor: checks the installation and the correctness of results on this machine.
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/bzm/launch.hpp>
#include <boltzmann/bzm/process.hpp>
#include <boltzmann/core/clock.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/core/launcher.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/conserved.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

// Declared here, because their headers are not needed for a version.
extern "C" {
int H5get_libversion(unsigned* major, unsigned* minor, unsigned* release);
char const* cairo_version_string(void);
extern char const fftw_version[];
}

namespace boltzmann::bzm {
namespace {

namespace fs = std::filesystem;

class Findings {
 public:
  void ok(std::string const& what, std::string const& text) const { line("ok", "32", what, text); }
  void note(std::string const& what, std::string const& text) const { line("note", "33", what, text); }
  void problem(std::string const& what, std::string const& text) {
    ++problems_;
    line("problem", "31", what, text);
  }
  int problems() const { return problems_; }

 private:
  void line(char const* mark, char const* colour, std::string const& what, std::string const& text) const {
    if (coloured_)
      fmt::print("\033[{}m{:<8}\033[0m{:<16}{}\n", colour, mark, what, text);
    else
      fmt::print("{:<8}{:<16}{}\n", mark, what, text);
    std::fflush(stdout);
  }
  int problems_ = 0;
  bool coloured_ = isatty(STDOUT_FILENO) == 1 && std::getenv("NO_COLOR") == nullptr;
};

std::string cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) {
      auto const at = line.find(": ");
      if (at != std::string::npos) return line.substr(at + 2);
    }
  return "unknown";
}

// The instruction set in use, those available, and how to choose.
std::string instructions() {
  std::vector<std::string> words;
  for (auto const set : instruction_sets()) words.push_back(to_string(set));
  std::string const used = to_string(instruction_set());
  if (words.size() == 1) return used;
  return fmt::format("{} of {} (BOLTZMANN_INSTRUCTIONS={} forces one)", used, join(words), words.front());
}

std::string first_line(std::string const& text) { return text.substr(0, text.find('\n')); }

void check_compiler(Findings& findings) {
  char const* chosen = std::getenv("CXX");
  std::string const compiler = chosen && *chosen ? chosen : "g++";
  std::string const path = find_program(compiler);
  if (path.empty())
    findings.note("compiler", compiler + " is not there: `bzm build` needs it (Debian: apt install g++)");
  else
    findings.ok("compiler", first_line(output_of({path, "--version"})));
}

// Checks the requirements of bzm run --ranks: a launcher, and the plug-in for the same MPI.
void check_mpi(Findings& findings) {
  auto const launcher = launcher_version();
  auto const plugin = open_mpi_plugin();
  if (launcher.empty())
    findings.note("MPI", "no mpirun is there: `bzm run --ranks` needs it (Debian: apt install openmpi-bin)");
  else
    findings.ok("MPI", launcher);
  if (!plugin.library.empty())
    findings.ok("MPI plug-in", fmt::format("{} ({})", plugin.path, plugin.library));
  else if (!plugin.path.empty())
    findings.note("MPI plug-in", fmt::format("{} can't be used: {}", plugin.path, plugin.reason));
  else if (!launcher.empty())
    findings.note("MPI plug-in", "libboltzmann_mpi.so is not there; " + how_to_make_mpi_plugin());
}

// Writes 64 MB to the disk and removes them.
void check_writing(std::string const& folder, Findings& findings) {
  fs::path place = folder;
  std::error_code ignored;
  while (!fs::is_directory(place, ignored) && place.has_parent_path() && place != place.parent_path())
    place = place.parent_path();
  if (!fs::is_directory(place, ignored)) place = ".";
  std::string name = (place / ".bzm-doctor-XXXXXX").string();
  int const file = mkstemp(name.data());
  if (file < 0) {
    findings.problem("writing", fmt::format("no file can be made in {}", place.string()));
    return;
  }
  std::vector<char> const block(1 << 20, 'b');
  auto const start = Clock::now();
  int written = 0;
  while (written < 64 && write(file, block.data(), block.size()) == static_cast<ssize_t>(block.size())) ++written;
  bool const kept = fsync(file) == 0;
  double const time = seconds_since(start);
  close(file);
  fs::remove(name, ignored);
  if (written < 64 || !kept)
    findings.problem("writing", fmt::format("only {} of 64 MB could be written to {}", written, place.string()));
  else
    findings.ok("writing",
                fmt::format("{:.0f} MB/s to {}", 64 / time, fs::absolute(place).lexically_normal().string()));
}

// The start of the standard Lennard-Jones liquid benchmark: 32,000 atoms on an fcc lattice at density 0.8442, cut-off
// 2.5, potential energy -6.7733680532 per atom. Then runs as many steps as fit into half a second.
void check_physics(Findings& findings) {
  constexpr double wanted = -6.7733680532;
  double const edge = 20 * std::cbrt(4 / 0.8442);
  Ensemble<Newton<3>> atoms("atoms");
  LatticeBlock const block{Lattice::fcc, edge / 20 / std::numbers::sqrt2, {20, 20, 20}, {0, 0, 0}};
  block_load(atoms, block);
  maxwellian_load(atoms, {.temperature = 1.44, .seed = 87287, .remove_drift = true});
  PairScheme scheme(Box(Vector{0., 0., 0.}, Vector{edge, edge, edge}, Boundary::periodic), 2.5);
  // Use the kernels of the selected instruction set, as scenarios do.
  install_pairs(scheme, *find_law("lennard-jones"), {{"depth", {1}}, {"r0", {std::pow(2, 1.0 / 6)}}}, LawUse::internal,
                atoms, atoms, scheme.cutoff());
  Simulation simulation(scheme, 0.005);
  simulation.integrate(atoms, Method::leap_frog);
  scheme.shifted(false);  // the reference energy is that of the unshifted law
  simulation.check();
  double const size = static_cast<double>(atoms.size());
  double const energy = simulation.measure().potential / size;
  std::string const text = fmt::format("Lennard-Jones fcc, 32000 atoms: {:.10f} energy per atom", energy);
  if (std::abs(energy - wanted) < 1e-9)
    findings.ok("physics", text);
  else
    findings.problem("physics", fmt::format("{}; right is {:.10f}", text, wanted));
  scheme.shifted(true);
  auto const before = conserved(simulation);
  auto const start = Clock::now();
  std::uint64_t steps = 0;
  while (seconds_since(start) < 0.7 && steps < 1000) simulation.run(5), steps += 5;
  double const time = seconds_since(start);
  auto const after = conserved(simulation);
  double const drift = std::abs(*after.energy - *before.energy) / size;
  if (drift < 0.01)
    findings.ok("energy", fmt::format("changes by {:.1e} per atom in {} steps", drift, steps));
  else
    findings.problem("energy",
                     fmt::format("changes by {:.1e} per atom in {} steps; below 0.01 is right", drift, steps));
  findings.ok("speed", fmt::format("{:.3g} million particle-steps/s with {} threads",
                                   size * static_cast<double>(steps) / time / 1e6, scheme.threads()));
}

}  // namespace

int doctor(std::string const& folder) {
  Findings findings;
  findings.ok("bzm", fmt::format("{} ({})", described_version, own_path()));
  findings.ok("processor", cpu_name());
  findings.ok("instructions", instructions());
  findings.ok("threads", fmt::format("{}", default_threads()));
  check_compiler(findings);
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  findings.ok("HDF5", fmt::format("{}.{}.{}", major, minor, release));
  findings.ok("FFTW", static_cast<char const*>(fftw_version));
  findings.ok("Cairo", cairo_version_string());
  if (auto const ffmpeg = find_program("ffmpeg"); ffmpeg.empty())
    findings.note("ffmpeg", "is not there: `bzm render` makes pictures but no movies (Debian: apt install ffmpeg)");
  else
    findings.ok("ffmpeg", first_line(output_of({ffmpeg, "-version"})));
  check_mpi(findings);
  check_writing(folder.empty() ? "results" : folder, findings);
  check_physics(findings);
  if (findings.problems() == 0)
    fmt::print("all is well\n");
  else
    fmt::print("{} {}\n", findings.problems(), findings.problems() == 1 ? "problem" : "problems");
  return findings.problems() == 0 ? 0 : 1;
}

}  // namespace boltzmann::bzm
