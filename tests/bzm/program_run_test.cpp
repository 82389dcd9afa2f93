// Runs of C++ programs, with classes of their own, are runs: drawn and shown again from their folders, gone on with by
// the same program.
#include "tests/bzm/command.hpp"

#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/pictures/picture_options.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/recording/run_file.hpp>
#include <boltzmann/scenario/stored_run.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <tests/message.hpp>

#include <cmath>

namespace boltzmann::program_run_test {
namespace {

using namespace boltzmann::test;

template <int D, class Real = double>
struct Bead : Newton<D, Real> {
  static constexpr char const* class_name = "Bead";
  Real heat;
  Vector<D, Real> spin;

  static FieldTable fields() {
    return Newton<D, Real>::fields()
        .add(&Bead::heat, "heat", dimensions::energy, "kept inside \"it\"")
        .add(&Bead::spin, "spin", dimensions::velocity, "round itself");
  }
};

template <int D>
Box box() {
  Vector<D> low, high;
  std::array<Boundary, D> kinds{};
  for (int a = 0; a < D; ++a) low[a] = -3, high[a] = 4, kinds[a] = Boundary::reflecting;
  if (D > 1) kinds[D - 1] = Boundary::periodic;
  if (D > 2) kinds[1] = Boundary::open;
  Box box(low, high, kinds);
  if constexpr (D == 2) {
    box.open_end(0, Box::End::high);
    box.install(Vector{2.0, 2.0}, Vector{3.0, 3.0}, Region::Side::keep_out);
  }
  return box;
}

// Beads on springs to each other, two sorts.
template <int D>
struct Beads {
  Ensemble<Bead<D>> heavy{"heavy", 5}, light{"light \"beads\"", 3};
  PairScheme scheme{box<D>(), 3.0};
  Simulation simulation{scheme, 0.01};

