// Remeshing and splitting of vortices: what stays, what is lost, where nodes may be, and runs that are stopped.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/particles/spreading.hpp>

#include <gtest/gtest.h>
#include <tests/files/temporary_folder.hpp>
#include <tests/message.hpp>
#include <tests/same_rows.hpp>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace boltzmann::remesh_test {
namespace {

template <int D>
Box box(Boundary boundary = Boundary::open) {
  Vector<D> low{}, high{};
  for (int a = 0; a < D; ++a) low[a] = -1, high[a] = 1;
  return Box(low, high, boundary);
}

template <int D>
void load_random(Ensemble<Diffusive<D>>& vortices, std::size_t count, double within = 0.7) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(-within, within), strength(-1, 2);
  vortices.resize(count);
  for (auto& p : vortices) {
    for (int a = 0; a < D; ++a) p.position[a] = place(random);
    for (int a = 0; a < cross_dimension<D>; ++a) p.vorticity[a] = strength(random);
    p.core = 0.3, p.volume = 1, p.viscosity = 0.25;
  }
}

template <int D>
double sum_of_magnitudes(Ensemble<Diffusive<D>> const& vortices) {
  double sum = 0;
  for (auto const& p : vortices) sum += magnitude(p.vorticity);
  return sum;
}

void expect_near(Triple const& a, Triple const& b, double bound, char const* what) {
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], bound) << what << " " << k;
}
void expect_same_moments(VortexMeasures const& before, VortexMeasures const& now, double scale) {
  expect_near(before.circulation, now.circulation, 1e-13 * scale, "circulation");
  expect_near(before.impulse, now.impulse, 1e-13 * scale, "impulse");
  expect_near(before.angular_impulse, now.angular_impulse, 1e-13 * scale, "angular impulse");
}

TEST(RemeshWeights, KeepTheirMoments) {
  for (auto const& [kernel, highest] : {std::pair(RemeshKernel::m4, 2), std::pair(RemeshKernel::m6, 4)})
    for (double const fraction : {0.0, 0.1, 0.37, 0.5, 0.81, 0.999}) {
      std::array<double, 6> weights{};
      int const half = remesh_weights(kernel, fraction, weights);
      for (int power = 0; power <= highest; ++power) {
        double sum = 0;
        for (int k = 0; k < 2 * half; ++k)
          sum += weights[static_cast<std::size_t>(k)] * std::pow(1 - half + k - fraction, power);
        EXPECT_NEAR(sum, power == 0 ? 1 : 0, 3e-15) << power << " at " << fraction;
      }
      double beyond = 0;  // the next moment is not kept
      for (int k = 0; k < 2 * half; ++k)
        beyond += weights[static_cast<std::size_t>(k)] * std::pow(1 - half + k - fraction, highest + 1);
      if (fraction > 0 && fraction != 0.5) {
        EXPECT_GT(std::abs(beyond), 1e-4) << fraction;
      }
      for (int k = 0; k < 2 * half; ++k)
        if (fraction == 0) {
          EXPECT_EQ(weights[static_cast<std::size_t>(k)], k == half - 1 ? 1 : 0);
        }
    }
}

template <int D>
void expect_moments_stay() {
  for (auto const kernel : {RemeshKernel::m4, RemeshKernel::m6}) {
    Ensemble<Diffusive<D>> vortices("vortices");
    load_random(vortices, 300);
    auto const before = vortex_measures(vortices);
    auto const done = remesh(vortices, box<D>(), {.spacing = 0.11, .kernel = kernel, .core = 0.2});
    expect_same_moments(before, vortex_measures(vortices), 300);
    EXPECT_EQ(done.removed, 0U);
    EXPECT_GT(vortices.size(), 100U);
    for (auto const& p : vortices) {
      EXPECT_EQ(p.core, 0.2);
      EXPECT_EQ(p.viscosity, 0.25);
      EXPECT_NEAR(p.volume, std::pow(0.11, D), 1e-15);
      for (int a = 0; a < D; ++a) {
        double const node = (p.position[a] + 1) / 0.11 - 0.5;
        EXPECT_NEAR(node, std::round(node), 1e-12);
      }
    }
    // Once more changes nothing: each stands on its node.
    std::vector<Diffusive<D>> const once(vortices.begin(), vortices.end());
    remesh(vortices, box<D>(), {.spacing = 0.11, .kernel = kernel, .core = 0.2});
    double largest = 0, largest_change = 0;
    std::size_t at = 0;
    for (auto const& p : once) {
      while (at < vortices.size() && magnitude(vortices[at].position - p.position) > 1e-9) ++at;
      if (magnitude(p.vorticity) < 1e-9) continue;
      ASSERT_LT(at, vortices.size());
      largest = std::max(largest, magnitude(p.vorticity));
      largest_change = std::max(largest_change, magnitude(vortices[at].vorticity - p.vorticity));
    }
    EXPECT_LT(largest_change, 1e-12 * largest);
  }
}
TEST(Remesh, KeepsVorticityImpulseAndAngularImpulse) {
  expect_moments_stay<2>();
  expect_moments_stay<3>();
}

