// NoSlip: fluid sticks to bodies, whose walls therefore make vorticity.
#pragma once

#include <boltzmann/schemes/panels/panel_scheme.hpp>
#include <boltzmann/simulation/adaptation.hpp>

#include <cstddef>
#include <vector>

namespace boltzmann {

/// After every step the sheet that the flow needs to stand still at the wall enters the fluid (M. J. Lighthill, in Laminar
/// Boundary Layers, Oxford 1963, section II.1.7; A. J. Chorin, J. Fluid Mech. 57, 785 (1973)): each panel sheds a vortex
/// with its circulation, as far out as a constant flux from the wall has spread in the mean while it lasted, 4/3 sqrt(nu
/// t / pi). So circulation is kept exactly. It spreads further by the vortices' own viscosity, to neighbours that are there:
/// remeshing merges shed vortices with these, and lets none get into bodies.
class NoSlip final : public Adaptation {
 public:
  /// The sheets of these bodies, by number, enter this ensemble, whose first particle says the viscosity and the core. A
  /// change comes every `interval` of time. Scheme and ensemble must outlive it. Error if the ensemble has no viscosity or
  /// nobody in it, or the bodies' sheet does not carry it.
  NoSlip(PanelScheme& bodies, AnyEnsemble& vortices, std::vector<std::size_t> which, double interval);

  void change() override;
  std::string report(UnitSystem const& units) const override;
  std::vector<double> state() const override { return {shed_}; }
  void restore(std::span<double const> state) override;

 private:
  PanelScheme* bodies_;
  AnyEnsemble* vortices_;
  std::vector<std::size_t> which_;
  double interval_, shed_ = 0;
};

}  // namespace boltzmann
