// Sorted copies and lists of a sheared box against brute force: every image within reach is where Lees and Edwards have
// it, as fast as it is there, and lists have all that are near while images slide for many box lengths.
#include <boltzmann/neighbours/neighbourhood.hpp>
#include <boltzmann/particles/newton.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace boltzmann::sheared_copy_test {
namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Particles that flow with the box, and a bit on their own, some fast.
template <int D>
struct Gas {
  Box box;
  Shear shear;
  Ensemble<Newton<D>> few{"few", 40}, many{"many", 900};
  std::mt19937_64 random{test_seed(5)};
  double dt = 0.01, time = 0;

  Gas(int flow, int gradient, double rate) : box(space()), shear{rate, flow, gradient} {
    box.shear(shear);
    for (auto* ensemble : {&few, &many})
      for (auto& p : *ensemble) {
        for (int a = 0; a < D; ++a) {
          p.position[a] = std::uniform_real_distribution(box.low(a), box.high(a))(random);
          p.velocity[a] = std::uniform_real_distribution(-0.6, 0.6)(random);
        }
        p.velocity[flow] += box.flow_velocity(&p.position[0]);
      }
    many[7].velocity[gradient] = 60;  // knocked on
    few[3].velocity[flow] += 70;
  }
  static Box space() {
    Vector<D> low, high;
    std::array<Boundary, D> boundaries{};
    for (int a = 0; a < D; ++a) low[a] = -1 + 0.3 * a, high[a] = low[a] + (D == 2 ? 10.0 : 5.0) + a;
    boundaries.fill(Boundary::periodic);
    return Box(low, high, boundaries);
  }
  void step() {
    time += dt;
    box.move_walls(time);
    for (auto* ensemble : {&few, &many}) {
      for (auto& p : *ensemble) p.position = p.position + dt * p.velocity;
      box.apply(*ensemble);
    }
  }
  /// Calls function(image, up) for the images of a position that are in the box or less than 1 outside, which lists reach.
  template <class Function>
  void each_image(Vector<D> const& x, Function const& function) const {
    int const f = shear.flow, g = shear.gradient, third = D == 3 ? 3 - f - g : f;
    for (int up = -1; up <= 1; ++up)
      for (int along = -1; along <= 1; ++along)
        for (int other = D == 3 ? -1 : 0; other <= (D == 3 ? 1 : 0); ++other) {
          Vector<D> image = x;
          image[g] += up * box.length(g);
          image[f] += up * shear.rate * box.length(g) * time;
          image[f] += box.length(f) * (along - std::floor((image[f] - box.low(f)) / box.length(f)));
          image[third] += other * box.length(third);
          bool reached = true;
          for (int a = 0; a < D; ++a) reached = reached && image[a] > box.low(a) - 1 && image[a] < box.high(a) + 1;
          if (reached) function(image, up);
        }
  }
  Pairs near(Ensemble<Newton<D>>& a, Ensemble<Newton<D>>& b, double cutoff) const {
    Pairs pairs;
    for (std::uint32_t j = 0; j < b.size(); ++j)
      each_image(b[j].position, [&](Vector<D> const& image, int) {
        for (std::uint32_t i = 0; i < a.size(); ++i) {
          double const square = norm2(image - a[i].position);
          if (square > 0 && square < cutoff * cutoff) pairs.emplace_back(i, j);
        }
      });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  }
};

