// Checks that a run is long enough for its measurements, and its time steps short enough to its end.
#include <boltzmann/diagnoses/average.hpp>
#include <boltzmann/diagnoses/diffusion.hpp>
#include <boltzmann/diagnoses/green_kubo.hpp>
#include <boltzmann/diagnoses/heat_flux.hpp>
#include <boltzmann/diagnoses/mean_profile.hpp>
#include <boltzmann/diagnoses/radial_distribution.hpp>
#include <boltzmann/diagnoses/shock.hpp>
#include <boltzmann/diagnoses/structure_factor.hpp>
#include <boltzmann/diagnoses/time_correlation.hpp>
#include <boltzmann/diagnoses/wave_spectrum.hpp>
#include <boltzmann/recording/planned_run.hpp>
#include <boltzmann/simulation/collapse.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace boltzmann {
namespace {

constexpr std::int64_t looks_of_a_spectrum = 4;

struct Plan {
  double time, step_size;
  std::int64_t steps, rows_every;
  UnitSystem const& units;

  double end() const { return time + static_cast<double>(steps) * step_size; }
  std::string told(double number) const { return units.text(number, dimensions::time, 3); }
  /// The number of samples at this interval from a time on.
  std::int64_t looks(std::int64_t every, double since) const {
    if (every < 1) return 0;
    std::int64_t skipped = 0;
    if (since > time && step_size > 0)
      skipped = static_cast<std::int64_t>(
          std::ceil(std::min((since - time) / step_size, 1e18) / static_cast<double>(every) - 1e-9));
    return std::max<std::int64_t>(0, steps / every + 1 - skipped);
  }
};

/// A diagnosis that correlates samples up to `count` intervals apart.
struct Correlator {
  std::string kind, result;
  std::int64_t every;
  double since;
  std::size_t count;
};
std::optional<Correlator> correlator(Diagnosis const& diagnosis, Plan const& plan) {
  if (auto const* one = dynamic_cast<TimeCorrelation const*>(&diagnosis))
    return Correlator{
        dynamic_cast<MeanSquareDisplacement const*>(one) ? "mean-square-displacement" : "velocity-autocorrelation",
        "diffusion coefficient", static_cast<std::int64_t>(one->options().every), one->options().since,
        one->options().count};
  if (auto const* one = dynamic_cast<GreenKubo const*>(&diagnosis))
    return Correlator{"green-kubo", one->columns().front().name, plan.rows_every, one->options().since,
                      one->options().count};
  return std::nullopt;
}

/// The time from which it measures, if one was given.
double since(Diagnosis const& diagnosis) {
  if (auto const* one = dynamic_cast<Average const*>(&diagnosis)) return one->since();
  if (auto const* one = dynamic_cast<Diffusion const*>(&diagnosis)) return one->since();
  if (auto const* one = dynamic_cast<HeatFlux const*>(&diagnosis)) return one->since();
  if (auto const* one = dynamic_cast<MeanProfile const*>(&diagnosis)) return one->since();
  if (auto const* one = dynamic_cast<RadialDistribution const*>(&diagnosis)) return one->since();
  if (auto const* one = dynamic_cast<StructureFactor const*>(&diagnosis)) return one->since();
  if (auto const* one = dynamic_cast<Shock const*>(&diagnosis)) return one->options().since;
  return 0;
}

std::string name_of(Diagnosis const& diagnosis) {
  auto const columns = diagnosis.columns();
  if (!columns.empty()) return columns.front().name;
  auto const tables = diagnosis.tables();
  return tables.empty() ? "a diagnosis" : tables.front().name;
}

std::string too_few_looks(Correlator const& one, Plan const& plan) {
  std::int64_t const looks = plan.looks(one.every, one.since);
  if (looks > static_cast<std::int64_t>(one.count)) return "";
  double const interval = static_cast<double>(one.every) * std::abs(plan.step_size);
  double const left = plan.end() - std::max(plan.time, one.since);
  bool const late = one.since > plan.time;
  return fmt::format("warning: {}: the longest lag is {}, the run has {}{}: no {}; {}", one.kind,
                     plan.told(static_cast<double>(one.count) * interval), plan.told(std::max(0.0, left)),
                     late ? " from 'since' on" : "", one.result,
                     looks > 2 ? fmt::format("count = {}", looks / 2)
                     : late    ? "run longer, or take an earlier 'since'"
                               : "run longer, or sample more often");
}

std::string warning_of(Diagnosis const& diagnosis, Plan const& plan) {
  if (auto const one = correlator(diagnosis, plan)) return too_few_looks(*one, plan);
  if (double const from = since(diagnosis); from > plan.end() && plan.step_size > 0)
    return fmt::format(
        "warning: '{}' is measured from the time {} on, and the run ends at {}: nothing is measured; run longer, or "
        "take "
        "an earlier 'since'",
        name_of(diagnosis), plan.told(from), plan.told(plan.end()));
  if (dynamic_cast<WaveSpectrum const*>(&diagnosis) && plan.looks(plan.rows_every, 0) < looks_of_a_spectrum)
    return fmt::format("warning: wave-spectrum: it needs {} rows of diagnoses, the run has {}: no spectrum; {}",
                       looks_of_a_spectrum, plan.looks(plan.rows_every, 0),
                       plan.steps >= looks_of_a_spectrum
                           ? fmt::format("write diagnoses = {} in [output]", plan.steps / looks_of_a_spectrum)
                           : "run longer");
  return "";
}

}  // namespace

std::vector<std::string> planned_warnings(Recording const& recording, std::int64_t steps) {
  Simulation const& simulation = recording.simulation();
  Plan const plan{simulation.time(), simulation.step_size(), steps, recording.diagnoses_every(), recording.units()};
  std::vector<std::string> lines;
  if (steps <= 0) return lines;
  for (auto const* diagnosis : recording.instruments())
    if (auto line = warning_of(*diagnosis, plan); !line.empty()) lines.push_back(std::move(line));
  double const duration = static_cast<double>(steps) * std::abs(plan.step_size);
  if (auto line = warn_of_collapse(simulation, duration); !line.empty()) lines.push_back(std::move(line));
  return lines;
}

}  // namespace boltzmann
