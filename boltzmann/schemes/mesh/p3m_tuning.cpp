// Errors of P3M by Hockney and Eastwood's formulas, and the search for the cheapest parameters with a given error.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/in_dimension.hpp>
#include <boltzmann/core/pack.hpp>
#include <boltzmann/core/vector.hpp>
#include <boltzmann/schemes/mesh/ewald.hpp>
#include <boltzmann/schemes/mesh/p3m_tuning.hpp>
#include <boltzmann/schemes/mesh/spline.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace boltzmann {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
using MeshCells = std::array<std::size_t, 3>;
using Edges = std::array<double, 3>;

double whole_power(double x, int n) {
  double product = 1;
  for (int i = 0; i < n; ++i) product *= x;
  return product;
}

double volume_of(P3mSystem const& system) {
  double volume = 1;
  for (int a = 0; a < system.dimension; ++a) volume *= system.edges[a];
  return volume;
}

void check(int dimension, Edges const& edges, char const* where) {
  if (dimension < 1 || dimension > 3) throw Error(fmt::format("{}: dimension {} is not 1, 2 or 3", where, dimension));
  for (int a = 0; a < dimension; ++a)
    if (!(edges[a] > 0) || !std::isfinite(edges[a]))
      throw Error(fmt::format("{}: edge {} = {} must be positive", where, a, edges[a]));
}
void check(P3mSystem const& system, char const* where) {
  check(system.dimension, system.edges, where);
  if (!std::isfinite(system.constant))
    throw Error(fmt::format("{}: constant = {} must be finite", where, system.constant));
  if (!(system.sum_of_squares >= 0) || !std::isfinite(system.sum_of_squares))
    throw Error(fmt::format("{}: sum of squares = {} must not be negative", where, system.sum_of_squares));
}
void check_mesh(int dimension, int order, MeshCells const& cells, double alpha, char const* where) {
  if (order < 1 || order > highest_order)
    throw Error(fmt::format("{}: order {} is not 1 to {}", where, order, highest_order));
  for (int a = 0; a < dimension; ++a)
    if (cells[a] == 0) throw Error(fmt::format("{}: axis {} has no cells", where, a));
  if (!(alpha > 0) || !std::isfinite(alpha)) throw Error(fmt::format("{}: alpha = {} must be positive", where, alpha));
}

// ---- the waves of one axis and their aliases ----

/// The number of aliases on either side after which the Gaussian of the next one is 1e-16 of that of the wave itself.
int aliases_of(double alpha, double h) {
  double const ratio = 2 * alpha * h / pi;
  return std::clamp(static_cast<int>(std::ceil((std::sqrt(1 + 37 * ratio * ratio) - 1) / 2)), 1, 6);
}

/// A wave j of an axis with n cells: 2 pi j/L and its aliases m = 0, -1, 1, -2, 2 ...
struct AxisWave {
  double derivative;            ///< k, zero at the mesh's limit
  double sum;                   ///< of U^2 over all m
  double rest;                  ///< that sum without m = 0, over the sum: without cancellation
  std::vector<double> k;        ///< k_m
  std::vector<double> splines;  ///< U^2
  std::vector<double> gauss;    ///< exp(-k_m^2 / 4 alpha^2)
};

