// Divided runs in which something changes between steps or particles hang together: events, adaptations, barostats,
// molecules, several lists, substeps. All have the bits of one rank.
#include "tests/simulation/divided_runs.hpp"

#include <boltzmann/dissipation/langevin_bath.hpp>
#include <boltzmann/dissipation/nose_hoover.hpp>
#include <boltzmann/dissipation/pair_dissipation.hpp>
#include <boltzmann/dissipation/rigid_motion.hpp>
#include <boltzmann/laws/angular.hpp>
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/laws/soft.hpp>
#include <boltzmann/laws/spring.hpp>
#include <boltzmann/laws/uniform.hpp>
#include <boltzmann/neighbours/bonds.hpp>
#include <boltzmann/particles/smooth.hpp>
#include <boltzmann/schemes/molecules/molecule_scheme.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>
#include <boltzmann/simulation/velocity_changes.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

namespace boltzmann::divided_changes_test {
namespace {

using test::expect_same_bits;
using test::expect_to_go_on;
using test::Make;
using test::melt;
using test::scenario;
using test::World;

template <class T>
T& part_of(World& world, std::size_t number) {
  return *static_cast<T*>(world.parts[number].get());
}

// ---- Events ----

TEST(DividedEvents, ChangeVelocitiesLawsAndMethods) {
  expect_same_bits(
      [](World& world) {
        melt<2>(world, 30, 1.0, Boundary::reflecting);
        auto& atoms = part_of<Ensemble<Newton<2>>>(world, 0);
        auto& scheme = part_of<PairScheme>(world, 1);
        Simulation& simulation = *world.simulation;
        simulation.happen(
            0.02,
            [&] {
              kick({{&atoms, {3, 5, 700}}}, {0.5, -0.2, 0});
            },
            false);
        simulation.happen(
            0.05, [&] { scheme.internal(atoms, Soft{.repulsion = 0.1, .range = 1.7}, 1.7); }, true);
        simulation.happen(
            0.05, [&] { scheme.skin(0.4); }, true);
        simulation.happen(
            0.09, [&] { simulation.integrate(atoms, Method::rk2); }, true);
        simulation.happen(
            0.1,
            [&] {
              scheme.external(atoms, UniformGravity<2>{{0.1, 0}});
            },
            true);
      },
      40, {2, 3, 5});
}

TEST(DividedEvents, OfMethodsThatABathBeforeTheRunCouldNotHave) {
  expect_to_go_on([](World& world) {
    melt<2>(world, 20, 0.5, Boundary::periodic);
    auto& atoms = part_of<Ensemble<Newton<2>>>(world, 0);
    Simulation& simulation = *world.simulation;
    auto bath = std::make_shared<LangevinBath>(1.0, 1.0, 1.0);
    bath->on(atoms);
    simulation.equilibrate(bath, 2);
    simulation.happen(
        0.03, [&] { simulation.integrate(atoms, Method::rk2); }, true);
  });
}

TEST(DividedEvents, OfScenarios) {
  ScenarioText const text{R"(
[units]
base = "reduced"
[box]
low = [0, 0]
high = [24, 24]
boundary = "periodic"
[run]
step = 0.005
steps = 60
cutoff = 2.5
[[ensembles]]
name = "atoms"
class = "Newton"
temperature = 0.5
load = { kind = "fill", lattice = "square", spacing = 1.2 }
[[influences]]
law = "lennard-jones"
on = "atoms"
depth = 1
r0 = 1.12
[[dissipation]]
kind = "langevin"
on = "atoms"
temperature = 0.5
rate = 1
[[events]]
at = 0.05
set = { "dissipation.0.temperature" = 1.5 }
[[events]]
at = 0.1
temperature = 0.1
where = "x < 8"
[[events]]
at = 0.1
kick = [0.5, 0]
where = "y < 4"
[[events]]
at = 0.07
on = "atoms"
add = { velocity = [2, 1], load = { kind = "positions", positions = [[12.03, 12.02], [0.02, 23.98]] } }
)",
                          "events.toml", "events", ""};
  expect_same_bits(scenario(text), 40, {2, 3, 5});
}

// ---- Adaptations ----

TEST(DividedAdaptations, PutAtomsInAndTakeThemOut) {
  expect_same_bits(
      [](World& world) {
        melt<2>(world, 26, 0.5, Boundary::reflecting);
        auto& atoms = part_of<Ensemble<Newton<2>>>(world, 0);
        auto& times = world.make<int>(0);
        world.simulation->adapt(5, [&] {
          switch (++times % 4) {
            case 0:
              return;  // nothing
            case 1:
              return atoms.resize(atoms.size() - 37);
            case 2:
              atoms[11].velocity[0] += 0.3;
              return;
            default:
              Newton<2> atom = atoms[atoms.size() - 1];
              atom.position[1] += 1.15;
              atoms.add(atom);
          }
        });
      },
      50, {2, 3, 5});
}

TEST(DividedAdaptations, OfMetals) {
  expect_same_bits(
      [](World& world) {
        scenario("copper-3d")(world);
        auto& copper = *world.simulation->schemes()[0]->ensembles()[0];
        world.simulation->adapt(4, [&] { copper.resize(copper.size() - 3); });
      },
      12, {2, 3});
}

TEST(DividedAdaptations, RezoneAGas) {
  ScenarioText const text{R"toml(
[units]
base = "si"
[box]
low = [0, 0]
high = [1, 1]
boundary = ["periodic", "mirror"]
[run]
step = 0.005
steps = 40
[smooth]
[[smooth.rezone]]
every = 5
on = "gas"
split_above = "1.1 kg/m^2"
smallest_mass = "1 g"
merge_below = "900 g/m^2"
largest_mass = 0.005
merge_within = 0.7
[[ensembles]]
name = "gas"
class = "Smooth"
range = 0.13
integrator = "leap-frog"
load = { kind = "fill", spacing = 0.05 }
formulas = { density = "(1 + 0.4*sin(2*pi*x/(1 m)))*(1 kg/m^2)", specific_energy = "1" }
material = { kind = "ideal-gas", gamma = 1.4, specific_heat = 1 }
)toml",
                          "rezone.toml", "rezone", ""};
  expect_same_bits(scenario(text), 22, {2, 3, 5});
}

