// Two runs of one program leave the same bytes in every file, whenever they run.
#include "tests/bzm/command.hpp"

#include <map>

namespace boltzmann::same_files_test {
namespace {

using namespace boltzmann::test;

std::map<std::string, std::string> files_in(fs::path const& folder) {
  std::map<std::string, std::string> files;
  for (auto const& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files[fs::relative(entry.path(), folder).string()] = text_of(entry.path());
  return files;
}

void run_all(std::string const& folder, std::string const& out) {
  auto const run = [&](std::vector<std::string> words) {
    words.insert(words.end(), {"--quiet", "--set", "output.diagnoses=5", "--set", "output.trajectory=10", "--set",
                               "output.checkpoint=20"});
    auto const outcome = bzm(words, folder);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  };
  run({"run", "copper", "--steps", "40", "--out", out + "/copper", "--set",
       "output.pictures=[{ colour = 'speed' }, { file = 'picture.svg' }, { file = 'picture.pdf' }]"});
  run({"run", "two-stream", "--steps", "40", "--out", out + "/two-stream", "--set", "output.mesh=10"});
  run({"run", "copper", "--steps", "20", "--out", out + "/sweep", "--seeds", "2", "--set",
       "ensembles.0.temperature='300 K'"});
  auto const resumed = bzm({"resume", out + "/copper", "--steps", "20", "--quiet"}, folder);
  ASSERT_EQ(resumed.status, 0) << resumed.err;
}

TEST(SameFiles, ByteForByteSecondsLater) {
  Folder folder;
  run_all(folder.string(), "first");
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  run_all(folder.string(), "second");
  auto const first = files_in(folder / "first"), second = files_in(folder / "second");
  for (auto const* file : {"copper/trajectory.h5", "copper/checkpoint.h5", "copper/diagnoses.csv", "copper/picture.pdf",
                           "two-stream/trajectory.h5", "two-stream/mesh/000000010.vti", "sweep/sweep.csv"})
    EXPECT_TRUE(first.contains(file)) << file;
  ASSERT_EQ(first.size(), second.size());
  for (auto const& [name, bytes] : first) {
    ASSERT_TRUE(second.contains(name)) << name;
    EXPECT_TRUE(bytes == second.at(name)) << name << " differs";
  }
}

}  // namespace
}  // namespace boltzmann::same_files_test