// A patch around the corner where all ends of a periodic box meet is what it is in the middle.
template <int D>
void expect_periodic() {
  Ensemble<Diffusive<D>> middle("middle"), around("around");
  load_random(middle, 100, 0.3);
  Box const space = box<D>(Boundary::periodic);
  for (auto p : middle) {
    for (int a = 0; a < D; ++a) p.position[a] += p.position[a] < 0 ? 1 : -1;
    around.add(p);
  }
  Remeshing const how{.spacing = 0.125, .kernel = RemeshKernel::m6, .threshold = 0.01, .max_loss = 0.5, .margin = 1};
  auto const lost = remesh(middle, space, how), lost_around = remesh(around, space, how);
  EXPECT_GT(lost.removed, 0U);
  EXPECT_EQ(lost.removed, lost_around.removed);
  EXPECT_NEAR(lost.magnitudes_lost, lost_around.magnitudes_lost, 1e-12);
  ASSERT_EQ(middle.size(), around.size());
  for (auto const& p : middle) {
    std::size_t found = 0;
    for (auto const& q : around) {
      auto d = q.position - p.position;
      for (int a = 0; a < D; ++a) d[a] = std::abs(d[a]) - 1;
      if (magnitude(d) > 1e-9) continue;
      ++found;
      EXPECT_LT(magnitude(q.vorticity - p.vorticity), 1e-12);
    }
    EXPECT_EQ(found, 1U);
  }
}
TEST(Remesh, RepeatsAlongPeriodicAxes) {
  expect_periodic<2>();
  expect_periodic<3>();
}

TEST(Remesh, TellsWhatIsLostAndKeepsItBounded) {
  for (double const max_loss : {1e-3, 0.02, 0.9}) {
    Ensemble<Diffusive<2>> vortices("vortices");
    load_random(vortices, 400);
    auto const before = vortex_measures(vortices);
    Ensemble<Diffusive<2>> all("all");
    for (auto const& p : vortices) all.add(p);
    remesh(all, box<2>(), {.spacing = 0.1});
    auto const done = remesh(vortices, box<2>(), {.spacing = 0.1, .threshold = 0.1, .max_loss = max_loss});
    EXPECT_GT(done.removed, 0U);
    EXPECT_EQ(vortices.size() + done.removed, all.size());
    EXPECT_NEAR(before.circulation[0] - vortex_measures(vortices).circulation[0], done.vorticity_lost[2], 1e-11);
    EXPECT_NEAR(sum_of_magnitudes(all) - sum_of_magnitudes(vortices), done.magnitudes_lost, 1e-11);
    EXPECT_LE(done.magnitudes_lost, max_loss * sum_of_magnitudes(all));
    if (max_loss > 0.5) {
      double greatest = 0, least = 1e300;
      for (auto const& p : vortices) {
        greatest = std::max(greatest, std::abs(p.vorticity[0]));
        least = std::min(least, std::abs(p.vorticity[0]));
      }
      EXPECT_GE(least, 0.1 * greatest);
    }
  }
  // One vortex with a margin of two: 5 x 5 nodes, and none without vorticity where there is no margin.
  Ensemble<Diffusive<2>> one("one", 1);
  one[0].position = {0.05, 0.05}, one[0].vorticity[0] = 1, one[0].viscosity = 3, one[0].core = 0.1;
  remesh(one, box<2>(), {.spacing = 0.1, .margin = 2});
  ASSERT_EQ(one.size(), 25U);
  for (auto const& p : one) EXPECT_EQ(p.viscosity, 3);
  EXPECT_NEAR(one[12].vorticity[0], 1, 1e-12);
  EXPECT_NEAR(one[12].core, 0.15, 1e-15);
  remesh(one, box<2>(), {.spacing = 0.1, .threshold = 1e-6});
  EXPECT_EQ(one.size(), 1U);
  Ensemble<Diffusive<2>> none("none");
  remesh(none, box<2>(), {.spacing = 0.1, .margin = 2});
  EXPECT_EQ(none.size(), 0U);
}

