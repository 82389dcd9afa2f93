// Images beyond walls against brute force: which there are (own ones, corners, with periodic axes), what they carry by
// the rules of walls, and that lists stay right while particles and walls move.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/tensor.hpp>
#include <boltzmann/neighbours/neighbour_list.hpp>
#include <boltzmann/neighbours/sorted_copy.hpp>
#include <boltzmann/particles/newton.hpp>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

namespace boltzmann::mirror_images_test {
namespace {

using End = Box::End;

/// A continuum's particle: one field for each rule. The mass is the particle's number.
template <int D, class Real = double>
struct Gas : Newton<D, Real> {
  static constexpr char const* class_name = "Gas";
  Real temperature;
  Vector<D, Real> gradient, heat_flux;
  Tensor<D, Real> stress;
  static FieldTable fields() {
    return Newton<D, Real>::fields()
        .add(&Gas::temperature, "temperature", dimensions::temperature, "temperature")
        .add(&Gas::gradient, "gradient", dimensions::none, "gradient of something even")
        .add(&Gas::heat_flux, "heat_flux", dimensions::none, "of temperature")
        .add(&Gas::stress, "stress", dimensions::none, "symmetric");
  }
};

/// The rules for a Gas, and for extra blocks: the first holds a velocity and a temperature, the others what is the
/// same.
template <int D>
std::vector<ImageComponent> rules(AnyEnsemble const& e, std::size_t extra) {
  std::vector<ImageComponent> rules(e.stride() + 4 * extra);
  auto const vector = [&](std::size_t offset, ImageRule rule) {
    for (int a = 0; a < D; ++a) rules[offset + a] = {rule, a, 0};
  };
  auto const offset = [&](char const* name) { return static_cast<std::size_t>(e.field(name).offset); };
  vector(offset("position"), ImageRule::position);
  vector(offset("velocity"), ImageRule::velocity);
  vector(offset("gradient"), ImageRule::normal_vector);
  vector(offset("heat_flux"), ImageRule::heat_flux);
  rules[offset("temperature")] = {ImageRule::temperature, 0, 0};
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) rules[offset("stress") + D * a + b] = {ImageRule::tensor, a, b};
  if (extra > 0) {
    vector(e.stride(), ImageRule::velocity);
    rules[e.stride() + 3] = {ImageRule::temperature, 0, 0};
  }
  return rules;
}

/// What happens at the ends of an axis, for all combinations of them.
enum class Ends { open, periodic, mirror, only_low, only_high };
constexpr std::array all_ends{Ends::open, Ends::periodic, Ends::mirror, Ends::only_low, Ends::only_high};

Wall random_wall(std::mt19937_64& random, double speed) {
  auto const number = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  Wall wall;
  wall.slips = random() % 2 == 0;
  for (double& u : wall.velocity) u = number(-speed, speed);
  if (random() % 2 == 0) wall.temperature = number(0.5, 3);
  return wall;
}

template <int D>
Box make_box(std::array<Ends, 3> const& ends, std::array<double, 3> const& length, std::mt19937_64& random,
             double speed = 1) {
  std::array<double, 3> low{}, high{};
  std::array<Boundary, 3> kinds{};
  for (int a = 0; a < D; ++a) {
    low[a] = -0.3 * length[a];
    high[a] = low[a] + length[a];
    kinds[a] = ends[a] == Ends::open       ? Boundary::open
               : ends[a] == Ends::periodic ? Boundary::periodic
                                           : Boundary::mirror;
  }
  Box box(D, low, high, kinds);
  for (int a = 0; a < D; ++a) {
    if (kinds[a] != Boundary::mirror) continue;
    for (End const end : {End::low, End::high}) box.wall(a, end, random_wall(random, speed));
    if (ends[a] == Ends::only_low) box.open_end(a, End::high);
    if (ends[a] == Ends::only_high) box.open_end(a, End::low);
  }
  return box;
}

template <int D>
void scatter(Ensemble<Gas<D>>& e, Box const& box, std::mt19937_64& random) {
  auto const number = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  for (std::size_t i = 0; i < e.size(); ++i) {
    double* row = e.row(i);
    for (std::size_t k = 0; k < e.doubles(); ++k) row[k] = number(-1, 1);
    for (int a = 0; a < D; ++a) row[a] = number(box.low(a), box.high(a));
    e[i].mass = static_cast<double>(i);
  }
}

// ---- brute force --------------------------------------------------------------------------------------------------

/// How an image is made: along each axis by so many lengths, or at the low (-1) or high (1) wall.
using Turns = std::array<int, 3>;

/// A reflection about a plane: its matrix is diagonal.
template <int D>
struct Reflection {
  int axis;
  Vector<D> operator()(Vector<D> v) const {
    v[axis] = -v[axis];
    return v;
  }
  Tensor<D> operator()(Tensor<D> t) const {  // R t R
    for (int b = 0; b < D; ++b) t[axis][b] = -t[axis][b];
    for (int b = 0; b < D; ++b) t[b][axis] = -t[b][axis];
    return t;
  }
};

/// Fields on the other side of a wall: v'(x') = R v(x), or - v(x), in the wall's frame of reference; T'(x') = T(x), or
/// odd about the wall's.
template <int D>
void mirror_at(Gas<D>& p, int axis, double place, Wall const& wall) {
  Reflection<D> const reflected{axis};
  Vector<D> u;
  for (int a = 0; a < D; ++a) u[a] = wall.velocity[a];
  p.position[axis] = place - (p.position[axis] - place);
  if (wall.slips) {
    Vector<D> normal{};
    normal[axis] = u[axis];
    p.velocity = normal + reflected(p.velocity - normal);
    p.stress = reflected(p.stress);
  } else {
    p.velocity = u - (p.velocity - u);
  }
  p.gradient = reflected(p.gradient);
  if (std::isnan(wall.temperature)) {
    p.heat_flux = reflected(p.heat_flux);  // grad T' = R grad T
  } else {
    p.temperature = wall.temperature - (p.temperature - wall.temperature);
    p.heat_flux = -reflected(p.heat_flux);
  }
}

/// The image: its axes taken in every order, and the mean of what comes out.
template <int D>
Gas<D> image_of(Gas<D> const& p, Turns const& turns, Box const& box) {
  std::vector<int> axes;
  for (int a = 0; a < D; ++a)
    if (turns[a] != 0) axes.push_back(a);
  constexpr std::size_t numbers = sizeof(Gas<D>) / sizeof(double);
  std::array<double, numbers> sum{};
  int orders = 0;
  do {
    Gas<D> q = p;
    for (int const a : axes) {
      if (box.periodic(a))
        q.position[a] += turns[a] * box.length(a);
      else
        mirror_at(q, a, turns[a] < 0 ? box.low(a) : box.high(a), box.wall(a, turns[a] < 0 ? End::low : End::high));
    }
    std::array<double, numbers> each;
    std::memcpy(each.data(), &q, sizeof(q));
    for (std::size_t k = 0; k < numbers; ++k) sum[k] += each[k];
    ++orders;
  } while (std::next_permutation(axes.begin(), axes.end()));
  for (double& x : sum) x /= orders;
  Gas<D> mean;
  std::memcpy(static_cast<void*>(&mean), sum.data(), sizeof(mean));
  return mean;
}

/// Its position alone.
template <int D>
Vector<D> place_of(Vector<D> x, Turns const& turns, Box const& box) {
  for (int a = 0; a < D; ++a) {
    if (box.periodic(a))
      x[a] += turns[a] * box.length(a);
    else if (turns[a] != 0)
      x[a] = 2 * (turns[a] < 0 ? box.low(a) : box.high(a)) - x[a];
  }
  return x;
}

/// All turns that there may be, none included.
template <int D>
std::vector<Turns> all_turns(Box const& box, double reach) {
  std::array<int, 3> low{}, high{};
  for (int a = 0; a < D; ++a) {
    if (box.periodic(a)) high[a] = static_cast<int>(reach / box.length(a)) + 2, low[a] = -high[a];
    if (box.walled(a, End::low)) low[a] = -1;
    if (box.walled(a, End::high)) high[a] = 1;
  }
  std::vector<Turns> all;
  for (int x = low[0]; x <= high[0]; ++x)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int z = low[2]; z <= high[2]; ++z) all.push_back({x, y, z});
  return all;
}

