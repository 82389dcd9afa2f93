// Runs a recording to its end and prints the summary table.
#include <boltzmann/core/team.hpp>
#include <boltzmann/recording/planned_run.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/recording/run_loop.hpp>
#include <boltzmann/simulation/conserved.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace boltzmann {
namespace {

std::string large(double number) {
  if (number >= 1e9) return fmt::format("{:.3g} billion", number / 1e9);
  if (number >= 1e6) return fmt::format("{:.3g} million", number / 1e6);
  return fmt::format("{:.6g}", number);
}

void print_summary(Recording const& recording, RunReport const& report, Conserved const& start, Conserved const& end,
                   double recorded) {
  Simulation const& simulation = recording.simulation();
  std::size_t now = 0;
  for (auto const* ensemble : simulation.ensembles()) now += ensemble->size();
  bool const changed = now != static_cast<std::size_t>(report.particles);
  fmt::print("\n{} particles{}, {} steps to step {}, time {}\n\n", report.particles,
             changed ? fmt::format(" at the start, {} at the end", now) : "", report.steps, simulation.step(),
             recording.units().text(simulation.time(), dimensions::time, 6));
  if (simulation.minimised()) fmt::print("  minimised {}\n\n", text(*simulation.minimised(), recording.units()));
  if (report.steps > 0) {
    for (auto const& line : conserved_table(start, end, recording.units())) fmt::print("{}\n", line);
    double const work = std::max(report.seconds - recorded, 1e-9);
    fmt::print("\n  speed    {} particle-steps/s, {:.3g} ns for a particle and step, {:.3g} s in all",
               large(report.particle_steps / work), work / std::max(report.particle_steps, 1.0) * 1e9, report.seconds);
    if (recorded > 0) fmt::print(" ({:.2g} s of it measuring and writing)", recorded);
    fmt::print("\n");
  }
  for (auto const* scheme : simulation.schemes())
    if (auto const line = scheme->report(); !line.empty()) fmt::print("  scheme   {}\n", line);
  for (auto const* dissipation : simulation.dissipations())
    if (auto const line = dissipation->report(); !line.empty()) fmt::print("  dissipation {}\n", line);
  for (auto const& barostat : simulation.barostats())
    if (auto const line = barostat->report(); !line.empty()) fmt::print("  box      {}\n", line);
  for (auto const* adaptation : simulation.adaptations())
    if (auto const line = adaptation->report(recording.units()); !line.empty()) fmt::print("  changes  {}\n", line);
  for (auto const* diagnosis : recording.instruments())
    for (auto const& line : diagnosis->report(recording.units())) fmt::print("  mean     {}\n", line);
  if (!report.condition.empty())
    fmt::print("  stop     {}: true at step {}\n", report.condition, recording.ended_step());
  fmt::print("  results  {}: {}\n", recording.folder(), join(recording.files()));
  std::fflush(stdout);
}

}  // namespace

RunReport run_with_progress(Recording& recording, std::uint64_t steps, ProgressOptions const& options) {
  Simulation& simulation = recording.simulation();
  Interrupt const interrupt(simulation);
  steps = recording.resume_if_asked(steps);
  simulation.check();
  // The initial values of conserved quantities are known only after equilibration.
  Conserved start = conserved(simulation);
  Attending const observer(
      simulation, simulation.observe_when([first = simulation.step()](std::int64_t step) { return step == first; },
                                          [&start](Simulation const& now) {
                                            start = conserved(now);
                                            need_finite(now, start);
                                          }));
  if (options.warnings && simulation.step() == 0)
    for (auto const& line : planned_warnings(recording, static_cast<std::int64_t>(steps)))
      fmt::print(stderr, "{}\n", line);
  double const before = recording.seconds();
  RunReport report;
  try {
    report = run_loop(simulation, steps, options, interrupt, [&] { return recording.checkpoint_seconds(); });
  } catch (PhysicsFailure const& failure) {
    recording.give_up();
    if (recording.checkpoint_step() < 0) throw;
    std::int64_t const every = recording.diagnoses_every();
    throw PhysicsFailure(fmt::format(
        "{}\nlast good checkpoint: {}/checkpoint.h5 (step {}){}", failure.what(), recording.folder(),
        recording.checkpoint_step(),
        every > 1
            ? fmt::format("; diagnoses were every {} steps, every 1 (--set output.diagnoses=1) shows the way there",
                          every)
            : ""));
  }
  double const recorded = recording.seconds() - before;
  recording.finish();
  report.signalled = team().any(interrupt.seen());
  report.condition = recording.ended_by();
  if (!report.condition.empty() && recording.ended_step() == simulation.step())
    report.interrupted = report.out_of_time = false;
  Conserved const end = conserved(simulation);
  need_finite(simulation, end);
  if (!options.quiet) print_summary(recording, report, start, end, recorded);
  auto const tell = [&](std::string const& line) {
    if (options.tell)
      options.tell(line);
    else
      fmt::print(stderr, "{}\n", line);
  };
  std::string const whose = options.warnings ? "" : recording.folder() + ": ";
  for (auto const& line : drift_warnings(start, end, recording.units())) tell(whose + line);
  for (auto const& barostat : simulation.barostats())
    for (auto const& line : barostat->warnings(recording.units())) tell(whose + line);
  if (auto const& minimised = simulation.minimised(); minimised && !minimised->converged)
    tell(fmt::format("{}warning: the minimum before the run was not reached: {}", whose,
                     text(*minimised, recording.units())));
  if (report.interrupted || report.out_of_time)
    tell(fmt::format("{} after step {}; its checkpoint is written: {}/checkpoint.h5",
                     report.interrupted ? "stopped by a signal" : "out of time", simulation.step(),
                     recording.folder()));
  return report;
}

int report(std::exception const& error) {
  tell_failure(error.what());
  if (dynamic_cast<Error const*>(&error)) return 2;
  if (dynamic_cast<PhysicsFailure const*>(&error)) return 3;
  if (auto const* of_rank = dynamic_cast<TeamFailure const*>(&error)) return of_rank->status;
  return 1;
}

}  // namespace boltzmann
