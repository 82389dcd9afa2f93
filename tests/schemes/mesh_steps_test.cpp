// Whole steps on a mesh: against the general path to rounding, against themselves to the last bit, and their failures.
#include <boltzmann/laws/magnetic.hpp>
#include <boltzmann/laws/uniform.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>
#include <tests/schemes/mesh_systems.hpp>
#include <tests/seed.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>

namespace boltzmann::mesh_steps_test {
namespace {

using namespace boltzmann::mesh_tests;

double const nan = std::numeric_limits<double>::quiet_NaN();

/// Electrons in two beams, light ions and a grid of heavy ones that stay put, in a box of unequal edges.
template <int D>
struct Plasma {
  Ensemble<Coulomb<D>> left{"left"}, right{"right"}, light{"light"}, fixed{"fixed"};
  std::unique_ptr<MeshScheme> mesh;
  std::unique_ptr<Simulation> simulation;

  struct Options {
    Boundary boundary = Boundary::periodic;
    int order = 2;
    std::size_t count = 500;
    std::size_t cells = 12;
    double dt = 0.02, thermal = 0.1, drift = 1;
    unsigned seed = 1;
    bool general = false;  ///< by a stage of one's own, which does what the mesh does
    bool fields = false;   ///< an electric field on the light ones, weight on electrons, a magnetic field on all
    Precision precision = Precision::full;
    int threads = 1;
    double low = 0;
    FieldBoundary walls = FieldBoundary::open;
    PoissonForm form = PoissonForm::finite_difference;
  };

  explicit Plasma(Options const& options) {
    Vector<D> low, high;
    std::vector<std::size_t> cells;
    for (int a = 0; a < D; ++a) {
      low[a] = options.low + 0.1 * a;
      high[a] = low[a] + 2 + 0.5 * a;
      cells.push_back(options.cells + static_cast<std::size_t>(a));
    }
    std::mt19937_64 random(test_seed(options.seed));
    std::uniform_real_distribution<double> uniform(0, 1);
    std::normal_distribution<double> normal;
    Box const box(low, high, options.boundary);
    mesh = std::make_unique<MeshScheme>(box, cells, coulomb(0.5));
    // Open boxes are left with a margin on all sides, or particles would leave.
    double const margin = options.boundary == Boundary::open ? 0.3 : 0;
    int which = 0;
    for (auto* ensemble : {&left, &right, &light, &fixed}) {
      std::size_t const n = which == 0 ? options.count : options.count / 2 + 1;
      double const charges[] = {-1, -1.5, 1, 1}, masses[] = {1, 2, 3, 1836};
      ensemble->resize(n);
      for (auto& p : *ensemble) {
        for (int a = 0; a < D; ++a) {
          p.position[a] = low[a] + (high[a] - low[a]) * (margin + (1 - 2 * margin) * uniform(random));
          p.velocity[a] = which == 3 ? 0 : options.thermal * normal(random);
        }
        if (which < 2 && options.boundary != Boundary::open)
          p.velocity[0] += which == 0 ? options.drift : -options.drift;
        p.charge = charges[which] / static_cast<double>(options.count);
        p.mass = masses[which] / static_cast<double>(options.count);
      }
      mesh->add(*ensemble);
      ++which;
    }
    mesh->background(true);
    mesh->assignment(options.order);
    mesh->form(options.form);
    mesh->precision(options.precision);
    mesh->threads(options.threads);
    if (options.boundary != Boundary::periodic)
      for (int a = 0; a < D; ++a) mesh->boundary(a, options.walls);
    if (options.fields) {
      mesh->external(light, UniformElectricField<D>{filled<D>(0.3)});
      mesh->external(left, UniformGravity<D>{filled<D>(-0.2)});
      if constexpr (D > 1) {
        UniformMagneticField<D> field;
        for (int a = 0; a < cross_dimension<D>; ++a) field.field[a] = 1.5 - 0.4 * a;
        mesh->external(left, field);
        mesh->external(light, field);
      }
    }
    if (options.general)
      mesh->density_assignment([](MeshScheme& scheme, MeshField& density) { scheme.assign_density(density); });
    simulation = std::make_unique<Simulation>(*mesh, options.dt);
    for (auto* ensemble : {&left, &right, &light}) simulation->integrate(*ensemble, Method::leap_frog);
    simulation->integrate(fixed, Method::deactivate);
  }