AxisWave axis_wave(std::size_t j, std::size_t n, double edge, int order, double alpha) {
  double const count = static_cast<double>(n), h = edge / count;
  double const number = 2 * j < n ? static_cast<double>(j) : static_cast<double>(j) - count;
  double const x = number / count;  // -1/2 <= x < 1/2
  int const most = aliases_of(alpha, h);
  double const wave_number = 2 * pi / edge;
  AxisWave wave{2 * j == n ? 0.0 : wave_number * number, 0, 0, {}, {}, {}};
  double const sine = std::sin(pi * x);
  auto const spline = [&](int m) {
    if (number == 0) return m == 0 ? 1.0 : 0.0;
    return whole_power(square(sine / (pi * (x + m))), order);
  };
  for (int i = 0; i <= 2 * most; ++i) {
    int const m = (i % 2 == 0 ? 1 : -1) * ((i + 1) / 2);
    double const k = wave_number * (number + m * count);
    wave.k.push_back(k);
    wave.splines.push_back(spline(m));
    wave.gauss.push_back(std::exp(-k * k / (4 * alpha * alpha)));
  }
  // The sum to |m| = 20 and the integral from there.
  double others = 0;
  constexpr int last = 20;
  for (int m = 1; m <= last; ++m) others += spline(m) + spline(-m);
  if (number != 0) {
    double const power = 2 * order - 1, scale = whole_power(square(sine / pi), order) / power;
    others += scale * (std::pow(last + 0.5 + x, -power) + std::pow(last + 0.5 - x, -power));
  }
  wave.sum = spline(0) + others;
  wave.rest = others / wave.sum;
  return wave;
}

// ---- Hockney and Eastwood's Q ----

/// The sum over the mesh's wave vectors of sum_m |R_m|^2 - |D . sum_m w_m R_m|^2 / |D|^2, where R_m = k_m exp(-k_m^2 /
/// 4 alpha^2)/k_m^2, w_m = U^2/sum U^2 and D = k (without components that have no derivative). With D = k the
/// difference is computed term by term, because on a good mesh it is much smaller than the terms. Vectors are omitted
/// if the Gaussian's square is below 1e-26. Meshes of more than `most` cells on an axis are sampled by one with fewer
/// cells of the same size, but at least 8 vectors per alpha. In 3D, an eighth of the vectors represents all by
/// symmetry.
double sum_of_errors(int dimension, Edges const& edges, int order, MeshCells const& cells, double alpha,
                     std::size_t most) {
  std::array<std::vector<AxisWave>, 3> waves;
  std::array<std::size_t, 3> n{1, 1, 1};
  double sampled = 1;
  for (int a = 0; a < dimension; ++a) {
    double const h = edges[a] / static_cast<double>(cells[a]);
    auto const enough = 2 * static_cast<std::size_t>(std::ceil(std::min(4 / (alpha * h), 1e9)));
    n[a] = std::min(cells[a], std::max(most, enough));
    double const part = static_cast<double>(n[a]) / static_cast<double>(cells[a]);
    sampled *= part;
    auto const last = static_cast<std::size_t>(std::min(11 * alpha * edges[a] * part / (2 * pi), 1e9)) + 1;
    for (std::size_t j = 0; j <= std::min(n[a] / 2, last); ++j)
      waves[a].push_back(axis_wave(j, n[a], edges[a] * part, order, alpha));
  }
  for (int a = dimension; a < 3; ++a) waves[a].push_back({0, 1, 0, {0}, {1}, {1}});

  auto const of_vector = [&](AxisWave const& x, AxisWave const& y, AxisWave const& z) {
    std::array<double, 3> d{x.derivative, y.derivative, z.derivative};
    bool const full = d[0] == x.k[0] && d[1] == y.k[0] && d[2] == z.k[0];
    double const d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    double const norm = d2 > 0 ? 1 / std::sqrt(d2) : 0;
    for (double& component : d) component *= norm;
    double const inverse_sum = 1 / (x.sum * y.sum * z.sum);
    double squares = 0, along = 0;  // of all aliases but m = 0
    double first_square = 0, first_along = 0;
    for (std::size_t c = 0; c < z.k.size(); ++c)
      for (std::size_t b = 0; b < y.k.size(); ++b) {
        double const gauss_yz = y.gauss[b] * z.gauss[c], splines_yz = y.splines[b] * z.splines[c] * inverse_sum;
        double const square_yz = y.k[b] * y.k[b] + z.k[c] * z.k[c], dot_yz = d[1] * y.k[b] + d[2] * z.k[c];
        for (std::size_t a = 0; a < x.k.size(); ++a) {
          double const k2 = x.k[a] * x.k[a] + square_yz;
          double const r = x.gauss[a] * gauss_yz / k2;  // |R|/|k|
          double const of_square = r * r * k2, of_along = x.splines[a] * splines_yz * r * (d[0] * x.k[a] + dot_yz);
          if (a + b + c == 0) {
            first_square = of_square;
            first_along = of_along;
          } else {
            squares += of_square;
            along += of_along;
          }
        }
      }
    if (!full) return std::max(0.0, first_square + squares - square(first_along + along));
    // first_along^2 = first_square (1 - rest)^2.
    double const yz = y.rest + z.rest - y.rest * z.rest, rest = x.rest + yz - x.rest * yz;
    return std::max(0.0, first_square * rest * (2 - rest) + squares - along * (2 * first_along + along));
  };

  auto const twice = [&](int a, std::size_t j) { return j == 0 || 2 * j == n[a] ? 1.0 : 2.0; };
  double total = 0;
  for (std::size_t l = 0; l < waves[2].size(); ++l)
    for (std::size_t j = 0; j < waves[1].size(); ++j)
      for (std::size_t i = 0; i < waves[0].size(); ++i)
        if (i + j + l > 0)
          total += twice(0, i) * twice(1, j) * twice(2, l) * of_vector(waves[0][i], waves[1][j], waves[2][l]);
  return total / sampled;
}

