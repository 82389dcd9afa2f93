// Team: the processes ("ranks") of one run. Every rank runs the same program; rank 0 prints and writes.
#pragma once

#include <array>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

struct BoltzmannTeamFunctions;

namespace boltzmann {

/// Another rank has ended by an exception that is neither an Error, nor a PhysicsFailure, nor a lack of memory. The
/// line and the exit status are those of that rank.
struct TeamFailure : std::runtime_error {
  TeamFailure(std::string const& line, int of_rank) : std::runtime_error(line), status(of_rank) {}
  int status;
};

/// A failure of a rank, or of a vote, that all ranks of a run throw together.
struct AgreedFailure {
  std::exception_ptr failure;
};

/// All calls of a team except rank() and other queries are collective: all ranks make them in the same order. If other
/// ranks don't arrive within BOLTZMANN_PATIENCE seconds (environment; default 600), the waiting rank aborts all with a
/// message.
class Team {
 public:
  /// The point of the program at which a rank votes; it has to be the same on all ranks.
  enum class Occasion : std::int64_t {
    prepares,
    run_begins,
    in_run,
    run_ends,
    between_runs,
    program_ends,
    exchanges,  ///< rows that are read where they are not owned
    gathers,    ///< rows, for an observer of all rows
    follows,    ///< its particles, to check whether neighbour lists are still valid
    step_ends,
  };
  /// Numbers of which all ranks get the maximum.
  using Most = std::array<std::int64_t, 6>;

  /// The contribution of a rank to a vote.
  struct Ballot {
    Occasion occasion;
    bool stop = false, pause = false;
    std::int64_t place = 0;                                        ///< of a run: steps done
    std::int64_t next = std::numeric_limits<std::int64_t>::max();  ///< steps to the next vote
    std::uint64_t checksum = 0;                                    ///< of data that has to be the same,
    char const* what = "";                                         ///< and its name, if a run is prepared
    Most most{};
  };

  /// The result of a vote, the same on all ranks.
  struct Outcome {
    bool stop = false, pause = false;  ///< whether any rank requests it
    bool same_place = true;
    std::int64_t last_place = 0;  ///< of the most advanced rank
    std::int64_t next = 0;        ///< the smallest
    Most most{};
    std::exception_ptr failure;  ///< of a rank, the same line on all; or of the vote: ranks are at different points
  };

  /// A team of one rank.
  Team() = default;
  /// A rank that has joined others. The functions and `of` must outlive it.
  Team(BoltzmannTeamFunctions const& functions, void* of, int rank, int size);
  /// Uses these functions from here on. For all ranks.
  void speak_by(BoltzmannTeamFunctions const& functions, void* of) { functions_ = &functions, of_ = of; }
  Team(Team const&) = delete;
  Team& operator=(Team const&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }
  /// True if this rank prints and writes.
  bool first() const { return rank_ == 0; }
  bool alone() const { return size_ == 1; }

  /// Replaces each number by its sum over all ranks; the order of ranks does not matter.
  void sum(std::span<std::int64_t> numbers);
  void min(std::span<std::int64_t> numbers);
  void max(std::span<std::int64_t> numbers);
  /// Replaces `bytes` by those of rank `from`.
  void broadcast(std::string& bytes, int from = 0);
  /// The texts of all ranks, on every rank.
  std::vector<std::string> gather(std::string const& mine);
  /// Bytes to a rank, or from one.
  struct Message {
    int rank;
    bool receive;
    void* bytes;
    std::size_t size;
  };
  /// Exchanges messages between pairs of ranks, none with itself. Each sent message is received by the other rank, with
  /// the same size, in the order in which the messages of the pair are listed.
  void exchange(std::span<Message const> messages);
  /// Exchanges one message of doubles between each two ranks, of sizes that both ranks have: write(r, to) writes the
  /// one for rank r, read(r, from) reads the one from rank r. Nothing is copied if ranks see each other's memory.
  void exchange(std::span<std::size_t const> sent, std::span<std::size_t const> received,
                std::function<void(std::size_t r, double* to)> const& write,
                std::function<void(std::size_t r, double const* from)> const& read);
  /// Counts the communication of this rank.
  struct Counts {
    std::uint64_t collectives = 0;  ///< sums, minima, broadcasts, gathers and exchanges: one wait each
    std::uint64_t messages = 0;     ///< sent in exchanges,
    std::uint64_t bytes = 0;        ///< their total size,
    std::uint64_t numbers = 0;      ///< numbers in sums, minima and maxima
  };
  Counts const& counts() const { return counts_; }
  /// Processor time that this rank has spent waiting for others, in seconds; the rest of its processor time is work.
  double waited() const { return waited_; }
  /// Sets the time limit of a wait.
  void patience(double seconds) { patience_ = seconds; }

