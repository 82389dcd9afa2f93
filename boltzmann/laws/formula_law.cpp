// Compiles the text of a law to programs: names and fields become inputs, energies are differentiated.
#include <boltzmann/formulas/formula_reader.hpp>
#include <boltzmann/laws/angular_program.hpp>
#include <boltzmann/laws/formula_law.hpp>
#include <boltzmann/laws/pair_numbers.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>

namespace boltzmann {
namespace {

/// The dimension of the influence on particles of this ensemble: a force, or a velocity of a flow.
Dimension influence_dimension(AnyEnsemble const& ensemble) {
  return ensemble.find_field("mass") && ensemble.find_field("velocity") ? dimensions::force : dimensions::velocity;
}

/// Attributes an error about the meaning of a text to its part.
template <class F>
auto in_part(std::string const& part, F const& f) {
  try {
    return f();
  } catch (FormulaPartError const& error) {
    throw FormulaPartError(error.part.empty() ? part : error.part, error.offset, error.what());
  }
}

class Maker {
 public:
  Maker(FormulaLaw const& law, AnyEnsemble const& target) : law_(law), target_(target), dimension_(target.dimension()) {
    names_.units = law.units;
    names_.checked = !law.units.is_reduced();
    names_.with_parameters = true;
    if (law.changes.empty() && target.influence_size() != static_cast<std::size_t>(dimension_))
      throw FormulaPartError(
          "", 0,
          fmt::format("what acts on particles of class {} is more than a vector; a formula gives a vector",
                      target.class_name()));
  }

  PairProgram pairs(AnyEnsemble const& source, FormulaLaw::Target part, double cutoff) {
    bool const is_p = part == FormulaLaw::Target::p;
    name_separation(is_p);
    auto const of_target = add_fields(target_, is_p ? "p." : "q.", false);
    auto const of_source = add_fields(source, is_p ? "q." : "p.", false);
    name_relative_velocity();
    FormulaValue value = read();
    for (auto& component : value.components) component = by_square(component);
    PairProgram program;
    std::vector<Expression> results;
    Expression energy = 0;
    if (!law_.changes.empty()) {
      results = rate_of(changed_field(), value);
      program.along = false;
    } else if (law_.gives == FormulaLaw::Gives::energy) {
      need(value, dimensions::energy, "an energy");
      energy = value.components[0];
      if (&source == &target_) check_symmetry(energy, of_target, of_source);
      energy = ended(energy, cutoff, true);
      results = forces_of(energy, program.along);
      program.has_energy = true;
      program.antisymmetric = true;
    } else {
      results = influence_of(value, cutoff, program.along);
      program.antisymmetric = &source == &target_ && is_antisymmetric(results, program.along, of_target, of_source);
    }
    std::vector<Expression> measured = results;
    if (program.has_energy) measured.push_back(energy);
    std::vector<std::uint32_t> columns, rows;
    for (std::uint32_t c = 0; c <= static_cast<std::uint32_t>(dimension_); ++c) columns.push_back(c);
    program.of_q = choose(measured, of_source, columns);
    program.of_p = choose(measured, of_target, rows);
    std::size_t const gathered = static_cast<std::size_t>(dimension_) + 1;
    program.influence = make_program(graph_, results, columns, rows, gathered);
    program.measure = make_program(graph_, measured, columns, rows, gathered);
    program.velocity_dependent = reads_changing(target_, program.of_p) || reads_changing(source, program.of_q);
    if (is_singular(results, program.along)) program.least_square = 0;
    program.numbers = std::make_shared<PairNumbers>(
        PairNumbers{Calculation(graph_, measured), of_target, of_source, next_, program.along, program.has_energy});
    return program;
  }

