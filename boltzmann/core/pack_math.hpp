// Elementary functions of packs: exp, expm1, log, pow, sin, cos, tanh, erf, erfc and the exponential integral E1,
// written once in the arithmetic of Pack.
//
// Every lane depends on its own input only. No branches, except that sin and cos of arguments beyond 2^20 go to the C
// library, lane by lane. Only exp uses instructions of particular sets, to multiply by a power of two, look up a table,
// or limit a number; the bits are the same without them. Where a rounding error would matter, products are exact (their
// factors have few bits), so that a compiler that fuses a * b + c changes nothing there; in the polynomials it may
// change the last bits. So: the same bits on every instruction set with FMA (from -O2), the same bits on every one
// without, and between the two differences within the errors below.
//
// Largest errors measured against 80-bit arithmetic, in units in the last place (tests/core/pack_math_test.cpp):
//   exp 1.2   expm1 1.1   log 0.95   pow 1.1   sin 0.8   cos 0.8   tanh 1.9   erfc 5.5   erf 3.0
//   E1 3.8
// Special values (0, -0, infinities, NaN, results that overflow or are subnormal) are those of the C standard; no flags
// are raised on purpose. Packs of float are computed in double.
#pragma once

#include <boltzmann/core/pack.hpp>

#include <cstdint>
#include <type_traits>

namespace boltzmann {

using std::expm1;
using std::tanh;

namespace detail {

template <int W>
using Bits = typename Mask<double, W>::Native;

template <int W>
[[gnu::always_inline]] inline Bits<W> bits_of(Pack<double, W> x) {
  return (Bits<W>)x.native;
}
template <int W>
[[gnu::always_inline]] inline Pack<double, W> from_bits(Bits<W> bits) {
  return (typename Pack<double, W>::Native)bits;
}
/// All ones or all zeros per lane, as a condition for select().
template <int W>
[[gnu::always_inline]] inline Mask<double, W> mask_of(Bits<W> bits) {
  return {bits};
}

inline constexpr std::int64_t sign_bit = INT64_MIN;
inline constexpr std::int64_t mantissa_bits = 0x000fffffffffffff;

/// x multiplied by the sign of s: x >= 0 gets the sign of s.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> with_sign_of(Pack<double, W> x, Pack<double, W> s) {
  return from_bits<W>(bits_of(x) ^ (bits_of(s) & sign_bit));
}
/// The leading 26 bits: a product of two of these is exact.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> leading(Pack<double, W> x) {
  return from_bits<W>(bits_of(x) & ~std::int64_t{0x7ffffff});
}

/// c0 + c1 x + c2 x^2 + ...
template <int W>
[[gnu::always_inline]] inline Pack<double, W> polynomial(Pack<double, W>, double c0) {
  return c0;
}
template <int W, class... Coefficients>
[[gnu::always_inline]] inline Pack<double, W> polynomial(Pack<double, W> x, double c0, Coefficients... more) {
  return c0 + x * polynomial(x, more...);
}

// Adding and subtracting it rounds to the nearest integer, which is in the low bits of the sum.
inline constexpr double to_integer = 0x1.8p52;

inline constexpr double ln2_high = 0x1.62e42fefa2p-1;  // 40 bits: times an exponent it is exact
inline constexpr double ln2_low = 0x1.9ef35793c7673p-41;

/// 2^n for whole n in -1022..1023, given n + to_integer.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> power_of_two(Pack<double, W> n_shifted) {
  return from_bits<W>((bits_of(n_shifted) + 1023) << 52);
}

/// exp(r) - 1 - r for |r| <= ln(2)/2.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> exp_tail(Pack<double, W> r) {
  auto const q = polynomial(r, 0x1.555555555555cp-3, 0x1.5555555555556p-5, 0x1.111111110eb24p-7, 0x1.6c16c16c163b5p-10,
                            0x1.a01a01b3f349ep-13, 0x1.a01a01a63aa89p-16, 0x1.71ddef0597a48p-19, 0x1.27e4dd9fd0bb5p-22,
                            0x1.af6dc7c126498p-26, 0x1.1f6df94007fe5p-29);
  return (r * r) * (0.5 + r * q);
}

