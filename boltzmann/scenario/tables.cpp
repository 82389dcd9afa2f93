// The tables of a scenario, except those defined in their own modules.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/once.hpp>
#include <boltzmann/diagnoses/bond_harmonics.hpp>
#include <boltzmann/dissipation/dissipation_options.hpp>
#include <boltzmann/integrators/integrator.hpp>
#include <boltzmann/pictures/colour.hpp>
#include <boltzmann/scenario/schemes.hpp>
#include <boltzmann/scenario/tables.hpp>
#include <boltzmann/schemes/panels/body_options.hpp>
#include <boltzmann/simulation/dye.hpp>
#include <boltzmann/simulation/minimise.hpp>
#include <boltzmann/simulation/outflow.hpp>
#include <boltzmann/simulation/remesh.hpp>
#include <boltzmann/simulation/split_cores.hpp>
#include <boltzmann/simulation/vortex_relaxation.hpp>

#include <limits>

namespace boltzmann {
namespace {

using namespace option;

OptionTable const& substep_options() {
  static OptionTable const all = [] {
    using S = SubstepOptions;
    OptionTable options;
    options.add("distance", &S::distance, number(dimensions::length, positive),
                "no particle moves further in a substep, by its velocity or by its acceleration");
    options.add("energy", &S::energy, number(dimensions::energy, positive),
                "no force does more work on a particle in a substep");
    options.add("courant", &S::courant, number(dimensions::none, positive), "this part of the Courant step");
    return options;
  }();
  return all;
}

OptionTable make_run_options() {
  using R = RunOptions;
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  OptionTable all;
  all.add_said("step", "a time; with `[smooth]` also `\"courant\"`, or `{ courant = 0.5 }`",
               "of each step; that part of the Courant step of the state at the start");
  all.add("steps", &R::steps, whole(0, unlimited), "how many", "or `time`");
  all.add("time", &R::time, number(dimensions::time, not_negative), "how long: as many steps as it takes",
          "or `steps`");
  all.add("seed", &R::seed, whole(0, unlimited), "of all random numbers: the same seed gives the same bits");
  all.add("threads", &R::threads, whole(0, 4096), "0: all cores; the result has the same bits for any number");
  all.add("cutoff", &R::cutoff, number(dimensions::length, positive),
          "distance beyond which pair laws are zero; periodic axes need one. Energies of pairs are shifted, so that "
          "they are zero there and a run conserves energy; forces stay as they are",
          "all pairs count");
  all.add("shifted", &R::shifted, flag(),
          "energies of pairs are counted from the cut-off; `false`: as the law has them, as papers do that cut it and "
          "add its [tail](#energies-as-papers-have-them)");
  all.add("skin", &R::skin, number(dimensions::length, not_negative),
          "by how much neighbour lists reach further than the cut-off, at most 4 cut-offs; it changes the speed, not "
          "the result",
          "chosen for you");
  all.add("tolerance", &R::tolerance, number(dimensions::none, {1e-14, 0.01}),
          "of `gauss-radau`: how large the last term of its series may be in each of its steps, in parts of the first",
          "1e-9, as exact as doubles are");
  all.add(
      "substeps", &R::substeps, substep_options(), "{ distance = 0.01 }",
      "of `leap-frog` and `symplectic-4`: each step is divided into so many equal parts, 2^n of them, that in a "
      "substep "
      "no particle moves further than `distance`, no force does more work on it than `energy`, and that it is the part "
      "`courant` of the Courant step; one of these three, or several",
      "steps are not divided");
  all.add_said("stop", text("a [condition](#stop)"), "ends the run before its last step", "none");
  all.at("step").needed = "0.01";
  return all;
}

OptionTable make_units_options() {
  using U = UnitsOptions;
  OptionTable all;
  all.add("base", &U::base, word({"si", "cgs", "reduced", "lennard-jones", "gravitational", "plasma", "custom"}),
          "what plain numbers mean, and the units of the results; reduced: pure numbers, no text may have a unit",
          "`\"si\"`");
  all.add("sigma", &U::sigma, number(dimensions::length),
          "lennard-jones: sigma, epsilon, mass and Boltzmann's constant are 1");
  all.add("epsilon", &U::epsilon, number(dimensions::energy), "lennard-jones");
  all.add("mass", &U::mass, number(dimensions::mass),
          "lennard-jones, plasma, custom; gravitational: length, mass and G are 1");
  all.add("length", &U::length, number(dimensions::length), "gravitational, custom");
  all.add("time", &U::time, number(dimensions::time), "custom");
  all.add("density", &U::density, number(dimensions::number_density),
          "plasma: the plasma frequency, the Debye length and the thermal velocity are 1");
  all.add("charge", &U::charge, number(dimensions::charge), "plasma, custom", "of custom the elementary charge");
  all.add("temperature", &U::temperature, number(dimensions::temperature), "plasma, custom", "of custom 1 K");
  return all;
}

OptionTable make_sweep_options() {
  OptionTable all;
  all.add_said("seeds", whole(1, 10'000),
               "how many runs there are of each value; they have the seed of `[run]`, the next one, ...", "`1`");
  all.add_said("vary", "a table: for each key the list of its values",
               "values are whatever the key is: numbers, quantities, words, lists, tables. Keys are written as for "
               "`--set`, and go together: all have as many values",
               "repeated with other seeds only");
  all.add_said("table", "columns of diagnoses, a list or with commas",
               "of `sweep.csv` and of the table that is printed. A run counts once: its last row, or its mean since "
               "`from`",
               "all");
  all.add_said("from", number(dimensions::time), "the table has means over the rows since then", "the last row");
  all.add_said("labels", "a list of texts, `[\"coupled\", \"uncoupled\"]`",
               "names of the values, for legends, tables and folders", "the values");
  all.add_said("pictures", "tables, `[[sweep.pictures]]`", "of all runs together", "none");
  return all;
}

OptionTable make_sweep_picture_options() {
  using P = SweepPictureOptions;
  OptionTable all;
  all.add("drawing", &P::drawing, word({"points", "time-series"}), "a point for each value, or curves over time");
  all.add_said("x", text("a key that varies, or a column of diagnoses"),
               "of points; of a key with lists the one component that differs", "the key, if only one varies");
  all.add_said("y", "columns of diagnoses, a list or with commas", "upwards");
  all.add("fit", &P::fit, word({"line"}),
          "of points: the straight line through all runs by least squares, with the errors that their scatter about it "
          "tells; it is drawn, printed and written to `fits.csv`",
          "none");
  all.add("logarithmic", &P::logarithmic, flag(), "y");
  all.add("file", &P::file, text(), "a name in the folder of the sweep; .png, .svg or .pdf",
          "`sweep.png`, `series.png`");
  all.at("y").needed = "\"temperature\"";
  return all;
}

OptionTable make_shear_options() {
  using S = BoxOptions::Sheared;
  OptionTable all;
  all.add("rate", &S::rate, number(pow(dimensions::time, -1)),
          "of the flow's velocity per length up the gradient; negative: the other way");
  all.add("flow", &S::flow, axis_word(), "along which the images move");
  all.add("gradient", &S::gradient, axis_word(), "across which they move past each other");
  all.add("established", &S::established, flag(),
          "every particle begins with the velocity of the flow where it is, besides its own; else the fluid begins at "
          "rest, and is dragged in");
  all.at("rate").needed = "0.1";
  return all;
}

OptionTable make_box_options() {
  OptionTable all;
  all.add_said("low", vector(dimensions::length),
               "the lower edges: one, two or three numbers make the space 1D, 2D or 3D");
  all.add_said("high", vector(dimensions::length), "the upper edges");
  std::string kinds;
  for (auto const& word : boundary_words())
    kinds += (kinds.empty() ? "`\"" : "; `\"") + std::string(word.name) + "\"`: " + std::string(word.doc);
  all.add_said("boundary", "a word, or a list with one for each axis", kinds, "`\"open\"`");
  all.add("shear", &BoxOptions::shear, shear_options(), "{ rate = 0.1 }",
          "of two periodic axes: [a flow without walls](#shear), whose images move past each other (Lees and Edwards)",
          "at rest");
  all.add_said("walls", "tables, `[[box.walls]]`", "of [mirror and reflecting axes](#boxwalls)", "none");
  all.add_said("regions", "tables, `[[box.regions]]`", "[blocks](#boxregions) inside the space with elastic faces",
               "none");
  all.at("low").needed = "[0, 0]";
  all.at("high").needed = "[10, 10]";
  return all;
}

OptionTable make_ensemble_options() {  // long: a table, a row for each key
  std::string methods;
  for (auto const& word : method_words())
    methods += (methods.empty() ? "`\"" : "; `\"") + std::string(word.name) + "\"`: " + std::string(word.doc);
  using E = EnsembleOptions;
  OptionTable all;
  all.add("name", &E::name, text(), "for the rest of the file, the columns and the legends");
  all.add_said("class", text("a class (`bzm list classes`)"), "what each particle is");
  all.add_of<E>(
      "integrator",
      [](E& of) -> OptionPlace {
        return NamedValue{[&of] { return of.integrator ? method_words().name(*of.integrator) : ""; },
                          [&of](std::string const& name) { of.integrator = method_words().named(name); }};
      },
      word(method_words().names()), methods,
      "`\"leap-frog\"` for classical particles, `\"rk4\"` for those that a flow carries");
  all.add_said("load", "a table, `{ kind = \"block\", ... }`",
               "where the particles are: a [loader](#load) (`bzm list loaders`)");
  all.add("number", &E::number, whole(0, std::numeric_limits<double>::infinity()),
          "how many, for loaders that don't know; 0: [events](ensembles.md#events) add them", "what the loader knows");
  all.add("molecule", &E::molecule, whole(1, 4e9),
          "particles that make a molecule, one behind the other: numbers of `bonds`, `angles` and `dihedrals` are "
          "those within one, and hold for all",
          "the ensemble is one");
  all.add_said("bonds", "`\"chain\"`, `[[0, 1], [0, 2]]` or `{ file = \"bonds.txt\" }`",
               "which particles of a [molecule](#molecules) are bonded: each to the next one, or the pairs of numbers "
               "in a list, or on the lines of a file",
               "none");
  all.add_said("formulas", "a table of [formulas](#formulas)", "fields that depend on the place", "none");
  all.add("element", &E::element, text(),
          "the symbol of a chemical element, `\"Cu\"`. Exports name the particles by it. It gives their mass if "
          "nothing else "
          "does, and their element in `[embedded_atoms]`",
          "none");
  all.add("temperature", &E::temperature, number(dimensions::temperature, not_negative),
          "velocities from Maxwell's distribution", "none");
  all.add("drift", &E::drift, vector(dimensions::velocity), "a common velocity, added to these", "none");
  all.add("remove_drift", &E::thermal, &MaxwellianOptions::remove_drift, flag(), "takes the mean off first");
  all.add(
      "exact_temperature", &E::thermal, &MaxwellianOptions::exact_temperature, flag(),
      "scales them so that the measured temperature is the wanted one, of the particles that move and the degrees of "
      "freedom that rigid bonds leave them");
  all.add("quiet", &E::thermal, &MaxwellianOptions::quiet, flag(),
          "puts them at the quantiles of the distribution, so that noise is far lower than that of random ones");
  all.add_said("velocity_ripple",
               "a table, `{ axis = \"x\", mode = 1, amplitude = \"100 m/s\", phase = 0, component = \"x\" }`",
               "a wave on top of the velocities", "none");
  all.add_said("density", "a density", "of smooth particles on a lattice: the masses follow", "none");
  all.add_said("material", "a table, `{ kind = \"tait\", ... }`",
               "of smooth particles: a [material](#material) (`bzm list materials`)", "needed with `[smooth]`");
  all.add_said(
      "heat_capacity",
      "a number, `\"16 kB\"`; `{ file = \"cv.csv\" }`; or `{ formula = \"kB*(10 + T/(100 K))\", from = \"50 K\", "
      "to = \"3000 K\" }`",
      "of `Meso`: which temperature an internal energy stands for. The file has two columns, temperature and "
      "heat capacity, numbers of the base or of the units that `temperature = \"1 K\"` and `heat_capacity = "
      "\"1 kB\"` beside it name; the formula is in T and Boltzmann's constant kB. "
      "Outside a table or the two ends the last value stays",
      "internal energies have no temperature");
  all.add_said("internal_energy", "an energy as any other field, or `{ temperature = \"300 K\" }`",
               "of `Meso`: each particle draws its own from the equilibrium at that temperature (mean (Cv + k) T for a "
               "constant heat capacity)",
               "0");
  all.add("colour", &E::appearance, &Appearance::colour, text(),
          "in pictures: " + join(colour_names()) + ", or `\"#rrggbb\"`", "chosen for you");
  all.add("diameter", &E::appearance, &Appearance::diameter, number(dimensions::length, not_negative), "in pictures",
          "0");
  all.add_said("set", "tables, `[[ensembles.set]]`", "other values for [some particles](#ensemblesset)", "none");
  all.at("name").needed = "\"atoms\"";
  all.at("class").needed = "\"Newton\"";
  all.at("load").needed = "{ kind = \"random\" }";
  return all;
}

OptionTable make_class_options() {
  OptionTable all;
  all.add_said("name", text("a text of letters, digits and _"), "for `class = ...` of `[[ensembles]]`");
  all.add_said("base", text("a class (`bzm list classes`)"),
               "from which it is derived: how its particles move, which fields they have, and which laws act on them");
  all.add_said("doc", text(), "one line about it", "none");
  all.add_said("fields", "a list of tables, [`{ name = \"charge\", unit = \"e\" }`](#classesfields)", "its own fields",
               "none");
  all.add_said("rate", "a table of [formulas](#laws-that-are-typed), `rate.charge = \"...\"`",
               "how fast a field changes; influences that change it (`changes` in `[[influences]]`) are added. Fields "
               "without a rate stay as they are",
               "none");
  all.add_said(
      "diffusion", "a table of [formulas](#laws-that-are-typed), `diffusion.angle = \"...\"`",
      "coefficients D of fields that take a random walk beside their rates, of variance 2 D t for each component",
      "none");
  all.add_said("parameters", "a table of quantities", "which its formulas use: `{ tau = \"1 s\" }`", "none");
  all.add_said("where", "a table of [formulas](#laws-that-are-typed)",
               "parts with names, which later ones and the rates may use", "none");
  all.at("name").needed = "\"Grain\"";
  all.at("base").needed = "\"Newton\"";
  return all;
}

OptionTable make_class_field_options() {
  using F = ClassFieldOptions;
  OptionTable all;
  all.add("name", &F::name, text(), "of letters, digits and _, in formulas, files, diagnoses and pictures");
  all.add("kind", &F::kind, word({"scalar", "vector"}), "a number, or as many as the space has axes");
  all.add("unit", &F::unit, text(), "what it is measured in, `\"e\"`, `\"1/s\"`, which gives its dimension",
          "a pure number");
  all.add_said("default", "a quantity, or a list of them", "of particles of which nothing else is said", "0");
  all.add("sum", &F::sum, flag(),
          "it has no rate, but is what influences with `changes` give to it at each calculation: rates may use it");
  all.add_said("period", "a quantity, positive",
               "of a field that has a rate: after each step it is taken back to between minus and plus half of it, as "
               "`\"2 pi\"` does with an angle",
               "it grows as it does");
  all.add("neighbours", &F::neighbours, number(dimensions::length, positive),
          "it is how many particles are nearer than that, found whenever somebody looks: files, pictures, diagnoses "
          "and events may use it, influences and rates can't",
          "it is no such number");
  all.add("of", &F::of, option::ensembles(), "whose particles are neighbours", "all particles");
  all.add("bond_order", &F::bond_order, whole(1, BondHarmonics::largest_order),
          "instead of their number, how far the directions to the neighbours are those of a crystal, as `bond-order` "
          "has it: Steinhardt's q6 or psi6 for 6",
          "their number");
  all.add("doc", &F::doc, text(), "one line about it", "none");
  all.at("name").needed = "\"charge\"";
  return all;
}

OptionTable make_influence_options() {  // long: a table, a row for each key
  using I = InfluenceOptions;
  using AtCutoff = FormulaLaw::AtCutoff;
  static Words<AtCutoff> const ends{
      "at_cutoff", {{AtCutoff::cut, "cut", ""}, {AtCutoff::shift, "shift", ""}, {AtCutoff::switched, "switch", ""}}};
  OptionTable all;
  all.add_said("law", text("a law (`bzm list laws`)"), "its parameters stand beside it");
  all.add_said("on", text("the name of an ensemble"), "among its particles; for laws from outside: on all of them",
               "`on`, `between` or `among`");
  all.add_said("between", "the names of two ensembles", "between the particles of two ensembles, both ways",
               "`on` or `between`");
  all.add_said("by", text("the name of an ensemble"), "with `on`: who acts; nothing acts back", "the same as `on`");
  all.add_said("among", "a list of names of ensembles",
               "within each of them and between each two, in place of `on` and `between`. A parameter, and `cutoff`, "
               "may be a table "
               "by names then, `{ argon = \"0.01 eV\", krypton = \"0.014 eV\", \"argon-krypton\" = \"0.012 eV\" }`",
               "`on` or `between`");
  all.add_said(
      "mixing", "a table of `\"arithmetic\"` and `\"geometric\"` by parameters",
      "with `among`: numbers for two ensembles that such a table does not have are this mean of those of each, "
      "`{ depth = \"geometric\", r0 = \"arithmetic\" }` (Lorentz and Berthelot)",
      "tables have them");
  all.add("cutoff", &I::cutoff, number(dimensions::length, positive), "of this law", "that of `[run]`");
  all.add("every", &I::every, whole(1, 1e6),
          "so many steps from one calculation to the next: a slow law, which then counts as often (r-RESPA); energies "
          "are right at multiples of it",
          "in each step");
  all.add("precision", &I::precision, word({"full", "single"}),
          "of `biot-savart` and `biot-savart-algebraic`, summed over all pairs: single is right to some 1e-6 and twice "
          "as fast");
  all.add_said("connect", "`[[first, last, interval]]` or `\"bonds\"`",
               "with `on`: only between fixed pairs, (first, first + interval), (first + interval, first + 2 "
               "interval), ... up to last; or those that are bonded (`bonds` of `[[ensembles]]`)",
               "all pairs");
  all.add("bonded_factors", &I::bonded_factors, numbers(dimensions::none),
          "with `on` and a cut-off: of pairs 1, 2, 3, ... bonds apart, `[0, 0, 0.5]`; 0 leaves them out",
          "1: as of all others");
  all.add_said("angles", "`\"bonds\"`, `[[0, 1, 2]]` or `{ file = \"angles.txt\" }`",
               "with `on`, of an `energy` in `angle`: on each three particles of a [molecule](#molecules) that two "
               "bonds join, or on those of the list, by the angle at the second",
               "it acts on pairs");
  all.add_said(
      "dihedrals", "`\"bonds\"`, `[[0, 1, 2, 3]]` or `{ file = \"dihedrals.txt\" }`",
      "with `on`, of an `energy` in `dihedral`: on each four that three bonds join, or on those of the list, by "
      "the turn about the line from the second to the third",
      "it acts on pairs");
  all.add_said("particles", particles(), "laws from outside: only on these, written as in `[[ensembles.set]]`",
               "on all");
  all.add_said("margin", number(dimensions::length, not_negative), "with `particles = \"edge\"`", "0");
  all.add_said(
      "where", "a [formula](#formulas); beside `energy` or `influence` a table of them",
      "laws from outside: only on those for which it is true. Of a typed law: its parts, `{ s = \"(sigma/r)^6\" }`",
      "on all");
  all.add_said("energy", text("a [formula](#laws-that-are-typed)"), "instead of `law`: a typed law, by its energy");
  all.add_said("influence", text("a [formula](#laws-that-are-typed)"),
               "instead of `law`: a typed law, by the force (or velocity) that p gets");
  all.add("changes", &I::changes, name_of_quantity(),
          "of a typed law by an influence: it moves nobody, but is added to the rate of that field of those that it "
          "acts on, which a class of [`[[classes]]`](#classes) has",
          "it moves them");
  all.add_said("parameters", "a table of quantities", "of a typed law: `{ depth = \"0.1 eV\" }`", "none");
  all.add("at_cutoff", &I::at_cutoff, ends,
          "of a pair law: as it is up to the cut-off; less its value there (an energy less its slope there, too, so "
          "that the force ends at zero); or times a smooth step from 1 to 0");
  all.add("switch_from", &I::switch_from, number(dimensions::length, positive), "where that step begins",
          "nine tenths of the cut-off");
  all.add("tail", &I::tail, flag(),
          "energy and pressure have what pairs beyond the cut-off would add, if particles stood there as everywhere; "
          "with `shifted = false` in `[run]`");
  all.add("from_outside", &I::from_outside, flag(), "a typed law that acts from outside");
  all.at("law").needed = "\"lennard-jones\"";
  return all;
}

OptionTable make_rigid_bond_options() {
  using R = RigidBondOptions;
  OptionTable all;
  all.add_said("on", text("the name of an ensemble"), "whose bonds they are, moved by the leap-frog");
  all.add_said("pairs", "`\"bonds\"`, `[[0, 1], [0, 2]]` or `{ file = \"bonds.txt\" }`",
               "which particles: those that are bonded, or others, as `bonds` of `[[ensembles]]` are written",
               "`\"bonds\"`");
  all.add("length", &R::length, number(dimensions::length, positive), "of all of them");
  all.add("tolerance", &R::tolerance, number(dimensions::none, {1e-14, 0.1}),
          "how exactly they keep it, in parts of the length; rigid bodies keep it to rounding");
  all.at("on").needed = "\"water\"";
  all.at("length").needed = "\"1 angstrom\"";
  return all;
}

OptionTable make_output_options() {
  OptionTable all;
  OptionKind const steps = whole(0, std::numeric_limits<double>::infinity());
  all.add("diagnoses", &OutputOptions::diagnoses, steps, "steps between two rows of `diagnoses.csv`", "200 rows");
  all.add("trajectory", &OutputOptions::trajectory, steps, "steps between two frames of `trajectory.h5`", "none");
  all.add("checkpoint", &OutputOptions::checkpoint, steps, "steps between two checkpoints",
          "at the start and at the end");
  all.add("mesh", &OutputOptions::mesh, steps,
          "steps between two frames of density, potential and field: `mesh/000000100.vti`, ... and `mesh.pvd`, which "
          "ParaView opens as a time series",
          "none");
  all.add_said("units", "a table of units by what they are of, `{ energy = \"kcal/mol\", length = \"angstrom\" }`",
               "of results: diagnoses, tables, pictures and trajectories ([units](units.md#results))",
               "those of the base");
  all.add_said("pictures", "tables, `[[output.pictures]]`", "pictures of the last state", "none");
  return all;
}

OptionTable make_region_options() {
  using Side = Region::Side;
  static Words<Side> const sides{"side", {{Side::keep_out, "keep-out", ""}, {Side::keep_in, "keep-in", ""}}};
  OptionTable all;
  all.add("low", &RegionOptions::low, vector(dimensions::length), "the lower edges of the block");
  all.add("high", &RegionOptions::high, vector(dimensions::length), "the upper edges");
  all.add("side", &RegionOptions::side, sides, "nothing gets in, or nothing that is inside gets out");
  all.at("low").needed = "[2, 2]";
  all.at("high").needed = "[4, 4]";
  all.at("side").needed = "\"keep-out\"";
  return all;
}

OptionTable make_set_options() {
  OptionTable all;
  all.add_said("particles", particles(), "which ones, numbered from 0 in the order of loading",
               "`particles` or `where`");
  all.add_said("margin", number(dimensions::length, not_negative),
               "with `particles = \"edge\"`: those nearer than this to a face of the block that encloses all",
               "needed by `\"edge\"`");
  all.add_said("where", text("a [formula](#formulas)"), "those for which it is true: `\"x < 0.1 && mass > 1\"`",
               "`particles` or `where`");
  all.add_said("formulas", "a table of [formulas](#formulas)", "fields that depend on the place", "none");
  all.add("freeze", &SetOptions::freeze, flag(), "they stay where they are, and have no temperature");
  return all;
}

OptionTable make_dissipation_pair_options() {
  OptionTable all;
  all.add_said("on", "the name of an ensemble; of heat baths also a list",
               "for the pairs within it; on whom a bath acts", "`on` or `between`");
  all.add_said("between", "the names of two ensembles", "for the pairs of one of each", "`on` or `between`");
  return all;
}

OptionTable make_wall_options() {
  using W = WallOptions;
  static Words<Box::End> const ends{"end", {{Box::End::low, "low", ""}, {Box::End::high, "high", ""}}};
  OptionTable all;
  all.add("axis", &W::axis, axis_word(), "that the wall ends");
  all.add("end", &W::end, ends, "which end of it");
  all.add("open", &W::open, flag(), "no wall at this end: a free surface");
  all.add("slips", &W::wall, &Wall::slips, flag(), "of a mirror; else matter at the wall moves with it");
  all.add("velocity", &W::velocity, vector(dimensions::velocity), "along the axis it makes a piston; else of a mirror",
          "none");
  all.add("temperature", &W::wall, &Wall::temperature, number(dimensions::temperature, not_negative), "of a mirror",
          "no heat goes through");
  all.at("axis").needed = "\"y\"";
  all.at("end").needed = "\"low\"";
  return all;
}

OptionTable make_event_options() {
  using E = EventOptions;
  OptionTable all;
  all.add("at", &E::at, number(dimensions::time, positive),
          "since the start of the run; at the end of the step that ends "
          "there or just behind");
  all.add("every", &E::every, number(dimensions::time, positive), "and again after so long, and so on", "once");
  all.add("times", &E::times, whole(1, 10'000), "how often in all");
  all.add_said("set", "a table of keys by their paths, as those of `--set`, and values",
               "numbers that other tables have said: `{ \"dissipation.0.temperature\" = \"100 K\" }`", "none");
  all.add_said("add", "a table, `{ load = { ... }, velocity = [1, 0] }`",
               "particles are added to the ensemble `on`: keys of [[ensembles]], of which those that are left out are "
               "as its own table has them, but velocities are zero",
               "none");
  all.add_said("on", option::ensembles(), "whose velocities are changed; or to whom particles are added",
               "all that have velocities");
  all.add_said("where", text("a [formula](#formulas)"), "of those the ones for which it is true then", "all");
  all.add("temperature", &E::temperature, number(dimensions::temperature, not_negative),
          "velocities are scaled to it: a quench. A total momentum that the system keeps stays as it is");
  all.add("subtract_drift", &E::subtract_drift, flag(),
          "with `temperature`: velocities are those relative to the common one, which stays, in any case");
  all.add("scale", &E::scale, number(dimensions::none), "velocities are multiplied by it");
  all.add("kick", &E::kick, vector(dimensions::velocity), "a velocity that is added");
  all.add("keep_distance", &E::keep_distance, number(dimensions::length, not_negative),
          "of what is added at random, from particles that are there: places are drawn again until they are that far, "
          "20,000 times at most");
  all.at("at").needed = "\"5 ps\"";
  return all;
}

OptionTable make_equilibration_options() {
  OptionTable all = equilibration_bath_options();
  all.add_said("time", number(dimensions::time, not_negative), "how long");
  all.add_said("on", option::ensembles(), "who is brought to it", "all that leap-frog moves");
  all.at("time").needed = "\"2 ps\"";
  return all;
}

}  // namespace

OptionTable const& units_options() { return once<make_units_options>(); }
OptionTable units_options(std::string const& base) {
  auto const of = [](std::vector<std::pair<char const*, char const*>> const& with_examples) {
    std::vector<OptionKey> keys;
    for (auto const& [key, example] : with_examples) keys.push_back({.key = key, .needed = example});
    return units_options().only(keys);
  };
  if (base == "lennard-jones")
    return of({{"sigma", "\"3.405 angstrom\""}, {"epsilon", "\"0.01032 eV\""}, {"mass", "\"39.948 amu\""}});
  if (base == "gravitational") return of({{"length", "\"1 AU\""}, {"mass", "\"1 Msun\""}});
  if (base == "plasma")
    return of({{"density", "\"1e18 1/m^3\""},
               {"charge", "\"1.602176634e-19 C\""},
               {"mass", "\"9.1093837015e-31 kg\""},
               {"temperature", "\"10000 K\""}});
  if (base == "custom")
    return of({{"length", "\"1 angstrom\""},
               {"mass", "\"1 amu\""},
               {"time", "\"1 ps\""},
               {"temperature", ""},
               {"charge", ""}});
  return {};
}
OptionTable const& sweep_picture_options() { return once<make_sweep_picture_options>(); }
OptionTable const& event_options() { return once<make_event_options>(); }
OptionTable const& run_options() { return once<make_run_options>(); }
OptionTable const& box_options() { return once<make_box_options>(); }
OptionTable const& shear_options() { return once<make_shear_options>(); }
OptionTable const& ensemble_options() { return once<make_ensemble_options>(); }
OptionTable const& influence_options() { return once<make_influence_options>(); }
OptionTable const& rigid_bond_options() { return once<make_rigid_bond_options>(); }
OptionTable const& class_options() { return once<make_class_options>(); }
OptionTable const& class_field_options() { return once<make_class_field_options>(); }
OptionTable const& output_options() { return once<make_output_options>(); }
OptionTable const& wall_options() { return once<make_wall_options>(); }
OptionTable const& region_options() { return once<make_region_options>(); }
OptionTable const& set_options() { return once<make_set_options>(); }
OptionTable const& dissipation_pair_options() { return once<make_dissipation_pair_options>(); }
OptionTable const& equilibration_options() { return once<make_equilibration_options>(); }

namespace {

std::vector<ScenarioTable> make_tables() {  // long: a table, an entry for each
  static InfluenceOptions influence;
  static RigidBondOptions rigid;
  static ClassFieldOptions field;
  static WallOptions wall;
  static RunOptions run;
  static BathOptions bath;
  static EnsembleOptions ensemble;
  static RegionOptions region;
  static SetOptions set;
  static OutputOptions output;
  static RelaxationOptions relaxation;
  static BarostatOptions barostat;
  static EventOptions event;
  static MinimiseOptions minimise;
  static RemeshOptions remesh;
  static CoreSplittingOptions split;
  static OutflowOptions outflow;
  static DyeOptions dye;
  static BodyOptions body;
  static UnitsOptions units;
  std::vector<ScenarioTable> all = {
      {"units", "[units]", "what plain numbers mean, and the units of the results", &units_options(), &units},
      {"box", "[box]", "the space", &box_options(), nullptr},
      {"box.walls", "[[box.walls]]", "the walls of mirror axes, and what is moved or left out of reflecting ones",
       &wall_options(), &wall},
      {"box.regions", "[[box.regions]]", "a block with elastic faces inside the space", &region_options(), &region},
      {"run", "[run]", "how long, in which steps", &run_options(), &run}};
  for (auto const& scheme : scheme_entries()) {
    all.push_back(scheme.told);
    all.insert(all.end(), scheme.inner.begin(), scheme.inner.end());
  }
  static OptionTable const sweep = make_sweep_options();
  static SweepPictureOptions picture;
  all.insert(
      all.end(),
      {{"classes", "[[classes]]", "a class of particles that is derived from another one", &class_options(), nullptr},
       {"classes.fields", "[[classes.fields]]", "a field of such a class", &class_field_options(), &field},
       {"ensembles", "[[ensembles]]", "the particles of one class", &ensemble_options(), &ensemble},
       {"ensembles.set", "[[ensembles.set]]", "other values for some particles, beside the fields of their class",
        &set_options(), &set},
       {"bodies", "[[bodies]]", "a solid body in a plane flow, which flows around its outline", &body_options(), &body},
       {"influences", "[[influences]]", "a law, and on whom it acts", &influence_options(), &influence},
       {"rigid_bonds", "[[rigid_bonds]]", "bonds of a fixed length", &rigid_bond_options(), &rigid},
       {"remesh", "[[remesh]]", "vortices that are replaced by others on a lattice while the run goes on",
        &remesh_options(), &remesh},
       {"split_cores", "[[split_cores]]", "vortices whose cores have grown wide are split while the run goes on",
        &core_splitting_options(), &split},
       {"outflow", "[[outflow]]", "where vortices and tracers leave that the flow has carried away", &outflow_options(),
        &outflow},
       {"dye", "[[dye]]", "where tracers are released while the run goes on", &dye_options(), &dye},
       {"output", "[output]", "what is written, and how often", &output_options(), &output},
       {"minimise", "[minimise]", "particles are moved downhill before the run begins", &minimise_options(), &minimise},
       {"equilibrate", "[equilibrate]", "a heat bath before the run begins", &equilibration_options(), &bath},
       {"barostat", "[[barostat]]", "a pressure that is held by stretching the box", &barostat_options(), &barostat},
       {"events", "[[events]]", "what happens once at a time of the run", &event_options(), &event},
       {"relaxation", "[relaxation]", "vortices in 3D: vorticity is turned towards the curl of the flow",
        &relaxation_options(), &relaxation},
       {"sweep", "[sweep]", "the same scenario for several values of its keys, and with several seeds", &sweep,
        nullptr},
       {"sweep.pictures", "[[sweep.pictures]]", "a picture of all runs of a sweep", &sweep_picture_options(),
        &picture}});
  return all;
}

}  // namespace

std::vector<ScenarioTable> const& scenario_tables() { return once<make_tables>(); }

}  // namespace boltzmann
