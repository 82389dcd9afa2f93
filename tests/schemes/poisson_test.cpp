// Poisson's equation on meshes against exact solutions: modes and smooth potentials for all ends, Gaussian charges in
// empty space.
#include <boltzmann/schemes/mesh/poisson.hpp>

#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <random>
#include <string>

namespace boltzmann::poisson_test {
namespace {

double const pi_ = std::numbers::pi;
using Fields = std::vector<std::vector<double>>;
using enum FieldBoundary;

FieldEnds const closed_ends[] = {
    {periodic, periodic}, {dirichlet, dirichlet}, {neumann, neumann}, {dirichlet, neumann}, {neumann, dirichlet}};

MeshGrid grid_of(std::vector<FieldEnds> const& ends, std::vector<std::size_t> const& cells,
                 std::vector<double> const& lengths) {
  MeshGrid grid;
  grid.dimension = static_cast<int>(cells.size());
  for (std::size_t a = 0; a < cells.size(); ++a) {
    grid.periodic[a] = ends[a].low == periodic;
    grid.nodes[a] = cells[a] + (grid.periodic[a] ? 0 : 1);
    grid.low[a] = -0.3 * static_cast<double>(a + 1);
    grid.spacing[a] = lengths[a] / static_cast<double>(cells[a]);
  }
  return grid;
}

std::array<FieldEnds, 3> three(std::vector<FieldEnds> const& ends) {
  std::array<FieldEnds, 3> result;
  std::copy(ends.begin(), ends.end(), result.begin());
  return result;
}

/// function(position from the low corner, index) for all nodes.
template <class Function>
void for_nodes(MeshGrid const& grid, Function const& function) {
  for (std::size_t k = 0; k < grid.nodes[2]; ++k)
    for (std::size_t j = 0; j < grid.nodes[1]; ++j)
      for (std::size_t i = 0; i < grid.nodes[0]; ++i)
        function(
            std::array<double, 3>{static_cast<double>(i) * grid.spacing[0], static_cast<double>(j) * grid.spacing[1],
                                  static_cast<double>(k) * grid.spacing[2]},
            grid.index(i, j, k));
}

double largest(std::vector<double> const& values) {
  double most = 0;
  for (double const v : values) most = std::max(most, std::isnan(v) ? INFINITY : std::abs(v));
  return most;
}
double difference(std::vector<double> const& a, std::vector<double> const& b) {
  if (a.size() != b.size()) return INFINITY;
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    double const d = std::abs(a[i] - b[i]);
    most = std::max(most, std::isnan(d) ? INFINITY : d);
  }
  return most;
}

/// A function of one coordinate and its first two derivatives.
struct Jet {
  double f = 0, d = 0, dd = 0;
};
Jet operator*(Jet const& a, Jet const& b) {
  return {a.f * b.f, a.d * b.f + a.f * b.d, a.dd * b.f + 2 * a.d * b.d + a.f * b.dd};
}
Jet sine(double k, double x, double phase = 0) {
  return {std::sin(k * x + phase), k * std::cos(k * x + phase), -k * k * std::sin(k * x + phase)};
}
Jet exponential(Jet const& a) { return {std::exp(a.f), a.d * std::exp(a.f), (a.dd + a.d * a.d) * std::exp(a.f)}; }

/// An eigenfunction of the axis: mode m of a box of length L.
double wave_number(FieldEnds const& ends, int m, double length) {
  if (ends.low == periodic) return 2 * pi_ * m / length;
  if (ends.low == ends.high) return pi_ * m / length;
  return pi_ * (m + 0.5) / length;
}
Jet mode(FieldEnds const& ends, int m, double length, double x) {
  double const k = wave_number(ends, m, length);
  if (ends.low == periodic) return sine(k, x, 0.7);
  return ends.low == dirichlet ? sine(k, x) : sine(k, x, pi_ / 2);
}

/// A smooth function with all modes, of the ends' symmetry.
Jet smooth(FieldEnds const& ends, double length, double x) {
  if (ends.low == periodic) return exponential(sine(2 * pi_ / length, x, 0.4));
  Jet const even = exponential(sine(pi_ / length, x, pi_ / 2));
  if (ends.low == neumann && ends.high == neumann) return even;
  if (ends.low == ends.high) return sine(pi_ / length, x) * even;
  return sine(pi_ / (2 * length), x, ends.low == dirichlet ? 0 : pi_ / 2) * even;
}

struct Problem {
  std::vector<double> density, potential;
  Fields field;
};

/// Potential: the product of one function for each axis; density: -laplacian / constant.
template <class Function>
Problem product(MeshGrid const& grid, double constant, Function const& function) {
  Problem problem;
  problem.density.resize(grid.size());
  problem.potential.resize(grid.size());
  problem.field.assign(grid.dimension, std::vector<double>(grid.size()));
  for_nodes(grid, [&](std::array<double, 3> const& x, std::size_t i) {
    std::array<Jet, 3> jets;
    for (int a = 0; a < grid.dimension; ++a) jets[a] = function(a, x[a]);
    double value = 1, laplacian = 0;
    for (int a = 0; a < grid.dimension; ++a) value *= jets[a].f;
    for (int a = 0; a < grid.dimension; ++a) {
      double rest = 1;
      for (int b = 0; b < grid.dimension; ++b)
        if (b != a) rest *= jets[b].f;
      laplacian += rest * jets[a].dd;
      problem.field[a][i] = -rest * jets[a].d;
    }
    problem.potential[i] = value;
    problem.density[i] = -laplacian / constant;
  });
  return problem;
}

std::vector<double> random_numbers(std::size_t size, unsigned seed) {
  std::mt19937 engine(test_seed(seed));
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> numbers(size);
  for (double& number : numbers) number = uniform(engine);
  return numbers;
}

/// All choices of ends for so many axes.
template <class Function>
void for_closed_ends(int dimension, Function const& function) {
  int const choices = dimension == 1 ? 5 : dimension == 2 ? 25 : 125;
  for (int c = 0; c < choices; ++c) {
    std::vector<FieldEnds> ends;
    for (int a = 0, rest = c; a < dimension; ++a, rest /= 5) ends.push_back(closed_ends[rest % 5]);
    function(ends);
  }
}

}  // namespace