  /// Collects the ballots of all ranks. `failed` is the exception with which this rank has failed, if any. All ranks
  /// get the same outcome, for any failure.
  Outcome vote(Ballot const& ballot, std::exception_ptr const& failed = nullptr);
  /// A vote inside a run, before each collective operation. A failure of any rank is thrown by all, as an
  /// AgreedFailure.
  Outcome meet(Occasion occasion, Most const& most = {});
  /// Throws the failure of any rank.
  static void check(Outcome const& outcome) {
    if (outcome.failure) std::rethrow_exception(outcome.failure);
  }

  /// Calls the function on every rank; an exception on one is thrown by all. Inside a run it only calls it: the run
  /// votes on failures.
  void agree(std::function<void()> const& function);
  /// Calls the function on rank 0 while the others wait; its exception is thrown by all.
  void on_first(std::function<void()> const& function);
  /// The value of rank 0; the other: whether it is true on any rank.
  bool first_says(bool mine);
  bool any(bool mine);
  /// Error on all ranks, naming one, if their texts differ; `what` names the text: "scenario".
  void same(std::string_view text, char const* what);

  /// While it lives, this rank is inside a run, which makes its own votes.
  class Inside {
   public:
    explicit Inside(Team& team) : team_(team) { ++team_.depth_; }
    ~Inside() { --team_.depth_; }
    Inside(Inside const&) = delete;
    Inside& operator=(Inside const&) = delete;

   private:
    Team& team_;
  };
  /// The number of nested runs that this rank is inside of: an observer may run another simulation.
  int depth() const { return depth_; }

  /// Stores the message with which this rank fails. True if it is still to be printed: more than one call may throw a
  /// failure that ends all ranks.
  bool tell(std::string const& line) { return std::exchange(told_, line) != line; }
  /// Ends the program of this rank with an exit status. Waits for all ranks without a time limit; returns the exit
  /// status for all, that of the lowest rank that fails.
  int end(int status);

 private:
  void reduce(std::span<std::int64_t> numbers, int operation);
  void wait();
  [[noreturn]] void give_up(std::string const& line);
  std::exception_ptr failure_of(int rank, Ballot const& ballot, std::exception_ptr const& mine);
  std::exception_ptr other_occasions(Ballot const& ballot);
  std::exception_ptr other_checksums(Ballot const& ballot);

  BoltzmannTeamFunctions const* functions_ = nullptr;
  void* of_ = nullptr;
  int rank_ = 0, size_ = 1, depth_ = 0;
  double patience_ = std::numeric_limits<double>::infinity();
  double waited_ = 0;
  Counts counts_;
  std::vector<std::vector<double>> sent_, received_;  // buffers of copied messages
  Occasion occasion_ = Occasion::between_runs;        // of the pending vote
  std::exception_ptr over_;                           // a failure after which ranks can't vote any more
  std::string told_;
};

/// The team of this process: several ranks under a launcher (launcher.hpp), by MPI, else one. The first call joins it.
/// From then on ranks above 0 print nothing, and the process ends with the exit status of all. Error if the launcher
/// has started several processes and they can't become a team. Simulations and Programs call it. A program that prints
/// earlier prints on every rank, unless it calls team() first.
Team& team();

/// While it lives, this is the team of the calling thread: ranks that are threads of one process, for tests.
class ActingTeam {
 public:
  explicit ActingTeam(Team& team);
  ~ActingTeam();
  ActingTeam(ActingTeam const&) = delete;
  ActingTeam& operator=(ActingTeam const&) = delete;

 private:
  Team* before_;
};

/// Prints the one line of a failure on standard error, on any rank.
void tell_failure(std::string const& line);
/// The same without contact to other ranks.
void tell_last_words(std::string const& line);
/// The exit status for an exception: 2 for an Error, 3 for a PhysicsFailure, 1 for anything else.
int exit_status(std::exception_ptr const& failure);

}  // namespace boltzmann
