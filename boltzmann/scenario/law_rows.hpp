// Law rows: the memory layouts that each law of a scenario runs on, so that a law is compiled once per layout and not
// once per class. Types only: kernel units and ordinary units both read it. Private to this room.
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

/// Newton particles in rows of 8 numbers in 1D and 12 in 3D (in 2D plain Newton rows have 8 and room for 3 more).
template <int D, class Real = double>
struct LongNewton : Newton<D, Real> {
  Vector<2, Real> more;
};

template <int D, class Real = double>
struct LongKepler : Kepler<D, Real> {
  Vector<2, Real> more;
};

/// Q acts on P.
template <class P, class Q>
struct On {};

/// A list of classes, or of pairs of them.
template <class... P>
struct Layouts {};

/// What a law runs on: pairs, fixed connections, something from outside.
template <class Pairs, class Connections = Layouts<>, class Externals = Layouts<>>
struct LawRows {};

/// A short layout (Newton, Kepler) and its long one, within each dimension.
template <class S1, class L1, class S2, class S3, class L3>
using ShortAndLong = LawRows<Layouts<On<S1, S1>, On<S1, L1>, On<L1, S1>, On<L1, L1>,  //
                                     On<S2, S2>,                                      //
                                     On<S3, S3>, On<S3, L3>, On<L3, S3>, On<L3, L3>>,
                             Layouts<S1, L1, S2, S3, L3>>;

/// An external law.
template <class... P>
using Outside = LawRows<Layouts<>, Layouts<>, Layouts<P...>>;

/// Every classical particle.
using NewtonRows = ShortAndLong<Newton<1>, LongNewton<1>, Newton<2>, Newton<3>, LongNewton<3>>;
using OnNewton = Outside<Newton<1>, LongNewton<1>, Newton<2>, Newton<3>, LongNewton<3>>;
template <int D>
using OnNewtonIn = std::conditional_t<D == 2, Outside<Newton<D>>, Outside<Newton<D>, LongNewton<D>>>;

using KeplerRows = ShortAndLong<Kepler<1>, LongKepler<1>, Kepler<2>, Kepler<3>, LongKepler<3>>;
using CoulombRows = LawRows<Layouts<On<Coulomb<1>, Coulomb<1>>, On<Coulomb<2>, Coulomb<2>>, On<Coulomb<3>, Coulomb<3>>>,
                            Layouts<Coulomb<1>, Coulomb<2>, Coulomb<3>>>;
template <int D>
using OnCoulombIn = Outside<Coulomb<D>>;
using PendulumRows = LawRows<Layouts<On<Pendulum<1>, Pendulum<1>>>, Layouts<Pendulum<1>>>;
using OnPendulum = Outside<Pendulum<1>>;
using OnTethered = Outside<Tethered<1>, Tethered<2>, Tethered<3>>;

/// Vortices carry each other and test particles.
using VortexRows = LawRows<Layouts<On<Vortex<2>, Vortex<2>>, On<Vortex<2>, Viscous<2>>, On<Viscous<2>, Vortex<2>>,
                                   On<Viscous<2>, Viscous<2>>, On<Euler<2>, Vortex<2>>, On<Euler<2>, Viscous<2>>,  //
                                   On<Inviscid<3>, Vortex<3>>, On<Vortex<3>, Vortex<3>>, On<Euler<3>, Vortex<3>>>,
                           Layouts<Vortex<2>, Viscous<2>, Inviscid<3>, Vortex<3>>>;
template <int D>
using OnFlowIn = std::conditional_t<
    D == 1, Outside<Euler<1>>,
    std::conditional_t<D == 2, Outside<Euler<2>, Viscous<2>>, Outside<Euler<3>, Vortex<3>, Inviscid<3>>>>;

/// Smooth particles, of fluids and of solids.
using OnSmooth = Outside<Smooth<1>, Smooth<2>, Smooth<3>, Solid<1>, Solid<2>, Solid<3>>;
template <int D>
using OnSmoothIn = Outside<Smooth<D>, Solid<D>>;

/// The classical particle in any class that derives from it.
template <int D, class Real>
[[gnu::always_inline]] inline Newton<D, Real> const& newton_in(Newton<D, Real> const& particle) {
  return particle;
}

/// A law that sees two classical particles of one type, whatever rows they come from.
template <class Law>
struct BetweenNewton : Law {
  template <class P, class Q>
  auto operator()(P const& p, Q const& q) const {
    return Law::operator()(newton_in(p), newton_in(q));
  }
};

/// Kernels of a law for the layouts of its rows, in their order.
struct LawKernels {
  PairKernels const* pairs;
  PairKernels const* connections;
  ExternalKernels const* externals;
};

/// Kernel units define it for the laws of scenarios (law_kernels.hpp), once for each instruction set.
template <InstructionSet set, class Law, class Rows>
LawKernels law_kernels();

}  // namespace boltzmann
