// The list of stored runs: what stands below a folder, and nothing else.
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/window/address_file.hpp>
#include <boltzmann/window/run_list.hpp>

#include "../files/temporary_folder.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>
#include <tests/message.hpp>

#include <filesystem>
#include <fstream>

namespace boltzmann::run_list_test {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

void run_program(std::string const& folder, bool frames) {
  Ensemble<Newton<2>> atoms("atoms", 2);
  atoms[1].position = {1., 1.};
  PairScheme scheme(Box(Vector{-5., -5.}, Vector{5., 5.}));
  scheme.internal(atoms, [](auto const& p, auto const& q) { return q.position - p.position; });
  Simulation simulation(scheme, 0.01);
  simulation.integrate(atoms, Method::leap_frog);
  Recording recording(simulation, UnitSystem::reduced(), folder);
  recording.title("Two atoms");
  if (frames) recording.trajectory(5);
  recording.picture({.file = "first.png"});
  run_with_progress(recording, 5, {.quiet = true});
}

TEST(RunList, HasTheRunsBelowAFolder) {
  TemporaryFolder const folder, elsewhere;
  RunList list(folder.path);
  EXPECT_FALSE(list.any());
  run_program(folder / "deep/er/program", true);
  run_program(folder / "silent", false);
  run_program(elsewhere / "hidden", true);
  fs::create_directories(folder / "a/b/c/d/e/too-deep");
  fs::copy(folder / "silent", folder / "a/b/c/d/e/too-deep", fs::copy_options::recursive);
  fs::create_directory_symlink(elsewhere.path, folder / "link");
  fs::create_directory(folder / "scenario");
  std::ofstream(folder / "scenario/scenario.toml")
      << "title = \"By hand\"\ndescription = \"Few\"\n[box]\nlow = [0]\nhigh = [1]\n[run]\nsteps = 7\n[[ensembles]]\n";
  fs::create_directory(folder / "broken");
  std::ofstream(folder / "broken/run.toml") << "title =";
  fs::create_directory(folder / "other");
  EXPECT_TRUE(list.any());

  json const reply = list.runs();
  EXPECT_EQ(reply.at("ok"), true);
  auto const& runs = reply.at("scenarios");
  ASSERT_EQ(runs.size(), 3U) << runs;
  EXPECT_EQ(runs[0].at("name"), "deep/er/program");
  EXPECT_EQ(runs[0].at("title"), "Two atoms");
  EXPECT_EQ(runs[0].at("dimension"), 2);
  EXPECT_EQ(runs[1].at("name"), "scenario");
  EXPECT_EQ(runs[1].at("title"), "By hand");
  EXPECT_EQ(runs[1].at("description"), "Few");
  EXPECT_EQ(runs[1].at("steps"), 7);
  EXPECT_TRUE(runs[1].at("picture").is_null());
  EXPECT_EQ(runs[2].at("name"), "silent");

  auto const picture = list.picture(runs[0].at("picture").get<std::string>());
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->type, "image/png");
  std::ifstream file(folder / "deep/er/program/first.png", std::ios::binary);
  EXPECT_EQ(*picture->content, std::string(std::istreambuf_iterator<char>(file), {}));
  for (char const* path : {"/run/2.png", "/run/-1.png", "/run/0.png/", "/run/.png", "/run/00x.png", "/run/../0.png",
                           "/gallery/0.png", "/run/99999999999999999999.png"})
    EXPECT_FALSE(list.picture(path)) << path;

  EXPECT_EQ(list.find("deep/er/program"), folder / "deep/er/program");
  EXPECT_NE(message([&] { list.find("silent"); }).find("no trajectory.h5"), std::string::npos);
  EXPECT_NE(message([&] { list.find("silen"); }).find("did you mean 'silent'"), std::string::npos);
  for (char const* name : {"link/hidden", "../", "", "/etc", "a/b/c/d/e/too-deep"})
    EXPECT_NE(message([&] { list.find(name); }).find("there is no run"), std::string::npos) << name;
}

// Standard output that is no terminal may be read by others.
TEST(Announcement, GivesTheAddressToItsOwnerOnly) {
  std::string const address = "http://127.0.0.1:1/?token=secret";
  testing::internal::CaptureStdout();
  std::string path;
  {
    Announcement const announcement("window", address);
    std::string const said = testing::internal::GetCapturedStdout();
    EXPECT_EQ(said.find("secret"), std::string::npos) << said;
    std::string const start = "window: its address is in ";
    ASSERT_TRUE(said.starts_with(start)) << said;
    path = said.substr(start.size(), said.size() - start.size() - 1);
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    EXPECT_EQ(line, address);
    EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  }
  EXPECT_FALSE(fs::exists(path));
  // On a terminal it is printed.
  int const terminal = posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0) GTEST_FAIL() << "no terminal";
  ASSERT_EQ(grantpt(terminal), 0);
  ASSERT_EQ(unlockpt(terminal), 0);
  int const screen = open(ptsname(terminal), O_RDWR | O_NOCTTY), before = dup(STDOUT_FILENO);
  std::fflush(stdout);
  dup2(screen, STDOUT_FILENO);
  { Announcement const announcement("window", address); }
  dup2(before, STDOUT_FILENO);
  std::string text(200, '\0');
  text.resize(static_cast<std::size_t>(read(terminal, text.data(), text.size())));
  EXPECT_EQ(text, "window: " + address + "\r\n");
  close(screen), close(before), close(terminal);
}

}  // namespace
}  // namespace boltzmann::run_list_test
