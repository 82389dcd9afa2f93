// Viscosity of vortices against what heat does, vortices that are put onto lattices and cores that are split, and what
// flows do that are followed so: mergers, sheets that roll up.
#include "shipped.hpp"

#include <boltzmann/boltzmann.hpp>
#include <boltzmann/exact/lamb_oseen.hpp>
#include <boltzmann/particles/spreading.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace boltzmann::vortex_viscosity_test {
namespace {

constexpr double viscosity = 0.01;

/// A Gaussian of vorticity of this variance around the origin on a lattice, of which each particle stands for its volume.
template <int D>
void load_gaussian(Ensemble<Diffusive<D>>& vortices, Box const& box, double spacing, double variance) {
  fill_load(vortices, box, {.spacing = spacing});
  for (auto& p : vortices) {
    p.volume = std::pow(spacing, D), p.viscosity = viscosity;
    p.vorticity[cross_dimension<D> - 1] =
        p.volume * std::exp(-norm2(p.position) / (2 * variance)) / std::pow(2 * pi * variance, 0.5 * D);
  }
}

template <int D>
double mean_square_radius(Ensemble<Diffusive<D>> const& vortices) {
  double sum = 0, squares = 0;
  for (auto const& p : vortices) {
    double const gamma = p.vorticity[cross_dimension<D> - 1];
    sum += gamma, squares += gamma * norm2(p.position);
  }
  return squares / sum;
}

/// The largest difference of the vorticity from a profile, in parts of the profile's maximum.
template <int D, class Profile>
double error_of_profile(Ensemble<Diffusive<D>> const& vortices, Profile const& profile) {
  double largest = 0;
  for (auto const& p : vortices)
    largest = std::max(largest, std::abs(p.vorticity[cross_dimension<D> - 1] / p.volume - profile(norm2(p.position))));
  return largest / profile(0.0);
}

template <int D>
auto gaussian(double variance) {
  return [=](double square) { return std::exp(-square / (2 * variance)) / std::pow(2 * pi * variance, 0.5 * D); };
}
/// What the exchange makes of such a Gaussian: vorticity jumps by a Gaussian of the width, 2 nu t / width^2 times in the
/// mean.
template <int D>
auto jumping(double variance, double time, double width) {
  return [=](double square) {
    double const mean = 2 * viscosity * time / (width * width);
    double sum = 0, probability = std::exp(-mean);
    for (int jumps = 0; jumps < 60; ++jumps) {
      sum += probability * gaussian<D>(variance + jumps * width * width)(square);
      probability *= mean / (jumps + 1);
    }
    return sum;
  };
}

// Without a flow: the mean square radius grows by 4 nu t, and the profile is that of Lamb and Oseen to second order in
// the width at a fixed overlap.
TEST(VorticityExchange, SpreadsAsHeatDoesToSecondOrder) {
  double const start = 0.01, time = 0.5, end = start + 2 * viscosity * time;
  std::vector<double> errors;
  for (double const spacing : {0.04, 0.02}) {
    Ensemble<Diffusive<2>> vortices("vortices");
    PairScheme scheme(Box({-0.8, -0.8}, {0.8, 0.8}));
    load_gaussian<2>(vortices, scheme.box(), spacing, start);
    scheme.internal(vortices, VorticityExchange{.width = spacing}, 6 * spacing);
    double const before = mean_square_radius(vortices);
    Simulation simulation(scheme, time / 20);
    simulation.run(20);
    EXPECT_NEAR((mean_square_radius(vortices) - before) / (4 * viscosity * time), 1, 1e-4);
    EXPECT_LT(error_of_profile(vortices, jumping<2>(start, time, spacing)), 1e-3);
    errors.push_back(error_of_profile(vortices, gaussian<2>(end)));
  }
  EXPECT_LT(errors[1], 0.012);
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.4) << errors[0] << ", " << errors[1];
}

