// Undo logs: a file that was written over, grown or cut is what it was again, or stays what it is.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <boltzmann/files/checksum.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/files/undo_log.hpp>
#include <tests/seed.hpp>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>

#include "temporary_folder.hpp"

namespace boltzmann::undo_log_test {
namespace {

void put(std::string const& path, std::string const& text) { std::ofstream(path, std::ios::binary) << text; }

// A file that is changed by chance, with a log that began when it was `then`.
struct Changed {
  TemporaryFolder const folder;
  std::string const path = folder / "file", log = folder / "log";
  std::mt19937_64 random;
  std::string then;
  int file;
  std::optional<UndoLog> undo;

  explicit Changed(std::uint64_t seed) : random(test_seed(seed)), then(text(random() % 40'000)) {
    put(path, then);
    file = open(path.c_str(), O_RDWR);
    undo.emplace(log, then.size(), UndoLog::Label{7, seed});
    for (int change = 0; change < 20; ++change) {
      auto const now = std::filesystem::file_size(path);
      if (change % 5 == 4) {
        std::uint64_t const size = random() % (now + 1);
        undo->keep(file, size, now - size);
        EXPECT_EQ(ftruncate(file, static_cast<off_t>(size)), 0);
      } else {
        std::string const bytes = text(random() % 9000);
        std::uint64_t const at = random() % (now + 1);
        undo->keep(file, at, bytes.size());
        EXPECT_EQ(pwrite(file, bytes.data(), bytes.size(), static_cast<off_t>(at)), static_cast<ssize_t>(bytes.size()));
      }
    }
  }
  ~Changed() { ::close(file); }

  std::string text(std::size_t size) {
    std::string bytes(size, 0);
    for (char& c : bytes) c = static_cast<char>(random());
    return bytes;
  }
  bool take_back(UndoLog::Label const& label, bool right = true) {
    return UndoLog::take_back(log, file, label, [&] {
      EXPECT_EQ(read_text(path).substr(0, then.size()), then);
      return right;
    });
  }
};

TEST(UndoLog, TakesAFileBackToTheByte) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Changed changed(seed);
    if (seed % 2 == 0) changed.undo->close();  // else as after a kill
    ASSERT_TRUE(changed.take_back({7, seed}));
    ASSERT_TRUE(read_text(changed.path) == changed.then) << seed;
  }
}

TEST(UndoLog, ThatDoesNotFitChangesNothing) {
  Changed changed(1);
  std::string const now = read_text(changed.path), good = read_text(changed.log);
  EXPECT_FALSE(changed.take_back({7, 2})) << "another label";
  EXPECT_FALSE(changed.take_back({7, 1}, false)) << "whoever is asked says no";
  EXPECT_TRUE(read_text(changed.path) == now);
  for (int trial = 0; trial < 200; ++trial) {
    std::string bad = good;
    if (trial % 2 == 0)
      bad.resize(changed.random() % bad.size());
    else
      bad[changed.random() % bad.size()] ^= static_cast<char>(1U << changed.random() % 8);
    put(changed.log, bad);
    ASSERT_FALSE(changed.take_back({7, 1})) << trial;
    ASSERT_TRUE(read_text(changed.path) == now) << trial;
  }
  std::filesystem::remove(changed.log);
  EXPECT_FALSE(changed.take_back({7, 1}));
}

// Then the machine may have lost what stood in the log's last pages, but not in the file's.
TEST(UndoLog, OfAMachineThatLostItsPowerHasToBeClosed) {
  for (bool const closed : {false, true}) {
    Changed changed(3);
    if (closed) changed.undo->close();
    std::string log = read_text(changed.log);
    std::string boot;
    std::ifstream("/proc/sys/kernel/random/boot_id") >> boot;
    auto const at = log.find(boot);
    ASSERT_NE(at, log.npos);
    log.replace(at, 8, "somebody");
    std::size_t const end = at + boot.size() + 4;
    std::uint64_t const sum = crc64(log.data(), end);
    std::memcpy(log.data() + end, &sum, sizeof sum);
    put(changed.log, log);
    EXPECT_EQ(changed.take_back({7, 3}), closed);
  }
}

}  // namespace
}  // namespace boltzmann::undo_log_test
