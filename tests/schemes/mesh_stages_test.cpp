// The stages of a mesh and what users put in their place; backgrounds, other integrators, mistakes, and advice.
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>
#include <tests/schemes/mesh_systems.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace boltzmann::mesh_stages_test {
namespace {

using namespace boltzmann::mesh_tests;

// ---- stages ----

TEST(MeshStages, AnAssignmentThatCounts) {
  Ensemble<Coulomb<2>> charges("charges");
  scatter<2>(charges, 50, Vector<2>{}, filled<2>(1.0), 1);
  MeshScheme mesh(box_of(filled<2>(1.0), Boundary::periodic), {12, 14}, coulomb(1)),
      plain(mesh.box(), {12, 14}, coulomb(1));
  plain.add(charges);
  plain.calculate();
  auto const expected = forces(charges);
  int calls = 0;
  mesh.add(charges);
  mesh.density_assignment([&](MeshScheme& scheme, MeshField& density) {
    ++calls;
    scheme.assign_density(density);
  });
  mesh.calculate();
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(std::memcmp(expected.data(), forces(charges).data(), 50 * sizeof(Vector<2>)), 0);
  mesh.measure();
  EXPECT_EQ(calls, 2);
  auto const fields = mesh.mesh_fields();
  EXPECT_EQ(calls, 3);
  // Twice the density: twice the field.
  mesh.density_assignment([&](MeshScheme& scheme, MeshField& density) {
    scheme.assign_density(density);
    for (double& rho : density.components[0]) rho *= 2;
  });
  mesh.calculate();
  EXPECT_NEAR(charges.influence_on(7)[1], 2 * expected[7][1], 1e-11 * rms(expected));
  mesh.density_assignment({});
  mesh.calculate();
  EXPECT_EQ(std::memcmp(expected.data(), forces(charges).data(), 50 * sizeof(Vector<2>)), 0);
}

// Successive over-relaxation of the three-point Laplacian, between two conductors: the same equation as the
// transform's.
TEST(MeshStages, APotentialByRelaxation) {
  Ensemble<Coulomb<1>> charges("charges");
  scatter<1>(charges, 9, Vector{-1.0}, Vector{1.0}, 2);
  MeshScheme mesh(Box(Vector{-1.0}, Vector{1.0}, Boundary::reflecting), {24}, coulomb(0.3));
  mesh.boundary(0, FieldBoundary::dirichlet);
  mesh.add(charges);
  mesh.calculate();
  auto const expected = forces(charges);
  double const energy = mesh.measure().potential;
  int sweeps = 0;
  mesh.potential_calculation([&](MeshScheme& scheme, MeshField const& density, MeshField& potential) {
    std::size_t const n = density.grid.nodes[0];
    double const h2 = density.grid.spacing[0] * density.grid.spacing[0];
    auto& phi = potential.components[0];
    std::fill(phi.begin(), phi.end(), 0.0);
    for (double change = 1; change > 1e-15; ++sweeps) {
      change = 0;
      for (std::size_t i = 1; i + 1 < n; ++i) {
        double const next = 0.5 * (phi[i - 1] + phi[i + 1] + h2 * scheme.constant() * density.at(i));
        change = std::max(change, std::abs(next - phi[i]));
        phi[i] += 1.77 * (next - phi[i]);
      }
    }
  });
  mesh.calculate();
  EXPECT_GT(sweeps, 20);
  EXPECT_LT(relative_error(forces(charges), expected), 1e-11);
  EXPECT_NEAR(mesh.measure().potential, energy, 1e-11 * std::abs(energy));
}

// A difference of fourth order: (8 (phi_+1 - phi_-1) - (phi_+2 - phi_-2)) / 12 h gives a sine wave the factor
// (8 sin kh - sin 2kh) / 6kh.
TEST(MeshStages, AFieldOfFourthOrder) {
  std::size_t const n = 16;
  double const k = 2 * std::numbers::pi, h = 1.0 / static_cast<double>(n);
  Ensemble<Coulomb<2>> charges("charges", 40);
  for (std::size_t i = 0; i < 40; ++i)
    charges[i].position = {0.025 * static_cast<double>(i), 0.37}, charges[i].charge = 1;
  MeshScheme mesh(box_of(filled<2>(1.0), Boundary::periodic), {n, n}, coulomb(1));
  mesh.background(true);
  mesh.assignment(1);
  mesh.potential_calculation([&](MeshScheme&, MeshField const& density, MeshField& potential) {
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i) potential.at(i, j) = std::cos(k * density.grid.position(0, i));
  });
  mesh.add(charges);
  auto const factor_of = [&] {
    mesh.calculate();
    double most = 0;
    for (auto const& f : forces(charges)) {
      most = std::max(most, std::abs(f[0]));
      EXPECT_NEAR(f[1], 0, 1e-12);
    }
    return most / k;
  };
  EXPECT_NEAR(factor_of(), std::sin(k * h) / (k * h), 1e-12);
  mesh.influence_field([&](MeshScheme&, MeshField const& potential, MeshField& field) {
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i) {
        auto const x = [&](std::size_t d) { return potential.at((i + d) % n, j); };
        auto const y = [&](std::size_t d) { return potential.at(i, (j + d) % n); };
        std::size_t const at = field.grid.index(i, j);
        field.components[0][at] = -(8 * (x(1) - x(n - 1)) - (x(2) - x(n - 2))) / (12 * h);
        field.components[1][at] = -(8 * (y(1) - y(n - 1)) - (y(2) - y(n - 2))) / (12 * h);
      }
  });
  EXPECT_NEAR(factor_of(), (8 * std::sin(k * h) - std::sin(2 * k * h)) / (6 * k * h), 1e-12);
}

