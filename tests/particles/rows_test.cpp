// Rows of particles in registers: load_rows and broadcast against plain access to the struct, for every shipped class.
#include <gtest/gtest.h>
#include <boltzmann/particles/euler.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/rows.hpp>
#include <boltzmann/particles/tethered.hpp>
#include <boltzmann/particles/vortex.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <numeric>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

namespace boltzmann::rows_test {
namespace {

template <class P>
class RowsOf : public testing::Test {};

using Classes = testing::Types<Particle<1>, Particle<2>, Particle<3>, Newton<1>, Newton<2>, Newton<3>, Laplace<1>,
                               Laplace<2>, Laplace<3>, Coulomb<1>, Coulomb<2>, Coulomb<3>, Kepler<1>, Kepler<2>,
                               Kepler<3>, Tethered<1>, Tethered<2>, Tethered<3>, Euler<1>, Euler<2>, Euler<3>,
                               Vortex<2>, Vortex<3>, Inviscid<2>, Inviscid<3>, Viscous<2>, Viscous<3>>;
TYPED_TEST_SUITE(RowsOf, Classes);

/// Rows whose every double is another number; padding is filled too, and must not be seen.
template <class P>
std::vector<Row<P>> numbered_rows(std::size_t count) {
  std::vector<Row<P>> rows(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<double, row_stride<P>> values;
    std::iota(values.begin(), values.end(), 1000.0 * static_cast<double>(i) + 0.25);
    rows[i] = std::bit_cast<Row<P>>(values);
  }
  return rows;
}

template <class P>
double const* data_of(std::vector<Row<P>> const& rows) {
  return reinterpret_cast<double const*>(rows.data());
}

/// Not a template, as the tests below are compiled for many classes and widths.
void expect_same(double packed, double plain, char const* what, std::size_t k, int lane) {
  EXPECT_EQ(packed, plain) << what << " " << k << " lane " << lane;
}

template <class P, int W>
void expect_lanes_are_rows() {
  using Real = Pack<double, W>;
  using Packed = rebind_t<P, Real>;
  constexpr std::size_t doubles = row_doubles<P>;
  static_assert(sizeof(Packed) == doubles * sizeof(Real));
  std::size_t const count = 40;
  auto const rows = numbered_rows<P>(count);
  double const* const data = data_of(rows);
  std::mt19937 random(11);
  for (int trial = 0; trial < 50; ++trial) {
    std::array<std::size_t, W> chosen;  // any order, also the same row twice
    for (auto& i : chosen) i = trial == 0 ? static_cast<std::size_t>(&i - chosen.data()) : random() % count;
    Packed const packed = load_rows<P, W>([&](int lane) { return data + chosen[lane] * row_stride<P>; });
    auto const columns = std::bit_cast<std::array<Real, doubles>>(packed);
    for (int lane = 0; lane < W; ++lane) {
      P const& particle = rows[chosen[lane]];
      auto const values = std::bit_cast<std::array<double, doubles>>(particle);
      for (std::size_t k = 0; k < doubles; ++k) expect_same(columns[k][lane], values[k], "column", k, lane);
      auto const same = [&](auto const& of_pack, double plain, char const* what, std::size_t k = 0) {
        expect_same(of_pack[lane], plain, what, k, lane);
      };
      auto const same_vectors = [&](auto const& of_pack, auto const& plain, char const* what) {
        for (int d = 0; d < P::dimension; ++d) same(of_pack[d], plain[d], what, d);
      };
      same_vectors(packed.position, particle.position, "position");
      if constexpr (requires { particle.velocity; }) {
        same(packed.mass, particle.mass, "mass");
        same_vectors(packed.velocity, particle.velocity, "velocity");
      }
      if constexpr (requires { particle.strength(); }) same(packed.strength(), particle.strength(), "strength");
      if constexpr (requires { particle.anchor; }) {
        same(packed.stiffness, particle.stiffness, "stiffness");
        same_vectors(packed.anchor, particle.anchor, "anchor");
      }
      if constexpr (requires { particle.vorticity; }) {
        same(packed.core, particle.core, "core");
        same(packed.vorticity[0], particle.vorticity[0], "vorticity");
      }
    }
  }
}

template <class P, int W>
void expect_broadcast_fills_lanes() {
  using Real = Pack<double, W>;
  constexpr std::size_t doubles = row_doubles<P>;
  auto const rows = numbered_rows<P>(3);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    auto const packed = broadcast<P, Real>(data_of(rows) + i * row_stride<P>);
    static_assert(std::is_same_v<decltype(packed), rebind_t<P, Real> const>);
    auto const columns = std::bit_cast<std::array<Real, doubles>>(packed);
    P const& particle = rows[i];
    auto const values = std::bit_cast<std::array<double, doubles>>(particle);
    for (std::size_t k = 0; k < doubles; ++k)
      for (int lane = 0; lane < W; ++lane) expect_same(columns[k][lane], values[k], "column", k, lane);
  }
}

TYPED_TEST(RowsOf, LanesAreRows) {
  expect_lanes_are_rows<TypeParam, 2>();
  expect_lanes_are_rows<TypeParam, 4>();
  expect_lanes_are_rows<TypeParam, 8>();
}

TYPED_TEST(RowsOf, BroadcastFillsEveryLane) {
  expect_broadcast_fills_lanes<TypeParam, 2>();
  expect_broadcast_fills_lanes<TypeParam, 4>();
  expect_broadcast_fills_lanes<TypeParam, 8>();
}

void expect_whole_blocks(std::size_t bytes, std::size_t stride, std::size_t doubles) {
  EXPECT_EQ(bytes % 32, 0U);
  EXPECT_EQ(stride % 4, 0U);
  EXPECT_GE(stride, doubles);
  EXPECT_LT(stride, doubles + 4);
}

TYPED_TEST(RowsOf, RowsAreWholeBlocksOf32Bytes) {
  expect_whole_blocks(sizeof(Row<TypeParam>), row_stride<TypeParam>, row_doubles<TypeParam>);
  static_assert(rebind_t<rebind_t<TypeParam, Pack<double, 4>>, double>::dimension == TypeParam::dimension);
}

void expect_every_double_named(std::vector<Field> const& fields, std::size_t doubles) {
  std::vector<bool> named(doubles, false);
  for (auto const& field : fields)
    for (int c = 0; c < field.components; ++c) {
      auto const k = static_cast<std::size_t>(field.offset + c);
      ASSERT_LT(k, named.size()) << field.name;
      EXPECT_FALSE(named[k]) << field.name << " lies over another field";
      named[k] = true;
    }
  for (std::size_t k = 0; k < named.size(); ++k) EXPECT_TRUE(named[k]) << "double " << k << " has no name";
  EXPECT_EQ(fields.front().name, "position");
}

TYPED_TEST(RowsOf, FieldTableNamesEveryDouble) {
  expect_every_double_named(TypeParam::template fields<TypeParam>().fields, row_doubles<TypeParam>);
}

/// A class of a user's own, by the number type alone.
template <class Real>
struct Ion : Coulomb<3, Real> {
  Real internal_energy;
};

TEST(RowsOfAUsersClass, LanesAreRows) {
  expect_lanes_are_rows<Ion<double>, 2>();
  expect_lanes_are_rows<Ion<double>, 4>();
  expect_lanes_are_rows<Ion<double>, 8>();
  auto const rows = numbered_rows<Ion<double>>(8);
  auto const packed =
      load_rows<Ion<double>, 8>([&](int lane) { return data_of(rows) + lane * row_stride<Ion<double>>; });
  for (int lane = 0; lane < 8; ++lane) EXPECT_EQ(packed.internal_energy[lane], rows[lane].internal_energy);
}

}  // namespace
}  // namespace boltzmann::rows_test
