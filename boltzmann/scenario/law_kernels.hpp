// Law kernels: the tables of a law's kernels for its rows. For kernel units only (see core/kernel_unit.hpp), which
// instantiate law_kernels<this_set, Law, Rows>. Private to this module.
#pragma once

#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/scenario/law_rows.hpp>
#include <boltzmann/schemes/pair/pair_kernels.hpp>

namespace boltzmann {
namespace detail {

template <InstructionSet set, class Law, class Rows>
struct LawTables;
template <InstructionSet set, class Law, class... P, class... Q, class... Connected, class... Outside>
struct LawTables<set, Law, LawRows<Layouts<On<P, Q>...>, Layouts<Connected...>, Layouts<Outside...>>> {
  // An empty entry at the end, because arrays of size zero are not allowed.
  static constexpr PairKernels pairs[] = {near_kernels<P, Q, OfScenario<Law>>()..., {}};
  static constexpr PairKernels connections[] = {connection_kernels<Connected, OfScenario<Law>>()..., {}};
  static constexpr ExternalKernels externals[] = {external_kernels<Outside, OfScenario<Law>>()..., {}};
};

}  // namespace detail

template <InstructionSet set, class Law, class Rows>
LawKernels law_kernels() {
  using Tables = detail::LawTables<set, Law, Rows>;
  return {Tables::pairs, Tables::connections, Tables::externals};
}

}  // namespace boltzmann
