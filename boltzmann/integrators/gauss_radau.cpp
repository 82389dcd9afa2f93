// The method of Everhart, Rein and Spiegel on columns of numbers.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/integrators/gauss_radau.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr std::size_t grain = 4096;
constexpr int max_iterations = 12, max_attempts = 60;
constexpr double max_noise = 1e-6;  // of the last coefficient in the last iteration
/// The error of the last term if each rate has the relative error of a double: the sum of |1 / product over k of (h_i -
/// h_k)| over the nodes i.
constexpr double noise_of_last_term = 11525 * 1.1e-16;
/// A step is repeated if its size should have been less than this fraction; the next step grows by at most the
/// reciprocal (Rein and Spiegel's safety factor).
constexpr double shortest = 0.25;

/// Gauss-Radau spacings of [0, 1) with eight nodes, the first at 0.
constexpr std::array<double, 8> nodes{0,
                                      0.0562625605369221464656521910318,
                                      0.1802406917368923649875799428092,
                                      0.3526247171131696373739077702241,
                                      0.5471536263305553830014485576523,
                                      0.7342101772154105315232106055607,
                                      0.8853209468390957680903597629325,
                                      0.9775206135612875018911745004292};

struct Coefficients {
  /// s (s - h_1) ... (s - h_k) = sum over m of newton[k][m] s^(m + 1).
  std::array<std::array<double, 7>, 7> newton{};
  /// 1 / (h_i - h_k).
  std::array<std::array<double, 8>, 8> inverse{};
  /// Factors of b_k in the integral, and in the double integral, from 0 to each node; the last is the end of the step.
  std::array<std::array<double, 7>, 9> once{}, twice{};
  /// Factors of b_k in coefficient m of the polynomial of s + 1: binomials.
  std::array<std::array<double, 7>, 7> shifted{};
};

constexpr Coefficients make_coefficients() {
  Coefficients c;
  c.newton[0][0] = 1;
  for (std::size_t k = 1; k < 7; ++k)
    for (std::size_t m = 0; m <= k; ++m)
      c.newton[k][m] = (m > 0 ? c.newton[k - 1][m - 1] : 0) - nodes[k] * c.newton[k - 1][m];
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t k = 0; k < i; ++k) c.inverse[i][k] = 1 / (nodes[i] - nodes[k]);
  for (std::size_t i = 0; i < 9; ++i) {
    double const s = i < 8 ? nodes[i] : 1;
    double power = s;
    for (std::size_t k = 0; k < 7; ++k, power *= s) {
      c.once[i][k] = power / static_cast<double>(k + 2);
      c.twice[i][k] = power / static_cast<double>((k + 2) * (k + 3));
    }
  }
  for (std::size_t k = 0; k < 7; ++k) {
    double binomial = static_cast<double>(k + 1);  // (k + 1) over (m + 1)
    for (std::size_t m = 0; m <= k; ++m) {
      c.shifted[k][m] = binomial;
      binomial = binomial * static_cast<double>(k - m) / static_cast<double>(m + 2);
    }
  }
  return c;
}

constexpr Coefficients coefficients = make_coefficients();

/// The largest number, and whether all are finite: 0 times a finite number is 0, else NaN.
struct Extent {
  double largest = 0, zero = 0;
  void take(double x) {
    largest = std::max(largest, std::abs(x));
    zero += 0 * x;
  }
  bool finite() const { return zero == 0; }
};

/// Adds to a number with a low part, which accumulates the rounding error (Kahan).
inline void add(double& x, double& low, double dx) {
  double const y = dx + low, sum = x + y;
  low = y - (sum - x);
  x = sum;
}

}  // namespace

void GaussRadau::parts(std::vector<Part> parts) {
  bool const same = std::equal(parts.begin(), parts.end(), parts_.begin(), parts_.end(),
                               [](Part const& a, Part const& b) { return a.equations == b.equations; });
  parts_ = std::move(parts);
  if (same) return;
  begin_.clear();
  size_ = last_size_ = 0;
}

