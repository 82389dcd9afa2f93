// Formulas made by chance: as texts, and as the numbers that plain C++ makes of them, with derivatives by dual numbers.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

/// A number with its derivative by one input, and bounds for what rounding may have done to both, in first order and in
/// whatever order sums are taken. `clear`: no kink or jump was so near that rounding might have chosen the other side.
struct RoundedDual {
  static constexpr double unit = 4 * std::numeric_limits<double>::epsilon();

  double value = 0, slope = 0, value_error = 0, slope_error = 0;
  bool clear = true;

  /// f of this number, whose value and first two derivatives there are these; the first one is a difference of numbers
  /// up to `parts`.
  RoundedDual with(double f, double first, double second, double parts = 0) const {
    return {f, first * slope, std::abs(first) * value_error + unit * std::abs(f),
            std::abs(first) * slope_error + std::abs(second * slope) * value_error +
                unit * (std::abs(first) + parts) * std::abs(slope),
            clear};
  }
  bool above(RoundedDual const& other) const { return value > other.value; }
  /// One of two numbers, as `a` is below `b`, or not.
  static RoundedDual choose(RoundedDual const& a, RoundedDual const& b, RoundedDual chosen) {
    double const room = a.value_error + b.value_error;
    chosen.clear = a.clear && b.clear && chosen.clear && std::abs(a.value - b.value) > 100 * room;
    return chosen;
  }
};

inline RoundedDual operator+(RoundedDual const& a, RoundedDual const& b) {
  double const unit = RoundedDual::unit;
  return {a.value + b.value, a.slope + b.slope,
          a.value_error + b.value_error + unit * (std::abs(a.value) + std::abs(b.value)),
          a.slope_error + b.slope_error + unit * (std::abs(a.slope) + std::abs(b.slope)), a.clear && b.clear};
}
inline RoundedDual operator-(RoundedDual const& a) {
  return {-a.value, -a.slope, a.value_error, a.slope_error, a.clear};
}
inline RoundedDual operator-(RoundedDual const& a, RoundedDual const& b) { return a + -b; }
inline RoundedDual operator*(RoundedDual const& a, RoundedDual const& b) {
  double const unit = RoundedDual::unit, left = a.slope * b.value, right = a.value * b.slope;
  return {a.value * b.value, left + right,
          std::abs(a.value) * b.value_error + std::abs(b.value) * a.value_error + unit * std::abs(a.value * b.value),
          std::abs(a.slope) * b.value_error + std::abs(b.value) * a.slope_error + std::abs(a.value) * b.slope_error +
              std::abs(b.slope) * a.value_error + unit * (std::abs(left) + std::abs(right)),
          a.clear && b.clear};
}
inline RoundedDual operator+(double a, RoundedDual const& b) { return RoundedDual{a} + b; }
inline RoundedDual operator*(double a, RoundedDual const& b) { return RoundedDual{a} * b; }

/// a^exponent of what is above zero, or for a whole exponent of anything.
inline RoundedDual power(RoundedDual const& a, double exponent) {
  return a.with(std::pow(a.value, exponent), exponent * std::pow(a.value, exponent - 1),
                exponent * (exponent - 1) * std::pow(a.value, exponent - 2));
}

/// A step of a formula: its text, with % for its arguments, and the same in C++.
struct FormulaStep {
  char const* text;
  int arguments;
  RoundedDual (*of)(RoundedDual const* arguments);
};

