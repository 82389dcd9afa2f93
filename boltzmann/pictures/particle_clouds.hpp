// Particle clouds: converts the rows of ensembles to drawable clouds of a canvas, in one pass over memory.
#pragma once

#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/pictures/canvas.hpp>

#include <array>
#include <cstddef>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace boltzmann {

/// One number of every particle, read in place: particle i has first[i stride], or the length of several components.
/// Fields and "speed" are read from the rows; other quantities are stored here.
struct ParticleColumn {
  double const* first = nullptr;  ///< null: particles have no value
  std::size_t stride = 1;
  int components = 1;
  std::vector<double> own = {};

  double operator[](std::size_t i) const;
};

/// The column of a quantity (derived.hpp), valid as long as the ensemble keeps its particles. `potential` as for
/// quantity(). Throws Error for an unknown name.
ParticleColumn column_of(AnyEnsemble const& ensemble, std::string_view name, std::span<double const> potential = {},
                         UnitSystem const* units = nullptr);

/// The data drawn for one ensemble.
struct CloudSource {
  AnyEnsemble const* ensemble;
  Colour colour;
  double diameter = 0;                ///< of all particles; 0: points
  std::vector<ParticleColumn> place;  ///< 2 or 3: the coordinates
  std::optional<ParticleColumn> value = {};
  std::optional<ParticleColumn> size = {};  ///< the largest value of all sources has the source's `diameter`; none
                                            ///< (NaN): all have it
};

/// A pool of buffers of discarded clouds. It avoids page faults for buffers that are needed many times a second.
/// Thread-safe.
class CloudMemory {
 public:
  /// An array of this size: one of that length if available, else one with sufficient capacity, else a new one.
  std::vector<float> take(std::size_t count);
  /// Recycles the arrays of a canvas, a few of them.
  void keep(std::vector<Canvas::Cloud> clouds);

 private:
  static constexpr std::size_t most = 12;
  std::mutex mutex_;
  std::vector<std::vector<float>> spare_;
};

struct CloudOptions {
  std::array<double, 3> origin{0, 0, 0}, scale{1, 1, 1};   ///< of the clouds
  double low = std::numeric_limits<double>::quiet_NaN();   ///< the values at the ends of the colours; NaN: the smallest
                                                           ///< ...
  double high = std::numeric_limits<double>::quiet_NaN();  ///< ... and the largest of all particles, drawn or not
  std::size_t most = 0;                            ///< only one of every n particles is drawn, to limit their number;
                                                   ///< 0: all
  std::vector<std::array<double, 2>> region = {};  ///< only particles with low <= coordinate <= high; empty: all
  int threads = 1;
  CloudMemory* memory = nullptr;  ///< source of arrays; null: allocate new ones
};

struct ParticleClouds {
  std::vector<Canvas::Cloud> clouds;  ///< per source, in order
  std::size_t particles = 0;          ///< total number
  std::size_t inside = 0;             ///< particles in the region; without a region all
  std::size_t shown = 0;
  std::uint32_t stride = 1;            ///< one of this number of particles inside is shown
  std::size_t not_finite = 0;          ///< shown particles without a finite position
  std::size_t without_value = 0;       ///< shown particles
  double low = 0, high = 0;            ///< the ends of the colours
  ColourMap map = ColourMap::viridis;  ///< diverging with ends -a and a, if values or ends have both signs
};

/// The result has the same bits for any number of threads.
ParticleClouds particle_clouds(std::span<CloudSource const> sources, CloudOptions const& options);

/// Interleaves parts of several clouds with many particles, so that none hides another.
std::vector<Canvas::Cloud> interleaved(std::vector<Canvas::Cloud> clouds);

}  // namespace boltzmann