/// Calls function(part, begin, end) for ranges of the columns of each part.
template <class Function>
void GaussRadau::each_part(int threads, Function const& function) {
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    std::size_t const first = begin_[k], count = begin_[k + 1] - first;
    for_ranges(count, grain, threads_for(count, 1, threads),
               [&](std::size_t begin, std::size_t end) { function(k, first + begin, first + end); });
  }
}

/// Reads rows and rates. Low parts are kept only for numbers that have not changed since.
void GaussRadau::take_rows() {
  std::vector<std::size_t>& begin = begin_;
  std::size_t total = 0;
  bool same = begin.size() == parts_.size() + 1;
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    same = same && begin[k] == total;
    total += parts_[k].equations->numbers() * parts_[k].equations->ensemble().size();
  }
  if (!same || begin.back() != total) {
    begin.assign(1, 0);
    for (auto const& part : parts_)
      begin.push_back(begin.back() + part.equations->numbers() * part.equations->ensemble().size());
    for (Column* column : {&origin_, &x_, &v_, &x_low_, &v_low_, &start_rates_, &rates_, &x_node_, &v_node_})
      column->assign(total, 0);
    for (auto* all : {&b_, &g_, &predicted_})
      for (auto& column : *all) column.assign(total, 0);
    last_size_ = 0;
    kept_ = false;
  }
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    auto& equations = *parts_[k].equations;
    equations.read(x_node_.data() + begin[k], v_node_.data() + begin[k]);
    equations.rates(start_rates_.data() + begin[k]);
  }
  std::fill(origin_.begin(), origin_.end(), 0.0);
  for (std::size_t i = 0; i < total; ++i) {
    if (!kept_ || x_node_[i] != x_[i]) x_[i] = x_node_[i], x_low_[i] = 0;
    if (!kept_ || v_node_[i] != v_[i]) v_[i] = v_node_[i], v_low_[i] = 0;
  }
}

/// Writes the rows at the end of a step.
void GaussRadau::put_rows() {
  for (std::size_t k = 0; k < parts_.size(); ++k)
    parts_[k].equations->write(x_.data() + begin_[k], v_.data() + begin_[k]);
}

/// Sets the origin to the particle with the largest rate, and calculates the rates at the start from there.
void GaussRadau::choose_origin(std::function<void(double time)> const& influences) {
  std::size_t most = 0;
  for (std::size_t i = 0; i < x_.size(); ++i)
    if (std::abs(start_rates_[i]) > std::abs(start_rates_[most])) most = i;
  auto const dimension = static_cast<std::size_t>(parts_.front().equations->ensemble().dimension());
  most -= most % dimension;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    origin_[i] = x_[most + i % dimension];
    x_node_[i] = (x_[i] - origin_[i]) + x_low_[i];
  }
  for (std::size_t k = 0; k < parts_.size(); ++k)
    parts_[k].equations->write(x_node_.data() + begin_[k], v_.data() + begin_[k]);
  influences(0);
  ++counts_.evaluations;
  for (std::size_t k = 0; k < parts_.size(); ++k) parts_[k].equations->rates(rates_.data() + begin_[k]);
  // A user's law may depend on absolute positions; then the origin is not shifted.
  Extent rate, change;
  for (std::size_t i = 0; i < x_.size(); ++i) rate.take(rates_[i]), change.take(rates_[i] - start_rates_[i]);
  if (change.finite() && change.largest <= 1e-3 * rate.largest)
    std::swap(rates_, start_rates_);
  else
    std::fill(origin_.begin(), origin_.end(), 0.0);
}

/// Divides the rest evenly if one step would leave a tiny one.
double GaussRadau::proposal(double remaining) const {
  double const rest = std::abs(remaining);
  if (size_ == 0 || size_ >= rest) return remaining;
  return std::copysign(size_ > 0.5 * rest ? 0.5 * rest : size_, remaining);
}

