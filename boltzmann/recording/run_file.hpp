// The run file of a program: it describes a run for which there is no scenario.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/pictures/picture.hpp>

#include <span>
#include <string>

namespace boltzmann {

inline constexpr char const* run_file = "run.toml";  ///< in the folder of the run

/// Title, units, time step, box with its walls and regions, classes of the ensembles with their fields, and pictures,
/// as TOML. Numbers are in the simulation's units, except for those of [units]. scenario/stored_run.hpp reads it.
std::string run_file_text(std::string const& title, UnitSystem const& units, double step_size, Box const& box,
                          std::span<AnyEnsemble* const> ensembles, std::span<Picture const> pictures);

}  // namespace boltzmann