struct Ghost {
  std::size_t particle;
  Turns turns;
};

/// The images that are within reach of the box as everything stands.
template <int D>
std::vector<Ghost> ghosts_of(Ensemble<Gas<D>> const& e, Box const& box, double reach) {
  std::vector<Ghost> ghosts;
  for (std::size_t i = 0; i < e.size(); ++i)
    for (auto const& turns : all_turns<D>(box, reach)) {
      if (turns == Turns{}) continue;
      auto const place = place_of<D>(e[i].position, turns, box);
      bool inside = true;
      for (int a = 0; a < D; ++a)
        inside = inside && (turns[a] == 0 || (place[a] >= box.low(a) - reach && place[a] <= box.high(a) + reach));
      if (inside) ghosts.push_back({i, turns});
    }
  return ghosts;
}

double at(SortedCopy const& copy, std::size_t k, std::size_t c) {
  return copy.block(c / row_block)[row_block * k + c % row_block];
}

template <int D>
Gas<D> row_of(SortedCopy const& copy, std::size_t k) {
  Gas<D> p;
  std::array<double, sizeof(Gas<D>) / sizeof(double)> numbers;
  for (std::size_t c = 0; c < numbers.size(); ++c) numbers[c] = at(copy, k, c);
  std::memcpy(static_cast<void*>(&p), numbers.data(), sizeof(p));
  return p;
}

