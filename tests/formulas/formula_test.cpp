// Formulas: their values are those of the same expression in C++; what is wrong is told with its column.
#include <boltzmann/formulas/formula.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace boltzmann::formula_test {
namespace {

constexpr double pi = std::numbers::pi;

FormulaInputs const& names() {
  static FormulaInputs const inputs = [] {
    FormulaInputs all;
    for (char const* name : {"x", "y", "velocity.x", "density"}) all.add(name, {});
    return all;
  }();
  return inputs;
}

double value(std::string const& text, double x = 0, double y = 0, double v = 0, double density = 0) {
  return names().read(text)(std::array{x, y, v, density});
}

TEST(Formula, HasTheValueOfTheSameExpressionInCpp) {
  struct Pair {
    char const* text;
    std::function<double(double, double)> expected;
  };
  std::vector<Pair> const pairs{
      {"-sin(2*pi*x)*cos(2*pi*y)", [](double x, double y) { return -std::sin(2 * pi * x) * std::cos(2 * pi * y); }},
      {"x - y - 1", [](double x, double y) { return x - y - 1; }},
      {"x / y / 2 * 3", [](double x, double y) { return x / y / 2 * 3; }},
      {"1 + 2 * abs(x) ^ 2 ^ y", [](double x, double y) { return 1 + 2 * std::pow(std::abs(x), std::pow(2, y)); }},
      {"-x^2", [](double x, double) { return -(x * x); }},
      {"2^-x + (-y)^2", [](double x, double y) { return std::pow(2, -x) + y * y; }},
      {"--x + +y", [](double x, double y) { return x + y; }},
      {" ( ( x+1.5e-3 ) * .25)\t", [](double x, double) { return (x + 1.5e-3) * 0.25; }},
      {"if(x < y, exp(x), log(y))", [](double x, double y) { return x < y ? std::exp(x) : std::log(y); }},
      {"x < 0.5 ? 1 : y > 0.5 ? 2 : 3", [](double x, double y) { return x < 0.5   ? 1
                                                                        : y > 0.5 ? 2
                                                                                  : 3; }},
      {"x < y || x > 2 && !(y == 1)", [](double x, double y) { return x < y || (x > 2 && y != 1); }},
      {"(x <= y) + 2*(x >= y) + 4*(x != y) + 8*(x == y)",
       [](double x, double y) { return (x <= y) + 2 * (x >= y) + 4 * (x != y) + 8 * (x == y); }},
      {"sqrt(abs(x)) + tan(y) + atan2(y, x) + atan(x)",
       [](double x, double y) { return std::sqrt(std::abs(x)) + std::tan(y) + std::atan2(y, x) + std::atan(x); }},
      {"min(x, y) + 3*max(x, y) + pow(2, x)",
       [](double x, double y) { return std::min(x, y) + 3 * std::max(x, y) + std::pow(2, x); }},
      {"floor(x) + ceil(y) + mod(x, 0.75)",
       [](double x, double y) { return std::floor(x) + std::ceil(y) + x - 0.75 * std::floor(x / 0.75); }},
      {"sinh(x) + cosh(x) + tanh(y) + asin(0.1*x) + acos(0.1*y)",
       [](double x, double y) {
         return std::sinh(x) + std::cosh(x) + std::tanh(y) + std::asin(0.1 * x) + std::acos(0.1 * y);
       }},
  };
  for (auto const& pair : pairs)
    for (double const x : {-1.25, 0.0, 0.3, 1.0, 2.5})
      for (double const y : {0.3, 0.75, 1.0, 2.5}) {
        double const expected = pair.expected(x, y);
        EXPECT_NEAR(value(pair.text, x, y), expected, 1e-14 * (1 + std::abs(expected)))
            << pair.text << " at " << x << ", " << y;
      }
}

TEST(Formula, ReadsFields) {
  EXPECT_EQ(value("velocity.x * density", 0, 0, 3, 5), 15);
  EXPECT_EQ(names().read("density + x + density").inputs(), (std::vector<std::uint32_t>{0, 3}));
}

// What is not chosen can't make it no number.
TEST(Formula, KeepsOnlyWhatIsChosen) {
  EXPECT_EQ(value("if(x > 0, 1/x - 1/x, 2) + 3*(x > 0 ? 0/x : 1)", 0), 5);
  EXPECT_EQ(value("x > 0 ? log(x) : 0", -1), 0);
  EXPECT_TRUE(std::isnan(value("log(x)", -1)));
  EXPECT_EQ(value("1/x", 0), std::numeric_limits<double>::infinity());
}

struct Wrong {
  char const* text;
  std::size_t offset;
  std::vector<std::string> parts;
};

TEST(Formula, SaysWhatIsWrongAndWhere) {
  std::vector<Wrong> const all{
      {"", 0, {"empty"}},
      {"   ", 0, {"empty"}},
      {"2*X", 2, {"unknown name 'X'", "there are x, y, velocity.x, density, pi", "did you mean 'x'?"}},
      {"velocity.y", 0, {"unknown name 'velocity.y'", "did you mean 'velocity.x'?"}},
      {"1 + sine(x)", 4, {"unknown function 'sine'", "atan2", "did you mean 'sin'?"}},
      {"2 x", 2, {"operator is missing before 'x'", "2*x"}},
      {"2x", 1, {"operator is missing before 'x'", "2*x"}},
      {"2 sin(x)", 2, {"operator is missing before 'sin'", "2*x"}},
      {"2 apple", 2, {"'apple': the scenario has pure numbers", "'*'"}},
      {"x (1)", 0, {"'x' is no function"}},
      {"pi(2)", 0, {"'pi' is no function"}},
      {"(x) (y)", 4, {"operator is missing"}},
      {"sin x", 0, {"'sin' needs parentheses"}},
      {"sin", 0, {"'sin' needs parentheses"}},
      {"sin(x", 3, {"not closed"}},
      {"(x + (y)", 0, {"not closed"}},
      {"x)", 1, {"without its '('"}},
      {"atan2(x)", 0, {"atan2 takes 2 values, not 1"}},
      {"sin(x, y)", 0, {"sin takes 1 value, not 2"}},
      {"if(x, y)", 0, {"if takes 3 values, not 2"}},
      {"sin()", 0, {"sin takes 1 value, not 0"}},
      {"x, y", 1, {"','"}},
      {"x +", 3, {"ends where a number"}},
      {"* x", 0, {"a number or a name is needed, not '*'"}},
      {"x ? 1", 5, {"':' is missing"}},
      {"0 < x < 1", 6, {"0 < x && x < 1"}},
      {"x = 1", 2, {"'=='"}},
      {"x ** 2", 2, {"x^2"}},
      {"1.2.3", 0, {"'1.2.3' is no number"}},
      {"1e999", 0, {"'1e999' is no number"}},
      {".", 0, {"'.' is no number"}},
      {"x & y", 2, {"'&' is not allowed here"}},
      {"x # 2", 2, {"'#'"}},
      {"\xc3\xa9 + 1", 0, {"'\xc3\xa9'"}},
      {"x \xc3\xa9", 2, {"'\xc3\xa9'"}},
  };
  for (auto const& wrong : all) {
    try {
      names().read(wrong.text);
      ADD_FAILURE() << wrong.text;
    } catch (FormulaError const& error) {
      EXPECT_EQ(error.offset, wrong.offset) << wrong.text << ": " << error.what();
      for (auto const& part : wrong.parts)
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << wrong.text << ": " << error.what();
    }
  }
}

TEST(Formula, OfAnySizeEndsWell) {
  std::string const n(5000, '(');
  EXPECT_THROW(names().read(n), FormulaError);
  EXPECT_THROW(names().read(std::string(5000, '-') + "x"), FormulaError);
  std::string sum = "x";
  for (int k = 0; k < 4000; ++k) sum += "+x";
  EXPECT_EQ(value(sum, 0.5), 2000.5);
  for (int k = 0; k < 40'000; ++k) sum += "+x";
  EXPECT_THROW(names().read(sum), FormulaError);
  std::string choice = "x";
  for (int k = 0; k < 5000; ++k) choice += "?x:x";
  EXPECT_THROW(names().read(choice), FormulaError);
}

/// Not fused with a sum.
double rounded(double x) {
  double volatile y = x;
  return y;
}

// The same bits as the same expression in C++: nothing is put in another order.
TEST(Formula, IsCalculatedAsItIsWritten) {
  for (double const x : {0.1, 0.7, 1.3, 17.9})
    for (double const y : {0.3, 3.1, 1e-9}) {
      EXPECT_EQ(value("x + y + 0.1", x, y), x + y + 0.1);
      EXPECT_EQ(value("0.1 + (y + x)", x, y), 0.1 + (y + x));
      EXPECT_EQ(value("x/y/3*x", x, y), x / y / 3 * x);
      EXPECT_EQ(value("3*x - x - x/3", x, y), rounded(3 * x) - x - x / 3);
      EXPECT_EQ(value("0.0036*exp(-((x + 0.5)^2 + y^2)/0.0828)/(0.0828*pi)", x, y),
                0.0036 * std::exp(-(rounded(std::pow(x + 0.5, 2)) + rounded(std::pow(y, 2))) / 0.0828) / (0.0828 * pi));
      EXPECT_EQ(value("(x^2 + y)^0.75 - x^-3", x, y),
                std::pow(rounded(std::pow(x, 2)) + y, 0.75) - rounded(std::pow(x, -3)));
    }
}

TEST(Formula, ChecksDimensions) {
  FormulaInputs inputs(2, UnitSystem::si());
  inputs.add("x", dimensions::length);
  inputs.add_vector("velocity", dimensions::velocity);
  inputs.define("k", 3, dimensions::spring_constant);
  inputs.define("height", "x + 2 m");
  auto const dimension = [&](char const* text) { return inputs.read(text).dimension(); };
  EXPECT_EQ(dimension("0.5*k*x^2"), dimensions::energy);
  EXPECT_EQ(dimension("norm(velocity)*1 s + height"), dimensions::length);
  EXPECT_EQ(dimension("mod(x, 1 mm) + min(2, x)"), dimensions::length);
  EXPECT_EQ(dimension("sqrt(k/(2 kg))"), dimensions::frequency);
  EXPECT_EQ(dimension("velocity").length, 1);
  EXPECT_EQ(dimension("0.1 1/s"), dimensions::frequency);
  EXPECT_EQ(dimension("x*0.1 1/s + 3 m/s"), dimensions::velocity);
  EXPECT_NEAR(inputs.read("2 1/ms + 3 1/ s")(std::array{2., 0., 0.}), 2003, 1e-12);
  EXPECT_NEAR(inputs.read("2 1/cm^2*x^2")(std::array{2., 0., 0.}), 80000, 1e-9);
  EXPECT_EQ(inputs.read("[x, 2*x]/(1 s)").components(), 2U);
  EXPECT_TRUE(inputs.read("3 + 4/2").fits(dimensions::mass));
  EXPECT_FALSE(inputs.read("3 kg").fits(dimensions::length));
  EXPECT_NEAR(inputs.read("1 cm + height")(std::array{2., 0., 0.}), 4.01, 1e-15);
  for (auto const& [text, offset, part] : std::vector<std::tuple<char const*, std::size_t, char const*>>{
           {"x + k", 2, "a length and a "},
           {"sin(x)", 4, "sin is taken of pure numbers; this is a length"},
           {"x^x", 1, "an exponent is a length"},
           {"2^x", 1, "an exponent is a length"},
           {"floor(x)", 6, "floor is taken of pure numbers"},
           {"mod(x, 1 s)", 7, "a length and a time can't be compared"},
           {"velocity*velocity", 8, "dot(a, b)"},
           {"velocity + x", 9, "a velocity and a length can't be added"},
           {"2 1/x", 2, "an operator is missing"},
           {"2 1/y", 2, "unknown unit"},
           {"2 1", 2, "1"},
           {"x < 3 kg", 2, "a length and a mass can't be compared"}}) {
    try {
      inputs.read(text);
      ADD_FAILURE() << text;
    } catch (FormulaError const& error) {
      EXPECT_EQ(error.offset, offset) << text << ": " << error.what();
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << text << ": " << error.what();
    }
  }
}

// In one dimension a vector is a number, too.
TEST(Formula, InOneDimensionVectorsAreNumbers) {
  FormulaInputs inputs(1);
  inputs.add_vector("velocity", dimensions::velocity);
  for (char const* text : {"velocity^2", "velocity*velocity", "velocity.x^2", "dot(velocity, velocity)",
                           "norm(velocity)^2", "norm(3) + velocity*velocity - 3", "1/velocity*velocity^3"})
    EXPECT_NEAR(inputs.read(text)(std::array{-1.5}), 2.25, 1e-15) << text;
}

// Every text is a formula or a mistake within it, never anything else.
TEST(Formula, OfAnyCharactersIsAFormulaOrAMistake) {
  std::string const alphabet = "x1.+-*/^()<>=!&|?:,e pi sn";
  std::uint64_t state = 12345;
  std::size_t good = 0, wrong = 0;
  for (int k = 0; k < 20'000; ++k) {
    std::string text;
    for (int c = 0; c < 1 + k % 9; ++c) {
      state = state * 6364136223846793005U + 1442695040888963407U;
      text += alphabet[(state >> 33) % alphabet.size()];
    }
    try {
      names().read(text)(std::array{1.0, 2.0, 3.0, 4.0});
      ++good;
    } catch (FormulaError const& error) {
      ++wrong;
      EXPECT_LE(error.offset, text.size()) << text;
    }
  }
  EXPECT_GT(good, 200U);
  EXPECT_GT(wrong, 10'000U);
}

}  // namespace
}  // namespace boltzmann::formula_test
