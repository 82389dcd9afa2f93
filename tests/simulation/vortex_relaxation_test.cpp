// Relaxation of vorticity: what has a divergence goes, a clean ring stays, by pairs and by multipoles, with the same bits.
#include <boltzmann/boltzmann.hpp>

#include <tests/files/temporary_folder.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace boltzmann::vortex_relaxation_test {
namespace {

Box const space({-4, -4, -4}, {4, 4, 4});

/// A ring, whose elements are turned out of their line, up and down six times around it, so that it has a divergence.
void load(Ensemble<Inviscid<3>>& ring, double turned, std::size_t layers = 2) {
  vortex_ring_load(ring, {.radius = 1, .tube = {.circulation = 1, .core_radius = 0.3, .layers = layers}});
  for (auto& p : ring) {
    double const wave = std::cos(6 * std::atan2(p.position[1], p.position[0]));
    p.vorticity += Vector<3>{0.0, 0.0, wave * turned * magnitude(p.vorticity)};
  }
}

struct Flow {
  Flow(bool multipoles, double turned, std::size_t layers = 2) {
    load(ring, turned, layers);
    if (multipoles) {
      auto made = std::make_unique<MultipoleScheme>(space, GaussianBiotSavart{}, 1e-5);
      made->add(ring);
      scheme = std::move(made);
    } else {
      auto made = std::make_unique<PairScheme>(space);
      made->internal(ring, GaussianBiotSavart{});
      scheme = std::move(made);
    }
    simulation = std::make_unique<Simulation>(*scheme, 0.02);
  }
  double divergence() const { return VortexFlow(vortex_sources({scheme.get()}), space).measure().divergence; }

