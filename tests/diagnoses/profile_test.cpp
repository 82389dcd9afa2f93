// Profiles: by hand, of a gas whose temperature and pressure are known, against the pressure tensor, and as a picture.
#include <boltzmann/diagnoses/profile.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/meso.hpp>
#include <boltzmann/particles/smooth.hpp>
#include <boltzmann/particles/tracer.hpp>
#include <boltzmann/pictures/picture.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace boltzmann::profile_test {
namespace {

using List = std::vector<AnyEnsemble const*>;

/// Three mesoparticles and an atom in a box of 4 x 5: two bins of 2 x 5.
struct Four {
  Box box{Vector{0.0, 0.0}, Vector{4.0, 5.0}, Boundary::reflecting};
  Ensemble<Meso<2>> lumps{"lumps", 3};
  Ensemble<Newton<2>> atoms{"atoms", 1};
  List all{&lumps, &atoms};
  EnergyAndVirial measures = EnergyAndVirial::known();

  Four() {
    lumps[0] = {{{{0.5, 1.0}}, 2, {3.0, 0.0}}, 7, 100};
    lumps[1] = {{{{1.5, 1.0}}, 4, {0.0, -1.0}}, 9, 300};
    lumps[2] = {{{{3.5, 1.0}}, 1, {5.0, 6.0}}, 2, 50};
    atoms[0] = {{{1.0, 4.0}}, 2, {1.0, 2.0}};
    measures.per_particle = {{-1, -2, -4}, {-0.5}};
    measures.virial_per_particle = {std::vector<double>(27, 0), std::vector<double>(9, 0)};
    measures.virial_per_particle[0][0] = 30;     // xx of the first
    measures.virial_per_particle[0][9 + 1] = 4;  // xy of the second
    measures.virial_per_particle[1][4] = -5;     // yy of the atom
  }
  Profile look(std::size_t bins = 2) const {
    return profile(MassiveParticles(all, &measures), box, 0, 0, 4, bins, 0.5);
  }
};

TEST(Profile, ByHand) {
  Four const four;
  Profile const p = four.look();
  EXPECT_EQ(p.position, (std::vector<double>{1, 3}));
  EXPECT_EQ(p.values("number"), (std::vector<double>{3, 1}));
  EXPECT_EQ(p.values("density"), (std::vector<double>{0.8, 0.1}));
  // Masses 2, 4, 2 with (3, 0), (0, -1), (1, 2): mean (1, 0); deviations (2, 0), (-1, -1), (0, 2).
  MatterState const& m = p.matter[0];
  EXPECT_NEAR(m.velocity[0], 1, 1e-15);
  EXPECT_NEAR(m.velocity[1], 0, 1e-15);
  EXPECT_NEAR(m.kinetic_temperature[0], (8 + 4) / (0.5 * 2), 1e-13);
  EXPECT_NEAR(m.kinetic_temperature[1], (4 + 8) / (0.5 * 2), 1e-13);
  EXPECT_NEAR(m.mean_kinetic_temperature, 12, 1e-13);
  EXPECT_NEAR(m.internal_temperature, 150, 1e-12);  // 2 / (1/100 + 1/300)
  EXPECT_NEAR(m.pressure[0][0], (12 + 30) / 10.0, 1e-14);
  EXPECT_NEAR(m.pressure[0][1], (4 + 4) / 10.0, 1e-14);
  EXPECT_NEAR(m.pressure[1][1], (12 - 5) / 10.0, 1e-14);
  EXPECT_NEAR(m.internal_energy, 16 / 8.0, 1e-15);
  EXPECT_NEAR(m.potential_energy, -3.5 / 8, 1e-15);
  EXPECT_NEAR(m.specific_energy, (12 + 16 - 3.5) / 8, 1e-14);
  EXPECT_EQ(p.values("velocity.x")[1], 5);
  EXPECT_TRUE(std::isnan(p.values("kinetic-temperature.x")[1]));  // of one particle
  EXPECT_EQ(p.values("pressure.xy"), (std::vector<double>{m.pressure[0][1], 0}));
  EXPECT_EQ(p.values("internal-temperature")[1], 50);

  // The same as one window; of one ensemble; without measures.
  EXPECT_EQ(matter_between(MassiveParticles(four.all, &four.measures), four.box, 0, 0, 2, 0.5).specific_energy,
            m.specific_energy);
  EXPECT_EQ(matter_between(MassiveParticles(four.all, nullptr, {"atoms"}), four.box, 0, 0, 4, 0.5).mass, 2);
  auto const blind = matter_between(MassiveParticles(four.all, nullptr), four.box, 0, 0, 2, 0.5);
  EXPECT_EQ(blind.kinetic_temperature, m.kinetic_temperature);
  EXPECT_TRUE(std::isnan(blind.pressure[0][0]) && std::isnan(blind.specific_energy));
  EXPECT_EQ(blind.internal_energy, m.internal_energy);
}

TEST(Profile, EmptyBinsWallsAndEnds) {
  Four four;
  Profile const p = four.look(8);
  EXPECT_EQ(p.values("number"), (std::vector<double>{0, 1, 1, 1, 0, 0, 0, 1}));
  EXPECT_EQ(p.matter[4].density, 0);
  for (char const* name : {"velocity.y", "kinetic-temperature", "internal-temperature", "pressure.yy",
                           "specific-energy", "potential-energy"})
    EXPECT_TRUE(std::isnan(p.values(name)[4])) << name;
  // A particle at the high end belongs to the last bin; a bin that reaches beyond a wall has less room.
  four.lumps[2].position[0] = 4;
  EXPECT_EQ(four.look().matter[1].number, 1U);
  auto const beyond = profile(MassiveParticles(four.all, nullptr), four.box, 0, -4, 4.0, 2, 1);
  EXPECT_EQ(beyond.matter[0].number, 0U);
  EXPECT_TRUE(std::isnan(beyond.matter[0].density));
  EXPECT_EQ(profile(MassiveParticles(four.all, nullptr), four.box, 0, -1, 3.0, 2, 1).matter[0].density, 2.0 / 5);
  // An internal temperature of zero or less has no harmonic mean.
  four.lumps[0].temperature = -3;
  EXPECT_TRUE(std::isnan(four.look().matter[0].internal_temperature));
  // On an open axis the extent reaches to the outermost particle.
  Box const open(Vector{0.0, 0.0}, Vector{3.0, 5.0});
  auto const reach = extent(MassiveParticles(four.all, nullptr), open, 0);
  EXPECT_EQ(reach.low, 0);
  EXPECT_EQ(reach.high, 4);
}

TEST(Profile, WhatCarriesNoMomentumDoesNotCount) {
  Box const box(Vector{0.0, 0.0}, Vector{1.0, 1.0}, Boundary::reflecting);
  Ensemble<Tracer<2>> vortices("vortices", 3);
  Ensemble<Smooth<2>> water("water", 2);
  for (auto& p : water) {
    p.mass = 3;
    p.specific_energy = 2;
    p.temperature = 40;
  }
  List const all{&vortices, &water};
  auto const m = matter_between(MassiveParticles(all, nullptr), box, 0, 0, 1, 1);
  EXPECT_EQ(m.number, 2U);
  EXPECT_EQ(m.internal_energy, 2);  // per mass
  EXPECT_NEAR(m.internal_temperature, 40, 1e-13);
  List const none{&vortices};
  EXPECT_EQ(matter_between(MassiveParticles(none, nullptr), box, 0, 0, 1, 1).number, 0U);
}

TEST(Profile, FastGasHasItsTemperatureAndPressure) {
  // An ideal gas with two temperatures and drifts a million times its thermal velocity.
  Box const box(Vector{0.0, 0.0, 0.0}, Vector{2.0, 1.0, 1.0}, Boundary::periodic);
  Ensemble<Newton<3>> gas("gas", 200'000);
  random_load(gas, box, {.seed = test_seed(5)});
  maxwellian_load(gas, {.temperature = 3, .seed = test_seed(6)});
  for (auto& p : gas) {
    if (p.position[0] > 1) p.velocity *= 2;
    p.velocity[1] += 1e6 * p.mass;
  }
  auto nothing = EnergyAndVirial::known();
  nothing.per_particle = {std::vector<double>(gas.size(), 0)};
  nothing.virial_per_particle = {std::vector<double>(9 * gas.size(), 0)};
  List const all{&gas};
  auto const p = profile(MassiveParticles(all, &nothing), box, 0, 0, 2, 2, 1);
  for (std::size_t b = 0; b < 2; ++b) {
    double const t = b == 0 ? 3 : 12;
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(p.matter[b].kinetic_temperature[a] / t, 1, 0.025);  // five standard errors, and a half
      EXPECT_NEAR(p.matter[b].pressure[a][a] / (1e5 * t), 1, 0.025);
    }
    EXPECT_NEAR(p.matter[b].pressure[0][1] / (1e5 * t), 0, 0.02);
    EXPECT_NEAR(p.matter[b].specific_energy / (1.5 * t), 1, 0.02);
    EXPECT_NEAR(p.matter[b].velocity[1], 1e6, 0.1);
  }
}

TEST(Profile, BinsAddUpToThePressureTensor) {
  Ensemble<Newton<2>> atoms("atoms");
  double const a = 1.05;
  block_load(atoms, {Lattice::triangular, a, {20, 12, 1}, {0.1, 0.1, 0}});
  Box const box(Vector{0.0, 0.0}, Vector{20 * a, 12 * a * std::sqrt(0.75)}, Boundary::periodic);
  maxwellian_load(atoms, {.temperature = 0.3, .seed = test_seed(3)});
  PairScheme scheme(box);
  scheme.internal(atoms, LennardJones{1, 1}, 2.5);
  EnergyAndVirial const measures = scheme.measure();
  List const all{&atoms};
  MassiveParticles const bodies(all, &measures);
  Tensor3 const whole = pressure_tensor(atoms, measures, box);
  auto const p = profile(bodies, box, 0, 0, box.high(0), 5, 1);
  double energy = 0;
  for (int i = 0; i < 2; ++i)
    for (int j = i; j < 2; ++j) {
      double sum = 0;
      for (auto const& m : p.matter)
        sum += (m.pressure[i][j] * m.volume + m.mass * m.velocity[i] * m.velocity[j]) / box.volume();
      EXPECT_NEAR(sum, whole[i][j], 1e-11 * std::abs(whole[0][0]));
    }
  for (auto const& m : p.matter)
    energy += m.mass * (m.specific_energy + 0.5 * (m.velocity[0] * m.velocity[0] + m.velocity[1] * m.velocity[1]));
  EXPECT_NEAR(energy, measures.potential + kinetic_energy(atoms), 1e-10);
}

TEST(Profile, NamesAndRefusals) {
  EXPECT_EQ(profile_quantities(1).size(), 10U);
  EXPECT_EQ(profile_quantities(3).size(), 19U);
  EXPECT_EQ(profile_quantity(2, "density").dimension, dimensions::mass / dimensions::area);
  EXPECT_EQ(profile_quantity(2, "pressure.xx").dimension, dimensions::energy / dimensions::area);
  EXPECT_EQ(profile_quantity(3, "kinetic-temperature.z").label, "kinetic temperature z");
  EXPECT_NE(message([] { profile_quantity(2, "presure.xx"); }).find("did you mean 'pressure.xx'?"), std::string::npos);
  EXPECT_NE(message([] { profile_quantity(2, "velocity.z"); }).find("a profile has no quantity 'velocity.z'"),
            std::string::npos);
  Four const four;
  MassiveParticles const bodies(four.all, nullptr);
  EXPECT_EQ(message([&] { profile(bodies, four.box, 2, 0, 1, 3, 1); }), "a profile along axis 2: the space has 2 axes");
  EXPECT_EQ(message([&] { profile(bodies, four.box, 0, 0, 1, 0, 1); }), "a profile needs at least one bin");
  EXPECT_EQ(message([&] { profile(bodies, four.box, 0, 1, 1, 3, 1); }),
            "a profile goes from a lower to a higher place, not from 1 to 1");
  MomentSums sum;
  EXPECT_EQ(message([&] { sum.restore({}); }), "the checkpoint does not fit this diagnosis: its sums are others");
  EXPECT_TRUE(std::isnan(sum.matter(2, 1).velocity[0]));
}

TEST(Profile, SumsSurviveACheckpoint) {
  Four const four;
  MomentSums sum, other;
  MassiveParticles const bodies(four.all, &four.measures);
  sum.add(bodies.where([](double const*) { return true; }), 2);
  sum.add_volume(3);
  ASSERT_EQ(sum.state().size(), MomentSums::state_size);
  other.restore(sum.state());
  EXPECT_EQ(other.state(), sum.state());
  EXPECT_EQ(other.matter(2, 1).pressure, sum.matter(2, 1).pressure);
  EXPECT_EQ(other.matter(2, 1).internal_temperature, sum.matter(2, 1).internal_temperature);
}

TEST(Profile, DoesNotDependOnTheOrderOfParticles) {
  Box const box(Vector{0.0, 0.0}, Vector{10.0, 10.0}, Boundary::reflecting);
  Ensemble<Newton<2>> gas("gas", 3000), shuffled("gas", 3000);
  random_load(gas, box, {.seed = test_seed(1)});
  maxwellian_load(gas, {.temperature = 1, .seed = test_seed(2), .drift = {3, 0}});
  for (std::size_t i = 0; i < gas.size(); ++i) shuffled[i] = gas[(i * 1789 + 333) % gas.size()];
  AnyEnsemble const *const one[] = {&gas}, *const other[] = {&shuffled};
  Profile const first = profile(MassiveParticles(one, nullptr), box, 0, 0, 10, 7, 1),
                second = profile(MassiveParticles(other, nullptr), box, 0, 0, 10, 7, 1);
  for (auto const* quantity : {"density", "velocity.x", "kinetic-temperature", "kinetic-temperature.y"})
    EXPECT_EQ(first.values(quantity), second.values(quantity)) << quantity;
}

TEST(Profile, AsAPicture) {
  // Twice as hot and dense on the right: the curve says so.
  Box const box(Vector{0.0, 0.0}, Vector{10.0, 10.0}, Boundary::reflecting);
  Ensemble<Newton<2>> gas("gas", 3000);
  random_load(gas, box, {.seed = test_seed(1)});
  maxwellian_load(gas, {.temperature = 1, .seed = test_seed(2)});
  for (std::size_t i = 0; i < gas.size(); ++i)
    if (i % 3 > 0 && gas[i].position[0] < 5) gas[i].position[0] += 5;
  PairScheme scheme(box);
  scheme.internal(gas, LennardJones{0, 1}, 1);
  Simulation simulation(scheme, 0.1);
  simulation.integrate(gas, Method::leap_frog);
  UnitSystem const units = UnitSystem::reduced();
  PictureContext const context{simulation, units, "two halves", 0, 0, "", {}};
  Canvas const canvas =
      draw({.drawing = "profile", .x = "position.x", .y = "density, kinetic-temperature.y", .bins = 20}, context);
  ASSERT_EQ(canvas.curves().size(), 2U);
  EXPECT_EQ(canvas.curves()[0].label, "density");
  EXPECT_EQ(canvas.curves()[1].label, "kinetic temperature y");
  ASSERT_EQ(canvas.curves()[0].x.size(), 20U);
  double left = 0, right = 0;
  for (std::size_t b = 0; b < 20; ++b) (b < 10 ? left : right) += canvas.curves()[0].y[b] / 10;
  EXPECT_NEAR(left, 10, 1.6);  // a third of 30; five standard errors
  EXPECT_NEAR(right, 50, 1.6);
  EXPECT_EQ(canvas.x_axis().low, 0);
  EXPECT_EQ(canvas.x_axis().high, 10);
  Canvas const single = draw({.drawing = "profile"}, context);
  EXPECT_EQ(single.curves().size(), 1U);
  EXPECT_EQ(single.curves()[0].x.size(), 60U);  // 50 particles in each
  EXPECT_EQ(single.y_axis().label, "density");

  std::vector<AnyEnsemble*> const all{&gas};
  auto const says = [&](Picture const& picture) { return message([&] { check(picture, all, {}, {}); }); };
  EXPECT_EQ(says({.drawing = "profile", .y = "density, velocity.x"}), "no error");
  EXPECT_EQ(says({.drawing = "profile", .x = "position.z"}),
            "a profile in 2D is over position.x or position.y, not 'position.z'");
  EXPECT_NE(says({.drawing = "profile", .y = "densty"}).find("did you mean 'density'?"), std::string::npos);
}

}  // namespace
}  // namespace boltzmann::profile_test
