// Adaptations: a run in which particles are changed between steps is the same as runs with changes between them.
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/laws/materials/newtonian.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/smooth.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/same_rows.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace boltzmann::adaptation_test {
namespace {

Box square(double side, Boundary boundary = Boundary::periodic) {
  return Box(Vector{0.0, 0.0}, Vector{side, side}, boundary);
}

/// Atoms on a lattice of the spacing 1.3, into the gaps of which others are put.
struct Atoms {
  std::size_t side;
  Ensemble<Newton<2>> atoms;
  PairScheme scheme;
  Simulation simulation;
  std::size_t put = 0;

  Atoms(std::size_t n, double cutoff, Boundary boundary, Method method)
      : side(n),
        atoms("atoms", n * n),
        scheme(square(1.3 * static_cast<double>(n), boundary), cutoff),
        simulation(scheme, 0.005) {
    for (std::size_t i = 0; i < atoms.size(); ++i) {
      atoms[i].position = {1.3 * (0.3 + static_cast<double>(i % n)), 1.3 * (0.3 + static_cast<double>(i / n))};
      atoms[i].velocity = {0.2 * std::sin(1.0 + static_cast<double>(i)), 0.2 * std::cos(2.0 * static_cast<double>(i))};
    }
    scheme.internal(atoms, LennardJones{1, 0.8});
    simulation.integrate(atoms, method);
  }
  void change() {
    Newton<2> atom = atoms[put];
    atom.position = atom.position + 0.6;
    atom.mass = 0.1;
    atoms.add(atom);
    ++put;
  }
};

TEST(Adaptation, IsAChangeBetweenTwoRuns) {
  // From few atoms in an open space, which have a loop of their own, to neighbour lists.
  for (auto const method : {Method::leap_frog, Method::rk2, Method::rk4})
    for (std::size_t const n : {2U, 3U, 20U}) {
      bool const few = n < 20;
      double const cutoff = few ? no_cutoff : 2.0;
      Boundary const boundary = few ? Boundary::open : Boundary::periodic;
      Atoms whole(n, cutoff, boundary, method), pieces(n, cutoff, boundary, method);
      whole.simulation.adapt(10, [&] { whole.change(); });
      whole.simulation.run(45);
      for (int k = 0; k < 4; ++k) {
        pieces.simulation.run(10);
        pieces.change();
      }
      pieces.simulation.run(5);
      EXPECT_EQ(whole.put, 4U);
      EXPECT_EQ(whole.atoms.size(), n * n + 4);
      expect_same_rows(whole.atoms, pieces.atoms, to_string(method) + " of " + std::to_string(n * n));
    }
}

TEST(Adaptation, WhoLooksSeesTheInfluencesOnThoseThatAreThere) {
  Atoms run(20, 2.0, Boundary::periodic, Method::rk4);
  run.simulation.adapt(3, [&] { run.change(); });
  int looks = 0;
  auto const look = [&] {
    ++looks;
    Atoms fresh(20, 2.0, Boundary::periodic, Method::rk4);
    fresh.atoms.resize(run.atoms.size());
    std::copy_n(run.atoms.row(0), run.atoms.size() * run.atoms.stride(), fresh.atoms.row(0));
    fresh.scheme.calculate();
    for (std::size_t i = 0; i < run.atoms.size(); ++i)
      for (std::size_t a = 0; a < 2; ++a)
        ASSERT_NEAR(run.atoms.influence(i)[a], fresh.atoms.influence(i)[a], 1e-11) << "particle " << i;
  };
  run.simulation.observe_when([](std::int64_t step) { return step == 3 || step == 6; },
                              [&](Simulation const&) { look(); });
  run.simulation.run(9);
  look();
  EXPECT_EQ(looks, 3);
}

TEST(Adaptation, ChargesOnAMeshMayComeAndGo) {
  auto const charges = [](Ensemble<Coulomb<1>>& all, std::size_t count) {
    all.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      all[i].position[0] = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
      all[i].velocity[0] = 0.1 * std::sin(2 * std::numbers::pi * all[i].position[0]);
      all[i].charge = -1.0 / static_cast<double>(count);
      all[i].mass = 1.0 / static_cast<double>(count);
    }
  };
  Ensemble<Coulomb<1>> a("electrons"), b("electrons");
  charges(a, 300);
  charges(b, 300);
  auto const fewer = [](Ensemble<Coulomb<1>>& all) {
    for (std::size_t i = 0; 2 * i < all.size(); ++i) {
      all[i] = all[2 * i];
      all[i].charge *= 2;
      all[i].mass *= 2;
    }
    all.resize(all.size() / 2);
  };
  Box const box(Vector{0.0}, Vector{1.0}, Boundary::periodic);
  MeshScheme mesh(box, {32}, LaplaceLaw{1}), other(box, {32}, LaplaceLaw{1});
  mesh.background(true);
  other.background(true);
  mesh.add(a);
  other.add(b);
  Simulation whole(mesh, 0.02), pieces(other, 0.02);
  whole.integrate(a, Method::leap_frog);
  pieces.integrate(b, Method::leap_frog);
  whole.adapt(20, [&] { fewer(a); });
  whole.run(50);
  pieces.run(20);
  fewer(b);
  pieces.run(20);
  fewer(b);
  pieces.run(10);
  ASSERT_EQ(a.size(), 75U);
  ASSERT_EQ(b.size(), 75U);
  // The pieces are whole steps, which round in another way.
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i].position[0], b[i].position[0], 1e-12);
    EXPECT_NEAR(a[i].velocity[0], b[i].velocity[0], 1e-12);
  }
}

