// Reading trajectories.
#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/checksum.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/files/trajectory_layout.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace boltzmann {

namespace layout {

std::vector<std::string> ensembles(hdf5::File const& file) {
  if (!file.has("/h5md") || !file.has("/particles"))
    throw Error(file.path() + ": is not a trajectory, or has no frame yet");
  std::vector<std::pair<std::int64_t, std::string>> found;
  for (auto const& name : file.children("/particles")) {
    if (!file.has("/particles/" + name, "index"))
      throw Error(fmt::format("{}: its ensemble '{}' was not written by this program", file.path(), name));
    found.emplace_back(file.integer("/particles/" + name, "index"), name);
  }
  if (found.empty()) throw Error(file.path() + ": has no ensembles");
  std::sort(found.begin(), found.end());
  std::vector<std::string> names;
  names.reserve(found.size());
  for (auto& [index, name] : found) names.push_back(std::move(name));
  return names;
}

Frames frames(hdf5::File const& file) {
  std::uint64_t count = std::numeric_limits<std::uint64_t>::max();
  auto const bound = [&](std::string const& dataset) {
    auto const extents = file.dataset(dataset).extents();
    count = std::min(count, extents.empty() ? 0 : extents[0]);
  };
  auto const names = ensembles(file);
  std::string const first = "/particles/" + names[0];
  bound(first + "/position/step");
  bound(first + "/position/time");
  for (auto const& element : file.children(first + "/box")) bound(fmt::format("{}/box/{}/value", first, element));
  for (auto const& name : names)
    for (auto const& element : file.children("/particles/" + name)) {
      std::string const object = fmt::format("/particles/{}/{}", name, element);
      if (element == "box" || file.is_dataset(object)) continue;
      bound(object + "/value");
      if (file.has(object + "/checksum")) bound(object + "/checksum");
    }
  Frames result;
  result.steps.resize(count);
  result.times.resize(count);
  file.dataset(first + "/position/step").read(result.steps.data(), {0}, {count});
  file.dataset(first + "/position/time").read(result.times.data(), {0}, {count});
  return result;
}

std::uint64_t checksum(std::vector<double> const& values) {
  return crc64(values.data(), values.size() * sizeof(double));
}

std::uint64_t checksum(std::int64_t step, double time, std::int64_t count, std::span<double const> bounds) {
  std::uint64_t sum = crc64(&step, sizeof(step));
  sum = crc64(&time, sizeof(time), sum);
  sum = crc64(&count, sizeof(count), sum);
  return crc64(bounds.data(), bounds.size_bytes(), sum);
}

void add_checksum(std::uint64_t& all, std::uint64_t frame, std::uint64_t sum) {
  std::array const words{frame, sum};
  all += crc64(words.data(), sizeof(words));
}

std::uint64_t checksum_of_frames(hdf5::File const& file, std::uint64_t frames) {
  std::uint64_t all = 0;
  for (auto const& name : ensembles(file))
    for (auto const& element : file.children("/particles/" + name)) {
      std::string const object = fmt::format("/particles/{}/{}/checksum", name, element);
      if (element == "box" || !file.has(object)) continue;
      std::vector<std::int64_t> sums(frames);
      file.dataset(object).read(sums.data(), {0}, {frames});
      for (std::uint64_t f = 0; f < frames; ++f) add_checksum(all, f, std::bit_cast<std::uint64_t>(sums[f]));
    }
  return all;
}

std::size_t frames_until(std::vector<std::int64_t> const& steps, std::int64_t last_step) {
  if (steps.size() > 1 && steps[1] < steps[0]) return steps.size();  // counts backwards from the start
  std::size_t frames = 0;
  while (frames < steps.size() && steps[frames] <= last_step && (frames == 0 || steps[frames] > steps[frames - 1]))
    ++frames;
  return frames;
}

std::array<bool, 3> periodic_axes(hdf5::File const& file, std::string const& box) {
  std::array<bool, 3> periodic{};
  if (!file.has(box, "boltzmann_periodic")) {  // version 0.1
    auto const boundary = file.texts(box, "boundary");
    for (std::size_t a = 0; a < std::min<std::size_t>(boundary.size(), 3); ++a) periodic[a] = boundary[a] == "periodic";
    return periodic;
  }
  auto const axes = file.integers(box, "boltzmann_periodic");
  for (std::size_t a = 0; a < std::min<std::size_t>(axes.size(), 3); ++a) periodic[a] = axes[a] != 0;
  return periodic;
}

}  // namespace layout

