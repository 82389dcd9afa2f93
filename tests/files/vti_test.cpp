// VTK ImageData: what a reader of the format finds in the files, and the index of a time series.
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/export.hpp>
#include <boltzmann/files/mesh_frames.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/schemes/mesh/mesh_field.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "temporary_folder.hpp"
#include "vtk_array.hpp"

namespace boltzmann::vti_test {
namespace {

MeshField ramp(std::string name, MeshGrid const& grid, std::size_t components) {
  MeshField field{std::move(name), dimensions::none, grid, {}};
  for (std::size_t c = 0; c < components; ++c) {
    field.components.emplace_back();
    for (std::size_t i = 0; i < grid.size(); ++i)
      field.components[c].push_back(0.1 * static_cast<double>(i) + 100 * static_cast<double>(c));
  }
  return field;
}

MeshGrid grid_2d() {
  return make_grid(Box(Vector{-1., 2.}, Vector{3., 5.}, {Boundary::periodic, Boundary::open}), {4, 2});
}

std::string attribute(std::string const& file, std::string const& tag, std::string const& name) {
  std::size_t const at = file.find(" " + name + "=\"", file.find("<" + tag));
  if (at == std::string::npos) return "none";
  std::size_t const begin = at + name.size() + 3;
  return file.substr(begin, file.find('"', begin) - begin);
}

TEST(Vti, HoldsTheMeshAndEveryField) {
  TemporaryFolder const folder;
  MeshField const density = ramp("density", grid_2d(), 1), field = ramp("field", grid_2d(), 2);
  MeshField const* const fields[] = {&density, &field};
  write_vti(folder / "a.vti", 2.5, fields);
  std::string const file = read_text(folder / "a.vti");
  EXPECT_EQ(attribute(file, "VTKFile", "type"), "ImageData");
  EXPECT_EQ(attribute(file, "VTKFile", "header_type"), "UInt64");
  // Four nodes along the periodic axis, three along the open one.
  EXPECT_EQ(attribute(file, "ImageData", "WholeExtent"), "0 3 0 2 0 0");
  EXPECT_EQ(attribute(file, "Piece", "Extent"), "0 3 0 2 0 0");
  EXPECT_EQ(attribute(file, "ImageData", "Origin"), "-1 2 0");
  EXPECT_EQ(attribute(file, "ImageData", "Spacing"), "1 1.5 1");
  EXPECT_NE(file.find("Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">2.5<"), std::string::npos);
  EXPECT_EQ(array_of(file, "density"), density.components[0]);
  auto const vectors = array_of(file, "field");
  ASSERT_EQ(vectors.size(), 36U);
  for (std::size_t node = 0; node < 12; ++node) {
    EXPECT_EQ(vectors[3 * node], field.components[0][node]);
    EXPECT_EQ(vectors[3 * node + 1], field.components[1][node]);
    EXPECT_EQ(vectors[3 * node + 2], 0);
  }
  EXPECT_NE(file.find("Name=\"field\" NumberOfComponents=\"3\""), std::string::npos);
  // The file ends where the data end.
  EXPECT_TRUE(file.ends_with("\n</AppendedData>\n</VTKFile>\n"));
  std::size_t const data = file.find('_', file.find("<AppendedData")) + 1;
  EXPECT_EQ(file.find("\n</AppendedData>", data), data + 8 + 12 * 8 + 8 + 36 * 8);
}

TEST(Vti, OneAndThreeDimensions) {
  TemporaryFolder const folder;
  MeshField const line = ramp("field", make_grid(Box(Vector{0.}, Vector{1.}, Boundary::periodic), {10}), 1);
  MeshField const* const one[] = {&line};
  write_vti(folder / "a.vti", 0, one);
  std::string file = read_text(folder / "a.vti");
  EXPECT_EQ(attribute(file, "ImageData", "WholeExtent"), "0 9 0 0 0 0");
  EXPECT_EQ(attribute(file, "ImageData", "Spacing"), "0.1 1 1");
  EXPECT_EQ(array_of(file, "field").size(), 30U);
  MeshField const cube =
      ramp("potential", make_grid(Box(Vector{0., 0., 0.}, Vector{1., 1., 1.}, Boundary::open), {2, 3, 4}), 1);
  MeshField const* const three[] = {&cube};
  write_vti(folder / "a.vti", 0, three);
  file = read_text(folder / "a.vti");
  EXPECT_EQ(attribute(file, "ImageData", "WholeExtent"), "0 2 0 3 0 4");
  EXPECT_EQ(array_of(file, "potential"), cube.components[0]);
}

TEST(Vti, MistakesAreOneLine) {
  TemporaryFolder const folder;
  MeshField const density = ramp("density", grid_2d(), 1);
  MeshField const other = ramp("potential", make_grid(Box(Vector{0.}, Vector{1.}, Boundary::periodic), {10}), 1);
  MeshField const* const fields[] = {&density, &other};
  EXPECT_NE(message([&] { write_vti(folder / "a.vti", 0, fields); }).find("potential is on another mesh than density"),
            std::string::npos);
  EXPECT_NE(message([&] { write_vti(folder / "a.vti", 0, {}); }).find("no mesh to write"), std::string::npos);
  MeshField const* const one[] = {&density};
  EXPECT_EQ(message([&] { write_vti("/dev/full", 0, one); }), "/dev/full: can't be written: No space left on device");
}

TEST(MeshFrames, IndexIsWhatIsThere) {
  TemporaryFolder const folder;
  MeshField const density = ramp("density", grid_2d(), 1);
  MeshField const* const fields[] = {&density};
  MeshFrames frames(folder / "");
  for (int n = 0; n < 4; ++n) frames.write(100 * n, 0.1 * n, fields);
  auto const index = [](std::string const& sets) {
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
           "<Collection>\n" +
           sets + "</Collection>\n</VTKFile>\n";
  };
  std::string const first = "<DataSet timestep=\"0\" file=\"mesh/000000000.vti\"/>\n",
                    second = "<DataSet timestep=\"0.1\" file=\"mesh/000000100.vti\"/>\n",
                    third = "<DataSet timestep=\"0.2\" file=\"mesh/000000200.vti\"/>\n";
  EXPECT_EQ(read_text(folder / "mesh.pvd").substr(0, 200), index(first + second + third).substr(0, 200));
  std::ofstream(folder / "mesh/notes.txt") << "somebody's";
  auto again = MeshFrames::append_to(folder / "", 150);
  EXPECT_EQ(read_text(folder / "mesh.pvd"), index(first + second));
  EXPECT_FALSE(std::filesystem::exists(folder / "mesh/000000200.vti"));
  again.write(200, 0.2, fields);
  EXPECT_EQ(read_text(folder / "mesh.pvd"), index(first + second + third));
  // A frame that is cut off is named; those after the last step are removed unread.
  std::filesystem::resize_file(folder / "mesh/000000200.vti", 100);
  MeshFrames::append_to(folder / "", 150);
  std::filesystem::resize_file(folder / "mesh/000000100.vti", 100);
  std::string const refused = message([&] { MeshFrames::append_to(folder / "", 150); });
  EXPECT_NE(refused.find("mesh/000000100.vti' is an incomplete mesh frame; remove it"), std::string::npos) << refused;
  MeshFrames::remove(folder / "");
  EXPECT_FALSE(std::filesystem::exists(folder / "mesh.pvd"));
  EXPECT_FALSE(std::filesystem::exists(folder / "mesh/000000000.vti"));
  EXPECT_TRUE(std::filesystem::exists(folder / "mesh/notes.txt"));
}

}  // namespace
}  // namespace boltzmann::vti_test
