// Frames of a run, and which of them stay when it goes on.
#include <boltzmann/recording/run_frames.hpp>
#include <boltzmann/recording/saved_state.hpp>
#include <boltzmann/recording/trajectory_units.hpp>
#include <boltzmann/recording/version.hpp>

#include <fmt/format.h>

namespace boltzmann {

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
  file_.emplace(Trajectory::append_to(path, step, options()));
}

void RunFrames::write() {
  if (stopped_ >= 0) {
    close();
    go_on(path_, (simulation_.step() - 1) / every * every);
  }
  auto const ensembles = supervised_by(simulation_.schemes());
  Box const& box = simulation_.schemes().front()->box();
  BoxEdges edges{.dimension = box.dimension()};
  for (int a = 0; a < box.dimension(); ++a) {
    edges.low[a] = box.low(a);
    edges.high[a] = box.high(a);
    edges.periodic[a] = box.periodic(a);
  }
  file_->write(simulation_.step(), simulation_.time(),
               std::vector<AnyEnsemble const*>(ensembles.begin(), ensembles.end()), edges);
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
  if (file_) file_->close();
  file_.reset();
}

}  // namespace boltzmann
