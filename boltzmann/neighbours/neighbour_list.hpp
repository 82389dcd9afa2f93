// Neighbour lists: for each particle all near particles, in a fixed order.
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

/// Pairs within one ensemble by particle numbers: those that a list excludes, or the only ones that it has. Applies to
/// their images, too.
struct PairFilter {
  bool only = false;
  std::vector<std::size_t> start;    ///< of each particle's partners in `index`
  std::vector<std::uint32_t> index;  ///< sorted
  friend bool operator==(PairFilter const&, PairFilter const&) = default;
};

/// A full list: for every owned row of a target sorted copy the rows of a source sorted copy, owned and ghosts, that
/// were within cutoff + skin of it, by the references of both, except itself. An entry is item_of_row() of a source
/// row. A row begins with those within cutoff + skin / 4, followed by rings to cutoff + 2 skin / 4, ... (ascending;
/// `list_rings` in all). While nothing has moved further than half a ring's part of the skin, entries beyond that ring
/// can't be within the cut-off, and are not read. Rows are padded with the source's sentinel.
class NeighbourList {
 public:
  /// For a list whose target and source are one ensemble; applies from the next build on.
  void filter(PairFilter filter) { filter_ = std::move(filter); }
  PairFilter const& filter() const { return filter_; }
  /// Finds the neighbours of all targets.
  void build(SortedCopy const& target, SortedCopy const& source, double cutoff, double skin, int threads) {
    build(target, source, cutoff, skin, {{0, target.owned()}}, threads);
  }
  /// Finds the neighbours of these target rows, which are owned; the other lists are empty. `marks`, if not null, is
  /// set to 1 for each row of the source that is in a list, and for some near them.
  void build(SortedCopy const& target, SortedCopy const& source, double cutoff, double skin,
             std::vector<Stretch> const& rows, int threads, char* marks = nullptr);
  /// Builds the lists of further rows, for the references of the last build with later moves.
  void build_more(SortedCopy const& target, SortedCopy const& source, std::vector<Stretch> const& rows, int threads,
                  char* marks = nullptr);
  /// Rebuilds the lists of the given target rows, after references have changed (SortedCopy::move).
  void rebuild(SortedCopy const& target, SortedCopy const& source, std::span<std::uint32_t const> rows,
               char* marks = nullptr);

  std::size_t size() const { return row_.size(); }
  /// The start of each row.
  std::uint32_t const* const* rows() const { return row_.data(); }
  /// For each row the number of entries up to a ring (0 to list_rings - 1).
  std::uint32_t const* lengths(int ring) const { return length_.data() + static_cast<std::size_t>(ring) * size(); }
  /// The rows of the last rebuild().
  std::span<std::uint32_t const> rebuilt() const { return rebuilt_; }
  /// Entries of all built rows, including padding.
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
  std::vector<Stretch> found_;                      // rows whose lists are built
  std::vector<std::vector<std::uint32_t>> chunks_;  // their size is capacity, not content
  std::deque<std::vector<std::vector<std::uint32_t>>> more_;
  std::deque<std::vector<std::uint32_t>> replaced_;  // rows that have outgrown their place
};

/// Memory of a pair scheme with a cut-off per particle with rows of this size, without periodic images: the row of the
/// copy, its reference and cell, and the start of its list. Every entry of a list needs 4 more bytes.
constexpr std::size_t bytes_with_lists(std::size_t row_bytes) {
  constexpr std::size_t reference = 4 * sizeof(double) + 4 * sizeof(std::int32_t);
  constexpr std::size_t cells = (3 + 4) * sizeof(std::uint32_t);  // position, item, row, order, about one cell
  return row_bytes + reference + cells + sizeof(std::uint32_t*) + list_rings * sizeof(std::uint32_t);
}

}  // namespace boltzmann
