// Which class of the hierarchy says how a particle moves: what is compiled for that one serves all that derive from it.
#pragma once

#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/tracer.hpp>

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

template <class P>
inline constexpr bool has_viscosity = requires(P p) {
  p.viscosity;
};

/// True if P moves by the equations of its base class B alone: it inherits them, so it has the very same function.
template <class B, class P>
consteval bool moves_as() {
  using Influence = typename B::Influence;
  if constexpr (std::is_base_of_v<B, P> && std::is_same_v<typename P::Influence, Influence> &&
                depends_on_velocity<P> == depends_on_velocity<B> && !has_viscosity<P> &&
                requires { &P::template equations<P, Influence, AnyRate>; })
    return &P::template equations<P, Influence, AnyRate> == &B::template equations<P, Influence, AnyRate>;
  else
    return false;
}

/// Newton or Tracer, if P moves as they do; else P itself.
template <class P>
using MovesAs = std::conditional_t<moves_as<Newton<P::dimension>, P>(), Newton<P::dimension>,
                                   std::conditional_t<moves_as<Tracer<P::dimension>, P>(), Tracer<P::dimension>, P>>;

}  // namespace detail
}  // namespace boltzmann
