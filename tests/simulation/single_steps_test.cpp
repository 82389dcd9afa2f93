// run(1) in a loop does what run(n) does and calculates no more, and whatever somebody has changed between two runs
// counts from the next one on.
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/laws/uniform.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <bit>
#include <cmath>
#include <functional>
#include <random>
#include <span>

namespace boltzmann::single_steps_test {
namespace {

using Rows = std::vector<double>;

Rows rows_of(AnyEnsemble const& ensemble) {
  return {ensemble.row(0), ensemble.row(0) + ensemble.size() * ensemble.stride()};
}

/// After n single steps, and after n in one go.
void expect_same_bits(char const* name, std::vector<std::string> const& set, std::uint64_t n) {
  Overrides overrides;
  overrides.set = set;
  auto const singly = load_scenario(find_scenario(name), overrides);
  auto const together = load_scenario(find_scenario(name), overrides);
  for (std::uint64_t k = 0; k < n; ++k) singly->simulation->run(1);
  together->simulation->run(n);
  for (std::size_t e = 0; e < singly->ensembles.size(); ++e)
    EXPECT_EQ(rows_of(*singly->ensembles[e]), rows_of(*together->ensembles[e])) << name;
}

TEST(SingleSteps, HaveTheBitsOfARun) {
  expect_same_bits("copper", {}, 20);
  expect_same_bits("two-stream", {}, 70);
  expect_same_bits("electron-gas-2d", {}, 3);
  expect_same_bits("electron-gas-2d", {"mesh.precision=single"}, 3);
  expect_same_bits("molten-salt", {}, 3);
  expect_same_bits("sod", {}, 5);
  expect_same_bits("taylor-green", {}, 3);  // one range for all: densities at the end of a run hold in the next
  expect_same_bits("langmuir", {}, 60);  // sorts its particles
  expect_same_bits("thomson-ring", {}, 20);
  expect_same_bits("active-matter", {}, 5);
  expect_same_bits("plummer", {"ensembles.0.number=3000"}, 70);  // multipoles look at their error every 64 times
}

TEST(SingleSteps, ChecksumsTellEveryChange) {
  Ensemble<Newton<3>> atoms("atoms", 4000);
  AnyEnsemble* const all[] = {&atoms};
  std::mt19937_64 random(test_seed(7));
  std::span<double> const numbers(atoms.row(0), atoms.size() * atoms.stride());
  for (double& number : numbers) number = std::normal_distribution(0.0, 1.0)(random);
  std::uint64_t const before = rows_checksum(all, 1);
  EXPECT_EQ(rows_checksum(all, 3), before);
  auto const expect_told = [&](auto const& change, std::size_t of) {
    change();
    EXPECT_NE(rows_checksum(all, 1), before) << of;
    change();  // back again
  };
  std::span<double> const few = numbers.last(700);
  for (std::size_t k = 1; k < few.size(); ++k) {
    expect_told([&] { few[k] = std::bit_cast<double>(std::bit_cast<std::uint64_t>(few[k]) ^ 1U << k % 32); }, k);
    expect_told([&] { std::swap(few[0], few[k]); }, k);
    expect_told([&] { few[0] = -few[0], few[k] = -few[k]; }, k);
  }
  expect_told(
      [&] {
        for (double& number : numbers) number = -number;
      },
      numbers.size());
  EXPECT_EQ(rows_checksum(all, 1), before);
}

TEST(SingleSteps, ChecksumsAreTheSameForEveryInstructionSet) {
  Ensemble<Newton<1>> atoms("atoms", 1001);
  for (std::size_t i = 0; i < atoms.size(); ++i) atoms[i].position = {1.0 / static_cast<double>(i + 1)};
  AnyEnsemble* const all[] = {&atoms};
  EXPECT_EQ(rows_checksum(all, 1), 0xa8b3fda44d2126dfU);
}

/// Atoms in a box, by leap-frog, and the influences that a pair scheme was asked for.
struct Melt {
  Ensemble<Newton<2>> atoms{"atoms", 100};
  PairScheme scheme;
  Simulation simulation;

