// Frames go from the reader, field by field, through a change of units, to the writer of a format.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/files/csv.hpp>
#include <boltzmann/files/export.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/files/trajectory_export.hpp>
#include <boltzmann/particles/component_words.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

namespace boltzmann {
namespace {

namespace fs = std::filesystem;

constexpr std::array all_formats{
    ExportFormat{"extended XYZ", ".xyz .extxyz",
                 "all frames as text: box, species, id, pos, velo and the other fields that the ensembles share",
                 "OVITO, ASE, MDAnalysis and VMD (these two: positions alone)"},
    ExportFormat{"LAMMPS dump", ".dump .lammpstrj",
                 "all frames as text: box, id, type, element, x y z, vx vy vz, mass, q and the other fields",
                 "OVITO, VMD, MDAnalysis, ASE"},
    ExportFormat{"VTK time series", ".pvd", "an index, and in a folder beside it a .vtp for each frame and ensemble",
                 "ParaView"},
    ExportFormat{"VTK PolyData", ".vtp", "one frame of one ensemble, with every field", "ParaView, VTK, PyVista"},
    ExportFormat{"CSV", ".csv", "a row for each particle and frame: step, time, ensemble, number and every field",
                 "spreadsheets, pandas, R"},
};
enum class Kind { xyz, dump, pvd, vtp, csv };

Kind kind_of(std::string const& path) { return static_cast<Kind>(&export_format(path) - all_formats.data()); }

// ---- Units ----

// LAMMPS' "metal" where it is not what follows from angstrom, amu and ps.
struct MetalUnit {
  Dimension dimension;
  char const* unit;
};
constexpr std::array metal_units{
    MetalUnit{dimensions::energy, "eV"},
    MetalUnit{dimensions::force, "eV/angstrom"},
    MetalUnit{dimensions::pressure, "bar"},
    MetalUnit{dimensions::density, "g/cm^3"},
    MetalUnit{dimensions::specific_energy, "eV/amu"},
    MetalUnit{dimensions::heat_capacity, "eV/K"},
};

class UnitChange {
 public:
  UnitChange(std::string wanted, Kind kind, TrajectoryReader const& reader) {
    std::string length;
    for (auto const& field : reader.ensembles().front().fields)
      if (field.name == "position") length = field.unit;
    if (!wanted.empty() && wanted != "metal" && wanted != "si" && wanted != "run") {
      std::vector<std::string> const words{"metal", "si", "run"};
      throw Error(
          fmt::format("there are no units '{}'; there are {}{}", wanted, join(words), did_you_mean(wanted, words)));
    }
    if (length.empty()) {
      if (!wanted.empty() && wanted != "run")
        throw Error(fmt::format("the run has pure numbers, which can't become units of '{}'", wanted));
      name_ = "none";
      return;
    }
    bool const text = kind == Kind::xyz || kind == Kind::dump;
    bool const atoms = parse_quantity("1 " + length).si < 1e-8;
    name_ = !wanted.empty() ? wanted : !text ? "run" : atoms ? "metal" : "si";
    using namespace literals;
    if (name_ == "metal") units_ = UnitSystem(1_angstrom, 1_amu, 1_ps);
    if (name_ == "si") units_ = UnitSystem::si();
  }

  std::string const& name() const { return name_; }

  struct Change {
    std::string unit;
    double factor = 1;
  };
  /// For numbers that are in this unit.
  Change operator()(std::string const& unit) const {
    if (unit.empty() || !units_) return {unit, 1};
    auto const quantity = parse_quantity(is_number(unit) ? unit : "1 " + unit);
    auto const& d = quantity.dimension;
    std::string target = units_->unit_name(d);
    if (name_ == "metal")
      for (auto const& special : metal_units)
        if (special.dimension == d) target = special.unit;
    if (target == unit) return {unit, 1};
    return {target, quantity.si / parse_quantity(is_number(target) ? target : "1 " + target).si};
  }

 private:
  static bool is_number(std::string const& unit) {
    return !unit.empty() && ((unit[0] >= '0' && unit[0] <= '9' && !unit.starts_with("1/")) || unit[0] == '.');
  }