  ExternalProgram external() {
    std::uint32_t const D = static_cast<std::uint32_t>(dimension_);
    std::uint32_t time = 0;
    auto const fields = add_names_from_outside(time);
    FormulaValue const value = read();
    ExternalProgram program;
    std::vector<Expression> results;
    Expression energy = 0;
    if (!law_.changes.empty()) {
      results = rate_of(changed_field(), value);
    } else if (law_.gives == FormulaLaw::Gives::energy) {
      need(value, dimensions::energy, "an energy");
      energy = value.components[0];
      for (std::uint32_t c = 0; c < D; ++c) results.push_back(graph_.scale(-1, graph_.derivative(energy, c)));
      program.has_energy = true;
    } else {
      Dimension const wanted = influence_dimension(target_);
      need(value, wanted, wanted == dimensions::force ? "a force" : "a velocity", true);
      if (!value.is_vector && D > 1)
        throw FormulaPartError("", 0, fmt::format("a vector is needed, [..., ...], of {} numbers", D));
      results = value.components;
    }
    std::vector<Expression> measured = results;
    if (program.has_energy) measured.push_back(energy);
    std::vector<std::uint32_t> columns;
    std::vector<std::uint32_t> const rows{time};
    program.of_p = choose(measured, fields, columns);
    program.influence = make_program(graph_, results, columns, rows);
    program.measure = make_program(graph_, measured, columns, rows);
    program.velocity_dependent = reads_changing(target_, program.of_p);
    program.depends_on_time = depend_on(measured, time);
    return program;
  }

  AngularProgram angular(std::string const& variable) {
    if (law_.gives != FormulaLaw::Gives::energy || !law_.changes.empty())
      throw FormulaPartError("", 0, fmt::format("what acts by the {} is an energy", variable));
    next_ = 1;
    names_.values[variable] = {{graph_.input(0)}, dimension_of(dimensions::angle), false, false};
    FormulaValue const value = read();
    need(value, dimensions::energy, "an energy");
    std::vector<Expression> results{graph_.derivative(value.components[0], 0)};
    std::vector<std::uint32_t> const columns{0};
    AngularProgram program;
    program.influence = make_program(graph_, results, columns, {});
    results.push_back(value.components[0]);
    program.measure = make_program(graph_, results, columns, {});
    return program;
  }

  RateProgram rates(FieldRates const& all) {
    std::uint32_t time = 0;
    sums_known_ = true;
    auto const fields = add_names_from_outside(time);
    read_names();
    RateProgram program;
    std::vector<Expression> expressions;
    auto const add = [&](std::vector<Expression> const& components, std::size_t rate, int count) {
      for (std::size_t c = 0; c < static_cast<std::size_t>(count); ++c) {
        expressions.push_back(components[c]);
        program.results.push_back({rate, c});
      }
    };
    for (auto const& rate : all.rates) {
      std::string const part = "rate." + rate.field;
      Field const& field = target_.field(rate.field);
      add(in_part(part, [&] { return rate_of(field, read_text(part, rate.text)); }),
          static_cast<std::size_t>(target_.number_driven(field)), field.components);
    }
    for (std::size_t k = 0; k < target_.driven().size(); ++k) {
      auto const& driven = target_.driven()[k];
      auto const is_of = [k](RateProgram::Result const& result) { return result.rate == k; };
      if (!driven.sum && std::none_of(program.results.begin(), program.results.end(), is_of))
        add(std::vector(static_cast<std::size_t>(driven.components), graph_.number(0)), k, driven.components);
    }
    std::size_t place = target_.driven().size();
    for (auto const& driven : target_.driven()) {
      if (!driven.diffuses) continue;
      for (auto const& diffusion : all.diffusions) {
        Field const& field = target_.field(diffusion.field);
        if (field.offset != driven.offset) continue;
        add({diffusion_of(field, diffusion.text)}, place, 1);
      }
      ++place;
    }
    std::vector<std::uint32_t> columns;
    std::vector<std::uint32_t> const rows{time};
    program.of_p = choose(expressions, fields, columns);
    for (std::size_t k = 0; k < target_.driven().size(); ++k)
      for (auto const& input : fields) {
        auto const& driven = target_.driven()[k];
        int const component = input.offset - driven.offset;
        if (!driven.sum || component < 0 || component >= driven.components || !depend_on(expressions, input.input))
          continue;
        program.sums.push_back({k, static_cast<std::size_t>(component)});
        columns.push_back(input.input);
      }
    program.program = make_program(graph_, expressions, columns, rows);
    program.velocity_dependent = reads_changing(target_, program.of_p);
    program.depends_on_time = depend_on(expressions, time);
    return program;
  }

