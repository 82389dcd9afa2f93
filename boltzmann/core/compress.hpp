// Compression: stores the 32-bit lanes of a register for which a condition holds one after the other.
#pragma once

#include <boltzmann/core/pack.hpp>

#include <cstdint>
#if defined(__AVX2__)
#include <immintrin.h>
#endif

namespace boltzmann {

/// One bit for each lane.
using LaneBits = unsigned;

[[gnu::always_inline]] inline int count_of(LaneBits bits) { return __builtin_popcount(bits); }

/// The lanes of `a` that are below `limit`; NaN is not.
template <class Real, int W>
[[gnu::always_inline]] inline LaneBits lanes_below(Pack<Real, W> a, Real limit) {
  [[maybe_unused]] constexpr int bytes = W * static_cast<int>(sizeof(Real));
  [[maybe_unused]] constexpr bool is_double = sizeof(Real) == 8;
#if defined(__AVX512F__)
  if constexpr (bytes == 64 && is_double)
    return _mm512_cmp_pd_mask((__m512d)a.native, _mm512_set1_pd(limit), _CMP_LT_OQ);
  else if constexpr (bytes == 64)
    return _mm512_cmp_ps_mask((__m512)a.native, _mm512_set1_ps(limit), _CMP_LT_OQ);
  else
#endif
#if defined(__AVX2__)
      if constexpr (bytes == 32 && is_double)
    return static_cast<LaneBits>(
        _mm256_movemask_pd(_mm256_cmp_pd((__m256d)a.native, _mm256_set1_pd(limit), _CMP_LT_OQ)));
  else if constexpr (bytes == 32)
    return static_cast<LaneBits>(
        _mm256_movemask_ps(_mm256_cmp_ps((__m256)a.native, _mm256_set1_ps(limit), _CMP_LT_OQ)));
  else
#endif
  {
    LaneBits bits = 0;
    for (int lane = 0; lane < W; ++lane) bits |= static_cast<LaneBits>(a.native[lane] < limit) << lane;
    return bits;
  }
}

/// W numbers of 32 bits.
template <int W>
using LaneWords = typename detail::register_of<std::uint32_t, W>::type;

template <int W>
[[gnu::always_inline]] inline LaneWords<W> load_words(std::uint32_t const* from) {
  LaneWords<W> words;
  __builtin_memcpy(&words, from, sizeof(words));
  return words;
}

/// The lanes that are equal to `value`.
template <int W>
[[gnu::always_inline]] inline LaneBits lanes_equal(LaneWords<W> words, std::uint32_t value) {
#if defined(__AVX512F__)
  if constexpr (W == 16)
    return _mm512_cmpeq_epi32_mask((__m512i)words, _mm512_set1_epi32(static_cast<int>(value)));
  else
#endif
#if defined(__AVX2__)
      if constexpr (W == 8)
    return static_cast<LaneBits>(
        _mm256_movemask_ps((__m256)_mm256_cmpeq_epi32((__m256i)words, _mm256_set1_epi32(static_cast<int>(value)))));
  else
#endif
  {
    LaneBits bits = 0;
    for (int lane = 0; lane < W; ++lane) bits |= static_cast<LaneBits>(words[lane] == value) << lane;
    return bits;
  }
}

namespace detail {
/// For each set of W lanes: the numbers of its lanes, in order.
template <int W>
struct SelectedLanes {
  std::uint8_t lane[1 << W][W];
  constexpr SelectedLanes() : lane{} {
    for (int bits = 0; bits < 1 << W; ++bits) {
      int next = 0;
      for (int l = 0; l < W; ++l)
        if (bits >> l & 1) lane[bits][next++] = static_cast<std::uint8_t>(l);
    }
  }
  static SelectedLanes const table;
};
template <int W>
constexpr SelectedLanes<W> SelectedLanes<W>::table{};
}  // namespace detail

/// Stores those of the W words whose bit is set, in order. All W words at `to` are written; the rest have no meaning.
template <int W>
[[gnu::always_inline]] inline void store_selected(std::uint32_t* to, LaneWords<W> words, LaneBits bits) {
#if defined(__AVX512VL__)
  if constexpr (W == 16)
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), (__m512i)words));
  else if constexpr (W == 8)
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                        _mm256_maskz_compress_epi32(static_cast<__mmask8>(bits), (__m256i)words));
  else
#elif defined(__AVX2__)
  if constexpr (W == 8 || W == 4) {
    long long lanes = 0;
    __builtin_memcpy(&lanes, detail::SelectedLanes<W>::table.lane[bits], W);
    __m256i const order = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(lanes));
    __m256i all;
    if constexpr (W == 8)
      all = (__m256i)words;
    else
      all = _mm256_castsi128_si256((__m128i)words);
    __m256i const selected = _mm256_permutevar8x32_epi32(all, order);
    __builtin_memcpy(to, &selected, W * sizeof(*to));
  } else
#endif
  {
    for (int lane = 0; lane < W; ++lane) {
      *to = words[lane];
      to += bits >> lane & 1U;
    }
  }
}
template <int W>
[[gnu::always_inline]] inline void store_selected(float* to, Pack<float, W> values, LaneBits bits) {
  store_selected<W>(reinterpret_cast<std::uint32_t __attribute__((may_alias))*>(to), (LaneWords<W>)values.native, bits);
}

}  // namespace boltzmann
