// Flows of vortices against closed forms: pairs, Thomson's rings, Kirchhoff's ellipse, Lamb and Oseen's spreading, rings in
// space.
#include "shipped.hpp"

#include <boltzmann/boltzmann.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <string>
#include <vector>

namespace boltzmann::vortices_test {
namespace {

// Gamma / (2 pi d), and the fluid of Kelvin's oval goes with the pair: half axes 0.8635 (along) and 1.044 (across) d.
TEST(VortexPair, MovesAsTheClosedFormHasItAndCarriesItsOval) {
  auto const run = shipped("vortex-pair");
  AnyEnsemble &pair = ensemble(*run, "pair"), &dust = ensemble(*run, "dust");
  auto const from_pair = [&](std::size_t i) {  // 1 on the ellipse of these half axes, which the oval nearly is
    return std::hypot((dust.row(i)[0] - pair.row(0)[0]) / 0.8635, dust.row(i)[1] / 1.044);
  };
  std::vector<double> start;
  for (std::size_t i = 0; i < dust.size(); ++i) start.push_back(from_pair(i));
  double const from = pair.row(0)[0];
  run->simulation->run(run->steps);
  double const way = pair.row(0)[0] - from;
  EXPECT_NEAR(way / run->simulation->time() * 2 * pi, 1, 1e-4);
  EXPECT_NEAR(pair.row(0)[1] - pair.row(1)[1], 1, 1e-6);
  EXPECT_GT(way, 6) << "many times its own size";
  std::size_t inside = 0, outside = 0;
  for (std::size_t i = 0; i < dust.size(); ++i) {
    if (start[i] < 0.93) {
      EXPECT_LT(from_pair(i), 1.05) << i;
      ++inside;
    } else if (start[i] > 1.15) {
      EXPECT_GT(from_pair(i), 1) << i;
      ++outside;
    }
  }
  EXPECT_GT(inside, 100U);
  EXPECT_GT(outside, 100U);
}

/// How high the ripple of the mode is on a ring of vortices: the part of r - R that goes as cos(mode angle).
double ripple(AnyEnsemble const& ring, int mode) {
  double sum = 0;
  auto const count = static_cast<double>(ring.size());
  for (std::size_t k = 0; k < ring.size(); ++k)
    sum += (std::hypot(ring.row(k)[0], ring.row(k)[1]) - 1) * std::cos(2 * pi * mode * static_cast<double>(k) / count);
  return sum / count * (2 * mode == static_cast<int>(ring.size()) ? 1 : 2);
}

// A small ripple of mode m goes as cosh(s t), s^2 = m (N - m) (m (N - m) - 2 (N - 1)) (Gamma / 4 pi R^2)^2.
class ThomsonRing : public testing::TestWithParam<std::pair<int, int>> {};
INSTANTIATE_TEST_SUITE_P(Rings, ThomsonRing,
                         testing::Values(std::pair(6, 3), std::pair(6, 2), std::pair(7, 3), std::pair(8, 4),
                                         std::pair(8, 3), std::pair(9, 4)),
                         [](auto const& info) {
                           return std::to_string(info.param.first) + "_" + std::to_string(info.param.second);
                         });
TEST_P(ThomsonRing, GrowsOrSwingsAsThomsonAndHavelockHaveIt) {
  auto const [count, mode] = GetParam();
  Overrides overrides;
  overrides.set = {"ensembles.ring.number=" + std::to_string(count), "ensembles.ring.load.mode=" + std::to_string(mode),
                   "ensembles.ring.load.ripple=1e-6", "ensembles.ring.core=1e-3"};
  auto const run = shipped("thomson-ring", overrides);
  AnyEnsemble& ring = ensemble(*run, "ring");
  double const product = mode * (count - mode), square = product * (product - 2 * (count - 1)), unit = 1 / (4 * pi),
               start = ripple(ring, mode), angle = std::atan2(ring.row(0)[1], ring.row(0)[0]);
  EXPECT_NEAR(start, 1e-6, 1e-12);
  double largest = 0;
  std::complex<double> const rate = std::sqrt(std::complex<double>(square)) * unit;
  for (int k = 0; k < 10; ++k) {
    run->simulation->run(50);  // a time of 1
    double const expected = 1e-6 * std::cosh(rate * run->simulation->time()).real();
    EXPECT_NEAR(ripple(ring, mode), expected, 0.01 * std::max(1e-6, std::abs(expected))) << run->simulation->time();
    largest = std::max(largest, std::abs(ripple(ring, mode)));
  }
  if (count < 8) {
    EXPECT_LT(largest, 1.01e-6) << "stable, or on the edge";
  } else {
    EXPECT_GT(largest, 3e-6) << "unstable";
  }
  // And all of it turns at (N - 1) Gamma / (4 pi R^2).
  double const turned = std::remainder(
      std::atan2(ring.row(0)[1], ring.row(0)[0]) - angle - (count - 1) * unit * run->simulation->time(), 2 * pi);
  EXPECT_NEAR(turned, 0, 1e-3);
}

/// The direction of the long axis of an ellipse of vortices, from its second moments.
double direction(AnyEnsemble const& ellipse) {
  double xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < ellipse.size(); ++i) {
    double const x = ellipse.row(i)[0], y = ellipse.row(i)[1];
    xx += x * x, yy += y * y, xy += x * y;
  }
  return 0.5 * std::atan2(2 * xy, xx - yy);
}

/// a b / (a + b)^2 of the vorticity, of what a lattice makes of the ellipse: circulation / (pi (a + b)^2).
double expected_turning(AnyEnsemble const& ellipse, double circulation) {
  double xx = 0, yy = 0;
  auto const count = static_cast<double>(ellipse.size());
  for (std::size_t i = 0; i < ellipse.size(); ++i)
    xx += square(ellipse.row(i)[0]) / count, yy += square(ellipse.row(i)[1]) / count;
  return count * circulation / (pi * square(2 * std::sqrt(xx) + 2 * std::sqrt(yy)));
}

// Closer with finer lattices and cores.
TEST(KirchhoffsEllipse, TurnsAsTheClosedFormHasIt) {
  std::vector<double> errors;
  for (int const cells : {48, 95}) {
    double const spacing = 6.0 / cells;
    Overrides overrides;
    overrides.set = {"ensembles.ellipse.load.spacing=" + std::to_string(spacing),
                     "ensembles.ellipse.vorticity=" + std::to_string(spacing * spacing),
                     "ensembles.ellipse.core=" + std::to_string(1.5 * spacing)};
    auto const run = shipped("kirchhoff-ellipse", overrides);
    AnyEnsemble& ellipse = ensemble(*run, "ellipse");
    double const turning = expected_turning(ellipse, spacing * spacing);
    EXPECT_NEAR(turning, 2.0 / 9, 0.01 * 2 / 9);
    run->simulation->run(40);
    errors.push_back(direction(ellipse) / (turning * run->simulation->time()) - 1);
  }
  EXPECT_LT(std::abs(errors[1]), 0.01);
  EXPECT_LT(std::abs(errors[1]), 0.6 * std::abs(errors[0])) << errors[0] << ", " << errors[1];
}

// The mean square radius grows by 4 nu t, whatever the vortices do to each other: within three standard errors.
TEST(LambOseen, SpreadsAsHeatDoes) {
  auto const run = shipped("lamb-oseen");
  AnyEnsemble& vortices = ensemble(*run, "vortices");
  auto const mean_square = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < vortices.size(); ++i) sum += square(vortices.row(i)[0]) + square(vortices.row(i)[1]);
    return sum / static_cast<double>(vortices.size());
  };
  double const start = mean_square();
  run->simulation->run(run->steps);
  double const growth = 4 * 0.01 * run->simulation->time();
  // The square of a radius is distributed exponentially: its standard deviation is its mean.
  EXPECT_NEAR(mean_square() - start, growth, 3 * growth / std::sqrt(static_cast<double>(vortices.size())));
  // Half of the vorticity is within sqrt(4 nu t ln 2).
  std::size_t within = 0;
  for (std::size_t i = 0; i < vortices.size(); ++i)
    within += square(vortices.row(i)[0]) + square(vortices.row(i)[1]) < growth * std::log(2.0);
  EXPECT_NEAR(static_cast<double>(within) / static_cast<double>(vortices.size()), 0.5,
              3 * 0.5 / std::sqrt(static_cast<double>(vortices.size())) + start / growth);
}

