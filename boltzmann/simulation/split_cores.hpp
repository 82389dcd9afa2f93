// Splitting of vortices whose cores have grown wide, and merging of those that overlap more than they need.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/options.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/simulation/adaptation.hpp>

#include <cstddef>
#include <cstdint>

namespace boltzmann {

/// Which vortices are split, and into what (L. F. Rossi, SIAM J. Sci. Comput. 17, 370 (1996)).
struct CoreSplitting {
  double above = 0;         ///< cores that are wider are split,
  double ratio = 0.8;       ///< into some that are so much narrower: 4 around the old place in 2D, 6 in 3D
  double merge_within = 0;  ///< two of like direction that are nearer to each other than this part of the narrower core
                            ///< become one, unless its core would be too wide; 0: nothing merges

  /// Error if it can't be done.
  void check() const;
};

struct CoresSplit {
  std::size_t splits = 0, merges = 0;
};

/// Splits once, then merges. A split keeps the vorticity, its first moment, and its second, cores counted as Gaussians of
/// standard deviation `core`: circulation, linear and angular impulse; so does a merger of vortices of one direction (in
/// 2D of one sign; in 3D they are taken as one if they are within 8 degrees, and the second moment is kept of magnitudes).
/// The first of the new ones stays in the row of the old one, others are appended in the order of their rows; of merged
/// ones the first stays. A field `volume` is shared, and added; other fields are those of the first. The result depends on
/// the particles alone; images along periodic axes do not merge. Error for wrong options and missing fields; PhysicsFailure for cores that are not finite.
CoresSplit split_cores(AnyEnsemble& ensemble, CoreSplitting const& splitting);

/// The same while a simulation runs.
///   simulation.adapt(5, CoreSplitter(vortices, scheme.box(), {.above = 0.1}));
class CoreSplitter final : public Adaptation {
 public:
  /// The ensemble must outlive it. Error as above, and if the box has limits within which a split might not find place:
  /// its axes are open or periodic, and it has no regions.
  CoreSplitter(AnyEnsemble& ensemble, Box const& box, CoreSplitting const& splitting);

  void change() override;
  std::string report(UnitSystem const& units) const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  /// Of all times so far.
  CoresSplit const& done() const { return done_; }

 private:
  AnyEnsemble* ensemble_;
  CoreSplitting splitting_;
  CoresSplit done_;
};

/// [[split_cores]] of a scenario; on whom is read by code.
struct CoreSplittingOptions {
  std::int64_t every = 1;
  CoreSplitting how;
};
OptionTable const& core_splitting_options();

}  // namespace boltzmann
