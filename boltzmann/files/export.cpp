// Extended XYZ, VTK PolyData and ImageData.
#include <fmt/format.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/export.hpp>
#include <boltzmann/files/spatial.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/schemes/mesh/mesh_field.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace boltzmann {
namespace {

static_assert(std::endian::native == std::endian::little, "the raw data of VTK files say LittleEndian");

// Names without blanks, which separate columns.
std::string word(std::string text) {
  for (char& c : text)
    if (c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == ':' || c == '"' || c == '=') c = '_';
  return text.empty() ? "X" : text;
}

std::string xml(std::string const& text) {
  std::string result;
  for (char const c : text) switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  return result;
}

// The fields that every ensemble has, as the first one describes them, position first.
std::vector<Field> common_fields(std::span<AnyEnsemble const* const> ensembles) {
  std::vector<Field> fields;
  if (ensembles.empty()) return fields;
  for (auto const& field : ensembles[0]->fields()) {
    bool const everywhere = std::all_of(ensembles.begin(), ensembles.end(), [&](AnyEnsemble const* other) {
      Field const* found = other->find_field(field.name);
      return found != nullptr && found->components == field.components;
    });
    if (everywhere) fields.push_back(field);
  }
  return fields;
}

/// What stands behind the XML of a VTK file: every array is its length in bytes as a 64-bit number, then the numbers.
struct AppendedData {
  std::string data;

  /// Begins an array and returns its offset.
  std::size_t begin_array(std::size_t bytes) {
    std::size_t const offset = data.size();
    put(static_cast<std::uint64_t>(bytes));
    return offset;
  }
  template <class T>
  void put(T value) {
    data.append(reinterpret_cast<char const*>(&value), sizeof value);
  }
};

std::string array_tag(char const* type, std::string const& name, int components, std::size_t offset) {
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n", type,
      xml(name), components, offset);
}

/// Everything before the pieces of a data set of this kind, which has these attributes.
std::string vtk_head(char const* kind, std::string const& attributes, double time) {
  std::string now;
  append_number(now, time);
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n"
      "<{0}{1}>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
      "format=\"ascii\">{2}</DataArray>\n</FieldData>\n",
      kind, attributes, now);
}

void write_vtk(std::string const& path, char const* kind, std::string text, AppendedData const& appended) {
  text += fmt::format("</Piece>\n</{}>\n<AppendedData encoding=\"raw\">\n_", kind);
  text += appended.data;
  text += "\n</AppendedData>\n</VTKFile>\n";
  TextFile file(path, TextFile::Mode::replace);
  file.write(text);
  file.close();
}

std::string lattice(BoxEdges const& box) {
  bool open = true, infinite = false;
  for (int axis = 0; axis < box.dimension; ++axis) {
    open = open && !box.periodic[axis];
    infinite = infinite || !std::isfinite(box.low[axis]) || !std::isfinite(box.high[axis]);
  }
  if (open && infinite) return "";
  std::string edges, origin;
  for (int row = 0; row < 3; ++row) {
    bool const finite = row < box.dimension && std::isfinite(box.low[row]) && std::isfinite(box.high[row]);
    for (int column = 0; column < 3; ++column) {
      double const length = row != column ? 0 : finite ? box.high[row] - box.low[row] : 1;
      if (row + column > 0) edges += ' ';
      append_number(edges, length);
    }
    if (row > 0) origin += ' ';
    append_number(origin, finite ? box.low[row] : 0);
  }
  return fmt::format("Lattice=\"{}\" Origin=\"{}\" ", edges, origin);
}

}  // namespace

