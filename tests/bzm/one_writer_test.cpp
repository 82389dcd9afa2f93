// A folder of results has one writer: whoever comes second says so, and the run that is going on loses nothing.
#include "tests/bzm/command.hpp"

#include <boltzmann/files/folder_lock.hpp>

#include <sstream>

namespace boltzmann::one_writer_test {
namespace {

using namespace boltzmann::test;

constexpr char const* refusal = "another process is writing into '";
std::vector<std::string> const long_run{"run",     "three-body", "--out", "three",
                                        "--steps", "400000",     "--set", "output.diagnoses=100"};

/// bzm, while a run goes on in "three".
void expect_refused(Process& going, std::vector<std::string> const& words, std::string const& folder) {
  ASSERT_TRUE(going.running());
  auto const second = bzm(words, folder);
  EXPECT_EQ(second.status, 2) << second.err;
  EXPECT_TRUE(second.err.starts_with(refusal)) << second.err;
  EXPECT_EQ(lines_in(second.err), 1U) << second.err;
}

TEST(OneWriter, NobodyElseResumesOrReplacesARunThatIsGoingOn) {
  Folder folder;
  Process going(bzm_words(long_run), folder.string());
  ASSERT_TRUE(going.wait_until([&] { return lines_in(text_of(folder / "three/diagnoses.csv")) > 20; }));
  expect_refused(going, {"resume", "three"}, folder.string());
  expect_refused(going, {"resume", "./three/", "--steps", "10"}, folder.string());
  expect_refused(going, {"run", "three-body", "--out", "three", "--steps", "10", "--force"}, folder.string());
  expect_refused(going, {"run", "three-body", "--out", "three", "--steps", "10", "--seeds", "2", "--force"},
                 folder.string());
  going.signal(SIGINT);
  EXPECT_EQ(going.wait().status, 130);
  // It has lost no row, and now another may go on.
  std::size_t const rows = lines_in(text_of(folder / "three/diagnoses.csv"));
  auto const resumed = bzm({"resume", "three", "--steps", "100", "--quiet"}, folder.string());
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  std::string const table = text_of(folder / "three/diagnoses.csv");
  EXPECT_EQ(lines_in(table), rows + 1);
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);
  for (long step = 0; std::getline(lines, line); step += 100) ASSERT_EQ(std::stol(line), step) << "no row is missing";
}

TEST(OneWriter, NorASweep) {
  Folder folder;
  std::vector<std::string> const sweep{"run",     "three-body", "--out",  "three",
                                       "--steps", "200000",     "--vary", "run.seed=[1,2,3]"};
  Process going(bzm_words(sweep), folder.string());
  ASSERT_TRUE(going.wait_until([&] { return fs::exists(folder / "three/sweep.toml"); }));
  expect_refused(going, {"resume", "three"}, folder.string());
  expect_refused(going, {"run", "three-body", "--out", "three", "--steps", "10", "--force"}, folder.string());
  EXPECT_TRUE(fs::exists(folder / "three/sweep.toml"));
  going.signal(SIGKILL);
  going.wait();
  EXPECT_EQ(bzm({"run", "three-body", "--out", "three", "--steps", "10", "--force"}, folder.string()).status, 0)
      << "a killed process holds nothing";
}

TEST(OneWriter, LeavesNothingAndMayAskTwice) {
  Folder folder;
  {
    FolderLock const one = lock_folder(folder.string()), again = lock_folder(folder.string() + "/.");
    EXPECT_TRUE(one && one == again);
    EXPECT_TRUE(fs::is_empty(folder.string()));
  }
  EXPECT_TRUE(lock_folder(folder.string()));
  EXPECT_FALSE(lock_folder(folder.string() + "/nowhere"));
}

}  // namespace
}  // namespace boltzmann::one_writer_test