// Lists of forces that are calculated every other step are built for whoever looks in between.
TEST(DividedLooks, LeaveForcesWithParticlesThatGetOtherOwners) {
  ScenarioText const text{R"toml(
[units]
base = "reduced"
[box]
low = [0]
high = [960]
[run]
step = 0.008
steps = 25
cutoff = 1.27
skin = 0.05
[[ensembles]]
name = "driven"
class = "Newton"
number = 71
load = { kind = "random", high = [630] }
[[ensembles]]
name = "others"
class = "Newton"
number = 143
load = { kind = "random", minimum_distance = 0.64 }
[[influences]]
energy = "1.8*exp(-r/0.3)"
every = 2
between = ["others", "driven"]
[[influences]]
influence = "0.3*sin(5*time)*position"
from_outside = true
on = "driven"
)toml",
                          "slow.toml", "slow", ""};
  expect_same_bits(scenario(text), 25, {2, 3});
}

// Influences of both hold from one step to the next, since some are of velocities inside of it.
TEST(DividedRates, OfFieldsBesideThoseThatLeapFrogMoves) {
  ScenarioText const text{R"toml(
[units]
base = "reduced"
[box]
low = [0, 0]
high = [16, 16]
boundary = "periodic"
[run]
step = 0.02
steps = 40
cutoff = 1.5
[[classes]]
name = "Bird"
base = "Newton"
fields = [{ name = "angle", period = "2 pi" }, { name = "turn", sum = true }]
rate.angle = "0.1*turn + sin(9*time)"
[[ensembles]]
name = "walkers"
class = "Bird"
integrator = "euler"
number = 150
load = { kind = "random" }
temperature = 1
[[ensembles]]
name = "flyers"
class = "Bird"
number = 150
load = { kind = "random" }
temperature = 1
[[influences]]
changes = "turn"
influence = "sin(q.angle - p.angle + r)"
among = ["walkers", "flyers"]
)toml",
                          "birds.toml", "birds", ""};
  expect_to_go_on(scenario(text));
}

