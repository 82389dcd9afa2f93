// Kind of fault: grounded walls of a mesh missed half a cell of charge. Field and density at Dirichlet ends, and forces
// beside them, for each dimension, order of assignment and form of Poisson's equation, charges and gravity, walls at either
// end or both, with a background and without.
#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/mesh/ewald.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>

#include <tests/schemes/mesh_systems.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>

namespace boltzmann::grounded_walls_test {
namespace {

using namespace mesh_tests;
using enum FieldBoundary;

/// Walls along x at 0 and 1, periodic along the other axes.
template <int D>
Box between_plates(Vector<D> const& edges) {
  std::array<Boundary, D> boundaries;
  boundaries.fill(Boundary::periodic);
  boundaries[0] = Boundary::reflecting;
  return Box(Vector<D>{}, edges, boundaries);
}

/// A potential whose density has a value, a slope and a curvature at the walls, its field and -laplacian.
struct Smooth {
  FieldEnds ends;
  double wave = 0;  ///< along y (and z)
  bool uniform = false;

  /// Function of x, first and second derivative.
  std::array<double, 3> across(double x) const {
    if (uniform && ends.high == neumann) return {x - x * x / 2, 1 - x, -1};
    if (uniform) return {x * (1 - x) / 2, 0.5 - x, -1};
    if (ends.high == neumann)
      return {x * (1 + x * (1 + x * (1 - 1.5 * x))), 1 + x * (2 + x * (3 - 6 * x)), 2 + x * (6 - 18 * x)};
    return {x * (1 - x) * (2 + x + 3 * x * x), 2 + x * (-2 + x * (6 - 12 * x)), -2 + x * (12 - 36 * x)};
  }
  template <int D>
  double density(Vector<D> const& r) const {
    auto const [f, d, dd] = across(r[0]);
    double value = -dd;
    for (int a = 1; a < D; ++a) value *= std::cos(wave * r[a]);
    double rest = (D - 1) * wave * wave * f;
    for (int a = 1; a < D; ++a) rest *= std::cos(wave * r[a]);
    return value + rest;
  }
  template <int D>
  Vector<D> field(Vector<D> const& r) const {
    auto const [f, d, dd] = across(r[0]);
    Vector<D> E;
    E[0] = -d;
    for (int a = 1; a < D; ++a) E[0] *= std::cos(wave * r[a]);
    for (int a = 1; a < D; ++a) {
      E[a] = f;
      for (int b = 1; b < D; ++b) E[a] *= a == b ? wave * std::sin(wave * r[b]) : std::cos(wave * r[b]);
    }
    return E;
  }
};

struct Errors {
  double density = 0, field = 0, force = 0;
};

/// The largest errors at nodes and at particles. `n` cells from wall to wall and `along` (0: as many) along other axes,
/// `each` particles a cell along each axis.
template <class P>
Errors errors(Smooth const& smooth, std::size_t n, std::size_t each, int order, PoissonForm form,
              LaplaceLaw const& law = coulomb(0.7), std::size_t along = 0) {
  constexpr int D = P::dimension;
  constexpr bool charged = std::is_same_v<P, Coulomb<D>>;
  Vector<D> const edges = filled<D>(1.0);
  std::vector<std::size_t> cells(D, along == 0 ? n : along), sides;
  cells[0] = n;
  for (auto const count : cells) sides.push_back(count * each);
  MeshScheme mesh(between_plates<D>(edges), cells, law);
  mesh.boundary(0, smooth.ends.low, smooth.ends.high);
  mesh.assignment(order);
  mesh.form(form);
  mesh.threads(2);
  std::size_t count = 1;
  for (auto const side : sides) count *= side;
  double const volume = 1 / static_cast<double>(count);
  Ensemble<P> charges("charges", count);
  for (std::size_t i = 0; i < charges.size(); ++i) {
    std::size_t rest = i;
    for (int a = 0; a < D; ++a) {
      std::size_t const side = sides[static_cast<std::size_t>(a)];
      charges[i].position[a] = (static_cast<double>(rest % side) + 0.5) / static_cast<double>(side);
      rest /= side;
    }
    double const strength = smooth.density(charges[i].position) / law.constant * volume;
    if constexpr (charged)
      charges[i].charge = strength;
    else
      charges[i].mass = strength;
  }
  mesh.add(charges);
  mesh.calculate();
  Errors result;
  double largest = 0;
  for (std::size_t i = 0; i < charges.size(); ++i) {
    auto const E = smooth.field(charges[i].position);
    largest = std::max(largest, std::sqrt(norm2(E)));
    result.force = std::max(result.force, std::sqrt(norm2(charges.influence_on(i) / charges[i].strength() - E)));
  }
  auto const fields = mesh.mesh_fields();
  MeshGrid const& grid = fields[0]->grid;
  double densest = 0;
  for (std::size_t k = 0; k < grid.nodes[2]; ++k)
    for (std::size_t j = 0; j < grid.nodes[1]; ++j)
      for (std::size_t i = 0; i < grid.nodes[0]; ++i) {
        Vector<D> r;
        std::array<std::size_t, 3> const at{i, j, k};
        for (std::size_t a = 0; a < D; ++a) r[static_cast<int>(a)] = grid.position(static_cast<int>(a), at[a]);
        std::size_t const node = grid.index(i, j, k);
        double const rho = smooth.density(r) / law.constant;
        densest = std::max(densest, std::abs(rho));
        result.density = std::max(result.density, std::abs(fields[0]->components[0][node] - rho));
        auto const E = smooth.field(r);
        for (int a = 0; a < D; ++a)
          result.field =
              std::max(result.field, std::abs(fields[2]->components[static_cast<std::size_t>(a)][node] - E[a]));
      }
  result.density /= densest;
  result.field /= largest;
  result.force /= largest;
  return result;
}

/// The order of convergence by halving the cell twice more.
double order_of(double coarse, double fine) { return std::log2(coarse / fine) / 2; }

std::string name_of(Smooth const& smooth, int order, PoissonForm form) {
  return to_string(smooth.ends.low) + " " + to_string(smooth.ends.high) + " order " + std::to_string(order) +
         (form == PoissonForm::spectral ? " spectral" : " differences");
}

std::array const both_forms{PoissonForm::finite_difference, PoissonForm::spectral};

}  // namespace

// Between plates a uniform plasma of density n has the field C n (x - L/2), and density n everywhere.
template <class P1>
void expect_exact_for_a_uniform_density(LaplaceLaw const& law) {
  for (auto const& ends : {FieldEnds{dirichlet, dirichlet}, FieldEnds{dirichlet, neumann}})
    for (int order = 1; order <= 7; ++order) {
      auto const error = errors<P1>({ends, 0, true}, 20, 64, order, PoissonForm::finite_difference, law);
      EXPECT_LT(error.density, 1e-4) << order;
      EXPECT_LT(error.field, 1e-5) << order;
      if (order > 1) {
        EXPECT_LT(error.force, 1e-5) << order;
      }
    }
}

TEST(GroundedWalls, UniformPlasmaIsExactInDifferences) {
  expect_exact_for_a_uniform_density<Coulomb<1>>(coulomb(0.7));
  expect_exact_for_a_uniform_density<Kepler<1>>(gravity(0.9));
  auto const two = errors<Coulomb<2>>({{dirichlet, dirichlet}, 0, true}, 12, 2, 2, PoissonForm::finite_difference);
  EXPECT_LT(two.force, 1e-12);
  auto const three =
      errors<Kepler<3>>({{dirichlet, dirichlet}, 0, true}, 8, 2, 2, PoissonForm::finite_difference, gravity(0.9));
  EXPECT_LT(three.field, 1e-12);
}

// A smooth density that does not vanish at the walls: second order up to the walls, at either kind of end.
TEST(GroundedWalls, SecondOrder) {
  for (auto const form : both_forms)
    for (auto const& ends : {FieldEnds{dirichlet, dirichlet}, FieldEnds{dirichlet, neumann}})
      for (int order = 1; order <= 7; ++order) {
        Smooth const smooth{ends};
        std::size_t const n = order <= 5 ? 16 : 64;  // clouds reach over some cells
        auto const coarse = errors<Coulomb<1>>(smooth, n, 32, order, form);
        auto const fine = errors<Coulomb<1>>(smooth, 4 * n, 32, order, form);
        EXPECT_GT(order_of(coarse.density, fine.density), 1.8) << name_of(smooth, order, form);
        EXPECT_GT(order_of(coarse.field, fine.field), 1.8) << name_of(smooth, order, form);
        if (order > 1) {  // the field of the nearest node is one of first order anywhere
          EXPECT_GT(order_of(coarse.force, fine.force), 1.8) << name_of(smooth, order, form);
        }
      }
}

TEST(GroundedWalls, SecondOrderInTwoAndThreeDimensions) {
  for (auto const form : both_forms)
    for (int order = 2; order <= 3; ++order) {
      Smooth const smooth{{dirichlet, dirichlet}, 2 * pi};
      auto const coarse = errors<Coulomb<2>>(smooth, 16, 6, order, form),
                 fine = errors<Coulomb<2>>(smooth, 64, 6, order, form);
      EXPECT_GT(order_of(coarse.field, fine.field), 1.8) << name_of(smooth, order, form) << " 2D";
      EXPECT_GT(order_of(coarse.density, fine.density), 1.8) << name_of(smooth, order, form) << " 2D";
      // Up to 64 cells forces inside are less exact than those at the walls.
      auto const finest = errors<Coulomb<2>>(smooth, 256, 6, order, form);
      EXPECT_GT(order_of(fine.force, finest.force), 1.8) << name_of(smooth, order, form) << " 2D";
      auto const coarse3 = errors<Kepler<3>>(smooth, 8, 3, order, form, gravity(0.9)),
                 fine3 = errors<Kepler<3>>(smooth, 32, 3, order, form, gravity(0.9));
      EXPECT_GT(order_of(coarse3.field, fine3.field), 1.8) << name_of(smooth, order, form) << " 3D";
      EXPECT_GT(order_of(coarse3.density, fine3.density), 1.8) << name_of(smooth, order, form) << " 3D";
    }
}

// A density that varies across the walls alone: cells as fine as in one dimension.
TEST(GroundedWalls, ForcesAreOfSecondOrderInThreeDimensions) {
  for (auto const form : both_forms)
    for (auto const& ends : {FieldEnds{dirichlet, dirichlet}, FieldEnds{dirichlet, neumann}})
      for (int order = 2; order <= 5; ++order) {
        Smooth const smooth{ends};
        auto const coarse = errors<Kepler<3>>(smooth, 24, 8, order, form, gravity(0.9), 2),
                   fine = errors<Kepler<3>>(smooth, 96, 8, order, form, gravity(0.9), 2);
        EXPECT_GT(order_of(coarse.force, fine.force), 1.8) << name_of(smooth, order, form);
      }
}

// A background counts at walls as particles do: a uniform plasma on one has no field, up to the walls.
TEST(GroundedWalls, WithABackground) {
  for (auto const form : both_forms)
    for (int order = 1; order <= 4; ++order) {
      constexpr std::size_t cells = 20, count = 64 * cells;
      MeshScheme mesh(between_plates<1>({1.0}), {cells}, coulomb(0.7));
      mesh.boundary(0, dirichlet, dirichlet);
      mesh.assignment(order);
      mesh.form(form);
      Ensemble<Coulomb<1>> charges("charges", count);
      for (std::size_t i = 0; i < count; ++i) {
        charges[i].position[0] = (static_cast<double>(i) + 0.5) / count;
        charges[i].charge = 5.0 / count;
      }
      mesh.background(true);
      mesh.add(charges);
      mesh.calculate();
      double const alone = coulomb(0.7).constant * 5 / 2 * charges[0].charge;  // the force at a wall without it
      for (std::size_t i = 0; i < count; ++i) EXPECT_LT(std::abs(charges.influence_on(i)[0]), 1e-3 * alone) << order;
    }
}

// A charge alone in one dimension: q E with E the mean of both sides, C q (x/L - 1/2) between two plates, -C q/2 where
// the other end is insulated. In differences it is exact for any place, however near the plate.
TEST(GroundedWalls, ALoneChargeInOneDimension) {
  for (int order = 1; order <= 7; ++order)
    for (auto const& ends :
         {FieldEnds{dirichlet, dirichlet}, FieldEnds{dirichlet, neumann}, FieldEnds{neumann, dirichlet}})
      for (double cells = 0; cells < 6; cells += 0.23) {
        Ensemble<Coulomb<1>> charge("charge", 1);
        MeshScheme mesh(between_plates<1>({2.0}), {30}, coulomb(0.4));
        mesh.boundary(0, ends.low, ends.high);
        mesh.assignment(order);
        // The nearest node is where such a charge is.
        double const L = 2, x = (order == 1 ? std::round(cells) : cells) * L / 30;
        charge[0].position = {ends.low == dirichlet ? x : L - x};
        charge[0].charge = -1.3;
        mesh.add(charge);
        mesh.calculate();
        double const C = mesh.constant(), one = C * 1.3 * 1.3;
        double const exact = ends.high == neumann ? -0.5 * one : ends.low == neumann ? 0.5 * one : one * (x / L - 0.5);
        EXPECT_NEAR(charge.influence_on(0)[0], exact, 1e-11 * one) << order << " " << cells;
        // The field at the plate is that of the charge on it, by which Gauss' law holds.
        MeshField const& field = *mesh.mesh_fields()[2];
        std::size_t const wall = ends.low == dirichlet ? 0 : 30;
        double const at_wall = ends.high == dirichlet && ends.low == dirichlet ? C * 1.3 * (1 - x / L)
                               : ends.low == dirichlet                         ? C * 1.3
                                                                               : -C * 1.3;
        if (cells > 4) {
          EXPECT_NEAR(field.at(wall), at_wall, 1e-11 * C) << order << " " << cells;
        }
      }
}

namespace {

/// The error of the force on a charge at a fixed distance from a plate, by the sum over its images.
template <int D>
double image_force_error(std::size_t n, double distance, int order, PoissonForm form, bool high) {
  Vector<D> const edges = filled<D>(1.0);
  Ensemble<Coulomb<D>> charge("charge", 1);
  charge[0].charge = 1.2;
  for (int a = 0; a < D; ++a) charge[0].position[a] = 0.437;
  charge[0].position[0] = high ? 1 - distance : distance;
  std::array<FieldEnds, D> ends;
  ends.fill({periodic, periodic});
  ends[0] = {dirichlet, dirichlet};
  Mirrored<D> const images = mirrored<D>(charge, edges, ends);
  MeshScheme mesh(between_plates<D>(edges), std::vector<std::size_t>(D, n), coulomb(1));
  mesh.boundary(0, dirichlet);
  mesh.assignment(order);
  mesh.form(form);
  mesh.add(charge);
  mesh.calculate();
  auto const exact = ewald_sums<D>(images.positions, images.strengths, images.edges, coulomb(1).constant).force[0];
  return std::sqrt(norm2(charge.influence_on(0) - exact) / norm2(exact));
}

}  // namespace

// In two and three dimensions the force of the images comes out as the cell gets smaller than the distance.
TEST(GroundedWalls, ImageForceConverges) {
  for (bool const high : {false, true})
    for (int order = 2; order <= 3; ++order) {
      double const a = image_force_error<2>(16, 0.15, order, PoissonForm::finite_difference, high),
                   b = image_force_error<2>(128, 0.15, order, PoissonForm::finite_difference, high);
      EXPECT_GT(std::log2(a / b) / 3, 1.6) << order << " " << a << " " << b;
      EXPECT_LT(b, 0.01);
      double const c = image_force_error<3>(12, 0.2, order, PoissonForm::finite_difference, high),
                   d = image_force_error<3>(48, 0.2, order, PoissonForm::finite_difference, high);
      EXPECT_GT(order_of(c, d), 1.5) << order << " " << c << " " << d;
      EXPECT_LT(d, 0.03);
    }
}

// Nearer than a cell the force is finite, of the right sign, and grows towards the plate.
TEST(GroundedWalls, BesideThePlate) {
  double last = 0;
  for (double cells = 1; cells >= 0; cells -= 0.25) {
    Ensemble<Coulomb<3>> charge("charge", 1);
    charge[0].charge = 1;
    charge[0].position = {cells / 16, 0.5, 0.5};
    MeshScheme mesh(between_plates<3>({1.0, 1.0, 1.0}), {16, 16, 16}, coulomb(1));
    mesh.boundary(0, dirichlet);
    mesh.add(charge);
    mesh.calculate();
    EXPECT_LT(charge.influence_on(0)[0], last) << cells;
    last = charge.influence_on(0)[0];
  }
}

}  // namespace boltzmann::grounded_walls_test
