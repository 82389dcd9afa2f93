// Vortices and tracers that leave: who, what went with them, and what that does to the forces on bodies.
#include <boltzmann/boltzmann.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>

#include <cmath>
#include <vector>

namespace boltzmann::outflow_test {
namespace {

template <int D>
Box box() {
  Vector<D> low{}, high{};
  for (int a = 0; a < D; ++a) low[a] = -4, high[a] = 4;
  return Box(low, high, Boundary::open);
}

template <int D>
void place(Ensemble<Inviscid<D>>& vortices) {
  vortices.resize(10);
  for (std::size_t i = 0; i < 10; ++i) {
    auto const n = static_cast<double>(i);
    for (int a = 0; a < D; ++a) vortices[i].position[a] = std::sin(3 * n + a);
    for (int k = 0; k < cross_dimension<D>; ++k) vortices[i].vorticity[k] = std::cos(2 * n + k);
  }
}

/// Those beyond x + y = 0.2 leave, the others stay in their order, and sums of both are those of all.
template <int D>
void expect_parts() {
  Ensemble<Inviscid<D>> vortices("wake"), before("before");
  place(vortices), place(before);
  VortexMeasures const all = vortex_measures(vortices);
  Outflow outflow(vortices, box<D>(), {.from = {{0.2, 0, 0}}, .direction = {{3, 3, 0}}});
  outflow.change();
  std::size_t at = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i].position[0] + before[i].position[1] > 0.2) continue;
    ASSERT_LT(at, vortices.size());
    EXPECT_EQ(vortices[at++].position, before[i].position);
  }
  EXPECT_EQ(at, vortices.size());
  EXPECT_GT(at, 2U);
  EXPECT_EQ(outflow.left(), 10 - at);
  EXPECT_GT(outflow.left(), 2U);
  VortexMeasures const rest = vortex_measures(vortices);
  for (int k = 0; k < 3; ++k) {
    auto const n = static_cast<std::size_t>(k);
    double const gone = D == 3 ? outflow.vorticity()[k] : k == 0 ? outflow.vorticity()[2] : 0;
    EXPECT_NEAR(rest.circulation[n] + gone, all.circulation[n], 1e-14);
    EXPECT_NEAR(rest.impulse[n] + outflow.impulse()[k], all.impulse[n], 1e-14);
  }
  if (D == 2) {
    EXPECT_EQ(outflow.taken().circulation, outflow.vorticity()[2]);
    EXPECT_EQ(outflow.taken().impulse[1], outflow.impulse()[1]);
  }
  Outflow resumed(before, box<D>(), {.from = {{0.2, 0, 0}}, .direction = {{3, 3, 0}}});
  resumed.restore(outflow.state());
  EXPECT_EQ(resumed.state(), outflow.state());
}

TEST(Outflow, TellsWhatLeftInThePlane) { expect_parts<2>(); }
TEST(Outflow, TellsWhatLeftInSpace) { expect_parts<3>(); }

TEST(Outflow, LetsTracersGo) {
  Ensemble<Tracer<2>> dye("dye", 3);
  for (std::size_t i = 0; i < 3; ++i) dye[i].position = {static_cast<double>(i), 0};
  Outflow outflow(dye, box<2>(), {.from = {{1.5, 0, 0}}, .direction = {{1, 0, 0}}});
  EXPECT_EQ(outflow.report(UnitSystem::reduced()), "");
  outflow.change();
  EXPECT_EQ(dye.size(), 2U);
  EXPECT_EQ(outflow.report(UnitSystem::reduced()), "'dye': 1 has left with the flow, 2 stay");
}

// Into a coarser wake: nothing of circulation and impulse is lost, and no force comes of it.
TEST(Outflow, IntoAnotherEnsembleLosesNothing) {
  Ensemble<Diffusive<2>> wake("wake", 40);
  Ensemble<Vortex<2>> far("far", 1);
  far[0].core = 7;
  for (std::size_t i = 0; i < wake.size(); ++i) {
    auto const n = static_cast<double>(i);
    wake[i].position = {std::sin(3 * n), std::cos(5 * n)};
    wake[i].vorticity[0] = std::cos(2 * n);
    wake[i].core = 0.1 + 0.01 * n;
  }
  AnyEnsemble* const both[] = {&wake, &far};
  FlowImpulse const before = flow_impulse(both);
  Outflow outflow(wake, box<2>(), {.from = {{0.1, 0, 0}}, .direction = {{1, 0, 0}}}, {.into = &far});
  outflow.change();
  FlowImpulse const now = flow_impulse(both);
  EXPECT_EQ(wake.size() + far.size(), 41U);
  EXPECT_GT(far.size(), 10U);
  EXPECT_NEAR(now.circulation, before.circulation, 1e-14);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(now.impulse[k], before.impulse[k], 1e-14);
  EXPECT_EQ(outflow.taken().circulation, 0);
  EXPECT_EQ(outflow.taken().impulse[0], 0);
  EXPECT_EQ(far[0].core, 7);
  EXPECT_LT(far[1].core, 0.5);
  Remesher(far, box<2>(), {.spacing = 0.3}).change();  // as a wider lattice has it
  FlowImpulse const remeshed = flow_impulse(both);
  EXPECT_NEAR(remeshed.circulation, before.circulation, 1e-13);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(remeshed.impulse[k], before.impulse[k], 1e-13);
  EXPECT_NE(outflow.report(UnitSystem::reduced()).find(" gone over to 'far', "), std::string::npos);
}

