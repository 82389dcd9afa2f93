// Trajectories of runs that are killed, stopped or out of disk: every frame that was written can be read.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/newton.hpp>
#include <tests/cpu_time.hpp>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <random>

#include "../small_disk.hpp"
#include "temporary_folder.hpp"

namespace boltzmann::trajectory_crash_test {
namespace {

// Position and velocity of particle i at a step.
double position_at(std::int64_t step, std::size_t i) {
  return static_cast<double>(step) + 1e-4 * static_cast<double>(i);
}

struct Example {
  Ensemble<Newton<3>> ions, dust;
  explicit Example(std::size_t size) : ions("ions", size), dust("dust", 2) {}

  void write(Trajectory& file, std::int64_t step) {
    for (auto* ensemble : {&ions, &dust})
      for (std::size_t i = 0; i < ensemble->size(); ++i) {
        (*ensemble)[i].position = {position_at(step, i), 1, 2};
        (*ensemble)[i].velocity = {3, 4, -position_at(step, i)};
      }
    AnyEnsemble const* const list[] = {&ions, &dust};
    file.write(step, 0.5 * static_cast<double>(step), list, {.periodic = {true, true, true}});
  }
};

// Reads every frame and compares it with what was written.
std::size_t good_frames(std::string const& path, std::size_t size) {
  TrajectoryReader const reader(path);
  std::size_t const stride = reader.frames() / 200 + 1;  // not all of a long file, but always the last ones
  for (std::size_t frame = 0; frame < reader.frames(); frame += frame + 50 < reader.frames() ? stride : 1) {
    auto const step = static_cast<std::int64_t>(frame);
    EXPECT_EQ(reader.steps()[frame], step);
    EXPECT_EQ(reader.times()[frame], 0.5 * static_cast<double>(step));
    for (char const* name : {"ions", "dust"}) {
      auto const position = reader.read(frame, name, "position"), velocity = reader.read(frame, name, "velocity");
      EXPECT_EQ(position.size(), 3 * (name[0] == 'i' ? size : 2));
      for (std::size_t i = 0; 3 * i < position.size(); ++i)
        if (position[3 * i] != position_at(step, i) || velocity[3 * i + 2] != -position_at(step, i)) {
          ADD_FAILURE() << "frame " << frame << " particle " << i << ": " << position[3 * i] << " "
                        << velocity[3 * i + 2];
          return 0;
        }
    }
    if (::testing::Test::HasFailure()) return 0;
  }
  return reader.frames();
}

// A child that writes frames without end and tells, by a pipe, of each one written.
struct Writer {
  pid_t child = -1;
  int pipe_end = -1;
  std::int64_t told = -1;