constexpr std::size_t finest_sample = 32;

/// |C| sum s^2 / sqrt(N V): the factor of the roots of integrals and of Q.
double error_scale(P3mSystem const& system) {
  if (system.particles == 0) return 0;
  return std::fabs(system.constant) * system.sum_of_squares /
         std::sqrt(static_cast<double>(system.particles) * volume_of(system));
}

/// Integral of f(r)^2 over r > cutoff for C = 1: with r^2 = cutoff^2 + t/(2 alpha^2) the integrand is exp(-t) times a
/// smooth function.
double tail_of_near_force(int dimension, double alpha, double cutoff) {
  auto const smooth = [&](double t) {  // f^2 times surface times dr/dt, without exp(-2 alpha^2 r^2)
    double const r = std::sqrt(cutoff * cutoff + t / (2 * alpha * alpha)), x = alpha * r;
    double const scaled = x < 25 ? std::exp(x * x) * std::erfc(x) : (1 - 0.5 / (x * x)) / (x * root_pi);
    double force = 0, surface = 0;
    if (dimension == 1) {
      force = 0.5 * scaled;
      surface = 2;
    } else if (dimension == 2) {
      force = 1 / (2 * pi * r);
      surface = 2 * pi * r;
    } else {
      force = (scaled / r + 2 * alpha / root_pi) / (4 * pi * r);
      surface = 4 * pi * r * r;
    }
    return force * force * surface / (4 * alpha * alpha * r);
  };
  // Simpson's rule in s, t = s^3: the steps are small where r changes fast.
  constexpr int steps = 120;
  constexpr double last = 3.4;  // exp(-39)
  double sum = 0;
  for (int i = 1; i <= steps; ++i) {
    double const s = last * i / steps, t = s * s * s;
    sum += (i == steps ? 1 : i % 2 == 1 ? 4 : 2) * 3 * s * s * std::exp(-t) * smooth(t);
  }
  return std::exp(-2 * square(alpha * cutoff)) * sum * (last / steps) / 3;
}

/// Integral of the near potential over r > cutoff for C = 1.
double tail_of_near_potential(int dimension, double alpha, double cutoff) {
  double const a = alpha * cutoff, c = std::erfc(a), e = std::exp(-a * a);
  double const moment = 0.5 * ((0.5 - a * a) * c + a * e / root_pi);  // of x erfc(x) beyond a
  double const inner = dimension == 1   ? 0.5 * c - moment
                       : dimension == 2 ? 0.25 * (e - a * a * exponential_integral(a * a))
                                        : moment;
  return inner / (alpha * alpha);
}

