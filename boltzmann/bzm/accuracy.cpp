// bzm accuracy: error against cost, as a basis for the choice of a tolerance.
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/pictures/draw_arrays.hpp>
#include <boltzmann/pictures/figure.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/schemes/multipole/multipole_scheme.hpp>

#include <fmt/format.h>

#include <cmath>

namespace boltzmann::bzm {

int accuracy(AccuracyOptions const& options) {
  if (!options.out.empty() && !ends_as_picture(options.out))
    throw Error("'" + options.out + "' ends in none of .png, .svg, .pdf");
  auto const scenario = load_scenario(read_scenario(find_scenario(options.scenario)), options.overrides);
  auto* const scheme = scenario->scheme<MultipoleScheme>();
  if (!scheme)
    throw Error(
        "accuracy: the scenario has no [multipole]; other schemes have no tolerance to choose (a mesh with "
        "'accuracy' keeps to it)");
  scenario->simulation->check();
  std::size_t particles = 0;
  for (auto const* ensemble : scheme->ensembles()) particles += ensemble->size();
  fmt::print("All influences on {} particle{} by multipoles, {} thread{}:\n", particles, particles == 1 ? "" : "s",
             scheme->threads(), scheme->threads() == 1 ? "" : "s");
  fmt::print("  {:>9}  {:>9}  {:>5}  {:>12}  {:>12}  {:>9}\n", "tolerance", "error", "order", "translations", "pairs",
             "seconds");
  std::vector<double> errors, seconds;
  for (int digits = 1; digits <= 10; ++digits) {
    double const tolerance = std::pow(10.0, -digits);
    auto const trial = scheme->try_tolerance(tolerance);
    auto const& found = trial.accuracy;
    if (found.order == 0) {
      fmt::print("  {:9.0e}  {:>9}  {:>5}  {:>12}  {:12.4g}  {:9.3g}\n", tolerance, "rounding", "", "",
                 static_cast<double>(found.pairs), trial.seconds);
      if (errors.empty()) break;  // so few sources that the sums are exact at every tolerance
    } else {
      fmt::print("  {:9.0e}  {:9.1e}  {:5}  {:12.4g}  {:12.4g}  {:9.3g}\n", tolerance, found.measured, found.order,
                 static_cast<double>(found.translations), static_cast<double>(found.pairs), trial.seconds);
      errors.push_back(found.measured);
      seconds.push_back(trial.seconds);
    }
    std::fflush(stdout);
  }
  if (options.out.empty()) return 0;
  if (errors.size() < 2) throw Error("accuracy: there is nothing to draw: everything is summed directly");
  Series const curve{"", errors, seconds};
  Axis x{"error of the influences", ""}, y{"seconds for all influences", ""};
  x.logarithmic = y.logarithmic = true;
  write_picture(draw_profile(std::span(&curve, 1), x, y, fmt::format("{} particles by multipoles", particles)),
                options.out);
  return 0;
}

}  // namespace boltzmann::bzm