 private:
  using RowInput = PairNumbers::RowInput;

  Dimension dimension_of(Dimension dimension) const { return names_.checked ? dimension : Dimension{}; }

  /// The separation from p to q, either of which may be the target, and the distance. Inputs are the components of q -
  /// p as seen from the target, and their square.
  void name_separation(bool is_p) {
    std::uint32_t const D = static_cast<std::uint32_t>(dimension_);
    FormulaValue separation;
    separation.is_vector = true;
    separation.dimension = dimension_of(dimensions::length);
    for (std::uint32_t c = 0; c < D; ++c) {
      Expression const d = graph_.input(c);
      separation.components.push_back(is_p ? d : graph_.scale(-1, d));
    }
    square_ = graph_.input(D, true);
    next_ = D + 1;
    names_.values["separation"] = separation;
    names_.values["r"] = {{graph_.root(square_)}, dimension_of(dimensions::length), false, false};
  }

  /// If both have a velocity.
  void name_relative_velocity() {
    auto const p = names_.values.find("p.velocity"), q = names_.values.find("q.velocity");
    if (p == names_.values.end() || q == names_.values.end()) return;
    FormulaValue relative = q->second;
    for (std::size_t c = 0; c < relative.components.size(); ++c)
      relative.components[c] = graph_.subtract(relative.components[c], p->second.components[c]);
    names_.values["velocity"] = relative;
  }

  /// The influence on the target of a vector, or of a number along the separation; `along`: one factor of the
  /// separation.
  std::vector<Expression> influence_of(FormulaValue const& value, double cutoff, bool& along) {
    Dimension const wanted = influence_dimension(target_);
    need(value, wanted, wanted == dimensions::force ? "a force" : "a velocity", true);
    along = !value.is_vector;
    std::vector<Expression> results = value.components;
    for (auto& result : results) result = ended(result, cutoff, false);
    // A positive number pushes p away from q.
    if (along) results[0] = graph_.scale(-1, graph_.product({{results[0], 1}, {square_, -0.5}}));
    if (auto const factor = factor_of_separation(results); value.is_vector && factor) {
      along = true;
      results = {*factor};
    }
    return results;
  }

  std::vector<RowInput> add_fields(AnyEnsemble const& ensemble, std::string const& prefix, bool with_position) {
    std::vector<RowInput> inputs;
    for (auto const& field : ensemble.fields()) {
      if (field.name == "position" && !with_position) continue;
      bool const vector = ensemble.is_vector(field);
      if (field.components != 1 && !vector) continue;
      int const number = ensemble.number_driven(field);
      if (number >= 0 && ensemble.driven()[static_cast<std::size_t>(number)].sum && !sums_known_) {
        unknown_.push_back(prefix + field.name);
        continue;
      }
      FormulaValue value;
      value.is_vector = vector;
      value.dimension = dimension_of(field.dimension);
      for (int c = 0; c < field.components; ++c) {
        value.components.push_back(graph_.input(next_));
        inputs.push_back({field.offset + c, next_++});
      }
      names_.values[prefix + field.name] = value;
    }
    return inputs;
  }

  /// The names in external laws: x, y, z, fields, time.
  std::vector<RowInput> add_names_from_outside(std::uint32_t& time) {
    next_ = 0;
    auto fields = add_fields(target_, "", true);
    auto const position = names_.values.find("position");
    for (std::uint32_t c = 0; c < static_cast<std::uint32_t>(dimension_); ++c)
      names_.values[std::string(1, "xyz"[c])] = {
          {position->second.components[c]}, position->second.dimension, false, false};
    time = next_++;
    names_.values["time"] = {{graph_.input(time)}, dimension_of(dimensions::time), false, false};
    return fields;
  }
  bool depend_on(std::vector<Expression> const& expressions, std::uint32_t input) const {
    return std::any_of(expressions.begin(), expressions.end(), [&](Expression e) {
      auto const inputs = graph_.inputs_of(e);
      return std::binary_search(inputs.begin(), inputs.end(), input);
    });
  }

