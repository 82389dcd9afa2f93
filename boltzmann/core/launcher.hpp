// Launcher: what mpirun, mpiexec or srun say to the processes that they start, and the plug-in by which these become a
// team.
#pragma once

#include <string>

namespace boltzmann {

struct Launched {
  int rank = 0;
  int size = 1;  ///< 0: the launcher has not said of how many
};
/// From the environment; one rank of one where there is no launcher, where BOLTZMANN_ALONE=1 says so, and in what a rank
/// starts.
Launched launched();
/// This process does something of its own, whatever has started it: its team is of one rank.
void stay_alone();

/// The plug-in that makes a team by MPI.
struct MpiPlugin {
  std::string path;     ///< empty: there is none
  std::string library;  ///< "Open MPI v4.1.4, ..."; empty: it can't be opened,
  std::string reason;   ///< for this reason
};
/// Looks where BOLTZMANN_MPI says; else beside this program and beside the bzm of the PATH, in the lib/boltzmann that
/// belongs to their folders, in ~/.local/lib/boltzmann, /usr/local/lib/boltzmann and /usr/lib/boltzmann.
std::string find_mpi_plugin();
/// The same, opened.
MpiPlugin open_mpi_plugin();
/// The line of a shell that makes it; it goes to where find_mpi_plugin() looks.
std::string how_to_make_mpi_plugin();

}  // namespace boltzmann
