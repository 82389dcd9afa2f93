// Sums over lattices (Nijboer and de Wette, Physica 23, 309 (1957)), with all harmonics but far images only.
//
// With Q(s, x) the regularised incomplete gamma function, P = 1 - Q, x = alpha^2 R^2 and s = n + D/2 - 1,
//   sum over far R of T_n(R) = sum far T_n Q(s, x) - sum near, R != 0 of T_n P(s, x) + (1/V) sum k != 0 of t_n(k)
// where t_n is the Fourier transform of T_n P, which is smooth:
//   3D  4 pi (-1)^(n/2) / (2n - 1)!! Y_n(k) / k^2 exp(-k^2 / 4 alpha^2),
//   2D  4 pi (-1)^(n/2) / (n - 1)!  (k/2)^n / k^2 exp(-k^2 / 4 alpha^2),   k = k_x - i k_y.
// The term k = 0 is omitted, which means conducting boundary conditions at infinity. A uniform background neutralises
// the box.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/pack.hpp>
#include <boltzmann/schemes/mesh/ewald.hpp>
#include <boltzmann/schemes/multipole/image_lattice.hpp>
#include <boltzmann/schemes/multipole/solid_harmonics.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace boltzmann {
namespace {

using Place = std::array<double, 3>;

constexpr double euler_gamma = std::numbers::egamma;
constexpr double reach = 7;  // exp(-reach^2) = 5e-22

/// Calls use(place, multiplicity) for the integer multiples of steps (none along an axis with step 0) within a
/// distance. Mirror images of each other are visited once.
template <class Use>
void each_within(Place const& steps, double distance, Use const& use) {
  std::array<double, 3> most{};
  for (int a = 0; a < 3; ++a) most[a] = steps[a] > 0 ? std::floor(distance / steps[a]) : 0;
  for (double i = 0; i <= most[0]; ++i)
    for (double j = 0; j <= most[1]; ++j)
      for (double k = 0; k <= most[2]; ++k) {
        Place const place{i * steps[0], j * steps[1], k * steps[2]};
        if (distance_of(place) <= distance) use(place, (i > 0 ? 2. : 1.) * (j > 0 ? 2. : 1.) * (k > 0 ? 2. : 1.));
      }
}

/// P(s, x) and Q(s, x) for s = first, first + 1, ..., each to rounding.
class IncompleteGamma {
 public:
  IncompleteGamma(double first, double x, int count) : p_(static_cast<std::size_t>(count)), q_(p_) {
    int const beyond = count + 40 + static_cast<int>(4 * x);
    double p = 0;
    for (int k = beyond; k-- > 0;) {
      double const s = first + k, term = std::exp(s * std::log(x) - x - std::lgamma(s + 1));
      p += term;
      if (k < count) p_[static_cast<std::size_t>(k)] = p;
    }
    double q = first == 0.5 ? std::erfc(std::sqrt(x)) : 0;
    for (int k = 0; k < count; ++k) {
      q_[static_cast<std::size_t>(k)] = q;
      double const s = first + k;
      q += std::exp(s * std::log(x) - x - std::lgamma(s + 1));
    }
  }
  double p(int k) const { return p_[static_cast<std::size_t>(k)]; }
  double q(int k) const { return q_[static_cast<std::size_t>(k)]; }

 private:
  std::vector<double> p_, q_;
};

/// Sum over i > first of i^-s, s > 1, by the Euler-Maclaurin formula.
double tail_of_zeta(double s, double first) {
  double const last = first + 30;
  double sum = 0;
  for (double i = last - 1; i > first; --i) sum += std::pow(i, -s);
  double const f = std::pow(last, -s);
  return sum + f * (last / (s - 1) + 0.5 + s / (12 * last) - s * (s + 1) * (s + 2) / (720 * last * last * last) +
                    s * (s + 1) * (s + 2) * (s + 3) * (s + 4) / (30240 * std::pow(last, 5)));
}

/// The real parts of normalised Y_n^m(r) (2D: of (x - i y)^n) for even n and m up to an order.
class Harmonics {
 public:
  Harmonics(int dimension, int order) : dimension_(dimension), order_(order) {}

