// State laws: heat capacities, integrated.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/laws/invariant_law.hpp>
#include <boltzmann/laws/state_law.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace boltzmann {
namespace {

bool is_positive(double x) { return x > 0 && std::isfinite(x); }

double checked_capacity(std::function<double(double)> const& heat_capacity, double temperature) {
  double const value = heat_capacity(temperature);
  if (!is_positive(value))
    throw Error(fmt::format("state law: the heat capacity must be positive and finite, at the temperature {} it is {}",
                            temperature, std::isnan(value) ? std::abs(value) : value));  // NaN without its sign
  return value;
}

/// Points of a function, close enough that straight lines between them are accurate to `tolerance`; intervals are
/// halved as needed.
struct Sampling {
  std::function<double(double)> const& function;
  double tolerance;
  double floor;  // smaller values are treated like this
  std::vector<double>& x;
  std::vector<double>& y;

  /// Adds all points after x0 up to x1.
  void add(double x0, double y0, double x1, double y1, int depth) {
    double const middle = 0.5 * (x0 + x1);
    double const value = checked_capacity(function, middle);
    bool const straight = std::abs(value - 0.5 * (y0 + y1)) <= tolerance * std::max(value, floor);
    if (depth > 0 && !straight && middle > x0 && middle < x1) {
      add(x0, y0, middle, value, depth - 1);
      add(middle, value, x1, y1, depth - 1);
    } else {
      x.insert(x.end(), {middle, x1});
      y.insert(y.end(), {value, y1});
    }
  }
};

}  // namespace

StateLaw::StateLaw(double heat_capacity) : heat_capacity_(heat_capacity) {
  if (!is_positive(heat_capacity))
    throw Error(fmt::format("state law: the heat capacity must be positive and finite, it is {}", heat_capacity));
}

StateLaw::StateLaw(std::vector<double> temperatures, std::vector<double> heat_capacities)
    : temperature_(std::move(temperatures)), capacity_(std::move(heat_capacities)) {
  check_and_integrate();
}

StateLaw::StateLaw(std::function<double(double)> const& heat_capacity, double lowest, double highest) {
  if (!is_positive(lowest) || !(highest > lowest) || !std::isfinite(highest / lowest))
    throw Error(fmt::format(
        "state law: the temperatures must ascend from above zero, by a factor that is a number, not from {} "
        "to {}",
        lowest, highest));
  constexpr int pieces = 32;  // initial points: of equal ratio, so that details at low temperature are resolved
  std::vector<double> points(pieces + 1), values(pieces + 1);
  for (int i = 0; i <= pieces; ++i) {
    points[i] = i == pieces ? highest : lowest * std::pow(highest / lowest, static_cast<double>(i) / pieces);
    values[i] = checked_capacity(heat_capacity, points[i]);
  }
  temperature_ = {points[0]};
  capacity_ = {values[0]};
  Sampling sampling{heat_capacity, 1e-6, 1e-4 * *std::max_element(values.begin(), values.end()), temperature_,
                    capacity_};
  for (int i = 0; i < pieces; ++i)
    if (points[i + 1] > points[i]) sampling.add(points[i], values[i], points[i + 1], values[i + 1], 10);
  check_and_integrate();
}

void StateLaw::check_and_integrate() {
  std::size_t const size = temperature_.size();
  if (size != capacity_.size())
    throw Error(fmt::format("state law: {} temperatures, but {} heat capacities", size, capacity_.size()));
  if (size < 2) throw Error(fmt::format("state law: a table needs at least two temperatures, it has {}", size));
  if (size > std::numeric_limits<std::uint32_t>::max() / 8) throw Error("state law: the table is too long");
  for (std::size_t i = 0; i < size; ++i) {
    if (!is_positive(temperature_[i]))
      throw Error(
          fmt::format("state law: temperatures must be positive and finite, number {} is {}", i + 1, temperature_[i]));
    if (!is_positive(capacity_[i]))
      throw Error(
          fmt::format("state law: the heat capacity must be positive and finite, at the temperature {} it is {}",
                      temperature_[i], capacity_[i]));
    if (i > 0 && !(temperature_[i] > temperature_[i - 1]))
      throw Error(
          fmt::format("state law: temperatures must ascend, but {} follows {}", temperature_[i], temperature_[i - 1]));
  }

  ExactSum energy, entropy;
  energy += capacity_[0] * temperature_[0];
  energy_ = {energy.value()};
  entropy_ = {0};
  for (std::size_t i = 0; i + 1 < size; ++i) {
    double const width = temperature_[i + 1] - temperature_[i];
    double const slope = (capacity_[i + 1] - capacity_[i]) / width;
    slope_.push_back(slope);
    energy += 0.5 * (capacity_[i] + capacity_[i + 1]) * width;
    entropy += (capacity_[i] - slope * temperature_[i]) * std::log1p(width / temperature_[i]);
    entropy += slope * width;
    energy_.push_back(energy.value());
    entropy_.push_back(entropy.value());
  }
  if (!std::isfinite(energy_.back())) throw Error("state law: the energies of the table are not finite");

  // Positive numbers have the order of their bits, which increase linearly within each power of two.
  first_bits_ = std::bit_cast<std::uint64_t>(energy_.front());
  std::uint64_t const range = std::bit_cast<std::uint64_t>(energy_.back()) - first_bits_;
  while ((range >> shift_) > 4 * size) ++shift_;
  first_piece_.resize((range >> shift_) + 2);
  std::size_t piece = 0;
  for (std::size_t b = 0; b < first_piece_.size(); ++b) {
    auto const lowest = first_bits_ + (static_cast<std::uint64_t>(b) << shift_);
    while (piece + 2 < size && std::bit_cast<std::uint64_t>(energy_[piece + 1]) <= lowest) ++piece;
    first_piece_[b] = static_cast<std::uint32_t>(piece);
  }
}

