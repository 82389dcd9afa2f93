// XYZ files: plain and extended text as other programs write it, and every kind of mistake with its line.
#include <boltzmann/core/error.hpp>
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/particles/laplace.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace boltzmann::xyz_file_test {
namespace {

class XyzFile : public testing::Test {
 protected:
  std::string write(std::string const& text) {
    std::ofstream(path_) << text;
    return path_;
  }
  std::string message_of(std::string const& text, std::size_t frame = 0) {
    try {
      from_xyz_file(write(text), frame);
    } catch (Error const& error) {
      std::string const what = error.what();
      return what.starts_with(path_) ? what.substr(path_.size()) : what;
    }
    return "no error";
  }
  void TearDown() override { std::filesystem::remove(path_); }

  std::string const path_ =
      testing::TempDir() + "boltzmann_" + testing::UnitTest::GetInstance()->current_test_info()->name() + ".xyz";
};

TEST_F(XyzFile, Plain) {
  auto const frame = from_xyz_file(write("3\nwater\nO 0.0 0 0.117\nH 0 +0.757 -4.67e-1\r\n  H\t0 -0.757 -0.467\n"));
  EXPECT_EQ(frame.comment, "water");
  EXPECT_EQ(frame.species, (std::vector<std::string>{"O", "H", "H"}));
  ASSERT_EQ(frame.columns.size(), 1U);
  EXPECT_EQ(frame.find("position")->values, (std::vector<double>{0, 0, 0.117, 0, 0.757, -0.467, 0, -0.757, -0.467}));
  EXPECT_FALSE(frame.lattice);

  Ensemble<Newton<3>> hydrogen("hydrogen", 2);
  EXPECT_EQ(frame_load(hydrogen, frame, {.species = "H", .length = 10}), 2U);
  EXPECT_EQ(hydrogen[1].position, (Vector<3>{0, -7.57, -4.67}));
  EXPECT_EQ(hydrogen[0].mass, 1);
  EXPECT_THROW(frame_load(hydrogen, frame), Error);
  EXPECT_EQ(frame_load(hydrogen, frame, {.resize = true}), 3U);
  EXPECT_EQ(hydrogen.size(), 3U);
  EXPECT_THROW(frame_load(hydrogen, frame, {.species = "He"}), Error);
  Ensemble<Newton<2>> flat("flat", 3);
  EXPECT_THROW(frame_load(flat, frame), Error);
}

TEST_F(XyzFile, ExtendedWithVelocitiesMassesAndLattice) {
  auto const frame = from_xyz_file(write(
      "2\nLattice=\"5 0 0 0 6 0 0 0 7\" Properties=id:I:1:species:S:1:pos:R:3:velo:R:3:masses:R:1:fixed:L:1:charge:R:1 "
      "pbc=\"T T F\"\n1 Na 1 2 0 -0.5 0.25 0 22.99 T 1\n2 Cl 3 4 0 0 1 0 35.45 F -1\n"));
  ASSERT_TRUE(frame.lattice);
  EXPECT_EQ((*frame.lattice)[8], 7);
  EXPECT_EQ(frame.species[1], "Cl");
  Ensemble<Coulomb<2>> ions("ions", 2);
  EXPECT_EQ(frame_load(ions, frame, {.length = 2, .velocity = 100}), 2U);
  EXPECT_EQ(ions[1].position, (Vector<2>{6, 8}));
  EXPECT_EQ(ions[0].velocity, (Vector<2>{-50, 25}));
  EXPECT_EQ(ions[0].mass, 22.99);
  EXPECT_EQ(ions[1].charge, -1);
}

TEST_F(XyzFile, Frames) {
  std::string const text = "1\nfirst\nAr 1 0 0\n\n1\nsecond\nAr 2 0 0\n0\nempty\n";
  EXPECT_EQ(from_xyz_file(write(text), 1).find("position")->values[0], 2);
  EXPECT_EQ(from_xyz_file(write(text), 2).size(), 0U);
  EXPECT_EQ(message_of(text, 3), ":10: the file has 3 frames, there is no frame 3 (the first is 0)");
  Ensemble<Newton<3>> none("none");
  EXPECT_EQ(frame_load(none, from_xyz_file(write(text), 2)), 0U);
}

TEST_F(XyzFile, MistakesNameTheirLine) {
  EXPECT_EQ(message_of(""), ":1: the XYZ file is empty");
  EXPECT_EQ(message_of("two\n"), ":1: 'two' is not a number of particles, with which a frame begins");
  EXPECT_EQ(message_of("-1\n\n"), ":1: '-1' is not a number of particles, with which a frame begins");
  EXPECT_EQ(message_of("1"), ":2: the file ends before the comment line of the frame");
  EXPECT_EQ(message_of("2\n\nAr 1 2 3\n"), ":4: the file ends after 1 of the 2 particles of the frame");
  EXPECT_EQ(message_of("99999999999999\n\nAr 1 2 3\n"),
            ":4: the file ends after 1 of the 99999999999999 particles of the frame");
  EXPECT_EQ(message_of("1\n\nAr 1 2\n"), ":3: a particle needs 4 words, this line has 3");
  EXPECT_EQ(message_of("1\n\nAr 1 2 x3\n"), ":3: 'x3' is not a number (position)");
  EXPECT_EQ(message_of("1\n\nAr 1 2 nan\n"), ":3: 'nan' is not a number (position)");
  EXPECT_EQ(message_of("1\nProperties=species:S:1:pos:R\nAr 1 2 3\n"),
            ":2: Properties=species:S:1:pos:R is not a list of name:type:number");
  EXPECT_EQ(message_of("1\nProperties=species:S:1:vel:R:3\nAr 1 2 3\n"),
            ":2: Properties=species:S:1:vel:R:3 has no pos:R:3, the positions");
  EXPECT_EQ(message_of("1\nLattice=\"1 0 0\"\nAr 1 2 3\n"), ":2: Lattice=\"1 0 0\" has not 9 numbers");
  EXPECT_THROW(from_xyz_file("/nowhere/at/all.xyz"), Error);
  // Of somebody's file no more is told than shows what is wrong.
  EXPECT_EQ(
      message_of("root:x:0:0:\x1b[2Jroot:/root:/bin/bash and many more words\n"),
      ":1: 'root:x:0:0:?[2Jroot:/root:/bin/bash and ...' is not a number of particles, with which a frame begins");
}

TEST_F(XyzFile, TheLatticeIsThatOfAPeriodicBox) {
  Box const box(Vector{0.0, -1.0, 0.0}, Vector{5.0, 3.0, 20.0},
                std::array{Boundary::periodic, Boundary::periodic, Boundary::open});
  auto const misfit = [&](std::string const& comment, double length = 1) {
    return lattice_misfit(from_xyz_file(write("1\n" + comment + "\nAr 1 2 3\n")), box, {.length = length});
  };
  EXPECT_EQ(misfit("no lattice"), "");
  EXPECT_EQ(misfit("Lattice=\"5 0 0 0 4 0 0 0 7\""), "");
  EXPECT_EQ(misfit("Lattice=\"0.5 0 0 0 0.4 0 0 0 1\"", 10), "");
  EXPECT_EQ(misfit("Lattice=\"5 0 0 0 4.01 0 0 0 7\""),
            "the file's lattice is 4.01 long along y, the periodic box 4; they must be the same");
  EXPECT_EQ(misfit("Lattice=\"5 0 0 0 4.01 0 0 0 7\" pbc=\"T F T\""), "");
  EXPECT_EQ(misfit("Lattice=\"5 0 0 1 4 0 0 0 7\""),
            "the file's lattice is skew along x; a periodic box has right angles");
}

}  // namespace
}  // namespace boltzmann::xyz_file_test
