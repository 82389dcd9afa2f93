// Formulas of particles: a number, or a vector, for each particle from its position and its fields,
// "0.5*mass*dot(velocity, velocity)".
#pragma once

#include <boltzmann/formulas/formula.hpp>
#include <boltzmann/particles/field.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// The names in formulas for particles: x, y, z, r (the distance from the origin), the fields of a class, and the
/// speed. Fields are numbers ("mass"), vectors ("velocity", "velocity.x") and components of tensors ("stress.xy").
class ParticleNames {
 public:
  ParticleNames(std::vector<Field> const& fields, int dimension, UnitSystem const& units = UnitSystem::reduced());
  /// For a point in space: x, y, z, r only.
  explicit ParticleNames(int dimension, UnitSystem const& units = UnitSystem::reduced());

  /// The inputs that are the same for all particles.
  std::vector<std::uint32_t> common() const;
  /// Adds `time`.
  void add_time();
  /// Parameters and parts may be added.
  FormulaInputs inputs;

  /// The name of an input, "velocity.y", and its field; empty: it has none.
  std::string const& name(std::size_t input) const { return places_[input].name; }
  std::string const& field(std::size_t input) const { return places_[input].field; }
  /// The offset of an input in a row; -1: it is the time.
  int offset(std::size_t input) const { return places_[input].offset; }
  std::size_t size() const { return places_.size(); }

 private:
  struct InputPlace {
    std::string name, field;
    int offset;
  };
  std::vector<InputPlace> places_;
};

/// A formula with the offsets of its inputs in a row.
class ParticleFormula {
 public:
  /// FormulaError, with the place, if the text is not valid.
  ParticleFormula(std::string_view text, ParticleNames const& names);

  /// For the particle in that row; for a vector the other components follow.
  double operator()(double const* row, double time = 0);
  double component(std::size_t k) const { return formula_.component(k); }
  std::size_t components() const { return formula_.components(); }
  Formula const& formula() const { return formula_; }

 private:
  Formula formula_;
  std::vector<int> offsets_;  // of the inputs that it uses
  std::vector<double> values_;
};

/// A formula for many particles together (CollectiveFormula), with the offsets of its inputs in a row.
class ParticlesFormula {
 public:
  /// FormulaError, with the place, if the text is not valid.
  ParticlesFormula(std::string_view text, ParticleNames const& names);

  /// For these particles, given by their rows.
  template <class RowOf>
  void run(std::size_t particles, RowOf const& row_of, double time) {
    formula_.run(particles, [&](std::size_t i, std::span<double> inputs) {
      double const* const row = row_of(i);
      for (std::size_t k = 0; k < offsets_.size(); ++k)
        inputs[formula_.inputs()[k]] = offsets_[k] < 0 ? time : row[offsets_[k]];
    });
  }
  double component(std::size_t k) const { return formula_.component(k); }
  std::size_t components() const { return formula_.components(); }
  Dimension dimension() const { return formula_.dimension(); }

 private:
  CollectiveFormula formula_;
  std::vector<int> offsets_;
};

}  // namespace boltzmann
