// Reading: data that the readers of a scenario's tables exchange. Private to this module.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/options.hpp>
#include <boltzmann/diagnoses/neighbour_fields.hpp>
#include <boltzmann/dissipation/dissipation.hpp>
#include <boltzmann/laws/formula_law.hpp>
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/laws/state_law.hpp>
#include <boltzmann/scenario/classes.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/scenario/materials.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/scenario/section.hpp>
#include <boltzmann/scenario/tables.hpp>
#include <boltzmann/schemes/molecules/molecule_scheme.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/schemes/panels/panel_scheme.hpp>
#include <boltzmann/schemes/smooth/rezone.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>
#include <boltzmann/simulation/dye.hpp>
#include <boltzmann/simulation/vortex_relaxation.hpp>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boltzmann {

struct Reading;
struct SchemeEntry;

/// A field computed from a particle's neighbours, with the names of their ensembles; empty: all particles.
struct ReadNeighbourField {
  NeighbourField field;
  std::vector<std::string> among;
  Place place, among_place;
};

/// A class that the file derives from another one.
struct ReadClass {
  ParticleClass kind;  ///< in the space of the file; without variants after mistakes
  FieldRates rates;
  Place place;
  std::vector<ReadNeighbourField> neighbour_fields = {};
};

/// The bonded particles of an ensemble, and the number of particles of a molecule (0: all are one molecule).
struct ReadMolecules {
  std::size_t length = 0;
  std::vector<BondMembers> bonds = {};
};

/// The initial velocities of an ensemble that depend on the simulation as a whole (settle_velocities()).
struct ReadVelocities {
  double temperature = 0;
  bool remove_drift = false, exact = false;
  std::array<double, 3> drift{};
  std::vector<std::uint32_t> given = {};  ///< particles with given velocities
  Place place;
};

/// An ensemble of the file; `particles` is null if it could not be loaded.
struct ReadEnsemble {
  std::string name;
  Place place, load_place, range_place;
  Item const* table = nullptr;  ///< null: it has no table in the file
  ParticleClass const* kind = nullptr;
  AnyEnsemble* particles = nullptr;
  std::unique_ptr<Integrator> integrator;
  std::optional<BoundMaterial> material;  ///< for smooth particles
  std::optional<StateLaw> state;          ///< for internal energies
  ReadMolecules molecules = {};
  std::string element = {};  ///< "Cu"; empty: unknown
  std::optional<ReadVelocities> velocities = {};

  bool smooth() const { return kind && kind->matter != Matter::none; }
};

struct ReadRun : RunOptions {
  std::optional<double> step;
  std::optional<double> courant;  ///< instead of the step: fraction of the Courant step
  bool cutoff_known = true;       ///< false: there is one, but it could not be read
  std::optional<Item> stop;       ///< the condition that ends the run, set once the diagnoses are known
  Place place, cutoff_place, skin_place, step_place, time_place, tolerance_place, substeps_place;
};

struct ReadMesh {
  std::vector<double> bonded_factors = {};
  Place bonded_place = {};
  bool usable = true;                    ///< false: there is an invalid [mesh]; skip checks that need a mesh
  Place background_place;                ///< or that of the table
  std::vector<MeshField const*> fields;  ///< computed on demand
};

struct ReadRezone {
  Place place;
  std::int64_t every = 1;
  Rezoning policy;
  Item const* on = nullptr;             ///< null: all ensembles
  std::vector<AnyEnsemble*> ensembles;  ///< set when they exist
};

struct ReadSmooth {
  bool wanted = false;  ///< true if there is a [smooth], even an invalid one
  bool from_continuity = false;
  Place heating_place, skin_place;
  std::optional<VariableRange> variable;
  Place variable_place;
  std::vector<ReadRezone> rezones;
};

struct ReadBarostat {
  BarostatOptions options;
  Place place;
  std::function<double(double)> pressure = {}, temperature = {};  ///< function of time; null: constant, as in the
                                                                  ///< options
};

