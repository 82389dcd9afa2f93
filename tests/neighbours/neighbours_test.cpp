// Cells, lists, connections and sorted copies against brute force: random, clustered, equal and far-off points in 1D to
// 3D.
#include <boltzmann/core/error.hpp>
#include <boltzmann/neighbours/cells.hpp>
#include <boltzmann/neighbours/connection.hpp>
#include <boltzmann/neighbours/neighbour_list.hpp>
#include <boltzmann/neighbours/sorted_copy.hpp>
#include <boltzmann/particles/newton.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <map>
#include <new>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace boltzmann::neighbours_test {
namespace {
std::atomic<std::size_t> largest_allocation = 0;

void note(std::size_t size) {
  std::size_t largest = largest_allocation.load(std::memory_order_relaxed);
  while (largest < size && !largest_allocation.compare_exchange_weak(largest, size, std::memory_order_relaxed)) {
  }
}
}  // namespace
}  // namespace boltzmann::neighbours_test

// Watches how much memory is asked for at once: by the allocator of the thread sanitizer where that is in the program,
// which lets nobody replace it.
#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define BOLTZMANN_THREAD_SANITIZER
#endif
#endif
#ifdef BOLTZMANN_THREAD_SANITIZER
#include <sanitizer/allocator_interface.h>

namespace {
int const watches = __sanitizer_install_malloc_and_free_hooks(
    [](void const volatile*, std::size_t size) { boltzmann::neighbours_test::note(size); },
    [](void const volatile*) {});
}
#else
[[gnu::noinline]] void* operator new(std::size_t size) {
  boltzmann::neighbours_test::note(size);
  if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }
#endif

