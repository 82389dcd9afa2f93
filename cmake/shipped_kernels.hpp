// Kernels of shipped laws for shipped classes, as many of the tests use them: they are compiled once
// (shipped_kernels.cpp), with full optimisation, and not in every unit again. Precompiled headers of tests have this.
#pragma once

#include <boltzmann/boltzmann.hpp>

#ifndef SHIPPED_KERNELS
#define SHIPPED_KERNELS extern template
#endif

// The last argument is the law, which may have commas.
#define SHIPPED_PASS(traversal, pass, ...)                                                                    \
  SHIPPED_KERNELS void traversal<Pass::pass, native_width<double>, __VA_ARGS__>(void const*, PairTask const&, \
                                                                                std::size_t, std::size_t)
#define SHIPPED_BETWEEN(...)                        \
  SHIPPED_PASS(over_list, influence, __VA_ARGS__);  \
  SHIPPED_PASS(over_list, reversible, __VA_ARGS__); \
  SHIPPED_PASS(over_list, measure, __VA_ARGS__);    \
  SHIPPED_PASS(over_all, influence, __VA_ARGS__);   \
  SHIPPED_PASS(over_all, measure, __VA_ARGS__)
#define SHIPPED_AMONG(P, ...)                                                                                      \
  SHIPPED_BETWEEN(P, P, __VA_ARGS__);                                                                              \
  SHIPPED_KERNELS void over_small<native_width<double>, P, __VA_ARGS__>(void const*, PairTask const&, std::size_t, \
                                                                        std::size_t)
#define SHIPPED_CONNECTIONS(...)                          \
  SHIPPED_PASS(over_connections, influence, __VA_ARGS__); \
  SHIPPED_PASS(over_connections, measure, __VA_ARGS__)
#define SHIPPED_TUPLES(...)                                                                                 \
  SHIPPED_KERNELS void over_tuples<false, native_width<double>, __VA_ARGS__>(void const*, TupleTask const&, \
                                                                             std::size_t, std::size_t);     \
  SHIPPED_KERNELS void over_tuples<true, native_width<double>, __VA_ARGS__>(void const*, TupleTask const&,  \
                                                                            std::size_t, std::size_t)

namespace boltzmann::detail {

SHIPPED_AMONG(Newton<1>, LennardJones);
SHIPPED_AMONG(Newton<2>, LennardJones);
SHIPPED_AMONG(Newton<3>, LennardJones);
SHIPPED_AMONG(Newton<2>, Soft);
SHIPPED_AMONG(Newton<3>, Soft);
SHIPPED_AMONG(Meso<2>, Rydberg);
SHIPPED_AMONG(Meso<3>, Rydberg);
SHIPPED_AMONG(Kepler<2>, LaplaceLaw);
SHIPPED_AMONG(Kepler<3>, LaplaceLaw);
SHIPPED_AMONG(Coulomb<2>, LaplaceLaw);
SHIPPED_AMONG(Coulomb<3>, LaplaceLaw);
SHIPPED_AMONG(Pendulum<1>, PendulumCoupling);
SHIPPED_AMONG(Vortex<2>, BiotSavart);
SHIPPED_AMONG(Vortex<2>, AlgebraicBiotSavart);
SHIPPED_AMONG(Vortex<2>, GaussianBiotSavart);
SHIPPED_AMONG(Diffusive<2>, GaussianBiotSavart);
SHIPPED_AMONG(Inviscid<3>, BiotSavart);
SHIPPED_AMONG(Inviscid<3>, AlgebraicBiotSavart);
SHIPPED_AMONG(Inviscid<3>, GaussianBiotSavart);
SHIPPED_BETWEEN(Tracer<2>, Vortex<2>, Declared<BiotSavart, Symmetry::one_way>);
SHIPPED_BETWEEN(Panel<2>, Vortex<2>, Declared<BiotSavart, Symmetry::one_way>);
SHIPPED_AMONG(Diffusive<2>, VorticityExchange);
SHIPPED_AMONG(Diffusive<3>, VorticityExchange);
SHIPPED_CONNECTIONS(Newton<2>, Spring);
SHIPPED_CONNECTIONS(Newton<3>, Spring);
SHIPPED_TUPLES(AngleOf<2>, HarmonicAngle);
SHIPPED_TUPLES(AngleOf<3>, HarmonicAngle);
SHIPPED_TUPLES(DihedralOf, FourierDihedral);

}  // namespace boltzmann::detail

#undef SHIPPED_KERNELS
#undef SHIPPED_PASS
#undef SHIPPED_BETWEEN
#undef SHIPPED_AMONG
#undef SHIPPED_CONNECTIONS
#undef SHIPPED_TUPLES
