// Panel: a piece of the outline of a solid body in a flow. It experiences the flow, but does not move.
#pragma once

#include <boltzmann/particles/tracer.hpp>

namespace boltzmann {

/// A panel of a body; its position is its middle. Its influence is the velocity of the flow there without the body.
/// PanelScheme computes from it the vortex sheet that represents the body.
template <int D, class Real = double>
struct Panel : Tracer<D, Real> {
  static_assert(D == 2, "panels are lines: bodies of panels stand in 2D");
  static constexpr char const* class_name = "Panel";
  static constexpr bool stays = true;

  Vector<D, Real> normal;
  Real length;
  Real sheet;
  Real flux;

  static void equations(auto const&, auto const&, auto const&) {}

  static FieldTable fields() {
    return Tracer<D, Real>::fields()
        .add(&Panel::normal, "normal", dimensions::none, "unit vector out of the body")
        .add(&Panel::length, "length", dimensions::length, "of the panel")
        .add(&Panel::sheet, "sheet", dimensions::velocity,
             "strength of the vortex sheet: how fast the fluid slips along the panel, counterclockwise")
        .add(&Panel::flux, "flux", dimensions::velocity / dimensions::time,
             "vorticity that has entered the fluid, per length and time, where it does not slip");
  }
};

}  // namespace boltzmann