void write_xyz(std::string const& path, double time, std::span<AnyEnsemble const* const> ensembles, BoxEdges const& box,
               bool append, std::function<std::string(Dimension)> const& unit_name) {
  std::vector<Field> const fields = common_fields(ensembles);
  std::size_t total = 0;
  for (auto const* ensemble : ensembles) total += ensemble->size();
  std::string text = fmt::format("{}\n{}Properties=species:S:1", total, lattice(box));
  auto const columns = [&](Field const& field) {
    return !ensembles.empty() && is_spatial(field, ensembles[0]->dimension()) ? 3 : field.components;
  };
  for (auto const& field : fields) {
    std::string const name = field.name == "position" ? "pos" : field.name == "velocity" ? "velo" : word(field.name);
    text += fmt::format(":{}:R:{}", name, columns(field));
  }
  if (fields.empty()) text += ":pos:R:3";
  text += " pbc=\"";
  for (int axis = 0; axis < 3; ++axis)
    text += fmt::format("{}{}", axis > 0 ? " " : "", axis < box.dimension && box.periodic[axis] ? "T" : "F");
  text += "\" Time=";
  append_number(text, time);
  auto const unit = [&](char const* key, Dimension dimension) {
    std::string const name = unit_name ? unit_name(dimension) : "";
    if (!name.empty()) text += fmt::format(" {}=\"{}\"", key, name);
  };
  unit("Length_unit", dimensions::length);
  unit("Time_unit", dimensions::time);
  text += '\n';

  TextFile file(path, append ? TextFile::Mode::append : TextFile::Mode::replace);
  for (auto const* ensemble : ensembles) {
    std::string const species = word(ensemble->name());
    std::vector<int> offsets;
    offsets.reserve(fields.size());
    for (auto const& field : fields) offsets.push_back(ensemble->find_field(field.name)->offset);
    for (std::size_t i = 0; i < ensemble->size(); ++i) {
      text += species;
      for (std::size_t k = 0; k < fields.size(); ++k)
        for (int c = 0; c < columns(fields[k]); ++c) {
          text += ' ';
          append_number(text, c < fields[k].components ? ensemble->row(i)[offsets[k] + c] : 0.0);
        }
      text += '\n';
    }
  }
  file.write(text);
  file.close();
}

void write_vtp(std::string const& path, double time, AnyEnsemble const& ensemble) {
  std::size_t const n = ensemble.size();
  AppendedData appended;
  auto const add_field = [&](Field const& field) {
    int const columns = is_spatial(field, ensemble.dimension()) ? 3 : field.components;
    std::size_t const offset = appended.begin_array(n * static_cast<std::size_t>(columns) * sizeof(double));
    for (std::size_t i = 0; i < n; ++i)
      for (int c = 0; c < columns; ++c) appended.put(c < field.components ? ensemble.row(i)[field.offset + c] : 0.0);
    return array_tag("Float64", field.name, columns, offset);
  };
  auto const add_integers = [&](char const* name, std::int64_t first) {
    std::size_t const offset = appended.begin_array(n * sizeof(std::int64_t));
    for (std::size_t i = 0; i < n; ++i) appended.put(first + static_cast<std::int64_t>(i));
    return array_tag("Int64", name, 1, offset);
  };

  std::string text = vtk_head("PolyData", "", time);
  text += fmt::format(
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\">\n",
      n, n);
  text += "<PointData>\n";
  for (auto const& field : ensemble.fields())
    if (field.name != "position") text += add_field(field);
  text += add_integers("id", 0);
  text += "</PointData>\n<Points>\n";
  text += add_field(ensemble.field("position"));
  text += "</Points>\n<Verts>\n";
  text += add_integers("connectivity", 0);
  text += add_integers("offsets", 1);
  text += "</Verts>\n";
  write_vtk(path, "PolyData", std::move(text), appended);
}

void write_vti(std::string const& path, double time, std::span<MeshField const* const> fields) {
  if (fields.empty()) throw Error(path + ": there is no mesh to write");
  MeshGrid const& grid = fields.front()->grid;
  std::string extent, origin, spacing;
  for (int a = 0; a < 3; ++a) {
    if (a > 0) extent += ' ', origin += ' ', spacing += ' ';
    extent += fmt::format("0 {}", grid.nodes[a] - 1);
    append_number(origin, grid.low[a]);
    append_number(spacing, grid.spacing[a]);
  }
  AppendedData appended;
  std::string arrays;
  for (auto const* field : fields) {
    if (field->grid.nodes != grid.nodes || field->grid.low != grid.low || field->grid.spacing != grid.spacing)
      throw Error(path + ": " + field->name + " is on another mesh than " + fields.front()->name);
    bool const vector = field->components.size() > 1 || field->name == "field";
    std::size_t const columns = vector ? std::max<std::size_t>(3, field->components.size()) : 1;
    std::size_t const offset = appended.begin_array(grid.size() * columns * sizeof(double));
    for (std::size_t node = 0; node < grid.size(); ++node)
      for (std::size_t c = 0; c < columns; ++c)
        appended.put(c < field->components.size() ? field->components[c][node] : 0.0);
    arrays += array_tag("Float64", field->name, static_cast<int>(columns), offset);
  }
  std::string text = vtk_head(
      "ImageData", fmt::format(" WholeExtent=\"{}\" Origin=\"{}\" Spacing=\"{}\"", extent, origin, spacing), time);
  text += fmt::format("<Piece Extent=\"{}\">\n<PointData>\n{}</PointData>\n", extent, arrays);
  write_vtk(path, "ImageData", std::move(text), appended);
}

}  // namespace boltzmann
