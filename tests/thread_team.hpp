// Ranks that are threads of one process: teams without MPI.
#pragma once

#include <boltzmann/core/memory_team.hpp>
#include <boltzmann/core/team.hpp>

#include <exception>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace boltzmann::test {

/// They tell each other what they have to by memory, as processes of one machine do.
class ThreadTeam {
 public:
  explicit ThreadTeam(int size, double patience = 60) : size_(size), patience_(patience) {}

  /// Calls it on each rank, in a thread of its own; gives what each has thrown.
  std::vector<std::exception_ptr> run(std::function<void(Team&)> const& main) {
    std::vector<std::unique_ptr<MemoryTeam>> memory;
    std::vector<std::string> addresses;
    for (int rank = 0; rank < size_; ++rank) {
      memory.push_back(std::make_unique<MemoryTeam>(rank, size_, launched(), nullptr));
      addresses.push_back(memory.back()->address());
    }
    for (auto& one : memory)
      if (!one->open(addresses)) throw std::runtime_error("threads don't see each other's memory");
    std::vector<std::exception_ptr> thrown(static_cast<std::size_t>(size_));
    std::vector<std::thread> threads;
    for (int rank = 0; rank < size_; ++rank)
      threads.emplace_back([&, rank] {
        Team team(MemoryTeam::functions(), memory[static_cast<std::size_t>(rank)].get(), rank, size_);
        team.patience(patience_);
        ActingTeam const acting(team);
        try {
          main(team);
        } catch (...) {
          thrown[static_cast<std::size_t>(rank)] = std::current_exception();
        }
      });
    for (auto& thread : threads) thread.join();
    return thrown;
  }

 private:
  /// Nothing to leave, and nobody else to end.
  static BoltzmannTeamFunctions const& launched() {
    static BoltzmannTeamFunctions const none = [] {
      BoltzmannTeamFunctions functions{};
      functions.leave = [](void*) {};
      functions.abort = [](void*, int) {};
      return functions;
    }();
    return none;
  }

  int size_;
  double patience_;
};

/// "" for nothing.
inline std::string line_of(std::exception_ptr const& thrown) {
  if (!thrown) return "";
  try {
    std::rethrow_exception(thrown);
  } catch (std::exception const& error) {
    return error.what();
  }
}

}  // namespace boltzmann::test
