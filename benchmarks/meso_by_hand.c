// Mesoparticles by hand: one scalar loop over a half list, order-free friction with energy reinjection, and Philox
// noise. The same physics as bench_meso's first problem, as one writes it for one purpose.
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define KB 0.831446

typedef struct {
  size_t n;
  double lx, ly, mass, depth, r0, lambda, alpha, cutoff, skin, gamma, heat_capacity;
  double *x, *v, *energy;  // x, y pairs
} Matter;

typedef struct {
  uint32_t* start;
  uint32_t* other;
  size_t room, builds;
  double* built;
} List;

static double nearest(double d, double l) { return d > 0.5 * l ? d - l : d < -0.5 * l ? d + l : d; }

static void build(Matter const* m, List* list) {
  double const reach = m->cutoff + m->skin;
  int const cx = (int)(m->lx / reach), cy = (int)(m->ly / reach);
  int* head = malloc(sizeof(int) * (size_t)(cx * cy));
  int* next = malloc(sizeof(int) * m->n);
  for (int c = 0; c < cx * cy; ++c) head[c] = -1;
  for (size_t i = m->n; i-- > 0;) {
    int a = (int)(m->x[2 * i] / m->lx * cx), b = (int)(m->x[2 * i + 1] / m->ly * cy);
    a = a < 0 ? 0 : a >= cx ? cx - 1 : a;
    b = b < 0 ? 0 : b >= cy ? cy - 1 : b;
    next[i] = head[b * cx + a];
    head[b * cx + a] = (int)i;
  }
  uint32_t count = 0;
  for (size_t i = 0; i < m->n; ++i) {
    list->start[i] = count;
    int a = (int)(m->x[2 * i] / m->lx * cx), b = (int)(m->x[2 * i + 1] / m->ly * cy);
    a = a < 0 ? 0 : a >= cx ? cx - 1 : a;
    b = b < 0 ? 0 : b >= cy ? cy - 1 : b;
    for (int db = -1; db <= 1; ++db)
      for (int da = -1; da <= 1; ++da)
        for (int j = head[(b + db + cy) % cy * cx + (a + da + cx) % cx]; j >= 0; j = next[j]) {
          if ((size_t)j <= i) continue;
          double const dx = nearest(m->x[2 * i] - m->x[2 * j], m->lx);
          double const dy = nearest(m->x[2 * i + 1] - m->x[2 * j + 1], m->ly);
          if (dx * dx + dy * dy >= reach * reach) continue;
          if (count == list->room) {
            list->room = 2 * list->room + 1024;
            list->other = realloc(list->other, sizeof(uint32_t) * list->room);
          }
          list->other[count++] = (uint32_t)j;
        }
  }
  list->start[m->n] = count;
  memcpy(list->built, m->x, sizeof(double) * 2 * m->n);
  ++list->builds;
  free(head);
  free(next);
}

static int moved(Matter const* m, List const* list) {
  double const most = 0.25 * m->skin * m->skin;
  for (size_t i = 0; i < m->n; ++i) {
    double const dx = nearest(m->x[2 * i] - list->built[2 * i], m->lx);
    double const dy = nearest(m->x[2 * i + 1] - list->built[2 * i + 1], m->ly);
    if (dx * dx + dy * dy > most) return 1;
  }
  return 0;
}

static void forces(Matter const* m, List const* list, double* f) {
  memset(f, 0, sizeof(double) * 2 * m->n);
  for (size_t i = 0; i < m->n; ++i) {
    double fx = 0, fy = 0;
    for (uint32_t e = list->start[i]; e < list->start[i + 1]; ++e) {
      uint32_t const j = list->other[e];
      double const dx = nearest(m->x[2 * i] - m->x[2 * j], m->lx);
      double const dy = nearest(m->x[2 * i + 1] - m->x[2 * j + 1], m->ly);
      double const r2 = dx * dx + dy * dy;
      if (r2 >= m->cutoff * m->cutoff) continue;
      double const r = sqrt(r2), d = m->lambda * (r / m->r0 - 1);
      double const push = m->depth * m->lambda / m->r0 * -d * (1 - m->alpha * d * (3 - d)) * exp(-d) / r;
      fx += push * dx;
      fy += push * dy;
      f[2 * j] -= push * dx;
      f[2 * j + 1] -= push * dy;
    }
    f[2 * i] += fx;
    f[2 * i + 1] += fy;
  }
}

