// Frames of a run, and which of them are kept when it is resumed.
#include <boltzmann/files/trajectory_view.hpp>
#include <boltzmann/recording/run_frames.hpp>
#include <boltzmann/recording/saved_state.hpp>
#include <boltzmann/recording/trajectory_units.hpp>
#include <boltzmann/recording/version.hpp>

#include <fmt/format.h>

#include <bit>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <utility>

namespace boltzmann {
namespace {

std::vector<std::size_t> sizes_of(std::vector<AnyEnsemble*> const& ensembles) {
  std::vector<std::size_t> sizes;
  for (auto const* ensemble : ensembles) sizes.push_back(ensemble->size());
  return sizes;
}

BoxEdges edges_of(Box const& box) {
  BoxEdges edges{.dimension = box.dimension()};
  for (int a = 0; a < box.dimension(); ++a) {
    edges.low[a] = box.low(a);
    edges.high[a] = box.high(a);
    edges.periodic[a] = box.periodic(a);
  }
  return edges;
}

}  // namespace

TrajectoryOptions RunFrames::options() const {
  TrajectoryOptions options;
  options.version = program_version;
  options.sizes_change = simulation_.numbers_change();
  options.elements = elements;
  if (!units_.is_reduced()) {
    options.unit_name = [units = units_](Dimension d) { return trajectory_unit(units, d).unit; };
    options.factor = [units = units_](Dimension d) { return trajectory_unit(units, d).factor; };
  }
  return options;
}

void RunFrames::begin(std::string const& path) {
  if (every > 0) file_.emplace(path, options());
  path_ = path;
}

void RunFrames::check(Checkpoint const& saved, std::string const& path) const {
  auto const found = saved.state.find("trajectory.h5");
  if (every == 0 || found == saved.state.end()) return;
  auto const count = static_cast<std::size_t>(found->second.at(2));
  if (count == 0) return;
  TrajectoryReader const stored(path);
  if (stored.frames() < count || stored.checksum(count) != whole(found->second))
    throw Error(
        fmt::format("{}: its frames up to step {} are not those that this run has written (damaged, or of "
                    "another run)",
                    path, saved.step));
  // This also finds damage of HDF5's own tables, which would make later writes fail.
  if (auto const damage = stored.find_damage(count); !damage.empty())
    fmt::print(stderr, "warning: {}; the run continues, and the frame stays as it is\n", damage);
}

void RunFrames::go_on(std::string const& path, Checkpoint const& saved) {
  if (every == 0) return;
  path_ = path;
  file_.reset();
  TrajectoryReader const stored(path);
  std::size_t const frames = stored.frames_until(saved.step);
  auto const found = saved.state.find("trajectory.h5");
  std::size_t const stay = found == saved.state.end() ? frames : static_cast<std::size_t>(found->second.at(2));
  stay_ = {stay, stored.checksum(stay)};
  stay_until_ = stay > 0 ? stored.steps()[stay - 1] : std::numeric_limits<std::int64_t>::min();
  stopped_ = saved.step;
  times_.clear();
  for (std::size_t frame = 0; frame < stay; ++frame) times_.push_back(stored.written_time(frame));
  sizes_.clear();
  same_particles_ = true;
  shown_ = false;
  for (auto const& ensemble : stored.ensembles())
    for (std::size_t frame = 0; frame < stay; ++frame) {
      std::size_t const size = stored.size(frame, ensemble.name);
      if (frame == 0) sizes_.push_back(size);
      same_particles_ = same_particles_ && size == sizes_.back();
    }
  if (frames == stay) open();
}

void RunFrames::open() {
  file_.emplace(Trajectory::append_to(path_, stay_until_, options()));
  marked_ = false;
}

void RunFrames::write() {
  if (!file_) open();
  if (!std::exchange(marked_, true)) file_->mark();
  auto const ensembles = supervised_by(simulation_.schemes());
  file_->write(simulation_.step(), simulation_.time(),
               std::vector<AnyEnsemble const*>(ensembles.begin(), ensembles.end()),
               edges_of(simulation_.schemes().front()->box()));
  auto const options = this->options();
  // in the unit of the file
  times_.push_back((options.factor ? options.factor(dimensions::time) : 1) * simulation_.time());
  if (sizes_.empty()) sizes_ = sizes_of(ensembles);
  if (same_particles_ && sizes_ != sizes_of(ensembles)) {
    same_particles_ = false;
    std::error_code ignored;
    std::filesystem::remove(view(), ignored);
  }
  if (!shown_ || std::has_single_bit(times_.size())) show(false);
}

void RunFrames::show(bool finished) {
  auto const ensembles = supervised_by(simulation_.schemes());
  if (!same_particles_ || times_.empty() || sizes_ != sizes_of(ensembles)) return;
  try {
    write_trajectory_view(view(), std::filesystem::path(path_).filename().string(), options(),
                          std::vector<AnyEnsemble const*>(ensembles.begin(), ensembles.end()),
                          edges_of(simulation_.schemes().front()->box()), times_, finished);
    shown_ = true;
  } catch (Error const&) {
    shown_ = false;  // the frames do not depend on the view; the next call tries again
  }
}

void RunFrames::write_last() {
  if (every == 0 || path_.empty() || simulation_.step() % every == 0) return;
  if (file_ || simulation_.step() != stopped_) write();
}

void RunFrames::save(Checkpoint& checkpoint) {
  if (every == 0) return;
  if (file_) file_->sync();
  auto const [count, checksum] = file_ ? std::pair(file_->frames(), file_->checksum()) : stay_;
  auto& state = checkpoint.state["trajectory.h5"] = halves(checksum);
  state.push_back(static_cast<double>(count));
  marked_ = false;
}

void RunFrames::close() {
  if (!file_) return;
  auto file = std::exchange(file_, std::nullopt);
  file->close();
  if (!marked_) std::remove((path_ + ".undo").c_str());
  show(true);
}

}  // namespace boltzmann