/// A single ring, with elements that overlap, and how fast it goes.
double speed_of_ring(double core, double transposed) {
  std::size_t const count = 400;
  Ensemble<Inviscid<3>> ring("ring", count);
  ring_load(ring, {.radius = 1});
  for (auto& p : ring) {
    p.vorticity = Vector<3>{-p.position[1], p.position[0], 0.0} * (2 * pi / static_cast<double>(count));
    p.core = core;
  }
  PairScheme scheme(Box({-3, -3, -3}, {3, 3, 3}));
  scheme.internal(ring, BiotSavart{.transposed = transposed});
  Simulation simulation(scheme, 0.02);
  simulation.run(100);
  double z = 0, widest = 0;
  for (auto const& p : ring) {
    z += p.position[2] / static_cast<double>(count);
    widest = std::max(widest, std::abs(std::hypot(p.position[0], p.position[1]) - 1));
  }
  EXPECT_LT(widest, 1e-6);
  return z / simulation.time();
}

// Of Rosenhead's core: Gamma / (4 pi R) (ln(8 R / core) - 1), to the order of (core / R)^2 ln(R / core) (P. G. Saffman,
// Vortex Dynamics, section 10.3).
TEST(VortexRing, MovesAsSaffmanHasIt) {
  for (double const core : {0.05, 0.1}) {
    double const expected = 1 / (4 * pi) * (std::log(8 / core) - 1);
    EXPECT_NEAR(speed_of_ring(core, 1) / expected, 1, 0.01) << core;
    EXPECT_NEAR(speed_of_ring(core, 0) / expected, 1, 0.01) << core;
  }
}

