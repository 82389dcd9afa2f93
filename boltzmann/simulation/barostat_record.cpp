// The record of a barostat's pressure, and the warnings at the end of a run.
#include <boltzmann/simulation/barostat.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr std::size_t moves_to_judge = 50;
constexpr double least_accepted = 0.1;   // of all moves
constexpr double times_to_judge = 20;    // in relaxation times of the box
constexpr double errors_to_warn = 5;     // standard errors of the mean
constexpr double strain_to_warn = 0.05;  // the strain of the volume that corresponds to the pressure difference

struct Mean {
  double value = 0, error = 0;
};
Mean mean_of(std::span<double const> parts) {
  Mean mean;
  auto const count = static_cast<double>(parts.size());
  for (double const x : parts) mean.value += x / count;
  for (double const x : parts) mean.error += (x - mean.value) * (x - mean.value);
  mean.error = std::sqrt(mean.error / (count * (count - 1)));
  return mean;
}

double two_digits_below(double x) {
  double const unit = std::pow(10.0, std::floor(std::log10(x)) - 1);
  return unit * std::floor(x / unit);
}

}  // namespace

void Barostat::Record::add(double difference) {
  sum += difference;
  in_part += 1;
  if (in_part < length) return;
  means[static_cast<std::size_t>(parts)] = sum / length;
  parts += 1;
  sum = in_part = 0;
  if (static_cast<std::size_t>(parts) < most) return;
  for (std::size_t k = 0; k < most / 2; ++k) means[k] = 0.5 * (means[2 * k] + means[2 * k + 1]);
  parts = most / 2;
  length *= 2;
}

std::vector<double> Barostat::Record::state() const {
  std::vector<double> state{parts, length, in_part, sum, duration};
  state.insert(state.end(), means.begin(), means.end());
  return state;
}

void Barostat::Record::restore(std::span<double const> state) {
  parts = state[0], length = state[1], in_part = state[2], sum = state[3], duration = state[4];
  std::copy_n(state.begin() + 5, most, means.begin());
}

std::vector<std::string> Barostat::warnings(UnitSystem const& units) const {
  auto const rate = [&](double number) { return units.text(number, dimensions::frequency, 2); };
  if (options_.method == BarostatMethod::cell_rescaling && moves_ >= moves_to_judge &&
      static_cast<double>(accepted_) < least_accepted * static_cast<double>(moves_)) {
    double const slower = two_digits_below(std::min(0.1 * options_.rate, 0.1 / record_.duration));
    return {
        fmt::format("warning: the barostat accepted {} of {} moves of the box, so it does not hold the pressure: its "
                    "moves are too large; take a smaller rate, such as {}",
                    accepted_, moves_, rate(slower))};
  }
  auto const parts = static_cast<std::size_t>(record_.parts);
  double const time = record_.parts * record_.length * record_.duration;
  if (pressure_of_time_ || parts < Record::most / 2 || time * options_.rate < times_to_judge) return {};
  std::span<double const> const later = std::span(record_.means).subspan(parts / 2, parts - parts / 2);
  Mean const mean = mean_of(later);
  double const first = mean_of(later.first(later.size() / 2)).value, last = mean_of(later.last(later.size() / 2)).value;
  bool const relaxing = std::abs(last) < 0.7 * std::abs(first) && first * last > 0;
  if (std::abs(mean.value) < errors_to_warn * mean.error || relaxing ||
      std::abs(mean.value) * options_.compressibility < strain_to_warn)
    return {};
  auto const text = [&](double number) {
    return units.text(number, dimensions::energy / pow(dimensions::length, dimension_), 3);
  };
  return {
      fmt::format("warning: the barostat does not hold the pressure: the mean over the second half of the run is {}, "
                  "and should be {}; run longer, or check 'rate' and 'compressibility'",
                  text(options_.pressure + mean.value), text(options_.pressure))};
}

}  // namespace boltzmann
