// Means, standard errors and least squares, in two passes each: first the means, then the deviations.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/statistics.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {

MeanError mean_with_error(std::span<double const> values) {
  MeanError result;
  double sum = 0;
  for (double const v : values)
    if (std::isfinite(v)) sum += v, ++result.count;
  if (result.count == 0) return result;
  auto const n = static_cast<double>(result.count);
  result.mean = sum / n;
  if (result.count < 2) return result;
  double squares = 0;
  for (double const v : values)
    if (std::isfinite(v)) squares += (v - result.mean) * (v - result.mean);
  result.error = std::sqrt(squares / (n - 1) / n);
  return result;
}

std::string text_of(MeanError const& value) {
  if (!std::isfinite(value.mean)) return "nan";
  if (!std::isfinite(value.error)) return fmt::format("{:.6g}", value.mean);
  if (value.error == 0) return fmt::format("{:.6g} ± 0", value.mean);
  // The decimal place of the error's second digit, after rounding has carried over (0.0996 is 0.10).
  std::string const rounded = fmt::format("{:.1e}", value.error);
  int const last = std::stoi(rounded.substr(rounded.find('e') + 1)) - 1;
  double const larger = std::max(std::abs(value.mean), value.error);
  int const power = static_cast<int>(std::floor(std::log10(larger)));
  bool const plain = power < 6 && power > -5;
  int const shift = plain ? 0 : power;
  double const scale = std::pow(10.0, -shift);
  int const digits = std::clamp(shift - last, 0, 17);
  std::string const text = fmt::format("{:.{}f} ± {:.{}f}", value.mean * scale, digits, value.error * scale, digits);
  return plain ? text : fmt::format("({})e{:+03d}", text, shift);
}

void BlockSums::add(double value) {
  for (std::size_t k = 0;; ++k) {
    if (k == levels_.size()) levels_.emplace_back();
    Level& level = levels_[k];
    level.count += 1;
    double const off = value - level.mean;
    level.mean += off / level.count;
    level.squares += off * (value - level.mean);
    level.waits = 1 - level.waits;
    if (level.waits != 0) {
      level.waiting = value;
      return;
    }
    value = 0.5 * (level.waiting + value);
  }
}

std::size_t BlockSums::count() const { return levels_.empty() ? 0 : static_cast<std::size_t>(levels_[0].count); }

std::vector<BlockSums::Blocks> BlockSums::blocks() const {
  std::vector<Blocks> all;
  std::size_t length = 1;
  for (auto const& level : levels_) {
    double const error = level.count > 1 ? std::sqrt(level.squares / (level.count * (level.count - 1)))
                                         : std::numeric_limits<double>::quiet_NaN();
    all.push_back({length, static_cast<std::size_t>(level.count), error});
    length *= 2;
  }
  return all;
}

MeanError BlockSums::mean() const {
  constexpr std::size_t least = 8;
  MeanError result;
  if (levels_.empty()) return result;
  result.mean = levels_[0].mean;
  auto const all = blocks();
  for (auto const& one : all) {
    if (one.number < least) break;
    double const ratio = all[0].error > 0 ? one.error / all[0].error : 1, length = static_cast<double>(one.length);
    if (length * length * length <= 2 * levels_[0].count * std::pow(ratio, 4)) continue;
    result.error = one.error;
    result.count = one.number;
    break;
  }
  return result;
}

std::vector<double> BlockSums::state() const {
  std::vector<double> state;
  for (auto const& level : levels_)
    state.insert(state.end(), {level.count, level.mean, level.squares, level.waiting, level.waits});
  return state;
}

void BlockSums::restore(std::span<double const> state) {
  if (state.size() % 5 != 0) throw Error("the checkpoint does not fit this diagnosis: its sums are others");
  levels_.clear();
  for (std::size_t k = 0; k < state.size(); k += 5)
    levels_.push_back({state[k], state[k + 1], state[k + 2], state[k + 3], state[k + 4]});
}

void LineSums::add(double x, double y) {
  count_ += 1;
  double const dx = x - x_, dy = y - y_;
  x_ += dx / count_;
  y_ += dy / count_;
  xx_ += dx * (x - x_);
  xy_ += dx * (y - y_);
  yy_ += dy * (y - y_);
}

LineFit LineSums::fit() const {
  LineFit fit;
  fit.intercept.count = fit.slope.count = count();
  if (count_ < 2 || !(xx_ > 0)) return fit;
  fit.slope.mean = xy_ / xx_;
  fit.intercept.mean = y_ - fit.slope.mean * x_;
  if (count_ < 3) return fit;
  double const variance = std::max(0.0, yy_ - fit.slope.mean * xy_) / (count_ - 2);
  fit.slope.error = std::sqrt(variance / xx_);
  fit.intercept.error = std::sqrt(variance * (1 / count_ + x_ * x_ / xx_));
  return fit;
}

void LineSums::restore(std::span<double const> state) {
  if (state.size() != state_size) throw Error("the checkpoint does not fit this diagnosis: its sums are others");
  count_ = state[0];
  x_ = state[1];
  y_ = state[2];
  xx_ = state[3];
  xy_ = state[4];
  yy_ = state[5];
}

LineFit fit_line(std::span<double const> x, std::span<double const> y) {
  if (x.size() != y.size())
    throw Error(fmt::format("a line through points needs as many y as x, not {} and {}", y.size(), x.size()));
  LineSums sums;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i])) sums.add(x[i], y[i]);
  return sums.fit();
}

}  // namespace boltzmann
