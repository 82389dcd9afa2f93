// Unit change: from the units of a trajectory to those of an exported file. Private to this module.
#pragma once

#include <boltzmann/core/unit_style.hpp>
#include <boltzmann/files/trajectory_export.hpp>

#include <string>

namespace boltzmann {

class UnitChange {
 public:
  /// `wanted`: a unit style, "metal", or "run"; empty: the default of the format. Throws Error if there is no such
  /// style, the format has other fixed units, or the run has none.
  UnitChange(std::string const& wanted, ExportFormat const& format, TrajectoryReader const& reader);

  /// "metal", "run", ...; "none" if the run has pure numbers.
  std::string const& name() const { return name_; }

  struct Change {
    std::string unit;
    double factor = 1;
  };
  /// The change for numbers in this unit.
  Change operator()(std::string const& unit) const;

 private:
  std::string name_;
  UnitStyle const* style_ = nullptr;  // null: the units of the run
};

}  // namespace boltzmann