double error_near(P3mSystem const& system, double alpha, double cutoff) {
  return error_scale(system) * std::sqrt(tail_of_near_force(system.dimension, alpha, cutoff));
}
double error_mesh(P3mSystem const& system, int order, MeshCells const& cells, double alpha, std::size_t most) {
  return error_scale(system) *
         std::sqrt(sum_of_errors(system.dimension, system.edges, order, cells, alpha, most) / volume_of(system));
}

// ---- the search ----

/// Solves f(x) = 0 in [low, high] for an increasing f by bisection of the logarithm. Returns low or high if there is no
/// root.
template <class Function>
double root_of(double low, double high, Function const& f) {
  if (f(low) >= 0) return low;
  if (f(high) <= 0) return high;
  for (int i = 0; i < 60 && high > low * (1 + 1e-14); ++i) {
    double const middle = std::sqrt(low * high);
    (f(middle) < 0 ? low : high) = middle;
  }
  return std::sqrt(low * high);
}
/// The minimum of a unimodal f in [low, high], to a thousandth, by golden sections of the logarithm.
template <class Function>
double minimum_of(double low, double high, Function const& f) {
  double const golden = 0.6180339887498949;
  double a = std::log(low), b = std::log(high), x = b - golden * (b - a), y = a + golden * (b - a);
  double fx = f(std::exp(x)), fy = f(std::exp(y));
  while (b - a > 1e-3) {
    if (fx < fy) {
      b = y, y = x, fy = fx, x = b - golden * (b - a);
      fx = f(std::exp(x));
    } else {
      a = x, x = y, fx = fy, y = a + golden * (b - a);
      fy = f(std::exp(y));
    }
  }
  return std::exp(fx < fy ? x : y);
}

// Limits of alpha times the length of a cell. Below the range every mesh is fine enough; above, the field is not
// resolved.
constexpr double min_alpha_h = 0.02, max_alpha_h = 3;

/// The error of the mesh for cubic cells, computed once per order: sum of errors = cells h^2 q(alpha h).
class MeshErrors {
 public:
  explicit MeshErrors(int dimension) {
    for (int order = 1; order <= highest_order; ++order)
      for (int i = 0; i <= points; ++i) {
        MeshCells const cells{many, many, many};
        double const edge = many, q = sum_of_errors(dimension, {edge, edge, edge}, order, cells, alpha_h(i), sample) /
                                      whole_power(edge, dimension);
        log_q_[order - 1][i] = std::log(std::max(q, 1e-200));
      }
  }
  /// The alpha h for which q has this value.
  double alpha_h_of(int order, double q) const {
    auto const& table = log_q_[order - 1];
    double const wanted = std::log(std::max(q, 1e-300));
    if (wanted <= table[0]) return 0;
    int i = 0;
    while (i < points && table[i + 1] < wanted) ++i;
    if (i == points) return max_alpha_h;
    double const part = (wanted - table[i]) / (table[i + 1] - table[i]);
    return alpha_h(i) * std::pow(alpha_h(i + 1) / alpha_h(i), part);
  }

 private:
  static constexpr int points = 32;
  static constexpr std::size_t many = 4096, sample = 10;
  static double alpha_h(int i) { return min_alpha_h * std::pow(max_alpha_h / min_alpha_h, double(i) / points); }
  std::array<std::array<double, points + 1>, highest_order> log_q_{};
};

bool good_size(std::size_t n) {
  for (std::size_t const factor : {2, 3, 5, 7})
    while (n % factor == 0) n /= factor;
  return n == 1;
}
std::size_t next_good_size(std::size_t n) {
  while (!good_size(n)) ++n;
  return n;
}

double cells_in_all(int dimension, MeshCells const& cells) {
  double product = 1;
  for (int a = 0; a < dimension; ++a) product *= static_cast<double>(cells[a]);
  return product;
}

