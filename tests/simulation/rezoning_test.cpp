// Rezoning while a simulation runs: what is conserved, sound that crosses the border of fine and coarse particles,
// threads, files and restarts of runs whose number of particles changes.
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/files/csv.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/laws/materials/newtonian.hpp>
#include <boltzmann/particles/smooth.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>
#include <boltzmann/simulation/conserved.hpp>
#include <boltzmann/simulation/rezoner.hpp>

#include <gtest/gtest.h>
#include <tests/files/temporary_folder.hpp>
#include <tests/message.hpp>
#include <tests/same_rows.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <filesystem>
#include <limits>
#include <numbers>
#include <vector>

namespace boltzmann::rezoning_test {
namespace {

constexpr double pi = std::numbers::pi;
using By = Rezoning::By;

/// A hot round spot in a periodic box of gas, dense in the middle, that bursts. Half the ensemble may have another
/// name.
struct Burst {
  double side;
  Ensemble<Smooth<2>> gas{"gas"}, air{"air"};
  SmoothScheme scheme;
  Simulation simulation;

  Burst(std::size_t n, Method method, bool vary = false, bool halved = false, double dt = 0.02)
      : side(static_cast<double>(n)),
        scheme(Box(Vector{0.0, 0.0}, Vector{side, side}, Boundary::periodic)),
        simulation(scheme, dt) {
    for (std::size_t i = 0; i < n * n; ++i) {
      Smooth<2> p{};
      p.position = {0.5 + static_cast<double>(i % n), 0.5 + static_cast<double>(i / n)};
      Vector<2> const out = (p.position - 0.5 * side) * (6 / side);
      double const near = std::exp(-norm2(out));
      p.mass = 0.5 + 1.5 * near;
      p.specific_energy = 1 + near;
      p.velocity = {0.2 * std::sin(2 * pi * p.position[1] / side), 0};
      p.range = 2.7;
      p.density = 1;
      (halved && i % 2 == 1 ? air : gas).add(p);
    }
    scheme.material(gas, Newtonian<IdealGas>{IdealGas{1.4, 1}, 0.05, 0, 0.05});
    simulation.integrate(gas, method);
    if (halved) {
      scheme.material(air, IdealGas{1.6, 1});
      simulation.integrate(air, method);
    }
    if (vary) scheme.variable_range({.spacings = 2.7});
  }
  static Rezoning policy() {
    return {.split_above = 1.2, .merge_below = 0.55, .smallest_mass = 0.3, .largest_mass = 1.5, .merge_within = 0.5};
  }
  double mass() const {
    double sum = 0;
    for (auto const* all : {&gas, &air})
      for (auto const& p : *all) sum += p.mass;
    return sum;
  }
};

// ---- What stays ----

TEST(Rezoning, ConservesWhatARunWithoutItConserves) {
  for (auto const method : {Method::leap_frog, Method::rk2, Method::rk4})
    for (bool const vary : {false, true}) {
      std::string const what = to_string(method) + (vary ? ", variable ranges" : "");
      Burst plain(16, method, vary), rezoned(16, method, vary);
      auto rezoner = std::make_unique<Rezoner>(rezoned.gas, rezoned.scheme.box(), Burst::policy());
      Rezoner const& done = *rezoner;
      rezoned.simulation.adapt(10, std::move(rezoner));
      rezoned.simulation.check();
      plain.simulation.check();
      double const mass = rezoned.mass();
      Conserved const start = conserved(rezoned.simulation), plain_start = conserved(plain.simulation);
      std::vector<std::size_t> sizes;
      rezoned.simulation.observe(10, [&](Simulation const&) { sizes.push_back(rezoned.gas.size()); });
      rezoned.simulation.run(100);
      plain.simulation.run(100);
      Conserved const end = conserved(rezoned.simulation), plain_end = conserved(plain.simulation);
      EXPECT_GT(done.done().splits, 15U) << what;
      EXPECT_GT(done.done().merges, 15U) << what;
      EXPECT_EQ(rezoned.gas.size(), 256 + done.done().splits - done.done().merges) << what;
      EXPECT_GT(std::count_if(sizes.begin(), sizes.end(), [](std::size_t n) { return n != 256; }), 2) << what;
      EXPECT_NEAR(rezoned.mass(), mass, 1e-13 * mass) << what;
      for (int a = 0; a < 2; ++a)
        EXPECT_NEAR((*end.momentum)[a], (*start.momentum)[a], 1e-13 * end.momentum_scale) << what;
      // As far as steps go: each method's error, which finer particles with shorter ranges make larger.
      double const drift = std::abs(*end.energy - *start.energy) / *start.energy;
      double const plain_drift = std::abs(*plain_end.energy - *plain_start.energy) / *plain_start.energy;
      EXPECT_LT(drift, 4 * plain_drift + 1e-9) << what;
    }
}

TEST(Rezoning, IsTheSameAsRezoningBetweenTwoRuns) {
  for (auto const method : {Method::leap_frog, Method::rk4}) {
    Burst whole(14, method), pieces(14, method);
    whole.simulation.adapt(20, Rezoner(whole.gas, whole.scheme.box(), Burst::policy()));
    whole.simulation.run(70);
    std::size_t changes = 0;
    for (int k = 0; k < 3; ++k) {
      pieces.simulation.run(20);
      auto const done = rezone(pieces.gas, pieces.scheme.box(), Burst::policy());
      changes += done.splits + done.merges;
    }
    pieces.simulation.run(10);
    EXPECT_GT(changes, 20U);
    expect_same_rows(whole.gas, pieces.gas, to_string(method));
  }
}

// ---- What happens, against what must happen ----

/// The mode of the velocity that fits once into the tube.
std::complex<double> sound_in(Ensemble<Smooth<1>> const& gas, double flow) {
  std::complex<double> sum = 0;
  for (auto const& p : gas) sum += 2 * p.mass * (p.velocity[0] - flow) * std::polar(1.0, -2 * pi * p.position[0]);
  return sum;
}

TEST(Rezoning, SoundPassesTheBordersOfFineAndCoarse) {
  // Sound of unit speed runs to the right, in a gas that itself runs at half of that through a part of the tube where
  // particles are halved; behind it they merge again. In unit time the mode's phase changes by -2 pi (1/2 + 1).
  constexpr std::size_t n = 100;
  double const amplitude = 0.05, flow = 0.5, gamma = 1.4, mass = 1.0 / n;
  Ensemble<Smooth<1>> gas("gas", n);
  for (std::size_t i = 0; i < n; ++i) {
    auto& p = gas[i];
    double const x = (static_cast<double>(i) + 0.5) / n, wave = amplitude * std::sin(2 * pi * x);
    p.position[0] = x + amplitude / (2 * pi) * std::cos(2 * pi * x);
    p.mass = mass;
    p.range = 3.0 / n;
    p.velocity[0] = flow + wave;
    p.specific_energy = (1 + (gamma - 1) * wave) / (gamma * (gamma - 1));
  }
  SmoothScheme scheme(Box(Vector{0.0}, Vector{1.0}, Boundary::periodic), WeightShape::wendland);
  scheme.material(gas, IdealGas{gamma, 1});
  scheme.variable_range({.spacings = 3});
  Simulation simulation(scheme, 0.001);
  simulation.integrate(gas, Method::leap_frog);
  auto const coarse = [&](double low, double high) {
    return Rezoner(gas, scheme.box(),
                   {.merge_below = std::numeric_limits<double>::infinity(),
                    .largest_mass = mass,
                    .merge_within = 0.3,
                    .region = Rezoning::Block{{low}, {high}}});
  };
  simulation.adapt(5,
                   Rezoner(gas, scheme.box(),
                           {.split_above = 0, .smallest_mass = 0.5 * mass, .region = Rezoning::Block{{0.3}, {0.7}}}));
  simulation.adapt(5, coarse(0, 0.3));
  simulation.adapt(5, coarse(0.7, 1));
  auto const start = sound_in(gas, flow);
  simulation.run(1000);
  auto const end = sound_in(gas, flow);
  std::size_t inside = 0, halves = 0;
  for (auto const& p : gas)
    if (p.position[0] > 0.32 && p.position[0] < 0.68) ++inside, halves += p.mass == 0.5 * mass ? 1 : 0;
  EXPECT_EQ(halves, inside);
  EXPECT_NEAR(static_cast<double>(inside), 72, 8);
  // 5 % of the speed of sound were 0.31.
  EXPECT_NEAR(std::remainder(std::arg(end / start) + 3 * pi, 2 * pi), 0, 0.15);
  EXPECT_NEAR(std::abs(end / start), 1, 0.15);
  for (auto const& p : gas) EXPECT_NEAR(p.density, 1, 0.3);
}

// ---- Bits ----

TEST(Rezoning, ThreadsChangeNoBit) {
  Burst one(72, Method::leap_frog, true, true), two(72, Method::leap_frog, true, true);
  for (Burst* burst : {&one, &two}) {
    burst->simulation.threads(burst == &one ? 1 : 2);
    burst->simulation.adapt(4, Rezoner(burst->gas, burst->scheme.box(), Burst::policy()));
    burst->simulation.adapt(6, Rezoner(burst->air, burst->scheme.box(), Burst::policy()));
    burst->simulation.run(14);
  }
  EXPECT_NE(one.gas.size(), 2592U);
  EXPECT_NE(one.air.size(), 2592U);
  expect_same_rows(one.gas, two.gas, "gas");
  expect_same_rows(one.air, two.air, "air");
}

TEST(Rezoning, ParticlesMayChangeTheirEnsemble) {
  // Nobody moves and the sum of particles stays, so that neighbour lists hold; but the material of one is another.
  Burst burst(12, Method::leap_frog, false, true);
  burst.simulation.adapt(5, [&] {
    Smooth<2> const last = burst.gas[burst.gas.size() - 1];
    burst.gas.resize(burst.gas.size() - 1);
    std::vector<Smooth<2>> rest(burst.air.begin(), burst.air.end());
    rest.insert(rest.begin(), last);
    burst.air.resize(0);
    for (auto const& p : rest) burst.air.add(p);
  });
  burst.simulation.run(10);
  ASSERT_EQ(burst.gas.size(), 70U);
  ASSERT_EQ(burst.air.size(), 74U);
  Burst fresh(12, Method::leap_frog, false, true);
  fresh.gas.resize(0);
  fresh.air.resize(0);
  for (auto const& p : burst.gas) fresh.gas.add(p);
  for (auto const& p : burst.air) fresh.air.add(p);
  burst.scheme.calculate();
  fresh.scheme.calculate();
  for (auto const& [a, b] : {std::pair{&burst.gas, &fresh.gas}, std::pair{&burst.air, &fresh.air}})
    for (std::size_t i = 0; i < a->size(); ++i) {
      EXPECT_NEAR(magnitude(a->influence_on(i).force - b->influence_on(i).force), 0, 1e-13);
      EXPECT_NEAR(a->influence_on(i).heating, b->influence_on(i).heating, 1e-13);
      EXPECT_EQ((*a)[i].pressure, (*b)[i].pressure);
    }
}

// ---- Files ----

struct Way {
  Method method;
  bool vary;  // ranges
};
class RezonedRecording : public testing::TestWithParam<Way> {};

TEST_P(RezonedRecording, GoesOnWithTheBitsOfARunWithoutAStop) {
  auto const [method, vary] = GetParam();
  TemporaryFolder const folder;
  std::vector<std::size_t> sizes;
  auto const record = [&, method = method, vary = vary](std::string const& name, std::uint64_t steps, bool resume) {
    auto burst = std::make_unique<Burst>(14, method, vary, true, 0.08);
    burst->simulation.adapt(5, Rezoner(burst->gas, burst->scheme.box(), Burst::policy()));
    burst->simulation.adapt(15, Rezoner(burst->air, burst->scheme.box(), Burst::policy()));
    Recording recording(burst->simulation, UnitSystem::reduced(), folder / name);
    recording.diagnoses(5, {"energies", "momentum"});
    recording.trajectory(5);
    recording.checkpoint(10);
    recording.picture({.colour = "density"});
    if (resume) recording.resume();
    burst->simulation.observe(5, [&](Simulation const& now) {
      if (name == "whole" && now.step() >= 35) sizes.push_back(burst->gas.size());
    });
    run_with_progress(recording, steps, {.quiet = true});
    return burst;
  };
  record("parts", 35, false);  // ends with a change
  auto const resumed = record("parts", 30, true);
  auto const whole = record("whole", 65, false);
  EXPECT_EQ(whole->simulation.step(), 65);
  std::erase(sizes, sizes.at(0));
  EXPECT_TRUE(!vary || !sizes.empty()) << "numbers change after the restart, too";
  expect_same_rows(whole->gas, resumed->gas, "gas");
  expect_same_rows(whole->air, resumed->air, "air");
  EXPECT_EQ(read_text(folder / "parts/diagnoses.csv"), read_text(folder / "whole/diagnoses.csv"));
  auto const parts_checkpoint = read_checkpoint(folder / "parts/checkpoint.h5"),
             whole_checkpoint = read_checkpoint(folder / "whole/checkpoint.h5");
  EXPECT_EQ(parts_checkpoint.state, whole_checkpoint.state);
  auto const reports = [](Burst const& burst) {
    std::string all;
    for (auto const* adaptation : burst.simulation.adaptations())
      all += adaptation->report(UnitSystem::reduced()) + '\n';
    return all;
  };
  EXPECT_EQ(reports(*whole), reports(*resumed));

  // Every frame has the particles that there were, and no others.
  TrajectoryReader const a(folder / "parts/trajectory.h5"), b(folder / "whole/trajectory.h5");
  ASSERT_EQ(a.steps(), b.steps());
  ASSERT_EQ(a.frames(), 14U);
  double const mass = Burst(14, Method::rk4, false, true).mass();
  std::size_t different = 0;
  for (std::size_t frame = 0; frame < a.frames(); ++frame) {
    double sum = 0;
    for (char const* name : {"gas", "air"}) {
      ASSERT_EQ(a.size(frame, name), b.size(frame, name));
      if (frame > 0 && a.size(frame, name) != a.size(frame - 1, name)) ++different;
      for (char const* field : {"position", "mass", "range", "density"})
        EXPECT_EQ(a.read(frame, name, field), b.read(frame, name, field)) << field << " of frame " << frame;
      for (double const m : a.read(frame, name, "mass")) sum += m;
    }
    EXPECT_NEAR(sum, mass, 1e-12 * mass) << frame;
  }
  EXPECT_GT(different, vary ? 5U : 2U);
  // A frame is drawn with its own particles.
  a.load(0, resumed->gas);
  a.load(0, resumed->air);
  EXPECT_EQ(resumed->gas.size() + resumed->air.size(), 196U);
  Picture const picture{.colour = "density"};
  Canvas const first = draw(picture, {resumed->simulation, UnitSystem::reduced(), "first", 0, 0, folder / "parts"});
  std::size_t drawn = 0;
  for (auto const& cloud : first.clouds()) drawn += cloud.count();
  EXPECT_EQ(drawn, 196U);
  a.load(13, resumed->gas);
  a.load(13, resumed->air);
  expect_same_rows(whole->gas, resumed->gas, "the last frame");
}

INSTANTIATE_TEST_SUITE_P(Methods, RezonedRecording,
                         testing::Values(Way{Method::leap_frog, true}, Way{Method::leap_frog, false},
                                         Way{Method::rk2, true}, Way{Method::rk4, true}, Way{Method::rk4, false}),
                         [](auto const& info) {
                           std::string name = to_string(info.param.method) + (info.param.vary ? "_varying" : "_fixed");
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(RezonedRecording, EndsWithWhatWasDone) {
  TemporaryFolder const folder;
  Burst burst(14, Method::leap_frog);
  auto owned = std::make_unique<Rezoner>(burst.gas, burst.scheme.box(), Burst::policy());
  Rezoner const& rezoner = *owned;
  burst.simulation.adapt(5, std::move(owned));
  Recording recording(burst.simulation, UnitSystem::reduced(), folder / "out");
  testing::internal::CaptureStdout();
  auto const report = run_with_progress(recording, 40, {});
  std::string const text = testing::internal::GetCapturedStdout();
  Rezoned const& done = rezoner.done();
  ASSERT_GT(done.merges, 5U);
  EXPECT_NE(done.angular_momentum_lost[2], 0);
  EXPECT_EQ(report.particles, 196);
  // More than at the start, or fewer, for a part of the steps.
  EXPECT_NE(report.particle_steps, 196.0 * 40);
  EXPECT_NEAR(report.particle_steps, 0.5 * 40 * (196.0 + static_cast<double>(burst.gas.size())), 0.1 * 196 * 40);
  auto const expect = [&](std::string const& line) {
    EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
  };
  expect("\n196 particles at the start, " + std::to_string(burst.gas.size()) + " at the end, 40 steps to step 40");
  expect("'gas': " + std::to_string(done.splits) + " splits, " + std::to_string(done.merges) + " merges, " +
         std::to_string(burst.gas.size()) + " particles now; angular momentum lost: " +
         UnitSystem::reduced().text(done.angular_momentum_lost[2], dimensions::angular_momentum));
}

TEST(Rezoning, RefusesWhatNeedsNumbersThatStay) {
  TemporaryFolder const folder;
  Burst burst(6, Method::leap_frog);
  burst.simulation.adapt(5, Rezoner(burst.gas, burst.scheme.box(), Burst::policy()));
  Recording tracks(burst.simulation, UnitSystem::reduced(), folder / "tracks");
  tracks.trajectory(5);
  tracks.picture({.trace = true});
  EXPECT_EQ(message([&] { tracks.check(); }),
            "a picture with tracks needs particles that keep their numbers; here some come and go between steps");
  Recording group(burst.simulation, UnitSystem::reduced(), folder / "group");
  DiagnosisParameters parameters;
  parameters.available = {&burst.gas};
  parameters.particles = {3, 30};
  group.diagnose(5, make_diagnosis("mean-velocity", parameters));
  EXPECT_EQ(message([&] { group.check(); }),
            "the diagnosis of 'gas mean velocity x' follows particles by their numbers, which change where particles "
            "come and go between steps");
  EXPECT_EQ(message([&] { Rezoner(burst.gas, burst.scheme.box(), {.split_above = 1}); }),
            "rezoning: to split by density needs a smallest_mass, where it ends");
  Ensemble<Smooth<1>> line("line");
  EXPECT_EQ(message([&] { Rezoner(line, burst.scheme.box(), Burst::policy()); }),
            "rezoning: ensemble 'line' is 1-dimensional, the box 2-dimensional");
}

}  // namespace
}  // namespace boltzmann::rezoning_test
