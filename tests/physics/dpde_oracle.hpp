// An oracle of dissipative particle dynamics with energy: every pair in turn, or all at once, by plain loops, with
// noise from outside. It shares nothing with the dissipations but the names of the conventions.
#pragma once

#include <boltzmann/dissipation/dissipation_law.hpp>

#include <array>
#include <cmath>
#include <vector>

namespace boltzmann::oracle {

template <int D>
using Triplet = std::array<double, D>;
template <int D>
double inner(Triplet<D> const& a, Triplet<D> const& b) {
  double sum = 0;
  for (int d = 0; d < D; ++d) sum += a[d] * b[d];
  return sum;
}

template <int D>
Triplet<D> difference(Triplet<D> const& a, Triplet<D> const& b) {
  Triplet<D> c{};
  for (int d = 0; d < D; ++d) c[d] = a[d] - b[d];
  return c;
}

template <int D>
struct Lump {
  Triplet<D> position{}, velocity{};
  double mass = 1, energy = 0, heat_capacity = 1;  // energy = heat capacity times temperature
  double temperature() const { return energy / heat_capacity; }
};

/// Friction gamma and noise sigma of a pair, without their weights chi^2 and chi.
struct Coefficients {
  double friction, noise;
};

/// Detailed balance asks for gamma = sigma^2 beta / 2 + (d/d eps_i + d/d eps_j) sigma^2 / 4.
template <int D>
Coefficients coefficients(DissipationLaw const& d, Lump<D> const& i, Lump<D> const& j, double k) {
  double const ti = i.temperature(), tj = j.temperature(), beta = (1 / ti + 1 / tj) / (2 * k);
  switch (d.convention) {
    case Convention::fixed_temperature:
      return {d.friction, std::sqrt(2 * d.friction * k * d.temperature)};
    case Convention::constant_noise: {
      double const noise = std::sqrt(2 * d.friction * k * d.temperature);
      return {noise * noise * beta / 2, noise};
    }
    case Convention::constant_friction: {
      // sigma^2 = 2 gamma / beta, and d beta / d eps_i = -1 / (2 k Ti^2 Ci).
      double const noise2 = 2 * d.friction / beta;
      double const slope =
          noise2 / beta / (2 * k) * (1 / (ti * ti * i.heat_capacity) + 1 / (tj * tj * j.heat_capacity));
      return {noise2 * beta / 2 + slope / 4, std::sqrt(noise2)};
    }
    case Convention::deterministic: {
      // Unprojected. The pair's kinetic temperature, so that for Maxwell's velocities <(T_ext - T_int) v^2> = 0 where
      // both are equal.
      auto const v = difference<D>(i.velocity, j.velocity);
      double const mu = i.mass * j.mass / (i.mass + j.mass);
      return {d.friction * (mu * inner<D>(v, v) / ((D + 2) * k) - (ti + tj) / 2) / d.temperature, 0};
    }
  }
  return {0, 0};
}

inline double weight(DissipationLaw const& d, double r) {
  return r < d.range ? std::pow(1 - r / d.range, d.exponent) : 0;
}

/// x_i - x_j by the nearest image in a periodic box of this length (0: open).
template <int D>
Triplet<D> apart(Lump<D> const& i, Lump<D> const& j, double length) {
  Triplet<D> r{};
  for (int d = 0; d < D; ++d) {
    r[d] = i.position[d] - j.position[d];
    if (length > 0) r[d] -= length * std::round(r[d] / length);
  }
  return r;
}

/// What i gains and j loses: -a v + s U, projected on the line of centres or not (then U[0] counts).
template <int D>
Triplet<D> impulse(DissipationLaw const& d, Triplet<D> const& r, Triplet<D> const& v, double a, double s,
                   Triplet<D> const& u) {
  Triplet<D> dp{};
  if (!d.projected) {
    for (int c = 0; c < D; ++c) dp[c] = -a * v[c] + s * u[c];
    return dp;
  }
  double const distance = std::sqrt(inner<D>(r, r)), along = (-a * inner<D>(v, r) / distance + s * u[0]) / distance;
  for (int c = 0; c < D; ++c) dp[c] = along * r[c];
  return dp;
}

/// One pair over dt with its coefficients frozen (Shardlow 2003, for unequal masses):
/// v' = [(1 - a/2mu) v + (s/mu) U] / (1 + a/2mu). Each takes half of what the motion loses.
template <int D>
void pair_step(DissipationLaw const& d, Lump<D>& i, Lump<D>& j, double k, double dt, Triplet<D> const& u,
               double length = 0) {
  auto const r = apart<D>(i, j, length);
  double const chi = weight(d, std::sqrt(inner<D>(r, r))), mu = i.mass * j.mass / (i.mass + j.mass);
  if (chi == 0) return;
  auto const [friction, noise] = coefficients<D>(d, i, j, k);
  double const a = friction * chi * chi * dt, s = noise * chi * std::sqrt(dt), x = 1 + a / (2 * mu);
  auto const v = difference<D>(i.velocity, j.velocity);
  auto const dp = impulse<D>(d, r, v, a / x, s / x, u);
  double before = 0, after = 0;
  for (auto const* p : {&i, &j}) before += p->mass * inner<D>(p->velocity, p->velocity) / 2;
  for (int c = 0; c < D; ++c) i.velocity[c] += dp[c] / i.mass, j.velocity[c] -= dp[c] / j.mass;
  for (auto const* p : {&i, &j}) after += p->mass * inner<D>(p->velocity, p->velocity) / 2;
  i.energy -= (after - before) / 2;
  j.energy -= (after - before) / 2;
}

template <int D, class Noise>  // noise(i, j) for i < j
void splitting_step(DissipationLaw const& d, std::vector<Lump<D>>& lumps, double k, double dt, Noise const& noise,
                    double length) {
  for (std::size_t i = 0; i < lumps.size(); ++i)
    for (std::size_t j = i + 1; j < lumps.size(); ++j) pair_step<D>(d, lumps[i], lumps[j], k, dt, noise(i, j), length);
}

/// All pairs at once, in so many tries: the first on the velocities as they are, each further one on the mean of them
/// and of those which the one before has led to. The last one counts, with u its velocities and dP' the impulses of the
/// one before: eps_i -= sum_j dp_ij.u_ij / 2 + dP_i.(dP_i - dP'_i) / 2m_i, which is what the motion gains in total. If
/// there was but one (dP' = 0), the two of a pair share what noise adds: + |dp_ij|^2 (1/m_j - 1/m_i) / 4.
template <int D, class Noise>
void simultaneous_step(DissipationLaw const& d, std::vector<Lump<D>>& lumps, double k, double dt, Noise const& noise,
                       double length, int tries) {
  std::vector<Triplet<D>> total(lumps.size(), Triplet<D>{}), before;
  std::vector<double> loss;
  for (int t = 0; t < tries; ++t) {
    before = total;
    total.assign(lumps.size(), Triplet<D>{});
    loss.assign(lumps.size(), 0.0);
    auto const velocity = [&](std::size_t i) {
      auto u = lumps[i].velocity;
      for (int c = 0; c < D; ++c) u[c] += before[i][c] / (2 * lumps[i].mass);
      return u;
    };
    for (std::size_t i = 0; i < lumps.size(); ++i)
      for (std::size_t j = 0; j < lumps.size(); ++j) {
        auto const &p = lumps[i], &q = lumps[j];
        auto const r = apart<D>(p, q, length);
        double const chi = i == j ? 0 : weight(d, std::sqrt(inner<D>(r, r)));
        if (chi == 0) continue;
        auto const [friction, sigma] = coefficients<D>(d, p, q, k);
        auto n = noise(std::min(i, j), std::max(i, j));
        if (!d.projected && i > j)
          for (double& x : n) x = -x;
        auto const u = difference<D>(velocity(i), velocity(j));
        auto const dp = impulse<D>(d, r, u, friction * chi * chi * dt, sigma * chi * std::sqrt(dt), n);
        for (int c = 0; c < D; ++c) total[i][c] += dp[c];
        loss[i] += inner<D>(dp, u) / 2;
        if (tries == 1) loss[i] += inner<D>(dp, dp) * (1 / q.mass - 1 / p.mass) / 4;
      }
  }
  for (std::size_t i = 0; i < lumps.size(); ++i) {
    auto& p = lumps[i];
    p.energy -= loss[i] + inner<D>(total[i], difference<D>(total[i], before[i])) / (2 * p.mass);
    for (int c = 0; c < D; ++c) p.velocity[c] += total[i][c] / p.mass;
  }
}

}  // namespace boltzmann::oracle