  // ---- Fields that have rates ----

  Field const& changed_field() const {
    if (law_.gives == FormulaLaw::Gives::energy)
      throw FormulaPartError("", 0,
                             "an energy moves particles; what changes a field is an influence, which gives its rate");
    return target_.field(law_.changes);
  }
  /// As many components as space has axes.
  std::vector<Expression> rate_of(Field const& field, FormulaValue const& value) {
    int const number = target_.number_driven(field);
    bool const sum = number >= 0 && target_.driven()[static_cast<std::size_t>(number)].sum;
    if (number < 0)
      throw FormulaPartError(
          "", 0,
          fmt::format("{} of class {} does not change: give it a rate in [[classes]], 0 if nothing else changes it",
                      field.name, target_.class_name()));
    bool const vector = target_.is_vector(field);
    if (value.is_vector != vector)
      throw FormulaPartError("", 0,
                             vector ? fmt::format("{} is a vector: its rate is one, [..., ...]", field.name)
                                    : fmt::format("{} is a number: its rate is one, not a vector", field.name));
    std::string const what =
        fmt::format("{}{}, for {}", dimension_text(field.dimension), sum ? "" : " in a time", field.name);
    need(value, sum ? field.dimension : field.dimension / dimensions::time, what.c_str(), vector);
    auto components = value.components;
    components.resize(static_cast<std::size_t>(dimension_), graph_.number(0));
    return components;
  }
  Expression diffusion_of(Field const& field, std::string const& text) {
    std::string const part = "diffusion." + field.name;
    FormulaValue const value = read_text(part, text);
    return in_part(part, [&] {
      need(value, field.dimension * field.dimension / dimensions::time,
           fmt::format("the square of {} in a time, for {}", dimension_text(field.dimension), field.name).c_str());
      auto const inputs = graph_.inputs_of(value.components[0]);
      for (auto const& name : names_.values)
        for (auto const e : name.second.components)
          if (changes(name.first) && std::binary_search(inputs.begin(), inputs.end(), graph_.node(e).input) &&
              graph_.node(e).kind == ExpressionGraph::Kind::input)
            throw FormulaPartError(
                "", 0,
                fmt::format("'{}' changes during a step, and diffusion may not: it may use parameters, "
                            "the time, and fields that stay as they are",
                            name.first));
      return value.components[0];
    });
  }
  bool changes(std::string const& name) const {
    if (name == "x" || name == "y" || name == "z" || name == "position" || name == "velocity") return true;
    Field const* field = target_.find_field(name);
    return field && target_.number_driven(*field) >= 0;
  }
  FormulaValue read() {
    read_names();
    return read_text("", law_.text);
  }
  void read_names() {
    auto const taken = [&](std::string const& name) { return names_.values.contains(name) || name == "pi"; };
    for (auto const& parameter : law_.parameters) {
      if (taken(parameter.name))
        throw FormulaPartError(parameter.name, 0,
                               fmt::format("'{}' means something else in a formula already", parameter.name));
      names_.values[parameter.name] = {
          {graph_.number(parameter.value)}, dimension_of(parameter.dimension), false, false};
    }
    for (auto const& part : law_.where) {
      if (taken(part.name))
        throw FormulaPartError(part.name, 0, fmt::format("'{}' means something else in a formula already", part.name));
      names_.values[part.name] = read_text(part.name, part.text);
    }
  }
  FormulaValue read_text(std::string const& part, std::string const& text) {
    try {
      return read_formula_text(text, names_, dimension_, graph_);
    } catch (FormulaError const& error) {
      for (auto const& sum : unknown_)
        if (std::string_view(error.what()).find("'" + sum + "'") != std::string_view::npos)
          throw FormulaPartError(
              part, error.offset,
              fmt::format("'{}' is a sum, which is not known while laws act; rates may use it", sum));
      throw FormulaPartError(part, error.offset, error.what());
    }
  }

