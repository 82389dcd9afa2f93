// Functions of formulas over the whole range of doubles, against the C library's 80-bit functions: as programs run them,
// interpreted and by machine code, and as single values. Kind: a function that is right near 1 and wrong far from it.
// Siblings: every function that a formula may name, at zeros, infinities, NaN, subnormal numbers, and where results
// overflow.
#include <boltzmann/formulas/evaluate.hpp>
#include <boltzmann/formulas/formula_functions.hpp>
#include <boltzmann/formulas/formula_reader.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tests/seed.hpp>
#include <tests/ulp.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace boltzmann::formula_accuracy_test {
namespace {

using namespace test;

/// A formula of x and y as a program, and as it is calculated for single values.
class Way {
 public:
  explicit Way(std::string const& text) {
    NamesInFormula names;
    names.checked = false;
    names.values["x"] = {{graph_.input(0)}, {}, false, false};
    names.values["y"] = {{graph_.input(1)}, {}, false, false};
    result_ = read_formula_text(text, names, 3, graph_).components[0];
    std::vector<std::uint32_t> const columns{0, 1};
    program_ = make_program(graph_, std::vector{result_}, columns, {});
    calculation_ = std::make_unique<Calculation>(graph_, std::vector{result_});
  }
  double single(double x, double y) {
    calculation_->run(std::vector{x, y});
    return (*calculation_)[0];
  }
  /// Of numbers in lanes and columns, whichever.
  template <int W>
  std::vector<double> by_program(std::vector<double> const& x, std::vector<double> const& y, bool by_code) {
    program_.code = by_code ? machine_code(program_, W) : nullptr;
    auto const work = std::make_unique<detail::Workspace<W>>();
    work->set_constants(program_);
    std::vector<double> results;
    for (std::size_t from = 0; from < x.size(); from += block_pairs) {
      for (std::size_t k = 0; k < block_pairs; ++k) {
        std::size_t const at = std::min(from + k, x.size() - 1);
        work->column(0)[k] = x[at], work->column(1)[k] = y[at];
      }
      detail::run_program<W>(*work, program_, block_pairs / W);
      auto const place = program_.results[0];
      for (std::size_t k = 0; k < block_pairs && from + k < x.size(); ++k)
        results.push_back(work->place(place)[place.scalar ? 0 : k]);
    }
    return results;
  }

