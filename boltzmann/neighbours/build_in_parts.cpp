// Builds lists over the ranks of a team without any rank that has all particles. Ranks agree on the global order of
// rows, particles are sent to the ranks that own or read them, and each rank sorts its own.
//
// Rows are in the order of cells, and cells run along the first axis fastest. So the rows of a rank are runs of grid
// lines (in 1D of cells), here called *units*. All ranks have the number of particles in each unit. Geometry then
// determines the ranks that need a unit. With one run per rank, a rank has a layer of space, cut anywhere. With many
// ranks each has columns of whole units.
#include <boltzmann/core/in_dimension.hpp>
#include <boltzmann/neighbours/neighbourhood.hpp>
#include <boltzmann/neighbours/shares_of_space.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <utility>

namespace boltzmann {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
/// The distance up to which a rank has the neighbours of a row: the reach, plus the rounding of the single-precision
/// search, plus the margin by which rows may move before they get new references.
double wide(double reach, double margin) {
  constexpr double rounding = 1e-5;  // relative to the reach
  return reach * (1 + rounding) + margin;
}

/// A set of particle numbers as bits, which yields them in ascending order.
class Numbers {
 public:
  explicit Numbers(std::size_t size) : words_(size / 64 + 1) {}
  void add(std::uint32_t i) { words_[i / 64] |= std::uint64_t{1} << (i % 64); }
  std::vector<std::uint32_t> ascending() const {
    std::vector<std::uint32_t> numbers;
    for (std::size_t w = 0; w < words_.size(); ++w)
      for (std::uint64_t bits = words_[w]; bits != 0; bits &= bits - 1)
        numbers.push_back(static_cast<std::uint32_t>(64 * w + static_cast<std::size_t>(std::countr_zero(bits))));
    return numbers;
  }

 private:
  std::vector<std::uint64_t> words_;
};

struct Interval {
  double low, high;
  bool operator==(Interval const&) const = default;
  double distance(Interval const& other) const { return std::max(std::max(0.0, low - other.high), other.low - high); }
  /// The largest distance from this interval of a point in the other one.
  double furthest(Interval const& other) const { return std::max(std::max(0.0, low - other.low), other.high - high); }
};
/// A region in the plane of the axes that distinguish units: the second and the third axis, in 1D the first.
using Place = std::array<Interval, 2>;

double distance2(Place const& a, Place const& b) {
  double const first = a[0].distance(b[0]), second = a[1].distance(b[1]);
  return first * first + second * second;
}

double furthest2(Place const& a, Place const& b) {
  double square = 0;
  for (int n = 0; n < 2; ++n) square += a[n].furthest(b[n]) * a[n].furthest(b[n]);
  return square;
}

/// The image of an interval along an axis.
Interval image_of(Images const& images, int axis, int turns, Interval const& x) {
  double const low = images.at(axis, turns, x.low), high = images.at(axis, turns, x.high);
  return {std::min(low, high), std::max(low, high)};
}
/// An image of an interval along an axis, and its index.
struct Seen {
  int turns;
  Interval at;
};
std::vector<Seen> images_of(Images const& images, int axis, double reach, Interval const& x) {
  std::vector<Seen> all{{0, x}};
  for (int turn = 1, most = images.most(axis, reach); turn <= most; ++turn)
    for (int const sign : {-1, 1}) all.push_back({sign * turn, image_of(images, axis, sign * turn, x)});
  return all;
}

/// A rank that reads particles of a unit: all of them, or those near these places. A particle, or an image of it, is
/// there if it is near a row of the rank.
struct Reader {
  std::size_t rank;
  bool all;
  SortedCopy::NearPlaces near;
};

/// Adds the regions that are near these places; back(n, turns, interval) maps an image interval by these turns back to
/// particles, along axis n. True if all that is in the unit is within the distance.
template <class Back>
bool add_near(std::vector<Place> const& places, std::vector<Seen> const& inner, std::vector<Seen> const& outer,
              Back const& back, SortedCopy::NearPlaces& near) {
  for (auto const& place : places)
    for (auto const& b : outer) {
      double const across = place[1].distance(b.at);
      if (across * across > near.square) continue;
      if (b.turns != 0 && place[1].low == -infinite) continue;  // all images are equally far
      for (auto const& a : inner) {
        if (a.turns != 0 && place[0].low == -infinite) continue;
        if (distance2(place, {a.at, b.at}) > near.square) continue;
        if (furthest2(place, {a.at, b.at}) <= near.square) return true;
        near.add(back(0, a.turns, place[0]), back(1, b.turns, place[1]));
      }
    }
  return false;
}

/// Bounds that all ranks have to agree on.
struct Extents {
  Bounds rows, images;
  double count = 0;  ///< number of images

