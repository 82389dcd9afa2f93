// Ranks: the part of each rank of a team in a solution of Poisson's equation. A rank transforms the rows and columns of
// a range of planes, and a range of the lines along the last axis. The numbers of these lines are exchanged with all
// ranks. Private to the solver.
#pragma once

#include <boltzmann/core/team.hpp>
#include <boltzmann/schemes/mesh/poisson_lines.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace boltzmann::poisson {

struct Range {
  std::size_t begin, end;

  std::size_t size() const { return end - begin; }
  Range within(Range const& other) const {
    std::size_t const first = std::max(begin, other.begin);
    return {first, std::max(first, std::min(end, other.end))};
  }
};

/// Numbers in planes of rows, with padding between them.
struct Planes {
  double* data;
  std::size_t count, rows, columns;  ///< of planes, and of what is in them
  std::size_t row, plane;            ///< strides of rows and planes

  /// The number of blocks of lines in a row.
  std::size_t blocks_of_row() const { return (columns + block_width - 1) / block_width; }
  std::size_t blocks() const { return rows * blocks_of_row(); }
};

class Ranks {
 public:
  /// Null: one rank solves alone.
  explicit Ranks(SolvingRanks const* all) : all_(all), team_(all ? all->team : nullptr) {
    if (!team_) return;
    rank_ = static_cast<std::size_t>(team_->rank());
    size_ = static_cast<std::size_t>(team_->size());
  }

  bool several() const { return size_ > 1; }
  /// The part of this rank, out of this number of planes or blocks of lines.
  Range own(std::size_t all) const { return of(rank_, all); }

  /// Exchanges data from ranks with planes [samples.begin, samples.end) to ranks with lines, which then have complete
  /// lines; and back.
  void to_lines(Planes const& array, Range samples) const { turn(array, samples, true); }
  void to_planes(Planes const& array, Range samples) const { turn(array, samples, false); }

  /// Sends results on the nodes from ranks with planes, or lines, to the ranks that read them, or to all.
  struct Result {
    Planes array;
    bool by_lines = false;
  };
  void share(std::vector<Result> const& results, bool everybody = false) const {
    if (results.empty()) return;
    auto const parts = [&](std::size_t owner, std::size_t reader) {
      std::vector<Part> parts;
      for (auto const& [array, by_lines] : results)
        parts.push_back({&array, by_lines ? Range{0, array.count} : of(owner, array.count),
                         by_lines ? of(owner, array.blocks()) : Range{0, array.blocks()},
                         everybody || all_->reads.empty() ? nullptr : all_->reads[reader].data()});
      return parts;
    };
    exchange([&](std::size_t r) { return parts(rank_, r); }, [&](std::size_t r) { return parts(r, rank_); });
  }

 private:
  /// Blocks of those planes that are read.
  struct Part {
    Planes const* array;
    Range planes, blocks;
    char const* read;  ///< null: all

    /// Calls function(first, count) for each contiguous range.
    template <class Function>
    void each(Function const& function) const {
      std::size_t const of_row = array->blocks_of_row();
      for (std::size_t l = planes.begin; l < planes.end; ++l) {
        if (read && !read[l]) continue;
        for (std::size_t block = blocks.begin, next = 0; block < blocks.end; block = next) {
          std::size_t const m = block / of_row, first = (block - m * of_row) * block_width;
          next = std::min(blocks.end, (m + 1) * of_row);
          std::size_t const last = std::min(array->columns, (next - m * of_row) * block_width);
          function(array->data + l * array->plane + m * array->row + first, last - first);
        }
      }
    }
  };

  Range of(std::size_t rank, std::size_t all) const {
    if (!team_) return {0, all};
    auto const [begin, end] = all_->part(rank, all);
    return {begin, end};
  }

  void turn(Planes const& array, Range samples, bool to_lines) const {
    auto const part = [&](std::size_t of_planes, std::size_t of_lines) {
      return std::vector<Part>{
          {&array, of(of_planes, array.count).within(samples), of(of_lines, array.blocks()), nullptr}};
    };
    exchange([&](std::size_t r) { return to_lines ? part(rank_, r) : part(r, rank_); },
             [&](std::size_t r) { return to_lines ? part(r, rank_) : part(rank_, r); });
  }

  /// Sends sent(r) to rank r, and receives received(r) from it.
  template <class Sent, class Received>
  void exchange(Sent const& sent, Received const& received) const {
    if (!several()) return;
    auto const each = [](std::vector<Part> const& parts, auto const& function) {
      for (auto const& part : parts) part.each(function);
    };
    auto const sizes = [&](auto const& parts) {
      std::vector<std::size_t> sizes(size_);
      for (std::size_t r = 0; r < size_; ++r)
        if (r != rank_) each(parts(r), [&](double const*, std::size_t count) { sizes[r] += count; });
      return sizes;
    };
    team_->meet(Team::Occasion::exchanges);
    team_->exchange(
        sizes(sent), sizes(received),
        [&](std::size_t r, double* to) {
          each(sent(r), [&](double const* at, std::size_t count) { to = std::copy_n(at, count, to); });
        },
        [&](std::size_t r, double const* from) {
          each(received(r), [&](double* at, std::size_t count) { std::copy_n(from, count, at), from += count; });
        });
  }

  SolvingRanks const* all_;
  Team* team_;
  std::size_t rank_ = 0, size_ = 1;
};

}  // namespace boltzmann::poisson