TEST(MeshStages, AnInterpolationFromTheNearestNode) {
  Ensemble<Coulomb<2>> charges("charges"), others("others");
  scatter<2>(charges, 30, Vector<2>{}, filled<2>(1.0), 3);
  scatter<2>(others, 10, Vector<2>{}, filled<2>(1.0), 4);
  MeshScheme mesh(box_of(filled<2>(1.0), Boundary::periodic), {10, 10}, coulomb(1));
  mesh.add(charges);
  mesh.add(others);
  mesh.interpolation([](MeshScheme&, MeshField const& field, AnyEnsemble const& ensemble, std::vector<double>& E) {
    E.resize(ensemble.size() * 2);
    for (std::size_t i = 0; i < ensemble.size(); ++i) {
      std::size_t node[2];
      for (int a = 0; a < 2; ++a)
        node[a] = static_cast<std::size_t>(std::floor(ensemble.row(i)[a] / field.grid.spacing[a] + 0.5)) % 10;
      for (std::size_t c = 0; c < 2; ++c) E[2 * i + c] = field.components[c][field.grid.index(node[0], node[1])];
    }
  });
  mesh.calculate();
  auto const own = forces(charges);
  // The same by hand from the fields that the mesh shows.
  MeshField const field = *mesh.mesh_fields()[2];
  for (std::size_t i = 0; i < 30; ++i) {
    auto const node = [&](int a) { return static_cast<std::size_t>(std::lround(charges[i].position[a] * 10)) % 10; };
    EXPECT_NEAR(own[i][0], charges[i].charge * field.components[0][field.grid.index(node(0), node(1))], 1e-12);
  }
  // And what the mesh itself does, through a stage.
  mesh.interpolation([](MeshScheme& scheme, MeshField const& f, AnyEnsemble const& ensemble, std::vector<double>& E) {
    scheme.interpolate(f, ensemble, E);
  });
  mesh.calculate();
  auto const through = forces(charges);
  mesh.interpolation({});
  mesh.calculate();
  EXPECT_LT(relative_error(through, forces(charges)), 1e-14);
  EXPECT_GT(relative_error(own, forces(charges)), 0.01);
}