  template <class Use>  // use(n, m, value)
  void each(Place const& r, Use const& use) const {
    if (dimension_ == 2) {
      std::complex<double> const step = std::pow(std::complex(r[0], -r[1]), 2);
      std::complex<double> power = 1;
      for (int n = 0; n <= order_; n += 2, power *= step) use(n, 0, power.real());
      return;
    }
    // sqrt((n - m)! / (n + m)!) r^n P_n^m(cos theta) cos(m phi)
    double const z = r[2], square = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
    std::complex<double> const across(r[0], r[1]);
    std::complex<double> top = 1;
    for (int m = 0; m <= order_; ++m) {
      if (m > 0) top *= -across * std::sqrt((2 * m - 1) / (2. * m));
      if (m % 2 != 0) continue;
      double now = top.real(), before = 0;
      for (int n = m; n <= order_; ++n) {
        if (n % 2 == 0) use(n, m, now);
        double const next = ((2 * n + 1) * z * now - norm(n, m) * square * before) / norm(n + 1, m);
        before = now;
        now = next;
      }
    }
  }

 private:
  static double norm(int n, int m) { return std::sqrt(double(n * n - m * m)); }
  int dimension_, order_;
};

/// The sums over far images. The unit is the distance of the nearest of them, so that all are of order 1.
class LatticeSums {
 public:
  LatticeSums(int dimension, ImageLattice const& lattice, double distance, double unit, int order)
      : dimension_(dimension),
        order_(order),
        unit_(unit),
        near_(0.5 * (distance / unit + 1)),
        harmonics_(dimension, 2 * order),
        sums_(static_cast<std::size_t>(order + 1) * (order + 1), 0.0) {
    for (int a = 0; a < dimension; ++a) {
      steps_[a] = lattice.edges[a] / unit;
      if (steps_[a] > 0)
        volume_ *= steps_[a];
      else
        open_[a] = 1;
    }
    int const axes = lattice.periodic_axes();
    if (axes == 1) {
      add_row();
    } else {
      add_images();
      axes == dimension ? add_box() : add_layers();
    }
  }
  std::vector<double> const& sums() const { return sums_; }

 private:
  static constexpr double alpha = 2;

  void add(int n, int m, double value) { sums_[static_cast<std::size_t>(n / 2 * (order_ + 1) + m / 2)] += value; }
  /// The power of 1/r in T_n.
  int power(int n) const { return dimension_ == 3 ? n + 1 : n; }
  static double sign(int n) { return n / 2 % 2 != 0 ? -1 : 1; }
  /// 1 / (2n - 1)!! = 2^n n! / (2n)!, or 1 / (2^n (n - 1)!), 1/2 for n = 0.
  double logarithm_of_factor(int n) const {
    if (dimension_ == 3) return n * std::log(2.) + std::lgamma(n + 1.) - std::lgamma(2. * n + 1);
    return n > 0 ? -n * std::log(2.) - std::lgamma(double(n)) : -std::log(2.);
  }

  /// One periodic axis: zeta functions. Far from a row the potential is -(2/L) ln r, in 2D -(pi/L) |y|.
  void add_row() {
    Place direction{};
    for (int a = 0; a < dimension_; ++a) direction[a] = 1 - open_[a];
    double const edge = volume_, first = std::floor(near_ / edge);
    harmonics_.each(direction, [&](int n, int m, double value) {
      if (n > 0) add(n, m, value * 2 * std::pow(edge, -power(n)) * tail_of_zeta(power(n), first));
    });
    double harmonic = 0, logarithms = -std::log(2 * pi / (edge * unit_));
    for (double i = 1; i <= first; ++i) harmonic += 1 / i, logarithms += 2 * std::log(i * edge * unit_);
    add(0, 0, dimension_ == 3 ? 2 / edge * (euler_gamma - harmonic - std::log(2 * edge * unit_)) : logarithms);
  }

