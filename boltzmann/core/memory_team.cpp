// Outboxes, and the operations of a team that use them.
#include <boltzmann/core/memory_team.hpp>

#include <boltzmann/core/launcher.hpp>
#include <boltzmann/core/team.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>
#include <string>
#include <utility>

namespace boltzmann {
namespace {

constexpr std::size_t page = 1 << 16;  // unit of growth of outboxes, in bytes
constexpr std::size_t few = 1024;      // numbers that every rank adds up by itself
constexpr char const* no_memory = "not enough shared memory for the messages between ranks";

/// The state of a rank that all others see. Zeros, as in a new file, are its initial value.
struct Head {
  std::uint64_t token;                             // identifies the team
  alignas(64) std::atomic<std::uint64_t> posted;   // number of posts
  std::atomic<std::uint64_t> ended;                // the rank has aborted the team
  alignas(64) std::atomic<std::uint64_t> room[2];  // sizes of its outboxes, in bytes
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

/// An unnamed file in memory; -1 if there can be none.
int new_file() {
#if defined(__linux__)
  return memfd_create("boltzmann", MFD_CLOEXEC);
#else
  return -1;
#endif
}

/// Allocates memory for it now: writing to more memory than the machine has would kill the process.
bool grow(int file, std::size_t size) {
#if defined(__linux__)
  return file >= 0 && posix_fallocate(file, 0, static_cast<off_t>(size)) == 0;
#else
  return false;
#endif
}

}  // namespace

/// The mapped bytes of a file. They move when the mapping grows.
class MemoryTeam::Outbox {
 public:
  explicit Outbox(int file = -1) : file_(file) {}
  ~Outbox() {
    unmap();
    if (file_ >= 0) close(file_);
  }
  Outbox(Outbox const&) = delete;
  Outbox& operator=(Outbox const&) = delete;

  int file() const { return file_; }
  void file(int file) { file_ = file; }
  /// Null if they can't be mapped.
  char* bytes(std::size_t size) {
    if (size <= size_) return bytes_;
    unmap();
    void* const at = file_ < 0 ? MAP_FAILED : mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
    if (at == MAP_FAILED) return nullptr;
    bytes_ = static_cast<char*>(at);
    size_ = size;
    return bytes_;
  }

 private:
  void unmap() {
    if (bytes_) munmap(bytes_, size_);
    bytes_ = nullptr;
    size_ = 0;
  }