struct TrajectoryReader::State {
  std::unique_ptr<hdf5::File> file;
  std::vector<bool> damaged;  // frames whose step, time, size or box differs from what was written

  /// The factor from the simulation's numbers to those in the file.
  double factor(std::string const& dataset) const {
    return file->has(dataset, "boltzmann_factor") ? file->real(dataset, "boltzmann_factor") : 1;
  }

  /// Finds the frames whose step, time, size or box doesn't match its checksum. After a failure of the disk or of the
  /// power, the last frames may be damaged; earlier ones are still good.
  void find_damaged(std::vector<StoredEnsemble> const& ensembles, std::vector<std::int64_t> const& steps,
                    std::vector<double> const& times) {
    damaged.assign(steps.size(), false);
    auto const all = file->dataset("/particles/" + ensembles[0].name + "/box/bounds/value");
    auto const extents = all.extents();
    if (extents.size() != 3 || extents[1] != 2 || extents[2] < 1 || extents[2] > 3)
      throw Error(fmt::format("{}: its box is damaged", file->path()));
    std::uint64_t const frames = steps.size(), d = 2 * extents[2];
    std::vector<double> bounds(frames * d);
    all.read(bounds.data(), {0, 0, 0}, {frames, 2, extents[2]});
    for (auto const& ensemble : ensembles) {
      std::string const group = "/particles/" + ensemble.name + "/count";
      if (!file->has(group + "/checksum")) continue;
      std::vector<std::int64_t> sums(frames), counts(frames);
      file->dataset(group + "/checksum").read(sums.data(), {0}, {frames});
      file->dataset(group + "/value").read(counts.data(), {0}, {frames});
      for (std::uint64_t f = 0; f < frames; ++f)
        if (std::bit_cast<std::uint64_t>(sums[f]) !=
            layout::checksum(steps[f], times[f], counts[f], std::span(bounds).subspan(f * d, d)))
          damaged[f] = true;
    }
  }

  /// Throws Error if the values don't match their checksum.
  void check_values(std::string const& element, bool constant, std::size_t frame,
                    std::vector<double> const& values) const {
    std::int64_t sum = 0;
    if (constant) {
      if (!file->has(element, "boltzmann_checksum")) return;
      sum = file->integer(element, "boltzmann_checksum");
    } else {
      if (!file->has(element + "/checksum")) return;
      file->dataset(element + "/checksum").read(&sum, {frame}, {1});
    }
    if (std::bit_cast<std::uint64_t>(sum) != layout::checksum(values))
      throw Error(fmt::format("{}: its frame {} is damaged: {} is not what was written", file->path(), frame, element));
  }
};

TrajectoryReader::TrajectoryReader(std::string path) : state_(std::make_unique<State>()) {
  state_->file = hdf5::File::open(std::move(path));
  hdf5::File const& file = *state_->file;
  auto const unit = [&](std::string const& object) {
    return file.has(object, "boltzmann_unit") ? file.text(object, "boltzmann_unit") : "";
  };
  for (auto const& name : layout::ensembles(file)) {
    std::string const group = "/particles/" + name;
    StoredEnsemble ensemble{name, file.text(group, "class"), static_cast<int>(file.integer(group, "dimension")), {}};
    if (file.has(group, "boltzmann_element")) ensemble.element = file.text(group, "boltzmann_element");
    std::vector<std::pair<std::int64_t, StoredField>> fields;
    for (auto const& element : file.children(group)) {
      if (element == "box" || element == "count" || element == "id" || element == "species") continue;
      bool const constant = file.is_dataset(group + "/" + element);
      std::string const values = group + "/" + element + (constant ? "" : "/value");
      fields.emplace_back(file.integer(values, "offset"),
                          StoredField{element, static_cast<int>(file.integer(values, "components")), constant,
                                      unit(values), state_->factor(values)});
    }
    std::sort(fields.begin(), fields.end(), [](auto const& a, auto const& b) { return a.first < b.first; });
    for (auto& [offset, field] : fields) ensemble.fields.push_back(std::move(field));
    ensembles_.push_back(std::move(ensemble));
  }
  auto stored = layout::frames(file);
  steps_ = std::move(stored.steps);
  times_ = std::move(stored.times);
  state_->find_damaged(ensembles_, steps_, times_);
  written_times_ = times_;
  double const time_factor = state_->factor("/particles/" + ensembles_[0].name + "/position/time");
  for (double& time : times_) time /= time_factor;
  time_unit_ = unit("/particles/" + ensembles_[0].name + "/position/time");
}