/// The same as a list has them; their relative velocities are those of the images that are near.
template <int D>
Pairs listed(Neighbourhood const& hood, std::size_t list, Gas<D> const& gas, double& worst) {
  SortedCopy const &target = hood.target(list), &source = hood.source(list);
  double const cutoff = hood.cutoff(list);
  Pairs pairs;
  auto const number = [](SortedCopy const& copy, std::size_t row, std::size_t n) {
    return copy.block(n / row_block)[row_block * row + n % row_block];
  };
  auto const &to = static_cast<Ensemble<Newton<D>> const&>(target.ensemble()),
             &from = static_cast<Ensemble<Newton<D>> const&>(source.ensemble());
  auto const velocity = static_cast<std::size_t>(to.field("velocity").offset);
  Shear const& shear = gas.shear;
  for (std::size_t i = 0; i < target.owned(); ++i)
    for (std::uint32_t k = 0; k < hood.list(list).lengths(hood.ring())[i]; ++k) {
      std::size_t const row = row_of_item(hood.list(list).rows()[i][k]);
      Vector<D> apart;
      for (std::size_t a = 0; a < D; ++a) apart[a] = number(source, row, a) - number(target, i, a);
      if (!(norm2(apart) < cutoff * cutoff)) continue;  // the sentinel too
      auto const p = target.order()[i], q = source.order()[source.owner(row)];
      pairs.emplace_back(p, q);
      bool found = false;
      gas.each_image(from[q].position, [&](Vector<D> const& image, int up) {
        if (norm2(image - to[p].position - apart) > 1e-18) return;
        found = true;
        for (std::size_t a = 0; a < D; ++a) {
          double const more = static_cast<int>(a) == shear.flow ? up * shear.rate * gas.box.length(shear.gradient) : 0;
          double const exact = from[q].velocity[a] + more - to[p].velocity[a];
          double const here = number(source, row, velocity + a) - number(target, i, velocity + a);
          worst = std::max(worst, std::abs(here - exact));
        }
      });
      EXPECT_TRUE(found);
    }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// Where those are that a list has for a row, in its order.
std::vector<double> row(Neighbourhood const& hood, std::size_t list, std::size_t i) {
  std::vector<double> places;
  for (std::uint32_t k = 0; k < hood.list(list).lengths(hood.ring())[i]; ++k) {
    double const* const y = hood.source(list).rows() + row_block * row_of_item(hood.list(list).rows()[i][k]);
    if (!std::isnan(y[0])) places.insert(places.end(), {y[0], y[1]});
  }
  return places;
}

template <int D>
void expect_lists(int flow, int gradient, double rate, std::size_t max_builds) {
  Gas<D> gas(flow, gradient, rate);
  Neighbourhood hood(gas.box), again(gas.box);
  double const cutoff = D == 2 ? 0.5 : 0.6;
  std::size_t const own = hood.add(gas.many, gas.many, cutoff), other = hood.add(gas.few, gas.many, 0.9);
  for (double const each : {cutoff, 0.9}) again.add(each == cutoff ? gas.many : gas.few, gas.many, each);
  double worst = 0;
  int const steps = 90;
  for (int n = 0; n < steps; ++n) {
    hood.refresh(2);
    ASSERT_EQ(listed(hood, own, gas, worst), gas.near(gas.many, gas.many, cutoff)) << n;
    ASSERT_EQ(listed(hood, other, gas, worst), gas.near(gas.few, gas.many, 0.9)) << n;
    for (std::size_t k = 0; k < hood.source(own).owned(); ++k) {
      auto const& p = gas.many[hood.source(own).order()[k]];
      auto const v = static_cast<std::size_t>(gas.many.field("velocity").offset + flow);
      double const here = hood.source(own).block(v / row_block)[row_block * k + v % row_block];
      worst = std::max(worst, std::abs(here - p.velocity[flow] - hood.source(own).ahead_in_flow(k)));
    }
    if (n == 60) again.restore(hood.state(), 1);
    if (n >= 60) {
      again.refresh(1);
      ASSERT_EQ(again.ring(), hood.ring());
      ASSERT_EQ(again.state(), hood.state());
      for (std::size_t i = 0; i < hood.target(own).owned(); ++i) ASSERT_EQ(row(again, own, i), row(hood, own, i));
    }
    gas.step();
  }
  EXPECT_LT(worst, 1e-12 * std::abs(rate) * 12);
  EXPECT_GE(hood.moves(), 10u);
  EXPECT_LE(hood.builds(), max_builds);
}

// The images slide by up to four lengths. Had their way counted as displacement, lists would be built in each step.
TEST(ShearedCopy, ListsHaveAllImagesThatAreNear) {
  expect_lists<2>(0, 1, 4, 60);
  expect_lists<2>(1, 0, -1, 30);
  expect_lists<3>(0, 2, 3, 20);
  expect_lists<3>(2, 1, 0.5, 10);
}

}  // namespace
}  // namespace boltzmann::sheared_copy_test
