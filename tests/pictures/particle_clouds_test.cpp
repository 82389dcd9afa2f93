// Rows to clouds: against a plain computation with doubles, one particle after the other.
#include <gtest/gtest.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/pictures/particle_clouds.hpp>
#include <tests/seed.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <set>
#include <vector>

namespace boltzmann::particle_clouds_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

template <int D>
void fill(Ensemble<Newton<D>>& all, unsigned seed = 1) {
  std::mt19937_64 random(test_seed(seed));
  std::uniform_real_distribution<double> place(10, 20);
  std::normal_distribution<double> speed(0, 3);
  for (auto& p : all) {
    p.mass = place(random);
    for (int a = 0; a < D; ++a) p.position[a] = place(random), p.velocity[a] = speed(random);
  }
}

template <int D>
CloudSource source_of(Ensemble<Newton<D>> const& ensemble) {
  CloudSource source{&ensemble, Colour{}, 0, {}};
  for (int a = 0; a < D; ++a) source.place.push_back(column_of(ensemble, std::string("position.") + "xyz"[a]));
  return source;
}

template <class T>
bool same_bits(std::vector<T> const& a, std::vector<T> const& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

TEST(ParticleColumns, AreTheQuantitiesOfTheSameName) {
  Ensemble<Newton<2>> two("gas", 50);
  fill(two);
  Ensemble<Newton<3>> three("gas", 50);
  fill(three);
  Ensemble<Newton<1>> one("gas", 50);
  fill(one);
  for (AnyEnsemble const* ensemble : {static_cast<AnyEnsemble const*>(&one), static_cast<AnyEnsemble const*>(&two),
                                      static_cast<AnyEnsemble const*>(&three)})
    for (auto const& what : quantities(*ensemble)) {
      auto const column = column_of(*ensemble, what.name);
      auto const values = quantity(*ensemble, what.name);
      for (std::size_t i = 0; i < 50; ++i) {
        if (std::isnan(values[i]) && std::isnan(column[i])) continue;
        EXPECT_NEAR(column[i], values[i], 1e-14 * std::abs(values[i])) << what.name;
      }
    }
  EXPECT_EQ(column_of(two, "velocity.y").first, &two[0].velocity[1]) << "read where it stands";
  EXPECT_THROW(column_of(two, "velocity.z"), Error);
  EXPECT_THROW(column_of(two, "position"), Error);
  EXPECT_THROW(column_of(two, "mass.x"), Error);
  EXPECT_THROW(column_of(two, "colour"), Error);
  EXPECT_THROW(column_of(Ensemble<Newton<2>>("none"), "colour"), Error);
}

template <int D>
void against_doubles(std::size_t count, std::string const& what) {
  Ensemble<Newton<D>> all("gas", count);
  fill(all);
  auto source = source_of(all);
  source.value = column_of(all, what);
  auto const values = quantity(all, what);
  CloudOptions options;
  options.origin = {10, 10, 10};
  options.scale = {10, 5, 2};
  double low = infinity, high = -infinity;
  for (double const v : values) low = std::min(low, v), high = std::max(high, v);
  bool const diverging = low < 0 && high > 0;
  if (diverging) high = std::max(-low, high), low = -high;
  std::vector<Canvas::Cloud> first;
  for (int const threads : {1, 2, 5}) {
    options.threads = threads;
    auto const made = particle_clouds({&source, 1}, options);
    ASSERT_EQ(made.clouds.size(), 1U);
    auto const& cloud = made.clouds[0];
    ASSERT_EQ(cloud.count(), count);
    EXPECT_EQ(made.shown, count);
    EXPECT_EQ(made.stride, 1U);
    EXPECT_EQ(made.map, diverging ? ColourMap::diverging : ColourMap::viridis);
    EXPECT_NEAR(made.low, low, 2e-7 * std::abs(high));
    EXPECT_NEAR(made.high, high, 2e-7 * std::abs(high));
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t a = 0; a < D; ++a)
        ASSERT_NEAR(cloud.origin[a] + cloud.scale[a] * static_cast<double>(cloud.position[D * i + a]),
                    all[i].position[static_cast<int>(a)], 1e-6);
      ASSERT_NEAR(static_cast<double>(cloud.value[i]), count == 1 ? 0.5 : (values[i] - low) / (high - low), 2e-6);
    }
    if (first.empty()) first = made.clouds;
    EXPECT_TRUE(same_bits(first[0].position, cloud.position)) << threads;
    EXPECT_TRUE(same_bits(first[0].value, cloud.value)) << threads;
  }
}

TEST(ParticleClouds, AreWhatDoublesSay) {
  for (std::size_t const count : {1, 2, 3, 255, 256, 257, 40000})
    for (char const* what : {"mass", "speed", "velocity.x", "kinetic-energy"}) {
      against_doubles<2>(count, what);
      against_doubles<3>(count, what);
    }
}

