// Diagnosis: a measuring instrument that looks at a finished step and gives numbers with names and dimensions.
#pragma once

#include <boltzmann/core/dimension.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/diagnoses/flow_impulse.hpp>
#include <boltzmann/schemes/scheme.hpp>

#include <array>
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
  std::array<bool, 3> momentum_is_kept = {};           ///< of the system, if it needs_kept_momentum()
};

/// What a diagnosis has gathered over a run: a function of a distance, a wave number or a time lag.
struct GatheredTable {
  std::string name;             ///< of its file in the run's folder, without ".csv"; the same from the start
  std::vector<Column> columns;  ///< the others are functions of the first
  std::vector<std::vector<double>> values = {};  ///< of each column as many; none before there is something
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
  /// Whether it counts degrees of freedom, and so has to know which momentum is kept.
  virtual bool needs_kept_momentum() const { return false; }
  /// Whether it asks for sums over all particles alone, by measures.hpp, and for energies and the virial of them together.
  virtual bool sums() const { return false; }
  /// Whether it follows particles from look to look by their numbers.
  virtual bool by_number() const { return false; }
  /// Error if it can't be measured in such a box.
  virtual void check(Box const&) const {}
  /// Functions that it gathers from all looks so far: files at the end of a run, and the drawing `curves`.
  virtual std::vector<GatheredTable> tables() const { return {}; }
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

/// Why a simulation with such measures can't give what the diagnosis needs, in one line; empty if it can.
std::string refusal(Diagnosis const& diagnosis, EnergyAndVirial const& measures);

}  // namespace boltzmann
