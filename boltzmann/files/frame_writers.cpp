// Writers of text, table and VTK formats. Frames go to a temporary file, which is renamed when it is complete.
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/csv.hpp>
#include <boltzmann/files/frame_writers.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/particles/component_words.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

namespace boltzmann {
namespace {

namespace fs = std::filesystem;

/// Writes all frames into one text file.
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

/// Writes a row per particle and frame, with the fields of all ensembles.
class CsvWriter final : public FrameWriter {
 public:
  explicit CsvWriter(std::string path) : file_(std::move(path)) {}

  void write(ExportFrame const& frame) override {
    std::string text;
    if (columns_.empty()) text = header(frame);
    for (auto const& particles : frame.particles) {
      // Maps each column to the field of these particles.
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

/// Writes copper.pvd and copper/ions-000000100.vtp, ...
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
    // Remove frames of an earlier export; other files in the folder stay.
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

}  // namespace

std::unique_ptr<FrameWriter> text_writer(std::string const& path, std::string (*text)(ExportFrame const&)) {
  return std::make_unique<TextWriter>(path, text);
}
std::unique_ptr<FrameWriter> csv_writer(std::string const& path) { return std::make_unique<CsvWriter>(path); }
std::unique_ptr<FrameWriter> vtp_writer(std::string const& path) { return std::make_unique<VtpWriter>(path); }
std::unique_ptr<FrameWriter> pvd_writer(std::string const& path) { return std::make_unique<PvdWriter>(path); }

}  // namespace boltzmann