/// Extrapolates the polynomial of the last step into the next, corrected by the error of the last prediction.
void GaussRadau::predict_polynomial(double h) {
  double const ratio = last_size_ == 0 ? 0 : h / last_size_;
  std::size_t const total = x_.size();
  bool const forget = last_size_ == 0 || std::abs(ratio) > 20;
  std::array<double, order> powers{};
  for (double power = ratio; double& p : powers) p = power, power *= ratio;
  for (std::size_t i = 0; i < total; ++i) {
    for (std::size_t m = 0; m < order; ++m) {
      double sum = 0;
      for (std::size_t k = m; k < order; ++k) sum += coefficients.shifted[k][m] * b_[k][i];
      double const predicted = forget ? 0 : powers[m] * sum;
      double const missed = b_[m][i] - predicted_[m][i];
      predicted_[m][i] = predicted;
      b_[m][i] = forget ? 0 : predicted + missed;
    }
  }
}

/// Rescales the polynomial to a step that is shorter by this factor.
void GaussRadau::shorten_polynomial(double factor) {
  double power = factor;
  for (std::size_t m = 0; m < order; ++m, power *= factor)
    for (std::size_t i = 0; i < x_.size(); ++i) predicted_[m][i] = b_[m][i] = power * b_[m][i];
}

/// Writes positions and velocities at a node to the rows; false if one is not finite.
bool GaussRadau::predict(std::size_t node, double h, int threads) {
  double const s = nodes[node] * h;
  auto const& once = coefficients.once[node];
  auto const& twice = coefficients.twice[node];
  each_part(threads, [&](std::size_t part, std::size_t begin, std::size_t end) {
    if (parts_[part].equations->second_order())
      for (std::size_t i = begin; i < end; ++i) {
        double v = 0, x = 0;
        for (std::size_t k = order; k-- > 0;) v += once[k] * b_[k][i], x += twice[k] * b_[k][i];
        v_node_[i] = v_[i] + (v_low_[i] + s * (start_rates_[i] + v));
        x_node_[i] = (x_[i] - origin_[i]) + (x_low_[i] + s * (v_[i] + s * (0.5 * start_rates_[i] + x)));
      }
    else
      for (std::size_t i = begin; i < end; ++i) {
        double x = 0;
        for (std::size_t k = order; k-- > 0;) x += once[k] * b_[k][i];
        x_node_[i] = x_[i] + (x_low_[i] + s * (start_rates_[i] + x));
      }
  });
  Extent all;
  for (double const x : x_node_) all.take(x);
  if (!all.finite()) return false;
  for (std::size_t k = 0; k < parts_.size(); ++k)
    parts_[k].equations->write(x_node_.data() + begin_[k], v_node_.data() + begin_[k]);
  return true;
}

/// Makes the polynomial pass through the rates at this node, too. Returns the largest change of its last coefficient
/// relative to the largest rate, for the worst ensemble; NaN if rates are not finite.
double GaussRadau::correct(std::size_t node, int threads) {
  for (std::size_t k = 0; k < parts_.size(); ++k) parts_[k].equations->rates(rates_.data() + begin_[k]);
  auto const& inverse = coefficients.inverse[node];
  auto const& newton = coefficients.newton[node - 1];
  each_part(threads, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double value = (rates_[i] - start_rates_[i]) * inverse[0];
      for (std::size_t k = 1; k < node; ++k) value = (value - g_[k - 1][i]) * inverse[k];
      double const change = value - g_[node - 1][i];
      g_[node - 1][i] = value;
      for (std::size_t m = 0; m < node; ++m) b_[m][i] += change * newton[m];
      if (node == order) x_node_[i] = change;
    }
  });
  double worst = 0;
  for (std::size_t k = 0; node == order && k < parts_.size(); ++k) {
    Extent change, rate;
    for (std::size_t i = begin_[k]; i < begin_[k + 1]; ++i)
      change.take(x_node_[i]), rate.take(start_rates_[i]), rate.take(rates_[i]);
    if (!change.finite() || !rate.finite()) return std::numeric_limits<double>::quiet_NaN();
    if (rate.largest > 0) worst = std::max(worst, change.largest / rate.largest);
  }
  return worst;
}