  void need(FormulaValue const& value, Dimension dimension, char const* what, bool vector = false) const {
    if (value.is_vector && !vector) throw FormulaPartError("", 0, fmt::format("{} is needed, not a vector", what));
    if (names_.checked && !(value.dimension == dimension) && !(value.plain && graph_.is_number(value.components[0], 0)))
      throw FormulaPartError("", 0, fmt::format("{} is needed; this is {}", what, dimension_text(value.dimension)));
  }

  /// Replaces norm(separation) and dot(separation, separation) by the input that is the square of the distance: then an
  /// energy of these depends on r only, and is finite where r is.
  Expression by_square(Expression value) {
    std::vector<ExpressionGraph::Term> squares;
    for (std::uint32_t c = 0; c < static_cast<std::uint32_t>(dimension_); ++c)
      squares.push_back({graph_.product({{graph_.input(c), 2}}), 1});
    if (dimension_ > 1) return graph_.with_sum(value, squares, square_);
    Expression const r = graph_.root(square_), step = graph_.input(0);
    Expression const there = graph_.apply(Operation::abs, step),
                     back = graph_.apply(Operation::abs, graph_.scale(-1, step));
    return graph_.with_sum(value, squares, square_, {{squares[0].node, square_}, {there, r}, {back, r}});
  }

  /// True if the influence diverges as two particles approach each other.
  bool is_singular(std::vector<Expression> results, bool along) {
    for (auto& result : results) result = graph_.with_common_powers(result);  // as in programs
    auto const strength = [&](double distance) {
      auto inputs = sample(0, {}, {}).here;
      auto const D = static_cast<std::size_t>(dimension_);
      double const scale = distance / std::sqrt(inputs[D]);
      for (std::size_t c = 0; c < D; ++c) inputs[c] *= scale;
      inputs[D] = distance * distance;
      for (std::size_t k = D + 1; k < inputs.size(); ++k) inputs[k] = some_number(static_cast<std::uint32_t>(k), 0);
      double sum = 0;  // NaN if any of them is
      for (auto const result : results) sum += std::fabs(graph_.value(result, inputs)) * (along ? distance : 1);
      return sum;
    };
    constexpr double near = 1e-110, nearer = 1e-130;
    double const there = strength(nearer);
    return !std::isfinite(there) || there > 10 * strength(near);
  }

  /// On the target: (source - target) 2 dU/ds, and dU/dd if the energy depends on the direction.
  std::vector<Expression> forces_of(Expression energy, bool& along) {
    std::uint32_t const D = static_cast<std::uint32_t>(dimension_);
    Expression const factor = graph_.scale(2, graph_.derivative(energy, D));
    std::vector<Expression> direct;
    along = true;
    for (std::uint32_t c = 0; c < D; ++c) {
      direct.push_back(graph_.derivative(energy, c));
      along = along && graph_.is_number(direct[c], 0);
    }
    if (along) return {factor};
    for (std::uint32_t c = 0; c < D; ++c)
      direct[c] = graph_.sum(0, {{graph_.multiply(factor, graph_.input(c)), 1}, {direct[c], 1}});
    return direct;
  }

  /// The common factor of the separation, if all components are that times the separation.
  std::optional<Expression> factor_of_separation(std::vector<Expression> const& components) {
    std::optional<Expression> common;
    for (std::uint32_t c = 0; c < components.size(); ++c) {
      auto const whole = graph_.node(components[c]);
      bool const scaled = whole.kind == ExpressionGraph::Kind::sum && whole.number == 0 && whole.terms.size() == 1;
      ExpressionGraph::Term const inner = scaled ? whole.terms[0] : ExpressionGraph::Term{components[c], 1};
      auto const node = graph_.node(inner.node);
      std::vector<ExpressionGraph::Term> factors{{inner.node, 1}};
      if (node.kind == ExpressionGraph::Kind::product) factors = node.terms;
      auto const separation = std::find(factors.begin(), factors.end(), ExpressionGraph::Term{graph_.input(c), 1});
      if (separation == factors.end()) return std::nullopt;
      factors.erase(separation);
      Expression const rest = graph_.scale(inner.factor, factors.empty() ? graph_.number(1) : graph_.product(factors));
      if (common && *common != rest) return std::nullopt;
      common = rest;
    }
    return common;
  }

