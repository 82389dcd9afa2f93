// Ewald sums in one, two and three dimensions, in the plain form of textbooks.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/pack.hpp>
#include <boltzmann/schemes/mesh/ewald.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

namespace boltzmann {

namespace {

constexpr double euler_gamma = std::numbers::egamma;
// The short-range sum ends at alpha r = reach, the long-range one at k = 2 alpha reach: exp(-reach^2) = 4e-18.
constexpr double reach = 6.35;

/// Potential and -(1/r) d phi/dr of a strength 1 in its cloud, for C = 1.
struct Near {
  double potential, field_over_r;
};
template <int D>
Near near(double square, double alpha) {
  double const r = std::sqrt(square), e = std::exp(-alpha * alpha * square);
  if constexpr (D == 1) {
    double const c = std::erfc(alpha * r);
    return {0.5 * (e / (alpha * root_pi) - r * c), r > 0 ? 0.5 * c / r : 0.0};
  } else if constexpr (D == 2) {
    return {exponential_integral(alpha * alpha * square) / (4 * pi), e / (2 * pi * square)};
  } else {
    double const c = std::erfc(alpha * r) / r;
    return {c / (4 * pi), (c + 2 * alpha / root_pi * e) / (4 * pi * square)};
  }
}

/// The short-range potential of a strength at its own place, minus that of the bare strength, for C = 1.
template <int D>
double own(double alpha) {
  if constexpr (D == 1)
    return 0.5 / (alpha * root_pi);
  else if constexpr (D == 2)
    return -(euler_gamma + 2 * std::log(alpha)) / (4 * pi);
  else
    return -2 * alpha / root_pi / (4 * pi);
}

template <int D>
double volume_of(Vector<D> const& edges) {
  double volume = 1;
  for (int a = 0; a < D; ++a) volume *= edges[a];
  return volume;
}

template <int D>
void check(std::span<Vector<D> const> positions, std::span<double const> strengths, Vector<D> const& edges,
           double constant, double alpha) {
  if (positions.size() != strengths.size())
    throw Error(fmt::format("ewald_sums: {} positions but {} strengths", positions.size(), strengths.size()));
  for (int a = 0; a < D; ++a)
    if (!(edges[a] > 0) || !std::isfinite(edges[a]))
      throw Error(fmt::format("ewald_sums: edge {} = {} must be positive", a, edges[a]));
  if (!(alpha >= 0) || !std::isfinite(alpha))
    throw Error(fmt::format("ewald_sums: alpha = {} must be positive, or 0 to have it chosen", alpha));
  if (!std::isfinite(constant)) throw Error(fmt::format("ewald_sums: constant = {} must be finite", constant));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    bool finite = std::isfinite(strengths[i]);
    for (int a = 0; a < D; ++a) finite = finite && std::isfinite(positions[i][a]);
    if (!finite) throw Error(fmt::format("ewald_sums: position or strength of particle {} is not finite", i));
  }
}

/// Calls f(shift) for every image of `separation` that is nearer than `cutoff`.
template <int D, class Function>
void for_images(Vector<D> const& separation, Vector<D> const& edges, double cutoff, Function const& f) {
  std::array<int, 3> first{}, last{};
  for (int a = 0; a < D; ++a) {
    first[a] = static_cast<int>(std::ceil((-cutoff - separation[a]) / edges[a]));
    last[a] = static_cast<int>(std::floor((cutoff - separation[a]) / edges[a]));
  }
  std::array<int, 3> n{};
  for (n[2] = first[2]; n[2] <= last[2]; ++n[2])
    for (n[1] = first[1]; n[1] <= last[1]; ++n[1])
      for (n[0] = first[0]; n[0] <= last[0]; ++n[0]) {
        Vector<D> r = separation;
        for (int a = 0; a < D; ++a) r[a] += n[a] * edges[a];
        if (norm2(r) < cutoff * cutoff) f(r);
      }
}

template <int D>
struct Totals {
  std::vector<Vector<D>> field;
  std::vector<double> potential;
};

template <int D>
void add_near(Totals<D>& total, std::span<Vector<D> const> x, std::span<double const> s, Vector<D> const& edges,
              double alpha) {
  double const cutoff = reach / alpha;
  std::size_t const n = x.size();
  double images_of_itself = own<D>(alpha);
  for_images(Vector<D>{}, edges, cutoff, [&](Vector<D> const& r) {
    if (norm2(r) > 0) images_of_itself += near<D>(norm2(r), alpha).potential;
  });
  for (std::size_t i = 0; i < n; ++i) total.potential[i] += s[i] * images_of_itself;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      Vector<D> separation = x[j] - x[i];
      for (int a = 0; a < D; ++a) separation[a] -= edges[a] * std::round(separation[a] / edges[a]);
      if (D > 1 && norm2(separation) == 0)
        throw Error(fmt::format("ewald_sums: particles {} and {} are at one place", i, j));
      for_images(separation, edges, cutoff, [&](Vector<D> const& r) {
        auto const pair = near<D>(norm2(r), alpha);
        total.potential[i] += s[j] * pair.potential;
        total.potential[j] += s[i] * pair.potential;
        total.field[i] -= r * (s[j] * pair.field_over_r);
        total.field[j] += r * (s[i] * pair.field_over_r);
      });
    }
}

