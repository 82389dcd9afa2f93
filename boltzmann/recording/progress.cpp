// The progress line. The clock is read only as often as the line can change, so the cost is negligible for small
// systems.
#include <boltzmann/core/clock.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/recording/interrupt.hpp>
#include <boltzmann/recording/progress.hpp>
#include <boltzmann/recording/run_loop.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

namespace boltzmann {
namespace {

// 1234567 -> "1.23 million".
std::string rate_text(double rate) {
  if (rate >= 1e6) return fmt::format("{:.3g} million", rate / 1e6);
  if (rate >= 100) return fmt::format("{:.0f}", rate);
  return fmt::format("{:.3g}", rate);
}

class ProgressLine {
 public:
  ProgressLine(std::int64_t first, std::int64_t last, std::int64_t planned)
      : first_(first),
        last_(last),
        planned_(std::max(planned, last)),
        terminal_(rewrites_lines()),
        next_tenth_(planned_ > 0 ? first * 10 / planned_ + 1 : 11) {}

  /// The work before the first step may take long: equilibration, lists, plans of transforms.
  void begin(bool equilibrates) const {
    char const* const what = equilibrates ? "equilibrating" : "getting ready";
    if (terminal_)
      fmt::print(stderr, "\r{}: {}\033[K", place(first_), what), std::fflush(stderr);
    else if (equilibrates)
      fmt::print(stderr, "{}\n", what);
  }

  /// Reads the clock if enough steps have passed since the last reading.
  void look(std::int64_t step) {
    if (step < next_look_ && step != last_) return;
    if (!stepped_) {  // steps are timed from here on
      stepped_ = true;
      first_ = step;
      start_ = Clock::now();
    }
    double const now = seconds_since(start_);
    std::int64_t const done = step - first_;
    if (terminal_) {
      if (now - shown_ >= 0.2) show(step, now);
    } else {
      while (next_tenth_ <= 10 && step * 10 >= next_tenth_ * planned_) {
        next_tenth_ = step * 10 / planned_ + 1;
        show(step, now);
      }
    }
    // Schedule the next reading 50 ms from now, but never more than twice as many steps ahead as were done.
    double const rate = now > 0 ? static_cast<double>(done) / now : 1;
    auto ahead =
        static_cast<std::int64_t>(std::clamp(rate * 0.05, 1.0, static_cast<double>(std::max<std::int64_t>(done, 1))));
    next_look_ = step + ahead;
    if (!terminal_) next_look_ = std::min(next_look_, (next_tenth_ * planned_ + 9) / 10);
  }

  void clear() const {
    if (terminal_) std::fputs("\r\033[K", stderr);
  }

 private:
  std::string place(std::int64_t step) const {
    return fmt::format("{:3d} %  step {} of {}", planned_ > 0 ? 100 * step / planned_ : 100, step, planned_);
  }
  void show(std::int64_t step, double now) {
    std::string line = place(step);
    if (step > first_) {
      double const rate = static_cast<double>(step - first_) / std::max(now, 1e-9);
      line += fmt::format(", {} steps/s, {} left", rate_text(rate),
                          duration_text(static_cast<double>(last_ - step) / std::max(rate, 1e-9)));
    }
    fmt::print(stderr, "{}{}{}", terminal_ ? "\r" : "", line, terminal_ ? "\033[K" : "\n");
    std::fflush(stderr);
    shown_ = now;
  }

  Clock::time_point start_ = Clock::now();
  std::int64_t first_, last_, planned_, next_look_ = 0;
  bool terminal_, stepped_ = false;
  std::int64_t next_tenth_;
  double shown_ = 0;
};

// Decides whether further steps and the output at the end fit into the remaining time.
class TimeLimit {
 public:
  TimeLimit(double seconds, std::function<double()> seconds_at_end)
      : seconds_(seconds), seconds_at_end_(std::move(seconds_at_end)) {}

  /// Called after each step. Returns true when the limit is reached.
  bool reached() {
    if (++steps_ < between_looks_) return false;
    double const now = seconds_since(start_), took = now - last_look_;
    steps_ = 0;
    if (last_look_ > 0) longest_ = std::max(longest_, took);  // exclude the setup before the first step
    last_look_ = now;
    // Reading the clock costs as much as ten pairs. It is read after every step unless steps are short.
    between_looks_ =
        took > 1e-3 ? std::max<std::int64_t>(between_looks_ / 2, 1) : std::min<std::int64_t>(2 * between_looks_, 64);
    return now + 2 * longest_ + 2 * (seconds_at_end_ ? seconds_at_end_() : 0) >= seconds_;
  }

