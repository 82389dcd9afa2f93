// Team: the processes ("ranks") that do one run together. Every rank runs the same program; rank 0 prints and writes.
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

/// Something that is neither an Error nor a PhysicsFailure nor a lack of memory has ended another rank. The line is that
/// rank's, and so is the exit status.
struct TeamFailure : std::runtime_error {
  TeamFailure(std::string const& line, int of_rank) : std::runtime_error(line), status(of_rank) {}
  int status;
};

/// A failure of a rank, or of a vote, that all ranks of a run throw together.
struct AgreedFailure {
  std::exception_ptr failure;
};

/// All calls of a team but rank() and the like are for all its ranks, in the same order. A rank waits for the others;
/// where they don't come within BOLTZMANN_PATIENCE seconds (the environment; 600 unless told), it ends them all with a
/// line.
class Team {
 public:
  /// What a rank has come to when it votes: all have to come to the same.
  enum class Occasion : std::int64_t {
    prepares,
    run_begins,
    in_run,
    run_ends,
    between_runs,
    program_ends,
    exchanges,  ///< rows that are read where they are not owned
    gathers,    ///< rows, for whoever looks at all of them
    follows,    ///< its particles, to find out whether neighbours are still known
    step_ends,
  };
  /// Numbers of which all ranks are told the greatest.
  using Most = std::array<std::int64_t, 6>;

  /// What a rank says in a vote.
  struct Ballot {
    Occasion occasion;
    bool stop = false, pause = false;
    std::int64_t place = 0;                                        ///< of a run: steps done
    std::int64_t next = std::numeric_limits<std::int64_t>::max();  ///< steps to the next vote
    std::uint64_t checksum = 0;                                    ///< of what has to be the same,
    char const* what = "";                                         ///< where a run is prepared: this
    Most most{};
  };

  /// What all ranks then know.
  struct Outcome {
    bool stop = false, pause = false;  ///< whether any rank says so
    bool same_place = true;
    std::int64_t last_place = 0;  ///< of the rank that is ahead of all
    std::int64_t next = 0;        ///< the smallest
    Most most{};
    std::exception_ptr failure;  ///< of a rank, the same line on all; or of the vote: ranks do different things
  };

  /// One rank, which waits for nobody.
  Team() = default;
  /// A rank that has joined others. The functions, and `of`, outlive it.
  Team(BoltzmannTeamFunctions const& functions, void* of, int rank, int size);
  /// From here on by these functions. For all ranks.
  void speak_by(BoltzmannTeamFunctions const& functions, void* of) { functions_ = &functions, of_ = of; }
  Team(Team const&) = delete;
  Team& operator=(Team const&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }
  /// Whether this rank prints and writes.
  bool first() const { return rank_ == 0; }
  bool alone() const { return size_ == 1; }

  /// Each number becomes that of all ranks; the order of ranks does not matter.
  void sum(std::span<std::int64_t> numbers);
  void min(std::span<std::int64_t> numbers);
  void max(std::span<std::int64_t> numbers);
  /// Becomes what the rank has.
  void broadcast(std::string& bytes, int from = 0);
  /// What each rank has, on every rank.
  std::vector<std::string> gather(std::string const& mine);
  /// Bytes for a rank, or from one.
  struct Message {
    int rank;
    bool receive;
    void* bytes;
    std::size_t size;
  };
  /// Between pairs of ranks, none with itself: each that one sends is received by the other, with as many bytes, in the
  /// order in which the pair's are listed.
  void exchange(std::span<Message const> messages);
  /// A message of doubles from each rank to each other one, of sizes that both know: write(r, to) writes that for rank r,
  /// read(r, from) reads that of rank r. Without a copy where ranks see each other's memory.
  void exchange(std::span<std::size_t const> sent, std::span<std::size_t const> received,
                std::function<void(std::size_t r, double* to)> const& write,
                std::function<void(std::size_t r, double const* from)> const& read);
  /// What this rank has had to do with others.
  struct Counts {
    std::uint64_t collectives = 0;  ///< sums, minima, broadcasts, gathers and exchanges: one wait each
    std::uint64_t messages = 0;     ///< that it has sent in exchanges,
    std::uint64_t bytes = 0;        ///< with so many bytes,
    std::uint64_t numbers = 0;      ///< and its numbers in sums, minima and maxima
  };
  Counts const& counts() const { return counts_; }
  /// Processor time that this rank has spent waiting for others, in seconds: what is left of all of it is work.
  double waited() const { return waited_; }
  /// How long a rank waits.
  void patience(double seconds) { patience_ = seconds; }

  /// Tells all ranks what each says, and whether one has failed: by this exception, if it is this one. Whatever fails,
  /// all ranks have the same outcome.
  Outcome vote(Ballot const& ballot, std::exception_ptr const& failed = nullptr);
  /// A vote inside a run, before all that ranks do together in it. What has failed on any rank is thrown by all: as an
  /// AgreedFailure, for whoever runs.
  Outcome meet(Occasion occasion, Most const& most = {});
  /// Throws what has failed on any rank.
  static void check(Outcome const& outcome) {
    if (outcome.failure) std::rethrow_exception(outcome.failure);
  }

  /// Calls it on every rank; what it throws on one, all throw. Inside a run just calls it: a run tells of failures.
  void agree(std::function<void()> const& function);
  /// Calls it on rank 0 while the others wait; what it throws, all throw.
  void on_first(std::function<void()> const& function);
  /// What rank 0 says; whether any rank says so.
  bool first_says(bool mine);
  bool any(bool mine);
  /// Error on all ranks, naming one, if they don't have the same; `what` says of what: "scenario".
  void same(std::string_view text, char const* what);

  /// While it lives, this rank is inside a run, whose votes are its own.
  class Inside {
   public:
    explicit Inside(Team& team) : team_(team) { ++team_.depth_; }
    ~Inside() { --team_.depth_; }
    Inside(Inside const&) = delete;
    Inside& operator=(Inside const&) = delete;

   private:
    Team& team_;
  };
  /// How many runs this rank is inside of: a run in an observer is in another.
  int depth() const { return depth_; }

  /// Keeps the line with which this rank fails. Whether it is still to be printed: what ends all ranks may be thrown by
  /// more than one call.
  bool tell(std::string const& line) { return std::exchange(told_, line) != line; }
  /// The program of this rank is at its end, with an exit status. Waits for all, however long they take; gives the exit
  /// status for all ranks: that of the lowest rank that fails.
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
  std::vector<std::vector<double>> sent_, received_;  // where messages are copied
  Occasion occasion_ = Occasion::between_runs;        // of the vote that is waited for
  std::exception_ptr over_;                           // a failure after which ranks can't vote any more
  std::string told_;
};

/// The team of this process: of several ranks under a launcher (launcher.hpp), by MPI, else of one. The first call joins
/// it: from then on ranks above 0 print nothing, and the process ends with the exit status of all. Error if the launcher
/// has started several processes and they can't become a team. Simulations and Programs ask for it; what a program prints
/// before its first one is printed by every rank unless it has asked.
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

/// Prints the one line of a failure on standard error, of whichever rank it is.
void tell_failure(std::string const& line);
/// The same where no other rank is asked any more.
void tell_last_words(std::string const& line);
/// An exit status for an exception: 2 of an Error, 3 of a PhysicsFailure, 1 of anything else.
int exit_status(std::exception_ptr const& failure);

}  // namespace boltzmann
