// Launcher: what mpirun, mpiexec or srun say to the processes that they start, and the plug-in by which these become a
// team.
#pragma once

#include <string>
#include <vector>

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

/// Says with which words this process was started. Ranks that were started with other words than rank 0 are refused when
/// they join their team.
void started_with(int argc, char const* const* argv);
/// For a program that rank 0 alone does, without MPI: Error if the launcher has started another rank of this machine with
/// other words. Looks for half a second if it finds no other rank.
void compare_start_of_ranks();

/// The machine, since it was started, and the processes that see each other on it.
std::string where_processes_are_numbered();

/// The ranks of a launch that run on this machine, by their process ids. Launchers do not forward signals reliably, so
/// the process that starts a launcher keeps this, and signals ranks directly. Each rank reports itself when it joins its
/// team; /proc carries the reports, so ranks on other machines and behind the walls of a container do not.
class LocalRanks {
 public:
  /// Sets the environment variable by which ranks find this. Error if there can be no pipe.
  LocalRanks();
  ~LocalRanks();
  LocalRanks(LocalRanks const&) = delete;
  LocalRanks& operator=(LocalRanks const&) = delete;

  /// Readable when a rank has reported itself.
  int descriptor() const { return ends_[0]; }
  /// Reads what has been reported; returns the ranks that are new.
  std::vector<int> read_new();
  /// All so far.
  std::vector<int> const& all() const { return all_; }

  /// Called by a rank: reports it to the process that has started its launcher, if there is one. From then on SIGUSR1
  /// is counted while no SignalWatch lives; a second one ends the process with status 130.
  static void report();
  /// How often it has come so; counting starts anew.
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
/// Looks where BOLTZMANN_MPI says; else beside this program and beside the bzm of the PATH, in the lib/boltzmann that
/// belongs to their folders, in ~/.local/lib/boltzmann, /usr/local/lib/boltzmann and /usr/lib/boltzmann.
std::string find_mpi_plugin();
/// The same, opened.
MpiPlugin open_mpi_plugin();
/// The line of a shell that makes it; it goes to where find_mpi_plugin() looks.
std::string how_to_make_mpi_plugin();

}  // namespace boltzmann
