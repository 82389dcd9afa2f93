// Law binding: kernels of a law for the memory layouts that particle classes have, so that a law is compiled once per
// layout and not once per class. Private to this room.
#pragma once

#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boltzmann {

using LayoutTest = bool (*)(AnyEnsemble const&);

struct PairChoice {
  LayoutTest target, source;
  PairKernels kernels;
};
struct ConnectionChoice {
  LayoutTest ensemble;
  PairKernels kernels;
};
struct ExternalChoice {
  LayoutTest ensemble;
  ExternalKernels kernels;
};

/// A law with its parameters, and the kernels that can run it.
struct BoundLaw {
  PairScheme::LawPointer law;
  PairScheme::LawTraits traits;
  bool one_way = false;  ///< the law acts on its first particle only
  std::vector<PairChoice> pairs;
  std::vector<ConnectionChoice> connections;
  std::vector<ExternalChoice> externals;
};

/// True if rows of the ensemble can be read as rows of P: same distance from row to row, and every field of P is there
/// under its name, with its dimension, at the same offset. A law that needs P then runs on the ensemble's class,
/// whatever else that has.
template <class P>
bool has_rows(AnyEnsemble const& ensemble) {
  if (ensemble.dimension() != P::dimension || ensemble.stride() != row_stride<P>) return false;
  for (auto const& wanted : P::template fields<P>().fields) {
    Field const* field = ensemble.find_field(wanted.name);
    if (!field || field->offset != wanted.offset || field->components != wanted.components ||
        field->dimension != wanted.dimension)
      return false;
  }
  return true;
}
/// The same, and influences are those of P.
template <class P>
bool has_layout(AnyEnsemble const& ensemble) {
  return has_rows<P>(ensemble) && ensemble.influence_size() == sizeof(typename P::Influence) / sizeof(double);
}

/// Newton particles in rows of 8 numbers in 1D and 12 in 3D (in 2D plain Newton rows have 8 and room for 3 more).
template <int D, class Real = double>
struct LongNewton : Newton<D, Real> {
  Vector<2, Real> more;
};

template <int D, class Real = double>
struct LongKepler : Kepler<D, Real> {
  Vector<2, Real> more;
};

/// A list of classes.
template <class... P>
struct Layouts {};

/// The rows that classical particles of the shipped classes have.
template <int D>
struct NewtonLayouts;
template <>
struct NewtonLayouts<1> {
  using type = Layouts<Newton<1>, LongNewton<1>>;
};
template <>
struct NewtonLayouts<2> {
  using type = Layouts<Newton<2>>;
};
template <>
struct NewtonLayouts<3> {
  using type = Layouts<Newton<3>, LongNewton<3>>;
};

template <class Law>
BoundLaw bind_law(Law const& law) {
  return {PairScheme::keep(law), PairScheme::traits_of(law), symmetry_of<Law>() == Symmetry::one_way, {}, {}, {}};
}

/// The parameters of a law in the simulation's base.
struct LawValues {
  int dimension;
  std::vector<std::pair<std::string, std::vector<double>>> values;

  std::vector<double> const& vector(std::string_view name) const {
    for (auto const& [key, value] : values)
      if (key == name) return value;
    throw Error("a law asks for a parameter '" + std::string(name) + "' that its catalogue entry does not have");
  }
  double operator()(std::string_view name) const { return vector(name).front(); }
  template <int D>
  Vector<D> as_vector(std::string_view name) const {
    Vector<D> result{};
    for (int a = 0; a < D; ++a) result[static_cast<std::size_t>(a)] = vector(name)[static_cast<std::size_t>(a)];
    return result;
  }
};

/// The word of a law and how it is made. One table per source file, so that they compile side by side.
struct LawBinder {
  std::string_view name;
  BoundLaw (*bind)(LawValues const& values);
};
namespace detail {
std::vector<LawBinder> well_laws();
std::vector<LawBinder> bond_laws();
std::vector<LawBinder> laplace_laws();
std::vector<LawBinder> flow_laws();
std::vector<LawBinder> external_laws();
std::vector<LawBinder> pendulum_laws();
}  // namespace detail

/// Kernels between every two of the layouts.
template <class Law, class... P>
void bind_pairs(BoundLaw& bound, Layouts<P...> layouts) {
  (bind_sources<Law, P>(bound, layouts), ...);
}
template <class Law, class P, class... Q>
void bind_sources(BoundLaw& bound, Layouts<Q...>) {
  (bound.pairs.push_back({has_layout<P>, has_rows<Q>, near_kernels<P, Q, Law>()}), ...);
}
/// Kernels of targets by sources.
template <class Law, class... P, class Sources>
void bind_pairs(BoundLaw& bound, Layouts<P...>, Sources sources) {
  (bind_sources<Law, P>(bound, sources), ...);
}
template <class Law, class... P>
void bind_connections(BoundLaw& bound, Layouts<P...>) {
  (bound.connections.push_back({has_layout<P>, connection_kernels<P, Law>()}), ...);
}
template <class Law, class... P>
void bind_externals(BoundLaw& bound, Layouts<P...>) {
  (bound.externals.push_back({has_layout<P>, external_kernels<P, Law>()}), ...);
}

/// The classical particle in any class that derives from it.
template <int D, class Real>
Newton<D, Real> const& newton_in(Newton<D, Real> const& particle) {
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

/// A law between classical particles, and over connections, in one, two and three dimensions.
template <class PlainLaw>
BoundLaw bind_between_newton(PlainLaw const& plain) {
  using Law = BetweenNewton<PlainLaw>;
  BoundLaw bound = bind_law(Law{plain});
  bind_pairs<Law>(bound, NewtonLayouts<1>::type{});
  bind_pairs<Law>(bound, NewtonLayouts<2>::type{});
  bind_pairs<Law>(bound, NewtonLayouts<3>::type{});
  bind_connections<Law>(bound, NewtonLayouts<1>::type{});
  bind_connections<Law>(bound, NewtonLayouts<2>::type{});
  bind_connections<Law>(bound, NewtonLayouts<3>::type{});
  return bound;
}

/// An external law on classical particles.
template <class Law>
void bind_on_newton(BoundLaw& bound) {
  bind_externals<Law>(bound, NewtonLayouts<1>::type{});
  bind_externals<Law>(bound, NewtonLayouts<2>::type{});
  bind_externals<Law>(bound, NewtonLayouts<3>::type{});
}

}  // namespace boltzmann
