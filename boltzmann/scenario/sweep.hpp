// Sweep: one scenario run for several values of some of its keys, each with several seeds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace boltzmann {

struct ScenarioSimulation;

/// A key of the scenario and the values that it takes, one after the other.
struct SweepKey {
  std::string path, name;          ///< as in --set: "ensembles.atoms.temperature"; in short, "temperature"
  std::vector<std::string> texts;  ///< the values as they are written in the scenario; of arrays that component
  std::vector<double> numbers;     ///< as they are shown, in `unit`; of arrays the one component that differs. Empty
                                   ///< if the values are no such numbers
  std::string unit;                ///< empty: that of the scenario's plain numbers
  std::string title() const { return unit.empty() ? path : path + " (" + unit + ")"; }
};

/// A column of diagnoses.csv.
struct SweepColumn {
  std::string name, unit;
  std::string title() const { return unit.empty() ? name : name + " (" + unit + ")"; }
};

/// A picture of all runs: means over the seeds, with bars of one standard error.
struct SweepPicture {
  bool time_series = false;  ///< columns over time; else a point for each value
  std::string x;             ///< of points: a key that varies, or a column
  std::vector<std::string> y;
  std::string file = "sweep.png";
  bool line = false;         ///< a straight line through the points
  bool logarithmic = false;  ///< y
};

/// All that a [sweep] says. Runs are numbered from 0: those of the first value with its seeds, of the second, ...
struct SweepPlan {
  std::vector<SweepKey> vary;       ///< these go together: all have as many values
  std::vector<std::string> labels;  ///< of the values, for people
  std::size_t values = 1, seeds = 1;
  std::uint64_t first_seed = 1;
  std::vector<std::string> table;                          ///< columns
  double from = std::numeric_limits<double>::quiet_NaN();  ///< the table has means since this time, as it is shown;
                                                           ///< NaN: the last row
  std::vector<SweepPicture> pictures;
  std::vector<SweepColumn> columns;  ///< all but the step; the first is the time
  std::string text;                  ///< the scenario with the sweep and all overrides, as TOML

  std::size_t runs() const { return values * seeds; }
  std::size_t value_of(std::size_t run) const { return run / seeds; }
  std::uint64_t seed_of(std::size_t run) const { return first_seed + run % seeds; }
};

/// The columns that diagnoses.csv of a scenario will have behind the step.
std::vector<SweepColumn> sweep_columns(ScenarioSimulation const& scenario);

}  // namespace boltzmann