/// Density, field, and the workspace of transforms.
double bytes_of_mesh(int dimension, MeshCells const& cells) {
  return 8.0 * (dimension + 3) * cells_in_all(dimension, cells);
}

MeshCells cells_for(P3mSystem const& system, std::size_t longest, int order) {
  MeshCells cells{1, 1, 1};
  double const longest_edge = *std::max_element(system.edges.begin(), system.edges.begin() + system.dimension);
  for (int a = 0; a < system.dimension; ++a) {
    double const wanted = static_cast<double>(longest) * system.edges[a] / longest_edge;
    auto const whole = static_cast<std::size_t>(std::ceil(wanted - 1e-9));
    cells[a] = next_good_size(std::max({whole, static_cast<std::size_t>(order), std::size_t{2}}));
  }
  return cells;
}

/// Estimated seconds of one calculation of all forces, per thread on a core of 2020: pairs from a list with a skin, p^D
/// weights for assignment and interpolation, one forward transform and D backward ones, which scale less with threads.
double seconds_of(P3mSystem const& system, int order, MeshCells const& cells, double cutoff, int threads) {
  int const D = system.dimension;
  double const n = static_cast<double>(system.particles), mesh = cells_in_all(D, cells);
  double const ball = D == 1 ? 2 * cutoff : D == 2 ? pi * square(cutoff) : 4 * pi / 3 * cube(cutoff);
  double const pairs = n * n * ball / volume_of(system);
  double const weights = n * whole_power(order, D);
  double const each = 1.3e-9 * pairs + 1e-9 * weights * (1 + D) + 1e-8 * n * order;
  double const transforms = (1 + D) * 0.6e-9 * mesh * std::log2(mesh + 1);
  return each / threads + transforms / std::pow(threads, 0.8);
}

double shortest_edge(P3mSystem const& system) {
  return *std::min_element(system.edges.begin(), system.edges.begin() + system.dimension);
}
double longest_cell(P3mSystem const& system, MeshCells const& cells) {
  double longest = 0;
  for (int a = 0; a < system.dimension; ++a)
    longest = std::max(longest, system.edges[a] / static_cast<double>(cells[a]));
  return longest;
}

constexpr std::size_t max_cells = std::size_t{1} << 20;  // per axis

struct Candidate {
  int order;
  MeshCells cells;
  double seconds;
};

/// The smallest cut-off with which this order and mesh reach the accuracy, and its alpha; nothing if it is too large.
std::optional<P3mParameters> smallest_cutoff(P3mSystem const& system, int order, MeshCells const& cells,
                                             double accuracy) {
  double const half = shortest_edge(system) / 2, h = longest_cell(system, cells);
  auto const mesh = [&](double alpha) { return error_mesh(system, order, cells, alpha, finest_sample); };
  auto const cutoff_for = [&](double alpha, double of_mesh) {
    double const left = accuracy * accuracy - of_mesh * of_mesh;
    if (!(left > 0)) return infinity;
    return root_of(1e-4 * half, 64 * half,
                   [&](double cutoff) { return std::sqrt(left) - error_near(system, alpha, cutoff); });
  };
  double const most = root_of(min_alpha_h / h, max_alpha_h / h, [&](double a) { return mesh(a) - accuracy; });
  double const alpha = minimum_of(most / 16, most, [&](double a) { return cutoff_for(a, mesh(a)); });
  P3mParameters result{order, cells, alpha, 0, 0, mesh(alpha)};
  result.cutoff = cutoff_for(alpha, result.error_mesh);
  if (!(result.cutoff <= half)) return std::nullopt;
  result.error_near = error_near(system, alpha, result.cutoff);
  return result;
}

/// The smallest error of this order and mesh, at the largest cut-off.
double smallest_error(P3mSystem const& system, int order, MeshCells const& cells) {
  double const half = shortest_edge(system) / 2, h = longest_cell(system, cells);
  auto const total = [&](double alpha) {
    return std::hypot(error_near(system, alpha, half), error_mesh(system, order, cells, alpha, finest_sample));
  };
  return total(minimum_of(min_alpha_h / h, max_alpha_h / h, total));
}

