// Traversals for atoms with many-body forces: the first pass over neighbour lists stores the entries within the
// cut-off, and later passes use only these.
#pragma once

#include <boltzmann/core/compress.hpp>
#include <boltzmann/neighbours/near_task.hpp>
#include <boltzmann/schemes/many_body/many_body_kernels.hpp>
#include <boltzmann/schemes/pair/pair_sum.hpp>

namespace boltzmann {

namespace detail {

/// Stores the entries of a row that are within the cut-off.
class NearEntries {
 public:
  [[gnu::always_inline]] NearEntries(AtomTask const& task, std::size_t i) : first_(task.near[i]), next_(first_) {}

  /// Appends those of up to 64 entries whose bits are set. `entries` are read in groups of eight, because rows are
  /// padded.
  [[gnu::always_inline]] void add(std::uint32_t const* entries, int count, std::uint64_t bits) {
    constexpr int at_once = 8;
    static_assert(at_once <= list_padding);
    for (int k = 0; k < count; k += at_once) {
      auto const some = static_cast<LaneBits>(bits >> k & 255U);
      store_selected<at_once>(next_, load_words<at_once>(entries + k), some);
      next_ += count_of(some);
    }
  }
  [[gnu::always_inline]] std::uint32_t end(std::uint32_t sentinel) const {
    for (std::size_t k = 0; k < list_padding; ++k) next_[k] = sentinel;
    return static_cast<std::uint32_t>(next_ - first_);
  }

 private:
  std::uint32_t *first_, *next_;
};

/// For laws whose data are addressed by the distance: `law.look(p, q, seen)` stores what they need from q, and law(p,
/// seen) returns the contribution of q to p, with p at the origin.
template <class Law>
inline constexpr bool looks_ahead = requires {
  Law::looks_ahead;
};

template <class Law, class Q>
struct seen_by {
  using type = Q;
};
template <class Law, class Q>
requires looks_ahead<Law>
struct seen_by<Law, Q> {
  using type = typename Law::template Seen<Q::dimension>;
};

/// `first`: traverses whole lists and stores the near entries.
template <Pass pass, bool first, int W, class P, class Law>
[[gnu::flatten]] void over_near(void const* known, AtomTask const& task, std::size_t begin, std::size_t end) {
  using Known = std::remove_cvref_t<decltype(Law::known)>;
  using Seen = typename seen_by<Law, P>::type;
  using S = Sum<pass, W, P, Seen, Law>;
  // Number of packs whose addresses are computed before the first of them is summed, so that no load waits for its
  // address.
  constexpr int ahead = 64 / W;
  Law const law{*static_cast<Known const*>(known)};
  double const cutoff2 = task.cutoff2;
  typename S::Real const rounding = task.rounding;
  double const* const source = task.source;
  std::size_t const stride = task.source_block_stride;
  for (std::size_t i = begin; i < end; ++i) {
    auto const p = broadcast<P, Pack<double, W>>(task.target + row_block * i, task.target_block_stride);
    auto at_origin = p;
    for (int a = 0; a < P::dimension; ++a) at_origin.position[a] = 0.0;
    S sum;
    [[maybe_unused]] NearEntries near(task, i);
    std::uint32_t const* j = first ? task.row[i] : task.near[i];
    std::uint32_t const* const last = j + (first ? task.length : task.near_length)[i];
    while (j < last) {
      [[maybe_unused]] rebind_t<Seen, Pack<double, W>> seen[looks_ahead<Law> ? ahead : 1];
      [[maybe_unused]] std::uint32_t const* const entries = j;
      [[maybe_unused]] std::uint64_t bits = 0;
      int count = 0;
      for (; count < ahead && j < last; ++count, j += W) {
        auto const q = load_rows<P, W>([&](int lane) { return source + j[lane]; }, stride);
        auto const square = norm2(q.position - p.position);
        if constexpr (first) bits |= std::uint64_t{lanes_below(square, cutoff2)} << (W * count);
        if constexpr (looks_ahead<Law>)
          law.look(p, q, seen[count]);
        else
          sum.add(law, p, q, square < cutoff2, rounding);
      }
      if constexpr (first) near.add(entries, W * count, bits);
      if constexpr (looks_ahead<Law>)
        for (int k = 0; k < count; ++k) sum.add(law, at_origin, seen[k], seen[k].square < cutoff2, rounding);
    }
    if constexpr (first) task.near_length[i] = near.end(task.sentinel);
    sum.store(task, task.order ? task.order[i] : i);
  }
}

}  // namespace detail

}  // namespace boltzmann
