// Changes of a scenario by the command line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

/// Changes of a scenario by the command line.
struct Overrides {
  std::vector<std::string>
      set;  ///< "key.path=value", as TOML would have it ("run.step=0.1", "ensembles.0.mass='63.5 amu'")
  std::optional<std::int64_t> steps;
  std::optional<std::uint64_t> seed;
  std::optional<int> threads;
  std::vector<std::string> vary = {};         ///< "key.path=[values]": instead of what [sweep] varies
  std::optional<std::int64_t> seeds = {};     ///< for each value
  std::optional<std::size_t> sweep_run = {};  ///< load the scenario of this run of its [sweep], without [sweep]
  bool no_sweep = false;                      ///< ignore [sweep]
  bool by_page = false;  ///< `set` comes from a page: it may change keys that [sweep] varies, since it edits the file's
                         ///< own values, and name only files in the folder of the scenario. The page receives all keys
  std::vector<std::string> without = {};  ///< paths of keys to ignore
};

}  // namespace boltzmann
