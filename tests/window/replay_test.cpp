// A stored run on a page: every frame is what the run was then, and one that is still being written grows.
#include <gtest/gtest.h>
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/window/address_file.hpp>
#include <boltzmann/window/clients.hpp>
#include <boltzmann/window/replay.hpp>

#include <unistd.h>
#include <cstring>

#include <filesystem>
#include <fstream>
#include <memory>
#include <tests/window/reader.hpp>
#include <thread>

namespace boltzmann::replay_test {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

// Three balls on springs in space, recorded every 10 steps.
struct Balls {
  Ensemble<Newton<3>> balls{"balls", 3};
  PairScheme scheme{Box(Vector{-5.0, -5.0, -5.0}, Vector{5.0, 5.0, 5.0}, Boundary::open)};
  Simulation simulation{scheme, 0.01};

  Balls() {
    for (int i = 0; i < 3; ++i) balls[static_cast<std::size_t>(i)].position = {1.0 * i, 0.5 * i * i, -0.3 * i};
    scheme.internal(balls, [](auto const& p, auto const& q) { return q.position - p.position; });
    simulation.integrate(balls, Method::leap_frog);
  }
};

class ReplayTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    recording_ = std::make_unique<Recording>(run_.simulation, UnitSystem::reduced(), folder_,
                                             RecordingOptions{.overwrite = true});
    recording_->trajectory(10);
    recording_->diagnoses(5, {"temperature"});
    run_with_progress(*recording_, 200, {.quiet = true});
  }
  void TearDown() override {
    recording_.reset();
    fs::remove_all(folder_);
  }

  // A replay in a thread of its own.
  struct Shown {
    Balls stored;
    Views views;
    Clients clients;
    Replay replay;
    std::thread thread;
    explicit Shown(std::string const& folder)
        : views(stored.simulation, UnitSystem::reduced(), "balls", folder), replay(views, "balls", "") {
      stored.simulation.check();
      views.add_usual();
      thread = std::thread([this] { replay.run(clients); });
    }
    ~Shown() { thread.join(); }
  };

  std::string const folder_ = (fs::temp_directory_path() / ("replay_test_" + std::to_string(getpid()))).string();
  Balls run_;
  std::unique_ptr<Recording> recording_;
};

// The positions that an update shows, particle after particle.
std::vector<double> places(WireMessage const& update) {
  for (auto const& view : update.head["views"])
    for (auto const& mark : view["canvas"]["marks"])
      if (mark["kind"] == "cloud") {
        auto const positions = update.array<float>(mark["positions"]);
        std::vector<double> all;
        for (std::size_t k = 0; k < positions.size(); ++k)
          all.push_back(mark["origin"][k % 3].get<double>() + mark["scale"][k % 3].get<double>() * positions[k]);
        return all;
      }
  return {};
}

json const particles = json::array({{{"id", 1}, {"diagnosis", "Particles"}}});

TEST_F(ReplayTest, ShowsEachFrameAsItWas) {
  Shown shown(folder_);
  PageReader page(shown.clients.address());
  EXPECT_EQ(page.hello["kind"], "replay");
  EXPECT_EQ(page.hello["planned"], 200);
  EXPECT_NE(page.hello["can"]["step_size"], "");
  page.show(particles);
  TrajectoryReader const stored(folder_ + "/trajectory.h5");
  ASSERT_EQ(stored.frames(), 21U);
  for (std::size_t const frame : {5U, 20U, 0U, 13U}) {
    EXPECT_TRUE(page.ask({{"do", "seek"}, {"frame", frame}}).contains("ok"));
    auto const update = page.until([&](json const& u) { return u["frame"] == frame; });
    EXPECT_EQ(update.head["frames"], 21);
    EXPECT_EQ(update.head["step"], 10 * frame);
    EXPECT_NEAR(update.head["time_number"].get<double>(), 0.1 * static_cast<double>(frame), 1e-12);
    auto const found = places(update), wanted = stored.read(frame, "balls", "position");
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], wanted[k], 2e-6) << frame;
  }
  page.ask({{"do", "quit"}});
}

TEST_F(ReplayTest, PlaysForwardsAndBackwards) {
  Shown shown(folder_);
  PageReader page(shown.clients.address());
  page.show(particles);
  page.ask({{"do", "set"}, {"steps_per_frame", 200}});
  page.ask({{"do", "play"}});
  EXPECT_EQ(page.until_state("done").head["frame"], 20);
  page.ask({{"do", "step"}, {"steps", -3}});
  page.until([](json const& u) { return u["frame"] == 17; });
  page.ask({{"do", "rewind"}});
  page.until([](json const& u) { return u["frame"] == 0 && u["state"] == "paused"; });
  EXPECT_TRUE(page.ask({{"do", "rewind"}}).contains("error"));
  page.ask({{"do", "step"}});
  page.until([](json const& u) { return u["frame"] == 1; });
  page.ask({{"do", "step"}, {"steps", -7}});
  page.until([](json const& u) { return u["frame"] == 0; });
  page.ask({{"do", "quit"}});
}

