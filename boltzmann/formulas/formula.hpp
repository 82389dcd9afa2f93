// Formulas: a number (or a vector) from a text and the values of its names, "-sin(2*pi*x)", as in a program.
#pragma once

#include <boltzmann/formulas/formula_reader.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// A parsed text, evaluated in double like the same expression in C++.
class Formula {
 public:
  /// `names` refer to inputs of `graph`, which must be of Form::as_written. FormulaError, with the place, if the text
  /// is invalid.
  Formula(std::string_view text, NamesInFormula const& names, int dimension, ExpressionGraph graph);

  /// For these inputs, by number. For a vector the other components follow.
  double operator()(std::span<double const> inputs) { return calculation_.run(inputs), calculation_[0]; }
  double component(std::size_t k) const { return calculation_[k]; }
  std::size_t components() const { return components_; }

  Dimension dimension() const { return dimension_; }
  /// True if its value may have this dimension: pure numbers without units may have any.
  bool fits(Dimension dimension) const { return !checked_ || plain_ || dimension_ == dimension; }
  /// True if its value is a comparison, or a combination of several: true or false.
  bool is_condition() const { return is_condition_; }
  /// The inputs that it depends on, sorted.
  std::vector<std::uint32_t> const& inputs() const { return inputs_; }

 private:
  Formula(FormulaValue const& value, bool checked, ExpressionGraph const& graph);

  std::size_t components_;
  Dimension dimension_;
  bool plain_, checked_, is_condition_;
  Calculation calculation_;
  std::vector<std::uint32_t> inputs_;
};

/// A number (or a vector) for many particles together: a formula with mean(...), sum(...), min(...) or max(...) of others,
/// "norm(mean(velocity))/mean(norm(velocity))", and their `number`.
class CollectiveFormula {
 public:
  /// `names` as for Formula; `common` inputs are the same for all particles. FormulaError, also if a quantity of one
  /// particle is outside a sum.
  CollectiveFormula(std::string_view text, NamesInFormula names, int dimension, ExpressionGraph graph,
                    std::uint32_t inputs, std::vector<std::uint32_t> const& common);

  /// For this number of particles; `take(i, inputs)` fills in the inputs of particle i. Runs in their order, on one
  /// thread.
  template <class Take>
  void run(std::size_t particles, Take const& take) {
    values_[number_] = static_cast<double>(particles);
    for (auto& level : levels_) {
      level.begin();
      for (std::size_t i = 0; i < particles; ++i) {
        take(i, std::span(values_));
        level.add(values_);
      }
      level.end(particles, values_);
    }
    if (particles > 0) take(0, std::span(values_));  // common inputs
    result_.run(values_);
  }
  double component(std::size_t k) const { return result_[k]; }
  std::size_t components() const { return components_; }
  Dimension dimension() const { return dimension_; }
  std::vector<std::uint32_t> const& inputs() const { return inputs_; }

 private:
  /// Sums that are computed in one pass over the particles.
  struct Level {
    std::vector<ParticleSum> sums;
    Calculation calculation;
    std::vector<double> totals = {};

    void begin();
    void add(std::span<double const> inputs);
    void end(std::size_t particles, std::span<double> values) const;
  };

  std::vector<Level> levels_;
  std::uint32_t number_ = 0;
  std::size_t components_ = 0;
  Dimension dimension_{};
  Calculation result_;
  std::vector<std::uint32_t> inputs_;  // of single particles
  std::vector<double> values_;
};

/// The names in a formula, each an input or several, numbered from 0.
class FormulaInputs {
 public:
  /// `dimension`: of space. Dimensions are checked unless units are reduced.
  explicit FormulaInputs(int dimension = 1, UnitSystem const& units = UnitSystem::reduced());

  /// Adds the next input. Of two with the same name the first is used.
  void add(std::string const& name, Dimension dimension);
  /// Adds the next inputs, x, y and z of a vector.
  void add_vector(std::string const& name, Dimension dimension);
  /// Defines a named number.
  void define(std::string const& name, double value, Dimension dimension);
  /// Defines a named formula. FormulaError.
  void define(std::string const& name, std::string_view text);
  /// Names may have blanks (NamesInFormula::with_blanks).
  void allow_blanks() { names_.with_blanks = true; }
  void check_dimensions(bool wanted) { names_.checked = wanted; }
  bool has(std::string_view name) const { return names_.values.contains(name) || name == "pi"; }

  /// FormulaError, with the place, if the text is not a valid formula.
  Formula read(std::string_view text) const { return {text, names_, dimension_, graph_}; }
  /// `common`: inputs that are the same for all particles.
  CollectiveFormula read_collective(std::string_view text, std::vector<std::uint32_t> const& common) const {
    return {text, names_, dimension_, graph_, next_, common};
  }
  std::uint32_t size() const { return next_; }

 private:
  Dimension known(Dimension dimension) const { return names_.checked ? dimension : Dimension{}; }

  int dimension_;
  NamesInFormula names_;
  ExpressionGraph graph_{Form::as_written};
  std::uint32_t next_ = 0;
};

}  // namespace boltzmann
