// The catalogue of laws: every entry is complete, unambiguous and says what the law's own type says.
#include <gtest/gtest.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/drag.hpp>
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/laws/magnetic.hpp>
#include <boltzmann/laws/morse.hpp>
#include <boltzmann/laws/rydberg.hpp>
#include <boltzmann/laws/spring.hpp>
#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/scenario/classes.hpp>
#include <boltzmann/scenario/law_binding.hpp>
#include <boltzmann/scenario/laws.hpp>

#include <filesystem>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace boltzmann::catalogue_test {
namespace {

Parameter const& parameter(std::string_view law, std::string_view name) {
  for (auto const& p : law_info(law).parameters)
    if (p.name == name) return p;
  throw Error("no parameter " + std::string(name));
}

TEST(LawCatalogue, NamesAreUniqueWordsOfScenarios) {
  std::set<std::string_view> names;
  for (auto const& law : scenario_laws()) {
    EXPECT_TRUE(names.insert(law.name).second) << law.name << " twice";
    EXPECT_FALSE(law.name.empty());
    EXPECT_EQ(law.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz-"), std::string_view::npos) << law.name;
  }
  EXPECT_GE(names.size(), 16U);
}

TEST(LawCatalogue, EveryEntryIsDocumented) {
  for (auto const& law : scenario_laws()) {
    EXPECT_GT(law.doc.size(), 10U) << law.name;
    EXPECT_EQ(law.doc.find('\n'), std::string_view::npos) << law.name;
    EXPECT_FALSE(law.formula.empty()) << law.name;
    EXPECT_FALSE(law.target.empty()) << law.name;
    EXPECT_EQ(law.source.empty(), law.kind == LawKind::external) << law.name;
    EXPECT_FALSE(law.type.empty()) << law.name;
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(BOLTZMANN_SOURCE) / law.header)) << law.header;
    EXPECT_LE(1, law.least_dimension) << law.name;
    EXPECT_LE(law.least_dimension, law.greatest_dimension) << law.name;
    EXPECT_LE(law.greatest_dimension, 3) << law.name;
    std::set<std::string_view> names;
    for (auto const& p : law.parameters) {
      EXPECT_TRUE(names.insert(p.name).second) << law.name << " " << p.name;
      EXPECT_GT(p.doc.size(), 5U) << law.name << " " << p.name;
      EXPECT_NE(law.formula.find(p.name), std::string_view::npos)
          << law.name << ": " << p.name << " is not in the formula";
    }
  }
}

TEST(LawCatalogue, AgreesWithTheTypes) {
  EXPECT_EQ(law_info("lennard-jones").symmetry, symmetry_of<LennardJones>());
  EXPECT_EQ(law_info("morse").symmetry, symmetry_of<Morse>());
  EXPECT_EQ(law_info("rydberg").symmetry, symmetry_of<Rydberg>());
  EXPECT_EQ(law_info("spring").symmetry, symmetry_of<Spring>());
  EXPECT_EQ(law_info("coulomb").symmetry, symmetry_of<LaplaceLaw>());
  EXPECT_EQ(law_info("gravity").symmetry, symmetry_of<LaplaceLaw>());
  EXPECT_EQ(law_info("biot-savart").symmetry, symmetry_of<BiotSavart>());
  for (auto const& law : scenario_laws())
    EXPECT_EQ(law.velocity_dependent,
              (law.name == "drag" && depends_on_velocity<Drag>()) ||
                  (law.name == "uniform-magnetic-field" && depends_on_velocity<UniformMagneticField<3>>()))
        << law.name;
}

