// From names to numbers: the table of quantities of a class and their computation.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/particles/particle_formula.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>

namespace boltzmann {
namespace {

struct DerivedQuantity {
  QuantityMeaning meaning;
  std::function<double(std::size_t)> value;
};

/// The component of a vector as a word: x, y, z; of a tensor xx, xy, ...; otherwise numbers from 3 on.
std::string component_name(Field const& field, int dimension, int component) {
  if (dimension > 1 && field.components == dimension * dimension)
    return {"xyz"[component / dimension], "xyz"[component % dimension]};
  return component < 3 ? std::string(1, "xyz"[component]) : std::to_string(component);
}

std::string readable(std::string name) {
  for (char& c : name)
    if (c == '_' || c == '-' || c == '.') c = ' ';
  return name;
}

std::vector<DerivedQuantity> table_of(AnyEnsemble const& ensemble, std::span<double const> potential_energy) {
  std::vector<DerivedQuantity> table;
  auto const* particles = &ensemble;
  auto const add = [&](std::string const& name, Dimension dimension, std::function<double(std::size_t)> value) {
    table.push_back({{name, readable(name), dimension}, std::move(value)});
  };
  for (auto const& field : ensemble.fields())
    for (int c = 0; c < field.components; ++c) {
      auto const value = [particles, at = field.offset + c](std::size_t i) { return particles->row(i)[at]; };
      bool const along_axes = field.components > 1 || field.name == "position" || field.name == "velocity";
      if (field.components == 1) add(field.name, field.dimension, value);
      if (along_axes) add(field.name + "." + component_name(field, ensemble.dimension(), c), field.dimension, value);
    }
  bool const body = carries_momentum(ensemble), has_velocity = ensemble.find_field("velocity") != nullptr;
  int const dimension = ensemble.dimension();
  if (static_cast<std::size_t>(dimension) <= ensemble.influence_size()) {
    for (int c = 0; c < dimension; ++c) {
      auto const value = [particles, c](std::size_t i) { return particles->influence(i)[c]; };
      if (!has_velocity) add(std::string("velocity.") + "xyz"[c], dimensions::velocity, value);
      add(std::string("influence.") + "xyz"[c], body ? dimensions::force : dimensions::velocity, value);
    }
  }
  if (has_velocities(ensemble))
    add("speed", dimensions::velocity, [velocities = velocities_of(ensemble), dimension](std::size_t i) {
      double const* v = velocities[i];
      return std::hypot(v[0], dimension > 1 ? v[1] : 0.0, dimension > 2 ? v[2] : 0.0);
    });
  if (body)
    add("kinetic-energy", dimensions::energy,
        [particles, velocities = velocities_of(ensemble), dimension,
         mass = ensemble.field("mass").offset](std::size_t i) {
          double const* v = velocities[i];
          double square = 0;
          for (int a = 0; a < dimension; ++a) square += v[a] * v[a];
          return 0.5 * particles->row(i)[mass] * square;
        });
  Field const *mass = ensemble.find_field("mass"), *heat = ensemble.find_field("specific_energy");
  if (mass != nullptr && heat != nullptr)
    add("internal-energy", dimensions::energy, [particles, m = mass->offset, e = heat->offset](std::size_t i) {
      return particles->row(i)[m] * particles->row(i)[e];
    });
  bool const known = potential_energy.size() == ensemble.size();
  add("potential-energy", dimensions::energy, [known, potential_energy](std::size_t i) {
    return known ? potential_energy[i] : std::numeric_limits<double>::quiet_NaN();
  });
  return table;
}

/// A formula with the fields of a particle that it reads.
class QuantityFormula {
 public:
  QuantityFormula(AnyEnsemble const& ensemble, std::string_view text, UnitSystem const& units,
                  std::span<double const> potential_energy) {
    int const dimension = ensemble.dimension();
    ParticleNames names(ensemble.fields(), dimension, units);
    auto const* particles = &ensemble;
    for (std::size_t k = 0; k < names.size(); ++k)
      values_.emplace_back([particles, at = names.offset(k)](std::size_t i) { return particles->row(i)[at]; });
    auto table = table_of(ensemble, potential_energy);
    for (std::string const vector : {"influence", "velocity"}) {
      auto const first = std::find_if(table.begin(), table.end(),
                                      [&](auto const& entry) { return entry.meaning.name == vector + ".x"; });
      if (first == table.end() || names.inputs.has(vector)) continue;
      names.inputs.add_vector(vector, first->meaning.dimension);
      for (int c = 0; c < dimension; ++c) values_.push_back((first + c)->value);
    }
    for (auto& entry : table) {
      std::string name = entry.meaning.name;
      std::replace(name.begin(), name.end(), '-', '_');
      if (name.find('.') != std::string::npos || names.inputs.has(name)) continue;
      names.inputs.add(name, entry.meaning.dimension);
      values_.push_back(std::move(entry.value));
    }
    formula_.emplace(names.inputs.read(text));
    if (formula_->components() > 1) throw FormulaError(0, "a number is needed, not a vector; norm(...) is its length");
    inputs_.resize(values_.size());
  }
  Dimension dimension() const { return formula_->dimension(); }
  double operator()(std::size_t i) {
    for (auto const input : formula_->inputs()) inputs_[input] = values_[input](i);
    return (*formula_)(inputs_);
  }

