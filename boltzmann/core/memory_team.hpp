// MemoryTeam: messages between ranks of one machine, through shared memory. MPI starts the ranks; its own messages
// between processes are copied twice, in small pieces.
#pragma once

#include <boltzmann/core/team_functions.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

/// A rank's side. Each rank has two *outboxes*, unnamed files that the others map. Successive operations of the team (a
/// sum, a broadcast, ...) use them alternately. An outbox is overwritten only after all ranks have read it: a rank that
/// begins an operation has seen all others begin the one before.
class MemoryTeam {
 public:
  /// `launched` is the table by which ranks leave the team, or abort it.
  MemoryTeam(int rank, int size, BoltzmannTeamFunctions const& launched, void* of);
  ~MemoryTeam();
  MemoryTeam(MemoryTeam const&) = delete;
  MemoryTeam& operator=(MemoryTeam const&) = delete;

  /// The address of this rank's outboxes for the others; empty if it has none.
  std::string address() const;
  /// Opens the outboxes of all ranks. False if one is not visible from here: its rank is on another machine or in
  /// another container.
  bool open(std::vector<std::string> const& addresses);

  /// The table of functions of a team, where each `of` is an open MemoryTeam. A rank without memory for its messages
  /// aborts all.
  static BoltzmannTeamFunctions const& functions();

 private:
  class Outbox;
  struct Rank;
  enum class Kind { reduce, broadcast, gather, exchange };
  struct Operation {  // the pending one
    Kind kind{};
    std::int64_t* numbers = nullptr;  // of a reduction
    void* bytes = nullptr;            // incoming
    int count = 0, operation = 0, from = 0;
    std::vector<BoltzmannMessage> received;
    bool in_slices = false;  // each rank combines one slice
    bool combined = false;   // this rank's slice is combined
  };
  static MemoryTeam& self(void* of) { return *static_cast<MemoryTeam*>(of); }
  std::size_t box() const { return begun_ % 2; }
  char* room(std::size_t bytes);
  struct Place {  // of a message to a rank, in an outbox
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
  std::uint64_t begun_ = 0, posts_ = 0;  // operations, and posts of this rank
  int seen_ = 0;                         // ranks with as many posts
  std::size_t read_ = 0;                 // outboxes of the last operation that have been read
};

}  // namespace boltzmann
