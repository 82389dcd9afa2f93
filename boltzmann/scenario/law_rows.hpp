// Law rows: the classes for which each law of a scenario is compiled. It runs on every class that has their fields at
// the same offsets of its rows, of any length. Types only, for both kernel units and ordinary units. Private to this
// module.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/pendulum.hpp>
#include <boltzmann/particles/smooth.hpp>
#include <boltzmann/particles/tethered.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/schemes/pair/external_kernels.hpp>
#include <boltzmann/schemes/pair/pair_task.hpp>

namespace boltzmann {

/// Q acts on P.
template <class P, class Q>
struct On {};

/// A list of classes, or of pairs of them.
template <class... P>
struct Layouts {};

/// The rows of a law: for pairs, fixed connections, and external influences.
template <class Pairs, class Connections = Layouts<>, class Externals = Layouts<>>
struct LawRows {};

/// The number of pairs of classes for which a law is compiled.
template <class Rows>
inline constexpr std::size_t pair_layouts = 0;
template <class... Pair, class Connections, class Externals>
inline constexpr std::size_t pair_layouts<LawRows<Layouts<Pair...>, Connections, Externals>> = sizeof...(Pair);

/// A law among particles of each class, and over their connections.
template <class... P>
using Among = LawRows<Layouts<On<P, P>...>, Layouts<P...>>;

/// An external law.
template <class... P>
using Outside = LawRows<Layouts<>, Layouts<>, Layouts<P...>>;

/// Every classical particle.
using NewtonRows = Among<Newton<1>, Newton<2>, Newton<3>>;
using OnNewton = Outside<Newton<1>, Newton<2>, Newton<3>>;
template <int D>
using OnNewtonIn = Outside<Newton<D>>;

using KeplerRows = Among<Kepler<1>, Kepler<2>, Kepler<3>>;
using CoulombRows = Among<Coulomb<1>, Coulomb<2>, Coulomb<3>>;
template <int D>
using OnCoulombIn = Outside<Coulomb<D>>;
using PendulumRows = Among<Pendulum<1>>;
using OnPendulum = Outside<Pendulum<1>>;
using OnTethered = Outside<Tethered<1>, Tethered<2>, Tethered<3>>;

/// Vortices advect each other and test particles.
using VortexRows = LawRows<Layouts<On<Vortex<2>, Vortex<2>>, On<Tracer<2>, Vortex<2>>, On<Diffusive<2>, Vortex<2>>,  //
                                   On<Inviscid<3>, Vortex<3>>, On<Vortex<3>, Vortex<3>>, On<Tracer<3>, Vortex<3>>>,
                           Layouts<Vortex<2>, Diffusive<2>, Inviscid<3>, Vortex<3>>>;
/// Vortices exchange vorticity.
using ExchangeRows = Among<Diffusive<2>, Diffusive<3>>;
template <int D>
using OnFlowIn = std::conditional_t<D == 3, Outside<Tracer<D>, Inviscid<3>>,
                                    std::conditional_t<D == 2, Outside<Tracer<D>, Diffusive<2>>, Outside<Tracer<D>>>>;
/// Those of them without vortex stretching.
template <int D>
using OnCarriedIn = std::conditional_t<D == 2, OnFlowIn<2>, Outside<Tracer<D>>>;

/// Smooth particles, of fluids and of solids.
using OnSmooth = Outside<Smooth<1>, Smooth<2>, Smooth<3>, Solid<1>, Solid<2>, Solid<3>>;
template <int D>
using OnSmoothIn = Outside<Smooth<D>, Solid<D>>;

/// The rows of a law of a scenario; it runs on all classes that have the required fields.
template <class Law>
struct OfScenario : Law {
  static constexpr bool on_longer_rows = true;
};

/// The law of a shipped one: itself, or the result of its law().
template <class Law>
auto law_of(Law const& law) {
  if constexpr (requires { law.law(); })
    return law.law();
  else
    return law;
}
template <class Law>
using LawOf = decltype(law_of(std::declval<Law const&>()));

/// Kernels of a law for the layouts of its rows, in their order.
struct LawKernels {
  PairKernels const* pairs;
  PairKernels const* connections;
  ExternalKernels const* externals;
};

/// Defined by kernel units for the laws of scenarios (law_kernels.hpp), once per instruction set.
template <InstructionSet set, class Law, class Rows>
LawKernels law_kernels();

}  // namespace boltzmann