  void add(Extents const& other) {
    rows.take(other.rows);
    images.take(other.images);
    count += other.count;
  }
};

Extents nothing() {
  Extents none;
  for (auto* extent : {&none.rows, &none.images}) extent->low.fill(infinite), extent->high.fill(-infinite);
  return none;
}

/// The bounds of rows, D numbers each, and of their images.
template <int D>
Extents extents_of(Box const& box, double reach, double const* rows, std::size_t count) {
  Images const images(box);
  Extents all = nothing();
  std::array<double, D> low, high, lowest, highest;
  for (int a = 0; a < D; ++a) {
    bool const any = images.most(a, reach) > 0;
    low[a] = any ? box.low(a) + reach : -infinite, high[a] = any ? box.high(a) - reach : infinite;
    lowest[a] = infinite, highest[a] = -infinite;
  }
  for (double const* x = rows; count > 0; --count, x += D) {
    bool inside = true;  // where rows have no images
    for (int a = 0; a < D; ++a) {
      lowest[a] = std::min(lowest[a], x[a]), highest[a] = std::max(highest[a], x[a]);
      inside = inside && x[a] > low[a] && x[a] < high[a];
    }
    if (inside) continue;
    double with_images = 1;
    for (int a = 0; a < D; ++a) {
      auto const [first, last] = images.turns_within(a, reach, x[a]);
      for (int const turns : {first, last})
        if (turns != 0) all.images.take(a, images.at(a, turns, x[a]));
      with_images *= last - first + 1;
    }
    all.count += with_images - 1;
  }
  std::ranges::copy(lowest, all.rows.low.begin()), std::ranges::copy(highest, all.rows.high.begin());
  all.images.take(all.rows);
  return all;
}

}  // namespace

/// One sorted copy, and the data on its rows that all ranks share.
struct Neighbourhood::Sorting {
  SortedCopy* copy;
  std::vector<std::uint32_t> own;         ///< numbers of this rank's particles before the build, ascending
  std::unique_ptr<double[]> references;   ///< of these particles
  std::vector<std::uint32_t> cell, unit;  ///< cell and unit of each of them
  Extents extents = nothing();
  Grid grid, cells;  ///< of the order of rows, and of the neighbour search
  int dimension = 1;
  std::vector<std::size_t> start;  ///< the first row of each unit, and the end
  struct Run {
    std::size_t first, rank;
  };
  std::vector<Run> runs;                    ///< of rows of one rank, ascending; terminated by one at the end of all
                                            ///< rows
  std::vector<std::vector<Place>> places;   ///< of each rank: where its rows may be
  std::vector<std::vector<Place>> read_at;  ///< of each rank: where the rows are whose lists may have these rows
  double wide = 0;                          ///< distance of such reads
  bool read_by_itself = false;

