// Parameters of diagnoses: one struct for all kinds, and the table of its members.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/diagnoses/diagnosis.hpp>
#include <boltzmann/laws/formula_law.hpp>
#include <boltzmann/laws/weight.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/schemes/mesh/mesh_field.hpp>
#include <boltzmann/schemes/vortices/vortex_source.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

/// The parameters of all kinds of diagnoses. DiagnosisKind::options lists those of a kind; the others must keep their
/// defaults.
struct DiagnosisParameters {
  /// All ensembles of the simulation, for names, dimensions and checks. Used only during construction.
  std::vector<AnyEnsemble const*> available = {};
  /// Names of ensembles: one set of columns for each, "atoms temperature". Empty: one set for the whole system,
  /// "temperature" (for mean-velocity, velocity-diffusion and extremes: one set for each ensemble).
  std::vector<std::string> ensembles = {};
  /// Replaces the ensemble's name in columns, if a group is measured; empty: the ensemble's name.
  std::string label = {};
  std::vector<std::uint32_t> particles = {};  ///< a group of one ensemble, by number; empty: all
  std::vector<std::uint32_t> partners = {};   ///< of pairs: the other side; empty: the group itself
  std::optional<std::array<double, 3>> similar_velocity =
      {};                             ///< a group by velocity at the first sample (section 5.2.3.3) ...
  double tolerance = 0;               ///< ... within this distance of it
  bool subtract_drift = false;        ///< temperature: relative to the mean velocity, over N - 1
  bool about_centre_of_mass = false;  ///< angular momentum: else about the origin
  std::string quantity = {};  ///< extremes: a name for quantity(); of a mesh: a name for mesh_quantity(); shock:
                              ///< "velocity" (empty) or "density"
  std::string formula = {};   ///< formula: with sums over particles; histogram: of one particle
  std::vector<FormulaParameter> formula_parameters = {};  ///< named numbers for formulas
  std::vector<FormulaPart> formula_parts = {};            ///< named parts of formulas
  UnitSystem units = UnitSystem::reduced();               ///< of numbers in formulas
  std::vector<MeshField const*> mesh_fields =
      {};  ///< fields of the mesh, for kinds that are of_mesh; used only during construction
  std::vector<VortexSource> vortices = {};  ///< those with influences, for kinds that are of_flow
  std::vector<int> mode = {};               ///< field-mode: periods in the box along each axis
  std::string axis = {};                    ///< wave-spectrum, heat-flux, slab, shock: "x", "y" or "z"
  std::size_t modes = 0;                    ///< wave-spectrum: number of recorded waves; 0: all, up to 256
  std::string by = {};                      ///< structure-factor: "mesh", or "direct" (empty)
  WeightShape weight = WeightShape::lucy;   ///< entropy: of the averages
  double range = 0;                         ///< entropy: of the weight; 0: each particle's own
  double gamma = 0;                         ///< entropy: the ratio of specific heats; 0: 1 + 2/D
  double conductivity = 0;                  ///< heat-flux: of the material
  double since = 0;                         ///< heat-flux, shock, diffusion: start of the averages
  double from = std::numeric_limits<double>::quiet_NaN();  ///< slab: its ends at the start; NaN: those of the box
  double to = std::numeric_limits<double>::quiet_NaN();
  std::size_t count = 0;  ///< slab: number of adjacent slabs, 0: one; shock: bins of the profile, 0: automatic
  std::string end = {};   ///< shock: "low" or "high", where it starts; empty: the wall that moves into the matter
  double margin = 0;      ///< shock: excluded width beside the front and at both ends; 0: 5 % of the matter
  double near = 0;        ///< shock: start of the window behind the front; 0: two margins behind it
  std::optional<std::array<double, 3>> stream = {};      ///< body-forces: velocity of the undisturbed flow
  double length = 0;                                     ///< body-forces: of coefficients; 0: none
  std::size_t order = 6;                                 ///< bond-order: of the harmonics
  std::vector<Column> columns_before = {};               ///< average: those of all diagnoses before it
  std::string columns = {};                              ///< average: names of them, separated by commas; empty: all
  std::size_t every = 1;                                 ///< for time series: steps from one sample to the next
  std::size_t origins = 20;                              ///< likewise: number of stored time origins
  double far = std::numeric_limits<double>::infinity();  ///< shock: end of the window, or a margin before the driven
                                                         ///< end
};

/// The dimension of the diagnosis' space. Error if there is no ensemble.
int dimension_of(DiagnosisParameters const& parameters);

/// All members that a user can set. DiagnosisKind::options lists those of a kind, with their meaning.
OptionTable const& diagnosis_options();

}  // namespace boltzmann
