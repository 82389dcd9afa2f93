// Mixtures: laws between unlike particles, by mixing rules or by a table of species.
#pragma once

#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/particles/rows.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <limits>

namespace boltzmann {

/// The rule by which parameters of unlike particles follow from those of like particles.
enum class Mixing {
  lorentz_berthelot,  ///< r0 = (r1 + r2) / 2, depth = sqrt(d1 d2)
  geometric,          ///< r0 = sqrt(r1 r2), depth = sqrt(d1 d2)
  sixth_power,        ///< r0^6 = (r1^6 + r2^6) / 2, depth = sqrt(d1 d2) r1^3 r2^3 / r0^6 (Waldman and Hagler 1993)
};

/// The law between a particle with the law a among its like and one with the law b.
LennardJones mix(LennardJones const& a, LennardJones const& b, Mixing rule);

/// Throws Error: the species are 0 to count - 1.
[[noreturn]] void refuse_species(int a, int b, int count);

/// N numbers for every pair of K species, the same for (a, b) as for (b, a). Numbers that were not set, and those of
/// invalid species, are NaN: a law with these gives NaN forces, and the run stops with an error.
template <int K, int N = 1>
class SpeciesTable {
 public:
  static_assert(K >= 1 && K <= 32 && N >= 1 && N <= 4, "up to 32 species, and 4 numbers for a pair of them");

  SpeciesTable() {
    for (auto& row : rows_)
      for (double& x : row.number) x = std::numeric_limits<double>::quiet_NaN();
    for (auto& column : columns_)
      for (double& x : column) x = std::numeric_limits<double>::quiet_NaN();
  }

  /// Error unless 0 <= a, b < K.
  void set(int a, int b, std::array<double, N> const& numbers) {
    for (auto const k : {index(a, b), index(b, a)})
      for (std::size_t n = 0; n < N; ++n) {
        rows_[k].number[n] = numbers[n];
        if constexpr (in_registers) columns_[n][k] = numbers[n];
      }
  }
  /// NaN if nothing was set. Error unless 0 <= a, b < K.
  std::array<double, N> get(int a, int b) const {
    std::array<double, N> numbers;
    for (std::size_t n = 0; n < N; ++n) numbers[n] = rows_[index(a, b)].number[n];
    return numbers;
  }

  /// The numbers of a pair, for laws: table(p.species, q.species), with doubles or packs, of any value.
  template <class Real>
  [[gnu::always_inline]] inline std::array<Real, N> operator()(Real const& a, Real const& b) const {
    // Depends on `a` alone, so it is computed outside the loop over neighbours.
    auto const known = (a > -0.5) & (a < K - 0.5);
    Real const row = select(known, Real(((a + detail::to_integer) - detail::to_integer) * (K + 2.0)), Real(0.0));
    Real const least = select(known, Real(-1.0), Real(K));
    // Not min(b, K): for b = NaN this gives K.
    Real const place = row + 1.0 + max(least, min(Real(K), b));
    return at(place);
  }

 private:
  /// A row for each first species: a number for each second one, between two columns of NaN.
  static constexpr std::size_t entries = static_cast<std::size_t>(K) * (K + 2);
  static constexpr bool in_registers = entries <= 24;
  static constexpr std::size_t index(int a, int b) {
    if (a < 0 || a >= K || b < 0 || b >= K) refuse_species(a, b, K);
    return static_cast<std::size_t>(a * (K + 2) + b + 1);
  }

  std::array<double, N> at(double place) const {
    std::array<double, N> numbers;
    auto const k = static_cast<std::size_t>((place + detail::to_integer) - detail::to_integer);
    for (std::size_t n = 0; n < N; ++n) numbers[n] = rows_[k].number[n];
    return numbers;
  }
  template <int W>
  [[gnu::always_inline]] inline std::array<Pack<double, W>, N> at(Pack<double, W> place) const {
    std::array<Pack<double, W>, 4> numbers;
    auto const number = detail::bits_of(place + detail::to_integer);
    constexpr auto zero = std::int64_t{0x4338000000000000};
#if defined(__AVX512F__)
    if constexpr (W == 8 && in_registers) {  // a permutation of whole registers, which uses the low bits only
      using Native = typename Pack<double, W>::Native;
      for (std::size_t n = 0; n < N; ++n) {
        auto const* const column = reinterpret_cast<Native const*>(columns_[n]);
        if constexpr (entries <= 8) {
          numbers[n] = detail::permuted(column[0], number);
        } else {
          numbers[n] = detail::permuted(column[0], column[1], number);
          if constexpr (entries > 16)
            numbers[n] = select(place > 15.5, Pack<double, W>(detail::permuted(column[2], number)), numbers[n]);
        }
      }
    } else
#endif
    {
      auto const offsets = std::bit_cast<std::array<std::int64_t, W>>((number - zero) << 2);
      detail::transpose_block<W>([&](int lane) { return rows_[0].number + offsets[static_cast<std::size_t>(lane)]; }, 0,
                                 numbers.data(), N);
    }
    std::array<Pack<double, W>, N> result;
    for (std::size_t n = 0; n < N; ++n) result[n] = numbers[n];
    return result;
  }

  struct alignas(32) Row {
    double number[4];
  };
  Row rows_[entries];
  alignas(64) double columns_[in_registers ? N : 1][in_registers ? (entries + 7) / 8 * 8 : 1];
};

/// Lennard-Jones among particles of K species (a class with the field `species`, like Species). The laws of like
/// particles are given; those of unlike ones follow from a mixing rule, or are set.
template <int K>
class LennardJonesMixture {
 public:
  static constexpr Symmetry symmetry = Symmetry::antisymmetric;

  explicit LennardJonesMixture(std::array<LennardJones, K> const& like, Mixing rule = Mixing::lorentz_berthelot) {
    for (int a = 0; a < K; ++a)
      for (int b = 0; b <= a; ++b)
        set(a, b,
            a == b ? like[static_cast<std::size_t>(a)]
                   : mix(like[static_cast<std::size_t>(a)], like[static_cast<std::size_t>(b)], rule));
  }

  /// Errors as of SpeciesTable.
  void set(int a, int b, LennardJones const& law) { table_.set(a, b, {law.depth, law.r0 * law.r0}); }
  LennardJones between(int a, int b) const {
    auto const [depth, r02] = table_.get(a, b);
    return {depth, sqrt(r02)};
  }

  template <class P, class Q>
  requires requires(P const& p, Q const& q) { p.species + q.species; }
  auto operator()(P const& p, Q const& q) const {
    auto const r = q.position - p.position;
    auto const inverse = 1.0 / dot(r, r);
    auto const [depth, r02] = table_(p.species, q.species);
    auto const s6 = cube(r02 * inverse);
    return Interaction{r * (-12.0 * depth * s6 * (s6 - 1.0) * inverse), depth * s6 * (s6 - 2.0)};
  }

  double length_scale() const {
    double least = __builtin_inf();
    for (int a = 0; a < K; ++a)
      for (int b = 0; b <= a; ++b) least = min(least, between(a, b).r0);
    return least;
  }
  void check() const {
    for (int a = 0; a < K; ++a)
      for (int b = 0; b <= a; ++b) check_parameters(between(a, b));
  }

 private:
  SpeciesTable<K, 2> table_;
};
template <std::size_t K>
LennardJonesMixture(std::array<LennardJones, K>) -> LennardJonesMixture<static_cast<int>(K)>;
template <std::size_t K>
LennardJonesMixture(std::array<LennardJones, K>, Mixing) -> LennardJonesMixture<static_cast<int>(K)>;

}  // namespace boltzmann
