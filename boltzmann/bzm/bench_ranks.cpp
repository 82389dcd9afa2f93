// bzm bench --ranks: what a step costs each rank, in processor time, and what ranks tell each other.
#include <boltzmann/bzm/bench_problems.hpp>
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/core/team.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <limits>

namespace boltzmann::bzm {
namespace {

// Of the network and the nodes that projections are for.
constexpr double bandwidth = 12e9, latency = 2e-6;  // bytes a second, seconds
constexpr int nodes[] = {64, 1024};

/// What a run has taken of a rank, for each step.
struct Cost {
  double seconds = 0;  ///< of its processor, waiting apart
  double collectives = 0, messages = 0, bytes = 0, builds = 0;
};

double processor_seconds() {
  std::timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

Cost run(Problem& problem, std::uint64_t steps) {
  Team const& here = team();
  auto const counts = here.counts();
  double const seconds = processor_seconds() - here.waited();
  std::size_t const builds = problem.scheme->neighbourhood().builds();
  problem.simulation->run(steps);
  auto const each = [&](auto difference) { return static_cast<double>(difference) / static_cast<double>(steps); };
  return {each(processor_seconds() - here.waited() - seconds), each(here.counts().collectives - counts.collectives),
          each(here.counts().messages - counts.messages), each(here.counts().bytes - counts.bytes),
          each(problem.scheme->neighbourhood().builds() - builds)};
}

/// That of the rank with the most, number by number, or the least.
Cost over_ranks(Cost const& mine, bool most) {
  Cost all = mine;
  auto const take = [&](double& a, double b) { a = most ? std::max(a, b) : std::min(a, b); };
  for (auto const& bytes : team().gather({reinterpret_cast<char const*>(&mine), sizeof mine})) {
    Cost one;
    std::memcpy(&one, bytes.data(), sizeof one);
    take(all.seconds, one.seconds), take(all.collectives, one.collectives), take(all.messages, one.messages);
    take(all.bytes, one.bytes), take(all.builds, one.builds);
  }
  return all;
}

/// As many particles on each node as on a rank here; the network carries what was counted, and where lists are built
/// all rows to all nodes.
double projected(Cost const& cost, double own, double row_bytes, int ranks, int count) {
  double const gathered = cost.builds * own * row_bytes;
  double const between_builds = std::max(cost.bytes - gathered * (ranks - 1), 0.0);
  double const rest = (cost.collectives * std::log2(count) + cost.messages) * latency +
                      (between_builds + gathered * (count - 1)) / bandwidth;
  return cost.seconds / (cost.seconds + rest);
}

}  // namespace

int bench_on_ranks(BenchOptions const& options) {
  constexpr std::size_t all_cells[] = {20, 40};
  constexpr int rounds = 3;
  if (options.threads || !options.json.empty())
    throw Error("bench on several ranks has one thread for each and writes no file; leave out --threads and --json");
  int const ranks = team().size();
  fmt::print("bzm {}, instructions {}, {} ranks of one thread\n\n", described_version, to_string(instruction_set()),
             ranks);
  fmt::print("{:>9} {:>12} {:>12} {:>10} {:>8} {:>9} {:>10}\n", "particles", "alone", "slowest rank", "efficiency",
             "waits", "messages", "kB sent");
  std::string projections;
  for (std::size_t const cells : all_cells) {
    Problem problem = melt(cells);
    problem.simulation->threads(1);
    auto const particles = static_cast<double>(problem.particles->size());
    // So many steps that all of it takes the time, at some 4 million particle-steps a second.
    double const possible = options.seconds / 2 / rounds * 4e6 / particles / (1 + 1.0 / ranks);
    auto const steps = static_cast<std::uint64_t>(std::clamp(possible, 20.0, 100000.0));
    double alone = std::numeric_limits<double>::infinity();
    Cost slowest;
    slowest.seconds = alone;
    for (int round = 0; round < rounds; ++round) {
      problem.simulation->divide_from(std::numeric_limits<std::size_t>::max());
      alone = std::min(alone, over_ranks(run(problem, steps), false).seconds);
      problem.simulation->divide_from(0);
      Cost const cost = over_ranks(run(problem, steps), true);
      if (cost.seconds < slowest.seconds) slowest = cost;
    }
    fmt::print("{:>9} {:>9.3f} ms {:>9.3f} ms {:>8.0f} % {:>8.1f} {:>9.1f} {:>10.1f}\n", problem.particles->size(),
               1e3 * alone, 1e3 * slowest.seconds, 100 * alone / (ranks * slowest.seconds), slowest.collectives,
               slowest.messages, 1e-3 * slowest.bytes);
    std::fflush(stdout);
    double const row_bytes = static_cast<double>(problem.particles->stride() * sizeof(double));
    for (int const count : nodes)
      projections +=
          fmt::format("projected, not measured: {} nodes with {:.0f} particles each: {:.0f} %\n", count,
                      particles / ranks, 100 * projected(slowest, particles / ranks, row_bytes, ranks, count));
  }
  fmt::print(
      "\nProcessor time a step of a Lennard-Jones melt, waiting apart, the least of {} rounds. Efficiency: that of one "
      "rank alone, divided by the number of ranks and the slowest one's. Waits, messages and bytes: of one rank, a "
      "step.\n\n{}One core a node, a network of {:.0f} GB/s and {:.0f} us.\n",
      rounds, projections, 1e-9 * bandwidth, 1e6 * latency);
  return 0;
}

}  // namespace boltzmann::bzm
