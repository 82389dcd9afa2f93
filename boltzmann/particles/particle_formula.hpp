// Formulas of particles: a number, or a vector, for each particle from its place and its fields, "0.5*mass*dot(velocity,
// velocity)".
#pragma once

#include <boltzmann/formulas/formula.hpp>
#include <boltzmann/particles/field.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// What may stand in formulas for particles: x, y, z, r (the distance from the origin), and the fields of a class: numbers
/// ("mass"), vectors ("velocity", "velocity.x"), components of tensors ("stress.xy"); and the speed.
class ParticleNames {
 public:
  ParticleNames(std::vector<Field> const& fields, int dimension, UnitSystem const& units = UnitSystem::reduced());
  /// Of a place in space alone: x, y, z, r.
  explicit ParticleNames(int dimension, UnitSystem const& units = UnitSystem::reduced());

  /// The inputs that are the same for all particles.
  std::vector<std::uint32_t> common() const;
  /// Also `time`.
  void add_time();
  /// Parameters and parts may be added.
  FormulaInputs inputs;

  /// What an input is called, "velocity.y", and of which field it is; empty: of none.
  std::string const& name(std::size_t input) const { return places_[input].name; }
  std::string const& field(std::size_t input) const { return places_[input].field; }
  /// Where an input stands in a row; -1: it is the time.
  int offset(std::size_t input) const { return places_[input].offset; }
  std::size_t size() const { return places_.size(); }

 private:
  struct InputPlace {
    std::string name, field;
    int offset;
  };
  std::vector<InputPlace> places_;
};

/// A formula with the places of its inputs in a row.
class ParticleFormula {
 public:
  /// FormulaError, with the place, if the text is none.
  ParticleFormula(std::string_view text, ParticleNames const& names);

  /// For the particle in that row. What follows are the components of a vector.
  double operator()(double const* row, double time = 0);
  double component(std::size_t k) const { return formula_.component(k); }
  std::size_t components() const { return formula_.components(); }
  Formula const& formula() const { return formula_; }

 private:
  Formula formula_;
  std::vector<int> offsets_;  // of the inputs that stand in it
  std::vector<double> values_;
};

/// A formula for many particles together (CollectiveFormula), with the places of its inputs in a row.
class ParticlesFormula {
 public:
  /// FormulaError, with the place, if the text is none.
  ParticlesFormula(std::string_view text, ParticleNames const& names);

  /// Of these particles, given by their rows.
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
