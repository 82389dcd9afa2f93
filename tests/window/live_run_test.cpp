// A live run, steered by pages that are read here: what each button does to the simulation, exactly.
#include <gtest/gtest.h>
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/pictures/picture_options.hpp>
#include <boltzmann/window/window.hpp>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <memory>
#include <tests/window/reader.hpp>
#include <thread>

namespace boltzmann::live_run_test {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

// 64 warm Lennard-Jones atoms in the plane, or in space.
template <int D>
struct Atoms {
  Ensemble<Newton<D>> atoms{"atoms"};
  std::unique_ptr<PairScheme> scheme;
  std::unique_ptr<Simulation> simulation;

  explicit Atoms(Method method = Method::leap_frog, double step = 0.004) {
    double const side = D == 2 ? 8 : 4, spacing = 1.12;
    int const count = D == 2 ? 64 : 64, along = D == 2 ? 8 : 4;
    for (int i = 0; i < count; ++i) {
      Newton<D> atom{};
      atom.mass = 1;
      int rest = i;
      for (int a = 0; a < D; ++a) {
        atom.position[a] = spacing * (0.5 + rest % along);
        atom.velocity[a] = std::sin(1.7 * i + a);
        rest /= along;
      }
      atoms.add(atom);
    }
    Vector<D, double> low, high;
    for (int a = 0; a < D; ++a) low[a] = 0, high[a] = side * spacing;
    scheme = std::make_unique<PairScheme>(Box(low, high, Boundary::periodic), D == 2 ? 2.5 : 1.8);
    scheme->internal(atoms, LennardJones{1, 1});
    simulation = std::make_unique<Simulation>(*scheme, step);
    simulation->integrate(atoms, method);
  }
};

// A window whose run goes on in a thread of its own, as that of a program does.
class Running {
 public:
  Running(Simulation& simulation, std::uint64_t steps, WindowOptions options = {})
      : window(simulation, UnitSystem::reduced(), quiet(options)) {
    start(steps);
  }
  Running(Recording& recording, std::uint64_t steps, WindowOptions options = {}) : window(recording, quiet(options)) {
    start(steps);
  }
  ~Running() {
    if (thread_.joinable()) {
      window.simulation().stop();
      thread_.join();
    }
  }
  void join() { thread_.join(); }
  /// The last step that is done, while the thread goes on.
  std::int64_t step() const { return *step_; }

  Window window;
  std::atomic<bool> ended = false;
  std::exception_ptr failure;

