// Writing trajectories.
#include <fmt/format.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/hdf5_file.hpp>
#include <boltzmann/files/spatial.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/files/trajectory_layout.hpp>
#include <boltzmann/files/trajectory_view.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

namespace boltzmann {
namespace {

using hdf5::Dataset;
using hdf5::Extents;
using hdf5::File;
using hdf5::Number;

// Chunks have at least 16 kB if they hold many small frames, and at most about 1 MB. Ensembles that may grow have large
// chunks from the start: a frame of 40000 particles would need thousands of the chunks that suit 10 particles.
constexpr std::size_t least_rows_growing = 512;

Extents chunk_for(std::size_t particles, std::size_t columns, bool may_grow) {
  if (may_grow) particles = std::max(particles, least_rows_growing);
  std::uint64_t const rows =
      particles == 0 ? 64 : std::min<std::uint64_t>(particles, std::uint64_t{131072} / (columns + 1));
  std::uint64_t const frames = std::clamp<std::uint64_t>(16384 / (rows * columns * sizeof(double)), 1, 1024);
  return {frames, rows, columns};
}

struct StoredColumn {
  Field field;
  std::size_t columns;  // in the file
  bool constant;
  bool scalar;
  std::uint64_t checksum = 0;  // of a constant field
  Dataset values;
  double factor = 1;                      // factor of written numbers
  std::optional<Dataset> checksums = {};  // per frame; absent in files of version 0.1
};

struct StoredEnsemble {
  std::string name, class_name;
  std::uint64_t capacity = 0;  // allocated particles per frame
  std::vector<StoredColumn> columns;
  Dataset count;
  std::optional<Dataset> checksums;  // of the data of a frame besides its fields
  std::vector<Dataset> labels;       // id and species
};

std::vector<double> gather(AnyEnsemble const& ensemble, StoredColumn const& column) {
  std::vector<double> values(ensemble.size() * column.columns, 0.0);
  auto const components = static_cast<std::size_t>(column.field.components);
  for (std::size_t i = 0; i < ensemble.size(); ++i)
    std::copy_n(ensemble.row(i) + column.field.offset, components,
                values.begin() + static_cast<std::ptrdiff_t>(i * column.columns));
  if (column.factor != 1)
    for (double& value : values) value *= column.factor;
  return values;
}

/// The checksum of the values as they are read: without the padding columns of vectors.
std::uint64_t checksum_of(std::vector<double> const& values, StoredColumn const& column) {
  auto const components = static_cast<std::size_t>(column.field.components);
  if (components == column.columns) return layout::checksum(values);
  std::vector<double> own;
  own.reserve(values.size() / column.columns * components);
  for (auto at = values.begin(); at != values.end(); at += static_cast<std::ptrdiff_t>(column.columns))
    own.insert(own.end(), at, at + column.field.components);
  return layout::checksum(own);
}

}  // namespace

struct Trajectory::State {
  std::unique_ptr<File> file;
  std::string path;
  TrajectoryOptions options;
  std::vector<StoredEnsemble> ensembles;
  Dataset step, time, edges, bounds;
  bool has_edges = false;
  std::array<bool, 3> periodic{};
  std::uint64_t frames = 0;
  double time_factor = 1, length_factor = 1;
  bool laid_out = false;       // the groups and datasets exist
  bool open = false;           // the datasets are open and the ordered writes have begun
  std::uint64_t checksum = 0;  // combines all checksums of all frames
  std::string failure;         // reason why the trajectory has ended

  double factor(Dimension dimension) const { return options.factor ? options.factor(dimension) : 1; }
  std::string unit(Dimension dimension) const { return options.unit_name ? options.unit_name(dimension) : ""; }

  void write_unit(std::string const& dataset, std::string const& element, Dimension dimension) {
    if (factor(dimension) != 1) file->set(dataset, "boltzmann_factor", factor(dimension));
    std::string const name = unit(dimension);
    if (name.empty()) return;
    file->set_fixed(dataset, "boltzmann_unit", name);
    std::string const h5md = h5md_unit(name);
    if (!h5md.empty() && mdanalysis_reads(element, h5md)) file->set(dataset, "unit", h5md);
  }