// Ranges that follow densities may have grown beyond what lists reach, when somebody looks behind a step whose influences
// go on to hold.
TEST(DividedLooks, LeaveListsOfRangesThatGrowAsTheyAre) {
  ScenarioText const text{R"toml(
[units]
base = "reduced"
[box]
low = [0, 0]
high = [16, 16]
[run]
step = { courant = 0.3 }
steps = 60
[smooth]
variable_range = { spacings = 3 }
[[ensembles]]
name = "gas"
class = "Smooth"
density = 1
range = 3
specific_energy = 1.5
load = { kind = "fill", spacing = 1.0, where = "x > 8" }
material = { kind = "ideal-gas", gamma = 1.4 }
)toml",
                          "growing.toml", "growing", ""};
  auto const rows = [&](bool looks) {
    World world;
    scenario(text)(world);
    world.simulation->threads(1);
    world.simulation->divide_from(0);
    if (looks) world.simulation->observe(1, [](Simulation const&) {});
    world.simulation->run(60);
    auto const& gas = *world.simulation->ensembles().front();
    return std::vector<double>(gas.row(0), gas.row(0) + gas.size() * gas.stride());
  };
  auto const wanted = rows(false);
  EXPECT_EQ(rows(true), wanted);
  for (auto const& failure : test::ThreadTeam(2).run([&](Team&) { EXPECT_EQ(rows(true), wanted); }))
    EXPECT_EQ(test::line_of(failure), "");
}

TEST(DividedAdaptations, RemeshVortices) {
  expect_same_bits(scenario("lamb-oseen-exchange", {"ensembles.0.load.where=x^2 + y^2 < 1",
                                                    "ensembles.0.formulas.vorticity=0.0025*exp(-(x^2 + y^2)/0.1)"}),
                   9, {2, 3});
}

// ---- Barostats ----

void hold_pressure(World& world, BarostatMethod method, bool together) {
  BarostatOptions options{.pressure = 0.5, .temperature = 1, .compressibility = 0.1, .rate = 5};
  options.every = 4;
  options.method = method;
  options.together = together;
  world.simulation->add(Barostat(options, 1));
}

void add_bath(World& world, AnyEnsemble& ensemble) {
  auto& bath = world.make<LangevinBath>(1.0, 1.0, 1.0);
  bath.on(ensemble);
  world.simulation->add(bath);
}

TEST(DividedBarostats, GoOnBesideAPiston) {
  expect_to_go_on([](World& world) {
    auto& atoms = world.make<Ensemble<Newton<2>>>("atoms");
    Box box(Vector{0., 0.}, Vector{21., 20.7}, {Boundary::reflecting, Boundary::periodic});
    box.wall(0, Box::End::low, {.velocity = {0.2}});
    auto& scheme = world.make<PairScheme>(box, 2.5);
    block_load(atoms, {Lattice::square, 1.15, {18, 18, 1}, {0.3, 0.3, 0}});
    maxwellian_load(atoms, {.temperature = 1, .seed = test_seed(3)});
    scheme.internal(atoms, LennardJones{1.0, 1.0});
    world.simulation = &world.make<Simulation>(scheme, 0.004);
    add_bath(world, atoms);
    BarostatOptions options{.pressure = 0.5, .temperature = 1, .compressibility = 0.1, .rate = 5};
    options.every = 4;
    options.axes = {1};
    world.simulation->add(Barostat(options, 1));
  });
}

TEST(DividedBarostats, StretchAFluid) {
  for (auto const method : {BarostatMethod::cell_rescaling, BarostatMethod::mtk})
    expect_same_bits(
        [&](World& world) {
          melt<3>(world, 5, 1.0, Boundary::periodic);
          add_bath(world, part_of<Ensemble<Newton<3>>>(world, 0));
          hold_pressure(world, method, method == BarostatMethod::mtk);
        },
        18, {2, 3, 5});
}

