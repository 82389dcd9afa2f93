// A command on several ranks: bzm run copper --ranks 4.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace boltzmann::bzm {

/// How many processes do a run together.
struct Ranks {
  std::optional<int> count;
  std::string hosts;  ///< a file that says where; empty: here
};

/// Starts this command, whose words are given without --ranks and --hosts, on so many ranks by the mpirun or mpiexec of
/// the PATH, and waits. What stops a run (Ctrl-C, SIGTERM, SIGHUP) is handed on; a second one ends all. Gives the exit
/// status of the ranks. Error if there is no launcher or no plug-in (core/launcher.hpp).
int run_on_ranks(std::vector<std::string> const& words, Ranks const& ranks);

/// What is found to launch with, in one line; empty: nothing.
std::string launcher_version();

}  // namespace boltzmann::bzm
