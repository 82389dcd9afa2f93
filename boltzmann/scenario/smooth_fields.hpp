// Smooth fields: masses, densities and ranges of smooth particles, which follow from each other. Private to this room.
#pragma once

#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/scenario/classes.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

struct Reading;
class Section;

/// Says of fields that follow from others that they do.
void refuse_found(Section& section, ParticleClass const& kind, Reading& reading);
/// Fields that formulas can't use, because only the scheme finds them.
std::vector<std::string> unknown_fields(Section const& section, ParticleClass const& kind);
/// Whether there are ranges, masses and densities. `volume` is the space that each particle has.
void check_smooth(Section& section, std::optional<double> volume, bool loadable, Reading& reading);
/// A range to start with, where ranges are found.
void set_ranges(AnyEnsemble& particles, double volume, double spacings);
/// mass = density times volume.
void set_masses(AnyEnsemble& particles, double volume, std::vector<std::uint32_t> const& which);

}  // namespace boltzmann
