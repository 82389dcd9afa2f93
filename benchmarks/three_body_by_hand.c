/* Three bodies under gravity, RK4, as one writes it by hand in C: the yardstick of benchmarks/three_body.cpp. */
#include <math.h>

enum { N = 3, D = 3 };

static void accelerations(const double x[N][D], const double m[N], double a[N][D]) {
  for (int i = 0; i < N; ++i)
    for (int k = 0; k < D; ++k) a[i][k] = 0;
  for (int i = 0; i < N; ++i)
    for (int j = i + 1; j < N; ++j) {
      double r[D], r2 = 0;
      for (int k = 0; k < D; ++k) {
        r[k] = x[j][k] - x[i][k];
        r2 += r[k] * r[k];
      }
      const double w = 1 / (r2 * sqrt(r2));
      for (int k = 0; k < D; ++k) {
        a[i][k] += m[j] * w * r[k];
        a[j][k] -= m[i] * w * r[k];
      }
    }
}

void three_body_by_hand(double x[3][3], double v[3][3], const double m[3], double dt, long steps) {
  double x1[N][D], v1[N][D], kx[N][D], kv[N][D], a[N][D];
  for (long n = 0; n < steps; ++n) {
    accelerations(x, m, a);
    for (int i = 0; i < N; ++i)
      for (int k = 0; k < D; ++k) {
        kx[i][k] = v[i][k];
        kv[i][k] = a[i][k];
        x1[i][k] = x[i][k] + 0.5 * dt * v[i][k];
        v1[i][k] = v[i][k] + 0.5 * dt * a[i][k];
      }
    for (int stage = 1; stage < 3; ++stage) {
      const double h = stage == 1 ? 0.5 * dt : dt;
      accelerations(x1, m, a);
      for (int i = 0; i < N; ++i)
        for (int k = 0; k < D; ++k) {
          const double w = v1[i][k];
          kx[i][k] += 2 * w;
          kv[i][k] += 2 * a[i][k];
          x1[i][k] = x[i][k] + h * w;
          v1[i][k] = v[i][k] + h * a[i][k];
        }
    }
    accelerations(x1, m, a);
    for (int i = 0; i < N; ++i)
      for (int k = 0; k < D; ++k) {
        x[i][k] += dt / 6 * (kx[i][k] + v1[i][k]);
        v[i][k] += dt / 6 * (kv[i][k] + a[i][k]);
      }
  }
}
