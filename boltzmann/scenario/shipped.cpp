// Where the shipped scenarios are.
#include <boltzmann/core/error.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace boltzmann {

std::string scenario_folder() {
  namespace fs = std::filesystem;
  if (char const* chosen = std::getenv("BOLTZMANN_SCENARIOS"); chosen && *chosen) return chosen;
  std::error_code failure;
  fs::path const program = fs::read_symlink("/proc/self/exe", failure);
  // Installed: <prefix>/bin/bzm and <prefix>/share/boltzmann/scenarios. Else the source tree.
  fs::path const installed = program.parent_path().parent_path() / "share" / "boltzmann" / "scenarios";
  if (!failure && fs::is_directory(installed, failure)) return installed.string();
  return (fs::path(__FILE__).parent_path().parent_path().parent_path() / "scenarios").string();
}

std::vector<std::string> shipped_scenarios() {
  namespace fs = std::filesystem;
  std::vector<std::string> names;
  std::error_code failure;
  for (fs::directory_iterator entry(scenario_folder(), failure), end; !failure && entry != end;
       entry.increment(failure))
    if (entry->path().extension() == ".toml") names.push_back(entry->path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string find_scenario(std::string const& file_or_name) {
  namespace fs = std::filesystem;
  if (file_or_name == "-") return file_or_name;
  std::error_code failure;
  if (fs::is_regular_file(file_or_name, failure)) return file_or_name;
  fs::path const shipped = fs::path(scenario_folder()) / (file_or_name + ".toml");
  if (!file_or_name.empty() && file_or_name.find('/') == std::string::npos && fs::is_regular_file(shipped, failure))
    return shipped.string();
  if (fs::is_directory(file_or_name, failure))
    throw Error(fmt::format("'{}' is a directory; a scenario is a file", file_or_name));
  auto const names = shipped_scenarios();
  throw Error(fmt::format("there is no file '{}', and no shipped scenario of that name; there {} {}{}", file_or_name,
                          names.size() == 1 ? "is" : "are", names.empty() ? "none" : join(names),
                          did_you_mean(file_or_name, names)));
}

}  // namespace boltzmann
