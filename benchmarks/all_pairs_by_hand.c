// Softened gravity of all pairs in 3D by hand: AVX-512 intrinsics over columns, four targets for each load of sources,
// 1/sqrt from a 14-bit estimate and one fourth-order correction. Nothing in it is general: what a program that does
// only this would run.
#include <stddef.h>

#if defined(__AVX512F__)
#include <immintrin.h>

enum { block = 4 };

struct Constants {
  __m512d softening2, one, half, three_eighths, five_sixteenths;
};

static inline __attribute__((always_inline)) __m512d inverse_root(__m512d a, struct Constants const* k) {
  __m512d const y = _mm512_rsqrt14_pd(a);
  __m512d const e = _mm512_fnmadd_pd(_mm512_mul_pd(a, y), y, k->one);
  __m512d const c = _mm512_fmadd_pd(e, _mm512_fmadd_pd(e, k->five_sixteenths, k->three_eighths), k->half);
  return _mm512_fmadd_pd(_mm512_mul_pd(y, e), c, y);
}

// The force on every one of `count` particles (a multiple of 8; masses of 0 fill up) and, if `potential` is not null,
// m_i sum_j -m_j / r, its own share of -m_i^2 / softening taken out again. G = 1, softening > 0.
static inline __attribute__((always_inline)) void all_pairs(size_t count, double const* x, double const* y,
                                                            double const* z, double const* m, double softening2,
                                                            double* fx, double* fy, double* fz, double* potential,
                                                            int with_potential) {
  struct Constants const k = {_mm512_set1_pd(softening2), _mm512_set1_pd(1), _mm512_set1_pd(0.5), _mm512_set1_pd(0.375),
                              _mm512_set1_pd(0.3125)};
  double const self = 1 / __builtin_sqrt(softening2);
  for (size_t i = 0; i < count; i += block) {
    __m512d px[block], py[block], pz[block], ax[block], ay[block], az[block], u[block];
#pragma GCC unroll 4
    for (int t = 0; t < block; ++t) {
      px[t] = _mm512_set1_pd(x[i + t]), py[t] = _mm512_set1_pd(y[i + t]), pz[t] = _mm512_set1_pd(z[i + t]);
      ax[t] = ay[t] = az[t] = u[t] = _mm512_setzero_pd();
    }
    for (size_t j = 0; j < count; j += 8) {
      __m512d const qx = _mm512_loadu_pd(x + j), qy = _mm512_loadu_pd(y + j), qz = _mm512_loadu_pd(z + j);
      __m512d const qm = _mm512_loadu_pd(m + j);
#pragma GCC unroll 4
      for (int t = 0; t < block; ++t) {
        __m512d const dx = _mm512_sub_pd(qx, px[t]), dy = _mm512_sub_pd(qy, py[t]), dz = _mm512_sub_pd(qz, pz[t]);
        __m512d const r2 = _mm512_fmadd_pd(dz, dz, _mm512_fmadd_pd(dy, dy, _mm512_fmadd_pd(dx, dx, k.softening2)));
        __m512d const inverse = inverse_root(r2, &k);
        __m512d const phi = _mm512_mul_pd(qm, inverse);
        __m512d const f = _mm512_mul_pd(phi, _mm512_mul_pd(inverse, inverse));
        ax[t] = _mm512_fmadd_pd(dx, f, ax[t]);
        ay[t] = _mm512_fmadd_pd(dy, f, ay[t]);
        az[t] = _mm512_fmadd_pd(dz, f, az[t]);
        if (with_potential) u[t] = _mm512_add_pd(u[t], phi);
      }
    }
#pragma GCC unroll 4
    for (int t = 0; t < block; ++t) {
      double const mass = m[i + t];
      fx[i + t] = mass * _mm512_reduce_add_pd(ax[t]);
      fy[i + t] = mass * _mm512_reduce_add_pd(ay[t]);
      fz[i + t] = mass * _mm512_reduce_add_pd(az[t]);
      if (with_potential) potential[i + t] = -mass * (_mm512_reduce_add_pd(u[t]) - mass * self);
    }
  }
}

int all_pairs_by_hand(size_t count, double const* x, double const* y, double const* z, double const* m,
                      double softening2, double* fx, double* fy, double* fz, double* potential) {
  if (potential)
    all_pairs(count, x, y, z, m, softening2, fx, fy, fz, potential, 1);
  else
    all_pairs(count, x, y, z, m, softening2, fx, fy, fz, potential, 0);
  return 1;
}

#else

// Without AVX-512 there is nothing to compare with.
int all_pairs_by_hand(size_t count, double const* x, double const* y, double const* z, double const* m,
                      double softening2, double* fx, double* fy, double* fz, double* potential) {
  (void)count, (void)x, (void)y, (void)z, (void)m, (void)softening2, (void)fx, (void)fy, (void)fz, (void)potential;
  return 0;
}

#endif