// In space 6 nu t, and the vector of vorticity keeps its direction.
TEST(VorticityExchange, SpreadsInSpace) {
  double const start = 0.0225, time = 0.5, width = 0.075;
  Ensemble<Diffusive<3>> vortices("vortices");
  PairScheme scheme(Box({-0.9, -0.9, -0.9}, {0.9, 0.9, 0.9}));
  load_gaussian<3>(vortices, scheme.box(), width, start);
  for (auto& p : vortices) p.core = width, p.vorticity[0] = 0.5 * p.vorticity[2];
  scheme.internal(vortices, VorticityExchange{}, 6 * width);
  double const before = mean_square_radius(vortices);
  Simulation simulation(scheme, time / 10);
  simulation.integrate(vortices, Method::rk2);
  simulation.run(10);
  EXPECT_NEAR((mean_square_radius(vortices) - before) / (6 * viscosity * time), 1, 1e-3);
  EXPECT_LT(error_of_profile(vortices, jumping<3>(start, time, width)), 2e-3);
  for (auto const& p : vortices) EXPECT_NEAR(p.vorticity[0], 0.5 * p.vorticity[2], 1e-12 * p.volume);
}

// With its flow, remeshed: from 0.01 to 0.11 of variance.
TEST(LambOseenExchange, SpreadsAsHeatDoes) {
  auto const run = shipped("lamb-oseen-exchange");
  AnyEnsemble& vortices = ensemble(*run, "vortices");
  auto const sums = [&] {
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < vortices.size(); ++i) {
      double const* row = vortices.row(i);
      sum += row[2], squares += row[2] * (square(row[0]) + square(row[1]));
    }
    return std::pair(sum, squares);
  };
  auto const [circulation, start] = sums();
  run->simulation->run(run->steps);
  auto const [now, squares] = sums();
  double const variance = 0.01 + 2 * viscosity * run->simulation->time();
  EXPECT_NEAR(now / circulation, 1, 1e-3) << "what was left out";
  EXPECT_NEAR((squares / now - start / circulation) / (4 * viscosity * run->simulation->time()), 1, 0.01);
  double const age = variance / (2 * viscosity), height = exact::lamb_oseen(0, age, 1, viscosity).vorticity;
  double largest = 0;
  for (std::size_t i = 0; i < vortices.size(); ++i) {
    double const* row = vortices.row(i);
    double const exact = exact::lamb_oseen(std::hypot(row[0], row[1]), age, 1, viscosity).vorticity;
    largest = std::max(largest, std::abs(row[2] / 0.0025 - exact) / height);
  }
  EXPECT_LT(largest, 0.03);
}