/// value 2^floor(k) for k in -1100..1100, rounded once if the result is subnormal. The low bits of `whole` are
/// floor(k); bits from 2^12 on are ignored.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> times_power_of_two(Pack<double, W> value,
                                                                 [[maybe_unused]] Pack<double, W> k,
                                                                 [[maybe_unused]] Bits<W> whole) {
#if defined(__AVX512F__)
  if constexpr (W == 8)
    return __builtin_ia32_scalefpd512_mask(value.native, k.native, value.native, -1, 4);  // any k, also infinite
  else
#endif
  {
    // In two factors, the first of which is exact.
    using Unsigned = typename register_of<std::uint64_t, W>::type;
    Unsigned const twice = (Unsigned)(whole + 2 * 1023), half = twice >> 1;
    return value * from_bits<W>((Bits<W>)(half << 52)) * from_bits<W>((Bits<W>)((twice - half) << 52));
  }
}

/// exp(high + low), |low| far below |high|; high has at most 53 bits and is not NaN where low is finite.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> exp_of_sum(Pack<double, W> high, Pack<double, W> low) {
  using Real = Pack<double, W>;
  Mask<double, W> const over = high > 710.0, under = high < -746.0;
  high = select(under, Real(-746.0), select(over, Real(710.0), high));
  low = select(under | over, Real(0.0), low);
  Real const shifted = high * 0x1.71547652b82fep+0 + to_integer;
  Real const k = shifted - to_integer;
  Real const r = (high - k * ln2_high) + (low - k * ln2_low);
  return times_power_of_two(1.0 + (r + exp_tail(r)), k, bits_of(shifted));
}

/// 2^(j/16)
template <int W>
alignas(64) inline constexpr double roots_of_two[16] = {
    0x1.0000000000000p+0, 0x1.0b5586cf9890fp+0, 0x1.172b83c7d517bp+0, 0x1.2387a6e756238p+0,
    0x1.306fe0a31b715p+0, 0x1.3dea64c123422p+0, 0x1.4bfdad5362a27p+0, 0x1.5ab07dd485429p+0,
    0x1.6a09e667f3bcdp+0, 0x1.7a11473eb0187p+0, 0x1.8ace5422aa0dbp+0, 0x1.9c49182a3f090p+0,
    0x1.ae89f995ad3adp+0, 0x1.c199bdd85529cp+0, 0x1.d5818dcfba487p+0, 0x1.ea4afa2a490dap+0};

/// 2^(j/16), j the low four bits of every lane.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> root_of_two(Bits<W> j) {
  using Native = typename Pack<double, W>::Native;
#if defined(__AVX512F__)
  if constexpr (W == 8) {
    Native low, high;
    __builtin_memcpy(&low, roots_of_two<W>, sizeof low);
    __builtin_memcpy(&high, roots_of_two<W> + W, sizeof high);
    return detail::permuted(low, high, j);
  } else
#endif
  {
    Native result;
    for (int lane = 0; lane < W; ++lane) result[lane] = roots_of_two<W>[j[lane] & 15];
    return result;
  }
}

// As to_integer, for sixteenths.
inline constexpr double to_sixteenths = 0x1.8p48;

/// exp(k ln 2 + r) for k in sixteenths and |r| <= ln(2)/32, given also k + to_sixteenths.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> exp_of_parts(Pack<double, W> k, Pack<double, W> k_shifted,
                                                           Pack<double, W> r) {
  auto const root = root_of_two<W>(bits_of(k_shifted));
  auto const r2 = r * r;
  // A polynomial of degree 6 with an error below 1.4e-17.
  auto const a = 0x1.fffffffffffecp-2 + r * 0x1.555555547cc9ep-3;
  auto const b = (0x1.5555555639e86p-5 + r * 0x1.1112473f7f092p-7) + r2 * 0x1.6c16df70e5ddfp-10;
  auto const p = r + r2 * (a + r2 * b);
  using Unsigned = typename register_of<std::uint64_t, W>::type;
  return times_power_of_two(root + root * p, k, (Bits<W>)((Unsigned)bits_of(k_shifted) >> 4));
}

