// Unit change: from the units of a trajectory to those that an exported file is in. Private to this room.
#pragma once

#include <boltzmann/core/unit_style.hpp>
#include <boltzmann/files/trajectory_export.hpp>

#include <string>

namespace boltzmann {

class UnitChange {
 public:
  /// To the units that are wanted, "metal", "run"; empty: those of the format. Error if there are none of that name, the
  /// format is in others, or the run has none.
  UnitChange(std::string const& wanted, ExportFormat const& format, TrajectoryReader const& reader);

  /// "metal", "run", ...; "none": the run has pure numbers.
  std::string const& name() const { return name_; }

  struct Change {
    std::string unit;
    double factor = 1;
  };
  /// For numbers that are in this unit.
  Change operator()(std::string const& unit) const;

 private:
  std::string name_;
  UnitStyle const* style_ = nullptr;  // null: the units of the run
};

}  // namespace boltzmann
