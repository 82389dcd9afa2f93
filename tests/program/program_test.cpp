// Programs by run_program: what the command line says reaches the run, and what is wrong with it is said in one line.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/files/csv.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/scenario/classes.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <unistd.h>

namespace boltzmann::program_test {
namespace {

namespace fs = std::filesystem;

/// A folder of its own, taken away at the end; without the environment that --resume sets.
class Programs : public testing::Test {
 protected:
  Programs() { fs::remove_all(place_); }
  ~Programs() override {
    fs::remove_all(place_);
    unsetenv("BOLTZMANN_RESUME");
  }

  /// Two bodies on a circle for 40 steps of 0.05; the exit status.
  int run(std::vector<std::string> words, double time = 0, bool ask = true) {
    words.insert(words.begin(), "circle");
    std::vector<char*> argv;
    for (auto& word : words) argv.push_back(word.data());
    return run_program(static_cast<int>(argv.size()), argv.data(), folder(), [&](Program& program) {
      Ensemble<Kepler<2>> bodies("bodies", 2);
      bodies[0].position = {0.5, 0};
      bodies[1].position = {-0.5, 0};
      bodies[0].velocity = {0, std::sqrt(0.5)};
      bodies[1].velocity = {0, -std::sqrt(0.5)};
      PairScheme space(Box(Vector{-1.0, -1.0}, Vector{1.0, 1.0}));
      space.internal(bodies, gravity(1.0));
      Simulation simulation(space, 0.05);
      EXPECT_EQ(simulation.method(bodies), Method::leap_frog);
      if (ask) seed_ = program.seed(7);
      Recording recording = program.recording(simulation);
      recording.diagnoses(1, {"energies"});
      report_ = time > 0 ? program.run_for(recording, time) : program.run(recording, 40);
      end_ = simulation.time();
    });
  }
  std::string folder() const { return (place_ / "circle").string(); }
  std::size_t rows(std::string const& of) const { return read_csv(of + "/diagnoses.csv").column("step").size(); }

  fs::path place_ = fs::temp_directory_path() / ("boltzmann-program-" + std::to_string(::getpid()));
  RunReport report_;
  std::uint64_t seed_ = 0;
  double end_ = 0;
};

TEST_F(Programs, RunAsTheyAreWritten) {
  EXPECT_EQ(run({"--quiet"}), 0);
  EXPECT_EQ(rows(folder()), 41U);
  EXPECT_EQ(seed_, 7U);
  EXPECT_NEAR(end_, 2, 1e-12);
}

TEST_F(Programs, TakeFolderStepsAndSeed) {
  for (auto const& words :
       std::vector<std::vector<std::string>>{{folder() + "-a", "--steps", "10", "--seed=3", "--quiet"},
                                             {"--quiet", "--out", folder() + "-a", "--steps=1e1", "--seed", "3"}}) {
    EXPECT_EQ(run(words), 0);
    EXPECT_EQ(rows(folder() + "-a"), 11U);
    EXPECT_EQ(seed_, 3U);
    EXPECT_FALSE(fs::exists(folder()));
    fs::remove_all(folder() + "-a");
  }
}

// The steps end at the time exactly, none longer than the simulation's.
TEST_F(Programs, RunForATime) {
  EXPECT_EQ(run({"--quiet"}, 0.98), 0);
  EXPECT_EQ(rows(folder()), 21U);
  EXPECT_NEAR(end_, 0.98, 1e-14);
  EXPECT_EQ(run({"--quiet", "--time", "0.31"}, 0.98), 0);
  EXPECT_EQ(rows(folder()), 8U);
  EXPECT_NEAR(end_, 0.31, 1e-14);
  EXPECT_EQ(run({"--quiet", "--time", "0"}), 2);
}

TEST_F(Programs, GoOnToTheSameBits) {
  EXPECT_EQ(run({"--quiet"}), 0);
  fs::rename(folder(), folder() + "-whole");
  EXPECT_EQ(run({"--quiet", "--steps", "13"}), 0);
  EXPECT_EQ(rows(folder()), 14U);
  EXPECT_EQ(run({"--quiet", "--resume", "--threads", "2"}), 0);
  EXPECT_EQ(read_text(folder() + "/diagnoses.csv"), read_text(folder() + "-whole/diagnoses.csv"));
}

TEST_F(Programs, SayWhatIsWrong) {
  struct Wrong {
    std::vector<std::string> words;
    std::string said;
  };
  for (auto const& [words, said] :
       std::vector<Wrong>{{{"--stepps", "3"}, "There are --out, --steps"},
                          {{"--stepps", "3"}, "did you mean '--steps'?"},
                          {{"--steps"}, "--steps needs a value, --steps N"},
                          {{"--steps", "2.5"}, "--steps: a whole number of 0 to 9e+15 is needed, not '2.5'"},
                          {{"--threads", "0"}, "--threads: a whole number of 1 to 4096 is needed, not '0'"},
                          {{"--quiet=1"}, "--quiet has no value"},
                          {{"a", "b"}, "'b': the folder for the results is 'a' already"},
                          {{"--steps", "3", "--time", "4"}, "--steps and --time both set the length"},
                          {{"--play"}, "--play needs --window"},
                          {{"--out", ""}, "the folder for the results has no name"},
                          {{"--time", "3 kg", "--quiet"}, "3 kg"}}) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(run(words), 2) << said;
    std::string const text = testing::internal::GetCapturedStderr();
    EXPECT_NE(text.find(said), std::string::npos) << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    EXPECT_FALSE(fs::exists(folder())) << said;
  }
}

TEST_F(Programs, RefuseASeedThatChangesNothing) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(run({"--seed", "4", "--quiet"}, 0, false), 2);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("--seed: this program uses no seed"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder()));
}