namespace boltzmann::neighbours_test {
namespace {

// ---- cells --------------------------------------------------------------------------------------------------------

std::vector<double> points(int dimension, std::size_t count, double extent, unsigned seed) {
  std::mt19937_64 random(test_seed(seed));
  std::vector<double> x(count * dimension);
  for (double& v : x) v = std::uniform_real_distribution(-0.3 * extent, 0.7 * extent)(random);
  return x;
}

/// Every point within `edge` of each point must be among those that near() visits. Returns the number visited in all.
std::size_t expect_all_near_are_visited(int dimension, std::vector<double> const& x, double edge,
                                        std::string const& what) {
  std::size_t const count = x.size() / dimension;
  Cells const cells(dimension, x.data(), dimension, count, edge);
  auto const& items = cells.items();
  std::vector<std::uint32_t> sorted(items);
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::uint32_t> everyone(count);
  std::iota(everyone.begin(), everyone.end(), 0u);
  EXPECT_EQ(sorted, everyone) << what << ": items are not each point once";
  std::size_t all = 0, missed = 0, outside = 0;
  std::vector<char> seen(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::fill(seen.begin(), seen.end(), 0);
    cells.near(x.data() + i * dimension, [&](std::size_t begin, std::size_t end) {
      if (begin > end || end > count) return void(++outside);
      for (std::size_t k = begin; k < end; ++k) {
        EXPECT_FALSE(seen[items[k]]) << what << ": a point is visited twice";
        seen[items[k]] = 1;
        ++all;
      }
    });
    for (std::size_t j = 0; j < count; ++j) {
      double square = 0;
      for (int a = 0; a < dimension; ++a)
        square += (x[j * dimension + a] - x[i * dimension + a]) * (x[j * dimension + a] - x[i * dimension + a]);
      if (square < edge * edge && !seen[j]) ++missed;
    }
  }
  EXPECT_EQ(missed, 0u) << what;
  EXPECT_EQ(outside, 0u) << what;
  return all;
}

TEST(Cells, NearFindsAllOfRandomPoints) {
  for (int const dimension : {1, 2, 3})
    for (std::size_t const count : {0, 1, 2, 3, 50, 600})
      for (double const edge : {0.05, 0.4, 1.0, 3.0, 40.0})
        expect_all_near_are_visited(
            dimension, points(dimension, count, 10, 3), edge,
            std::to_string(dimension) + "D N " + std::to_string(count) + " edge " + std::to_string(edge));
  // And not everybody is asked: in 2D about 9 cells' worth of points.
  std::size_t const visited = expect_all_near_are_visited(2, points(2, 2000, 10, 4), 0.5, "2000 in 2D");
  EXPECT_LT(visited, 2000u * 9 * 2000 / 400 * 2);
}

TEST(Cells, NearFindsAllOfClusteredAndEqualPoints) {
  for (int const dimension : {1, 2, 3}) {
    auto clustered = points(dimension, 400, 10, 5);
    for (std::size_t i = 0; i < clustered.size() * 3 / 4; ++i) clustered[i] *= 1e-3;
    expect_all_near_are_visited(dimension, clustered, 0.1, "clustered");
    for (double const at : {0.0, -0.0, 1e-310, 7.25, -1e200})
      EXPECT_EQ(expect_all_near_are_visited(dimension, std::vector<double>(60 * dimension, at), 0.5, "equal"),
                60u * 60);
    // On a line and on a plane inside the space, also where the third coordinate is all but zero.
    auto flat = points(dimension, 300, 10, 6);
    for (std::size_t i = 0; i < 300; ++i) flat[i * dimension + dimension - 1] = 1;
    expect_all_near_are_visited(dimension, flat, 0.7, "flat");
    for (std::size_t i = 0; i < 300; ++i) flat[i * dimension + dimension - 1] = i % 3 == 0 ? 1e-310 : 0;
    expect_all_near_are_visited(dimension, flat, 0.7, "flat but for a denormal number");
  }
}

// Neighbours at the edge's length but for a rounding error, over many cells: both sides of a cell's face round alone.
TEST(Cells, NearFindsLatticeNeighboursAtTheEdge) {
  std::mt19937_64 random(test_seed(7));
  for (int trial = 0; trial < 300; ++trial) {
    double const edge = std::uniform_real_distribution(0.5, 1.5)(random);
    double const start = std::uniform_real_distribution(-100.0, 100.0)(random);
    std::vector<double> x(std::uniform_int_distribution(20, 300)(random));
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = start + static_cast<double>(i) * edge;
    expect_all_near_are_visited(1, x, edge, "lattice " + std::to_string(trial));
    if (HasFailure()) return;
  }
}

TEST(Cells, FarPointsMakeCellsLargerAndNotMemory) {
  for (int const dimension : {1, 2, 3})
    for (double const far : {1e3, 1e9, 1e100, 1e307}) {
      auto x = points(dimension, 500, 10, 8);
      for (int a = 0; a < dimension; ++a) x[3 * dimension + a] = a % 2 ? far : -far;
      largest_allocation = 0;
      Cells const cells(dimension, x.data(), dimension, 500, 0.5);
      EXPECT_LE(largest_allocation, (4 * 500 + 66) * sizeof(std::uint32_t)) << dimension << "D " << far;
      expect_all_near_are_visited(dimension, x, 0.5, "outlier");
    }
}

TEST(Cells, PointsOfOneCellKeepTheirOrder) {
  auto const x = points(2, 300, 1, 9);
  Cells const cells(2, x.data(), 2, 300, 5.0);
  std::size_t fullest = 0;
  for (std::size_t c = 0; c < cells.grid().cells(); ++c) {
    auto const begin = cells.items().begin() + cells.start()[c], end = cells.items().begin() + cells.start()[c + 1];
    EXPECT_TRUE(std::is_sorted(begin, end));
    fullest = std::max(fullest, static_cast<std::size_t>(end - begin));
    for (auto item = begin; item != end; ++item) EXPECT_EQ(cells.grid().cell_of(x.data() + 2 * *item), c);
  }
  EXPECT_GT(fullest, 100u);
}

// In finer and coarser grids, whose cells have the same edges and begin elsewhere.
TEST(Cells, TellCellsInAnotherGrid) {
  for (int const dimension : {1, 2, 3})
    for (std::size_t const count : {0, 1, 700}) {
      auto const x = points(dimension, count, 10, 10);
      double const reach = 0.5 * dimension * dimension;  // so that cells need not be folded
      Bounds const extent = Bounds::of(dimension, x.data(), dimension, count);
      Cells const cells(dimension, x.data(), dimension, count, reach);
      for (double const further : {0.0, 0.7, 40.0, 1e6}) {
        Bounds wide = extent;
        for (int a = 0; a < dimension; ++a) wide.low[a] -= 2 * further, wide.high[a] += further;
        Grid const other = Cells::grid_for(dimension, wide, 3 * count, reach);
        ASSERT_TRUE(cells.tell_cells_in(other));
        std::vector<std::uint32_t> found(count);
        cells.cells_in(other, found.data());
        for (std::size_t n = 0; n < count; ++n)
          ASSERT_EQ(found[n], other.cell_of(x.data() + dimension * cells.items()[n])) << dimension << "D " << further;
      }
      EXPECT_FALSE(cells.tell_cells_in(Cells::grid_for(dimension, extent, count, 1.1 * reach)));
    }
  auto far = points(3, 50, 10, 11);
  far[7] = 1e9;  // cells are folded
  Cells const cells(3, far.data(), 3, 50, 0.5);
  EXPECT_FALSE(cells.tell_cells_in(cells.grid()));
}

// ---- Sorted copies ----

template <int D>
Box make_box(std::array<double, 3> length, std::array<Boundary, 3> kinds) {
  std::array<double, 3> low{}, high{};
  for (int a = 0; a < D; ++a) low[a] = -0.25 * length[a], high[a] = low[a] + length[a];
  return Box(D, low, high, kinds);
}

/// Random particles; the mass is the particle's number, so that a copied row says whose it is.
template <int D>
void scatter(Ensemble<Newton<D>>& e, Box const& box, unsigned seed) {
  std::mt19937_64 random(test_seed(seed));
  for (std::size_t i = 0; i < e.size(); ++i) {
    for (int a = 0; a < D; ++a) {
      e[i].position[a] = std::uniform_real_distribution(box.low(a), box.high(a))(random);
      e[i].velocity[a] = std::normal_distribution()(random);
    }
    e[i].mass = static_cast<double>(i);
  }
}

constexpr int mass_column(int D) { return D; }

/// Number c of row k.
double at(SortedCopy const& copy, std::size_t k, std::size_t c) {
  return copy.rows()[c / row_block * copy.block_stride() + row_block * k + c % row_block];
}
std::size_t numbers(SortedCopy const& copy) { return row_block * copy.blocks(); }

/// A row of a sorted copy: which particle, and by how many lengths it is moved.
using Image = std::array<int, 4>;

template <int D>
Image image_of(SortedCopy const& copy, Box const& box, std::size_t row) {
  int const particle = static_cast<int>(at(copy, row, mass_column(D)));
  Image image{particle, 0, 0, 0};
  auto const references = copy.built_references();
  for (int a = 0; a < D; ++a)
    if (box.periodic(a))
      image[a + 1] = static_cast<int>(std::lround((at(copy, row, a) - references[particle * D + a]) / box.length(a)));
  return image;
}

/// The images, by brute force, of the positions at the last build that are within reach of the box.
template <int D>
std::set<Image> expected_ghosts(SortedCopy const& copy, Box const& box, double reach) {
  std::set<Image> ghosts;
  auto const references = copy.built_references();
  int range[3] = {0, 0, 0};
  for (int a = 0; a < D; ++a)
    if (box.periodic(a)) range[a] = static_cast<int>(reach / box.length(a)) + 2;
  for (std::size_t i = 0; i < copy.owned(); ++i)
    for (int x = -range[0]; x <= range[0]; ++x)
      for (int y = -range[1]; y <= range[1]; ++y)
        for (int z = -range[2]; z <= range[2]; ++z) {
          int const n[3] = {x, y, z};
          bool inside = x != 0 || y != 0 || z != 0;
          for (int a = 0; a < D; ++a) {
            double const x = references[i * D + a] + n[a] * box.length(a);
            if (box.periodic(a) && !(x >= box.low(a) - reach && x <= box.high(a) + reach)) inside = false;
          }
          if (inside) ghosts.insert({static_cast<int>(i), x, y, z});
        }
  return ghosts;
}

template <int D>
void expect_rows_are_images(SortedCopy const& copy, Ensemble<Newton<D>> const& e, Box const& box, double reach) {
  ASSERT_EQ(copy.owned(), e.size());
  std::vector<char> seen(e.size(), 0);
  std::vector<std::size_t> row_of(e.size());
  for (std::size_t k = 0; k < copy.owned(); ++k) {
    std::uint32_t const i = copy.order()[k];
    ASSERT_LT(i, e.size());
    ASSERT_FALSE(seen[i]) << "a particle stands twice in the order";
    seen[i] = 1;
    row_of[i] = k;
    ASSERT_EQ(reinterpret_cast<std::uintptr_t>(copy.rows() + row_block * k) % 32, 0u);
    auto const row = [&](std::size_t c) { return at(copy, k, c); };
    ASSERT_EQ(row(mass_column(D)), static_cast<double>(i));
    for (int a = 0; a < D; ++a) {
      ASSERT_EQ(row(D + 1 + a), e[i].velocity[a]);
      double const turns = (e[i].position[a] - row(a)) / box.length(a);
      if (box.periodic(a))
        ASSERT_NEAR(turns, std::nearbyint(turns), 1e-14);
      else
        ASSERT_EQ(row(a), e[i].position[a]);
    }
    ASSERT_EQ(image_of<D>(copy, box, k), (Image{static_cast<int>(i), 0, 0, 0})) << "it stays where it was built";
  }
  // The ghosts: exactly those within reach, each the owned row moved by whole lengths, bit by bit.
  std::set<Image> ghosts;
  for (std::size_t k = copy.owned() + 1; k <= copy.total(); ++k) {
    Image const image = image_of<D>(copy, box, k);
    ASSERT_TRUE(ghosts.insert(image).second) << "a ghost stands twice";
    for (std::size_t c = 0; c < numbers(copy); ++c) {
      double const owned = at(copy, row_of[image[0]], c);
      bool const moved = c < D && image[c + 1] != 0;
      // Rounded as a length of its own, not fused with the sum.
      double const volatile shift = moved ? image[c + 1] * box.length(static_cast<int>(c)) : 0;
      ASSERT_EQ(at(copy, k, c), moved ? owned + shift : owned);
    }
  }
  ASSERT_EQ(ghosts, (expected_ghosts<D>(copy, box, reach)));
  for (std::size_t c = 0; c < numbers(copy); ++c)
    ASSERT_TRUE(std::isnan(at(copy, copy.sentinel(), c))) << "the sentinel has a position";
}

template <int D>
void mirror_follows(std::array<double, 3> length, std::array<Boundary, 3> kinds, double reach, std::size_t count) {
  SCOPED_TRACE(std::to_string(D) + "D, reach " + std::to_string(reach) + ", N " + std::to_string(count));
  Box const box = make_box<D>(length, kinds);
  Ensemble<Newton<D>> e("e", count);
  scatter(e, box, 11);
  if (count > 3)  // on edges and corners, and outside, as after an intermediate stage
    for (int a = 0; a < D; ++a) {
      e[0].position[a] = box.low(a);
      e[1].position[a] = box.high(a);
      e[2].position[a] = box.high(a) + 0.137;
      e[3].position[a] = box.low(a) - 0.137;
    }
  SortedCopy copy(e, box);
  copy.build(reach);
  EXPECT_FALSE(copy.is_current() && count > 0);
  EXPECT_EQ(copy.refresh(1), count > 0);
  EXPECT_FALSE(copy.refresh(2)) << "nothing has changed";
  EXPECT_TRUE(copy.is_current());
  EXPECT_LT(copy.largest2(), 1e-28);
  ASSERT_NO_FATAL_FAILURE(expect_rows_are_images(copy, e, box, reach));
  for (std::size_t k = 0; k < copy.owned(); ++k)
    for (int a = 0; a < D; ++a)
      if (box.periodic(a)) {
        ASSERT_GE(at(copy, k, a), box.low(a));
        ASSERT_LE(at(copy, k, a), box.high(a));
      }

  // Particles move, some over an edge, and are wrapped: the sorted copy must not see the jump.
  std::mt19937_64 random(test_seed(13));
  std::vector<Vector<D>> path(count, Vector<D>{});
  for (int step = 0; step < 5; ++step) {
    for (std::size_t i = 0; i < count; ++i)
      for (int a = 0; a < D; ++a) {
        double const d = std::uniform_real_distribution(-0.05, 0.05)(random);
        e[i].position[a] += d;
        path[i][a] += d;
        if (box.periodic(a)) {
          if (e[i].position[a] >= box.high(a)) e[i].position[a] -= box.length(a);
          if (e[i].position[a] < box.low(a)) e[i].position[a] += box.length(a);
        }
      }
    EXPECT_EQ(copy.is_current(), count == 0);
    EXPECT_EQ(copy.refresh(1 + step % 3), count > 0);
    ASSERT_NO_FATAL_FAILURE(expect_rows_are_images(copy, e, box, reach));
    std::vector<double> squares{0, 0};
    for (auto const& d : path) squares.push_back(norm2(d));
    std::sort(squares.rbegin(), squares.rend());
    EXPECT_NEAR(copy.largest2(), squares[0], 1e-14);
    for (double const limit : {squares[0] * 0.99, squares[count / 2] * 1.01}) {
      auto const beyond = copy.beyond(limit, count).value();
      auto const expected = std::count_if(squares.begin(), squares.end(), [&](double d) { return d > limit; });
      EXPECT_EQ(static_cast<std::ptrdiff_t>(beyond.size()), expected);
      for (auto const row : beyond) EXPECT_GT(norm2(path[copy.order()[row]]), limit * 0.999);
      if (expected > 0) {
        EXPECT_FALSE(copy.beyond(limit, static_cast<std::size_t>(expected) - 1));
      }
    }
  }

  // Built again from the reference alone, at another state: the same rows in the same order.
  SortedCopy again(e, box);
  auto const references = copy.built_references();
  again.build(reach, references);
  again.refresh(1);
  ASSERT_EQ(again.owned(), copy.owned());
  ASSERT_EQ(again.total(), copy.total());
  EXPECT_EQ(again.built_references(), references);
  EXPECT_TRUE(std::equal(again.order(), again.order() + again.owned(), copy.order()));
  for (std::size_t k = 0; k <= again.total(); ++k)
    for (std::size_t c = 0; c < numbers(again) && k != again.sentinel(); ++c)
      ASSERT_EQ(at(again, k, c), at(copy, k, c));
}

constexpr std::array<Boundary, 3> all_periodic{Boundary::periodic, Boundary::periodic, Boundary::periodic};
constexpr std::array<Boundary, 3> mixed{Boundary::periodic, Boundary::open, Boundary::periodic};
constexpr std::array<Boundary, 3> none_periodic{Boundary::open, Boundary::reflecting, Boundary::open};

TEST(SortedCopy, GhostsAreExactImagesAndFollowTheParticles) {
  for (auto const& kinds : {all_periodic, mixed, none_periodic})
    for (std::size_t const count : {0, 1, 2, 40})
      for (double const reach : {0.3, 1.0, 2.7}) {  // 2.7: further than the box is long, several images
        mirror_follows<1>({1.3, 0, 0}, kinds, reach, count);
        mirror_follows<2>({1.3, 2, 0}, kinds, reach, count);
        mirror_follows<3>({1.3, 2, 1.6}, kinds, reach, count);
      }
  mirror_follows<3>({6, 5, 7}, all_periodic, 1.2, 5000);
}

TEST(SortedCopy, NeighboursInTheOrderAreNearInSpace) {
  Box const box = make_box<3>({10, 10, 10}, all_periodic);
  Ensemble<Newton<3>> e("e", 3000);
  scatter(e, box, 1);
  SortedCopy copy(e, box);
  copy.build(1.0);
  copy.refresh(1);
  double sorted = 0, given = 0;
  for (std::size_t k = 1; k < 3000; ++k) {
    Vector<3> d;
    for (int a = 0; a < 3; ++a) d[a] = at(copy, k, a) - at(copy, k - 1, a);
    sorted += magnitude(d);
    given += magnitude(e[k].position - e[k - 1].position);
  }
  EXPECT_LT(sorted, 0.3 * given);
}

TEST(SortedCopy, RefusesPositionsThatAreNotFinite) {
  for (double const x : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Box const box = make_box<2>({3, 3, 0}, all_periodic);
    Ensemble<Newton<2>> e("gas", 5);
    scatter(e, box, 1);
    SortedCopy copy(e, box);
    copy.build(1.0);
    e[4].position[1] = x;
    auto const message = [&](auto const& call) -> std::string {
      try {
        call();
      } catch (PhysicsFailure const& failure) {
        return failure.what();
      }
      return "";
    };
    EXPECT_NE(message([&] { copy.refresh(1); }).find("particle 4 of 'gas'"), std::string::npos);
    EXPECT_NE(message([&] { copy.build(1.0); }).find("particle 4 of 'gas'"), std::string::npos);
  }
}

TEST(SortedCopy, ImagesThatWouldFillTheMemoryAreRefused) {
  Ensemble<Newton<3>> gas("gas", 100);
  Box const box = make_box<3>({10, 1e14, 10}, all_periodic);
  scatter(gas, box, 3);
  SortedCopy copy(gas, box);
  std::string const told = "neighbours of 'gas' are found up to a distance of ";
  for (double const reach : {80.1, 1e6, 1e16, 1e300})
    EXPECT_EQ(message([&] { copy.build(reach); }).find(told), 0U) << reach;
  EXPECT_EQ(message([&] { copy.build(80.1); }), told + "80.1; a periodic axis of 10 (x) allows at most 80");
  copy.build(79.9);
  Ensemble<Newton<3>> many("many", 400000);
  Box const cube = make_box<3>({10, 10, 10}, all_periodic);
  SortedCopy larger(many, cube);
  EXPECT_EQ(message([&] { larger.build(79.9); }),
            "ensemble 'many' has 1958272157 particles and images within reach, lists allow 1073741823");
}

// ---- lists --------------------------------------------------------------------------------------------------------

/// Number of sources (all images) within reach of each target, by brute force and without sorted copies; not itself.
template <int D>
std::vector<std::size_t> neighbours_of(Ensemble<Newton<D>> const& target, Ensemble<Newton<D>> const& source,
                                       Box const& box, double reach) {
  std::vector<std::size_t> count(target.size(), 0);
  int range[3] = {0, 0, 0};
  for (int a = 0; a < D; ++a)
    if (box.periodic(a)) range[a] = static_cast<int>(reach / box.length(a)) + 2;
  for (std::size_t i = 0; i < target.size(); ++i)
    for (std::size_t j = 0; j < source.size(); ++j)
      for (int x = -range[0]; x <= range[0]; ++x)
        for (int y = -range[1]; y <= range[1]; ++y)
          for (int z = -range[2]; z <= range[2]; ++z) {
            if (&target == &source && i == j && x == 0 && y == 0 && z == 0) continue;
            int const n[3] = {x, y, z};
            double square = 0;
            for (int a = 0; a < D; ++a) {
              double const d = source[j].position[a] + n[a] * box.length(a) - target[i].position[a];
              square += d * d;
            }
            if (square < reach * reach) ++count[i];
          }
  return count;
}

struct Rows {
  std::vector<std::vector<std::uint32_t>> items;  // with padding
  std::array<std::vector<std::uint32_t>, list_rings> length;
  friend bool operator==(Rows const&, Rows const&) = default;
};

/// The neighbour list between two sorted copies, copied out; `skin` is the width of its rings together.
Rows near_pairs(SortedCopy const& target, SortedCopy const& source, double reach, int threads, double skin = 0) {
  NeighbourList list;
  list.build(target, source, reach - skin, skin, threads);
  Rows rows;
  for (int r = 0; r < list_rings; ++r)
    rows.length[static_cast<std::size_t>(r)].assign(list.lengths(r), list.lengths(r) + list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    std::size_t const used = (rows.length[list_rings - 1][i] + list_padding - 1) / list_padding * list_padding;
    rows.items.emplace_back(list.rows()[i], list.rows()[i] + used);
  }
  return rows;
}

template <int D>
double distance2(SortedCopy const& target, std::size_t i, SortedCopy const& source, std::size_t j) {
  double square = 0;
  for (int a = 0; a < D; ++a) square += (at(source, j, a) - at(target, i, a)) * (at(source, j, a) - at(target, i, a));
  return square;
}

template <int D>
void compare_list(std::array<double, 3> length, std::array<Boundary, 3> kinds, double reach, std::size_t targets,
                  std::size_t sources, double cluster = 1) {
  SCOPED_TRACE(std::to_string(D) + "D, reach " + std::to_string(reach) + ", N " + std::to_string(targets) + " and " +
               std::to_string(sources));
  Box const box = make_box<D>(length, kinds);
  Ensemble<Newton<D>> e("e", targets), other("other", sources);
  scatter(e, box, 21);
  scatter(other, box, 22);
  for (auto* ensemble : {&e, &other})
    for (std::size_t i = 0; i < ensemble->size() * 2 / 3; ++i) (*ensemble)[i].position *= cluster;
  SortedCopy copy(e, box), other_copy(other, box);
  for (auto* m : {&copy, &other_copy}) {
    m->build(reach);
    m->refresh(1);
  }
  for (SortedCopy const* from : {&copy, &other_copy}) {
    // The list is right if it has everybody within reach, nobody twice, and nobody much further away.
    double const skin = 0.3 * reach;
    Rows const list = near_pairs(copy, *from, reach, 1, skin);
    auto const expected = neighbours_of(e, from == &copy ? e : other, box, reach);
    ASSERT_EQ(list.items.size(), targets);
    for (std::size_t i = 0; i < targets; ++i) {
      auto const& items = list.items[i];
      auto const count = static_cast<std::ptrdiff_t>(list.length[list_rings - 1][i]);
      ASSERT_TRUE(std::all_of(items.begin() + count, items.end(), [&](auto item) {
        return item == item_of_row(from->sentinel());
      })) << "padding stands last";
      std::set<std::uint32_t> rows;
      for (std::ptrdiff_t k = 0; k < count; ++k) rows.insert(static_cast<std::uint32_t>(row_of_item(items[k])));
      ASSERT_EQ(rows.size(), static_cast<std::size_t>(count)) << "a neighbour stands twice";
      std::size_t near = 0;
      for (std::uint32_t j = 0; j <= from->total(); ++j) {
        if (j == from->sentinel() || (from == &copy && i == j)) {
          ASSERT_EQ(rows.count(j), 0u);
          continue;
        }
        double const square = distance2<D>(copy, i, *from, j);
        if (square < reach * reach) {
          ++near;
          ASSERT_EQ(rows.count(j), 1u);
        } else if (square > reach * reach * (1 + 1e-4)) {
          ASSERT_EQ(rows.count(j), 0u);
        }
      }
      ASSERT_EQ(near, expected[copy.order()[i]]) << "images are missing";
      // And no ring lacks what is nearer than its outer radius.
      for (int r = 0; r < list_rings; ++r) {
        double const radius = reach - skin + skin * (r + 1) / list_rings;
        auto const read = static_cast<std::ptrdiff_t>(list.length[static_cast<std::size_t>(r)][i]);
        for (std::ptrdiff_t k = read; k < count; ++k)
          ASSERT_GE(distance2<D>(copy, i, *from, row_of_item(items[k])), radius * radius) << "ring " << r;
      }
    }
    for (int const threads : {2, 3}) EXPECT_EQ(near_pairs(copy, *from, reach, threads, skin), list);
  }
  // From the references, after everybody has moved: the same list, in the same order.
  auto const list = near_pairs(copy, copy, reach, 1);
  auto const references = copy.built_references();
  for (auto& p : e) p.position = p.position + 0.01;
  copy.refresh(1);
  SortedCopy again(e, box);
  again.build(reach, references);
  EXPECT_EQ(near_pairs(again, again, reach, 2), list);
}

TEST(NearPairs, AreThoseWithinReach) {
  for (auto const& kinds : {all_periodic, mixed, none_periodic}) {
    for (std::size_t const count : {0, 1, 2, 7, 120})
      for (double const reach : {0.4, 1.3, 3.1}) {
        compare_list<1>({4, 0, 0}, kinds, reach, count, 50);
        compare_list<2>({4, 3, 0}, kinds, reach, count, 50);
        if (reach < 3) compare_list<3>({4, 3, 3.5}, kinds, reach, count, 50);
      }
    compare_list<1>({1.3, 0, 0}, kinds, 2.9, 30, 20);  // several images
    compare_list<2>({1.3, 1.1, 0}, kinds, 2.9, 20, 10);
    compare_list<3>({1.3, 1.1, 1.4}, kinds, 2.2, 10, 10);
    compare_list<2>({9, 9, 0}, kinds, 0.3, 150, 60, 1e-2);  // clustered
    compare_list<3>({9, 9, 9}, kinds, 0.3, 150, 60, 1e-2);
    compare_list<2>({9, 9, 0}, kinds, 0.3, 40, 30, 0);  // most of them at one place
  }
  compare_list<2>({60, 60, 0}, all_periodic, 0.9, 2500, 10);  // more than one range of a thread
}

TEST(NearPairs, FarFromTheOriginRoundingIsWiderThanTheReach) {
  // 1e14 reaches away cells are narrower than what positions are rounded to: everybody is asked, nothing overflows.
  Box const box = make_box<3>({10, 1e14, 10}, all_periodic);
  Ensemble<Newton<3>> gas("gas", 100);
  scatter(gas, box, 3);
  double const x0 = box.low(0), y0 = box.low(1);
  for (std::size_t i = 0; i < 100; i += 2) {  // pairs
    gas[i].position[1] = y0 + 1e12 + 1.9e12 * static_cast<double>(i / 2);
    gas[i + 1].position = gas[i].position;
    gas[i + 1].position[0] += gas[i].position[0] > x0 + 5 ? -0.2 : 0.2;
  }
  SortedCopy copy(gas, box);
  copy.build(0.4);
  copy.refresh(1);
  Rows const rows = near_pairs(copy, copy, 0.4, 1);
  for (std::size_t k = 0; k < 100; ++k) {
    ASSERT_GE(rows.length[list_rings - 1][k], 1U);
    std::size_t const partner = copy.order()[k] ^ 1U;
    auto const& items = rows.items[k];
    EXPECT_TRUE(std::any_of(items.begin(), items.end(), [&](auto item) {
      std::size_t const row = row_of_item(item);
      return row != copy.sentinel() && copy.order()[copy.owner(row)] == partner;
    }));
  }
}

TEST(NearPairs, AFarParticleOfAnOpenBoxCostsNoMemory) {
  Box const box = make_box<3>({10, 10, 10}, none_periodic);
  Ensemble<Newton<3>> e("e", 400);
  scatter(e, box, 5);
  e[17].position = {1e12, -1e12, 1e12};
  SortedCopy copy(e, box);
  largest_allocation = 0;
  copy.build(1.0);
  copy.refresh(1);
  auto const list = near_pairs(copy, copy, 1.0, 1);
  EXPECT_LT(largest_allocation, 200000u);
  auto const expected = neighbours_of(e, e, box, 1.0);
  for (std::size_t k = 0; k < e.size(); ++k) {
    EXPECT_EQ(list.length[list_rings - 1][k], expected[copy.order()[k]]);
  }
  EXPECT_EQ(expected[17], 0u);
}

// ---- connections --------------------------------------------------------------------------------------------------

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

/// The pairs of a full list, each as (smaller, larger); checks that the list is sorted, symmetric and padded.
Pairs pairs_of(PartnerList const& list) {
  Pairs pairs;
  std::multiset<std::pair<std::uint32_t, std::uint32_t>> both;
  for (std::uint32_t i = 0; i + 1 < list.start.size(); ++i) {
    EXPECT_EQ((list.start[i + 1] - list.start[i]) % PartnerList::padding, 0u);
    bool padding = false;
    std::uint32_t last = 0;
    bool first = true;
    for (std::size_t k = list.start[i]; k < list.start[i + 1]; ++k) {
      std::uint32_t const j = list.index[k];
      if (j == i) {
        padding = true;
        continue;
      }
      EXPECT_FALSE(padding) << "a partner behind the padding";
      EXPECT_TRUE(first || j > last) << "partners are not in order";
      first = false;
      last = j;
      pairs.insert(std::minmax(i, j));
      both.insert({i, j});
    }
  }
  EXPECT_EQ(both.size(), 2 * pairs.size()) << "each pair stands once on either side";
  for (auto const& [i, j] : both) EXPECT_EQ(both.count({j, i}), 1u);
  return pairs;
}

TEST(Connections, AreThePairsOfSection43) {
  auto const pairs = [](Connection c, std::size_t size) { return pairs_of(connected_pairs(std::span(&c, 1), size)); };
  EXPECT_EQ(pairs({0, 5, 2}, 6), (Pairs{{0, 2}, {2, 4}}));
  EXPECT_EQ(pairs({0, 4, 1}, 25), (Pairs{{0, 1}, {1, 2}, {2, 3}, {3, 4}}));
  EXPECT_EQ(pairs({1, 21, 5}, 25), (Pairs{{1, 6}, {6, 11}, {11, 16}, {16, 21}}));
  EXPECT_EQ(pairs({3, 3, 1}, 4), Pairs{});
  EXPECT_EQ(pairs({0, 3, 4}, 4), Pairs{});
  EXPECT_EQ(pairs({0, 3, 3}, 4), (Pairs{{0, 3}}));
  EXPECT_EQ(pairs({1, 3, std::numeric_limits<std::size_t>::max()}, 4), Pairs{});
  EXPECT_EQ(pairs_of(connected_pairs({}, 3)), Pairs{});
  EXPECT_EQ(connected_pairs({}, 0).start, (std::vector<std::size_t>{0}));
}

TEST(Connections, UnionsHaveEachPairOnce) {
  std::mt19937_64 random(test_seed(3));
  for (int trial = 0; trial < 300; ++trial) {
    std::size_t const size = 1 + random() % 40;
    std::vector<Connection> connections(random() % 6);
    Pairs expected;
    bool repeated = false;
    for (auto& c : connections) {
      c.first = random() % size;
      c.last = c.first + random() % (size - c.first);
      c.interval = 1 + random() % 7;
      // {(i, i + k), ..., (i + (floor((j - i) / k) - 1) k, i + floor((j - i) / k) k)}
      for (std::size_t m = 0; m < (c.last - c.first) / c.interval; ++m)
        repeated = !expected
                        .insert({static_cast<std::uint32_t>(c.first + m * c.interval),
                                 static_cast<std::uint32_t>(c.first + (m + 1) * c.interval)})
                        .second ||
                   repeated;
    }
    if (repeated) {
      EXPECT_THROW(connected_pairs(connections, size), Error);
      continue;
    }
    auto const list = connected_pairs(connections, size);
    ASSERT_EQ(list.start.size(), size + 1);
    ASSERT_EQ(pairs_of(list), expected);
  }
}

TEST(Connections, MistakesAreNamed) {
  auto const message = [](Connection c, std::size_t size) -> std::string {
    try {
      connected_pairs(std::span(&c, 1), size);
    } catch (Error const& error) {
      return error.what();
    }
    return "nothing was thrown";
  };
  EXPECT_EQ(message({0, 5, 0}, 9), "connection 0:5:0: the interval is at least 1");
  EXPECT_EQ(message({5, 2, 1}, 9), "connection 5:2:1 runs backwards");
  EXPECT_EQ(message({0, 9, 1}, 9), "connection 0:9:1 names particle 9, but there are 9 (0 to 8)");
  EXPECT_NE(message({0, 0, 1}, 0).find("names particle 0, but there are 0"), std::string::npos);
}

}  // namespace
}  // namespace boltzmann::neighbours_test