  std::array<int, 2> axes() const { return dimension == 1 ? std::array{0, 1} : std::array{1, 2}; }
  std::int64_t along(int n) const { return axes()[n] < dimension ? grid.count[axes()[n]] : 1; }
  std::size_t units() const { return static_cast<std::size_t>(along(0) * along(1)); }
  std::uint32_t unit_of(std::uint32_t cell) const { return cell / static_cast<std::uint32_t>(cells_of_unit()); }
  std::size_t cells_of_unit() const { return dimension == 1 ? 1 : static_cast<std::size_t>(grid.count[0]); }
  Interval cells_along(int n, std::int64_t first, std::int64_t last) const {
    int const axis = axes()[n];
    if (axis >= dimension) return {-infinite, infinite};
    return {grid.edge[axis] * static_cast<double>(grid.unfolded(axis, first)),
            grid.edge[axis] * static_cast<double>(grid.unfolded(axis, last) + 1)};
  }
  static void add_place(Place const& place, std::vector<Place>& places) {
    bool const goes_on = !places.empty() && places.back()[0] == place[0] && places.back()[1].high == place[1].low;
    if (goes_on)
      places.back()[1].high = place[1].high;
    else
      places.push_back(place);
  }
  /// The places of units [first, last] of one line.
  void add_line(std::int64_t line, std::int64_t first, std::int64_t last, std::vector<Place>& places) const {
    Interval const across = cells_along(1, line, line);
    for (std::int64_t begin = first, end = first; begin <= last; begin = end) {
      for (end = begin + 1; end <= last && grid.unfolded(axes()[0], end) == grid.unfolded(axes()[0], end - 1) + 1;)
        ++end;
      add_place({cells_along(0, begin, end - 1), across}, places);
    }
  }
  /// The places of the rows of each rank.
  std::vector<std::vector<Place>> places_of_ranks(std::size_t ranks) const {
    std::vector<std::vector<Place>> places(ranks);
    for (auto run = runs.begin(); run + 1 != runs.end(); ++run)
      if (run->first < run[1].first) add_places(run->first, run[1].first, places[run->rank]);
    return places;
  }
  /// The places of these rows.
  void add_places(std::size_t begin, std::size_t end, std::vector<Place>& places) const {
    auto const unit_at = [&](std::size_t row) {
      return std::upper_bound(start.begin(), start.end(), row) - start.begin() - 1;
    };
    std::int64_t const n = along(0), first = unit_at(begin), last = unit_at(end - 1);
    for (std::int64_t line = first / n; line <= last / n; ++line) {
      std::int64_t const from = line == first / n ? first % n : 0, to = line == last / n ? last % n : n - 1;
      if (from > 0 || to < n - 1)
        add_line(line, from, to, places);
      else
        add_place({Interval{-infinite, infinite}, cells_along(1, line, line)}, places);
    }
  }
  std::size_t rank_at(std::size_t row) const {
    return std::prev(std::upper_bound(runs.begin(), runs.end(), row,
                                      [](std::size_t k, Run const& run) { return k < run.first; }))
        ->rank;
  }
  /// The indices of units along an axis in spatial order.
  std::vector<std::int64_t> in_space(int n) const {
    std::vector<std::int64_t> order(static_cast<std::size_t>(along(n)));
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<std::int64_t>(k);
    if (axes()[n] < dimension)
      std::sort(order.begin(), order.end(),
                [&](auto a, auto b) { return grid.unfolded(axes()[n], a) < grid.unfolded(axes()[n], b); });
    return order;
  }
  /// Adds to `work` the number of entries of these lists for own particles, whose rows are known then, and the work per
  /// row.
  void add_work(std::deque<List> const& lists, std::vector<std::uint32_t> const* row_of, std::int64_t* work) const {
    auto const around = static_cast<std::int64_t>(work_around(*copy, own.size())), all = std::ssize(unit);
    for (std::int64_t k = 0, done = 0; k < all; ++k) {
      std::int64_t const until = around * (k + 1) / all;
      work[unit[static_cast<std::size_t>(k)]] += work_of_a_row + until - std::exchange(done, until);
    }
    if (row_of == nullptr || row_of->size() != copy->ensemble().size()) return;
    for (auto const& one : lists) {
      if (one.target != copy) continue;
      std::uint32_t const* const length = one.list.lengths(list_rings - 1);
      for (std::size_t k = 0; k < own.size(); ++k)
        if (std::uint32_t const row = (*row_of)[own[k]]; row < one.list.size()) work[unit[k]] += length[row];
    }
  }
  /// References of these particles, ascending, and their cells. Particles that this rank owned before are taken from
  /// its own.
  std::vector<std::uint32_t> find(std::vector<std::uint32_t> const& numbers, std::unique_ptr<double[]>& all,
                                  int threads) const {
    std::vector<std::uint32_t> come(numbers.size()), place_of_come(numbers.size()), cells(numbers.size());
    all = std::make_unique_for_overwrite<double[]>(static_cast<std::size_t>(dimension) * numbers.size());
    in_dimension(dimension, [&](auto D) {
      auto const take = [to = all.get(), D](std::size_t n, double const* from) {
        for (int a = 0; a < D; ++a) to[D * n + a] = from[a];
      };
      std::size_t count = 0;
      for (std::size_t n = 0, k = 0; n < numbers.size(); ++n) {
        while (k < own.size() && own[k] < numbers[n]) ++k;
        if (k < own.size() && own[k] == numbers[n]) {
          cells[n] = cell[k];
          take(n, references.get() + D * k);
        } else {
          come[count] = numbers[n];
          place_of_come[count++] = static_cast<std::uint32_t>(n);
        }
      }
      come.resize(count);
      auto const of_come = copy->references_of(come);
      auto const cells_of_come = cells_of(grid, of_come.get(), D, come.size(), threads);
      for (std::size_t m = 0; m < come.size(); ++m) {
        cells[place_of_come[m]] = cells_of_come[m];
        take(place_of_come[m], of_come.get() + D * m);
      }
    });
    return cells;
  }
  /// Runs of rows of consecutive units with one owner.
  void run_by_units(std::vector<std::uint16_t> const& owner) {
    for (std::size_t u = 0; u < owner.size(); ++u)
      if (runs.empty() || runs.back().rank != owner[u]) runs.push_back({start[u], owner[u]});
    runs.push_back({start.back(), 0});
  }
  void run_by_cuts(WorkShares::Cuts const& cuts) {
    for (std::size_t r = 0; r < cuts.size(); ++r) runs.push_back({cuts[r], r});
  }
  PlaneOfLines plane() const {
    PlaneOfLines plane;
    for (int n = 0; n < 2; ++n) {
      plane.count[n] = along(n);
      if (axes()[n] < dimension) plane.edge[n] = grid.edge[axes()[n]];
    }
    return plane;
  }
};

