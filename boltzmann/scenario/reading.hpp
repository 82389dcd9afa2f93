// Reading: what the readers of a scenario's tables hand to each other. Private to this room.
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

/// A field that is found by a particle's neighbours, and who they are by the names of ensembles; none: all particles.
struct ReadNeighbourField {
  NeighbourField field;
  std::vector<std::string> among;
  Place place, among_place;
};

/// A class that the file derives from another one.
struct ReadClass {
  ParticleClass kind;  ///< in the space of the file; without variants: there are mistakes in it
  FieldRates rates;
  Place place;
  std::vector<ReadNeighbourField> neighbour_fields = {};
};

/// Which particles of an ensemble are bonded, and how many of them make a molecule (0: they are all one).
struct ReadMolecules {
  std::size_t length = 0;
  std::vector<BondMembers> bonds = {};
};

/// What [[ensembles]] says of thermal velocities that hold for the simulation as a whole (settle_velocities()).
struct ReadVelocities {
  double temperature = 0;
  bool remove_drift = false, exact = false;
  std::array<double, 3> drift{};
  std::vector<std::uint32_t> given = {};  ///< particles whose velocities are said
  Place place;
};

/// An ensemble of the file; `particles` is null if it could not be loaded.
struct ReadEnsemble {
  std::string name;
  Place place, load_place, range_place;
  Item const* table = nullptr;  ///< null: no table of the file is its own
  ParticleClass const* kind = nullptr;
  AnyEnsemble* particles = nullptr;
  std::unique_ptr<Integrator> integrator;
  std::optional<BoundMaterial> material;  ///< of smooth particles
  std::optional<StateLaw> state;          ///< of internal energies
  ReadMolecules molecules = {};
  std::optional<ReadVelocities> velocities = {};

  bool smooth() const { return kind && kind->matter != Matter::none; }
};

struct ReadRun : RunOptions {
  std::optional<double> step;
  std::optional<double> courant;  ///< instead of the step: which part of the Courant step
  bool cutoff_known = true;       ///< false: there is one, but it could not be read
  std::optional<Item> stop;       ///< the condition that ends the run, once the diagnoses are known
  Place place, cutoff_place, skin_place, step_place, time_place, tolerance_place, substeps_place;
};

struct ReadMesh {
  std::vector<double> bonded_factors = {};
  Place bonded_place = {};
  bool usable = true;      ///< false: there is a [mesh], but mistakes in it; what needs a mesh is not to be checked
  Place background_place;  ///< or that of the table
  std::vector<MeshField const*> fields;  ///< once somebody has asked for them
};

struct ReadRezone {
  Place place;
  std::int64_t every = 1;
  Rezoning policy;
  Item const* on = nullptr;             ///< null: all ensembles
  std::vector<AnyEnsemble*> ensembles;  ///< once they are there
};

struct ReadSmooth {
  bool wanted = false;  ///< there is a [smooth], with mistakes or without
  bool from_continuity = false;
  Place heating_place, skin_place;
  std::optional<VariableRange> variable;
  Place variable_place;
  std::vector<ReadRezone> rezones;
};

struct ReadBarostat {
  BarostatOptions options;
  Place place;
  std::function<double(double)> pressure = {}, temperature = {};  ///< of the time; null: those of the options
};

