// Stored runs: the description of a run in a folder of results, ready to load the frames of its trajectory.
#pragma once

#include <boltzmann/scenario/parameters.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include <memory>
#include <string>

namespace boltzmann {

/// True if the folder holds a run of a scenario (scenario.toml) or of a program (run.toml).
bool holds_run(std::string const& folder);

/// The run of a folder, for drawing. A scenario's run is checked and ready to continue. A program's run has its
/// ensembles (without particles), box, units and pictures, and no laws, so that energies are unavailable. Throws Error
/// if the folder holds no run.
std::unique_ptr<ScenarioSimulation> load_stored_run(std::string const& folder);

/// Its properties that are known without loading particles. Throws Error as above.
ScenarioOutline outline_stored_run(std::string const& folder);

}  // namespace boltzmann