TEST_F(Programs, TellWhatTheyCanBeTold) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(run({"--help"}), 0);
  std::string const text = testing::internal::GetCapturedStdout();
  for (char const* part : {"circle [DIR] [options]; results go to ", "--steps N", "--resume  ", "--window  "})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  EXPECT_FALSE(fs::exists(folder()));
}

/// Two bodies that stand still, for so many steps into each of these folders; `between` is done after each run.
int run_parts(std::vector<std::string> words, std::vector<std::string> const& parts,
              std::function<void(Program&)> const& between) {
  words.insert(words.begin(), "parts");
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  return run_program(static_cast<int>(argv.size()), argv.data(), "", [&](Program& program) {
    for (auto const& part : parts) {
      Ensemble<Newton<1>> bodies("bodies", 2);
      bodies[1].position = {0.5};
      PairScheme space(Box({-1}, {1}));
      space.internal(bodies, Spring{.stiffness = 1, .rest_length = 0.5});
      Simulation simulation(space, 0.05);
      Recording recording = program.recording(simulation, part);
      recording.diagnoses(1, {"energies"});
      program.run(recording, 40);
      between(program);
    }
  });
}

TEST_F(Programs, DoSeveralRunsInFoldersOfTheirOwn) {
  int done = 0;
  auto const count = [&](Program&) { ++done; };
  EXPECT_EQ(run_parts({folder(), "--quiet", "--steps", "7"}, {"a", "b"}, count), 0);
  EXPECT_EQ(done, 2);
  EXPECT_EQ(rows(folder() + "/a"), 8U);
  EXPECT_EQ(rows(folder() + "/b"), 8U);
  // Each goes on with what is left of it; what has not begun begins.
  EXPECT_EQ(run_parts({folder(), "--quiet", "--resume"}, {"a", "b", "c"}, count), 0);
  for (char const* part : {"/a", "/b", "/c"}) EXPECT_EQ(rows(folder() + part), 41U) << part;
  EXPECT_EQ(done, 5);
}

TEST_F(Programs, RefuseTwoRunsInOneFolder) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_parts({folder(), "--quiet"}, {"a", "a"}, [](Program&) {}), 2);
  std::string const text = testing::internal::GetCapturedStderr();
  EXPECT_NE(text.find("two runs of this program go to " + folder() + "/a; name each"), std::string::npos) << text;
}

// A run out of time ends the program with status 4: nothing behind it is done.
TEST_F(Programs, EndWhereARunIsStopped) {
  int done = 0;
  EXPECT_EQ(
      run_parts({folder(), "--quiet", "--hours", "0.000001", "--steps", "9e15"}, {"a", "b"}, [&](Program&) { ++done; }),
      4);
  EXPECT_EQ(done, 0);
  EXPECT_TRUE(fs::exists(folder() + "/a/checkpoint.h5"));
  EXPECT_FALSE(fs::exists(folder() + "/b"));
}

// As scenarios have them.
TEST(UsualMethod, OfAnEnsembleIsThatOfItsClass) {
  int seen = 0;
  for (auto const& entry : particle_classes())
    for (auto const& variant : entry.variants) {
      auto const ensemble = variant.make("some", 1);
      EXPECT_EQ(usual_method(*ensemble), variant.usual_method) << entry.name << " " << variant.dimension;
      EXPECT_EQ(usual_integrator(*ensemble)->method(), variant.usual_method) << entry.name << " " << variant.dimension;
      ++seen;
    }
  EXPECT_GT(seen, 20);
}

TEST(UsualMethod, IsThatOfTheClass) {
  static_assert(usual_method<Newton<3>>() == Method::leap_frog && usual_method<Smooth<2>>() == Method::leap_frog);
  static_assert(usual_method<Tracer<2>>() == Method::rk4 && usual_method<Inviscid<3>>() == Method::rk4);
  static_assert(usual_method<Viscous<2>>() == Method::random_walk);
}

}  // namespace
}  // namespace boltzmann::program_test
