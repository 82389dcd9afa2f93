// Field values: fields of particles in a scenario, one value for all, one per particle, or one per particle of a
// molecule. Private to this module.
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

/// The value of a field for all particles, or one per particle. If there are fewer, they repeat.
struct FieldValue {
  Field field;
  bool each;
  std::vector<double> values;  ///< field.components numbers, or that many per particle
};

/// The fields of the class in this space (of its first variant if the space is unknown).
std::vector<Field> fields_of(ParticleClass const& kind, int dimension);
/// The fields that a scenario can set: all but those for which is_found() is true.
std::vector<Field> given_fields(ParticleClass const& kind, int dimension);
/// Fields derived from others: those of smooth particles, and the temperature of an internal energy.
bool is_found(ParticleClass const& kind, std::string_view field);

/// Reads the fields in a table, for `count` particles (0: unknown). If `molecule` is not 0, that many values are
/// repeated for each molecule. The position is not one of them in an ensemble's own table.
std::vector<FieldValue> read_fields(Section& section, std::vector<Field> const& fields, bool with_position,
                                    std::size_t count, Reading& reading, std::size_t molecule = 0);
/// Adds a mistake for masses, and for densities and ranges of smooth particles, that are not positive.
void check_positive(Section const& section, std::vector<FieldValue> const& values, ParticleClass const& kind,
                    Reading& reading);
/// True if a table sets a field, as a value or by a formula.
bool gives(Section const& section, std::string_view field);

void apply(FieldValue const& value, AnyEnsemble& particles, std::vector<std::uint32_t> const& which);

}  // namespace boltzmann