/// References of this rank's particles, and the bounds over all ranks.
void Neighbourhood::agree_on_extents(std::vector<Sorting>& all, double reach) {
  for (auto& one : all) {
    AnyEnsemble const& ensemble = one.copy->ensemble();
    for (auto const& [begin, end] : ensemble.share()->stretches) {
      one.own.resize(one.own.size() + end - begin);
      std::iota(one.own.end() - static_cast<std::ptrdiff_t>(end - begin), one.own.end(),
                static_cast<std::uint32_t>(begin));
    }
    one.references = one.copy->references_of(one.own);
    one.dimension = box_->dimension();
    in_dimension(one.dimension,
                 [&](auto D) { one.extents = extents_of<D>(*box_, reach, one.references.get(), one.own.size()); });
  }
  Team& team = division_->team();
  team.meet(Team::Occasion::gathers);
  std::vector<Extents> mine;
  for (auto& one : all) mine.push_back(std::exchange(one.extents, nothing()));
  for (auto const& bytes : team.gather({reinterpret_cast<char const*>(mine.data()), mine.size() * sizeof mine[0]}))
    for (std::size_t e = 0; e < all.size(); ++e) {
      Extents other;
      std::memcpy(&other, bytes.data() + e * sizeof other, sizeof other);
      all[e].extents.add(other);
    }
}

