// Atom points: the data of atoms with many-body forces that passes over pairs read, independent of class and ensemble.
// The members after the position are filled between the passes.
#pragma once

#include <boltzmann/particles/particle.hpp>

namespace boltzmann {

/// An embedded atom: in 3D one block of four numbers.
template <int D, class Real = double>
struct EmbeddedPoint : Particle<D, Real> {
  static constexpr char const* class_name = "embedded atom";
  Real slope;  ///< dF/d(density)
};

/// An atom of an alloy, with its element.
template <int D, class Real = double>
struct AlloyPoint : Particle<D, Real> {
  static constexpr char const* class_name = "atom of an alloy";
  Real element;  ///< number of the element
  Real slope;    ///< dF/d(density)
};

/// An atom with bonds, each with a weight g and a direction u.
template <int D, class Real = double>
struct BondedPoint : Particle<D, Real> {
  static constexpr char const* class_name = "atom with bonds";
  Real weight;                   ///< sum g
  Vector<D, Real> lean;          ///< sum g u
  Real spread[D * (D + 1) / 2];  ///< sum g u u: xx, xy, xz, yy, yz, zz
};

}  // namespace boltzmann
