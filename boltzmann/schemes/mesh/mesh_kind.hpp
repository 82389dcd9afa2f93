// What a mesh must know of a particle class: its strength, and whether it moves as Newton says.
#pragma once

#include <boltzmann/particles/motion.hpp>
#include <boltzmann/particles/rows.hpp>

#include <concepts>
#include <cstddef>
#include <type_traits>

namespace boltzmann {

/// Classes that a mesh can supervise: classical particles with a strength().
template <class P>
concept MeshParticle = std::is_same_v<typename P::Influence, Vector<P::dimension>> && requires(P const& p) {
  { p.strength() } -> std::convertible_to<double>;
  p.mass;
  p.velocity;
};

struct MeshKind {
  /// strength() of particles begin ... end-1.
  void (*strengths)(double const* rows, std::size_t begin, std::size_t end, double* strengths) = nullptr;
  double sign = 0;             ///< +1: equal strengths repel, -1: they attract, 0: the class does not say
  bool newton = false;         ///< equations of motion are Newton's, and no other field evolves
  int mass = 0, velocity = 0;  ///< where they stand in the row
};

template <class P>
MeshKind mesh_kind() {
  MeshKind kind;
  kind.strengths = [](double const* rows, std::size_t begin, std::size_t end, double* strengths) {
    auto const* particles = reinterpret_cast<Row<P> const*>(rows);
    for (std::size_t i = begin; i < end; ++i) strengths[i] = particles[i].strength();
  };
  if constexpr (requires { P::sign; }) kind.sign = P::sign;
  kind.newton = detail::moves_as<Newton<P::dimension>, P>();
  kind.mass = offset_of<P>(&P::mass);
  kind.velocity = offset_of<P>(&P::velocity);
  return kind;
}

}  // namespace boltzmann