/// x = 2^exponent mantissa with the mantissa in [sqrt(1/2), sqrt(2)), for finite x > 0.
template <int W>
struct Split {
  Pack<double, W> mantissa, exponent;
};
template <int W>
[[gnu::always_inline]] inline Split<W> split(Pack<double, W> x) {
  using Real = Pack<double, W>;
  constexpr std::int64_t root_half = 0x3fe6a09e667f3bcd, one = 0x3ff0000000000000,
                         magic = 0x4330000000000000;  // magic: 2^52
  Mask<double, W> const subnormal = x < 0x1p-1022;
  x = select(subnormal, x * 0x1p54, x);
  // Unsigned: lanes with NaN, whose result is not used, would overflow.
  using Unsigned = typename register_of<std::uint64_t, W>::type;
  Bits<W> const moved = (Bits<W>)((Unsigned)bits_of(x) + static_cast<std::uint64_t>(one - root_half));
  Real const biased = from_bits<W>((Bits<W>)((typename Mask<double, W>::Native)moved >> 52 & 0x7ff) | magic);
  return {from_bits<W>((moved & mantissa_bits) + root_half),
          biased - select(subnormal, Real(0x1p52 + 1077), Real(0x1p52 + 1023))};
}

/// An argument of sin or cos as quadrant pi/2 + high + low.
template <int W>
struct Reduced {
  Pack<double, W> high, low;
  Bits<W> quadrant;  ///< right modulo 4
};
inline constexpr double reducible = 0x1p20;

/// For |x| <= reducible: pi/2 in four parts, the first three of 33 bits, so that their products with the quadrant are
/// exact.
template <int W>
[[gnu::always_inline]] inline Reduced<W> reduce_angle(Pack<double, W> x) {
  using Real = Pack<double, W>;
  Real const shifted = x * 0x1.45f306dc9c883p-1 + to_integer;
  Real const n = shifted - to_integer;
  Real const a = x - n * 0x1.921fb544p+0;
  Real error = 0.0;
  auto const subtract = [&error](Real big, Real part) {  // accumulates the rounding error of the difference
    Real const difference = big - part;
    Real const back = difference - big;
    error += (big - (difference - back)) - (part + back);
    return difference;
  };
  Real const b = subtract(a, n * 0x1.0b4611a6p-34);
  Real const c = subtract(b, n * 0x1.3198a2ep-69);
  Real const low = error - n * 0x1.b839a252049c1p-104;
  Real const high = c + low;
  return {high, (c - high) + low, bits_of(shifted)};
}

template <int W>
[[gnu::always_inline]] inline Pack<double, W> sin_reduced(Reduced<W> r) {
  auto const z = r.high * r.high;
  auto const s = polynomial(z, -0x1.5555555555549p-3, 0x1.111111110f87ep-7, -0x1.a01a019c121c2p-13,
                            0x1.71de35782c167p-19, -0x1.ae5e66998807ap-26, 0x1.5d931d4ea6d38p-33);
  return r.high + (r.high * z * s + r.low * (1.0 - 0.5 * z));
}
template <int W>
[[gnu::always_inline]] inline Pack<double, W> cos_reduced(Reduced<W> r) {
  auto const z = r.high * r.high;
  auto const c = polynomial(z, 0x1.555555555554cp-5, -0x1.6c16c16c15180p-10, 0x1.a01a019cb20a2p-16,
                            -0x1.27e4f80a2bf45p-22, 0x1.1ee9ec1401d6fp-29, -0x1.8faeb3d1b6debp-37);
  auto const half = 0.5 * z;
  auto const top = 1.0 - half;
  return top + (((1.0 - top) - half) + (z * z * c - r.high * r.low));
}
/// sin(r + quadrant pi/2)
template <int W>
[[gnu::always_inline]] inline Pack<double, W> sin_of_quadrant(Reduced<W> r) {
  Mask<double, W> const odd = mask_of<W>((r.quadrant & 1) != 0);
  auto const value = select(odd, cos_reduced(r), sin_reduced(r));
  return from_bits<W>(bits_of(value) ^ (Bits<W>)(r.quadrant << 62 & sign_bit));
}

/// Calls the C library's function in the lanes outside the range of reduce_angle(). It uses long double, since the
/// function for doubles is 160 units off at the double closest to a multiple of pi/2.
template <int W, class Function>
[[gnu::noinline, gnu::cold]] void replace_lanes(double const* x, double* value, Function f) {
  for (int lane = 0; lane < W; ++lane)
    if (!(x[lane] <= reducible && x[lane] >= -reducible)) value[lane] = f(x[lane]);
}
template <int W, class Function>
[[gnu::always_inline]] inline Pack<double, W> with_far_lanes(Pack<double, W> x, Pack<double, W> value, Function f) {
  if (any(abs(x) > reducible)) [[unlikely]] {
    double in[W], out[W];
    for (int lane = 0; lane < W; ++lane) in[lane] = x.native[lane], out[lane] = value.native[lane];
    replace_lanes<W>(in, out, f);
    for (int lane = 0; lane < W; ++lane) value.native[lane] = out[lane];
  }
  return value;
}

}  // namespace detail