/// What an event may set: by the path of its key, "dissipation.0.temperature".
struct Settable {
  std::string path;
  /// What setting it to this value does; null, and a mistake, if it can't be.
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

/// What a run records for pictures to show.
struct Recorded {
  bool trajectory = false, diagnoses = true;
};

/// What brings the particles to a temperature before the run.
struct ReadEquilibration {
  std::shared_ptr<Dissipation> bath;  ///< null: nothing does
  std::uint64_t steps = 0;
};

/// Everything that has been read so far. What could not be read is empty, and has left a mistake.
struct Reading {
  ReadContext context;
  std::unique_ptr<ScenarioSimulation> result = std::make_unique<ScenarioSimulation>();
  bool base_known = true;
  int dimension = 0;  ///< of the box; 0: unknown
  std::optional<Box> box;
  ReadRun run;
  std::vector<std::pair<SchemeEntry const*, Item const*>> schemes;  ///< those that the file has, with their tables
  ReadMesh mesh;
  ReadSmooth smooth;
  std::vector<ReadEnsemble> ensembles;
  std::vector<ReadDye> dyes = {};
  ReadEquilibration equilibration = {};
  ReadRelaxation relaxation = {};
  std::optional<MinimiseOptions> minimisation = {};
  std::vector<std::pair<Scheme*, std::int64_t>> slow = {};  ///< and every how many steps they are calculated
  std::vector<Place> diagnosis_places = {};                 ///< of each in the result
  bool diagnoses_known = true;  ///< false: one could not be read, so that columns may be missing
  Recorded recorded = {};
  std::vector<std::function<void(Simulation&)>> adaptations = {};   ///< what changes particles between steps
  std::vector<std::shared_ptr<RigidBonds>> rigid = {};              ///< one for each ensemble that has some
  std::vector<std::function<void(Simulation&)>> behind_baths = {};  ///< what follows dissipations
  std::unique_ptr<PanelScheme> bodies = {};  ///< until it stands behind the other schemes; null: there are none
  std::vector<std::pair<std::size_t, std::pair<std::string, Place>>> sticky_bodies =
      {};  ///< by number, and what they shed
  Place bodies_place = {};
  Place shear_place = {};                     ///< in [box]
  bool shear_is_right = true;                 ///< else what needs it is not asked
  std::set<std::string> acts_on_bodies = {};  ///< what has been told to: a law from outside, an ensemble of vortices
  std::vector<std::unique_ptr<ReadClass>> classes = {};
  std::vector<ReadBarostat> barostats = {};
  std::optional<Place> jump = {};  ///< a law whose energy jumps at its cut-off, without a tail
  std::vector<Settable> settable = {};
  std::vector<ReadEvent> events = {};

