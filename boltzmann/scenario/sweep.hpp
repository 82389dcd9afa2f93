// Sweep: runs one scenario for several values of some of its keys, each with several seeds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace boltzmann {

struct ScenarioSimulation;

/// A key of the scenario and its successive values.
struct SweepKey {
  std::string path, name;          ///< as in --set: "ensembles.atoms.temperature"; in short, "temperature"
  std::vector<std::string> texts;  ///< the values as written in the scenario; of arrays, one component
  std::vector<double> numbers;     ///< as displayed, in `unit`; of arrays, the one component that differs. Empty if the
                                   ///< values are not such numbers
  std::string unit;                ///< empty: plain numbers
  std::string title() const { return unit.empty() ? path : path + " (" + unit + ")"; }
};

/// A column of diagnoses.csv.
struct SweepColumn {
  std::string name, unit;
  std::string title() const { return unit.empty() ? name : name + " (" + unit + ")"; }
};

/// A picture of all runs: means over the seeds, with bars of one standard error.
struct SweepPicture {
  bool time_series = false;  ///< columns over time; else a point per value
  std::string x;             ///< for points: a key that varies, or a column
  std::vector<std::string> y;
  std::string file = "sweep.png";
  bool line = false;         ///< fit a straight line
  bool logarithmic = false;  ///< y
};

/// The contents of [sweep]. Runs are numbered from 0: those of the first value with its seeds, of the second, ...
struct SweepPlan {
  std::vector<SweepKey> vary;       ///< they vary in step: all have the same number of values
  std::vector<std::string> labels;  ///< of the values, in readable form
  std::size_t values = 1, seeds = 1;
  std::uint64_t first_seed = 1;
  std::vector<std::string> table;                          ///< columns
  double from = std::numeric_limits<double>::quiet_NaN();  ///< the table has means since this time, in its display
                                                           ///< unit; NaN: the last row
  std::vector<SweepPicture> pictures;
  std::vector<SweepColumn> columns;  ///< all but the step; the first is the time
  std::string text;                  ///< the scenario with the sweep and all overrides, as TOML

  std::size_t runs() const { return values * seeds; }
  std::size_t value_of(std::size_t run) const { return run / seeds; }
  std::uint64_t seed_of(std::size_t run) const { return first_seed + run % seeds; }
};

/// The columns of diagnoses.csv of a scenario, after the step.
std::vector<SweepColumn> sweep_columns(ScenarioSimulation const& scenario);

}  // namespace boltzmann
