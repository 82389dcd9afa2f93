// bzm bench --ranks: processor time of each rank per step, and the communication between ranks.
#include <boltzmann/bzm/bench_problems.hpp>
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <limits>

namespace boltzmann::bzm {
namespace {

// Network and nodes assumed for the projections.
constexpr double bandwidth = 12e9, latency = 2e-6;  // bytes a second, seconds
constexpr int nodes[] = {64, 1024};

/// Cost of a run on one rank, per step.
struct Cost {
  double seconds = 0;  ///< processor time, without waiting
  double collectives = 0, messages = 0, bytes = 0;
};

double processor_seconds() {
  std::timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

Cost run(Simulation& simulation, std::uint64_t steps) {
  Team const& here = team();
  auto const counts = here.counts();
  double const seconds = processor_seconds() - here.waited();
  simulation.run(steps);
  auto const each = [&](auto difference) { return static_cast<double>(difference) / static_cast<double>(steps); };
  return {each(processor_seconds() - here.waited() - seconds), each(here.counts().collectives - counts.collectives),
          each(here.counts().messages - counts.messages), each(here.counts().bytes - counts.bytes)};
}

/// Minimum, mean and maximum over all ranks, for each number.
struct OverRanks {
  Cost least, mean, most;
};
OverRanks over_ranks(Cost const& mine) {
  constexpr double Cost::*numbers[] = {&Cost::seconds, &Cost::collectives, &Cost::messages, &Cost::bytes};
  OverRanks all{mine, {}, mine};
  auto const ranks = team().gather({reinterpret_cast<char const*>(&mine), sizeof mine});
  for (auto const& bytes : ranks) {
    Cost one;
    std::memcpy(&one, bytes.data(), sizeof one);
    for (auto const number : numbers) {
      all.least.*number = std::min(all.least.*number, one.*number);
      all.most.*number = std::max(all.most.*number, one.*number);
      all.mean.*number += one.*number / static_cast<double>(ranks.size());
    }
  }
  return all;
}

/// Projected parallel efficiency, for nodes with as many particles each as a rank here. The network transfers the
/// measured bytes, and all rows to all nodes at each list build.
double projected(Cost const& cost, double builds, double own, double row_bytes, int ranks, int count) {
  double const gathered = builds * own * row_bytes;
  double const between_builds = std::max(cost.bytes - gathered * (ranks - 1), 0.0);
  double const rest = (cost.collectives * std::log2(count) + cost.messages) * latency +
                      (between_builds + gathered * (count - 1)) / bandwidth;
  return cost.seconds / (cost.seconds + rest);
}

/// Load imbalance where the work moves: water that starts in one corner of a tank and flows along it.
std::string balance_of_a_dam_break() {
  constexpr std::uint64_t steps = 300;
  constexpr int pieces = 4;
  auto const scenario = load_scenario(find_scenario("dam-break"));
  scenario->simulation->threads(1);
  scenario->simulation->divide_from(0);
  Cost all;
  double worst = 0;
  auto const of = [](OverRanks const& cost) { return cost.most.seconds / cost.mean.seconds; };
  for (int piece = 0; piece < pieces; ++piece) {
    Cost const cost = run(*scenario->simulation, steps);
    all.seconds += cost.seconds;
    worst = std::max(worst, of(over_ranks(cost)));
  }
  return fmt::format(
      "dam-break, {} smooth particles, {} steps: the slowest rank has {:.2f} of the mean processor time,\n"
      "up to {:.2f} in pieces of {} steps\n",
      scenario->ensembles.front()->size(), pieces * steps, of(over_ranks(all)), worst, steps);
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
  fmt::print("{:>9} {:>12} {:>12} {:>6} {:>10} {:>8} {:>9} {:>10}\n", "particles", "alone", "slowest rank", "/ mean",
             "efficiency", "waits", "messages", "kB sent");
  std::string projections;
  for (std::size_t const cells : all_cells) {
    Problem problem = melt(cells);
    problem.simulation->threads(1);
    auto const particles = static_cast<double>(problem.particles->size());
    // Choose the number of steps to fill the time, at about 4 million particle-steps a second.
    double const possible = options.seconds / 2 / rounds * 4e6 / particles / (1 + 1.0 / ranks);
    auto const steps = static_cast<std::uint64_t>(std::clamp(possible, 20.0, 100000.0));
    double alone = std::numeric_limits<double>::infinity(), mean = 0, builds = 0;
    Cost slowest;
    slowest.seconds = alone;
    for (int round = 0; round < rounds; ++round) {
      problem.simulation->divide_from(std::numeric_limits<std::size_t>::max());
      alone = std::min(alone, over_ranks(run(*problem.simulation, steps)).least.seconds);
      problem.simulation->divide_from(0);
      std::size_t const before = problem.scheme->neighbourhood().builds();
      OverRanks const cost = over_ranks(run(*problem.simulation, steps));
      if (cost.most.seconds >= slowest.seconds) continue;
      slowest = cost.most;
      mean = cost.mean.seconds;
      builds = static_cast<double>(problem.scheme->neighbourhood().builds() - before) / static_cast<double>(steps);
    }
    fmt::print("{:>9} {:>9.3f} ms {:>9.3f} ms {:>6.2f} {:>8.0f} % {:>8.1f} {:>9.1f} {:>10.1f}\n",
               problem.particles->size(), 1e3 * alone, 1e3 * slowest.seconds, slowest.seconds / mean,
               100 * alone / (ranks * slowest.seconds), slowest.collectives, slowest.messages, 1e-3 * slowest.bytes);
    std::fflush(stdout);
    double const row_bytes = static_cast<double>(problem.particles->stride() * sizeof(double));
    for (int const count : nodes)
      projections +=
          fmt::format("projected, not measured: {} nodes with {:.0f} particles each: {:.0f} %\n", count,
                      particles / ranks, 100 * projected(slowest, builds, particles / ranks, row_bytes, ranks, count));
  }
  std::string const balance = balance_of_a_dam_break();
  fmt::print(
      "\nProcessor time a step of a Lennard-Jones melt, waiting apart, the least of {} rounds. Efficiency: that of one "
      "rank alone, divided by the number of ranks and the slowest one's. Waits, messages and bytes: of one rank, a "
      "step.\n\n{}\n{}One core a node, a network of {:.0f} GB/s and {:.0f} us.\n",
      rounds, balance, projections, 1e-9 * bandwidth, 1e6 * latency);
  return 0;
}

}  // namespace boltzmann::bzm