// The core of one element is all of Lamb and Oseen's vortex; split and merged, it is nearly so.
TEST(Spreading, IsLambsAndOseensVortex) {
  for (bool const split : {false, true}) {
    Ensemble<Spreading<2>> vortices("vortices", 1);
    vortices[0].vorticity[0] = 1, vortices[0].core = 0.1, vortices[0].viscosity = viscosity;
    PairScheme scheme(Box({-2, -2}, {2, 2}));
    scheme.internal(vortices, GaussianBiotSavart{});
    Simulation simulation(scheme, 0.02);
    if (split)
      simulation.adapt(1, CoreSplitter(vortices, scheme.box(), {.above = 0.11, .ratio = 0.9, .merge_within = 0.4}));
    simulation.run(50);
    double const variance = 0.01 + 2 * viscosity * simulation.time();
    double sum = 0, squares = 0;
    for (auto const& p : vortices) {
      sum += p.vorticity[0];
      squares += p.vorticity[0] * (norm2(p.position) + 2 * square(p.core));
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR(squares / (2 * variance), 1, split ? 1e-4 : 1e-8);
    double const age = variance / (2 * viscosity), height = exact::lamb_oseen(0, age, 1, viscosity).vorticity;
    double largest = 0;
    for (int k = 0; k < 40; ++k) {
      Vector<2> const x{0.02 * k, 0.0};
      double here = 0;
      for (auto const& p : vortices) here += p.vorticity[0] * gaussian<2>(square(p.core))(norm2(x - p.position));
      largest = std::max(largest, std::abs(here - exact::lamb_oseen(x[0], age, 1, viscosity).vorticity) / height);
    }
    EXPECT_LT(largest, split ? 0.06 : 1e-8);
    EXPECT_EQ(vortices.size() > 1, split);
    EXPECT_LT(vortices.size(), 3000U);
  }
}

// The mean square radius that N random walks give is off by 4 nu t / sqrt(N) in the mean square: over 400 seeds known to
// sqrt(2 / 400) of its square, of which five are 0.35.
TEST(RandomWalk, IsAsNoisyAsItMustBe) {
  for (std::size_t const count : {50U, 200U, 800U}) {
    double sum = 0;
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
      Ensemble<Viscous<2>> vortices("vortices", count);
      for (auto& p : vortices) p.viscosity = viscosity;
      PairScheme scheme(Box({-2, -2}, {2, 2}));
      scheme.add(vortices);
      Simulation simulation(scheme, 0.5);
      simulation.seed(test_seed(1) * 1000 + seed);
      simulation.run(2);
      double squares = 0;
      for (auto const& p : vortices) squares += norm2(p.position) / static_cast<double>(count);
      sum += square(squares / (4 * viscosity * 1.0) - 1);
    }
    EXPECT_NEAR(sum / 400 * static_cast<double>(count), 1, 0.35 + 12.0 / static_cast<double>(count)) << count;
  }
}

/// The direction of the long axis of a patch, from its second moments.
double direction(AnyEnsemble const& patch) {
  double xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < patch.size(); ++i) {
    double const *row = patch.row(i), x = row[0], y = row[1];
    xx += row[2] * x * x, yy += row[2] * y * y, xy += row[2] * x * y;
  }
  return 0.5 * std::atan2(2 * xy, xx - yy);
}

// Put onto a lattice every tenth step, an ellipse turns at a b / (a + b)^2 of its vorticity as before.
TEST(KirchhoffsEllipse, TurnsOnWhenItIsRemeshed) {
  for (auto const kernel : {RemeshKernel::m4, RemeshKernel::m6}) {
    auto const run = shipped("kirchhoff-ellipse");
    AnyEnsemble& ellipse = ensemble(*run, "ellipse");
    double const spacing = 6.0 / 95;
    run->simulation->adapt(
        10, Remesher(ellipse, run->box(), {.spacing = spacing, .kernel = kernel, .core = 0.09, .threshold = 1e-4}));
    auto const before = vortex_measures(ellipse);
    run->simulation->run(40);
    EXPECT_NEAR(direction(ellipse) / (2.0 / 9 * run->simulation->time()), 1, 0.015);
    auto const now = vortex_measures(ellipse);
    EXPECT_NEAR(now.circulation[0] / before.circulation[0], 1, 1e-3);
    EXPECT_NEAR(now.angular_impulse[0] / before.angular_impulse[0], 1, 2e-3);
  }
}