/// The rows behind the owned ones are exactly these images, in all that they carry.
template <int D>
void expect_images(SortedCopy const& copy, Ensemble<Gas<D>> const& e, Box const& box,
                   std::vector<Ghost> const& ghosts) {
  ASSERT_EQ(copy.owned(), e.size());
  ASSERT_EQ(copy.total(), e.size() + ghosts.size());
  std::vector<Gas<D>> owned(e.size());  // where the sorted copy has them: periodic axes may have wrapped them since
  for (std::size_t k = 0; k < e.size(); ++k) {
    auto const& particle = e[copy.order()[k]];
    owned[copy.order()[k]] = row_of<D>(copy, k);
    for (std::size_t c = 0; c < e.doubles(); ++c)
      if (c >= D || !box.periodic(static_cast<int>(c))) {
        ASSERT_EQ(at(copy, k, c), e.row(copy.order()[k])[c]);
      } else {
        double const turns = (at(copy, k, c) - particle.position[c]) / box.length(static_cast<int>(c));
        ASSERT_NEAR(turns, std::nearbyint(turns), 1e-14);
      }
  }
  std::vector<std::vector<Gas<D>>> expected(e.size());
  for (auto const& ghost : ghosts)
    expected[ghost.particle].push_back(image_of<D>(owned[ghost.particle], ghost.turns, box));
  for (std::size_t k = copy.owned() + 1; k <= copy.total(); ++k) {
    auto const row = row_of<D>(copy, k);
    auto& images = expected[static_cast<std::size_t>(row.mass)];
    auto const found = std::find_if(images.begin(), images.end(), [&](Gas<D> const& image) {
      double largest = 0;
      for (std::size_t c = 0; c < sizeof(row) / sizeof(double); ++c) {
        double x = 0;
        std::memcpy(&x, reinterpret_cast<char const*>(&image) + c * sizeof(double), sizeof(double));
        largest = std::max(largest, std::abs(x - at(copy, k, c)));
      }
      return largest < 1e-13;
    });
    ASSERT_NE(found, images.end()) << "a row that is no image";
    images.erase(found);
  }
}

std::string words(std::array<Ends, 3> const& ends, int dimension) {
  std::string text;
  for (int a = 0; a < dimension; ++a) text += std::to_string(static_cast<int>(ends[a])) + " ";
  return text;
}

