// Laplace, Coulomb, Kepler: classical particles whose influence is the Green's function of the Laplacian (section 3.5).
#pragma once

#include <boltzmann/particles/newton.hpp>

namespace boltzmann {

/// A particle with a strength: its field obeys div E = C strength. A derived class defines the strength by
/// `strength()`, and whether equal strengths repel (sign +1) or attract (-1). Mesh and multipole schemes use nothing
/// else.
template <int D, class Real = double>
struct Laplace : Newton<D, Real> {
  static constexpr char const* class_name = "Laplace";
};

/// A charged particle: strength = charge; like charges repel (section 3.5.1).
template <int D, class Real = double>
struct Coulomb : Laplace<D, Real> {
  static constexpr char const* class_name = "Coulomb";
  static constexpr double sign = 1;

  Real charge;

  Real strength() const { return charge; }

  static FieldTable fields() {
    return Laplace<D, Real>::fields().add(&Coulomb::charge, "charge", dimensions::charge, "electric charge");
  }
};

/// A gravitating particle: strength = mass (the constant G belongs to the law); masses attract (section 3.5.2, whose
/// listing has the opposite sign).
template <int D, class Real = double>
struct Kepler : Laplace<D, Real> {
  static constexpr char const* class_name = "Kepler";
  static constexpr double sign = -1;

  Real strength() const { return this->mass; }
};

}  // namespace boltzmann
