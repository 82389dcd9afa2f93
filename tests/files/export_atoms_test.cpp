// Frames as LAMMPS data, PDB, GRO, POSCAR and H5MD: as texts, read back by our own readers, and by other programs.
#include <gtest/gtest.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/files/trajectory_export.hpp>
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/newton.hpp>
#include <tests/message.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "temporary_folder.hpp"

namespace boltzmann::export_atoms_test {
namespace {

using namespace literals;

UnitSystem const atomic(1_angstrom, 1_amu, 1_ps);

// Two ions and an argon atom in a box from -1 to 7 (periodic along x), in two frames.
template <int D>
void write_run(std::string const& path, UnitSystem const& units) {
  Ensemble<Coulomb<D>> ions("ions", 2);
  Ensemble<Newton<D>> gas("gas", 1);
  AnyEnsemble const* const list[] = {&ions, &gas};
  TrajectoryOptions options;
  if (!units.is_reduced()) {
    options.unit_name = [units](Dimension d) { return units.display(d).unit; };
    options.factor = [units](Dimension d) { return units.display(d).factor; };
  }
  Trajectory file(path, options);
  BoxEdges box;
  box.dimension = D;
  for (int a = 0; a < D; ++a) box.low[a] = -1, box.high[a] = 7;
  box.periodic[0] = true;
  ions[0].mass = ions[1].mass = 23;
  ions[0].charge = 1, ions[1].charge = -1;
  gas[0].mass = 40;
  for (int frame = 0; frame < 2; ++frame) {
    for (int a = 0; a < D; ++a) {
      ions[1].position[a] = 1.5 + a + frame;
      ions[1].velocity[a] = -0.25 * (a + 1);
      gas[0].position[a] = 6.25;
    }
    file.write(10 * frame, 0.5 * frame, list, box);
  }
}

std::string exported(TemporaryFolder const& folder, std::string const& name, ExportOptions const& options = {}) {
  TrajectoryReader const reader(folder / "t.h5");
  export_trajectory(reader, folder / name, options);
  return name.ends_with(".h5md") ? "" : read_text(folder / name);
}

ExportOptions const salt{.species = {{"ions", "Na"}, {"gas", "Ar"}}};

TEST(ExportAtoms, IsLammpsData) {
  TemporaryFolder const folder;
  write_run<3>(folder / "t.h5", atomic);
  EXPECT_EQ(exported(folder, "a.data", salt),
            "LAMMPS data file by Boltzmann, step 10, units = metal\n\n3 atoms\n2 atom types\n\n"
            "-1 7 xlo xhi\n-1 7 ylo yhi\n-1 7 zlo zhi\n\nMasses\n\n1 23 # Na\n2 40 # Ar\n\nAtoms # charge\n\n"
            "1 1 1 0 0 0\n2 1 -1 2.5 3.5 4.5\n3 2 0 6.25 6.25 6.25\n\n"
            "Velocities\n\n1 0 0 0\n2 -0.25 -0.5 -0.75\n3 0 0 0\n");
}

TEST(ExportAtoms, IsPdbGroAndPoscar) {
  TemporaryFolder const folder;
  write_run<3>(folder / "t.h5", atomic);
  auto options = salt;
  options.frames = {1};
  EXPECT_EQ(exported(folder, "a.pdb", options),
            "TITLE     Boltzmann, step 10\n"
            "CRYST1    8.000    8.000    8.000  90.00  90.00  90.00 P 1           1\n"
            "MODEL        1\n"
            "ATOM      1 Na    NA A   1       0.000   0.000   0.000  1.00  0.00          NA\n"
            "ATOM      2 Na    NA A   1       2.500   3.500   4.500  1.00  0.00          NA\n"
            "ATOM      3 Ar    AR B   2       6.250   6.250   6.250  1.00  0.00          AR\n"
            "ENDMDL\n");
  EXPECT_EQ(exported(folder, "a.gro", options),
            "Boltzmann, t= 0.5 step= 10\n3\n"
            "    1Na      Na    1   0.000   0.000   0.000  0.0000  0.0000  0.0000\n"
            "    1Na      Na    2   0.250   0.350   0.450 -0.0250 -0.0500 -0.0750\n"
            "    2Ar      Ar    3   0.625   0.625   0.625  0.0000  0.0000  0.0000\n"
            "   0.80000   0.80000   0.80000\n");
  EXPECT_EQ(exported(folder, "POSCAR", options),
            "Boltzmann, step 10\n1.0\n8 0 0\n0 8 0\n0 0 8\nNa Ar\n2 1\nCartesian\n0 0 0\n2.5 3.5 4.5\n"
            "6.25 6.25 6.25\n\n0 0 0\n-0.00025 -5e-04 -0.00075\n0 0 0\n");
}

/// What is exported is read with the same numbers, to the digits of the format, in any space and base.
template <int D>
void expect_round_trip(UnitSystem const& units) {
  TemporaryFolder const folder;
  write_run<D>(folder / "t.h5", units);
  TrajectoryReader const reader(folder / "t.h5");
  Box const box = [] {
    Vector<D> low, high;
    for (int a = 0; a < D; ++a) low[a] = -1, high[a] = 7;
    std::array<Boundary, D> boundaries;
    boundaries.fill(Boundary::open);
    boundaries[0] = Boundary::periodic;
    return Box(low, high, boundaries);
  }();
  for (char const* name : {"a.xyz", "a.dump", "a.data", "a.pdb", "a.gro", "a.vasp"}) {
    exported(folder, name, salt);
    bool const one = std::string(name) == "a.data" || std::string(name) == "a.vasp";
    bool const coarse = std::string(name) == "a.pdb" || std::string(name) == "a.gro";
    bool const stills = std::string(name) == "a.pdb";
    std::string const style = std::string(name) == "a.dump" && !units.is_reduced() ? "metal" : "";
    auto const frame = from_particle_file(folder / name, {.frame = one ? 0U : 1U, .units = style});
    ASSERT_EQ(frame.size(), 3U) << name;
    EXPECT_EQ(lattice_misfit(frame, box, {.units = units}), "") << name;
    Ensemble<Newton<D>> ions("ions"), gas("gas");
    FrameOptions options{.species = "Na", .units = units, .resize = true};
    EXPECT_EQ(frame_load(ions, frame, options), 2U) << name;
    options.species = "Ar";
    EXPECT_EQ(frame_load(gas, frame, options), 1U) << name;
    // Pure numbers have the digits that the format has; others those in nm or angstrom.
    double const digit = units.is_reduced() ? 1e-3 : std::string(name) == "a.gro" ? 0.01 : 0.001;
    double const close = coarse ? 0.51 * digit * (units.is_reduced() ? 1 : 1e-10 / units.scale().length) : 1e-12;
    for (int a = 0; a < D; ++a) {
      EXPECT_NEAR(ions[1].position[a], 2.5 + a, close) << name;
      EXPECT_NEAR(gas[0].position[a], 6.25, close) << name;
      if (stills) continue;
      EXPECT_NEAR(ions[1].velocity[a], -0.25 * (a + 1), coarse ? 0.002 : 1e-12) << name;
    }
  }
}

TEST(ExportAtoms, ComesBackAsItWas) {
  expect_round_trip<1>(atomic);
  expect_round_trip<2>(atomic);
  expect_round_trip<3>(atomic);
  expect_round_trip<3>(UnitSystem(2_angstrom, 40_amu, 1_ps));
  expect_round_trip<2>(UnitSystem::reduced());
}

TEST(ExportAtoms, SaysWhatAFormatCanNotHold) {
  TemporaryFolder const folder;
  write_run<3>(folder / "t.h5", atomic);
  TrajectoryReader const reader(folder / "t.h5");
  auto const wrong = [&](std::string const& name, ExportOptions const& options = {}) {
    return message([&] { export_trajectory(reader, folder / name, options); });
  };
  EXPECT_EQ(wrong("a.pdb", {.units = "metal"}), "a file of format PDB is in angstrom; leave out the units");
  EXPECT_EQ(wrong("a.gro", {.fields = {"mass"}}),
            "a file of format GRO has no field 'mass'; it has position, velocity");
  EXPECT_EQ(wrong("a.data", {.frames = {0, 1}}),
            "'" + (folder / "a.data") + "' holds one frame, not 2; choose it, -1 is the last");
  // What is far away has no place in columns; masses that differ none in Masses.
  write_run<3>(folder / "t.h5", UnitSystem(1_nm * 1e4, 1_amu, 1_ps));
  EXPECT_NE(message([&] {
              export_trajectory(TrajectoryReader(folder / "t.h5"), folder / "a.pdb");
            }).find("does not fit into the 9 letters that PDB has for a number"),
            std::string::npos);
  Ensemble<Newton<2>> mixed("mixed", 2);
  mixed[1].mass = 2;
  AnyEnsemble const* const list[] = {&mixed};
  Trajectory(folder / "m.h5").write(0, 0, list, BoxEdges{.dimension = 2});
  EXPECT_EQ(message([&] { export_trajectory(TrajectoryReader(folder / "m.h5"), folder / "a.data"); }),
            "the masses of 'mixed' differ, and LAMMPS data have one for each type; write .dump or .xyz");
}

// ---- Other programs ----

bool python(std::string const& text, std::string const& folder) {
  std::ofstream(folder + "/check.py") << text;
  return std::system(("cd " + folder + " && /usr/bin/python3 -W ignore check.py > out.txt 2>&1").c_str()) == 0;
}

// A Universe of all particles, whatever the base: a run in angstrom and fs, one in parsecs, one of pure numbers.
TEST(ExportAtoms, MdanalysisOpensThemWithoutArguments) {
  TemporaryFolder const folder;
  write_run<3>(folder / "t.h5", UnitSystem(1_angstrom, 1_amu, 1_fs));
  exported(folder, "fs.h5md", salt);
  exported(folder, "fs.pdb", salt);
  exported(folder, "fs.gro", salt);
  exported(folder, "fs.data", salt);
  write_run<2>(folder / "t.h5", UnitSystem(1 * units::parsec, 1 * units::solar_mass, 1 * units::year));
  exported(folder, "pc.h5md", salt);
  write_run<1>(folder / "t.h5", UnitSystem::reduced());
  exported(folder, "lj.h5md", salt);
  EXPECT_TRUE(python(R"(
import MDAnalysis, numpy as np, h5py
u = MDAnalysis.Universe('fs.h5md')
assert len(u.atoms) == 3 and len(u.trajectory) == 2
assert np.isclose(u.trajectory.dt, 0.5e-3), u.trajectory.dt
ts = u.trajectory[1]
assert ts.data['step'] == 10 and np.allclose(ts.dimensions, [8, 8, 8, 90, 90, 90])
assert np.allclose(u.atoms.positions, [[0, 0, 0], [2.5, 3.5, 4.5], [6.25] * 3])
assert np.allclose(u.atoms.velocities[1], [-250, -500, -750])
f = h5py.File('fs.h5md')['particles/trajectory']
assert f['species'][:].tolist() == [0, 0, 1] and list(f['species'].attrs['names']) == ['Na', 'Ar']
assert np.allclose(f['mass'][:], [23, 23, 40]) and f['mass'].attrs['unit'] == 'amu'
assert f['charge'][:].tolist() == [1, -1, 0]
u = MDAnalysis.Universe('pc.h5md')
assert np.isclose(u.atoms.positions[2, 1] / 6.25 / 3.0857e26, 1, rtol=1e-3)
u = MDAnalysis.Universe('lj.h5md')
assert np.allclose(u.trajectory[1].positions[:, 0], [0, 2.5, 6.25])
u = MDAnalysis.Universe('fs.data', 'fs.h5md', atom_style='id type charge x y z')
assert u.atoms.masses.tolist() == [23, 23, 40] and u.atoms.charges.tolist() == [1, -1, 0]
assert len(u.trajectory) == 2
u = MDAnalysis.Universe('fs.pdb')
assert u.atoms.elements.tolist() == ['NA', 'NA', 'AR'] or u.atoms.elements.tolist() == ['Na', 'Na', 'Ar'], u.atoms.elements
assert len(u.trajectory) == 2 and np.allclose(u.trajectory[1].positions[1], [2.5, 3.5, 4.5])
u = MDAnalysis.Universe('fs.gro')
assert u.atoms.names.tolist() == ['Na', 'Na', 'Ar']
)",
                     folder.path))
      << read_text(folder / "out.txt");
}

TEST(ExportAtoms, AseReadsThem) {
  TemporaryFolder const folder;
  write_run<3>(folder / "t.h5", atomic);
  for (char const* name : {"a.data", "a.pdb", "a.vasp"}) exported(folder, name, salt);
  auto last = salt;
  last.frames = {1};
  exported(folder, "a.gro", last);
  EXPECT_TRUE(python(R"(
import ase.io, numpy as np
for atoms in (ase.io.read('a.data', format='lammps-data', style='charge', units='metal'), ase.io.read('a.pdb', index=-1),
              ase.io.read('a.vasp', format='vasp'), ase.io.read('a.gro')):
    assert len(atoms) == 3
    assert np.allclose(atoms.positions[1] - atoms.positions[0], [2.5, 3.5, 4.5]), atoms.positions
    assert np.allclose(atoms.cell.lengths(), [8, 8, 8])
assert np.allclose(ase.io.read('a.data', format='lammps-data', style='charge', units='metal').get_masses(), [23, 23, 40])
)",
                     folder.path))
      << read_text(folder / "out.txt");
}

}  // namespace
}  // namespace boltzmann::export_atoms_test
