// Why a diagnosis can't have what it needs.
#include <boltzmann/diagnoses/diagnosis.hpp>

#include <boltzmann/core/error.hpp>

#include <fmt/format.h>
#include <cmath>

#include <algorithm>

namespace boltzmann {

void refuse_shear(Box const& box, char const* diagnosis) {
  if (box.sheared())
    throw Error(fmt::format("{}: in a sheared box it can't be had; viscosity, temperature, pressure and profiles can",
                            diagnosis));
}

std::string refusal(Diagnosis const& diagnosis, EnergyAndVirial const& measures) {
  std::string const what = diagnosis.columns().empty() ? "" : diagnosis.columns().front().name;
  if (diagnosis.needs_energies() && !measures.unknown.empty())
    return fmt::format("the diagnosis of '{}' needs energies, and {} gives none", what, measures.unknown);
  if (diagnosis.needs_virial() && !measures.no_virial.empty())
    return fmt::format("the diagnosis of '{}' needs the virial, which can't be had: {}", what, measures.no_virial);
  return "";
}

std::int64_t PlannedRun::looks(std::int64_t interval, double since) const {
  if (interval < 1 || steps < 0) return 0;
  std::int64_t skipped = 0;
  if (since > time && step_size > 0)
    skipped = static_cast<std::int64_t>(
        std::ceil(std::min((since - time) / step_size, 1e18) / static_cast<double>(interval)));
  return std::max<std::int64_t>(0, steps / interval + 1 - skipped);
}

std::vector<std::string> too_few_looks(PlannedRun const& run, UnitSystem const& units, std::string const& what,
                                       std::string const& result, std::int64_t every, double since, std::size_t count) {
  std::int64_t const looks = run.looks(every, since);
  if (looks > static_cast<std::int64_t>(count)) return {};
  auto const told = [&](double number) { return units.text(number, dimensions::time, 3); };
  double const interval = static_cast<double>(every) * std::abs(run.step_size);
  std::string const cure = looks > 2   ? fmt::format("count = {}", looks / 2)
                           : since > 0 ? "run longer, or from an earlier time (since)"
                                       : "run longer, or look more often";
  return {fmt::format(
      "warning: {}: the longest lag is {}, the run has {}{}: no {}; {}", what,
      told(static_cast<double>(count) * interval),
      told(std::max(0.0, static_cast<double>(run.steps) * std::abs(run.step_size) - std::max(0.0, since - run.time))),
      since > run.time ? " from the time on that is asked for" : "", result, cure)};
}

}  // namespace boltzmann