TEST(MeshStages, WrongSizesAreRefused) {
  Ensemble<Coulomb<2>> charges("charges"), stranger("stranger", 1);
  scatter<2>(charges, 4, Vector<2>{}, filled<2>(1.0), 5);
  auto const with = [&](auto const& set) {
    MeshScheme mesh(box_of(filled<2>(1.0), Boundary::periodic), {8, 8}, coulomb(1));
    mesh.add(charges);
    set(mesh);
    return failure([&] {
      mesh.calculate();
      mesh.measure();
    });
  };
  EXPECT_EQ(with([](MeshScheme&) {}), "no failure");
  EXPECT_TRUE(has(with([](MeshScheme& m) {
                    m.density_assignment([](MeshScheme&, MeshField& density) { density.components[0].resize(63); });
                  }),
                  "the density has 63 numbers, the mesh 64 nodes"));
  EXPECT_TRUE(has(with([](MeshScheme& m) {
                    m.potential_calculation(
                        [](MeshScheme&, MeshField const&, MeshField& potential) { potential.components[0].resize(1); });
                    m.influence_field([](MeshScheme&, MeshField const&, MeshField&) {});
                  }),
                  "the potential has 1 numbers, the mesh 64 nodes"));
  EXPECT_TRUE(has(with([](MeshScheme& m) {
                    m.influence_field([](MeshScheme&, MeshField const&, MeshField& f) { f.components[1].clear(); });
                  }),
                  "the field has 0 numbers, the mesh 64 nodes"));
  EXPECT_TRUE(has(with([](MeshScheme& m) {
                    m.influence_field([](MeshScheme&, MeshField const&, MeshField& f) { f.components.resize(1); });
                  }),
                  "the field has 1 components; it needs 2"));
  EXPECT_TRUE(has(with([](MeshScheme& m) {
                    m.interpolation(
                        [](MeshScheme&, MeshField const&, AnyEnsemble const&, std::vector<double>& E) { E.resize(7); });
                  }),
                  "the interpolation gave 7 numbers for 4 particles of 2 dimensions"));
  MeshScheme mesh(box_of(filled<2>(1.0), Boundary::periodic), {8, 8}, coulomb(1));
  mesh.add(charges);
  EXPECT_TRUE(has(failure([&] { mesh.strengths(stranger); }), "'stranger' is not loaded"));
  std::vector<double> E;
  MeshField const field = *mesh.mesh_fields()[2];
  EXPECT_TRUE(has(failure([&] { mesh.interpolate(field, stranger, E); }), "'stranger' is not loaded"));
}

// ---- backgrounds ----

// The field of a uniform background alone is exact in differences: E = 0 in the middle, and with grounded ends
// phi = (C rho/2) (L^2/4 - x^2).
TEST(MeshBackground, Slab) {
  double const L = 2, C = coulomb(0.5).constant;
  for (auto const walls : {FieldBoundary::dirichlet, FieldBoundary::open, FieldBoundary::neumann})
    for (int order = 1; order <= 4; ++order) {
      Ensemble<Coulomb<1>> charge("charge", 1);
      charge[0].charge = 3;
      MeshScheme mesh(Box(Vector{-1.0}, Vector{1.0}, Boundary::reflecting), {40}, coulomb(0.5));
      mesh.boundary(0, walls, walls == FieldBoundary::neumann ? FieldBoundary::dirichlet : walls);
      mesh.background(true);
      mesh.assignment(order);
      mesh.add(charge);
      mesh.density_assignment(
          [](MeshScheme& scheme, MeshField& density) { density.components[0].assign(scheme.grid().size(), 0.0); });
      auto const fields = mesh.mesh_fields();
      double const rho = -3 / L, from = walls == FieldBoundary::neumann ? -1 : 0;
      std::size_t const middle = fields[0]->grid.nodes[0] / 2;
      for (std::size_t i = 0; i < fields[0]->grid.nodes[0]; ++i) {
        double const x = fields[0]->grid.position(0, i);
        if (x < -1 + 0.026 || x > 1 - 0.026) continue;
        double const tolerance = walls == FieldBoundary::open ? 2e-3 : 1e-12;  // open: not by differences
        EXPECT_NEAR(fields[2]->at(i), C * rho * (x - from), tolerance * std::abs(C * rho)) << x;
        double const phi = fields[1]->at(i) - (walls == FieldBoundary::open ? fields[1]->at(middle) : 0);
        double const x0 = fields[0]->grid.position(0, middle);
        double const exact = walls == FieldBoundary::dirichlet ? C * rho / 2 * (1 - x * x)
                             : walls == FieldBoundary::open    ? -C * rho / 2 * (x * x - x0 * x0)
                                                               : C * rho / 2 * (4 - (x + 1) * (x + 1));
        EXPECT_NEAR(phi, exact, tolerance * std::abs(C * rho)) << x;
      }
    }
}

