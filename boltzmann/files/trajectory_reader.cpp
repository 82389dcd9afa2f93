// Reading trajectories.
#include <fmt/format.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/files/trajectory_layout.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <algorithm>
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
      if (element != "box" && !file.is_dataset(object)) bound(object + "/value");
    }
  Frames result;
  result.steps.resize(count);
  result.times.resize(count);
  file.dataset(first + "/position/step").read(result.steps.data(), {0}, {count});
  file.dataset(first + "/position/time").read(result.times.data(), {0}, {count});
  return result;
}

}  // namespace layout

struct TrajectoryReader::State {
  std::unique_ptr<hdf5::File> file;

  /// Numbers in the file are those of the simulation times this.
  double factor(std::string const& dataset) const {
    return file->has(dataset, "boltzmann_factor") ? file->real(dataset, "boltzmann_factor") : 1;
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
  time_factor_ = state_->factor("/particles/" + ensembles_[0].name + "/position/time");
  for (double& time : times_) time /= time_factor_;
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
  throw Error(fmt::format("{}: has no ensemble '{}'; it has {}{}", state_->file->path(), name, join(names),
                          did_you_mean(name, names)));
}

TrajectoryReader::StoredField const& TrajectoryReader::find(StoredEnsemble const& ensemble,
                                                            std::string const& name) const {
  std::vector<std::string> names;
  for (auto const& field : ensemble.fields) {
    if (field.name == name) return field;
    names.push_back(field.name);
  }
  throw Error(fmt::format("{}: its ensemble '{}' has no field '{}'; it has {}{}", state_->file->path(), ensemble.name,
                          name, join(names), did_you_mean(name, names)));
}

std::size_t TrajectoryReader::checked(std::size_t frame) const {
  if (frame >= frames())
    throw Error(fmt::format("{}: has no frame {}; its {} frames count from 0", state_->file->path(), frame, frames()));
  return frame;
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
  double const factor = numbers == Numbers::written ? 1 : state_->factor(dataset);
  if (factor != 1)
    for (double& value : result) value /= factor;
  return result;
}

BoxEdges TrajectoryReader::box(std::size_t frame, Numbers numbers) const {
  hdf5::File const& file = *state_->file;
  std::string const group = "/particles/" + ensembles_[0].name + "/box";
  BoxEdges box;
  auto const boundary = file.texts(group, "boundary");
  auto const values = file.dataset(group + "/bounds/value");
  auto const extents = values.extents();
  if (extents.size() != 3 || extents[1] != 2 || extents[2] < 1 || extents[2] > 3 || boundary.size() < extents[2])
    throw Error(fmt::format("{}: its box is damaged", file.path()));
  std::uint64_t const d = extents[2];
  box.dimension = static_cast<int>(d);
  values.read(box.low, {checked(frame), 0, 0}, {1, 1, d});
  values.read(box.high, {frame, 1, 0}, {1, 1, d});
  double const factor = numbers == Numbers::written ? 1 : state_->factor(group + "/bounds/value");
  for (std::size_t axis = 0; axis < d; ++axis) box.low[axis] /= factor, box.high[axis] /= factor;
  for (std::size_t axis = 0; axis < d; ++axis) box.periodic[axis] = boundary[axis] == "periodic";
  return box;
}

void TrajectoryReader::load(std::size_t frame, AnyEnsemble& ensemble) const {
  StoredEnsemble const& stored = find(ensemble.name());
  if (stored.class_name != ensemble.class_name() || stored.dimension != ensemble.dimension())
    throw Error(fmt::format("{}: its ensemble '{}' is of class {} in {}D, not {} in {}D", state_->file->path(),
                            stored.name, stored.class_name, stored.dimension, ensemble.class_name(),
                            ensemble.dimension()));
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
