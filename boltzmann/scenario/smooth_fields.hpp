// Smooth fields: masses, densities and ranges of smooth particles, which follow from each other. Private to this
// module.
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

/// Rejects fields that follow from others.
void refuse_found(Section& section, ParticleClass const& kind, Reading& reading);
/// Fields that formulas can't use, because only the scheme computes them.
std::vector<std::string> unknown_fields(Section const& section, ParticleClass const& kind);
/// Checks ranges, masses and densities. `volume` is the volume per particle.
void check_smooth(Section& section, std::optional<double> volume, bool loadable, Reading& reading);
/// Sets initial ranges, if the scheme adapts them.
void set_ranges(AnyEnsemble& particles, double volume, double spacings);
/// mass = density times volume.
void set_masses(AnyEnsemble& particles, double volume, std::vector<std::uint32_t> const& which);

}  // namespace boltzmann
