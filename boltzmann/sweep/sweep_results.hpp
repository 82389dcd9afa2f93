// Joint results of the runs of a sweep: tables and pictures of means over the seeds with their standard errors.
#pragma once

#include <boltzmann/scenario/sweep.hpp>

#include <string>
#include <vector>

namespace boltzmann {

/// Reads the diagnoses.csv of the runs (`folders`, one per run; empty: a failed run, left out). Writes sweep.csv,
/// series.csv, fits.csv and the pictures into `folder`, and prints the table and the fits unless quiet. Returns the
/// names of the files.
std::vector<std::string> write_sweep_results(SweepPlan const& plan, std::string const& folder,
                                             std::vector<std::string> const& folders, std::string const& title,
                                             bool quiet);

}  // namespace boltzmann