TEST(Remesh, HasNoNodesBeyondWalls) {
  Box space = box<2>(Boundary::reflecting);
  space.install(Vector{-0.2, -0.2}, Vector{0.2, 0.2}, Region::Side::keep_out);
  auto const outside = [](Vector<2> const& x) { return magnitude(x - Vector{0.6, 0.6}) > 0.25; };
  Ensemble<Diffusive<2>> vortices("vortices");
  load_random(vortices, 2000, 0.99);
  std::vector<Diffusive<2>> const all(vortices.begin(), vortices.end());
  vortices.resize(0);
  for (auto const& p : all)
    if (outside(p.position) && std::max(std::abs(p.position[0]), std::abs(p.position[1])) > 0.2) vortices.add(p);
  ASSERT_LT(vortices.size(), 1900U);
  auto const before = vortex_measures(vortices);
  auto const done = remesh(vortices, space, {.spacing = 0.05, .allowed = [&](auto const& x) {
                                               return outside({x[0], x[1]});
                                             }});
  expect_same_moments(before, vortex_measures(vortices), 2000);
  EXPECT_EQ(done.left_as_they_are, 0U);
  EXPECT_NO_THROW(space.check(vortices));
  for (auto const& p : vortices) EXPECT_TRUE(outside(p.position));
  // In a hole that has no three nodes side by side nothing is done.
  Ensemble<Diffusive<2>> one("one", 1);
  one[0].vorticity[0] = 1, one[0].core = 0.1, one[0].position = {0.03, 0.02};
  EXPECT_EQ(remesh(one, box<2>(), {.spacing = 0.05, .allowed = [](auto const& x) { return std::abs(x[0]) < 0.06; }})
                .left_as_they_are,
            1U);
  EXPECT_EQ(one[0].position[0], 0.03);
  EXPECT_EQ(one[0].core, 0.1);
}

template <class Real>
struct DyedVortex : Vortex<2, Real> {
  static constexpr char const* class_name = "DyedVortex";
  Real dye;
};

TEST(Remesh, OtherFieldsAreThoseOfWhoGaveMost) {
  Ensemble<DyedVortex<double>> vortices("vortices", 2);
  vortices[0].position = {-0.51, -0.52}, vortices[1].position = {0.52, 0.53};
  for (std::size_t i = 0; i < 2; ++i)
    vortices[i].vorticity[0] = 1, vortices[i].core = 0.1, vortices[i].dye = static_cast<double>(i + 1);
  remesh(vortices, box<2>(), {.spacing = 0.1});
  ASSERT_EQ(vortices.size(), 32U);
  for (auto const& p : vortices) EXPECT_EQ(p.dye, p.position[0] < 0 ? 1 : 2);
}

TEST(Remesh, RefusesWhatCannotBe) {
  Ensemble<Diffusive<2>> vortices("vortices", 1);
  Ensemble<Tracer<2>> dust("dust", 1);
  auto const told = [&](Remeshing const& how, Boundary boundary = Boundary::open) {
    return message([&] { Remesher(vortices, box<2>(boundary), how); });
  };
  EXPECT_EQ(told({.spacing = 0.3}, Boundary::periodic),
            "remesh: the spacing 0.3 does not divide the periodic axis x of 2; the nearest that do are "
            "0.2857142857142857 and 0.3333333333333333");
  EXPECT_EQ(told({.spacing = 0.25}, Boundary::periodic), "no error");
  EXPECT_EQ(told({}), "remesh: spacing = 0 must be a positive length");
  EXPECT_EQ(told({.spacing = 1, .threshold = 1}), "remesh: threshold = 1 must be at least 0 and below 1");
  EXPECT_EQ(told({.spacing = 1, .max_loss = -1}), "remesh: max_loss = -1 must be at least 0 and below 1");
  EXPECT_EQ(told({.spacing = 1, .margin = -1}), "remesh: margin = -1 must be between 0 and 100");
  EXPECT_EQ(message([&] { remesh(dust, box<2>(), {.spacing = 1}); }),
            "remesh: 'dust' is of class Tracer, which has no vorticity; vortices are remeshed");
  vortices[0].vorticity[0] = 1;
  vortices.resize(2);
  vortices[1].position = {1e7, 1e7};
  EXPECT_NE(message([&] { remesh(vortices, box<2>(), {.spacing = 0.1}); }).find("take a wider spacing"),
            std::string::npos);
  vortices[1].position = {std::nan(""), 0.0};
  EXPECT_THROW(remesh(vortices, box<2>(), {.spacing = 0.1}), PhysicsFailure);
}