// Every mode is an eigenfunction: of the Laplacian with k^2, of the three-point one with (2 sin(kh/2)/h)^2, where
// central differences of the mode have sin(kh)/h in place of k.
TEST(Poisson, modes_of_all_ends_and_sizes) {
  std::size_t const sizes[] = {1, 2, 3, 4, 5, 7, 8, 11, 12, 17, 18, 33};
  std::mt19937 engine(test_seed(7));
  for (int dimension = 1; dimension <= 3; ++dimension)
    for_closed_ends(dimension, [&](std::vector<FieldEnds> const& ends) {
      for (int repeat = 0; repeat < (dimension == 1 ? 24 : dimension == 2 ? 8 : 2); ++repeat) {
        std::vector<std::size_t> cells;
        std::vector<double> lengths;
        std::vector<int> modes;
        std::string name;
        for (FieldEnds const& e : ends) {
          std::size_t n = sizes[engine() % (dimension == 3 ? 10 : 12)];
          if (dimension == 1) n = sizes[repeat % 12];
          bool const both_dirichlet = e.low == dirichlet && e.high == dirichlet;
          if (both_dirichlet) n = std::max<std::size_t>(n, 2);
          cells.push_back(n);
          lengths.push_back(0.5 + static_cast<double>(engine() % 100) / 30);
          // Below the Nyquist mode, and with none that is zero on all nodes.
          std::size_t const choices = e.low == periodic ? (n + 1) / 2 : both_dirichlet ? n - 1 : n;
          modes.push_back(static_cast<int>(engine() % choices) + (both_dirichlet ? 1 : 0));
          name += std::to_string(n) +
                  (e.low == periodic    ? "P"
                   : e.low == dirichlet ? "D"
                                        : "N") +
                  (e.high == periodic    ? "P"
                   : e.high == dirichlet ? "D"
                                         : "N") +
                  std::to_string(modes.back()) + " ";
        }
        MeshGrid const grid = grid_of(ends, cells, lengths);
        double const constant = 3.7;
        Problem exact =
            product(grid, constant, [&](int a, double x) { return mode(ends[a], modes[a], lengths[a], x); });
        double k2 = 0, difference2 = 0, constant2 = 0, first2 = std::numeric_limits<double>::infinity();
        std::array<double, 3> slopes{1, 1, 1};
        for (int a = 0; a < dimension; ++a) {
          double const k = wave_number(ends[a], modes[a], lengths[a]), h = grid.spacing[a];
          bool const both_dirichlet = ends[a].low == dirichlet && ends[a].high == dirichlet;
          double const lowest = wave_number(ends[a], both_dirichlet ? 1 : 0, lengths[a]);
          constant2 += lowest * lowest;
          first2 = std::min(first2, std::pow(wave_number(ends[a], 1, lengths[a]), 2));
          k2 += k * k;
          difference2 += std::pow(2 / h * std::sin(k * h / 2), 2);
          slopes[a] = k > 0 ? std::sin(k * h) / (k * h) : 1;
        }
        if (k2 == 0) {  // a uniform density is dropped
          std::fill(exact.density.begin(), exact.density.end(), 2.0);
          std::fill(exact.potential.begin(), exact.potential.end(), 0.0);
          for (auto& component : exact.field) std::fill(component.begin(), component.end(), 0.0);
        }
        for (PoissonForm const form : {PoissonForm::spectral, PoissonForm::finite_difference}) {
          bool const spectral = form == PoissonForm::spectral;
          PoissonSolver solver(grid, three(ends), form);
          double const factor = spectral || k2 == 0 ? 1 : k2 / difference2;
          std::vector<double> potential, again;
          Fields field, later;
          solver.solve(exact.density, constant, &potential, field);
          solver.potential(exact.density, constant, again);
          EXPECT_EQ(difference(potential, again), 0) << name;
          solver.field(potential, later);
          ASSERT_EQ(field.size(), ends.size());
          // A density that rounds has some of the longest wave, too, whose potential is larger by the ratio of the k^2.
          double const longest2 = constant2 > 0 ? constant2 : first2;
          double const scale = std::max({1.0, factor, 1e-3 * k2 / longest2});
          std::vector<double> wanted = exact.potential;
          for (double& v : wanted) v *= factor;
          EXPECT_LT(difference(potential, wanted), 3e-12 * scale) << name << spectral;
          for (int a = 0; a < dimension; ++a) {
            wanted = exact.field[a];
            for (double& v : wanted) v *= spectral ? 1 : factor * slopes[a];
            double const size = scale * (1 + pi_ / grid.spacing[a]);
            EXPECT_LT(difference(field[a], wanted), 3e-12 * size) << name << spectral << " axis " << a;
            EXPECT_LT(difference(later[a], wanted), 3e-12 * size) << name << spectral << " axis " << a;
          }
          // Without the potential the field is the same.
          solver.solve(exact.density, constant, nullptr, later);
          for (int a = 0; a < dimension; ++a) EXPECT_EQ(difference(field[a], later[a]), 0) << name;
        }
      }
    });
}

