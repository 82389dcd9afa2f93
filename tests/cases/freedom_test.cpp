// Kind of fault: degrees of freedom were counted in each place anew, so that an event, the start, a bath, a kick and the
// diagnoses disagreed where particles are frozen, deactivated or joined by rigid bonds.
//
// The files are those reports. The sweep covers their siblings: plain, frozen, deactivated and rigid particles in 2D and
// 3D, with a momentum that is kept (periodic) or not (a heat bath from outside), in one ensemble and in two, for the
// start, events, kicks, global and local temperatures. Right values are counts: D for each moving particle, less the rank
// of rigid bonds, less one along each axis whose momentum is kept and zero.
#include "tests/cases/case.hpp"

#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/diagnoses/profile.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/schemes/molecules/rigid_bonds.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace boltzmann::freedom_test {
namespace {

using test::Case;

/// Rows of a column at this time and later.
std::vector<double> from(Case const& run, std::string const& column, double time) {
  auto const times = run.column("time"), all = run.column(column);
  std::vector<double> rows;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (times[k] > time - 1e-9) rows.push_back(all[k]);
  return rows;
}

TEST(Freedom, AnEventCountsRigidBonds) {
  Case const run("event-rigid");
  ASSERT_EQ(run.run().status, 0);
  EXPECT_NEAR(run.column("temperature").front(), 1, 0.15);  // drawn, not exact
  for (double const t : from(run, "temperature", 0.05)) EXPECT_NEAR(t, 2, 1e-8);
}

TEST(Freedom, FrozenParticlesHaveNone) {
  Case const run("event-frozen");
  ASSERT_EQ(run.run().status, 0);
  for (double const t : run.column("temperature")) EXPECT_NEAR(t, 1, 1e-9);
  for (double const k : run.column("kinetic energy")) EXPECT_NEAR(k, 384, 1e-6);
  for (char const* axis : {"momentum x", "momentum y", "momentum z"})
    EXPECT_NEAR(run.column(axis).front(), 0, 1e-11) << axis;
}

TEST(Freedom, AnExactStartIsExactWithRigidBonds) {
  Case const run("exact-rigid");
  ASSERT_EQ(run.run().status, 0);
  for (double const t : run.column("temperature")) EXPECT_NEAR(t, 1, 1e-8);
}

TEST(Freedom, AKickLeavesThoseAtRestAlone) {
  Case const run("kick-frozen");
  ASSERT_EQ(run.run().status, 0);
  EXPECT_EQ(run.column("kinetic energy").front(), 0);
  for (double const k : from(run, "kinetic energy", 0.05)) EXPECT_NEAR(k, 0.5, 1e-12);
  for (double const p : from(run, "momentum x", 0.05)) EXPECT_NEAR(p, 1, 1e-12);
}

TEST(Freedom, AnEquilibrationSparesFrozenParticles) {
  Case const run("equilibrate-frozen");
  ASSERT_EQ(run.run().status, 0);
  EXPECT_NEAR(run.column("temperature").front(), 1, 5 * std::sqrt(2.0 / 768));
  auto scenario = load_scenario((run / "equilibrate-frozen.toml").string());
  AnyEnsemble const& atoms = *scenario->ensembles.front();
  std::vector<double> const before = atoms.column(atoms.field("position"));
  scenario->simulation->run(3);
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    bool const frozen = before[i] < 4;
    EXPECT_EQ(atoms.row(i)[0] == before[i], frozen) << i;
    EXPECT_EQ(atoms.row(i)[atoms.field("velocity").offset] == 0, frozen) << i;
  }
}

TEST(Freedom, TenDistancesOfMethaneAreNine) {
  Case const run("methane-10");
  ASSERT_EQ(run.run().status, 0);
  auto const temperature = run.column("temperature"), kinetic = run.column("kinetic energy");
  double mean = 0;
  for (std::size_t k = 0; k < kinetic.size(); ++k) {
    EXPECT_NEAR(kinetic[k] / temperature[k], 27 * 3, 1e-8);
    if (k >= 50) mean += temperature[k] / static_cast<double>(kinetic.size() - 50);
  }
  // 159 degrees of freedom, forgotten in 1 / 20 of a unit of time: some 70 independent looks.
  EXPECT_NEAR(mean, 1, 5 * std::sqrt(2.0 / 159 / 70));
}

