// Kind of fault: input that is read wrongly, or ignored, without a word. Covers every format of particle files (XYZ, LAMMPS
// data and dump, PDB, GRO, POSCAR), compressed files, groups without particles, masses that no file gives, and files for
// LAMMPS and ASE. Siblings are swept over the formats in tests/loaders/particle_file_test.cpp.
#include "case.hpp"

#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/loaders/particle_file.hpp>

#include <fmt/format.h>
#include <zlib.h>

#include <cmath>
#include <tuple>

namespace boltzmann::files_test {
namespace {

using test::bzm;
using test::Case;
using test::text_of;
using test::write_text;
using testing::AssertionResult;
using Numbers = std::vector<double>;

/// Particles of a class from a file, in a periodic box of 10 angstrom; `more` stands in the ensemble.
std::string scenario(std::string const& load, std::string const& kind = "Newton", std::string const& more = "",
                     std::string const& rest = "") {
  return "[units]\nbase = \"custom\"\nlength = \"1 angstrom\"\nmass = \"1 amu\"\ntime = \"1 ps\"\n"
         "[box]\nlow = [0, 0, 0]\nhigh = [10, 10, 10]\nboundary = \"periodic\"\n"
         "[run]\nstep = 0.001\nsteps = 0\n" +
         rest + "[[ensembles]]\nname = \"a\"\nclass = \"" + kind + "\"\n" + more + "\nload = { kind = \"file\", " +
         load + " }\n[output]\ntrajectory = 1\n";
}

/// A field of ensemble "a" at the start.
Numbers field(Case const& one, std::string const& name) {
  return TrajectoryReader((one / "run/trajectory.h5").string()).read(0, "a", name);
}

bool contains(std::string const& text, std::string const& part) { return text.find(part) != std::string::npos; }

/// `bzm check` refuses with exit status 2 and one line that has these words.
AssertionResult refuses(Case const& one, std::string const& words) {
  auto const told = one.check();
  if (told.status == 2 && contains(told.err, words)) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "status " << told.status << ": " << told.out << told.err;
}

/// `bzm check` passes, and it and the run have a line with these words.
AssertionResult notes(Case const& one, std::string const& words) {
  auto const told = one.check(), ran = one.run();
  if (told.status == 0 && ran.status == 0 && contains(told.err, words) && contains(ran.err, words))
    return testing::AssertionSuccess();
  return testing::AssertionFailure() << told.status << ": " << told.out << told.err << "\n"
                                     << ran.status << ": " << ran.err;
}

void write_gz(std::filesystem::path const& path, std::string const& text) {
  gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  gzclose(file);
}

TEST(Files, TypesOfOneLabelAreAllLoaded) {
  Case const one("same-label-data");
  ASSERT_EQ(one.run().status, 0);
  EXPECT_EQ(field(one, "charge"), (Numbers{0.5, -0.5}));
  // The same by labels of the file, and in a dump by elements.
  Case const dump("dump", scenario("path = \"c.dump\", species = \"C\"", "Coulomb", "mass = 12"));
  write_text(dump / "c.dump",
             "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS pp pp pp\n0 10\n0 10\n0 10\n"
             "ITEM: ATOMS id type element x y z q\n1 1 C 1 1 1 0.5\n2 2 C 2 2 2 -0.5\n3 3 O 3 3 3 7\n");
  ASSERT_TRUE(notes(dump, "no ensemble takes the particles of species '3' (1)"));
  EXPECT_EQ(field(dump, "charge"), (Numbers{0.5, -0.5}));
}

TEST(Files, SkewBoxesAreRefused) {
  EXPECT_TRUE(refuses(Case("general-triclinic-data"), "the file's lattice is skew along x; a periodic box has right"));
}

TEST(Files, SectionsHaveAsManyLinesAsTheHeaderSays) {
  EXPECT_TRUE(refuses(Case("more-rows"), "the section Atoms has more lines than the 2 atoms of the header"));
}

TEST(Files, TypesAreNumbersAndLabelsMixed) {
  Case const one("labels-mixed");
  ASSERT_EQ(one.run().status, 0);
  EXPECT_EQ(field(one, "mass"), (Numbers{22.99, 35.45}));
  EXPECT_EQ(field(one, "charge"), (Numbers{1, -1}));
}

TEST(Files, TrueIsASpellingOfPeriodic) {
  EXPECT_TRUE(
      refuses(Case("pbc-true"), "the file's lattice is 12 angstrom long along x, the periodic box 10 angstrom"));
}

TEST(Files, AnAtomStyleIsNotGuessed) {
  EXPECT_TRUE(refuses(Case("sphere"), "of 7 words an atom may be of style full or sphere: write 'Atoms # full'"));
  // The scenario tells it. A sphere of diameter 0.5 and density 2 has the mass 2 pi/6 0.5^3 = pi/24.
  Case const sphere("sphere-told", scenario("path = \"sphere.data\", style = \"sphere\"", "Newton"));
  ASSERT_EQ(sphere.run().status, 0);
  for (double const mass : field(sphere, "mass")) EXPECT_NEAR(mass, 3.14159265358979 / 24, 1e-12);
  EXPECT_EQ(field(sphere, "position"), (Numbers{1.5, 2.5, 3.5, 4.5, 5.5, 6.5}));
}

TEST(Files, AMassIsThatOfTheElementOrAskedFor) {
  Case const one("no-mass");
  ASSERT_TRUE(notes(one, "note: 'a': one.pdb has no masses; those of the elements are taken"));
  EXPECT_NEAR(field(one, "mass")[0] / (39.948 * 1.66053906660e-27), 1, 1e-4);
  // An element that is told, in amu; and a mass goes before it.
  Case const told("told", scenario("path = \"one.gro\"", "Newton", "element = \"Cu\""));
  std::string const gro = "one\n1\n    1X        X    1   0.100   0.200   0.300\n   1.00000   1.00000   1.00000\n";
  write_text(told / "one.gro", gro);
  ASSERT_EQ(told.run().status, 0);
  EXPECT_NEAR(field(told, "mass")[0], 63.546, 1e-9);
  Case const mass("mass", scenario("path = \"one.gro\"", "Newton", "element = \"Cu\"\nmass = 7"));
  write_text(mass / "one.gro", gro);
  ASSERT_EQ(mass.run().status, 0);
  EXPECT_EQ(field(mass, "mass")[0], 7);
  // Names of atoms are no elements: CA is a carbon of proteins.
  Case const name("name", scenario("path = \"ca.gro\""));
  write_text(name / "ca.gro", "one\n1\n    1GLY     CA    1   0.100   0.200   0.300\n   1.00000   1.00000   1.00000\n");
  EXPECT_TRUE(notes(name,
                    "warning: 'a': ca.gro has no masses, and its species are no elements with known masses: each mass "
                    "is 1 amu"));
  auto in_kilograms = scenario("path = \"ca.gro\"");
  in_kilograms.replace(0, in_kilograms.find("[box]"), "[units]\nbase = \"si\"\n");
  in_kilograms.replace(in_kilograms.find("[10, 10, 10]"), 12, "[1e-9, 1e-9, 1e-9]");
  Case const kilogram("kilogram", in_kilograms);
  write_text(kilogram / "ca.gro", text_of(name / "ca.gro"));
  EXPECT_TRUE(
      refuses(kilogram, "load: ca.gro has no masses, and its species are no elements with known masses; add mass"));
  Case const wrong("wrong", scenario("path = \"one.gro\"", "Newton", "element = \"Kup\""));
  EXPECT_TRUE(refuses(wrong, "element: 'Kup' is not the symbol of an element"));
}

TEST(Files, FieldsGetTypesAndMoleculesFromAnyFormat) {
  std::string const classes =
      "[[classes]]\nname = \"Site\"\nbase = \"Coulomb\"\nfields = [{ name = \"type\" }, { name = \"mol\" }]\n";
  Case const dump("type-field");
  ASSERT_EQ(dump.run().status, 0);
  EXPECT_EQ(field(dump, "type"), Numbers{2});
  EXPECT_EQ(field(dump, "mol"), Numbers{3});
  struct Format {
    char const *file, *text;
  };
  for (auto const& [file, text] :
       {Format{"t.dump",
               "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 10\n0 10\n0 10\n"
               "ITEM: ATOMS id mol type x y z\n7 3 2 1 1 1\n"},
        Format{
            "t.data",
            "c\n\n1 atoms\n2 atom types\n0 10 xlo xhi\n0 10 ylo yhi\n0 10 zlo zhi\n\nAtoms # full\n\n7 3 2 0 1 1 1\n"},
        Format{"t.xyz", "1\nProperties=species:S:1:pos:R:3:type:I:1:mol:I:1\nX 1 1 1 2 3\n"}}) {
    Case const one("site", scenario(std::string("path = \"") + file + "\"", "Site", "mass = 1\ncharge = 1", classes));
    write_text(one / file, text);
    auto const ran = one.run();
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(field(one, "type"), Numbers{2}) << file;
    EXPECT_EQ(field(one, "mol"), Numbers{3}) << file;
  }
}

TEST(Files, GroupsWithoutParticlesAreTold) {
  EXPECT_TRUE(notes(Case("where-nobody"), "warning: where: 'x > 100' is true for no particle of 'a' (line 15)"));
  std::string const start =
      "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0, 0]\nhigh = [10, 10, 10]\n[run]\nstep = 0.01\nsteps = 2\n"
      "[[ensembles]]\nname = \"a\"\nclass = \"Newton\"\n"
      "load = { kind = \"positions\", positions = [[1, 1, 1], [2, 2, 2]] }\n";
  EXPECT_TRUE(notes(
      Case("pull",
           start +
               "[[influences]]\nlaw = \"uniform-gravity\"\non = \"a\"\nacceleration = [1, 0, 0]\nwhere = \"y > 5\"\n"),
      "warning: where: 'y > 5' is true for no particle of 'a'"));
  Case const event("event", start + "[[events]]\nat = 0.01\nkick = [1, 0, 0]\nwhere = \"z < 0\"\n");
  EXPECT_TRUE(notes(event, "note: where: 'z < 0' is true for no particle at the start"));
  EXPECT_TRUE(contains(event.run().err, "warning: event at 0.01: where 'z < 0' is true for no particle"));
  EXPECT_TRUE(
      refuses(Case("measure",
                   start + "[[diagnoses]]\nkind = \"extremes\"\nquantity = \"x\"\nlabel = \"a\"\nwhere = \"x > 7\"\n"),
              "the group has no particle"));
  // And no false alarm.
  auto const told = Case("fine", start + "[[ensembles.set]]\nwhere = \"x > 1.5\"\nfreeze = true\n").check();
  EXPECT_FALSE(contains(told.err, "true for no particle")) << told.err;
}

TEST(Files, AnOpenBoxIsExportedWithAllAtomsInside) {
  Case const one("open-export");
  ASSERT_EQ(one.run().status, 0);
  for (char const* name : {"last.data", "last.dump"}) {
    ASSERT_EQ(bzm({"export", "run", "-o", name}, one.string()).status, 0);
    auto const frame = from_particle_file((one / name).string());
    double const length = (*frame.lattice)[4];
    auto const text = text_of(one / name);
    // Edges that hold y = -2 and 14.5, the upper one beyond: LAMMPS loses atoms on it.
    EXPECT_GE(length, 16.5) << text;
    EXPECT_LT(length, 16.7) << text;
    EXPECT_EQ((*frame.lattice)[0], 10);
  }
  auto const text = text_of(one / "last.data");
  auto const line = text.rfind('\n', text.find("ylo")) + 1;
  EXPECT_LT(std::stod(text.substr(line)), -2) << text;
  EXPECT_GT(std::stod(text.substr(text.find(' ', line))), 14.5) << text;
}

TEST(Files, ExportsNameElements) {
  std::string const start =
      "[units]\nbase = \"custom\"\nlength = \"1 angstrom\"\nmass = \"1 amu\"\ntime = \"1 ps\"\n[box]\nlow = [0, 0, 0]\n"
      "high = [10, 10, 10]\n[run]\nstep = 0.01\nsteps = 0\n[[ensembles]]\nname = \"atoms\"\nclass = \"Newton\"\n"
      "load = { kind = \"positions\", positions = [[1, 1, 1]] }\n";
  Case const named("named", start + "element = \"Cu\"\n[output]\ntrajectory = 1\n"),
      none("none", start + "mass = 1\n[output]\ntrajectory = 1\n");
  ASSERT_EQ(named.run().status, 0);
  ASSERT_EQ(none.run().status, 0);
  for (char const* name : {"c.xyz", "c.pdb", "c.vasp"}) {
    auto const told = bzm({"export", "run", "-o", name}, named.string()),
               warned = bzm({"export", "run", "-o", name}, none.string());
    EXPECT_EQ(told.err, "") << name;
    EXPECT_EQ(from_particle_file((named / name).string()).species[0], "Cu") << name;
    EXPECT_TRUE(contains(warned.err, "'atoms' is no chemical symbol")) << warned.err;
    EXPECT_TRUE(contains(warned.err, "--species atoms=Cu")) << warned.err;
  }
  for (char const* name : {"c.data", "c.dump"}) {
    ASSERT_EQ(bzm({"export", "run", "-o", name}, named.string()).status, 0);
    auto const frame = from_particle_file((named / name).string());
    EXPECT_EQ(count_species(frame, "Cu"), 1U) << name;
    EXPECT_NEAR(frame.find("mass")->values[0], 63.546, 1e-9) << name;
  }
}

TEST(Files, AModelThatEndsTwiceIsRefused) {
  EXPECT_TRUE(refuses(Case("crash"), "ENDMDL without a MODEL or atoms before it"));
  // A frame without particles, which was the crash, in other formats.
  for (auto const& [file, text] : {std::pair{"e.xyz", "0\n\n"},
                                   {"e.data", "c\n\n0 atoms\n1 atom types\n\nAtoms # atomic\n\n"},
                                   {"e.dump", "ITEM: NUMBER OF ATOMS\n0\nITEM: ATOMS id x y z\n"},
                                   {"e.pdb", "MODEL        1\nENDMDL\n"},
                                   {"e.gro", "t\n0\n 1 1 1\n"},
                                   {"e.vasp", "t\n1\n10 0 0\n0 10 0\n0 0 10\nNa\n0\nDirect\n"}}) {
    Case const one("empty", scenario(std::string("path = \"") + file + "\""));
    write_text(one / file, text);
    EXPECT_TRUE(refuses(one, "has no particles")) << file;
  }
}

TEST(Files, WhatIsLeftAsideIsTold) {
  Case const bonds("bonds", scenario("path = \"m.data\"", "Coulomb"));
  write_text(
      bonds / "m.data",
      "c\n\n2 atoms\n1 atom types\n1 bonds\n1 bond types\n0 10 xlo xhi\n0 10 ylo yhi\n0 10 zlo zhi\n\nMasses\n\n1 2\n\n"
      "Atoms # full\n\n1 4 1 0.5 1 1 1 0 0 2\n2 5 1 -0.5 2 2 2 0 0 0\n\nVelocities\n\n1 1 2 3\n2 4 5 6\n\n"
      "Bonds\n\n1 1 1 2\n\nBond Coeffs # harmonic\n\n1 100 1\n");
  ASSERT_TRUE(
      notes(bonds,
            "note: 'a': left aside of m.data: mol, iz (a class with fields of these names gets them); section Bonds "
            "(1 lines; `bonds` of the ensemble gives them); section Bond Coeffs ([[influences]] give laws)"));
  EXPECT_EQ(field(bonds, "velocity"), (Numbers{1, 2, 3, 4, 5, 6}));
  // A quiet run says nothing.
  EXPECT_EQ(bonds.run({"--quiet"}).err, "");
  // What the scenario gives goes before, and is told.
  Case const given("given", scenario("path = \"v.xyz\"", "Newton", "mass = 3\ntemperature = \"300 K\""));
  write_text(given / "v.xyz", "1\nProperties=species:S:1:pos:R:3:velo:R:3:mass:R:1\nAr 1 1 1 5 5 5 40\n");
  EXPECT_TRUE(notes(given, "left aside of v.xyz: velocity, mass (the scenario gives other values)"));
  EXPECT_EQ(field(given, "mass"), Numbers{3});
  // Units that nothing says.
  Case const units("units", scenario("path = \"v.xyz\"", "Newton", "mass = 3"));
  write_text(units / "v.xyz", "1\nProperties=species:S:1:pos:R:3:velo:R:3\nAr 1 1 1 5 5 5\n");
  EXPECT_TRUE(notes(units, "v.xyz has no units, and is read in those of the base (velocity in angstrom/ps)"));
  // Particles of two ensembles.
  Case const twice("twice",
                   scenario("path = \"one.pdb\"") +
                       "[[ensembles]]\nname = \"b\"\nclass = \"Newton\"\nload = { kind = \"file\", path = \"one.pdb\", "
                       "species = \"Ar\" }\n");
  EXPECT_TRUE(contains(twice.check().err,
                       "warning: one.pdb: several ensembles take the particles of species "
                       "'Ar' (1)"));
}

TEST(Files, MomentaOfAseAreVelocities) {
  // ASE: p = m v; a velocity of 1 angstrom/fs is 1 / (0.1018051) of ASE's, 10.180505 fs being its unit of time.
  std::string const text =
      "1\nLattice=\"10 0 0 0 10 0 0 0 10\" Properties=species:S:1:pos:R:3:momenta:R:3 pbc=\"T T T\"\n"
      "Cu 1 2 3 63.546 0 -127.092\n";
  Case const plain("plain", scenario("path = \"p.xyz\"")), ase("ase", scenario("path = \"p.xyz\", units = \"ase\""));
  write_text(plain / "p.xyz", text);
  write_text(ase / "p.xyz", text);
  ASSERT_TRUE(notes(plain, "momenta (units = \"ase\" in load makes velocities of those that ASE writes)"));
  EXPECT_EQ(field(plain, "velocity"), (Numbers{0, 0, 0}));
  ASSERT_EQ(ase.run().status, 0);
  double const v = 1000 / 10.180505717871192;  // angstrom/ps
  EXPECT_NEAR(field(ase, "velocity")[0] / v, 1, 1e-6);
  EXPECT_NEAR(field(ase, "velocity")[2] / v, -2, 1e-6);
}

TEST(Files, FilesAreKnownByTheirContentAndMayBeCompressed) {
  auto const mass = [](std::string const& load, std::string const& file, std::string const& text, bool packed) {
    Case const one("content", scenario("path = \"" + file + "\"" + load, "Coulomb"));
    if (packed)
      write_gz(one / file, text);
    else
      write_text(one / file, text);
    auto const ran = one.run();
    EXPECT_EQ(ran.status, 0) << file << ": " << ran.err;
    return ran.status == 0 ? field(one, "mass") : Numbers{};
  };
  for (bool const packed : {false, true})
    EXPECT_EQ(mass("", "data.melt",
                   text_of(std::filesystem::path(BOLTZMANN_SOURCE) / "tests/cases/files/same-label.data"), packed),
              (Numbers{12.011, 12.011}));
  EXPECT_EQ(mass("", "melt.data.gz",
                 text_of(std::filesystem::path(BOLTZMANN_SOURCE) / "tests/cases/files/same-label.data"), true),
            (Numbers{12.011, 12.011}));
  // A truncated and a damaged file, and one that is not what it says.
  std::string text;
  for (int k = 0; k < 3000; ++k) text += std::to_string(k * 7919 % 10007) + " ";
  Case const cut("cut", scenario("path = \"c.xyz.gz\""));
  write_gz(cut / "c.xyz.gz", "2000\n" + text + "\n");
  auto const whole = text_of(cut / "c.xyz.gz");
  write_text(cut / "c.xyz.gz", whole.substr(0, whole.size() / 2));
  EXPECT_TRUE(refuses(cut, "is truncated"));
  auto damaged = whole;
  damaged[whole.size() - 6] ^= 1;  // of the checksum
  write_text(cut / "c.xyz.gz", damaged);
  EXPECT_TRUE(refuses(cut, "is damaged"));
  write_text(cut / "c.xyz.gz", "1\n\nAr 1 1 1\n");
  EXPECT_TRUE(refuses(cut, "is not compressed by gzip"));
  write_text(cut / "c.xyz.gz", "BZh91AY");
  EXPECT_TRUE(refuses(cut, "ends in .gz"));
}

TEST(Files, AFrameOfARunInAnotherBaseIsConverted) {
  Case const first("first", scenario("path = \"v.xyz\", velocity = \"1 angstrom/ps\"", "Coulomb", "charge = \"1 e\""));
  write_text(first / "v.xyz", "1\nProperties=species:S:1:pos:R:3:velo:R:3\nAr 1 2 3 5 0 0\n");
  ASSERT_EQ(first.run().status, 0);
  std::string const text =
      "[units]\nbase = \"si\"\n[box]\nlow = [0, 0, 0]\nhigh = [1.1e-9, 1e-9, 1e-9]\nboundary = "
      "\"periodic\"\n[run]\nstep = "
      "1e-15\nsteps = 0\n[[ensembles]]\nname = \"a\"\nclass = \"Newton\"\nload = { kind = \"frame\", path = "
      "\"stored.h5\" }\n[output]\ntrajectory = 1\n";
  Case const second("second", text);
  std::filesystem::copy(first / "run/trajectory.h5", second / "stored.h5");
  ASSERT_TRUE(notes(second, "note: 'a': left aside of stored.h5: charge"));
  EXPECT_TRUE(notes(second, "warning: 'a': the box of stored.h5 is 1e-09 m long along x, this one 1.1e-09 m"));
  EXPECT_NEAR(field(second, "position")[2] / 3e-10, 1, 1e-9);
  EXPECT_NEAR(field(second, "velocity")[0] / 500, 1, 1e-9);
  EXPECT_NEAR(field(second, "mass")[0] / (39.948 * 1.66053906660e-27), 1, 1e-9);
}

/// A table in the format eam.fs of Fe and Cr, made up: F = -A_a sqrt(rho), rho = (1 + a + 2 b) (1 - r/4)^3 of a at b, and
/// V = (1 + a + b) (1 - r/4)^4.
std::string finnis_sinclair() {
  constexpr int n = 801;
  double const dr = 4.0 / (n - 1), drho = 0.05;
  auto const rows = [&](auto const& value) {
    std::string text;
    for (int k = 0; k < n; ++k) text += fmt::format("{:.15g}\n", value(k));
    return text;
  };
  std::string text = fmt::format("c\nc\nc\n2 Fe Cr\n{0} {1} {0} {2} 4\n", n, drho, dr);
  for (int a = 0; a < 2; ++a) {
    text += "26 55.845 2.855 bcc\n" + rows([&](int k) { return -(1.5 + a) * std::sqrt(k * drho); });
    for (int b = 0; b < 2; ++b) text += rows([&](int k) { return (1 + a + 2 * b) * std::pow(1 - k * dr / 4, 3); });
  }
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b <= a; ++b)
      text += rows([&](int k) { return k * dr * (1 + a + b) * std::pow(1 - k * dr / 4, 4); });
  return text;
}

TEST(Files, AnAlloyOfFinnisAndSinclairFromACompressedFile) {
  std::string text =
      "[units]\nbase = \"custom\"\nlength = \"1 angstrom\"\nmass = \"1 amu\"\ntime = \"1 ps\"\n[box]\nlow = [0, 0, 0]\n"
      "high = [20, 20, 20]\n[run]\nstep = 0.0001\nsteps = 1\n[embedded_atoms]\npotential = \"file\"\nfile = "
      "\"x.eam.fs.gz\"\n";
  for (auto const& [name, element, x] : {std::tuple{"iron", "Fe", 5}, std::tuple{"chrome", "Cr", 7}})
    text += fmt::format(
        "[[ensembles]]\nname = \"{}\"\nclass = \"Newton\"\nelement = \"{}\"\n"
        "load = {{ kind = \"positions\", positions = [[{}, 5, 5]] }}\n",
        name, element, x);
  Case const one("alloy",
                 text + "[output]\ndiagnoses = 1\nunits = { energy = \"eV\" }\n[[diagnoses]]\nkind = \"energies\"\n");
  write_gz(one / "x.eam.fs.gz", finnis_sinclair());
  auto const ran = one.run();
  ASSERT_EQ(ran.status, 0) << ran.err;
  // Two atoms 2 apart: V = 2/16, rho of Cr at Fe = 2/8, of Fe at Cr = 3/8.
  EXPECT_NEAR(one.column("potential energy (eV)")[0], 2.0 / 16 - 1.5 * std::sqrt(2.0 / 8) - 2.5 * std::sqrt(3.0 / 8),
              2e-5);
}

}  // namespace
}  // namespace boltzmann::files_test