/// Determines the grids, the number of rows in each unit, and the owners of rows. False if cells are folded, so that
/// units have no definite place.
bool Neighbourhood::agree_on_order(std::vector<Sorting>& all, double reach) {
  for (auto& one : all) {
    std::size_t const size = one.copy->ensemble().size();
    if (size == 0) return false;
    Extents const& extents = one.extents;
    double const sorting = one.copy->sorting_reach(reach, box_->edges());
    one.grid = Cells::grid_for(one.dimension, extents.rows, size, sorting);
    one.cells = Cells::grid_for(one.dimension, extents.images, size + static_cast<std::size_t>(extents.count), reach);
    if (one.grid.is_folded) return false;
  }
  // One decomposition for all copies, so that interacting particles have the same owner. It follows the largest one.
  auto const& largest = *std::max_element(all.begin(), all.end(), [](auto const& a, auto const& b) {
    return a.copy->ensemble().size() < b.copy->ensemble().size();
  });
  int const ranks = division_->team().size(),
            layers = layers_for(largest.plane(), wide(reach, margin()), ranks, columns_worth_);
  bool const columns = layers < ranks;
  std::vector<std::int64_t> counts;
  for (std::size_t e = 0; e < all.size(); ++e) {
    Sorting& one = all[e];
    std::size_t const at = counts.size(), units = one.units();
    counts.resize(at + (columns ? 2 : 1) * units);
    one.cell = cells_of(one.grid, one.references.get(), static_cast<std::size_t>(one.dimension), one.own.size());
    one.unit.resize(one.cell.size());
    for (std::size_t k = 0; k < one.unit.size(); ++k) ++counts[at + (one.unit[k] = one.unit_of(one.cell[k]))];
    if (columns) one.add_work(lists_, e < row_of_.size() ? &row_of_[e] : nullptr, counts.data() + at + units);
  }
  division_->team().sum(counts);
  auto next = counts.begin();
  for (std::size_t e = 0; e < all.size(); ++e) {
    Sorting& one = all[e];
    one.start = {0};
    for (std::size_t u = 0; u < one.units(); ++u)
      one.start.push_back(one.start.back() + static_cast<std::size_t>(*next++));
    if (columns) {
      cuts_[e].clear();
      std::vector<std::int64_t> const work(next, next + static_cast<std::ptrdiff_t>(one.units()));
      next += static_cast<std::ptrdiff_t>(one.units());
      one.run_by_units(columns_of(one.plane(), {one.in_space(0), one.in_space(1)}, work, layers, ranks));
    } else {
      one.run_by_cuts(cut(e));
    }
    one.places = one.places_of_ranks(static_cast<std::size_t>(ranks));
  }
  return true;
}

/// Finds the ranks that read rows, and from which distance, until the next build. Rows that get new references in
/// between have moved no further than the margin; otherwise all ranks gather all particles.
void Neighbourhood::find_who_reads(std::vector<Sorting>& all, double reach) const {
  for (auto& source : all) {
    source.wide = wide(reach, margin());
    source.read_at.resize(static_cast<std::size_t>(division_->team().size()));
    for (auto const& target : all) {
      bool const in_list = std::any_of(lists_.begin(), lists_.end(), [&](List const& list) {
        return list.target == target.copy && list.source == source.copy;
      });
      source.read_by_itself = source.read_by_itself || (in_list && target.copy == source.copy);
      for (std::size_t r = 0; in_list && r < source.read_at.size(); ++r)
        source.read_at[r].insert(source.read_at[r].end(), target.places[r].begin(), target.places[r].end());
    }
  }
}

/// The ranks to which this rank's particles are sent: their new owners and their readers.
std::vector<std::vector<std::uint32_t>> Neighbourhood::readers(Sorting const& one) const {
  auto const ranks = static_cast<std::size_t>(division_->team().size());
  Images const images(*box_);
  auto const axes = one.axes();
  auto const seen = [&](int n, Interval const& x) {
    return axes[n] < one.dimension ? images_of(images, axes[n], one.wide, x) : std::vector<Seen>{{0, x}};
  };
  // A wall's image maps back by the same wall, other images by the opposite turns.
  auto const back = [&](int n, int turns, Interval const& x) {
    return turns == 0 ? x : image_of(images, axes[n], box_->periodic(axes[n]) ? -turns : turns, x);
  };
  auto const readers_of = [&](std::size_t unit) {
    std::vector<Reader> readers;
    std::size_t const begin = one.start[unit], end = one.start[unit + 1];
    std::size_t const first = one.rank_at(begin), last = one.rank_at(end - 1);
    auto const n = one.along(0), at = static_cast<std::int64_t>(unit);
    auto const inner = seen(0, one.cells_along(0, at % n, at % n)), outer = seen(1, one.cells_along(1, at / n, at / n));
    for (std::size_t r = 0; r < ranks; ++r) {
      // In a unit that is cut, the ranks that have the whole unit determine the owner of a particle.
      bool const owns = r >= first && r <= last;
      SortedCopy::NearPlaces near{.places = {}, .axes = axes, .square = one.wide * one.wide};
      bool const all = add_near(one.read_at[r], inner, outer, back, near);
      if (owns || all || !near.places.empty()) readers.push_back({r, owns || all || first != last, std::move(near)});
    }
    return readers;
  };
  std::vector<std::vector<Reader>> of_unit(one.units());
  std::vector<std::vector<std::uint32_t>> to(ranks);
  in_dimension(one.dimension, [&](auto D) {
    double const* x = one.references.get();
    for (std::size_t k = 0; k < one.own.size(); ++k, x += D) {
      auto& readers = of_unit[one.unit[k]];
      if (readers.empty()) readers = readers_of(one.unit[k]);
      for (Reader const& reader : readers)
        if (reader.all || reader.near.contains(x[D == 1 ? 0 : 1], D == 3 ? x[D - 1] : 0))
          to[reader.rank].push_back(one.own[k]);
    }
  });
  return to;
}