// Two rings of elements against two circles that move by the same law, integrated around them: they leap.
TEST(LeapfrogRings, MoveAsTwoCirclesDo) {
  auto const run = shipped("leapfrog-rings");
  AnyEnsemble &first = ensemble(*run, "first"), &second = ensemble(*run, "second");
  struct Circle {
    double radius, z;
  };
  auto const velocity = [](Circle const& at, Circle const& of, double core) {  // by quadrature around the circle
    int const parts = 2000;
    Circle sum{0, 0};
    for (int k = 0; k < parts; ++k) {
      double const angle = 2 * pi * (k + 0.5) / parts, c = std::cos(angle), z = at.z - of.z;
      double const s2 = square(at.radius) + square(of.radius) - 2 * at.radius * of.radius * c + z * z + core * core;
      double const weight = of.radius / (4 * pi * s2 * std::sqrt(s2)) * 2 * pi / parts;
      sum.z += weight * (of.radius - at.radius * c);
      sum.radius += weight * z * c;
    }
    return sum;
  };
  std::vector<Circle> rings{{1, 0}, {1, 1}};
  auto const rates = [&](std::vector<Circle> const& r) {
    std::vector<Circle> all(2);
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        auto const v = velocity(r[static_cast<std::size_t>(i)], r[static_cast<std::size_t>(j)], 0.15);
        all[static_cast<std::size_t>(i)].radius += v.radius, all[static_cast<std::size_t>(i)].z += v.z;
      }
    return all;
  };
  auto const moved = [](std::vector<Circle> r, std::vector<Circle> const& v, double dt) {
    for (std::size_t i = 0; i < 2; ++i) r[i].radius += dt * v[i].radius, r[i].z += dt * v[i].z;
    return r;
  };
  double const dt = 0.05;
  bool leapt = false;
  for (int step = 0; step < 240; ++step) {
    auto const k1 = rates(rings), k2 = rates(moved(rings, k1, dt / 2)), k3 = rates(moved(rings, k2, dt / 2)),
               k4 = rates(moved(rings, k3, dt));
    for (std::size_t i = 0; i < 2; ++i) {
      rings[i].radius += dt / 6 * (k1[i].radius + 2 * k2[i].radius + 2 * k3[i].radius + k4[i].radius);
      rings[i].z += dt / 6 * (k1[i].z + 2 * k2[i].z + 2 * k3[i].z + k4[i].z);
    }
    run->simulation->run(1);
    leapt = leapt || rings[0].z > rings[1].z;
    if (step % 40 != 39) continue;
    for (auto const& [elements, circle] : {std::pair(&first, rings[0]), std::pair(&second, rings[1])}) {
      double z = 0, radius = 0;
      auto const count = static_cast<double>(elements->size());
      for (std::size_t i = 0; i < elements->size(); ++i)
        z += elements->row(i)[2] / count, radius += std::hypot(elements->row(i)[0], elements->row(i)[1]) / count;
      EXPECT_NEAR(z, circle.z, 0.01) << elements->name() << " at step " << step;
      EXPECT_NEAR(radius, circle.radius, 0.01) << elements->name() << " at step " << step;
    }
  }
  EXPECT_TRUE(leapt);
}

