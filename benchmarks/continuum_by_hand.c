/* Smooth particles by hand: density and rates of a gas in 3D with Lucy's weight, plain loops over a half list. */
#include <math.h>
#include <stddef.h>

struct gas {
  size_t size;
  double const *x, *v; /* 3 a particle */
  double const* energy;
  size_t const* start; /* of the neighbours of i among those after i */
  unsigned const* neighbour;
  double range, period, gamma;
  double *density, *push, *force, *heating;
};

static double nearest(double d, double period) { return d - period * rint(d / period); }

void smooth_rates_by_hand(struct gas const* g) {
  double const h = g->range, ih = 1 / h, norm = 105 / (16 * 3.14159265358979323846) * ih * ih * ih;
  for (size_t i = 0; i < g->size; ++i) g->density[i] = norm;
  for (size_t i = 0; i < g->size; ++i)
    for (size_t k = g->start[i]; k < g->start[i + 1]; ++k) {
      size_t const j = g->neighbour[k];
      double r2 = 0;
      for (int a = 0; a < 3; ++a) {
        double const d = nearest(g->x[3 * j + a] - g->x[3 * i + a], g->period);
        r2 += d * d;
      }
      if (r2 >= h * h) continue;
      double const q = sqrt(r2) * ih, u = 1 - q, w = norm * u * u * u * (1 + 3 * q);
      g->density[i] += w;
      g->density[j] += w;
    }
  for (size_t i = 0; i < g->size; ++i) {
    g->push[i] = (g->gamma - 1) * g->energy[i] / g->density[i];
    g->force[3 * i] = g->force[3 * i + 1] = g->force[3 * i + 2] = g->heating[i] = 0;
  }
  for (size_t i = 0; i < g->size; ++i)
    for (size_t k = g->start[i]; k < g->start[i + 1]; ++k) {
      size_t const j = g->neighbour[k];
      double d[3], r2 = 0, approach = 0;
      for (int a = 0; a < 3; ++a) {
        d[a] = nearest(g->x[3 * j + a] - g->x[3 * i + a], g->period);
        r2 += d[a] * d[a];
        approach += d[a] * (g->v[3 * j + a] - g->v[3 * i + a]);
      }
      if (r2 >= h * h) continue;
      double const u = 1 - sqrt(r2) * ih, push = -12 * norm * ih * ih * u * u * (g->push[i] + g->push[j]);
      for (int a = 0; a < 3; ++a) {
        g->force[3 * i + a] += push * d[a];
        g->force[3 * j + a] -= push * d[a];
      }
      g->heating[i] += 0.5 * push * approach;
      g->heating[j] += 0.5 * push * approach;
    }
}