/// Calls test(ends) for all combinations of axes.
template <int D, class Test>
void each_kind_of_box(Test const& test) {
  for (Ends const x : all_ends)
    for (Ends const y : all_ends)
      for (Ends const z : all_ends) {
        if ((D < 2 && y != Ends::open) || (D < 3 && z != Ends::open)) continue;
        SCOPED_TRACE(std::to_string(D) + "D, ends " + words({x, y, z}, D));
        test(std::array{x, y, z});
        if (::testing::Test::HasFatalFailure()) return;
      }
}

// ---- which images, and what they carry ----------------------------------------------------------------------------

template <int D>
void images_are_right(std::array<Ends, 3> const& ends, std::size_t count, double reach) {
  std::mt19937_64 random(test_seed(count + 100U * D));
  Box box = make_box<D>(ends, {1.7, 1.9, 1.8}, random);
  for (int a = 0; a < D; ++a)  // shorter than the reach: several images
    if (ends[a] == Ends::periodic && a == 0) box = make_box<D>(ends, {1.1, 1.9, 1.8}, random);
  Ensemble<Gas<D>> e("gas", count);
  scatter<D>(e, box, random);
  SortedCopy copy(e, box, 2);
  copy.components(rules<D>(e, 2));
  copy.build(reach);
  auto const ghosts = ghosts_of<D>(e, box, reach);
  EXPECT_EQ(copy.refresh(1), count > 0);
  ASSERT_NO_FATAL_FAILURE(expect_images<D>(copy, e, box, ghosts));
  EXPECT_FALSE(copy.refresh(2));
  EXPECT_TRUE(copy.is_current());
  EXPECT_LT(copy.largest2(), 1e-28);

  // Extra blocks are nowhere until they are filled, and stay so in the sentinel.
  ASSERT_EQ(copy.extra_blocks(), 2u);
  for (std::size_t b = copy.blocks(); b < copy.blocks() + 2; ++b)
    for (std::size_t n = 0; n < 4 * (copy.total() + 1); ++n) ASSERT_TRUE(std::isnan(copy.block(b)[n]));
  std::size_t const extra = 4 * copy.blocks();
  for (std::size_t k = 0; k < copy.owned(); ++k)
    for (std::size_t n = 0; n < 4; ++n) {
      // The first block a copy of velocity and temperature, the second of something.
      auto const& p = e[copy.order()[k]];
      copy.block(copy.blocks())[4 * k + n] = n == 3 ? p.temperature : n < D ? p.velocity[n] : 0.25;
      copy.block(copy.blocks() + 1)[4 * k + n] = 10 * p.mass + static_cast<double>(n);
    }
  copy.refresh_images(copy.blocks(), copy.blocks() + 2, 2);
  for (std::size_t k = copy.owned() + 1; k <= copy.total(); ++k) {
    auto const row = row_of<D>(copy, k);
    for (int a = 0; a < D; ++a) ASSERT_EQ(at(copy, k, extra + a), row.velocity[a]);
    ASSERT_EQ(at(copy, k, extra + 3), row.temperature);
    for (std::size_t n = 0; n < 4; ++n) ASSERT_EQ(at(copy, k, extra + 4 + n), 10 * row.mass + static_cast<double>(n));
  }
  for (std::size_t n = 0; n < 4; ++n) ASSERT_TRUE(std::isnan(at(copy, copy.sentinel(), extra + n)));

  // Particles and walls move: the images of the same particles, about the walls as they are now, with the extra blocks
  // as they were.
  for (double const time : {0.02, 0.05, 0.03}) {
    for (std::size_t i = 0; i < count; ++i)
      for (int a = 0; a < D; ++a) {
        e[i].position[a] += 0.01 * std::normal_distribution()(random);
        e[i].velocity[a] += 0.1;
      }
    box.move_walls(time);
    EXPECT_EQ(copy.is_current(), count == 0 && !box.walls_move());
    EXPECT_EQ(copy.refresh(2), count > 0 || box.walls_move());
    ASSERT_NO_FATAL_FAILURE(expect_images<D>(copy, e, box, ghosts));
    EXPECT_TRUE(copy.is_current());
    for (std::size_t k = copy.owned() + 1; k <= copy.total(); ++k)
      ASSERT_EQ(at(copy, k, extra + 4), 10 * at(copy, k, D));
  }

  // From the references and edges of the build, at the state of now: the same rows in the same order.
  SortedCopy again(e, box, 2);
  again.components(rules<D>(e, 2));
  again.build(reach, copy.built_references(), copy.built_edges(), copy.built_slide());
  again.refresh(1);
  EXPECT_EQ(again.built_edges(), copy.built_edges());
  EXPECT_EQ(again.largest2(), copy.largest2());
  ASSERT_EQ(again.total(), copy.total());
  EXPECT_TRUE(std::equal(again.order(), again.order() + count, copy.order()));
  for (std::size_t k = 0; k <= again.total(); ++k)
    for (std::size_t c = 0; c < extra && k != again.sentinel(); ++c) ASSERT_EQ(at(again, k, c), at(copy, k, c));
}