/// Where the vorticity of a ring is along its axis, z.
double middle(AnyEnsemble const& ring) {
  int const at = ring.field("vorticity").offset;
  double sum = 0, all = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    double const part = std::hypot(ring.row(i)[at], ring.row(i)[at + 1]);
    sum += part * ring.row(i)[2], all += part;
  }
  return sum / all;
}

FlowMeasures measures_of(ScenarioSimulation const& run) {
  auto const& schemes = run.simulation->schemes();
  return VortexFlow(vortex_sources(schemes), run.box()).measure();
}

// A core that goes as exp(-d^2 / a^2): Gamma / (4 pi R) (ln(8 R / a) - 0.558), the energy 1/2 Gamma^2 R (ln(8 R / a) -
// 2.058) (P. G. Saffman, Stud. Appl. Math. 49, 371 (1970)), pi Gamma R^2 the impulse; the next term of the speed is
// -0.918 (a / R)^2 (Y. Fukumoto and H. K. Moffatt, J. Fluid Mech. 417, 1 (2000)).
TEST(VortexRing, MovesAsSaffmanHasItWithAResolvedCore) {
  auto const run = shipped("vortex-ring");
  AnyEnsemble& ring = ensemble(*run, "ring");
  double const a = 0.2, start = middle(ring), impulse = vortex_measures(ring).impulse[2];
  double const R = std::sqrt(impulse / pi), thin = std::log(8 * R / a) - 0.558;
  FlowMeasures const before = measures_of(*run);
  EXPECT_NEAR(impulse, pi * (1 + a * a / 2 - square(ring.row(0)[ring.field("core").offset])), 1e-3);
  EXPECT_NEAR(before.energy / (0.5 * R * (thin - 1.5)), 1, 0.01);
  EXPECT_NEAR(before.enstrophy * a * a, 1, 0.02) << "of a straight tube: Gamma^2 / (2 pi a^2) times 2 pi R";
  EXPECT_LT(before.divergence, 0.02);
  run->simulation->run(run->steps);
  double const speed = (middle(ring) - start) / run->simulation->time();
  EXPECT_NEAR(speed / ((thin - 0.918 * square(a / R)) / (4 * pi * R)), 1, 0.01);
  FlowMeasures const after = measures_of(*run);
  EXPECT_NEAR(after.energy / before.energy, 1, 2e-3);
  EXPECT_NEAR(vortex_measures(ring).impulse[2] / impulse, 1, 2e-3);
  for (double const sum : vortex_measures(ring).circulation) EXPECT_NEAR(sum, 0, 1e-3);
}

// Head on: the rings are stretched to twice their radius in front of the plane between them, and neither impulse nor
// helicity appears. Cores keep their radius, which a fluid without viscosity would not allow: that costs energy, and more
// of it the further the rings are stretched.
TEST(RingCollision, StretchesRingsWithoutImpulseAndHelicity) {
  auto const run = shipped("ring-collision");
  AnyEnsemble &upper = ensemble(*run, "upper"), &lower = ensemble(*run, "lower");
  auto const radius = [](AnyEnsemble const& ring) {
    int const at = ring.field("vorticity").offset;
    double sum = 0, all = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      double const part = std::hypot(ring.row(i)[at], ring.row(i)[at + 1]);
      sum += part * std::hypot(ring.row(i)[0], ring.row(i)[1]), all += part;
    }
    return sum / all;
  };
  FlowMeasures const before = measures_of(*run);
  double const wide = radius(upper);
  run->simulation->run(30);
  FlowMeasures const between = measures_of(*run);
  EXPECT_LT(between.energy, before.energy);
  EXPECT_NEAR(between.energy / before.energy, 1, 0.08);
  run->simulation->run(30);
  FlowMeasures const after = measures_of(*run);
  EXPECT_GT(radius(upper), 1.9 * wide);
  EXPECT_NEAR(radius(upper), radius(lower), 0.01);
  EXPECT_NEAR(middle(upper), -middle(lower), 0.01);
  EXPECT_GT(middle(upper), 0.1) << "they never meet";
  EXPECT_LT(middle(upper), 0.4);
  EXPECT_NEAR(after.energy / before.energy, 0.8, 0.05);
  EXPECT_GT(after.enstrophy, 1.7 * before.enstrophy);
  EXPECT_LT(after.divergence, 0.01);
  std::vector<AnyEnsemble const*> const both{&upper, &lower};
  auto const conserved = vortex_measures(both);
  for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(conserved.impulse[a], 0, 1e-3);
  EXPECT_NEAR(conserved.helicity, 0, 1e-3);
}

}  // namespace
}  // namespace boltzmann::vortices_test
