// A stored run as one HTML text: its frames are those of the trajectory, evenly chosen; its size is kept; and nothing of
// the run's words gets out of its place in the page.
#include <gtest/gtest.h>
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/window/page.hpp>
#include <boltzmann/window/replay_page.hpp>
#include <boltzmann/window/stored_replay.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <tests/window/reader.hpp>
#include <vector>

namespace boltzmann::replay_page_test {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

// RFC 4648, section 4.
std::vector<char> from_base64(std::string const& text) {
  static std::string const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  EXPECT_EQ(text.size() % 4, 0U);
  std::vector<char> bytes;
  for (std::size_t k = 0; k + 4 <= text.size(); k += 4) {
    unsigned four = 0;
    int padding = 0;
    for (std::size_t j = k; j < k + 4; ++j) {
      padding += text[j] == '=' ? 1 : 0;
      auto const digit = text[j] == '=' ? 0 : digits.find(text[j]);
      EXPECT_NE(digit, std::string::npos) << text[j];
      four = four << 6 | static_cast<unsigned>(digit);
    }
    for (int j = 0; j < 3 - padding; ++j) bytes.push_back(static_cast<char>(four >> (16 - 8 * j) & 255U));
  }
  return bytes;
}

/// What stands in the page, as the page itself finds it.
json recording_in(std::string const& html) {
  std::string const start = "<script type=\"application/json\" id=\"recording\">";
  auto const at = html.find(start);
  EXPECT_NE(at, std::string::npos);
  auto const first = at + start.size();
  return json::parse(html.substr(first, html.find("</script>", first) - first));
}

WireMessage frame_of(json const& recording, std::size_t frame) {
  return decode(from_base64(recording["updates"][frame].get<std::string>()));
}

json cloud_of(WireMessage const& update) {
  for (auto const& mark : update.head["views"][0]["canvas"]["marks"])
    if (mark["kind"] == "cloud") return mark;
  return {};
}

std::size_t count_of(std::string const& text, std::string const& what) {
  std::size_t count = 0;
  for (auto at = text.find(what); at != text.npos; at = text.find(what, at + 1)) ++count;
  return count;
}

std::string error_of(std::string const& folder, ReplayPageOptions const& options = {}) {
  try {
    replay_page(folder, options);
  } catch (Error const& error) {
    return error.what();
  }
  return "";
}

class ReplayPageTest : public testing::Test {
 protected:
  // Free particles on a line through a square, recorded every 10 steps.
  void record(std::size_t particles, std::uint64_t steps, bool trajectory = true, std::string const& title = "") {
    fs::remove_all(folder_);
    Ensemble<Newton<2>> dust("dust", particles);
    for (std::size_t k = 0; k < particles; ++k) {
      double const place = (static_cast<double>(k) + 0.5) / static_cast<double>(particles);
      dust[k].position = {place, place * place};
      dust[k].velocity = {0.1 * place, -0.2};
    }
    PairScheme scheme(Box(Vector{0.0, 0.0}, Vector{1.0, 1.0}, Boundary::open));
    scheme.add(dust);
    Simulation simulation(scheme, 0.01);
    simulation.integrate(dust, Method::leap_frog);
    Recording recording(simulation, UnitSystem::reduced(), folder_, {.overwrite = true});
    if (!title.empty()) recording.title(title);
    if (trajectory) recording.trajectory(10);
    recording.diagnoses(10, {"temperature"});
    run_with_progress(recording, steps, {.quiet = true});
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string const folder_ = (fs::temp_directory_path() / ("replay_page_" + std::to_string(getpid()))).string();
};

TEST_F(ReplayPageTest, HasEachFrameAsItWas) {
  record(50, 200);
  auto const page = replay_page(folder_);
  EXPECT_EQ(page.frames, 21U);
  EXPECT_EQ(page.stored_frames, 21U);
  EXPECT_EQ(page.message, "");
  auto const recording = recording_in(page.html);
  EXPECT_EQ(recording["hello"]["kind"], "replay");
  EXPECT_EQ(recording["hello"]["recording"], true);
  EXPECT_EQ(recording["hello"]["folder"], "");
  EXPECT_EQ(recording["views"][0]["diagnosis"], "Particles");
  TrajectoryReader const stored(folder_ + "/trajectory.h5");
  for (std::size_t const frame : {0U, 7U, 20U}) {
    auto const update = frame_of(recording, frame);
    EXPECT_EQ(update.head["step"], 10 * frame);
    EXPECT_NEAR(update.head["time_number"].get<double>(), 0.1 * static_cast<double>(frame), 1e-12);
    auto const cloud = cloud_of(update);
    auto const places = update.array<float>(cloud["positions"]);
    auto const wanted = stored.read(frame, "dust", "position");
    ASSERT_EQ(places.size(), wanted.size());
    for (std::size_t k = 0; k < places.size(); ++k)
      EXPECT_NEAR(cloud["origin"][k % 2].get<double>() + cloud["scale"][k % 2].get<double>() * places[k], wanted[k],
                  1e-6);
  }
  auto const table = decode(from_base64(recording["table"].get<std::string>()));
  EXPECT_EQ(table.head["table"]["rows"], 21);
  EXPECT_EQ(table.array<double>(table.head["table"]["values"])[0], 0);
}

TEST_F(ReplayPageTest, ChoosesFramesEvenly) {
  record(10, 200);
  auto const steps_of = [&](std::size_t frames) {
    auto const recording = recording_in(replay_page(folder_, {.frames = frames}).html);
    std::vector<int> steps;
    for (std::size_t k = 0; k < recording["updates"].size(); ++k) steps.push_back(frame_of(recording, k).head["step"]);
    return steps;
  };
  EXPECT_EQ(steps_of(5), (std::vector{0, 50, 100, 150, 200}));
  EXPECT_EQ(steps_of(2), (std::vector{0, 200}));
  EXPECT_EQ(steps_of(1), (std::vector{200}));
  auto const many = steps_of(9);  // 20 intervals among 8: two or three each
  ASSERT_EQ(many.size(), 9U);
  EXPECT_EQ(many.front(), 0);
  EXPECT_EQ(many.back(), 200);
  for (std::size_t k = 1; k < many.size(); ++k) {
    EXPECT_GE(many[k] - many[k - 1], 20);
    EXPECT_LE(many[k] - many[k - 1], 30);
  }
  EXPECT_NE(replay_page(folder_, {.frames = 5}).message.find("5 of 21 frames"), std::string::npos);
}

// 30,000 particles take 240 kB a frame, 320 kB as base64.
TEST_F(ReplayPageTest, KeepsItsSize) {
  record(30'000, 300);
  for (double const megabytes : {0.4, 1.0, 3.0, 5.0}) {
    auto const page = replay_page(folder_, {.megabytes = megabytes});
    EXPECT_LE(static_cast<double>(page.html.size()), megabytes * 1e6);
    EXPECT_GT(static_cast<double>(page.html.size()), 0.6 * megabytes * 1e6);
    auto const recording = recording_in(page.html);
    EXPECT_EQ(recording["updates"].size(), page.frames);
    EXPECT_EQ(recording["message"], page.message);
    auto const cloud = cloud_of(frame_of(recording, 0));
    auto const stride = cloud["stride"].get<int>();
    EXPECT_GE(cloud["count"], 1000 / stride);
    bool const fewer = page.message.find(fmt::format("{} of 31 frames", page.frames)) != std::string::npos;
    EXPECT_EQ(fewer, page.frames < 31) << page.message;
    EXPECT_NE(page.message.find(fmt::format("one of {} particles", stride)), std::string::npos) << page.message;
  }
  // Fewer particles first, as long as there are ten thousand.
  auto const page = replay_page(folder_, {.megabytes = 6});
  EXPECT_EQ(page.frames, 31U);
  EXPECT_GE(cloud_of(frame_of(recording_in(page.html), 30))["count"], 10'000);
  // All of it has room.
  EXPECT_EQ(replay_page(folder_, {.megabytes = 15}).message, "");
}

TEST_F(ReplayPageTest, ShowsTheViewsThatAreNamed) {
  record(100, 100);
  auto const page = replay_page(folder_, {.views = {"Histogram", "Phase space"}});
  auto const recording = recording_in(page.html);
  ASSERT_EQ(recording["views"].size(), 2U);
  EXPECT_EQ(recording["views"][0]["diagnosis"], "Histogram");
  std::vector<std::string> names;
  for (auto const& shown : recording["hello"]["diagnoses"]) names.push_back(shown["name"]);
  EXPECT_EQ(names, (std::vector<std::string>{"Histogram", "Phase space", "Measured"}));
  auto const update = frame_of(recording, 3);
  EXPECT_EQ(update.head["views"].size(), 2U);
  EXPECT_TRUE(update.head["views"][1].contains("canvas"));
}

TEST_F(ReplayPageTest, NothingGetsOutOfItsPlace) {
  record(10, 20, true, "</script><script>alert(1)</script><!-- & <b>");
  auto const page = replay_page(folder_);
  EXPECT_EQ(count_of(page.html, "<script"), 2U);  // the page's own, and the recording
  EXPECT_EQ(count_of(page.html, "</script>"), 2U);
  EXPECT_EQ(count_of(page.html, "<!--"), count_of(std::string(page_html()), "<!--"));
  EXPECT_EQ(recording_in(page.html)["hello"]["title"], "</script><script>alert(1)</script><!-- & <b>");
  EXPECT_NE(page.html.find("default-src 'none'"), std::string::npos);
}

TEST_F(ReplayPageTest, RefusesInOneLine) {
  record(10, 20);
  EXPECT_NE(error_of(folder_, {.views = {"Partcles"}}).find("did you mean 'Particles'?"), std::string::npos);
  EXPECT_NE(error_of(folder_, {.frames = 0}).find("one frame or more"), std::string::npos);
  for (double const wrong : {0.0, -1.0, std::nan("")})
    EXPECT_NE(error_of(folder_, {.megabytes = wrong}).find("megabytes"), std::string::npos);
  EXPECT_NE(error_of(folder_, {.megabytes = 0.01}).find("has no room"), std::string::npos);
  EXPECT_NE(error_of(folder_, {.views = std::vector<std::string>(9, "Particles")}).find("8 views"), std::string::npos);
  EXPECT_NE(error_of(folder_ + "-missing").find("there is no folder"), std::string::npos);
  record(10, 20, false);
  std::string const without = error_of(folder_);
  EXPECT_NE(without.find("has no trajectory.h5 to show"), std::string::npos);
  EXPECT_EQ(without.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace boltzmann::replay_page_test