/// A value that an event may set, by the path of its key, "dissipation.0.temperature".
struct Settable {
  std::string path;
  /// Returns the action that sets this value; null, and a mistake, if it is invalid.
  std::function<std::function<void(Simulation&)>(Item const& value, Reading& reading)> read;
};

struct ReadEvent {
  double at = 0;
  enum class Kind { lasting, passing, adding } kind = Kind::passing;
  std::function<void(Simulation&)> happen;
};

struct ReadRelaxation {
  std::optional<RelaxationOptions> options;
  Place place;
};

struct ReadDye {
  AnyEnsemble* ensemble;
  DyeOptions options;
};

/// The records of a run that pictures can show.
struct Recorded {
  bool trajectory = false, diagnoses = true;
};

/// The thermalisation of particles before the run.
struct ReadEquilibration {
  std::shared_ptr<Dissipation> bath;  ///< null: none
  std::uint64_t steps = 0;
};

/// A file of particles, and the species that ensembles have used.
struct ReadFile {
  struct Species {
    std::size_t particles = 0, ensembles = 0;
  };
  std::string name = {};  ///< without its folder
  std::map<std::string, Species> species = {};
};

/// Everything that has been read so far. Members that could not be read are empty, and have left a mistake.
struct Reading {
  ReadContext context;
  std::unique_ptr<ScenarioSimulation> result = std::make_unique<ScenarioSimulation>();
  bool base_known = true;
  int dimension = 0;  ///< of the box; 0: unknown
  std::optional<Box> box;
  ReadRun run;
  std::vector<std::pair<SchemeEntry const*, Item const*>> schemes;  ///< those in the file, with their tables
  ReadMesh mesh;
  ReadSmooth smooth;
  std::vector<ReadEnsemble> ensembles;
  std::vector<ReadDye> dyes = {};
  ReadEquilibration equilibration = {};
  ReadRelaxation relaxation = {};
  std::optional<MinimiseOptions> minimisation = {};
  std::vector<std::pair<Scheme*, std::int64_t>> slow = {};  ///< and the number of steps between their calculations
  std::vector<Place> diagnosis_places = {};                 ///< of each one in the result
  std::vector<Place> track_places = {};                     ///< of pictures that show tracks
  bool diagnoses_known = true;  ///< false: one could not be read, so that columns may be missing
  Recorded recorded = {};
  std::vector<std::function<void(Simulation&)>> adaptations = {};   ///< functions that add changes of particles between
                                                                    ///< steps
  std::vector<std::shared_ptr<RigidBonds>> rigid = {};              ///< one per ensemble that has some
  std::vector<std::function<void(Simulation&)>> behind_baths = {};  ///< functions that run after the dissipations
  std::unique_ptr<PanelScheme> bodies = {};  ///< until it is added after the other schemes; null: there are none
  std::vector<std::pair<std::size_t, std::pair<std::string, Place>>> sticky_bodies =
      {};  ///< by number, and the vortices that they shed
  Place bodies_place = {};
  Place shear_place = {};                     ///< in [box]
  bool shear_is_right = true;                 ///< otherwise checks that need it are skipped
  std::set<std::string> acts_on_bodies = {};  ///< influences already added to bodies: an external law, an ensemble of
                                              ///< vortices
  std::vector<std::unique_ptr<ReadClass>> classes = {};
  std::vector<ReadBarostat> barostats = {};
  std::optional<Place> jump = {};  ///< a law whose energy jumps at its cut-off, without a tail
  std::vector<Settable> settable = {};
  std::vector<ReadEvent> events = {};
  std::map<std::string, ReadFile> files = {};  ///< of particles, by path and frame