TEST(DividedBarostats, StretchAMetal) {
  expect_same_bits(scenario("copper-melting", {"equilibrate.time=9 fs", "barostat.every=3"}), 8, {2, 3});
}

// ---- Molecules ----

struct ChainOptions {
  std::size_t each = 5;  // particles of a molecule
  bool rigid = false;    // bonds; and of triangles the third side
  bool lists = true;     // a law between all that has a cut-off
  bool scaled = false;   // it is left out between neighbours, and halved between next ones
  bool pressure = false;
};

/// Molecules at places of a cubic lattice, zigzags along x (three particles: equilateral triangles).
void chains(World& world, ChainOptions const& options) {
  auto& atoms = world.make<Ensemble<Newton<3>>>("atoms");
  std::size_t const each = options.each, side = 4;
  double const width = 2.4, length = std::max(width, 0.9 * static_cast<double>(each));
  std::array<double, 3> const edge{length * side, width * side, width * side};
  Box const box(Vector{0.0, 0.0, 0.0}, Vector{edge[0], edge[1], edge[2]}, Boundary::periodic);
  for (std::size_t m = 0; m < side * side * side; ++m)
    for (std::size_t k = 0; k < each; ++k) {
      Newton<3> atom{};
      atom.mass = 1 + 0.5 * static_cast<double>(k % 2);
      atom.position = {length * static_cast<double>(m % side) + 0.5 * std::sqrt(3.0) * static_cast<double>(k),
                       width * (static_cast<double>(m / side % side) + 0.07 * static_cast<double>(m % 5)) +
                           0.5 * static_cast<double>(k % 2),
                       width * static_cast<double>(m / side / side)};
      if (each == 3)
        atom.position[0] -= 0.5 * std::sqrt(3.0) * static_cast<double>(k) - 0.5 * static_cast<double>(k),
            atom.position[1] += (0.5 * std::sqrt(3.0) - 0.5) * static_cast<double>(k % 2);
      atoms.add(atom);
    }
  maxwellian_load(atoms, {.temperature = 1, .seed = test_seed(5)});
  auto const bonds = chain_bonds(atoms.size(), each);
  auto rigid_bonds = bonds;
  if (each == 3)
    for (auto const& bond : repeated(std::vector<BondMembers>{{0, 2}}, 3, atoms.size())) rigid_bonds.push_back(bond);

  auto& molecules = world.make<MoleculeScheme>(box);
  auto& pairs = world.make<PairScheme>(box, 2.4);
  if (options.scaled) pairs.bonded_factors(atoms, bonds, {0, 0.5});
  if (options.lists) pairs.internal(atoms, Soft{.repulsion = 4, .range = 2.4}, 2.4);
  if (each > 3) {
    molecules.angles(atoms, angles_along(bonds), HarmonicAngle{.stiffness = 10, .rest_angle = 2});
    molecules.dihedrals(atoms, dihedrals_along(bonds), FourierDihedral{.stiffness = 2, .multiplicity = 3, .phase = 0});
  }
  if (!options.rigid) pairs.connect(atoms, connections_of(bonds), Spring{.stiffness = 100, .rest_length = 1});
  pairs.add(atoms);
  molecules.add(atoms);
  world.simulation = &world.make<Simulation>(molecules, 0.01);
  world.simulation->add(pairs);
  add_bath(world, atoms);
  if (options.rigid) {
    auto const rigid = std::make_shared<RigidBonds>(atoms, molecules.box(), rigid_bonds, 1);
    rigid->settle();
    molecules.keeps(rigid);
    world.simulation->integrate(atoms, with_rigid_bonds(rigid, make_integrator(atoms, Method::leap_frog)));
    world.simulation->add(world.make<RigidVelocities>(rigid));
  }
  if (options.pressure) hold_pressure(world, BarostatMethod::cell_rescaling, true);
}

void expect_same_chains(ChainOptions const& options) {
  expect_same_bits([&](World& world) { chains(world, options); }, 40, {2, 3, 5});
}