TEST(WallImages, AreThoseOfBruteForce) {
  for (std::size_t const count : {0, 1, 2, 14})
    for (double const reach : {0.3, 1.6}) {
      each_kind_of_box<1>([&](auto const& ends) { images_are_right<1>(ends, count, reach); });
      each_kind_of_box<2>([&](auto const& ends) { images_are_right<2>(ends, count, reach); });
      each_kind_of_box<3>([&](auto const& ends) { images_are_right<3>(ends, count, reach); });
    }
}

TEST(WallImages, OneParticleInACornerHasThree) {
  Box box(Vector{0., 0.}, Vector{4., 4.}, Boundary::mirror);
  Wall cold;  // no slip
  cold.slips = false;
  cold.velocity = {2, 0, 0};
  cold.temperature = 1;
  box.wall(1, End::low, cold);
  Ensemble<Gas<2>> e("gas", 1);
  e[0].position = {0.25, 0.5};
  e[0].velocity = {1, 3};
  e[0].temperature = 5;
  e[0].heat_flux = {1, 2};
  e[0].stress = {1, 2, 3, 4};
  SortedCopy copy(e, box);
  copy.components(rules<2>(e, 0));
  copy.build(1);
  copy.refresh(1);
  ASSERT_EQ(copy.total(), 4u);
  int seen = 0;
  for (std::size_t k = 2; k <= 4; ++k) {
    auto const p = row_of<2>(copy, k);
    if (p.position == Vector{-0.25, 0.5}) {  // its own image: slippery, insulated
      ++seen;
      EXPECT_EQ(p.velocity, (Vector{-1., 3.}));
      EXPECT_EQ(p.temperature, 5);
      EXPECT_EQ(p.heat_flux, (Vector{-1., 2.}));
      EXPECT_EQ(p.stress, (Tensor<2>{1, -2, -3, 4}));
    } else if (p.position == Vector{0.25, -0.5}) {  // v' = 2 u - v, T' = 2 T_wall - T
      ++seen;
      EXPECT_EQ(p.velocity, (Vector{3., -3.}));
      EXPECT_EQ(p.temperature, -3);
      EXPECT_EQ(p.heat_flux, (Vector{-1., 2.}));
      EXPECT_EQ(p.stress, (Tensor<2>{1, 2, 3, 4}));
    } else if (p.position == Vector{-0.25, -0.5}) {
      ++seen;  // the walls' velocities along x are 0 and 2: the mean of both orders
      EXPECT_EQ(p.velocity, (Vector{1., -3.}));
      EXPECT_EQ(p.temperature, -3);
      EXPECT_EQ(p.heat_flux, (Vector{1., 2.}));
      EXPECT_EQ(p.stress, (Tensor<2>{1, -2, -3, 4}));
    }
  }
  EXPECT_EQ(seen, 3);
  // On a wall the image is at the same place; and the list has it.
  e[0].position = {0, 2};
  copy.build(1);
  copy.refresh(1);
  ASSERT_EQ(copy.total(), 2u);
  EXPECT_EQ(row_of<2>(copy, 2).position, e[0].position);
  NeighbourList list;
  list.build(copy, copy, 1, 0, 1);
  ASSERT_EQ(list.lengths(0)[0], 1u);
  EXPECT_EQ(list.rows()[0][0], item_of_row(2));
}

