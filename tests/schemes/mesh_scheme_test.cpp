// Forces and energies on a mesh against sums over pairs, over images, over all periodic copies, and against work done.
#include <boltzmann/schemes/mesh/ewald.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>
#include <boltzmann/schemes/mesh/spline.hpp>
#include <tests/schemes/mesh_systems.hpp>
#include <tests/seed.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace boltzmann::mesh_scheme_test {
namespace {

using namespace boltzmann::mesh_tests;

using enum FieldBoundary;
constexpr PoissonForm both_forms[] = {PoissonForm::finite_difference, PoissonForm::spectral};

/// A particle of one's own: it has a weight besides its charge, and both make its strength.
template <int D, class Real = double>
struct Weighted : Laplace<D, Real> {
  static constexpr char const* class_name = "Weighted";

  Real charge, weight;

  Real strength() const { return charge * weight; }

  static FieldTable fields() {
    return Laplace<D, Real>::fields()
        .add(&Weighted::charge, "charge", dimensions::charge, "electric charge")
        .add(&Weighted::weight, "weight", dimensions::none, "particles that it stands for");
  }
};

template <int D>
std::vector<std::size_t> cubic(std::size_t n) {
  return std::vector<std::size_t>(D, n);
}

// ---- open space ----

/// The rms error of the force of a source on probes at 0.3 to 0.4 box lengths from it, by the mesh, over many places of
/// the source in its cell, as a part of the force.
template <int D>
double error_in_open_space(std::size_t cells, int order, PoissonForm form) {
  std::mt19937_64 random(test_seed(11));
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal;
  double errors = 0, squares = 0;
  Box const box = box_of(filled<D>(1.0), Boundary::reflecting);
  Ensemble<Coulomb<D>> source("source", 1), probes("probes", 100);
  double const tiny = 1e-9;  // probes feel the source, and nearly nothing of each other
  MeshScheme mesh(box, cubic<D>(cells), coulomb(1));
  mesh.assignment(order);
  mesh.form(form);
  mesh.add(source);
  mesh.add(probes);
  PairScheme pairs(box);
  pairs.between(probes, source, coulomb(1));
  for (int shift = 0; shift < 6; ++shift) {
    source[0].charge = 1;
    for (int a = 0; a < D; ++a) source[0].position[a] = 0.5 + 0.05 * (uniform(random) - 0.5);
    for (auto& probe : probes) {
      Vector<D> direction;
      for (int a = 0; a < D; ++a) direction[a] = normal(random);
      probe.position = source[0].position + direction * ((0.3 + 0.1 * uniform(random)) / magnitude(direction));
      probe.charge = tiny;
    }
    mesh.calculate();
    auto const by_mesh = forces(probes);
    pairs.calculate();
    auto const exact = forces(probes);
    for (std::size_t i = 0; i < exact.size(); ++i) {
      errors += norm2(by_mesh[i] - exact[i]);
      squares += norm2(exact[i]);
    }
  }
  return std::sqrt(errors / squares);
}

/// log(error) against log(cell), a straight line by least squares.
template <int D>
double slope_in_open_space(std::vector<std::size_t> const& meshes, int order, PoissonForm form, double* finest) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (auto const cells : meshes) {
    *finest = error_in_open_space<D>(cells, order, form);
    double const u = -std::log(static_cast<double>(cells)), v = std::log(*finest);
    n += 1, x += u, y += v, xx += u * u, xy += u * v;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

// The last wave of a mesh is where a spectral field is cut off: E = i k/k^2 jumps there, and the field of a point rings
// with the splines' weight at that wave, sinc(pi/2)^2p = (2/pi)^2p.
double ringing(int order) { return std::pow(2 / std::numbers::pi, 2 * order); }

// Sheets: the field of a sheet is constant, so mesh and pairs agree as soon as clouds don't overlap, but for the
// ringing, which falls with the distance in cells.
TEST(MeshInOpenSpace, Sheets) {
  for (auto const form : both_forms)
    for (int order = 1; order <= 7; ++order) {
      Ensemble<Coulomb<1>> sheets("sheets", 7);
      for (std::size_t i = 0; i < 7; ++i) {
        sheets[i].position[0] =
            -0.5 + (0.05 + 0.93 * (static_cast<double>(i * i) + 0.2 * static_cast<double>(i)) / 40) * 3;
        sheets[i].charge = 0.5 - 0.3 * static_cast<double>(i);
      }
      Box const box(Vector{-0.5}, Vector{2.5}, Boundary::open);
      MeshScheme mesh(box, {400}, coulomb(0.7));
      mesh.assignment(order);
      mesh.form(form);
      mesh.add(sheets);
      mesh.calculate();
      auto const by_mesh = forces(sheets);
      auto const of_mesh = mesh.measure();
      PairScheme pairs(box);
      pairs.internal(sheets, coulomb(0.7));
      pairs.calculate();
      EXPECT_LT(relative_error(by_mesh, forces(sheets)), (form == PoissonForm::spectral ? 0.02 : 2e-5) * ringing(order))
          << order;
      // Each cloud has an energy of its own, of the order of a cell.
      EXPECT_NEAR(of_mesh.potential, pairs.measure().potential, 0.05 * std::abs(pairs.measure().potential)) << order;
    }
}

// Differences are of second order; the nearest node is a place of first order.
TEST(MeshInOpenSpace, DifferencesAreOfSecondOrder) {
  for (int order = 1; order <= 7; ++order) {
    double error;
    EXPECT_NEAR(slope_in_open_space<2>({40, 60, 90}, order, PoissonForm::finite_difference, &error), order == 1 ? 1 : 2,
                0.25)
        << order;
    EXPECT_LT(error, order == 1 ? 0.03 : 0.005) << order;
  }
  for (int const order : {1, 2, 3, 5}) {
    double error;
    EXPECT_NEAR(slope_in_open_space<3>({24, 30, 40}, order, PoissonForm::finite_difference, &error), order == 1 ? 1 : 2,
                0.35)
        << order;
    EXPECT_LT(error, order == 1 ? 0.1 : 0.02) << order;
  }
}

// In spectral form the ringing is concentrated on the axes through a point, where in 3D it falls more slowly than the
// force itself: its rms as a part of the force doesn't fall with the cells, but with every order by (2/pi)^2.
TEST(MeshInOpenSpace, SpectralFieldsOfPointsRing) {
  double before = 0;
  for (int order = 1; order <= 7; ++order) {
    double const error = error_in_open_space<3>(32, order, PoissonForm::spectral);
    EXPECT_LT(error, (order == 1 ? 3 : 1.6) * ringing(order)) << order;
    if (order > 2) {
      EXPECT_NEAR(error / before, std::pow(2 / std::numbers::pi, 2), 0.12) << order;
    }
    before = error;
    EXPECT_LT(error_in_open_space<2>(64, order, PoissonForm::spectral), 0.4 * ringing(order)) << order;
  }
}

// ---- periodic space ----

template <int D>
double error_in_periodic_box(Vector<D> const& edges, std::size_t cells_per_length, int order, PoissonForm form,
                             double* energy_error = nullptr) {
  std::vector<std::size_t> cells;
  for (int a = 0; a < D; ++a)
    cells.push_back(static_cast<std::size_t>(std::lround(edges[a] * static_cast<double>(cells_per_length))));
  double errors = 0, squares = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    Ensemble<Coulomb<D>> charges("charges");
    scatter<D>(charges, 6, Vector<D>{}, edges, seed, 0.3);
    MeshScheme mesh(box_of(edges, Boundary::periodic), cells, coulomb(1.3));
    mesh.assignment(order);
    mesh.form(form);
    mesh.add(charges);
    mesh.calculate();
    std::vector<double> q;
    for (auto const& p : charges) q.push_back(p.charge);
    auto const exact = ewald_sums<D>(positions(charges), q, edges, coulomb(1.3).constant);
    auto const by_mesh = forces(charges);
    for (std::size_t i = 0; i < q.size(); ++i) {
      errors += norm2(by_mesh[i] - exact.force[i]);
      squares += norm2(exact.force[i]);
    }
    if (energy_error) *energy_error = mesh.measure().potential - exact.energy;
  }
  return std::sqrt(errors / squares);
}

TEST(MeshInPeriodicBox, Sheets) {
  for (auto const form : both_forms)
    for (int order = 1; order <= 7; ++order) {
      Ensemble<Coulomb<1>> sheets("sheets", 4);
      double const x[] = {0.1, 0.6, 1.1, 1.6}, q[] = {1, -2, 0.5, 3};
      for (std::size_t i = 0; i < 4; ++i) sheets[i].position[0] = x[i] + 0.0123, sheets[i].charge = q[i];
      MeshScheme mesh(box_of(Vector{2.0}, Boundary::periodic), {41}, coulomb(0.7));
      mesh.background(true);
      mesh.assignment(order);
      mesh.form(form);
      mesh.add(sheets);
      mesh.calculate();
      auto const exact =
          ewald_sums<1>(positions(sheets), std::vector<double>(q, q + 4), Vector{2.0}, coulomb(0.7).constant);
      // In differences the nearest node is all that is wrong.
      double const tolerance = order == 1 ? 0.1 : form == PoissonForm::spectral ? 0.1 * ringing(order) : 1e-12;
      EXPECT_LT(relative_error(forces(sheets), exact.force), tolerance) << order;
    }
}

TEST(MeshInPeriodicBox, AgreesWithEwaldSums) {
  for (int const order : {2, 3, 4, 5}) {
    double const coarse = error_in_periodic_box<2>({1.0, 1.5}, 32, order, PoissonForm::finite_difference);
    double const fine = error_in_periodic_box<2>({1.0, 1.5}, 64, order, PoissonForm::finite_difference);
    EXPECT_LT(fine, 0.03) << order;
    EXPECT_NEAR(std::log2(coarse / fine), 2, 0.5) << order;
    EXPECT_LT(error_in_periodic_box<2>({1.0, 1.5}, 64, order, PoissonForm::spectral), ringing(order)) << order;
  }
  EXPECT_LT(error_in_periodic_box<3>({1.0, 1.0, 0.75}, 32, 2, PoissonForm::finite_difference), 0.03);
  EXPECT_LT(error_in_periodic_box<3>({1.0, 1.0, 0.75}, 32, 6, PoissonForm::spectral), 2 * ringing(6));
}

// ---- walls ----

template <int D>
std::vector<std::array<FieldEnds, D>> walls() {
  std::vector<FieldEnds> const kinds{
      {dirichlet, dirichlet}, {neumann, neumann}, {dirichlet, neumann}, {neumann, dirichlet}, {periodic, periodic}};
  std::vector<std::array<FieldEnds, D>> all;
  std::size_t count = 1;
  for (int a = 0; a < D; ++a) count *= kinds.size();
  for (std::size_t c = 0; c + 1 < count; ++c) {
    std::array<FieldEnds, D> ends;
    std::size_t rest = c;
    for (int a = 0; a < D; ++a) {
      ends[static_cast<std::size_t>(a)] = kinds[rest % kinds.size()];
      rest /= kinds.size();
    }
    all.push_back(ends);
  }
  return all;
}

template <int D>
Box walled_box(Vector<D> const& edges, std::array<FieldEnds, D> const& ends) {
  std::array<Boundary, D> boundaries;
  for (std::size_t a = 0; a < D; ++a)
    boundaries[a] = ends[a].low == periodic ? Boundary::periodic : Boundary::reflecting;
  return Box(Vector<D>{}, edges, boundaries);
}

/// Distance from a Dirichlet end, in cells, below which a particle meets a node whose field GroundedWalls corrects.
double corrected_cells(int order) { return nodes_before(order) + 0.5 * order; }

/// Leaves out components of forces across Dirichlet ends that are so near.
template <int D>
void leave_out_corrected(std::vector<Vector<D>>& forces, Ensemble<Coulomb<D>> const& charges,
                         std::array<FieldEnds, D> const& ends, Vector<D> const& edges,
                         std::vector<std::size_t> const& cells, int order) {
  for (std::size_t i = 0; i < charges.size(); ++i)
    for (int a = 0; a < D; ++a) {
      auto const b = static_cast<std::size_t>(a);
      double const n = static_cast<double>(cells[b]), s = charges[i].position[a] / edges[a] * n;
      double const near = corrected_cells(order);
      if ((ends[b].low == dirichlet && s < near) || (ends[b].high == dirichlet && n - s < near)) forces[i][a] = 0;
    }
}

/// What a charge in the first cell has beside the force of the images on a mesh, in differences with clouds of at most two
/// cells: the charge of the half cell at the wall counts, half of it where it is the charge's own.
void add_half_cells(std::vector<Vector<1>>& forces, Ensemble<Coulomb<1>> const& charges, FieldEnds const& ends,
                    double length, std::size_t cells, int order, double C) {
  double const n = static_cast<double>(cells), h = length / n;
  for (bool const high : {false, true}) {
    if ((high ? ends.high : ends.low) != dirichlet) continue;
    // What a charge counts on the node so many cells from the wall.
    auto const weight = [&](std::size_t i, double node) {
      double const s = charges[i].position[0] / h, apart = std::abs((high ? n - s : s) - node);
      return order == 1 ? (apart < 0.5 ? 1.0 : 0.0) : std::max(0.0, 1 - apart);
    };
    double wall = 0, inside = 0;
    for (std::size_t i = 0; i < charges.size(); ++i) {
      wall += 2 * charges[i].charge * weight(i, 0);  // of half a cell
      inside += charges[i].charge * weight(i, 2);
    }
    for (std::size_t i = 0; i < charges.size(); ++i)
      forces[i][0] -= (high ? -C : C) / 4 * (wall + (order == 1 ? 0 : inside)) * charges[i].charge * weight(i, 0);
  }
}

/// A mesh with walls does what the mesh of the whole with all images does, to rounding: energies and forces, but for
/// forces beside Dirichlet ends towards them. In the spectral form charge on such ends changes all waves, so no cloud
/// reaches them here.
template <int D>
void expect_walls_are_images(std::array<FieldEnds, D> const& ends, Vector<D> const& edges,
                             std::vector<std::size_t> const& cells, int order, PoissonForm form) {
  Ensemble<Coulomb<D>> charges("charges"), whole("whole");
  scatter<D>(charges, 9, Vector<D>{}, edges, 3);
  for (std::size_t i = 0; i < charges.size(); ++i) charges[i].charge = 0.3 + 0.2 * static_cast<double>(i);
  for (int a = 0; a < D; ++a) {  // near the walls, and in the cells next to them
    charges[0].position[a] = 0.01 * edges[a];
    charges[1].position[a] = 0.985 * edges[a];
  }
  if (form == PoissonForm::spectral)
    for (auto& charge : charges)
      for (std::size_t a = 0; a < D; ++a) {
        double const cell = edges[static_cast<int>(a)] / static_cast<double>(cells[a]);
        double const low = ends[a].low == dirichlet ? 0.5 * order * cell : 0,
                     high = ends[a].high == dirichlet ? 0.5 * order * cell : 0;
        double& x = charge.position[static_cast<int>(a)];
        x = low + x * (1 - (low + high) / edges[static_cast<int>(a)]);
      }
  Mirrored<D> const images = mirrored<D>(charges, edges, ends);
  whole.resize(images.positions.size());
  for (std::size_t i = 0; i < whole.size(); ++i)
    whole[i].position = images.positions[i], whole[i].charge = images.strengths[i];
  auto many = cells;
  for (std::size_t a = 0; a < D; ++a) many[a] *= static_cast<std::size_t>(images.periods[a]);

  MeshScheme with_walls(walled_box<D>(edges, ends), cells, coulomb(0.8));
  MeshScheme with_images(box_of(images.edges, Boundary::periodic), many, coulomb(0.8));
  for (int a = 0; a < D; ++a)
    with_walls.boundary(a, ends[static_cast<std::size_t>(a)].low, ends[static_cast<std::size_t>(a)].high);
  bool closed = true;
  for (auto const& end : ends) closed = closed && end.low != dirichlet && end.high != dirichlet;
  for (auto* mesh : {&with_walls, &with_images}) {
    mesh->assignment(order);
    mesh->form(form);
  }
  with_images.background(true);
  if (closed) with_walls.background(true);
  with_walls.add(charges);
  with_images.add(whole);
  with_walls.calculate();
  with_images.calculate();
  auto exact = forces(whole), ours = forces(charges);
  exact.resize(charges.size());
  bool known = false;  // across grounded ends, too
  if constexpr (D == 1)
    if (known = order <= 2 && form == PoissonForm::finite_difference; known)
      add_half_cells(exact, charges, ends[0], edges[0], cells[0], order, with_walls.constant());
  if (!known)
    for (auto* some : {&exact, &ours}) {
      leave_out_corrected<D>(*some, charges, ends, edges, cells, order);
      if (form == PoissonForm::spectral)  // charges far from walls correct the field across them
        for (auto& force : *some)
          for (std::size_t a = 0; a < D; ++a)
            if (order > 2 && (ends[a].low == dirichlet || ends[a].high == dirichlet)) force[static_cast<int>(a)] = 0;
    }
  std::string name = std::to_string(order);
  for (auto const& end : ends)
    name.append(" ").append(std::to_string(int(end.low))).append(std::to_string(int(end.high)));
  double largest = 0;
  for (auto const& force : exact) largest = std::max(largest, norm2(force));
  if (largest > 0) {
    EXPECT_LT(relative_error(ours, exact), 1e-11) << name;
  }
  auto const a = with_walls.measure(), b = with_images.measure();
  double scale = 0;
  for (double const e : b.per_particle[0]) scale += std::abs(e);
  EXPECT_NEAR(a.potential * static_cast<double>(images.copies), b.potential, 1e-11 * scale) << name;
}

TEST(MeshWalls, AreImages) {
  for (auto const form : both_forms)
    for (int order = 1; order <= 7; ++order) {
      for (auto const& ends : walls<1>()) expect_walls_are_images<1>(ends, {1.7}, {12}, order, form);
      for (auto const& ends : walls<2>()) expect_walls_are_images<2>(ends, {1.7, 1.1}, {9, 8}, order, form);
    }
  auto const three = walls<3>();
  for (std::size_t i = 0; i < three.size(); i += 5)
    expect_walls_are_images<3>(three[i], {1.7, 1.1, 1.3}, {7, 6, 8}, 1 + static_cast<int>(i / 5) % 5,
                               both_forms[i % 2]);
  // Fewer cells than a cloud is wide.
  for (auto const& ends : walls<1>()) expect_walls_are_images<1>(ends, {1.7}, {2}, 7, PoissonForm::finite_difference);
}

/// And images summed without a mesh.
template <int D>
double error_between_walls(std::array<FieldEnds, D> const& ends, Vector<D> const& edges,
                           std::vector<std::size_t> const& cells, int order) {
  Ensemble<Coulomb<D>> charges("charges");
  scatter<D>(charges, 5, edges * 0.15, edges * 0.85, 5, 0.13);
  Mirrored<D> const images = mirrored<D>(charges, edges, ends);
  MeshScheme mesh(walled_box<D>(edges, ends), cells, coulomb(0.8));
  for (int a = 0; a < D; ++a)
    mesh.boundary(a, ends[static_cast<std::size_t>(a)].low, ends[static_cast<std::size_t>(a)].high);
  mesh.assignment(order);
  mesh.form(order > 2 ? PoissonForm::spectral : PoissonForm::finite_difference);
  mesh.background(std::all_of(ends.begin(), ends.end(),
                              [](auto const& end) { return end.low != dirichlet && end.high != dirichlet; }));
  mesh.add(charges);
  mesh.calculate();
  auto exact = ewald_sums<D>(images.positions, images.strengths, images.edges, coulomb(0.8).constant).force;
  exact.resize(charges.size());
  return relative_error(forces(charges), exact);
}

TEST(MeshWalls, AgreeWithSumsOverImages) {
  for (auto const& ends : walls<1>()) EXPECT_LT(error_between_walls<1>(ends, {1.7}, {200}, 2), 1e-11);
  for (auto const& ends : walls<2>()) {
    EXPECT_LT(error_between_walls<2>(ends, {1.7, 1.1}, {170, 110}, 2), 0.004);
    EXPECT_LT(error_between_walls<2>(ends, {1.7, 1.1}, {51, 33}, 5), 0.004);
  }
  for (auto const& ends :
       {std::array<FieldEnds, 3>{{{dirichlet, dirichlet}, {dirichlet, dirichlet}, {dirichlet, dirichlet}}},
        {{{neumann, neumann}, {neumann, neumann}, {neumann, neumann}}},
        {{{dirichlet, neumann}, {periodic, periodic}, {neumann, neumann}}}})
    EXPECT_LT(error_between_walls<3>(ends, {1.2, 1.1, 1.3}, {36, 33, 39}, 6), 3 * ringing(6));
}

// A charge between two planes with empty space beside it: images in both, for ever.
TEST(MeshWalls, OpenBesideAWall) {
  Ensemble<Coulomb<2>> charge("charge", 1);
  charge[0].position = {0.31, 2.05};
  charge[0].charge = 1.5;
  for (auto const wall : {dirichlet, neumann}) {
    MeshScheme mesh(Box(Vector{0.0, 0.0}, Vector{4.0, 4.0}, Boundary::reflecting), {160, 160}, coulomb(1));
    mesh.boundary(0, wall, dirichlet);
    mesh.assignment(3);
    mesh.add(charge);
    mesh.calculate();
    // Images in both walls, 8 apart.
    double force = 0;
    for (int n = -200; n <= 200; ++n) {
      double const sign = wall == dirichlet ? 1 : n % 2 == 0 ? 1 : -1;
      if (n != 0) force += sign * 2 * 1.5 * 1.5 / (-8.0 * n);
      force += (wall == dirichlet ? -1 : 1) * sign * 2 * 1.5 * 1.5 / (0.62 - 8.0 * n);
    }
    EXPECT_NEAR(charge.influence_on(0)[0], force, 0.005 * std::abs(force));
    EXPECT_NEAR(charge.influence_on(0)[1], 0, 0.002 * std::abs(force));
  }
}

// ---- classes ----

TEST(MeshClasses, AnyClassWithAStrength) {
  auto const edges = filled<3>(1.0);
  Ensemble<Coulomb<3>> ions("ions");
  Ensemble<Weighted<3>> own("own", 3);
  scatter<3>(ions, 3, Vector<3>{}, edges, 21, 0.3);
  double const x[3][3] = {{0.1, 0.15, 0.8}, {0.9, 0.5, 0.3}, {0.45, 0.9, 0.55}};
  for (std::size_t i = 0; i < 3; ++i) {
    own[i].position = {x[i][0], x[i][1], x[i][2]};
    own[i].charge = i == 1 ? 0.5 : -0.25;
    own[i].weight = static_cast<double>(i + 2);
  }
  MeshScheme mesh(box_of(edges, Boundary::periodic), {32, 32, 32}, coulomb(1));
  mesh.background(true);
  mesh.assignment(4);
  mesh.form(PoissonForm::spectral);
  mesh.add(ions);
  mesh.add(own);
  mesh.calculate();
  auto all = positions(ions);
  std::vector<double> strengths{1, -1, 1};
  for (auto const& p : own) all.push_back(p.position), strengths.push_back(p.charge * p.weight);
  EXPECT_EQ(mesh.strengths(own), (std::vector<double>{-0.5, 1.5, -1.0}));
  auto const exact = ewald_sums<3>(all, strengths, edges, 4 * std::numbers::pi);
  auto both = forces(ions);
  for (auto const& f : forces(own)) both.push_back(f);
  EXPECT_LT(relative_error(both, exact.force), 0.02);
  EXPECT_EQ(mesh.ensembles().size(), 2U);
}

TEST(MeshClasses, GravityAttracts) {
  Ensemble<Kepler<3>> stars("stars", 2);
  stars[0].position = {0.3, 0.5, 0.5};
  stars[1].position = {0.7, 0.5, 0.5};
  stars[0].mass = 2;
  stars[1].mass = 3;
  MeshScheme open(box_of(filled<3>(1.0), Boundary::open), {40, 40, 40}, gravity(0.5));
  open.add(stars);
  open.assignment(3);
  open.calculate();
  EXPECT_NEAR(stars.influence_on(0)[0], 0.5 * 6 / 0.16, 0.01 * 0.5 * 6 / 0.16);
  EXPECT_NEAR(stars.influence_on(1)[0], -0.5 * 6 / 0.16, 0.01 * 0.5 * 6 / 0.16);
  EXPECT_LT(open.measure().potential, 0);

  MeshScheme periodic_box(box_of(filled<3>(1.0), Boundary::periodic), {40, 40, 40}, gravity(0.5));
  periodic_box.add(stars);
  periodic_box.assignment(3);
  EXPECT_TRUE(has(failure([&] { periodic_box.calculate(); }), "background(true)"));
  periodic_box.background(true);
  periodic_box.calculate();
  auto const exact = ewald_sums<3>(positions(stars), std::vector{2.0, 3.0}, filled<3>(1.0), gravity(0.5).constant);
  EXPECT_GT(exact.force[0][0], 0);
  EXPECT_LT(relative_error(forces(stars), exact.force), 0.01);
}

// ---- momentum ----

template <int D>
void expect_no_total_force(Boundary boundary, PoissonForm form, int order) {
  Ensemble<Coulomb<D>> charges("charges");
  Vector<D> edges;
  std::vector<std::size_t> cells;
  for (int a = 0; a < D; ++a) edges[a] = 1 + 0.3 * a, cells.push_back(D == 3 ? 10U : 16U);
  scatter<D>(charges, 41, edges * 0.15, edges * 0.85, 31);
  MeshScheme mesh(box_of(edges, boundary), cells, coulomb(1));
  mesh.background(boundary == Boundary::periodic);
  mesh.assignment(order);
  mesh.form(form);
  mesh.add(charges);
  mesh.calculate();
  Vector<D> total{};
  for (auto const& f : forces(charges)) total += f;
  EXPECT_LT(magnitude(total), 1e-11 * rms(forces(charges))) << D << "D, order " << order;
  // Nobody pushes itself.
  charges.resize(1);
  charges[0].position = edges * 0.437;
  mesh.calculate();
  EXPECT_LT(rms(forces(charges)), 1e-11) << D << "D, order " << order;
}

TEST(MeshMomentum, ForcesSumToZero) {
  for (auto const boundary : {Boundary::periodic, Boundary::open})
    for (auto const form : both_forms)
      for (int order = 1; order <= 7; ++order) {
        expect_no_total_force<1>(boundary, form, order);
        expect_no_total_force<2>(boundary, form, order);
        if (order < 5) expect_no_total_force<3>(boundary, form, order);
      }
}

// ---- energy ----

// A charge carried slowly past others: what the forces do is what the energy loses.
TEST(MeshEnergy, IsTheWorkDone) {
  for (auto const boundary : {Boundary::periodic, Boundary::open, Boundary::reflecting}) {
    Ensemble<Coulomb<2>> charges("charges", 3);
    charges[0].position = {0.25, 0.4};
    charges[1].position = {0.7, 0.75};
    charges[0].charge = 1, charges[1].charge = 1.5, charges[2].charge = -2;
    MeshScheme mesh(box_of(filled<2>(1.0), boundary), {96, 96}, coulomb(1));
    mesh.background(true);
    mesh.assignment(3);
    if (boundary == Boundary::reflecting) {
      mesh.boundary(0, dirichlet, neumann);
      mesh.boundary(1, open);
    }
    mesh.add(charges);
    auto const energy_at = [&](double s) {
      charges[2].position = {0.35 + 0.5 * s,
                             0.62 - 0.3125 * s};  // whole cells: its own energy at both ends is the same
      return mesh.measure().potential;
    };
    double work = 0, least = 1e300, most = -1e300;
    double const start = energy_at(0);
    int const steps = 200;
    for (int i = 0; i <= steps; ++i) {
      double const e = energy_at(double(i) / steps);
      least = std::min(least, e), most = std::max(most, e);
      mesh.calculate();
      double const force = charges.influence_on(2)[0] * 0.5 - charges.influence_on(2)[1] * 0.3125;
      work += force / steps * (i == 0 || i == steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) / 3;
    }
    EXPECT_NEAR(work, start - energy_at(1), 0.005 * (most - least)) << to_string(boundary);
    EXPECT_GT(std::abs(work), 0.1 * (most - least));
  }
}

// The energy of a pair is that of the law, once the clouds' own energies are taken off.
TEST(MeshEnergy, OfAPairInOpenSpace) {
  Ensemble<Coulomb<3>> pair("pair", 2);
  pair[0].position = {0.303, 0.5, 0.41};
  pair[1].position = {0.703, 0.52, 0.61};
  pair[0].charge = 2;
  pair[1].charge = -3;
  MeshScheme mesh(box_of(filled<3>(1.0), Boundary::open), {32, 32, 32}, coulomb(0.5));
  mesh.assignment(3);
  mesh.form(PoissonForm::spectral);
  mesh.add(pair);
  double const together = mesh.measure().potential;
  auto const parts = mesh.measure().per_particle;
  EXPECT_NEAR(parts[0][0] + parts[0][1], together, 1e-12 * std::abs(together));
  pair[1].charge = 0;
  double const first = mesh.measure().potential;
  pair[1].charge = -3, pair[0].charge = 0;
  double const second = mesh.measure().potential;
  double const exact = -0.5 * 6 / magnitude(pair[1].position - pair[0].position);
  EXPECT_NEAR(together - first - second, exact, 0.003 * std::abs(exact));
}

// Box and particles larger by a factor: the energy changes by the virial. Odd numbers of cells have no wave without a
// derivative, so that this holds to rounding in spectral form.
template <int D>
void expect_virial(std::vector<std::size_t> const& cells) {
  Vector<D> edges;
  for (int a = 0; a < D; ++a) edges[a] = 1 + 0.4 * a;
  auto const energy = [&](Vector<D> const& scale, std::array<std::array<double, 3>, 3>* virial) {
    Ensemble<Coulomb<D>> charges("charges");
    scatter<D>(charges, 12, Vector<D>{}, edges, 41);
    Vector<D> scaled = edges;
    for (int a = 0; a < D; ++a) {
      scaled[a] *= scale[a];
      for (auto& p : charges) p.position[a] *= scale[a];
    }
    MeshScheme mesh(box_of(scaled, Boundary::periodic), cells, coulomb(1));
    mesh.form(PoissonForm::spectral);
    mesh.add(charges);
    auto const measures = mesh.measure();
    if (virial) *virial = measures.virial;
    return measures.potential;
  };
  std::array<std::array<double, 3>, 3> virial;
  double const e = energy(filled<D>(1.0), &virial);
  for (int a = 0; a < D; ++a) {
    auto up = filled<D>(1.0), down = filled<D>(1.0);
    up[a] += 1e-4, down[a] -= 1e-4;
    EXPECT_NEAR(virial[a][a], -(energy(up, nullptr) - energy(down, nullptr)) / 2e-4, 1e-6 * std::abs(e)) << D;
    for (int b = 0; b < D; ++b) EXPECT_NEAR(virial[a][b], virial[b][a], 1e-12 * std::abs(e));
  }
}

TEST(MeshEnergy, VirialIsTheChangeWithTheBox) {
  expect_virial<1>({15});
  expect_virial<2>({15, 17});
  expect_virial<3>({9, 11, 13});
  // Only a periodic field's own stress is the whole story.
  Ensemble<Coulomb<1>> charges("charges", 2);
  charges[1].position[0] = 0.5;
  charges[0].charge = 1;
  MeshScheme mesh(box_of(Vector{1.0}, Boundary::open), {8}, coulomb(1));
  mesh.add(charges);
  EXPECT_TRUE(std::isnan(mesh.measure().virial[0][0]));
  EXPECT_EQ(mesh.measure().no_virial, "axis x is not periodic: the field of a mesh continues beyond its ends");
}

// ---- bits ----

template <int D>
void expect_same_bits(int order, Boundary boundary) {
  std::size_t const count = 50001;
  Vector<D> const edges = filled<D>(1.0);
  auto const run = [&](int threads, bool turned) {
    Ensemble<Coulomb<D>> charges("charges");
    scatter<D>(charges, count, Vector<D>{}, edges, 51);
    if (turned) std::reverse(charges.begin(), charges.end());
    MeshScheme mesh(box_of(edges, boundary), cubic<D>(D == 3 ? 12 : 20), coulomb(1));
    mesh.background(true);
    mesh.assignment(order);
    mesh.add(charges);
    mesh.threads(threads);
    mesh.calculate();
    mesh.calculate();
    auto all = forces(charges);
    if (turned) std::reverse(all.begin(), all.end());
    return all;
  };
  auto const one = run(1, false);
  for (int const threads : {2, 3, 7}) {
    auto const more = run(threads, false);
    EXPECT_EQ(std::memcmp(one.data(), more.data(), sizeof(one[0]) * count), 0) << D << " " << threads;
  }
  auto const turned = run(2, true);
  EXPECT_EQ(std::memcmp(one.data(), turned.data(), sizeof(one[0]) * count), 0) << D;
}

TEST(MeshBits, AreTheSameForAnyThreadsAndOrder) {
  expect_same_bits<1>(2, Boundary::periodic);
  expect_same_bits<2>(3, Boundary::reflecting);
  expect_same_bits<3>(2, Boundary::periodic);
  expect_same_bits<3>(5, Boundary::open);
}

// ---- where there is none ----

TEST(MeshBoxes, HaveNoMirrors) {
  Box const mirrored(Vector{0.0, 0.0}, Vector{1.0, 1.0}, {Boundary::periodic, Boundary::mirror});
  EXPECT_TRUE(
      has(failure([&] {
            MeshScheme(mirrored, {8, 8}, coulomb(1));
          }),
          "mesh: axis y is a mirror: particles on a mesh need a reflecting, periodic or open axis there (mirrors "
          "are for smooth particles)"));
}

// ---- few and none ----

TEST(MeshOfFew, NoneOneAndTwo) {
  Ensemble<Coulomb<2>> charges("charges");
  MeshScheme mesh(box_of(filled<2>(1.0), Boundary::periodic), {8, 8}, coulomb(1));
  mesh.calculate();  // no ensemble at all
  mesh.add(charges);
  mesh.calculate();
  EXPECT_EQ(mesh.measure().potential, 0);
  charges.resize(1);
  charges[0].position = {0.3, 0.3};
  EXPECT_TRUE(has(failure([&] { mesh.calculate(); }), "no failure"));  // without charge: neutral
  charges[0].charge = 1;
  EXPECT_TRUE(has(failure([&] { mesh.calculate(); }), "sum to 1"));
  charges.resize(2);
  charges[1].position = {0.3, 0.3};
  charges[1].charge = -1;
  mesh.calculate();  // at one place: they cancel
  EXPECT_LT(rms(forces(charges)), 1e-12);
  charges[1].position = {1.0, 0.8};  // on the edge
  mesh.calculate();
  EXPECT_GT(rms(forces(charges)), 0.1);
}

}  // namespace
}  // namespace boltzmann::mesh_scheme_test