  std::string name_;
  std::optional<UnitSystem> units_;  // none: the units of the run
};

class FrameWriter {
 public:
  FrameWriter() = default;
  virtual ~FrameWriter() = default;
  FrameWriter(FrameWriter const&) = delete;
  FrameWriter& operator=(FrameWriter const&) = delete;
  virtual void write(ExportFrame const& frame) = 0;
  virtual void finish() = 0;
};

/// A text with all frames.
class TextWriter final : public FrameWriter {
 public:
  TextWriter(std::string path, std::string (*text)(ExportFrame const&)) : file_(std::move(path)), text_(text) {}
  void write(ExportFrame const& frame) override { file_.write(text_(frame)); }
  void finish() override { file_.finish(); }

 private:
  PartFile file_;
  std::string (*text_)(ExportFrame const&);
};

std::vector<std::string> component_names(ExportField const& field, int dimension) {
  if (field.components == 1) return {field.name};
  auto names = component_words(field.components, dimension);
  for (auto& name : names) name = field.name + "." + name;
  return names;
}

/// A row for each particle and frame, with the fields of all ensembles.
class CsvWriter final : public FrameWriter {
 public:
  explicit CsvWriter(std::string path) : file_(std::move(path)) {}

  void write(ExportFrame const& frame) override {
    std::string text;
    if (columns_.empty()) text = header(frame);
    for (auto const& particles : frame.particles) {
      // Where each column is in these particles.
      std::vector<ExportField const*> fields(columns_.size(), nullptr);
      for (std::size_t c = 0; c < columns_.size(); ++c)
        for (auto const& field : particles.fields)
          if (field.name == columns_[c].field && columns_[c].component < field.components) fields[c] = &field;
      std::string const name = csv_word(particles.name);
      std::string start;
      append_number(start, frame.step);
      start += ',';
      append_number(start, frame.time);
      start += ',' + name + ',';
      for (std::size_t i = 0; i < particles.size; ++i) {
        text += start;
        append_number(text, static_cast<std::int64_t>(i));
        for (std::size_t c = 0; c < columns_.size(); ++c) {
          text += ',';
          if (auto const* field = fields[c])
            append_number(text, field->factor *
                                    field->first[i * field->stride + static_cast<std::size_t>(columns_[c].component)]);
        }
        text += '\n';
      }
    }
    file_.write(text);
  }
  void finish() override { file_.finish(); }

 private:
  struct ColumnOf {
    std::string field;
    int component;
  };

  std::string header(ExportFrame const& frame) {
    auto const titled = [](std::string const& name, std::string const& unit) {
      return csv_word(unit.empty() ? name : name + " (" + unit + ")");
    };
    std::string text = "step," + titled("time", frame.time_unit) + ",ensemble,number";
    for (auto const& particles : frame.particles)
      for (auto const& field : particles.fields) {
        bool const known = std::any_of(columns_.begin(), columns_.end(),
                                       [&](ColumnOf const& column) { return column.field == field.name; });
        if (known) continue;
        auto const names = component_names(field, particles.dimension);
        for (int c = 0; c < field.components; ++c) {
          columns_.push_back({field.name, c});
          text += "," + titled(names[static_cast<std::size_t>(c)], field.unit);
        }
      }
    return text + "\n";
  }

  PartFile file_;
  std::vector<ColumnOf> columns_;
};

class VtpWriter final : public FrameWriter {
 public:
  explicit VtpWriter(std::string path) : path_(std::move(path)) {}
  void write(ExportFrame const& frame) override { write_vtp(path_ + ".part", frame.time, frame.particles.front()); }
  void finish() override {
    std::error_code error;
    fs::rename(path_ + ".part", path_, error);
    if (error) throw Error(fmt::format("{}: can't be written: {}", path_, error.message()));
  }