TrajectoryReader::~TrajectoryReader() = default;
TrajectoryReader::TrajectoryReader(TrajectoryReader&&) noexcept = default;
TrajectoryReader& TrajectoryReader::operator=(TrajectoryReader&&) noexcept = default;

TrajectoryReader::StoredEnsemble const& TrajectoryReader::find(std::string const& name) const {
  std::vector<std::string> names;
  for (auto const& ensemble : ensembles_) {
    if (ensemble.name == name) return ensemble;
    names.push_back(ensemble.name);
  }
  throw Error(fmt::format("{}: has no ensemble '{}'{}", state_->file->path(), name, choices(name, names, "it has")));
}

TrajectoryReader::StoredField const& TrajectoryReader::find(StoredEnsemble const& ensemble,
                                                            std::string const& name) const {
  std::vector<std::string> names;
  for (auto const& field : ensemble.fields) {
    if (field.name == name) return field;
    names.push_back(field.name);
  }
  throw Error(fmt::format("{}: its ensemble '{}' has no field '{}'{}", state_->file->path(), ensemble.name, name,
                          choices(name, names, "it has")));
}

std::uint64_t TrajectoryReader::checksum(std::size_t frames) const {
  return layout::checksum_of_frames(*state_->file, std::min(frames, this->frames()));
}

std::size_t TrajectoryReader::checked(std::size_t frame) const {
  if (frame >= frames())
    throw Error(fmt::format("{}: has no frame {}; its {} frames count from 0", state_->file->path(), frame, frames()));
  if (state_->damaged[frame])
    throw Error(fmt::format("{}: its frame {} is damaged: its step, time, size or box is not what was written",
                            state_->file->path(), frame));
  return frame;
}

std::size_t TrajectoryReader::frames_until(std::int64_t last_step) const {
  return layout::frames_until(steps_, last_step);
}

std::size_t TrajectoryReader::size(std::size_t frame, std::string const& ensemble) const {
  std::int64_t count = 0;
  state_->file->dataset("/particles/" + find(ensemble).name + "/count/value").read(&count, {checked(frame)}, {1});
  if (count < 0) throw Error(fmt::format("{}: its frame {} is damaged", state_->file->path(), frame));
  return static_cast<std::size_t>(count);
}

std::vector<double> TrajectoryReader::read(std::size_t frame, std::string const& ensemble, std::string const& field,
                                           Numbers numbers) const {
  StoredField const& stored = find(find(ensemble), field);
  std::size_t const n = size(frame, ensemble);
  auto const components = static_cast<std::size_t>(stored.components);
  std::string const dataset = "/particles/" + ensemble + "/" + field + (stored.constant ? "" : "/value");
  auto const values = state_->file->dataset(dataset);
  hdf5::Extents extents = values.extents(), start(extents.size(), 0);
  std::size_t const particles_at = stored.constant ? 0 : 1;
  if (extents.size() <= particles_at || n > extents[particles_at])
    throw Error(
        fmt::format("{}: its field '{}' has fewer particles than its frame {}", state_->file->path(), field, frame));
  bool const vector = extents.size() > particles_at + 1;
  if (!stored.constant) start[0] = frame, extents[0] = 1;
  extents[particles_at] = n;
  if (vector) extents.back() = components;
  std::vector<double> result(n * components);
  values.read(result.data(), start, extents);
  state_->check_values("/particles/" + ensemble + "/" + field, stored.constant, frame, result);
  double const factor = numbers == Numbers::written ? 1 : state_->factor(dataset);
  if (factor != 1)
    for (double& value : result) value /= factor;
  return result;
}

BoxEdges TrajectoryReader::box(std::size_t frame, Numbers numbers) const {
  hdf5::File const& file = *state_->file;
  std::string const group = "/particles/" + ensembles_[0].name + "/box";
  BoxEdges box;
  auto const values = file.dataset(group + "/bounds/value");
  auto const extents = values.extents();
  std::uint64_t const d = extents[2];
  box.dimension = static_cast<int>(d);
  values.read(box.low, {checked(frame), 0, 0}, {1, 1, d});
  values.read(box.high, {frame, 1, 0}, {1, 1, d});
  double const factor = numbers == Numbers::written ? 1 : state_->factor(group + "/bounds/value");
  for (std::size_t axis = 0; axis < d; ++axis) box.low[axis] /= factor, box.high[axis] /= factor;
  std::ranges::copy(layout::periodic_axes(file, group), box.periodic);
  return box;
}