 private:
  std::vector<std::function<double(std::size_t)>> values_;
  std::vector<double> inputs_;
  std::optional<Formula> formula_;
};

std::shared_ptr<QuantityFormula> read_formula_of(AnyEnsemble const& ensemble, std::string_view text,
                                                 std::span<double const> potential_energy, UnitSystem const* units) {
  if (units) return std::make_shared<QuantityFormula>(ensemble, text, *units, potential_energy);
  try {
    return std::make_shared<QuantityFormula>(ensemble, text, UnitSystem::si(), potential_energy);
  } catch (FormulaError const& error) {
    try {  // in pure numbers nothing needs a check
      return std::make_shared<QuantityFormula>(ensemble, text, UnitSystem::reduced(), potential_energy);
    } catch (FormulaError const&) {
      throw error;
    }
  }
}

DerivedQuantity find(AnyEnsemble const& ensemble, std::string_view name, std::span<double const> potential_energy,
                     UnitSystem const* units) {
  auto table = table_of(ensemble, potential_energy);
  std::vector<std::string> names;
  for (auto& entry : table) {
    if (entry.meaning.name == name) return std::move(entry);
    names.push_back(entry.meaning.name);
  }
  try {
    auto const formula = read_formula_of(ensemble, name, potential_energy, units);
    return {{std::string(name), std::string(name), formula->dimension()},
            [formula](std::size_t i) { return (*formula)(i); }};
  } catch (FormulaError const& error) {
    if (name.find_first_of("+*/^()<>=?[") != std::string_view::npos)
      throw Error(fmt::format("formula '{}' of particles of '{}': {} (at '{}')", quoted(name), ensemble.name(),
                              error.what(), quoted(name.substr(std::min(error.offset, name.size())))));
  }
  Field const* vector = ensemble.find_field(name);
  std::string const hint = vector != nullptr ? fmt::format("; did you mean '{}.x'?", name) : did_you_mean(name, names);
  throw Error(fmt::format("ensemble '{}' of class {} has no quantity '{}'{}", ensemble.name(), ensemble.class_name(),
                          name, choices_with(hint, names, "it has")));
}

}  // namespace

std::vector<QuantityMeaning> quantities(AnyEnsemble const& ensemble) {
  std::vector<QuantityMeaning> meanings;
  for (auto& entry : table_of(ensemble, {})) meanings.push_back(std::move(entry.meaning));
  return meanings;
}

QuantityMeaning quantity_meaning(AnyEnsemble const& ensemble, std::string_view name, UnitSystem const* units) {
  return find(ensemble, name, {}, units).meaning;
}

bool has_quantity(AnyEnsemble const& ensemble, std::string_view name, UnitSystem const* units) {
  try {
    find(ensemble, name, {}, units);
    return true;
  } catch (Error const&) {
    return false;
  }
}

std::vector<double> quantity(AnyEnsemble const& ensemble, std::string_view name,
                             std::span<double const> potential_energy, UnitSystem const* units) {
  DerivedQuantity const entry = find(ensemble, name, potential_energy, units);
  std::vector<double> values(ensemble.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = entry.value(i);
  return values;
}

}  // namespace boltzmann
