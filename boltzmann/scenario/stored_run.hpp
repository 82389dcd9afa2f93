// Stored runs: what a folder of results says of its run, ready to be filled with the frames of its trajectory.
#pragma once

#include <boltzmann/scenario/parameters.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include <memory>
#include <string>

namespace boltzmann {

/// Whether the folder holds a run: of a scenario (scenario.toml) or of a program (run.toml).
bool holds_run(std::string const& folder);

/// The run of a folder, to be drawn: that of a scenario is checked and ready to go on; that of a program has its
/// ensembles (without particles), box, units and pictures, and no laws: energies can't be had of it. Error if the
/// folder holds no run.
std::unique_ptr<ScenarioSimulation> load_stored_run(std::string const& folder);

/// What can be said of it without making its particles. Error as above.
ScenarioOutline outline_stored_run(std::string const& folder);

}  // namespace boltzmann
