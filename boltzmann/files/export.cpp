// Extended XYZ, LAMMPS dumps, VTK PolyData and ImageData.
#include <fmt/format.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/export.hpp>
#include <boltzmann/files/export_atoms.hpp>
#include <boltzmann/files/spatial.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/particles/component_words.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/schemes/mesh/mesh_field.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace boltzmann {
namespace {

static_assert(std::endian::native == std::endian::little, "VTK files with raw data must be LittleEndian");

// Removes blanks, which separate columns, from a name.
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

/// The data after the XML of a VTK file. Each array is its length in bytes as a 64-bit number, followed by its numbers.
struct AppendedData {
  std::string data;

  /// Starts an array and returns its offset.
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

std::string array_tag(char const* type, std::string const& name, int components, std::size_t offset,
                      std::string const& unit = "") {
  std::string const tag =
      fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"",
                  type, xml(name), components, offset);
  if (unit.empty()) return tag + "/>\n";
  return tag + fmt::format(
                   ">\n<InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">{}</InformationKey>\n"
                   "</DataArray>\n",
                   xml(unit));
}

/// The XML before the pieces of a data set of this kind with these attributes.
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

int columns_of(ExportField const& field, int dimension) { return is_spatial(field, dimension) ? 3 : field.components; }

// The fields of `wanted`, in that order, as pointers to the fields of these particles.
std::vector<ExportField const*> own_fields(ExportParticles const& particles, std::vector<ExportField> const& wanted) {
  std::vector<ExportField const*> own;
  for (auto const& field : wanted)
    own.push_back(&*std::find_if(particles.fields.begin(), particles.fields.end(),
                                 [&](ExportField const& candidate) { return candidate.name == field.name; }));
  return own;
}

std::size_t count_of(ExportFrame const& frame) {
  std::size_t total = 0;
  for (auto const& particles : frame.particles) total += particles.size;
  return total;
}

std::string xyz_name(std::string const& field) {
  return field == "position" ? "pos" : field == "velocity" ? "velo" : word(field);
}

std::string xyz(ExportFrame const& frame, bool complete) {
  std::vector<ExportField> const fields = common_fields(frame.particles);
  int const dimension = frame.particles.empty() ? 3 : frame.particles.front().dimension;
  std::string text = fmt::format("{}\n{}Properties=species:S:1", count_of(frame), lattice(frame.box));
  // The identifier follows the position, for readers that only know name x y z.
  auto const with_id = [&](ExportField const& field) { return complete && field.name == "position"; };
  for (auto const& field : fields)
    text +=
        fmt::format(":{}:R:{}{}", xyz_name(field.name), columns_of(field, dimension), with_id(field) ? ":id:I:1" : "");
  if (fields.empty()) text += ":pos:R:3";
  text += " pbc=\"";
  for (int axis = 0; axis < 3; ++axis)
    text +=
        fmt::format("{}{}", axis > 0 ? " " : "", axis < frame.box.dimension && frame.box.periodic[axis] ? "T" : "F");
  text += "\" Time=";
  append_number(text, frame.time);
  if (complete) text += fmt::format(" Step={}", frame.step);
  if (!frame.length_unit.empty()) text += fmt::format(" Length_unit=\"{}\"", frame.length_unit);
  if (!frame.time_unit.empty()) text += fmt::format(" Time_unit=\"{}\"", frame.time_unit);
  for (auto const& field : fields)
    if (complete && !field.unit.empty() && field.name != "position")
      text += fmt::format(" {}_unit=\"{}\"", xyz_name(field.name), field.unit);
  text += '\n';
  for (auto const& particles : frame.particles) {
    std::string const species = species_of(particles);
    auto const own = own_fields(particles, fields);
    for (std::size_t i = 0; i < particles.size; ++i) {
      text += species;
      for (auto const* field : own) {
        for (int c = 0; c < columns_of(*field, dimension); ++c) {
          text += ' ';
          append_number(text, value_of(*field, i, c));
        }
        if (with_id(*field)) text += ' ', append_number(text, particles.first_id + static_cast<std::int64_t>(i));
      }
      text += '\n';
    }
  }
  return text;
}

// The names of the columns of a field in LAMMPS.
std::vector<std::string> dump_columns(ExportField const& field, int dimension) {
  if (field.name == "position") return {"x", "y", "z"};
  if (field.name == "velocity" && is_spatial(field, dimension)) return {"vx", "vy", "vz"};
  if (field.name == "force" && is_spatial(field, dimension)) return {"fx", "fy", "fz"};
  if (field.name == "charge" && field.components == 1) return {"q"};
  std::string const name = word(field.name);
  if (field.components == 1) return {name};
  auto names = component_words(field.components, dimension, 1);
  for (auto& component : names) component = name + "_" + component;
  return names;
}

}  // namespace

