// The command as a user meets it: exit statuses, messages, and what is left in the folder.
#include "tests/bzm/command.hpp"

#include <boltzmann/core/quantity_text.hpp>
#include "tests/small_disk.hpp"

#include <boltzmann/files/csv.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/pictures/picture_options.hpp>
#include <boltzmann/recording/version.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/scenario/load_options.hpp>
#include <boltzmann/scenario/tables.hpp>

#include <cairo/cairo.h>
#include <cmath>
#include <cstdint>
#include <regex>
#include <set>
#include <sstream>

namespace boltzmann::command_test {
namespace {

using namespace boltzmann::test;

void expect_one_line(Outcome const& outcome, int status, std::vector<std::string> const& parts) {
  EXPECT_EQ(outcome.status, status) << outcome.out << outcome.err;
  EXPECT_EQ(lines_in(outcome.err), 1U) << outcome.err;
  for (auto const& part : parts) EXPECT_TRUE(has(outcome.err, part)) << outcome.err << "\nlacks: " << part;
}

// 0.1.0, or with commits since and the commit's name, as git describe writes them.
TEST(Bzm, VersionIsThatOfTheProject) {
  Folder folder;
  auto const outcome = bzm({"--version"}, folder.string());
  EXPECT_EQ(outcome.status, 0);
  std::smatch parts;
  ASSERT_TRUE(std::regex_match(outcome.out, parts,
                               std::regex("bzm ([0-9]+\\.[0-9]+\\.[0-9]+)(-[0-9]+-g([0-9a-f]{7,40}))?(-dirty)?\n")))
      << outcome.out;
  if (fs::exists(fs::path(BOLTZMANN_SOURCE) / ".git") && parts[3].matched) {
    std::string const source = BOLTZMANN_SOURCE;
    auto const commit = Process({"/usr/bin/env", "git", "-c", "safe.directory=" + source, "-C", source, "cat-file",
                                 "-e", parts[3].str() + "^{commit}"},
                                folder.string())
                            .wait();
    EXPECT_EQ(commit.status, 0) << commit.err;
  }
  EXPECT_EQ(parts[1], program_version);
  EXPECT_TRUE(has(text_of(fs::path(BOLTZMANN_SOURCE) / "CMakeLists.txt"), std::string("VERSION ") + program_version));
}

TEST(Bzm, EveryCommandHasHelp) {
  Folder folder;
  auto const all = bzm({"--help"}, folder.string());
  EXPECT_EQ(all.status, 0);
  EXPECT_TRUE(has(all.out, "Exit status"));
  for (auto const* command :
       {"run", "resume", "render", "list", "show", "check", "new", "build", "doctor", "completion"}) {
    EXPECT_TRUE(has(all.out, std::string("  ") + command)) << command;
    auto const help = bzm({command, "--help"}, folder.string());
    EXPECT_EQ(help.status, 0) << command;
    EXPECT_TRUE(has(help.out, "--help")) << command;
    EXPECT_TRUE(help.err.empty()) << help.err;
  }
}

TEST(Bzm, WindowWritesAStoredRunIntoAFile) {
  Folder folder;
  auto const run = [&](std::vector<std::string> const& words) { return bzm(words, folder.string()); };
  ASSERT_EQ(run({"run", "copper", "--steps", "40", "--set", "output.trajectory=2", "--out", "run", "--quiet"}).status,
            0);
  auto const written = run({"window", "run", "-o", "run.html"});
  EXPECT_EQ(written.status, 0) << written.err;
  EXPECT_TRUE(has(written.out, "run.html: ") && has(written.out, " MB, 21 frames")) << written.out;
  EXPECT_TRUE(has(text_of(folder / "run.html"), "id=\"recording\""));
  auto const few = run({"window", "run", "-o", "few.html", "--frames", "3", "--view", "Histogram"});
  EXPECT_TRUE(has(few.out, "a recording with 3 of 21 frames")) << few.out << few.err;
  expect_one_line(run({"window", "run", "-o", "run.png"}), 2, {"'run.png' is no page", ".html", "bzm render"});
  expect_one_line(run({"window", "-o", "run.html"}), 2, {"give the run"});
  expect_one_line(run({"window", "run", "--frames", "3"}), 2, {"--frames requires --out"});
  expect_one_line(run({"window", "run", "-o", "x.html", "--view", "Partcles"}), 2, {"did you mean 'Particles'?"});
  expect_one_line(run({"window", "run", "-o", "x.html", "--megabytes", "0.01"}), 2, {"0.01 MB has no room"});
  expect_one_line(run({"window", "missing", "-o", "x.html"}), 2, {"there is no folder 'missing'"});
  expect_one_line(run({"window", "run", "-o", "no/x.html"}), 2, {"no/x.html"});
  ASSERT_EQ(run({"run", "copper", "--steps", "4", "--set", "output.trajectory=0", "--out", "bare", "--quiet"}).status,
            0);
  expect_one_line(run({"window", "bare", "-o", "x.html"}), 2, {"'bare' has no trajectory.h5 to show"});
  EXPECT_FALSE(fs::exists(folder / "x.html"));
}

TEST(Bzm, UnknownWordsGetTheNearestKnownOne) {
  Folder folder;
  expect_one_line(bzm({"rnu"}, folder.string()), 2, {"unknown command 'rnu'", "did you mean 'run'?"});
  expect_one_line(bzm({"help"}, folder.string()), 2, {"unknown command 'help'", "did you mean 'bzm --help'?"});
  expect_one_line(bzm({"chek", "x"}, folder.string()), 2, {"did you mean 'check'?"});
  expect_one_line(bzm({"run", "x.toml", "--stpes", "3"}, folder.string()), 2,
                  {"unknown option '--stpes'", "did you mean '--steps'?"});
  expect_one_line(bzm({"run"}, folder.string()), 2, {"scenario"});
  expect_one_line(bzm({"run", "x.toml", "--steps", "many"}, folder.string()), 2, {"--steps"});
  expect_one_line(bzm({"run", "x.toml", "--steps", "-3"}, folder.string()), 2, {"--steps"});
  expect_one_line(bzm({"run", "x.toml", "--threads", "0"}, folder.string()), 2, {"--threads"});
  expect_one_line(bzm({"show", "leapfrog"}, folder.string()), 2, {"did you mean 'leap-frog'?"});
  expect_one_line(bzm({"list", "law"}, folder.string()), 2, {"did you mean 'laws'?"});
  write_text(folder / "mine.toml", "");
  expect_one_line(bzm({"mine.toml"}, folder.string()), 2, {"did you mean 'bzm run mine.toml'?"});
}

TEST(Run, MissingAndWrongScenariosLeaveNothing) {
  GasFolder folder;
  expect_one_line(bzm({"run", "nowhere.toml"}, folder.string()), 2, {"nowhere.toml"});
  std::string const good = text_of(folder / "gas.toml");
  std::string bad = good;
  bad.replace(bad.find("mass = \"39.948 amu\""), 19, "mass = \"39.948 angstrom\"");
  bad.replace(bad.find("law = \"lennard-jones\""), 21, "law = \"lenard-jones\"");
  write_text(folder / "bad.toml", bad);
  for (auto const* command : {"run", "check"}) {
    auto const outcome = bzm({command, "bad.toml"}, folder.string());
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(lines_in(outcome.err), 2U) << outcome.err;
    EXPECT_TRUE(has(outcome.err, "bad.toml:") && has(outcome.err, "did you mean 'lennard-jones'?")) << outcome.err;
    EXPECT_TRUE(has(outcome.err, "a length, a mass is needed")) << outcome.err;
  }
  EXPECT_FALSE(fs::exists(folder / "results"));
}

TEST(Run, LeavesItsFilesAndATable) {
  GasFolder folder;
  auto const outcome = folder.run({"--steps", "100", "--out", "out"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (auto const* word : {"energy", "momentum", "particle-steps/s", "lists built", "out: scenario.toml"})
    EXPECT_TRUE(has(outcome.out, word)) << outcome.out;
  EXPECT_TRUE(has(outcome.err, "100 %")) << outcome.err;
  EXPECT_LE(lines_in(outcome.err), 10U) << "a line for every 10 % where there is no terminal";
  EXPECT_FALSE(has(outcome.err + outcome.out, "\033")) << "no control characters where there is no terminal";
  for (auto const* file :
       {"scenario.toml", "diagnoses.csv", "trajectory.h5", "checkpoint.h5", "picture.png", "energies.png"})
    EXPECT_GT(fs::file_size(folder / (std::string("out/") + file)), 0U) << file;

  auto const table = read_csv((folder / "out/diagnoses.csv").string());
  EXPECT_EQ(table.header[0], "step");
  EXPECT_EQ(table.header[1], "time (ps)");
  auto const& steps = table.column("step");
  ASSERT_EQ(steps.size(), 6U);
  EXPECT_EQ(steps.back(), 100);
  EXPECT_NEAR(table.column("time (ps)").back(), 1.0, 1e-12);
  // 256 atoms in two dimensions at the temperature that the scenario asks for, within its statistical error of 6 %.
  EXPECT_NEAR(table.column("temperature (K)").front(), 120, 4 * 120 / std::sqrt(256.0));
  // A cut-off Lennard-Jones gas conserves its energy.
  auto const& energy = table.column("total energy (amu angstrom^2/ps^2)");
  auto const& kinetic = table.column("kinetic energy (amu angstrom^2/ps^2)");
  EXPECT_NEAR(energy.back(), energy.front(), 1e-3 * kinetic.front());

  TrajectoryReader const reader((folder / "out/trajectory.h5").string());
  EXPECT_EQ(reader.steps(), (std::vector<std::int64_t>{0, 50, 100}));
  // What is stored is a scenario that gives the same run.
  ASSERT_EQ(bzm({"run", "out/scenario.toml", "--out", "again", "--quiet"}, folder.string()).status, 0);
  EXPECT_EQ(text_of(folder / "out/diagnoses.csv"), text_of(folder / "again/diagnoses.csv"));
}

TEST(Run, OverridesChangeTheScenario) {
  GasFolder folder;
  ASSERT_EQ(folder
                .run({"--set", "run.steps=40", "--set", "run.step=5 fs", "--set", "output.diagnoses=10", "--seed", "7",
                      "--out", "a", "--quiet"})
                .status,
            0);
  auto const a = read_csv((folder / "a/diagnoses.csv").string());
  EXPECT_EQ(a.column("step"), (std::vector<double>{0, 10, 20, 30, 40}));
  EXPECT_NEAR(a.column("time (ps)").back(), 0.2, 1e-12);
  ASSERT_EQ(
      folder.run({"--set", "output.diagnoses=10", "--steps", "40", "--seed", "8", "--out", "b", "--quiet"}).status, 0);
  auto const b = read_csv((folder / "b/diagnoses.csv").string());
  EXPECT_NE(a.column("temperature (K)").front(), b.column("temperature (K)").front()) << "another seed";
  expect_one_line(folder.run({"--set", "run.stpe=1", "--out", "c"}), 2, {"stpe", "did you mean 'step'?"});
  EXPECT_FALSE(fs::exists(folder / "c"));
}

TEST(Run, QuietSaysNothing) {
  GasFolder folder;
  auto const outcome = folder.run({"--steps", "10", "--out", "out", "--quiet"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
}

TEST(Run, ZeroStepsLeaveTheStart) {
  GasFolder folder;
  auto const outcome = folder.run({"--steps", "0", "--out", "out"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(read_csv((folder / "out/diagnoses.csv").string()).column("step"), (std::vector<double>{0}));
}

TEST(Run, AFolderWithARunIsKept) {
  GasFolder folder;
  ASSERT_EQ(folder.run({"--steps", "10", "--out", "out", "--quiet"}).status, 0);
  auto const before = text_of(folder / "out/checkpoint.h5");
  expect_one_line(folder.run({"--steps", "20", "--out", "out"}), 2, {"already holds a run", "--force"});
  EXPECT_EQ(text_of(folder / "out/checkpoint.h5"), before);
  EXPECT_EQ(folder.run({"--steps", "20", "--out", "out", "--force", "--quiet"}).status, 0);
  EXPECT_NE(text_of(folder / "out/checkpoint.h5"), before);
}

TEST(Run, FoldersThatCannotBeWritten) {
  GasFolder folder;
  expect_one_line(folder.run({"--out", "gas.toml/out", "--quiet"}), 2, {"gas.toml", "is no folder"});
  expect_one_line(folder.run({"--out", "gas.toml", "--quiet"}), 2, {"'gas.toml', which is no folder"});
  expect_one_line(folder.run({"--out", "/proc/bzm", "--quiet"}), 2, {"/proc/bzm"});
}

TEST(Run, ADiskThatIsFullLaterLeavesAGoodCheckpoint) {
  GasFolder folder;
  SmallDisk const disk(folder / "disk", "1m");
  ASSERT_TRUE(disk.mounted()) << SmallDisk::refused;
  auto const outcome = folder.run({"--steps", "100000", "--out", "disk/out", "--quiet", "--set", "output.trajectory=10",
                                   "--set", "output.checkpoint=20"});
  expect_one_line(outcome, 1,
                  {"No space left on device", "the last checkpoint is intact: disk/out/checkpoint.h5 (step "});
  fs::remove(folder / "disk/out/trajectory.h5");
  fs::copy(folder / "disk/out", folder / "moved");
  auto const at = outcome.err.find("(step ");
  auto const resumed = bzm({"check", "moved/scenario.toml"}, folder.string());
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_GT(std::stol(outcome.err.substr(at + 6)), 0);
}

TEST(Run, ADiskThatIsFullAtTheStartLeavesNothing) {
  GasFolder folder;
  SmallDisk const disk(folder / "disk", "16k");
  ASSERT_TRUE(disk.mounted()) << SmallDisk::refused;
  expect_one_line(folder.run({"--out", "disk/out", "--quiet"}), 2, {"No space left on device"});
  EXPECT_FALSE(fs::exists(folder / "disk/out"));
}

TEST(Run, ALimitOnFilesIsToldLikeAFullDisk) {
  GasFolder folder;
  Process process({"/bin/bash", "-c",
                   "ulimit -f 500; exec " + bzm_words({})[0] +
                       " run gas.toml --steps 100000 --out out --quiet --set output.trajectory=10"},
                  folder.string());
  expect_one_line(process.wait(), 1, {"File too large", "the last checkpoint is intact: out/checkpoint.h5 (step "});
}

// A small plasma with all drawings that a mesh has.
struct PlasmaFolder : Folder {
  PlasmaFolder() {
    write_text(path("plasma.toml"), R"(
[units]
base = "reduced"
[box]
low = [0]
high = [6.283185307179586]
boundary = "periodic"
[run]
step = 0.1
steps = 40
[mesh]
law = "coulomb"
k = 1
cells = 16
background = true
[[ensembles]]
name = "electrons"
class = "Coulomb"
number = 256
mass = 0.02
charge = -0.02
load = { kind = "sinusoidal", mode = 1, amplitude = 0.2, quiet = true }
[[diagnoses]]
kind = "field-energy"
[[diagnoses]]
kind = "wave-spectrum"
[output]
diagnoses = 2
[[output.pictures]]
drawing = "wave-spectrum"
[[output.pictures]]
drawing = "mesh"
y = "field.x"
file = "field.png"
[[output.pictures]]
drawing = "time-series"
y = "field energy"
logarithmic = true
file = "energy.png"
)");
  }
  std::string path(std::string const& name) const { return (*this / name).string(); }
  Outcome run(std::vector<std::string> more) const {
    more.insert(more.begin(), {"run", "plasma.toml", "--quiet"});
    return bzm(more, string());
  }
};

TEST(Run, DrawsWavesOrSaysWhyThereAreNone) {
  PlasmaFolder folder;
  // Stopped before there is a spectrum: that is no failure, and all pictures are there.
  for (auto const* steps : {"0", "1", "4", "40"}) {
    auto const run = folder.run({"--out", steps, "--steps", steps});
    EXPECT_EQ(run.status, 0) << run.err;
    for (auto const* file : {"picture.png", "field.png", "energy.png"})
      EXPECT_GT(fs::file_size(folder / steps / file), 1000U) << steps << " " << file;
  }
}

TEST(Render, OfAMesh) {
  PlasmaFolder folder;
  ASSERT_EQ(folder.run({"--out", "without"}).status, 0);
  expect_one_line(bzm({"render", "without", "-o", "x.png"}, folder.string()), 2,
                  {"'without' has no trajectory.h5", "output.trajectory=10"});
  ASSERT_EQ(folder.run({"--out", "out", "--set", "output.trajectory=10"}).status, 0);
  expect_one_line(bzm({"render", "out", "-o", "x.png"}, folder.string()), 2, {"wave spectrum", "when the run ends"});
  // That of the scenario with this drawing, and so what the run has drawn at its end.
  EXPECT_EQ(bzm({"render", "out", "-o", "x.png", "--drawing", "mesh"}, folder.string()).status, 0);
  EXPECT_EQ(text_of(folder / "x.png"), text_of(folder / "out/field.png"));
  EXPECT_EQ(bzm({"render", "out", "-o", "x.png", "--drawing", "mesh", "--y", "density"}, folder.string()).status, 0);
  expect_one_line(bzm({"render", "out", "-o", "x.png", "--drawing", "mesh", "--y", "densty"}, folder.string()), 2,
                  {"no 'densty'", "did you mean 'density'?"});
  // Another drawing has nothing of the scenario's first picture.
  EXPECT_EQ(bzm({"render", "out", "-o", "x.png", "--drawing", "phase-space"}, folder.string()).status, 0);
}

TEST(Render, FramesOfAMovieHaveOneScale) {
  PlasmaFolder folder;
  ASSERT_EQ(folder.run({"--out", "out", "--set", "output.trajectory=4"}).status, 0);
  // The numbers at the ticks of the y axis.
  auto const left_of_the_frame = [&](std::string const& file) {
    cairo_surface_t* picture = cairo_image_surface_create_from_png((folder / file).c_str());
    EXPECT_EQ(cairo_surface_status(picture), CAIRO_STATUS_SUCCESS) << file;
    std::vector<std::uint8_t> pixels;
    for (int y = 120; y < cairo_image_surface_get_height(picture) - 60; ++y) {
      auto const* row = cairo_image_surface_get_data(picture) + y * cairo_image_surface_get_stride(picture);
      pixels.insert(pixels.end(), row, row + 4 * 70);
    }
    cairo_surface_destroy(picture);
    return pixels;
  };
  for (std::string const drawing : {"phase-space", "mesh", "time-series"}) {
    auto const frames = bzm({"render", "out", "-o", drawing + "/", "--drawing", drawing}, folder.string());
    ASSERT_EQ(frames.status, 0) << frames.err;
    EXPECT_EQ(frames.out, drawing + "/: 11 pictures\n");
    auto const first = left_of_the_frame(drawing + "/000000.png");
    EXPECT_GT(std::set<std::uint8_t>(first.begin(), first.end()).size(), 10U) << "there is something";
    for (auto const* frame : {"/000003.png", "/000010.png"})
      EXPECT_TRUE(first == left_of_the_frame(drawing + frame)) << drawing << frame;
    // Alone, the start has a scale of its own.
    ASSERT_EQ(bzm({"render", "out", "-o", "alone.png", "--frame", "0", "--drawing", drawing}, folder.string()).status,
              0);
    EXPECT_TRUE(first != left_of_the_frame("alone.png")) << drawing;
  }
}

TEST(Physics, AStepThatIsTooLargeNamesParticleAndStep) {
  GasFolder folder;
  auto const outcome = folder.run({"--set", "run.step=10 ps", "--out", "out", "--quiet"});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_EQ(lines_in(outcome.err), 3U) << outcome.err;
  EXPECT_TRUE(has(outcome.err, "warning: particles of 'atoms' meet")) << outcome.err;
  EXPECT_TRUE(has(outcome.err, "step 1: particle ")) << outcome.err;
  EXPECT_TRUE(has(outcome.err, "of 'atoms' moved")) << outcome.err;
  EXPECT_TRUE(has(outcome.err, "last good checkpoint: out/checkpoint.h5 (step 0); diagnoses were every 20 steps"))
      << outcome.err;
  // The step that it advises, with its unit, is one that holds, and no thousandth of it.
  std::size_t const below = outcome.err.find("take a step below ") + 18;
  std::string const step = outcome.err.substr(below, outcome.err.find_first_of(":\n", below) - below);
  double const advised = parse_quantity(step).si;
  EXPECT_GT(advised, 1e-15) << step;
  EXPECT_LT(advised, 1e-12) << step;
  EXPECT_EQ(folder.run({"--set", "run.step=" + step, "--steps", "50", "--out", "again", "--quiet"}).status, 0) << step;
  EXPECT_TRUE(fs::exists(folder / "out/picture.png")) << "the last recorded state is drawn";
  EXPECT_EQ(read_csv((folder / "out/diagnoses.csv").string()).column("step"), (std::vector<double>{0}));
  // The failed run goes on from its last good checkpoint, and fails again at the same step.
  auto const again = bzm({"resume", "out", "--quiet"}, folder.string());
  EXPECT_EQ(again.status, 3);
  EXPECT_TRUE(has(again.err, "step 1: particle ")) << again.err;
}

TEST(Physics, AnEnergyThatShouldStayAndGoesIsToldOfAtTheEnd) {
  Folder folder;
  auto const run = [&](std::string const& step, bool quiet) {
    std::vector<std::string> words{"run", "pendulums", "--set", "run.step=" + step, "--steps", "500", "--force"};
    if (quiet) words.emplace_back("--quiet");
    return bzm(words, folder.string());
  };
  expect_one_line(run("5", true), 0, {"warning: energy should be conserved and has gone from ", "too long"});
  EXPECT_TRUE(has(run("5", false).err, "warning: energy should be conserved"));
  auto const good = run("0.005", false);
  EXPECT_FALSE(has(good.err, "warning")) << good.err;
  EXPECT_FALSE(has(good.out, "momentum")) << good.out;
}

TEST(Physics, AFailureInTheMiddleKeepsWhatWasGood) {
  GasFolder folder;
  // Two atoms driven at each other so fast that the step is too large when they meet.
  std::string text = text_of(folder / "gas.toml");
  auto const from = text.find("load = "), to = text.find("remove_drift");
  text.replace(from, to - from,
               "load = { kind = \"positions\", positions = [[20, 40], [60, 40]] }\n"
               "mass = \"39.948 amu\"\nvelocity = [[100, 0], [-100, 0]]\n#");
  write_text(folder / "gas.toml", text);
  auto const outcome =
      folder.run({"--out", "out", "--quiet", "--set", "output.checkpoint=5", "--set", "output.diagnoses=1"});
  EXPECT_EQ(outcome.status, 3) << outcome.err;
  EXPECT_TRUE(has(outcome.err, "of 'atoms'")) << outcome.err;
  auto const steps = read_csv((folder / "out/diagnoses.csv").string()).column("step");
  long const failed = std::stol(outcome.err.substr(outcome.err.find("\nstep ") + 6));
  EXPECT_GT(failed, 10);
  EXPECT_EQ(steps.back(), failed - 1) << "every step before the failure is recorded";
  EXPECT_TRUE(has(outcome.err, "(step " + std::to_string((failed - 1) / 5 * 5) + ")")) << outcome.err;
}

TEST(Physics, ANumberThatIsNoneIsRefusedAtTheStart) {
  GasFolder folder;
  auto const nan = folder.run({"--set", "ensembles.atoms.mass=nan", "--out", "out", "--quiet"});
  EXPECT_EQ(nan.status, 2);
  EXPECT_TRUE(has(nan.err, "mass")) << nan.err;
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(Check, SaysOkAndRunsNothing) {
  GasFolder folder;
  auto const outcome = bzm({"check", "gas.toml"}, folder.string());
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out.substr(0, 17), "ok: 256 particles");
  EXPECT_FALSE(fs::exists(folder / "results"));
}

TEST(Check, TakesTheOptionsOfRun) {
  Folder folder;
  EXPECT_NE(bzm({"check", "copper", "--steps", "1e2", "--set", "run.seed=5"}, folder.string()).out.find("100 steps"),
            std::string::npos);
  EXPECT_NE(bzm({"check", "copper", "--time", "32.73 fs"}, folder.string()).out.find("1000 steps"), std::string::npos);
  auto const wrong = bzm({"check", "copper", "--set", "run.step=-1"}, folder.string());
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("--set run.step=-1: step"), std::string::npos) << wrong.err;
  for (char const* steps : {"-5", "1.5", "1e400", "many", "nan"}) {
    auto const refused = bzm({"run", "copper", std::string("--steps=") + steps}, folder.string());
    EXPECT_EQ(refused.status, 2) << steps;
    EXPECT_EQ(lines_in(refused.err), 1U) << refused.err;
    EXPECT_LT(refused.err.size(), 150U) << refused.err;
    EXPECT_NE(refused.err.find("a whole number, zero or more, is needed"), std::string::npos) << refused.err;
  }
  // A name that no file can have.
  auto const nameless = bzm({"resume", std::string(300, 'x')}, folder.string());
  EXPECT_EQ(nameless.status, 2);
  EXPECT_EQ(nameless.err.find("internal error"), std::string::npos) << nameless.err;
}

TEST(Check, EveryShippedScenarioIsRight) {
  Folder folder;
  std::istringstream names(bzm({"list", "--names", "scenarios"}, folder.string()).out);
  int count = 0;
  for (std::string name; names >> name; ++count) {
    auto const outcome = bzm({"check", name}, folder.string());
    EXPECT_EQ(outcome.status, 0) << name << ": " << outcome.err;
    auto const shown = bzm({"show", name}, folder.string());
    EXPECT_EQ(shown.status, 0) << name << ": " << shown.err;
    EXPECT_TRUE(has(shown.out, "scenario " + name + ": ")) << shown.out;
  }
  EXPECT_GE(count, 5);
}

TEST(New, KeepsWhatIsThere) {
  GasFolder folder;
  write_text(folder / "gas.toml", "mine");
  expect_one_line(bzm({"new", "gas"}, folder.string()), 2, {"gas.toml", "is there already"});
  EXPECT_EQ(text_of(folder / "gas.toml"), "mine");
  EXPECT_EQ(bzm({"new", "other.toml"}, folder.string()).status, 0);
  EXPECT_EQ(text_of(folder / "other.toml").find("#:schema ./boltzmann.schema.json\n"), 0U);
  EXPECT_EQ(text_of(folder / "boltzmann.schema.json"), bzm({"show", "--schema"}, folder.string()).out);
  EXPECT_TRUE(has(text_of(folder / "other.toml"), "bzm run other.toml"));
  EXPECT_EQ(bzm({"new", "grains", "--class"}, folder.string()).status, 0);
  EXPECT_EQ(bzm({"check", "grains.toml"}, folder.string()).status, 0);
  EXPECT_EQ(bzm({"new", "dust", "--law"}, folder.string()).status, 0);
  EXPECT_EQ(bzm({"check", "dust.toml"}, folder.string()).status, 0);
  EXPECT_EQ(bzm({"run", "dust.toml", "--steps", "20"}, folder.string()).status, 0);
  expect_one_line(bzm({"new", "both", "--law", "--class"}, folder.string()), 2, {"--law", "--class"});
  expect_one_line(bzm({"new", "no/such/folder/x"}, folder.string()), 2, {"no/such/folder/x.toml"});
}

TEST(List, ShowsEveryKindAndShowExplainsEveryName) {
  Folder folder;
  auto const all = bzm({"list"}, folder.string()).out;
  for (auto const* word : {"scenarios", "Newton", "lennard-jones", "ideal-gas", "leap-frog", "energies"})
    EXPECT_TRUE(has(all, word)) << word;
  std::istringstream names(bzm({"list", "--names"}, folder.string()).out +
                           bzm({"list", "--names", "units"}, folder.string()).out);
  int count = 0;
  for (std::string name; names >> name; ++count) {
    auto const outcome = bzm({"show", name}, folder.string());
    EXPECT_EQ(outcome.status, 0) << name << ": " << outcome.err;
    EXPECT_TRUE(has(outcome.out, name)) << outcome.out;
  }
  EXPECT_GT(count, 40);
}

TEST(Show, GivesTheBytesOfAParticle) {
  Folder folder;
  auto const newton = bzm({"show", "Newton"}, folder.string()).out;
  // x y z m vx vy vz padded to 64 bytes, and a force of 24.
  EXPECT_TRUE(has(newton, "in 3D       88 bytes")) << newton;
  EXPECT_TRUE(has(newton, "velocity     3 numbers  velocity")) << newton;
  auto const unit = bzm({"show", "eV"}, folder.string()).out;
  EXPECT_TRUE(has(unit, "1.602176634e-19")) << unit;
}

TEST(Show, KnowsWhatScenariosKnow) {
  Folder folder;
  for (auto const& law : scenario_laws())
    EXPECT_EQ(bzm({"show", std::string(law.name)}, folder.string()).status, 0) << law.name;
  for (auto const& drawing : drawings()) {
    auto const shown = bzm({"show", drawing.name}, folder.string());
    EXPECT_EQ(shown.status, 0) << drawing.name;
    for (auto const& key : drawing.options.keys()) EXPECT_TRUE(has(shown.out, "\n  " + key + " ")) << key;
  }
  for (auto const& table : scenario_tables()) {
    auto const shown = bzm({"show", table.name}, folder.string());
    EXPECT_EQ(shown.status, 0) << table.name;
    for (auto const& key : table.options->keys()) EXPECT_TRUE(has(shown.out, "\n  " + key + " ")) << key;
  }
  for (auto const& kind : load_kinds())
    EXPECT_TRUE(has(bzm({"show", kind.name}, folder.string()).out, "loader " + kind.name + ": ")) << kind.name;
}

TEST(Show, KnowsKeysAndWordsToo) {
  Folder folder;
  auto const told = [&](char const* name) { return bzm({"show", name}, folder.string()).out; };
  EXPECT_TRUE(has(told("stop"), "ends the run early: a condition\n    of [run]")) << told("stop");
  EXPECT_TRUE(has(told("convention"), "dissipation dpd")) << told("convention");
  EXPECT_TRUE(has(told("material"), "[[ensembles]]")) << told("material");
  EXPECT_TRUE(has(told("reflecting"), "boundary reflecting: elastic walls")) << told("reflecting");
  EXPECT_TRUE(has(told("diagnoses"), "energy-balance")) << told("diagnoses");
  auto const tables = bzm({"list", "tables"}, folder.string()).out;
  for (char const* table : {"units", "sweep", "sweep.pictures", "views", "dissipation", "diagnoses", "ensembles.set",
                            "box.regions", "output.pictures"}) {
    EXPECT_TRUE(has(tables, std::string("\n  ") + table + " ")) << table;
    EXPECT_EQ(bzm({"show", table}, folder.string()).status, 0) << table;
  }
  expect_one_line(bzm({"show", "order-free"}, folder.string()), 2, {"it is 'simultaneous' now"});
  expect_one_line(bzm({"show", "verlet"}, folder.string()), 2, {"it is called 'leap-frog' here"});
  expect_one_line(bzm({"show", "dt"}, folder.string()), 2, {"it is called 'step' here"});
  auto const units = bzm({"list", "units"}, folder.string()).out;
  EXPECT_TRUE(has(units, "an energy") && has(units, "a mass") && !std::regex_search(units, std::regex(" a [aeiou]")));
}

TEST(Show, RefusesWhatSaysNothingOrTooMuch) {
  Folder folder;
  expect_one_line(bzm({"show"}, folder.string()), 2, {"needs a name", "--schema"});
  expect_one_line(bzm({"show", "copper", "--schema"}, folder.string()), 2, {"leave 'copper' out"});
  expect_one_line(bzm({"show", "lennard-jone"}, folder.string()), 2, {"did you mean 'lennard-jones'"});
  auto const told = bzm({"show", "run"}, folder.string()).out;
  EXPECT_TRUE(has(told, "a condition [none]")) << told;  // links are for pages
  EXPECT_FALSE(has(told, "`") || has(told, "](")) << told;
}

TEST(Show, ExplainsAMaterial) {
  Folder folder;
  auto const tait = bzm({"show", "tait"}, folder.string()).out;
  for (auto const* part : {"equation of state", "reference_density", "kg/m^3", "positive [7]", "shear_viscosity",
                           "elastic = { ... }", "[no limit]", "boltzmann/laws/materials/tait.hpp"})
    EXPECT_TRUE(has(tait, part)) << part << "\n" << tait;
}

TEST(Doctor, ComputesTheKnownEnergy) {
  Folder folder;
  auto const outcome = bzm({"doctor"}, folder.string());
  EXPECT_EQ(outcome.status, 0) << outcome.out;
  for (auto const* word :
       {"HDF5            1.", "FFTW            fftw-3", "Cairo           1.", "MB/s", "-6.7733680", "all is well"})
    EXPECT_TRUE(has(outcome.out, word)) << outcome.out;
  EXPECT_FALSE(has(outcome.out, "\033"));
}

TEST(Completion, IsABashScriptThatKnowsTheCommands) {
  Folder folder;
  auto const outcome = bzm({"completion", "bash"}, folder.string());
  ASSERT_EQ(outcome.status, 0);
  fs::create_directory(folder / "results");
  write_text(folder / "mine.cpp", "");
  write_text(folder / "complete.sh",
             "PATH=" BOLTZMANN_BUILD ":$PATH\n" + outcome.out +
                 "COMP_WORDS=(bzm re); COMP_CWORD=1; _bzm; echo ${COMPREPLY[@]}\n"
                 "COMP_WORDS=(bzm run --s); COMP_CWORD=2; _bzm; echo ${COMPREPLY[@]}\n"
                 "COMP_WORDS=(bzm run copp); COMP_CWORD=2; _bzm; echo ${COMPREPLY[@]}\n"
                 "COMP_WORDS=(bzm run copper --out re); COMP_CWORD=4; _bzm; echo ${COMPREPLY[@]}\n"
                 "COMP_WORDS=(bzm build m); COMP_CWORD=2; _bzm; echo ${COMPREPLY[@]}\n"
                 "COMP_WORDS=(bzm list sc); COMP_CWORD=2; _bzm; echo ${COMPREPLY[@]}\n");
  auto const bash = Process({"/bin/bash", "complete.sh"}, folder.string()).wait();
  EXPECT_EQ(bash.status, 0);
  EXPECT_EQ(bash.out,
            "resume render\n--set --steps --seed --seeds\ncopper copper-10000 copper-3d "
            "copper-cascade copper-melting\nresults\nmine.cpp\nscenarios\n")
      << bash.err;
  expect_one_line(bzm({"completion", "fihs"}, folder.string()), 2, {"bash, zsh, fish", "did you mean 'fish'?"});
}

// fish completes a line without a terminal.
TEST(Completion, IsAFishScriptThatKnowsTheCommands) {
  Folder folder;
  auto const outcome = bzm({"completion", "fish"}, folder.string());
  ASSERT_EQ(outcome.status, 0);
  write_text(folder / "complete.fish", "set PATH " BOLTZMANN_BUILD " $PATH\n" + outcome.out +
                                           "complete -C 'bzm re' | string replace -r '\\t.*' ''\n"
                                           "complete -C 'bzm run --thr' | string replace -r '\\t.*' ''\n"
                                           "complete -C 'bzm run copper-' | string replace -r '\\t.*' ''\n"
                                           "complete -C 'bzm list sc' | string replace -r '\\t.*' ''\n"
                                           "true\n");  // replacing nothing is a failure of string
  auto const fish =
      Process({"/usr/bin/env", "HOME=" + folder.string(), "fish", "--no-config", "complete.fish"}, folder.string())
          .wait();
  EXPECT_EQ(fish.status, 0) << fish.err;
  EXPECT_EQ(fish.out, "render\nresume\n--threads\ncopper-3d\ncopper-10000\ncopper-cascade\ncopper-melting\nscenarios\n")
      << fish.err;
}

// zsh completes in a terminal only: what its own functions would be told is looked at.
TEST(Completion, IsAZshScriptThatKnowsTheCommands) {
  Folder folder;
  auto const outcome = bzm({"completion", "zsh"}, folder.string());
  ASSERT_EQ(outcome.status, 0);
  write_text(folder / "complete.zsh", "path=(" BOLTZMANN_BUILD
                                      " $path)\n"
                                      "compdef() { print compdef $* }\n"
                                      "compadd() { [[ $1 == -a ]] && print -l ${(P)2} }\n"
                                      "_describe() { print -l -- ${commands%%:*} }\n"
                                      "_arguments() { print -l -- ${${@%%\\[*}%%=} }\n" +
                                          outcome.out +
                                          "words=(bzm re) CURRENT=2; _bzm | grep ^re\n"
                                          "words=(bzm resume --) CURRENT=3; _bzm\n"
                                          "_bzm_names | grep -x copper\n");
  auto const zsh = Process({"/usr/bin/env", "zsh", "-f", "complete.zsh"}, folder.string()).wait();
  EXPECT_EQ(zsh.status, 0) << zsh.err;
  EXPECT_TRUE(has(zsh.out, "compdef _bzm bzm\nresume\nrender\n--help\n--steps\n--threads\n--hours\n--quiet\n"))
      << zsh.out << zsh.err;
  EXPECT_TRUE(has(zsh.out, "1:folder:_files -/\ncopper\n")) << zsh.out << zsh.err;
}

TEST(Render, DrawsAnyFrame) {
  GasFolder folder;
  ASSERT_EQ(folder.run({"--steps", "100", "--out", "out", "--quiet"}).status, 0);
  auto const last = bzm({"render", "out", "-o", "last.png"}, folder.string());
  EXPECT_EQ(last.status, 0) << last.err;
  EXPECT_EQ(last.out, "last.png: frame 2 (step 100)\n");
  // The last frame is the state that the run has drawn at its end.
  EXPECT_EQ(text_of(folder / "last.png"), text_of(folder / "out/picture.png"));
  EXPECT_EQ(
      bzm({"render", "out", "-o", "first.svg", "--frame", "0", "--colour", "kinetic-energy"}, folder.string()).status,
      0);
  EXPECT_TRUE(has(text_of(folder / "first.svg"), "<svg"));
  for (auto const* drawing : {"phase-space", "spectrum", "time-series"})
    EXPECT_EQ(bzm({"render", "out", "-o", "x.png", "--drawing", drawing}, folder.string()).status, 0) << drawing;
  EXPECT_EQ(bzm({"render", "out", "-o", "x.png", "--trace"}, folder.string()).status, 0);
  // What a scenario can say of a picture the command can, in units.
  auto const levels = bzm({"render", "out", "-o", "x.png", "--drawing", "contours", "--levels", "0.5, 1", "--weight",
                           "wendland", "--range", "6 angstrom", "--cells", "40", "--low", "0 amu/angstrom^2"},
                          folder.string());
  EXPECT_EQ(levels.status, 0) << levels.err;
  expect_one_line(bzm({"render", "out", "-o", "x.png", "--drawing", "map", "--slice", "x"}, folder.string()), 2,
                  {"--slice x", "slices are of fields in 3D"});
  expect_one_line(bzm({"render", "out", "-o", "x.png", "--drawing", "map", "--low", "1 kg"}, folder.string()), 2,
                  {"--low 1 kg", "low", "mass"});
  expect_one_line(
      bzm({"render", "out", "-o", "x.png", "--drawing", "time-series", "--colour", "speed"}, folder.string()), 2,
      {"unknown key 'colour'", "'time-series'", "logarithmic"});
  auto const frames = bzm({"render", "out", "-o", "frames/"}, folder.string());
  EXPECT_EQ(frames.status, 0) << frames.err;
  for (auto const* file : {"frames/000000.png", "frames/000001.png", "frames/000002.png"})
    EXPECT_TRUE(fs::exists(folder / file));

  expect_one_line(bzm({"render", "out", "-o", "x.png", "--frame", "3"}, folder.string()), 2, {"frame 3", "0 to 2"});
  expect_one_line(bzm({"render", "out", "-o", "x.png", "--colour", "sped"}, folder.string()), 2,
                  {"did you mean 'speed'?"});
  expect_one_line(bzm({"render", "out", "-o", "x.png", "--drawing", "polar"}, folder.string()), 2, {"polar"});
  expect_one_line(bzm({"render", "out", "-o", "x.jpg"}, folder.string()), 2, {".jpg", ".png"});
  expect_one_line(bzm({"render", "nowhere", "-o", "x.png"}, folder.string()), 2, {"nowhere"});
}

TEST(Render, AMovieNeedsFfmpegAndSaysSo) {
  GasFolder folder;
  ASSERT_EQ(folder.run({"--steps", "100", "--out", "out", "--quiet"}).status, 0);
  auto const movie = bzm({"render", "out", "-o", "movie.mp4"}, folder.string());
  if (movie.status == 0)
    EXPECT_GT(fs::file_size(folder / "movie.mp4"), 1000U);
  else
    expect_one_line(movie, 2, {"ffmpeg", "frames/"});
}

// A line for each tolerance, none of which is exceeded, and a picture of them.
TEST(Bzm, TellsWhatTolerancesCost) {
  Folder folder;
  auto const outcome = bzm({"accuracy", "plummer", "--threads", "1", "--out", "cost.png"}, folder.string());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::istringstream lines(outcome.out);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "All influences on 10000 particles by multipoles, 1 thread:");
  std::getline(lines, line);
  int rows = 0;
  double tolerance = 0, error = 0, order = 0, translations = 0, pairs = 0, seconds = 0;
  for (; lines >> tolerance >> error >> order >> translations >> pairs >> seconds; ++rows) {
    EXPECT_LT(error, tolerance);
    EXPECT_GT(seconds, 0);
    EXPECT_LT(pairs, 1.1e8);
  }
  EXPECT_EQ(rows, 10);
  EXPECT_GT(fs::file_size(fs::path(folder.string()) / "cost.png"), 1000U);
  expect_one_line(bzm({"accuracy", "copper"}, folder.string()), 2, {"the scenario has no [multipole]"});
}

// What `bzm show` prints of a law can be put into a scenario, and a warning is told before a run.
TEST(Command, ShowsLawsAsTheyAreTyped) {
  test::Folder folder;
  std::string const head =
      "[units]\nbase = \"si\"\n[box]\nlow = [0, 0, 0]\nhigh = [90, 90, 90]\nboundary = \"periodic\"\n[run]\nstep = "
      "0.01\n"
      "steps = 2\ncutoff = CUTOFF\n[[ensembles]]\nname = \"atoms\"\nclass = \"CLASS\"\nnumber = 9\nload = { kind = "
      "\"random\", minimum_distance = 5 }\nmass = 1\n";
  for (char const* law : {"lennard-jones", "uniform-gravity"}) {  // all of them: tests/scenario/typed_twins_test.cpp
    auto const shown = bzm({"show", law}, folder.string()).out;
    auto const from = shown.rfind("    [[influences]]"), to = shown.find("\n\n", from);
    std::string text = head + shown.substr(from, to - from) + "\n";
    for (auto const& [old, now] :
         {std::pair("CLASS", "Newton"), std::pair("CUTOFF", "45"), std::pair("\"...\"", "\"atoms\"")})
      text.replace(text.find(old), std::string_view(old).size(), now);
    test::write_text(folder / "typed.toml", text);
    auto const checked = bzm({"check", "typed.toml"}, folder.string());
    EXPECT_EQ(checked.status, 0) << text << checked.err;
  }
  std::string jumps = head + "[[influences]]\nenergy = \"1 J/(r/(1 m))\"\non = \"atoms\"\n";
  jumps.replace(jumps.find("CLASS"), 5, "Newton");
  jumps.replace(jumps.find("CUTOFF"), 6, "30");
  test::write_text(folder / "jumps.toml", jumps);
  auto const checked = bzm({"check", "jumps.toml"}, folder.string());
  EXPECT_EQ(checked.status, 0) << checked.err;
  EXPECT_NE(checked.err.find("warning: the formula law within 'atoms' jumps at its cut-off 30 m"), std::string::npos)
      << checked.err;
}

}  // namespace
}  // namespace boltzmann::command_test