// An electron in its background between walls: a harmonic oscillation with C q^2 / (m L), and its energy.
TEST(MeshBackground, OscillatingElectron) {
  double const L = 2, C = coulomb(0.5).constant;
  for (auto const walls : {FieldBoundary::open, FieldBoundary::dirichlet}) {
    Ensemble<Coulomb<1>> electron("electron", 1);
    electron[0].charge = -1;
    electron[0].mass = 4;
    electron[0].position[0] = 0.6;
    MeshScheme mesh(Box(Vector{-1.0}, Vector{1.0}, Boundary::reflecting), {400}, coulomb(0.5));
    mesh.boundary(0, walls);
    mesh.background(true);
    mesh.assignment(3);
    mesh.add(electron);
    // Between conductors its images pull it out: a sheet at x has the force C q^2 x / L from them, all that the
    // background has. The two cancel, and it stays.
    double const wc2 = walls == FieldBoundary::open ? C / (4 * L) : 0;
    double const period = 2 * std::numbers::pi / std::sqrt(C / (4 * L));
    int const steps = 400;
    Simulation simulation(mesh, period / steps);
    simulation.integrate(electron, Method::leap_frog);
    simulation.check();
    auto const energy = [&] { return mesh.measure().potential + 2 * norm2(electron[0].velocity); };
    double const start = energy();
    double kinetic = 0;
    for (int n = 1; n <= 8; ++n) {
      simulation.run(steps / 8);
      double const w = 2 / simulation.step_size() * std::asin(std::sqrt(wc2) * simulation.step_size() / 2);
      EXPECT_NEAR(electron[0].position[0], 0.6 * std::cos(w * simulation.time()), 0.003) << n;
      EXPECT_NEAR(energy(), start, 0.01 * 0.5 * C / L * 0.36) << n;
      kinetic = std::max(kinetic, 2 * norm2(electron[0].velocity));
    }
    if (wc2 > 0) {
      EXPECT_NEAR(kinetic, 0.5 * C / L * 0.36, 0.01 * 0.5 * C / L * 0.36);
    }
  }
}

// ---- integrators ----

TEST(MeshIntegrators, ReversibleToTheLastBit) {
  for (auto const boundary : {Boundary::periodic, Boundary::reflecting}) {
    Ensemble<Coulomb<2>> charges("charges");
    scatter<2>(charges, 9000, Vector<2>{}, filled<2>(1.0), 7);
    for (std::size_t i = 0; i < charges.size(); ++i) {
      charges[i].charge *= 1e-3;
      charges[i].mass = 1e-3 * (1 + static_cast<double>(i % 3));
      charges[i].velocity = {0.3 * std::sin(static_cast<double>(i)), 0.2 * std::cos(2.0 * static_cast<double>(i))};
    }
    MeshScheme mesh(box_of(filled<2>(1.0), boundary), {16, 16}, coulomb(1));
    if (boundary == Boundary::reflecting) mesh.boundary(0, FieldBoundary::dirichlet, FieldBoundary::neumann);
    mesh.add(charges);
    mesh.threads(3);
    Simulation simulation(mesh, 0.01);
    simulation.integrate(charges, Method::reversible_leap_frog);
    simulation.check();
    auto const start = bits(charges);
    simulation.run(40);
    auto const there = bits(charges);
    EXPECT_FALSE(there == start);
    mesh.threads(2);
    simulation.rewind(40);
    EXPECT_TRUE(bits(charges) == start);
    simulation.threads(1);
    simulation.run(40);
    EXPECT_TRUE(bits(charges) == there);
  }
}

