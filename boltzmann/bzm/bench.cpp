// bzm bench: the speed of this machine for a few standard problems, with the shipped laws.
#include <boltzmann/bzm/bench_problems.hpp>
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/core/clock.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/scenario/classes.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

namespace boltzmann::bzm {
namespace {

struct Row {
  std::string problem;
  std::size_t particles;
  int threads;
  double steps, pairs;  // per second
};

Problem make(char const* class_name, int dimension, std::size_t count, Box box, double cutoff) {
  ClassVariant const* variant = find_class(class_name)->in(dimension);
  Problem problem;
  problem.particles = variant->make("particles", count);
  problem.scheme = std::make_unique<PairScheme>(std::move(box), cutoff);
  return problem;
}

void start(Problem& problem, double step) {
  AnyEnsemble& particles = *problem.particles;
  problem.simulation = std::make_unique<Simulation>(*problem.scheme, step);
  ClassVariant const* variant = find_class(particles.class_name())->in(particles.dimension());
  problem.simulation->integrate(particles, variant->integrate(particles, Method::leap_frog));
}

void unit_masses(AnyEnsemble& particles) {
  Field const* mass = particles.find_field("mass");
  for (std::size_t i = 0; i < particles.size(); ++i) particles.row(i)[mass->offset] = 1;
}

/// Pairs of particles closer than the cut-off; each pair counts twice.
double pairs_within(AnyEnsemble const& particles, Box const& box, double cutoff) {
  Ensemble<Newton<3>> points("points", particles.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int a = 0; a < 3; ++a) points[i].position[a] = particles.row(i)[a];
  auto const one = [](auto const& p, auto const& q) {
    auto const r = q.position - p.position;
    return Interaction{r * 0.0, dot(r, r) * 0.0 + 1.0};
  };
  PairScheme counting(box, cutoff);
  counting.shifted(false);
  counting.internal(points, one);
  return 2 * counting.measure().potential;
}

}  // namespace

Problem melt(std::size_t cells) {
  LatticeBlock const block{Lattice::fcc, spacing_for_density(Lattice::fcc, 3, 0.8442), {cells, cells, cells}};
  auto const length = repeat_lengths(block, 3);
  Box const box(Vector{0.0, 0.0, 0.0}, Vector{length[0], length[1], length[2]}, Boundary::periodic);
  double const cutoff = 2.5;
  Problem problem = make("Newton", 3, site_count(block, 3), box, cutoff);
  block_load(*problem.particles, block);
  unit_masses(*problem.particles);
  maxwellian_load(*problem.particles, {.temperature = 1.44, .remove_drift = true, .exact_temperature = true});
  problem.scheme->skin(0.3);
  install_pairs(*problem.scheme, law_info("lennard-jones"), {{"r0", {std::pow(2.0, 1.0 / 6)}}, {"depth", {1.0}}},
                LawUse::internal, *problem.particles, *problem.particles, cutoff);
  start(problem, 0.005);
  problem.simulation->run(40);  // until the lattice has melted
  problem.pairs = pairs_within(*problem.particles, box, cutoff);
  return problem;
}

namespace {

/// Softened gravity of all pairs.
Problem stars() {
  constexpr std::size_t count = 4096;
  Box const box(Vector{-1.0, -1.0, -1.0}, Vector{1.0, 1.0, 1.0});
  Problem problem = make("Kepler", 3, count, box, no_cutoff);
  unit_masses(*problem.particles);
  random_load(*problem.particles, box);
  install_pairs(*problem.scheme, law_info("gravity"), {{"G", {1.0 / count}}, {"softening", {0.05}}}, LawUse::internal,
                *problem.particles, *problem.particles, no_cutoff);
  start(problem, 1e-4);
  problem.pairs = static_cast<double>(count) * (count - 1);
  return problem;
}

/// A chain of springs, stretched a little: sound waves run inwards from its ends.
Problem chain() {
  constexpr std::size_t count = 100000;
  Problem problem = make("Newton", 1, count, Box(Vector{0.0}, Vector{static_cast<double>(count)}), no_cutoff);
  unit_masses(*problem.particles);
  block_load(*problem.particles, {Lattice::square, 1.01, {count, 1, 1}});
  install_connections(*problem.scheme, law_info("spring"), {{"stiffness", {1.0}}, {"rest_length", {1.0}}},
                      *problem.particles, {{0, count - 1}});
  start(problem, 0.05);
  problem.pairs = 2.0 * (count - 1);
  return problem;
}

/// Steps per second: the median of five batches that fill the time.
double measure(Simulation& simulation, double seconds) {
  auto const timed = [&](std::uint64_t steps) {
    auto const since = Clock::now();
    simulation.run(steps);
    return seconds_since(since);
  };
  constexpr int batches = 5;
  timed(1);
  std::uint64_t steps = 1;
  double taken = timed(steps);
  while (taken < 0.02 * seconds && steps < (1U << 20U)) taken = timed(steps *= 2);
  auto const batch = static_cast<std::uint64_t>(
      std::max(1.0, std::round(seconds / batches * static_cast<double>(steps) / std::max(taken, 1e-9))));
  std::vector<double> rates;
  for (int k = 0; k < batches; ++k) rates.push_back(static_cast<double>(batch) / timed(batch));
  std::sort(rates.begin(), rates.end());
  return rates[batches / 2];
}

/// 2.66 M, 123 k: three digits.
std::string rate(double value) {
  char const* unit = "";
  for (char const* larger : {"k", "M", "G"})
    if (value >= 999.5) {
      value /= 1000;
      unit = larger;
    }
  return fmt::format("{:.{}f} {}", value, value < 9.995 ? 2 : value < 99.95 ? 1 : 0, unit);
}

/// A file that is opened before the measurements, so that a wrong name is reported immediately.
class FiguresFile {
 public:
  explicit FiguresFile(std::string path) : path_(std::move(path)) {
    if (!path_.empty() && !(file_ = std::fopen(path_.c_str(), "w"))) throw Error("can't write " + path_);
  }
  ~FiguresFile() {
    if (file_) std::fclose(file_);
  }
  FiguresFile(FiguresFile const&) = delete;
  FiguresFile& operator=(FiguresFile const&) = delete;

