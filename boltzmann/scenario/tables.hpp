// Tables: the tables of a scenario with their keys, for `bzm show`, the guide and programs that write scenarios.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/options.hpp>
#include <boltzmann/integrators/integrator.hpp>
#include <boltzmann/laws/formula_law.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/simulation/barostat.hpp>
#include <boltzmann/simulation/substeps.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

/// [run]; its step and its end are read by code. To add a key, add a member, a row of the table, and its use where the
/// run is built.
struct RunOptions {
  std::int64_t steps = 0;
  std::optional<double> time;  ///< instead of the number of steps
  std::uint64_t seed = 1;
  int threads = 0;
  std::optional<double> cutoff, skin, tolerance;
  std::optional<SubstepOptions> substeps;
  bool shifted = true;
};
OptionTable const& run_options();

/// [units]: quantities that are 1, in SI.
struct UnitsOptions {
  std::string base;
  std::optional<double> sigma, epsilon, mass, length, time, density, charge, temperature;
};
OptionTable const& units_options();
/// The keys of a base, besides its name.
OptionTable units_options(std::string const& base);

/// [box]; corners, boundaries, walls and regions are read by code.
struct BoxOptions {
  struct Sheared {
    double rate = 0;
    std::string flow = "x", gradient = "y";
    bool established = true;
  };
  std::optional<Sheared> shear;
};
/// `shear` in it.
OptionTable const& shear_options();

/// [[box.walls]]
struct WallOptions {
  std::string axis;
  Box::End end = Box::End::low;
  bool open = false;
  std::optional<std::array<double, 3>> velocity;
  Wall wall;  ///< without its velocity
};
OptionTable const& wall_options();

/// [[box.regions]]
struct RegionOptions {
  std::optional<std::array<double, 3>> low, high;
  Region::Side side = Region::Side::keep_out;
};
OptionTable const& region_options();

/// [[ensembles]]; the class, the loader, bonds and the fields are read by code.
struct EnsembleOptions {
  std::string name;
  std::optional<Method> integrator;
  std::size_t number = 0, molecule = 0;
  Appearance appearance;
  std::string element;
  std::optional<double> temperature;
  MaxwellianOptions thermal;
  std::optional<std::array<double, 3>> drift;
};
OptionTable const& ensemble_options();

/// [[classes]], which are read by code of their own.
OptionTable const& class_options();

/// One of their `fields`; its default and its period are in its own unit, and read by code.
struct ClassFieldOptions {
  std::string name, kind = "scalar", unit, doc;
  bool sum = false;
  std::optional<double> neighbours;
  std::vector<std::string> of;
  std::size_t bond_order = 0;
};
OptionTable const& class_field_options();

/// [[ensembles.set]]; the selection and the fields are read by code.
struct SetOptions {
  bool freeze = false;
};
OptionTable const& set_options();

/// [equilibrate]: a heat bath for a limited time.
OptionTable const& equilibration_options();

/// [[events]]; set values, added particles and selections are read by code.
struct EventOptions {
  double at = 0;
  std::optional<double> every;
  std::int64_t times = 1;
  std::optional<double> temperature, scale;
  std::optional<std::array<double, 3>> kick;
  bool subtract_drift = false;
  double keep_distance = 0;
};
OptionTable const& event_options();

/// [[sweep.pictures]]; the axes are read by code.
struct SweepPictureOptions {
  std::string drawing = "points", fit, file;
  bool logarithmic = false;
};
OptionTable const& sweep_picture_options();

/// [output]: intervals in steps.
struct OutputOptions {
  std::int64_t diagnoses = 0, trajectory = 0, checkpoint = 0, mesh = 0;
};
OptionTable const& output_options();

OptionTable const& box_options();

/// [[influences]]: keys other than the law, ensembles and formulas; parameters of the law are further keys.
struct InfluenceOptions {
  std::optional<double> cutoff, switch_from;
  std::int64_t every = 1;
  std::string precision = "full", changes;
  std::vector<double> bonded_factors;
  FormulaLaw::AtCutoff at_cutoff = FormulaLaw::AtCutoff::cut;
  bool tail = false, from_outside = false;
};
OptionTable const& influence_options();

/// [[rigid_bonds]]; the ensemble and the particles are read by code.
struct RigidBondOptions {
  double length = 0, tolerance = 1e-10;
};
OptionTable const& rigid_bond_options();
/// For [[dissipation]] between pairs, besides the keys of its kind.
OptionTable const& dissipation_pair_options();

struct ScenarioTable {
  std::string name;     ///< "smooth.rezone"
  std::string heading;  ///< as a scenario writes it: "[[smooth.rezone]]"
  std::string doc;
  OptionTable const* options;
  void* plain;  ///< an object with default values; null: none of the keys is a plain member
};
/// The tables with options, in the order of the guide. Those of several kinds (dissipation, pictures, views, diagnoses)
/// have one per kind and are not included. The fields of classes for [[ensembles.set]] are in particle_classes().
std::vector<ScenarioTable> const& scenario_tables();

}  // namespace boltzmann