/// Builds this rank's part from the particles that it has now.
void Neighbourhood::build_part(Sorting const& one, std::vector<std::uint32_t> numbers, std::size_t e, double reach,
                               int threads) {
  auto const rank = static_cast<std::size_t>(division_->team().rank());
  SortedCopy::Part part;
  auto const cell = one.find(numbers, part.references, threads);
  part.sorted = Cells(one.grid, cell, one.copy->sorting_reach(reach, box_->edges()));
  part.grid = one.cells;
  part.rows.resize(numbers.size());
  auto& owners = division_->owners_here(one.copy->ensemble());
  Numbers own(one.copy->ensemble().size());
  std::size_t const cells_of_unit = one.cells_of_unit();
  auto run = one.runs.begin();
  for (std::size_t unit = 0, n = 0; n < numbers.size(); ++unit)
    for (std::size_t row = one.start[unit], end = part.sorted.start()[(unit + 1) * cells_of_unit]; n < end;
         ++n, ++row) {
      std::uint32_t const i = numbers[part.sorted.items()[n]];
      while (row >= run[1].first) ++run;
      part.rows[n] = static_cast<std::uint32_t>(row);
      owners[i] = static_cast<std::uint16_t>(run->rank);
      if (run->rank == rank) own.add(i);
    }
  part.particles = std::move(numbers);
  auto places = one.read_at[rank];
  if (!one.read_by_itself)  // owned_near() searches near its own rows, too
    places.insert(places.end(), one.places[rank].begin(), one.places[rank].end());
  // Most are near whole lines, so test these first.
  std::stable_partition(places.begin(), places.end(), [](Place const& place) { return place[0].low == -infinite; });
  part.near.axes = one.axes();
  part.near.square = one.wide * one.wide;
  for (auto const& [first, second] : places) part.near.add(first, second);
  own_[e].clear();
  for (auto stretch = one.runs.begin(); stretch + 1 != one.runs.end(); ++stretch)
    if (stretch->rank == rank && stretch->first < stretch[1].first)
      own_[e].push_back({stretch->first, stretch[1].first});
  division_->take(one.copy->ensemble(), own.ascending());
  one.copy->build_part(reach, std::move(part), threads);
}

bool Neighbourhood::build_in_parts(int threads) {
  // If all ranks have all particles, there is nothing to send.
  if (division_->is_whole() || also_read_ || division_->needs_all()) return false;
  if (box_->sheared()) return false;  // rows near an end have images anywhere along the flow
  double const reach = longest_cutoff() + skin();
  std::vector<Sorting> all(copies_.size());
  for (std::size_t e = 0; e < copies_.size(); ++e) {
    all[e].copy = &copies_[e];
    copies_[e].check_reach(reach, box_->edges());
  }
  agree_on_extents(all, reach);
  if (!agree_on_order(all, reach)) return false;
  find_who_reads(all, reach);
  for (std::size_t e = 0; e < copies_.size(); ++e) {
    AnyEnsemble const& ensemble = copies_[e].ensemble();
    Numbers known(ensemble.size());
    for (auto const& numbers : division_->hand_over(ensemble, readers(all[e])))
      for (auto const i : numbers) known.add(i);
    build_part(all[e], known.ascending(), e, reach, threads);
  }
  changes_ = division_->changes();
  references_known_ = false;
  return true;
}

