// Runs a command on several ranks: bzm run copper --ranks 4.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace boltzmann::bzm {

/// The number of processes of a run, and their hosts.
struct Ranks {
  std::optional<int> count;
  std::string hosts;  ///< a host file; empty: this machine
};

/// Starts this command, whose words are given without --ranks and --hosts, on these ranks by the mpirun or mpiexec of
/// the PATH, and waits. Signals that stop a run (Ctrl-C, SIGTERM, SIGHUP) are forwarded; a second one ends all ranks.
/// Returns the exit status of the ranks. Throws Error if there is no launcher or no plug-in (core/launcher.hpp).
int run_on_ranks(std::vector<std::string> const& words, Ranks const& ranks);

/// The version of the launcher in one line; empty if there is none.
std::string launcher_version();

}  // namespace boltzmann::bzm
