// Slabs: who is in them, what they are like when matter is squeezed and turned, and what is refused.
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/diagnoses/slab.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/meso.hpp>
#include <boltzmann/particles/tracer.hpp>

#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

namespace boltzmann::slab_test {
namespace {

std::map<std::string, double> look(Diagnosis& slab, std::vector<AnyEnsemble*> const& all, Box const& box,
                                   double boltzmann_constant = 1) {
  std::vector<double> values;
  slab.measure(Sample{all, box, nullptr, boltzmann_constant, 0, 0}, values);
  auto const columns = slab.columns();
  EXPECT_EQ(values.size(), columns.size());
  std::map<std::string, double> named;
  for (std::size_t c = 0; c < columns.size(); ++c) named[columns[c].name] = values[c];
  EXPECT_EQ(named.size(), columns.size());
  return named;
}

TEST(Slab, ByHandAndFollowed) {
  Box const box(Vector{0.0, 0.0}, Vector{10.0, 4.0}, Boundary::reflecting);
  Ensemble<Newton<2>> atoms("atoms", 2);
  Ensemble<Meso<2>> lumps("lumps", 3);
  std::vector<AnyEnsemble*> const all{&atoms, &lumps};
  std::vector<AnyEnsemble const*> const available{&atoms, &lumps};
  atoms[0].position = {1, 1};
  atoms[1] = {{{2.0, 1.0}}, 2, {3.0, 0.0}};
  lumps[0] = {{{{3.0, 1.0}}, 4, {0.0, -1.0}}, 9, 300};
  lumps[1] = {{{{4.0, 2.0}}, 2, {1.0, 2.0}}, 9, 100};
  lumps[2].position = {4.5, 1};
  Slab slab(available, {.axis = 0, .from = 1.5, .to = 4.25});
  EXPECT_TRUE(slab.by_number() && !slab.needs_energies() && slab.state().empty());
  auto v = look(slab, all, box, 0.5);
  // Masses 2, 4, 2 with (3, 0), (0, -1), (1, 2): mean (1, 0); deviations (2, 0), (-1, -1), (0, 2).
  EXPECT_NEAR(v.at("slab kinetic temperature x"), 12, 1e-13);
  EXPECT_NEAR(v.at("slab kinetic temperature y"), 12, 1e-13);
  EXPECT_NEAR(v.at("slab kinetic temperature"), 12, 1e-13);
  EXPECT_NEAR(v.at("slab internal temperature"), 150, 1e-12);
  EXPECT_NEAR(v.at("slab velocity x"), 1, 1e-15);
  EXPECT_NEAR(v.at("slab velocity y"), 0, 1e-15);
  EXPECT_NEAR(v.at("slab position x"), 3, 1e-15);
  EXPECT_NEAR(v.at("slab density"), 8 / (4 * std::sqrt(12 * 2 / 3.0)), 1e-13);
  EXPECT_EQ(slab.state(), (std::vector<double>{1, 1, 2, 0, 1}));

  // Two go away, a stranger comes in.
  atoms[1].position = {9, 1};
  lumps[0].position = {8, 1};
  lumps[2].position = {3, 3};
  v = look(slab, all, box, 0.5);
  EXPECT_NEAR(v.at("slab kinetic temperature x"), 12, 1e-13);
  EXPECT_NEAR(v.at("slab position x"), (2 * 9 + 4 * 8 + 2 * 4) / 8.0, 1e-14);

  Slab other(available, {.axis = 0, .from = 1.5, .to = 4.25});
  other.restore(slab.state());
  EXPECT_EQ(look(other, all, box, 0.5), v);
  for (std::vector<double> const& wrong :
       std::vector<std::vector<double>>{{1}, {1, 1, 2, 0}, {1, 1, 2, 0, 1, 1}, {-1, 2}, {NAN}})
    EXPECT_EQ(message([&] { other.restore(wrong); }),
              "the checkpoint does not fit this diagnosis: its slabs are others");
  lumps.resize(1);
  EXPECT_EQ(message([&] { look(slab, all, box); }), "a slab has particle 1 of 'lumps', which has 1 now");
}

TEST(Slab, SqueezedCrystalHasItsDensity) {
  // Four slabs of a crystal, one of them squeezed to half its width: densities within 1 %.
  Ensemble<Newton<3>> crystal("crystal");
  block_load(crystal, {Lattice::square, 1, {40, 5, 5}, {0.5, 0.5, 0.5}});
  Box const box(Vector{0.0, 0.0, 0.0}, Vector{40.0, 5.0, 5.0},
                {Boundary::reflecting, Boundary::periodic, Boundary::periodic});
  std::vector<AnyEnsemble*> const all{&crystal};
  for (auto& p : crystal) p.mass = 3;
  Slab slab({&crystal}, {.axis = 0, .count = 4, .label = "window"});
  auto v = look(slab, all, box);
  for (auto& p : crystal)
    if (p.position[0] < 10) p.position[0] = 5 + p.position[0] / 2;
  v = look(slab, all, box);
  EXPECT_NEAR(v.at("window 1 density"), 6, 0.06);
  EXPECT_NEAR(v.at("window 1 position x"), 7.5, 1e-13);
  for (char const* name : {"window 2 density", "window 3 density", "window 4 density"})
    EXPECT_NEAR(v.at(name), 3, 0.03);
  EXPECT_NEAR(v.at("window 4 position x"), 35, 1e-13);
  EXPECT_EQ(v.at("window 4 kinetic temperature"), 0);
  EXPECT_TRUE(std::isnan(v.at("window 4 internal temperature")));
}

TEST(Slab, GoesThroughAPeriodicWall) {
  Box const box(Vector{-5.0}, Vector{5.0}, Boundary::periodic);
  Ensemble<Newton<1>> gas("gas", 1000);
  random_load(gas, box, {.seed = test_seed(2)});
  std::vector<AnyEnsemble*> const all{&gas};
  Slab slab({&gas}, {.axis = 0, .from = 1, .to = 4});
  auto const before = look(slab, all, box);
  // About 300 particles; the width is that of their variance, which varies by sqrt(0.8 / 300): 5 of both together.
  EXPECT_NEAR(before.at("slab density"), 100, 5 * 100 * std::sqrt(0.7 / 300 + 0.2 / 300));
  for (auto& p : gas) p.position[0] = box.wrapped(p.position[0] + 3, 0);
  auto const after = look(slab, all, box);
  EXPECT_NEAR(after.at("slab density"), before.at("slab density"), 1e-9);
  EXPECT_NEAR(after.at("slab position x"), before.at("slab position x") + 3 - 10, 1e-11);
}

TEST(Slab, WhatAWindowCanNotBe) {
  Box const box(Vector{0.0, 0.0}, Vector{10.0, 4.0}, Boundary::reflecting);
  Ensemble<Newton<2>> atoms("atoms", 1);
  atoms[0].position = {1, 1};
  std::vector<AnyEnsemble*> const all{&atoms};
  auto const says = [&](SlabOptions const& options) {
    return message([&] {
      Slab slab({&atoms}, options);
      look(slab, all, box);
    });
  };
  EXPECT_EQ(says({.axis = 0}), "no error");
  EXPECT_EQ(says({.axis = 0, .from = 2, .to = 3}), "a slab along x from 2 to 3 has no particle at the start");
  EXPECT_EQ(says({.axis = 0, .count = 2}), "a slab along x from 5 to 10 has no particle at the start");
  EXPECT_EQ(says({.axis = 0, .from = 3, .to = 2}), "a slab along x from 3 to 2: its begin must be below its end");
  EXPECT_EQ(says({.axis = 0, .from = 11}), "a slab along x from 11 to 10: its begin must be below its end");
  EXPECT_EQ(says({.axis = 2}), "a slab along axis z: the space has 2 axes");
  EXPECT_EQ(says({.axis = 0, .count = 0}), "a slab diagnosis needs at least one slab");
  EXPECT_EQ(message([] { Slab slab({}, {}); }), "a slab needs particles; the simulation has none");
  Ensemble<Tracer<2>> vortices("vortices", 1);
  EXPECT_EQ(message([&] { Slab slab({&vortices}, {}); }),
            "a slab needs particles with a mass and a velocity; no ensemble that was chosen has both");
  // One particle: no temperature, no width.
  Slab one({&atoms}, {.axis = 0});
  auto const v = look(one, all, box);
  EXPECT_TRUE(std::isnan(v.at("slab kinetic temperature")) && std::isnan(v.at("slab density")));
  EXPECT_EQ(v.at("slab position x"), 1);
}

TEST(Slab, IsInTheCatalogue) {
  Box const box(Vector{0.0, 0.0}, Vector{10.0, 4.0}, Boundary::reflecting);
  Ensemble<Newton<2>> atoms("atoms", 2), others("others", 5);
  atoms[0].position = {1, 1};
  atoms[1].position = {1, 3};
  std::vector<AnyEnsemble*> const all{&atoms, &others};
  DiagnosisParameters with{.available = {&atoms, &others}};
  with.ensembles = {"atoms"};
  with.axis = "y";
  with.from = 0;
  with.to = 4;
  with.count = 2;
  with.label = "layer";
  auto const slab = make_diagnosis("slab", with);
  EXPECT_EQ(look(*slab, all, box).at("layer 2 position y"), 3);
  auto const columns = slab->columns();
  ASSERT_EQ(columns.size(), 16U);
  EXPECT_EQ(columns[0].name, "layer 1 kinetic temperature");
  EXPECT_EQ(columns[4].dimension, dimensions::mass / dimensions::area);
  with.since = 3;
  EXPECT_NE(message([&] { make_diagnosis("slab", with); }).find("diagnosis slab has no option since"),
            std::string::npos);
  with.since = 0;
  with.ensembles = {"atom"};
  EXPECT_NE(message([&] { make_diagnosis("slab", with); }).find("did you mean 'atoms'?"), std::string::npos);
}

}  // namespace
}  // namespace boltzmann::slab_test