TEST(WallImages, WithoutRulesPositionAndVelocityAreKnown) {
  Box box(Vector{0., 0.}, Vector{4., 4.}, {Boundary::mirror, Boundary::open});
  Ensemble<Gas<2>> e("gas", 1);
  e[0].position = {0.25, -7};
  e[0].velocity = {1, -0.0};
  e[0].temperature = 5;
  e[0].heat_flux = {1, 2};
  SortedCopy copy(e, box);
  copy.build(1);
  copy.refresh(1);
  ASSERT_EQ(copy.total(), 2u);
  auto const p = row_of<2>(copy, 2);
  EXPECT_EQ(p.position, (Vector{-0.25, -7.}));
  EXPECT_EQ(p.velocity, (Vector{-1., 0.}));
  EXPECT_TRUE(std::signbit(p.velocity[1])) << "what is the same is so to the last bit";
  EXPECT_EQ(p.temperature, 5);
  EXPECT_EQ(p.heat_flux, e[0].heat_flux);
}

TEST(WallImages, MistakesAreNamed) {
  Box box(Vector{0., 0.}, Vector{2., 3.}, {Boundary::mirror, Boundary::mirror});
  Ensemble<Gas<2>> e("gas", 1);
  SortedCopy copy(e, box, 1);
  EXPECT_EQ(message([&] { copy.build(2.5); }),
            "neighbours of 'gas' are found up to a distance of 2.5, the walls of axis x are 2 apart: they must not be "
            "nearer to each other than that");
  EXPECT_EQ(message([&] { copy.build(2); }), "no error");
  box.open_end(0, End::high);
  EXPECT_EQ(message([&] { copy.build(2.5); }), "no error");
  EXPECT_NE(message([&] { copy.components({}); }).find("transformations for 0 numbers of a row, which has 20"),
            std::string::npos);
  auto wrong = rules<2>(e, 1);
  wrong[7] = {ImageRule::tensor, 0, 2};
  EXPECT_NE(message([&] { copy.components(wrong); }).find("a rule names axis 2, the box has 2"), std::string::npos);
}

// ---- lists --------------------------------------------------------------------------------------------------------

/// Every pair of a particle and somebody or his image (its own, too) within the cut-off stands in the list, up to the
/// ring that the displacement demands. Returns how many pairs there are.
template <int D>
std::size_t expect_complete(NeighbourList const& list, SortedCopy const& copy, Ensemble<Gas<D>> const& e,
                            Box const& box, double cutoff, double skin) {
  int ring = 0;
  while (ring < list_rings && std::sqrt(copy.largest2()) > 0.5 * skin * (ring + 1) / list_rings) ++ring;
  EXPECT_LT(ring, list_rings) << "the list would not hold";
  if (ring == list_rings) return 0;
  std::size_t pairs = 0;
  auto const turns_here = all_turns<D>(box, cutoff);
  for (std::size_t k = 0; k < copy.owned(); ++k) {
    auto const& p = e[copy.order()[k]];
    std::vector<double> expected, found;
    for (std::size_t j = 0; j < e.size(); ++j)
      for (auto const& turns : turns_here) {
        if (j == copy.order()[k] && turns == Turns{}) continue;
        double const distance2 = norm2(place_of<D>(e[j].position, turns, box) - p.position);
        if (distance2 < cutoff * cutoff * (1 - 1e-9)) expected.push_back(distance2);
      }
    for (std::uint32_t n = 0; n < list.lengths(ring)[k]; ++n) {
      std::size_t const row = row_of_item(list.rows()[k][n]);
      double distance2 = 0;
      for (int a = 0; a < D; ++a)
        distance2 += (at(copy, row, a) - at(copy, k, a)) * (at(copy, row, a) - at(copy, k, a));
      if (distance2 < cutoff * cutoff * (1 - 1e-9)) found.push_back(distance2);
    }
    std::sort(expected.begin(), expected.end());
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found.size(), expected.size()) << "particle " << copy.order()[k];
    for (std::size_t n = 0; n < std::min(found.size(), expected.size()); ++n) EXPECT_NEAR(found[n], expected[n], 1e-12);
    pairs += expected.size();
  }
  return pairs;
}

