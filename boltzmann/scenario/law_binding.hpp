// Law binding: creates a law with its kernels from its name and parameters. Private to this module.
#pragma once

#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/scenario/law_rows.hpp>
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

/// A law with its parameters, and its kernels.
struct BoundLaw {
  PairScheme::LawPointer law;
  PairScheme::LawTraits traits;
  bool one_way = false;  ///< the law acts on its first particle only
  std::vector<PairChoice> pairs;
  std::vector<ConnectionChoice> connections;
  std::vector<ExternalChoice> externals;
};

/// True if rows of the ensemble can be read as rows of P: it has every field of P with the same name, dimension and
/// offset. A law for P then runs on the ensemble's class, whatever its other fields.
template <class P>
bool has_rows(AnyEnsemble const& ensemble) {
  if (ensemble.dimension() != P::dimension) return false;
  for (auto const& wanted : P::fields().fields) {
    Field const* field = ensemble.find_field(wanted.name);
    if (!field || field->offset != wanted.offset || field->components != wanted.components ||
        field->dimension != wanted.dimension)
      return false;
  }
  return true;
}
/// The same, and influences are also those of P.
template <class P>
bool has_layout(AnyEnsemble const& ensemble) {
  return has_rows<P>(ensemble) && ensemble.influence_size() == sizeof(typename P::Influence) / sizeof(double);
}

namespace detail {
template <class Law, class... P, class... Q, class... Connected, class... Outside>
void bind_kernels(BoundLaw& bound, LawRows<Layouts<On<P, Q>...>, Layouts<Connected...>, Layouts<Outside...>> rows) {
  LawKernels const kernels =
      for_instruction_set([&](auto set) { return law_kernels<decltype(set)::value, Law, decltype(rows)>(); });
  [[maybe_unused]] PairKernels const* pair = kernels.pairs;
  (bound.pairs.push_back({has_layout<P>, has_rows<Q>, *pair++}), ...);
  [[maybe_unused]] PairKernels const* connection = kernels.connections;
  (bound.connections.push_back({has_layout<Connected>, *connection++}), ...);
  [[maybe_unused]] ExternalKernels const* external = kernels.externals;
  (bound.externals.push_back({has_layout<Outside>, *external++}), ...);
}
}  // namespace detail

/// The law with its kernels for these rows, for the selected instruction set.
template <class Rows, class Law>
BoundLaw bind_law(Law const& law) {
  BoundLaw bound{PairScheme::keep(OfScenario<Law>{law}),
                 PairScheme::traits_of(law),
                 symmetry_of<Law>() == Symmetry::one_way,
                 {},
                 {},
                 {}};
  detail::bind_kernels<Law>(bound, Rows{});
  return bound;
}

}  // namespace boltzmann