  explicit Melt(std::function<void(Melt&)> const& laws)
      : scheme(Box({0, 0}, {20, 20}, Boundary::periodic), 2.5), simulation(scheme, 0.002) {
    std::mt19937_64 random(test_seed(3));
    for (std::size_t i = 0; i < atoms.size(); ++i) {
      atoms[i].position = {1.5 * static_cast<double>(i % 10) + 1, 1.5 * static_cast<double>(i / 10) + 1};
      atoms[i].velocity = {std::normal_distribution(0.0, 1.0)(random), std::normal_distribution(0.0, 1.0)(random)};
    }
    laws(*this);
    simulation.integrate(atoms, Method::leap_frog);
  }
  /// As report() tells it.
  int calculations() const { return std::stoi(scheme.report()); }
};

void attract(Melt& melt) { melt.scheme.internal(melt.atoms, LennardJones{1.0, 1.0}); }

TEST(SingleSteps, CalculateNoMore) {
  Melt singly(attract), together(attract);
  for (int k = 0; k < 10; ++k) singly.simulation.run(1);
  together.simulation.run(10);
  EXPECT_EQ(singly.calculations(), together.calculations());
  EXPECT_EQ(rows_of(singly.atoms), rows_of(together.atoms));
}

/// Five steps, a change, five steps: the same as a new simulation that begins with what there is after the change, but
/// for the rounding of sums in another order. Old influences in the first of these steps would shift particles by 1e-6.
void expect_to_count(std::function<void(Melt&)> const& laws, std::function<void(Melt&)> const& change,
                     std::function<void(Melt&)> const& laws_then) {
  Melt changed(laws), then(laws_then);
  changed.simulation.run(5);
  change(changed);
  std::copy_n(changed.atoms.row(0), changed.atoms.size() * changed.atoms.stride(), then.atoms.row(0));
  changed.simulation.run(5), then.simulation.run(5);
  Rows const end = rows_of(changed.atoms), wanted = rows_of(then.atoms);
  for (std::size_t k = 0; k < end.size(); ++k) EXPECT_NEAR(end[k], wanted[k], 1e-11) << k;
}

struct Push {
  double strength;
  Vector<2> operator()(auto const& p) const { return {p.mass * strength, p.mass * 0.0}; }
};

TEST(SingleSteps, CountWhatHasChangedBetweenThem) {
  expect_to_count(
      attract, [](Melt& melt) { melt.atoms[7].velocity[0] = -melt.atoms[7].velocity[0]; }, attract);
  expect_to_count(
      attract, [](Melt& melt) { std::swap(melt.atoms[3].position, melt.atoms[4].position); }, attract);
  // Signs of several numbers, which a plain sum of bits would not see.
  expect_to_count(
      attract,
      [](Melt& melt) {
        for (auto& p : melt.atoms) p.velocity = -1.0 * p.velocity;
      },
      attract);
  expect_to_count(
      attract, [](Melt& melt) { melt.scheme.external(melt.atoms, Push{3}); },
      [](Melt& melt) {
        attract(melt);
        melt.scheme.external(melt.atoms, Push{3});
      });
  // Somebody else's influences stand where the simulation's stood.
  expect_to_count(
      attract, [](Melt& melt) { melt.atoms.influence(0)[0] += 1; }, attract);
}

TEST(SingleSteps, CountVariablesThatALambdaCaptures) {
  double strength = 1;
  auto const pushed = [&strength](Melt& melt) {
    melt.scheme.external(melt.atoms, [&strength](auto const& p) { return Vector{p.mass * strength, p.mass * 0.0}; });
  };
  expect_to_count(
      pushed, [&strength](Melt&) { strength = 3; }, [](Melt& melt) { melt.scheme.external(melt.atoms, Push{3}); });
}

double global_strength = 1;

TEST(SingleSteps, CountVariablesOfTheProgramIfTold) {
  auto const pushed = [](Melt& melt) {
    melt.scheme.external(melt.atoms, [](auto const& p) { return Vector{p.mass * global_strength, p.mass * 0.0}; });
  };
  auto const change = [](Melt& melt) {
    global_strength = 3;
    melt.simulation.laws_changed();
  };
  expect_to_count(pushed, change, [](Melt& melt) { melt.scheme.external(melt.atoms, Push{3}); });
}

TEST(SingleSteps, CountARegionThatIsNew) {
  struct Walled {
    Ensemble<Newton<1>> ball{"ball", 1};
    PairScheme scheme{Box({0.}, {10.}, Boundary::reflecting)};
    Simulation simulation{scheme, 0.1};
    Walled() {
      ball[0].position = {8.};
      ball[0].velocity = {1.};
      scheme.add(ball);
    }
  } walled;
  for (int k = 0; k < 5; ++k) walled.simulation.run(1);
  walled.scheme.box().install(Vector{9.}, Vector{9.5}, Region::Side::keep_out);
  for (int k = 0; k < 10; ++k) walled.simulation.run(1);
  EXPECT_NEAR(walled.ball[0].position[0], 8.5, 1e-12);
  EXPECT_DOUBLE_EQ(walled.ball[0].velocity[0], -1);
}

/// A gas of smooth particles, whose densities are summed when somebody looks, unless they are those of the last step.
struct Gas {
  Ensemble<Smooth<1>> gas{"gas", 40};
  SmoothScheme scheme{Box({0.}, {4.}, Boundary::mirror)};
  Simulation simulation{scheme, 0.01};

