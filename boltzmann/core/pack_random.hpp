// Random numbers of packs: one block of Philox4x32-10 per lane, and normals from its words. A lane depends on its own
// counter only.
#pragma once

#include <boltzmann/core/pack.hpp>
#include <boltzmann/core/pack_math.hpp>

#include <array>
#include <cstdint>

namespace boltzmann {

namespace detail {

template <int W>
using Words = typename register_of<std::uint64_t, W>::type;

/// The product of the low halves of two 64-bit lanes.
template <int W>
[[gnu::always_inline]] inline Words<W> multiply_low_halves(Words<W> a, Words<W> b) {
#if defined(__AVX512F__) && !defined(__clang__)
  typedef int Halves16 __attribute__((vector_size(64)));
  typedef long long Lanes8 __attribute__((vector_size(64)));
  if constexpr (W == 8)
    return (Words<W>)__builtin_ia32_pmuludq512_mask((Halves16)a, (Halves16)b, Lanes8{}, -1);
  else
#endif
#if defined(__AVX2__)
      if constexpr (W == 4) {
    typedef int Halves8 __attribute__((vector_size(32)));
    return (Words<W>)__builtin_ia32_pmuludq256((Halves8)a, (Halves8)b);
  } else
#endif
#if defined(__SSE2__)
      if constexpr (W == 2) {
    typedef int Halves4 __attribute__((vector_size(16)));
    return (Words<W>)__builtin_ia32_pmuludq128((Halves4)a, (Halves4)b);
  } else
#endif
    return (a & 0xffffffffU) * (b & 0xffffffffU);
}

}  // namespace detail

/// The key of each of the ten rounds of Philox4x32.
struct PhiloxKey {
  std::uint64_t first[10], second[10];

  constexpr PhiloxKey() = default;
  constexpr explicit PhiloxKey(std::uint64_t seed) {
    auto a = static_cast<std::uint32_t>(seed), b = static_cast<std::uint32_t>(seed >> 32);
    for (int round = 0; round < 10; ++round) {
      first[round] = a;
      second[round] = b;
      a += 0x9E3779B9U;
      b += 0xBB67AE85U;
    }
  }
};

/// Four words of 32 random bits in every lane, in the low halves of 64-bit lanes; the high halves have no meaning.
template <int W>
struct RandomWords {
  detail::Words<W> word[4];
};

/// Ten rounds of Philox on four words of 32 bits (Salmon, Moraes, Dror and Shaw, SC11), for W counters at once; only
/// the low halves of the counters are used.
template <int W>
[[gnu::always_inline]] inline RandomWords<W> philox4x32(RandomWords<W> counter, PhiloxKey const& key) {
  using detail::multiply_low_halves;
  detail::Words<W> c0 = counter.word[0], c1 = counter.word[1], c2 = counter.word[2], c3 = counter.word[3];
  detail::Words<W> const m0 = detail::Words<W>{} + 0xD2511F53U, m1 = detail::Words<W>{} + 0xCD9E8D57U;
#pragma GCC unroll 10
  for (int round = 0; round < 10; ++round) {
    detail::Words<W> const first = multiply_low_halves<W>(m0, c0), second = multiply_low_halves<W>(m1, c2);
    c0 = (second >> 32) ^ c1 ^ key.first[round];
    c1 = second;
    c2 = (first >> 32) ^ c3 ^ key.second[round];
    c3 = first;
  }
  return {{c0, c1, c2, c3}};
}

/// Two independent normals of mean 0 and variance 1 from two words (Box and Muller 1958). The radius has 2^32 values,
/// the largest 6.8, the direction as many. Errors of the functions are below 1e-9.
template <int W>
[[gnu::always_inline]] inline std::array<Pack<double, W>, 2> normals(detail::Words<W> radius, detail::Words<W> angle) {
  using Real = Pack<double, W>;
  using Bits = detail::Bits<W>;
  // A whole number below 2^52 under this exponent is itself, less 2^52.
  constexpr std::int64_t exponent = 0x4330000000000000;
  Real const t = detail::from_bits<W>((Bits)(radius & 0xffffffffU) | exponent) - (0x1p52 - 0.5);

  // log t = k log 2 + log(1 + f), 1 + f in [sqrt(1/2), sqrt(2)).
  Bits const shifted = detail::bits_of(t) - 0x3fe6a09e667f3bcd;
  Real const k = detail::from_bits<W>((((shifted >> 52) + 1024) & 0x7ff) | exponent) - (0x1p52 + 1024);
  Real const f = detail::from_bits<W>((shifted & detail::mantissa_bits) + 0x3fe6a09e667f3bcd) - 1.0;
  // The polynomial by pairs of terms, which halves the chain of dependent operations.
  Real const f2 = f * f, f4 = f2 * f2;
  Real const low =
      (-0.5000000000208761 + f * 0.33333322605887444) + f2 * (-0.24999991259441945 + f * 0.20001452394186736);
  Real const high =
      (-0.16668581753451966 + f * 0.14233014077255088) + f2 * (-0.12402749445125048 + f * 0.11788906323739978);
  Real const rest = low + f4 * (high + f4 * (-0.11656578633241571 + f * 0.06941972205854507));
  Real const log_t = k * 0.6931471805599453 + (f + f2 * rest);
  Real const square = max(44.3614195558365 - 2.0 * log_t, Real(1e-11));  // 64 log 2: never below zero
  Real const r = square * rsqrt(square);

  // A direction in the quadrant about the x axis; two bits select the quadrant that it is rotated or mirrored to.
  Real const phi =
      (detail::from_bits<W>((Bits)(angle & 0x3fffffffU) | exponent) - (0x1p52 - 0.5)) * (1.5707963267948966 * 0x1p-30) -
      0.7853981633974483;
  Real const u = phi * phi;
  Real const sine = phi + phi * u *
                              detail::polynomial(u, -0.16666666663857263, 0.00833333187541575, -0.00019840087051744507,
                                                 2.724996052550623e-06);
  Real cosine = 1.0 + u * detail::polynomial(u, -0.4999999996916462, 0.041666650656229424, -0.00138875896489554,
                                             2.4463841010156155e-05);
  cosine = detail::from_bits<W>(detail::bits_of(cosine) ^ ((Bits)(angle << 32) & detail::sign_bit));
  auto const turned = detail::mask_of<W>(-(Bits)((angle >> 30) & 1U));
  return {r * select(turned, sine, cosine), r * select(turned, cosine, sine)};
}

}  // namespace boltzmann
