// Neighbour lists: for each particle, all that are near, in a fixed order.
#pragma once

#include <boltzmann/neighbours/sorted_copy.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <utility>
#include <vector>

namespace boltzmann {

/// Pairs within one ensemble by particle numbers: those that a list leaves out, or the only ones that it has. Their
/// images are meant, too.
struct PairFilter {
  bool only = false;
  std::vector<std::size_t> start;    ///< of each particle's partners in `index`
  std::vector<std::uint32_t> index;  ///< sorted
  friend bool operator==(PairFilter const&, PairFilter const&) = default;
};

/// The full list: for every owned row of a target sorted copy the rows of a source sorted copy, owned and ghosts, that
/// were within cutoff + skin of it, by the references of both; not itself. An entry is item_of_row() of a source row. A
/// row begins with those within cutoff + skin / 4, then come rings to cutoff + 2 skin / 4, ... (ascending; `list_rings`
/// in all): while nothing has moved further than half a ring's share of the skin, what lies behind that ring can't be
/// within the cut-off, and isn't read. Rows are padded with the source's sentinel.
class NeighbourList {
 public:
  /// Of a list whose target and source are one ensemble, from the next build on.
  void filter(PairFilter filter) { filter_ = std::move(filter); }
  PairFilter const& filter() const { return filter_; }
  /// Finds everybody's neighbours.
  void build(SortedCopy const& target, SortedCopy const& source, double cutoff, double skin, int threads) {
    build(target, source, cutoff, skin, {{0, target.owned()}}, threads);
  }
  /// Finds the neighbours of these target rows, which are owned; the others' lists are empty. `marks`, if asked for: 1
  /// for each row of the source that is in a list, and for some that are near.
  void build(SortedCopy const& target, SortedCopy const& source, double cutoff, double skin,
             std::vector<Stretch> const& rows, int threads, char* marks = nullptr);
  /// And those of others, for references as they were then or have been changed since.
  void build_more(SortedCopy const& target, SortedCopy const& source, std::vector<Stretch> const& rows, int threads,
                  char* marks = nullptr);
  /// Finds those of the given target rows anew, after references have been changed (SortedCopy::move).
  void rebuild(SortedCopy const& target, SortedCopy const& source, std::span<std::uint32_t const> rows,
               char* marks = nullptr);

  std::size_t size() const { return row_.size(); }
  /// Where each row starts.
  std::uint32_t const* const* rows() const { return row_.data(); }
  /// Of each row, how many entries there are up to a ring (0 to list_rings - 1).
  std::uint32_t const* lengths(int ring) const { return length_.data() + static_cast<std::size_t>(ring) * size(); }
  /// The rows of the last rebuild().
  std::span<std::uint32_t const> rebuilt() const { return rebuilt_; }
  /// Entries of all rows that were built, padding included.
  std::size_t entries() const { return entries_; }
  std::size_t bytes() const;

 private:
  void find_rows(SortedCopy const& target, SortedCopy const& source, std::vector<Stretch> const& rows,
                 std::vector<std::vector<std::uint32_t>>& chunks, int threads, char* marks);
  void sift(SortedCopy const& target, SortedCopy const& source, std::size_t i);

  PairFilter filter_;
  double cutoff_ = 0, skin_ = 0;
  std::size_t entries_ = 0;
  std::vector<std::uint32_t*> row_;
  std::vector<std::uint32_t> length_, rebuilt_;
  std::vector<Stretch> found_;                      // rows whose lists are not empty
  std::vector<std::vector<std::uint32_t>> chunks_;  // their size is room, not content
  std::deque<std::vector<std::vector<std::uint32_t>>> more_;
  std::deque<std::vector<std::uint32_t>> replaced_;  // rows that have outgrown their place
};

/// Bytes that a pair scheme with a cut-off holds for a particle whose row has so many, periodic images apart: the
/// mirrored row, its reference and place in the cells, and the start of its list. Every entry of a list takes 4 more.
constexpr std::size_t bytes_with_lists(std::size_t row_bytes) {
  constexpr std::size_t reference = 4 * sizeof(double) + 4 * sizeof(std::int32_t);
  constexpr std::size_t cells = (3 + 4) * sizeof(std::uint32_t);  // position, item, row, order, about one cell
  return row_bytes + reference + cells + sizeof(std::uint32_t*) + list_rings * sizeof(std::uint32_t);
}

}  // namespace boltzmann