 private:
  static WindowOptions quiet(WindowOptions options) {
    options.quiet = true;
    return options;
  }
  void start(std::uint64_t steps) {
    window.simulation().observe_progress([step = step_](Simulation const& simulation) { *step = simulation.step(); });
    thread_ = std::thread([this, steps] {
      try {
        window.run(steps);
      } catch (...) {
        failure = std::current_exception();
      }
      ended = true;
    });
  }
  std::shared_ptr<std::atomic<std::int64_t>> step_ = std::make_shared<std::atomic<std::int64_t>>(0);
  std::thread thread_;
};

json const particles = json::array({{{"id", 1}, {"diagnosis", "Particles"}}});

std::vector<double> rows_of(AnyEnsemble const& ensemble) {
  return {ensemble.row(0), ensemble.row(0) + ensemble.size() * ensemble.stride()};
}

struct Folder {
  fs::path path = fs::temp_directory_path() / ("live_run_" + std::to_string(::getpid()));
  Folder() { fs::remove_all(path); }
  ~Folder() { fs::remove_all(path); }
};

TEST(LiveRun, SaysWhatThereIsToSee) {
  Atoms<2> system;
  Running running(*system.simulation, 100);
  PageReader page(running.window.address());
  EXPECT_EQ(page.hello["kind"], "live");
  EXPECT_EQ(page.hello["dimension"], 2);
  EXPECT_EQ(page.hello["planned"], 100);
  EXPECT_EQ(page.hello["box"]["boundary"][0], "periodic");
  EXPECT_EQ(page.hello["ensembles"][0]["size"], 64);
  EXPECT_EQ(page.hello["maps"]["viridis"].size(), 256U);
  std::vector<std::string> names;
  for (auto const& diagnosis : page.hello["diagnoses"]) names.push_back(diagnosis["name"]);
  for (auto const* name : {"Particles", "Phase space", "Histogram", "Spectrum", "Profile"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  EXPECT_NE(page.hello["can"]["checkpoint"], "");
  EXPECT_EQ(page.hello["can"]["rewind"], "");
  // All that can be said of each drawing.
  for (auto const& drawing : drawings()) {
    std::vector<std::string> keys;
    for (auto const& option : page.hello["drawings"][drawing.name]) keys.push_back(option["key"]);
    EXPECT_EQ(keys, drawing.options.keys()) << drawing.name;
  }
}

// What a run's picture says is what its page begins with: arrows, too.
TEST(LiveRun, BeginsWithWhatAPictureSays) {
  Folder folder;
  Atoms<3> system;
  Recording recording(*system.simulation, UnitSystem::reduced(), folder.path.string());
  recording.picture({.vectors = "velocity", .file = "arrows.png", .projection = {10, 60}});
  recording.picture({.drawing = "contours", .file = "lines.png", .levels = {0.5, 1}, .cells = 50});
  Running running(recording, 100);
  PageReader page(running.window.address());
  json arrows, lines;
  for (auto const& diagnosis : page.hello["diagnoses"]) {
    if (diagnosis["name"] == "Arrows") arrows = diagnosis;
    if (diagnosis["name"] == "Lines") lines = diagnosis;
  }
  EXPECT_EQ(arrows["vectors"], "velocity");
  EXPECT_EQ(arrows["azimuth"], 10);
  EXPECT_EQ(arrows["low"], nullptr);
  EXPECT_EQ(lines["levels"], json({0.5, 1}));
  EXPECT_EQ(lines["cells"], 50);
  EXPECT_EQ(lines["weight"], "lucy");
  // Null is automatic again; what is out of range is one line.
  page.say({{"do", "views"}, {"views", {{{"id", 1}, {"diagnosis", "Lines"}, {"levels", nullptr}, {"cells", 1}}}}});
  auto const refused =
      page.until([](json const& u) { return u["views"].size() == 1 && u["views"][0].contains("error"); });
  EXPECT_EQ(refused.head["views"][0]["error"], "cells: 1 is out of range; it must be between 2 and 4000");
}

TEST(LiveRun, StepsExactlyAsOftenAsAsked) {
  Atoms<2> system, alone;
  Running running(*system.simulation, 1000);
  PageReader page(running.window.address());
  page.show(particles);
  EXPECT_EQ(page.update().head["state"], "paused");
  page.ask({{"do", "step"}});
  page.until([](json const& u) { return u["step"] == 1 && u["state"] == "paused"; });
  page.ask({{"do", "step"}, {"steps", 9}});
  page.until([](json const& u) { return u["step"] == 10 && u["state"] == "paused"; });
  page.ask({{"do", "quit"}});
  running.join();
  alone.simulation->run(10);
  EXPECT_EQ(system.simulation->step(), 10);
  EXPECT_EQ(rows_of(system.atoms), rows_of(alone.atoms)) << "a run in steps is the run in one piece";
}

TEST(LiveRun, PlaysToTheEndAndGoesOnIfAsked) {
  Atoms<2> system;
  Running running(*system.simulation, 200);
  PageReader page(running.window.address());
  page.show(particles);
  page.ask({{"do", "set"}, {"steps_per_frame", 0}});
  page.ask({{"do", "play"}});
  auto const done = page.until_state("done");
  EXPECT_EQ(done.head["step"], 200);
  page.ask({{"do", "play"}});
  page.until([](json const& u) { return u["step"] == 400 && u["state"] == "done"; });
  page.ask({{"do", "quit"}});
  running.join();
}

TEST(LiveRun, StopsWhereItIs) {
  Atoms<2> system;
  Running running(*system.simulation, 1'000'000'000);
  PageReader page(running.window.address());
  page.show(particles);
  page.ask({{"do", "set"}, {"steps_per_frame", 0}});
  page.ask({{"do", "play"}});
  page.until([](json const& u) { return u["step"] > 1000; });
  page.ask({{"do", "stop"}});
  auto const stopped = page.until_state("paused");
  auto const step = stopped.head["step"].get<std::int64_t>();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  page.show(json::array({{{"id", 2}, {"diagnosis", "Phase space"}}}));
  EXPECT_EQ(page.update().head["step"], step);
  page.ask({{"do", "quit"}});
  running.join();
  EXPECT_EQ(system.simulation->step(), step);
}

TEST(LiveRun, RewindsToTheLastBitWithTheReversibleLeapFrog) {
  Atoms<3> system(Method::reversible_leap_frog);
  Running running(*system.simulation, 500);
  PageReader page(running.window.address());
  page.show(particles);
  page.ask({{"do", "step"}, {"steps", 500}});
  page.until([](json const& u) { return u["step"] == 500; });
  page.ask({{"do", "set"}, {"steps_per_frame", 0}});
  page.ask({{"do", "rewind"}});
  auto const back = page.until([](json const& u) { return !u["missed"].is_null(); });
  EXPECT_EQ(back.head["step"], 0);
  EXPECT_EQ(back.head["missed"]["position"], 0.0);
  EXPECT_EQ(back.head["missed"]["velocity"], 0.0);
  EXPECT_EQ(back.head["missed"]["text"], "back at the start, exactly");
}

TEST(LiveRun, SaysByHowMuchTheStartIsMissed) {
  Atoms<2> system, alone;
  alone.simulation->run(300);
  auto const start = Atoms<2>();
  alone.simulation->rewind(300);
  double position = 0;
  for (std::size_t i = 0; i < 64; ++i)
    position = std::max(position, magnitude(alone.atoms[i].position - start.atoms[i].position));
  ASSERT_GT(position, 0);
  Running running(*system.simulation, 300);
  PageReader page(running.window.address());
  page.show(particles);
  page.ask({{"do", "step"}, {"steps", 300}});
  page.until([](json const& u) { return u["step"] == 300; });
  page.ask({{"do", "set"}, {"steps_per_frame", 0}});
  page.ask({{"do", "rewind"}});
  auto const back = page.until([](json const& u) { return !u["missed"].is_null(); });
  EXPECT_NEAR(back.head["missed"]["position"].get<double>(), position, 1e-3 * position);
  EXPECT_LT(position, 1e-6) << "300 steps there and back";
}

TEST(LiveRun, TakesAnotherStepSize) {
  Atoms<2> system;
  Running running(*system.simulation, 100);
  PageReader page(running.window.address());
  page.show(particles);
  page.ask({{"do", "step"}, {"steps", 10}});
  page.until([](json const& u) { return u["step"] == 10; });
  EXPECT_TRUE(page.ask({{"do", "set"}, {"step_size", 0.001}}).contains("ok"));
  page.ask({{"do", "step"}, {"steps", 10}});
  auto const update = page.until([](json const& u) { return u["step"] == 20; });
  EXPECT_NEAR(update.head["time_number"].get<double>(), 10 * 0.004 + 10 * 0.001, 1e-12);
  for (json const& wrong : {json(0), json(-1), json("fast"), json("3 kg"), json(true)})
    EXPECT_TRUE(page.ask({{"do", "set"}, {"step_size", wrong}}).contains("error")) << wrong;
  page.show(json::array({{{"id", 2}, {"diagnosis", "Phase space"}}}));
  EXPECT_EQ(page.update().head["step_size_number"], 0.001);
}

TEST(LiveRun, SendsParticlesWhereTheyAre) {
  Atoms<2> system;
  Running running(*system.simulation, 100);
  PageReader page(running.window.address());
  page.show(json::array({{{"id", 7}, {"diagnosis", "Particles"}, {"colour", "speed"}}}));
  page.ask({{"do", "step"}, {"steps", 5}});
  auto const update = page.until([](json const& u) { return u["step"] == 5 && !u["views"].empty(); });
  json const& canvas = update.head["views"][0]["canvas"];
  json cloud;
  for (auto const& mark : canvas["marks"])
    if (mark["kind"] == "cloud") cloud = mark;
  ASSERT_EQ(cloud["count"], 64);
  auto const positions = update.array<float>(cloud["positions"]);
  auto const values = update.array<float>(cloud["values"]);
  json const& bar = canvas["bars"][0];
  for (std::size_t i = 0; i < 64; ++i) {
    for (std::size_t a = 0; a < 2; ++a) {
      double const coordinate =
          cloud["origin"][a].get<double>() + cloud["scale"][a].get<double>() * positions[2 * i + a];
      EXPECT_NEAR(coordinate, system.atoms[i].position[static_cast<int>(a)], 2e-6);
    }
    double const low = bar["low"], high = bar["high"];
    EXPECT_NEAR(low + values[i] * (high - low), magnitude(system.atoms[i].velocity), 2e-6);
  }
}

TEST(LiveRun, TellsTheFieldsOfAParticle) {
  Atoms<2> system;
  Running running(*system.simulation, 100);
  PageReader page(running.window.address());
  page.show(particles);
  page.update();
  EXPECT_TRUE(page.ask({{"do", "select"}, {"ensemble", "atoms"}, {"particle", 64}}).contains("error"));
  page.ask({{"do", "select"}, {"ensemble", "atoms"}, {"particle", 5}});
  auto const update = page.until([](json const& u) { return !u["selected"].is_null(); });
  EXPECT_EQ(update.head["selected"]["position"][1].get<double>(), system.atoms[5].position[1]);
  bool speed = false;
  for (auto const& field : update.head["selected"]["fields"])
    if (field["name"] == "speed") {
      speed = true;
      EXPECT_NEAR(std::stod(field["value"].get<std::string>()), magnitude(system.atoms[5].velocity), 1e-4);
    }
  EXPECT_TRUE(speed);
}

TEST(LiveRun, DrawsTheUsersOwnDiagnosis) {
  Atoms<2> system;
  Window window(*system.simulation, UnitSystem::reduced(), {.quiet = true});
  window.install("Kinetic", [](Canvas& canvas, auto const& scheme) {
    auto const& ensemble = *scheme.ensembles()[0];
    canvas.axes({"number", ""}, {"x", ""});
    for (std::size_t i = 0; i < ensemble.size(); ++i) canvas.point(static_cast<double>(i), ensemble.row(i)[0]);
  });
  window.install("Own", [&](Canvas& canvas) { canvas.line(0, 0, 1, static_cast<double>(system.simulation->step())); });
  window.colours({"#12ff34", "red"});
  EXPECT_THROW(window.colours({"rod"}), Error);
  EXPECT_THROW(window.add("Wrong", {.drawing = "phase-space", .x = "charge"}), Error);
  window.add("Speeds", {.drawing = "phase-space", .x = "position.x", .y = "speed", .colour = "kinetic-energy"});
  std::thread thread([&] { window.run(10); });
  {
    PageReader page(window.address());
    EXPECT_EQ(page.hello["ensembles"][0]["colour"], "#12ff34");
    page.show(json::array({{{"id", 1}, {"diagnosis", "Kinetic"}},
                           {{"id", 2}, {"diagnosis", "Own"}},
                           {{"id", 3}, {"diagnosis", "Speeds"}},
                           {{"id", 4}, {"diagnosis", "None"}}}));
    auto const update = page.update();
    json const& marks = update.head["views"][0]["canvas"]["marks"][0];
    EXPECT_EQ(marks["kind"], "point");
    EXPECT_EQ(marks["colours"]["count"], 64);
    EXPECT_EQ(update.head["views"][1]["canvas"]["marks"][0]["kind"], "line");
    EXPECT_EQ(update.head["views"][2]["canvas"]["bars"].size(), 1U);
    EXPECT_NE(update.head["views"][3]["error"].get<std::string>().find("Particles"), std::string::npos);
    page.ask({{"do", "quit"}});
  }
  thread.join();
}

TEST(LiveRun, TellsOfAFailureAndKeepsTheWindowOpen) {
  Atoms<2> system(Method::leap_frog, 2.0);
  Running running(*system.simulation, 1000);
  PageReader page(running.window.address());
  page.show(particles);
  page.ask({{"do", "play"}});
  auto const failed = page.until_state("failed");
  EXPECT_NE(failed.head["message"].get<std::string>().find("particle"), std::string::npos);
  EXPECT_TRUE(page.ask({{"do", "play"}}).contains("error"));
  EXPECT_FALSE(running.ended);
  page.ask({{"do", "quit"}});
  running.join();
  ASSERT_TRUE(running.failure);
  EXPECT_THROW(std::rethrow_exception(running.failure), PhysicsFailure);
}

TEST(LiveRun, RefusesWhatItDoesNotUnderstand) {
  Atoms<2> system;
  Running running(*system.simulation, 100);
  PageReader page(running.window.address());
  page.show(particles);
  for (json const& wrong :
       {json{{"do", "explode"}}, json{{"do", "step"}, {"steps", 0}}, json{{"do", "step"}, {"steps", 0.5}},
        json{{"do", "step"}, {"steps", "many"}}, json{{"do", "rewind"}}, json{{"do", "views"}},
        json{{"do", "views"}, {"views", json::array()}}, json{{"do", "set"}},
        json{{"do", "set"}, {"steps_per_frame", -1}}, json{{"do", "select"}, {"ensemble", 3}}, json{{"do", "picture"}},
        json{{"do", "checkpoint"}}, json{{"do", "seek"}, {"frame", 3}},
        json{{"do", "picture"}, {"view", {{"diagnosis", "Particles"}}}, {"format", "gif"}}})
    EXPECT_TRUE(page.ask(wrong).contains("error")) << wrong;
  page.socket().say("no json");
  page.socket().say("[1, 2, 3]");
  page.ask({{"do", "step"}});
  EXPECT_EQ(page.until([](json const& u) { return u["step"] == 1; }).head["state"], "paused");
}

TEST(LiveRun, SeveralPagesLookAtOneRun) {
  Atoms<2> system;
  Running running(*system.simulation, 100);
  PageReader one(running.window.address());
  one.show(particles);
  {
    PageReader two(running.window.address());
    two.show(json::array({{{"id", 1}, {"diagnosis", "Histogram"}, {"x", "velocity.x"}}}));
    EXPECT_EQ(two.until([](json const& u) { return u["viewers"] == 2; }).head["views"].size(), 1U);
    one.ask({{"do", "step"}});
    EXPECT_EQ(two.until([](json const& u) { return u["step"] == 1; }).head["state"], "paused");
  }
  EXPECT_EQ(one.until([](json const& u) { return u["viewers"] == 1; }).head["step"], 1);
}

TEST(LiveRun, RecordsAsARunWithoutAWindow) {
  Folder const folder;
  auto const record = [&](Atoms<2>& system, std::string const& name, bool in_window) {
    Recording recording(*system.simulation, UnitSystem::reduced(), (folder.path / name).string(), {.overwrite = true});
    recording.diagnoses(5, {"energies"});
    recording.trajectory(10);
    recording.picture({.colour = "speed"});
    recording.title("64 atoms");
    if (!in_window) {
      run_with_progress(recording, 40, {.quiet = true});
      return;
    }
    Running running(recording, 40);
    PageReader page(running.window.address());
    EXPECT_EQ(page.hello["columns"][0]["name"], "kinetic energy");
    page.show(json::array({{{"id", 1}, {"diagnosis", "Particles"}, {"colour", "potential-energy"}},
                           {{"id", 2}, {"diagnosis", "Measured"}},
                           {{"id", 3}, {"diagnosis", "Spectrum"}}}));
    EXPECT_TRUE(page.ask({{"do", "checkpoint"}}).contains("error")) << "nothing is recorded before the first step";
    page.ask({{"do", "step"}, {"steps", 17}});
    page.until([](json const& u) { return u["step"] == 17; });
    auto const saved = page.ask({{"do", "checkpoint"}});
    EXPECT_EQ(read_checkpoint(saved["path"]).step, 17);
    page.ask({{"do", "play"}});
    auto const done = page.until_state("done");
    ASSERT_TRUE(done.head.contains("table"));
    auto const values = done.array<double>(done.head["table"]["values"]);
    EXPECT_EQ(done.head["table"]["rows"], 9);
    std::size_t const width = values.size() / 9;
    EXPECT_EQ(values[8 * width], 40);
    EXPECT_TRUE(fs::exists(folder.path / name / "window.txt"));
    page.ask({{"do", "quit"}});
    running.join();
    EXPECT_FALSE(fs::exists(folder.path / name / "window.txt"));
  };
  Atoms<2> alone, watched;
  record(alone, "alone", false);
  record(watched, "watched", true);
  EXPECT_EQ(rows_of(alone.atoms), rows_of(watched.atoms)) << "looking changes no bit";
  for (auto const* file : {"diagnoses.csv", "picture.png"}) {
    std::ifstream a(folder.path / "alone" / file), b(folder.path / "watched" / file);
    std::string const one(std::istreambuf_iterator<char>(a), {}), other(std::istreambuf_iterator<char>(b), {});
    EXPECT_GT(one.size(), 100U);
    EXPECT_TRUE(one == other) << file;
  }
}

TEST(LiveRun, QuitBeforeTheFirstStepLeavesARunToResume) {
  Folder const folder;
  Atoms<2> system;
  Recording recording(*system.simulation, UnitSystem::reduced(), folder.path.string(), {.overwrite = true});
  recording.trajectory(10);
  Running running(recording, 40);
  PageReader page(running.window.address());
  page.ask({{"do", "quit"}});
  running.join();
  EXPECT_FALSE(running.failure);
  EXPECT_EQ(read_checkpoint((folder.path / "checkpoint.h5").string()).step, 0);
}

TEST(LiveRun, GivesAPictureOfWhatIsShown) {
  Atoms<2> system;
  Running running(*system.simulation, 100);
  PageReader page(running.window.address());
  page.show(particles);
  auto const reply = page.ask_whole({{"do", "picture"},
                                     {"view", {{"diagnosis", "Particles"}, {"x_range", {0, 4}}, {"y_range", {0, 4}}}},
                                     {"format", "png"},
                                     {"width", 400},
                                     {"height", 300}});
  ASSERT_TRUE(reply.head.contains("ok"));
  auto const bytes = reply.array<char>(reply.head["file"]);
  ASSERT_GT(bytes.size(), 1000U);
  EXPECT_EQ(std::string_view(bytes.data() + 1, 3), "PNG");
  EXPECT_GT(reply.head["box"][2].get<double>(), 100);
}

TEST(LiveRun, EndsByItselfWhenNobodyLooks) {
  Atoms<2> system;
  Running running(*system.simulation, 50, {.play = true});
  running.join();
  EXPECT_EQ(system.simulation->step(), 50);
}

TEST(LiveRun, ABrowserThatNeverReadsHoldsNothingUp) {
  Atoms<2> system;
  Running running(*system.simulation, 1'000'000'000);
  PageReader silent(running.window.address()), page(running.window.address());
  silent.show(particles);
  silent.next();  // and it takes nothing
  page.ask({{"do", "set"}, {"steps_per_frame", 0}});
  page.ask({{"do", "play"}});
  // 333 steps a second at some time: a busy machine may not run it at any. In step with frames it would be 60.
  bool fast = false;
  for (int look = 0; look < 200 && !fast; ++look) {
    auto const since = std::chrono::steady_clock::now();
    auto const before = running.step();
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    auto const went = static_cast<double>(running.step() - before);
    fast = went > 333 * std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
  }
  EXPECT_TRUE(fast) << "in a minute";
  page.ask({{"do", "quit"}});
  running.join();
}

TEST(LiveRun, KeepsThePaceThatIsAskedFor) {
  Atoms<2> system;
  Running running(*system.simulation, 1'000'000'000);
  PageReader page(running.window.address());
  page.show(particles);
  page.ask({{"do", "set"}, {"steps_per_frame", 5}});
  page.ask({{"do", "play"}});
  page.update();
  auto const since = std::chrono::steady_clock::now();
  auto const before = running.step();
  int frames = 0;
  while (running.step() - before < 300) page.update(), ++frames;
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
  // 300 steps are 60 frames: a second at least, whatever the machine does.
  EXPECT_GT(seconds, 0.9);
  EXPECT_LE(frames, 64);
  page.ask({{"do", "quit"}});
  running.join();
}

}  // namespace
}  // namespace boltzmann::live_run_test