/// What a law gives to two particles, where all but their positions are drawn from this seed.
std::vector<double> influences(LawInfo const& law, ParameterValues const& values, int dimension, unsigned seed) {
  auto const particles = [&](std::string_view name) {
    return find_class(name == "Particle" ? "Newton" : name)->in(dimension)->make(std::string(name), 2);
  };
  auto const target = particles(law.target), other = law.source == law.target ? nullptr : particles(law.source);
  AnyEnsemble& source = other ? *other : *target;
  std::minstd_rand random(seed);
  for (auto* ensemble : {target.get(), &source})
    for (std::size_t i = 0; i < 2; ++i) {
      double* const row = ensemble->row(i);
      for (std::size_t k = 0; k < ensemble->doubles(); ++k)
        row[k] = 0.5 + 1e-9 * static_cast<double>(random() % 1000000);
      for (int a = 0; a < dimension; ++a)
        row[a] = 0.3 * static_cast<double>(i) + 0.1 * a + (ensemble == &source ? 0.2 : 0);
    }
  PairScheme scheme(Box(dimension, {-1, -1, -1}, {1, 1, 1}, {Boundary::open, Boundary::open, Boundary::open}));
  install_pairs(scheme, law, values, other ? LawUse::one_way : LawUse::internal, *target, source, no_cutoff);
  scheme.calculate();
  auto const all = target->influences();
  return {all.begin(), all.end()};
}

// Ranks send no more than positions of what laws say reads no more: each is asked with other velocities, masses, charges.
TEST(LawCatalogue, ThoseOfPositionsAloneReadNothingElse) {
  int alone = 0;
  for (auto const& law : scenario_laws()) {
    if (law.kind != LawKind::pair) continue;
    ParameterValues values;
    for (auto const& parameter : law.parameters) values.emplace_back(parameter.name, std::vector{1.0});
    bool reads_more = false, says_so = false;
    for (int D = law.least_dimension; D <= law.greatest_dimension; ++D) {
      says_so = law.bind(values, D).traits.positions_alone;
      reads_more = reads_more || influences(law, values, D, 1) != influences(law, values, D, 2);
    }
    EXPECT_EQ(says_so, !reads_more) << law.name;
    alone += says_so ? 1 : 0;
  }
  EXPECT_GE(alone, 6);
}

TEST(LawCatalogue, Dimensions) {
  // A formula's energy must be an energy: written here by hand from the formulas.
  using namespace dimensions;
  EXPECT_EQ(parameter("lennard-jones", "depth").dimension.in(3), energy);
  EXPECT_EQ(parameter("spring", "stiffness").dimension.in(3) * length * length, energy);
  EXPECT_EQ(parameter("morse", "a").dimension.in(3) * length, none);
  EXPECT_EQ(parameter("rydberg", "a").dimension.in(3), none);
  EXPECT_EQ(parameter("coulomb", "k").dimension.in(3) * charge * charge / length, energy);
  EXPECT_EQ(parameter("gravity", "G").dimension.in(3) * mass * mass / length, energy);
  EXPECT_EQ(parameter("drag", "friction").dimension.in(3) * velocity, force);
  EXPECT_EQ(parameter("uniform-gravity", "acceleration").dimension.in(3) * mass, force);
  EXPECT_EQ(parameter("uniform-electric-field", "field").dimension.in(3) * charge, force);
  EXPECT_EQ(parameter("uniform-magnetic-field", "field").dimension.in(3) * velocity * charge, force);
  EXPECT_EQ(parameter("uniform-flow", "velocity").dimension.in(3), velocity);
  EXPECT_EQ(parameter("oscillating-flow", "velocity").dimension.in(3), velocity);
  EXPECT_EQ(parameter("oscillating-flow", "angular_frequency").dimension.in(3) * time, angle);
  EXPECT_EQ(parameter("shear-flow", "direction").dimension.in(3) * parameter("shear-flow", "gradient").dimension.in(3) *
                parameter("shear-flow", "origin").dimension.in(3),
            velocity);
  EXPECT_EQ(parameter("strain-flow", "rates").dimension.in(3) * parameter("strain-flow", "origin").dimension.in(3),
            velocity);
}

TEST(LawCatalogue, UnknownNamesAreAnErrorThatHelps) {
  EXPECT_EQ(law_info("gravity").type, "gravity");
  try {
    law_info("lenard-jones");
    FAIL();
  } catch (Error const& error) {
    EXPECT_NE(std::string(error.what()).find("lennard-jones"), std::string::npos) << error.what();
  }
  EXPECT_THROW(law_info(""), Error);
}

}  // namespace
}  // namespace boltzmann::catalogue_test