static void philox(uint32_t c[4], uint32_t k0, uint32_t k1) {
  for (int round = 0; round < 10; ++round) {
    uint64_t const a = (uint64_t)0xD2511F53 * c[0], b = (uint64_t)0xCD9E8D57 * c[2];
    uint32_t const c1 = c[1], c3 = c[3];
    c[0] = (uint32_t)(b >> 32) ^ c1 ^ k0;
    c[1] = (uint32_t)b;
    c[2] = (uint32_t)(a >> 32) ^ c3 ^ k1;
    c[3] = (uint32_t)a;
    k0 += 0x9E3779B9;
    k1 += 0xBB67AE85;
  }
}

// sums: momentum x and y, energy lost.
static void friction(Matter* m, List const* list, double dt, uint32_t step, double* sums, double* beta) {
  memset(sums, 0, sizeof(double) * 3 * m->n);
  for (size_t i = 0; i < m->n; ++i) beta[i] = m->heat_capacity / m->energy[i];
  for (size_t i = 0; i < m->n; ++i)
    for (uint32_t e = list->start[i]; e < list->start[i + 1]; ++e) {
      uint32_t const j = list->other[e];
      double const dx = nearest(m->x[2 * i] - m->x[2 * j], m->lx);
      double const dy = nearest(m->x[2 * i + 1] - m->x[2 * j + 1], m->ly);
      double const r2 = dx * dx + dy * dy;
      if (r2 >= m->cutoff * m->cutoff) continue;
      double const w = 1 - sqrt(r2) / m->cutoff, chi = w * w;
      double const mean = 0.5 * (beta[i] + beta[j]);
      double const bracket = 1 + 0.25 * KB / m->heat_capacity * (beta[i] * beta[i] + beta[j] * beta[j]) / (mean * mean);
      double const drag = m->gamma * bracket * chi * chi * dt, noise = sqrt(2 * m->gamma * KB / mean * dt) * chi;
      uint32_t c[4] = {(uint32_t)i, j, step, 0};
      philox(c, 1, 0);
      double const radius = sqrt(-2 * log((c[0] + 0.5) * 0x1p-32)), angle = 6.283185307179586 * (c[1] * 0x1p-32);
      double const vx = m->v[2 * i] - m->v[2 * j], vy = m->v[2 * i + 1] - m->v[2 * j + 1];
      double const px = noise * radius * cos(angle) - drag * vx, py = noise * radius * sin(angle) - drag * vy;
      double const loss = 0.5 * (px * vx + py * vy);
      sums[3 * i] += px;
      sums[3 * i + 1] += py;
      sums[3 * i + 2] += loss;
      sums[3 * j] -= px;
      sums[3 * j + 1] -= py;
      sums[3 * j + 2] += loss;
    }
  for (size_t i = 0; i < m->n; ++i) {
    double const* s = sums + 3 * i;
    m->energy[i] -= s[2] + 0.5 * (s[0] * s[0] + s[1] * s[1]) / m->mass;
    m->v[2 * i] += s[0] / m->mass;
    m->v[2 * i + 1] += s[1] / m->mass;
  }
}

// Advances by so many steps, the first of which has this number (noise depends on it). x, v: 2 numbers a particle,
// inside the box [0, lx) x [0, ly). Returns how often lists were built.
size_t meso_by_hand(size_t n, double const* model, double lx, double ly, double* x, double* v, double* energy,
                    double dt, unsigned first_step, unsigned steps) {
  Matter m = {n,        lx,       ly,       model[0], model[1], model[2], model[3], model[4],
              model[5], model[6], model[7], model[8], x,        v,        energy};
  List list = {malloc(sizeof(uint32_t) * (n + 1)), NULL, 0, 0, malloc(sizeof(double) * 2 * n)};
  double* f = malloc(sizeof(double) * 2 * n);
  double* sums = malloc(sizeof(double) * 3 * n);
  double* beta = malloc(sizeof(double) * n);
  build(&m, &list);
  forces(&m, &list, f);
  for (unsigned step = first_step; step < first_step + steps; ++step) {
    for (size_t i = 0; i < n; ++i)
      for (int a = 0; a < 2; ++a) {
        double const l = a == 0 ? lx : ly;
        v[2 * i + a] += 0.5 * dt * f[2 * i + a] / m.mass;
        double const moved_to = x[2 * i + a] + dt * v[2 * i + a];
        x[2 * i + a] = moved_to < 0 ? moved_to + l : moved_to >= l ? moved_to - l : moved_to;
      }
    if (moved(&m, &list)) build(&m, &list);
    forces(&m, &list, f);
    for (size_t i = 0; i < 2 * n; ++i) v[i] += 0.5 * dt * f[i] / m.mass;
    friction(&m, &list, dt, step, sums, beta);
  }
  size_t const builds = list.builds;
  free(list.start);
  free(list.other);
  free(list.built);
  free(f);
  free(sums);
  free(beta);
  return builds;
}