/// The piece of an energy between the first and the last point.
std::size_t StateLaw::piece_of_energy(double energy) const {
  std::uint64_t const bucket = (std::bit_cast<std::uint64_t>(energy) - first_bits_) >> shift_;
  std::size_t low = first_piece_[bucket], high = first_piece_[bucket + 1];
  while (low < high) {
    std::size_t const middle = (low + high + 1) / 2;
    if (energy_[middle] <= energy)
      low = middle;
    else
      high = middle - 1;
  }
  return low;
}

/// The piece of a temperature between the first and the last one.
std::size_t StateLaw::piece_of_temperature(double temperature) const {
  auto const above = std::upper_bound(temperature_.begin() + 1, temperature_.end() - 1, temperature);
  return static_cast<std::size_t>(above - temperature_.begin()) - 1;
}

double StateLaw::energy(double temperature) const {
  if (constant()) return heat_capacity_ * temperature;
  if (!(temperature > temperature_.front())) return capacity_.front() * temperature;
  if (temperature >= temperature_.back())
    return energy_.back() + capacity_.back() * (temperature - temperature_.back());
  std::size_t const i = piece_of_temperature(temperature);
  double const t = temperature - temperature_[i];
  return energy_[i] + t * (capacity_[i] + 0.5 * slope_[i] * t);
}

double StateLaw::temperature(double energy) const {
  if (constant()) return energy / heat_capacity_;
  if (!(energy > energy_.front())) return energy / capacity_.front();
  if (energy >= energy_.back()) return temperature_.back() + (energy - energy_.back()) / capacity_.back();
  std::size_t const i = piece_of_energy(energy);
  double const rest = energy - energy_[i], capacity = capacity_[i];
  // The root of rest = capacity t + slope t^2 / 2 in the form that is accurate for any slope; the square root is Cv at
  // t.
  return temperature_[i] + 2 * rest / (capacity + std::sqrt(std::max(0.0, capacity * capacity + 2 * slope_[i] * rest)));
}

double StateLaw::heat_capacity(double temperature) const {
  if (constant()) return heat_capacity_;
  if (!(temperature > temperature_.front())) return capacity_.front();
  if (temperature >= temperature_.back()) return capacity_.back();
  std::size_t const i = piece_of_temperature(temperature);
  return capacity_[i] + slope_[i] * (temperature - temperature_[i]);
}

double StateLaw::entropy(double energy) const {
  if (constant()) return heat_capacity_ * std::log(energy);
  if (!(energy > energy_.front())) return capacity_.front() * std::log(energy / energy_.front());
  double const t = temperature(energy);
  if (energy >= energy_.back()) return entropy_.back() + capacity_.back() * std::log(t / temperature_.back());
  std::size_t const i = piece_of_energy(energy);
  double const rest = t - temperature_[i];
  return entropy_[i] + (capacity_[i] - slope_[i] * temperature_[i]) * std::log1p(rest / temperature_[i]) +
         slope_[i] * rest;
}

double StateLaw::draw(double temperature, double boltzmann_constant, Stream& stream) const {
  return quantile(stream.uniform(), temperature, boltzmann_constant);
}

double StateLaw::distribution(double energy, double temperature, double boltzmann_constant) const {
  return InvariantLaw(*this, temperature, boltzmann_constant).distribution(energy);
}

double StateLaw::quantile(double u, double temperature, double boltzmann_constant) const {
  return InvariantLaw(*this, temperature, boltzmann_constant).quantile(u);
}

}  // namespace boltzmann