  int file_;
  char* bytes_ = nullptr;
  std::size_t size_ = 0;
};

struct MemoryTeam::Rank {
  Outbox head_file, outboxes[2];
  Head* head = nullptr;
  bool opens(std::size_t box) {
    return outboxes[box].bytes(head->room[box].load(std::memory_order_acquire)) != nullptr;
  }
  /// The bytes that the rank has written.
  char* said(std::size_t box) {
    char* const bytes = outboxes[box].bytes(head->room[box].load(std::memory_order_acquire));
    if (bytes) return bytes;
    tell_last_words(no_memory);
    std::abort();  // the launcher then ends the others
  }
};

MemoryTeam::MemoryTeam(int rank, int size, BoltzmannTeamFunctions const& launched, void* of)
    : rank_(rank), size_(size), launched_(&launched), of_(of) {
  for (int r = 0; r < size; ++r) ranks_.push_back(std::make_unique<Rank>());
  Rank& mine = *ranks_[static_cast<std::size_t>(rank)];
  mine.head_file.file(new_file());
  for (auto& box : mine.outboxes) box.file(new_file());
  if (!grow(mine.head_file.file(), sizeof(Head))) return;
  mine.head = reinterpret_cast<Head*>(mine.head_file.bytes(sizeof(Head)));
  if (!mine.head) return;
  std::random_device random;  // for a name only, not for results
  mine.head->token = (std::uint64_t{random()} << 32U | random()) | 1U;
  for (std::size_t box = 0; box < 2; ++box)
    if (grow(mine.outboxes[box].file(), page)) mine.head->room[box] = page;
}

MemoryTeam::~MemoryTeam() = default;

std::string MemoryTeam::address() const {
  Rank const& mine = *ranks_[static_cast<std::size_t>(rank_)];
  if (!mine.head || mine.head->room[0] == 0 || mine.head->room[1] == 0) return "";
  return fmt::format("{} {} {} {} {} {}", getpid(), mine.head_file.file(), mine.outboxes[0].file(),
                     mine.outboxes[1].file(), mine.head->token, where_processes_are_numbered());
}

bool MemoryTeam::open(std::vector<std::string> const& addresses) {
  std::string const here = where_processes_are_numbered();
  for (int r = 0; r < size_; ++r) {
    Rank& rank = *ranks_[static_cast<std::size_t>(r)];
    long process = 0;
    int head = -1, boxes[2] = {-1, -1};
    unsigned long long token = 0;
    auto const& address = addresses[static_cast<std::size_t>(r)];
    if (std::sscanf(address.c_str(), "%ld %d %d %d %llu", &process, &head, boxes, boxes + 1, &token) != 5 ||
        !address.ends_with(here))
      return false;
    if (r == rank_) continue;
    auto const open_here = [&](Outbox& box, int file) {
      box.file(::open(fmt::format("/proc/{}/fd/{}", process, file).c_str(), O_RDWR | O_CLOEXEC));
      return box.file() >= 0;
    };
    if (!open_here(rank.head_file, head)) return false;
    rank.head = reinterpret_cast<Head*>(rank.head_file.bytes(sizeof(Head)));
    if (!rank.head || rank.head->token != token) return false;
    for (std::size_t box = 0; box < 2; ++box)
      if (!open_here(rank.outboxes[box], boxes[box]) || !rank.opens(box)) return false;
  }
  return true;
}

void MemoryTeam::end_all(char const* line) {
  ranks_[static_cast<std::size_t>(rank_)]->head->ended = 1;
  tell_last_words(line);
  launched_->abort(of_, 1);
  throw TeamFailure(line, 1);
}

/// Memory for the message of this rank in this operation.
char* MemoryTeam::room(std::size_t bytes) {
  Rank& mine = *ranks_[static_cast<std::size_t>(rank_)];
  auto& size = mine.head->room[box()];
  if (bytes > size) {
    std::size_t const more = (bytes + bytes / 4 + page) / page * page;
    if (!grow(mine.outboxes[box()].file(), more)) end_all(no_memory);
    size.store(more, std::memory_order_release);
  }
  return mine.said(box());
}

void MemoryTeam::post() {
  seen_ = 0;
  ranks_[static_cast<std::size_t>(rank_)]->head->posted.store(++posts_, std::memory_order_release);
}

bool MemoryTeam::all_have_posted() {
  for (; seen_ < size_; ++seen_) {
    Head const& head = *ranks_[static_cast<std::size_t>(seen_)]->head;
    bool const posted = head.posted.load(std::memory_order_acquire) >= posts_;
    if (head.ended.load(std::memory_order_relaxed) != 0) throw TeamFailure("another rank has ended all", 1);
    if (!posted) return false;
  }
  return true;
}

/// Combines the numbers [begin, end) of all ranks.
void MemoryTeam::combine(std::int64_t* to, std::size_t begin, std::size_t end) const {
  auto const over = [&](auto const& combined) {
    bool first = true;
    for (auto const& rank : ranks_) {
      auto const* const from = reinterpret_cast<std::int64_t const*>(rank->said(box()));
      if (std::exchange(first, false))
        std::memmove(to + begin, from + begin, (end - begin) * sizeof *to);
      else
        for (std::size_t k = begin; k < end; ++k) to[k] = combined(to[k], from[k]);
    }
  };
  if (now_.operation == boltzmann_team_sum)
    over([](std::int64_t a, std::int64_t b) { return a + b; });
  else if (now_.operation == boltzmann_team_min)
    over([](std::int64_t a, std::int64_t b) { return std::min(a, b); });
  else
    over([](std::int64_t a, std::int64_t b) { return std::max(a, b); });
}

// Memory for the index of the messages to each rank, which is written here, and for the messages after it.
char* MemoryTeam::room_for_ranks(std::vector<Place> const& places) {
  std::size_t const index = places.size() * sizeof(Place);
  std::uint64_t end = index;
  for (auto const& place : places) end = std::max(end, place.end);
  char* const box = room(end);
  std::memcpy(box, places.data(), index);
  return box;
}

/// The bytes that a rank has written for this one.
std::span<char const> MemoryTeam::said_to_this(int rank) const {
  char const* const box = ranks_[static_cast<std::size_t>(rank)]->said(read_);
  Place place;
  std::memcpy(&place, box + static_cast<std::size_t>(rank_) * sizeof place, sizeof place);
  return {box + place.begin, place.end - place.begin};
}

// A message that is the same for several ranks is written once.
void MemoryTeam::begin_exchange(BoltzmannMessage const* messages, int count) {
  using Said = std::vector<std::pair<void const*, std::size_t>>;
  now_ = {};
  now_.kind = Kind::exchange;
  auto const ranks = static_cast<std::size_t>(size_);
  std::vector<Said> said(ranks);
  for (int k = 0; k < count; ++k)
    if (messages[k].receive)
      now_.received.push_back(messages[k]);
    else
      said[static_cast<std::size_t>(messages[k].rank)].emplace_back(messages[k].bytes,
                                                                    static_cast<std::size_t>(messages[k].count));
  std::vector<Place> places(ranks);
  std::vector<std::size_t> written;  // ranks whose message is written; others may share it
  std::uint64_t at = ranks * sizeof(Place);
  for (std::size_t r = 0; r < ranks; ++r) {
    auto const same =
        std::find_if(written.begin(), written.end(), [&](std::size_t other) { return said[other] == said[r]; });
    if (same != written.end()) {
      places[r] = places[*same];
      continue;
    }
    written.push_back(r);
    places[r] = {at, at};
    for (auto const& [bytes, size] : said[r]) places[r].end += size;
    at = places[r].end;
  }
  char* const box = room_for_ranks(places);
  for (std::size_t const r : written) {
    std::uint64_t to = places[r].begin;
    for (auto const& [bytes, size] : said[r]) {
      std::memcpy(box + to, bytes, size);
      to += size;
    }
  }
  post();
}

bool MemoryTeam::done() {
  if (!all_have_posted()) return false;
  read_ = box();
  auto const said = [this](int rank) { return ranks_[static_cast<std::size_t>(rank)]->said(box()); };
  auto const count = static_cast<std::size_t>(now_.count), ranks = static_cast<std::size_t>(size_);
  auto const slice = [&](std::size_t r) { return count * r / ranks; };
  switch (now_.kind) {
    case Kind::reduce:
      if (!now_.in_slices) {
        combine(now_.numbers, 0, count);
      } else if (!std::exchange(now_.combined, true)) {
        auto const r = static_cast<std::size_t>(rank_);
        combine(now_.numbers, slice(r), slice(r + 1));
        std::copy(now_.numbers + slice(r), now_.numbers + slice(r + 1),
                  reinterpret_cast<std::int64_t*>(said(rank_)) + slice(r));
        post();
        return done();
      } else {
        for (std::size_t r = 0; r < ranks; ++r)
          if (static_cast<int>(r) != rank_)
            std::memcpy(now_.numbers + slice(r), said(static_cast<int>(r)) + slice(r) * sizeof(std::int64_t),
                        (slice(r + 1) - slice(r)) * sizeof(std::int64_t));
      }
      break;
    case Kind::broadcast:
      if (now_.from != rank_) std::memcpy(now_.bytes, said(now_.from), count);
      break;
    case Kind::gather:
      for (int r = 0; r < size_; ++r)
        std::memcpy(static_cast<char*>(now_.bytes) + static_cast<std::size_t>(r) * count, said(r), count);
      break;
    case Kind::exchange: {
      std::vector<std::size_t> before(ranks);
      for (auto const& message : now_.received) {
        auto const there = said_to_this(message.rank);
        auto& at = before[static_cast<std::size_t>(message.rank)];
        auto const size = static_cast<std::size_t>(message.count);
        if (at + size > there.size()) end_all("a message between ranks has another size than the receiver expects");
        std::memcpy(message.bytes, there.data() + at, size);
        at += size;
      }
      break;
    }
  }
  ++begun_;
  return true;
}

BoltzmannTeamFunctions const& MemoryTeam::functions() {  // long: a table
  static BoltzmannTeamFunctions const all{
      boltzmann_team_version,
      [] { return "memory"; },
      nullptr,
      [](void* of, std::int64_t* numbers, int count, int operation) {
        MemoryTeam& team = self(of);
        std::size_t const bytes = static_cast<std::size_t>(count) * sizeof *numbers;
        std::memcpy(team.room(bytes), numbers, bytes);
        team.now_ = {};
        team.now_.kind = Kind::reduce;
        team.now_.numbers = numbers;
        team.now_.count = count;
        team.now_.operation = operation;
        team.now_.in_slices = team.size_ > 2 && static_cast<std::size_t>(count) > few;
        team.post();
      },
      [](void* of, void* bytes, int count, int from) {
        MemoryTeam& team = self(of);
        if (team.rank_ == from)
          std::memcpy(team.room(static_cast<std::size_t>(count)), bytes, static_cast<std::size_t>(count));
        team.now_ = {};
        team.now_.kind = Kind::broadcast;
        team.now_.bytes = bytes;
        team.now_.count = count;
        team.now_.from = from;
        team.post();
      },
      [](void* of, void const* mine, int count, void* everything) {
        MemoryTeam& team = self(of);
        std::memcpy(team.room(static_cast<std::size_t>(count)), mine, static_cast<std::size_t>(count));
        team.now_ = {};
        team.now_.kind = Kind::gather;
        team.now_.bytes = everything;
        team.now_.count = count;
        team.post();
      },
      [](void* of, BoltzmannMessage const* messages, int count) { self(of).begin_exchange(messages, count); },
      [](void* of, std::uint64_t const* sizes, void** at) {
        MemoryTeam& team = self(of);
        std::vector<Place> places(static_cast<std::size_t>(team.size_));
        std::uint64_t end = places.size() * sizeof(Place);
        for (std::size_t r = 0; r < places.size(); ++r) {
          places[r] = {end, end + sizes[r]};
          end = places[r].end;
        }
        char* const box = team.room_for_ranks(places);
        for (std::size_t r = 0; r < places.size(); ++r) at[r] = box + places[r].begin;
      },
      [](void* of) {
        MemoryTeam& team = self(of);
        team.now_ = {};
        team.now_.kind = Kind::exchange;
        team.post();
      },
      [](void* of, void const** at) {
        MemoryTeam& team = self(of);
        for (int r = 0; r < team.size_; ++r) at[r] = team.said_to_this(r).data();
      },
      [](void* of) { return self(of).done() ? 1 : 0; },
      [](void* of) { self(of).launched_->leave(self(of).of_); },
      [](void* of, int status) {
        MemoryTeam& team = self(of);
        team.ranks_[static_cast<std::size_t>(team.rank_)]->head->ended = 1;
        team.launched_->abort(team.of_, status);
      }};
  return all;
}

}  // namespace boltzmann
