// Recording from a C++ program: totals against numbers worked out by hand, files, restarts, and mistakes.
#include "tests/bzm/command.hpp"

#include <boltzmann/files/csv.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/pendulum.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/conserved.hpp>
#include <tests/message.hpp>

#include <cmath>
#include <limits>

namespace boltzmann::recording_test {
namespace {

using namespace boltzmann::test;

// Two atoms of masses 2 and 3 at the distance of the minimum, in open space.
struct Pair {
  Ensemble<Newton<2>> atoms{"atoms", 2};
  PairScheme scheme;
  Simulation simulation;

  explicit Pair(Boundary boundary = Boundary::open)
      : scheme(Box(Vector{-5., -5.}, Vector{5., 5.}, boundary), 3.0), simulation(scheme, 0.001) {
    atoms[0].mass = 2;
    atoms[1].mass = 3;
    atoms[0].position = {1., 0.};
    atoms[1].position = {1., 1.5};
    atoms[0].velocity = {0.1, 0.2};
    atoms[1].velocity = {-0.3, 0.};
    scheme.internal(atoms, LennardJones{0.7, 1.5});
    scheme.shifted(false);
    simulation.integrate(atoms, Method::leap_frog);
  }
};

TEST(Conserved, TotalsOfTwoAtomsByHand) {
  Pair pair;
  pair.simulation.check();
  auto const total = conserved(pair.simulation);
  // 2 (0.01 + 0.04)/2 + 3 0.09/2 - 0.7
  ASSERT_TRUE(total.energy);
  EXPECT_NEAR(*total.energy, 0.05 + 0.135 - 0.7, 1e-14);
  EXPECT_NEAR(total.energy_scale, 0.185 + 0.7, 1e-14);
  ASSERT_TRUE(total.momentum);
  EXPECT_NEAR((*total.momentum)[0], 0.2 - 0.9, 1e-15);
  EXPECT_NEAR((*total.momentum)[1], 0.4, 1e-15);
  EXPECT_NEAR(total.momentum_scale, 2 * std::sqrt(0.05) + 0.9, 1e-15);
  // 2 (1 0.2 - 0 0.1) + 3 (1 0 - 1.5 (-0.3))
  ASSERT_TRUE(total.angular_momentum);
  double const spin = 0.4 + 1.35;
  auto const& components = *total.angular_momentum;
  EXPECT_NEAR(std::abs(components[0] + components[1] + components[2]), spin, 1e-14);
  EXPECT_TRUE(total.isolated);
}

TEST(Conserved, NoAngularMomentumOnPeriodicAxesAndWallsAreNamed) {
  Pair periodic(Boundary::periodic), walls(Boundary::reflecting);
  periodic.simulation.check();
  walls.simulation.check();
  EXPECT_FALSE(conserved(periodic.simulation).angular_momentum);
  auto const total = conserved(walls.simulation);
  EXPECT_FALSE(total.isolated);
  EXPECT_NE(conserved_table(total, total, UnitSystem::reduced()).back().find("walls"), std::string::npos);
}

TEST(Conserved, AnglesHaveNoMomenta) {
  Ensemble<Pendulum<>> bobs("bobs", 2);
  PairScheme scheme(Box(Vector{-9.}, Vector{9.}));
  scheme.add(bobs);
  Simulation simulation(scheme, 0.1);
  simulation.integrate(bobs, Method::leap_frog);
  simulation.check();
  auto const total = conserved(simulation);
  EXPECT_TRUE(total.energy);
  EXPECT_FALSE(total.momentum);
}

TEST(Conserved, TheTableShowsTheDrift) {
  Conserved start, end;
  start.energy = -2.0;
  end.energy = -2.002;
  start.energy_scale = end.energy_scale = 5;
  auto const lines = conserved_table(start, end, UnitSystem::reduced());
  EXPECT_NE(lines[1].find("-1.00e-03  of itself"), std::string::npos) << lines[1];
  start.energy = 0.0;
  end.energy = 0.01;
  EXPECT_NE(conserved_table(start, end, UnitSystem::reduced())[1].find("2.00e-03  of kinetic"), std::string::npos);
}

TEST(QuantityText, MultipliesUnitsThatAreNumbers) {
  EXPECT_EQ(UnitSystem::reduced().text(1.5, dimensions::time), "1.5");
  EXPECT_EQ(UnitSystem::si().text(1.5, dimensions::time), "1.5 s");
  UnitSystem const thesis(1.804 * units::angstrom, 5.275e-26 * units::gram, 3.273 * units::femtosecond);
  EXPECT_EQ(thesis.text(20, dimensions::time), "65.46 fs");
}

TEST(Recording, LeavesFilesThatGoOnWhereTheyEnded) {
  Folder folder;
  auto const record = [&](std::string const& name, std::uint64_t steps, bool resume) {
    Pair pair;
    Recording recording(pair.simulation, UnitSystem::reduced(), folder / name);
    recording.diagnoses(5, {"energies", "momentum"});
    recording.trajectory(10);
    recording.picture({.drawing = "phase-space", .x = "position.x", .y = "position.y", .trace = true});
    if (resume) recording.resume();
    auto const report = run_with_progress(recording, steps, {.quiet = true});
    EXPECT_EQ(report.steps, static_cast<std::int64_t>(steps));
    EXPECT_EQ(report.particles, 2);
    EXPECT_FALSE(report.interrupted);
    return recording.files();
  };
  auto const files = record("parts", 30, false);
  EXPECT_EQ(files,
            (std::vector<std::string>{"run.toml", "diagnoses.csv", "trajectory.h5", "checkpoint.h5", "picture.png"}));
  for (auto const& file : files) EXPECT_GT(fs::file_size(folder / "parts" / file), 0U) << file;
  record("parts", 20, true);
  record("whole", 50, false);
  EXPECT_EQ(text_of(folder / "parts/diagnoses.csv"), text_of(folder / "whole/diagnoses.csv"));
  auto const table = read_csv((folder / "whole/diagnoses.csv").string());
  EXPECT_EQ(table.column("step").size(), 11U);
  EXPECT_NEAR(table.column("total energy").front(), -0.515, 1e-14);
  EXPECT_NEAR(table.column("total energy").back(), -0.515, 1e-6);
  EXPECT_NE(message([&] { record("whole", 5, false); }).find("already holds a run"), std::string::npos);
}

TEST(Recording, TheDestructorFinishesAndNothingIsWrittenBeforeTheRun) {
  Folder folder;
  {
    Pair pair;
    Recording recording(pair.simulation, UnitSystem::reduced(), folder / "out");
    EXPECT_FALSE(fs::exists(folder / "out"));
    pair.simulation.run(7);
    EXPECT_EQ(recording.checkpoint_step(), 0);
  }
  Pair pair;
  Recording recording(pair.simulation, UnitSystem::reduced(), folder / "out");
  recording.resume();
  EXPECT_EQ(pair.simulation.step(), 7);
}

TEST(Recording, RefusesPlansThatCannotBe) {
  Folder folder;
  Pair pair;
  auto const plan = [&](std::function<void(Recording&)> const& say) {
    return message([&] {
      Recording recording(pair.simulation, UnitSystem::reduced(), folder / "out");
      say(recording);
      recording.check();
    });
  };
  EXPECT_EQ(plan([](Recording&) {}), "no error");
  EXPECT_NE(plan([](Recording& r) { r.diagnoses(0, {"energies"}); }).find("not every 0"), std::string::npos);
  EXPECT_NE(plan([](Recording& r) { r.trajectory(0); }).find("not every 0"), std::string::npos);
  EXPECT_NE(plan([](Recording& r) { r.diagnoses(5, {"energy"}); }).find("energies"), std::string::npos);
  EXPECT_NE(
      plan([](Recording& r) { r.diagnoses(5, {"energies"}), r.diagnoses(6, {"momentum"}); }).find("every 5 steps"),
      std::string::npos);
  EXPECT_NE(plan([](Recording& r) {
              r.diagnoses(5, {"energies", "energies"});
            }).find("two diagnoses"),
            std::string::npos);
  EXPECT_NE(plan([](Recording& r) { r.picture({.colour = "sped"}); }).find("did you mean 'speed'"), std::string::npos);
  EXPECT_NE(plan([](Recording& r) { r.picture({.drawing = "cartesien"}); }).find("did you mean 'cartesian'"),
            std::string::npos);
  EXPECT_NE(plan([](Recording& r) { r.picture({.drawing = "time-series"}); }).find("needs diagnoses"),
            std::string::npos);
  EXPECT_NE(plan([](Recording& r) {
              r.diagnoses(5, {"energies"}), r.picture({.drawing = "time-series", .x = "kinetic enrgy"});
            }).find("did you mean 'kinetic energy'"),
            std::string::npos);
  EXPECT_NE(plan([](Recording& r) { r.picture({.file = "p.jpg"}); }).find("none of .png"), std::string::npos);
  EXPECT_NE(plan([](Recording& r) { r.picture({.trace = true}); }).find("needs a trajectory"), std::string::npos);
  EXPECT_NE(plan([](Recording& r) { r.picture({}), r.picture({}); }).find("two pictures"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(Pictures, OverTimeCanBeLogarithmic) {
  Folder folder;
  Pair pair;
  Recording recording(pair.simulation, UnitSystem::reduced(), folder / "out");
  recording.diagnoses(5, {"energies"});
  run_with_progress(recording, 20, {.quiet = true});
  auto const drawn = [&](bool logarithmic) {
    return draw({.drawing = "time-series", .y = "kinetic energy", .logarithmic = logarithmic},
                {pair.simulation, UnitSystem::reduced(), "", 20, 0.02, folder / "out"});
  };
  EXPECT_TRUE(drawn(true).y_axis().logarithmic);
  EXPECT_FALSE(drawn(true).x_axis().logarithmic);
  EXPECT_FALSE(drawn(false).y_axis().logarithmic);
  EXPECT_EQ(drawn(true).curves()[0].y, drawn(false).curves()[0].y);
  EXPECT_TRUE(std::isnan(drawn(true).y_axis().low)) << "all of it is shown";
  // One value that is zero but for rounding does not press the others together.
  write_text(folder / "out/diagnoses.csv", "step,time,kinetic energy\n0,0,1e-30\n5,1,0\n10,2,3e-4\n15,3,7\n");
  EXPECT_DOUBLE_EQ(drawn(true).y_axis().low, 7e-12);
  EXPECT_TRUE(std::isnan(drawn(false).y_axis().low));
}

TEST(Pictures, OverTimeCanBeOverAnotherColumn) {
  Folder folder;
  Pair pair;
  Recording recording(pair.simulation, UnitSystem::reduced(), folder / "out");
  recording.diagnoses(5, {"energies"});
  run_with_progress(recording, 10, {.quiet = true});
  write_text(folder / "out/diagnoses.csv",
             "step,time (ps),kinetic energy (eV),volume (nm^3)\n0,0,1,30\n5,1,2,35\n10,2,3,31\n");
  auto const drawn = [&](std::string const& x) {
    return draw({.drawing = "time-series", .x = x, .y = "kinetic energy"},
                {pair.simulation, UnitSystem::reduced(), "", 20, 0.02, folder / "out"});
  };
  for (std::string const time : {"", "time"}) {
    EXPECT_EQ(drawn(time).curves()[0].x, (std::vector<double>{0, 1, 2}));
    EXPECT_EQ(drawn(time).x_axis().label, "time");
  }
  Canvas const canvas = drawn("volume");
  EXPECT_EQ(canvas.curves()[0].x, (std::vector<double>{30, 35, 31}));
  EXPECT_EQ(canvas.x_axis().label, "volume");
  EXPECT_EQ(canvas.x_axis().unit, "nm^3");
  EXPECT_EQ(canvas.x_axis().high, 35);
  EXPECT_NE(message([&] { drawn("volum"); }).find("did you mean 'volume'"), std::string::npos);
}

TEST(Pictures, ParticlesHaveTheColoursOfTheirEnsembles) {
  Folder folder;
  Pair pair;
  pair.atoms.appearance.colour = "seagreen";
  pair.simulation.check();
  for (auto const* drawing : {"cartesian", "phase-space"}) {
    Canvas const canvas =
        draw({.drawing = drawing}, {pair.simulation, UnitSystem::reduced(), "", 0, 0.0, folder.string()});
    ASSERT_EQ(canvas.clouds().size(), 1U) << drawing;
    EXPECT_EQ(canvas.clouds()[0].count(), 2U) << drawing;
    EXPECT_EQ(with_alpha(canvas.clouds()[0].colour, 1), colour_named("seagreen")) << drawing;
  }
}

TEST(Recording, AFailureIsDrawnFromTheLastRecordedState) {
  Folder folder;
  Pair pair;
  Recording recording(pair.simulation, UnitSystem::reduced(), folder / "out");
  recording.diagnoses(1, {"energies"});
  recording.picture({});
  pair.simulation.observe(1, [&](Simulation const& now) {
    if (now.step() == 4) pair.atoms[1].velocity = {std::numeric_limits<double>::quiet_NaN(), 0.};
  });
  try {
    run_with_progress(recording, 10, {.quiet = true});
    FAIL() << "a velocity that is no number was not handled_count";
  } catch (PhysicsFailure const& failure) {
    std::string const line = failure.what();
    EXPECT_NE(line.find("step 5: particle 1 of 'atoms'"), std::string::npos) << line;
    EXPECT_NE(line.find("(step 0)"), std::string::npos) << line;
  }
  EXPECT_TRUE(fs::exists(folder / "out/picture.png"));
  EXPECT_EQ(read_csv((folder / "out/diagnoses.csv").string()).column("step"), (std::vector<double>{0, 1, 2, 3, 4}));
  EXPECT_TRUE(std::isfinite(pair.atoms[1].velocity[0])) << "the recorded state is back";
}

// Runs of atoms have units in trajectory.h5 that MDAnalysis knows, whatever their base: it takes angstrom/fs for something
// else, and knows no bohr.
TEST(Recording, TrajectoriesOfAtomsAreInUnitsThatReadersKnow) {
  Folder const folder;
  auto const unit_of = [&](UnitSystem const& units, std::string const& name, double expected_speed) {
    Pair pair;
    Recording recording(pair.simulation, units, (folder / name).string());
    recording.trajectory(1);
    pair.simulation.run(1);
    recording.finish();
    TrajectoryReader const reader((folder / name / "trajectory.h5").string());
    EXPECT_NEAR(reader.read(0, "atoms", "velocity", TrajectoryReader::Numbers::written)[1] / expected_speed, 1, 1e-9)
        << name;
    EXPECT_NEAR(reader.read(0, "atoms", "velocity")[1], 0.2, 1e-15) << name;
    std::string all = reader.time_unit();
    for (auto const& field : reader.ensembles()[0].fields)
      if (field.name == "position" || field.name == "velocity") all += " " + field.unit;
    return all;
  };
  double const bohr = 0.529177210903;  // angstrom
  EXPECT_EQ(unit_of(UnitSystem(1 * units::angstrom, 1 * units::amu, 1 * units::femtosecond), "fs", 0.2e3),
            "fs angstrom angstrom/ps");
  EXPECT_EQ(unit_of(UnitSystem(1 * units::bohr, 1 * units::amu, 1 * units::picosecond), "bohr", 0.2 * bohr),
            "ps angstrom angstrom/ps");
  EXPECT_EQ(unit_of(UnitSystem(1 * units::nanometer, 1 * units::amu, 1 * units::picosecond), "nm", 0.2 * 10),
            "ps nm angstrom/ps");
}

// What stands in it is held to MDAnalysis in tests/files/trajectory_readers_test.cpp.
TEST(Recording, AViewOfTheFramesStandsBesideThemAsLongAsParticlesAreTheSame) {
  Folder const folder;
  auto const view = folder / "out/trajectory.h5md";
  auto const run = [&](std::string const& name, int first, int second) {
    Pair pair;
    Recording recording(pair.simulation, UnitSystem::reduced(), (folder / name).string());
    recording.trajectory(2);
    pair.simulation.run(static_cast<std::uint64_t>(first));
    recording.finish();
    if (second == 0) return;
    Pair again;
    Recording resumed(again.simulation, UnitSystem::reduced(), (folder / name).string());
    resumed.trajectory(2);
    resumed.resume();
    EXPECT_TRUE(fs::exists(folder / name / "trajectory.h5md"));
    again.simulation.run(static_cast<std::uint64_t>(second));
    resumed.finish();
  };
  run("whole", 9, 0);
  run("parts", 3, 6);
  EXPECT_TRUE(text_of(folder / "parts/trajectory.h5md") == text_of(folder / "whole/trajectory.h5md"));

  Pair pair;
  Recording recording(pair.simulation, UnitSystem::reduced(), (folder / "out").string());
  recording.trajectory(1);
  pair.simulation.run(1);
  EXPECT_TRUE(fs::exists(view));
  EXPECT_LT(fs::file_size(view), 16'000U);
  pair.atoms.add(Newton<2>{{{-3., -3.}}, 1, {0., 0.}});
  pair.simulation.run(1);
  EXPECT_FALSE(fs::exists(view));
  recording.finish();
  EXPECT_FALSE(fs::exists(view));
}

}  // namespace
}  // namespace boltzmann::recording_test
