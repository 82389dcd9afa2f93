// Ranks that are threads of one process, with a box of mail for each message: teams without MPI.
#pragma once

#include <boltzmann/core/team_functions.h>
#include <boltzmann/core/team.hpp>

#include <algorithm>
#include <cstring>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace boltzmann::test {

class ThreadTeam {
 public:
  explicit ThreadTeam(int size, double patience = 60) : size_(size), patience_(patience) {}

  /// Calls it on each rank, in a thread of its own; gives what each has thrown.
  std::vector<std::exception_ptr> run(std::function<void(Team&)> const& main) {
    std::vector<std::exception_ptr> thrown(static_cast<std::size_t>(size_));
    std::vector<std::thread> threads;
    for (int rank = 0; rank < size_; ++rank)
      threads.emplace_back([&, rank] {
        Member member{this, rank};
        Team team(functions(), &member, rank, size_);
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

  /// What a rank has done with others so far, and the bytes that it had to say then.
  struct Sent {
    std::uint64_t calls = 0, bytes = 0;
  };
  Sent sent(int rank) {
    std::lock_guard const lock(mutex_);
    return sent_[rank];
  }

 private:
  struct Box {
    std::vector<std::string> posted;
    int arrived = 0, read = 0;
  };
  struct Member {
    ThreadTeam* team;
    int rank;
    std::uint64_t sent = 0;  // messages
    std::function<void(std::vector<std::string> const&)> take = {};
  };

  static void post(void* of, std::string bytes, std::function<void(std::vector<std::string> const&)> take) {
    Member& member = *static_cast<Member*>(of);
    std::lock_guard const lock(member.team->mutex_);
    Box& box = member.team->boxes_[member.sent];
    box.posted.resize(static_cast<std::size_t>(member.team->size_));
    Sent& sent = member.team->sent_[member.rank];
    ++sent.calls;
    sent.bytes += bytes.size();
    box.posted[static_cast<std::size_t>(member.rank)] = std::move(bytes);
    ++box.arrived;
    member.take = std::move(take);
  }

  static int done(void* of) {
    Member& member = *static_cast<Member*>(of);
    std::lock_guard const lock(member.team->mutex_);
    if (member.team->aborted_) throw TeamFailure("another rank has ended all", 1);
    Box& box = member.team->boxes_[member.sent];
    if (box.arrived < member.team->size_) return 0;
    member.take(box.posted);
    if (++box.read == member.team->size_) member.team->boxes_.erase(member.sent);
    ++member.sent;
    return 1;
  }

  static void reduce(void* of, std::int64_t* numbers, int count, int operation) {
    std::size_t const bytes = static_cast<std::size_t>(count) * sizeof(std::int64_t);
    post(of, {reinterpret_cast<char const*>(numbers), bytes}, [=](auto const& all) {
      for (std::size_t r = 0; r < all.size(); ++r)
        for (int k = 0; k < count; ++k) {
          std::int64_t number = 0;
          std::memcpy(&number, all[r].data() + static_cast<std::size_t>(k) * sizeof number, sizeof number);
          numbers[k] = r == 0                            ? number
                       : operation == boltzmann_team_sum ? numbers[k] + number
                       : operation == boltzmann_team_min ? std::min(numbers[k], number)
                                                         : std::max(numbers[k], number);
        }
    });
  }

  static void exchange(void* of, BoltzmannMessage const* messages, int count) {
    Member& member = *static_cast<Member*>(of);
    int const rank = member.rank;
    std::string all;
    auto const write = [&](int number) { all.append(reinterpret_cast<char const*>(&number), sizeof number); };
    std::vector<BoltzmannMessage> received;
    for (int k = 0; k < count; ++k) {
      if (messages[k].receive) {
        received.push_back(messages[k]);
        continue;
      }
      write(messages[k].rank), write(messages[k].count);
      all.append(static_cast<char const*>(messages[k].bytes), static_cast<std::size_t>(messages[k].count));
    }
    post(of, std::move(all), [rank, received](auto const& posted) {
      std::vector<std::size_t> at(posted.size());
      for (auto const& message : received) {
        auto const& box = posted[static_cast<std::size_t>(message.rank)];
        auto& place = at[static_cast<std::size_t>(message.rank)];
        for (bool found = false; !found;) {
          int head[2];
          if (place + sizeof head > box.size()) throw std::logic_error("a message was not sent");
          std::memcpy(head, box.data() + place, sizeof head);
          found = head[0] == rank;
          if (found && head[1] != message.count) throw std::logic_error("a message has another size");
          if (found) std::memcpy(message.bytes, box.data() + place + sizeof head, static_cast<std::size_t>(head[1]));
          place += sizeof head + static_cast<std::size_t>(head[1]);
        }
      }
    });
  }

  static BoltzmannTeamFunctions const& functions() {
    static BoltzmannTeamFunctions const all{
        boltzmann_team_version,
        [] { return "threads"; },
        nullptr,
        reduce,
        [](void* of, void* bytes, int count, int from) {
          post(of, {static_cast<char const*>(bytes), static_cast<std::size_t>(count)}, [=](auto const& all) {
            std::memcpy(bytes, all[static_cast<std::size_t>(from)].data(), static_cast<std::size_t>(count));
          });
        },
        [](void* of, void const* mine, int count, void* all) {
          post(of, {static_cast<char const*>(mine), static_cast<std::size_t>(count)}, [=](auto const& each) {
            for (std::size_t r = 0; r < each.size(); ++r)
              std::memcpy(static_cast<char*>(all) + r * each[r].size(), each[r].data(), each[r].size());
          });
        },
        exchange,
        done,
        [](void*) {},
        [](void* of, int) {
          Member& member = *static_cast<Member*>(of);
          std::lock_guard const lock(member.team->mutex_);
          member.team->aborted_ = true;
        }};
    return all;
  }

  int size_;
  double patience_;
  std::mutex mutex_;
  std::map<std::uint64_t, Box> boxes_;
  std::map<int, Sent> sent_;
  bool aborted_ = false;
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