/// Finds the polynomial of a step of length h; false if the step is too long for convergence.
bool GaussRadau::attempt(double h, int threads, std::function<void(double time)> const& influences) {
  // g from b: b_m = sum over k of newton[k][m] g_k.
  for (std::size_t i = 0; i < x_.size(); ++i)
    for (std::size_t m = order; m-- > 0;) {
      double sum = b_[m][i];
      for (std::size_t k = m + 1; k < order; ++k) sum -= coefficients.newton[k][m] * g_[k][i];
      g_[m][i] = sum;
    }
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    double change = 0;
    for (std::size_t node = 1; node <= order; ++node) {
      if (!predict(node, h, threads)) return false;
      influences(nodes[node] * h);
      ++counts_.evaluations;
      change = correct(node, threads);
    }
    if (!std::isfinite(change)) return false;
    noise_ = change;
    if (change < 1e-16 || (iteration > 1 && change >= last)) break;
    last = change;
  }
  return noise_ < max_noise;
}

/// The factor by which the next step may be longer than this one, at most 1 / shortest. 0 if positions have too few
/// digits for the differences on which influences depend.
double GaussRadau::growth(double h) const {
  double error = 0, noise = std::max(noise_, noise_of_last_term), moved = 0;
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    auto const& part = parts_[k];
    bool const second = part.equations->second_order();
    Extent last, rate, change, motion;  // the rate may be zero beyond a cut-off
    for (std::size_t i = begin_[k]; i < begin_[k + 1]; ++i) {
      last.take(b_[order - 1][i]), rate.take(start_rates_[i]), rate.take(rates_[i]);
      change.take(b_[0][i] * (x_[i] - origin_[i]));
      motion.take(h * (second ? v_[i] + 0.5 * h * start_rates_[i] : start_rates_[i]));
    }
    if (rate.largest > 0) error = std::max(error, last.largest / rate.largest);
    // Rounding of positions changes rates, in proportion to their change along the step, and rates change the last
    // term.
    if (rate.largest > 0 && motion.largest > 0)
      noise = std::max(noise, noise_of_last_term * change.largest / (motion.largest * rate.largest));
    if (!std::isfinite(part.max_move)) continue;
    std::size_t const numbers = part.equations->numbers();
    auto const dimension = static_cast<std::size_t>(part.equations->ensemble().dimension());
    for (std::size_t first = begin_[k]; first < begin_[k + 1]; first += numbers) {
      double square = 0;  // the position comes first in every class
      for (std::size_t i = first; i < first + dimension; ++i) {
        double const d = h * (second ? v_[i] + 0.5 * h * start_rates_[i] : start_rates_[i]);
        square += d * d;
      }
      moved = std::max(moved, std::sqrt(square) / part.max_move);
    }
  }
  if (noise > max_noise) return 0;
  double const allowed = std::max(tolerance_, noise);
  double const by_error = error > 0 ? std::pow(allowed / error, 1.0 / order) : 1 / shortest;
  double const by_moves = moved > 0 ? (moved > 1 ? 0.2 : 0.9) / moved : 1 / shortest;
  return std::min({by_error, by_moves, 1 / shortest});
}

