// Votes, and the exceptions that result from them.
#include <boltzmann/core/team_functions.h>
#include <boltzmann/core/clock.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/shared_processors.hpp>
#include <boltzmann/core/team.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <new>
#include <thread>
#include <utility>

namespace boltzmann {
namespace {

constexpr std::int64_t nobody = std::numeric_limits<std::int64_t>::max();
constexpr std::size_t piece = std::size_t{1} << 30;  // of bytes: MPI counts them by ints

constexpr char const* occasion_words[] = {
    "prepares a run",   "begins a run",   "is in a run",           "ends a run",        "is between two runs",
    "ends its program", "exchanges rows", "gathers all particles", "follows particles", "ends a step"};
char const* words(Team::Occasion occasion) { return occasion_words[static_cast<std::size_t>(occasion)]; }

enum class Kind : int { error, physics, memory, other };

/// A failure as it is sent to other ranks.
struct Description {
  Kind kind = Kind::other;
  int status = 1;
  Team::Occasion occasion{};  // of the failed rank
  std::string line;
};

Description describe(std::exception_ptr const& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (Error const& error) {
    return {Kind::error, 2, {}, error.what()};
  } catch (PhysicsFailure const& error) {
    return {Kind::physics, 3, {}, error.what()};
  } catch (TeamFailure const& error) {
    return {Kind::other, error.status, {}, error.what()};
  } catch (std::bad_alloc const&) {
    return {Kind::memory, 1, {}, ""};
  } catch (std::exception const& error) {
    return {Kind::other, 1, {}, error.what()};
  } catch (...) {
    return {Kind::other, 1, {}, "an exception that is no std::exception"};
  }
}

std::exception_ptr exception_of(Description const& failure) {
  switch (failure.kind) {
    case Kind::error:
      return std::make_exception_ptr(Error(failure.line));
    case Kind::physics:
      return std::make_exception_ptr(PhysicsFailure(failure.line));
    case Kind::memory:
      return std::make_exception_ptr(std::bad_alloc());
    case Kind::other:
      break;
  }
  return std::make_exception_ptr(TeamFailure(failure.line, failure.status));
}

std::uint64_t checksum_of(std::string_view text) {  // FNV-1a
  std::uint64_t sum = 0xcbf29ce484222325U;
  for (char const c : text) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return sum;
}

/// Processor time of the calling thread.
double processor_seconds() {
  std::timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

template <class T>
std::string bytes_of(T const& value) {
  return {reinterpret_cast<char const*>(&value), sizeof value};
}

}  // namespace

int exit_status(std::exception_ptr const& failure) { return describe(failure).status; }

Team::Team(BoltzmannTeamFunctions const& functions, void* of, int rank, int size)
    : functions_(&functions), of_(of), rank_(rank), size_(size) {}

/// Spins at first, if it has a processor of its own; then it yields the processor, since another rank that it waits for
/// may need it.
void Team::wait() {
  ++counts_.collectives;
  if (functions_->done(of_) != 0) return;
  auto const start = Clock::now();
  double const since = processor_seconds();
  while (functions_->done(of_) == 0) {
    double const waited = seconds_since(start);
    if (waited > patience_)
      give_up(fmt::format(
          "rank {}, which {}, has waited {:.3g} s for others, which have not come so far; every rank must do "
          "the same (BOLTZMANN_PATIENCE sets how many seconds a rank waits)",
          rank_, words(occasion_), waited));
    if (waited < 2e-4 && processors_suffice()) continue;
    if (waited < 1e-3)
      std::this_thread::yield();
    else
      std::this_thread::sleep_for(clock_time(std::min(waited / 16, 2e-3)));
  }
  waited_ += processor_seconds() - since;
}

void Team::reduce(std::span<std::int64_t> numbers, int operation) {
  if (alone()) return;
  counts_.numbers += numbers.size();
  constexpr std::size_t most = piece / sizeof(std::int64_t);
  for (; !numbers.empty(); numbers = numbers.subspan(std::min(most, numbers.size()))) {
    functions_->begin_reduce(of_, numbers.data(), static_cast<int>(std::min(most, numbers.size())), operation);
    wait();
  }
}

void Team::sum(std::span<std::int64_t> numbers) { reduce(numbers, boltzmann_team_sum); }
void Team::min(std::span<std::int64_t> numbers) { reduce(numbers, boltzmann_team_min); }
void Team::max(std::span<std::int64_t> numbers) { reduce(numbers, boltzmann_team_max); }

void Team::broadcast(std::string& bytes, int from) {
  if (alone()) return;
  auto size = static_cast<std::uint64_t>(bytes.size());
  functions_->begin_broadcast(of_, &size, sizeof size, from);
  wait();
  bytes.resize(size);
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    functions_->begin_broadcast(of_, bytes.data() + at, static_cast<int>(std::min(piece, bytes.size() - at)), from);
    wait();
  }
}

std::vector<std::string> Team::gather(std::string const& mine) {
  if (alone()) return {mine};
  std::array<std::int64_t, 1> longest{static_cast<std::int64_t>(mine.size())};
  max(longest);
  auto const room = static_cast<std::size_t>(longest[0]) + sizeof(std::uint64_t);
  std::string own = bytes_of(static_cast<std::uint64_t>(mine.size())) + mine, all(room * size_, '\0');
  own.resize(room);
  functions_->begin_gather(of_, own.data(), static_cast<int>(room), all.data());
  wait();
  std::vector<std::string> each;
  for (int r = 0; r < size_; ++r) {
    std::uint64_t size = 0;
    char const* const of_rank = all.data() + room * static_cast<std::size_t>(r);
    std::memcpy(&size, of_rank, sizeof size);
    each.emplace_back(of_rank + sizeof size, size);
  }
  return each;
}

void Team::exchange(std::span<Message const> messages) {
  if (alone()) return;
  std::vector<BoltzmannMessage> pieces;
  for (auto const& message : messages) {
    if (!message.receive && message.size > 0) ++counts_.messages, counts_.bytes += message.size;
    for (std::size_t at = 0; at < message.size; at += piece)
      pieces.push_back({message.rank, message.receive ? 1 : 0, static_cast<char*>(message.bytes) + at,
                        static_cast<int>(std::min(piece, message.size - at))});
  }
  functions_->begin_exchange(of_, pieces.data(), static_cast<int>(pieces.size()));
  wait();
}

void Team::exchange(std::span<std::size_t const> sent, std::span<std::size_t const> received,
                    std::function<void(std::size_t r, double* to)> const& write,
                    std::function<void(std::size_t r, double const* from)> const& read) {
  if (alone()) return;
  std::size_t const ranks = sent.size();
  if (functions_->write_at) {
    std::vector<std::uint64_t> sizes;
    for (std::size_t const size : sent) {
      sizes.push_back(size * sizeof(double));
      if (size > 0) ++counts_.messages, counts_.bytes += sizes.back();
    }
    std::vector<void*> to(ranks);
    functions_->write_at(of_, sizes.data(), to.data());
    for (std::size_t r = 0; r < ranks; ++r)
      if (sent[r] > 0) write(r, static_cast<double*>(to[r]));
    functions_->begin_written(of_);
    wait();
    std::vector<void const*> from(ranks);
    functions_->read_at(of_, from.data());
    for (std::size_t r = 0; r < ranks; ++r)
      if (received[r] > 0) read(r, static_cast<double const*>(from[r]));
    return;
  }
  sent_.resize(ranks), received_.resize(ranks);
  std::vector<Message> messages;
  for (std::size_t r = 0; r < ranks; ++r) {
    sent_[r].resize(sent[r]), received_[r].resize(received[r]);
    if (sent[r] > 0) write(r, sent_[r].data());
    messages.push_back({static_cast<int>(r), true, received_[r].data(), received[r] * sizeof(double)});
    messages.push_back({static_cast<int>(r), false, sent_[r].data(), sent[r] * sizeof(double)});
  }
  exchange(messages);
  for (std::size_t r = 0; r < ranks; ++r)
    if (received[r] > 0) read(r, received_[r].data());
}

Team::Outcome Team::vote(Ballot const& ballot, std::exception_ptr const& failed) {
  Outcome outcome;
  if (over_) {
    outcome.failure = over_;
    return outcome;
  }
  if (alone()) return {ballot.stop, ballot.pause, true, ballot.place, ballot.next, ballot.most, failed};
  occasion_ = ballot.occasion;
  auto const occasion = static_cast<std::int64_t>(ballot.occasion);
  auto const checksum = static_cast<std::int64_t>(ballot.checksum);
  // Minima; the minimum of the complement gives the maximum.
  constexpr std::size_t own = 10;
  std::array<std::int64_t, own + std::tuple_size_v<Most>> numbers{failed ? rank_ : nobody,
                                                                  occasion,
                                                                  ~occasion,
                                                                  ballot.stop ? 0 : 1,
                                                                  ballot.pause ? 0 : 1,
                                                                  ballot.place,
                                                                  ~ballot.place,
                                                                  ballot.next,
                                                                  checksum,
                                                                  ~checksum};
  for (std::size_t k = 0; k < ballot.most.size(); ++k) numbers[own + k] = ~ballot.most[k];
  min(numbers);
  auto const [failing, first_occasion, last_occasion, stop, pause, place, last_place, next, low, high] =
      std::to_array({numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5], numbers[6], numbers[7],
                     numbers[8], numbers[9]});
  outcome = {stop == 0, pause == 0, place == ~last_place, ~last_place, next, {}, nullptr};
  for (std::size_t k = 0; k < ballot.most.size(); ++k) outcome.most[k] = ~numbers[own + k];
  if (failing != nobody)
    outcome.failure = failure_of(static_cast<int>(failing), ballot, failed);
  else if (first_occasion != ~last_occasion)
    outcome.failure = over_ = other_occasions(ballot);
  else if (low != ~high)
    outcome.failure = other_checksums(ballot);
  return outcome;
}

