// Field formulas: formulas of a scenario, with the particles they are evaluated for. Private to this room.
#pragma once

#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/scenario/document.hpp>
#include <boltzmann/scenario/formula.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

struct Reading;
class Section;

/// What may stand in formulas for particles with these fields: x, y, z and r (their distance from the origin), fields
/// ("mass"; in 1D "velocity"), components ("velocity.x", "stress.xy").
class FormulaNames {
 public:
  FormulaNames(std::vector<Field> const& fields, int dimension);
  /// Of a place in space alone: x, y, z, r.
  explicit FormulaNames(int dimension);

  std::vector<std::string> const& names() const { return names_; }
  /// The field behind a name; empty for places.
  std::string const& field(std::size_t name) const { return fields_[name]; }
  /// Takes the values of those that the formula uses out of a row.
  double evaluate(Formula const& formula, double const* row);

 private:
  std::vector<std::string> names_, fields_;
  std::vector<int> offsets_;  // in the row; -1: r
  int dimension_;
  std::vector<double> values_;
};

/// A mistake at the column of an item where its formula is wrong.
void formula_mistake(Item const& item, std::string_view key, FormulaError const& error, Reading& reading);

/// A formula that stands in an item; a mistake at its column if it is none. `unknown` are fields that have no values
/// yet.
std::optional<Formula> read_formula(Item const& item, std::string_view key, FormulaNames const& names,
                                    std::vector<std::string> const& unknown, Reading& reading);

/// A field by formulas, one for each component.
struct FieldFormula {
  Field field;
  std::vector<Formula> components;
  Place place;
};
/// Reads formulas = { specific_energy = "...", velocity = ["...", "..."] }: for these fields.
std::vector<FieldFormula> read_formulas(Section& section, std::vector<Field> const& fields, bool with_position,
                                        std::vector<std::string> const& unknown, Reading& reading);
/// Gives the particles their values. A mistake, with the particle, if one is not finite.
bool apply(FieldFormula const& formula, AnyEnsemble& particles, std::vector<std::uint32_t> const& which,
           Reading& reading);

}  // namespace boltzmann
