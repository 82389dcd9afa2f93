// Frames of a run, and which of them stay when it goes on.
#include <boltzmann/files/trajectory_view.hpp>
#include <boltzmann/recording/run_frames.hpp>
#include <boltzmann/recording/saved_state.hpp>
#include <boltzmann/recording/trajectory_units.hpp>
#include <boltzmann/recording/version.hpp>

#include <fmt/format.h>

#include <bit>
#include <filesystem>

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
}

void RunFrames::go_on(std::string const& path, std::int64_t step) {
  if (every == 0) return;
  path_ = path;
  stopped_ = -1;
  TrajectoryReader const stored(path);
  std::size_t stay = 0;
  for (std::size_t frame = 0; frame < stored.frames_until(step); ++frame)
    if (stored.steps()[frame] % every == 0)
      ++stay;
    else
      stopped_ = stored.steps()[frame];
  before_stop_ = {stay, stored.checksum(stay)};
  std::size_t const frames = stored.frames_until(step);
  times_.assign(stored.times().begin(), stored.times().begin() + static_cast<std::ptrdiff_t>(frames));
  sizes_.clear();
  same_particles_ = true;
  shown_ = false;
  for (auto const& ensemble : stored.ensembles())
    for (std::size_t frame = 0; frame < frames; ++frame) {
      std::size_t const size = stored.size(frame, ensemble.name);
      if (frame == 0) sizes_.push_back(size);
      same_particles_ = same_particles_ && size == sizes_.back();
    }
  file_.emplace(Trajectory::append_to(path, step, options()));
}

void RunFrames::write() {
  if (stopped_ >= 0) {
    close();
    go_on(path_, (simulation_.step() - 1) / every * every);
  }
  auto const ensembles = supervised_by(simulation_.schemes());
  file_->write(simulation_.step(), simulation_.time(),
               std::vector<AnyEnsemble const*>(ensembles.begin(), ensembles.end()),
               edges_of(simulation_.schemes().front()->box()));
  times_.push_back(simulation_.time());
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
    shown_ = false;  // the frames are there without it; the next one tries again
  }
}

void RunFrames::write_last() {
  if (file_ && simulation_.step() % every != 0 && simulation_.step() != stopped_) write();
}

void RunFrames::save(Checkpoint& checkpoint) {
  if (!file_) return;
  file_->sync();
  auto const [count, checksum] = stopped_ >= 0 ? before_stop_ : std::pair(file_->frames(), file_->checksum());
  auto& state = checkpoint.state["trajectory.h5"] = halves(checksum);
  state.push_back(static_cast<double>(count));
}

void RunFrames::close() {
  if (!file_) return;
  auto file = std::exchange(file_, std::nullopt);
  file->close();
  show(true);
}

}  // namespace boltzmann