// RK4 on a mesh: with four times the steps the error is 256 times smaller, in a smooth field.
TEST(MeshIntegrators, RungeKutta) {
  auto const at_end = [](std::uint64_t steps, Method method) {
    Ensemble<Coulomb<1>> sheets("sheets", 1);
    sheets[0].position[0] = 0.3;
    sheets[0].velocity[0] = 0.2;
    sheets[0].charge = 1;
    MeshScheme mesh(Box(Vector{-1.0}, Vector{1.0}, Boundary::reflecting), {10}, coulomb(1));
    mesh.background(true);
    mesh.assignment(2);
    mesh.add(sheets);
    // The exact field of the background on the nodes: linear, so that the mesh gives a harmonic oscillator.
    mesh.influence_field([](MeshScheme&, MeshField const&, MeshField& field) {
      for (std::size_t i = 0; i < field.grid.nodes[0]; ++i) field.at(i) = -field.grid.position(0, i);
    });
    Simulation simulation(mesh, 4.0 / static_cast<double>(steps));
    simulation.integrate(sheets, method);
    simulation.run(steps);
    return std::hypot(sheets[0].position[0] - (0.3 * std::cos(4.0) + 0.2 * std::sin(4.0)),
                      sheets[0].velocity[0] - (0.2 * std::cos(4.0) - 0.3 * std::sin(4.0)));
  };
  EXPECT_NEAR(std::log2(at_end(20, Method::rk4) / at_end(80, Method::rk4)) / 2, 4, 0.2);
  EXPECT_NEAR(std::log2(at_end(20, Method::leap_frog) / at_end(80, Method::leap_frog)) / 2, 2, 0.2);
  EXPECT_LT(at_end(80, Method::rk4), 3e-6);
}

// ---- mistakes ----

