// Pack<Real, W>: W numbers for SIMD arithmetic, on the compiler's vector extensions.
#pragma once

#include <boltzmann/core/number.hpp>

#include <concepts>
#include <cstdint>
#include <limits>

namespace boltzmann {

#if defined(__AVX512F__)
inline constexpr int register_bytes = 64;
#elif defined(__AVX__)
inline constexpr int register_bytes = 32;
#else
inline constexpr int register_bytes = 16;
#endif

/// Numbers per register of the instruction set this unit is compiled for.
template <class Real>
inline constexpr int native_width = register_bytes / static_cast<int>(sizeof(Real));

namespace detail {
template <class Real>
struct integer_of;
template <>
struct integer_of<double> {
  using type = std::int64_t;
};
template <>
struct integer_of<float> {
  using type = std::int32_t;
};
template <class Element, int W>
struct register_of {
  typedef Element type __attribute__((vector_size(W * sizeof(Element))));
};
/// The lanes of one register, or of two concatenated ones, selected by the low bits of `at`.
template <class Native, class Lanes>
[[gnu::always_inline]] inline Native permuted(Native a, Lanes at) {
#if defined(__clang__)
  Native result;
  constexpr int width = sizeof(Native) / sizeof(a[0]);
  for (int lane = 0; lane < width; ++lane) result[lane] = a[at[lane] & (width - 1)];
  return result;
#else
  return __builtin_shuffle(a, at);
#endif
}
template <class Native, class Lanes>
[[gnu::always_inline]] inline Native permuted(Native a, Native b, Lanes at) {
#if defined(__clang__)
  Native result;
  constexpr int width = sizeof(Native) / sizeof(a[0]);
  for (int lane = 0; lane < width; ++lane)
    result[lane] = at[lane] & width ? b[at[lane] & (width - 1)] : a[at[lane] & (width - 1)];
  return result;
#else
  return __builtin_shuffle(a, b, at);
#endif
}

}  // namespace detail

/// The result of comparing packs: one truth value per lane.
template <class Real, int W>
struct Mask {
  using Native = typename detail::register_of<typename detail::integer_of<Real>::type, W>::type;
  Native native;

  friend Mask operator&(Mask a, Mask b) { return {a.native & b.native}; }
  friend Mask operator|(Mask a, Mask b) { return {a.native | b.native}; }
  friend Mask operator!(Mask a) { return {~a.native}; }
  bool operator[](int lane) const { return native[lane] != 0; }
  /// Makes `if`, `?:`, && and || on masks a compile-time error.
  template <std::same_as<bool> Truth>
  explicit operator Truth() const {
    static_assert(
        sizeof(Truth) == 0,
        "of several particles at once there is no `if`: write select(condition, a, b), & for && and | for ||");
    return {};
  }
};

/// True if any lane is.
template <class Real, int W>
bool any(Mask<Real, W> mask) {
  bool result = false;
  for (int lane = 0; lane < W; ++lane) result = result || mask.native[lane] != 0;
  return result;
}

template <class Real = double, int W = native_width<Real>>
struct Pack {
  static constexpr int width = W;
  using Native = typename detail::register_of<Real, W>::type;
  Native native;

  Pack() = default;
  Pack(Native v) : native(v) {}           // NOLINT: a register is a pack
  Pack(Real s) : native(s - Native{}) {}  // NOLINT: a number is a pack of itself; -0.0 keeps its sign

  Real operator[](int lane) const { return native[lane]; }

  friend Pack operator+(Pack a, Pack b) { return a.native + b.native; }
  friend Pack operator-(Pack a, Pack b) { return a.native - b.native; }
  friend Pack operator*(Pack a, Pack b) { return a.native * b.native; }
  friend Pack operator/(Pack a, Pack b) { return a.native / b.native; }
  friend Pack operator-(Pack a) { return -a.native; }
  friend Pack operator+(Pack a) { return a; }
  Pack& operator+=(Pack b) { return *this = *this + b; }
  Pack& operator-=(Pack b) { return *this = *this - b; }
  Pack& operator*=(Pack b) { return *this = *this * b; }
  Pack& operator/=(Pack b) { return *this = *this / b; }

  friend Mask<Real, W> operator<(Pack a, Pack b) { return {a.native < b.native}; }
  friend Mask<Real, W> operator<=(Pack a, Pack b) { return {a.native <= b.native}; }
  friend Mask<Real, W> operator>(Pack a, Pack b) { return {a.native > b.native}; }
  friend Mask<Real, W> operator>=(Pack a, Pack b) { return {a.native >= b.native}; }
  friend Mask<Real, W> operator==(Pack a, Pack b) { return {a.native == b.native}; }
  friend Mask<Real, W> operator!=(Pack a, Pack b) { return {a.native != b.native}; }