TEST(ParticleClouds, ValuesThatDifferLittleAreToldApart) {
  Ensemble<Newton<2>> all("gas", 1000);
  fill(all);
  for (std::size_t i = 0; i < 1000; ++i) all[i].mass = 1e9 + 1e-3 * static_cast<double>(i);
  for (std::size_t i = 0; i < 1000; ++i) all[i].velocity = {1e6 + 1e-3 * static_cast<double>(i), 0};
  for (char const* what : {"mass", "speed"}) {
    auto source = source_of(all);
    source.value = column_of(all, what);
    auto const made = particle_clouds({&source, 1}, {});
    for (std::size_t i = 0; i < 1000; ++i)
      ASSERT_NEAR(static_cast<double>(made.clouds[0].value[i]), static_cast<double>(i) / 999, 1e-3) << what;
  }
  // Tiny and huge ones are no zeros and no infinities.
  for (double const unit : {1e-200, 1e200})
    for (char const* what : {"mass", "speed"}) {
      for (std::size_t i = 0; i < 1000; ++i) {
        all[i].mass = unit * static_cast<double>(i);
        all[i].velocity = {0, 1e-50 * unit * static_cast<double>(i)};
      }
      auto source = source_of(all);
      source.value = column_of(all, what);
      auto const made = particle_clouds({&source, 1}, {});
      if (unit < 1 && std::string(what) == "speed") continue;  // its squares are below all doubles
      for (std::size_t i = 0; i < 1000; ++i)
        ASSERT_NEAR(static_cast<double>(made.clouds[0].value[i]), static_cast<double>(i) / 999, 1e-5)
            << what << " " << unit;
    }
}

TEST(ParticleClouds, WhatIsNotFiniteIsCountedAndGetsNoColour) {
  Ensemble<Newton<2>> all("gas", 1000);
  fill(all);
  all[3].position[0] = nan;
  all[700].position[1] = infinity;
  all[700].mass = nan;
  all[701].mass = nan;
  for (int const region : {0, 1}) {
    auto source = source_of(all);
    source.value = column_of(all, "mass");
    CloudOptions options;
    if (region == 1) options.region = {{0, 100}, {0, 100}};
    auto const made = particle_clouds({&source, 1}, options);
    EXPECT_EQ(made.not_finite, region == 1 ? 0U : 2U);
    EXPECT_EQ(made.without_value, region == 1 ? 1U : 2U);
    EXPECT_EQ(made.shown, region == 1 ? 998U : 1000U);
    EXPECT_EQ(
        std::count_if(made.clouds[0].value.begin(), made.clouds[0].value.end(), [](float v) { return std::isnan(v); }),
        region == 1 ? 1 : 2);
    EXPECT_GT(made.low, 9);
    EXPECT_LT(made.high, 21);
  }
  all[5].mass = infinity;  // as large as the largest, which it doesn't shift
  auto source = source_of(all);
  source.value = column_of(all, "mass");
  auto const made = particle_clouds({&source, 1}, {});
  EXPECT_LT(made.high, 21);
  EXPECT_EQ(made.clouds[0].value[5], 1);
}

TEST(ParticleClouds, OneOfNIsShownAndSaysWhichItIs) {
  Ensemble<Newton<2>> a("a", 700), b("b", 305), none("none");
  fill(a), fill(b, 2);
  std::vector<CloudSource> sources;
  for (auto const* ensemble : {&a, &b, &none}) {
    sources.push_back(source_of(*ensemble));
    sources.back().value = column_of(*ensemble, "speed");
  }
  CloudOptions options;
  double fastest = 0;
  for (auto const* ensemble : {&a, &b})
    for (double const v : quantity(*ensemble, "speed")) fastest = std::max(fastest, v);
  for (std::size_t const most : {1004, 503, 100, 3}) {
    options.most = most;
    auto const made = particle_clouds(sources, options);
    EXPECT_LE(made.shown, most);
    EXPECT_GT(made.shown * 2 + 3, most) << "not many fewer than allowed";
    EXPECT_EQ(made.particles, 1005U);
    EXPECT_NEAR(made.high, fastest, 1e-6) << "colours are those of all particles";
    std::size_t const n = made.stride;
    EXPECT_EQ(made.clouds[0].count(), (700 + n - 1) / n);
    EXPECT_EQ(made.clouds[1].count(), (305 + n - 1) / n);
    EXPECT_EQ(made.clouds[2].count(), 0U);
    EXPECT_EQ(made.clouds[1].stride, n);
    for (std::size_t k = 0; k < made.clouds[1].count(); ++k) {
      std::size_t const i = n == 1 ? k : made.clouds[1].number[k];
      ASSERT_EQ(i / n, k) << "one of every n";
      ASSERT_LT(i, 305U);
      ASSERT_FLOAT_EQ(made.clouds[1].position[2 * k + 1], static_cast<float>(b[i].position[1]));
    }
  }
}

