// Reads masses, densities and ranges of smooth particles.
#include <boltzmann/scenario/field_values.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/scenario/smooth_fields.hpp>

#include <fmt/format.h>

#include <cmath>

namespace boltzmann {

void refuse_found(Section& section, ParticleClass const& kind, Reading& reading) {
  if (kind.matter == Matter::none) return;
  for (char const* key : {"pressure", "temperature", "sound_speed"}) {
    if (section.has(key))
      reading.mistake(section.place(key),
                      fmt::format("{}: the material finds it from density and specific_energy; give "
                                  "'specific_energy', e.g. by a formula",
                                  key));
    section.mark_used(key);
  }
}

std::vector<std::string> unknown_fields(Section const& section, ParticleClass const& kind) {
  std::vector<std::string> unknown;
  for (auto const& field : fields_of(kind, 0))
    if (is_found(kind, field.name) ||
        (kind.matter != Matter::none && field.name == "density" && !gives(section, "density")))
      unknown.push_back(field.name);
  return unknown;
}

void check_smooth(Section& section, std::optional<double> volume, bool loadable, Reading& reading) {
  bool const density = gives(section, "density"), mass = gives(section, "mass");
  if (reading.smooth.from_continuity && !density)
    reading.mistake(section.place(),
                    "density = \"continuity\" in [smooth] needs densities at the start; add e.g. "
                    "density = 1");
  if (density && mass && reading.smooth.wanted && !reading.smooth.from_continuity)
    reading.mistake(
        section.place(section.has("density") ? "density" : "formulas"),
        "density: it is the sum over the masses around a particle, and there is a 'mass' already; leave one "
        "out");
  if (!loadable) return;
  if (density && !mass && !volume)
    reading.mistake(section.place(section.has("density") ? "density" : "formulas"),
                    "density: masses follow from it only where particles are loaded by \"fill\" or \"block\", so that "
                    "each has its volume; give 'mass'");
  if (!gives(section, "range") && !(reading.smooth.variable && volume))
    reading.mistake(
        section.place(),
        fmt::format("smooth particles need a 'range', {}; add e.g. range = 3",
                    reading.smooth.variable ? "from which variable_range starts"
                                            : "the distance over which each is spread: about 3 times their spacing"));
}

void set_ranges(AnyEnsemble& particles, double volume, double spacings) {
  int const offset = particles.field("range").offset;
  double const range = spacings * std::pow(volume, 1.0 / particles.dimension());
  for (std::size_t i = 0; i < particles.size(); ++i) particles.row(i)[offset] = range;
}

void set_masses(AnyEnsemble& particles, double volume, std::vector<std::uint32_t> const& which) {
  int const mass = particles.field("mass").offset, density = particles.field("density").offset;
  for (auto const i : which) particles.row(i)[mass] = particles.row(i)[density] * volume;
}

}  // namespace boltzmann