  /// a where the condition holds, else b.
  friend Pack select(Mask<Real, W> condition, Pack a, Pack b) { return condition.native ? a.native : b.native; }
  // If one operand is NaN, the instructions, which clang emits by itself, return the second: here a.
  friend Pack min(Pack a, Pack b) {
#if defined(__AVX512F__) && !defined(__clang__)
    if constexpr (sizeof(Native) == 64 && sizeof(Real) == 8)
      return __builtin_ia32_minpd512_mask(b.native, a.native, a.native, -1, 4);
    else if constexpr (sizeof(Native) == 64)
      return __builtin_ia32_minps512_mask(b.native, a.native, a.native, -1, 4);
    else
#endif
#if defined(__AVX__) && !defined(__clang__)
        if constexpr (sizeof(Native) == 32 && sizeof(Real) == 8)
      return __builtin_ia32_minpd256(b.native, a.native);
    else if constexpr (sizeof(Native) == 32)
      return __builtin_ia32_minps256(b.native, a.native);
    else
#endif
      return select(b < a, b, a);
  }
  friend Pack max(Pack a, Pack b) {
#if defined(__AVX512F__) && !defined(__clang__)
    if constexpr (sizeof(Native) == 64 && sizeof(Real) == 8)
      return __builtin_ia32_maxpd512_mask(b.native, a.native, a.native, -1, 4);
    else if constexpr (sizeof(Native) == 64)
      return __builtin_ia32_maxps512_mask(b.native, a.native, a.native, -1, 4);
    else
#endif
#if defined(__AVX__) && !defined(__clang__)
        if constexpr (sizeof(Native) == 32 && sizeof(Real) == 8)
      return __builtin_ia32_maxpd256(b.native, a.native);
    else if constexpr (sizeof(Native) == 32)
      return __builtin_ia32_maxps256(b.native, a.native);
    else
#endif
      return select(a < b, b, a);
  }
  friend Pack abs(Pack a) {  // also for -0 and NaN: clears the sign bit
    using Bits = typename Mask<Real, W>::Native;
    return (Native)((Bits)a.native & (Bits{} + std::numeric_limits<typename detail::integer_of<Real>::type>::max()));
  }

  friend Pack sqrt(Pack a) {
#if defined(__AVX512F__) && defined(__clang__)
    if constexpr (sizeof(Native) == 64 && sizeof(Real) == 8)
      return __builtin_ia32_sqrtpd512(a.native, 4);
    else if constexpr (sizeof(Native) == 64)
      return __builtin_ia32_sqrtps512(a.native, 4);
    else
#elif defined(__AVX512F__)
    if constexpr (sizeof(Native) == 64 && sizeof(Real) == 8)
      return __builtin_ia32_sqrtpd512_mask(a.native, a.native, -1, 4);
    else if constexpr (sizeof(Native) == 64)
      return __builtin_ia32_sqrtps512_mask(a.native, a.native, -1, 4);
    else
#endif
#if defined(__AVX__)
        if constexpr (sizeof(Native) == 32 && sizeof(Real) == 8)
      return __builtin_ia32_sqrtpd256(a.native);
    else if constexpr (sizeof(Native) == 32)
      return __builtin_ia32_sqrtps256(a.native);
    else
#endif
#if defined(__SSE2__)
        if constexpr (sizeof(Native) == 16 && sizeof(Real) == 8)
      return __builtin_ia32_sqrtpd(a.native);
    else if constexpr (sizeof(Native) == 16)
      return __builtin_ia32_sqrtps(a.native);
    else
#endif
    {
      Pack result;
      for (int lane = 0; lane < W; ++lane) result.native[lane] = std::sqrt(a.native[lane]);
      return result;
    }
  }

  /// 1 / sqrt(a); with AVX-512 a 14-bit estimate and one fourth-order correction y += y e (1/2 + e (3/8 + 5/16 e)),
  /// e = 1 - a y^2, relative error below 1e-14; infinite at zero.
  friend Pack rsqrt(Pack a) {
#if defined(__AVX512F__)
    if constexpr (sizeof(Native) == 64 && sizeof(Real) == 8) {
      Pack const y = Native(__builtin_ia32_rsqrt14pd512_mask(a.native, a.native, -1));
      Pack const e = Real(1) - a * y * y;
      Pack const corrected = y + y * e * (Real(0.5) + e * (Real(0.375) + Real(0.3125) * e));
      return select(e == e, corrected, y);  // at zero and infinity e is NaN, and the estimate is exact
    } else
#endif
      return Real(1) / sqrt(a);
  }

  /// 1 / a where both are normal numbers, to a relative error below epsilon (1.25 of it where products are not fused);
  /// NaN or the right value at zero and infinity. With AVX-512 a 14-bit estimate and two of Newton's steps (floats:
  /// one), a third of a division's time.
  friend Pack reciprocal(Pack a) {
#if defined(__AVX512F__)
    if constexpr (sizeof(Native) == 64) {
      Pack y;
      if constexpr (sizeof(Real) == 8) {
        y = Native(__builtin_ia32_rcp14pd512_mask(a.native, a.native, -1));
        y = y + y * (Real(1) - a * y);
      } else {
        y = Native(__builtin_ia32_rcp14ps512_mask(a.native, a.native, -1));
      }
      return y + y * (Real(1) - a * y);
    } else
#endif
      return Real(1) / a;
  }
};

/// W consecutive numbers, at any alignment.
template <int W, class Real>
[[gnu::always_inline]] inline Pack<Real, W> load_pack(Real const* from) {
  Pack<Real, W> pack;
  __builtin_memcpy(&pack.native, from, sizeof(pack.native));
  return pack;
}
template <int W, class Real>
[[gnu::always_inline]] inline void store_pack(Real* to, Pack<Real, W> pack) {
  __builtin_memcpy(to, &pack.native, sizeof(pack.native));
}

/// The sum over all lanes, always in the same order.
template <class Real, int W>
Real sum(Pack<Real, W> a) {
  Real lanes[W];
  for (int lane = 0; lane < W; ++lane) lanes[lane] = a.native[lane];
  for (int half = W / 2; half > 0; half /= 2)
    for (int lane = 0; lane < half; ++lane) lanes[lane] += lanes[lane + half];
  return lanes[0];
}

}  // namespace boltzmann

#include <boltzmann/core/pack_math.hpp>  // exp, log, pow, sin, cos, tanh of packs
