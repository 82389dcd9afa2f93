// Particle: the root of the hierarchy; any object with a position.
#pragma once

#include <boltzmann/core/vector.hpp>
#include <boltzmann/particles/field.hpp>

namespace boltzmann {

/// A point that can be influenced. `Real` is double for one particle and a Pack in the inner loops. A class has only
/// members of Real and Vector<D, Real>, so that the same struct serves both. To make your own class, derive from one
/// and add fields. A class may replace:
///   Influence  the type that laws add up for it (a force, a velocity, any struct of Real),
///   equations  the equations of motion: calls rate(&Class::field, derivative) for every field that changes in time,
///   fields     its descriptor table, if its own fields need names in files and diagnoses.
template <int D, class Real = double>
struct Particle {
  static constexpr int dimension = D;
  using Influence = Vector<D, Real>;
  static constexpr char const* class_name = "Particle";

  Vector<D, Real> position;

  /// By default nothing moves a particle.
  static void equations(auto const&, auto const&, auto const&) {}

  static FieldTable fields() {
    return FieldTable{}.add(&Particle::position, "position", dimensions::length, "where the particle is");
  }
};

}  // namespace boltzmann