 private:
  std::string path_;
};

/// copper.pvd and copper/ions-000000100.vtp, ...
class PvdWriter final : public FrameWriter {
 public:
  explicit PvdWriter(std::string const& path)
      : folder_(path.substr(0, path.size() - 4)), part_(folder_ + ".part"), index_(path) {
    std::error_code error;
    if (fs::exists(folder_, error) && !fs::is_directory(folder_, error))
      throw Error(fmt::format("the frames go into the folder '{}', which is a file", folder_));
    fs::remove_all(part_, error);
    if (!fs::create_directory(part_, error))
      throw Error(fmt::format("the folder '{}' can't be made: {}", part_, error.message()));
    index_.write(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
        "<Collection>\n");
  }
  ~PvdWriter() override {
    std::error_code ignored;
    fs::remove_all(part_, ignored);
  }

  void write(ExportFrame const& frame) override {
    for (std::size_t e = 0; e < frame.particles.size(); ++e) {
      auto const& particles = frame.particles[e];
      std::string const name = fmt::format("{}-{:09d}.vtp", file_name(particles.name), frame.step);
      write_vtp(part_ + "/" + name, frame.time, particles);
      names_.push_back(name);
      std::string time;
      append_number(time, frame.time);
      index_.write(fmt::format("<DataSet timestep=\"{}\" group=\"\" part=\"{}\" name=\"{}\" file=\"{}/{}\"/>\n", time,
                               e, file_name(particles.name), fs::path(folder_).filename().string(), name));
    }
  }

  void finish() override {
    index_.write("</Collection>\n</VTKFile>\n");
    std::error_code error;
    fs::create_directory(folder_, error);
    // Frames of an earlier export go; what else somebody keeps there stays.
    for (auto const& entry : fs::directory_iterator(folder_, error))
      if (is_frame(entry.path().filename().string())) fs::remove(entry.path(), error);
    for (auto const& name : names_) {
      fs::rename(part_ + "/" + name, folder_ + "/" + name, error);
      if (error) throw Error(fmt::format("{}/{}: can't be written: {}", folder_, name, error.message()));
    }
    index_.finish();
  }

 private:
  static std::string file_name(std::string name) {
    for (char& c : name)
      if (c == ' ' || c == '/' || c == '"' || c == '&' || c == '<' || c == '>') c = '_';
    return name;
  }
  static bool is_frame(std::string const& name) {
    auto const dash = name.rfind('-');
    if (dash == std::string::npos || !name.ends_with(".vtp")) return false;
    std::string const digits = name.substr(dash + 1, name.size() - dash - 5);
    return digits.size() >= 9 && digits.find_first_not_of("0123456789") == std::string::npos;
  }