// ---- Runs ----

/// A patch of vorticity that turns in a shear of a second ensemble, diffuses, and is remeshed.
struct Patch {
  Ensemble<Diffusive<2>> patch{"patch"}, other{"other"};
  PairScheme scheme;
  Simulation simulation;

  explicit Patch(int threads = 1) : scheme(Box({-1, -1}, {1, 1})), simulation(scheme, 0.05) {
    load_random(patch, 150, 0.3);
    load_random(other, 60, 0.6);
    for (auto* ensemble : {&patch, &other})
      for (auto& p : *ensemble) p.core = 0.1, p.volume = 0.0025, p.viscosity = 0.005, p.vorticity *= 0.02;
    scheme.internal(patch, GaussianBiotSavart{});
    scheme.internal(other, GaussianBiotSavart{});
    scheme.between(patch, other, GaussianBiotSavart{});
    scheme.internal(patch, VorticityExchange{.width = 0.05}, 0.25);
    simulation.adapt(4, Remesher(patch, scheme.box(), {.spacing = 0.05, .threshold = 1e-3, .margin = 1}));
    simulation.adapt(6, Remesher(other, scheme.box(), {.spacing = 0.1, .kernel = RemeshKernel::m6, .threshold = 1e-2}));
    simulation.threads(threads);
  }
};

TEST(Remesher, ThreadsChangeNoBit) {
  Patch one(1), two(2), three(3);
  for (Patch* patch : {&one, &two, &three}) patch->simulation.run(14);
  EXPECT_NE(one.patch.size(), 150U);
  for (Patch* patch : {&two, &three}) {
    expect_same_rows(one.patch, patch->patch);
    expect_same_rows(one.other, patch->other);
  }
}

TEST(Remesher, GoesOnWithTheBitsOfARunWithoutAStop) {
  TemporaryFolder const folder;
  auto const record = [&](std::string const& name, std::uint64_t steps, bool resume) {
    auto patch = std::make_unique<Patch>();
    Recording recording(patch->simulation, UnitSystem::reduced(), folder / name);
    recording.diagnoses(2, {"vortex-invariants"});
    recording.trajectory(2);
    recording.checkpoint(3);
    if (resume) recording.resume();
    run_with_progress(recording, steps, {.quiet = true});
    return patch;
  };
  record("parts", 10, false);
  auto const resumed = record("parts", 8, true), whole = record("whole", 18, false);
  EXPECT_EQ(whole->simulation.step(), 18);
  expect_same_rows(whole->patch, resumed->patch);
  expect_same_rows(whole->other, resumed->other);
  EXPECT_EQ(read_text(folder / "parts/diagnoses.csv"), read_text(folder / "whole/diagnoses.csv"));
  std::vector<std::string> reports;
  for (auto const& run : {whole.get(), resumed.get()}) {
    std::string all;
    for (auto const* adaptation : run->simulation.adaptations())
      all += adaptation->report(UnitSystem::reduced()) + '\n';
    reports.push_back(all);
  }
  EXPECT_EQ(reports[0], reports[1]);
  EXPECT_NE(reports[0].find("'patch': remeshed 4 times, "), std::string::npos) << reports[0];
  EXPECT_NE(reports[0].find("weak ones left out, circulation lost: "), std::string::npos) << reports[0];
  TrajectoryReader const a(folder / "parts/trajectory.h5"), b(folder / "whole/trajectory.h5");
  ASSERT_EQ(a.steps(), b.steps());
  for (std::size_t frame = 0; frame < a.frames(); ++frame)
    for (char const* field : {"position", "vorticity", "volume"})
      EXPECT_EQ(a.read(frame, "patch", field), b.read(frame, "patch", field)) << field << " of frame " << frame;
  EXPECT_NE(a.size(0, "patch"), a.size(2, "patch"));
}

// ---- Cores that are split ----

/// The sum of vorticity, and its first and second moments, cores counted as Gaussians.
template <int D>
std::vector<double> moments(Ensemble<Spreading<D>> const& vortices) {
  std::vector<double> sums(1 + D + D * D);
  for (auto const& p : vortices) {
    double const gamma = p.vorticity[0];
    sums[0] += gamma;
    for (int a = 0; a < D; ++a) {
      sums[static_cast<std::size_t>(1 + a)] += gamma * p.position[a];
      for (int b = 0; b < D; ++b)
        sums[static_cast<std::size_t>(1 + D + D * a + b)] +=
            gamma * (p.position[a] * p.position[b] + (a == b ? p.core * p.core : 0));
    }
  }
  return sums;
}