  bool declared_constant(Field const& field) const {
    return std::find(options.constant_fields.begin(), options.constant_fields.end(), field.name) !=
               options.constant_fields.end() &&
           field.name != "position" && field.name != "velocity" && field.name != "force";
  }

  void close_datasets() {
    ensembles.clear();
    for (Dataset* dataset : {&step, &time, &edges, &bounds}) *dataset = Dataset();
  }

  void lay_out(std::span<AnyEnsemble const* const> list, BoxEdges const& box);
  // `first` is the group of the first ensemble; all ensembles share its steps, times and box.
  void lay_out(AnyEnsemble const& ensemble, std::size_t index, BoxEdges const& box, std::string const& first);
  void lay_out(AnyEnsemble const& ensemble, Field const& field, std::string const& first);
  void lay_out(BoxEdges const& box, std::string const& first);
  void link_frames(std::string const& first, std::string const& element);
  void open_datasets(std::span<AnyEnsemble const* const> list, BoxEdges const& box);
  void take_back(std::int64_t last_step) const;
  void cut(std::int64_t last_step);
  std::string log() const { return path + ".undo"; }
  void check(std::int64_t at_step, std::span<AnyEnsemble const* const> list, BoxEdges const& box) const;
  void write_frame(std::int64_t at_step, double at_time, std::span<AnyEnsemble const* const> list, BoxEdges const& box);
  void grow(StoredEnsemble& stored, std::size_t index, std::uint64_t capacity);
  void write_values(StoredEnsemble& stored, AnyEnsemble const& ensemble, bool positions);
  void write_checksum(Dataset& checksums, std::uint64_t sum);
};

// Creates the groups, and datasets without frames.
void Trajectory::State::lay_out(std::span<AnyEnsemble const* const> list, BoxEdges const& box) {
  if (list.empty()) throw Error(path + ": a trajectory needs an ensemble");
  for (std::size_t k = 0; k < list.size(); ++k) {
    try {
      check_stored_names(*list[k]);
    } catch (Error const& error) {
      throw Error(path + ": " + error.what());
    }
    for (std::size_t other = 0; other < k; ++other)
      if (list[other]->name() == list[k]->name())
        throw Error(fmt::format("{}: two ensembles are called '{}'", path, list[k]->name()));
  }
  file->create_group("/h5md");
  file->set("/h5md", "version", std::vector<std::int64_t>{1, 1});
  file->create_group("/h5md/author");
  file->set("/h5md/author", "name", options.author);
  file->create_group("/h5md/creator");
  file->set("/h5md/creator", "name", std::string("boltzmann"));
  file->set("/h5md/creator", "version", options.version);
  if (options.unit_name) {
    file->create_group("/h5md/modules");
    file->create_group("/h5md/modules/units");
    file->set("/h5md/modules/units", "version", std::vector<std::int64_t>{1, 0});
  }
  file->create_group("/particles");
  std::string const first = "/particles/" + list[0]->name();
  for (std::size_t k = 0; k < list.size(); ++k) lay_out(*list[k], k, box, first);
  file->flush();
  laid_out = true;
}

void Trajectory::State::link_frames(std::string const& first, std::string const& element) {
  file->link(first + "/position/step", element + "/step");
  file->link(first + "/position/time", element + "/time");
}

void Trajectory::State::lay_out(AnyEnsemble const& ensemble, std::size_t index, BoxEdges const& box,
                                std::string const& first) {
  std::string const group = "/particles/" + ensemble.name();
  bool const is_first = index == 0;
  file->create_group(group);
  file->set_fixed(group, "class", ensemble.class_name());
  file->set(group, "dimension", static_cast<std::int64_t>(ensemble.dimension()));
  file->set(group, "index", static_cast<std::int64_t>(index));
  for (auto const& [name, element] : options.elements)
    if (name == ensemble.name()) file->set_fixed(group, "boltzmann_element", element);
  if (is_first) {
    file->create_group(group + "/position");
    file->create_growing(group + "/position/step", Number::integer, {0}, {1024}, {true});
    file->create_growing(group + "/position/time", Number::real, {0}, {1024}, {true});
    write_unit(group + "/position/time", "time", dimensions::time);
  }
  for (auto const& field : ensemble.fields()) lay_out(ensemble, field, first);
  file->create_group(group + "/count");
  link_frames(first, group + "/count");
  for (char const* each : {"/count/value", "/count/checksum"})
    file->create_growing(group + each, Number::integer, {0}, {1024}, {true});
  for (char const* label : {"id", "species"})
    file->create_growing(group + "/" + label, Number::integer, {0},
                         {chunk_for(ensemble.size(), 1, options.sizes_change)[1]}, {true});
  if (is_first)
    lay_out(box, first);
  else
    file->link(first + "/box", group + "/box");
}

void Trajectory::State::lay_out(AnyEnsemble const& ensemble, Field const& field, std::string const& first) {
  std::string const group = "/particles/" + ensemble.name(), element = group + "/" + field.name;
  std::uint64_t const size = ensemble.size();
  bool const pad = options.three_columns && is_spatial(field, ensemble.dimension());
  std::uint64_t const columns = pad ? 3 : static_cast<std::uint64_t>(field.components);
  bool const scalar = field.components == 1 && !is_spatial(field, ensemble.dimension());
  std::string values = element;
  if (declared_constant(field)) {
    StoredColumn const column{field, columns, true, scalar, 0, {}, factor(field.dimension)};
    Extents extents{size, columns};
    if (scalar) extents.pop_back();
    auto const constant = gather(ensemble, column);
    file->create(element, Number::real, extents).write(constant.data(), Extents(extents.size(), 0), extents);
    file->set(element, "boltzmann_checksum", std::bit_cast<std::int64_t>(checksum_of(constant, column)));
  } else {
    if (group != first || field.name != "position") {
      file->create_group(element);
      link_frames(first, element);
    }
    file->create_growing(element + "/checksum", Number::integer, {0}, {1024}, {true});
    values += "/value";
    Extents extents{0, size, columns}, chunk = chunk_for(size, columns, options.sizes_change);
    std::vector<bool> growing{true, true, false};
    if (scalar) extents.pop_back(), chunk.pop_back(), growing.pop_back();
    file->create_growing(values, Number::real, extents, chunk, growing);
  }
  file->set(values, "components", static_cast<std::int64_t>(field.components));
  file->set(values, "offset", static_cast<std::int64_t>(field.offset));
  write_unit(values, field.name, field.dimension);
}

void Trajectory::State::lay_out(BoxEdges const& box, std::string const& first) {
  std::string const group = first + "/box";
  int const axes = options.three_columns ? 3 : box.dimension;
  std::vector<std::string> boundary;
  std::vector<std::int64_t> periodic_axes;
  bool any_periodic = false;
  for (int axis = 0; axis < axes; ++axis) {
    bool const is_periodic = axis < box.dimension && box.periodic[axis];
    any_periodic = any_periodic || is_periodic;
    boundary.emplace_back(is_periodic ? "periodic" : "none");
    periodic_axes.push_back(is_periodic ? 1 : 0);
  }
  file->create_group(group);
  file->set(group, "dimension", static_cast<std::int64_t>(axes));
  file->set(group, "boundary", boundary);
  file->set(group, "boltzmann_periodic", periodic_axes);
  file->set(group, "boltzmann_dimension", static_cast<std::int64_t>(box.dimension));
  auto const of_box = [&](std::string const& name, Extents const& extents, Extents const& chunk) {
    file->create_group(group + "/" + name);
    link_frames(first, group + "/" + name);
    file->create_growing(group + "/" + name + "/value", Number::real, extents, chunk, {true, false, false});
    write_unit(group + "/" + name + "/value", name, dimensions::length);
  };
  auto const n = static_cast<std::uint64_t>(axes), d = static_cast<std::uint64_t>(box.dimension);
  if (any_periodic) of_box("edges", {0, n, n}, {128, n, n});
  of_box("bounds", {0, 2, d}, {256, 2, d});
}

// Opens the datasets that lay_out has created, now or in an earlier run. Throws Error if they don't match these
// ensembles.
void Trajectory::State::open_datasets(std::span<AnyEnsemble const* const> list, BoxEdges const& box) {
  auto const names = layout::ensembles(*file);
  std::vector<std::string> given;
  for (auto const* ensemble : list) given.push_back(ensemble->name());
  if (names != given) throw Error(fmt::format("{}: it has the ensembles {}, not {}", path, join(names), join(given)));
  std::string const box_group = "/particles/" + names[0] + "/box";
  if (file->integer(box_group, "boltzmann_dimension") != box.dimension)
    throw Error(fmt::format("{}: its box has another dimension than {}", path, box.dimension));
  step = file->dataset("/particles/" + names[0] + "/position/step");
  time = file->dataset("/particles/" + names[0] + "/position/time");
  time_factor = factor(dimensions::time);
  length_factor = factor(dimensions::length);
  bounds = file->dataset(box_group + "/bounds/value");
  has_edges = file->has(box_group + "/edges");
  if (has_edges) edges = file->dataset(box_group + "/edges/value");
  periodic = layout::periodic_axes(*file, box_group);

  std::vector<StoredEnsemble> found;
  for (auto const* ensemble : list) {
    std::string const group = "/particles/" + ensemble->name();
    StoredEnsemble stored;
    stored.name = ensemble->name();
    stored.class_name = file->text(group, "class");
    if (stored.class_name != ensemble->class_name() || file->integer(group, "dimension") != ensemble->dimension())
      throw Error(fmt::format("{}: its ensemble '{}' is of class {} in {}D, not {} in {}D", path, stored.name,
                              stored.class_name, file->integer(group, "dimension"), ensemble->class_name(),
                              ensemble->dimension()));
    stored.count = file->dataset(group + "/count/value");
    if (file->has(group + "/count/checksum")) stored.checksums = file->dataset(group + "/count/checksum");
    for (char const* label : {"id", "species"}) stored.labels.push_back(file->dataset(group + "/" + label));
    for (auto const& field : ensemble->fields()) {
      std::string const element = group + "/" + field.name;
      if (!file->has(element))
        throw Error(fmt::format("{}: its ensemble '{}' has no field '{}'", path, stored.name, field.name));
      StoredColumn column{field, 1, file->is_dataset(element), true, 0, {}, factor(field.dimension)};
      std::string const values = column.constant ? element : element + "/value";
      column.values = file->dataset(values);
      Extents const extents = column.values.extents();
      std::size_t const leading = column.constant ? 1 : 2;
      column.scalar = extents.size() == leading;
      column.columns = column.scalar ? 1 : extents.back();
      if (file->integer(values, "components") != field.components ||
          column.columns < static_cast<std::uint64_t>(field.components))
        throw Error(fmt::format("{}: its field '{}' of ensemble '{}' has another number of components than {}", path,
                                field.name, stored.name, field.components));
      if (column.constant)
        column.checksum = checksum_of(column.values.reals(), column);
      else
        stored.capacity = extents[1];
      if (!column.constant && file->has(element + "/checksum")) column.checksums = file->dataset(element + "/checksum");
      stored.columns.push_back(std::move(column));
    }
    found.push_back(std::move(stored));
  }
  ensembles = std::move(found);
  file->start_ordered_writes();
  for (std::size_t k = 0; k < ensembles.size(); ++k) grow(ensembles[k], k, ensembles[k].capacity);
  open = true;
}

// Restores the file to the state after the frames up to a step, if that state was marked.
void Trajectory::State::take_back(std::int64_t last_step) const {
  auto const first_frames = [&](std::int64_t last) -> UndoLog::Label {
    auto const stored = File::open(path);
    std::size_t const count = layout::frames_until(layout::frames(*stored).steps, last);
    return {count, layout::checksum_of_frames(*stored, count)};
  };
  auto const wanted = first_frames(last_step);
  File::take_back(path, log(), wanted, [&] {
    try {
      return first_frames(std::numeric_limits<std::int64_t>::max()) == wanted;
    } catch (Error const&) {
      return false;
    }
  });
}

// Removes the frames after a step, and incomplete frames of a killed run.
void Trajectory::State::cut(std::int64_t last_step) {
  auto const names = layout::ensembles(*file);
  layout::Frames const stored = layout::frames(*file);
  frames = layout::frames_until(stored.steps, last_step);
  file->hold();
  auto const shorten = [&](std::string const& dataset, std::uint64_t capacity, bool has_particles) {
    Dataset values = file->dataset(dataset);
    Extents const before = values.extents();
    Extents after = before;
    after[0] = frames;
    if (has_particles) after[1] = capacity;
    if (after != before) values.resize(after);
  };
  std::string const first = "/particles/" + names[0];
  shorten(first + "/position/step", 0, false);
  shorten(first + "/position/time", 0, false);
  for (auto const& element : file->children(first + "/box"))
    shorten(fmt::format("{}/box/{}/value", first, element), 0, false);
  checksum = layout::checksum_of_frames(*file, frames);
  for (auto const& name : names) {
    std::string const group = "/particles/" + name;
    shorten(group + "/count/value", 0, false);
    for (auto const& element : file->children(group))
      if (std::string const sums = group + "/" + element + "/checksum"; element != "box" && file->has(sums))
        shorten(sums, 0, false);
    auto const counts = file->dataset(group + "/count/value").integers();
    std::uint64_t capacity = 0;
    for (auto const count : counts) capacity = std::max(capacity, static_cast<std::uint64_t>(count));
    for (auto const& element : file->children(group)) {
      std::string const values = group + "/" + element + "/value";
      if (element == "box" || element == "count" || file->is_dataset(group + "/" + element)) continue;
      std::uint64_t const room = frames > 0 ? capacity : file->dataset(values).extents()[1];
      shorten(values, room, true);
    }
    for (char const* label : {"id", "species"}) {
      Dataset values = file->dataset(group + "/" + label);
      if (frames > 0 && values.extents()[0] > capacity) values.resize({capacity});
    }
  }
  file->release();
}

// Allocates space for more particles.
void Trajectory::State::grow(StoredEnsemble& stored, std::size_t index, std::uint64_t capacity) {
  if (capacity > stored.capacity) {
    for (auto& column : stored.columns) {
      if (column.constant) continue;
      Extents extents = column.values.extents();
      extents[1] = capacity;
      column.values.resize(extents);
    }
    stored.capacity = capacity;
  }
  for (std::size_t label = 0; label < stored.labels.size(); ++label) {
    std::uint64_t const before = stored.labels[label].extents()[0];
    if (before >= capacity) continue;
    std::vector<std::int64_t> numbers(capacity - before, static_cast<std::int64_t>(index));
    if (label == 0)
      for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::int64_t>(before + i);
    stored.labels[label].resize({capacity});
    stored.labels[label].write(numbers.data(), {before}, {capacity - before});
  }
}

void Trajectory::State::check(std::int64_t at_step, std::span<AnyEnsemble const* const> list,
                              BoxEdges const& box) const {
  bool same = list.size() == ensembles.size();
  for (std::size_t k = 0; same && k < list.size(); ++k)
    same = list[k]->name() == ensembles[k].name && list[k]->class_name() == ensembles[k].class_name;
  if (!same) throw Error(fmt::format("{}: the ensembles of step {} are not those of the frames before", path, at_step));
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (periodic[axis] != (static_cast<int>(axis) < box.dimension && box.periodic[axis]))
      throw Error(fmt::format("{}: the boundary of axis {} has changed at step {}", path, "xyz"[axis], at_step));
  for (std::size_t k = 0; k < list.size(); ++k)
    for (auto const& column : ensembles[k].columns)
      if (column.constant && checksum_of(gather(*list[k], column), column) != column.checksum)
        throw Error(fmt::format("{}: the field '{}' of ensemble '{}' was declared constant and has changed at step {}",
                                path, column.field.name, list[k]->name(), at_step));
}

// Appends this frame's checksum.
void Trajectory::State::write_checksum(Dataset& checksums, std::uint64_t sum) {
  auto const bits = std::bit_cast<std::int64_t>(sum);
  checksums.resize({frames + 1});
  checksums.write(&bits, {frames}, {1});
  layout::add_checksum(checksum, frames, sum);
}

// Appends this frame's values of the positions, or of all other fields.
void Trajectory::State::write_values(StoredEnsemble& stored, AnyEnsemble const& ensemble, bool positions) {
  for (auto& column : stored.columns) {
    if (column.constant || (column.field.name == "position") != positions) continue;
    Extents extents{frames + 1, stored.capacity, column.columns}, start{frames, 0, 0},
        count{1, ensemble.size(), column.columns};
    if (column.scalar) extents.pop_back(), start.pop_back(), count.pop_back();
    column.values.resize(extents);
    auto const values = gather(ensemble, column);
    column.values.write(values.data(), start, count);
    if (column.checksums) write_checksum(*column.checksums, checksum_of(values, column));
  }
}

// The positions are written last, in a separate flush: a frame is complete if it has positions.
void Trajectory::State::write_frame(std::int64_t at_step, double at_time, std::span<AnyEnsemble const* const> list,
                                    BoxEdges const& box) {
  for (std::size_t k = 0; k < list.size(); ++k) {
    grow(ensembles[k], k, list[k]->size());
    write_values(ensembles[k], *list[k], false);
    auto const count = static_cast<std::int64_t>(list[k]->size());
    ensembles[k].count.resize({frames + 1});
    ensembles[k].count.write(&count, {frames}, {1});
  }
  auto const d = static_cast<std::uint64_t>(box.dimension);
  std::array<double, 6> low_high{};
  std::copy_n(box.low, d, low_high.begin());
  std::copy_n(box.high, d, low_high.begin() + box.dimension);
  for (double& x : low_high) x *= length_factor;
  bounds.resize({frames + 1, 2, d});
  bounds.write(low_high.data(), {frames, 0, 0}, {1, 2, d});
  if (has_edges) {
    std::uint64_t const axes = edges.extents()[1];
    std::vector<double> matrix(axes * axes, 0.0);
    for (std::uint64_t axis = 0; axis < axes; ++axis) {
      double const length = axis < d ? length_factor * (box.high[axis] - box.low[axis]) : 1;
      matrix[axis * (axes + 1)] = std::isfinite(length) ? length : 1;
    }
    edges.resize({frames + 1, axes, axes});
    edges.write(matrix.data(), {frames, 0, 0}, {1, axes, axes});
  }
  double const shown_time = time_factor * at_time;
  time.resize({frames + 1});
  time.write(&shown_time, {frames}, {1});
  step.resize({frames + 1});
  step.write(&at_step, {frames}, {1});
  for (std::size_t k = 0; k < list.size(); ++k)
    if (ensembles[k].checksums)
      write_checksum(*ensembles[k].checksums,
                     layout::checksum(at_step, shown_time, static_cast<std::int64_t>(list[k]->size()),
                                      std::span(low_high).first(2 * d)));
  file->flush();
  for (std::size_t k = 0; k < list.size(); ++k) write_values(ensembles[k], *list[k], true);
  file->flush();
}

Trajectory::Trajectory(std::unique_ptr<State> state) : state_(std::move(state)) {}

Trajectory::Trajectory(std::string path, TrajectoryOptions options) : state_(std::make_unique<State>()) {
  state_->path = path;
  state_->options = std::move(options);
  state_->file = File::create(std::move(path), true);
  std::remove(state_->log().c_str());
}

Trajectory Trajectory::append_to(std::string path, std::int64_t last_step, TrajectoryOptions options) {
  auto state = std::make_unique<State>();
  state->path = path;
  state->options = std::move(options);
  state->take_back(last_step);
  std::remove(state->log().c_str());
  state->file = File::open_for_writing(std::move(path));
  state->laid_out = true;
  state->cut(last_step);
  return Trajectory(std::move(state));
}

Trajectory::~Trajectory() = default;
Trajectory::Trajectory(Trajectory&&) noexcept = default;
Trajectory& Trajectory::operator=(Trajectory&&) noexcept = default;

void Trajectory::write(std::int64_t step, double time, std::span<AnyEnsemble const* const> ensembles,
                       BoxEdges const& box) {
  if (!state_ || !state_->file)
    throw Error((state_ ? state_->path + ": " : std::string()) + "the trajectory has ended" +
                (state_ && !state_->failure.empty() ? " (" + state_->failure + ")" : ""));
  State& state = *state_;
  if (box.dimension < 1 || box.dimension > 3)
    throw Error(fmt::format("{}: a box of dimension {}", state.path, box.dimension));
  if (state.open) state.check(step, ensembles, box);
  try {
    if (!state.laid_out) state.lay_out(ensembles, box);
    if (!state.open) {
      state.open_datasets(ensembles, box);
      state.check(step, ensembles, box);
    }
    state.write_frame(step, time, ensembles, box);
  } catch (Error const& error) {
    state.failure = error.what();
    state.ensembles.clear();
    state.close_datasets();
    state.file.reset();
    throw Error(fmt::format("{} (step {}; the {} frames before it are kept)", state.failure, step, state.frames));
  }
  ++state.frames;
}

std::size_t Trajectory::frames() const { return state_ ? state_->frames : 0; }
void Trajectory::mark() {
  if (state_ && state_->file && state_->laid_out)
    state_->file->keep_in(state_->log(), {state_->frames, state_->checksum});
}
void Trajectory::sync() {
  if (state_ && state_->file) state_->file->sync();
}

std::uint64_t Trajectory::checksum() const { return state_ ? state_->checksum : 0; }

void Trajectory::close() {
  if (!state_ || !state_->file) return;
  state_->close_datasets();
  auto const file = std::move(state_->file);
  file->close();
}

void check_stored_name(std::string const& what, std::string const& name) {
  // HDF5 interprets '/' and '.' as paths, and names of ensembles are parts of file names.
  constexpr std::size_t longest = 100;
  bool const control = std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  if (name.empty() || name.size() > longest || control || name == "." || name == ".." ||
      name.find('/') != std::string::npos)
    throw Error(
        fmt::format("{} can't be called '{}' in files; a name has 1 to {} letters, without '/' and control characters, "
                    "and is not '.' or '..'",
                    what, boltzmann::quoted(name), longest));
}

void check_stored_names(AnyEnsemble const& ensemble) {
  check_stored_name("an ensemble", ensemble.name());
  for (auto const& field : ensemble.fields()) {
    check_stored_name("a field", field.name);
    if (field.name == "box" || field.name == "count" || field.name == "id" || field.name == "species")
      throw Error(fmt::format("the field '{}' of ensemble '{}' has a name that H5MD needs for itself; choose another",
                              field.name, ensemble.name()));
  }
}

std::string h5md_unit(std::string const& unit) {
  std::string result;
  int sign = 1;
  std::string factor;
  bool good = true;
  auto const finish = [&] {
    if (factor.empty() || factor == "1") {
      factor.clear();
      return;
    }
    std::size_t const hat = factor.find('^');
    std::string name = factor.substr(0, hat);
    std::string const power = hat == std::string::npos ? "1" : factor.substr(hat + 1);
    good = good && !name.empty() && std::isdigit(static_cast<unsigned char>(name[0])) == 0 && power.size() == 1 &&
           std::isdigit(static_cast<unsigned char>(power[0])) != 0;
    if (name == "angstrom") name = "Angstrom";
    if (!result.empty()) result += ' ';
    result += name;
    if (sign < 0)
      result += "-" + power;
    else if (power != "1")
      result += "+" + power;
    factor.clear();
  };
  for (char const c : unit) {
    if (c != ' ' && c != '/' && c != '(' && c != ')') {
      factor += c;
      continue;
    }
    finish();
    if (c == '/') sign = -1;
  }
  finish();
  return good ? result : "";
}

}  // namespace boltzmann