Team::Outcome Team::meet(Occasion occasion, Most const& most) {
  Ballot ballot{occasion};
  ballot.most = most;
  auto const outcome = vote(ballot);
  if (outcome.failure && depth_ > 0) throw AgreedFailure{outcome.failure};
  check(outcome);
  return outcome;
}

/// The failure of a rank, as an exception on all of them: the rank's own exception if it is the same.
std::exception_ptr Team::failure_of(int rank, Ballot const& ballot, std::exception_ptr const& mine) {
  Description own;
  if (mine) own = describe(mine);
  own.occasion = ballot.occasion;
  std::string text =
      fmt::format("{} {} {}\n{}", static_cast<int>(own.kind), own.status, static_cast<int>(own.occasion), own.line);
  broadcast(text, rank);
  Description failure;
  int kind = 0, occasion = 0;
  std::sscanf(text.c_str(), "%d %d %d", &kind, &failure.status, &occasion);
  failure.kind = static_cast<Kind>(kind);
  failure.line = text.substr(text.find('\n') + 1);
  bool const same = mine && failure.line == own.line && failure.kind == own.kind;
  if (!mine && failure.line.empty() && failure.kind == Kind::other)
    failure.line = fmt::format("rank {} has ended with exit status {}", rank, failure.status);
  auto exception = same ? mine : exception_of(failure);
  if (static_cast<Occasion>(occasion) == Occasion::program_ends) over_ = exception;  // no rank is left to vote with
  return exception;
}

