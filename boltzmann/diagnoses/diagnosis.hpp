// Diagnosis: a measuring instrument that looks at a finished step and gives numbers with names and dimensions.
#pragma once

#include <boltzmann/core/dimension.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/diagnoses/flow_impulse.hpp>
#include <boltzmann/schemes/scheme.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

/// One number that a diagnosis gives at every look.
struct Column {
  std::string name;  ///< for example "kinetic energy" or "atoms temperature"
  Dimension dimension;
};

/// A finished step, as diagnoses see it. Nothing can be changed through it.
struct Sample {
  std::span<AnyEnsemble* const> ensembles;
  Box const& box;
  EnergyAndVirial const* measures;  ///< energies and virial; null unless the diagnosis needs one of them
  double boltzmann_constant;        ///< in the simulation's units
  double time;
  std::int64_t step;
  std::span<MeshField const* const> mesh_fields = {};  ///< empty unless the diagnosis needs_mesh()
  int threads = 1;                                     ///< for whoever sums over all pairs
  FlowImpulse taken = {};                              ///< of vortices that were taken out of a plane flow, so far
};

/// What a diagnosis has gathered over a run: a function of a distance, a wave number or a time lag.
struct GatheredTable {
  std::string name;             ///< of its file in the run's folder, without ".csv"; the same from the start
  std::vector<Column> columns;  ///< the others are functions of the first
  std::vector<std::vector<double>> values = {};  ///< of each column as many; none before there is something
};

/// A run that is about to begin.
struct PlannedRun {
  double time = 0;         ///< at which it begins,
  double step_size = 0;    ///< as it is now; steps may vary
  std::int64_t steps = 0;  ///< from there to its end
  std::int64_t every = 1;  ///< steps between two rows of diagnoses

  double end() const { return time + static_cast<double>(steps) * step_size; }
  /// How often something looks that looks every so many steps, from a time on.
  std::int64_t looks(std::int64_t interval, double since) const;
};

class Diagnosis {
 public:
  virtual ~Diagnosis() = default;
  /// Asked for before the first look, and again for the table's first line: the same columns in every answer.
  virtual std::vector<Column> columns() const = 0;
  /// Appends one value for each of columns().
  virtual void measure(Sample const& sample, std::vector<double>& values) = 0;
  /// Where it says that it follows(), it sees every step between two looks, too: where particles are, no energies.
  virtual bool follows() const { return false; }
  virtual void follow(Sample const&) {}
  // Whatever is needed is found once for all diagnoses of a look; what nobody needs is not there: Sample::measures is
  // null unless some diagnosis needs energies or the virial. The answers may not change.
  virtual bool needs_energies() const { return false; }
  virtual bool needs_virial() const { return false; }
  virtual bool needs_mesh() const { return false; }
  /// Whether it asks for sums over all particles alone, by measures.hpp, and for energies and the virial of them together.
  virtual bool sums() const { return false; }
  /// Whether it follows particles from look to look by their numbers.
  virtual bool by_number() const { return false; }
  /// Error if it can't be measured in such a box.
  virtual void check(Box const&) const {}
  /// Functions that it gathers from all looks so far: files at the end of a run, and the drawing `curves`.
  virtual std::vector<GatheredTable> tables() const { return {}; }
  /// The time of the first look that counts, where one was asked for.
  virtual double since() const { return 0; }
  /// What one should know before a run: lines that begin with "warning: ", for example that the run is too short for it.
  virtual std::vector<std::string> warnings(PlannedRun const&, UnitSystem const&) const { return {}; }
  /// What a run says of it at its end, a line each.
  virtual std::vector<std::string> report(UnitSystem const&) const { return {}; }
  /// What it remembers from earlier looks (initial velocities of a group, ...), for checkpoints.
  virtual std::vector<double> state() const { return {}; }
  /// Takes back what state() gave. Error if it is not of this diagnosis.
  virtual void restore(std::span<double const>) {}
};

/// Error where a box is sheared, of a diagnosis that finds images, or follows particles, through whole lengths alone, or
/// is of equilibrium.
void refuse_shear(Box const& box, char const* diagnosis);

/// A line of warning if something that is named `what` compares looks up to `count` of them apart, and the run has too few:
/// then there is no `result`.
std::vector<std::string> too_few_looks(PlannedRun const& run, UnitSystem const& units, std::string const& what,
                                       std::string const& result, std::int64_t every, double since, std::size_t count);

/// Why a simulation with such measures can't give what the diagnosis needs, in one line; empty if it can.
std::string refusal(Diagnosis const& diagnosis, EnergyAndVirial const& measures);

}  // namespace boltzmann
