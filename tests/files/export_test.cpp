// Export: the files as other programs define them.
#include <gtest/gtest.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/export.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <tests/message.hpp>

#include <limits>

#include "temporary_folder.hpp"
#include "vtk_array.hpp"

namespace boltzmann::export_test {
namespace {

BoxEdges box_2d() {
  BoxEdges box;
  box.dimension = 2;
  box.low[0] = -1, box.high[0] = 3, box.low[1] = 0, box.high[1] = 2.5;
  box.periodic[0] = true;
  return box;
}

TEST(Xyz, IsExtendedXyz) {
  TemporaryFolder const folder;
  Ensemble<Newton<2>> ions("heavy ions", 2);
  ions[0].position = {0.5, 0.25};
  ions[1].position = {1, 2};
  ions[1].velocity = {-1e-3, 0.1};
  ions[1].mass = 40;
  AnyEnsemble const* const list[] = {&ions};
  write_xyz(folder / "a.xyz", 1.5, list, box_2d());
  std::string const frame =
      "2\nLattice=\"4 0 0 0 2.5 0 0 0 1\" Origin=\"-1 0 0\" Properties=species:S:1:pos:R:3:mass:R:1:velo:R:3 pbc=\"T F "
      "F\" "
      "Time=1.5\n"
      "heavy_ions 0.5 0.25 0 1 0 0 0\n"
      "heavy_ions 1 2 0 40 -0.001 0.1 0\n";
  EXPECT_EQ(read_text(folder / "a.xyz"), frame);
  write_xyz(folder / "a.xyz", 1.5, list, box_2d(), true);
  EXPECT_EQ(read_text(folder / "a.xyz"), frame + frame);
  write_xyz(folder / "a.xyz", 1.5, list, box_2d());
  EXPECT_EQ(read_text(folder / "a.xyz"), frame);
}

TEST(Xyz, SeveralEnsemblesShareTheirCommonFields) {
  TemporaryFolder const folder;
  Ensemble<Coulomb<3>> ions("ions", 1);
  Ensemble<Newton<3>> none("none", 0), dust("dust", 1);
  BoxEdges open;
  for (int axis = 0; axis < 3; ++axis) {
    open.low[axis] = -std::numeric_limits<double>::infinity();
    open.high[axis] = std::numeric_limits<double>::infinity();
  }
  AnyEnsemble const* const list[] = {&ions, &none, &dust};
  write_xyz(folder / "a.xyz", 0, list, open, false, [](Dimension d) { return d == dimensions::length ? "nm" : ""; });
  EXPECT_EQ(read_text(folder / "a.xyz"),
            "2\nProperties=species:S:1:pos:R:3:mass:R:1:velo:R:3 pbc=\"F F F\" Time=0 Length_unit=\"nm\"\n"
            "ions 0 0 0 1 0 0 0\ndust 0 0 0 1 0 0 0\n");
  write_xyz(folder / "b.xyz", 0, {}, open);
  EXPECT_EQ(read_text(folder / "b.xyz"), "0\nProperties=species:S:1:pos:R:3 pbc=\"F F F\" Time=0\n");
}

TEST(Vtp, HoldsPointsVerticesAndEveryField) {
  TemporaryFolder const folder;
  Ensemble<Vortex<2>> vortices("vortices", 3);
  for (std::size_t i = 0; i < 3; ++i) {
    vortices[i].position = {static_cast<double>(i), 0.5};
    vortices[i].vorticity[0] = -0.25 * static_cast<double>(i);
    vortices[i].core = 0.125;
  }
  write_vtp(folder / "a.vtp", 2.5, vortices);
  std::string const file = read_text(folder / "a.vtp");
  EXPECT_EQ(array_of<double>(file, "position"), (std::vector<double>{0, 0.5, 0, 1, 0.5, 0, 2, 0.5, 0}));
  EXPECT_EQ(array_of<double>(file, "vorticity"), (std::vector<double>{0, -0.25, -0.5}));
  EXPECT_EQ(array_of<double>(file, "core"), (std::vector<double>{0.125, 0.125, 0.125}));
  EXPECT_EQ(array_of<std::int64_t>(file, "connectivity"), (std::vector<std::int64_t>{0, 1, 2}));
  EXPECT_EQ(array_of<std::int64_t>(file, "offsets"), (std::vector<std::int64_t>{1, 2, 3}));
  EXPECT_NE(file.find("NumberOfPoints=\"3\" NumberOfVerts=\"3\""), std::string::npos);
  EXPECT_NE(file.find("Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">2.5<"), std::string::npos);
  vortices.resize(0);
  write_vtp(folder / "a.vtp", 0, vortices);
  EXPECT_EQ(array_of<double>(read_text(folder / "a.vtp"), "position"), std::vector<double>{});
}

TEST(Export, FullDiskIsOneErrorLine) {
  Ensemble<Newton<3>> ions("ions", 1);
  AnyEnsemble const* const list[] = {&ions};
  std::string const expected = "/dev/full: can't be written: No space left on device";
  EXPECT_EQ(message([&] { write_vtp("/dev/full", 0, ions); }), expected);
  EXPECT_EQ(message([&] { write_xyz("/dev/full", 0, list, box_2d()); }), expected);
  EXPECT_EQ(message([&] { write_xyz("/dev/full", 0, list, box_2d(), true); }), expected);
  EXPECT_EQ(message([&] { write_vtp("/nowhere/a.vtp", 0, ions); }),
            "/nowhere/a.vtp: can't open it for writing: No such file or directory");
}

}  // namespace
}  // namespace boltzmann::export_test