TEST(DividedMolecules, BendAndTurn) { expect_same_chains({}); }
TEST(DividedMolecules, LeaveOutBondedPairs) { expect_same_chains({.scaled = true}); }
TEST(DividedMolecules, WithoutLists) { expect_same_chains({.lists = false}); }
TEST(DividedMolecules, OfRigidBonds) { expect_same_chains({.each = 4, .rigid = true}); }
TEST(DividedMolecules, OfRigidTriangles) { expect_same_chains({.each = 3, .rigid = true}); }
TEST(DividedMolecules, UnderAPressure) {
  expect_same_chains({.pressure = true});
  expect_same_chains({.each = 3, .rigid = true, .pressure = true});
}
TEST(DividedMolecules, OfAMelt) { expect_same_bits(scenario("polymer-melt"), 30, {2, 3, 5}); }

// ---- Several lists ----

/// Atoms of a melt, others among them which no list of the first scheme knows, and a second law with lists between all.
void two_lists(World& world, std::int64_t every_first, std::int64_t every_second) {
  melt<2>(world, 24, 1.0, Boundary::periodic);
  auto& atoms = part_of<Ensemble<Newton<2>>>(world, 0);
  auto& first = part_of<PairScheme>(world, 1);
  auto& others = world.make<Ensemble<Newton<2>>>("others");
  for (std::size_t i = 0; i < atoms.size(); i += 3) {
    Newton<2> other = atoms[i];
    other.position = other.position + 0.57;
    other.mass = 0.3;
    others.add(other);
  }
  auto& second = world.make<PairScheme>(first.box(), 1.9);
  second.internal(others, Soft{.repulsion = 1, .range = 1.9}, 1.9);
  second.between(atoms, others, Soft{.repulsion = 0.5, .range = 1.2}, 1.2);
  second.internal(atoms, Soft{.repulsion = 0.2, .range = 3}, 3);
  world.simulation->add(second);
  if (every_first > 1) world.simulation->every(every_first, first);
  if (every_second > 1) world.simulation->every(every_second, second);
}

TEST(DividedLists, OfTwoSchemes) {
  expect_same_bits([](World& world) { two_lists(world, 1, 1); }, 60, {2, 3, 5});
}

TEST(DividedLists, OfForcesOfEveryFewSteps) {
  expect_same_bits([](World& world) { two_lists(world, 1, 3); }, 60, {2, 3, 5});
  expect_same_bits([](World& world) { two_lists(world, 4, 1); }, 60, {3});
}

TEST(DividedLists, BesideAMetal) {
  expect_same_bits(
      [](World& world) {
        scenario("copper-3d")(world);
        Scheme& metal = *world.simulation->schemes()[0];
        auto& copper = dynamic_cast<Ensemble<Newton<3>>&>(*metal.ensembles()[0]);
        auto& pairs = world.make<PairScheme>(metal.box(), 3.0);
        pairs.internal(copper, Soft{.repulsion = 1e-3, .range = 3}, 3.0);
        world.simulation->add(pairs);
      },
      16, {2, 3});
}

// ---- Sheared boxes ----

/// Atoms of a hot fluid whose images flow, and a bath.
template <int D>
void sheared_melt(World& world, Shear const& shear) {
  melt<D>(world, D == 3 ? 5 : 20, 1.0, Boundary::periodic);
  auto& atoms = part_of<Ensemble<Newton<D>>>(world, 0);
  Box box = part_of<PairScheme>(world, 1).box();
  box.shear(shear);
  auto& scheme = world.make<PairScheme>(box, 2.5);
  scheme.internal(atoms, LennardJones{1.0, 1.0});
  atoms[17].velocity[0] = 12;  // ahead of all others, over an end soon
  world.simulation = &world.make<Simulation>(scheme, 0.004);
  add_bath(world, atoms);
}

TEST(DividedShear, OfAFluid) {
  expect_same_bits([](World& world) { sheared_melt<3>(world, {2, 0, 1}); }, 40, {2, 3});
  expect_same_bits(
      [](World& world) {
        sheared_melt<2>(world, {-3, 1, 0, false});
        auto& chain = world.make<NoseHooverChain>(1.0, 2.0, 1.0);
        chain.on(part_of<Ensemble<Newton<2>>>(world, 0));
        world.simulation->add(chain);
      },
      60, {3});
}