  void mistake(Place const& place, std::string message) { context.mistakes.add(place, std::move(message)); }
  /// Adds a line that `bzm check` and a run print, once: "note: ..." or "warning: ...".
  void note(std::string line);
  std::vector<std::string> ensemble_names() const;
  /// The ensemble that a word names; nullptr and a mistake if it is unknown.
  ReadEnsemble* ensemble(Item const& word, std::string_view key);
  double boltzmann_constant() const;
  /// A class of the file or a shipped one; nullptr if it is unknown or invalid.
  ParticleClass const* find_class(std::string_view name) const;
  std::vector<std::string> class_names() const;
  /// Adds a mistake if a formula that acts on particles reads a field that is computed only for observers.
  void refuse_neighbour_fields(std::string_view formula, std::string_view key, Place const& place);
};

/// Calls function(). An Error becomes a mistake at the place, and the result is false.
template <class Function>
bool catch_errors(Reading& reading, Place const& place, Function const& function) {
  try {
    function();
    return true;
  } catch (Error const& error) {
    reading.mistake(place, error.what());
    return false;
  }
}

/// A number with a dimension that an event may set.
Settable settable_number(std::string path, Dimension dimension, NumberRange range,
                         std::function<void(Simulation&, double)> set);

/// The place of the load table of the ensemble that an error names.
Place place_of(std::string const& message, Reading const& reading);

/// 0, 1, ...: all particles.
std::vector<std::uint32_t> all_indices(AnyEnsemble const& particles);
/// Selected particles: an array of numbers, "all", "edge" (with `margin`). Empty and a mistake if it is none of these.
/// `ensemble` may be null: then only the form is checked. If `parts`, `where` has another meaning and is ignored.
std::optional<std::vector<std::uint32_t>> read_particles(Section& section, AnyEnsemble const* ensemble,
                                                         Reading& reading, bool parts = false);

/// Particles by numbers, or by a formula that is true for them.
std::optional<std::vector<std::uint32_t>> read_chosen(Item const& item, char const* key, AnyEnsemble const* ensemble,
                                                      Reading& reading);

/// The parameters of a law or a material in a table; `owner` is its name in messages. Nothing, and mistakes, if one is
/// missing or invalid.
std::optional<ParameterValues> read_parameters(Section& section, std::string_view owner,
                                               std::vector<Parameter> const& parameters, Reading& reading);

void read_units(Section& document, Reading& reading);
void read_box(Section& document, Reading& reading);
void read_run(Section& document, Reading& reading);
/// Completes [run] when everything is loaded: a Courant step, the number of steps of a time. The results replace the
/// original values in `resolved`.
void settle_run(Item& resolved, Reading& reading);
/// Adds a mistake: the periodic axis is shorter than the cut-off.
void refuse_cutoff(Place const& place, double cutoff, int axis, Reading& reading);
/// Creates the schemes that have tables in the file.
void read_schemes(Section& document, Reading& reading);
void read_mesh(Item const& table, Reading& reading);
void read_multipole(Item const& table, Reading& reading);
void read_cylinder(Item const& table, Reading& reading);
void read_smooth(Item const& table, Reading& reading);
/// The law of the field of a mesh or of multipoles, with k or G, and its softening if the table has it.
std::optional<LaplaceLaw> read_field_law(Section& section, OptionTable const& keys, Reading& reading,
                                         std::vector<std::string> const& other_laws = {});
/// The remaining keys.
OptionTable keys_but_of_the_law(OptionTable const& all);
void read_ensembles(Section& document, Reading& reading);
/// Applies remove_drift and exact_temperature to the particles that move, with their degrees of freedom in the
/// simulation. Frozen particles and rigid bonds were not yet known when the velocities were drawn.
void settle_velocities(Reading& reading);
/// Places particles again, at a distance from existing ones.
using PlaceAgain = std::function<void(AnyEnsemble& particles, Box const& now, std::vector<AnyEnsemble const*> others,
                                      double distance)>;