  /// Ends an energy or an influence at the cut-off as the law defines.
  Expression ended(Expression value, double cutoff, bool is_energy) {
    if (law_.at_cutoff == FormulaLaw::AtCutoff::cut) return value;
    if (!std::isfinite(cutoff))
      throw FormulaPartError("", 0, "without a cut-off nothing can be shifted or switched off there");
    std::uint32_t const D = static_cast<std::uint32_t>(dimension_);
    Expression const r = graph_.root(square_);
    if (law_.at_cutoff == FormulaLaw::AtCutoff::switched) {
      double const from = law_.switch_from > 0 ? law_.switch_from : 0.9 * cutoff;
      if (!(from < cutoff))
        throw FormulaPartError("", 0,
                               fmt::format("a law that is switched off between {} and the cut-off {} has no room "
                                           "for it",
                                           from, cutoff));
      // 1 - x^3 (10 - 15 x + 6 x^2): value, slope and curvature are smooth at both ends.
      Expression const x = graph_.apply(Operation::max, graph_.number(0),
                                        graph_.sum(-from / (cutoff - from), {{r, 1 / (cutoff - from)}}));
      Expression const inside = graph_.sum(10, {{x, -15}, {graph_.product({{x, 2}}), 6}});
      return graph_.multiply(value, graph_.sum(1, {{graph_.product({{x, 3}, {inside, 1}}), -1}}));
    }
    // The same at the cut-off, in the same direction.
    std::unordered_map<std::uint32_t, Expression> at_end{{D, graph_.number(cutoff * cutoff)}};
    for (std::uint32_t c = 0; c < D; ++c)
      at_end[c] = graph_.scale(cutoff, graph_.multiply(graph_.input(c), graph_.product({{square_, -0.5}})));
    Expression const there = graph_.replaced(value, at_end);
    if (!is_energy) return graph_.subtract(value, there);
    std::vector<ExpressionGraph::Term> slope{{graph_.multiply(graph_.derivative(value, D), r), 2}};
    for (std::uint32_t c = 0; c < D; ++c)
      slope.push_back({graph_.multiply(graph_.derivative(value, c), graph_.divide(graph_.input(c), r)), 1});
    Expression const slope_there = graph_.replaced(graph_.sum(0, slope), at_end);
    return graph_.sum(0, {{value, 1}, {there, -1}, {graph_.multiply(graph_.sum(-cutoff, {{r, 1}}), slope_there), -1}});
  }

  /// Inputs for a pair, and for the same pair with p and q exchanged.
  struct Sample {
    std::vector<double> here, there;
  };
  /// Between 0.6 and 1.4.
  static double some_number(std::uint32_t k, int number) {
    double const x = std::fmod((static_cast<double>(k) + 1) * 0.6180339887498949 + number * 0.7548776662466927, 1.0);
    return 0.6 + 0.8 * x;
  }
  Sample sample(int number, std::vector<RowInput> const& of_target, std::vector<RowInput> const& of_source) const {
    auto const some = [&](std::uint32_t k) { return some_number(k, number); };
    Sample result;
    result.here.resize(next_);
    result.there.resize(next_);
    double square = 0;
    std::uint32_t const D = static_cast<std::uint32_t>(dimension_);
    for (std::uint32_t c = 0; c < D; ++c) {
      result.here[c] = some(c);
      result.there[c] = -result.here[c];
      square += some(c) * some(c);
    }
    result.here[D] = result.there[D] = square;
    for (std::size_t k = 0; k < of_target.size(); ++k) {
      result.here[of_target[k].input] = result.there[of_source[k].input] = some(of_target[k].input);
      result.here[of_source[k].input] = result.there[of_target[k].input] = some(of_source[k].input);
    }
    return result;
  }
  static bool equal(double a, double b) {
    return (std::isnan(a) && std::isnan(b)) || std::fabs(a - b) <= 1e-10 * (std::fabs(a) + std::fabs(b));
  }
  static constexpr int samples = 5;