 private:
  ExpressionGraph graph_;
  Expression result_ = 0;
  FormulaProgram program_;
  std::unique_ptr<Calculation> calculation_;
};

struct Range {
  double low, high;
};
using Exact = long double (*)(long double, long double);

struct Function {
  std::string text;
  Exact exact;
  std::vector<Range> of_x = {}, of_y = {{-10, 10}};
};

/// In ulp, as the guide states it; a division is rounded once.
double bound_of(Function const& function) {
  auto const* named = formula_function(function.text.substr(0, function.text.find('(')));
  return named ? named->error : 0.5;
}

long double exact_mod(long double a, long double b) {
  long double const rest = std::fmod(a, b);
  if (rest == 0) return 0;
  return (rest < 0) != (b < 0) ? rest + b : rest;
}

std::vector<Function> functions() {
  using L = long double;
  return {
      {"exp(x)", [](L x, L) { return std::exp(x); }, {{-2, 2}, {-746, 710}, {690, 709.7}}},
      {"log(x)", [](L x, L) { return std::log(x); }, {{0.5, 2}, {0.99, 1.01}}},
      {"sin(x)", [](L x, L) { return std::sin(x); }, {{-4, 4}, {-1e6, 1e6}, {-3e6, 3e6}}},
      {"cos(x)", [](L x, L) { return std::cos(x); }, {{-4, 4}, {-1e6, 1e6}, {-3e6, 3e6}}},
      {"tan(x)", [](L x, L) { return std::tan(x); }, {{-4, 4}, {-1e6, 1e6}, {-3e6, 3e6}}},
      {"asin(x)", [](L x, L) { return std::asin(x); }, {{-1, 1}}},
      {"acos(x)", [](L x, L) { return std::acos(x); }, {{-1, 1}}},
      {"atan(x)", [](L x, L) { return std::atan(x); }, {{-10, 10}}},
      {"sinh(x)", [](L x, L) { return std::sinh(x); }, {{-2, 2}, {-711, 711}, {709, 711}}},
      {"cosh(x)", [](L x, L) { return std::cosh(x); }, {{-2, 2}, {-711, 711}, {709, 711}}},
      {"tanh(x)", [](L x, L) { return std::tanh(x); }, {{-1, 1}, {-25, 25}}},
      {"erf(x)", [](L x, L) { return std::erf(x); }, {{-1, 1}, {-7, 7}}},
      {"erfc(x)", [](L x, L) { return std::erfc(x); }, {{-1, 1}, {-7, 27}}},
      {"sqrt(x)", [](L x, L) { return std::sqrt(x); }, {{0, 10}}},
      {"abs(x)", [](L x, L) { return std::fabs(x); }, {{-10, 10}}},
      {"floor(x)", [](L x, L) { return std::floor(x); }, {{-10, 10}}},
      {"ceil(x)", [](L x, L) { return std::ceil(x); }, {{-10, 10}}},
      {"1/x", [](L x, L) { return 1 / x; }, {{-10, 10}}},
      {"atan2(x, y)", [](L x, L y) { return std::atan2(x, y); }, {{-10, 10}}},
      {"pow(x, y)", [](L x, L y) { return std::pow(x, y); }, {{0, 2}, {0, 1e4}}, {{-700, 700}, {-10, 10}}},
      {"mod(x, y)", exact_mod, {{-10, 10}, {-1e17, 1e17}}, {{-10, 10}, {-1e-290, 1e-290}}},
  };
}

/// Ranges, all bit patterns, and what is special.
void arguments(Function const& function, std::vector<double>& x, std::vector<double>& y) {
  std::mt19937_64 random(test_seed(41));
  auto const within = [&](Range range) {
    return std::uniform_real_distribution<double>(range.low, range.high)(random);
  };
  auto const any = [&] { return std::bit_cast<double>(random()); };
  auto const add = [&](double a, double b) { x.push_back(a), y.push_back(b); };
  constexpr int each = 3000;
  for (auto const& of_x : function.of_x)
    for (auto const& of_y : function.of_y)
      for (int k = 0; k < each; ++k) add(within(of_x), within(of_y));
  for (int k = 0; k < each; ++k) add(any(), any());
  for (int k = 0; k < each; ++k) {
    double const size = std::exp2(within({-70, 12}));
    add((random() & 1) != 0 ? size : -size, std::exp2(within({-60, 60})));
  }
  double const special[] = {0,      infinity, nan_value, tiniest, 1e-310, 0x1p-1022, 1,          largest, 1e300, 0.1,
                            1e-300, 800,      709.9,     710.4,   711,    745.1,     746,        1e16,    1e18,  7,
                            3,      0.5,      1.5,       0x1p52,  0x1p53, 3e6,       0x1p20 + 1, 1e22,    2,     27.3};
  for (double const a : special)
    for (double const b : special)
      for (double const s : {1.0, -1.0})
        for (double const t : {1.0, -1.0}) add(s * a, t * b);
}

template <int W>
void expect_accurate(Function const& function, std::vector<double> const& x, std::vector<double> const& y) {
  Way way(function.text);
  auto const interpreted = way.by_program<W>(x, y, false), compiled = way.by_program<W>(x, y, true);
  constexpr bool comparable = detail::rounds_as_machine_code<W> && (W != 8 || native_width<double> == 8);
  double worst = 0;
  std::size_t where = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    double const error = error_in_ulp(interpreted[k], function.exact(x[k], y[k]));
    if (error > worst) worst = error, where = k;
    bool const same = std::bit_cast<std::uint64_t>(interpreted[k]) == std::bit_cast<std::uint64_t>(compiled[k]) ||
                      (std::isnan(interpreted[k]) && std::isnan(compiled[k]));
    if (comparable && !same) FAIL() << function.text << " at " << x[k] << ", " << y[k];
  }
  EXPECT_LE(worst, bound_of(function) + 1e-3)
      << fmt::format("{} at x = {}, y = {}, {} at a time", function.text, x[where], y[where], W);
}