TEST(Freedom, LinesAndPlanesAreRigidBodies) {
  for (auto const& [file, freedom] : std::map<std::string, double>{{"co2", 5}, {"square", 6}}) {
    Case const run(file);
    ASSERT_EQ(run.run().status, 0) << file;
    auto const temperature = run.column("temperature"), kinetic = run.column("kinetic energy");
    EXPECT_NEAR(kinetic.back() / temperature.back(), freedom / 2, 1e-9) << file;
    EXPECT_NEAR(kinetic.back(), kinetic.front(), 1e-9 * kinetic.front()) << file;  // none acts on them
  }
}

/// Particles without forces between them.
struct Sweep {
  int dimension;
  std::string kind;  // plain, frozen, deactivated, rigid
  bool kept;         // momentum
  std::string more = {};

  std::string text() const {
    std::string const D = dimension == 2 ? "8, 8" : "8, 8, 8", zero = dimension == 2 ? "0, 0" : "0, 0, 0", counts = D;
    std::string text = fmt::format(
        "[units]\nbase = \"reduced\"\n[box]\nlow = [{}]\nhigh = [{}]\nboundary = \"periodic\"\n"
        "[run]\nstep = 0.005\nsteps = 20\n[[ensembles]]\nname = \"a\"\nclass = \"Newton\"\nmass = 2\ntemperature = 1\n"
        "remove_drift = true\nexact_temperature = true\n{}",
        zero, D, kind == "rigid" ? "molecule = 2\nbonds = \"chain\"\n" : "");
    text += fmt::format("load = {{ kind = \"{}\", counts = [{}]{} }}\n", kind == "rigid" ? "path" : "block", counts,
                        kind == "rigid" ? "" : ", lattice = \"square\", spacing = 1");
    if (kind == "frozen") text += "[[ensembles.set]]\nwhere = \"x < 4\"\nfreeze = true\n";
    if (kind == "deactivated")
      text += fmt::format(
          "[[ensembles]]\nname = \"wall\"\nclass = \"Newton\"\nintegrator = \"deactivate\"\nnumber = 9\n"
          "load = {{ kind = \"random\" }}\nvelocity = [{}]\n",
          dimension == 2 ? "3, 0" : "3, 0, 0");
    if (kind == "rigid") text += "[[rigid_bonds]]\non = \"a\"\nlength = 1\n";
    if (!kept)  // all but no bath: it is there
      text += "[[dissipation]]\nkind = \"langevin\"\non = \"a\"\ntemperature = 1\nrate = 1e-12\n";
    text += "[[diagnoses]]\nkind = \"temperature\"\n[[diagnoses]]\nkind = \"energies\"\n[output]\ndiagnoses = 1\n";
    return text + more;
  }
  double freedom() const {
    double const all = std::pow(8, dimension);
    double const moving = kind == "frozen" ? all / 2 : all, bonds = kind == "rigid" ? all / 2 : 0;
    bool const zero = kept && (kind == "plain" || kind == "rigid");
    return dimension * (moving - (zero ? 1 : 0)) - bonds;
  }
};

std::vector<Sweep> sweep() {
  std::vector<Sweep> all;
  for (int const dimension : {2, 3})
    for (char const* kind : {"plain", "frozen", "deactivated", "rigid"})
      for (bool const kept : {true, false}) all.push_back({dimension, kind, kept});
  return all;
}

TEST(Freedom, StartAndEventsAgreeWithTheDiagnosis) {
  for (auto one : sweep()) {
    SCOPED_TRACE(fmt::format("{} {} {}", one.dimension, one.kind, one.kept));
    one.more = "[[events]]\nat = 0.05\ntemperature = 2\n";
    Case const run("sweep", one.text());
    ASSERT_EQ(run.run().status, 0);
    EXPECT_NEAR(run.column("temperature").front(), 1, 1e-9);
    EXPECT_NEAR(run.column("kinetic energy").front(), one.freedom() / 2, 1e-9 * one.freedom());
    for (double const t : from(run, "temperature", 0.05)) EXPECT_NEAR(t, 2, 1e-6);
  }
}