  Writer(std::string const& path, std::size_t size, std::int64_t from) {
    int ends[2];
    if (pipe(ends) != 0) throw Error("no pipe");
    child = fork();
    if (child == 0) {
      ::close(ends[0]);
      Example run(size);
      Trajectory file = from == 0 ? Trajectory(path) : Trajectory::append_to(path, from - 1);
      file.mark();
      for (std::int64_t step = from;; ++step) {
        run.write(file, step);
        if (::write(ends[1], &step, sizeof step) != static_cast<ssize_t>(sizeof step)) _exit(1);
      }
    }
    ::close(ends[1]);
    pipe_end = ends[0];
  }
  ~Writer() {
    if (child > 0) {
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
    }
    ::close(pipe_end);
  }
  void wait_for(std::int64_t step) {
    while (told < step && ::read(pipe_end, &told, sizeof told) == static_cast<ssize_t>(sizeof told)) {
    }
  }
  // Ends the child at once, in whatever it is doing.
  void kill_now() {
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    child = -1;
    while (::read(pipe_end, &told, sizeof told) == static_cast<ssize_t>(sizeof told)) {
    }
  }
};

TEST(TrajectoryCrash, KilledRunsLeaveEveryFrameAndGoOn) {
  TemporaryFolder const folder;
  std::mt19937 random(test_seed(3));
  for (int trial = 0; trial < 40; ++trial) {
    std::size_t const size = trial % 3 == 0 ? 3000 : trial % 3 == 1 ? 40 : 1;
    std::string const path = folder / "t.h5";
    std::int64_t from = 0;
    for (int resumption = 0; resumption < 2; ++resumption) {
      Writer writer(path, size, from);
      writer.wait_for(from + static_cast<std::int64_t>(random() % 20));
      usleep(random() % 4000);
      writer.kill_now();
      std::size_t const frames = good_frames(path, size);
      ASSERT_FALSE(HasFailure()) << "trial " << trial;
      ASSERT_GE(static_cast<std::int64_t>(frames), writer.told + 1) << "trial " << trial;
      ASSERT_LE(static_cast<std::int64_t>(frames), writer.told + 2) << "trial " << trial;
      from = static_cast<std::int64_t>(frames) - static_cast<std::int64_t>(random() % 3);
      from = std::max<std::int64_t>(from, 1);
    }
  }
}

// Wherever it is killed, also while it writes what it may have to be taken back to.
TEST(TrajectoryCrash, AMarkedFileIsTakenBackToTheByteAfterAKill) {
  TemporaryFolder const folder;
  std::mt19937 random(test_seed(6));
  for (std::size_t const size : {40, 3000}) {
    auto tell = [run = Example(size)](Trajectory file, std::int64_t from, std::int64_t to) mutable {
      for (std::int64_t step = from; step < to; ++step) run.write(file, step);
      file.close();
    };
    std::string const whole = folder / "whole.h5", path = folder / "t.h5";
    tell(Trajectory(whole), 0, 60);
    for (int trial = 0; trial < 15; ++trial) {
      auto const mark = static_cast<std::int64_t>(1 + random() % 40);
      tell(Trajectory(path), 0, mark);
      Writer writer(path, size, mark);
      writer.wait_for(mark + static_cast<std::int64_t>(random() % 8));
      usleep(random() % 3000);
      writer.kill_now();
      tell(Trajectory::append_to(path, mark - 1), mark, 60);
      ASSERT_TRUE(read_text(path) == read_text(whole)) << "trial " << trial << ", marked at " << mark;
    }
  }
}

TEST(TrajectoryCrash, ReadersSeeAWholeFileWheneverTheRunPauses) {
  TemporaryFolder const folder;
  std::mt19937 random(test_seed(4));
  std::string const path = folder / "t.h5";
  Writer writer(path, 500, 0);
  writer.wait_for(0);
  for (int trial = 0; trial < 60; ++trial) {
    usleep(random() % 3000);
    kill(writer.child, SIGSTOP);
    int status = 0;
    waitpid(writer.child, &status, WUNTRACED);
    EXPECT_GE(good_frames(path, 500), 1U);
    ASSERT_FALSE(HasFailure()) << "trial " << trial;
    kill(writer.child, SIGCONT);
  }
}

TEST(TrajectoryCrash, FullDiskIsOneErrorAndKeepsTheFramesBefore) {
  TemporaryFolder const folder;
  for (std::size_t const size : {2, 300, 5000}) {
    test::SmallDisk const disk(folder.path, "1m");
    ASSERT_TRUE(disk.mounted()) << test::SmallDisk::refused;
    std::string const path = folder / "t.h5";
    std::size_t written = 0;
    std::string text, again;
    std::size_t readable = 0;
    {
      Example run(size);
      Trajectory file(path);
      text = message([&] {
        for (; written < 100000; ++written) run.write(file, static_cast<std::int64_t>(written));
      });
      again = message([&] { run.write(file, 1); });
      EXPECT_EQ(file.frames(), written);
    }
    std::string const reading = message([&] { readable = good_frames(path, size); });
    EXPECT_TRUE(text.starts_with(path + ": ")) << text;
    EXPECT_NE(text.find("No space left on device"), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos);
    EXPECT_NE(again.find("the trajectory has ended"), std::string::npos) << again;
    EXPECT_EQ(reading, "no error");
    EXPECT_GE(readable, written);
    EXPECT_LE(readable, written + 1);
    EXPECT_GE(written, 2U);
  }
}

TEST(TrajectoryCrash, FailureAtAnyByteIsAnErrorAndACleanExit) {
  TemporaryFolder const folder;
  std::string const path = folder / "t.h5";
  bool some_frames = false;
  for (rlim_t limit = 0; limit < 600000; limit += limit < 20000 ? 977 : 9973) {
    pid_t const child = fork();
    if (child == 0) {
      signal(SIGXFSZ, SIG_IGN);
      rlimit const most{limit, limit};
      setrlimit(RLIMIT_FSIZE, &most);
      std::string const text = message([&] {
        Example run(100);
        Trajectory file(path);
        for (std::int64_t step = 0; step < 100000; ++step) run.write(file, step);
      });
      bool const good = text.find("File too large") != std::string::npos && text.find('\n') == std::string::npos;
      std::exit(good ? 0 : 1);  // exit, not _exit: HDF5 must be able to end
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status)) << limit << " signal " << WTERMSIG(status);
    EXPECT_EQ(WEXITSTATUS(status), 0) << limit;
    std::size_t frames = 0;
    std::string const text = message([&] { frames = good_frames(path, 100); });
    EXPECT_TRUE(text == "no error" || !some_frames) << limit << " " << text;
    some_frames = some_frames || frames > 0;
    // The empty tables take 430 kB, a frame of 102 particles of 7 doubles 6 kB and what rounding up to blocks adds.
    EXPECT_GE(frames * 6000 + 500000, limit);
  }
  EXPECT_TRUE(some_frames);
}

TEST(TrajectoryCrash, ManySmallFramesAreCheap) {
  TemporaryFolder const folder;
  Example run(2);
  Trajectory file(folder / "t.h5");
  double const start = cpu_seconds();
  for (std::int64_t step = 0; step < 2000; ++step) run.write(file, step);
  double const seconds = cpu_seconds() - start;
  EXPECT_LT(seconds, 4.0);
  file.close();
  struct stat facts {};
  stat((folder / "t.h5").c_str(), &facts);
  EXPECT_LT(static_cast<double>(facts.st_size) / 2000, 2000.0) << "bytes per frame of 4 particles";
  RecordProperty("microseconds_per_frame", static_cast<int>(seconds / 2000 * 1e6));
}

}  // namespace
}  // namespace boltzmann::trajectory_crash_test