  std::vector<Ensemble<Coulomb<D>>*> all() { return {&left, &right, &light, &fixed}; }
  std::vector<std::uint64_t> all_bits() {
    std::vector<std::uint64_t> whole;
    for (auto* ensemble : all()) {
      auto const part = bits(*ensemble);
      whole.insert(whole.end(), part.begin(), part.end());
    }
    return whole;
  }
};

/// The largest difference of positions (nearest images) and velocities.
template <int D>
double difference(Plasma<D>& a, Plasma<D>& b) {
  double most = 0;
  auto const ones = a.all(), others = b.all();
  for (std::size_t e = 0; e < ones.size(); ++e)
    for (std::size_t i = 0; i < ones[e]->size(); ++i) {
      auto r = (*ones[e])[i].position - (*others[e])[i].position;
      a.mesh->box().nearest_image(r.component);
      auto const v = (*ones[e])[i].velocity - (*others[e])[i].velocity;
      double const d = std::max(magnitude(r), magnitude(v));
      most = std::max(most, std::isnan(d) ? 1e300 : d);
    }
  return most;
}

// ---- against the general path ----

template <int D>
void expect_general_path(typename Plasma<D>::Options options, double tolerance = 1e-10) {
  options.general = false;
  Plasma<D> whole(options), start(options);
  options.general = true;
  Plasma<D> general(options);
  std::vector<Mover> movers;
  for (auto* ensemble : whole.all()) movers.push_back({ensemble, ensemble != &whole.fixed});
  whole.simulation->check();
  ASSERT_NE(whole.mesh->fused_steps(movers, options.dt), nullptr);
  ASSERT_EQ(general.mesh->fused_steps(movers, options.dt), nullptr);
  whole.simulation->run(30);
  general.simulation->run(30);
  EXPECT_LT(difference(whole, general), tolerance)
      << D << "D order " << options.order << " " << to_string(options.boundary);
  EXPECT_GT(difference(whole, start), 0.1);
  EXPECT_TRUE(bits(whole.fixed) == bits(start.fixed));  // deactivated: stays put
}

template <int D>
void expect_general_paths() {
  using Options = typename Plasma<D>::Options;
  for (int order = 1; order <= 3; ++order)
    for (auto const boundary : {Boundary::periodic, Boundary::reflecting, Boundary::open})
      for (bool const fields : {false, true}) {
        Options options;
        options.order = order;
        options.boundary = boundary;
        options.fields = fields;
        options.count = D == 1 ? 301 : 129;
        options.low = order == 2 ? -7.3 : 0;
        // To the nearest node, a rounding at the middle of a cell is a finite difference in the field.
        expect_general_path<D>(options, order == 1 ? 1e-9 : 1e-10);
        if (boundary == Boundary::reflecting) {
          options.walls = fields ? FieldBoundary::dirichlet : FieldBoundary::neumann;
          options.form = PoissonForm::spectral;
          expect_general_path<D>(options, order == 1 ? 1e-9 : 1e-10);
        }
        options.precision = Precision::single;
        if (order > 1) expect_general_path<D>(options, 2e-5);
      }
}

TEST(MeshSteps, DoWhatTheGeneralPathDoes1D) { expect_general_paths<1>(); }
TEST(MeshSteps, DoWhatTheGeneralPathDoes2D) { expect_general_paths<2>(); }
TEST(MeshSteps, DoWhatTheGeneralPathDoes3D) { expect_general_paths<3>(); }

TEST(MeshSteps, AreOnlyForWhatTheyCan) {
  Plasma<2>::Options options;
  Plasma<2> plasma(options);
  auto const possible = [&] {
    std::vector<Mover> movers;
    for (auto* ensemble : plasma.all()) movers.push_back({ensemble, true});
    return plasma.mesh->fused_steps(movers, 0.1) != nullptr;
  };
  plasma.simulation->check();
  EXPECT_TRUE(possible());
  plasma.left[3].mass *= 2;
  EXPECT_FALSE(possible());
  plasma.left[3].mass /= 2;
  plasma.left[3].charge *= 2;
  EXPECT_FALSE(possible());
  plasma.left[3].charge /= 2;
  plasma.mesh->assignment(4);
  EXPECT_FALSE(possible());
  plasma.mesh->assignment(2);
  EXPECT_TRUE(possible());
  plasma.mesh->pairs().internal(plasma.left, coulomb(1, 0.1), 0.5);
  EXPECT_FALSE(possible());
}

TEST(MeshSteps, OneTwoAndNoParticles) {
  for (std::size_t const count : {0, 1, 2, 3, 7, 127, 128, 129}) {
    Ensemble<Coulomb<2>> some("some", count), none("none");
    Ensemble<Coulomb<2>> others("others", count), nobody("nobody");
    double difference = 0;
    for (auto* e : {&some, &others})
      for (std::size_t i = 0; i < count; ++i) {
        (*e)[i].position = {0.3 + 0.004 * static_cast<double>(i), 0.4};
        (*e)[i].velocity = {0.5, -0.7};
        (*e)[i].charge = 0.1;
      }
    for (bool const general : {false, true}) {
      MeshScheme mesh(box_of(filled<2>(1.0), Boundary::reflecting), {9, 10}, coulomb(1));
      mesh.boundary(1, FieldBoundary::dirichlet, FieldBoundary::neumann);
      auto& particles = general ? others : some;
      mesh.add(particles);
      if (general) mesh.add(nobody);
      Simulation simulation(mesh, 0.01);
      simulation.integrate(particles, Method::leap_frog);
      if (general) simulation.integrate(nobody, Method::leap_frog);
      simulation.run(90);
    }
    for (std::size_t i = 0; i < count; ++i)
      difference = std::max(difference, magnitude(some[i].position - others[i].position));
    EXPECT_LT(difference, 1e-11) << count;
  }
}

// ---- bit for bit ----

template <int D>
void expect_same_bits(typename Plasma<D>::Options options) {
  std::string const name = std::to_string(D) + "D, order " + std::to_string(options.order) + ", " +
                           to_string(options.boundary) + (options.precision == Precision::single ? ", single" : "");
  std::uint64_t const steps = 24;
  Plasma<D> straight(options);
  straight.simulation->run(steps);
  auto const expected = straight.all_bits();

  Plasma<D> observed(options);
  std::size_t seen = 0;
  double energy = 0;
  observed.simulation->observe(1, [&](Simulation const& simulation) {
    ++seen;
    energy += simulation.measure().potential;
  });
  observed.simulation->run(steps);
  EXPECT_EQ(seen, steps + 1);
  EXPECT_TRUE(observed.all_bits() == expected) << name << ", observed";

  Plasma<D> pieces(options);
  for (int part = 0; part < 4; ++part) pieces.simulation->run(steps / 4);
  EXPECT_TRUE(pieces.all_bits() == expected) << name << ", in pieces";

  Plasma<D> saved(options), restored(options);
  saved.simulation->run(7);
  auto const state = saved.simulation->state();
  auto const from = saved.all(), to = restored.all();
  for (std::size_t e = 0; e < from.size(); ++e)
    for (std::size_t i = 0; i < from[e]->size(); ++i) std::copy_n(from[e]->row(i), from[e]->stride(), to[e]->row(i));
  restored.simulation->restore(7, options.dt, saved.simulation->seed(), state);
  restored.simulation->run(steps - 7);
  EXPECT_TRUE(restored.all_bits() == expected) << name << ", restored";

  for (int const threads : {2, 3, 7}) {
    auto more = options;
    more.threads = threads;
    Plasma<D> parallel(more);
    parallel.simulation->run(steps);
    EXPECT_TRUE(parallel.all_bits() == expected) << name << ", " << threads << " threads";
  }

  Plasma<D> there(options), start(options);
  there.simulation->run(steps);
  EXPECT_GT(difference(there, start), 0.01);
  there.simulation->rewind(steps);
  EXPECT_LT(difference(there, start), options.precision == Precision::single ? 3e-4 : 1e-11) << name;
}

TEST(MeshStepsBits, AreTheSameHoweverOneRuns) {
  for (auto const precision : {Precision::full, Precision::single})
    for (bool const fields : {false, true}) {
      Plasma<1>::Options one;
      one.precision = precision;
      one.fields = fields;
      one.count = 20001;
      one.order = 3;
      expect_same_bits<1>(one);
      Plasma<2>::Options two;
      two.precision = precision;
      two.fields = fields;
      two.count = 10007;
      two.boundary = fields ? Boundary::reflecting : Boundary::periodic;
      two.low = -3.7;
      expect_same_bits<2>(two);
      Plasma<3>::Options three;
      three.precision = precision;
      three.fields = fields;
      three.count = 9001;
      three.order = 2;
      three.cells = 8;
      expect_same_bits<3>(three);
    }
}

TEST(MeshStepsBits, AreTheSameWithSorting) {
  // Slots of 130 x 131 nodes don't fit what needs no order; particles come more than two cells far in four steps.
  Plasma<2>::Options options;
  options.cells = 130;
  options.order = 3;
  options.count = 18000;
  options.drift = 1;
  options.dt = 0.02;
  for (auto const precision : {Precision::full, Precision::single}) {
    options.precision = precision;
    expect_same_bits<2>(options);
  }
  options.count = 3000;
  options.precision = Precision::full;
  expect_general_path<2>(options);
}

// What is computed doesn't depend on the order of particles.
TEST(MeshStepsBits, AreTheSameInAnyOrder) {
  Plasma<2>::Options options;
  options.count = 12001;
  options.order = 3;
  Plasma<2> a(options), b(options);
  std::reverse(b.left.begin(), b.left.end());
  a.simulation->run(20);
  b.simulation->run(20);
  std::reverse(b.left.begin(), b.left.end());
  EXPECT_TRUE(a.all_bits() == b.all_bits());
}

// A field that is uniform in space and changes in time: also in the rows that are stored.
struct Waving {
  static constexpr bool uniform = true;
  double frequency;
  template <class P>
  auto operator()(P const& p, double time) const {
    auto force = p.velocity * 0.0;
    force[0] = force[0] + std::cos(frequency * time) * p.mass;
    return force;
  }
};

TEST(MeshSteps, FieldsThatChangeInTime) {
  Ensemble<Coulomb<1>> some("some", 2), others("others", 2);
  for (bool const general : {false, true}) {
    auto& particles = general ? others : some;
    particles[0].position[0] = 0.3, particles[1].position[0] = 0.6;
    MeshScheme mesh(box_of(Vector{1.0}, Boundary::reflecting), {8}, coulomb(1));
    mesh.add(particles);
    mesh.external(particles, Waving{3});
    if (general)
      mesh.density_assignment([](MeshScheme& scheme, MeshField& density) { scheme.assign_density(density); });
    Simulation simulation(mesh, 0.05);
    simulation.integrate(particles, Method::leap_frog);
    simulation.run(20);
    // dv/dt = cos wt, by the trapezoidal rule.
    double velocity = 0;
    for (int n = 0; n < 20; ++n) velocity += 0.05 * (std::cos(0.15 * n) + std::cos(0.15 * (n + 1))) / 2;
    EXPECT_NEAR(particles[0].velocity[0], velocity, 1e-10) << general;
  }
  EXPECT_NEAR(some[1].position[0], others[1].position[0], 1e-12);
  EXPECT_NEAR(some[1].velocity[0], others[1].velocity[0], 1e-12);
}

// ... and to the last bit whether somebody looks or not, though times are sums of steps that round.
TEST(MeshStepsBits, AreTheSameInAFieldThatChangesInTime) {
  Ensemble<Coulomb<1>> looked("looked", 1), straight("straight", 1);
  for (auto* particles : {&looked, &straight}) {
    (*particles)[0].position[0] = 0.3;
    MeshScheme mesh(box_of(Vector{1.0}, Boundary::reflecting), {8}, coulomb(1));
    mesh.add(*particles);
    mesh.external(*particles, Waving{300});
    Simulation simulation(mesh, 0.1);
    simulation.integrate(*particles, Method::leap_frog);
    if (particles == &straight)
      simulation.run(40);
    else
      for (int n = 0; n < 40; ++n) simulation.run(1);
  }
  EXPECT_EQ(looked[0].velocity[0], straight[0].velocity[0]);
  EXPECT_EQ(looked[0].position[0], straight[0].position[0]);
}

/// A class with very many fields of its own.
template <int D, class Real = double>
struct Heavy : Coulomb<D, Real> {
  static constexpr char const* class_name = "Heavy";
  Vector<3, Real> baggage[40];
};

TEST(MeshSteps, LargeClassesInAMagneticField) {
  Ensemble<Heavy<2>> ions("ions", 3);
  for (std::size_t i = 0; i < 3; ++i) {
    ions[i].position = {0.5, 0.5};
    ions[i].velocity = {0.1, 0.0};
    ions[i].charge = 1e-9;
    ions[i].baggage[39][2] = 7;
  }
  MeshScheme mesh(box_of(filled<2>(1.0), Boundary::periodic), {8, 8}, coulomb(1));
  mesh.background(true);
  mesh.add(ions);
  mesh.external(ions, UniformMagneticField<2>{Vector<1>{1e9}});
  Simulation simulation(mesh, 0.1);
  simulation.integrate(ions, Method::leap_frog);
  simulation.run(16);
  // Each step turns by 2 atan(dt/2 / 2) twice, or as near to dt as it comes.
  EXPECT_NEAR(magnitude(ions[0].velocity), 0.1, 1e-12);
  EXPECT_NEAR(ions[0].velocity[0], 0.1 * std::cos(1.6), 0.002);
  EXPECT_EQ(ions[1].baggage[39][2], 7);
}

// ---- failures ----

struct Failing {
  Ensemble<Coulomb<2>> ions{"ions", 40000};
  std::unique_ptr<MeshScheme> mesh;
  std::unique_ptr<Simulation> simulation;

