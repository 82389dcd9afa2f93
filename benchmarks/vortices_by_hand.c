// Vortices in 2D with a solid core, all pairs, by hand: intrinsics over columns, four targets for each load of sources
// (AVX2, which has half as many registers: two), in double and in single precision. Nothing in it is general: what a
// program that does only this would run.
#include <stddef.h>

#if defined(__AVX512F__)
#include <immintrin.h>

enum { block = 4 };

// The velocity of each of `count` vortices (a multiple of 8), circulation over 2 pi in w; the same core^2 > 0 for all.
// The inverse is a 14-bit estimate and two of Newton's steps, for a division takes three times as long.
int vortices_by_hand(size_t count, double const* x, double const* y, double const* w, double core2, double* u,
                     double* v) {
  __m512d const least = _mm512_set1_pd(core2), one = _mm512_set1_pd(1);
  for (size_t i = 0; i < count; i += block) {
    __m512d px[block], py[block], ux[block], uy[block];
#pragma GCC unroll 4
    for (int t = 0; t < block; ++t) {
      px[t] = _mm512_set1_pd(x[i + t]), py[t] = _mm512_set1_pd(y[i + t]);
      ux[t] = uy[t] = _mm512_setzero_pd();
    }
    for (size_t j = 0; j < count; j += 8) {
      __m512d const qx = _mm512_loadu_pd(x + j), qy = _mm512_loadu_pd(y + j), qw = _mm512_loadu_pd(w + j);
#pragma GCC unroll 4
      for (int t = 0; t < block; ++t) {
        __m512d const dx = _mm512_sub_pd(px[t], qx), dy = _mm512_sub_pd(py[t], qy);
        __m512d const r2 = _mm512_max_pd(_mm512_fmadd_pd(dx, dx, _mm512_mul_pd(dy, dy)), least);
        __m512d const estimate = _mm512_rcp14_pd(r2);
        __m512d const better = _mm512_fmadd_pd(estimate, _mm512_fnmadd_pd(r2, estimate, one), estimate);
        __m512d const inverse = _mm512_fmadd_pd(better, _mm512_fnmadd_pd(r2, better, one), better);
        __m512d const f = _mm512_mul_pd(qw, inverse);
        ux[t] = _mm512_fnmadd_pd(f, dy, ux[t]), uy[t] = _mm512_fmadd_pd(f, dx, uy[t]);
      }
    }
#pragma GCC unroll 4
    for (int t = 0; t < block; ++t) u[i + t] = _mm512_reduce_add_pd(ux[t]), v[i + t] = _mm512_reduce_add_pd(uy[t]);
  }
  return 1;
}

// The same of floats (a multiple of 16), by a 14-bit estimate of the inverse and one step of Newton's.
int vortices_by_hand_in_single(size_t count, float const* x, float const* y, float const* w, float core2, float* u,
                               float* v) {
  __m512 const least = _mm512_set1_ps(core2), two = _mm512_set1_ps(2);
  for (size_t i = 0; i < count; i += block) {
    __m512 px[block], py[block], ux[block], uy[block];
#pragma GCC unroll 4
    for (int t = 0; t < block; ++t) {
      px[t] = _mm512_set1_ps(x[i + t]), py[t] = _mm512_set1_ps(y[i + t]);
      ux[t] = uy[t] = _mm512_setzero_ps();
    }
    for (size_t j = 0; j < count; j += 16) {
      __m512 const qx = _mm512_loadu_ps(x + j), qy = _mm512_loadu_ps(y + j), qw = _mm512_loadu_ps(w + j);
#pragma GCC unroll 4
      for (int t = 0; t < block; ++t) {
        __m512 const dx = _mm512_sub_ps(px[t], qx), dy = _mm512_sub_ps(py[t], qy);
        __m512 const r2 = _mm512_max_ps(_mm512_fmadd_ps(dx, dx, _mm512_mul_ps(dy, dy)), least);
        __m512 const estimate = _mm512_rcp14_ps(r2);
        __m512 const inverse = _mm512_mul_ps(estimate, _mm512_fnmadd_ps(r2, estimate, two));
        __m512 const f = _mm512_mul_ps(qw, inverse);
        ux[t] = _mm512_fnmadd_ps(f, dy, ux[t]), uy[t] = _mm512_fmadd_ps(f, dx, uy[t]);
      }
    }
#pragma GCC unroll 4
    for (int t = 0; t < block; ++t) u[i + t] = _mm512_reduce_add_ps(ux[t]), v[i + t] = _mm512_reduce_add_ps(uy[t]);
  }
  return 1;
}

