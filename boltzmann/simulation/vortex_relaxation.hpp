// Vortex relaxation: turns the vorticity of vortices in 3D towards the curl of their velocity, which is free of
// divergence.
//
//   simulation.adapt(5, VortexRelaxation(scheme, {.fraction = 0.3}));
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/schemes/scheme.hpp>
#include <boltzmann/schemes/vortices/vortex_source.hpp>
#include <boltzmann/simulation/keeps_numbers.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace boltzmann {

class MultipoleScheme;

/// alpha becomes (1 - fraction) alpha + fraction |alpha| c / |c|, c the curl of the velocity at the element (G. Pedrizzetti,
/// Fluid Dyn. Res. 10, 101 (1992), with fraction = f dt).
struct Relaxing {
  double fraction = 0.3;  ///< per change
  bool corrected = true;  ///< rescales alpha to its old length, which otherwise decreases where it turns
};

class VortexRelaxation final : public Adaptation, public KeepsNumbers {
 public:
  /// Acts on the Inviscid and Viscous vortices of this scheme, or of all these schemes, which must outlive it. The curl
  /// is computed by pairs, or by multipoles for vortices in a multipole scheme. Error if there are none, if space has
  /// not 3 dimensions, or unless 0 < fraction <= 1.
  VortexRelaxation(Scheme& scheme, Relaxing const& relaxing);
  VortexRelaxation(std::vector<Scheme*> schemes, Relaxing const& relaxing);
  ~VortexRelaxation() override;
  VortexRelaxation(VortexRelaxation&&) noexcept;

  void change() override;
  std::string report(UnitSystem const& base) const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  /// The change of vorticity in the last relaxation: the square root of sum |change|^2 / sum |alpha|^2 for a fraction
  /// of 1 without correction; 0 if the vorticity is free of divergence.
  double misfit() const { return misfit_; }

 private:
  std::vector<double> slopes();

  std::vector<Scheme*> schemes_;
  Relaxing relaxing_;
  std::vector<VortexSource> sources_;
  std::unique_ptr<MultipoleScheme> multipoles_;
  double times_ = 0, misfit_ = 0, first_ = 0;
};

/// [relaxation] of a scenario.
struct RelaxationOptions {
  std::int64_t every = 1;
  Relaxing relaxing;
};
OptionTable const& relaxation_options();

}  // namespace boltzmann
