// Exported trajectories: the texts as their formats define them, and in the hands of the programs they are for.
#include <gtest/gtest.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/files/trajectory_export.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/newton.hpp>
#include <tests/message.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

#include "temporary_folder.hpp"

namespace boltzmann::trajectory_export_test {
namespace {

using namespace literals;

TrajectoryOptions options_of(UnitSystem const& units) {
  TrajectoryOptions options;
  if (!units.is_reduced()) {
    options.unit_name = [units](Dimension d) { return units.display(d).unit; };
    options.factor = [units](Dimension d) { return units.display(d).factor; };
  }
  return options;
}

BoxEdges box_of(int dimension) {
  BoxEdges box;
  box.dimension = dimension;
  for (int a = 0; a < dimension; ++a) box.low[a] = -1, box.high[a] = 3;
  box.periodic[0] = true;
  return box;
}

// Three frames; ion 0 is at x = 0, 0.5, 1; an ion and the dust come in the second frame.
template <int D>
void write_run(std::string const& path, UnitSystem const& units) {
  Ensemble<Coulomb<D>> ions("heavy ions", 1);
  Ensemble<Newton<D>> dust("dust", 0);
  AnyEnsemble const* const list[] = {&ions, &dust};
  Trajectory file(path, options_of(units));
  for (int frame = 0; frame < 3; ++frame) {
    if (frame == 1) {
      ions.resize(2);
      ions[1].position[0] = 2;
      ions[1].charge = -1;
      dust.resize(1);
      dust[0].mass = 4;
    }
    ions[0].position[0] = 0.5 * frame;
    ions[0].velocity[0] = 0.25;
    ions[0].charge = 1;
    file.write(10 * frame, 2 * frame, list, box_of(D));
  }
}

UnitSystem const atomic(1_angstrom, 1_amu, 1_ps);

std::string exported(TemporaryFolder const& folder, std::string const& name, ExportOptions const& options = {}) {
  TrajectoryReader const reader(folder / "t.h5");
  export_trajectory(reader, folder / name, options);
  return read_text(folder / name);
}

TEST(TrajectoryExport, IsExtendedXyz) {
  TemporaryFolder const folder;
  write_run<2>(folder / "t.h5", atomic);
  EXPECT_EQ(
      exported(folder, "a.xyz", {.frames = {0, 1}, .ensembles = {}, .fields = {"velocity", "mass"}}),
      "1\nLattice=\"4 0 0 0 4 0 0 0 1\" Origin=\"-1 -1 0\" Properties=species:S:1:pos:R:3:id:I:1:mass:R:1:velo:R:3 "
      "pbc=\"T F F\" Time=0 Step=0 Length_unit=\"angstrom\" Time_unit=\"ps\" mass_unit=\"amu\" "
      "velo_unit=\"angstrom/ps\"\n"
      "heavy_ions 0 0 0 1 1 0.25 0 0\n"
      "3\nLattice=\"4 0 0 0 4 0 0 0 1\" Origin=\"-1 -1 0\" Properties=species:S:1:pos:R:3:id:I:1:mass:R:1:velo:R:3 "
      "pbc=\"T F F\" Time=2 Step=10 Length_unit=\"angstrom\" Time_unit=\"ps\" mass_unit=\"amu\" "
      "velo_unit=\"angstrom/ps\"\n"
      "heavy_ions 0.5 0 0 1 1 0.25 0 0\nheavy_ions 2 0 0 2 1 0 0 0\ndust 0 0 0 3 4 0 0 0\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.xyz.part"));
}

TEST(TrajectoryExport, IsALammpsDump) {
  TemporaryFolder const folder;
  write_run<3>(folder / "t.h5", atomic);
  EXPECT_EQ(exported(folder, "a.dump", {.frames = {1}, .ensembles = {"heavy ions"}, .species = {{"heavy ions", "Na"}}}),
            "ITEM: TIMESTEP\n10\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp ff ff\n-1 3\n-1 3\n-1 3\n"
            "ITEM: ATOMS id type element x y z mass vx vy vz q\n"
            "1 1 Na 0.5 0 0 1 0.25 0 0 1\n2 1 Na 2 0 0 1 0 0 0 -1\n");
}

TEST(TrajectoryExport, IsCsvWithTheFieldsOfAllEnsembles) {
  TemporaryFolder const folder;
  write_run<1>(folder / "t.h5", UnitSystem::reduced());
  EXPECT_EQ(exported(folder, "a.csv", {.frames = {0, 2}}),
            "step,time,ensemble,number,position,mass,velocity,charge\n"
            "0,0,heavy ions,0,0,1,0.25,1\n"
            "20,4,heavy ions,0,1,1,0.25,1\n20,4,heavy ions,1,2,1,0,-1\n20,4,dust,0,0,4,0,\n");
}

TEST(TrajectoryExport, ChangesUnits) {
  TemporaryFolder const folder;
  write_run<3>(folder / "t.h5", UnitSystem(2.5_angstrom, 39.948_amu, 1_fs));
  auto const lines = [&](ExportOptions const& options, std::string const& name) {
    std::string const text = exported(folder, name, options);
    return text.substr(text.rfind("dust"));
  };
  // Lengths of 2.5 angstrom, masses of 39.948 amu, velocities of 2500 angstrom/ps.
  EXPECT_EQ(exported(folder, "a.xyz", {.frames = {2}, .ensembles = {"heavy ions"}, .fields = {"velocity"}})
                .substr(std::string("2\nLattice=\"10 0 0 0 10 0 0 0 10\" Origin=\"-2.5 -2.5 -2.5\" ").size()),
            "Properties=species:S:1:pos:R:3:id:I:1:velo:R:3 pbc=\"T F F\" Time=0.004 Step=20 Length_unit=\"angstrom\" "
            "Time_unit=\"ps\" velo_unit=\"angstrom/ps\"\nheavy_ions 2.5 0 0 1 625 0 0\nheavy_ions 5 0 0 2 0 0 0\n");
  auto const si = lines({.frames = {1}, .fields = {"mass"}, .units = "si"}, "b.xyz");
  double x = 0, mass = 0;
  ASSERT_EQ(std::sscanf(si.c_str(), "dust %lf 0 0 3 %lf", &x, &mass), 2) << si;
  EXPECT_NEAR(mass, 4 * 39.948 * 1.66053906660e-27, 1e-36);
  TrajectoryReader const reader(folder / "t.h5");
  auto const report = export_trajectory(reader, folder / "c.csv", {});
  EXPECT_EQ(report.units, "run");
  EXPECT_EQ(report.frames, 3U);
}

TEST(TrajectoryExport, ChoosesFramesAsPythonDoes) {
  using Frames = std::vector<std::size_t>;
  EXPECT_EQ(chosen_frames("3", 10), (Frames{3}));
  EXPECT_EQ(chosen_frames("-1", 10), (Frames{9}));
  EXPECT_EQ(chosen_frames("2:5", 10), (Frames{2, 3, 4}));
  EXPECT_EQ(chosen_frames("::4", 10), (Frames{0, 4, 8}));
  EXPECT_EQ(chosen_frames("-3:", 10), (Frames{7, 8, 9}));
  EXPECT_EQ(chosen_frames(":2:", 10), (Frames{0, 1}));
  EXPECT_EQ(chosen_frames("5:100", 7), (Frames{5, 6}));
  EXPECT_EQ(message([] { chosen_frames("10", 10); }),
            "frames '10': the trajectory has frames 0 to 9 (or -1 to -10 from the end)");
  EXPECT_EQ(message([] { chosen_frames("20:30", 10); }), "frames '20:30': none of the 10 frames is chosen");
  EXPECT_EQ(message([] { chosen_frames("1:2:0", 10); }), "frames '1:2:0': every is 1 or more");
  for (char const* text : {"", "a", "1:2:3:4", "1.5", "1,2"})
    EXPECT_NE(message([&] { chosen_frames(text, 10); }).find("from:to:every"), std::string::npos) << text;
}

TEST(TrajectoryExport, TellsWhatIsWrongInOneLine) {
  TemporaryFolder const folder;
  write_run<2>(folder / "t.h5", atomic);
  write_run<2>(folder / "reduced.h5", UnitSystem::reduced());
  TrajectoryReader const reader(folder / "t.h5"), reduced(folder / "reduced.h5");
  auto const wrong = [&](std::string const& name, ExportOptions const& options = {}) {
    return message([&] { export_trajectory(reader, folder / name, options); });
  };
  EXPECT_NE(wrong("a.xzy").find("There are .xyz, .extxyz, .dump"), std::string::npos) << wrong("a.xzy");
  EXPECT_NE(wrong("a.xzy").find("did you mean '.xyz'?"), std::string::npos) << wrong("a.xzy");
  EXPECT_NE(wrong("a").find("by the ending of"), std::string::npos);
  EXPECT_EQ(wrong("a.xyz", {.ensembles = {"dusk"}}),
            "there is no ensemble 'dusk' in the trajectory; it has heavy ions, dust; did you mean 'dust'?");
  EXPECT_NE(wrong("a.csv", {.fields = {"masss"}}).find("did you mean 'mass'?"), std::string::npos);
  EXPECT_NE(wrong("a.xyz", {.fields = {"charge"}}).find("'charge' is not in dust"), std::string::npos);
  EXPECT_NE(wrong("a.xyz", {.units = "mteal"}).find("did you mean 'metal'?"), std::string::npos);
  EXPECT_NE(wrong("a.vtp").find("one frame of one ensemble, not 3 of 2"), std::string::npos);
  EXPECT_EQ(message([&] { export_trajectory(reduced, folder / "a.xyz", {.units = "si"}); }),
            "the run has pure numbers, which can't become units of 'si'");
  EXPECT_EQ(message([&] { export_trajectory(reader, "/nowhere/a.xyz"); }),
            "/nowhere/a.xyz.part: can't open it for writing: No such file or directory");
  std::filesystem::create_directory(folder / "is.xyz");
  EXPECT_NE(wrong("is.xyz").find("is.xyz: can't be written: "), std::string::npos);
  for (auto const& entry : std::filesystem::directory_iterator(folder.path))
    EXPECT_FALSE(entry.path().string().ends_with(".part")) << entry.path();
}

TEST(TrajectoryExport, TimeSeriesKeepWhatIsNotTheirs) {
  TemporaryFolder const folder;
  write_run<2>(folder / "t.h5", atomic);
  TrajectoryReader const reader(folder / "t.h5");
  export_trajectory(reader, folder / "run.pvd", {});
  EXPECT_TRUE(std::filesystem::exists(folder / "run/heavy_ions-000000010.vtp"));
  std::ofstream(folder / "run/notes.txt") << "mine";
  export_trajectory(reader, folder / "run.pvd", {.frames = {2}, .ensembles = {"dust"}});
  std::size_t files = 0;
  for (auto const& entry : std::filesystem::directory_iterator(folder / "run")) files += entry.exists();
  EXPECT_EQ(files, 2U);
  EXPECT_EQ(read_text(folder / "run.pvd"),
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
            "<Collection>\n<DataSet timestep=\"4\" group=\"\" part=\"0\" name=\"dust\" "
            "file=\"run/dust-000000020.vtp\"/>\n</Collection>\n</VTKFile>\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "run.part"));
}

// ---- Other programs ----

bool python(std::string const& text, std::string const& folder) {
  std::ofstream(folder + "/check.py") << text;
  return std::system(("cd " + folder + " && /usr/bin/python3 -W ignore check.py > out.txt 2>&1").c_str()) == 0;
}

TEST(TrajectoryExport, MdanalysisReadsDumpsAndXyz) {
  TemporaryFolder const folder;
  for (int dimension = 1; dimension <= 3; ++dimension) {
    if (dimension == 1) write_run<1>(folder / "t.h5", atomic);
    if (dimension == 2) write_run<2>(folder / "t.h5", atomic);
    if (dimension == 3) write_run<3>(folder / "t.h5", atomic);
    // It wants the same particles in all frames.
    exported(folder, "a.dump", {.frames = {1, 2}});
    exported(folder, "a.xyz", {.frames = {1, 2}});
    EXPECT_TRUE(python(R"(
import MDAnalysis, numpy as np
u = MDAnalysis.Universe('a.dump', format='LAMMPSDUMP', topology_format='LAMMPSDUMP')
assert len(u.trajectory) == 2 and len(u.atoms) == 3
assert u.atoms.types.tolist() == ['1', '1', '2']
ts = u.trajectory[1]
assert ts.data['step'] == 20
assert np.isclose(ts.dimensions[0], 4)
assert np.allclose(u.atoms.positions[:, 0] - u.atoms.positions[2, 0], [1, 2, 0]), u.atoms.positions
u = MDAnalysis.Universe('a.xyz', format='XYZ', topology_format='XYZ')
assert len(u.trajectory) == 2 and u.atoms.names.tolist() == ['heavy_ions', 'heavy_ions', 'dust']
u.trajectory[1]
assert np.allclose(u.atoms.positions, [[1, 0, 0], [2, 0, 0], [0, 0, 0]]), u.atoms.positions
)",
                       folder.path))
        << dimension << "D: " << read_text(folder / "out.txt");
  }
}

TEST(TrajectoryExport, AseReadsXyzAndDumps) {
  TemporaryFolder const folder;
  write_run<3>(folder / "t.h5", atomic);
  exported(folder, "a.xyz", {.species = {{"heavy ions", "Na"}, {"dust", "C"}}});
  // Its reader of dumps fails at a frame of one particle.
  exported(folder, "a.dump", {.frames = {1, 2}, .species = {{"heavy ions", "Na"}, {"dust", "C"}}});
  EXPECT_TRUE(python(R"(
import ase.io, numpy as np
frames = ase.io.read('a.xyz', index=':')
assert [len(frame) for frame in frames] == [1, 3, 3]
last = frames[2]
assert last.get_chemical_symbols() == ['Na', 'Na', 'C']
assert np.allclose(last.positions, [[1, 0, 0], [2, 0, 0], [0, 0, 0]])
assert np.allclose(last.cell.lengths(), [4, 4, 4]) and last.pbc.tolist() == [True, False, False]
assert last.info['Time'] == 4 and last.info['Step'] == 20 and last.info['velo_unit'] == 'angstrom/ps'
assert np.allclose(last.arrays['velo'][0], [0.25, 0, 0]) and last.arrays['id'].tolist() == [1, 2, 3]
frames = ase.io.read('a.dump', index=':', format='lammps-dump-text')
assert [len(frame) for frame in frames] == [3, 3]
assert frames[1].get_chemical_symbols() == ['Na', 'Na', 'C']
assert frames[1].pbc.tolist() == [True, False, False]
x = frames[1].positions[:, 0]
assert np.allclose(x - x[2], [1, 2, 0]), x
)",
                     folder.path))
      << read_text(folder / "out.txt");
}

}  // namespace
}  // namespace boltzmann::trajectory_export_test
