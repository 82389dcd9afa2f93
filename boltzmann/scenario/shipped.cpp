// Finds the shipped scenarios.
#include <boltzmann/core/error.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include <fmt/format.h>

#include <dlfcn.h>
#include <link.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace boltzmann {

namespace {
namespace fs = std::filesystem;

/// The installation prefix of this code: <prefix> of <prefix>/bin/bzm; of <prefix>/lib/.../_core.so, if it is part of a
/// module loaded by another program, Python. Empty if it is unknown.
fs::path install_prefix() {
  static int const here = 0;
  Dl_info info;
  link_map* object = nullptr;
  std::error_code failure;
  bool const known = dladdr1(&here, &info, reinterpret_cast<void**>(&object), RTLD_DL_LINKMAP) != 0 && object;
  if (!known || !*object->l_name) return fs::read_symlink("/proc/self/exe", failure).parent_path().parent_path();
  for (fs::path folder = fs::canonical(object->l_name, failure).parent_path(); folder.has_relative_path();
       folder = folder.parent_path())
    if (folder.filename() == "lib") return folder.parent_path();
  return {};
}

}  // namespace

std::string scenario_folder() {
  if (char const* chosen = std::getenv("BOLTZMANN_SCENARIOS"); chosen && *chosen) return chosen;
  std::error_code failure;
  // Installed: <prefix>/share/boltzmann/scenarios. Otherwise the source tree.
  fs::path const installed = install_prefix() / "share" / "boltzmann" / "scenarios";
  if (installed.is_absolute() && fs::is_directory(installed, failure)) return installed.string();
  return (fs::path(__FILE__).parent_path().parent_path().parent_path() / "scenarios").string();
}

std::vector<std::string> shipped_scenarios() {
  std::vector<std::string> names;
  std::error_code failure;
  for (fs::directory_iterator entry(scenario_folder(), failure), end; !failure && entry != end;
       entry.increment(failure))
    if (entry->path().extension() == ".toml") names.push_back(entry->path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string find_scenario(std::string const& file_or_name) {
  if (file_or_name == "-") return file_or_name;
  std::error_code failure;
  if (fs::is_regular_file(file_or_name, failure)) return file_or_name;
  fs::path const shipped = fs::path(scenario_folder()) / (file_or_name + ".toml");
  if (!file_or_name.empty() && file_or_name.find('/') == std::string::npos && fs::is_regular_file(shipped, failure))
    return shipped.string();
  if (fs::is_directory(file_or_name, failure))
    throw Error(fmt::format("'{}' is a directory; a scenario is a file", file_or_name));
  auto const names = shipped_scenarios();
  constexpr std::size_t few = 8;  // greatest number of names in a line
  std::string const there_are = names.size() > few
                                    ? fmt::format("are {} (bzm list)", names.size())
                                    : (names.size() == 1 ? "is " : "are ") + (names.empty() ? "none" : join(names));
  throw Error(fmt::format("there is no file '{}', and no shipped scenario of that name; there {}{}", file_or_name,
                          there_are, did_you_mean(file_or_name, names)));
}

}  // namespace boltzmann