  Gas() {
    for (std::size_t i = 0; i < gas.size(); ++i) {
      double const x = (static_cast<double>(i) + 0.5) / 10;
      gas[i].position = {x};
      gas[i].velocity = {0.1 * std::sin(x)};
      gas[i].mass = 0.1;
      gas[i].range = 0.35;
      gas[i].specific_energy = 1 + 0.1 * x;
    }
    scheme.material(gas, IdealGas{1.4});
    scheme.artificial_viscosity({1, 2});
  }
};

TEST(SingleSteps, OfAGasCountWhatHasChanged) {
  std::function<void(Gas&)> const changes[] = {[](Gas& g) { g.gas[7].position[0] += 0.02; },
                                               [](Gas& g) { std::swap(g.gas[3], g.gas[4]); },
                                               [](Gas& g) { g.gas[7].velocity[0] *= -1; },
                                               [](Gas& g) { g.gas[7].mass = 0.2; },
                                               [](Gas& g) { g.gas[7].range = 0.4; },
                                               [](Gas& g) {
                                                 for (auto& p : g.gas) p.range = 0.4;
                                               },
                                               [](Gas& g) { g.gas[7].specific_energy *= 2; },
                                               [](Gas& g) { g.scheme.heating(Heating::own); },
                                               [](Gas& g) {
                                                 g.scheme.artificial_viscosity({2, 4});
                                               },
                                               [](Gas& g) { g.scheme.variable_range({3}); },
                                               [](Gas& g) { g.scheme.density_from(DensityFrom::continuity); }};
  for (auto const& change : changes) {
    Gas changed, then;
    for (int k = 0; k < 5; ++k) changed.simulation.run(1);
    std::copy_n(changed.gas.row(0), 40 * changed.gas.stride(), then.gas.row(0));
    change(changed), change(then);
    std::copy_n(changed.gas.row(0), 40 * changed.gas.stride(), then.gas.row(0));
    auto const expect_alike = [&](char const* when) {
      Rows const now = rows_of(changed.gas), wanted = rows_of(then.gas);
      for (std::size_t k = 0; k < now.size(); ++k)
        EXPECT_NEAR(now[k], wanted[k], 1e-11) << when << ", change " << &change - changes << ", number " << k;
    };
    EXPECT_NEAR(changed.scheme.measure().virial[0][0], then.scheme.measure().virial[0][0], 1e-11);
    expect_alike("looked at");
    changed.simulation.run(1), then.simulation.run(1);
    expect_alike("a step later");
    changed.simulation.run(3), then.simulation.run(3);
    expect_alike("behind");
  }
}

/// Electrons that a mesh advances in whole steps, which go on from where they were.
struct Electrons {
  Ensemble<Coulomb<1>> electrons{"electrons", 400};
  MeshScheme mesh{Box({0.}, {1.}, Boundary::periodic), {32}, coulomb(0.5)};
  Simulation simulation{mesh, 0.01};