TEST(MeshMistakes, AreOneLine) {
  auto const box = box_of(filled<2>(1.0), Boundary::periodic);
  auto const made = [](Box const& b, std::vector<std::size_t> const& cells, LaplaceLaw const& law) {
    return failure([&] { MeshScheme(b, cells, law); });
  };
  EXPECT_TRUE(has(made(box, {8, 8}, coulomb(1, 0.1)), "softening of 0.1"));
  EXPECT_TRUE(has(made(box, {8, 8}, coulomb(0)), "constant of the law is 0"));
  EXPECT_TRUE(has(made(box, {8, 8}, coulomb(std::nan(""))), "constant"));
  EXPECT_TRUE(has(made(box, {8}, coulomb(1)), "1 numbers of cells for 2 axes"));
  EXPECT_TRUE(has(made(box, {8, 0}, coulomb(1)), "axis y has no cells"));
  Box walled = box;
  walled.install(Vector<2>{0.2, 0.2}, Vector<2>{0.4, 0.4}, Region::Side::keep_out);
  EXPECT_TRUE(has(made(walled, {8, 8}, coulomb(1)), "regions"));

  MeshScheme mesh(Box(Vector<2>{0.0, 0.0}, Vector<2>{1.0, 1.0}, {Boundary::periodic, Boundary::reflecting}), {8, 8},
                  coulomb(1));
  auto const ends = [&](int axis, FieldBoundary low, FieldBoundary high) {
    return failure([&] { mesh.boundary(axis, low, high); });
  };
  using enum FieldBoundary;
  EXPECT_TRUE(has(ends(2, open, open), "there is no axis 2; the box has 2"));
  EXPECT_TRUE(has(ends(-1, open, open), "no axis -1"));
  EXPECT_TRUE(has(ends(0, open, open), "axis x of the box is periodic, so its field must be, too, not open"));
  EXPECT_TRUE(has(ends(0, periodic, neumann), "not neumann"));
  EXPECT_TRUE(has(ends(1, periodic, periodic), "can't be periodic along axis y, which is reflecting"));
  EXPECT_TRUE(has(ends(1, open, dirichlet), "axis y is open at one end and dirichlet at the other"));
  EXPECT_EQ(ends(1, dirichlet, neumann), "no failure");
  for (int const order : {0, 8, -1})
    EXPECT_TRUE(has(failure([&] { mesh.assignment(order); }), "allowed are 1 (NGP), 2 (CIC), 3 (TSC) to 7")) << order;

  Ensemble<Kepler<2>> stars("stars", 1);
  Ensemble<Coulomb<2>> charges("charges", 1), namesake("charges", 1), lost("lost", 1);
  EXPECT_TRUE(has(failure([&] { mesh.add(stars); }), "Kepler of 'stars' attracts, but with the constant"));
  MeshScheme cosmos(mesh.box(), {8, 8}, gravity(1));
  EXPECT_TRUE(has(failure([&] { cosmos.add(charges); }), "repels its like"));
  mesh.add(charges);
  mesh.add(charges);  // again: nothing
  EXPECT_EQ(mesh.ensembles().size(), 1U);
  EXPECT_TRUE(has(failure([&] { mesh.add(namesake); }), "two ensembles are called 'charges'"));
  lost[0].position = {0.5, 2.0};
  EXPECT_TRUE(has(failure([&] { mesh.add(lost); }), "'lost'"));

  // Far too large: said at once, nothing allocated, whether or not the number of nodes is one that a size can hold.
  for (std::size_t const n : {std::size_t{200000}, std::size_t{1} << 32U, std::size_t{1} << 40U}) {
    MeshScheme huge(box, {n, n}, coulomb(1));
    auto const text = failure([&] { huge.calculate(); });
    EXPECT_TRUE(has(text, "GiB of memory; this machine has")) << text;
  }
}

TEST(MeshMistakes, BadNumbers) {
  Ensemble<Coulomb<1>> charges("charges", 3);
  for (std::size_t i = 0; i < 3; ++i) charges[i].position[0] = 0.2 + 0.3 * static_cast<double>(i);
  MeshScheme mesh(box_of(Vector{1.0}, Boundary::open), {8}, coulomb(1));
  mesh.add(charges);
  mesh.calculate();
  charges[1].charge = std::nan("");
  EXPECT_TRUE(has(failure([&] { mesh.calculate(); }), "strength that is not finite"));
  charges[1].charge = 0;
  charges[2].position[0] = 1.01;
  EXPECT_TRUE(has(failure([&] { mesh.calculate(); }), "particle 2 of 'charges' is outside the mesh: x = 1.01"));
  charges[2].position[0] = std::nan("");
  EXPECT_TRUE(has(failure([&] { mesh.calculate(); }), "particle 2 of 'charges' has a position that is not finite"));
  charges[2].position[0] = 1.0;
  EXPECT_EQ(failure([&] { mesh.calculate(); }), "no failure");
  for (auto const n : {0.999999999999, 1.0, 0.0}) {
    charges[2].position[0] = n;
    charges[2].charge = 1;
    EXPECT_EQ(failure([&] { mesh.calculate(); }), "no failure");
  }
}

// ---- advice ----

struct Advised {
  double thermal = 0.05, dt = 0.1, drift = 0, constant = 1;
  std::size_t cells = 32;
  int order = 2;

