// Exported H5MD. All ensembles are one group, "trajectory", with units in the names of MDAnalysis, so that its Universe
// opens the file directly. The particles of the ensembles are concatenated; `species` is the index of the ensemble of
// each.
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/export_atoms.hpp>
#include <boltzmann/files/frame_writers.hpp>
#include <boltzmann/files/hdf5_file.hpp>
#include <boltzmann/files/trajectory.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

namespace boltzmann {
namespace {

using hdf5::Dataset;
using hdf5::File;
using hdf5::Number;

// MDAnalysis opens no file without units. Pure numbers are written unchanged, under these names.
constexpr char const *length_label = "Angstrom", *time_label = "ps", *velocity_label = "Angstrom ps-1";

std::string const group = "/particles/trajectory";

class H5mdWriter final : public FrameWriter {
 public:
  explicit H5mdWriter(std::string path) : path_(std::move(path)), file_(File::create(path_ + ".part")) {}
  ~H5mdWriter() override {
    close();
    std::error_code ignored;
    if (!finished_) std::filesystem::remove(path_ + ".part", ignored);
  }

  void write(ExportFrame const& frame) override {
    std::size_t count = 0;
    for (auto const& particles : frame.particles) count += particles.size;
    if (frames_ == 0) begin(frame, count);
    if (count != count_)
      throw Error(
          fmt::format("step {} has {} particles, the frames before {}: MDAnalysis reads the same particles in all "
                      "frames; choose some of them, or write .xyz",
                      frame.step, count, count_));
    append(position_, frame, "position");
    if (velocity_) append(*velocity_, frame, "velocity");
    if (edges_) {
      auto const edges = finite_edges(frame);
      std::vector<double> matrix(9, 0.0);
      for (std::size_t a = 0; a < 3; ++a) matrix[4 * a] = edges.high[a] - edges.low[a];
      edges_->resize({frames_ + 1, 3, 3});
      edges_->write(matrix.data(), {frames_, 0, 0}, {1, 3, 3});
    }
    step_.resize({frames_ + 1});
    step_.write(&frame.step, {frames_}, {1});
    time_.resize({frames_ + 1});
    time_.write(&frame.time, {frames_}, {1});
    times_.push_back(frame.time);
    ++frames_;
  }

  void finish() override {
    write_intervals();
    forget_datasets();
    std::exchange(file_, nullptr)->close();
    std::error_code error;
    std::filesystem::rename(path_ + ".part", path_, error);
    if (error) throw Error(fmt::format("{}: can't be written: {}", path_, error.message()));
    finished_ = true;
  }

 private:
  void begin(ExportFrame const& frame, std::size_t count) {
    count_ = count;
    for (char const* name :
         {"/h5md", "/h5md/author", "/h5md/creator", "/h5md/modules", "/h5md/modules/units", "/particles"})
      file_->create_group(name);
    file_->create_group(group);
    file_->set("/h5md", "version", std::vector<std::int64_t>{1, 1});
    file_->set("/h5md/author", "name", std::string("unknown"));
    file_->set("/h5md/creator", "name", std::string("Boltzmann"));
    file_->set("/h5md/creator", "version", std::string("export"));
    file_->set("/h5md/modules/units", "version", std::vector<std::int64_t>{1, 0});
    position_ = begin_field("position", length_label);
    step_ = file_->create_growing(group + "/position/step", Number::integer, {0}, {1024}, {true});
    time_ = file_->create_growing(group + "/position/time", Number::real, {0}, {1024}, {true});
    file_->set(group + "/position/time", "unit", std::string(time_label));
    auto const has = [&](std::string const& name) {
      return std::all_of(frame.particles.begin(), frame.particles.end(),
                         [&](auto const& particles) { return field_of(particles, name) != nullptr; });
    };
    if (has("velocity")) {
      velocity_ = begin_field("velocity", velocity_label);
      link_times("velocity");
    }
    begin_box(frame);
    write_kinds(frame);
    for (char const* name : {"mass", "charge"})
      if (std::any_of(frame.particles.begin(), frame.particles.end(),
                      [&](auto const& particles) { return field_of(particles, name) != nullptr; }))
        write_constant(frame, name);
  }

