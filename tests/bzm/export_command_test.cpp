// bzm export as a user meets it: formats, choices, mistakes.
#include "tests/bzm/command.hpp"

#include <boltzmann/files/csv.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/files/trajectory_export.hpp>
#include <boltzmann/scenario/scenario.hpp>

namespace boltzmann::export_command_test {
namespace {

using namespace boltzmann::test;

class Export : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<Folder>();
    EXPECT_EQ(bzm({"new", "gas"}, folder_->string()).status, 0);
    auto const run = bzm({"run", "gas.toml", "--steps", "200", "--out", "gas", "--quiet"}, folder_->string());
    EXPECT_EQ(run.status, 0) << run.err;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static Outcome run(std::vector<std::string> words) {
    words.insert(words.begin(), "export");
    return bzm(words, folder_->string());
  }
  static void expect_refused(std::vector<std::string> const& words, std::vector<std::string> const& parts) {
    auto const outcome = run(words);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(lines_in(outcome.err), 1U) << outcome.err;
    for (auto const& part : parts) EXPECT_TRUE(has(outcome.err, part)) << outcome.err << "\nlacks: " << part;
  }

  inline static std::unique_ptr<Folder> folder_;
};

// 256 atoms in 5 frames, one every 50 steps.
TEST_F(Export, WritesEveryFormat) {
  auto const xyz = run({"gas", "-o", "gas.xyz"});
  ASSERT_EQ(xyz.status, 0) << xyz.err;
  EXPECT_EQ(xyz.out, "gas.xyz: 5 frames, position, mass, velocity, units: metal\n");
  EXPECT_NE(xyz.err.find("note: 'atoms' is no chemical symbol"), std::string::npos) << xyz.err;
  EXPECT_EQ(lines_in(text_of(*folder_ / "gas.xyz")), 5U * 258);
  for (auto const* file : {"gas.extxyz", "gas.dump", "gas.lammpstrj", "gas.pvd", "gas.csv"})
    EXPECT_EQ(run({"gas", "-o", file}).status, 0) << file;
  EXPECT_EQ(run({"gas/", "-o", "one.vtp", "--frames", "-1"}).status, 0);
  EXPECT_EQ(lines_in(text_of(*folder_ / "gas.dump")), 5U * 265);
  EXPECT_EQ(lines_in(text_of(*folder_ / "gas.csv")), 1 + 5U * 256);
  EXPECT_TRUE(fs::exists(*folder_ / "gas/atoms-000000200.vtp"));
}

// What is exported can be loaded, with the numbers that the trajectory has.
TEST_F(Export, ComesBackAsItWas) {
  ASSERT_EQ(run({"gas/trajectory.h5", "-o", "back.xyz", "--frames", "2"}).status, 0);
  std::string text = text_of(*folder_ / "gas.toml");
  auto const from = text.find("load = "), to = text.find('\n', from);
  text.replace(from, to - from, "load = { kind = \"file\", path = \"" + (*folder_ / "back.xyz").string() + "\" }");
  auto const scenario = parse_scenario(text, "back.toml");
  TrajectoryReader const reader((*folder_ / "gas/trajectory.h5").string());
  auto const positions = reader.read(2, "atoms", "position");
  ASSERT_EQ(scenario->ensembles[0]->size(), 256U);
  for (std::size_t i = 0; i < 256; ++i)
    for (std::size_t a = 0; a < 2; ++a) EXPECT_EQ(scenario->ensembles[0]->row(i)[a], positions[2 * i + a]) << i;
}

TEST_F(Export, TakesFramesFieldsAndUnits) {
  ASSERT_EQ(run({"gas", "-o", "a.xyz", "--frames", "1::2", "--fields", "velocity", "--species", "atoms=Ar", "--units",
                 "si", "--ensemble", "atoms"})
                .status,
            0);
  std::string const text = text_of(*folder_ / "a.xyz");
  EXPECT_EQ(lines_in(text), 2U * 258);
  EXPECT_TRUE(has(text, "Properties=species:S:1:pos:R:3:id:I:1:velo:R:3 pbc=\"T T F\"")) << text.substr(0, 400);
  EXPECT_TRUE(has(text, "Length_unit=\"m\" Time_unit=\"s\" velo_unit=\"m/s\"\nAr ")) << text.substr(0, 400);
}

TEST_F(Export, SaysWhatIsWrongInOneLine) {
  expect_refused({"nowhere", "-o", "a.xyz"}, {"there is no folder 'nowhere'"});
  expect_refused({"gas", "-o", "a.xzy"}, {"by the ending of 'a.xzy'", "did you mean '.xyz'?"});
  expect_refused({"gas", "-o", "a.xyz", "--frames", "7"}, {"the trajectory has frames 0 to 4"});
  expect_refused({"gas", "-o", "a.xyz", "--frames", "x"}, {"from:to:every"});
  expect_refused({"gas", "-o", "a.xyz", "--fields", "velocty"}, {"did you mean 'velocity'?"});
  expect_refused({"gas", "-o", "a.xyz", "--ensemble", "atom"}, {"did you mean 'atoms'?"});
  expect_refused({"gas", "-o", "a.xyz", "--species", "Ar"}, {"atoms=Cu"});
  expect_refused({"gas", "-o", "a.xyz", "--units", "imperial"}, {"metal, real, si", "run"});
  expect_refused({"gas", "-o", "a.vtp"}, {"one frame of one ensemble, not 5 of 1"});
  expect_refused({"gas", "-o", "nowhere/a.xyz"}, {"nowhere/a.xyz", "No such file or directory"});
  expect_refused({"gas.toml", "-o", "a.xyz"}, {"gas.toml", "HDF5"});
  expect_refused({"gas"}, {"--out"});
  EXPECT_FALSE(fs::exists(*folder_ / "a.xyz.part"));
  ASSERT_EQ(bzm({"run", "gas.toml", "--steps", "5", "--out", "bare", "--quiet", "--set", "output.trajectory=0"},
                folder_->string())
                .status,
            0);
  expect_refused({"bare", "-o", "a.xyz"}, {"has no trajectory.h5"});
}

// Help, manual and guide name every ending of the one table.
TEST_F(Export, IsDescribedByItsTable) {
  std::string const help = run({"--help"}).out, manual = text_of(fs::path(BOLTZMANN_SOURCE) / "docs/bzm.1"),
                    guide = text_of(fs::path(BOLTZMANN_SOURCE) / "docs/reference/files.md");
  for (auto const& format : export_formats()) {
    EXPECT_TRUE(has(help, std::string(format.suffixes))) << help;
    std::string const first(format.suffixes.substr(0, format.suffixes.find(' ')));
    EXPECT_TRUE(has(manual, first)) << first;
    EXPECT_TRUE(has(guide, "`" + first + "`")) << first;
  }
  EXPECT_TRUE(has(bzm({"completion"}, folder_->string()).out, "export) options='"));
}

}  // namespace
}  // namespace boltzmann::export_command_test