// Smooth densities of all wavelengths: second order in finite differences, rounding in the spectral form.
TEST(Poisson, order_of_convergence_for_all_ends) {
  for (int dimension = 1; dimension <= 3; ++dimension)
    for_closed_ends(dimension, [&](std::vector<FieldEnds> const& ends) {
      std::vector<double> const lengths = {1.3, 0.9, 1.7};
      auto const errors = [&](PoissonForm form, std::size_t n) {
        std::vector<std::size_t> cells;
        for (int a = 0; a < dimension; ++a) cells.push_back(n + (dimension == 3 && a == 1 ? n / 4 : 0));
        MeshGrid const grid = grid_of(ends, cells, {lengths.begin(), lengths.begin() + dimension});
        double const constant = 2.5;
        Problem const exact = product(grid, constant, [&](int a, double x) { return smooth(ends[a], lengths[a], x); });
        PoissonSolver solver(grid, three(ends), form);
        std::vector<double> potential;
        Fields field;
        solver.solve(exact.density, constant, &potential, field);
        bool const free = std::none_of(ends.begin(), ends.end(),
                                       [](FieldEnds const& e) { return e.low == dirichlet || e.high == dirichlet; });
        if (free) {  // then the mean is ours to choose
          double mean = 0, weights = 0;
          for_nodes(grid, [&](std::array<double, 3> const& x, std::size_t i) {
            double weight = 1;
            for (int a = 0; a < dimension; ++a) {
              bool const edge = x[a] < 1e-9 || x[a] > lengths[a] - 1e-9;
              if (!grid.periodic[a] && edge) weight /= 2;
            }
            mean += weight * exact.potential[i];
            weights += weight;
          });
          for (double& v : potential) v += mean / weights;
        }
        double most = 0;
        for (int a = 0; a < dimension; ++a) most = std::max(most, difference(field[a], exact.field[a]));
        return std::array<double, 2>{difference(potential, exact.potential), most};
      };
      auto const exact = errors(PoissonForm::spectral, dimension == 3 ? 24 : 36);
      EXPECT_LT(exact[0], dimension == 3 ? 2e-9 : 3e-13);
      EXPECT_LT(exact[1], dimension == 3 ? 1e-7 : 1e-11);
      if (dimension == 3 && ends[0].low != ends[2].low) return;
      std::size_t const n = dimension == 3 ? 12 : 32;
      auto const coarse = errors(PoissonForm::finite_difference, n);
      auto const fine = errors(PoissonForm::finite_difference, 2 * n);
      for (int i = 0; i < 2; ++i) {
        double const order = std::log2(coarse[i] / fine[i]);
        EXPECT_NEAR(order, 2, dimension == 3 ? 0.35 : 0.15) << "dimension " << dimension << " quantity " << i;
      }
    });
}