/// The rounding error of the force of a neighbour.
double rounding_error(P3mSystem const& system) {
  double const n = static_cast<double>(std::max<std::size_t>(system.particles, 1));
  return 1e-14 * std::fabs(system.constant) * system.sum_of_squares / n *
         std::pow(n / volume_of(system), (system.dimension - 1.0) / system.dimension);
}

}  // namespace

P3mInfluence::P3mInfluence(int dimension, Edges const& edges, int order, MeshCells const& cells, double alpha)
    : dimension_(dimension), edges_(edges) {
  check(dimension, edges, "p3m influence function");
  check_mesh(dimension, order, cells, alpha, "p3m influence function");
  for (int a = 0; a < 3; ++a) {
    if (a >= dimension) {
      waves_[a].push_back({0, 1, {{0, 1}}});
      continue;
    }
    for (std::size_t j = 0; j < cells[a]; ++j) {
      auto const wave = axis_wave(j, cells[a], edges[a], order, alpha);
      Wave kept{wave.derivative, wave.sum, {}};
      double const first = wave.splines[0] * wave.gauss[0];
      for (std::size_t i = 0; i < wave.k.size(); ++i) {
        double const weight = wave.splines[i] * wave.gauss[i];
        if (i == 0 || weight > 1e-18 * first) kept.aliases.push_back({wave.k[i], weight});
      }
      waves_[a].push_back(std::move(kept));
    }
  }
}

double P3mInfluence::at(std::array<Wave const*, 3> const& wave) const {
  auto const& [x, y, z] = wave;
  double const d2 = square(x->derivative) + square(y->derivative) + square(z->derivative);
  if (d2 == 0) return 0;
  double along = 0;
  for (auto const& c : z->aliases)
    for (auto const& b : y->aliases)
      for (auto const& a : x->aliases)
        along += a.weight * b.weight * c.weight * (x->derivative * a.k + y->derivative * b.k + z->derivative * c.k) /
                 (a.k * a.k + b.k * b.k + c.k * c.k);
  return along / (d2 * square(x->sum * y->sum * z->sum));
}

double P3mInfluence::operator()(std::array<double, 3> const& k) const {
  std::array<Wave const*, 3> wave{&waves_[0][0], &waves_[1][0], &waves_[2][0]};
  for (int a = 0; a < dimension_; ++a) {
    auto const n = static_cast<long>(waves_[a].size());
    long const j = std::lround(k[a] * edges_[a] / (2 * pi)) % n;
    wave[a] = &waves_[a][static_cast<std::size_t>(j < 0 ? j + n : j)];
  }
  return at(wave);
}

double P3mInfluence::mean_self_potential() const {
  double sum = 0, volume = 1;
  for (int a = 0; a < dimension_; ++a) volume *= edges_[a];
  for (auto const& z : waves_[2])
    for (auto const& y : waves_[1])
      for (auto const& x : waves_[0]) sum += at({&x, &y, &z}) * x.sum * y.sum * z.sum;
  return sum / volume;
}

double p3m_error_near(P3mSystem const& system, double alpha, double cutoff) {
  check(system, "p3m_error_near");
  if (!(alpha > 0) || !(cutoff > 0))
    throw Error(fmt::format("p3m_error_near: alpha = {} and cutoff = {} must be positive", alpha, cutoff));
  return error_near(system, alpha, cutoff);
}

double p3m_error_mesh(P3mSystem const& system, int order, MeshCells const& cells, double alpha) {
  check(system, "p3m_error_mesh");
  check_mesh(system.dimension, order, cells, alpha, "p3m_error_mesh");
  return error_mesh(system, order, cells, alpha, finest_sample);
}