TEST(DividedShear, OfAFluidThatRubs) {
  expect_same_bits(scenario("sheared-fluid", {"equilibrate.time=0.2"}), 30, {2, 3});
}

TEST(DividedShear, OfAMetalAndOfAContinuum) {
  expect_same_bits(scenario("copper-3d", {"box.shear={rate='1e12 1/s', established=false}"}), 16, {2, 3});
  expect_same_bits(scenario("taylor-green", {"box.shear={rate=2}"}), 6, {3});
}

// ---- Who is told to stop ----

/// The step at which all ranks stop.
std::int64_t stops_at(Make const& make, std::function<void(Simulation&, int rank)> const& also) {
  std::vector<std::int64_t> steps(3);
  auto const thrown = test::ThreadTeam(3).run([&](Team& team) {
    World world;
    make(world);
    Simulation& simulation = *world.simulation;
    also(simulation, team.rank());
    simulation.run(1'000'000);
    EXPECT_EQ(simulation.undivided(), "");
    steps[static_cast<std::size_t>(team.rank())] = simulation.step();
  });
  for (auto const& failure : thrown) EXPECT_EQ(test::line_of(failure), "");
  EXPECT_EQ(steps[1], steps[0]);
  EXPECT_EQ(steps[2], steps[0]);
  return steps[0];
}