template <int D>
void expect_split() {
  Ensemble<Spreading<D>> vortices("vortices", 40);
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> from(0, 1);
  for (auto& p : vortices) {
    for (int a = 0; a < D; ++a) p.position[a] = from(random);
    for (int a = 0; a < cross_dimension<D>; ++a) p.vorticity[a] = (1 + from(random));
    p.core = 0.1 + 0.1 * from(random), p.viscosity = 0.3;
  }
  auto const before = moments(vortices);
  auto const done = split_cores(vortices, {.above = 0.15, .ratio = 0.7});
  EXPECT_GT(done.splits, 10U);
  EXPECT_LT(done.splits, 30U);
  EXPECT_EQ(vortices.size(), 40 + (2 * D - 1) * done.splits);
  for (auto const& p : vortices) {
    EXPECT_LE(p.core, 0.15);
    EXPECT_EQ(p.viscosity, 0.3);
  }
  auto const split = moments(vortices);
  for (std::size_t k = 0; k < before.size(); ++k) EXPECT_NEAR(split[k], before[k], 1e-12) << k;
  if (D == 3) return;  // directions differ
  auto const merged = split_cores(vortices, {.above = 0.15, .ratio = 0.7, .merge_within = 0.5});
  EXPECT_GT(merged.merges, 5U);
  EXPECT_EQ(merged.splits, 0U);
  auto const after = moments(vortices);
  for (std::size_t k = 0; k < 1 + D; ++k) EXPECT_NEAR(after[k], before[k], 1e-12) << k;
  EXPECT_NEAR(after[3] + after[6], before[3] + before[6], 1e-12) << "the trace of the second";
  for (auto const& p : vortices) EXPECT_LE(p.core, 0.15);
}
TEST(CoreSplitter, KeepsMoments) {
  expect_split<2>();
  expect_split<3>();
}

TEST(CoreSplitter, MergesWhatIsAlike) {
  Ensemble<Spreading<3>> pair("pair", 2);
  pair[0].vorticity = {0.0, 0.0, 1.0}, pair[1].vorticity = {0.0, 0.01, 3.0};
  pair[0].core = 0.1, pair[1].core = 0.12, pair[1].position = {0.04, 0.0, 0.0};
  CoreSplitting const how{.above = 0.2, .merge_within = 0.5};
  EXPECT_EQ(split_cores(pair, how).merges, 1U);
  ASSERT_EQ(pair.size(), 1U);
  EXPECT_EQ(pair[0].vorticity, (Vector{0.0, 0.01, 4.0}));
  EXPECT_NEAR(pair[0].position[0], 0.03, 1e-6);
  EXPECT_NEAR(square(pair[0].core), (0.01 + 3 * 0.0144) / 4 + 3.0 / 16 * 0.0016 / 3, 1e-7);
  pair.resize(2);
  pair[1] = pair[0];
  pair[1].vorticity = pair[0].vorticity * -1.0;
  EXPECT_EQ(split_cores(pair, how).merges, 0U) << "they turn against each other";
  EXPECT_EQ(split_cores(pair, {.above = 0.11, .ratio = 0.5}).splits, 2U);
}

TEST(CoreSplitter, RefusesWhatCannotBe) {
  Ensemble<Spreading<2>> vortices("vortices", 1);
  Ensemble<Tracer<2>> dust("dust", 1);
  EXPECT_EQ(message([&] { CoreSplitter(vortices, box<2>(), {}); }), "split_cores: above = 0 must be a positive length");
  EXPECT_EQ(message([&] { CoreSplitter(vortices, box<2>(), {.above = 1, .ratio = 1}); }),
            "split_cores: ratio = 1 must be between 0.5 and 0.95");
  EXPECT_EQ(message([&] { CoreSplitter(dust, box<2>(), {.above = 1}); }),
            "split_cores: 'dust' is of class Tracer, which has no vorticity; vortices are split");
  EXPECT_NE(
      message([&] { CoreSplitter(vortices, box<2>(Boundary::reflecting), {.above = 1}); }).find("axis x is reflecting"),
      std::string::npos);
}

}  // namespace
}  // namespace boltzmann::remesh_test
