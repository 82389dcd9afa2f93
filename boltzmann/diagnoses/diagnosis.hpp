// Diagnosis: a measuring instrument that samples finished steps and gives numbers with names and dimensions.
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

/// One number of a diagnosis per sample.
struct Column {
  std::string name;  ///< for example "kinetic energy" or "atoms temperature"
  Dimension dimension;
};

/// A finished step, as diagnoses see it, read-only.
struct Sample {
  std::span<AnyEnsemble* const> ensembles;
  Box const& box;
  EnergyAndVirial const* measures;  ///< energies and virial; null unless a diagnosis needs one of them
  double boltzmann_constant;        ///< in the simulation's units
  double time;
  std::int64_t step;
  std::span<MeshField const* const> mesh_fields = {};  ///< empty unless a diagnosis needs_mesh()
  int threads = 1;                                     ///< for sums over all pairs
  FlowImpulse taken = {};                              ///< of vortices removed from a plane flow, so far
  std::array<bool, 3> momentum_is_kept = {};           ///< of the system, if it needs_kept_momentum()
};

/// A function that a diagnosis has accumulated over a run: of a distance, a wave number or a time lag.
struct GatheredTable {
  std::string name;                              ///< of its file in the run's folder, without ".csv"; it never changes
  std::vector<Column> columns;                   ///< the others are functions of the first
  std::vector<std::vector<double>> values = {};  ///< the same number for each column; empty before there are samples
};

class Diagnosis {
 public:
  virtual ~Diagnosis() = default;
  /// Called before the first sample, and again for the table's first line; must always return the same columns.
  virtual std::vector<Column> columns() const = 0;
  /// Appends one value for each of columns().
  virtual void measure(Sample const& sample, std::vector<double>& values) = 0;
  /// If follows() is true, follow() is called after every step between two samples, too: with positions, but without
  /// energies.
  virtual bool follows() const { return false; }
  virtual void follow(Sample const&) {}
  // Needed data are computed once for all diagnoses of a sample; others are missing: Sample::measures is null unless a
  // diagnosis needs energies or the virial. The results must not change.
  virtual bool needs_energies() const { return false; }
  virtual bool needs_virial() const { return false; }
  virtual bool needs_mesh() const { return false; }
  /// True if it counts degrees of freedom, and so needs the conserved momentum.
  virtual bool needs_kept_momentum() const { return false; }
  /// True if it only needs global sums, by measures.hpp, and total energies and virial.
  virtual bool sums() const { return false; }
  /// True if it follows particles from sample to sample by their numbers.
  virtual bool by_number() const { return false; }
  /// Error if it does not support such a box.
  virtual void check(Box const&) const {}
  /// Functions accumulated over all samples so far: files at the end of a run, and the drawing `curves`.
  virtual std::vector<GatheredTable> tables() const { return {}; }
  /// Lines for the end of a run.
  virtual std::vector<std::string> report(UnitSystem const&) const { return {}; }
  /// The state from earlier samples (initial velocities of a group, ...), for checkpoints.
  virtual std::vector<double> state() const { return {}; }
  /// Restores the result of state(). Error if it does not fit this diagnosis.
  virtual void restore(std::span<double const>) {}
};

/// Error if a box is sheared, for a diagnosis that finds images, or follows particles, by whole lengths alone, or
/// assumes equilibrium.
void refuse_shear(Box const& box, char const* diagnosis);

/// The reason why a simulation with such measures lacks data of the diagnosis, in one line; empty if it has them.
std::string refusal(Diagnosis const& diagnosis, EnergyAndVirial const& measures);

}  // namespace boltzmann