/// Walls that go to and fro, particles that wander, some of which get new references on the way.
template <int D>
void lists_hold(std::array<Ends, 3> const& ends, std::size_t count) {
  std::mt19937_64 random(test_seed(200U * D));
  double const cutoff = 0.8, skin = 0.4;
  Box box = make_box<D>(ends, {1.7, 1.6, 1.5}, random, 0.05);
  Ensemble<Gas<D>> e("gas", count);
  scatter<D>(e, box, random);
  SortedCopy copy(e, box);
  copy.build(cutoff + skin);
  copy.refresh(1);
  NeighbourList list;
  list.build(copy, copy, cutoff, skin, 1);
  std::size_t pairs = expect_complete<D>(list, copy, e, box, cutoff, skin);
  for (double const time : {0.25, 0.6, 0.3, -0.4}) {
    for (std::size_t i = 0; i < count; ++i)
      for (int a = 0; a < D; ++a) e[i].position[a] += std::uniform_real_distribution(-0.02, 0.02)(random);
    // One particle jumps, across everything.
    std::size_t const knocked = random() % count;
    for (int a = 0; a < D; ++a)
      e[knocked].position[a] = std::uniform_real_distribution(box.low(a) + 0.05, box.high(a) - 0.05)(random);
    box.move_walls(time);
    copy.refresh(1);
    double const allowed = 0.17;
    auto const moved = copy.beyond(allowed * allowed, count).value();
    ASSERT_LE(moved.size(), 2u);
    std::vector<std::uint32_t> affected(moved);
    auto const look_around = [&] {
      for (auto const row : moved) copy.owned_near(copy.references() + 4 * std::size_t{row}, cutoff + skin, affected);
    };
    look_around();
    copy.move(moved);
    look_around();
    std::sort(affected.begin(), affected.end());
    affected.erase(std::unique(affected.begin(), affected.end()), affected.end());
    list.rebuild(copy, copy, affected);
    copy.refresh(1);
    EXPECT_LE(copy.largest2(), allowed * allowed * (1 + 1e-9));
    pairs += expect_complete<D>(list, copy, e, box, cutoff, skin);
    ASSERT_FALSE(::testing::Test::HasFailure());
  }
  EXPECT_GT(pairs, count);
}

TEST(WallLists, HoldWhileWallsAndParticlesMove) {
  each_kind_of_box<1>([&](auto const& ends) { lists_hold<1>(ends, 12); });
  each_kind_of_box<2>([&](auto const& ends) { lists_hold<2>(ends, 25); });
  each_kind_of_box<3>([&](auto const& ends) { lists_hold<3>(ends, 40); });
}

TEST(WallLists, AreReadFurtherAsWallsComeCloser) {
  double const cutoff = 0.8, skin = 0.4, u = 0.1;
  Box box(Vector{0., 0.}, Vector{3., 3.}, Boundary::mirror);
  for (int const a : {0, 1}) {
    Wall wall;
    wall.velocity[a] = -u;
    box.wall(a, End::high, wall);
  }
  std::mt19937_64 random(test_seed(7));
  Ensemble<Gas<2>> e("gas", 150);
  scatter<2>(e, box, random);
  for (auto& p : e) p.position *= 0.9;  // so that the walls don't reach them
  SortedCopy copy(e, box);
  copy.build(cutoff + skin);
  copy.refresh(1);
  NeighbourList list;
  list.build(copy, copy, cutoff, skin, 1);
  std::size_t last = 0;
  for (double const moved : {0.0, 0.049, 0.099, 0.149, 0.1999}) {  // one ring more each time
    box.move_walls(moved / std::sqrt(2.0) / u);
    copy.refresh(1);
    EXPECT_NEAR(std::sqrt(copy.largest2()), moved, 1e-14);
    std::size_t const pairs = expect_complete<2>(list, copy, e, box, cutoff, skin);
    EXPECT_GT(pairs, last);  // nobody moves, images come
    last = pairs;
  }
}