/// e^x; 0 below -745.2, infinite above 709.8.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> exp(Pack<double, W> x) {
  using Real = Pack<double, W>;
#if defined(__AVX512DQ__)
  constexpr bool limited = W == 8;  // times_power_of_two() accepts any k
#else
  constexpr bool limited = false;
#endif
  if constexpr (!limited) x = max(min(x, Real(710.0)), Real(-746.0));
  Real const shifted = x * 0x1.71547652b82fep+0 + detail::to_sixteenths;
  Real const k = shifted - detail::to_sixteenths;
  // ln 2 in two parts, the first of 36 bits.
  Real r = (x - k * 0x1.62e42fefap-1) - k * 0x1.cf79abc9e3b3ap-40;
#if defined(__AVX512DQ__)
  if constexpr (limited)  // to |r| <= 0.03, also where x is infinite or so large that k is inexact
    r = __builtin_ia32_rangepd512_mask(r.native, Real(0.03).native, 2, r.native, -1, 4);
#endif
  return detail::exp_of_parts(k, shifted, r);
}

/// e^x for an x that is itself rounded, the usual case. The relative error is below 2.1e-16 + 0.4e-16 |x| (with FMA;
/// without it 2.1e-16 + 1.2e-16 |x|), while the rounding of x alone causes 1.1e-16 |x|. Cheaper than exp(), with the
/// same special values, but not for x below -1e60 (NaN and the infinities are right).
template <int W>
[[gnu::always_inline]] inline Pack<double, W> exp_of_rounded(Pack<double, W> x) {
  using Real = Pack<double, W>;
#if defined(__AVX512F__)
  constexpr bool limited = W == 8;
#else
  constexpr bool limited = false;
#endif
  if constexpr (!limited) x = max(min(x, Real(710.0)), Real(-746.0));
  Real const shifted = x * 0x1.71547652b82fep+0 + detail::to_sixteenths;
  Real const k = shifted - detail::to_sixteenths;
  return detail::exp_of_parts(k, shifted, x - k * 0x1.62e42fefa39efp-1);
}
/// Fallback for other kinds of numbers.
template <class Real>
Real exp_of_rounded(Real const& x) {
  return exp(x);
}

/// e^x - 1, accurate near zero.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> expm1(Pack<double, W> x) {
  using Real = Pack<double, W>;
  Real const limited = select(x < -40.0, Real(-40.0), select(x > 710.0, Real(710.0), x));
  Real const shifted = limited * 0x1.71547652b82fep+0 + detail::to_integer;
  Real const k = shifted - detail::to_integer;
  Real const high = limited - k * detail::ln2_high;
  Real const r = high - k * detail::ln2_low;
  Real const error = (high - r) - k * detail::ln2_low;
  Real const tail = detail::exp_tail(r) + (error + error * r);
  Real const p = r + tail;
  Real const p_low = (r - p) + tail;
  // 2^k (p + p_low) + (2^k - 1) with half of 2^k, since k reaches 1024; products with it are exact.
  Real const half = detail::power_of_two(shifted - 1.0);
  Real const whole = half - 0.5;
  Real const value = whole + half * p;
  Real const value_low = ((whole - value) + half * p) + half * p_low;
  return select(k == 0.0, select(x == 0.0, x, p), select(x > 709.0, Real(2.0 * value), 2.0 * (value + value_low)));
}

/// ln x; -infinity at 0, NaN below.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> log(Pack<double, W> x) {
  using Real = Pack<double, W>;
  auto const [m, k] = detail::split(x);
  Real const f = m - 1.0;
  Real const s = f / (2.0 + f);  // ln m = 2 artanh s
  Real const z = s * s;
  Real const r =
      z * detail::polynomial(z, 0x1.5555555555592p-1, 0x1.999999997fd69p-2, 0x1.24924941f58c0p-2, 0x1.c71c5205ad7edp-3,
                             0x1.74663fb0c35f1p-3, 0x1.39a1a5caaed36p-3, 0x1.2f063e053c530p-3);
  Real const value = k * detail::ln2_high + (f - (s * (f - r) - k * detail::ln2_low));
  double const infinity = __builtin_inf();
  Real const finite = select(x > 0.0, select(x < infinity, value, x), Real(__builtin_nan("")));
  return select(x == 0.0, Real(-infinity), finite);
}