 private:
  Clock::time_point start_ = Clock::now();
  double seconds_, last_look_ = 0, longest_ = 0;
  std::function<double()> seconds_at_end_;
  std::int64_t steps_ = 0, between_looks_ = 1;
};

// Observer of each step: the progress line, the time limit, and the count of moved particles where their number
// changes.
struct Watch {
  std::optional<ProgressLine> line;
  std::optional<TimeLimit> limit;
  std::optional<double> particle_steps;
  bool out_of_time = false;

  void look(Simulation& simulation) {
    if (line) line->look(simulation.step());
    if (particle_steps)
      for (auto const* ensemble : simulation.ensembles()) *particle_steps += static_cast<double>(ensemble->size());
    if (!limit || out_of_time || !limit->reached()) return;
    out_of_time = true;
    simulation.pause();
  }
  void end() const {
    if (line) line->clear();
  }
};

}  // namespace

void print_warnings(Simulation const& simulation, ProgressOptions const& options) {
  auto const print = [&](std::vector<std::string> const& lines) {
    for (auto const& line : lines)
      if (line.starts_with("warning") ? options.warnings : !options.quiet) fmt::print(stderr, "{}\n", line);
  };
  for (auto* scheme : simulation.schemes()) print(scheme->warnings(simulation.step_size()));
  for (auto* dissipation : simulation.dissipations()) print(dissipation->warnings(simulation.step_size()));
  if (team().alone()) return;
  std::string const why = simulation.undivided();
  print({why.empty() ? fmt::format("{} ranks share the particles", team().size())
                     : fmt::format("each of the {} ranks does all the work: runs with {} are not divided so far",
                                   team().size(), why)});
}

bool rewrites_lines() {
  char const* terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::string(terminal) != "dumb";
}

std::string duration_text(double seconds) {
  if (!(seconds < 1e8)) return "long";
  if (seconds < 10) return fmt::format("{:.1f} s", seconds);
  if (seconds < 60) return fmt::format("{:.0f} s", std::ceil(seconds));
  auto const whole = static_cast<long>(seconds);
  if (whole < 3600) return fmt::format("{} min {:02d} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02d} min", whole / 3600, whole / 60 % 60);
}

RunReport run_loop(Simulation& simulation, std::uint64_t steps, ProgressOptions const& options,
                   Interrupt const& interrupt, std::function<double()> const& seconds_at_end) {
  Watch watch;
  if (options.seconds > 0) watch.limit.emplace(options.seconds, seconds_at_end);
  simulation.check();
  RunReport report;
  for (auto const* ensemble : simulation.ensembles()) report.particles += static_cast<std::int64_t>(ensemble->size());
  std::int64_t const first = simulation.step();
  print_warnings(simulation, options);
  if (!options.quiet) watch.line.emplace(first, first + static_cast<std::int64_t>(steps), options.planned);
  if (simulation.numbers_change()) watch.particle_steps = 0;
  std::optional<Attending> attending;
  if (watch.line || watch.limit || watch.particle_steps)
    attending.emplace(simulation, simulation.observe_progress([&](Simulation const&) { watch.look(simulation); }));
  auto const start = Clock::now();
  if (watch.line && !options.drive) watch.line->begin(simulation.equilibrates());
  try {
    if (options.drive)
      options.drive(steps);
    else
      simulation.run(steps);
  } catch (...) {
    watch.end();
    throw;
  }
  watch.end();
  report.seconds = seconds_since(start);
  report.steps = simulation.step() - first;
  report.particle_steps =
      watch.particle_steps.value_or(static_cast<double>(report.particles) * static_cast<double>(report.steps));
  report.signalled = team().any(interrupt.seen());
  bool const early = report.steps < static_cast<std::int64_t>(steps);
  report.interrupted = report.signalled && early;
  report.out_of_time = team().any(watch.out_of_time) && early && !report.interrupted;
  return report;
}

RunReport run_with_progress(Simulation& simulation, std::uint64_t steps, ProgressOptions const& options) {
  Interrupt const interrupt(simulation);
  return run_loop(simulation, steps, options, interrupt);
}

}  // namespace boltzmann