namespace {

/// e^(-k|x|)/2k and its like (k2 = 0: without the infinite part) convolved with a Gaussian of charge 1 and width s, as
/// an integral over the time of diffusion: potential and -d/dr.
std::array<double, 2> screened_gaussian(int axes, double k2, double s, double r) {
  double potential = 0, slope = 0;
  double const step = 0.05;
  for (double u = -40; u < 8; u += step) {
    double const t = std::exp(u), variance = s * s + 2 * t;
    double const value =
        step * t * std::exp(-k2 * t - r * r / (2 * variance)) / std::pow(2 * pi_ * variance, 0.5 * axes);
    potential += value;
    slope += value * r / variance;
  }
  return {potential, slope};
}

/// A Gaussian charge of 1 alone in empty space.
std::array<double, 2> free_gaussian(int axes, double s, double r) {
  double const z = r / (std::sqrt(2.0) * s);
  if (axes == 1) return {-0.5 * (r * std::erf(z) + s * std::sqrt(2 / pi_) * std::exp(-z * z)), 0.5 * std::erf(z)};
  if (axes == 2) {
    if (r == 0) return {-(std::log(2 * s * s) - std::numbers::egamma) / (4 * pi_), 0};
    return {-(std::log(r * r) - std::expint(-z * z)) / (4 * pi_), -std::expm1(-z * z) / (2 * pi_ * r)};
  }
  double const peak = std::sqrt(2 / pi_) / s;
  if (r == 0) return {peak / (4 * pi_), 0};
  return {std::erf(z) / (4 * pi_ * r), (std::erf(z) / r - peak * std::exp(-z * z)) / (4 * pi_ * r)};
}

}  // namespace

// A Gaussian off the middle of an oblong box in empty space: spectral accuracy, and second order of the differences.
TEST(Poisson, gaussian_charge_in_empty_space) {
  for (int dimension = 1; dimension <= 3; ++dimension) {
    std::vector<FieldEnds> const ends(dimension, FieldEnds{open, open});
    std::vector<double> const lengths = {1.0, 1.1, 0.96};
    double const s = 0.06, constant = 4 * pi_;
    auto const errors = [&](PoissonForm form, std::size_t n) {
      std::vector<std::size_t> cells;
      for (int a = 0; a < dimension; ++a) cells.push_back(n + 2 * a);
      MeshGrid const grid = grid_of(ends, cells, {lengths.begin(), lengths.begin() + dimension});
      Problem exact;
      exact.density.resize(grid.size());
      exact.potential.resize(grid.size());
      exact.field.assign(dimension, std::vector<double>(grid.size()));
      for_nodes(grid, [&](std::array<double, 3> x, std::size_t i) {
        double r2 = 0;
        for (int a = 0; a < dimension; ++a) {
          x[a] -= 0.5 * lengths[a] + 0.01 * (a - 0.5);
          r2 += x[a] * x[a];
        }
        double const r = std::sqrt(r2);
        auto const [potential, slope] = free_gaussian(dimension, s, r);
        exact.density[i] = std::exp(-r2 / (2 * s * s)) / std::pow(2 * pi_ * s * s, 0.5 * dimension);
        exact.potential[i] = constant * potential;
        for (int a = 0; a < dimension; ++a) exact.field[a][i] = r > 0 ? constant * slope * x[a] / r : 0;
      });
      PoissonSolver solver(grid, three(ends), form);
      std::vector<double> potential;
      Fields field;
      solver.solve(exact.density, constant, &potential, field);
      double error = 0, size = 0;
      for (int a = 0; a < dimension; ++a) {
        error = std::max(error, difference(field[a], exact.field[a]));
        size = std::max(size, largest(exact.field[a]));
      }
      return std::array<double, 2>{difference(potential, exact.potential) / largest(exact.potential), error / size};
    };
    auto const spectral = errors(PoissonForm::spectral, 48);
    EXPECT_LT(spectral[0], 1e-12) << dimension;
    EXPECT_LT(spectral[1], 1e-11) << dimension;
    auto const coarse = errors(PoissonForm::finite_difference, 32), fine = errors(PoissonForm::finite_difference, 64);
    EXPECT_LT(fine[0], 1e-12) << dimension;
    EXPECT_NEAR(std::log2(coarse[1] / fine[1]), 2, 0.25) << dimension;
  }
}