P3mEnergyTerms p3m_energy_terms(P3mSystem const& system, P3mParameters const& parameters) {
  check(system, "p3m_energy_terms");
  P3mInfluence const influence(system.dimension, system.edges, parameters.order, parameters.cells, parameters.alpha);
  double const itself = in_dimension(system.dimension, [&]<int D>(std::integral_constant<int, D>) {
    Vector<D> const place{};
    Vector<D> edges;
    double const strength = 1;
    for (int a = 0; a < D; ++a) edges[a] = system.edges[a];
    return ewald_sums<D>({&place, 1}, {&strength, 1}, edges, 1).potential[0];
  });
  double const background = 1 / (4 * square(parameters.alpha) * volume_of(system));
  double const beyond =
      tail_of_near_potential(system.dimension, parameters.alpha, parameters.cutoff) / volume_of(system);
  double const half = 0.5 * system.constant;
  return {half * (itself + background - influence.mean_self_potential() - beyond), half * (beyond - background)};
}

P3mParameters tune_p3m(P3mSystem const& system, double accuracy, int threads, std::size_t memory) {
  check(system, "p3m");
  if (!(accuracy > 0) || !std::isfinite(accuracy))
    throw Error(fmt::format("p3m: accuracy = {} must be a positive rms error of the force", accuracy));
  threads = std::max(threads, 1);
  double const half = shortest_edge(system) / 2;
  double const scale = error_scale(system);
  if (scale == 0) {  // without forces there is no error
    MeshCells const cells = cells_for(system, 4, 2);
    return {2, cells, 1 / longest_cell(system, cells), half, 0, 0};
  }

  MeshErrors const mesh_errors(system.dimension);
  double const volume = volume_of(system);
  auto const fits = [&](MeshCells const& cells) {
    return bytes_of_mesh(system.dimension, cells) <= static_cast<double>(memory);
  };
  std::vector<Candidate> candidates;
  MeshCells finest = cells_for(system, 1, highest_order);
  if (!fits(finest)) throw Error(fmt::format("p3m: {} bytes of memory are not enough for any mesh", memory));
  for (int order = 1; order <= highest_order; ++order) {
    double least = infinity;
    for (std::size_t longest = 2; longest <= max_cells; longest = next_good_size(longest + 1 + longest / 32)) {
      MeshCells const cells = cells_for(system, longest, order);
      if (!fits(cells)) break;
      if (order == highest_order) finest = cells;
      // Start with equal errors of both parts; smallest_cutoff() refines the guess.
      double const n = cells_in_all(system.dimension, cells), h = std::pow(volume / n, 1.0 / system.dimension);
      double const q = square(accuracy / scale) / 2 * volume / (n * h * h);
      double const alpha = mesh_errors.alpha_h_of(order, q) / h;
      if (alpha == 0) continue;
      double const cutoff = root_of(1e-4 * half, 4 * half,
                                    [&](double r) { return accuracy / std::sqrt(2.0) - error_near(system, alpha, r); });
      if (cutoff > 1.1 * half) continue;
      candidates.push_back({order, cells, seconds_of(system, order, cells, std::min(cutoff, half), threads)});
      least = std::min(least, candidates.back().seconds);
      if (seconds_of(system, order, cells, 0, threads) > least) break;  // finer meshes cost more
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](Candidate const& a, Candidate const& b) { return a.seconds < b.seconds; });
  if (accuracy >= rounding_error(system))
    for (auto const& candidate : candidates)
      if (auto const found = smallest_cutoff(system, candidate.order, candidate.cells, accuracy)) return *found;

  double const best = std::max(smallest_error(system, highest_order, finest), rounding_error(system));
  throw Error(
      fmt::format("p3m: an rms error of the force of {:.3g} can't be reached with a cut-off of at most half the "
                  "shortest edge, order {} and {} MiB for the mesh; {:.2g} can",
                  accuracy, highest_order, memory >> 20, best * 1.05));
}

}  // namespace boltzmann