  explicit Failing(Boundary boundary, Precision precision = Precision::full) {
    std::mt19937_64 random(test_seed(1));
    std::uniform_real_distribution<double> uniform(0.1, 0.9);
    for (auto& p : ions) {
      p.position = {uniform(random), uniform(random)};
      p.velocity = {0.02, 0.01};
    }
    mesh =
        std::make_unique<MeshScheme>(box_of(filled<2>(1.0), boundary), std::vector<std::size_t>{128, 128}, coulomb(1));
    mesh->add(ions);
    mesh->precision(precision);
    simulation = std::make_unique<Simulation>(*mesh, 0.01);
    simulation->integrate(ions, Method::leap_frog);
  }
  std::string run(std::uint64_t steps) {
    return failure([&] { simulation->run(steps); });
  }
};

TEST(MeshStepsFailures, NameTheParticle) {
  for (auto const precision : {Precision::full, Precision::single}) {
    {
      Failing open(Boundary::open, precision);
      open.ions[31234].position = {0.95, 0.5};
      open.ions[31234].velocity = {2.01, 0.3};
      auto const text = open.run(100);
      EXPECT_TRUE(has(text, "particle 31234 of 'ions' has left the mesh along x")) << text;
      EXPECT_TRUE(has(text, "step 3:")) << text;
    }
    {
      Failing low(Boundary::open, precision);
      low.ions[17].position = {0.5, 0.05};
      low.ions[17].velocity = {0.3, -4.01};
      auto const text = low.run(100);
      EXPECT_TRUE(has(text, "particle 17 of 'ions' has left the mesh along y")) << text;
    }
    for (auto const boundary : {Boundary::periodic, Boundary::reflecting, Boundary::open}) {
      Failing fast(boundary, precision);
      fast.ions[22222].velocity = {-30, 110};
      auto const text = fast.run(3);
      EXPECT_TRUE(has(text, "particle 22222 of 'ions' moved 1.14 in one step")) << text;
      EXPECT_TRUE(has(text, "step 1:")) << text;
      Failing very(boundary, precision);
      very.ions[39999].velocity = {1e25, 0};
      EXPECT_TRUE(has(very.run(3), "particle 39999 of 'ions' moved 1e+23")) << very.run(3);
    }
    Failing mad(Boundary::periodic, precision);
    mad.ions[7].velocity = {nan, 0};
    auto const text = mad.run(3);
    EXPECT_TRUE(has(text, "particle 7 of 'ions'")) << text;
    EXPECT_TRUE(has(text, "not finite")) << text;
  }
}

TEST(MeshStepsFailures, OutsideAtTheStart) {
  Failing open(Boundary::open);
  open.ions[11].position = {0.5, 1.25};
  auto const text = open.run(1);
  EXPECT_TRUE(has(text, "particle 11 of 'ions' is outside the mesh: y = 1.25, the box goes from 0 to 1")) << text;
  Failing lost(Boundary::open);
  lost.ions[12].position = {0.5, nan};
  EXPECT_TRUE(has(lost.run(1), "particle 12")) << lost.run(1);
  // Between two runs, where whole steps are the first to see it.
  Failing later(Boundary::open);
  later.simulation->run(2);
  later.ions[13].position = {-0.25, 0.5};
  EXPECT_TRUE(has(later.run(1), "particle 13 of 'ions' is outside the mesh: x = -0.25")) << later.run(1);
  // The first one, on any number of threads.
  later.ions[39000].position = {-0.5, 0.5};
  later.mesh->threads(3);
  EXPECT_TRUE(has(later.run(1), "particle 13 of 'ions' is outside the mesh: x = -0.25")) << later.run(1);
}

TEST(MeshStepsFailures, NotNeutralBetweenRuns) {
  Failing failing(Boundary::periodic);
  failing.simulation->run(1);
  for (auto& p : failing.ions) p.charge = 1e-6;
  EXPECT_TRUE(has(failing.run(1), "background(true)"));
}

}  // namespace
}  // namespace boltzmann::mesh_steps_test