/// A gas whose influences depend on velocities.
struct Gas {
  Ensemble<Smooth<2>> gas{"gas", 100};
  SmoothScheme scheme{square(10)};
  Simulation simulation{scheme, 0.02};

  explicit Gas(Method method) {
    for (std::size_t i = 0; i < gas.size(); ++i) {
      auto& p = gas[i];
      p.position = {0.5 + static_cast<double>(i % 10), 0.5 + static_cast<double>(i / 10)};
      p.velocity = {0.3 * std::sin(0.2 * std::numbers::pi * p.position[1]), 0};
      p.specific_energy = 1;
      p.range = 2.5;
    }
    scheme.material(gas, Newtonian<IdealGas>{IdealGas{1.4, 1}, 0.1, 0, 0.1});
    simulation.integrate(gas, method);
  }
};

TEST(Adaptation, ThatChangesNothingChangesNoBit) {
  for (auto const method : {Method::leap_frog, Method::rk4}) {
    Gas with(method), without(method);
    int looks = 0;
    with.simulation.adapt(3, [&] { ++looks; });
    with.simulation.run(20);
    without.simulation.run(20);
    EXPECT_EQ(looks, 6);
    expect_same_rows(with.gas, without.gas, to_string(method));
  }
}

TEST(Adaptation, SeesDensitiesAndIsSeenByObservers) {
  Gas gas(Method::leap_frog);
  std::vector<std::int64_t> changed, seen;
  gas.simulation.adapt(4, [&] {
    changed.push_back(gas.simulation.step());
    // A lattice of unit mass and spacing, hardly sheared yet.
    for (auto const& p : gas.gas) ASSERT_NEAR(p.density, 1, 0.02);
    gas.gas[7].mass = 2;
    gas.gas[7].density = -5;
  });
  gas.simulation.observe(1, [&](Simulation const& now) {
    seen.push_back(now.step());
    bool const heavy = now.step() >= 4;
    EXPECT_EQ(gas.gas[7].mass, heavy ? 2 : 1);
    // Twice the weight at the middle: m w(0) = 5/(pi 2.5^2) more.
    EXPECT_NEAR(gas.gas[7].density, heavy ? 1 + 5 / (std::numbers::pi * 6.25) : 1, 0.02);
  });
  gas.simulation.run(6);
  EXPECT_EQ(changed, (std::vector<std::int64_t>{4}));
  EXPECT_EQ(seen, (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6}));
}

TEST(Adaptation, InfluencesThatWereClearedAreFoundAnew) {
  // Rows end as they began, influences don't.
  Gas with(Method::leap_frog), without(Method::leap_frog);
  with.simulation.adapt(5, [&] { with.gas.clear_influence(); });
  with.simulation.run(10);
  without.simulation.run(10);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_NEAR(magnitude(with.gas[i].position - without.gas[i].position), 0, 1e-4);
    EXPECT_NEAR(with.gas[i].specific_energy, without.gas[i].specific_energy, 1e-4);
  }
}

TEST(Adaptation, ShorterLengthsCountForTheLongestMove) {
  // A third of the smoothing length a step; with ranges of a tenth that is too far.
  Gas gas(Method::rk2);
  for (auto& p : gas.gas) p.velocity = {20, 0};
  gas.simulation.run(2);
  gas.simulation.adapt(2, [&] {
    for (auto& p : gas.gas) p.range = 0.25;
  });
  try {
    gas.simulation.run(10);
    FAIL() << "nobody handled_count";
  } catch (PhysicsFailure const& failure) {
    EXPECT_NE(std::string(failure.what()).find("moved 0.4 in one step, further than the length 0.125"),
              std::string::npos)
        << failure.what();
  }
}

TEST(Adaptation, MistakesAreNamed) {
  Gas gas(Method::leap_frog);
  EXPECT_EQ(message([&] { gas.simulation.adapt(0, [] {}); }),
            "an adaptation changes particles every 1 or more steps, not every 0");
  gas.simulation.adapt(2, [&] { gas.gas[3].position = {std::nan(""), 0}; });
  EXPECT_EQ(message([&] { gas.simulation.run(5); }),
            "step 2: particle 3 of 'gas' has a position that is not finite: nan");
  EXPECT_EQ(gas.simulation.step(), 2);
  Gas back(Method::leap_frog);
  back.simulation.adapt(2, [] {});
  back.simulation.run(3);
  EXPECT_EQ(message([&] { back.simulation.rewind(1); }),
            "a run can't go backwards past steps between which an adaptation has changed particles");
  Atoms exact(3, no_cutoff, Boundary::open, Method::reversible_leap_frog);
  exact.simulation.adapt(2, [] {});
  EXPECT_EQ(message([&] { exact.simulation.check(); }),
            "the reversible leap-frog can't take back what an adaptation does between steps; use leap-frog");
}

TEST(Adaptation, AnEnsembleMayBecomeEmptyAndFillAgain) {
  Gas gas(Method::leap_frog);
  std::vector<Smooth<2>> const start(gas.gas.begin(), gas.gas.end());
  gas.simulation.adapt(1, [&] {
    if (gas.simulation.step() == 2) gas.gas.resize(0);
    if (gas.simulation.step() == 4)
      for (auto const& p : start) gas.gas.add(p);
  });
  gas.simulation.run(4);
  ASSERT_EQ(gas.gas.size(), 100U);
  gas.simulation.run(6);
  Gas fresh(Method::leap_frog);
  fresh.simulation.run(6);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_NEAR(magnitude(gas.gas[i].position - fresh.gas[i].position), 0, 1e-12);
}

}  // namespace
}  // namespace boltzmann::adaptation_test
