// Waiting line: shows what a command is doing during a long preparation, before there are steps to count.
#pragma once

#include <boltzmann/core/clock.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/recording/progress.hpp>

#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

namespace boltzmann::bzm {

/// After four seconds, a line on standard error shows the activity. On a terminal it counts the seconds, and is erased
/// at the end.
class WaitingLine {
 public:
  explicit WaitingLine(bool shown, std::chrono::milliseconds patience = std::chrono::seconds(4)) : patience_(patience) {
    if (shown && team().first()) thread_ = std::thread([this] { run(); });
  }
  ~WaitingLine() {
    {
      std::lock_guard const lock(mutex_);
      ended_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }
  WaitingLine(WaitingLine const&) = delete;
  WaitingLine& operator=(WaitingLine const&) = delete;

  /// Sets the activity that the line shows from now on.
  void doing(std::string what) {
    std::lock_guard const lock(mutex_);
    what_ = std::move(what);
    told_ = false;
  }

 private:
  void run() {
    bool const terminal = rewrites_lines();
    auto const start = Clock::now();
    std::unique_lock lock(mutex_);
    bool any = false;
    while (!ended_) {
      changed_.wait_for(lock, any ? std::chrono::milliseconds(500) : patience_, [this] { return ended_; });
      if (ended_ || what_.empty()) continue;
      if (terminal)
        fmt::print(stderr, "\r{}, {:.0f} s\033[K", what_, seconds_since(start));
      else if (!told_)
        fmt::print(stderr, "{}\n", what_);
      std::fflush(stderr);
      told_ = any = true;
    }
    if (any && terminal) std::fputs("\r\033[K", stderr);
  }

  std::chrono::milliseconds const patience_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string what_;
  bool ended_ = false, told_ = false;
  std::thread thread_;
};

}  // namespace boltzmann::bzm