std::string TrajectoryReader::find_damage(std::size_t frames) const {
  frames = std::min(frames, this->frames());
  std::string found;
  for (auto const& ensemble : ensembles_) {
    for (char const* label : {"id", "species"})
      state_->file->dataset("/particles/" + ensemble.name + "/" + label).integers();
    for (auto const& field : ensemble.fields)
      if (auto line = find_damage(frames, ensemble, field); found.empty()) found = std::move(line);
  }
  return found;
}

/// Reads blocks of frames, of about 32 MB each.
std::string TrajectoryReader::find_damage(std::size_t frames, StoredEnsemble const& ensemble,
                                          StoredField const& field) const {
  std::string const element = "/particles/" + ensemble.name + "/" + field.name;
  auto const line = [&](std::size_t frame) {
    return fmt::format("{}: its frame {} is damaged: {} is not what was written", state_->file->path(), frame, element);
  };
  if (field.constant || !state_->file->has(element + "/checksum")) return "";
  auto const dataset = state_->file->dataset(element + "/value");
  hdf5::Extents block = dataset.extents(), start(block.size(), 0);
  std::size_t const columns = block.size() > 2 ? block[2] : 1, components = static_cast<std::size_t>(field.components);
  if (block.size() < 2 || columns < components) return line(0);
  std::vector<std::int64_t> sums(frames), counts(frames);
  state_->file->dataset(element + "/checksum").read(sums.data(), {0}, {frames});
  state_->file->dataset("/particles/" + ensemble.name + "/count/value").read(counts.data(), {0}, {frames});
  std::size_t const capacity = block[1], row = std::max<std::size_t>(capacity * columns, 1);
  if (row > std::size_t{1} << 40) return line(0);
  std::size_t const most = std::clamp<std::size_t>((std::size_t{1} << 22) / row, 1, 8192);
  std::vector<double> values, own;
  for (std::size_t first = 0; first < frames; first += most) {
    start[0] = first, block[0] = std::min(most, frames - first);
    values.resize(block[0] * capacity * columns);
    dataset.read(values.data(), start, block);
    for (std::size_t f = 0; f < block[0]; ++f) {
      if (counts[first + f] < 0 || static_cast<std::uint64_t>(counts[first + f]) > capacity) return line(first + f);
      own.clear();
      auto at = values.begin() + static_cast<std::ptrdiff_t>(f * capacity * columns);
      for (std::int64_t i = 0; i < counts[first + f]; ++i, at += static_cast<std::ptrdiff_t>(columns))
        own.insert(own.end(), at, at + field.components);
      if (std::bit_cast<std::uint64_t>(sums[first + f]) != layout::checksum(own)) return line(first + f);
    }
  }
  return "";
}

void TrajectoryReader::load(std::size_t frame, Box& box) const {
  constexpr double rounding = 1e-12;
  BoxEdges const stored = this->box(frame);
  auto edges = box.edges();
  for (int a = 0; a < std::min(stored.dimension, box.dimension()); ++a) {
    bool const moved = std::max(std::abs(stored.low[a] - box.low(a)), std::abs(stored.high[a] - box.high(a))) >
                       rounding * box.length(a);
    if (!box.periodic(a) || !moved) continue;
    edges[a] = stored.low[a];
    edges[3 + a] = stored.high[a];
  }
  box.edges(edges);
  if (box.sheared()) box.move_walls(times_[frame]);
}

void TrajectoryReader::load(std::size_t frame, AnyEnsemble& ensemble) const {
  StoredEnsemble const& stored = find(ensemble.name());
  if (stored.class_name != ensemble.class_name() || stored.dimension != ensemble.dimension())
    throw Error(fmt::format("{}: its ensemble '{}' is of class {} in {}D, not {} in {}D", state_->file->path(),
                            stored.name, stored.class_name, stored.dimension, ensemble.class_name(),
                            ensemble.dimension()));
  load(frame, stored.name, ensemble);
}

void TrajectoryReader::load(std::size_t frame, std::string const& name, AnyEnsemble& ensemble) const {
  StoredEnsemble const& stored = find(name);
  ensemble.resize(size(frame, stored.name));
  for (auto const& field : stored.fields) {
    Field const* target = ensemble.find_field(field.name);
    if (target == nullptr || target->components != field.components) continue;
    auto const values = read(frame, stored.name, field.name);
    auto const components = static_cast<std::size_t>(field.components);
    for (std::size_t i = 0; i < ensemble.size(); ++i)
      std::copy_n(values.data() + i * components, components, ensemble.row(i) + target->offset);
  }
}

}  // namespace boltzmann
