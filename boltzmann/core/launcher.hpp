// Launcher: the ranks that mpirun, mpiexec or srun start, and the plug-in that makes a team of them.
#pragma once

#include <string>
#include <vector>

namespace boltzmann {

struct Launched {
  int rank = 0;
  int size = 1;  ///< 0: the launcher gives no number of ranks
};
/// From the environment. One rank of one if there is no launcher, if BOLTZMANN_ALONE=1, and in child processes of a
/// rank.
Launched launched();
/// Makes this process a team of one rank, even under a launcher.
void stay_alone();

/// Sets the command line of this process. A rank whose command line differs from that of rank 0 is refused when it
/// joins its team.
void started_with(int argc, char const* const* argv);
/// For a command that only rank 0 runs, without MPI: Error if the launcher has started another rank of this machine
/// with a different command line. Waits half a second if it finds no other rank.
void compare_start_of_ranks();

/// Identifies the machine since its boot, and the group of processes on it that see each other.
std::string where_processes_are_numbered();

/// The ranks of a launch that run on this machine, by their process ids. Launchers do not forward signals reliably, so
/// the process that starts a launcher keeps this object and signals ranks directly. Each rank reports itself through
/// /proc when it joins its team. Ranks on other machines or in other containers do not.
class LocalRanks {
 public:
  /// Sets the environment variable by which ranks find this object. Error if there can be no pipe.
  LocalRanks();
  ~LocalRanks();
  LocalRanks(LocalRanks const&) = delete;
  LocalRanks& operator=(LocalRanks const&) = delete;

  /// Becomes readable when a rank has reported itself.
  int descriptor() const { return ends_[0]; }
  /// Reads new reports; returns the ranks that are new.
  std::vector<int> read_new();
  /// All ranks so far.
  std::vector<int> const& all() const { return all_; }

  /// Called by a rank: reports it to the process that has started its launcher, if there is one. From then on SIGUSR1
  /// is counted while there is no SignalWatch; a second one ends the process with status 130.
  static void report();
  /// The number of such signals; resets the count.
  static int take_early_signals();

 private:
  int ends_[2] = {-1, -1};
  std::string unfinished_;
  std::vector<int> all_;
};

/// The plug-in that makes a team by MPI.
struct MpiPlugin {
  std::string path;     ///< empty: there is none
  std::string library;  ///< "Open MPI v4.1.4, ..."; empty: it can't be opened,
  std::string reason;   ///< for this reason
};
/// Searches BOLTZMANN_MPI first. Otherwise searches beside this program and beside the bzm of the PATH, in the
/// lib/boltzmann that belongs to their folders, in ~/.local/lib/boltzmann, /usr/local/lib/boltzmann and
/// /usr/lib/boltzmann.
std::string find_mpi_plugin();
/// Finds and opens the plug-in.
MpiPlugin open_mpi_plugin();
/// The shell command that builds the plug-in where find_mpi_plugin() searches.
std::string how_to_make_mpi_plugin();

}  // namespace boltzmann