  std::vector<std::string> lines() const {
    Ensemble<Coulomb<1>> electrons("electrons", 640);
    // wp^2 = C n q^2 / m = constant with unit density of charge and mass.
    for (std::size_t i = 0; i < 640; ++i) {
      electrons[i].position[0] = static_cast<double>(i) / 640;
      electrons[i].velocity[0] = drift + (i % 2 == 0 ? thermal : -thermal);
      electrons[i].charge = -1.0 / 640;
      electrons[i].mass = 1.0 / 640;
    }
    MeshScheme mesh(box_of(Vector{1.0}, Boundary::periodic), {cells}, LaplaceLaw{constant});
    mesh.background(true);
    mesh.assignment(order);
    mesh.add(electrons);
    return mesh.warnings(dt);
  }
  bool warns(std::string const& word) const {
    auto const all = lines();
    return std::any_of(all.begin(), all.end(),
                       [&](auto const& line) { return has(line, "warning: ") && has(line, word); });
  }
};

TEST(MeshAdvice, NumbersOfAPlasma) {
  // lambda_D = 0.05, dx = 1/32, wp dt = 0.1, 20 a cell, 0.05 * 0.1 * 32 cells a step.
  auto const lines = Advised{}.lines();
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(has(lines[0], "lambda_D/dx 1.6,")) << lines[0];
  EXPECT_TRUE(has(lines[0], "wp dt 0.1,")) << lines[0];
  EXPECT_TRUE(has(lines[0], "particles per cell 20,")) << lines[0];
  EXPECT_TRUE(has(lines[0], "largest v dt/dx 0.16")) << lines[0];
  // With wp = 1.5 and a drift.
  auto const fast = Advised{.drift = 1.3, .constant = 2.25}.lines();
  EXPECT_TRUE(has(fast[0], "lambda_D/dx 1.07,")) << fast[0];
  EXPECT_TRUE(has(fast[0], "wp dt 0.15,")) << fast[0];
  EXPECT_TRUE(has(fast[0], "largest v dt/dx 4.32")) << fast[0];
  // Backwards in time.
  EXPECT_EQ((Advised{.dt = -0.1}.lines()), lines);
}

TEST(MeshAdvice, WarnsWhenAndOnlyWhen) {
  EXPECT_FALSE(Advised{}.warns("Debye"));
  for (int const order : {1, 2, 3}) {
    double const quiet = order == 1 ? 1.0 : order == 2 ? 0.3 : 0.15;
    EXPECT_TRUE((Advised{.thermal = 0.98 * quiet / 32, .order = order}.warns("Debye length")));
    EXPECT_FALSE((Advised{.thermal = 1.02 * quiet / 32, .order = order}.warns("Debye length")));
  }
  EXPECT_TRUE((Advised{.thermal = 0}.warns("a species is cold")));
  EXPECT_FALSE((Advised{.dt = 0.29}.warns("wp dt")));
  EXPECT_TRUE((Advised{.dt = 0.31}.warns("wp dt is 0.31; plasma oscillations are then off by 0.4 %")));
  EXPECT_FALSE((Advised{.dt = 1.99}.warns("unstable")));
  EXPECT_TRUE((Advised{.dt = 2.01}.warns("unstable: take a step below 0.2")));
  EXPECT_FALSE((Advised{.drift = 0.25}.warns("crosses")));  // 0.3 * 0.1 * 32 = 0.96
  EXPECT_TRUE((Advised{.drift = 0.27}.warns("crosses 1.02 cells in a step")));
}

TEST(MeshAdvice, Nobody) {
  Ensemble<Coulomb<1>> none("none");
  MeshScheme mesh(box_of(Vector{1.0}, Boundary::periodic), {8}, coulomb(1));
  EXPECT_TRUE(mesh.warnings(0.1).empty());
  mesh.add(none);
  EXPECT_TRUE(mesh.warnings(0.1).empty());
  Ensemble<Kepler<3>> stars("stars", 8);
  MeshScheme cosmos(box_of(filled<3>(1.0), Boundary::periodic), {2, 2, 2}, gravity(1));
  cosmos.add(stars);
  auto const lines = cosmos.warnings(0.1);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0], "mesh: particles per cell 1, largest v dt/dx 0");
}

}  // namespace
}  // namespace boltzmann::mesh_stages_test
