// Vortex relaxation: turns the vorticity of vortices in 3D towards the curl of their velocity, which has no divergence.
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
  double fraction = 0.3;  ///< each time
  bool corrected = true;  ///< and gets the length that alpha had, which else becomes shorter where it turns
};

class VortexRelaxation final : public Adaptation, public KeepsNumbers {
 public:
  /// Of the Inviscid and Viscous that act in this scheme, or in all of these; they must outlive it. The curl is found by
  /// pairs, or by multipoles where a scheme of multipoles has vortices. Error if there are none, if space has not 3
  /// dimensions, or unless 0 < fraction <= 1.
  VortexRelaxation(Scheme& scheme, Relaxing const& relaxing);
  VortexRelaxation(std::vector<Scheme*> schemes, Relaxing const& relaxing);
  ~VortexRelaxation() override;
  VortexRelaxation(VortexRelaxation&&) noexcept;

  void change() override;
  std::string report(UnitSystem const& base) const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  /// How far the vorticity was turned the last time: the square root of sum |change|^2 / sum |alpha|^2 by a fraction of 1
  /// without a correction; 0 where nothing has a divergence.
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