TEST(Freedom, OneBinOfAProfileHasTheTemperatureOfAll) {
  for (auto one : sweep()) {
    if (one.dimension == 2 || one.kind == "deactivated") continue;
    SCOPED_TRACE(fmt::format("{} {}", one.kind, one.kept));
    one.more = "[[diagnoses]]\nkind = \"mean-profile\"\naxis = \"x\"\ncount = 1\nquantity = \"kinetic-temperature\"\n";
    Case const run("profile", one.text());
    ASSERT_EQ(run.run({"--steps", "0"}).status, 0);
    // A mean velocity is taken off, which is zero here; where it is not kept it could have been another one.
    bool const zero = one.kept && one.kind != "frozen";
    double const right = zero ? 1 : one.freedom() / (one.freedom() - 3);
    EXPECT_NEAR(run.column("lowest kinetic temperature").front(), right, 1e-9);
  }
}

TEST(Freedom, TwoSpeciesHaveOneExactTemperature) {
  std::string text = Sweep{3, "plain", true}.text();
  text +=
      "[[ensembles]]\nname = \"b\"\nclass = \"Newton\"\nmass = 7\nnumber = 20\ntemperature = 1\nremove_drift = true\n"
      "exact_temperature = true\nload = { kind = \"random\" }\n"
      "[[diagnoses]]\nkind = \"temperature\"\nensembles = [\"a\", \"b\"]\n";
  Case const run("species", text);
  ASSERT_EQ(run.run().status, 0);
  for (char const* column : {"temperature", "a temperature", "b temperature"})
    EXPECT_NEAR(run.column(column).front(), 1, 1e-9) << column;
}

TEST(Freedom, ABeamKeepsItsDriftUnlessItIsSubtracted) {
  // A momentum that is kept but not zero is a part of the temperature, as the particles were loaded.
  std::string text = Sweep{3, "plain", true}.text();
  text.replace(text.find("temperature = 1"), 15, "drift = [3, 0, 0]\ntemperature = 1");
  text += "[[events]]\nat = 0.05\ntemperature = 0\n";
  Case const run("beam", text);
  ASSERT_EQ(run.run().status, 0);
  EXPECT_NEAR(run.column("kinetic energy").front(), 1.5 * 511 + 0.5 * 2 * 9 * 512, 1e-6);
  for (double const k : from(run, "kinetic energy", 0.05)) EXPECT_NEAR(k, 0.5 * 2 * 9 * 512, 1e-6);
}

TEST(Freedom, EachEndOfARigidBondHasItsOwn) {
  // Dumbbells of masses 15 and 1 across two bins. A bond takes 1/16 of a degree of freedom from the heavy end and 15/16
  // from the light one: kinetic energies of 47/32 and 33/32 kT, which a count by bonds alone would call 0.98 and 0.69 of
  // the temperature. Spread: 2 / f of 20,000.
  std::size_t const count = 20'000;
  Ensemble<Newton<3>> atoms("atoms", 2 * count);
  Box const box({0., 0., 0.}, {8., 8., 8.}, Boundary::periodic);
  std::vector<BondMembers> bonds;
  for (std::uint32_t i = 0; i < count; ++i) {
    Stream stream(5, 0, i, Purpose::velocity);
    double const y = 8 * stream.uniform(), z = 8 * stream.uniform();
    atoms[2 * i].position = {2, y, z}, atoms[2 * i + 1].position = {5, y, z};
    atoms[2 * i].mass = 15, atoms[2 * i + 1].mass = 1;
    for (int a = 0; a < 3; ++a) {
      atoms[2 * i].velocity[a] = stream.normal() / std::sqrt(15.0);
      atoms[2 * i + 1].velocity[a] = stream.normal();
    }
    bonds.push_back({2 * i, 2 * i + 1});
  }
  RigidBonds rigid(atoms, box, bonds, 3);
  rigid.settle();
  EXPECT_EQ(rigid.rank(), count);
  auto const taken = rigid.taken_freedom();
  atoms.mobility.taken.assign(taken.begin(), taken.end());
  EXPECT_NEAR(atoms.mobility.taken[0], 1.0 / 16, 1e-8);
  std::vector<AnyEnsemble const*> const all{&atoms};
  Profile const found = profile(MassiveParticles(all, nullptr), box, 0, 0, 8, 2, 1);
  for (auto const& bin : found.matter) {
    EXPECT_EQ(bin.number, count);
    EXPECT_NEAR(bin.mean_kinetic_temperature, 1, 5 * std::sqrt(2.0 / (2 * count)));
  }
  EXPECT_NEAR(temperature(atoms, 1).total, 1, 5 * std::sqrt(2.0 / (5 * count)));
}

}  // namespace
}  // namespace boltzmann::freedom_test
