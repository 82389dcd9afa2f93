// Outflow: vortices and tracers that the flow has carried far enough leave the simulation, or become part of a coarser
// wake.
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

/// A plane; behind it nobody stays.
struct OutflowPlane {
  std::optional<std::array<double, 3>> from;       ///< a point of it
  std::optional<std::array<double, 3>> direction;  ///< across it, downstream, of any length

  /// Error if there is no such plane in a space of so many axes.
  void check(int dimension) const;
  bool beyond(double const* place, int dimension) const;
};

/// Where what leaves goes to, and what else it concerns; both may be null, and outlive the outflow.
struct OutflowInto {
  AnyEnsemble* into = nullptr;          ///< an ensemble of vortices, of any class, that takes up those who leave
  PanelScheme const* bodies = nullptr;  ///< whose sheets lose a part with those who leave for good
};

/// Removes what is beyond the plane; those who stay keep their order. What has left carries nobody any more: in 2D a
/// vortex Gamma at a distance d has moved the fluid at Gamma / (2 pi d). Circulation and impulse that went are told. Forces
/// on bodies count them, and what the bodies' sheets lose with them (Adaptation::taken): they are those of the flow
/// without the ones that left, and have no jumps. With an ensemble to go into nothing is lost: each becomes a particle of
/// that one, with the fields that both classes have; others are those of its first particle. Remeshed on a wider lattice
/// it is a far wake that costs little.
class Outflow final : public Adaptation {
 public:
  /// The ensemble must outlive it. Error if no flow carries the ensemble, there is no such plane, or an ensemble to go into
  /// is not one of vortices, the same, or empty.
  Outflow(AnyEnsemble& ensemble, Box const& box, OutflowPlane const& plane, OutflowInto const& to = {});

  void change() override;
  std::string report(UnitSystem const& units) const override;
  FlowImpulse taken() const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  /// How many have left; their vorticity (in 2D the third number) and their impulse over the density.
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
  std::vector<double> normal_velocity_;  // on panels, of those who leave
};

/// [[outflow]] of a scenario; on whom is read by code.
struct OutflowOptions {
  std::int64_t every = 1;
  OutflowPlane how;
  AnyEnsemble* into = nullptr;  ///< read by code
};
OptionTable const& outflow_options();

}  // namespace boltzmann