TEST(FormulaAccuracy, IsThatOfTheGuideOverAllDoubles) {
  for (auto const& function : functions()) {
    std::vector<double> x, y;
    arguments(function, x, y);
    expect_accurate<2>(function, x, y);
    expect_accurate<4>(function, x, y);
    expect_accurate<8>(function, x, y);
    Way way(function.text);
    double worst = 0;
    for (std::size_t k = 0; k < x.size(); k += 7)
      worst = std::max(worst, error_in_ulp(way.single(x[k], y[k]), function.exact(x[k], y[k])));
    EXPECT_LE(worst, std::max(2.3, bound_of(function))) << function.text << ", single values";
  }
}

/// Of a text without names, folded to a number, and of the same with a name.
void expect_value(std::string const& text, std::string const& with_x, double x, double expected) {
  auto const same = [&](double got) {
    return std::bit_cast<std::uint64_t>(got) == std::bit_cast<std::uint64_t>(expected) ||
           (std::isnan(got) && std::isnan(expected));
  };
  EXPECT_TRUE(same(Way(text).single(0, 0))) << text << " is " << Way(text).single(0, 0);
  Way way(with_x);
  EXPECT_TRUE(same(way.single(x, 0))) << with_x << " is " << way.single(x, 0);
  std::vector<double> const all(8, x);
  for (bool const by_code : {false, true})
    for (double const got : {way.by_program<2>(all, all, by_code)[1], way.by_program<4>(all, all, by_code)[3],
                             way.by_program<8>(all, all, by_code)[5]})
      EXPECT_TRUE(same(got)) << with_x << " is " << got;
}

TEST(FormulaAccuracy, ModIsBelowItsDivisorAndHasItsSign) {
  expect_value("mod(7, 3)", "mod(x, 3)", 7, 1);
  expect_value("mod(-7, 3)", "mod(x, 3)", -7, 2);
  expect_value("mod(7, -3)", "mod(x, -3)", 7, -2);
  expect_value("mod(-7, -3)", "mod(x, -3)", -7, -1);
  expect_value("mod(6, 3)", "mod(x, 3)", 6, 0);
  expect_value("mod(-6, 3)", "mod(x, 3)", -6, 0);
  expect_value("mod(1e16, -3)", "mod(x, -3)", 1e16, -2);  // 10^16 = 1 modulo 3
  expect_value("mod(1e18, 7)", "mod(x, 7)", 1e18, 1);     // 10^6 = 1 modulo 7
  expect_value("mod(0.1, 1e-300)", "mod(x, 1e-300)", 0.1, std::fmod(0.1, 1e-300));
  expect_value("mod(-1e-300, 1)", "mod(x, 1)", -1e-300, std::nextafter(1.0, 0.0));
  expect_value("mod(1, 0)", "mod(x, 0)", 1, nan_value);
}

TEST(FormulaAccuracy, HyperbolicSinesAreFiniteAsLongAsTheirValuesAre) {
  expect_value("sinh(800)", "sinh(x)", 800, infinity);
  expect_value("sinh(-800)", "sinh(x)", -800, -infinity);
  expect_value("cosh(-800)", "cosh(x)", -800, infinity);
  EXPECT_LT(
      error_in_ulp(Way("sinh(x)").by_program<4>({710.4}, {0}, false)[0], std::sinh(static_cast<long double>(710.4))),
      2);
  EXPECT_EQ(Way("sinh(x)").by_program<4>({-0.0}, {0}, true)[0], 0);
}

}  // namespace
}  // namespace boltzmann::formula_accuracy_test