  Ensemble<Inviscid<3>> ring{"ring"};
  std::unique_ptr<Scheme> scheme;
  std::unique_ptr<Simulation> simulation;
};

// One relaxation by all of it gives every vorticity the direction of the curl; a few make the divergence as small as
// cores can resolve.
TEST(VortexRelaxation, TakesTheDivergenceAway) {
  for (bool const multipoles : {false, true}) {
    Flow flow(multipoles, 0.5);
    double const start = flow.divergence();
    EXPECT_GT(start, 0.05);
    VortexRelaxation relaxation(*flow.scheme, {.fraction = 0.5});
    relaxation.change();
    double const misfit = relaxation.misfit();
    EXPECT_GT(misfit, 0.15);
    for (int k = 0; k < 8; ++k) relaxation.change();
    EXPECT_LT(relaxation.misfit(), 0.1 * misfit);
    EXPECT_LT(flow.divergence(), 0.2 * start);
    EXPECT_NE(relaxation.report(UnitSystem::reduced()).find("relaxed 9 times"), std::string::npos);
  }
}

// Uncorrected it is Pedrizzetti's: (1 - f) alpha + f |alpha| curl / |curl|; corrected of the length of alpha.
TEST(VortexRelaxation, IsTheFormulaOfPedrizzetti) {
  for (bool const corrected : {false, true}) {
    Flow flow(false, 0.5);
    std::vector<double> places;
    for (auto const& p : flow.ring) places.insert(places.end(), &p.position[0], &p.position[0] + 3);
    auto const slopes = VortexFlow(vortex_sources({flow.scheme.get()}), space).at_by_pairs(places);
    std::vector<Vector<3>> expected;
    for (std::size_t i = 0; i < flow.ring.size(); ++i) {
      Vector<3> const alpha = flow.ring[i].vorticity, curl = curl_of(slopes.data() + 12 * i);
      Vector<3> next = alpha * 0.8 + curl * (0.2 * magnitude(alpha) / magnitude(curl));
      if (corrected) next = next * (magnitude(alpha) / magnitude(next));
      expected.push_back(next);
    }
    VortexRelaxation(*flow.scheme, {.fraction = 0.2, .corrected = corrected}).change();
    for (std::size_t i = 0; i < flow.ring.size(); ++i)
      EXPECT_LT(magnitude(flow.ring[i].vorticity - expected[i]), 1e-12 * magnitude(expected[i])) << i;
  }
}

// By multipoles what pairs do, to their tolerance.
TEST(VortexRelaxation, IsTheSameByMultipoles) {
  Flow pairs(false, 0.3, 3), multipoles(true, 0.3, 3);
  ASSERT_GT(pairs.ring.size(), 1600U) << "so that there are expansions";
  VortexRelaxation(*pairs.scheme, {.fraction = 1}).change();
  VortexRelaxation(*multipoles.scheme, {.fraction = 1}).change();
  double error = 0, all = 0;
  for (std::size_t i = 0; i < pairs.ring.size(); ++i) {
    error += norm2(pairs.ring[i].vorticity - multipoles.ring[i].vorticity);
    all += norm2(pairs.ring[i].vorticity);
  }
  EXPECT_LT(std::sqrt(error / all), 1e-4);
  EXPECT_GT(error, 0);
}

double speed(bool relaxed) {
  Flow flow(false, 0);
  if (relaxed) flow.simulation->adapt(5, VortexRelaxation(*flow.scheme, {.fraction = 0.3}));
  auto const height = [&] {
    double sum = 0, all = 0;
    for (auto const& p : flow.ring) {
      double const part = p.position[0] * p.vorticity[1] - p.position[1] * p.vorticity[0];
      sum += part * p.position[2], all += part;
    }
    return sum / all;
  };
  double const from = height();
  flow.simulation->run(25);
  return (height() - from) / flow.simulation->time();
}

TEST(VortexRelaxation, LeavesACleanRingAsItIs) { EXPECT_NEAR(speed(true) / speed(false), 1, 2e-3); }

TEST(VortexRelaxation, GoesOnWithTheBitsOfARunWithoutAStop) {
  for (bool const multipoles : {false, true}) {
    TemporaryFolder const folder;
    auto const record = [&](std::string const& name, std::uint64_t steps, bool resume, int threads) {
      auto flow = std::make_unique<Flow>(multipoles, 0.3, multipoles ? 3 : 2);
      flow->simulation->integrate(flow->ring, Method::euler);  // one evaluation a step shows as much as four
      flow->simulation->adapt(2, VortexRelaxation(*flow->scheme, {.fraction = 0.3}));
      flow->simulation->threads(threads);
      Recording recording(*flow->simulation, UnitSystem::reduced(), folder / name);
      recording.checkpoint(3);
      if (resume) recording.resume();
      run_with_progress(recording, steps, {.quiet = true});
      return flow;
    };
    record("parts", 3, false, 1);  // relaxed after 2 steps, and after 4
    auto const resumed = record("parts", 2, true, 3), whole = record("whole", 5, false, 2);
    ASSERT_EQ(resumed->ring.size(), whole->ring.size());
    for (std::size_t i = 0; i < whole->ring.size(); ++i)
      for (std::size_t a = 0; a < 3; ++a) {
        ASSERT_EQ(whole->ring[i].position[static_cast<int>(a)], resumed->ring[i].position[static_cast<int>(a)]) << i;
        ASSERT_EQ(whole->ring[i].vorticity[static_cast<int>(a)], resumed->ring[i].vorticity[static_cast<int>(a)]) << i;
      }
  }
}

TEST(VortexRelaxation, RefusesWhatHasNoDivergenceToLose) {
  Ensemble<Vortex<2>> flat("flat", 3);
  PairScheme plane(Box({-1, -1}, {1, 1}));
  plane.internal(flat, BiotSavart{});
  EXPECT_NE(message([&] { VortexRelaxation(plane, {}); }).find("in a plane"), std::string::npos);
  Ensemble<Vortex<3>> stiff("stiff", 3);
  PairScheme scheme(space);
  EXPECT_NE(message([&] { VortexRelaxation(scheme, {}); }).find("there are no vortices"), std::string::npos);
  scheme.internal(stiff, BiotSavart{});
  EXPECT_NE(message([&] { VortexRelaxation(scheme, {}); }).find("'stiff' stays as it is"), std::string::npos);
  EXPECT_NE(message([&] { VortexRelaxation(scheme, {.fraction = 1.5}); }).find("at most 1, not 1.5"),
            std::string::npos);
}

}  // namespace
}  // namespace boltzmann::vortex_relaxation_test