TEST(DividedStops, WhatASignalTellsOneRankStopsAllInOneStep) {
  for (auto const& make : {Make([](World& world) { melt<2>(world, 32, 1.0, Boundary::periodic); }),
                           scenario("two-stream", {"run.threads=1"})})
    for (std::int64_t const first : {5, 30}) {
      auto const at = stops_at(make, [&](Simulation& simulation, int rank) {
        simulation.observe_progress([&simulation, rank, first](Simulation const& now) {
          if (rank != 1 && now.step() >= first + rank) simulation.stop();
        });
      });
      EXPECT_GE(at, first);
      EXPECT_LT(at, 100'000);
    }
}

TEST(DividedStops, WhatAllAreToldInAStepStopsThemThere) {
  Make const make = [](World& world) { melt<2>(world, 32, 1.0, Boundary::periodic); };
  EXPECT_EQ(stops_at(make,
                     [](Simulation& simulation, int) {
                       simulation.observe(1, [&simulation](Simulation const& now) {
                         if (now.step() == 37) simulation.stop();
                       });
                     }),
            37);
  EXPECT_EQ(
      stops_at(make, [](Simulation& simulation, int) { simulation.adapt(29, [&simulation] { simulation.pause(); }); }),
      29);
}

// ---- Friction ----

DissipationLaw const some_friction{
    .convention = Convention::fixed_temperature, .friction = 2, .temperature = 1, .range = 1.5};

/// Friction and noise between pairs of atoms, by the lists of a scheme.
PairDissipation& add_friction(World& world, AnyEnsemble& atoms, PairScheme& pairs, DissipationMethod method) {
  auto& friction = world.make<PairDissipation>(pairs, 1.0);
  friction.internal(atoms, some_friction);
  friction.method(method);
  world.simulation->add(friction);
  return friction;
}

/// A melt whose atoms rub against each other, and against dust that feels nothing else.
template <int D>
void rubbing_melt(World& world, int cells, Boundary boundary, bool corrector) {
  melt<D>(world, cells, 1.0, boundary);
  auto& atoms = part_of<Ensemble<Newton<D>>>(world, 0);
  auto& pairs = part_of<PairScheme>(world, 1);
  auto& dust = world.make<Ensemble<Newton<D>>>("dust", 100);
  std::mt19937_64 random(test_seed(5));
  for (auto& p : dust) {
    p.mass = 3;
    for (int a = 0; a < D; ++a)
      p.position[a] = std::uniform_real_distribution<double>(0.01, pairs.box().length(a) - 0.01)(random);
  }
  pairs.add(dust);
  auto& friction = add_friction(world, atoms, pairs, DissipationMethod::simultaneous);
  friction.between(atoms, dust, some_friction);
  friction.corrector(corrector);
  world.simulation->integrate(atoms, Method::leap_frog);
  world.simulation->integrate(dust, Method::leap_frog);
}

TEST(DividedFriction, OfPairsAcrossTheCuts) {
  expect_same_bits([](World& world) { rubbing_melt<1>(world, 300, Boundary::periodic, true); }, 10, {3});
  expect_same_bits([](World& world) { rubbing_melt<2>(world, 20, Boundary::reflecting, true); }, 20, {2, 5});
  expect_same_bits([](World& world) { rubbing_melt<3>(world, 5, Boundary::periodic, false); }, 20, {3});
}

TEST(DividedFriction, WhereRanksBeginInTheMidstOfAChunk) {
  expect_same_bits([](World& world) { rubbing_melt<2>(world, 134, Boundary::periodic, false); }, 3, {3});
}

TEST(DividedFriction, BesideSeveralListsOrRigidBonds) {
  expect_same_bits(
      [](World& world) {
        two_lists(world, 1, 1);
        add_friction(world, part_of<Ensemble<Newton<2>>>(world, 0), part_of<PairScheme>(world, 1),
                     DissipationMethod::simultaneous);
      },
      20, {3});
  expect_same_bits(
      [](World& world) {
        chains(world, {.each = 4, .rigid = true});
        add_friction(world, part_of<Ensemble<Newton<3>>>(world, 0), part_of<PairScheme>(world, 2),
                     DissipationMethod::simultaneous)
            .corrector(true);
      },
      40, {2, 5});
}

// ---- What every rank does, all of it ----

TEST(UndividedRun, OfFrictionOnePairAfterTheOther) {
  expect_same_bits(
      [](World& world) {
        melt<2>(world, 12, 1.0, Boundary::periodic);
        add_friction(world, part_of<Ensemble<Newton<2>>>(world, 0), part_of<PairScheme>(world, 1),
                     DissipationMethod::shardlow);
      },
      20, {2, 3}, "pairs that are taken one by one (shardlow)");
}

TEST(UndividedRun, OfMethodsThatKnowNoShares) {
  expect_same_bits(scenario("pythagorean"), 40, {2, 3}, "gauss-radau");
  expect_same_bits(
      [](World& world) {
        melt<2>(world, 12, 1.0, Boundary::periodic);
        world.simulation->integrate(part_of<Ensemble<Newton<2>>>(world, 0), Method::reversible_leap_frog);
      },
      40, {2, 3}, "the reversible leap-frog");
}

TEST(UndividedRun, OfTwoSchemesWithPointsOfTheirOwn) {
  expect_same_bits(
      [](World& world) {
        scenario("copper-3d")(world);
        Simulation& first = *world.simulation;
        scenario("copper-3d", {"ensembles.0.mass='60 amu'"})(world);
        Simulation& second = *world.simulation;
        first.add(*second.schemes()[0]);
        first.integrate(dynamic_cast<Ensemble<Newton<3>>&>(*second.schemes()[0]->ensembles()[0]), Method::leap_frog);
        world.simulation = &first;
      },
      4, {2}, "several schemes that have points of their own");
}

// ---- Substeps ----

TEST(DividedSubsteps, FollowWhatIsFastest) {
  expect_same_bits(
      [](World& world) {
        melt<2>(world, 26, 2.0, Boundary::reflecting);
        auto& atoms = part_of<Ensemble<Newton<2>>>(world, 0);
        atoms[40].velocity = {12, 5};
        world.simulation->divide_steps({.distance = 0.01});
      },
      14, {2, 3, 5});
}

TEST(DividedSubsteps, OfTwoLists) {
  expect_same_bits(
      [](World& world) {
        two_lists(world, 1, 1);
        world.simulation->divide_steps({.distance = 0.02, .energy = 0.1});
      },
      14, {2, 3});
}

}  // namespace
}  // namespace boltzmann::divided_changes_test