  void add_images() {
    each_within(steps_, reach / alpha, [&](Place const& place, double count) {
      double const r = distance_of(place), inverse = 1 / r;
      if (r == 0) return;
      bool const near = r < near_;
      IncompleteGamma const gamma(0.5 * dimension_ - 1, alpha * alpha * r * r, 2 * order_ + 1);
      Place const direction{place[0] * inverse, place[1] * inverse, place[2] * inverse};
      harmonics_.each(direction, [&](int n, int m, double value) {
        if (power(n) > 0) add(n, m, count * (near ? -gamma.p(n) : gamma.q(n)) * value * std::pow(inverse, power(n)));
      });
      if (dimension_ == 2)  // of -ln r
        add(0, 0, count * (0.5 * exponential_integral(alpha * alpha * r * r) + (near ? std::log(r * unit_) : 0)));
    });
  }

  /// The terms that vary along periodic axes, in a box of this volume that has a length along open axes, too.
  void add_waves(double volume) {
    double const furthest = 2 * alpha * (reach + std::sqrt(static_cast<double>(order_)));
    Place waves{};
    for (int a = 0; a < dimension_; ++a) waves[a] = 2 * pi / (steps_[a] > 0 ? steps_[a] : length_of_open_axis());
    each_within(waves, furthest, [&](Place const& k, double count) {
      double varies = 0;
      for (int a = 0; a < dimension_; ++a) varies += (1 - open_[a]) * k[a];
      if (varies == 0) return;
      double const wave = distance_of(k), inverse = 1 / wave;
      Place const direction{k[0] * inverse, k[1] * inverse, k[2] * inverse};
      double const f = count * 4 * pi / volume * inverse * inverse;
      harmonics_.each(direction, [&](int n, int m, double value) {
        double const exponent = logarithm_of_factor(n) + n * std::log(wave) - wave * wave / (4 * alpha * alpha);
        add(n, m, sign(n) * f * std::exp(exponent) * value);
      });
    });
  }

  /// All axes: waves, the mean, and the self term of the box's own cloud.
  void add_box() {
    add_waves(volume_);
    if (dimension_ == 3)
      add(0, 0, -pi / (alpha * alpha * volume_) - 2 * alpha / root_pi);
    else
      add(0, 0, -pi / (2 * alpha * alpha * volume_) - 0.5 * (euler_gamma + 2 * std::log(alpha / unit_)));
  }

  /// Two periodic axes of three. Along the open one k is sampled finely enough that the sum equals the integral. The
  /// terms that vary only along it are integrated analytically.
  void add_layers() {
    double const area = volume_;
    add_waves(area * length_of_open_axis());
    harmonics_.each(open_, [&](int n, int m, double value) {
      if (n == 0) return add(0, 0, -2 * root_pi / (alpha * area) - 2 * alpha / root_pi);
      double const exponent = logarithm_of_factor(n) + (n - 1) * std::log(2 * alpha) + std::lgamma(0.5 * (n - 1));
      add(n, m, sign(n) * 2 / area * std::exp(exponent) * value);
    });
  }
  double length_of_open_axis() const { return std::max(6.5 * *std::max_element(steps_.begin(), steps_.end()), 3.5); }

  int dimension_, order_;
  double unit_, near_;
  Harmonics harmonics_;
  Place steps_{}, open_{};  // open_: 1 along open axes
  double volume_ = 1;       // of the periodic axes
  std::vector<double> sums_;
};

}  // namespace

std::vector<Place> ImageLattice::within(double distance) const {
  double expected = 1;
  for (double const edge : edges) expected *= edge > 0 ? 1 + 2 * distance / edge : 1;
  if (!(expected <= static_cast<double>(most_images)))
    throw PhysicsFailure(fmt::format(
        "multipoles: {:.2g} images of the periodic box would act one by one, so far do particles spread (or so long is "
        "the box) against its shortest edge; a mesh does that",
        expected));
  std::vector<Place> all;
  each_within(edges, distance, [&](Place const& place, double) {
    for (int mirrors = 0; mirrors < 8; ++mirrors) {
      Place image = place;
      bool own = true;  // the origin has no mirror image
      for (int a = 0; a < 3; ++a)
        if ((mirrors >> a & 1) != 0) own = own && place[a] > 0, image[a] = -place[a];
      if (own) all.push_back(image);
    }
  });
  std::stable_sort(all.begin(), all.end(),
                   [](Place const& a, Place const& b) { return distance_of(a) < distance_of(b); });
  return all;
}

