// Field values: fields of particles as a scenario gives them, one value for all, one for each, or one for each of a
// molecule. Private to this room.
#pragma once

#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/scenario/classes.hpp>
#include <boltzmann/scenario/document.hpp>

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace boltzmann {

struct Reading;
class Section;

/// The value of a field for all particles, or one for each; of fewer, all are meant again and again.
struct FieldValue {
  Field field;
  bool each;
  std::vector<double> values;  ///< field.components numbers, or that many for each particle
};

/// The fields that the class has in this space (of its first variant if the space is not known).
std::vector<Field> fields_of(ParticleClass const& kind, int dimension);
/// The fields that a scenario can give: all but those that is_found().
std::vector<Field> given_fields(ParticleClass const& kind, int dimension);
/// Fields that follow from others: of smooth particles, and the temperature of an internal energy.
bool is_found(ParticleClass const& kind, std::string_view field);

/// Reads the fields that stand in a table, for `count` particles (0: not known); as many values as `molecule` (0: there are
/// none) hold for each molecule. The position is not one of them in an
/// ensemble's own table.
std::vector<FieldValue> read_fields(Section& section, std::vector<Field> const& fields, bool with_position,
                                    std::size_t count, Reading& reading, std::size_t molecule = 0);
/// A mistake for masses, and for densities and ranges of smooth particles, that are not positive.
void check_positive(Section const& section, std::vector<FieldValue> const& values, ParticleClass const& kind,
                    Reading& reading);
/// Whether a table gives a field, as a value or by a formula.
bool gives(Section const& section, std::string_view field);

void apply(FieldValue const& value, AnyEnsemble& particles, std::vector<std::uint32_t> const& which);

}  // namespace boltzmann