  std::string folder_, part_;
  PartFile index_;
  std::vector<std::string> names_;
};

std::unique_ptr<FrameWriter> make_writer(Kind kind, std::string const& path) {
  switch (kind) {
    case Kind::xyz:
      return std::make_unique<TextWriter>(path, xyz_text);
    case Kind::dump:
      return std::make_unique<TextWriter>(path, dump_text);
    case Kind::pvd:
      return std::make_unique<PvdWriter>(path);
    case Kind::vtp:
      return std::make_unique<VtpWriter>(path);
    case Kind::csv:
      return std::make_unique<CsvWriter>(path);
  }
  return nullptr;
}

// ---- What is chosen ----

std::vector<std::string> names_of(TrajectoryReader const& reader) {
  std::vector<std::string> names;
  for (auto const& ensemble : reader.ensembles()) names.push_back(ensemble.name);
  return names;
}

void need_ensemble(TrajectoryReader const& reader, std::string const& name) {
  auto const names = names_of(reader);
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw Error(fmt::format("there is no ensemble '{}' in the trajectory; it has {}{}", name, join(names),
                            did_you_mean(name, names)));
}

struct Chosen {
  TrajectoryReader::StoredEnsemble const* ensemble;
  std::vector<TrajectoryReader::StoredField const*> fields;
  std::int64_t first_id = 1;
};

bool has_field(TrajectoryReader::StoredEnsemble const& ensemble, std::string const& name) {
  return std::any_of(ensemble.fields.begin(), ensemble.fields.end(), [&](auto const& f) { return f.name == name; });
}

std::vector<Chosen> choose(TrajectoryReader const& reader, ExportOptions const& options, bool in_columns) {
  for (auto const& name : options.ensembles) need_ensemble(reader, name);
  for (auto const& [name, species] : options.species) need_ensemble(reader, name);
  std::vector<Chosen> chosen;
  for (auto const& ensemble : reader.ensembles())
    if (options.ensembles.empty() ||
        std::find(options.ensembles.begin(), options.ensembles.end(), ensemble.name) != options.ensembles.end())
      chosen.push_back({&ensemble, {}});
  for (auto const& name : options.fields) {
    std::vector<std::string> known, lacking;
    for (auto const& [ensemble, fields, first] : chosen) {
      if (!has_field(*ensemble, name)) lacking.push_back(ensemble->name);
      for (auto const& field : ensemble->fields)
        if (std::find(known.begin(), known.end(), field.name) == known.end()) known.push_back(field.name);
    }
    if (lacking.size() == chosen.size())
      throw Error(fmt::format("there is no field '{}' in the trajectory; it has {}{}", name, join(known),
                              did_you_mean(name, known)));
    if (in_columns && !lacking.empty())
      throw Error(
          fmt::format("the field '{}' is not in {}, and this format has the same columns for all: choose an "
                      "ensemble, or write .csv or .pvd",
                      name, join(lacking)));
  }
  for (auto& one : chosen)
    for (auto const& field : one.ensemble->fields)
      if (options.fields.empty() || field.name == "position" ||
          std::find(options.fields.begin(), options.fields.end(), field.name) != options.fields.end())
        one.fields.push_back(&field);
  return chosen;
}

}  // namespace

std::span<ExportFormat const> export_formats() { return all_formats; }

ExportFormat const& export_format(std::string const& path) {
  std::string const suffix = fs::path(path).extension().string();
  std::vector<std::string> all;
  for (auto const& format : all_formats)
    for (auto const& known : split_words(format.suffixes, ' ')) {
      if (known == suffix) return format;
      all.push_back(known);
    }
  throw Error(fmt::format("'{}' ends in none of {}{}", path, join(all), did_you_mean(suffix, all)));
}

std::vector<std::size_t> chosen_frames(std::string_view text, std::size_t count) {
  auto const wrong = [&](std::string const& why) { return Error(fmt::format("frames '{}': {}", text, why)); };
  std::vector<std::optional<std::int64_t>> numbers;
  for (std::string_view rest = text;;) {
    std::size_t const colon = std::min(rest.find(':'), rest.size());
    std::string_view const word = rest.substr(0, colon);
    std::int64_t number = 0;
    auto const [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (!word.empty() && (error != std::errc() || end != word.data() + word.size()))
      throw wrong(fmt::format("'{}' is no whole number; write a frame, 7, or from:to:every, as in 10:100:5", word));
    numbers.push_back(word.empty() ? std::nullopt : std::optional(number));
    if (colon == rest.size()) break;
    rest.remove_prefix(colon + 1);
  }
  if (numbers.size() > 3 || (numbers.size() == 1 && !numbers[0]))
    throw wrong("write a frame, 7, or from:to:every, as in 10:100:5");
  auto const n = static_cast<std::int64_t>(count);
  if (numbers.size() == 1) {
    std::int64_t const frame = *numbers[0] < 0 ? *numbers[0] + n : *numbers[0];
    if (frame < 0 || frame >= n)
      throw wrong(fmt::format("the trajectory has frames 0 to {} (or -1 to -{} from the end)", n - 1, n));
    return {static_cast<std::size_t>(frame)};
  }
  std::int64_t const every = numbers.size() == 3 ? numbers[2].value_or(1) : 1;
  if (every < 1) throw wrong("every is 1 or more");
  auto const bound = [&](std::optional<std::int64_t> number, std::int64_t otherwise) {
    std::int64_t const frame = number.value_or(otherwise);
    return std::clamp<std::int64_t>(frame < 0 ? frame + n : frame, 0, n);
  };
  std::vector<std::size_t> frames;
  for (std::int64_t frame = bound(numbers[0], 0), to = bound(numbers[1], n); frame < to; frame += every)
    frames.push_back(static_cast<std::size_t>(frame));
  if (frames.empty()) throw wrong(fmt::format("none of the {} frames is chosen", count));
  return frames;
}

namespace {

/// A frame of those that are chosen; `memory` keeps its numbers.
ExportFrame frame_of(TrajectoryReader const& reader, std::size_t number, std::vector<Chosen> const& chosen,
                     UnitChange const& units, ExportOptions const& options, std::vector<std::vector<double>>& memory) {
  ExportFrame frame;
  auto const time = units(reader.time_unit());
  frame.step = reader.steps()[number];
  frame.time = reader.written_time(number) * time.factor;
  frame.time_unit = time.unit;
  frame.box = reader.box(number, TrajectoryReader::Numbers::written);
  for (auto const& [ensemble, fields, first_id] : chosen) {
    ExportParticles particles{ensemble->name, ensemble->dimension, reader.size(number, ensemble->name), first_id, {}};
    for (auto const& [name, species] : options.species)
      if (name == ensemble->name) particles.species = species;
    for (auto const* field : fields) {
      memory.push_back(reader.read(number, ensemble->name, field->name, TrajectoryReader::Numbers::written));
      auto const change = units(field->unit);
      particles.fields.push_back({field->name, field->components, memory.back().data(),
                                  static_cast<std::size_t>(field->components), change.factor, change.unit});
      if (field->name == "position" && frame.particles.empty()) {
        frame.length_unit = change.unit;
        for (int axis = 0; axis < frame.box.dimension; ++axis)
          frame.box.low[axis] *= change.factor, frame.box.high[axis] *= change.factor;
      }
    }
    frame.particles.push_back(std::move(particles));
  }
  return frame;
}

std::vector<std::string> names_of(ExportFrame const& frame, bool in_columns) {
  std::vector<std::string> names;
  if (in_columns)
    for (auto const& field : common_fields(frame.particles)) names.push_back(field.name);
  else
    for (auto const& particles : frame.particles)
      for (auto const& field : particles.fields)
        if (std::find(names.begin(), names.end(), field.name) == names.end()) names.push_back(field.name);
  return names;
}

}  // namespace

ExportReport export_trajectory(TrajectoryReader const& reader, std::string const& path, ExportOptions const& options) {
  Kind const kind = kind_of(path);
  bool const in_columns = kind == Kind::xyz || kind == Kind::dump;
  if (reader.frames() == 0) throw Error("the trajectory has no frames");
  std::vector<std::size_t> frames = options.frames;
  if (frames.empty())
    for (std::size_t frame = 0; frame < reader.frames(); ++frame) frames.push_back(frame);
  UnitChange const units(options.units, kind, reader);
  auto chosen = choose(reader, options, in_columns);
  if (kind == Kind::vtp && (frames.size() != 1 || chosen.size() != 1))
    throw Error(fmt::format("'{}' holds one frame of one ensemble, not {} of {}; choose them, or write .pvd", path,
                            frames.size(), chosen.size()));
  // Identifiers of an ensemble stay what they are while others grow.
  std::int64_t next_id = 1;
  for (auto& one : chosen) {
    one.first_id = next_id;
    std::size_t most = 0;
    for (auto const frame : frames) most = std::max(most, reader.size(frame, one.ensemble->name));
    next_id += static_cast<std::int64_t>(most);
  }

  ExportReport report{0, units.name(), {}};
  auto const writer = make_writer(kind, path);
  for (auto const number : frames) {
    std::vector<std::vector<double>> memory;
    auto const frame = frame_of(reader, number, chosen, units, options, memory);
    if (report.frames == 0) report.names = names_of(frame, in_columns);
    writer->write(frame);
    ++report.frames;
    if (options.progress) options.progress(report.frames, frames.size());
  }
  writer->finish();
  return report;
}

}  // namespace boltzmann