TEST_F(ReplayTest, RefusesWhatAStoredRunCantDo) {
  Shown shown(folder_);
  PageReader page(shown.clients.address());
  page.show(particles);
  for (json const& wrong : {json{{"do", "checkpoint"}}, json{{"do", "set"}, {"step_size", 1}}, json{{"do", "seek"}},
                            json{{"do", "seek"}, {"frame", 21}}, json{{"do", "seek"}, {"frame", "five"}},
                            json{{"do", "set"}, {"steps_per_frame", 0}}, json{{"do", "scenarios"}}})
    EXPECT_TRUE(page.ask(wrong).contains("error")) << wrong;
  page.ask({{"do", "quit"}});
}

TEST_F(ReplayTest, HasTheTableOfTheRun) {
  Shown shown(folder_);
  PageReader page(shown.clients.address());
  page.show(particles);
  auto const update = page.until([](json const& u) { return u.contains("table"); });
  EXPECT_EQ(update.head["table"]["rows"], 41);
  auto const values = update.array<double>(update.head["table"]["values"]);
  std::size_t const width = values.size() / 41;
  EXPECT_EQ(values[40 * width], 200);
  EXPECT_NEAR(values[40 * width + 1], 2, 1e-12);
  page.ask({{"do", "quit"}});
}

TEST_F(ReplayTest, GrowsWhileTheRunGoesOn) {
  std::string const other = folder_ + "-growing";
  Balls growing;
  {
    Recording recording(growing.simulation, UnitSystem::reduced(), other, {.overwrite = true});
    recording.trajectory(10);
    growing.simulation.run(30);
    Shown shown(other);
    PageReader page(shown.clients.address());
    page.show(particles);
    EXPECT_EQ(page.update().head["frames"], 4);
    growing.simulation.run(30);
    page.until([](json const& u) { return u["frames"] == 7; });
    page.ask({{"do", "seek"}, {"frame", 6}});
    EXPECT_EQ(page.until([](json const& u) { return u["frame"] == 6; }).head["step"], 60);
    page.ask({{"do", "quit"}});
  }
  fs::remove_all(other);
}

// A frame that a failing disk has left half written: those before it play, and then a line says which it is.
TEST_F(ReplayTest, StopsBeforeADamagedFrame) {
  {
    std::string const path = folder_ + "/trajectory.h5";
    double const times[] = {190 * 0.01, 200 * 0.01};  // of the last two of 21 frames
    std::string bytes = read_text(path), both(sizeof times, '\0');
    std::memcpy(both.data(), times, sizeof times);
    auto const at = bytes.find(both);
    ASSERT_NE(at, std::string::npos);
    TextFile(path, TextFile::Mode::replace).write(bytes.replace(at + 8, 8, 8, '\0'));
  }
  Shown shown(folder_);
  PageReader page(shown.clients.address());
  EXPECT_NE(page.ask({{"do", "seek"}, {"frame", 20}})["error"].get<std::string>().find("frame 20 is damaged"),
            std::string::npos);
  EXPECT_FALSE(page.ask({{"do", "seek"}, {"frame", 18}}).contains("error"));
  page.ask({{"do", "play"}});
  auto const stopped = page.until([](json const& u) { return u["message"] != ""; });
  EXPECT_EQ(stopped.head["frame"], 19);
  EXPECT_EQ(stopped.head["state"], "paused");
  EXPECT_NE(stopped.head["message"].get<std::string>().find("frame 20 is damaged"), std::string::npos);
  page.ask({{"do", "quit"}});
}

TEST_F(ReplayTest, NeedsFrames) {
  Balls stored;
  Views nowhere(stored.simulation, UnitSystem::reduced(), "", folder_ + "-missing");
  EXPECT_THROW(Replay(nowhere, "", ""), Error);
}

TEST(AddressFile, TellsOfAWindowOnlyWhileItLives) {
  std::string const folder = (fs::temp_directory_path() / ("address_file_" + std::to_string(getpid()))).string();
  EXPECT_FALSE(living_window(folder));
  {
    Clients const clients;
    AddressFile const file(folder, clients.address());
    EXPECT_EQ(living_window(folder), clients.address());
    EXPECT_EQ(fs::status(folder + "/window.txt").permissions(), fs::perms::owner_read | fs::perms::owner_write);
  }
  EXPECT_FALSE(fs::exists(folder + "/window.txt"));
  for (char const* text : {"", "http://127.0.0.1:1/?token=x\n", "http://example.org/\n", "http://127.0.0.1:99999/\n",
                           "http://127.0.0.1:80/?token=x\x1b[2J\n", "http://127.0.0.1:80@evil.example/?token=x\n"}) {
    std::ofstream(folder + "/window.txt") << text;
    EXPECT_FALSE(living_window(folder)) << text;
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace boltzmann::replay_test
