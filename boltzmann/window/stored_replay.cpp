// Creates a replay from the files of a folder.
#include <boltzmann/core/error.hpp>
#include <boltzmann/recording/run_file.hpp>
#include <boltzmann/scenario/scenario_recording.hpp>
#include <boltzmann/scenario/stored_run.hpp>
#include <boltzmann/window/stored_replay.hpp>

#include <filesystem>
#include <nlohmann/json.hpp>

namespace boltzmann {

StoredReplay::StoredReplay(std::string const& folder) {
  namespace fs = std::filesystem;
  if (!fs::is_directory(folder)) throw Error("there is no folder '" + folder + "' with a run to show");
  if (!holds_run(folder))
    throw Error("'" + folder + "' holds no run that could be shown: neither scenario.toml nor " + run_file);
  if (!fs::exists(folder + "/trajectory.h5"))
    throw Error("'" + folder +
                "' has no trajectory.h5 to show: the run stored none (trajectory = 10 in [output] stores a frame every "
                "10 steps)");
  scenario_ = load_stored_run(folder);
  recording_ = make_recording(*scenario_, folder, {.overwrite = true});
  views_.emplace(*scenario_->simulation, scenario_->units, title_of(*scenario_, folder), folder);
  for (auto const& view : scenario_->views) views_->add(view.name, view);
  views_->take(*recording_);
  for (auto const& shown : views_->describe()["diagnoses"])
    if (shown["drawing"] != "table") own_views_.push_back(shown["name"]);
  replay_.emplace(*views_, scenario_->name, scenario_->description);
  views_->add_usual();
}

}  // namespace boltzmann
