// MemoryTeam: what ranks of one machine tell each other, through memory that all of them see. MPI starts them; its own
// messages between processes are copied twice, in small pieces.
#pragma once

#include <boltzmann/core/team_functions.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

/// A rank's side. Each has two *outboxes*, files without a name that others map: what it says in one operation of the
/// team (a sum, a broadcast, ...) stands in the one, in the next in the other. Nobody writes into an outbox before all
/// have read it: who begins the operation after the next has seen all others begin the next one.
class MemoryTeam {
 public:
  /// `launched` is the table by which ranks leave, and end all others.
  MemoryTeam(int rank, int size, BoltzmannTeamFunctions const& launched, void* of);
  ~MemoryTeam();
  MemoryTeam(MemoryTeam const&) = delete;
  MemoryTeam& operator=(MemoryTeam const&) = delete;

  /// Where the others find this rank's outboxes; empty if there can be none.
  std::string address() const;
  /// Opens those of all ranks. False if one can't be seen from here: it is on another machine, or behind a wall.
  bool open(std::vector<std::string> const& addresses);

  /// The table of a team, each `of` a MemoryTeam that is open. A rank that has no room for what it says ends all.
  static BoltzmannTeamFunctions const& functions();

 private:
  class Outbox;
  struct Rank;
  enum class Kind { reduce, broadcast, gather, exchange };
  struct Operation {  // that is under way
    Kind kind{};
    std::int64_t* numbers = nullptr;  // of a reduction
    void* bytes = nullptr;            // that come
    int count = 0, operation = 0, from = 0;
    std::vector<BoltzmannMessage> received;
    bool in_slices = false;  // each rank combines one
    bool combined = false;   // this rank's is
  };
  static MemoryTeam& self(void* of) { return *static_cast<MemoryTeam*>(of); }
  std::size_t box() const { return begun_ % 2; }
  char* room(std::size_t bytes);
  struct Place {  // of what a rank says to another, in an outbox
    std::uint64_t begin = 0, end = 0;
  };
  char* room_for_ranks(std::vector<Place> const& places);
  std::span<char const> said_to_this(int rank) const;
  void post();
  bool all_have_posted();
  void begin_exchange(BoltzmannMessage const* messages, int count);
  bool done();
  void combine(std::int64_t* to, std::size_t begin, std::size_t end) const;
  [[noreturn]] void end_all(char const* line);

  int rank_, size_;
  BoltzmannTeamFunctions const* launched_;
  void* of_;
  std::vector<std::unique_ptr<Rank>> ranks_;
  Operation now_;
  std::uint64_t begun_ = 0, posts_ = 0;  // operations, and what this rank has posted
  int seen_ = 0;                         // ranks that have posted as much
  std::size_t read_ = 0;                 // the outboxes of the last operation
};

}  // namespace boltzmann