  void check_symmetry(Expression energy, std::vector<RowInput> const& of_target,
                      std::vector<RowInput> const& of_source) const {
    for (int k = 0; k < samples; ++k) {
      Sample const s = sample(k, of_target, of_source);
      if (!equal(graph_.value(energy, s.here), graph_.value(energy, s.there)))
        throw FormulaPartError("", 0,
                               "the energy of a pair is another one when p and q change places; within one ensemble it "
                               "must be the same");
    }
  }
  bool is_antisymmetric(std::vector<Expression> const& results, bool along, std::vector<RowInput> const& of_target,
                        std::vector<RowInput> const& of_source) const {
    for (int k = 0; k < samples; ++k) {
      Sample const s = sample(k, of_target, of_source);
      for (auto const result : results)
        if (!equal(graph_.value(result, s.here), (along ? 1 : -1) * graph_.value(result, s.there))) return false;
    }
    return true;
  }

  /// The offsets of those inputs that the expressions read, except sums; appends their names to `names`.
  std::vector<int> choose(std::vector<Expression> const& expressions, std::vector<RowInput> const& inputs,
                          std::vector<std::uint32_t>& names) const {
    std::vector<std::uint32_t> read;
    for (auto const e : expressions) {
      auto const more = graph_.inputs_of(e);
      read.insert(read.end(), more.begin(), more.end());
    }
    std::vector<RowInput> chosen;
    auto const is_sum = [&](RowInput const& input) {
      return std::any_of(target_.driven().begin(), target_.driven().end(), [&](DrivenField const& driven) {
        return sums_known_ && driven.sum && input.offset >= driven.offset &&
               input.offset < driven.offset + driven.components;
      });
    };
    for (auto const& input : inputs)
      if (!is_sum(input) && std::find(read.begin(), read.end(), input.input) != read.end()) chosen.push_back(input);
    std::sort(chosen.begin(), chosen.end(), [](RowInput const& a, RowInput const& b) { return a.offset < b.offset; });
    std::vector<int> offsets;
    for (auto const& input : chosen) {
      offsets.push_back(input.offset);
      names.push_back(input.input);
    }
    return offsets;
  }
  /// True if some of these are velocities, or fields with rates of their own, which change while influences are kept.
  static bool reads_changing(AnyEnsemble const& ensemble, std::vector<int> const& offsets) {
    for (auto const& field : ensemble.fields())
      if (field.name == "velocity" || ensemble.number_driven(field) >= 0)
        for (int const offset : offsets)
          if (offset >= field.offset && offset < field.offset + field.components) return true;
    return false;
  }

  FormulaLaw const& law_;
  AnyEnsemble const& target_;
  int dimension_;
  ExpressionGraph graph_;
  NamesInFormula names_;
  bool sums_known_ = false;
  std::vector<std::string> unknown_;  // sums
  Expression square_ = 0;
  std::uint32_t next_ = 0;
};

}  // namespace

PairProgram FormulaLaw::between(AnyEnsemble const& target, AnyEnsemble const& source, Target part,
                                double cutoff) const {
  return Maker(*this, target).pairs(source, part, cutoff);
}

ExternalProgram FormulaLaw::on(AnyEnsemble const& target) const { return Maker(*this, target).external(); }

AngularProgram angular_program(FormulaLaw const& law, AnyEnsemble const& ensemble, std::string const& variable) {
  return Maker(law, ensemble).angular(variable);
}

RateProgram FieldRates::on(AnyEnsemble const& target) const {
  FormulaLaw law = FormulaLaw::influence("", parameters, where, units);
  law.changes = rates.empty() ? "" : rates.front().field;
  return Maker(law, target).rates(*this);
}

}  // namespace boltzmann
