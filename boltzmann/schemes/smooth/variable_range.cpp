// Finds ranges consistent with the densities that they give.
#include <boltzmann/core/error.hpp>
#include <boltzmann/schemes/smooth/loaded.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {

using namespace detail;

namespace {
constexpr double precision = 1e-12;  // relative accuracy of ranges
}

/// Computes the ranges of the next iteration. Returns the largest relative change.
double SmoothScheme::new_ranges(RangeBracket& bracket) {
  double largest_change = 0;
  in_dimension(box().dimension(), [&](auto d) {
    constexpr int D = d;
    for (auto const& loaded : loaded_)
      for (std::size_t i = 0; i < loaded->ensemble->size(); ++i) {
        auto& p = *reinterpret_cast<Smooth<D>*>(loaded->ensemble->row(i));
        double &low = bracket.shorter[loaded->first + i], &high = bracket.longer[loaded->first + i];
        double const excess = std::log(p.density / p.mass * detail::power<D>(p.range / variable_->spacings));
        (excess < 0 ? low : high) = std::clamp(p.range, variable_->shortest, variable_->longest);
        double wanted = p.range * std::exp(std::clamp(-excess * bracket.factor[loaded->first + i] / D, -1.0, 1.0));
        if (std::abs(wanted / p.range - 1) > precision && !(wanted > low && wanted < high)) {
          if (wanted <= low && low > variable_->shortest)
            wanted = std::sqrt(low * high);
          else if (wanted >= high && high < variable_->longest)
            wanted = low > 0 ? std::sqrt(low * high) : 0.5 * high;
          else
            wanted = std::clamp(wanted, low, high);
        }
        largest_change = std::max(largest_change, std::abs(wanted / p.range - 1));
        p.range = wanted;
      }
  });
  return largest_change;
}

void SmoothScheme::variable_range(VariableRange const& variable) {
  check_parameter("variable range", "spacings", variable.spacings, positive);
  check_parameter("variable range", "shortest", variable.shortest, not_negative);
  check_parameter("variable range", "longest", variable.longest, not_negative);
  if (density_from_ != DensityFrom::summation)
    throw Error("ranges follow densities that are summed; with densities from continuity they stay");
  if (loaded_.empty()) throw Error("variable_range() computes the ranges of particles: set their materials before it");
  take_places();
  variable_ = variable;
  if (variable.longest == 0) variable_->longest = 4 * longest_;
  if (variable_->longest < variable.shortest)
    throw Error(fmt::format("variable range: longest = {:.6g} is below shortest = {:.6g}", variable_->longest,
                            variable.shortest));
  hood_.reset();
  changed();
  // Solves range = spacings (mass / density(range))^(1/D) by Newton's iteration for each particle, with the derivative
  // from the grad-h factor, bracketed by a lower and an upper bound. Density range^D grows with the range.
  constexpr int max_iterations = 200;
  RangeBracket bracket{std::vector<double>(count()), std::vector<double>(count(), variable_->shortest),
                       std::vector<double>(count(), variable_->longest)};
  for (int iteration = 0;; ++iteration) {
    find(Until::state);
    for (std::size_t k = 0; k < factors_.size(); ++k) bracket.factor[hood_->target(0).order()[k]] = factors_[k];
    double const largest_change = new_ranges(bracket);
    if (largest_change < precision) break;
    if (iteration == max_iterations)
      throw Error(
          fmt::format("variable range: no ranges of {:.6g} spacings exist (after {} iterations they still change by "
                      "{:.1e}); this weight needs more than {:.3g}, 3 are usual",
                      variable.spacings, max_iterations, largest_change,
                      std::pow(loaded_.front()->task.self, 1.0 / box().dimension())));
  }
  // A gas that becomes thin must not end the run. So the limit is the range for which lists fit between the walls, with
  // a margin for overshoot.
  if (variable.longest == 0) {
    take_places();
    double const room = skin_ < 0 ? square(room_to_grow) * (1 + skin_of_range) : square(room_to_grow);
    for (int a = 0; a < box().dimension(); ++a)
      if (box().boundary(a) != Boundary::open)
        variable_->longest =
            std::min(variable_->longest, std::max(longest_, (box().length(a) - std::max(skin_, 0.0)) / room));
  }
}

}  // namespace boltzmann
