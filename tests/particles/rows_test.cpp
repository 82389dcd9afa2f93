// Rows of particles in registers: load_rows and broadcast against plain access to the struct, for every shipped class.
#include <gtest/gtest.h>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/rows.hpp>
#include <boltzmann/particles/tethered.hpp>
#include <boltzmann/particles/tracer.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <tests/seed.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <numeric>
#include <ostream>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

namespace boltzmann::rows_test {
namespace {

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
  std::mt19937 random(test_seed(11));
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

/// What is tested of a class; the tests themselves are compiled once and not for each.
struct RowClass {
  std::string name;
  void (*expect_lanes_are_rows)();
  void (*expect_broadcast_fills_lanes)();
  std::size_t bytes, stride, doubles;
  std::vector<Field> fields;
};
void PrintTo(RowClass const& of, std::ostream* out) { *out << of.name; }

template <class P>
RowClass row_class() {
  static_assert(rebind_t<rebind_t<P, Pack<double, 4>>, double>::dimension == P::dimension);
  return {P::class_name + std::to_string(P::dimension) + "D",
          [] {
            expect_lanes_are_rows<P, 2>();
            expect_lanes_are_rows<P, 4>();
            expect_lanes_are_rows<P, 8>();
          },
          [] {
            expect_broadcast_fills_lanes<P, 2>();
            expect_broadcast_fills_lanes<P, 4>();
            expect_broadcast_fills_lanes<P, 8>();
          },
          sizeof(Row<P>),
          row_stride<P>,
          row_doubles<P>,
          P::fields().fields};
}
template <class... P>
std::vector<RowClass> row_classes() {
  return {row_class<P>()...};
}

class RowsOf : public testing::TestWithParam<RowClass> {};
INSTANTIATE_TEST_SUITE_P(
    Classes, RowsOf,
    testing::ValuesIn(row_classes<Particle<1>, Particle<2>, Particle<3>, Newton<1>, Newton<2>, Newton<3>, Laplace<1>,
                                  Laplace<2>, Laplace<3>, Coulomb<1>, Coulomb<2>, Coulomb<3>, Kepler<1>, Kepler<2>,
                                  Kepler<3>, Tethered<1>, Tethered<2>, Tethered<3>, Tracer<1>, Tracer<2>, Tracer<3>,
                                  Vortex<2>, Vortex<3>, Inviscid<2>, Inviscid<3>, Viscous<2>, Viscous<3>,
                                  Diffusive<2>, Diffusive<3>>()),
    [](auto const& info) { return info.param.name; });

TEST_P(RowsOf, LanesAreRows) { GetParam().expect_lanes_are_rows(); }

TEST_P(RowsOf, BroadcastFillsEveryLane) { GetParam().expect_broadcast_fills_lanes(); }

TEST_P(RowsOf, RowsAreWholeBlocksOf32Bytes) {
  auto const& of = GetParam();
  EXPECT_EQ(of.bytes % 32, 0U);
  EXPECT_EQ(of.stride % 4, 0U);
  EXPECT_GE(of.stride, of.doubles);
  EXPECT_LT(of.stride, of.doubles + 4);
}

TEST_P(RowsOf, FieldTableNamesEveryDouble) {
  auto const& fields = GetParam().fields;
  std::vector<bool> named(GetParam().doubles, false);
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

/// Not of a Real: no pack can be made of it.
template <class Wrong>
struct With {
  template <class Real>
  struct Class : Newton<2, Real> {
    Wrong member;
  };
};
template <class Real>
struct Flagged : Newton<2, Real> {
  bool flags[8];
};
template <class Real>
struct Late : Newton<2, Real> {
  bool first;
  Real last;
};

TEST(Rows, OfAnythingButRealsDoNotCompile) {
  EXPECT_TRUE(holds_only_reals<Newton<1>>() && holds_only_reals<Tethered<3>>() && holds_only_reals<Ion<double>>());
  EXPECT_FALSE(holds_only_reals<With<int>::Class<double>>());
  EXPECT_FALSE(holds_only_reals<With<float>::Class<double>>());
  EXPECT_FALSE(holds_only_reals<With<double>::Class<double>>()) << "packs would share it";
  EXPECT_FALSE(holds_only_reals<With<long>::Class<double>>());
  EXPECT_FALSE(holds_only_reals<With<bool>::Class<double>>());
  EXPECT_FALSE(holds_only_reals<With<char*>::Class<double>>());
  EXPECT_FALSE(holds_only_reals<With<Vector<2>>::Class<double>>());
  EXPECT_FALSE(holds_only_reals<Flagged<double>>());
  EXPECT_FALSE(holds_only_reals<Late<double>>());
}

}  // namespace
}  // namespace boltzmann::rows_test
