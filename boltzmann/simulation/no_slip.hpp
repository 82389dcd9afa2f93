// NoSlip: fluid sticks to bodies, so that their walls generate vorticity.
#pragma once

#include <boltzmann/schemes/panels/panel_scheme.hpp>
#include <boltzmann/simulation/adaptation.hpp>

#include <cstddef>
#include <vector>

namespace boltzmann {

/// After every step the vortex sheet that makes the flow vanish at the wall enters the fluid (M. J. Lighthill, in
/// Laminar Boundary Layers, Oxford 1963, section II.1.7; A. J. Chorin, J. Fluid Mech. 57, 785 (1973)). Each panel sheds
/// a vortex with its circulation at a distance of 4/3 sqrt(nu t / pi), the mean distance to which a constant flux from
/// the wall has spread. So circulation is conserved exactly. It spreads further by the vortices' own viscosity, to
/// existing neighbours: remeshing merges shed vortices with these, and keeps vortices out of bodies.
class NoSlip final : public Adaptation {
 public:
  /// The sheets of these bodies, by number, enter this ensemble, whose first particle defines the viscosity and the
  /// core. Changes are `interval` of time apart. Scheme and ensemble must outlive it. Error if the ensemble has no
  /// viscosity or no particle, or the bodies' sheet does not carry it.
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