void GaussRadau::accept(double h, int threads) {
  auto const& once = coefficients.once.back();
  auto const& twice = coefficients.twice.back();
  each_part(threads, [&](std::size_t part, std::size_t begin, std::size_t end) {
    bool const second = parts_[part].equations->second_order();
    for (std::size_t i = begin; i < end; ++i) {
      double v = 0, x = 0;
      for (std::size_t k = order; k-- > 0;) v += once[k] * b_[k][i], x += twice[k] * b_[k][i];
      double const impulse = h * (start_rates_[i] + v);
      if (second) {
        add(x_[i], x_low_[i], h * h * (0.5 * start_rates_[i] + x) + h * v_low_[i]);
        add(x_[i], x_low_[i], h * v_[i]);
        add(v_[i], v_low_[i], impulse);
      } else {
        add(x_[i], x_low_[i], impulse);
      }
    }
  });
  put_rows();
  kept_ = true;
}

double GaussRadau::step(double remaining, int threads, std::function<void(double time)> const& influences) {
  take_rows();
  try {
    return step_from_here(remaining, threads, influences);
  } catch (...) {
    put_rows();
    throw;
  }
}

double GaussRadau::step_from_here(double remaining, int threads, std::function<void(double time)> const& influences) {
  if (shift_origin_) choose_origin(influences);
  double h = proposal(remaining);
  predict_polynomial(h);
  for (int attempts = 0; attempts < max_attempts; ++attempts) {
    bool const found = attempt(h, threads, influences);
    double const factor = found ? growth(h) : 0.1;
    if (found && factor >= shortest) {
      accept(h, threads);
      ++counts_.steps;
      // A step that was shortened to end at a given time gives no estimate for longer ones.
      double const next = std::abs(h) * factor;
      if (std::abs(h) >= 0.5 * size_)
        size_ = next;
      else if (factor < 1 / shortest)
        size_ = std::min(next, size_);
      last_size_ = h;
      return h;
    }
    ++counts_.rejected;
    double const shorter = std::max(factor, 0.01);
    h *= shorter;
    size_ = std::abs(h);
    shorten_polynomial(found ? shorter : 0);
  }
  fail(h);
}

/// Names the particle with the largest rate.
void GaussRadau::fail(double h) const {
  std::size_t worst = 0, part = 0;
  for (std::size_t k = 0; k < parts_.size(); ++k)
    for (std::size_t i = begin_[k]; i < begin_[k + 1]; ++i)
      if (!(std::abs(start_rates_[i]) <= std::abs(start_rates_[worst]))) worst = i, part = k;
  throw PhysicsFailure(fmt::format(
      "gauss-radau finds no step, not even {:.3g}, in which the motion of particle {} of '{}' is smooth: particles "
      "meet, or a law jumps (at its cut-off, at a wall)",
      std::abs(h), (worst - begin_[part]) / parts_[part].equations->numbers(),
      parts_[part].equations->ensemble().name()));
}

std::vector<double> GaussRadau::state() const {
  std::vector<double> state{size_, last_size_, kept_ ? static_cast<double>(x_.size()) : 0};
  if (!kept_) return state;
  auto const add = [&](Column const& column) { state.insert(state.end(), column.begin(), column.end()); };
  for (auto const* column : {&x_low_, &v_low_}) add(*column);
  for (auto const* all : {&b_, &predicted_})
    for (auto const& column : *all) add(column);
  return state;
}

void GaussRadau::restore(std::span<double const> state) {
  auto const misfit = [] { return Error("the checkpoint does not fit this simulation: its state has another length"); };
  if (state.size() < 3) throw misfit();
  auto const count = static_cast<std::size_t>(state[2]);
  if (state.size() != 3 + (2 + 2 * order) * count) throw misfit();
  begin_.clear();
  kept_ = false;
  take_rows();
  if (count > 0 && count != x_.size()) throw misfit();
  size_ = state[0];
  last_size_ = state[1];
  kept_ = count > 0;
  std::size_t at = 3;
  auto const take = [&](Column& column) {
    std::copy_n(state.begin() + static_cast<std::ptrdiff_t>(at), count, column.begin());
    at += count;
  };
  if (count == 0) return;
  for (auto* column : {&x_low_, &v_low_}) take(*column);
  for (auto* all : {&b_, &predicted_})
    for (auto& column : *all) take(column);
}

}  // namespace boltzmann