/// Particles to be added to an existing ensemble, as defined by `table` (the key `add` of an event), with defaults from
/// the ensemble's own table. Random numbers are those of an ensemble of this `name`. Null, and mistakes, if it is
/// invalid. `again` is set to the function that places them at a distance from others.
std::shared_ptr<AnyEnsemble const> read_addition(Item const& table, ReadEnsemble const& to, std::string const& name,
                                                 Reading& reading, PlaceAgain& again);
/// The material of an ensemble of this class. Nothing, and mistakes, if it is missing or invalid.
std::optional<BoundMaterial> read_material(Section& ensemble, ParticleClass const& kind, Reading& reading);
/// True if particles of this class have an internal energy (the field "internal_energy").
bool has_internal_energy(ParticleClass const& kind);
/// heat_capacity: the relation of internal energy and temperature. Nothing if it is missing or invalid.
std::optional<StateLaw> read_state_law(Section& ensemble, ParticleClass const& kind, Reading& reading);
/// internal_energy = { temperature = "300 K" }. Nothing if the energies are given in another way, or it is invalid.
std::optional<double> read_internal_temperature(Section& ensemble, ParticleClass const& kind, Reading& reading);
/// Sets the field "temperature" to that of the internal energies.
void find_temperatures(AnyEnsemble& particles, StateLaw const& law);
/// Adds ensembles to the schemes; those that fit none of these are added to pairs.
void load_schemes(Reading& reading);
void add_to_mesh(Item const& table, Reading& reading);
void add_to_multipole(Item const& table, Reading& reading);
void add_to_cylinder(Item const& table, Reading& reading);
void add_to_smooth(Item const& table, Reading& reading);
void read_embedded_atoms(Item const& table, Reading& reading);
void add_to_embedded_atoms(Item const& table, Reading& reading);
void read_stillinger_weber(Item const& table, Reading& reading);
void add_to_stillinger_weber(Item const& table, Reading& reading);
struct NamedEnsemble {
  ReadEnsemble* ensemble;
  Place place;  ///< of its name
};
/// The ensembles that the value of a key names, one or a list (null: unknown); adds a mistake for an unknown or
/// repeated name.
std::vector<NamedEnsemble> named_ensembles(Item const* item, std::string_view key, Reading& reading);
/// The two ensembles of `between`; null if one could not be read, both null if there are not two.
std::pair<ReadEnsemble*, ReadEnsemble*> two_ensembles(Item const& between, Reading& reading);
/// Rejects an ensemble that acts on itself and is named twice.
void refuse_twice(Item const& second, std::string_view key, Reading& reading);
/// Adds to a scheme of a field with this constant the ensembles named by `on`, or all that fit; and with `test` those
/// named by `test_particles`, if there is such a key. Returns false after a mistake.
using AddToField = std::function<void(AnyEnsemble&, SourceKind const&)>;
bool add_sources(Item const& table, char const* heading, std::optional<LaplaceLaw> const& law, AddToField const& add,
                 Reading& reading, AddToField const& test = {});