template <int D>
void add_far(Totals<D>& total, std::span<Vector<D> const> x, std::span<double const> s, Vector<D> const& edges,
             double alpha) {
  using Complex = std::complex<double>;
  double const k_max = 2 * alpha * reach, volume = volume_of(edges);
  std::size_t const n = x.size();
  // exp(2 pi i m x/L) for m = -most..most on every axis.
  std::array<int, 3> most{};
  std::array<std::vector<Complex>, 3> wave;
  for (int a = 0; a < D; ++a) {
    most[a] = static_cast<int>(std::floor(k_max * edges[a] / (2 * pi)));
    wave[a].resize(n * (2 * most[a] + 1));
    for (std::size_t i = 0; i < n; ++i) {
      double const turn = x[i][a] / edges[a], part = 2 * pi * (turn - std::round(turn));
      for (int m = -most[a]; m <= most[a]; ++m)
        wave[a][static_cast<std::size_t>(m + most[a]) * n + i] = std::polar(1.0, m * part);
    }
  }
  std::vector<Complex> term(n);
  std::array<int, 3> m{};
  // Only one of k and -k: the last component that is not zero is positive.
  for (m[2] = 0; m[2] <= most[2]; ++m[2])
    for (m[1] = m[2] > 0 ? -most[1] : 0; m[1] <= most[1]; ++m[1])
      for (m[0] = m[2] > 0 || m[1] > 0 ? -most[0] : 1; m[0] <= most[0]; ++m[0]) {
        Vector<D> k;
        for (int a = 0; a < D; ++a) k[a] = 2 * pi * m[a] / edges[a];
        double const k2 = norm2(k);
        if (k2 > k_max * k_max) continue;
        Complex sum = 0;
        for (std::size_t i = 0; i < n; ++i) {
          Complex w = wave[0][static_cast<std::size_t>(m[0] + most[0]) * n + i];
          for (int a = 1; a < D; ++a) w *= wave[a][static_cast<std::size_t>(m[a] + most[a]) * n + i];
          term[i] = w;
          sum += s[i] * std::conj(w);
        }
        double const factor = 2 / volume * std::exp(-k2 / (4 * alpha * alpha)) / k2;
        for (std::size_t i = 0; i < n; ++i) {
          Complex const value = factor * sum * term[i];
          total.potential[i] += value.real();
          total.field[i] += k * value.imag();  // -grad of the real part
        }
      }
}

}  // namespace

template <int D>
EwaldSums<D> ewald_sums(std::span<Vector<D> const> positions, std::span<double const> strengths, Vector<D> const& edges,
                        double constant, double alpha) {
  check(positions, strengths, edges, constant, alpha);
  std::size_t const n = positions.size();
  double const volume = volume_of(edges);
  if (alpha == 0) {
    // Choose alpha for equal cost: pairs within reach/alpha, and products of a particle with half of the wave vectors
    // below 2 alpha reach. One of the former takes as long as four of the latter.
    double const count = std::max(4.0 * static_cast<double>(n), 1.0);
    alpha = root_pi * std::pow(count / (volume * volume), 0.5 / D);
  }

  Totals<D> total{std::vector<Vector<D>>(n, Vector<D>{}), std::vector<double>(n, 0.0)};
  add_near(total, positions, strengths, edges, alpha);
  add_far(total, positions, strengths, edges, alpha);

  ExactSum all;
  for (double const s : strengths) all += s;
  double const background = -all.value() / (4 * alpha * alpha * volume);

  EwaldSums<D> result{0, std::move(total.field), std::move(total.potential)};
  ExactSum energy;
  for (std::size_t i = 0; i < n; ++i) {
    result.potential[i] = constant * (result.potential[i] + background);
    result.force[i] *= constant * strengths[i];
    energy += 0.5 * strengths[i] * result.potential[i];
  }
  result.energy = energy.value();
  return result;
}

template EwaldSums<1> ewald_sums<1>(std::span<Vector<1> const>, std::span<double const>, Vector<1> const&, double,
                                    double);
template EwaldSums<2> ewald_sums<2>(std::span<Vector<2> const>, std::span<double const>, Vector<2> const&, double,
                                    double);
template EwaldSums<3> ewald_sums<3>(std::span<Vector<3> const>, std::span<double const>, Vector<3> const&, double,
                                    double);

}  // namespace boltzmann
