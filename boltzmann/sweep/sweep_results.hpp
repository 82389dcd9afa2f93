// What the runs of a sweep say together: tables and pictures of means over the seeds with their standard errors.
#pragma once

#include <boltzmann/scenario/sweep.hpp>

#include <string>
#include <vector>

namespace boltzmann {

/// From the diagnoses.csv of the runs (`folders`, one for each run; empty: it failed, and is left out) to sweep.csv,
/// series.csv, fits.csv and the pictures in `folder`. Prints the table and the fits unless quiet. Gives the names of
/// the files.
std::vector<std::string> write_sweep_results(SweepPlan const& plan, std::string const& folder,
                                             std::vector<std::string> const& folders, std::string const& title,
                                             bool quiet);

}  // namespace boltzmann