/// Reads the key `rezone` of [smooth]; finds its ensembles when they exist; adds rezoning to the simulation.
void read_rezone(Section& smooth, Reading& reading);
void load_rezone(Reading& reading);
void add_rezoners(Reading const& reading);
/// Reads [[remesh]], [[split_cores]] and [[outflow]] into reading.adaptations.
void read_adaptations(Section& document, Reading& reading);
/// Fills reading.mesh.fields for users of the mesh, from `place` on. False if there is no mesh or it can't be
/// calculated, with a single mistake for all users.
bool find_mesh_fields(Reading& reading, Place const& place, std::string_view what);
/// Reads [[dye]]: places where tracers are released during the run; adds them to the simulation.
void read_dyes(Section& document, Reading& reading);
void add_dyes(Reading const& reading);
/// The class of their panels, which scenarios can't name.
ParticleClass const& body_class();
/// Reads [[bodies]] and creates their ensembles. Their sheet advects all particles that a flow advects. The scheme
/// comes after all others, and the simulation keeps particles outside of bodies.
void read_bodies(Section& document, Reading& reading);
void load_bodies(Reading& reading);
void add_bodies(Reading& reading);
void keep_out_of_bodies(Reading const& reading);
/// Reads `bonds` of [[ensembles]], for molecules of this size; without particles only the form is checked.
void read_bonds(Section& section, AnyEnsemble const* particles, ReadMolecules& molecules, Reading& reading);
/// True for connect = "bonds"; adds a mistake if there are none.
bool connects_bonds(Item const& item, ReadEnsemble const* of, Reading& reading);
/// Tuples of an influence on this ensemble (which may be null): "bonds", a list, or a file.
std::vector<AngleMembers> read_angles(Item const& item, ReadEnsemble const* of, Reading& reading);
std::vector<DihedralMembers> read_dihedrals(Item const& item, ReadEnsemble const* of, Reading& reading);
/// Reads [[rigid_bonds]]; sets integrators of their ensembles that enforce the constraints, and corrects velocities
/// after heat baths.
void read_rigid_bonds(Section& document, Reading& reading);
/// The scheme of the scenario, created on demand.
MoleculeScheme& molecule_scheme(Reading& reading);
void read_influences(Section& document, Reading& reading);
/// parameters = { depth = "0.1 eV" } and where = { s = "(sigma/r)^6" } for the formulas of a table.
std::vector<FormulaParameter> read_formula_parameters(Section& section, Reading& reading);
std::vector<FormulaPart> read_formula_parts(Section& section, Reading& reading);
/// True for valid names in formulas: letters, digits and _.
bool is_formula_name(std::string_view name);
/// Adds a mistake at the parameter or part of the table that the error names; false if it names none.
bool part_mistake(Section const& section, FormulaPartError const& error, Reading& reading);
/// The same, or else at `item`, called `key`.
void refuse_formula(Section const& section, FormulaPartError const& error, Item const& item, std::string_view key,
                    Reading& reading);
/// Reads [[classes]]: those that the scenario derives. Sets the rates of the fields of their particles.
void read_classes(Section& document, Reading& reading);
void load_rates(Reading& reading);
/// Fields of classes computed from neighbours: their ensembles, and those of the neighbours.
void load_neighbour_fields(Reading& reading);
/// Reads [[dissipation]], friction and noise, and [equilibrate]; adds them to the simulation.
void read_dissipations(Section& document, Reading& reading);
void add_dissipations(Reading const& reading);
/// Reads [[barostat]]; adds it to the simulation.
void read_barostats(Section& document, Reading& reading);
void add_barostats(Reading& reading);
/// Reads [[events]], after everything that they may set; adds them to the simulation.
void read_events(Section& document, Reading& reading);
void add_events(Reading& reading);
/// Reads [relaxation]; adds it to the simulation.
void read_relaxation(Section& document, Reading& reading);
void add_relaxation(Reading& reading);
/// Reads [minimise]; the simulation executes it first.
void read_minimise(Section& document, Reading& reading);
void add_minimisation(Reading const& reading);
void read_diagnoses(Section& document, Reading& reading);
/// Writes default intervals into `resolved`.
void read_output(Section& document, Item& resolved, Reading& reading);
/// Reads the condition of [run] stop, after diagnoses and their interval.
void read_stop(Reading& reading);
/// The columns of diagnoses.csv; the axes of the box (all three if it is unknown).
std::vector<std::string> column_names(Reading const& reading);
bool all_loaded(Reading const& reading);
/// Adds a mistake if particles with this range have more than one image between walls.
void check_range_of_weight(Section& section, double range, Box const& box);
void read_picture(Item const& table, Reading& reading);
/// Reads [[views]], the diagnoses for the window.
void read_views(Section& document, Reading& reading);

}  // namespace boltzmann
