// What a command line changes in a scenario.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

/// What the command line changes in a scenario.
struct Overrides {
  std::vector<std::string>
      set;  ///< "key.path=value", as TOML would have it ("run.step=0.1", "ensembles.0.mass='63.5 amu'")
  std::optional<std::int64_t> steps;
  std::optional<std::uint64_t> seed;
  std::optional<int> threads;
  std::vector<std::string> vary = {};         ///< "key.path=[values]": instead of what [sweep] varies
  std::optional<std::int64_t> seeds = {};     ///< of each value
  std::optional<std::size_t> sweep_run = {};  ///< the scenario of this run of its [sweep], which goes away
  bool no_sweep = false;                      ///< the scenario as if it had no [sweep]
  bool by_page = false;  ///< `set` comes from a page: it may name what [sweep] varies, since it edits the file's own
                         ///< values, and only files in the folder of the scenario. The page is told of all keys
  std::vector<std::string> without = {};  ///< keys by their paths: the scenario as if they were not there
};

}  // namespace boltzmann
