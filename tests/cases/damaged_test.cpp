// Kind: a damaged file of a run that makes a program crash, wait for ever, or go on without a word. Siblings: each file of
// a folder; flipped bits, blocks of zeros, ones and noise, blocks in each other's place, a file that is cut; resume,
// export, render and the page. BOLTZMANN_DAMAGES=1000 tries more of them (from BOLTZMANN_SEED on).
#include "tests/cases/case.hpp"

#include "tests/bzm/same_run.hpp"

#include <random>

namespace boltzmann::damaged_test {
namespace {

using namespace boltzmann::test;

int number_from(char const* variable, int otherwise) {
  char const* const text = std::getenv(variable);
  return text ? std::atoi(text) : otherwise;
}

/// Damages a file by chance; half of the time near its beginning, where HDF5's own tables are.
class Damage {
 public:
  explicit Damage(unsigned seed) : random_(seed) {}

  std::size_t below(std::size_t most) { return most == 0 ? 0 : random_() % most; }

  std::string of(std::string bytes) {
    switch (below(6)) {
      case 0:
        flip(bytes);
        break;
      case 1:
        for (std::size_t k = 2 + below(200); k > 0; --k) flip(bytes);
        break;
      case 2:
        bytes.resize(place(bytes));
        break;
      case 3: {
        std::size_t const one = place(bytes) / 512 * 512, other = place(bytes) / 512 * 512;
        for (std::size_t k = 0; k < 512 && std::max(one, other) + k < bytes.size(); ++k)
          std::swap(bytes[one + k], bytes[other + k]);
        break;
      }
      default:
        fill(bytes);
    }
    return bytes;
  }

 private:
  std::size_t place(std::string const& bytes) {
    return below(below(2) == 0 ? std::min<std::size_t>(bytes.size(), 20000) : bytes.size());
  }
  void flip(std::string& bytes) {
    std::size_t const at = place(bytes);
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
  }
  void fill(std::string& bytes) {
    std::size_t const size = std::size_t{8} << below(11), at = place(bytes) / size * size, with = below(3);
    for (std::size_t k = at; k < std::min(at + size, bytes.size()); ++k)
      bytes[k] = static_cast<char>(with == 0 ? 0 : with == 1 ? 0xff : below(256));
  }

  std::mt19937 random_;
};

bool is_utf8(std::string const& text) {
  for (std::size_t k = 0; k < text.size();) {
    auto const byte = static_cast<unsigned char>(text[k]);
    std::size_t const count = byte < 0x80   ? 1
                              : byte < 0xc2 ? 0
                              : byte < 0xe0 ? 2
                              : byte < 0xf0 ? 3
                              : byte < 0xf5 ? 4
                                            : 0;
    if (count == 0 || k + count > text.size()) return false;
    for (std::size_t i = 1; i < count; ++i)
      if ((static_cast<unsigned char>(text[k + i]) & 0xc0U) != 0x80) return false;
    k += count;
  }
  return true;
}

struct Damaged : GasFolder {
  Damaged() {
    EXPECT_EQ(run({"--steps", "40", "--out", "good", "--quiet", "--set", "output.trajectory=5", "--set",
                   "output.diagnoses=5", "--set", "output.pictures=[]"})
                  .status,
              0);
    for (auto const* file : {"trajectory.h5", "trajectory.h5md", "checkpoint.h5", "diagnoses.csv", "scenario.toml"})
      good_.emplace_back(file, text_of(*this / "good" / file));
  }
  /// Half of the time the trajectory, which is the largest.
  void try_one(unsigned seed) {
    Damage damage(seed);
    auto const& [name, bytes] = good_[damage.below(2) == 0 ? 0 : damage.below(good_.size())];
    fs::remove_all(*this / "bad");
    fs::copy(*this / "good", *this / "bad");
    write_text(*this / "bad" / name, damage.of(bytes));
    std::vector<std::vector<std::string>> const ways{{"resume", "bad", "--steps", "10", "--quiet"},
                                                     {"resume", "bad", "--steps", "10", "--quiet"},
                                                     {"export", "bad", "-o", "a.xyz"},
                                                     {"window", "bad", "-o", "a.html"},
                                                     {"render", "bad", "-o", "a.png"}};
    auto const& words = ways[damage.below(ways.size())];
    SCOPED_TRACE("BOLTZMANN_SEED=" + std::to_string(seed) + ": " + name + ", bzm " + words[0]);
    auto const since = std::chrono::steady_clock::now();
    Process going(bzm_words(words), string());
    bool const ended = going.wait_until([&] { return !going.running(); });
    if (!ended) going.signal(SIGKILL);
    auto const outcome = going.wait();
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count(), 30);
    EXPECT_TRUE(outcome.status >= 0 && outcome.status <= 3) << outcome.status << ": " << outcome.err;
    EXPECT_LE(lines_in(outcome.err), 1U) << outcome.err;
    EXPECT_EQ(lines_in(outcome.err), outcome.status == 0 && outcome.err.empty() ? 0U : 1U) << outcome.err;
    EXPECT_TRUE(is_utf8(outcome.err + outcome.out)) << outcome.err;
  }

 private:
  std::vector<std::pair<std::string, std::string>> good_;
};

TEST(Damaged, FilesEndInALineOrAreMended) {
  Damaged damaged;
  int const first = number_from("BOLTZMANN_SEED", 1), times = number_from("BOLTZMANN_DAMAGES", 40);
  for (int seed = first; seed < first + times; ++seed) damaged.try_one(static_cast<unsigned>(seed));
}

TEST(Damaged, AFrameThatIsNotWhatWasWrittenIsToldWhenARunGoesOn) {
  Damaged folder;
  auto const path = folder / "good/trajectory.h5";
  std::string bytes = text_of(path);
  // The numbers of a frame, by their bits.
  auto const velocities = TrajectoryReader(path.string()).read(3, "atoms", "velocity");
  auto const at = bytes.find(std::string(reinterpret_cast<char const*>(velocities.data()), 16));
  if (at == std::string::npos) GTEST_SKIP() << "units differ between the file and the reader";
  bytes[at] = static_cast<char>(bytes[at] ^ 1);
  write_text(path, bytes);
  auto const outcome = bzm({"resume", "good", "--steps", "10", "--quiet"}, folder.string());
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(
      has(outcome.err, "its frame 3 is damaged: /particles/atoms/velocity is not what was written; the run continues"))
      << outcome.err;
}

}  // namespace
}  // namespace boltzmann::damaged_test