  Electrons() {
    for (std::size_t i = 0; i < electrons.size(); ++i) {
      electrons[i].position = {(static_cast<double>(i) + 0.5) / 400};
      electrons[i].velocity = {0.1 * std::sin(6.28 * electrons[i].position[0])};
      electrons[i].charge = 0.1;
    }
    mesh.add(electrons);
    mesh.background(true);
    mesh.external(electrons, UniformElectricField<1>{{0.2}});
  }
};

TEST(SingleSteps, OnAMeshCountWhatHasChanged) {
  std::function<void(Electrons&)> const changes[] = {
      [](Electrons& e) { e.electrons[3].velocity[0] *= -1; },
      [](Electrons& e) {
        for (auto& p : e.electrons) p.velocity[0] *= -1;
      },
      [](Electrons& e) { std::swap(e.electrons[16].position, e.electrons[32].position); },
      [](Electrons& e) { e.electrons[3].charge = 0.2; },
      [](Electrons& e) { e.electrons.influence(0)[0] += 1; },
      [](Electrons& e) {
        for (auto& p : e.electrons) p.charge = 0.2;
      },
      [](Electrons& e) { e.simulation.step_size(0.02); },
      [](Electrons& e) { e.mesh.assignment(3); },
      [](Electrons& e) { e.mesh.precision(Precision::single); },
      [](Electrons& e) { e.mesh.external(e.electrons, UniformElectricField<1>{{0.5}}); },
      [](Electrons& e) { e.simulation.integrate(e.electrons, Method::deactivate); }};
  for (auto const& change : changes) {
    Electrons changed, then;
    for (int k = 0; k < 5; ++k) changed.simulation.run(1);
    change(changed);
    std::copy_n(changed.electrons.row(0), 400 * changed.electrons.stride(), then.electrons.row(0));
    change(then);
    std::copy_n(changed.electrons.row(0), 400 * changed.electrons.stride(), then.electrons.row(0));
    changed.simulation.run(5), then.simulation.run(5);
    EXPECT_EQ(rows_of(changed.electrons), rows_of(then.electrons)) << "change " << &change - changes;
  }
}

TEST(SingleSteps, OnAMeshGoBackwards) {
  Electrons there_and_back;
  Rows const start = rows_of(there_and_back.electrons);
  for (int k = 0; k < 5; ++k) there_and_back.simulation.run(1);
  for (int k = 0; k < 5; ++k) there_and_back.simulation.rewind(1);
  Rows const end = rows_of(there_and_back.electrons);
  for (std::size_t k = 0; k < start.size(); ++k) EXPECT_NEAR(end[k], start[k], 1e-9);
}

TEST(SingleSteps, OnAMeshEndWithAFailureThatLeavesNothingBehind) {
  Electrons failing, then;
  failing.simulation.run(1);
  Rows const before = rows_of(failing.electrons);
  std::copy_n(failing.electrons.row(0), before.size(), then.electrons.row(0));
  failing.electrons[0].velocity[0] = 1e9;
  EXPECT_THROW(failing.simulation.run(1), PhysicsFailure);
  std::copy_n(before.data(), before.size(), failing.electrons.row(0));
  failing.simulation.run(3), then.simulation.run(3);
  EXPECT_EQ(rows_of(failing.electrons), rows_of(then.electrons));
}

}  // namespace
}  // namespace boltzmann::single_steps_test
