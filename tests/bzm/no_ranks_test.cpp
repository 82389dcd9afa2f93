// --ranks where there is no MPI, and launchers where there is no plug-in: one line, and nothing is run.
#include "tests/bzm/command.hpp"
#include "tests/bzm/environment.hpp"

namespace boltzmann::no_ranks_test {
namespace {

using namespace boltzmann::test;

struct NoRanks : testing::Test {
  Folder folder;
  Environment environment;
  Outcome run(std::vector<std::string> const& words = {}) const {
    std::vector<std::string> all{"run", "three-body", "--steps", "20", "--quiet"};
    all.insert(all.end(), words.begin(), words.end());
    return bzm(all, folder.string());
  }
  void expect_refused(Outcome const& outcome, std::string const& why) const {
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(lines_in(outcome.err), 1U) << outcome.err;
    EXPECT_TRUE(has(outcome.err, why)) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_FALSE(fs::exists(folder / "results"));
  }
};

TEST_F(NoRanks, WithoutALauncher) {
  environment.set("PATH", folder.string().c_str());
  expect_refused(run({"--ranks", "2"}), "there is neither mpirun nor mpiexec on the PATH");
  EXPECT_EQ(run({"--ranks", "1"}).status, 0) << "which needs none";
}

TEST_F(NoRanks, WithoutThePlugin) {
  write_text(folder / "mpirun", "#!/bin/sh\necho mpirun '(Open MPI)' 4.1.4\n");
  fs::permissions(folder / "mpirun", fs::perms::owner_all);
  environment.set("PATH", folder.string().c_str());
  environment.set("BOLTZMANN_MPI", "/nowhere/libboltzmann_mpi.so");
  expect_refused(run({"--ranks", "2"}), "there is no libboltzmann_mpi.so");
  write_text(folder / "broken.so", "no library");
  environment.set("BOLTZMANN_MPI", (folder / "broken.so").c_str());
  expect_refused(run({"--ranks", "2"}), "broken.so' can't be used: ");
  auto const doctor = bzm({"doctor"}, folder.string());
  EXPECT_TRUE(has(doctor.out, "mpirun (Open MPI) 4.1.4")) << doctor.out;
  EXPECT_TRUE(has(doctor.out, "broken.so can't be used: ")) << doctor.out;
}

TEST_F(NoRanks, StartedByALauncher) {
  environment.set("BOLTZMANN_MPI", "/nowhere/libboltzmann_mpi.so");
  for (std::vector<char const*> const& names :
       {std::vector{"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"}, {"PMI_SIZE", "PMI_RANK"}}) {
    environment.set(names[0], "3"), environment.set(names[1], "0");
    expect_refused(run(), "a launcher has started 3 processes of this program, but there is no libboltzmann_mpi.so");
    environment.set(names[1], "1");
    auto const silent = run();
    EXPECT_EQ(silent.status, 2);
    EXPECT_EQ(silent.err + silent.out, "");
    // What is no run is done by the first.
    EXPECT_EQ(bzm({"list", "units"}, folder.string()).out, "");
    environment.set(names[1], "0");
    EXPECT_NE(bzm({"list", "units"}, folder.string()).out, "");
    environment.set(names[0], "1");
    auto const alone = run({"--force"});
    EXPECT_EQ(alone.status, 0) << "one process is no team: " << alone.err;
    fs::remove_all(folder / "results");
    environment.set(names[0], "3"), environment.set("BOLTZMANN_ALONE", "1");
    EXPECT_EQ(run().status, 0) << "as many runs as there are processes, if one wants that";
    fs::remove_all(folder / "results");
    environment.set("BOLTZMANN_ALONE", "");
    environment.set(names[0], ""), environment.set(names[1], "");
  }
}

TEST_F(NoRanks, TheCommandKnowsNoMpi) {
  std::string const command = text_of(bzm_words({})[0]);
  ASSERT_GT(command.size(), 1000000U);
  for (auto const* word : {"libmpi.so", "MPI_Init", "MPI_Comm"}) EXPECT_FALSE(has(command, word)) << word;
}

TEST_F(NoRanks, WordsThatAreWrong) {
  EXPECT_EQ(run({"--ranks", "0"}).status, 2);
  EXPECT_EQ(run({"--hosts", "hosts"}).status, 2) << "without --ranks";
  auto const outcome = run({"--rank", "2"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(has(outcome.err, "did you mean '--ranks'?")) << outcome.err;
}

}  // namespace
}  // namespace boltzmann::no_ranks_test
