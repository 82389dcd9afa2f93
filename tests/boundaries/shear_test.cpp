// Boxes that are sheared: where images are, what crosses, and all that does not go with them, one line each.
#include <boltzmann/boundaries/images.hpp>
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/dissipation/pair_dissipation.hpp>
#include <boltzmann/dissipation/rigid_motion.hpp>
#include <boltzmann/laws/soft.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/tracer.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>
#include <boltzmann/schemes/molecules/molecule_scheme.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann::shear_test {
namespace {

Box sheared(double rate = 0.5, double time = 0) {
  Box box({-1.0, 0.0}, {3.0, 2.0}, Boundary::periodic);
  box.shear({rate, 0, 1});
  box.move_walls(time);
  return box;
}

TEST(Shear, TheFlowIsZeroInTheMiddle) {
  Box const box = sheared();
  double const below[2] = {0, 0}, middle[2] = {2, 1}, above[2] = {1, 2};
  EXPECT_EQ(box.flow_velocity(below), -0.5);
  EXPECT_EQ(box.flow_velocity(middle), 0);
  EXPECT_EQ(box.flow_velocity(above), 0.5);
  EXPECT_EQ(box.slide_velocity(), 1);
}

// At time 5.5 images above are 5.5 further along: 1.5 in the lattice.
TEST(Shear, ImagesSlide) {
  Box const box = sheared(0.5, 5.5);
  EXPECT_DOUBLE_EQ(box.slide(), 5.5);
  EXPECT_DOUBLE_EQ(box.slide_in_lattice(), 1.5);
  double const x[3] = {2.5, 1.9, 0};
  std::vector<std::array<double, 3>> found;
  Images(box).each(x, 0.5, [&](Turns const& turns, std::array<double, 3> const& at) {
    for (int a = 0; a < 2; ++a) EXPECT_NEAR(image_map(box, {ImageRule::position, a}, turns)(x[a]), at[a], 1e-12);
    EXPECT_EQ(image_map(box, {ImageRule::velocity, 0}, turns)(2.0), 2 + turns[1]);
    EXPECT_EQ(image_map(box, {ImageRule::velocity, 1}, turns)(2.0), 2);
    found.push_back(at);
  });
  // Itself, one on its left; below at 2.5 - 1.5 = 1 and no other.
  std::vector<std::array<double, 3>> const expected{{1, -0.1, 0}, {-1.5, 1.9, 0}, {2.5, 1.9, 0}};
  ASSERT_EQ(found.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(found[k][a], expected[k][a], 1e-12) << k;
  double d[2] = {2.9, 1.8};  // 2.9 - 1.5 = 1.4 along
  box.nearest_image(d);
  EXPECT_NEAR(d[0], 1.4, 1e-12);
  EXPECT_NEAR(d[1], -0.2, 1e-12);
}

TEST(Shear, WhoCrossesTheGradientBecomesTheImage) {
  Box const box = sheared(0.5, 5.5);
  Ensemble<Newton<2>> three("three", 3);
  three[0].position = {0.2, 2.1};                      // at -1.3 + 4
  three[1].position = {2.9, -0.1};                     // at 4.4 - 4
  three[2].position = {0.0, std::nextafter(0.0, -1)};  // a rounding error below the edge, which is not crossed
  for (auto& p : three) p.velocity = {1, -2};
  box.apply(three);
  Vector<2> const places[] = {{2.7, 0.1}, {0.4, 1.9}, {0.0, 0.0}}, velocities[] = {{0, -2}, {2, -2}, {1, -2}};
  for (std::size_t i = 0; i < 3; ++i)
    for (int a = 0; a < 2; ++a) {
      EXPECT_NEAR(three[i].position[a], places[i][a], 1e-12) << i;
      EXPECT_EQ(three[i].velocity[a], velocities[i][a]) << i;
    }
  // The start of a run takes what is further outside, too.
  three[0].position = {0.2, 4.1};
  three[0].velocity = {1, -2};
  box.wrap(three);
  EXPECT_NEAR(three[0].position[0], 0.2 - 3 + 4, 1e-12);
  EXPECT_NEAR(three[0].position[1], 0.1, 1e-12);
  EXPECT_EQ(three[0].velocity[0], -1);
}

TEST(Shear, BoxesRefuseWhatDoesNotGo) {
  auto const refused = [](Box box, Shear const& shear) { return message([&] { box.shear(shear); }); };
  Box const plain({0.0, 0.0, 0.0}, {1, 1, 1}, Boundary::periodic);
  EXPECT_EQ(refused(Box({0.0}, {1}, Boundary::periodic), {1}),
            "shear: a box of one dimension has no gradient of a flow across it");
  EXPECT_EQ(refused(plain, {1, 0, 0}), "shear: flow and gradient are both along x; they are along different axes");
  EXPECT_EQ(refused(plain, {1, 0, 3}), "shear: a box of 3 dimensions has no axis number 3");
  EXPECT_EQ(refused(plain, {std::numeric_limits<double>::infinity()}), "shear: the rate is a finite number, not inf");
  EXPECT_EQ(refused(Box({0.0, 0.0}, {1, 1}, {Boundary::periodic, Boundary::reflecting}), {1}),
            "shear: axis y is reflecting; flow and gradient of a sheared box are along periodic axes");
  EXPECT_EQ(refused(Box({0.0, 0.0, 0.0}, {1, 1, 1}, {Boundary::periodic, Boundary::periodic, Boundary::mirror}), {1}),
            "shear: axis z is a mirror, whose images would not flow; use reflecting, periodic or open");
  Box box = sheared();
  EXPECT_NE(message([&] { box.install(Vector{0.0, 0.0}, Vector{1.0, 1.0}, Region::Side::keep_out); }), "no error");
  EXPECT_EQ(message([&] { box.edges({-1, 0, 0, 4, 2, 0}); }), "box: one that is sheared is not stretched");
  Box at_rest = plain;
  at_rest.shear({0});
  EXPECT_FALSE(at_rest.sheared());
}

struct Fluid {
  Ensemble<Newton<2>> atoms{"atoms", 2};
  PairScheme scheme{sheared(), 0.5};
  Simulation simulation{scheme, 0.001};
  Fluid() {
    atoms[1].position = {1, 1};
    for (auto& p : atoms) p.mass = 1;
    scheme.internal(atoms, Soft{25, 0.5});
  }
  std::string line() {
    return message([&] { simulation.check(); });
  }
};

TEST(Shear, SimulationsRefuseWhatDoesNotGo) {
  EXPECT_EQ(Fluid().line(), "no error");
  {
    Fluid fluid;
    PairScheme other(Box({-1.0, 0.0}, {3.0, 2.0}, Boundary::periodic), 0.5);
    other.internal(fluid.atoms, Soft{25, 0.5});
    fluid.simulation.add(other);
    EXPECT_EQ(fluid.line(), "shear: the boxes of all schemes of a simulation are sheared alike, or none is");
  }
  {
    Fluid fluid;
    auto const bonds =
        std::make_shared<RigidBonds>(fluid.atoms, fluid.scheme.box(), std::vector<BondMembers>{{0, 1}}, std::sqrt(2.0));
    fluid.simulation.integrate(fluid.atoms, with_rigid_bonds(bonds, make_integrator(fluid.atoms, Method::leap_frog)));
    EXPECT_EQ(fluid.line(),
              "shear: the bonds of ensemble 'atoms' are kept rigid with no regard to the velocities of images that "
              "flow; use springs");
    MoleculeScheme molecules(fluid.scheme.box());
    molecules.keeps(bonds);
    fluid.simulation.add(molecules);
    EXPECT_EQ(fluid.line(),
              "shear: molecules of 1 rigid bonds is kept rigid with no regard to the velocities of images that flow; "
              "use springs");
  }
  for (Method const method : {Method::reversible_leap_frog, Method::gauss_radau}) {
    Fluid fluid;
    fluid.simulation.integrate(fluid.atoms, method);
    EXPECT_EQ(fluid.line(), "shear: ensemble 'atoms' moves by " + to_string(method) +
                                ", which knows no images that flow; use leap-frog");
  }
  {
    Fluid fluid;
    fluid.simulation.integrate(fluid.atoms, Method::deactivate);
    EXPECT_EQ(fluid.line(), "shear: particles of ensemble 'atoms' are fixed, but their images would flow");
  }
  {
    Fluid fluid;
    Ensemble<Tracer<2>> dust("dust", 1);
    fluid.scheme.add(dust);
    EXPECT_EQ(fluid.line(), "shear: ensemble 'dust' of class Tracer has no velocities that change from image to image");
  }
  {
    Fluid fluid;
    fluid.simulation.adapt(1, [] {});
    EXPECT_EQ(fluid.line(), "shear: adaptations, which know their box, don't go with it");
  }
  {
    Fluid fluid;
    fluid.simulation.happen(
        1, [] {}, false);
    EXPECT_EQ(fluid.line(),
              "shear: events that change velocities, or add particles with velocities, which are not those relative to "
              "the flow, don't go with it");
  }
  {
    Fluid fluid;
    PairDissipation friction(fluid.scheme, 1);
    friction.internal(fluid.atoms,
                      {.convention = Convention::fixed_temperature, .friction = 1, .temperature = 1, .range = 0.5});
    friction.method(DissipationMethod::shardlow);
    fluid.simulation.add(friction);
    EXPECT_EQ(fluid.line(),
              "shear: shardlow takes pairs one by one between particles, not their images that flow; take the method "
              "simultaneous");
  }
  {
    Fluid fluid;
    fluid.simulation.add(Barostat({.pressure = 1, .temperature = 1, .compressibility = 1, .rate = 1}, 1));
    EXPECT_EQ(fluid.line(), "shear: a barostat stretches the box, and one that is sheared is not stretched");
  }
}

TEST(Shear, DiagnosesRefuseWhatTheyCantMeasure) {
  Fluid fluid;
  DiagnosisParameters parameters;
  parameters.available = {&fluid.atoms};
  Box const plain({-1.0, 0.0}, {3.0, 2.0}, Boundary::periodic);
  for (char const* kind : {"radial-distribution", "structure-factor", "bond-order", "diffusion",
                           "velocity-autocorrelation", "mean-square-displacement", "green-kubo"}) {
    auto with = parameters;
    if (std::string_view(kind) == "bond-order") with.range = 0.5;
    if (std::string_view(kind) == "green-kubo") with.quantity = "viscosity";
    auto const diagnosis = make_diagnosis(kind, with);
    EXPECT_NE(message([&] { diagnosis->check(fluid.scheme.box()); }).find("in a sheared box"), std::string::npos)
        << kind;
    EXPECT_EQ(message([&] { diagnosis->check(plain); }), "no error") << kind;
  }
  auto const viscosity = make_diagnosis("viscosity", parameters);
  EXPECT_EQ(message([&] { viscosity->check(fluid.scheme.box()); }), "no error");
  EXPECT_EQ(message([&] { viscosity->check(plain); }),
            "viscosity: the box is not sheared ('shear' in [box]); in equilibrium green-kubo gives a viscosity");
}

}  // namespace
}  // namespace boltzmann::shear_test