/// x^y. For x < 0 only whole y have a power; every special case is that of the C standard (pow(x, 0) = pow(1, y) = 1).
template <int W>
[[gnu::always_inline]] inline Pack<double, W> pow(Pack<double, W> x, std::type_identity_t<Pack<double, W>> y) {
  using Real = Pack<double, W>;
  double const infinity = __builtin_inf();
  Real const a = abs(x);
  auto const [m, k] = detail::split(a);

  // ln m = s (2 + 2/3 z + z^2 q), s = (m - 1) / (m + 1), z = s^2, to about 68 bits: every high part has 26 bits, every
  // product of them is exact.
  Real const f = m - 1.0;
  Real const d = m + 1.0;
  Real const d_high = detail::leading(d);
  Real const d_low = (d - d_high) + (m - (d - 1.0));
  Real const inverse = 1.0 / d;
  Real const s_high = detail::leading(f * inverse);
  Real const s_low = ((f - s_high * d_high) - s_high * d_low) * inverse;
  Real const z_exact = s_high * s_high;
  Real const z_error = s_low * (2.0 * s_high + s_low);
  Real const z = z_exact + z_error;
  Real const z_high = detail::leading(z_exact);
  Real const q =
      detail::polynomial(z, 0x1.9999999999996p-2, 0x1.2492492493035p-2, 0x1.c71c71c580565p-3, 0x1.745d18325b93ap-3,
                         0x1.3b1362b3afee0p-3, 0x1.1120b5fb760b8p-3, 0x1.de33628f58486p-4, 0x1.eb1195c207326p-4);
  constexpr double two_thirds_high = 0x1.555555p-1, two_thirds_low = 0x1.5555555555555p-27;
  Real const t_exact = two_thirds_high * z_high;
  Real const t_rest = (two_thirds_high * ((z_exact - z_high) + z_error) + two_thirds_low * z) + z * z * q;
  Real const u_high = detail::leading(2.0 + (t_exact + t_rest));
  Real const u_low = ((2.0 - u_high) + t_exact) + t_rest;
  Real const ln_m = s_high * u_high;
  Real const ln_m_low = s_high * u_low + s_low * (u_high + u_low);

  Real const k_ln2 = k * detail::ln2_high;
  Real const ln = k_ln2 + ln_m;
  Real const ln_low = (ln_m - (ln - k_ln2)) + (k * detail::ln2_low + ln_m_low);

  // y ln a; beyond 2^64 every y gives the same power.
  Real const exponent = select(y > 0x1p64, Real(0x1p64), select(y < -0x1p64, Real(-0x1p64), y));
  Real const y_high = detail::leading(exponent);
  Real const ln_high = detail::leading(ln);
  Real const ln_rest = (ln - ln_high) + ln_low;
  Real const power = detail::exp_of_sum(y_high * ln_high, y_high * ln_rest + (exponent - y_high) * (ln_high + ln_rest));

  Real const zero = 0.0, one = 1.0;
  auto const grows = ((a > 1.0) & (y > 0.0)) | ((a < 1.0) & (y < 0.0));
  Real value = select((a == 0.0) | (a == infinity), select(grows, Real(infinity), zero), power);

  Real const size = abs(y);
  auto const whole = [](Real v) { return (v >= 0x1p52) | (((v + 0x1p52) - 0x1p52) == v); };
  auto const y_whole = whole(size);
  auto const odd = y_whole & !whole(0.5 * size);
  value = select(odd, detail::with_sign_of(value, x), value);
  value = select((x < 0.0) & (a < infinity) & !y_whole, Real(__builtin_nan("")), value);
  value = select((x == x) & (y == y), value, x + y);
  return select((y == 0.0) | (x == 1.0), one, value);
}
template <int W>
[[gnu::always_inline]] inline Pack<double, W> pow(double x, Pack<double, W> y) {
  return pow(Pack<double, W>(x), y);
}

template <int W>
[[gnu::always_inline]] inline Pack<double, W> sin(Pack<double, W> x) {
  auto const value = detail::sin_of_quadrant(detail::reduce_angle(x));
  auto const near = select(abs(x) < 0x1p-27, x, value);  // -0 keeps its sign
  return detail::with_far_lanes(x, near, [](long double far) { return static_cast<double>(std::sin(far)); });
}

