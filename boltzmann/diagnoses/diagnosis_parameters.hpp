// What diagnoses may be told: one struct for all kinds, and the table of its members.
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

/// What a diagnosis may be told. Which of these a kind looks at is in its DiagnosisKind::options; the others must be
/// left as they are.
struct DiagnosisParameters {
  /// All ensembles of the simulation, for names, dimensions and checks. They are used by the constructor only.
  std::vector<AnyEnsemble const*> available = {};
  /// Names of ensembles: one set of columns for each, "atoms temperature". Empty: one set for the whole system,
  /// "temperature" (for mean-velocity, velocity-diffusion and extremes: one set for each ensemble there is).
  std::vector<std::string> ensembles = {};
  /// What the columns are called instead of the ensemble, if a group is measured; empty: the ensemble's name.
  std::string label = {};
  std::vector<std::uint32_t> particles = {};  ///< a group of one ensemble, by number; empty: all
  std::vector<std::uint32_t> partners = {};   ///< of pairs: those on their other side; empty: the group itself
  std::optional<std::array<double, 3>> similar_velocity =
      {};                             ///< a group by velocity at the first look (section 5.2.3.3) ...
  double tolerance = 0;               ///< ... within this distance of it
  bool subtract_drift = false;        ///< temperature: without the mean velocity, over N - 1
  bool about_centre_of_mass = false;  ///< angular momentum: else about the origin
  std::string quantity = {};  ///< extremes: a name that quantity() knows; of a mesh: one that mesh_quantity() knows;
                              ///< shock: "velocity" (empty) or "density"
  std::string formula = {};   ///< formula: with sums over particles; histogram: of one
  std::vector<FormulaParameter> formula_parameters = {};  ///< numbers with names, for formulas
  std::vector<FormulaPart> formula_parts = {};            ///< parts of formulas, with names
  UnitSystem units = UnitSystem::reduced();               ///< of numbers in formulas
  std::vector<MeshField const*> mesh_fields =
      {};  ///< what the mesh has, for kinds that are of_mesh; used by the constructor only
  std::vector<VortexSource> vortices = {};  ///< those that act, for kinds that are of_flow
  std::vector<int> mode = {};               ///< field-mode: periods in the box along each axis
  std::string axis = {};                    ///< wave-spectrum, heat-flux, slab, shock: "x", "y" or "z"
  std::size_t modes = 0;  ///< wave-spectrum: how many waves are kept; 0: as many as there are, up to 256
  std::string by = {};    ///< structure-factor: "mesh", or "direct" (empty)
  WeightShape weight = WeightShape::lucy;  ///< entropy: of the averages
  double range = 0;                        ///< entropy: of the weight; 0: each particle's own
  double gamma = 0;                        ///< entropy: the ratio of specific heats; 0: 1 + 2/D
  double conductivity = 0;                 ///< heat-flux: of the material
  double since = 0;                        ///< heat-flux, shock, diffusion: the time from which means are taken
  double from = std::numeric_limits<double>::quiet_NaN();  ///< slab: its ends at the start; NaN: those of the box
  double to = std::numeric_limits<double>::quiet_NaN();
  std::size_t count = 0;  ///< slab: so many side by side, 0: one; shock: bins of the profile, 0: as they fit
  std::string end = {};   ///< shock: "low" or "high", from which it comes; empty: the wall that runs into the matter
  double margin = 0;      ///< shock: what is left out beside the front and at both ends; 0: 5 % of the matter
  double near = 0;        ///< shock: where the window behind the front begins; 0: two margins behind it
  std::optional<std::array<double, 3>> stream = {};      ///< body-forces: velocity of the undisturbed flow
  double length = 0;                                     ///< body-forces: of coefficients; 0: none
  std::size_t order = 6;                                 ///< bond-order: of the harmonics
  std::vector<Column> columns_before = {};               ///< average: those of all diagnoses before it
  std::string columns = {};                              ///< average: names of them, separated by commas; empty: all
  std::size_t every = 1;                                 ///< of what gathers: steps from one look to the next
  std::size_t origins = 20;                              ///< the same: how many of them are remembered
  double far = std::numeric_limits<double>::infinity();  ///< shock: where it ends, or a margin before the driven end
};

/// Of the space that it looks at. Error if there is no ensemble.
int dimension_of(DiagnosisParameters const& parameters);

/// All members that a user can set. Which of them a kind looks at, and what they mean there, is in
/// DiagnosisKind::options.
OptionTable const& diagnosis_options();

}  // namespace boltzmann
