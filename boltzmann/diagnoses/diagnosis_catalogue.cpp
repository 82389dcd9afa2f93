// The table of diagnoses, and functions that make some of them.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/average.hpp>
#include <boltzmann/diagnoses/body_forces.hpp>
#include <boltzmann/diagnoses/bond_order.hpp>
#include <boltzmann/diagnoses/box_measures.hpp>
#include <boltzmann/diagnoses/chains.hpp>
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/diagnoses/diffusion.hpp>
#include <boltzmann/diagnoses/energy_balance.hpp>
#include <boltzmann/diagnoses/formula_diagnosis.hpp>
#include <boltzmann/diagnoses/green_kubo.hpp>
#include <boltzmann/diagnoses/heat_flux.hpp>
#include <boltzmann/diagnoses/instruments.hpp>
#include <boltzmann/diagnoses/mean_profile.hpp>
#include <boltzmann/diagnoses/radial_distribution.hpp>
#include <boltzmann/diagnoses/shock.hpp>
#include <boltzmann/diagnoses/slab.hpp>
#include <boltzmann/diagnoses/structure_factor.hpp>
#include <boltzmann/diagnoses/time_correlation.hpp>
#include <boltzmann/schemes/molecules/molecule_scheme.hpp>
#include <boltzmann/schemes/vortices/vortex_flow.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace boltzmann {
namespace {

std::unique_ptr<Diagnosis> make_heat_flux(DiagnosisParameters const& parameters) {
  int const axis = parameters.axis.empty() ? dimension_of(parameters) - 1 : parameters.axis[0] - 'x';
  return std::make_unique<HeatFlux>(parameters.available,
                                    HeatFluxOptions{axis, parameters.conductivity, parameters.since});
}

/// The first axis by default.
int axis_of(DiagnosisParameters const& parameters) { return parameters.axis.empty() ? 0 : parameters.axis[0] - 'x'; }

std::unique_ptr<Diagnosis> make_slab(DiagnosisParameters const& parameters) {
  for (auto const& name : parameters.ensembles) ensemble_named(parameters.available, name);
  return std::make_unique<Slab>(
      parameters.available,
      SlabOptions{axis_of(parameters), parameters.from, parameters.to, std::max<std::size_t>(parameters.count, 1),
                  parameters.ensembles, parameters.label.empty() ? "slab" : parameters.label});
}

std::unique_ptr<Diagnosis> make_shock(DiagnosisParameters const& parameters) {
  for (auto const& name : parameters.ensembles) ensemble_named(parameters.available, name);
  ShockOptions options;
  options.axis = axis_of(parameters);
  if (!parameters.end.empty() && parameters.end != "low" && parameters.end != "high")
    throw Error(fmt::format("a shock comes from the end 'low' or 'high' of its axis, not '{}'", parameters.end));
  if (!parameters.end.empty()) options.end = parameters.end == "low" ? Box::End::low : Box::End::high;
  if (!parameters.quantity.empty()) options.quantity = parameters.quantity;
  options.count = parameters.count;
  options.since = parameters.since;
  options.margin = parameters.margin;
  options.near = parameters.near;
  options.far = parameters.far;
  options.ensembles = parameters.ensembles;
  return std::make_unique<Shock>(parameters.available, std::move(options));
}

std::unique_ptr<Diagnosis> make_body_forces(DiagnosisParameters const& parameters) {
  return std::make_unique<BodyForces>(parameters.available, parameters.stream, parameters.length);
}

/// The default if the option is not set.
std::size_t or_usual(std::size_t said, std::size_t usual) { return said > 0 ? said : usual; }

std::unique_ptr<Diagnosis> make_radial_distribution(DiagnosisParameters const& parameters) {
  RadialDistributionOptions options{parameters.ensembles, parameters.label, parameters.to};
  options.count = or_usual(parameters.count, options.count);
  options.since = parameters.since;
  options.every = parameters.every;
  options.particles = parameters.particles;
  options.partners = parameters.partners;
  return std::make_unique<RadialDistribution>(parameters.available, std::move(options));
}

std::unique_ptr<Diagnosis> make_structure_factor(DiagnosisParameters const& parameters) {
  StructureFactorOptions options{parameters.ensembles, parameters.label};
  options.modes = or_usual(parameters.modes, options.modes);
  if (!parameters.by.empty()) options.by = wave_sums_words().named(parameters.by);
  options.since = parameters.since;
  options.every = parameters.every;
  options.particles = parameters.particles;
  options.partners = parameters.partners;
  return std::make_unique<StructureFactor>(parameters.available, std::move(options));
}

std::unique_ptr<Diagnosis> make_bond_order(DiagnosisParameters const& parameters) {
  return std::make_unique<BondOrder>(parameters.available, BondOrderOptions{parameters.ensembles, parameters.label,
                                                                            parameters.range, parameters.order});
}

template <class Kind>
std::unique_ptr<Diagnosis> make_time_correlation(DiagnosisParameters const& parameters) {
  TimeCorrelationOptions options{parameters.ensembles, parameters.since, parameters.every};
  options.count = or_usual(parameters.count, options.count);
  options.origins = parameters.origins;
  options.subtract_drift = parameters.subtract_drift;
  options.label = parameters.label;
  options.particles = parameters.particles;
  return std::make_unique<Kind>(parameters.available, options);
}

std::unique_ptr<Diagnosis> make_green_kubo(DiagnosisParameters const& parameters) {
  GreenKuboOptions options;
  options.quantity = transport_words().named(parameters.quantity);
  options.count = or_usual(parameters.count, options.count);
  options.since = parameters.since;
  return std::make_unique<GreenKubo>(parameters.available, options);
}

std::unique_ptr<Diagnosis> make_mean_profile(DiagnosisParameters const& parameters) {
  MeanProfileOptions options;
  if (!parameters.quantity.empty()) options.quantities = parameters.quantity;
  options.ensembles = parameters.ensembles;
  options.label = parameters.label;
  options.axis = axis_of(parameters);
  options.from = parameters.from;
  options.to = parameters.to;
  options.count = or_usual(parameters.count, options.count);
  options.since = parameters.since;
  return std::make_unique<MeanProfile>(parameters.available, std::move(options));
}

std::unique_ptr<Diagnosis> make_average(DiagnosisParameters const& parameters) {
  return std::make_unique<Average>(parameters.columns_before,
                                   AverageOptions{parameters.columns, parameters.label, parameters.since});
}

// ---- The table ----

struct Entry {
  DiagnosisKind kind;
  instruments::Maker* make;
};

OptionTable told(std::vector<OptionKey> const& keys) { return diagnosis_options().only(keys); }

std::vector<Entry> const& table() {  // long: a table, an entry for each diagnosis
  static std::vector<Entry> const entries = [] {
    OptionKey const each{"ensembles", "ensembles, with columns for each", "each ensemble"};
    std::vector<OptionKey> const group{each, {"label"}, {"particles"}, {"similar_velocity"}, {"tolerance"}};
    std::vector<OptionKey> group_and_quantity = group;
    group_and_quantity.push_back({"quantity", "a field, `\"speed\"`, `\"kinetic-energy\"`, ...", "", "\"speed\""});
    OptionKey const on_mesh{"quantity", "`\"field.x\"`, `\"potential\"` or `\"density\"`", "`\"field.x\"`"};
    OptionKey const pairs_of{"ensembles", "pairs within one ensemble, or between two", "all particles"};
    OptionKey const first_look{"since", "time of the first sample", "the start"};
    OptionKey const rows{"every", "sample only at rows whose step is a multiple of this"};
    OptionKey const lags{"count", "longest lag, in samples", "`200`"};
    OptionKey const group_label{"label", "name in columns and files", "that of the ensemble"};
    OptionKey const moving{"subtract_drift", "measure relative to the mean of the ensemble"};
    OptionKey const some{"ensembles", "only these ensembles", "all matter"};
    return std::vector<Entry>{
        {{"energies", "kinetic, potential, external, internal and total energy",
          told({{"ensembles", "ensembles with columns of their own kinetic energy", "none"}})},
         instruments::make_energies},
        {{"momentum", "total momentum, the sum of m v", told({{"ensembles"}})}, instruments::make_momentum},
        {{"angular-momentum", "sum of m r x v about the origin or the centre of mass; conserved in open space only",
          told({{"ensembles"}, {"about_centre_of_mass"}})},
         instruments::make_angular_momentum},
        {{"vortex-invariants",
          "circulation, linear and angular impulse of vortices, in 3D helicity: conserved by inviscid flow in open "
          "space",
          told({{"ensembles"}})},
         instruments::make_vortex_invariants},
        {{"vortex-energy",
          "flow of vortices in open space: energy (2D: Hamilton's function) and enstrophy over density, largest "
          "vorticity of an element, in 3D the part of the vorticity with a divergence; sums over all pairs",
          {},
          false,
          true},
         instruments::make_vortex_energy},
        {{"body-forces",
          "force of a flow on bodies over its density, averaged since the last row: on all by the change of the flow's "
          "impulse, with drag and lift coefficients; on each by pressure",
          told({{"stream"}, {"length"}})},
         make_body_forces},
        {{"temperature", "m <v^2> / k along each axis and their mean", told({{"ensembles"}, {"subtract_drift"}})},
         instruments::make_temperature},
        {{"pressure", "pressure tensor (sum of m v v + virial) / volume and the mean of its diagonal", {}},
         instruments::make_pressure},
        {{"viscosity", "sheared box: shear stress over rate, with pair friction; average it with `average`", {}},
         instruments::make_viscosity},
        {{"number", "number of particles and their mass", told({{"ensembles"}})}, instruments::make_number},
        {{"entropy",
          "entropy S / N k of an ideal gas of smooth particles, as a sum and as an integral, with and without velocity "
          "fluctuations",
          told({{"ensembles"}, {"weight"}, {"range"}, {"gamma"}})},
         instruments::make_entropy},
        {{"heat-flux",
          "smooth particles between two walls at given temperatures: conducted and convected heat, and the Nusselt "
          "number with mean and spread",
          told({{"axis", "axis from wall to wall", "the last"}, {"conductivity", "", "", "0.1"}, {"since"}})},
         make_heat_flux},
        {{"slab",
          "kinetic temperature (about the mean velocity), internal temperature, density, velocity and position of the "
          "particles that were initially in a slab",
          told({some,
                {"label", "name of the columns", "`\"slab\"`"},
                {"axis", "axis across the slab", "`\"x\"`"},
                {"from"},
                {"to"},
                {"count", "adjacent slabs of equal width", "`1`"}})},
         make_slab},
        {{"shock",
          "position and speed of a plane shock front, states behind and ahead of it in windows that move along, and "
          "the errors of the three Rankine-Hugoniot conditions",
          told({some,
                {"axis", "axis of the shock", "`\"x\"`"},
                {"end"},
                {"quantity", "quantity whose half-way value marks the front", "`\"velocity\"`", "",
                 option::word({"velocity", "density"})},
                {"count", "bins of the profile that shows the front", "automatic"},
                {"since"},
                {"margin"},
                {"near"},
                {"far"}})},
         make_shock},
        {{"mean-velocity", "mean velocity of a group of particles; its change is the drag", told(group)},
         instruments::make_mean_velocity},
        {{"velocity-diffusion", "variance of the velocities of a group of particles", told(group)},
         instruments::make_velocity_diffusion},
        {{"diffusion",
          "mean square displacement, relative to the mean and across periodic axes, and the diffusion coefficient from "
          "a linear fit",
          told({each, {"since"}})},
         [](DiagnosisParameters const& parameters) -> std::unique_ptr<Diagnosis> {
           return std::make_unique<Diffusion>(parameters.available, parameters.ensembles, parameters.since);
         }},
        {{"radial-distribution",
          "height and position of the highest peak of g(r), averaged over samples; g(r) and the running coordination "
          "number in radial-distribution.csv",
          told({pairs_of,
                {"label", "name in columns and file", "the ensembles"},
                {"particles"},
                {"partners"},
                {"to", "largest distance", "half of the shortest side"},
                {"count", "bins", "`200`"},
                rows,
                first_look})},
         make_radial_distribution},
        {{"structure-factor",
          "height and position of the highest value of S(k) over the wave vectors of a periodic box; S(k) in "
          "structure-factor.csv",
          told({pairs_of,
                {"label", "name in columns and file", "the ensembles"},
                {"particles"},
                {"partners"},
                {"modes", "periods of the shortest wave in the longest side", "`12`"},
                {"by"},
                rows,
                first_look})},
         make_structure_factor},
        {{"bond-order",
          "crystal order of neighbours: in 3D Steinhardt's q6 (fcc 0.575, bcc 0.629), in 2D psi6 (triangles 1); "
          "particle mean, global value and mean number of neighbours",
          told({{"ensembles", "ensemble of the particles and neighbours", "all"},
                {"label", "name of the columns", "the ensemble"},
                {"range", "range of neighbours", "", "1.5"},
                {"order", "symmetry: 4 for squares and cubes, 6 for triangles and close packing", "`6`"}})},
         make_bond_order},
        {{"velocity-autocorrelation",
          "Green-Kubo diffusion coefficient, from many time origins; <v(0).v(t)> in velocity-autocorrelation.csv, its "
          "spectrum in velocity-spectrum.csv",
          told({each, group_label, {"particles"}, first_look, {"every"}, lags, {"origins"}, moving})},
         make_time_correlation<VelocityAutocorrelation>},
        {{"mean-square-displacement",
          "Einstein diffusion coefficient from the later half of the mean square displacement, from many time origins "
          "and across periodic axes; file mean-square-displacement.csv",
          told({each, group_label, {"particles"}, first_look, {"every"}, lags, {"origins"}, moving})},
         make_time_correlation<MeanSquareDisplacement>},
        {{"green-kubo",
          "transport coefficient from the autocorrelation of the system's flux in equilibrium, sampled at each row; "
          "file green-kubo-viscosity.csv and the like",
          told({{"quantity", "the coefficient", "", "\"viscosity\"", option::word(transport_words().names())},
                {"count", "longest lag, in rows", "`200`"},
                first_look})},
         make_green_kubo},
        {{"mean-profile",
          "lowest and highest density, temperature, ... of bins along an axis, averaged over samples; profiles in "
          "mean-profile.csv",
          told({some,
                {"label", "name in columns and file", "none"},
                {"quantity", "quantities of the drawing `profile`, separated by commas: `\"density, pressure.xx\"`",
                 "`\"density, kinetic-temperature\"`"},
                {"axis", "axis of the bins", "`\"x\"`"},
                {"from", "lower end of the bins"},
                {"to", "upper end of the bins"},
                {"count", "bins", "`50`"},
                first_look})},
         make_mean_profile},
        {{"average",
          "columns of the diagnoses above: running mean, its error by block averaging, and their ratio; printed at the "
          "end of the run. average.csv has the error by block length",
          told({{"columns"}, {"label", "name of the file", "none"}, first_look})},
         make_average},
        {{"chains",
          "chains of particles stored one after the other: mean square end-to-end distance, mean square radius of "
          "gyration, and rms bond length",
          told({each, {"count", "particles of a chain", "", "20"}})},
         [](DiagnosisParameters const& parameters) -> std::unique_ptr<Diagnosis> {
           return std::make_unique<Chains>(parameters.available, parameters.ensembles, parameters.count);
         }},
        {{"extremes", "minimum, maximum and mean of a quantity over a group of particles", told(group_and_quantity)},
         instruments::make_extremes},
        {{"formula", "a formula with mean(...), sum(...), min(...) and max(...) over the particles of an ensemble",
          told({each,
                {"label", "name of the column", "", "\"order\""},
                {"formula", "", "", "\"norm(mean(velocity))/mean(speed)\""},
                {"parameters"},
                {"where"},
                {"particles"}})},
         formula_diagnosis},
        {{"histogram", "histogram: fraction of the particles of an ensemble whose formula has a value in each bin",
          told({each,
                {"label", "name of the columns", "", "\"speeds\""},
                {"formula", "quantity of one particle", "", "\"speed\""},
                {"from", "lower end of the first bin", "", "0", option::number(option::of_what_is_shown)},
                {"to", "upper end of the last bin", "", "10", option::number(option::of_what_is_shown)},
                {"count", "bins", "`20`"},
                {"parameters"},
                {"where"},
                {"particles"}})},
         histogram_diagnosis},
        {{"field-energy", "energy of a mesh's field, half the integral of density times potential", {}, true},
         instruments::make_field_energy},
        {{"field-mode", "complex amplitude c of a mode Re(c exp(i k x)) of a mesh",
          told({{"mode", "", "", "[3]"}, on_mesh}), true},
         instruments::make_field_mode},
        {{"wave-spectrum", "records a quantity of a mesh for the drawing wave-spectrum; no columns",
          told({on_mesh, {"axis", "axis of the waves", "`\"x\"`"}, {"modes"}}), true},
         instruments::make_wave_spectrum},
        {{"box", "volume and lengths of the box, and mass density", {}},
         [](DiagnosisParameters const& parameters) -> std::unique_ptr<Diagnosis> {
           return std::make_unique<BoxMeasures>(dimension_of(parameters));
         }},
        {{"energy-balance",
          "energy, work of moving walls, heat of baths, and energy less these, which is conserved",
          {}},
         [](DiagnosisParameters const&) -> std::unique_ptr<Diagnosis> { return std::make_unique<EnergyBalance>(); }},
    };
  }();
  return entries;
}

void refuse_unused(DiagnosisKind const& kind, DiagnosisParameters parameters) {
  DiagnosisParameters plain;
  for (auto const& option : diagnosis_options())
    if (!kind.options.find(option.key) && toml_value(option, &parameters) != toml_value(option, &plain))
      throw Error(fmt::format("diagnosis {} has no option {}; it has {}", kind.name, option.key,
                              kind.options.empty() ? "none" : join(kind.options.keys())));
}

}  // namespace

std::vector<DiagnosisKind> const& diagnosis_kinds() {
  static std::vector<DiagnosisKind> const kinds = [] {
    std::vector<DiagnosisKind> all;
    for (auto const& entry : table()) all.push_back(entry.kind);
    return all;
  }();
  return kinds;
}

void find_vortices(DiagnosisParameters& parameters, std::vector<Scheme*> const& schemes) {
  parameters.vortices = vortex_sources(schemes);
  if (!schemes.empty()) VortexFlow::refuse_images(schemes.front()->box());
}

std::unique_ptr<Diagnosis> make_diagnosis(std::string_view kind, DiagnosisParameters const& parameters) {
  std::vector<std::string> names;
  for (auto const& entry : table()) {
    if (entry.kind.name == kind) {
      refuse_unused(entry.kind, parameters);
      return entry.make(parameters);
    }
    names.push_back(entry.kind.name);
  }
  throw Error(
      fmt::format("there is no diagnosis '{}'{}", kind, choices(kind, names, "there are", "bzm list diagnoses")));
}

}  // namespace boltzmann
