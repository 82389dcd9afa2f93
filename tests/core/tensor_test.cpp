// Tensor algebra against worked examples and identities, for numbers and for packs.
#include <boltzmann/core/pack.hpp>
#include <boltzmann/core/tensor.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace boltzmann::tensor_test {
namespace {

constexpr Tensor<2> a2{1, 2, 3, 4};
constexpr Tensor<2> b2{5, -6, 7, 8};
constexpr Tensor<3> a3{2, -1, 0, 1, 3, -2, 4, 0.5, 5};
constexpr Tensor<3> b3{1, 2, 3, -4, 5, 6, 7, -8, 9.5};
constexpr Vector<3> u3{1, -2, 3};
constexpr Vector<3> v3{4, 0.5, -1};

template <int D>
void expect_near(Tensor<D> const& a, Tensor<D> const& b, double tolerance = 1e-14) {
  for (std::size_t i = 0; i < D; ++i)
    for (std::size_t j = 0; j < D; ++j) EXPECT_NEAR(a[i][j], b[i][j], tolerance) << i << " " << j;
}

TEST(Tensor, IsStoredRowByRow) {
  static_assert(sizeof(Tensor<3>) == 9 * sizeof(double));
  static_assert(a2[0][1] == 2.0 && a2[1][0] == 3.0);
  Tensor<2> a = a2;
  a[1][0] = 9.0;
  EXPECT_EQ(a, (Tensor<2>{1, 2, 9, 4}));
  EXPECT_FALSE(a == a2);
  EXPECT_EQ(Tensor<3>{}, a3 - a3);
}

TEST(Tensor, ArithmeticIsComponentByComponent) {
  static_assert(a2 + b2 == Tensor<2>{6, -4, 10, 12});
  static_assert(a2 - b2 == Tensor<2>{-4, 8, -4, -4});
  static_assert(-a2 == Tensor<2>{-1, -2, -3, -4});
  static_assert(a2 * 2.0 == Tensor<2>{2, 4, 6, 8} && 2.0 * a2 == a2 * 2.0);
  static_assert(a2 / 2.0 == Tensor<2>{0.5, 1, 1.5, 2});
  Tensor<2> a = a2;
  a += b2;
  a -= a2;
  a *= 4.0;
  a /= 2.0;
  EXPECT_EQ(a, 2.0 * b2);
}

TEST(Tensor, ProductsWithVectorsKeepTheirOrder) {
  constexpr Vector<2> v{10, 100};
  static_assert(dot(a2, v) == Vector<2>{210, 430});
  static_assert(dot(v, a2) == Vector<2>{310, 420});
  constexpr Tensor<2> dyad = outer(Vector<2>{1, 2}, Vector<2>{3, 4});
  static_assert(dyad == Tensor<2>{3, 4, 6, 8});
  // (a b) . c = a (b . c), c . (a b) = (c . a) b
  EXPECT_EQ(dot(outer(u3, v3), u3), u3 * dot(v3, u3));
  EXPECT_EQ(dot(u3, outer(u3, v3)), dot(u3, u3) * v3);
  EXPECT_EQ(dot(a3, u3), dot(u3, transpose(a3)));
}

TEST(Tensor, MatrixProduct) {
  static_assert(dot(a2, b2) == Tensor<2>{19, 10, 43, 14});
  static_assert(dot(a2, Tensor<2>::identity()) == a2 && dot(Tensor<2>::identity(), a2) == a2);
  EXPECT_EQ(dot(a3, b3), (Tensor<3>{6, -1, 0, -25, 33, 2, 37, -29.5, 62.5}));
  EXPECT_EQ(dot(dot(a3, b3), u3), dot(a3, dot(b3, u3)));
  EXPECT_EQ(transpose(dot(a3, b3)), dot(transpose(b3), transpose(a3)));
}

TEST(Tensor, ContractionTraceAndParts) {
  static_assert(contraction(a2, b2) == 5 - 12 + 21 + 32);
  EXPECT_EQ(contraction(a3, b3), trace(dot(a3, transpose(b3))));
  EXPECT_EQ(contraction(a3, outer(u3, v3)), dot(u3, dot(a3, v3)));
  static_assert(trace(a2) == 5 && trace(a3) == 10);
  EXPECT_EQ(transpose(a3), (Tensor<3>{2, 1, 4, -1, 3, 0.5, 0, -2, 5}));
  EXPECT_EQ(symmetric_part(a2), (Tensor<2>{1, 2.5, 2.5, 4}));
  EXPECT_EQ(symmetric_part(a3), transpose(symmetric_part(a3)));
  // A rigid rotation has no rate of strain.
  EXPECT_EQ(symmetric_part(Tensor<3>{0, -3, 2, 3, 0, -1, -2, 1, 0}), Tensor<3>{});
}

TEST(Tensor, DeterminantAndInverse) {
  static_assert(determinant(a2) == -2.0);
  static_assert(inverse(a2) == Tensor<2>{-2, 1, 1.5, -0.5});
  static_assert(determinant(Tensor<1>{4}) == 4.0 && inverse(Tensor<1>{4}) == Tensor<1>{0.25});
  // The volume spanned by the rows.
  Vector<3> const w{2, 7, -5};
  Tensor<3> const rows{u3[0], u3[1], u3[2], v3[0], v3[1], v3[2], w[0], w[1], w[2]};
  EXPECT_EQ(determinant(rows), dot(u3, cross(v3, w)));
  EXPECT_NEAR(determinant(dot(a3, b3)), determinant(a3) * determinant(b3), 1e-10);
  expect_near(dot(a3, inverse(a3)), Tensor<3>::identity());
  expect_near(dot(inverse(b3), b3), Tensor<3>::identity());
  // A rotation's inverse is its transpose.
  double const c = std::cos(0.3), s = std::sin(0.3);
  Tensor<3> const rotation = dot(Tensor<3>{c, -s, 0, s, c, 0, 0, 0, 1}, Tensor<3>{1, 0, 0, 0, c, -s, 0, s, c});
  expect_near(inverse(rotation), transpose(rotation), 1e-15);
  EXPECT_NEAR(determinant(rotation), 1.0, 1e-15);
}

TEST(Tensor, ASingularTensorHasAnAdjugateAndNoFiniteInverse) {
  Tensor<2> const singular{1, 2, 2, 4};
  EXPECT_EQ(dot(singular, adjugate(singular)), Tensor<2>{});
  EXPECT_FALSE(std::isfinite(inverse(singular)[0][0]));
}

/// Every lane of every operation on packs equals the same operation on numbers.
template <int D>
void check_packs() {
  using Wide = Pack<double, 4>;
  Tensor<D> a[4], b[4];
  Vector<D> v[4];
  Tensor<D, Wide> wide_a{}, wide_b{};
  Vector<D, Wide> wide_v{};
  for (int lane = 0; lane < 4; ++lane)
    for (std::size_t i = 0; i < D; ++i) {
      for (std::size_t j = 0; j < D; ++j) {
        a[lane][i][j] = 0.3 * lane + static_cast<double>(i * i) - 1.5 * static_cast<double>(j) + (i == j ? 4.0 : 0.0);
        b[lane][i][j] = 1.0 / (1.0 + lane + static_cast<double>(i + 2 * j));
        wide_a[i][j].native[lane] = a[lane][i][j];
        wide_b[i][j].native[lane] = b[lane][i][j];
      }
      v[lane][i] = lane - static_cast<double>(i);
      wide_v[i].native[lane] = v[lane][i];
    }
  // One tensor, vector and number that need every operation.
  auto const tensor = [](auto const& x, auto const& y, auto const& w) {
    auto sum = symmetric_part(dot(x, y)) - transpose(x) * 0.25 + inverse(x) / 3.0 + outer(w, w) + -y;
    sum += 2.0 * std::decay_t<decltype(x)>::identity();
    return sum;
  };
  auto const vector = [](auto const& x, auto const& y, auto const& w) { return dot(x, w) + dot(w, y); };
  auto const number = [](auto const& x, auto const& y) { return contraction(x, y) + trace(x) * determinant(x); };
  auto const wide_tensor = tensor(wide_a, wide_b, wide_v);
  auto const wide_vector = vector(wide_a, wide_b, wide_v);
  auto const wide_number = number(wide_a, wide_b);
  for (int lane = 0; lane < 4; ++lane) {
    auto const expected = tensor(a[lane], b[lane], v[lane]);
    auto const expected_vector = vector(a[lane], b[lane], v[lane]);
    for (std::size_t i = 0; i < D; ++i) {
      for (std::size_t j = 0; j < D; ++j)
        EXPECT_NEAR(wide_tensor[i][j][lane], expected[i][j], 1e-13) << D << " " << lane << " " << i << " " << j;
      EXPECT_NEAR(wide_vector[i][lane], expected_vector[i], 1e-13);
    }
    double const expected_number = number(a[lane], b[lane]);
    EXPECT_NEAR(wide_number[lane], expected_number, 1e-13 * std::abs(expected_number));
  }
}

TEST(Tensor, PacksGiveWhatNumbersGive) {
  check_packs<1>();
  check_packs<2>();
  check_packs<3>();
}

}  // namespace
}  // namespace boltzmann::tensor_test