template <int W>
[[gnu::always_inline]] inline Pack<double, W> cos(Pack<double, W> x) {
  auto r = detail::reduce_angle(x);
  r.quadrant = r.quadrant + 1;
  return detail::with_far_lanes(x, detail::sin_of_quadrant(r),
                                [](long double far) { return static_cast<double>(std::cos(far)); });
}

template <int W>
[[gnu::always_inline]] inline Pack<double, W> tanh(Pack<double, W> x) {
  using Real = Pack<double, W>;
  Real const a = abs(x);
  Real const t = expm1(2.0 * select(a > 22.0, Real(22.0), a));
  Real const d = t + 2.0;
  Real const d_low = select(t < 2.0, t - (d - 2.0), Real(0.0));
  Real const quotient = t / d;
  return detail::with_sign_of(quotient - quotient * (d_low / d), x);
}

namespace detail {

/// erf(x) for |x| < 1/2: x times a polynomial of x^2, of relative error 4e-18, through its values at Chebyshev points.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> erf_near(Pack<double, W> x) {
  return x * polynomial(x * x, 0x1.20dd750429b6dp+0, -0x1.812746b0379b5p-2, 0x1.ce2f21a03d814p-4, -0x1.b82ce30f2b28fp-6,
                        0x1.565bcbf8e0365p-8, -0x1.c02d4f6e4921ap-11, 0x1.f98db34e8872ep-14, -0x1.f224dfc5409afp-17,
                        0x1.8b4b60851826bp-20);
}
/// erfc(a) for a >= 1/2, by e^(a^2) erfc(a) (a + 3.5) = a polynomial of degree 20 of t = (a - 3.5)/(a + 3.5), of
/// relative error 7e-18. It interpolates the function at the Chebyshev points of the interval of t that belongs to 1/2
/// <= a <= 28. The square in the exponent is exact, in two parts.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> erfc_far(Pack<double, W> a) {
  using Real = Pack<double, W>;
  Real const x = min(a, Real(28.0));
  Real const high = leading(x);
  Real const e = exp_of_sum(-(high * high), -((x - high) * (x + high)));
  Real const t = (x - 3.5) / (x + 3.5);
  return e *
         polynomial(t, 0x1.1649466cd0bf1p+0, -0x1.e02749166d571p-1, 0x1.6362dd280194ep-1, -0x1.bdb3c1808b145p-2,
                    0x1.ce500ceb5cb50p-3, -0x1.7a232e1d37c37p-4, 0x1.b27b274763d4dp-6, -0x1.a06c1e77a762dp-9,
                    -0x1.5630de5707dc9p-10, 0x1.769ecb24455c0p-11, -0x1.60d8372338525p-15, -0x1.39a217e091919p-14,
                    0x1.38dc3fcff32d8p-16, 0x1.e5e0ca2594a40p-18, -0x1.c7834b1358bb9p-19, -0x1.a6a5a9a9e343bp-21,
                    0x1.2901c43048c9ep-21, 0x1.bc1f1b71ccb68p-24, -0x1.703f4d38a2b7ap-24, -0x1.972068358a45dp-27,
                    0x1.51c94f65fc06bp-27) /
         (x + 3.5);
}

}  // namespace detail

/// The complement of the error function, 1 - erf(x) = 2/sqrt(pi) times the integral of e^(-t^2) from x to infinity:
/// small relative error down to its underflow at x = 27.2.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> erfc(Pack<double, W> x) {
  using Real = Pack<double, W>;
  auto const a = abs(x);
  auto const far = detail::erfc_far(a);
  auto const near = a < 0.5, negative = x < 0.0;
  // One difference after the selection, so that no compiler fuses it with the product in erf_near().
  auto const whole = select(near, Real(1.0), select(negative, Real(2.0), Real(0.0)));
  return whole - select(near, detail::erf_near(x), select(negative, far, -far));
}

/// The error function.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> erf(Pack<double, W> x) {
  auto const a = abs(x);
  return select(a < 0.5, detail::erf_near(x), detail::with_sign_of(1.0 - detail::erfc_far(a), x));
}