double value_of(ExportField const& field, std::size_t particle, int component) {
  return component < field.components
             ? field.factor * field.first[particle * field.stride + static_cast<std::size_t>(component)]
             : 0.0;
}

std::string species_of(ExportParticles const& particles) {
  return word(particles.species.empty() ? particles.name : particles.species);
}

ExportParticles export_particles(AnyEnsemble const& ensemble) {
  ExportParticles particles{ensemble.name(), ensemble.dimension(), ensemble.size(), 1, {}};
  for (auto const& field : ensemble.fields())
    particles.fields.push_back({field.name, field.components,
                                ensemble.size() > 0 ? ensemble.row(0) + field.offset : nullptr, ensemble.stride()});
  return particles;
}

std::vector<ExportField> common_fields(std::span<ExportParticles const> particles) {
  std::vector<ExportField> fields;
  if (particles.empty()) return fields;
  for (auto const& field : particles.front().fields) {
    bool const everywhere = std::all_of(particles.begin(), particles.end(), [&](ExportParticles const& other) {
      return std::any_of(other.fields.begin(), other.fields.end(), [&](ExportField const& candidate) {
        return candidate.name == field.name && candidate.components == field.components;
      });
    });
    if (everywhere) fields.push_back(field);
  }
  return fields;
}

std::string xyz_text(ExportFrame const& frame) { return xyz(frame, true); }

std::string dump_text(ExportFrame const& frame) {
  std::vector<ExportField> const fields = common_fields(frame.particles);
  int const dimension = frame.particles.empty() ? 3 : frame.particles.front().dimension;
  auto const edges = finite_edges(frame);
  std::string text =
      fmt::format("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS", frame.step, count_of(frame));
  for (int axis = 0; axis < 3; ++axis) {
    bool const there = axis < frame.box.dimension;
    text += ' ';
    for (bool const lower : {true, false}) {
      auto const a = static_cast<std::size_t>(axis);
      bool const moved = lower ? edges.moved_low[a] : edges.moved_high[a];
      text += moved ? 's' : there && frame.box.periodic[axis] ? 'p' : 'f';
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    text += '\n';
    append_number(text, edges.low[axis]);
    text += ' ';
    append_number(text, edges.high[axis]);
  }
  text += "\nITEM: ATOMS id type element";
  for (auto const& field : fields)
    for (auto const& name : dump_columns(field, dimension)) text += " " + name;
  text += '\n';
  for (std::size_t e = 0; e < frame.particles.size(); ++e) {
    auto const& particles = frame.particles[e];
    std::string const kind = fmt::format(" {} {}", e + 1, species_of(particles));
    auto const own = own_fields(particles, fields);
    for (std::size_t i = 0; i < particles.size; ++i) {
      append_number(text, particles.first_id + static_cast<std::int64_t>(i));
      text += kind;
      for (auto const* field : own)
        for (int c = 0; c < columns_of(*field, dimension); ++c) {
          text += ' ';
          append_number(text, value_of(*field, i, c));
        }
      text += '\n';
    }
  }
  return text;
}

void write_xyz(std::string const& path, double time, std::span<AnyEnsemble const* const> ensembles, BoxEdges const& box,
               bool append, std::function<std::string(Dimension)> const& unit_name) {
  ExportFrame frame{0, time, box, {}};
  for (auto const* ensemble : ensembles) frame.particles.push_back(export_particles(*ensemble));
  if (unit_name) frame.length_unit = unit_name(dimensions::length), frame.time_unit = unit_name(dimensions::time);
  TextFile file(path, append ? TextFile::Mode::append : TextFile::Mode::replace);
  file.write(xyz(frame, false));
  file.close();
}

void write_vtp(std::string const& path, double time, AnyEnsemble const& ensemble) {
  auto particles = export_particles(ensemble);
  particles.first_id = 0;
  write_vtp(path, time, particles);
}

void write_vtp(std::string const& path, double time, ExportParticles const& particles) {
  std::size_t const n = particles.size;
  AppendedData appended;
  auto const add_field = [&](ExportField const& field) {
    int const columns = columns_of(field, particles.dimension);
    std::size_t const offset = appended.begin_array(n * static_cast<std::size_t>(columns) * sizeof(double));
    for (std::size_t i = 0; i < n; ++i)
      for (int c = 0; c < columns; ++c) appended.put(value_of(field, i, c));
    return array_tag("Float64", field.name, columns, offset, field.unit);
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
  for (auto const& field : particles.fields)
    if (field.name != "position") text += add_field(field);
  text += add_integers("id", particles.first_id);
  text += "</PointData>\n<Points>\n";
  for (auto const& field : particles.fields)
    if (field.name == "position") text += add_field(field);
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
