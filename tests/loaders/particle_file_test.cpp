// Files of particles as other programs write them, typed by hand after their manuals, and what is wrong with them.
#include <boltzmann/core/error.hpp>
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/particles/laplace.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace boltzmann::particle_file_test {
namespace {

using Numbers = std::vector<double>;
using Words = std::vector<std::string>;
using namespace literals;

class ParticleFile : public testing::Test {
 protected:
  std::string write(std::string const& name, std::string const& text) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  ParticleFrame read(std::string const& name, std::string const& text, ParticleFileOptions const& options = {}) {
    return from_particle_file(write(name, text), options);
  }
  std::string message(std::string const& name, std::string const& text, ParticleFileOptions const& options = {}) {
    try {
      read(name, text, options);
    } catch (Error const& error) {
      std::string const what = error.what(), path = (folder_ / name).string();
      return what.starts_with(path) ? what.substr(path.size()) : what;
    }
    return "no error";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path const folder_ =
      testing::TempDir() + "boltzmann_particle_file_" + testing::UnitTest::GetInstance()->current_test_info()->name();
};

UnitSystem const atomic(1_angstrom, 1_amu, 1_ps);

Numbers values(ParticleFrame const& frame, std::string const& name) {
  auto const* column = frame.find(name);
  return column ? column->values : Numbers{};
}

// As LAMMPS' manual shows it for water, with atoms out of order, image flags and a section that is left aside.
std::string const water =
    "LAMMPS data file via write_data, version 29 Sep 2021, timestep = 0, units = real\n\n"
    "3 atoms\n2 atom types\n2 bonds\n1 bond types\n\n"
    "-1 9 xlo xhi\n0.0 10.0 ylo yhi\n0.0 12.0 zlo zhi\n\n"
    "Masses\n\n1 15.9994 # O\n2 1.00794 # H\n\nPair Coeffs # lj/cut\n\n1 0.1553 3.166\n2 0 0\n\n"
    "Atoms # full\n\n"
    "2 1 2 0.4238 1.0 2.0 3.5 0 0 0\n1 1 1 -0.8476 1.0 2.0 3.0 0 0 0\n3 1 2 0.4238 1.5 2.0 3.0 0 1 0\n\n"
    "Velocities\n\n1 0.001 0 0\n3 0 0 -0.003\n2 0 0.002 0\n\nBonds\n\n1 1 1 2\n2 1 1 3\n";

TEST_F(ParticleFile, LammpsDataOfStyleFull) {
  auto const frame = read("water.data", water);
  EXPECT_EQ(frame.species, (Words{"1", "2", "2"}));
  EXPECT_EQ(values(frame, "position"), (Numbers{1, 2, 3, 1, 2, 3.5, 1.5, 2, 3}));
  EXPECT_EQ(values(frame, "velocity"), (Numbers{0.001, 0, 0, 0, 0.002, 0, 0, 0, -0.003}));
  EXPECT_EQ(values(frame, "mass"), (Numbers{15.9994, 1.00794, 1.00794}));
  EXPECT_EQ(values(frame, "charge"), (Numbers{-0.8476, 0.4238, 0.4238}));
  ASSERT_TRUE(frame.lattice);
  EXPECT_EQ((*frame.lattice)[0], 10);
  EXPECT_EQ((*frame.lattice)[8], 12);
  // Types and labels choose particles; velocities are in angstrom/fs, as the file says.
  Ensemble<Coulomb<3>> hydrogen("hydrogen");
  EXPECT_EQ(frame_load(hydrogen, frame, {.species = "H", .units = atomic, .resize = true}), 2U);
  EXPECT_EQ(hydrogen[0].position, (Vector<3>{1, 2, 3.5}));
  EXPECT_NEAR(hydrogen[0].velocity[1], 2, 1e-12);
  EXPECT_NEAR(hydrogen[0].mass, 1.00794, 1e-12);
  EXPECT_NEAR(hydrogen[0].charge, 0.4238, 1e-12);
  EXPECT_EQ(count_species(frame, "1"), 1U);
  EXPECT_EQ(count_species(frame, "O"), 1U);
  // Another base: nm, electron masses, fs.
  Ensemble<Coulomb<3>> all("all");
  frame_load(all, frame, {.units = UnitSystem(1_nm, 1 * constants::electron_mass, 1_fs), .resize = true});
  EXPECT_NEAR(all[0].position[2], 0.3, 1e-12);
  EXPECT_NEAR(all[0].velocity[0], 1e-4, 1e-15);
  EXPECT_NEAR(all[0].mass / 29164.4, 1, 1e-4);
  // Of pure numbers the file's units are no matter.
  frame_load(all, frame);
  EXPECT_EQ(all[0].position[2], 3);
}

TEST_F(ParticleFile, LammpsDataOfOtherStyles) {
  std::string const head = "comment\n\n2 atoms\n1 atom types\n0 4 xlo xhi\n0 5 ylo yhi\n-0.5 0.5 zlo zhi\n";
  auto const atomic_style = read("a.data", head + "Atoms\n\n1 1 1 2 0\n2 1 3 4 0\n");
  EXPECT_EQ(values(atomic_style, "position"), (Numbers{1, 2, 0, 3, 4, 0}));
  EXPECT_FALSE(atomic_style.find("charge"));
  std::string const six = "Atoms\n\n1 1 -1 1 2 0\n2 1 1 3 4 0\n";
  EXPECT_EQ(values(read("a.data", head + six, {.style = "charge"}), "charge"), (Numbers{-1, 1}));
  EXPECT_EQ(values(read("a.data", head + "Atoms # molecular\n\n1 1 1 1 2 0\n2 1 1 3 4 0\n"), "position"),
            (Numbers{1, 2, 0, 3, 4, 0}));
  EXPECT_NE(message("a.data", head + six)
                .find(":10: of 6 words an atom may be of style charge or bond or angle or molecular: "
                      "write 'Atoms # charge' in the file, or style = \"charge\" in load"),
            std::string::npos)
      << message("a.data", head + six);
  // LAMMPS' units on demand, in 2D.
  Ensemble<Newton<2>> atoms("atoms");
  frame_load(atoms,
             read("a.data", head + "Masses\n\n1 2\n\nAtoms # atomic\n\n1 1 1 2 0\n2 1 3 4 0\n", {.units = "nano"}),
             {.units = atomic, .resize = true});
  EXPECT_NEAR(atoms[1].position[0], 30, 1e-12);
  EXPECT_NEAR(atoms[1].mass / (2e-21 / 1.66053906660e-27), 1, 1e-9);  // attograms
}

TEST_F(ParticleFile, LammpsDump) {
  std::string const text =
      "ITEM: UNITS\nmetal\nITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp ff\n-2 2\n0 10\n0 1\n"
      "ITEM: ATOMS id type element xs ys zs vx vy vz q c_pe\n"
      "2 1 Ar 0.75 0.5 0.25 1 2 3 -1 0.5\n1 2 Kr 0.25 0.1 0 4 5 6 1 0.25\n"
      "ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n"
      "ITEM: ATOMS id type x y z\n7 1 0.5 0.25 0.125\n";
  auto const frame = read("a.dump", text);
  EXPECT_EQ(frame.species, (Words{"2", "1"}));
  EXPECT_EQ(values(frame, "position"), (Numbers{-1, 1, 0, 1, 5, 0.25}));
  EXPECT_EQ(values(frame, "velocity"), (Numbers{4, 5, 6, 1, 2, 3}));
  EXPECT_EQ(values(frame, "charge"), (Numbers{1, -1}));
  EXPECT_EQ(values(frame, "c_pe"), (Numbers{0.25, 0.5}));
  EXPECT_FALSE(frame.periodic[2]);
  EXPECT_EQ(frame.find("velocity")->unit, "angstrom/ps");
  EXPECT_EQ(count_species(frame, "Kr"), 1U);
  EXPECT_EQ(values(read("a.dump", text, {.frame = 1}), "position"), (Numbers{0.5, 0.25, 0.125}));
  EXPECT_EQ(message("a.dump", text, {.frame = 2}), ":24: the file has 2 frames, there is no frame 2 (the first is 0)");
  // A skew box: x = xlo + xs lx + ys xy, and the bounds of the file hold the tilt.
  auto const skew =
      read("b.dump",
           "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS xy xz yz pp pp pp\n0 5 1\n0 2 0\n0 "
           "3 0\nITEM: ATOMS id type xs ys zs\n1 1 0.5 0.5 0.5\n");
  EXPECT_EQ(values(skew, "position"), (Numbers{2.5, 1, 1.5}));
  EXPECT_EQ((*skew.lattice)[0], 4);
  EXPECT_EQ((*skew.lattice)[3], 1);
  Box const box({0, 0, 0}, {4, 2, 3}, Boundary::periodic);
  EXPECT_EQ(lattice_misfit(skew, box), "the file's lattice is skew along x; a periodic box has right angles");
}

TEST_F(ParticleFile, Pdb) {
  std::string const text =
      "TITLE     WATER\n"
      "CRYST1   18.774   18.774   18.774  90.00  90.00  90.00 P 1           1\n"
      "MODEL        1\n"
      "ATOM      1  OW  SOL     1       5.690  12.751  11.651  1.00  0.00           O  \n"
      "HETATM    2  HW1 SOL     1       4.760 -12.681 111.281  1.00  0.00           H  \n"
      "TER\nENDMDL\n"
      "MODEL        2\nATOM      1  OW  SOL     1       1.000   2.000   3.000\nENDMDL\nEND\n";
  auto const frame = read("a.pdb", text);
  EXPECT_EQ(frame.species, (Words{"O", "H"}));
  EXPECT_EQ(values(frame, "position"), (Numbers{5.690, 12.751, 11.651, 4.760, -12.681, 111.281}));
  EXPECT_EQ((*frame.lattice)[4], 18.774);
  Ensemble<Newton<3>> oxygen("oxygen");
  frame_load(oxygen, frame, {.species = "O", .units = UnitSystem(1_nm, 1_amu, 1_ps), .resize = true});
  EXPECT_NEAR(oxygen[0].position[0], 0.5690, 1e-12);
  EXPECT_EQ(read("a.pdb", text, {.frame = 1}).species, (Words{"OW"}));
  EXPECT_EQ(message("a.pdb", text, {.frame = 2}), ":12: the file has 2 frames, there is no frame 2 (the first is 0)");
  EXPECT_EQ(message("a.pdb", "ATOM      1  OW  SOL     1       5.690  12.751\n"),
            ":1: an atom's line ends before its z, which is in columns 47 to 54");
  EXPECT_EQ(message("a.pdb", "REMARK nothing\n"), ":2: the PDB file has no atoms");
  // 0.001 angstrom is what such a box can say.
  Box const box({0, 0, 0}, {18.7743, 18.774, 18.774}, Boundary::periodic),
      other({0, 0, 0}, {18.776, 18.774, 18.774}, Boundary::periodic);
  EXPECT_EQ(lattice_misfit(frame, box, {.units = atomic}), "");
  EXPECT_EQ(
      lattice_misfit(frame, other, {.units = atomic}),
      "the file's lattice is 18.774 angstrom long along x, the periodic box 18.776 angstrom; they must be the same");
}

TEST_F(ParticleFile, Gro) {
  // The example of GROMACS' manual.
  std::string const text =
      "MD of 2 waters, t= 0.0\n    3\n"
      "    1WATER  OW1    1   0.126   1.624   1.679  0.1227 -0.0580  0.0434\n"
      "    1WATER  HW2    2   0.190   1.661   1.747  0.8085  0.3191 -0.7791\n"
      "    1WATER  HW3    3   0.177   1.568   1.613 -0.9045 -2.6469  1.3180\n"
      "   1.82060   1.82060   1.82060\n";
  auto const frame = read("a.gro", text + text);
  EXPECT_EQ(frame.species, (Words{"OW1", "HW2", "HW3"}));
  EXPECT_EQ(values(frame, "velocity")[8], 1.3180);
  Ensemble<Newton<3>> atoms("atoms");
  frame_load(atoms, read("a.gro", text + text, {.frame = 1}), {.units = atomic, .resize = true});
  EXPECT_NEAR(atoms[1].position[2], 17.47, 1e-12);
  EXPECT_NEAR(atoms[1].velocity[2], -7.791, 1e-12);  // nm/ps in angstrom/ps
  EXPECT_EQ((*frame.lattice)[8], 1.82060);
  // More digits, no velocities, a skew box.
  auto const wide =
      read("b.gro", "digits\n1\n    1WATER  OW1    1   0.12600   1.62400   1.67900\n 2 2 1.7 0 0 0.5 0 0.5 0.5\n");
  EXPECT_EQ(values(wide, "position"), (Numbers{0.126, 1.624, 1.679}));
  EXPECT_FALSE(wide.find("velocity"));
  EXPECT_EQ((*wide.lattice)[3], 0.5);
  EXPECT_EQ(message("a.gro", "t\n2\n    1WATER  OW1    1   0.126   1.624   1.679\n"),
            ":4: the file ends after 1 of the 2 atoms of the frame");
  EXPECT_EQ(message("a.gro", "t\n1\n    1WATER  OW1    1   0.126   1.624   1.679\n"),
            ":4: the file ends before the edges of the box");
  EXPECT_EQ(message("a.gro", "t\nmany\n"), ":2: 'many' is not a number of atoms");
}

TEST_F(ParticleFile, Poscar) {
  // Cubic diamond as VASP's manual has it, with a scale; then with names, Cartesian places and velocities.
  auto const diamond = read(
      "POSCAR", "cubic diamond\n 3.7\n 0.5 0.5 0.0\n 0.0 0.5 0.5\n 0.5 0.0 0.5\n 2\nDirect\n 0 0 0\n 0.25 0.25 0.25\n");
  EXPECT_EQ(diamond.species, (Words{"1", "1"}));
  for (double const x :
       {values(diamond, "position")[3], values(diamond, "position")[4], values(diamond, "position")[5]})
    EXPECT_NEAR(x, 0.25 * 3.7, 1e-12);
  std::string const salt =
      "salt\n-64\n1 0 0\n0 1 0\n0 0 1\nNa Cl\n1 1\nSelective dynamics\nCartesian\n0 0 0 T T F\n0.5 0.5 0.25 F F F\n\n"
      "0.001 0 0\n0 -0.002 0\n";
  auto const frame = read("a.vasp", salt);
  EXPECT_EQ(frame.species, (Words{"Na", "Cl"}));
  EXPECT_NEAR((*frame.lattice)[0], 4, 1e-12);
  EXPECT_NEAR(values(frame, "position")[5], 1, 1e-12);
  Ensemble<Newton<3>> atoms("atoms");
  frame_load(atoms, frame, {.units = atomic, .resize = true});
  EXPECT_NEAR(atoms[1].velocity[1], -2, 1e-12);  // angstrom/fs
  EXPECT_EQ(message("a.vasp", "t\n1\n1 0 0\n0 1 0\n0 0 1\nNa Cl\n1 1\nDirect\n0 0 0\n"),
            ":10: the file ends after 0 of the 1 atoms of 'Cl'");
  EXPECT_EQ(message("a.vasp", "t\n1\n1 0 0\n2 0 0\n0 0 1\nNa\n1\n"), ":5: the edges of the lattice lie in a plane");
  EXPECT_EQ(message("a.vasp", "t\n1\n1 0 0\n0 1 0\n0 0 1\nNa\n1\nfractional\n0 0 0\n"),
            ":8: 'fractional' is neither Direct nor Cartesian");
  EXPECT_EQ(message("a.vasp", "t\n1\n1 0 0\n0 1 0\n0 0 1\nNa Cl\n1\n"),
            ":7: there are 2 elements and 1 numbers of atoms");
}

TEST_F(ParticleFile, UnitsThatTheFileSays) {
  auto const frame = read(
      "a.xyz", "1\nProperties=species:S:1:pos:R:3:velo:R:3 Length_unit=\"nm\" velo_unit=\"m/s\"\nAr 1 2 3 100 0 0\n");
  Ensemble<Newton<3>> atoms("atoms");
  frame_load(atoms, frame, {.units = atomic, .resize = true});
  EXPECT_NEAR(atoms[0].position[1], 20, 1e-12);
  EXPECT_NEAR(atoms[0].velocity[0], 1, 1e-12);
  frame_load(atoms, frame, {.length = 2, .units = atomic});
  EXPECT_EQ(atoms[0].position[1], 4);
  EXPECT_THROW(frame_load(atoms, read("a.xyz", "1\nLength_unit=\"kg\"\nAr 1 2 3\n"), {.units = atomic}), Error);
}

TEST_F(ParticleFile, MistakesNameTheirLine) {
  auto const without = [](std::string text, std::string const& part, std::string const& other = "") {
    return text.replace(text.find(part), part.size(), other);
  };
  EXPECT_EQ(message("w.data", ""), ":1: the file ends before its first line");
  EXPECT_EQ(message("w.data", "only a line\n"), ":1: the header has no line 'N atoms' before this one");
  EXPECT_EQ(message("w.data", "c\n3 atoms\n"), ":3: the file has no section Atoms");
  EXPECT_EQ(message("w.data", without(water, "3 1 2 0.4238 1.5 2.0 3.0 0 1 0\n")),
            ":28: the section Atoms ends after 2 of its 3 atoms");
  EXPECT_EQ(message("w.data", without(water, "1.5 2.0 3.0", "1.5 x 3.0")), ":26: 'x' is not a number (position)");
  EXPECT_EQ(message("w.data", without(water, "3 1 2 0.4238", "2 1 2 0.4238")), ":26: there is an atom 2 already");
  EXPECT_EQ(message("w.data", without(water, "3 0 0 -0.003", "4 0 0 -0.003")), ":31: there is no atom 4");
  EXPECT_EQ(message("w.data", without(water, "-1 9 xlo", "9 9 xlo")), ":8: the box goes from 9 to 9 along x");
  EXPECT_EQ(message("w.data", without(water, "# full", "# hybrid")),
            ":22: atom style 'hybrid' can't be read; those that can are atomic, charge, bond, angle, molecular, full, "
            "sphere, bpm/sphere and 1 more");
  EXPECT_EQ(message("w.data", without(water, "units = real", "units = reel")),
            "there are no units 'reel'; there are metal, real, si, cgs, micro, nano; did you mean 'real'?");
  EXPECT_EQ(message("w.dump", ""), ":1: the LAMMPS dump is empty");
  EXPECT_EQ(message("w.dump", "3\nxyz\n"), ":1: '3' is not 'ITEM: ...', with which a part of a frame begins");
  EXPECT_EQ(message("w.dump", "ITEM: NUMBER OF ATOMS\n2\nITEM: ATOMS id x y z\n1 0 0 0\n"),
            ":5: the file ends after 1 of the 2 atoms of the frame");
  EXPECT_EQ(message("w.dump", "ITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id x y z\n1 0 0\n"),
            ":4: an atom needs 4 words, this line has 3");
  EXPECT_EQ(message("w.pdb", "", {.units = "metal"}), ": a file of format pdb is in angstrom; leave out the units");
  EXPECT_EQ(message("w.xyz", "", {.format = "pdf"}),
            "there is no format 'pdf'; there are xyz, lammps-data, lammps-dump, pdb, gro, poscar; did you mean 'pdb'?");
  EXPECT_NE(message("w.data", water, {.frame = 1}).find("LAMMPS data is one frame"), std::string::npos);
}

// Kind of fault: a file that contradicts itself was read in part. One line each, in every format.
TEST_F(ParticleFile, ContradictionsAreRefused) {
  auto const with = [](std::string text, std::string const& part, std::string const& other) {
    auto const at = text.find(part);
    EXPECT_NE(at, std::string::npos) << part;
    return at == std::string::npos ? text : text.replace(at, part.size(), other);
  };
  struct Wrong {
    std::string file, text, words;
  };
  std::string const dump =
      "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n"
      "ITEM: ATOMS id type x y z\n1 1 1 1 1\n2 1 2 2 2\n";
  std::string const xyz = "2\nProperties=species:S:1:pos:R:3:id:I:1 pbc=\"T T F\"\nC 0 0 0 1\nC 1 1 1 2\n";
  std::string const gro =
      "t\n2\n    1WATER  OW1    1   0.126   1.624   1.679  0.1227 -0.0580  0.0434\n"
      "    1WATER  HW2    2   0.190   1.661   1.747  0.8085  0.3191 -0.7791\n   1.8   1.8   1.8\n";
  std::string const pdb =
      "CRYST1   18.774   18.774   18.774  90.00  90.00  90.00 P 1           1\nMODEL        1\n"
      "ATOM      1  OW  SOL     1       5.690  12.751  11.651  1.00  0.00           O  \n"
      "ATOM      2  HW1 SOL     1       4.760  12.681  11.281  1.00  0.00           H  \nENDMDL\n";
  std::string const vasp = "t\n1\n4 0 0\n0 4 0\n0 0 4\nNa Cl\n1 1\nDirect\n0 0 0\n0.5 0.5 0.5\n";
  for (auto const& [file, text, words] : {
           Wrong{"w.data", with(water, "3 atoms", "2 atoms"), "the section Atoms has more lines than the 2 atoms"},
           {"w.data", with(water, "2 bonds", "3 bonds"), "the section Bonds has 2 lines, the header announces 3"},
           {"w.data", with(water, "2 bonds\n", ""), "the section Bonds has 2 lines, the header announces 0"},
           {"w.data", with(water, "2 bonds", "2 bonds\n4 angles"),
            "the header announces 4 angles, but there is no section Angles"},
           {"w.data", with(water, "2 atom types", "1 atom types"),
            "there is no type 2; the header announces 1 atom types"},
           {"w.data", with(water, "3 1 2 0.4238", "3 1 3 0.4238"),
            "there is no type 3; the header announces 2 atom types"},
           {"w.data", with(water, "3 atoms", "3 atoms\n3 atoms"), "the header has 'atoms' twice"},
           {"w.data", with(water, "Bonds\n", "Masses\n"), "there is a section Masses already"},
           {"w.data", with(water, "2 1.00794 # H", "1 1.00794 # H"), "Masses has type '1' already"},
           {"w.data", with(water, "3 0 0 -0.003", "1 0 0 -0.003"), "atom 1 has a velocity already"},
           {"w.data", with(water, "3 0 0 -0.003\n", ""), "the section Velocities ends after 2 of its 3 atoms"},
           {"w.data", with(water, "1.5 2.0 3.0 0 1 0", "1.5 2.0 3.0"), "this line has 7, those before it have flags"},
           {"w.data", with(water, "0.0 10.0 ylo yhi", "10 0 0 bvec\n0 9 0 avec\n0 0 9 cvec"), "the box twice"},
           {"w.data", with(water, "2 bonds", "two bonds"),
            ":5: 'two bonds' is neither a line of the header nor a section"},
           {"w.data", with(water, "2 1.00794 # H\n", ""), "Masses has 1 types, the header announces 2"},
           {"w.dump", with(dump, "2 1 2 2 2", "1 1 2 2 2"), ":11: there is an atom 1 already"},
           {"w.dump", with(dump, "2 1 2 2 2", "2 1 2 2 2 2"), ":11: an atom needs 5 words, this line has 6"},
           {"w.dump", dump + "3 1 3 3 3\n", ":12: the frame has more lines than its 2 atoms"},
           {"w.dump", with(dump, "2 1 2 2 2\n", "ITEM: TIMESTEP\n"), "the frame ends after 1 of its 2 atoms"},
           {"w.dump", with(dump, "ITEM: ATOMS", "ITEM: TIMESTEP\n1\nITEM: ATOMS"),
            "the frame has ITEM: TIMESTEP already"},
           {"w.dump", with(dump, "type x y z", "x x y z"), "two columns are called 'x'"},
           {"w.dump", with(dump, "0 9\n", "9 0\n"), "the box goes from 9 to 0 along x"},
           {"w.dump", with(dump, "ITEM: ATOMS", "ITEM: NUMBER OF ENTRIES\n1\nITEM: ATOMS"),
            "can't be read; those that can"},
           {"w.xyz", with(xyz, "1 1 1 2", "1 1 1 1"), ":4: there is an atom 1 already"},
           {"w.xyz", xyz + "C 2 2 2 3\n", "is not a number of particles, with which a frame begins"},
           {"w.xyz", with(xyz, "1 1 1 2", "1 1 1 2 3"), "a particle needs 5 words, this line has 6"},
           {"w.xyz", with(xyz, "T T F", "T T"), "pbc=\"T T\" is not T or F for each of three axes"},
           {"w.xyz", with(xyz, "T T F", "T T yes"), "pbc: 'yes' is neither T nor F"},
           {"w.xyz", with(xyz, "pbc", "pbc=T pbc"), "the comment line has two of pbc="},
           {"w.xyz", with(xyz, "id:I:1", "pos:R:1"), "Properties: two columns are the position"},
           {"w.xyz", "2\n\nC 0 0 0 5\nC 1 1 1\n", ":4: a particle needs 5 words, this line has 4"},
           {"w.gro", with(gro, "  0.8085  0.3191 -0.7791", ""),
            ":4: this atom has no velocity, those before it have one"},
           {"w.gro", with(gro, "  0.1227 -0.0580  0.0434", ""),
            ":4: this atom has a velocity, those before it have none"},
           {"w.gro", with(gro, " -0.7791", ""), ":4: an atom has three components of its velocity"},
           {"w.gro", with(gro, "t\n2", "t\n1"), ":4: '1WATER' is not a number (edge of the box)"},
           {"w.gro", with(gro, "HW2    2", "OW1    1"), "is there twice"},
           {"w.gro", with(gro, "   1.8   1.8   1.8", "1 2 3 4"), "the edges of the box are 3 numbers, or 9"},
           {"w.pdb", with(pdb, "2  HW1", "1  OW "), "is there twice"},
           {"w.pdb", with(pdb, "ENDMDL\n", ""), "the file ends within model 1: there is no ENDMDL"},
           {"w.pdb", with(pdb, "MODEL        1\n", "MODEL        1\nMODEL        2\n"), "MODEL within a model"},
           {"w.pdb", with(pdb, "MODEL        1\n", "ENDMDL\n"), "ENDMDL without a MODEL or atoms before it"},
           {"w.pdb", with(pdb, "HW1 SOL", "HW1BSOL"), "the file has alternate places of an atom ('B' in column 17)"},
           {"w.pdb", with(pdb, " 4.760  12.681", " 4.7 6  12.681"), "'4.7 6' is not a number (position)"},
           {"w.vasp", vasp + "0.25 0.25 0.25\n", "'0.25 0.25 0.25' follows the 2 atoms"},
           {"w.vasp", with(vasp, "1 1\nDirect", "1 1 2\nDirect"), "there are 2 elements and more numbers of atoms"},
           {"w.vasp", vasp + "\n1 0 0\n", "the file ends after 1 of the 2 velocities"},
           {"w.vasp", vasp + "\n1 0 0\n0 1 0\n0 0 1\n", "'0 0 1' follows the 2 velocities"},
           {"w.vasp", with(vasp, "Direct", "Selective dynamics\nDirect"), "T or F for each of three axes"},
       })
    EXPECT_NE(message(file, text).find(words), std::string::npos) << file << ", " << words << ":\n"
                                                                  << message(file, text);
}

// Kind of fault: columns and records that were ignored without a word. Each is a column, or is told.
TEST_F(ParticleFile, WhatNoColumnHoldsIsTold) {
  Ensemble<Coulomb<3>> atoms("a");
  auto const told = [&](std::string const& name, std::string const& text, ParticleFileOptions const& options = {}) {
    return join(left_aside(atoms, read(name, text, options)), "; ");
  };
  EXPECT_EQ(
      told("w.data", water),
      "mol, iy (a class with fields of these names gets them); section Pair Coeffs ([[influences]] give laws); section "
      "Bonds (2 lines; `bonds` of the ensemble gives them)");
  EXPECT_EQ(told("w.data",
                 "c\n\n1 atoms\n1 atom types\n2 crossterms\n\nAtoms # atomic\n\n1 1 0 0 0\n\nCMAP\n\n1 1 2\n2 1 3\n"),
            "section CMAP (it belongs to a command of LAMMPS)");
  EXPECT_EQ(
      told("w.dump", "ITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id type x y z fx ix mol name vx\n1 1 0 0 0 2 0 3 Bob 1\n"),
      "fx, mol, vx (a class with fields of these names gets them); name (words, which no field holds)");
  EXPECT_EQ(told("w.xyz", "1\n\nC 0 0 0 1 2 3\n"),
            "words 5 to 7 of each line (Properties= in the comment line names them: "
            "Properties=species:S:1:pos:R:3:velo:R:3)");
  EXPECT_EQ(told("w.xyz",
                 "1\nProperties=species:S:1:pos:R:3:forces:R:3:fixed:L:1:name:S:1:velo:R:3\nC 0 0 0 1 2 3 T x 1 1 1\n"),
            "forces, fixed (a class with fields of these names gets them); name (words, which no field holds)");
  EXPECT_EQ(
      told("w.pdb",
           "CRYST1   18.774   18.774   18.774  90.00  90.00  90.00 P 21          1\n"
           "ATOM      1  OW  SOL     1       5.690  12.751  11.651  1.00  0.50           O1-\n"
           "ATOM      2  HW1 SOL     2       4.760  12.681  11.281  0.50  0.50           H  \n"
           "CONECT    1    2\nEND\n"),
      "residue, occupancy, temperature_factor (a class with fields of these names gets them); the symmetry of space "
      "group P 21 (only the atoms of the file are read; write all of the cell); 1 records of bonds (CONECT, SSBOND, "
      "LINK; give them as `bonds` of the ensemble)");
  EXPECT_EQ(
      told(
          "w.gro",
          "t\n2\n    1SOL     OW    1   0.126   1.624   1.679\n    2SOL     OW    2   0.226   1.624   1.679\n 2 2 2\n"),
      "residue (a class with fields of these names gets them)");
  std::string const vasp = "t\n1\n4 0 0\n0 4 0\n0 0 4\nNa_pv\n1\nSelective dynamics\nDirect\n0 0 0 T F T\n";
  EXPECT_EQ(told("w.vasp", vasp),
            "selective dynamics, by which 1 atoms are held (freeze = true in [[ensembles.set]] holds them)");
  EXPECT_EQ(
      told("w.vasp", vasp + "Direct\n1 0 0\n"),
      "selective dynamics, by which 1 atoms are held (freeze = true in [[ensembles.set]] holds them); velocities in "
      "parts of the lattice and the time step (write them as Cartesian)");
}

// CONTCAR as VASP writes it after a run at constant pressure: velocities of the lattice go before those of atoms.
TEST_F(ParticleFile, VelocitiesOfContcar) {
  std::string const start = "t\n1\n4 0 0\n0 4 0\n0 0 4\nNa/1a2b Cl\n1 1\nDirect\n0 0 0\n0.5 0.5 0.5\n",
                    lattice = "Lattice velocities and vectors\n 1\n 0 0 0\n 0 0 0\n 0 0 0\n 4 0 0\n 0 4 0\n 0 0 4\n",
                    velocities = " 0.1E-02  0 0\n 0 -2e-3 0\n", predictor = "\n 1\n 0.5\n 0 0 0\n";
  for (auto const& text : {"\n" + velocities, "Cartesian\n" + velocities, lattice + "\n" + velocities,
                           "\n" + velocities + predictor, "\n\n" + velocities + "\n\n"}) {
    auto const frame = read("CONTCAR", start + text);
    EXPECT_EQ(values(frame, "velocity"), (Numbers{0.001, 0, 0, 0, -0.002, 0})) << text;
    EXPECT_EQ(frame.species, (Words{"Na", "Cl"}));
    EXPECT_EQ(count_species(frame, "Na/1a2b"), 1U);
    bool const more = text.find("Lattice") != std::string::npos || text.find(predictor) != std::string::npos;
    EXPECT_EQ(frame.left_aside.size(), more ? 1U : 0U) << text;
  }
  EXPECT_FALSE(read("CONTCAR", start + "\n\n").find("velocity"));
  EXPECT_FALSE(read("CONTCAR", start).find("velocity"));
}

TEST_F(ParticleFile, EverySpellingOfPeriodicAxes) {
  for (char const* pbc : {"pbc=\"T F T\"", "pbc=\"true false true\"", "pbc=\"True False True\"",
                          "pbc=\"TRUE FALSE TRUE\"", "pbc=\"1 0 1\"", "pbc='T F T'", "pbc={T F T}", "pbc=[T, F, T]",
                          "pbc=[true,false,true]", "PBC=\"t f t\"", "pbc = \"T F T\""}) {
    auto const frame = read("a.xyz", std::string("1\nLattice=\"4 0 0 0 4 0 0 0 4\" ") + pbc + " energy=-1\nC 0 0 0\n");
    bool const spaced = std::string(pbc).find(" = ") != std::string::npos;  // which is no pair of key and value
    EXPECT_EQ(frame.periodic, (std::array{true, spaced, true})) << pbc;
  }
  EXPECT_EQ(read("a.xyz", "1\nLattice=\"4 0 0 0 4 0 0 0 4\" pbc=F\nC 0 0 0\n").periodic,
            (std::array{false, false, false}));
  for (char const* lattice :
       {"Lattice=[[4, 0, 0], [0, 5, 0], [0, 0, 6]]", "Lattice={4 0 0 0 5 0 0 0 6}", "lattice='4 0 0 0 5 0 0 0 6'"})
    EXPECT_EQ((*read("a.xyz", std::string("1\n") + lattice + "\nC 0 0 0\n").lattice)[4], 5) << lattice;
}

// Boxes that have no right angles, in every format, against a periodic box.
TEST_F(ParticleFile, SkewLatticesDoNotFit) {
  Box const box({0, 0, 0}, {4, 4, 4}, Boundary::periodic);
  auto const misfit = [&](std::string const& name, std::string const& text) {
    return lattice_misfit(read(name, text), box, {.units = atomic});
  };
  std::string const said = "the file's lattice is skew along x; a periodic box has right angles";
  auto const data = [](std::string const& edges) {
    return "c\n\n1 atoms\n1 atom types\n" + edges + "\nAtoms # atomic\n\n1 1 0 0 0\n";
  };
  std::string const straight = "0 4 xlo xhi\n0 4 ylo yhi\n0 4 zlo zhi\n";
  EXPECT_EQ(misfit("a.data", data(straight)), "");
  EXPECT_EQ(misfit("a.data", data(straight + "0 0 0 xy xz yz\n")), "");
  EXPECT_EQ(misfit("a.data", data(straight + "1 0 0 xy xz yz\n")), said);
  EXPECT_EQ(misfit("a.data", data("4 0 0 avec\n0 4 0 bvec\n0 0 4 cvec\n0 0 0 abc origin\n")), "");
  EXPECT_EQ(misfit("a.data", data("4 0 0 avec\n2 4 0 bvec\n0 0 4 cvec\n0 0 0 abc origin\n")), said);
  auto const dump = [](std::string const& bounds) {
    return "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS " + bounds +
           "ITEM: ATOMS id type x y z\n1 1 0 0 0\n";
  };
  EXPECT_EQ(misfit("a.dump", dump("xy xz yz pp pp pp\n0 4 0\n0 4 0\n0 4 0\n")), "");
  EXPECT_EQ(misfit("a.dump", dump("xy xz yz pp pp pp\n0 5 1\n0 4 0\n0 4 0\n")), said);
  EXPECT_EQ(misfit("a.dump", dump("abc origin pp pp pp\n4 0 0 0\n0 4 0 0\n0 0 4 0\n")), "");
  EXPECT_EQ(misfit("a.dump", dump("abc origin pp pp pp\n4 0 0 0\n1 4 0 0\n0 0 4 0\n")), said);
  auto const pdb = [](char const* angles) {
    return std::string("CRYST1    4.000    4.000    4.000") + angles +
           " P 1           1\nATOM      1  OW  SOL     1       1.000   2.000   3.000  1.00  0.00           O\nEND\n";
  };
  EXPECT_EQ(misfit("a.pdb", pdb("  90.00  90.00  90.00")), "");
  EXPECT_EQ(misfit("a.pdb", pdb("  90.00  90.00  80.00")), said);
  auto const gro = [](std::string const& edges) {
    return "t\n1\n    1SOL     OW    1   0.126   0.124   0.179\n" + edges + "\n";
  };
  EXPECT_EQ(misfit("a.gro", gro("0.4 0.4 0.4 0 0 0 0 0 0")), "");
  EXPECT_EQ(misfit("a.gro", gro("0.4 0.4 0.4 0 0 0.1 0 0 0")), said);
  auto const vasp = [](std::string const& second) {
    return "t\n1\n4 0 0\n" + second + "\n0 0 4\nNa\n1\nDirect\n0 0 0\n";
  };
  EXPECT_EQ(misfit("a.vasp", vasp("0 4 0")), "");
  EXPECT_EQ(misfit("a.vasp", vasp("1 4 0")), said);
  EXPECT_EQ(misfit("a.xyz", "1\nLattice=\"4 0 0 1 4 0 0 0 4\"\nC 0 0 0\n"), said);
}

// A file of each format under a name that says nothing, plain.
TEST_F(ParticleFile, AreKnownByTheirFirstLines) {
  for (auto const& text :
       {std::string("1\n\nC 0 0 0\n"), water, std::string("ITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id x y z\n1 0 0 0\n"),
        std::string("REMARK\nATOM      1  OW  SOL     1       1.000   2.000   3.000\n"),
        std::string("t\n1\n    1SOL     OW    1   0.126   0.124   0.179\n 2 2 2\n"),
        std::string("t\n1\n4 0 0\n0 4 0\n0 0 4\nNa\n1\nDirect\n0 0 0\n")})
    for (char const* name : {"data.one", "POSCAR_1", "file", "x.txt"}) {
      SCOPED_TRACE(name + (":\n" + text));
      EXPECT_NO_THROW(read(name, text));
    }
  EXPECT_NE(message("file", "nothing\nof this kind\n").find("neither its name nor its first lines show a format"),
            std::string::npos);
}

TEST_F(ParticleFile, StylesOfLammps) {
  std::string const head = "c\n\n1 atoms\n1 atom types\n\n";
  auto const frame = read("a.data", head + "Atoms # dipole\n\n1 1 -0.5 1 2 3 4 5 6\n");
  EXPECT_EQ(values(frame, "charge"), Numbers{-0.5});
  EXPECT_EQ(values(frame, "muy"), Numbers{5});
  // The comment and the scenario may not differ; a comment that is no style does not matter if the scenario says it.
  EXPECT_NE(message("a.data", head + "Atoms # full\n\n1 1 1 0.5 1 2 3\n", {.style = "sphere"})
                .find("the file has style full, the scenario sphere"),
            std::string::npos);
  EXPECT_EQ(values(read("a.data", head + "Atoms # made by hand\n\n1 1 1 0.5 1 2 3\n", {.style = "full"}), "charge"),
            Numbers{0.5});
  for (char const* row : {"1 1 1 1 1 1", "1 1 1 1 1 1 1", "1 1 1 1 1 1 1 1", "1 1 1 1 1 1 1 1 1"})
    EXPECT_NE(message("a.data", head + "Atoms\n\n" + row + "\n").find("words an atom may be of style"),
              std::string::npos)
        << row;
}

}  // namespace
}  // namespace boltzmann::particle_file_test