// Open axes together with any others in any order: a Gaussian along the open ones times a mode of the others.
TEST(Poisson, open_axes_among_others) {
  double const s = 0.07, constant = 1.7;
  for (int dimension = 2; dimension <= 3; ++dimension)
    for (int which = 1; which < (1 << dimension) - 1; ++which)
      for (int choice = 0; choice < 5; ++choice)
        for (int const number : {0, 2}) {
          std::vector<FieldEnds> ends;
          std::vector<std::size_t> cells;
          std::vector<double> lengths;
          int open_axes = 0;
          for (int a = 0; a < dimension; ++a) {
            bool const is_open = which >> a & 1;
            open_axes += is_open;
            ends.push_back(is_open ? FieldEnds{open, open} : closed_ends[(choice + a) % 5]);
            cells.push_back(is_open ? 44 + a : 7 + a);
            lengths.push_back(is_open ? 1.1 - 0.05 * a : 0.6 + 0.3 * a);
          }
          MeshGrid const grid = grid_of(ends, cells, lengths);
          for (PoissonForm const form : {PoissonForm::spectral, PoissonForm::finite_difference}) {
            bool const spectral = form == PoissonForm::spectral;
            double k2 = 0;
            std::array<int, 3> modes{};
            std::array<double, 3> ratio{1, 1, 1};
            for (int a = 0; a < dimension; ++a) {
              if (which >> a & 1) continue;
              bool const both = ends[a].low == dirichlet && ends[a].high == dirichlet;
              modes[a] = number == 0 ? (both ? 1 : 0) : number + (a % 2);
              double const k = wave_number(ends[a], modes[a], lengths[a]), h = grid.spacing[a];
              k2 += spectral ? k * k : std::pow(2 / h * std::sin(k * h / 2), 2);
              if (!spectral && k > 0) ratio[a] = std::sin(k * h) / (k * h);
            }
            std::vector<double> density(grid.size());
            for_nodes(grid, [&](std::array<double, 3> const& x, std::size_t i) {
              double r2 = 0, rest = 1;
              for (int a = 0; a < dimension; ++a)
                if (which >> a & 1)
                  r2 += std::pow(x[a] - 0.5 * lengths[a] - 0.003, 2);
                else
                  rest *= mode(ends[a], modes[a], lengths[a], x[a]).f;
              density[i] = rest * std::exp(-r2 / (2 * s * s)) / std::pow(2 * pi_ * s * s, 0.5 * open_axes);
            });
            PoissonSolver solver(grid, three(ends), form);
            std::vector<double> got;
            Fields got_field;
            solver.solve(density, constant, &got, got_field);
            // The integral costs: at some nodes only.
            std::size_t node = 0;
            double worst = 0, worst_field = 0, most = 0, most_field = 0;
            for_nodes(grid, [&](std::array<double, 3> const& x, std::size_t i) {
              if (node++ % (grid.size() / 29 + 1) != 0 && i + 1 != grid.size()) return;
              double r2 = 0, rest = 1;
              std::array<double, 3> y{};
              std::array<Jet, 3> jets;
              for (int a = 0; a < dimension; ++a) {
                if (which >> a & 1) {
                  y[a] = x[a] - 0.5 * lengths[a] - 0.003;
                  r2 += y[a] * y[a];
                } else {
                  jets[a] = mode(ends[a], modes[a], lengths[a], x[a]);
                  rest *= jets[a].f;
                }
              }
              double const r = std::sqrt(r2);
              auto const [value, slope] =
                  k2 > 0 ? screened_gaussian(open_axes, k2, s, r) : free_gaussian(open_axes, s, r);
              worst = std::max(worst, std::abs(got[i] - constant * rest * value));
              most = std::max(most, std::abs(constant * value));
              for (int a = 0; a < dimension; ++a) {
                double wanted = constant * rest * slope * y[a] / std::max(r, 1e-300);
                if (!(which >> a & 1)) {
                  wanted = -constant * value * jets[a].d * ratio[a];
                  for (int b = 0; b < dimension; ++b)
                    if (b != a && !(which >> b & 1)) wanted *= jets[b].f;
                } else if (!spectral) {
                  continue;
                }
                worst_field = std::max(worst_field, std::abs(got_field[a][i] - wanted));
                most_field = std::max(most_field, std::abs(wanted));
              }
            });
            EXPECT_LT(worst, 3e-11 * most)
                << dimension << "D open " << which << " ends " << choice << " mode " << number << spectral;
            EXPECT_LT(worst_field, 1e-10 * std::max(most_field, most))
                << dimension << "D open " << which << " ends " << choice << " mode " << number << spectral;
          }
        }
}

// Two unit densities at opposite edges and corners: each gives at the other's place what the other gives at its own,
// and the fields are opposite. Nothing of a charge comes back around the doubled mesh.
TEST(Poisson, open_box_is_the_same_from_edge_to_edge) {
  for (std::size_t const n : {std::size_t{1}, std::size_t{2}, std::size_t{13}, std::size_t{20}})
    for (PoissonForm const form : {PoissonForm::spectral, PoissonForm::finite_difference}) {
      MeshGrid const grid = grid_of({{open, open}, {open, open}}, {n, n + 3}, {1.0, 1.4});
      PoissonSolver solver(grid, three({{open, open}, {open, open}}), form);
      std::vector<double> first(grid.size(), 0.0), second(grid.size(), 0.0), phi, phi_back;
      first.front() = second.back() = 1 / grid.cell_volume();
      Fields field, field_back;
      solver.solve(first, 1.0, &phi, field);
      solver.solve(second, 1.0, &phi_back, field_back);
      double const distance = std::hypot(1.0, 1.4);
      EXPECT_NEAR(phi.back(), phi_back.front(), 1e-13);
      EXPECT_NEAR(phi.back(), -std::log(distance) / (2 * pi_), n > 2 ? 1e-3 : 5e-2) << n;
      for (int a = 0; a < 2; ++a) {
        EXPECT_NEAR(field[a].back(), -field_back[a].front(), 1e-12);
        if (n > 2) {
          double const wanted = (a == 0 ? 1.0 : 1.4) / (distance * distance * 2 * pi_);
          EXPECT_NEAR(field[a].back(), wanted, 0.03 * wanted) << n << (form == PoissonForm::spectral);
        }
      }
    }
}