#elif defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>

enum { block = 2 };

static double sum4(__m256d a) {
  __m128d const two = _mm_add_pd(_mm256_castpd256_pd128(a), _mm256_extractf128_pd(a, 1));
  return _mm_cvtsd_f64(_mm_add_sd(two, _mm_unpackhi_pd(two, two)));
}
static float sum8(__m256 a) {
  __m128 const four = _mm_add_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
  __m128 const two = _mm_add_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_add_ss(two, _mm_shuffle_ps(two, two, 1)));
}

// The same with AVX2, by divisions: there is no estimate of an inverse in double, and in single it would save nothing.
int vortices_by_hand(size_t count, double const* x, double const* y, double const* w, double core2, double* u,
                     double* v) {
  __m256d const least = _mm256_set1_pd(core2);
  for (size_t i = 0; i < count; i += block) {
    __m256d px[block], py[block], ux[block], uy[block];
#pragma GCC unroll 2
    for (int t = 0; t < block; ++t) {
      px[t] = _mm256_set1_pd(x[i + t]), py[t] = _mm256_set1_pd(y[i + t]);
      ux[t] = uy[t] = _mm256_setzero_pd();
    }
    for (size_t j = 0; j < count; j += 4) {
      __m256d const qx = _mm256_loadu_pd(x + j), qy = _mm256_loadu_pd(y + j), qw = _mm256_loadu_pd(w + j);
#pragma GCC unroll 2
      for (int t = 0; t < block; ++t) {
        __m256d const dx = _mm256_sub_pd(px[t], qx), dy = _mm256_sub_pd(py[t], qy);
        __m256d const f = _mm256_div_pd(qw, _mm256_max_pd(_mm256_fmadd_pd(dx, dx, _mm256_mul_pd(dy, dy)), least));
        ux[t] = _mm256_fnmadd_pd(f, dy, ux[t]), uy[t] = _mm256_fmadd_pd(f, dx, uy[t]);
      }
    }
#pragma GCC unroll 2
    for (int t = 0; t < block; ++t) u[i + t] = sum4(ux[t]), v[i + t] = sum4(uy[t]);
  }
  return 1;
}

int vortices_by_hand_in_single(size_t count, float const* x, float const* y, float const* w, float core2, float* u,
                               float* v) {
  __m256 const least = _mm256_set1_ps(core2);
  for (size_t i = 0; i < count; i += block) {
    __m256 px[block], py[block], ux[block], uy[block];
#pragma GCC unroll 2
    for (int t = 0; t < block; ++t) {
      px[t] = _mm256_set1_ps(x[i + t]), py[t] = _mm256_set1_ps(y[i + t]);
      ux[t] = uy[t] = _mm256_setzero_ps();
    }
    for (size_t j = 0; j < count; j += 8) {
      __m256 const qx = _mm256_loadu_ps(x + j), qy = _mm256_loadu_ps(y + j), qw = _mm256_loadu_ps(w + j);
#pragma GCC unroll 2
      for (int t = 0; t < block; ++t) {
        __m256 const dx = _mm256_sub_ps(px[t], qx), dy = _mm256_sub_ps(py[t], qy);
        __m256 const f = _mm256_div_ps(qw, _mm256_max_ps(_mm256_fmadd_ps(dx, dx, _mm256_mul_ps(dy, dy)), least));
        ux[t] = _mm256_fnmadd_ps(f, dy, ux[t]), uy[t] = _mm256_fmadd_ps(f, dx, uy[t]);
      }
    }
#pragma GCC unroll 2
    for (int t = 0; t < block; ++t) u[i + t] = sum8(ux[t]), v[i + t] = sum8(uy[t]);
  }
  return 1;
}

#else

// Without AVX2 there is nothing to compare with.
int vortices_by_hand(size_t count, double const* x, double const* y, double const* w, double core2, double* u,
                     double* v) {
  (void)count, (void)x, (void)y, (void)w, (void)core2, (void)u, (void)v;
  return 0;
}
int vortices_by_hand_in_single(size_t count, float const* x, float const* y, float const* w, float core2, float* u,
                               float* v) {
  (void)count, (void)x, (void)y, (void)w, (void)core2, (void)u, (void)v;
  return 0;
}

#endif
