// Splitting of vortices whose cores have grown wide, and merging of those that overlap more than necessary.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/options.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/simulation/adaptation.hpp>

#include <cstddef>
#include <cstdint>

namespace boltzmann {

/// Criteria of splitting, and the resulting vortices (L. F. Rossi, SIAM J. Sci. Comput. 17, 370 (1996)).
struct CoreSplitting {
  double above = 0;         ///< wider cores are split,
  double ratio = 0.8;       ///< into narrower ones by this factor: 4 around the old position in 2D, 6 in 3D
  double merge_within = 0;  ///< two of similar direction that are nearer than this part of the narrower core merge,
                            ///< unless the new core would be too wide; 0: no merging

  /// Error if an option is invalid.
  void check() const;
};

struct CoresSplit {
  std::size_t splits = 0, merges = 0;
};

/// Splits once, then merges. A split conserves the vorticity and its first and second moments, with cores as Gaussians
/// of standard deviation `core`: circulation, linear and angular impulse. So does a merger of vortices of one
/// direction. In 2D that means one sign; in 3D they merge within 8 degrees, and the second moment of magnitudes is
/// conserved. The first new vortex keeps the row of the old one, others are appended in the order of their rows; merged
/// ones keep the first row. A field `volume` is divided, and added; other fields are those of the first. The result
/// depends on the particles only; images along periodic axes do not merge. Error for invalid options and missing
/// fields; PhysicsFailure for cores that are not finite.
CoresSplit split_cores(AnyEnsemble& ensemble, CoreSplitting const& splitting);

/// The same during a run.
///   simulation.adapt(5, CoreSplitter(vortices, scheme.box(), {.above = 0.1}));
class CoreSplitter final : public Adaptation {
 public:
  /// The ensemble must outlive it. Error as above, and if a split might be outside the limits of the box: its axes must
  /// be open or periodic, and it must have no regions.
  CoreSplitter(AnyEnsemble& ensemble, Box const& box, CoreSplitting const& splitting);

  void change() override;
  std::string report(UnitSystem const& units) const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  /// Totals so far.
  CoresSplit const& done() const { return done_; }

 private:
  AnyEnsemble* ensemble_;
  CoreSplitting splitting_;
  CoresSplit done_;
};

/// [[split_cores]] of a scenario; the ensemble is read by other code.
struct CoreSplittingOptions {
  std::int64_t every = 1;
  CoreSplitting how;
};
OptionTable const& core_splitting_options();

}  // namespace boltzmann
