// Trajectories in the hands of other programs: h5py and MDAnalysis, also after a kill.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/files/trajectory_view.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/newton.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "temporary_folder.hpp"

namespace boltzmann::trajectory_readers_test {
namespace {

// Seven frames in a run that is then killed: particle 1 moves with x = step, v = -step; the box grows.
template <int D>
void write_and_die(std::string const& path, bool periodic, std::function<std::string(Dimension)> const& unit_name) {
  pid_t const child = fork();
  if (child == 0) {
    Ensemble<Newton<D>> ions("ions", 5), none("none", 0);
    AnyEnsemble const* const list[] = {&ions, &none};
    TrajectoryOptions options;
    options.unit_name = unit_name;
    options.constant_fields = {"mass"};
    Trajectory file(path, options);
    for (int step = 0; step < 7; ++step) {
      ions[1].position[0] = step;
      ions[1].velocity[0] = -step;
      BoxEdges box{.dimension = D, .low = {}, .high = {5.0 + step, 6, 7}, .periodic = {periodic, periodic, periodic}};
      file.write(10 * step, 2 * step, list, box);
    }
    kill(getpid(), SIGKILL);
  }
  waitpid(child, nullptr, 0);
}

// Three frames of two ensembles, and the view of them that was written with the second one.
void write_shown(std::string const& path, std::function<std::string(Dimension)> const& unit_name) {
  Ensemble<Newton<2>> zinc("zinc", 3), none("none", 0);
  Ensemble<Coulomb<2>> argon("argon", 2);
  AnyEnsemble const* const list[] = {&zinc, &none, &argon};
  TrajectoryOptions options;
  options.unit_name = unit_name;
  Trajectory file(path, options);
  std::vector<double> times;
  for (int step = 0; step < 3; ++step) {
    zinc[1].position = {1.0 * step, 2};
    argon[1].velocity = {0, -1.0 * step};
    argon[0].charge = 3;
    argon[1].mass = 40;
    BoxEdges const box{.dimension = 2, .low = {}, .high = {5.0 + step, 6}, .periodic = {true, true}};
    file.write(10 * step, 2 * step, list, box);
    times.push_back(2 * step);
    if (step == 1)
      write_trajectory_view(path + "md", std::filesystem::path(path).filename().string(), options, list, box, times);
  }
}

bool python(std::string const& text, std::string const& folder) {
  std::ofstream(folder + "/check.py") << text;
  return std::system(("cd " + folder + " && /usr/bin/python3 -W ignore check.py > out.txt 2>&1").c_str()) == 0;
}

std::string output(std::string const& folder) {
  std::ifstream file(folder + "/out.txt");
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string unit_known(Dimension d) {
  return d == dimensions::length ? "nm" : d == dimensions::time ? "fs" : d == dimensions::velocity ? "nm/ps" : "amu";
}

TEST(TrajectoryReaders, H5pyOpensTheFileOfAKilledRun) {
  TemporaryFolder const folder;
  ASSERT_TRUE(python("import h5py", folder.path)) << "h5py is needed (Debian: apt-get install python3-h5py)";
  write_and_die<2>(folder / "t.h5", true, unit_known);
  EXPECT_TRUE(python(R"(
import h5py
f = h5py.File('t.h5', 'r')
assert list(f['h5md'].attrs['version']) == [1, 1]
ions = f['particles/ions']
assert ions['position/value'].shape == (7, 5, 3)
assert ions['position/value'].attrs['unit'] == 'nm'
assert list(ions['position/step'][:]) == [0, 10, 20, 30, 40, 50, 60]
assert list(ions['position/value'][:, 1, 0]) == [0, 1, 2, 3, 4, 5, 6]
assert list(ions['velocity/value'][6, 1]) == [-6, 0, 0]
assert list(ions['mass'][:]) == [1] * 5
assert list(ions['box'].attrs['boundary']) == ['periodic', 'periodic', 'none']
assert ions['box/edges/value'][6].diagonal().tolist() == [11, 6, 1]
assert ions['position/step'] == ions['box/edges/step']
assert f['particles/none/position/value'].shape == (7, 0, 3)
)",
                     folder.path))
      << output(folder.path);
}

TEST(TrajectoryReaders, MdanalysisReadsEveryDimensionWithAndWithoutUnits) {
  TemporaryFolder const folder;
  ASSERT_TRUE(python("import MDAnalysis, h5py", folder.path))
      << "MDAnalysis is needed (Debian: apt-get install python3-mdanalysis python3-h5py)";
  write_and_die<3>(folder / "periodic.h5", true, unit_known);
  write_and_die<2>(folder / "plane.h5", true, unit_known);
  write_and_die<1>(folder / "line.h5", false, {});
  write_and_die<3>(folder / "cgs.h5", true, [](Dimension d) { return d == dimensions::time ? "s" : "cm"; });
  write_shown(folder / "shown.h5", unit_known);
  write_shown(folder / "galaxy.h5", [](Dimension d) { return d == dimensions::time ? "yr" : "pc"; });
  write_shown(folder / "reduced.h5", {});
  EXPECT_TRUE(python(R"(
import MDAnalysis, h5py, numpy as np
def load(name, **options):
    u = MDAnalysis.Universe.empty(5, trajectory=True, velocities=True)
    u.load_new(name, format='H5MD', **options)
    assert len(u.trajectory) == 7
    ts = u.trajectory[3]
    assert ts.data['step'] == 30
    return u, ts
for name, edges in ('periodic.h5', [80, 60, 70]), ('plane.h5', [80, 60, 10]):
    u, ts = load(name)                            # in angstrom and ps
    assert np.allclose(ts.dimensions, edges + [90, 90, 90]), ts.dimensions
    assert np.allclose(u.atoms.positions[1], [30, 0, 0])
    assert np.allclose(u.atoms.velocities[1], [-30, 0, 0])
    assert np.isclose(ts.time, 0.006)
for name in 'line.h5', 'cgs.h5':                  # no units, or units that MDAnalysis doesn't know
    u, ts = load(name, convert_units=False)
    assert np.allclose(u.atoms.positions[1], [3, 0, 0])
    assert np.allclose(u.atoms.velocities[1], [-3, 0, 0])
    assert ts.time == 6
assert load('line.h5', convert_units=False)[1].dimensions is None
for name, length, time in ('shown', 10, 1e-3), ('galaxy', 1, 1), ('reduced', 1, 1):   # what it knows; what it doesn't
    u = MDAnalysis.Universe(name + '.h5md')       # all ensembles, without arguments
    assert len(u.atoms) == 5 and len(u.trajectory) == 3, name
    ts = u.trajectory[2]
    assert np.allclose(u.atoms.positions[1], [2 * length, 2 * length, 0]), (name, u.atoms.positions)
    assert np.allclose(u.atoms.velocities[4], [0, -2 * length, 0]), (name, u.atoms.velocities)
    assert np.allclose(ts.dimensions, [7 * length, 6 * length, length, 90, 90, 90]), (name, ts.dimensions)
    assert ts.data['step'] == 20 and np.isclose(ts.time, 4 * time) and np.isclose(u.trajectory.dt, 2 * time), name
    kinds = h5py.File(name + '.h5md')['particles/trajectory']
    u.add_TopologyAttr('masses', kinds['mass'][:])
    assert u.atoms.masses.tolist() == [1, 1, 1, 1, 40] and kinds['charge'][:].tolist() == [0, 0, 0, 3, 0]
    assert [kinds['species'].attrs['names'][k] for k in kinds['species']] == ['zinc'] * 3 + ['argon'] * 2
)",
                     folder.path))
      << output(folder.path);
}

}  // namespace
}  // namespace boltzmann::trajectory_readers_test