  void write(std::vector<Row> const& rows, std::string const& instructions) {
    if (!file_) return;
    std::string text = fmt::format("{{\n  \"program\": \"bzm {}\",\n  \"instructions\": \"{}\",\n  \"problems\": [",
                                   described_version, instructions);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      Row const& row = rows[k];
      text += fmt::format(
          "{}\n    {{\"problem\": \"{}\", \"particles\": {}, \"threads\": {}, \"particle_steps_per_second\": {:.6g}, "
          "\"pairs_per_second\": {:.6g}}}",
          k == 0 ? "" : ",", row.problem, row.particles, row.threads, row.steps * static_cast<double>(row.particles),
          row.pairs);
    }
    text += "\n  ]\n}\n";
    bool const written = std::fputs(text.c_str(), file_) >= 0;
    if (std::fclose(std::exchange(file_, nullptr)) != 0 || !written) throw Error("can't write " + path_);
  }

 private:
  std::string path_;
  std::FILE* file_ = nullptr;
};

}  // namespace

int bench(BenchOptions const& options) {
  if (!team().alone()) return bench_on_ranks(options);
  std::string const instructions = to_string(instruction_set());
  FiguresFile figures(options.json);
  int const most = options.threads.value_or(default_threads());
  std::vector<int> counts{1};
  if (most > 1) counts.push_back(most);
  struct Entry {
    char const* name;
    Problem (*make)();
  };
  constexpr Entry entries[] = {
      {"Lennard-Jones melt", [] { return melt(20); }}, {"gravity, all pairs", stars}, {"chain of springs", chain}};

  double const share = options.seconds / static_cast<double>(std::size(entries) * counts.size());
  fmt::print("bzm {}, instructions {}\n\n", described_version, instructions);
  fmt::print("{:20} {:>9} {:>8} {:>17} {:>10}\n", "problem", "particles", "threads", "particle-steps/s", "pairs/s");
  std::vector<Row> rows;
  for (auto const& entry : entries) {
    Problem problem = entry.make();
    for (int const threads : counts) {
      problem.simulation->threads(threads);
      double const steps = measure(*problem.simulation, share);
      rows.push_back({entry.name, problem.particles->size(), threads, steps, steps * problem.pairs});
      fmt::print("{:20} {:>9} {:>8} {:>17} {:>10}\n", entry.name, problem.particles->size(), threads,
                 rate(steps * static_cast<double>(problem.particles->size())), rate(steps * problem.pairs));
      std::fflush(stdout);
    }
  }
  fmt::print("\nA pair is an influence of one particle on another; the median of five runs each.\n");
  figures.write(rows, instructions);
  return 0;
}

}  // namespace boltzmann::bzm