// Which of n is shown has nothing to do with where it stands: of an alternating order both kinds are seen alike.
TEST(ParticleClouds, OneOfNIsAFairSample) {
  Ensemble<Newton<2>> lattice("lattice", 100'000);
  for (std::size_t i = 0; i < lattice.size(); ++i) lattice[i].position = {static_cast<double>(i % 2), 0};
  auto const source = source_of(lattice);
  for (std::size_t const most : {50'000, 25'000, 10'000}) {
    CloudOptions options;
    options.most = most;
    auto const made = particle_clouds({&source, 1}, options);
    double ones = 0;
    for (std::size_t k = 0; k < made.shown; ++k) ones += static_cast<double>(made.clouds[0].position[2 * k]);
    double const error = 0.5 / std::sqrt(static_cast<double>(made.shown));
    EXPECT_NEAR(ones / static_cast<double>(made.shown), 0.5, 4 * error);
  }
}

TEST(ParticleClouds, ARegionShowsThoseInsideByNumber) {
  Ensemble<Newton<2>> a("a", 40000), b("b", 300);
  fill(a), fill(b, 2);
  std::vector<CloudSource> sources{source_of(a), source_of(b)};
  CloudOptions options;
  options.region = {{12, 13}, {15, 19}};
  std::vector<std::vector<std::uint32_t>> inside(2);
  for (std::size_t s = 0; s < 2; ++s) {
    auto const& ensemble = s == 0 ? a : b;
    for (std::uint32_t i = 0; i < ensemble.size(); ++i) {
      auto const& x = ensemble[i].position;
      if (x[0] >= 12 && x[0] <= 13 && x[1] >= 15 && x[1] <= 19) inside[s].push_back(i);
    }
  }
  for (int const threads : {1, 3}) {
    options.threads = threads;
    options.most = 0;
    auto const all = particle_clouds(sources, options);
    EXPECT_EQ(all.clouds[0].number, inside[0]);
    EXPECT_EQ(all.clouds[1].number, inside[1]);
    EXPECT_EQ(all.inside, inside[0].size() + inside[1].size());
    options.most = 100;
    auto const some = particle_clouds(sources, options);
    EXPECT_LE(some.shown, 100U);
    EXPECT_GT(some.stride, 1U);
    for (std::size_t k = 0; k < some.clouds[0].count(); ++k) {
      auto const found = std::find(inside[0].begin(), inside[0].end(), some.clouds[0].number[k]);
      ASSERT_EQ(static_cast<std::size_t>(found - inside[0].begin()) / some.stride, k);
      ASSERT_FLOAT_EQ(some.clouds[0].position[2 * k], static_cast<float>(a[some.clouds[0].number[k]].position[0]));
    }
  }
  options.region = {{100, 200}};
  EXPECT_EQ(particle_clouds(sources, options).shown, 0U);
}

TEST(ParticleClouds, TheLargestValueHasTheDiameterOfItsEnsemble) {
  Ensemble<Newton<2>> a("a", 10), b("b", 10);
  fill(a), fill(b, 2);
  for (std::size_t i = 0; i < 10; ++i) a[i].mass = static_cast<double>(i), b[i].mass = -static_cast<double>(2 * i);
  a[4].mass = nan;
  std::vector<CloudSource> sources{source_of(a), source_of(b)};
  for (std::size_t s = 0; s < 2; ++s) {
    sources[s].diameter = s == 0 ? 1 : 0.5;
    sources[s].size = column_of(s == 0 ? a : b, "mass");
  }
  auto const made = particle_clouds(sources, {});
  EXPECT_FLOAT_EQ(made.clouds[0].diameter[9], 0.5F);
  EXPECT_FLOAT_EQ(made.clouds[0].diameter[0], 0);
  EXPECT_FLOAT_EQ(made.clouds[0].diameter[4], 1) << "without a value: its own";
  EXPECT_FLOAT_EQ(made.clouds[1].diameter[9], 0.5F);
  EXPECT_EQ(made.clouds[0].common_diameter, 0);
}

TEST(Turns, MixCloudsWithoutLosingAnybody) {
  Ensemble<Newton<2>> a("a", 100), b("b", 33);
  fill(a), fill(b, 2);
  std::vector<CloudSource> sources{source_of(a), source_of(b)};
  for (std::size_t s = 0; s < 2; ++s) sources[s].value = column_of(s == 0 ? a : b, "mass");
  auto made = particle_clouds(sources, {});
  auto const whole = made.clouds;
  auto const parts = interleaved(std::move(made.clouds));
  EXPECT_EQ(parts.size(), 32U);
  std::vector<std::size_t> found(2);
  std::set<std::uint32_t> numbers;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    auto const& from = whole[p % 2];
    found[p % 2] += parts[p].count();
    for (std::size_t k = 0; k < parts[p].count(); ++k) {
      std::uint32_t const i = parts[p].number[k];
      if (p % 2 == 0) numbers.insert(i);
      ASSERT_EQ(parts[p].position[2 * k], from.position[2 * i]);
      ASSERT_EQ(parts[p].value[k], from.value[i]);
    }
  }
  EXPECT_EQ(found[0], 100U);
  EXPECT_EQ(found[1], 33U);
  EXPECT_EQ(numbers.size(), 100U);
  EXPECT_EQ(interleaved({whole[0]}).size(), 1U) << "one hides nobody";
}

}  // namespace
}  // namespace boltzmann::particle_clouds_test
