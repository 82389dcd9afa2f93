// Particles as clouds: from the rows of ensembles to what a canvas draws, in one pass over memory.
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

/// One number of every particle, read where it stands: particle i has first[i stride], or with several components
/// their length. Fields and "speed" stand in the rows; of anything else the numbers are here.
struct ParticleColumn {
  double const* first = nullptr;  ///< null: no particle has a value
  std::size_t stride = 1;
  int components = 1;
  std::vector<double> own = {};

  double operator[](std::size_t i) const;
};

/// The column of a quantity (derived.hpp), valid as long as the ensemble keeps its particles. `potential` as for
/// quantity(). Error for an unknown name.
ParticleColumn column_of(AnyEnsemble const& ensemble, std::string_view name, std::span<double const> potential = {},
                         UnitSystem const* units = nullptr);

/// What is drawn of one ensemble.
struct CloudSource {
  AnyEnsemble const* ensemble;
  Colour colour;
  double diameter = 0;                ///< of all; 0: points
  std::vector<ParticleColumn> place;  ///< 2 or 3: the coordinates
  std::optional<ParticleColumn> value = {};
  std::optional<ParticleColumn> size = {};  ///< the largest of all sources gets its `diameter`; none (NaN): the same
};

/// Memory of clouds that nobody shows any more, for the next ones: what is made many times a second must not be asked
/// of the system, page by page, each time. May be used from several threads.
class CloudMemory {
 public:
  /// An array for so many numbers: one of that length, else one with room for them, else a new one.
  std::vector<float> take(std::size_t count);
  /// Keeps the arrays of a canvas, a few of them.
  void keep(std::vector<Canvas::Cloud> clouds);

 private:
  static constexpr std::size_t most = 12;
  std::mutex mutex_;
  std::vector<std::vector<float>> spare_;
};

struct CloudOptions {
  std::array<double, 3> origin{0, 0, 0}, scale{1, 1, 1};   ///< of the clouds
  double low = std::numeric_limits<double>::quiet_NaN();   ///< the values at the ends of the colours; NaN: the smallest
  double high = std::numeric_limits<double>::quiet_NaN();  ///< and the largest of all particles, drawn or not
  std::size_t most = 0;                            ///< one of every n particles, so that so many are drawn; 0: all
  std::vector<std::array<double, 2>> region = {};  ///< only particles with low <= coordinate <= high; empty: all
  int threads = 1;
  CloudMemory* memory = nullptr;  ///< where arrays come from; null: new ones
};

struct ParticleClouds {
  std::vector<Canvas::Cloud> clouds;  ///< of each source, in order
  std::size_t particles = 0;          ///< that there are
  std::size_t inside = 0;             ///< the region; without one all
  std::size_t shown = 0;
  std::uint32_t stride = 1;            ///< one of so many inside is shown
  std::size_t not_finite = 0;          ///< shown, but nowhere
  std::size_t without_value = 0;       ///< of those shown
  double low = 0, high = 0;            ///< the ends of the colours
  ColourMap map = ColourMap::viridis;  ///< the diverging one, with ends -a and a, for values of both signs or such ends
};

/// The result has the same bits for any number of threads.
ParticleClouds particle_clouds(std::span<CloudSource const> sources, CloudOptions const& options);

/// Of several clouds with many particles, parts turn by turn, so that none hides another.
std::vector<Canvas::Cloud> interleaved(std::vector<Canvas::Cloud> clouds);

}  // namespace boltzmann
