// Ranks exchange messages in rounds. Every rank sees the same messages in a round, so all agree on the assignment of
// runs.
#include <boltzmann/core/clock.hpp>
#include <boltzmann/sweep/run_farm.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <optional>
#include <sstream>
#include <thread>
#include <utility>

namespace boltzmann {
namespace {

constexpr std::int64_t none = -1;

/// Serialises a message: the numbers first, then the text.
std::string text_of(FarmWord const& word) {
  std::string text = fmt::format("{} {:d} {} {:d} {:d} {} {:d} {} {}\n{}\n", word.run, word.ended,
                                 static_cast<int>(word.end.state), word.end.interrupted, word.end.out_of_time,
                                 word.part, word.stop, word.lines.size(), word.warnings.size(), word.end.reason);
  for (auto const* lines : {&word.lines, &word.warnings})
    for (auto const& line : *lines) text += line + "\n";
  return text;
}

FarmWord word_of(std::string const& text) {
  std::istringstream stream(text);
  FarmWord word;
  int state = 0;
  std::size_t lines = 0, warnings = 0;
  stream >> word.run >> word.ended >> state >> word.end.interrupted >> word.end.out_of_time >> word.part >> word.stop >>
      lines >> warnings;
  word.end.state = static_cast<RunState>(state);
  word.lines.resize(lines);
  word.warnings.resize(warnings);
  stream.ignore();
  std::getline(stream, word.end.reason);
  for (auto& line : word.lines) std::getline(stream, line);
  for (auto& line : word.warnings) std::getline(stream, line);
  return word;
}

}  // namespace

FarmHand::Stoppable::Stoppable(FarmHand& hand, Simulation& simulation) : hand_(hand) {
  std::scoped_lock const lock(hand.mutex_);
  hand.simulation_ = &simulation;
  if (hand.stopping_) simulation.stop();
}

FarmHand::Stoppable::~Stoppable() {
  std::scoped_lock const lock(hand_.mutex_);
  hand_.simulation_ = nullptr;
}

void FarmHand::add(std::vector<std::string>& lines, std::string const& text) {
  std::scoped_lock const lock(mutex_);
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
}

void FarmHand::stop() {
  std::scoped_lock const lock(mutex_);
  stopping_ = true;
  if (simulation_) simulation_->stop();
}

/// The farm, as one rank runs it.
class RunFarm {
 public:
  RunFarm(std::vector<std::size_t> const& runs, FarmCalls const& calls)
      : team_(team()), runs_(runs), calls_(calls), taken_(static_cast<std::size_t>(team_.size()), none) {}

  ~RunFarm() {
    hand_.stop();
    if (worker_.joinable()) worker_.join();
  }

  void work() {
    for (;;) {
      take_runs();
      if (std::all_of(taken_.begin(), taken_.end(), [](auto run) { return run == none; })) break;
      wait();
      speak();
      if (stopping_) hand_.stop();
    }
    team_.agree([this] {
      if (failure_) std::rethrow_exception(failure_);
    });
  }

 private:
  /// Assigns waiting runs to free ranks. The result is the same on every rank.
  void take_runs() {
    for (std::size_t r = 0; r < taken_.size() && given_ < runs_.size() && !stopping_; ++r) {
      if (taken_[r] != none) continue;
      taken_[r] = static_cast<std::int64_t>(runs_[given_++]);
      changed_ = Clock::now();
      if (static_cast<int>(r) == team_.rank()) begin(static_cast<std::size_t>(taken_[r]));
    }
  }

  void begin(std::size_t run) {
    hand_.part(0);
    ended_.reset();
    worker_ = std::thread([this, run] {
      Team one;
      ActingTeam const acting(one);
      RunEnd end;
      std::exception_ptr failure;
      try {
        end = calls_.perform(run, hand_);
      } catch (...) {
        failure = std::current_exception();
      }
      std::scoped_lock const lock(ending_);
      ended_ = std::move(end);
      if (failure && !failure_) failure_ = failure;
      at_end_.notify_all();
    });
  }

  /// Waits until the local run has ended. The timeout is a twentieth of the time since the last event, because runs of
  /// other ranks may have ended.
  void wait() {
    std::unique_lock lock(ending_);
    at_end_.wait_for(lock, clock_time(std::clamp(seconds_since(changed_) / 20, 1e-3, 0.1)),
                     [this] { return ended_.has_value(); });
  }

  void speak() {
    FarmWord mine;
    mine.run = taken_[static_cast<std::size_t>(team_.rank())];
    {
      std::scoped_lock const lock(ending_);
      mine.ended = ended_.has_value();
      if (mine.ended) mine.end = *std::exchange(ended_, std::nullopt);
      mine.stop = failure_ != nullptr || mine.end.interrupted || mine.end.out_of_time;
    }
    if (mine.ended) worker_.join();
    mine.stop = mine.stop || calls_.stop();
    mine.part = hand_.part_;
    {
      std::scoped_lock const lock(hand_.mutex_);
      mine.lines.swap(hand_.lines_);
      mine.warnings.swap(hand_.warnings_);
    }
    std::vector<FarmWord> words;
    for (auto const& text : team_.gather(text_of(mine))) words.push_back(word_of(text));
    for (std::size_t r = 0; r < words.size(); ++r) {
      stopping_ = stopping_ || words[r].stop;
      if (!words[r].ended) continue;
      taken_[r] = none;
      changed_ = Clock::now();
    }
    try {
      calls_.hear(words);
    } catch (...) {
      std::scoped_lock const lock(ending_);
      if (!failure_) failure_ = std::current_exception();
    }
  }

  Team& team_;
  std::vector<std::size_t> const& runs_;
  FarmCalls const& calls_;
  std::vector<std::int64_t> taken_;  // per rank
  std::size_t given_ = 0;
  bool stopping_ = false;
  Clock::time_point changed_ = Clock::now();
  FarmHand hand_;
  std::thread worker_;
  std::mutex ending_;
  std::condition_variable at_end_;
  std::optional<RunEnd> ended_;
  std::exception_ptr failure_;
};

void farm_runs(std::vector<std::size_t> const& runs, FarmCalls const& calls) { RunFarm(runs, calls).work(); }

}  // namespace boltzmann
