// Dye: tracers that record where they were released, so that those of one place form a streakline.
#pragma once

#include <boltzmann/particles/tracer.hpp>

namespace boltzmann {

/// A fluid particle released by a DyeSource. Particles from the initial state have place and release 0, and are on no
/// line.
template <int D, class Real = double>
struct Dye : Tracer<D, Real> {
  static constexpr char const* class_name = "Dye";

  Real place;
  Real release;

  static FieldTable fields() {
    return Tracer<D, Real>::fields()
        .add(&Dye::place, "place", dimensions::none, "number of the place where it was released, 1 for the first")
        .add(&Dye::release, "release", dimensions::none, "of which release it is, 1 for the first");
  }
};

}  // namespace boltzmann