std::exception_ptr Team::other_occasions(Ballot const& ballot) {
  auto const all = gather(bytes_of(ballot.occasion));
  int other = 1;
  while (all[static_cast<std::size_t>(other)] == all[0]) ++other;
  auto const words_of = [&](int rank) {
    Occasion occasion{};
    std::memcpy(&occasion, all[static_cast<std::size_t>(rank)].data(), sizeof occasion);
    return words(occasion);
  };
  return std::make_exception_ptr(Error(
      fmt::format("rank {} {} where rank 0 {}; every rank must do the same: run() and its like are not for some of "
                  "them",
                  other, words_of(other), words_of(0))));
}

std::exception_ptr Team::other_checksums(Ballot const& ballot) {
  auto const all = gather(bytes_of(ballot.checksum));
  int other = 1;
  while (all[static_cast<std::size_t>(other)] == all[0]) ++other;
  if (ballot.occasion == Occasion::prepares)
    return std::make_exception_ptr(Error(fmt::format("rank {} has another {} than rank 0", other, ballot.what)));
  return std::make_exception_ptr(Error(
      ballot.occasion == Occasion::run_begins
          ? fmt::format("rank {} has other particles, or other steps to do, than rank 0 where a run begins: the "
                        "program must do the same on every rank (seeds from random_device? the time?)",
                        other)
          : fmt::format("rank {} has come to other particles than rank 0 by the same steps: do their processors or "
                        "C libraries differ?",
                        other)));
}

void Team::agree(std::function<void()> const& function) {
  if (alone() || depth_ > 0) return function();
  Ballot const here{Occasion::between_runs};
  std::exception_ptr failure;
  try {
    function();
  } catch (...) {
    failure = std::current_exception();
  }
  check(vote(here, failure));
}

void Team::on_first(std::function<void()> const& function) {
  agree([&] {
    if (first()) function();
  });
}

bool Team::any(bool mine) {
  if (alone() || depth_ > 0) return mine;
  auto const outcome = vote({Occasion::between_runs, mine});
  check(outcome);
  return outcome.stop;
}

bool Team::first_says(bool mine) { return any(first() && mine); }

void Team::same(std::string_view text, char const* what) {
  if (alone() || depth_ > 0) return;
  Ballot ballot{Occasion::prepares};
  ballot.checksum = checksum_of(text);
  ballot.what = what;
  check(vote(ballot));
}

int Team::end(int status) {
  if (!functions_) return status;
  if (!alone()) {
    if (!over_) {
      patience_ = std::numeric_limits<double>::infinity();
      auto const outcome =
          vote({Occasion::program_ends}, status == 0 ? nullptr : std::make_exception_ptr(TeamFailure(told_, status)));
      over_ = outcome.failure;
    }
    if (over_) {
      auto const failure = describe(over_);
      status = failure.status;
      if (first() && !failure.line.empty() && failure.line != told_) tell_failure(failure.line);
    }
  }
  functions_->leave(of_);
  return status;
}

}  // namespace boltzmann
