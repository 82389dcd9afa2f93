// Load options: the kinds of loaders that scenarios can name, with their keys.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/loaders/disc_load.hpp>
#include <boltzmann/loaders/lattice.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

/// Members for plain numbers, words and places. Counts, lists of places and formulas are read by code.
struct LoadOptions {
  Lattice lattice = Lattice::square;
  std::optional<double> spacing, number_density, lattice_constant;
  double jitter = 0;  ///< fraction of the spacing
  double minimum_distance = 0;
  std::optional<double> packing_fraction;
  std::string axis = "x", component;
  std::int64_t mode = 0;  ///< 0: the wave number is given
  std::optional<double> wave_number;
  double phase = 0, amplitude = 0;
  bool quiet = false;
  double temperature = 1, acceleration = 0;
  std::int64_t frame = 0;
  std::string path, species, format, units, style, ensemble;
  std::optional<double> length, velocity;
  double mass = 1, radius = 1;
  std::optional<double> G;
  std::optional<std::array<double, 3>> low, high, centre, drift, normal;
  DiscProfile profile = DiscProfile::exponential;
  std::optional<double> edge;
  double central_mass = 0;
  double ripple = 0;
  double circulation = 1, core_radius = 1, overlap = 1.25;
  std::int64_t layers = 4, sections = 0;
};

struct LoadKind {
  std::string name, doc;
  bool counted;  ///< the ensemble sets the number of particles
  OptionTable options;
};
std::vector<LoadKind> const& load_kinds();
/// Options of a wave that is added to velocities: their amplitude and component, and the wave.
OptionTable const& ripple_options();

}  // namespace boltzmann
