// The kernels over connections against scalars, for every width of packs, and the same bits for every division into
// ranges.
#include <boltzmann/laws/spring.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <cstring>
#include <random>
#include <set>

namespace boltzmann::connections_test {
namespace {

template <int D>
void scatter(Ensemble<Newton<D>>& lumps, double length) {
  std::mt19937_64 random(test_seed(1));
  std::uniform_real_distribution<double> place(0, length);
  for (auto& lump : lumps) {
    for (int a = 0; a < D; ++a) lump.position[a] = place(random);
    lump.mass = 1;
  }
}

struct Output {
  std::vector<double> influence, energy, virial;
  bool operator==(Output const&) const = default;
};

/// One partner after the other; `length` 0: no periodic axis.
template <int D>
Output by_scalars(Ensemble<Newton<D>> const& lumps, std::vector<Connection> const& connections, Spring const& law,
                  double length) {
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (auto const& c : connections)
    for (std::size_t i = c.first; i + c.interval <= c.last; i += c.interval) {
      pairs.insert({i, i + c.interval});
      pairs.insert({i + c.interval, i});
    }
  Output out{std::vector<double>(D * lumps.size()), std::vector<double>(lumps.size()),
             std::vector<double>(9 * lumps.size())};
  for (auto const& [i, j] : pairs) {
    auto const& p = lumps[i];
    Newton<D> q = lumps[j];
    for (int a = 0; a < D && length > 0; ++a)
      q.position[a] -= length * std::round((q.position[a] - p.position[a]) / length);
    auto const result = law(p, q);
    for (int a = 0; a < D; ++a) out.influence[i * D + a] += result.force[a];
    out.energy[i] += 0.5 * result.energy;
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b)
        out.virial[9 * i + 3 * a + b] -= 0.5 * (q.position[a] - p.position[a]) * result.force[b];
  }
  return out;
}

template <int W, int D>
Output by_kernel(Ensemble<Newton<D>> const& lumps, std::vector<Connection> const& connections, Spring const& law,
                 double length, std::size_t grain, bool overwrite = false) {
  constexpr auto kernels = connection_kernels<Newton<D>, Spring, W>();
  auto const list = connected_pairs(connections, lumps.size());
  Output out{std::vector<double>(D * lumps.size(), overwrite ? 1e9 : 0), std::vector<double>(lumps.size()),
             std::vector<double>(9 * lumps.size())};
  PairTask task;
  task.same = true;
  task.overwrite = overwrite;
  task.target = task.source = lumps.row(0);
  task.targets = task.sources = lumps.size();
  task.start = list.start.data();
  task.index = list.index.data();
  task.influence = out.influence.data();
  task.energy = out.energy.data();
  task.virial = out.virial.data();
  for (int a = 0; a < D && length > 0; ++a) task.period[a] = length, task.inverse_period[a] = 1 / length;
  for (std::size_t begin = 0; begin < lumps.size(); begin += grain) {
    std::size_t const end = std::min(begin + grain, lumps.size());
    kernels.connected(&law, task, begin, end);
    kernels.connected_measure(&law, task, begin, end);
  }
  return out;
}

void expect_near(std::vector<double> const& actual, std::vector<double> const& expected, char const* what) {
  ASSERT_EQ(actual.size(), expected.size());
  double scale = 0;
  for (double const x : expected) scale = std::max(scale, std::abs(x));
  for (std::size_t k = 0; k < actual.size(); ++k)
    ASSERT_NEAR(actual[k], expected[k], 1e-13 * scale) << what << ", number " << k;
}

template <int W, int D>
void compare(std::size_t count, std::vector<Connection> const& connections, double length) {
  SCOPED_TRACE(testing::Message() << "W = " << W << ", " << D << "D, " << count << " lumps, period " << length);
  Ensemble<Newton<D>> lumps("lumps", count);
  scatter(lumps, 5);
  Spring const law{.stiffness = 2, .rest_length = 0.3};
  Output const expected = by_scalars(lumps, connections, law, length);
  Output const whole = by_kernel<W>(lumps, connections, law, length, count + 1);
  expect_near(whole.influence, expected.influence, "influence");
  expect_near(whole.energy, expected.energy, "energy");
  expect_near(whole.virial, expected.virial, "virial");
  for (std::size_t const grain : {1, 3, 5, 8, 13, 64})
    EXPECT_TRUE(by_kernel<W>(lumps, connections, law, length, grain) == whole) << "ranges of " << grain;
  EXPECT_TRUE(by_kernel<W>(lumps, connections, law, length, 7, true).influence == whole.influence);
}

template <int W, int D>
void compare_all(double length) {
  compare<W, D>(0, {}, length);
  compare<W, D>(1, {}, length);
  compare<W, D>(2, {{0, 1}}, length);
  compare<W, D>(3, {{1, 2}}, length);
  compare<W, D>(50, {}, length);
  compare<W, D>(50, {{0, 49}}, length);                          // a chain
  compare<W, D>(61, {{0, 60}, {0, 60, 7}, {3, 58, 5}}, length);  // with springs between others across it
  std::vector<Connection> star;                                  // one with 40 partners, in the middle of a chain
  for (std::size_t i = 0; i < 40; ++i)
    star.push_back(i < 20 ? Connection{i, 20, 20 - i} : Connection{20, i + 1, i - 19});
  compare<W, D>(45, star, length);
  star.insert(star.end(), {{0, 19}, {21, 44}});  // 19-20 and 20-21 are there already
  compare<W, D>(45, star, length);
}

template <class Width>
class Connections : public testing::Test {};
using Widths =
    testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 4>, std::integral_constant<int, 8>>;
TYPED_TEST_SUITE(Connections, Widths);

TYPED_TEST(Connections, EqualScalars) {
  constexpr int W = TypeParam::value;
  for (double const length : {0.0, 5.0}) {
    compare_all<W, 1>(length);
    compare_all<W, 2>(length);
    compare_all<W, 3>(length);
  }
}

/// A chain that is stretched evenly: inside forces cancel, at the ends they are stiffness times extension.
TYPED_TEST(Connections, EvenlyStretchedChain) {
  Ensemble<Newton<1>> chain("chain", 100);
  for (std::size_t i = 0; i < chain.size(); ++i) chain[i].position = {1.25 * static_cast<double>(i)};
  auto const out = by_kernel<TypeParam::value>(chain, {{0, 99}}, Spring{.stiffness = 2, .rest_length = 1}, 0, 100);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_NEAR(out.influence[i], i == 0 ? 0.5 : i == 99 ? -0.5 : 0.0, 1e-13) << i;
}

TEST(ConnectionsOfAScheme, HaveTheSameBitsForAnyNumberOfThreads) {
  std::size_t const count = 200000;
  Ensemble<Newton<3>> chain("chain", count);
  scatter(chain, 50);
  PairScheme scheme(Box(Vector{0.0, 0.0, 0.0}, Vector{50.0, 50.0, 50.0}));
  scheme.connect(chain, {{0, count - 1}, {0, count - 1, 3}}, Spring{.stiffness = 1, .rest_length = 1});
  scheme.threads(1);
  scheme.calculate();
  std::vector<double> const one(chain.influence(0), chain.influence(0) + 3 * count);
  for (int const threads : {2, 3}) {
    scheme.threads(threads);
    scheme.calculate();
    EXPECT_EQ(std::memcmp(one.data(), chain.influence(0), one.size() * sizeof(double)), 0) << threads << " threads";
  }
}

}  // namespace
}  // namespace boltzmann::connections_test
