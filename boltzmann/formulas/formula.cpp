// Formulas of one particle, and of many: sums, level by level.
#include <boltzmann/formulas/formula.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace boltzmann {

Formula::Formula(FormulaValue const& value, bool checked, ExpressionGraph const& graph)
    : components_(value.components.size()),
      dimension_(value.dimension),
      plain_(value.plain),
      checked_(checked),
      is_condition_(value.is_truth),
      calculation_(graph, value.components),
      inputs_(graph.inputs_of(value.components)) {}

Formula::Formula(std::string_view text, NamesInFormula const& names, int dimension, ExpressionGraph graph)
    : Formula(read_formula_text(text, names, dimension, graph), names.checked, graph) {}

CollectiveFormula::CollectiveFormula(std::string_view text, NamesInFormula names, int dimension, ExpressionGraph graph,
                                     std::uint32_t inputs, std::vector<std::uint32_t> const& common)
    : result_(graph, {}) {
  ParticleSums sums;
  number_ = inputs;
  sums.next_input = inputs + 1;
  names.sums = &sums;
  if (!names.values.contains("number")) names.values["number"] = {{graph.input(number_)}, {}};
  FormulaValue const value = read_formula_text(text, names, dimension, graph);
  auto const is_common = [&](std::uint32_t input) {
    return input >= number_ || std::find(common.begin(), common.end(), input) != common.end();
  };
  auto const outside = graph.inputs_of(value.components);
  for (auto const& [name, known] : names.values) {
    auto const of = graph.inputs_of(known.components);
    bool const single = std::any_of(of.begin(), of.end(), [&](std::uint32_t input) {
      return !is_common(input) && std::binary_search(outside.begin(), outside.end(), input);
    });
    if (!single || text.find(name) == std::string_view::npos) continue;
    throw FormulaError(text.find(name), "'" + name +
                                            "' is of one particle; for many take its mean(...), sum(...), min(...) or "
                                            "max(...)");
  }
  if (!std::all_of(outside.begin(), outside.end(), is_common))
    throw FormulaError(0, "for many particles a mean(...), sum(...), min(...) or max(...) is needed");
  // A sum is one level above the sums inside it.
  std::vector<std::size_t> level_of(sums.next_input, 0);
  std::vector<std::vector<ParticleSum>> levels;
  for (auto const& sum : sums.all) {
    std::size_t level = 0;
    for (auto const input : graph.inputs_of(sum.of)) {
      level = std::max(level, level_of[input]);
      if (input < number_) inputs_.push_back(input);
    }
    level_of[sum.input] = level + 1;
    levels.resize(std::max(levels.size(), level + 1));
    levels[level].push_back(sum);
  }
  std::sort(inputs_.begin(), inputs_.end());
  inputs_.erase(std::unique(inputs_.begin(), inputs_.end()), inputs_.end());
  for (auto const input : outside)
    if (input < number_ && !std::binary_search(inputs_.begin(), inputs_.end(), input)) inputs_.push_back(input);
  for (auto& level : levels) {
    std::vector<Expression> of;
    of.reserve(level.size());
    for (auto const& sum : level) of.push_back(sum.of);
    levels_.push_back({std::move(level), Calculation(graph, of)});
  }
  values_.resize(sums.next_input);
  components_ = value.components.size();
  dimension_ = value.dimension;
  result_ = Calculation(graph, value.components);
}

void CollectiveFormula::Level::begin() {
  using Kind = ParticleSum::Kind;
  totals.clear();
  double const infinite = std::numeric_limits<double>::infinity();
  for (auto const& sum : sums)
    totals.push_back(sum.kind == Kind::min ? infinite : sum.kind == Kind::max ? -infinite : 0);
}

void CollectiveFormula::Level::add(std::span<double const> inputs) {
  using Kind = ParticleSum::Kind;
  calculation.run(inputs);
  for (std::size_t k = 0; k < sums.size(); ++k) {
    double const x = calculation[k];
    if (sums[k].kind == Kind::min)
      totals[k] = x < totals[k] || std::isnan(x) ? x : totals[k];
    else if (sums[k].kind == Kind::max)
      totals[k] = x > totals[k] || std::isnan(x) ? x : totals[k];
    else
      totals[k] += x;
  }
}

void CollectiveFormula::Level::end(std::size_t particles, std::span<double> values) const {
  using Kind = ParticleSum::Kind;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    values[sums[k].input] = totals[k];
    if (particles == 0 && sums[k].kind != Kind::sum) values[sums[k].input] = std::numeric_limits<double>::quiet_NaN();
    if (sums[k].kind == Kind::mean) values[sums[k].input] /= static_cast<double>(particles);
  }
}

FormulaInputs::FormulaInputs(int dimension, UnitSystem const& units) : dimension_(dimension) {
  names_.units = units;
  names_.checked = !units.is_reduced();
}

void FormulaInputs::add(std::string const& name, Dimension dimension) {
  FormulaValue value{{graph_.input(next_++)}, known(dimension)};
  if (!names_.values.contains(name)) names_.values[name] = std::move(value);
}

void FormulaInputs::add_vector(std::string const& name, Dimension dimension) {
  FormulaValue value{{}, known(dimension), false, true};
  for (int c = 0; c < dimension_; ++c) value.components.push_back(graph_.input(next_++));
  names_.values[name] = std::move(value);
}

void FormulaInputs::define(std::string const& name, double value, Dimension dimension) {
  names_.values[name] = {{graph_.number(value)}, known(dimension), false, false};
}

void FormulaInputs::define(std::string const& name, std::string_view text) {
  names_.values[name] = read_formula_text(text, names_, dimension_, graph_);
}

}  // namespace boltzmann
