// bzm build: the compiler line of a user's program, printed and executed.
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/bzm/process.hpp>
#include <boltzmann/core/clock.hpp>
#include <boltzmann/core/error.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>

namespace boltzmann::bzm {
namespace {

namespace fs = std::filesystem;

// The same texts as in pack.hpp and interaction.hpp.
constexpr char const* select_hint = "of several particles at once there is no `if`: write select(condition, a, b)";
constexpr char const* interaction_hint = "an Interaction is {force, energy}, in this order";

struct Installation {
  std::string include, library;
  std::string precompiled =
      {};  // includes of most programs, with the shipped examples; halves the build time of a short one
};

/// Returns the precompiled header if no header has changed since it was made; else empty. The compiler does not check
/// this.
std::string precompiled_header(fs::path const& source, fs::path const& build) {
  auto const header = build / "CMakeFiles/examples_header.dir/cmake_pch.hxx";
  std::error_code error;
  auto const made = fs::last_write_time(header.string() + ".gch", error);
  if (error) return "";
  for (auto const& file : fs::recursive_directory_iterator(source / "boltzmann"))
    if (file.path().extension() == ".hpp" && file.last_write_time() > made) return "";
  return header.string();
}

// Location of headers and library: the source and build folders if this program runs in its build folder, else the
// installation.
Installation installation() {
  fs::path const own = own_path(), build = own.parent_path(), prefix = build.parent_path();
  std::error_code ignored;
  if (fs::equivalent(build, BOLTZMANN_BUILD, ignored)) {
    if (!fs::exists(build / "libboltzmann.a"))
      throw Error(fmt::format("there is no libboltzmann.a in {}; cmake --build {} --target boltzmann makes it",
                              build.string(), build.string()));
    return {BOLTZMANN_SOURCE, (build / "libboltzmann.a").string(), precompiled_header(BOLTZMANN_SOURCE, build)};
  }
  if (fs::exists(prefix / "include/boltzmann/core/error.hpp"))
    for (auto const* folder : {BOLTZMANN_LIBRARY_FOLDER, "lib", "lib64"})
      if (auto const library = prefix / folder / "libboltzmann.a"; fs::exists(library))
        return {(prefix / "include").string(), library.string()};
  throw Error(fmt::format("headers and libboltzmann.a are not below {} (Debian: apt install libboltzmann-dev)",
                          prefix.string()));
}

std::vector<std::string> words_of(std::string const& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

// The dependencies of libboltzmann.a itself.
std::vector<std::string> dependencies() {
  auto words = words_of(output_of({"pkg-config", "--libs", "fftw3", "cairo", "hdf5", "zlib"}));
  if (!words.empty()) return words;
  words = {"-lfftw3", "-lcairo"};
  for (auto const* folder : {"/usr/lib/x86_64-linux-gnu/hdf5/serial", "/usr/lib/aarch64-linux-gnu/hdf5/serial"})
    if (fs::exists(folder)) words.push_back(std::string("-L") + folder);
  for (char const* one : {"-lhdf5", "-lz"}) words.emplace_back(one);
  return words;
}

// Explains compiler messages that are typical of laws on packs of particles.
std::vector<std::string> hints(std::string const& messages) {
  // With packs, as in "no matching function for call to 'exp(boltzmann::Pack<double>&)'". clang++ writes "for call to
  // 'exp'" and names the argument type in a note.
  std::set<std::string> called;
  std::istringstream lines(messages);
  std::string of_clang;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("no known conversion from 'boltzmann::Pack<") != std::string::npos && !of_clang.empty())
      called.insert(of_clang);
    for (auto const* name : {"exp", "log", "pow", "sqrt", "sin", "cos", "tanh", "erf", "erfc", "abs", "min", "max"}) {
      if (line.find(fmt::format("call to '{}'", name)) != std::string::npos) of_clang = name;
      auto const call = line.find("call to "), at = line.find(fmt::format("{}(", name), call);
      if (call == std::string::npos || at == std::string::npos || line.find("Pack<", at) == std::string::npos) continue;
      if (std::islower(static_cast<unsigned char>(line[at - 1])) == 0) called.insert(name);
    }
  }
  std::vector<std::string> all;
  for (auto const& name : called)
    all.push_back(
        fmt::format("in a law write {0} without std:: (a law is compiled for several particles at once)", name));
  for (auto const* ours : {select_hint, interaction_hint})
    if (messages.find(ours) != std::string::npos) all.emplace_back(ours);
  return all;
}

}  // namespace

int build(BuildOptions const& options) {
  if (!fs::is_regular_file(options.program)) throw Error("there is no program '" + options.program + "'");
  std::string const out = options.out.empty() ? fs::path(options.program).replace_extension("").string() : options.out;
  if (fs::path(out).lexically_normal() == fs::path(options.program).lexically_normal())
    throw Error("'" + options.program + "' would be replaced by its own program; name another with -o");
  auto const place = installation();
  char const* chosen = std::getenv("CXX");
#ifdef BOLTZMANN_SANITIZED  // the compiler and the flag of the library; other sanitizer runtimes do not link with it
  std::vector<std::string> line = words_of(chosen ? chosen : BOLTZMANN_SANITIZED);
#else
  std::vector<std::string> line = words_of(chosen ? chosen : "g++");
#endif
  if (line.empty()) line = {"g++"};
  if (find_program(line[0]).empty())
    throw Error("the compiler '" + line[0] + "' is not there (Debian: apt install g++)");
  for (auto const* word : {"-std=c++20", "-O3", "-DNDEBUG", "-march=native", "-Wno-psabi", "-Wall", "-Wextra"})
    line.emplace_back(word);
  if (isatty(STDERR_FILENO) == 1) line.emplace_back("-fdiagnostics-color=always");  // they go through a pipe
  line.push_back("-I" + place.include);
  if (!place.precompiled.empty() && !chosen) line.insert(line.end(), {"-include", place.precompiled});
#ifndef BOLTZMANN_SANITIZED
  // The gold linker needs half the time of the default linker.
  if (!chosen && !find_program("ld.gold").empty()) line.emplace_back("-fuse-ld=gold");
#endif
  line.push_back(options.program);
  line.emplace_back("-o");
  line.push_back(out);
  line.push_back("-L" + fs::path(place.library).parent_path().string());
  for (auto const* word : {"-lboltzmann", "-lfmt", "-lpthread"}) line.emplace_back(word);
  for (auto const& word : dependencies()) line.push_back(word);
  fmt::print("{}\n", shell_line(line));
  std::fflush(stdout);
  if (options.dry) return 0;
  auto const start = Clock::now();
  std::string messages;
  int const status = run_program(line, messages);
  if (status != 0) fmt::print(stderr, "'{}' does not compile\n", options.program);
  if (status != 0)
    for (auto const& hint : hints(messages)) fmt::print(stderr, "hint: {}\n", hint);
  fmt::print(stderr, "{}", messages);
  if (status != 0) return status > 128 ? status : 2;
  fmt::print("{} built in {:.1f} s\n", out, seconds_since(start));
  return 0;
}

}  // namespace boltzmann::bzm