TEST(WallLists, NewImagesOfMovedRowsHaveTheirExtraBlocks) {
  Box box(Vector{0., 0.}, Vector{9., 9.}, {Boundary::mirror, Boundary::periodic});
  Ensemble<Gas<2>> e("gas", 40);
  for (auto& p : e) p.position = {4, 4};  // nobody has an image
  SortedCopy copy(e, box, 1);
  copy.components(rules<2>(e, 1));
  copy.build(1);
  copy.refresh(1);
  ASSERT_EQ(copy.total(), 40u);
  std::size_t const extra = copy.blocks();
  for (std::size_t n = 0; n < 160; ++n) copy.block(extra)[n] = 1 + static_cast<double>(n);
  std::vector<std::uint32_t> rows(40);
  for (std::uint32_t k = 0; k < 40; ++k) rows[k] = k;
  for (auto& p : e) p.position = {0.5, 8.75};  // everybody has three: more room is needed
  copy.refresh(1);
  copy.move(rows);
  ASSERT_EQ(copy.total(), 160u);
  std::array<int, 2> signs{};
  for (std::size_t k = 41; k <= 160; ++k) {
    std::size_t const source = static_cast<std::size_t>(at(copy, k, 4 * extra + 3)) / 4 - 1;
    ASSERT_LT(source, 40u);
    bool const reflected = at(copy, k, 0) < 0;
    ++signs[reflected ? 1 : 0];
    ASSERT_EQ(at(copy, k, 4 * extra), reflected ? -(1.0 + 4 * source) : 1.0 + 4 * source);
    ASSERT_EQ(at(copy, k, 4 * extra + 1), 2.0 + 4 * source);
  }
  EXPECT_EQ(signs, (std::array{40, 80}));
}

TEST(WallLists, TheMotionOfWallsIsDisplacementOfAll) {
  Box box(Vector{0., 0.}, Vector{4., 4.}, Boundary::mirror);
  Wall east, north;
  east.velocity = {-0.3, 9, 0};
  north.velocity = {0, 0.4, 0};
  box.wall(0, End::high, east);
  box.wall(1, End::high, north);
  Ensemble<Gas<2>> e("gas", 3);
  e[0].position = {3.5, 3.75};
  e[1].position = {1, 1};
  e[2].position = {2, 3};
  SortedCopy copy(e, box);
  copy.build(1);
  copy.refresh(1);
  EXPECT_EQ(copy.largest2(), 0);
  box.move_walls(0.5);
  EXPECT_TRUE(copy.refresh(1));  // nobody has moved, but his image has
  // The corner image of particle 0 has moved by 2 (0.15, 0.2), of which it and its particle take half each.
  EXPECT_NEAR(std::sqrt(copy.largest2()), 0.25, 1e-15);
  e[1].position[0] += 0.5;
  copy.refresh(1);
  EXPECT_NEAR(std::sqrt(copy.largest2()), 0.75, 1e-15);
  EXPECT_EQ(copy.beyond(0.8 * 0.8, 9).value().size(), 0u);
  auto const one = copy.beyond(0.7 * 0.7, 9).value();
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(copy.order()[one[0]], 1u);
  EXPECT_EQ(copy.beyond(0.2 * 0.2, 3).value().size(), 3u);  // walls have moved further: no new reference helps
  EXPECT_FALSE(copy.beyond(0.2 * 0.2, 2));                  // they are more
  copy.build(1);
  copy.refresh(1);
  EXPECT_EQ(copy.largest2(), 0);
}

}  // namespace
}  // namespace boltzmann::mirror_images_test
