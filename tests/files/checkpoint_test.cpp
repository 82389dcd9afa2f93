// Checkpoints: every bit comes back, and no damaged file does.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/files/checksum.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/newton.hpp>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <bit>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "../small_disk.hpp"
#include "temporary_folder.hpp"

namespace boltzmann::checkpoint_test {
namespace {

void put(std::string const& path, std::string const& text) { std::ofstream(path, std::ios::binary) << text; }

std::vector<std::uint64_t> bits(std::vector<double> const& values) {
  std::vector<std::uint64_t> result;
  for (double const value : values) result.push_back(std::bit_cast<std::uint64_t>(value));
  return result;
}

// Bit patterns of all kinds: NaNs with payloads (quiet and signalling), zeros, denormals, infinities, noise.
std::vector<double> all_kinds(std::size_t size, unsigned seed) {
  std::mt19937_64 random(test_seed(seed));
  std::vector<std::uint64_t> const special{
      0x7FF8000000000001, 0x7FF0000000000001, 0xFFF8DEADBEEF0000, 0x8000000000000000, 1,
      0x000FFFFFFFFFFFFF, 0x7FF0000000000000, 0xFFF0000000000000};
  std::vector<double> values;
  for (std::size_t k = 0; k < size; ++k)
    values.push_back(std::bit_cast<double>(k < special.size() ? special[k] : random()));
  return values;
}

Checkpoint example() {
  Checkpoint c;
  c.program_version = "0.1.0";
  c.scenario = "[box]\nlow = [0, 0]\n# Ångström ≤ nm\n" + std::string(100000, 'x');
  c.step = 1234567890123;
  c.time = 0.1 + 0.2;
  c.step_size = std::numeric_limits<double>::denorm_min();
  c.seed = 0xFFFFFFFFFFFFFFFF;
  c.ensembles.push_back({"ions", "Ion", 7, 12, all_kinds(7 * 12, 1)});
  c.ensembles.push_back({"a/b c", "Newton", 0, 8, {}});
  c.ensembles.push_back({"aaa", "Newton", 1, 8, all_kinds(8, 2)});
  c.state["leap frog/ions"] = all_kinds(33, 3);
  c.state["empty"] = {};
  c.state["."] = {-0.0};
  return c;
}

void expect_same(Checkpoint const& a, Checkpoint const& b) {
  EXPECT_EQ(a.program_version, b.program_version);
  EXPECT_EQ(a.scenario, b.scenario);
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(bits({a.time, a.step_size}), bits({b.time, b.step_size}));
  ASSERT_EQ(a.ensembles.size(), b.ensembles.size());
  for (std::size_t k = 0; k < a.ensembles.size(); ++k) {
    EXPECT_EQ(a.ensembles[k].name, b.ensembles[k].name);
    EXPECT_EQ(a.ensembles[k].class_name, b.ensembles[k].class_name);
    EXPECT_EQ(a.ensembles[k].size, b.ensembles[k].size);
    EXPECT_EQ(a.ensembles[k].stride, b.ensembles[k].stride);
    EXPECT_EQ(bits(a.ensembles[k].rows), bits(b.ensembles[k].rows));
  }
  ASSERT_EQ(a.state.size(), b.state.size());
  for (auto const& [name, values] : a.state) {
    ASSERT_TRUE(b.state.contains(name)) << name;
    EXPECT_EQ(bits(values), bits(b.state.at(name))) << name;
  }
}

TEST(Checkpoint, ComesBackBitForBit) {
  TemporaryFolder const folder;
  write_checkpoint(folder / "c.h5", example());
  expect_same(read_checkpoint(folder / "c.h5"), example());
  EXPECT_FALSE(std::filesystem::exists(folder / "c.h5.part"));
}

TEST(Checkpoint, EmptyOneComesBack) {
  TemporaryFolder const folder;
  write_checkpoint(folder / "c.h5", {});
  expect_same(read_checkpoint(folder / "c.h5"), {});
}

TEST(Checkpoint, KeepsThePreviousOne) {
  TemporaryFolder const folder;
  for (int step = 1; step <= 3; ++step) {
    Checkpoint c;
    c.step = step;
    write_checkpoint(folder / "c.h5", c);
  }
  EXPECT_EQ(read_checkpoint(folder / "c.h5").step, 3);
  EXPECT_EQ(read_checkpoint(folder / "c.h5.previous").step, 2);
  write_checkpoint(folder / "d.h5", {}, false);
  write_checkpoint(folder / "d.h5", {}, false);
  EXPECT_FALSE(std::filesystem::exists(folder / "d.h5.previous"));
}

TEST(Checkpoint, PartsFollowNoLinks) {
  TemporaryFolder const folder;
  std::ofstream(folder / "precious") << "mine";
  for (std::string const name : {"c.h5", "d.txt"}) {
    std::filesystem::create_symlink("precious", folder / (name + ".part"));
    if (name == "c.h5")
      write_checkpoint(folder / name, {});
    else
      TextFile(folder / (name + ".part"), TextFile::Mode::replace).write("theirs");
    EXPECT_EQ(read_text(folder / "precious"), "mine") << name;
  }
}

TEST(Checkpoint, RowsGoBackIntoAnEnsemble) {
  Ensemble<Newton<2>> a("ions", 3), b("ions", 1), other("electrons", 3);
  Ensemble<Newton<3>> deeper("ions", 3);
  for (std::size_t i = 0; i < 3; ++i) a[i].velocity = {1.5 * static_cast<double>(i), -0.0};
  restore_rows(copy_rows(a), b);
  ASSERT_EQ(b.size(), 3U);
  EXPECT_EQ(bits(copy_rows(a).rows), bits(copy_rows(b).rows));
  EXPECT_EQ(b[2].velocity[0], 3.0);
  EXPECT_THROW(restore_rows(copy_rows(a), other), Error);
  EXPECT_EQ(copy_rows(a).class_name, deeper.class_name());
  a.resize(0);
  restore_rows(copy_rows(a), b);
  EXPECT_EQ(b.size(), 0U);
}

TEST(Checkpoint, ADamagedOneNamesTheOneBeforeIfThatIsWhole) {
  TemporaryFolder const folder;
  std::string const path = folder / "c.h5", previous = path + ".previous";
  write_checkpoint(path, {});
  std::string const bytes = read_text(path);
  put(path, bytes.substr(0, 700));
  EXPECT_TRUE(message([&] { read_checkpoint(path); }).ends_with(" bytes")) << "there is none before";
  put(previous, bytes);
  EXPECT_TRUE(message([&] {
                read_checkpoint(path);
              }).ends_with("; the one before it is whole: cp '" + previous + "' '" + path + "' goes back to it"));
  put(previous, bytes.substr(0, 800));
  EXPECT_TRUE(message([&] { read_checkpoint(path); }).ends_with(" bytes"));
}

TEST(Checkpoint, EveryTruncationIsOneError) {
  TemporaryFolder const folder;
  write_checkpoint(folder / "c.h5", {});
  std::string const bytes = read_text(folder / "c.h5");
  for (std::size_t size = 0; size < bytes.size(); size += size < 600 ? 1 : 37) {
    put(folder / "t.h5", bytes.substr(0, size));
    std::string const text = message([&] { read_checkpoint(folder / "t.h5"); });
    EXPECT_TRUE(text == folder / "t.h5" + ": is empty" || text.starts_with(folder / "t.h5" + ": is truncated")) << text;
  }
  put(folder / "t.h5", bytes + "x");
  EXPECT_EQ(message([&] { read_checkpoint(folder / "t.h5"); }),
            folder / "t.h5" + ": is damaged (its checksum is wrong)");
}

TEST(Checkpoint, EveryChangedBitIsAnError) {
  TemporaryFolder const folder;
  Checkpoint small;
  small.ensembles.push_back({"ions", "Newton", 2, 8, all_kinds(16, 1)});
  write_checkpoint(folder / "c.h5", small);
  std::string bytes = read_text(folder / "c.h5");
  for (std::size_t k = 0; k < bytes.size(); k += k < 512 ? 1 : 5) {
    bytes[k] = static_cast<char>(bytes[k] ^ (1 << (k % 8)));
    put(folder / "t.h5", bytes);
    std::string const text = message([&] { read_checkpoint(folder / "t.h5"); });
    EXPECT_TRUE(text.starts_with(folder / "t.h5" + ": ")) << k << " " << text;
    EXPECT_EQ(text.find('\n'), std::string::npos);
    bytes[k] = static_cast<char>(bytes[k] ^ (1 << (k % 8)));
  }
}

TEST(Checkpoint, OtherFilesAreRefusedInOneLine) {
  TemporaryFolder const folder;
  EXPECT_EQ(message([&] { read_checkpoint(folder / "c.h5"); }),
            folder / "c.h5" + ": can't open it: No such file or directory");
  EXPECT_EQ(message([&] { read_checkpoint(folder.path); }), "'" + folder.path + "' is a directory, not a file");
  put(folder / "c.h5", std::string(2000, 'z'));
  EXPECT_EQ(message([&] { read_checkpoint(folder / "c.h5"); }), folder / "c.h5" + ": is not a checkpoint");
  put(folder / "c.h5", std::string("\x89HDF\r\n\x1a\n", 8) + std::string(2000, 0));
  EXPECT_EQ(message([&] { read_checkpoint(folder / "c.h5"); }),
            folder / "c.h5" + ": is an HDF5 file but not a checkpoint");
  write_checkpoint(folder / "c.h5", {});
  std::string bytes = read_text(folder / "c.h5");
  bytes[bytes.find("format 1") + 7] = '3';
  put(folder / "c.h5", bytes);
  EXPECT_EQ(message([&] { read_checkpoint(folder / "c.h5"); }),
            folder / "c.h5" + ": has format 3, this program reads 1");
}

TEST(Checkpoint, FailedWritesLeaveTheOldOne) {
  TemporaryFolder const folder;
  EXPECT_EQ(message([&] { write_checkpoint(folder / "no/c.h5", {}); }),
            folder / "no/c.h5.part" + ": can't open it for writing: No such file or directory");
  test::SmallDisk const disk(folder.path, "600k");
  ASSERT_TRUE(disk.mounted()) << test::SmallDisk::refused;
  Checkpoint good = example(), large = example();
  large.ensembles.push_back({"many", "Newton", 20000, 8, std::vector<double>(160000, 1.0)});
  write_checkpoint(folder / "c.h5", good);
  std::string const text = message([&] { write_checkpoint(folder / "c.h5", large); });
  std::string const later = message([&] { expect_same(read_checkpoint(folder / "c.h5"), good); });
  bool const part = std::filesystem::exists(folder / "c.h5.part");
  std::string const again = message([&] { write_checkpoint(folder / "c.h5", good); });
  EXPECT_EQ(text, folder / "c.h5.part" + ": can't be written: No space left on device");
  EXPECT_EQ(later, "no error");
  EXPECT_FALSE(part);
  EXPECT_EQ(again, "no error");
}

TEST(Checkpoint, FailureAtAnyByteIsAnErrorAndACleanExit) {
  TemporaryFolder const folder;
  write_checkpoint(folder / "c.h5", {});
  for (rlim_t limit = 0; limit < 130000; limit += 4999) {
    pid_t const child = fork();
    if (child == 0) {
      signal(SIGXFSZ, SIG_IGN);
      rlimit const most{limit, limit};
      setrlimit(RLIMIT_FSIZE, &most);
      std::string const text = message([&] { write_checkpoint(folder / "c.h5", example()); });
      // exit, not _exit: HDF5 must be able to end.
      std::exit(text.ends_with("File too large") && text.find('\n') == std::string::npos ? 0
                : text == "no error"                                                     ? 7
                                                                                         : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status)) << limit << " signal " << WTERMSIG(status);
    if (WEXITSTATUS(status) == 7) {
      EXPECT_GT(limit, 100000U);
      break;
    }
    EXPECT_EQ(WEXITSTATUS(status), 0) << limit;
    EXPECT_EQ(read_checkpoint(folder / "c.h5").step, 0) << limit;
  }
}

TEST(Checkpoint, KilledWritersAlwaysLeaveAGoodOne) {
  TemporaryFolder const folder;
  write_checkpoint(folder / "c.h5", example());
  std::mt19937 random(test_seed(5));
  for (int trial = 0; trial < 20; ++trial) {
    pid_t const child = fork();
    if (child == 0)
      for (Checkpoint c = example();; ++c.step) write_checkpoint(folder / "c.h5", c);
    usleep(1000 + random() % 20000);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    EXPECT_GE(read_checkpoint(folder / "c.h5").step, example().step);
  }
}

}  // namespace
}  // namespace boltzmann::checkpoint_test