/// Each keeps what it is taken of where it is defined.
inline std::span<FormulaStep const> formula_steps() {
  using Dual = RoundedDual;
  static constexpr FormulaStep steps[] = {
      {"(% + %)", 2, [](Dual const* a) { return a[0] + a[1]; }},
      {"(% - %)", 2, [](Dual const* a) { return a[0] - a[1]; }},
      {"%*%", 2, [](Dual const* a) { return a[0] * a[1]; }},
      {"%/(1.5 + (%)^2)", 2, [](Dual const* a) { return a[0] * power(1.5 + a[1] * a[1], -1); }},
      {"(%)^2", 1, [](Dual const* a) { return power(a[0], 2); }},
      {"(%)^3", 1, [](Dual const* a) { return power(a[0], 3); }},
      {"(%)^4", 1, [](Dual const* a) { return power(a[0], 4); }},
      {"-(%)", 1, [](Dual const* a) { return -a[0]; }},
      {"sqrt(1 + (%)^2)", 1, [](Dual const* a) { return power(1 + a[0] * a[0], 0.5); }},
      {"(0.5 + (%)^2)^-1.5", 1, [](Dual const* a) { return power(0.5 + a[0] * a[0], -1.5); }},
      {"exp(-(%)^2)", 1,
       [](Dual const* a) {
         Dual const x = -(a[0] * a[0]);
         return x.with(std::exp(x.value), std::exp(x.value), std::exp(x.value));
       }},
      {"log(2 + (%)^2)", 1,
       [](Dual const* a) {
         Dual const x = 2 + a[0] * a[0];
         return x.with(std::log(x.value), 1 / x.value, -1 / (x.value * x.value));
       }},
      {"sin(%)", 1, [](Dual const* a) { return a->with(std::sin(a->value), std::cos(a->value), -std::sin(a->value)); }},
      {"cos(%)", 1,
       [](Dual const* a) { return a->with(std::cos(a->value), -std::sin(a->value), -std::cos(a->value)); }},
      {"tanh(%)", 1,
       [](Dual const* a) {
         double const t = std::tanh(a->value), first = 1 / (std::cosh(a->value) * std::cosh(a->value));
         return a->with(t, first, -2 * t * first, 1);
       }},
      {"max(%, %)", 2, [](Dual const* a) { return Dual::choose(a[0], a[1], a[0].above(a[1]) ? a[0] : a[1]); }},
      // What is rarer.
      {"min(%, %)", 2, [](Dual const* a) { return Dual::choose(a[0], a[1], a[0].above(a[1]) ? a[1] : a[0]); }},
      {"abs(%)", 1, [](Dual const* a) { return Dual::choose(a[0], Dual{}, a->above({}) ? a[0] : -a[0]); }},
      {"(% < % ? % : %)", 4,
       [](Dual const* a) {
         Dual chosen = a[1].above(a[0]) ? a[2] : a[3];
         chosen.clear = a[2].clear && a[3].clear;
         return Dual::choose(a[0], a[1], chosen);
       }},
      {"step(%)*%", 2,
       [](Dual const* a) {
         return Dual::choose(a[0], Dual{}, a->above({}) ? a[1] : RoundedDual{0, 0, 0, 0, a[1].clear});
       }},
      {"tan(sin(%))", 1,
       [](Dual const* a) {
         Dual const s = a->with(std::sin(a->value), std::cos(a->value), -std::sin(a->value));
         double const t = std::tan(s.value), first = 1 + t * t;
         return s.with(t, first, 2 * t * first);
       }},
      {"asin(tanh(%)/2)", 1,
       [](Dual const* a) {
         double const t = std::tanh(a->value), slope = 1 - t * t;
         Dual const x = a->with(0.5 * t, 0.5 * slope, -t * slope, 1);
         double const rest = 1 - x.value * x.value;
         return x.with(std::asin(x.value), 1 / std::sqrt(rest), x.value / (rest * std::sqrt(rest)), 2);
       }},
      {"acos(0.9*cos(%))", 1,
       [](Dual const* a) {
         Dual const x = a->with(0.9 * std::cos(a->value), -0.9 * std::sin(a->value), -0.9 * std::cos(a->value));
         double const rest = 1 - x.value * x.value;
         return x.with(std::acos(x.value), -1 / std::sqrt(rest), -x.value / (rest * std::sqrt(rest)),
                       10);  // rest > 0.19
       }},
      {"atan(%)", 1,
       [](Dual const* a) {
         double const first = 1 / (1 + a->value * a->value);
         return a->with(std::atan(a->value), first, -2 * a->value * first * first);
       }},
      {"atan2(%, 0.5 + (%)^2)", 2,
       [](Dual const* a) {
         Dual const x = a[0] * power(0.5 + a[1] * a[1], -1);
         double const first = 1 / (1 + x.value * x.value);
         return x.with(std::atan(x.value), first, -2 * x.value * first * first);
       }},
      {"sinh(%)", 1,
       [](Dual const* a) { return a->with(std::sinh(a->value), std::cosh(a->value), std::sinh(a->value)); }},
      {"cosh(%)", 1,
       [](Dual const* a) { return a->with(std::cosh(a->value), std::sinh(a->value), std::cosh(a->value)); }},
      {"erf(%)", 1,
       [](Dual const* a) {
         double const first = 2 * std::numbers::inv_sqrtpi * std::exp(-a->value * a->value);
         return a->with(std::erf(a->value), first, -2 * a->value * first);
       }},
      {"erfc(%)", 1,
       [](Dual const* a) {
         double const first = -2 * std::numbers::inv_sqrtpi * std::exp(-a->value * a->value);
         return a->with(std::erfc(a->value), first, -2 * a->value * first);
       }},
      {"(1 + (%)^2)^sin(%)", 2,
       [](Dual const* a) {
         Dual const base = 1 + a[0] * a[0],
                    x = base.with(std::log(base.value), 1 / base.value, -1 / (base.value * base.value)),
                    exponent = a[1].with(std::sin(a[1].value), std::cos(a[1].value), -std::sin(a[1].value));
         Dual const whole = exponent * x;
         return whole.with(std::exp(whole.value), std::exp(whole.value), std::exp(whole.value));
       }},
  };
  return steps;
}

/// A random formula of these names, a letter each.
class RandomFormula {
 public:
  RandomFormula(std::mt19937& random, int depth, std::string const& names) {
    constexpr int usual = 16;
    auto const pick = [&](int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); };
    if (depth == 0) {
      if (pick(4) == 0) {
        number_ = 1 + pick(5);
        text_ = std::to_string(static_cast<int>(number_));
      } else {
        input_ = pick(static_cast<int>(names.size()));
        text_ = names[static_cast<std::size_t>(input_)];
      }
      return;
    }
    auto const all = formula_steps();
    step_ = &all[static_cast<std::size_t>(pick(3) > 0 ? pick(usual) : pick(static_cast<int>(all.size())))];
    for (int k = 0; k < step_->arguments; ++k)
      arguments_.emplace_back(random, depth - 1 - pick(2) * (depth > 1), names);
    auto argument = arguments_.begin();
    for (char const* c = step_->text; *c != 0; ++c) text_ += *c == '%' ? (argument++)->text_ : std::string(1, *c);
  }

  std::string const& text() const { return text_; }
  /// Its value, and its derivative by the input `by`.
  RoundedDual at(std::span<double const> inputs, std::size_t by = 0) const {
    if (!step_ && input_ < 0) return {number_};
    if (!step_) return {inputs[static_cast<std::size_t>(input_)], static_cast<std::size_t>(input_) == by ? 1. : 0.};
    RoundedDual arguments[4];
    for (std::size_t k = 0; k < arguments_.size(); ++k) arguments[k] = arguments_[k].at(inputs, by);
    return step_->of(arguments);
  }

 private:
  FormulaStep const* step_ = nullptr;  // null: a number, or an input
  double number_ = 0;
  int input_ = -1;
  std::vector<RandomFormula> arguments_;
  std::string text_;
};

}  // namespace boltzmann
