// OutsideBodies: moves particles out of bodies that they have entered during a step, as a finite step may cause near a
// wall.
#pragma once

#include <boltzmann/schemes/panels/panel_scheme.hpp>
#include <boltzmann/simulation/keeps_numbers.hpp>

#include <cstddef>

namespace boltzmann {

/// Each particle that the bodies' sheet carries and that is inside a body is mirrored at the nearest point of the
/// outline. Vortices keep their vorticity, but represent no volume there: remeshing moves such vorticity to nodes that
/// a wall cuts off, where there is no fluid.
class OutsideBodies final : public Adaptation, public KeepsNumbers {
 public:
  /// The scheme must outlive it.
  explicit OutsideBodies(PanelScheme& bodies) : bodies_(&bodies) {}

  void change() override;
  std::string report(UnitSystem const& units) const override;
  std::vector<double> state() const override { return {static_cast<double>(put_back_)}; }
  void restore(std::span<double const> state) override;

 private:
  PanelScheme* bodies_;
  std::size_t put_back_ = 0;
};

/// Error if a particle that the sheet carries is inside a body.
void check_outside(PanelScheme const& bodies);

}  // namespace boltzmann