  Beads() {
    int k = 0;
    for (auto* beads : {&heavy, &light}) {
      for (auto& bead : *beads) {
        ++k;
        for (int a = 0; a < D; ++a) {
          bead.position[a] = 0.9 * std::cos(1.0 * k * (a + 1));
          bead.velocity[a] = 0.2 * std::sin(2.0 * k + a);
          bead.spin[a] = 0.1 * k - a;
        }
        bead.mass = beads == &heavy ? 3 : 0.5;
        bead.heat = k * k;
      }
      scheme.internal(*beads, [](auto const& p, auto const& q) { return (q.position - p.position) * 0.1; });
      simulation.integrate(*beads, Method::leap_frog);
    }
    heavy.appearance = {"navy", 0.7};
  }
};

UnitSystem const units(units::angstrom, units::amu, units::picosecond);

template <int D>
void plan(Recording& recording) {
  recording.title("Beads of \"two\" sorts");
  recording.diagnoses(5, {"momentum"});
  recording.trajectory(20);
  recording.picture({.colour = "heat", .low = 0, .high = 50, .projection = {20, 60}});
  if constexpr (D > 1) recording.picture({.vectors = "spin", .file = "spins.png", .trace = true});
  recording.picture({.drawing = "phase-space", .x = "heat", .y = "velocity.x", .size = "speed", .file = "phases.png"});
  recording.picture({.drawing = "time-series", .file = "series.png"});
  recording.picture({.drawing = "histogram", .x = "speed", .file = "speeds.png"});
  recording.picture({.drawing = "profile", .y = "density", .file = "profile.png"});
  recording.picture({.drawing = "map", .y = "heat", .file = "map.png", .cells = 40});
}

template <int D>
void expect_drawn_again() {
  Folder folder;
  {
    Beads<D> run;
    Recording recording(run.simulation, units, folder / "run");
    plan<D>(recording);
    run_with_progress(recording, 60, {.quiet = true});
    EXPECT_EQ(recording.files().front(), "run.toml");
  }
  // The last frame is the last state: the first picture, and the first of another drawing, are drawn as the run has.
  struct Again {
    char const* file;
    std::vector<std::string> options;
  };
  for (auto const& [file, options] :
       {Again{"picture.png", {}}, Again{"phases.png", {"--drawing", "phase-space"}},
        Again{"series.png", {"--drawing", "time-series"}}, Again{"speeds.png", {"--drawing", "histogram"}},
        Again{"profile.png", {"--drawing", "profile"}}, Again{"map.png", {"--drawing", "map"}}}) {
    std::vector<std::string> words{"render", "run", "-o", "again.png"};
    words.insert(words.end(), options.begin(), options.end());
    auto const drawn = bzm(words, folder.string());
    ASSERT_EQ(drawn.status, 0) << drawn.err;
    EXPECT_EQ(text_of(folder / "again.png"), text_of(folder / "run" / file)) << D << "D, " << file;
  }
  auto const stored = load_stored_run((folder / "run").string());
  ASSERT_EQ(stored->ensembles.size(), 2U);
  TrajectoryReader const reader((folder / "run" / "trajectory.h5").string());
  Beads<D> again;
  Box const& told = stored->box();
  for (int a = 0; a < D; ++a) {
    EXPECT_EQ(told.boundary(a), again.scheme.box().boundary(a));
    EXPECT_EQ(told.low(a), -3);
    for (auto const end : {Box::End::low, Box::End::high})
      EXPECT_EQ(told.walled(a, end), again.scheme.box().walled(a, end));
  }
  EXPECT_EQ(told.regions().size(), again.scheme.box().regions().size());
  reader.load(3, *stored->ensembles[0]);
  reader.load(3, again.heavy);
  for (auto const& field : again.heavy.fields()) {
    auto const& other = stored->ensembles[0]->field(field.name);
    EXPECT_EQ(other.dimension, field.dimension) << field.name;
    EXPECT_EQ(other.doc, field.doc);
    for (int c = 0; c < field.components; ++c)
      EXPECT_EQ(stored->ensembles[0]->column(other, c), again.heavy.column(field, c)) << field.name;
  }
  EXPECT_EQ(stored->units, units);
  EXPECT_EQ(stored->simulation->step_size(), 0.01);
  // What needs the laws is refused, not drawn as nothing.
  auto const energies =
      bzm({"render", "run", "-o", "no.png", "--drawing", "cartesian", "--color", "potential-energy"}, folder.string());
  EXPECT_EQ(energies.status, 2);
  EXPECT_NE(energies.err.find("potential energ"), std::string::npos) << energies.err;
  EXPECT_FALSE(fs::exists(folder / "no.png"));
}

TEST(ProgramRun, IsDrawnAgainIn1D) { expect_drawn_again<1>(); }
TEST(ProgramRun, IsDrawnAgainIn2D) { expect_drawn_again<2>(); }
TEST(ProgramRun, IsDrawnAgainIn3D) { expect_drawn_again<3>(); }

TEST(ProgramRun, GoesOnWhereTheEnvironmentSaysSo) {
  Folder folder;
  auto const run = [&](std::string const& name, std::uint64_t steps) {
    Beads<2> beads;
    Recording recording(beads.simulation, units, folder / name, {.overwrite = true});
    plan<2>(recording);
    return run_with_progress(recording, steps, {.quiet = true}).steps;
  };
  auto const plainly = [&](std::string const& name) {
    Beads<2> beads;
    Recording const recording(beads.simulation, units, folder / name, {.overwrite = true});
    beads.simulation.run(1);
  };
  struct Asked {
    Asked() { setenv("BOLTZMANN_RESUME", "1", 1); }
    ~Asked() { unsetenv("BOLTZMANN_RESUME"); }
  };
  EXPECT_EQ(run("whole", 100), 100);
  EXPECT_EQ(run("parts", 30), 30);
  {
    Asked const asked;
    EXPECT_EQ(run("parts", 100), 70);
    EXPECT_EQ(run("parts", 100), 0);  // it has ended
    EXPECT_EQ(run("new", 10), 10);    // there is nothing to go on with
    EXPECT_NE(message([&] { plainly("parts"); }).find("BOLTZMANN_RESUME=1"), std::string::npos);
  }
  for (char const* file : {"run.toml", "diagnoses.csv", "trajectory.h5", "picture.png", "spins.png", "series.png"})
    EXPECT_EQ(text_of(folder / "parts" / file), text_of(folder / "whole" / file)) << file;
  EXPECT_EQ(run("parts", 10), 10);  // and begins anew where nobody asks
  auto const resumed = bzm({"resume", "whole"}, folder.string());
  EXPECT_EQ(resumed.status, 2);
  EXPECT_NE(resumed.err.find("BOLTZMANN_RESUME=1"), std::string::npos) << resumed.err;
}

// A run that its condition has ended is at its end, whatever the program asks for.
TEST(ProgramRun, DoesNotGoOnBehindItsCondition) {
  Folder folder;
  auto const run = [&] {
    Beads<2> beads;
    Recording recording(beads.simulation, units, folder / "run", {.overwrite = true});
    recording.diagnoses(5, {"momentum"});
    recording.stop_when("soon", [](std::int64_t step, std::span<double const>) { return step >= 20; });
    return run_with_progress(recording, 100, {.quiet = true}).steps;
  };
  setenv("BOLTZMANN_RESUME", "1", 1);
  EXPECT_EQ(run(), 20);
  EXPECT_EQ(run(), 0);
  setenv("BOLTZMANN_RESUME", "yes", 1);
  EXPECT_EQ(message([&] { run(); }), "BOLTZMANN_RESUME is 1 (continue the run in the folder) or 0, not 'yes'");
  setenv("BOLTZMANN_RESUME", "0", 1);
  EXPECT_EQ(run(), 20);
  unsetenv("BOLTZMANN_RESUME");
}

// Every member of a picture, every kind of wall and region: what is read gives the same text.
TEST(ProgramRun, TheRunFileComesBackWhole) {
  Folder folder;
  Box box(Vector{0.0, -1.5}, Vector{4.0, 2.5}, {Boundary::mirror, Boundary::reflecting});
  box.wall(0, Box::End::low, {.slips = false, .velocity = {0.25, -1, 0}, .temperature = 320.5});
  box.open_end(0, Box::End::high);
  box.wall(1, Box::End::low, {.velocity = {0, 0.125, 0}});
  box.install(Vector{1.0, 0.0}, Vector{2.0, 1.0}, Region::Side::keep_out);
  box.install(Vector{0.0, -1.0}, Vector{3.5, 2.0}, Region::Side::keep_in);
  Box flowing(Vector{0.0, -1.5}, Vector{4.0, 2.5}, Boundary::periodic);
  flowing.shear({-0.1, 1, 0});
  Ensemble<Bead<2>> beads("beads\t\"1\"", 1);
  beads.appearance = {"#10a0ff", 0.3};
  Picture picture{.drawing = "bands",
                  .x = "heat",
                  .y = "a, b",
                  .colour = "speed",
                  .size = "mass",
                  .vectors = "spin",
                  .file = "p.svg",
                  .trace = true,
                  .low = -1e-30,
                  .high = 1e50,
                  .slice = "y",
                  .at = 0.1,
                  .curves = {{1.5, 2.5}, {0, 3}},
                  .logarithmic = true,
                  .smoothing = {WeightShape::wendland, 0.7},
                  .levels = {1, 2.5, 1e9},
                  .level_count = 7,
                  .projection = {12.5, -80},
                  .most = 99,
                  .region = {{0, 1}, {-2, 2}},
                  .streamlines = 12,
                  .streaklines = true,
                  .gap = 0.25,
                  .cells = 33,
                  .bins = 34};
  AnyEnsemble* const ensembles[] = {&beads};
  Picture const plain, pictures[] = {plain, picture};
  for (UnitSystem const& chosen : {units, UnitSystem::reduced()}) {
    bool const flows = chosen == units;
    auto const text = run_file_text("\"T\"\n2", chosen, 1e-3, flows ? flowing : box, ensembles, pictures);
    write_text(folder / "run.toml", text);
    auto const back = load_stored_run(folder.string());
    std::vector<AnyEnsemble*> const again{back->ensembles[0].get()};
    std::vector<Picture> const plans(back->output.pictures.begin(), back->output.pictures.end());
    EXPECT_EQ(run_file_text(back->title, back->units, back->simulation->step_size(), back->box(), again, plans), text);
    EXPECT_EQ(back->units, chosen);
    EXPECT_EQ(back->box().shear().rate, flows ? -0.1 : 0);
    // None of the words was left out because it looked like nothing.
    for (auto const& option : picture_options())
      EXPECT_NE(text.find("\n" + option.key + " = ", text.rfind("[[pictures]]")), std::string::npos) << option.key;
  }
}

TEST(ProgramRun, DamagedRunFilesAreMistakesWithAPlace) {
  Folder folder;
  {
    Beads<2> run;
    Recording recording(run.simulation, units, folder / "run");
    recording.trajectory(5);
    run_with_progress(recording, 5, {.quiet = true});
  }
  std::string const right = text_of(folder / "run/run.toml");
  auto const with = [&](std::string const& part, std::string const& other) {
    std::string text = right;
    auto const at = text.find(part);
    EXPECT_NE(at, std::string::npos) << part;
    write_text(folder / "run/run.toml", text.replace(at, part.size(), other));
    auto const drawn = bzm({"render", "run", "-o", "no.png"}, folder.string());
    EXPECT_EQ(drawn.status, 2) << part;
    EXPECT_LE(lines_in(drawn.err), 2U) << drawn.err;
    return drawn.err;
  };
  for (auto const& [part, other] :
       std::vector<std::array<std::string, 2>>{{"\"periodic\"", "\"perodic\""},
                                               {"[box]", "[bax]"},
                                               {"\"position\"", "\"place\""},
                                               {"dimension = [1, 0, 0, 0, 0]", "dimension = 1"},
                                               {"components = 2", "components = 900"},
                                               {"low = [-3, -3]", "low = [5, -3]"},
                                               {"length = 1e-10", "length = -1"},
                                               {"title = ", "title "}}) {
    auto const line = with(part, other);
    EXPECT_NE(line.find(part == "low = [-3, -3]" ? "low" : "run/run.toml:"), std::string::npos) << line;
  }
  fs::remove(folder / "run/run.toml");
  auto const none = bzm({"render", "run", "-o", "no.png"}, folder.string());
  EXPECT_NE(none.err.find("contains no run"), std::string::npos) << none.err;
  EXPECT_FALSE(fs::exists(folder / "no.png"));
}

}  // namespace
}  // namespace boltzmann::program_run_test