// A sheet of Gaussian cores of standard deviation c and strength g: displacements of wave number k, along the sheet and
// across it, grow as s^2 = g^2 (k E / 2) (k E / 2 + (1 - exp(-k^2 c^2 / 2)) / (sqrt(2 pi) c)), E = erfc(k c / sqrt(2)).
TEST(KelvinHelmholtz, GrowsAtItsRate) {
  for (double const core : {0.02, 0.05}) {
    Overrides overrides;
    overrides.set = {"ensembles.sheet.core=" + std::to_string(core)};
    auto const run = shipped("kelvin-helmholtz", overrides);
    AnyEnsemble& sheet = ensemble(*run, "sheet");
    auto const count = static_cast<double>(sheet.size());
    double const k = 2 * pi, along = k * std::erfc(k * core / std::sqrt(2)) / 2,
                 across = along - std::expm1(-k * k * core * core / 2) / (std::sqrt(2 * pi) * core),
                 rate = std::sqrt(along * across);
    if (core == 0.05) {
      EXPECT_NEAR(rate, 2.552, 0.001) << "as the description has it";
    }
    for (std::size_t i = 0; i < sheet.size(); ++i) {
      double const at = (static_cast<double>(i) + 0.5) / count, height = 1e-4 * std::sin(k * at);
      sheet.row(i)[0] = at + height, sheet.row(i)[1] = -height * std::sqrt(along / across);
    }
    auto const wave = [&] {
      double sum = 0;
      for (std::size_t i = 0; i < sheet.size(); ++i)
        sum -= sheet.row(i)[1] * std::sin(k * (static_cast<double>(i) + 0.5) / count) * 2 / count;
      return sum;
    };
    run->simulation->run(6);
    double const first = wave(), from = run->simulation->time();
    run->simulation->run(14);
    EXPECT_NEAR(std::log(wave() / first) / (run->simulation->time() - from) / rate, 1, 0.01) << core;
  }
}

/// The distance of the centres of two vortices.
double distance(ScenarioSimulation& run) {
  std::array<double, 2> centre[2]{};
  for (std::size_t k = 0; k < 2; ++k) {
    AnyEnsemble const& vortex = ensemble(run, k == 0 ? "first" : "second");
    double sum = 0;
    for (std::size_t i = 0; i < vortex.size(); ++i) {
      double const* row = vortex.row(i);
      sum += row[2];
      for (std::size_t a = 0; a < 2; ++a) centre[k][a] += row[2] * row[a];
    }
    for (double& x : centre[k]) x /= sum;
  }
  return std::hypot(centre[0][0] - centre[1][0], centre[0][1] - centre[1][1]);
}

// Vortices of a / b = 0.3 merge in less than a turn, those of 0.18 do not: the limit is 0.22 to 0.24.
TEST(Merger, HasACriticalDistance) {
  for (double const ratio : {0.18, 0.3}) {
    double const spacing = 0.075,
                 part = ratio * ratio - 2 * spacing * spacing;  // of a^2; the rest is that of the cores
    Overrides overrides;
    for (int k = 0; k < 2; ++k) {
      std::string const name = k == 0 ? "first" : "second",
                        square = k == 0 ? "((x + 0.5)^2 + y^2)" : "((x - 0.5)^2 + y^2)";
      overrides.set.push_back("ensembles." + name + ".load.spacing=" + std::to_string(spacing));
      overrides.set.push_back("ensembles." + name + ".load.where='" + square + " < " + std::to_string(7 * part) + "'");
      overrides.set.push_back("ensembles." + name + ".formulas.vorticity='" + std::to_string(spacing * spacing) +
                              "*exp(-" + square + "/" + std::to_string(part) + ")/(pi*" + std::to_string(part) + ")'");
      overrides.set.push_back("ensembles." + name + ".core=" + std::to_string(spacing));
    }
    overrides.set.push_back("remesh.0.spacing=" + std::to_string(spacing));
    overrides.set.push_back("remesh.0.core=" + std::to_string(spacing));
    auto const run = shipped("merger", overrides);
    double const start = distance(*run);
    EXPECT_NEAR(start, 1, 0.01);
    run->simulation->run(150);
    if (ratio < 0.2) {
      EXPECT_NEAR(distance(*run), 1, 0.1);
    } else {
      EXPECT_LT(distance(*run), 0.5);
    }
    double sum = 0;
    for (auto const& e : run->ensembles)
      for (std::size_t i = 0; i < e->size(); ++i) sum += e->row(i)[2];
    EXPECT_NEAR(sum, 2, 0.02);
  }
}

}  // namespace
}  // namespace boltzmann::vortex_viscosity_test
