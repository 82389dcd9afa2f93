// Extended XYZ and VTK PolyData.
#include <fmt/format.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/export.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace boltzmann {
namespace {

static_assert(std::endian::native == std::endian::little, "the raw data of write_vtp say LittleEndian");

bool is_spatial(Field const& field, int dimension) {
  return (field.name == "position" || field.name == "velocity" || field.name == "force") &&
         field.components == dimension;
}

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
  std::string data;  // every array: its length in bytes as a 64-bit number, then the numbers
  auto const begin_array = [&](std::size_t bytes) {
    std::size_t const offset = data.size();
    std::uint64_t const header = bytes;
    data.append(reinterpret_cast<char const*>(&header), sizeof header);
    return offset;
  };
  auto const put = [&](auto value) { data.append(reinterpret_cast<char const*>(&value), sizeof value); };
  auto const add_field = [&](Field const& field) {
    int const columns = is_spatial(field, ensemble.dimension()) ? 3 : field.components;
    std::size_t const offset = begin_array(n * static_cast<std::size_t>(columns) * sizeof(double));
    for (std::size_t i = 0; i < n; ++i)
      for (int c = 0; c < columns; ++c) put(c < field.components ? ensemble.row(i)[field.offset + c] : 0.0);
    return fmt::format(
        "<DataArray type=\"Float64\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
        xml(field.name), columns, offset);
  };
  auto const add_integers = [&](char const* name, std::int64_t first) {
    std::size_t const offset = begin_array(n * sizeof(std::int64_t));
    for (std::size_t i = 0; i < n; ++i) put(first + static_cast<std::int64_t>(i));
    return fmt::format("<DataArray type=\"Int64\" Name=\"{}\" format=\"appended\" offset=\"{}\"/>\n", name, offset);
  };

  std::string now;
  append_number(now, time);
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n"
      "<PolyData>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
      "format=\"ascii\">{}</DataArray>\n"
      "</FieldData>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\">\n",
      now, n, n);
  text += "<PointData>\n";
  for (auto const& field : ensemble.fields())
    if (field.name != "position") text += add_field(field);
  text += add_integers("id", 0);
  text += "</PointData>\n<Points>\n";
  text += add_field(ensemble.field("position"));
  text += "</Points>\n<Verts>\n";
  text += add_integers("connectivity", 0);
  text += add_integers("offsets", 1);
  text += "</Verts>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
  text += data;
  text += "\n</AppendedData>\n</VTKFile>\n";
  TextFile file(path, TextFile::Mode::replace);
  file.write(text);
  file.close();
}

}  // namespace boltzmann
