// Field formulas: formulas of a scenario and the particles for which they are evaluated. Private to this module.
#pragma once

#include <boltzmann/laws/formula_law.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/particle_formula.hpp>
#include <boltzmann/scenario/document.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

struct Reading;
class Section;

/// The names available in formulas for particles with these fields, in the scenario's units.
ParticleNames formula_names(std::vector<Field> const& fields, int dimension, Reading const& reading);
/// The names available for a place in space.
ParticleNames formula_names(int dimension, Reading const& reading);

/// Adds a mistake at the column of an item where its formula is wrong.
void formula_mistake(Item const& item, std::string_view key, FormulaError const& error, Reading& reading);

/// Parses the formula of an item; adds a mistake at the column of an error. `unknown` are fields that have no values
/// yet.
std::optional<ParticleFormula> read_formula(Item const& item, std::string_view key, ParticleNames const& names,
                                            std::vector<std::string> const& unknown, Reading& reading);

/// A field given by formulas, one for each component, or one with a vector value.
struct FieldFormula {
  Field field;
  std::vector<ParticleFormula> components;
  Place place;
};
/// Reads formulas = { specific_energy = "...", velocity = ["...", "..."] } for these fields.
std::vector<FieldFormula> read_formulas(Section& section, std::vector<Field> const& fields, bool with_position,
                                        std::vector<std::string> const& unknown, Reading& reading);
/// Evaluates the formulas for the particles. Adds a mistake, with the particle, if a value is not finite.
bool apply(FieldFormula const& formula, AnyEnsemble& particles, std::vector<std::uint32_t> const& which,
           Reading& reading);

}  // namespace boltzmann