  /// The time between successive frames, as an observable `dt`, where MDAnalysis expects it.
  void write_intervals() {
    if (frames_ < 2) return;
    std::vector<double> intervals;
    for (std::size_t k = 1; k < times_.size(); ++k) intervals.push_back(times_[k] - times_[k - 1]);
    intervals.push_back(intervals.back());
    file_->create_group("/observables");
    file_->create_group("/observables/dt");
    file_->link(group + "/position/step", "/observables/dt/step");
    file_->link(group + "/position/time", "/observables/dt/time");
    file_->create("/observables/dt/value", Number::real, {frames_}).write(intervals.data(), {0}, {frames_});
    file_->set("/observables/dt/value", "unit", std::string(time_label));
  }

  Dataset begin_field(std::string const& name, char const* unit) {
    std::uint64_t const chunk = std::clamp<std::uint64_t>(count_, 1, 40'000);
    file_->create_group(group + "/" + name);
    auto values = file_->create_growing(group + "/" + name + "/value", Number::real, {0, count_, 3}, {1, chunk, 3},
                                        {true, false, false});
    file_->set(group + "/" + name + "/value", "unit", std::string(unit));
    return values;
  }
  void link_times(std::string const& name) {
    file_->link(group + "/position/step", group + "/" + name + "/step");
    file_->link(group + "/position/time", group + "/" + name + "/time");
  }

  void begin_box(ExportFrame const& frame) {
    std::vector<std::string> boundary;
    for (int a = 0; a < 3; ++a)
      boundary.emplace_back(a < frame.box.dimension && frame.box.periodic[a] ? "periodic" : "none");
    file_->create_group(group + "/box");
    file_->set(group + "/box", "dimension", std::int64_t{3});
    file_->set(group + "/box", "boundary", boundary);
    if (std::find(boundary.begin(), boundary.end(), "periodic") == boundary.end()) return;
    file_->create_group(group + "/box/edges");
    edges_ =
        file_->create_growing(group + "/box/edges/value", Number::real, {0, 3, 3}, {128, 3, 3}, {true, false, false});
    file_->set(group + "/box/edges/value", "unit", std::string(length_label));
    link_times("box/edges");
  }

  /// The number of each particle and of its ensemble, and the names of the ensembles.
  void write_kinds(ExportFrame const& frame) {
    std::vector<std::int64_t> species, ids;
    std::vector<std::string> names;
    for (auto const& particles : frame.particles) {
      for (std::size_t i = 0; i < particles.size; ++i) {
        species.push_back(static_cast<std::int64_t>(names.size()));
        ids.push_back(particles.first_id + static_cast<std::int64_t>(i));
      }
      names.push_back(species_of(particles));
    }
    file_->create(group + "/species", Number::integer, {count_}).write(species.data(), {0}, {count_});
    file_->create(group + "/id", Number::integer, {count_}).write(ids.data(), {0}, {count_});
    file_->set(group + "/species", "names", names);
  }

  void write_constant(ExportFrame const& frame, std::string const& name) {
    std::vector<double> values;
    std::string unit;
    for (auto const& particles : frame.particles) {
      auto const* field = field_of(particles, name);
      if (field) unit = field->unit;
      for (std::size_t i = 0; i < particles.size; ++i) values.push_back(field ? value_of(*field, i, 0) : 0.0);
    }
    file_->create(group + "/" + name, Number::real, {count_}).write(values.data(), {0}, {count_});
    if (!unit.empty()) file_->set(group + "/" + name, "unit", h5md_unit(unit));
  }

  void append(Dataset& values, ExportFrame const& frame, std::string const& name) {
    std::vector<double> numbers;
    numbers.reserve(3 * count_);
    for (auto const& particles : frame.particles)
      for (std::size_t i = 0; i < particles.size; ++i)
        for (int c = 0; c < 3; ++c) numbers.push_back(value_of(*field_of(particles, name), i, c));
    values.resize({frames_ + 1, count_, 3});
    values.write(numbers.data(), {frames_, 0, 0}, {1, count_, 3});
  }

  void forget_datasets() {
    for (auto* dataset : {&position_, &step_, &time_}) *dataset = Dataset();
    velocity_.reset();
    edges_.reset();
  }
  void close() {
    forget_datasets();
    file_.reset();
  }

  std::string path_;
  std::unique_ptr<File> file_;
  Dataset position_, step_, time_;
  std::optional<Dataset> velocity_, edges_;
  std::vector<double> times_;
  std::uint64_t frames_ = 0, count_ = 0;
  bool finished_ = false;
};

}  // namespace

std::unique_ptr<FrameWriter> h5md_writer(std::string const& path) { return std::make_unique<H5mdWriter>(path); }

}  // namespace boltzmann