double ImageLattice::next_after(double distance) const {
  double shortest = 0, next = 0;
  for (double const edge : edges)
    if (edge > 0 && (shortest == 0 || edge < shortest)) shortest = edge;
  each_within(edges, distance + 1.001 * shortest, [&](Place const& place, double) {
    double const r = distance_of(place);
    if (r > distance && (next == 0 || r < next)) next = r;
  });
  return next;
}

FarImages::FarImages(int dimension, ImageLattice const& lattice, double distance, int order)
    : dimension_(dimension),
      order_(order),
      distance_(distance),
      unit_(lattice.next_after(distance)),
      sums_(LatticeSums(dimension, lattice, distance, unit_, order).sums()) {
  auto const width = static_cast<std::size_t>(4 * order) + 1;
  binomials_.assign(width * width, 0.0);
  for (std::size_t n = 0; n < width; ++n)
    for (std::size_t k = 0; k <= n; ++k)
      binomials_[n * width + k] =
          k == 0 || k == n ? 1 : binomials_[(n - 1) * width + k - 1] + binomials_[(n - 1) * width + k];
}

void FarImages::add(ExpansionView const& tables, double const* moments, double radius, double* local) const {
  dimension_ == 3 ? add_solid(tables, moments, radius, local) : add_plane(tables, moments, radius, local);
}

/// F_n^m = (-1)^n sum conj(M_k^l) T_(n+k)^(m+l), all normalised.
void FarImages::add_solid(ExpansionView const& tables, double const* moments, double radius, double* local) const {
  int const p = tables.order;
  std::size_t const width = static_cast<std::size_t>(4 * order_) + 1;
  auto const choose = [&](int n, int k) { return binomials_[static_cast<std::size_t>(n) * width + k]; };
  std::vector<double> powers(static_cast<std::size_t>(2 * p) + 1);
  powers[0] = 1 / unit_;
  for (std::size_t j = 1; j < powers.size(); ++j) powers[j] = powers[j - 1] * radius / unit_;
  for (int n = 0; n <= p; ++n)
    for (int m = 0; m <= n; ++m) {
      double re = 0, im = 0;
      for (int k = n % 2; k <= p; k += 2) {
        int const j = n + k;
        for (int l = -k; l <= k; ++l) {
          int const order = m + l, size = l < 0 ? -l : l;
          if (order % 2 != 0) continue;
          double const f = powers[static_cast<std::size_t>(j)] * sum(j, order < 0 ? -order : order) *
                           std::sqrt(choose(j - order, n - m) * choose(j + order, n + m));
          double const sign = l < 0 && size % 2 != 0 ? -1 : 1;
          re += sign * f * moments[multipole::real_at(k, size)];
          if (size > 0) im -= (l < 0 ? -sign : sign) * f * moments[multipole::imaginary_at(k, size)];
        }
      }
      double const sign = n % 2 != 0 ? -1 : 1;
      local[multipole::real_at(n, m)] += sign * re;
      if (m > 0) local[multipole::imaginary_at(n, m)] += sign * im;
    }
}

/// Expands ln(R + x - y): -(1/j) sum of R^-j times (x - y)^j for even j; sum q y^k = -k a_k.
void FarImages::add_plane(ExpansionView const& tables, double const* moments, double radius, double* local) const {
  int const p = tables.order;
  std::size_t const width = static_cast<std::size_t>(4 * order_) + 1;
  local[0] -= moments[0] * sum(0, 0);
  for (int l = 0; l <= p; ++l) {
    double re = 0, im = 0;
    for (int k = l % 2; k <= p; k += 2) {
      int const j = l + k;
      if (j == 0) continue;
      double const f = -sum(j, 0) / j * std::pow(radius / unit_, j) *
                       binomials_[static_cast<std::size_t>(j) * width + l] * (k > 0 ? (k % 2 != 0 ? k : -k) : 1);
      re += f * moments[2 * k];
      im += f * moments[2 * k + 1];
    }
    local[2 * l] += re;
    local[2 * l + 1] += im;
  }
}

}  // namespace boltzmann