// A sheet of charge on a line in empty space: E = C q/2 on either side, all the way to the edges.
TEST(Poisson, charge_of_one_sign_on_an_open_line) {
  MeshGrid const grid = grid_of({{open, open}}, {64}, {2.0});
  std::vector<double> density(grid.size()), potential;
  for (std::size_t i = 0; i < density.size(); ++i)
    density[i] = std::exp(-std::pow(grid.spacing[0] * static_cast<double>(i) - 1, 2) / 0.02) / std::sqrt(0.02 * pi_);
  for (PoissonForm const form : {PoissonForm::spectral, PoissonForm::finite_difference}) {
    Fields field;
    PoissonSolver solver(grid, three({{open, open}}), form);
    solver.solve(density, 4 * pi_, &potential, field);
    EXPECT_NEAR(field[0].front(), -2 * pi_, 1e-10);
    EXPECT_NEAR(field[0].back(), 2 * pi_, 1e-10);
    EXPECT_NEAR(potential.front(), -2 * pi_, 1e-10);
  }
}

TEST(Poisson, density_on_conductors_is_ignored) {
  MeshGrid const grid = grid_of({{dirichlet, neumann}, {periodic, periodic}}, {6, 5}, {1.0, 1.0});
  for (PoissonForm const form : {PoissonForm::spectral, PoissonForm::finite_difference}) {
    PoissonSolver solver(grid, three({{dirichlet, neumann}, {periodic, periodic}}), form);
    auto density = random_numbers(grid.size(), 1);
    std::vector<double> potential, same;
    solver.potential(density, 1.0, potential);
    for (std::size_t j = 0; j < 5; ++j) {
      EXPECT_EQ(potential[grid.index(0, j)], 0);
      density[grid.index(0, j)] = std::numeric_limits<double>::quiet_NaN();
    }
    solver.potential(density, 1.0, same);
    EXPECT_EQ(difference(potential, same), 0);
  }
}

// The discrete equation holds at every node for a random density (mean zero where it must be).
TEST(Poisson, three_point_laplacian_of_random_densities) {
  for_closed_ends(2, [&](std::vector<FieldEnds> const& ends) {
    MeshGrid const grid = grid_of(ends, {13, 10}, {1.0, 2.3});
    auto const density = random_numbers(grid.size(), 5);
    std::vector<double> phi;
    PoissonSolver(grid, three(ends), PoissonForm::finite_difference).potential(density, 2.0, phi);
    auto const neighbours = [&](int a, std::size_t j) -> std::array<std::ptrdiff_t, 2> {
      auto const last = static_cast<std::ptrdiff_t>(grid.nodes[a]) - 1, at = static_cast<std::ptrdiff_t>(j);
      if (grid.periodic[a]) return {at == 0 ? last : at - 1, at == last ? 0 : at + 1};
      return {at == 0 ? 1 : at - 1, at == last ? last - 1 : at + 1};  // inside, or mirrored at a Neumann end
    };
    bool free = true;
    for (auto const& e : ends) free = free && e.low != dirichlet && e.high != dirichlet;
    double first = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t j = 0; j < grid.nodes[1]; ++j)
      for (std::size_t i = 0; i < grid.nodes[0]; ++i) {
        std::array<std::size_t, 2> const node{i, j};
        bool grounded = false;
        for (int a = 0; a < 2; ++a)
          grounded = grounded || (ends[a].low == dirichlet && node[a] == 0) ||
                     (ends[a].high == dirichlet && node[a] == grid.nodes[a] - 1);
        if (grounded) continue;
        double laplacian = 0;
        for (int a = 0; a < 2; ++a)
          for (auto const other : neighbours(a, node[a])) {
            double const there = a == 0 ? phi[grid.index(other, j)] : phi[grid.index(i, other)];
            laplacian += (there - phi[grid.index(i, j)]) / (grid.spacing[a] * grid.spacing[a]);
          }
        double const rest = laplacian + 2.0 * density[grid.index(i, j)];  // zero, or 2 times the mean density
        if (!free) {
          EXPECT_NEAR(rest, 0, 1e-10);
        } else {
          if (std::isnan(first)) first = rest;
          EXPECT_NEAR(rest, first, 1e-10);
        }
      }
  });
}