/// Leaves the state of parts: builds from the references of all particles, which have been gathered.
void Neighbourhood::become_whole(int threads) {
  double const reach = longest_cutoff() + skin();
  for (auto& copy : copies_) {
    std::vector<std::uint32_t> particles;
    std::vector<double> references;
    for (auto const row : copy.moved()) {
      particles.push_back(copy.order()[row]);
      double const* const reference = copy.references() + 4 * std::size_t{row};
      references.insert(references.end(), reference, reference + 3);
    }
    auto const built = copy.built_references();
    copy.build(reach, built, copy.built_edges(), copy.built_slide(), threads_for(copy.owned(), 1, threads));
    auto const row_of = copy.rows_by_number();
    for (auto& particle : particles) particle = row_of[particle];
    copy.move(particles, references);
  }
  if (divided())
    take_shares();
  else
    for (std::size_t e = 0; e < copies_.size(); ++e) own_[e] = {{0, copies_[e].owned()}};
  begin_marks();
  for (auto& list : lists_)
    list.list.build(*list.target, *list.source, list.cutoff, skin(), own(*list.target),
                    threads_for(list.target->owned(), 4, threads), marks(list.source));
  complete_ = !divided();
  ++version_;
}

/// Broadcasts rows that get new references, in their current state: `moved` becomes the list over all ranks.
void Neighbourhood::tell_moved(std::vector<Moved>& moved) {
  auto const D = static_cast<std::size_t>(box_->dimension());
  auto const size = [](SortedCopy const& copy) { return copy.ensemble().doubles(); };
  std::vector<double> mine;  // of each copy: row, particle, whether it is further than the margin, reference, numbers
  for (std::size_t e = 0; e < copies_.size(); ++e)
    for (std::uint32_t const k : moved[e].rows) {
      std::uint32_t const i = copies_[e].order()[k];
      double const* const reference = copies_[e].references() + 4 * std::size_t{k};
      double const* const row = copies_[e].ensemble().row(i);
      mine.insert(mine.end(), {static_cast<double>(e), static_cast<double>(k), static_cast<double>(i),
                               is_part() && copies_[e].left_build_by(k) > margin() ? 1.0 : 0.0});
      mine.insert(mine.end(), reference, reference + D);
      mine.insert(mine.end(), row, row + size(copies_[e]));
    }
  Team& team = division_->team();
  team.meet(Team::Occasion::gathers);
  auto const all = team.gather({reinterpret_cast<char const*>(mine.data()), mine.size() * sizeof mine[0]});
  std::vector<std::vector<std::uint32_t>> of_all(moved.size());  // their rows in the global order
  for (auto& one : moved) one.rows.clear();
  bool too_far = false;
  struct Told {
    std::size_t rank;
    double const* at;
  };
  std::vector<std::vector<double>> numbers(all.size());
  std::vector<Told> told;  // in the order of rows, as on one rank
  for (std::size_t r = 0; r < all.size(); ++r) {
    numbers[r].resize(all[r].size() / sizeof(double));
    if (!numbers[r].empty()) std::memcpy(numbers[r].data(), all[r].data(), all[r].size());
    for (double const *at = numbers[r].data(), *const end = at + numbers[r].size(); at < end;) {
      told.push_back({r, at});
      at += 4 + D + size(copies_[static_cast<std::size_t>(at[0])]);
    }
  }
  std::sort(told.begin(), told.end(), [](Told const& a, Told const& b) { return a.at[1] < b.at[1]; });
  for (auto const& [r, at] : told) {
    auto const e = static_cast<std::size_t>(at[0]);
    auto const k = static_cast<std::uint32_t>(at[1]), i = static_cast<std::uint32_t>(at[2]);
    too_far = too_far || at[3] != 0;
    SortedCopy& copy = copies_[e];
    auto* const ensemble = const_cast<AnyEnsemble*>(&copy.ensemble());
    std::copy_n(at + 4 + D, size(copy), ensemble->row(i));
    division_->owners_here(*ensemble)[i] = static_cast<std::uint16_t>(r);
    std::uint32_t& row = row_of_[e][i];
    if (!copy.knows(row, i)) row = copy.learn(k, i, at + 4);
    copy.refresh_row(row);
    moved[e].rows.push_back(row);
    of_all[e].push_back(k);
  }
  // Some neighbours of rows that have moved further than the margin are not here.
  if (!is_part() || !too_far) return;
  division_->make_whole();
  become_whole(1);
  follow(1);
  for (std::size_t e = 0; e < copies_.size(); ++e) moved[e].rows = std::move(of_all[e]);
}

}  // namespace boltzmann