TEST(Outflow, IsRefusedWhereItMeansNothing) {
  Ensemble<Newton<2>> atoms("atoms", 1);
  Ensemble<Tracer<2>> dye("dye", 1);
  OutflowPlane const plane{.from = {{1, 0, 0}}, .direction = {{1, 0, 0}}};
  EXPECT_EQ(message([&] { Outflow(atoms, box<2>(), plane); }),
            "outflow: 'atoms' is of class Newton, which no flow carries; tracers and vortices leave with a flow");
  EXPECT_EQ(message([&] {
              Outflow(dye, box<2>(), {.from = {{1, 0, 0}}, .direction = {}});
            }),
            "outflow: the direction is missing; add e.g. direction = [1, 0]");
  EXPECT_EQ(message([&] {
              Outflow(dye, box<2>(), {.from = {{1, 0, 0}}, .direction = {{0, 0, 1}}});
            }),
            "outflow: the direction is zero; one of its numbers must differ from 0");
  Ensemble<Vortex<2>> wake("wake", 1), none("none");
  EXPECT_EQ(message([&] { Outflow(wake, box<2>(), plane, {.into = &wake}); }),
            "outflow: 'wake' can't leave into itself");
  EXPECT_EQ(message([&] { Outflow(wake, box<2>(), plane, {.into = &dye}); }),
            "outflow: 'dye' is of class Tracer; only vortices become part of another ensemble of vortices");
  EXPECT_EQ(message([&] { Outflow(wake, box<2>(), plane, {.into = &none}); }),
            "outflow: 'none' needs a particle as an example of those that enter it");
}

// A vortex leaves behind a cylinder: from one step to the next the force is that of the flow without it, none in a steady
// stream, and no part of the impulse that went, neither its own nor that of its image, is taken for a force.
TEST(Outflow, LeavesNoJumpInTheForcesOnABody) {
  Ensemble<Vortex<2>> vortex("vortex", 2);
  vortex[0].position = {2.5, 0.8};
  vortex[0].vorticity[0] = 1.5;
  vortex[1].position = {-90, 0};  // somebody stays
  Ensemble<Panel<2>> cylinder("cylinder");
  PairScheme pairs(box<2>());
  UniformFlow<2> const stream{{1, 0}};
  pairs.internal(vortex, BiotSavart{});
  pairs.between(cylinder, vortex, one_way(BiotSavart{}));
  pairs.external(vortex, stream);
  pairs.external(cylinder, stream);
  PanelScheme bodies(box<2>());
  bodies.add_body(cylinder, circle_outline({0, 0}, 1, 200));
  bodies.add(vortex);
  Simulation simulation(pairs, 0.02);
  simulation.add(bodies);
  simulation.adapt(1, Outflow(vortex, box<2>(), {.from = {{3, 0, 0}}, .direction = {{1, 0, 0}}}, {.bodies = &bodies}));
  simulation.check();
  std::vector<AnyEnsemble const*> const all(simulation.ensembles().begin(), simulation.ensembles().end());
  BodyForces forces(all, std::array<double, 3>{1, 0, 0}, 2);
  std::vector<std::vector<double>> rows;
  std::vector<std::size_t> sizes;
  simulation.observe(1, [&](Simulation const& now) {
    Sample sample{now.ensembles(), pairs.box(), nullptr, 1, now.time(), now.step()};
    for (auto const* adaptation : now.adaptations()) sample.taken += adaptation->taken();
    forces.measure(sample, rows.emplace_back());
    sizes.push_back(vortex.size());
  });
  simulation.run(60);
  ASSERT_EQ(sizes.back(), 1U);
  ASSERT_EQ(sizes[5], 2U);
  for (std::size_t step = 1; step < rows.size(); ++step) {
    double const bound = sizes[step] == 1 && sizes[step - 1] == 1 ? 1e-9 : 1.5;
    for (std::size_t k = 0; k < 2; ++k) EXPECT_LT(std::abs(rows[step][k]), bound) << step;
  }
  // In the step after which it left, what it would have been without leaving.
  std::size_t left = 0;
  while (sizes[left] == 2) ++left;
  for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(rows[left][k], rows[left - 1][k], 0.05) << k;
}

}  // namespace
}  // namespace boltzmann::outflow_test