TEST(Poisson, same_bits_for_any_number_of_threads) {
  FieldEnds const p{periodic, periodic}, d{dirichlet, dirichlet}, m{dirichlet, neumann}, n{neumann, neumann},
      o{open, open};
  std::vector<std::vector<FieldEnds>> const cases = {{p},       {d},       {o},       {p, p},    {d, p},
                                                     {p, m},    {o, p},    {n, o},    {p, p, p}, {d, n, p},
                                                     {p, m, d}, {o, p, d}, {p, o, o}, {o, o, o}};
  for (auto const& ends : cases) {
    std::vector<std::vector<std::size_t>> const sizes = {{20000}, {151, 130}, {29, 26, 27}};
    auto const& cells = sizes[ends.size() - 1];
    MeshGrid const grid = grid_of(ends, cells, std::vector<double>(ends.size(), 1.0));
    auto const density = random_numbers(grid.size(), 3);
    for (PoissonForm const form : {PoissonForm::spectral, PoissonForm::finite_difference}) {
      PoissonSolver one(grid, three(ends), form, 1), many(grid, three(ends), form, 3);
      std::vector<double> a, b;
      Fields e, f, again;
      one.solve(density, 1.0, &a, e);
      many.solve(density, 1.0, &b, f);
      EXPECT_EQ(difference(a, b), 0);
      EXPECT_GT(largest(a), 0);
      for (std::size_t c = 0; c < ends.size(); ++c) EXPECT_EQ(difference(e[c], f[c]), 0);
      one.field(a, e);
      many.field(a, f);
      many.field(a, again);
      for (std::size_t c = 0; c < ends.size(); ++c) {
        EXPECT_EQ(difference(e[c], f[c]), 0);
        EXPECT_EQ(difference(f[c], again[c]), 0);
      }
    }
  }
}

TEST(Poisson, green_function_of_ones_own) {
  for (int dimension = 1; dimension <= 3; ++dimension) {
    std::vector<FieldEnds> const ends(dimension, FieldEnds{});
    std::vector<std::size_t> const cells = {12, 9, 10};
    std::vector<double> const lengths = {1.0, 2.0, 1.5};
    MeshGrid const grid =
        grid_of(ends, {cells.begin(), cells.begin() + dimension}, {lengths.begin(), lengths.begin() + dimension});
    auto const density = random_numbers(grid.size(), 9);
    GreensFunction const green = [&](std::array<double, 3> const& k) {
      double k2 = 0;
      for (int a = 0; a < 3; ++a) {
        if (a >= dimension) {
          EXPECT_EQ(k[a], 0);
        } else {
          EXPECT_GE(k[a], -pi_ / grid.spacing[a] * (1 + 1e-14));
          EXPECT_LT(k[a], pi_ / grid.spacing[a] * (1 - 1e-14));
        }
        k2 += k[a] * k[a];
      }
      EXPECT_GT(k2, 0);
      return 1 / k2;
    };
    for (PoissonForm const form : {PoissonForm::spectral, PoissonForm::finite_difference}) {
      PoissonSolver with(grid, three(ends), form, 1, green), without(grid, three(ends), PoissonForm::spectral);
      std::vector<double> a, b;
      with.potential(density, 3.0, a);
      without.potential(density, 3.0, b);
      EXPECT_LT(difference(a, b), 1e-14 * (1 + largest(b)));
    }
  }
}

TEST(Poisson, refusals) {
  auto const line = [](std::vector<FieldEnds> const& ends, std::vector<std::size_t> const& cells,
                       GreensFunction const& green = {}) {
    std::vector<double> const lengths(cells.size(), 1.0);
    return message([&] { PoissonSolver(grid_of(ends, cells, lengths), three(ends), PoissonForm::spectral, 1, green); });
  };
  EXPECT_EQ(line({{periodic, neumann}}, {4}),
            "mesh: axis x is periodic at its low end and neumann at its high end; periodic must be both or none");
  EXPECT_EQ(line({{}, {dirichlet, open}}, {4, 4}),
            "mesh: axis y is dirichlet at its low end and open at its high end; open must be both or none");
  EXPECT_EQ(line({{open, periodic}}, {4}),
            "mesh: axis x is open at its low end and periodic at its high end; periodic must be both or none");
  EXPECT_EQ(line({{dirichlet, dirichlet}}, {1}),
            "mesh: axis x has 1 cell(s); with the ends dirichlet and dirichlet it needs 2 or more");
  EXPECT_EQ(line({{neumann, neumann}}, {0}),
            "mesh: axis x has 0 cell(s); with the ends neumann and neumann it needs 1 or more");
  EXPECT_EQ(line({{}, {neumann, neumann}}, {4, 4}, [](std::array<double, 3> const&) { return 1.0; }),
            "mesh: axis y is not periodic; a Green function of one's own needs periodic axes");
  EXPECT_NE(line({{}}, {4}, [](std::array<double, 3> const&) { return NAN; }).find("it must be finite"),
            std::string::npos);
  EXPECT_EQ(line({{}}, {4}), "no error");

  MeshGrid grid = grid_of({{}}, {4}, {1.0});
  EXPECT_EQ(message([&] {
              PoissonSolver(grid, three({{open, open}}), PoissonForm::spectral);
            }),
            "mesh: axis x of the mesh is periodic, but the potential's ends are open and open");
  PoissonSolver solver(grid, {}, PoissonForm::spectral);
  std::vector<double> const wrong(5);
  std::vector<double> potential;
  Fields field;
  EXPECT_EQ(message([&] { solver.potential(wrong, 1, potential); }),
            "mesh: the density has 5 numbers; the mesh has 4 nodes");
  EXPECT_EQ(message([&] { solver.solve(wrong, 1, nullptr, field); }),
            "mesh: the density has 5 numbers; the mesh has 4 nodes");
  EXPECT_EQ(message([&] { solver.field(wrong, field); }), "mesh: the potential has 5 numbers; the mesh has 4 nodes");
  grid.spacing[0] = 0;
  EXPECT_EQ(message([&] { PoissonSolver(grid, {}, PoissonForm::spectral); }),
            "mesh: the spacing along x is 0; it must be finite and > 0");
  grid.dimension = 4;
  EXPECT_EQ(message([&] { PoissonSolver(grid, {}, PoissonForm::spectral); }),
            "mesh: 4 dimensions; a mesh has 1, 2 or 3");
}