  void mistake(Place const& place, std::string message) { context.mistakes.add(place, std::move(message)); }
  std::vector<std::string> ensemble_names() const;
  /// The ensemble that a word names; nullptr and a mistake if there is none.
  ReadEnsemble* ensemble(Item const& word, std::string_view key);
  double boltzmann_constant() const;
  /// A class of the file or a shipped one; nullptr if there is none of that name, or mistakes in it.
  ParticleClass const* find_class(std::string_view name) const;
  std::vector<std::string> class_names() const;
  /// A mistake if a formula that acts on particles reads a field that is found only when somebody looks.
  void refuse_neighbour_fields(std::string_view formula, std::string_view key, Place const& place);
};

/// Calls function(); an Error becomes a mistake at the place. False if there was one.
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

/// A number of a dimension that an event may set.
Settable settable_number(std::string path, Dimension dimension, NumberRange range,
                         std::function<void(Simulation&, double)> set);

/// Where the ensemble is loaded that an error of a lower room names.
Place place_of(std::string const& message, Reading const& reading);

/// 0, 1, ...: all particles.
std::vector<std::uint32_t> all_indices(AnyEnsemble const& particles);
/// Which particles: an array of numbers, "all", "edge" (with `margin`). Empty and a mistake if it is none of these.
/// `ensemble` may be null: then only the form is checked.
/// `where` may have another meaning there (`parts`): then it is left alone.
std::optional<std::vector<std::uint32_t>> read_particles(Section& section, AnyEnsemble const* ensemble,
                                                         Reading& reading, bool parts = false);

/// Numbers, or a formula that is true for those that are meant.
std::optional<std::vector<std::uint32_t>> read_chosen(Item const& item, char const* key, AnyEnsemble const* ensemble,
                                                      Reading& reading);

/// The parameters of a law or a material, `owner` in messages, that stand in a table. Nothing, and mistakes, if one is
/// missing or wrong.
std::optional<ParameterValues> read_parameters(Section& section, std::string_view owner,
                                               std::vector<Parameter> const& parameters, Reading& reading);

void read_units(Section& document, Reading& reading);
void read_box(Section& document, Reading& reading);
void read_run(Section& document, Reading& reading);
/// What follows from [run] when everything is loaded: a Courant step, the number of steps of a time. They stand in
/// `resolved` instead of what was asked for.
void settle_run(Item& resolved, Reading& reading);
/// A mistake: the periodic axis is shorter than the cut-off.
void refuse_cutoff(Place const& place, double cutoff, int axis, Reading& reading);
/// Makes the schemes that the file has tables of.
void read_schemes(Section& document, Reading& reading);
void read_mesh(Item const& table, Reading& reading);
void read_multipole(Item const& table, Reading& reading);
void read_cylinder(Item const& table, Reading& reading);
void read_smooth(Item const& table, Reading& reading);
/// The law that makes the field of a mesh or of multipoles, with k or G, and its softening if the table has it.
std::optional<LaplaceLaw> read_field_law(Section& section, OptionTable const& keys, Reading& reading,
                                         std::vector<std::string> const& other_laws = {});
/// The keys that this leaves.
OptionTable keys_but_of_the_law(OptionTable const& all);
void read_ensembles(Section& document, Reading& reading);
/// Makes remove_drift and exact_temperature hold for the particles that move, with the degrees of freedom that they have
/// in the simulation: frozen particles and rigid bonds have taken their part since the velocities were drawn.
void settle_velocities(Reading& reading);
/// Particles for an ensemble that there is, made as `table` says (the key `add` of an event), and where it says nothing as
/// the ensemble's own does. Random numbers are those of an ensemble of this `name`. Null, and mistakes, if it is wrong.
std::shared_ptr<AnyEnsemble const> read_addition(Item const& table, ReadEnsemble const& to, std::string const& name,
                                                 Reading& reading);
/// What an ensemble of this class is made of. Nothing, and mistakes, if it is missing or wrong.
std::optional<BoundMaterial> read_material(Section& ensemble, ParticleClass const& kind, Reading& reading);
/// Whether particles of this class have an internal energy of their own (the field "internal_energy").
bool has_internal_energy(ParticleClass const& kind);
/// heat_capacity: which temperature an internal energy stands for. Nothing if it is missing, or wrong.
std::optional<StateLaw> read_state_law(Section& ensemble, ParticleClass const& kind, Reading& reading);
/// internal_energy = { temperature = "300 K" }. Nothing if the energies are given in another way, or it is wrong.
std::optional<double> read_internal_temperature(Section& ensemble, ParticleClass const& kind, Reading& reading);
/// Sets the field "temperature" to that of the internal energies.
void find_temperatures(AnyEnsemble& particles, StateLaw const& law);
/// Loads ensembles into the schemes; what none of these takes is for pairs.
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
/// The ensembles that the value of a key names, one or a list (null: none); a mistake where one is none, or named twice.
std::vector<NamedEnsemble> named_ensembles(Item const* item, std::string_view key, Reading& reading);
/// The two that `between` names; null where one could not be read, both if they are not two.
std::pair<ReadEnsemble*, ReadEnsemble*> two_ensembles(Item const& between, Reading& reading);
/// An ensemble that acts on itself, named twice.
void refuse_twice(Item const& second, std::string_view key, Reading& reading);
/// Gives a scheme of a field with this constant the ensembles that are named by `on`, or all that fit; and those that
/// `test_particles` names to `test`, if there is such a key. False: something is wrong with those that are there.
using AddToField = std::function<void(AnyEnsemble&, SourceKind const&)>;
bool add_sources(Item const& table, char const* heading, std::optional<LaplaceLaw> const& law, AddToField const& add,
                 Reading& reading, AddToField const& test = {});
/// Reads the key `rezone` of [smooth]; finds its ensembles once they are there; lets the simulation rezone them.
void read_rezone(Section& smooth, Reading& reading);
void load_rezone(Reading& reading);
void add_rezoners(Reading const& reading);
/// Reads [[remesh]], [[split_cores]] and [[outflow]] into reading.adaptations.
void read_adaptations(Section& document, Reading& reading);
/// Fills reading.mesh.fields for what looks at the mesh, from `place` on. False if there is no mesh or it can't be
/// calculated, with one mistake for all that ask.
bool find_mesh_fields(Reading& reading, Place const& place, std::string_view what);
/// Reads [[dye]]: where tracers are released while the run goes on; lets the simulation do it.
void read_dyes(Section& document, Reading& reading);
void add_dyes(Reading const& reading);
/// The class of their panels, which no scenario names.
ParticleClass const& body_class();
/// Reads [[bodies]] and makes their ensembles; lets their sheet carry all that a flow carries; puts the scheme behind
/// all others and lets the simulation keep particles out of bodies.
void read_bodies(Section& document, Reading& reading);
void load_bodies(Reading& reading);
void add_bodies(Reading& reading);
void keep_out_of_bodies(Reading const& reading);
/// Reads `bonds` of [[ensembles]], of molecules of a length; without particles only the form is checked.
void read_bonds(Section& section, AnyEnsemble const* particles, ReadMolecules& molecules, Reading& reading);
/// Whether connect = "bonds": a mistake if there are none.
bool connects_bonds(Item const& item, ReadEnsemble const* of, Reading& reading);
/// Of an influence on this ensemble (it may be null): "bonds", a list, or a file.
std::vector<AngleMembers> read_angles(Item const& item, ReadEnsemble const* of, Reading& reading);
std::vector<DihedralMembers> read_dihedrals(Item const& item, ReadEnsemble const* of, Reading& reading);
/// Reads [[rigid_bonds]]; gives their ensembles integrators that keep them, and lets velocities follow behind baths.
void read_rigid_bonds(Section& document, Reading& reading);
/// That of the scenario, made when it is first asked for.
MoleculeScheme& molecule_scheme(Reading& reading);
void read_influences(Section& document, Reading& reading);
/// parameters = { depth = "0.1 eV" } and where = { s = "(sigma/r)^6" }, which formulas of a table may use.
std::vector<FormulaParameter> read_formula_parameters(Section& section, Reading& reading);
std::vector<FormulaPart> read_formula_parts(Section& section, Reading& reading);
/// Whether formulas can have a name: letters, digits and _.
bool is_formula_name(std::string_view name);
/// A mistake at the parameter or part of the table that the error is of; false if it is of none.
bool part_mistake(Section const& section, FormulaPartError const& error, Reading& reading);
/// The same, or else at `item`, called `key`.
void refuse_formula(Section const& section, FormulaPartError const& error, Item const& item, std::string_view key,
                    Reading& reading);
/// Reads [[classes]]: those that the scenario derives. Gives the fields of their particles their rates.
void read_classes(Section& document, Reading& reading);
void load_rates(Reading& reading);
/// Fields of classes that are found by neighbours: whose they are, and who is one.
void load_neighbour_fields(Reading& reading);
/// Reads [[dissipation]], friction and noise, and [equilibrate]; lets the simulation have them.
void read_dissipations(Section& document, Reading& reading);
void add_dissipations(Reading const& reading);
/// Reads [[barostat]]; lets the simulation have it.
void read_barostats(Section& document, Reading& reading);
void add_barostats(Reading& reading);
/// Reads [[events]], when all that they may set has been read; lets the simulation have them.
void read_events(Section& document, Reading& reading);
void add_events(Reading& reading);
/// Reads [relaxation]; lets the simulation have it.
void read_relaxation(Section& document, Reading& reading);
void add_relaxation(Reading& reading);
/// Reads [minimise]; lets the simulation do it first.
void read_minimise(Section& document, Reading& reading);
void add_minimisation(Reading const& reading);
void read_diagnoses(Section& document, Reading& reading);
/// `resolved` gets the intervals that the file leaves to us.
void read_output(Section& document, Item& resolved, Reading& reading);
/// Reads the condition of [run] stop, when diagnoses and their interval are known.
void read_stop(Reading& reading);
/// The columns that diagnoses.csv will have; the axes that the box has (all three if it is not known).
std::vector<std::string> column_names(Reading const& reading);
bool all_loaded(Reading const& reading);
/// A mistake if particles that are spread so far have more images between walls than one.
void check_range_of_weight(Section& section, double range, Box const& box);
void read_picture(Item const& table, Reading& reading);
/// Reads [[views]], the diagnoses for the window.
void read_views(Section& document, Reading& reading);

}  // namespace boltzmann