/// The exponential integral E1(x), the integral of e^(-t)/t from x to infinity, for x > 0; infinite at 0, NaN below.
/// Below 1/2 it is -ln x - gamma + x p(x), of relative error 4e-18 through the function's values at Chebyshev points;
/// above e^(-x)/(x + 1) (1 + r(x)), where r < 0.4 is a ratio of polynomials of degree 12, of relative error 5e-17
/// through its values at points that are those of Chebyshev in (x - 15/8)/(x + 15/8).
template <int W>
[[gnu::always_inline]] inline Pack<double, W> exponential_integral(Pack<double, W> x) {
  using Real = Pack<double, W>;
  Real const near = (x * detail::polynomial(x, 1.0, -0x1.fffffffffffcdp-3, 0x1.c71c71c7192e6p-5, -0x1.55555554068ebp-7,
                                            0x1.b4e81ac61acccp-10, -0x1.e5738c984cbb0p-13, 0x1.db86dd4ee1597p-16,
                                            -0x1.9fb2099e1ab38p-19, 0x1.4325c0fa841f3p-22, -0x1.8193218907408p-26) -
                     0x1.2788cfc6fb619p-1) -
                    log(x);
  Real const limited = min(x, Real(750.0));
  Real const r =
      detail::polynomial(limited, 0x1.0a11bc6e15d82p+2, 0x1.7a951e6ed3e66p+7, 0x1.f3946c0ae0480p+10,
                         0x1.ea70e11ebbd68p+12, 0x1.b3ab93301d923p+13, 0x1.839f2eb114526p+13, 0x1.6ca77489e8409p+12,
                         0x1.725401409f128p+10, 0x1.8fc8946581c25p+7, 0x1.a8a7feadcb75fp+3, 0x1.5850c7f6f3a70p-2,
                         0x1.3117cdbbf1669p-43, -0x1.342802e472b7ep-53) /
      detail::polynomial(limited, 1.0, 0x1.665d31c8fa4dcp+6, 0x1.a5825d1d860b7p+10, 0x1.6faa5e775e03ap+13,
                         0x1.2a896bb04dad4p+15, 0x1.fc6058b3e0784p+15, 0x1.e63c3005e7ea5p+15, 0x1.0f9c43ec85e4ap+15,
                         0x1.686a10ea256a2p+13, 0x1.1a76fdc9e64abp+11, 0x1.f89a435f0b578p+7, 0x1.d3b217a8e41b4p+3,
                         0x1.5850c7f7b8ff8p-2);
  return select(x < 0.5, near, exp(-x) / (limited + 1.0) * (1.0 + r));
}
/// For a plain number: the same arithmetic.
[[gnu::always_inline]] inline double exponential_integral(double x) {
  return exponential_integral(Pack<double, 2>(x))[0];
}

// Packs of float: in double, and rounded.
namespace detail {
template <int W>
[[gnu::always_inline]] inline Pack<double, W> widened(Pack<float, W> x) {
  return __builtin_convertvector(x.native, typename Pack<double, W>::Native);
}
template <int W>
[[gnu::always_inline]] inline Pack<float, W> narrowed(Pack<double, W> x) {
  return __builtin_convertvector(x.native, typename Pack<float, W>::Native);
}
}  // namespace detail
template <int W>
Pack<float, W> exp(Pack<float, W> x) {
  return detail::narrowed(exp(detail::widened(x)));
}
template <int W>
Pack<float, W> expm1(Pack<float, W> x) {
  return detail::narrowed(expm1(detail::widened(x)));
}
template <int W>
Pack<float, W> log(Pack<float, W> x) {
  return detail::narrowed(log(detail::widened(x)));
}
template <int W>
Pack<float, W> pow(Pack<float, W> x, std::type_identity_t<Pack<float, W>> y) {
  return detail::narrowed(pow(detail::widened(x), detail::widened(y)));
}
template <int W>
Pack<float, W> sin(Pack<float, W> x) {
  return detail::narrowed(sin(detail::widened(x)));
}
template <int W>
Pack<float, W> cos(Pack<float, W> x) {
  return detail::narrowed(cos(detail::widened(x)));
}
template <int W>
Pack<float, W> tanh(Pack<float, W> x) {
  return detail::narrowed(tanh(detail::widened(x)));
}
template <int W>
Pack<float, W> erf(Pack<float, W> x) {
  return detail::narrowed(erf(detail::widened(x)));
}
template <int W>
Pack<float, W> erfc(Pack<float, W> x) {
  return detail::narrowed(erfc(detail::widened(x)));
}
template <int W>
Pack<float, W> exponential_integral(Pack<float, W> x) {
  return detail::narrowed(exponential_integral(detail::widened(x)));
}

}  // namespace boltzmann
