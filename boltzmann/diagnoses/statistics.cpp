// Means, standard errors and least squares, in two passes each: first the means, then what is around them.
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
  // The place of the error's second digit, after rounding has carried over (0.0996 is 0.10).
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