#ifndef BOLTZMANN_SANITIZED
namespace {

double status_bytes(std::string const& key) {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;)
    if (word == key) {
      double kilobytes = 0;
      file >> kilobytes;
      return 1024 * kilobytes;
    }
  return NAN;
}

/// What a solver takes at its peak, as the system sees it: in a process of its own, that tells by a pipe.
double measured_peak(MeshGrid const& grid, std::array<FieldEnds, 3> const& ends, PoissonForm form) {
  int ends_of_pipe[2];
  if (pipe(ends_of_pipe) != 0) return NAN;
  pid_t const child = fork();
  if (child == 0) {
    // Large blocks go back to the system when they are freed, whatever this program has freed before.
    mallopt(M_MMAP_THRESHOLD, 128 << 10);
    std::vector<double> const density(grid.size(), 1.0);
    std::vector<double> potential(grid.size(), 1.0);
    Fields field(grid.dimension, potential);
    // Code that is used for the first time and memory that was freed before are not the solver's.
    MeshGrid small = grid;
    for (int a = 0; a < grid.dimension; ++a) small.nodes[a] = 6;
    Fields aside;
    PoissonSolver(small, ends, form).solve(std::vector<double>(small.size(), 1.0), 1.0, nullptr, aside);
    malloc_trim(0);
    { std::ofstream("/proc/self/clear_refs") << 5; }  // the peak begins here
    double const before = status_bytes("VmRSS:");
    PoissonSolver(grid, ends, form).solve(density, 1.0, &potential, field);
    double const peak = status_bytes("VmHWM:") - before;
    bool const written = write(ends_of_pipe[1], &peak, sizeof peak) == sizeof peak;
    _exit(written ? 0 : 1);
  }
  double peak = NAN;
  bool const read_all = read(ends_of_pipe[0], &peak, sizeof peak) == sizeof peak;
  waitpid(child, nullptr, 0);
  close(ends_of_pipe[0]);
  close(ends_of_pipe[1]);
  return read_all ? peak : NAN;
}

}  // namespace

TEST(Poisson, memory_is_known_before) {
  FieldEnds const p{periodic, periodic}, d{dirichlet, dirichlet}, o{open, open};
  struct Case {
    std::vector<FieldEnds> ends;
    std::vector<std::size_t> cells;
  };
  for (Case const& c : {Case{{p, p, p}, {128, 128, 128}}, Case{{d, d, d}, {128, 100, 130}}, Case{{p, p}, {1500, 1500}},
                        Case{{p}, {1000000}}, Case{{o, o, o}, {60, 62, 64}}, Case{{o, o}, {800, 800}},
                        Case{{p, p, o}, {120, 120, 120}}})
    for (PoissonForm const form : {PoissonForm::spectral, PoissonForm::finite_difference}) {
      MeshGrid const grid = grid_of(c.ends, c.cells, std::vector<double>(c.cells.size(), 1.0));
      auto const needed = static_cast<double>(PoissonSolver::bytes_needed(grid, three(c.ends), form));
      double const peak = measured_peak(grid, three(c.ends), form);
      // What the system counts is off by some MB where other programs want memory.
      EXPECT_NEAR(needed, peak, 0.1 * peak + 6e6)
          << c.cells[0] << " cells, " << c.ends.size() << "D, " << (form == PoissonForm::spectral) << ": " << needed
          << " against " << peak;
    }
  // A box of 256^3 with density, potential, field and solver under 2 GiB.
  MeshGrid const large = grid_of({p, p, p}, {256, 256, 256}, {1.0, 1.0, 1.0});
  EXPECT_LT(PoissonSolver::bytes_needed(large, {}) + 5 * 8 * large.size(), std::size_t{2} << 30);
}
#endif

}  // namespace boltzmann::poisson_test
