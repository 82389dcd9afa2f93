// The class of the hierarchy that defines how a particle moves: code compiled for it serves all classes that derive
// from it.
#pragma once

#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/tracer.hpp>
#include <boltzmann/particles/vortex.hpp>

#include <type_traits>

namespace boltzmann {
namespace detail {

struct AnyRate {
  template <class Member, class Derivative>
  void operator()(Member, Derivative const&) const {}
};

template <class P>
inline constexpr bool depends_on_velocity = [] {
  if constexpr (requires { P::velocity_dependent; })
    return static_cast<bool>(P::velocity_dependent);
  else
    return false;
}();

/// Classes with a viscosity walk at random, unless they define `static constexpr bool random_walk = false`.
template <class P>
inline constexpr bool walks_at_random = [] {
  if constexpr (requires { P::random_walk; })
    return static_cast<bool>(P::random_walk);
  else
    return requires(P p) { p.viscosity; };
}();

/// True if P moves by the equations of its base class B alone: it inherits them, so it has the very same function.
template <class B, class P>
consteval bool moves_as() {
  using Influence = typename B::Influence;
  if constexpr (std::is_base_of_v<B, P> && std::is_same_v<typename P::Influence, Influence> &&
                depends_on_velocity<P> == depends_on_velocity<B> && !walks_at_random<P> &&
                requires { &P::template equations<P, Influence, AnyRate>; })
    return &P::template equations<P, Influence, AnyRate> == &B::template equations<P, Influence, AnyRate>;
  else
    return false;
}

/// The first of these that P moves as; else P itself.
template <class P, class... B>
struct FirstMotion {
  using type = P;
};
template <class P, class B, class... More>
struct FirstMotion<P, B, More...> {
  using type = typename std::conditional_t<moves_as<B, P>(), std::type_identity<B>, FirstMotion<P, More...>>::type;
};

/// The classes whose motion others inherit; for vortices also those in 3D that are stretched, and in 2D those that
/// exchange vorticity.
template <class P, int D = P::dimension>
struct Motions : FirstMotion<P, Newton<D>, Tracer<D>> {};
template <class P>
struct Motions<P, 2> : FirstMotion<P, Newton<2>, Tracer<2>, Diffusive<2>> {};
template <class P>
struct Motions<P, 3> : FirstMotion<P, Newton<3>, Tracer<3>, Inviscid<3>> {};

/// Newton, Tracer or a vortex, if P moves like them; else P itself.
template <class P>
using MovesAs = typename Motions<P>::type;

}  // namespace detail
}  // namespace boltzmann
