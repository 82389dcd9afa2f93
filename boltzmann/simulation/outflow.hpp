// Outflow: vortices and tracers that are far downstream leave the simulation, or join a coarser wake.
//
//   simulation.adapt(1, Outflow(wake, box, {.from = {{10, 0, 0}}, .direction = {{1, 0, 0}}}, {.bodies = &bodies}));
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/options.hpp>
#include <boltzmann/core/vector.hpp>
#include <boltzmann/diagnoses/flow_impulse.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/schemes/panels/panel_scheme.hpp>
#include <boltzmann/simulation/adaptation.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace boltzmann {

/// Particles beyond this plane are removed.
struct OutflowPlane {
  std::optional<std::array<double, 3>> from;       ///< a point on it
  std::optional<std::array<double, 3>> direction;  ///< normal to it, downstream, of any length

  /// Error if this is no plane in a space of this dimension.
  void check(int dimension) const;
  bool beyond(double const* place, int dimension) const;
};

/// The destination of particles that leave, and bodies that they affect. Both may be null, and must outlive the
/// outflow.
struct OutflowInto {
  AnyEnsemble* into = nullptr;          ///< an ensemble of vortices, of any class, to which particles that leave are
                                        ///< added
  PanelScheme const* bodies = nullptr;  ///< their sheets lose a part with the vortices that are removed
};

/// Removes particles beyond the plane; the others keep their order. A removed vortex no longer moves the fluid: in 2D a
/// vortex Gamma at a distance d has moved it at Gamma / (2 pi d). Removed circulation and impulse are recorded. Forces
/// on bodies include them, and the changes of the bodies' sheets (Adaptation::taken): they are the forces of the flow
/// without the removed vortices, and have no jumps. With a destination ensemble nothing is lost: each vortex becomes a
/// particle of that one, with the fields that both classes have; other fields are those of its first particle. Remeshed
/// on a wider lattice it is a cheap far wake.
class Outflow final : public Adaptation {
 public:
  /// The ensemble must outlive it. Error if no flow carries the ensemble, if there is no such plane, or if the
  /// destination has no vortices, is the same ensemble, or is empty.
  Outflow(AnyEnsemble& ensemble, Box const& box, OutflowPlane const& plane, OutflowInto const& to = {});

  void change() override;
  std::string report(UnitSystem const& units) const override;
  FlowImpulse taken() const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  /// The number of removed particles; their vorticity (in 2D the third number) and their impulse over the density.
  std::size_t left() const { return left_; }
  Vector<3> const& vorticity() const { return vorticity_; }
  Vector<3> const& impulse() const { return impulse_; }

 private:
  void leave(double const* row);
  void enter(double const* row);

  AnyEnsemble* ensemble_;
  OutflowPlane plane_;
  OutflowInto to_;
  std::size_t left_ = 0;
  Vector<3> vorticity_{}, impulse_{};
  Vector<2> sheet_impulse_{};
  std::vector<double> normal_velocity_;  // on panels, by removed vortices
};

/// [[outflow]] of a scenario; the ensemble is read by other code.
struct OutflowOptions {
  std::int64_t every = 1;
  OutflowPlane how;
  AnyEnsemble* into = nullptr;  ///< read by other code
};
OptionTable const& outflow_options();

}  // namespace boltzmann
