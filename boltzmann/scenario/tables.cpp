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
                "longest distance that a particle moves in a substep");
    options.add("energy", &S::energy, number(dimensions::energy, positive),
                "largest work of a force on a particle in a substep");
    options.add("courant", &S::courant, number(dimensions::none, positive),
                "largest part of the Courant step in a substep");
    return options;
  }();
  return all;
}

OptionTable make_run_options() {
  using R = RunOptions;
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  OptionTable all;
  all.add_said("step", "a time; with `[smooth]` also `\"courant\"`, or `{ courant = 0.5 }`",
               "time step, or a part of the initial Courant step");
  all.add("steps", &R::steps, whole(0, unlimited), "number of steps", "or `time`");
  all.add("time", &R::time, number(dimensions::time, not_negative), "length of the run, instead of `steps`",
          "or `steps`");
  all.add("seed", &R::seed, whole(0, unlimited), "seed of all random numbers");
  all.add("threads", &R::threads, whole(0, 4096),
          "number of threads, 0: all cores; results are the same for any number");
  all.add("cutoff", &R::cutoff, number(dimensions::length, positive),
          "distance beyond which pair laws are zero; needed if an axis is periodic. Energies are shifted to zero "
          "there, forces are not changed",
          "all pairs");
  all.add("shifted", &R::shifted, flag(),
          "shift pair energies to zero at the cut-off; `false`: use them as they are, as papers with a "
          "[tail](influences.md#cut-offs-and-tails) do");
  all.add("skin", &R::skin, number(dimensions::length, not_negative),
          "reach of neighbour lists beyond the cut-off, at most 4 cut-offs; changes the speed only", "automatic");
  all.add("tolerance", &R::tolerance, number(dimensions::none, {1e-14, 0.01}),
          "with `gauss-radau`: largest ratio of the last term of its series to the first, in each step",
          "1e-9, the accuracy of doubles");
  all.add(
      "substeps", &R::substeps, substep_options(), "{ distance = 0.01 }",
      "with `leap-frog` and `symplectic-4`: divide each step into 2^n substeps that keep these limits, one or several",
      "no substeps");
  all.add_said("stop", text("a [condition](#stop)"), "ends the run early", "none");
  all.at("step").needed = "0.01";
  return all;
}

OptionTable make_units_options() {
  using U = UnitsOptions;
  OptionTable all;
  all.add("base", &U::base, word({"si", "cgs", "reduced", "lennard-jones", "gravitational", "plasma", "custom"}),
          "units of plain numbers and of results; `reduced`: pure numbers without units", "`\"si\"`");
  all.add("sigma", &U::sigma, number(dimensions::length),
          "lennard-jones: sigma, epsilon, mass and Boltzmann's constant are 1");
  all.add("epsilon", &U::epsilon, number(dimensions::energy), "lennard-jones");
  all.add("mass", &U::mass, number(dimensions::mass),
          "lennard-jones, plasma, custom; gravitational: length, mass and G are 1");
  all.add("length", &U::length, number(dimensions::length), "gravitational, custom");
  all.add("time", &U::time, number(dimensions::time), "custom");
  all.add("density", &U::density, number(dimensions::number_density),
          "plasma: the plasma frequency, the Debye length and the thermal velocity are 1");
  all.add("charge", &U::charge, number(dimensions::charge), "plasma, custom", "custom: the elementary charge");
  all.add("temperature", &U::temperature, number(dimensions::temperature), "plasma, custom", "custom: 1 K");
  return all;
}

OptionTable make_sweep_options() {
  OptionTable all;
  all.add_said("seeds", whole(1, 10'000), "runs of each value, with the seed of `[run]`, the next one, ...", "`1`");
  all.add_said("vary", "a table: for each key the list of its values",
               "values are whatever the key is: numbers, quantities, words, lists, tables. Keys are written as for "
               "`--set`, and go together: all have as many values",
               "repeated with other seeds only");
  all.add_said(
      "table", "columns of diagnoses, a list or with commas",
      "columns of `sweep.csv` and of the printed table; one value for each run: its last row, or its mean since `from`",
      "all");
  all.add_said("from", number(dimensions::time), "the table has means over the rows since then", "the last row");
  all.add_said("labels", "a list of texts, `[\"coupled\", \"uncoupled\"]`",
               "names of the values, for legends, tables and folders", "the values");
  all.add_said("pictures", "tables, `[[sweep.pictures]]`", "pictures of all runs together", "none");
  return all;
}

OptionTable make_sweep_picture_options() {
  using P = SweepPictureOptions;
  OptionTable all;
  all.add("drawing", &P::drawing, word({"points", "time-series"}), "a point for each value, or curves over time");
  all.add_said("x", text("a key that varies, or a column of diagnoses"),
               "horizontal axis of points; for a key with lists the one component that differs",
               "the key, if only one varies");
  all.add_said("y", "columns of diagnoses, a list or with commas", "upwards");
  all.add("fit", &P::fit, word({"line"}),
          "for points: least-squares line through all runs, with errors from their scatter; drawn, printed and written "
          "to `fits.csv`",
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
          "velocity gradient, velocity per length; negative: the other way");
  all.add("flow", &S::flow, axis_word(), "axis along which the images move");
  all.add("gradient", &S::gradient, axis_word(), "axis of the velocity gradient");
  all.add("established", &S::established, flag(),
          "particles start with the velocity of the flow; else the fluid starts at rest");
  all.at("rate").needed = "0.1";
  return all;
}

OptionTable make_box_options() {
  OptionTable all;
  all.add_said("low", vector(dimensions::length), "lower edges: one, two or three numbers make the space 1D, 2D or 3D");
  all.add_said("high", vector(dimensions::length), "upper edges");
  std::string kinds;
  for (auto const& word : boundary_words())
    kinds += (kinds.empty() ? "`\"" : "; `\"") + std::string(word.name) + "\"`: " + std::string(word.doc);
  all.add_said("boundary", "a word, or a list with one for each axis", kinds, "`\"open\"`");
  all.add("shear", &BoxOptions::shear, shear_options(), "{ rate = 0.1 }",
          "two periodic axes whose images move past each other (Lees and Edwards): a [flow without walls](#shear)",
          "at rest");
  all.add_said("walls", "tables, `[[box.walls]]`", "[walls](#boxwalls) of mirror and reflecting axes", "none");
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
  all.add("name", &E::name, text(), "name in tables, columns and legends");
  all.add_said("class", text("a class (`bzm list classes`)"), "class of the particles");
  all.add_of<E>(
      "integrator",
      [](E& of) -> OptionPlace {
        return NamedValue{[&of] { return of.integrator ? method_words().name(*of.integrator) : ""; },
                          [&of](std::string const& name) { of.integrator = method_words().named(name); }};
      },
      word(method_words().names()), methods,
      "`\"leap-frog\"` for classical particles, `\"rk4\"` for those that a flow carries");
  all.add_said("load", "a table, `{ kind = \"block\", ... }`",
               "initial positions: a [loader](load.md) (`bzm list loaders`)");
  all.add("number", &E::number, whole(0, std::numeric_limits<double>::infinity()),
          "number of particles, for loaders that need it; 0: [events](events.md) add them", "from the loader");
  all.add("molecule", &E::molecule, whole(1, 4e9),
          "particles in a molecule, stored one after the other; `bonds`, `angles` and `dihedrals` number the particles "
          "of one molecule and apply to all",
          "the whole ensemble");
  all.add_said("bonds", "`\"chain\"`, `[[0, 1], [0, 2]]` or `{ file = \"bonds.txt\" }`",
               "bonded pairs of a [molecule](../../how-to/build-molecules.md): each particle with the next, or pairs "
               "of numbers from a list or a file",
               "none");
  all.add_said("formulas", "a table of [formulas](../formulas.md)", "fields that depend on the position", "none");
  all.add("element", &E::element, text(),
          "chemical symbol, `\"Cu\"`, for exports and `[embedded_atoms]`; sets the mass if nothing else does", "none");
  all.add("temperature", &E::temperature, number(dimensions::temperature, not_negative),
          "temperature of Maxwell-distributed velocities", "none");
  all.add("drift", &E::drift, vector(dimensions::velocity), "common velocity, added to the thermal ones", "none");
  all.add("remove_drift", &E::thermal, &MaxwellianOptions::remove_drift, flag(), "subtract the mean velocity first");
  all.add("exact_temperature", &E::thermal, &MaxwellianOptions::exact_temperature, flag(),
          "scale velocities so that the measured temperature of the moving particles is exact; rigid bonds reduce the "
          "degrees of freedom");
  all.add("quiet", &E::thermal, &MaxwellianOptions::quiet, flag(),
          "place velocities at the quantiles of the distribution, with far less noise than random ones");
  all.add_said("velocity_ripple",
               "a table, `{ axis = \"x\", mode = 1, amplitude = \"100 m/s\", phase = 0, component = \"x\" }`",
               "a wave added to the velocities", "none");
  all.add_said("density", "a density", "density of smooth particles on a lattice; sets their masses", "none");
  all.add_said("material", "a table, `{ kind = \"tait\", ... }`",
               "[material](material.md) of smooth particles (`bzm list materials`)", "needed with `[smooth]`");
  all.add_said(
      "heat_capacity",
      "a number, `\"16 kB\"`; `{ file = \"cv.csv\" }`; or `{ formula = \"kB*(10 + T/(100 K))\", from = \"50 K\", to = "
      "\"3000 K\" }`",
      "with `Meso`: heat capacity, which relates temperature to internal energy. Columns of a file: temperature and "
      "heat capacity, in base units or those given by `temperature = \"1 K\"` and `heat_capacity = \"1 kB\"`. A "
      "formula is in T and Boltzmann's constant kB. Beyond the ends the last value holds",
      "no temperature");
  all.add_said(
      "internal_energy", "an energy, or `{ temperature = \"300 K\" }`",
      "with `Meso`: energies drawn from equilibrium at that temperature (mean (Cv + k) T for a constant heat capacity)",
      "0");
  all.add("colour", &E::appearance, &Appearance::colour, text(),
          "in pictures: " + join(colour_names()) + ", or `\"#rrggbb\"`", "automatic");
  all.add("diameter", &E::appearance, &Appearance::diameter, number(dimensions::length, not_negative),
          "diameter in pictures", "0");
  all.add_said("set", "tables, `[[ensembles.set]]`", "other values for [some particles](#ensemblesset)", "none");
  all.at("name").needed = "\"atoms\"";
  all.at("class").needed = "\"Newton\"";
  all.at("load").needed = "{ kind = \"random\" }";
  return all;
}

OptionTable make_class_options() {
  OptionTable all;
  all.add_said("name", text("letters, digits and _"), "name, used as `class = ...` in `[[ensembles]]`");
  all.add_said("base", text("a class (`bzm list classes`)"),
               "class that gives the motion, the first fields and the laws");
  all.add_said("doc", text(), "description, one line", "none");
  all.add_said("fields", "a list of tables, [`{ name = \"charge\", unit = \"e\" }`](#classesfields)", "new fields",
               "none");
  all.add_said("rate", "a table of [formulas](../../how-to/write-a-formula-law.md), `rate.charge = \"...\"`",
               "rates of change of fields; influences with `changes` are added. Fields without a rate are constant",
               "none");
  all.add_said("diffusion", "a table of [formulas](../../how-to/write-a-formula-law.md), `diffusion.angle = \"...\"`",
               "diffusion coefficients D of fields: a random walk of variance 2 D t for each component", "none");
  all.add_said("parameters", "a table of quantities", "constants of the formulas: `{ tau = \"1 s\" }`", "none");
  all.add_said("where", "a table of [formulas](../../how-to/write-a-formula-law.md)",
               "named parts, usable in later parts and in rates", "none");
  all.at("name").needed = "\"Grain\"";
  all.at("base").needed = "\"Newton\"";
  return all;
}

OptionTable make_class_field_options() {
  using F = ClassFieldOptions;
  OptionTable all;
  all.add("name", &F::name, text(), "letters, digits and _; used in formulas, files, diagnoses and pictures");
  all.add("kind", &F::kind, word({"scalar", "vector"}), "one number, or one for each axis");
  all.add("unit", &F::unit, text(), "unit, `\"e\"`, `\"1/s\"`; sets the dimension", "a pure number");
  all.add_said("default", "a quantity, or a list of them", "initial value of particles that do not set this field",
               "0");
  all.add("sum", &F::sum, flag(), "holds the sum of influences with `changes`, for use in rates; has no rate");
  all.add_said(
      "period", "a quantity, positive",
      "period: after each step the value is wrapped to between minus and plus half of it, `\"2 pi\"` for angles",
      "not wrapped");
  all.add("neighbours", &F::neighbours, number(dimensions::length, positive),
          "number of particles nearer than this. Computed for files, pictures, diagnoses and events; not usable in "
          "influences and rates",
          "not such a field");
  all.add("of", &F::of, option::ensembles(), "ensembles of the neighbours", "all particles");
  all.add("bond_order", &F::bond_order, whole(1, BondHarmonics::largest_order),
          "crystal order of the neighbours instead of their number, as `bond-order`: Steinhardt's q6, or psi6 for 6",
          "the number");
  all.add("doc", &F::doc, text(), "description, one line", "none");
  all.at("name").needed = "\"charge\"";
  return all;
}

OptionTable make_influence_options() {  // long: a table, a row for each key
  using I = InfluenceOptions;
  using AtCutoff = FormulaLaw::AtCutoff;
  static Words<AtCutoff> const ends{
      "at_cutoff", {{AtCutoff::cut, "cut", ""}, {AtCutoff::shift, "shift", ""}, {AtCutoff::switched, "switch", ""}}};
  OptionTable all;
  all.add_said("law", text("a law (`bzm list laws`)"), "built-in law; its parameters are keys beside it");
  all.add_said("on", text("the name of an ensemble"),
               "ensemble whose pairs interact; with external laws: that feels the law", "`on`, `between` or `among`");
  all.add_said("between", "the names of two ensembles", "two ensembles, acting on each other", "`on` or `between`");
  all.add_said("by", text("the name of an ensemble"), "with `on`: ensemble that acts, without reaction",
               "the same as `on`");
  all.add_said(
      "among", "a list of names of ensembles",
      "interact within each and between each two, instead of `on` and `between`. Parameters and `cutoff` may be tables "
      "by names, `{ argon = \"0.01 eV\", krypton = \"0.014 eV\", \"argon-krypton\" = \"0.012 eV\" }`",
      "`on` or `between`");
  all.add_said("mixing", "a table of `\"arithmetic\"` and `\"geometric\"` by parameters",
               "with `among`: mean for pairs of ensembles that a table lacks, `{ depth = \"geometric\", r0 = "
               "\"arithmetic\" }` (Lorentz and Berthelot)",
               "tables list all pairs");
  all.add("cutoff", &I::cutoff, number(dimensions::length, positive), "cut-off of this law", "that of `[run]`");
  all.add("every", &I::every, whole(1, 1e6),
          "steps between evaluations of a slow law, which is weighted accordingly (r-RESPA); energies are right at "
          "multiples of it",
          "each step");
  all.add("precision", &I::precision, word({"full", "single"}),
          "with `biot-savart` and `biot-savart-algebraic`, all pairs: single is accurate to 1e-6 and twice as fast");
  all.add_said("connect", "`[[first, last, interval]]` or `\"bonds\"`",
               "with `on`: fixed pairs (first, first + interval), (first + interval, first + 2 interval), ... up to "
               "last; or those of `bonds` in `[[ensembles]]`",
               "all pairs");
  all.add("bonded_factors", &I::bonded_factors, numbers(dimensions::none),
          "with `on` and a cut-off: factors of pairs 1, 2, 3, ... bonds apart, `[0, 0, 0.5]`; 0 excludes them",
          "1, as other pairs");
  all.add_said("angles", "`\"bonds\"`, `[[0, 1, 2]]` or `{ file = \"angles.txt\" }`",
               "with `on`, for an `energy` of `angle`: each three bonded particles of a "
               "[molecule](../../how-to/build-molecules.md), or those listed; the angle is at the second",
               "pairs");
  all.add_said("dihedrals", "`\"bonds\"`, `[[0, 1, 2, 3]]` or `{ file = \"dihedrals.txt\" }`",
               "with `on`, for an `energy` of `dihedral`: each four particles bonded in a row, or those listed",
               "pairs");
  all.add_said("particles", particles(), "external laws: only these particles, as in `[[ensembles.set]]`", "all");
  all.add_said("margin", number(dimensions::length, not_negative), "with `particles = \"edge\"`", "0");
  all.add_said(
      "where", "a [formula](../formulas.md); beside `energy` or `influence` a table of them",
      "external laws: only particles for which it is true. With formula laws: named parts, `{ s = \"(sigma/r)^6\" }`",
      "all");
  all.add_said("energy", text("a [formula](../../how-to/write-a-formula-law.md)"),
               "energy of a formula law, instead of `law`; forces follow");
  all.add_said("influence", text("a [formula](../../how-to/write-a-formula-law.md)"),
               "force on p (or velocity) of a formula law, instead of `law`");
  all.add(
      "changes", &I::changes, name_of_quantity(),
      "add the influence of a formula law to the rate of this field of a [class](classes.md), instead of to the motion",
      "the motion");
  all.add_said("parameters", "a table of quantities", "constants of a formula law: `{ depth = \"0.1 eV\" }`", "none");
  all.add("at_cutoff", &I::at_cutoff, ends,
          "end of a pair law at the cut-off: cut; shifted energy (and its slope, so that the force ends at zero); or a "
          "smooth step from 1 to 0");
  all.add("switch_from", &I::switch_from, number(dimensions::length, positive), "start of the smooth step",
          "0.9 of the cut-off");
  all.add("tail", &I::tail, flag(),
          "add to energy and pressure the mean contribution of pairs beyond the cut-off; needs `shifted = false` in "
          "`[run]`");
  all.add("from_outside", &I::from_outside, flag(), "an external formula law");
  all.at("law").needed = "\"lennard-jones\"";
  return all;
}

OptionTable make_rigid_bond_options() {
  using R = RigidBondOptions;
  OptionTable all;
  all.add_said("on", text("the name of an ensemble"), "ensemble with the bonds, moved by leap-frog");
  all.add_said("pairs", "`\"bonds\"`, `[[0, 1], [0, 2]]` or `{ file = \"bonds.txt\" }`",
               "constrained pairs: those bonded, or others, written as `bonds` of `[[ensembles]]`", "`\"bonds\"`");
  all.add("length", &R::length, number(dimensions::length, positive), "length of all");
  all.add("tolerance", &R::tolerance, number(dimensions::none, {1e-14, 0.1}),
          "relative tolerance of the lengths; rigid bodies keep them to rounding");
  all.at("on").needed = "\"water\"";
  all.at("length").needed = "\"1 angstrom\"";
  return all;
}

OptionTable make_output_options() {
  OptionTable all;
  OptionKind const steps = whole(0, std::numeric_limits<double>::infinity());
  all.add("diagnoses", &OutputOptions::diagnoses, steps, "steps between rows of `diagnoses.csv`", "200 rows");
  all.add("trajectory", &OutputOptions::trajectory, steps, "steps between frames of `trajectory.h5`", "none");
  all.add("checkpoint", &OutputOptions::checkpoint, steps, "steps between checkpoints", "at the start and at the end");
  all.add(
      "mesh", &OutputOptions::mesh, steps,
      "steps between frames of density, potential and field, `mesh/000000100.vti`, ..., and `mesh.pvd` for ParaView",
      "none");
  all.add_said("units", "a table of units by quantity, `{ energy = \"kcal/mol\", length = \"angstrom\" }`",
               "units of results: diagnoses, tables, pictures and trajectories ([units](../units.md#results))",
               "base units");
  all.add_said("pictures", "tables, `[[output.pictures]]`", "pictures of the last state", "none");
  return all;
}

OptionTable make_region_options() {
  using Side = Region::Side;
  static Words<Side> const sides{"side", {{Side::keep_out, "keep-out", ""}, {Side::keep_in, "keep-in", ""}}};
  OptionTable all;
  all.add("low", &RegionOptions::low, vector(dimensions::length), "lower edges of the block");
  all.add("high", &RegionOptions::high, vector(dimensions::length), "upper edges");
  all.add("side", &RegionOptions::side, sides, "keep particles out of the block, or inside");
  all.at("low").needed = "[2, 2]";
  all.at("high").needed = "[4, 4]";
  all.at("side").needed = "\"keep-out\"";
  return all;
}

OptionTable make_set_options() {
  OptionTable all;
  all.add_said("particles", particles(), "numbers of particles, from 0 in the order of loading",
               "`particles` or `where`");
  all.add_said("margin", number(dimensions::length, not_negative),
               "with `particles = \"edge\"`: those nearer than this to a face of the block that encloses all",
               "needed by `\"edge\"`");
  all.add_said("where", text("a [formula](../formulas.md)"),
               "particles for which it is true: `\"x < 0.1 && mass > 1\"`", "`particles` or `where`");
  all.add_said("formulas", "a table of [formulas](../formulas.md)", "fields that depend on the position", "none");
  all.add("freeze", &SetOptions::freeze, flag(), "fixed particles, without temperature");
  return all;
}

OptionTable make_dissipation_pair_options() {
  OptionTable all;
  all.add_said("on", "the name of an ensemble; for heat baths also a list",
               "pairs within this ensemble; particles that a bath acts on", "`on` or `between`");
  all.add_said("between", "the names of two ensembles", "pairs of one particle of each", "`on` or `between`");
  return all;
}

OptionTable make_wall_options() {
  using W = WallOptions;
  static Words<Box::End> const ends{"end", {{Box::End::low, "low", ""}, {Box::End::high, "high", ""}}};
  OptionTable all;
  all.add("axis", &W::axis, axis_word(), "axis of the wall");
  all.add("end", &W::end, ends, "end of the axis");
  all.add("open", &W::open, flag(), "free surface without a wall");
  all.add("slips", &W::wall, &Wall::slips, flag(),
          "slip wall; `false`: adjacent matter moves with the wall. Mirror axes only");
  all.add("velocity", &W::velocity, vector(dimensions::velocity),
          "velocity of the wall; along the axis it is a piston. Mirror axes only", "none");
  all.add("temperature", &W::wall, &Wall::temperature, number(dimensions::temperature, not_negative),
          "temperature of the wall. Mirror axes only", "no heat flux");
  all.at("axis").needed = "\"y\"";
  all.at("end").needed = "\"low\"";
  return all;
}

OptionTable make_event_options() {
  using E = EventOptions;
  OptionTable all;
  all.add("at", &E::at, number(dimensions::time, positive),
          "time since the start; the event happens at the end of the step that reaches it");
  all.add("every", &E::every, number(dimensions::time, positive), "interval of repetitions", "once");
  all.add("times", &E::times, whole(1, 10'000), "number of times in all");
  all.add_said("set", "a table of values by path, as for `--set`",
               "changed values of other tables: `{ \"dissipation.0.temperature\" = \"100 K\" }`", "none");
  all.add_said("add", "a table, `{ load = { ... }, velocity = [1, 0] }`",
               "particles added to the ensemble `on`, with keys of [[ensembles]]; other keys are those of its own "
               "table, but velocities are zero",
               "none");
  all.add_said("on", option::ensembles(), "ensemble whose velocities change, or that gets particles",
               "all with velocities");
  all.add_said("where", text("a [formula](../formulas.md)"), "only particles for which it is true at that time", "all");
  all.add("temperature", &E::temperature, number(dimensions::temperature, not_negative),
          "scale velocities to this temperature (a quench), keeping a conserved total momentum");
  all.add("subtract_drift", &E::subtract_drift, flag(),
          "with `temperature`: scale velocities relative to the mean, which is kept");
  all.add("scale", &E::scale, number(dimensions::none), "factor of the velocities");
  all.add("kick", &E::kick, vector(dimensions::velocity), "velocity to add");
  all.add("keep_distance", &E::keep_distance, number(dimensions::length, not_negative),
          "smallest distance of randomly added particles from others; at most 20,000 attempts");
  all.at("at").needed = "\"5 ps\"";
  return all;
}

OptionTable make_equilibration_options() {
  OptionTable all = equilibration_bath_options();
  all.add_said("time", number(dimensions::time, not_negative), "length");
  all.add_said("on", option::ensembles(), "ensembles with the bath", "all moved by leap-frog");
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
      {"units", "[units]", "units of plain numbers and results", &units_options(), &units},
      {"box", "[box]", "the space", &box_options(), nullptr},
      {"box.walls", "[[box.walls]]", "walls of mirror axes; moving or open ends of reflecting axes", &wall_options(),
       &wall},
      {"box.regions", "[[box.regions]]", "a block with elastic faces inside the space", &region_options(), &region},
      {"run", "[run]", "length of the run and its time steps", &run_options(), &run}};
  for (auto const& scheme : scheme_entries()) {
    all.push_back(scheme.told);
    all.insert(all.end(), scheme.inner.begin(), scheme.inner.end());
  }
  static OptionTable const sweep = make_sweep_options();
  static SweepPictureOptions picture;
  all.insert(
      all.end(),
      {{"classes", "[[classes]]", "a particle class, derived from another", &class_options(), nullptr},
       {"classes.fields", "[[classes.fields]]", "a field of such a class", &class_field_options(), &field},
       {"ensembles", "[[ensembles]]", "the particles of one class", &ensemble_options(), &ensemble},
       {"ensembles.set", "[[ensembles.set]]", "other values for some particles, such as fields of their class",
        &set_options(), &set},
       {"bodies", "[[bodies]]", "a solid body in a plane flow", &body_options(), &body},
       {"influences", "[[influences]]", "a law between or on ensembles", &influence_options(), &influence},
       {"rigid_bonds", "[[rigid_bonds]]", "bonds of fixed length", &rigid_bond_options(), &rigid},
       {"remesh", "[[remesh]]", "moves vorticity to the nodes of a lattice during the run", &remesh_options(), &remesh},
       {"split_cores", "[[split_cores]]", "splits wide vortex cores during the run", &core_splitting_options(), &split},
       {"outflow", "[[outflow]]", "removes vortices and tracers downstream", &outflow_options(), &outflow},
       {"dye", "[[dye]]", "releases tracers during the run", &dye_options(), &dye},
       {"output", "[output]", "output files and their intervals", &output_options(), &output},
       {"minimise", "[minimise]", "energy minimisation before the run", &minimise_options(), &minimise},
       {"equilibrate", "[equilibrate]", "a thermostat before the run", &equilibration_options(), &bath},
       {"barostat", "[[barostat]]", "a constant pressure by stretching the box", &barostat_options(), &barostat},
       {"events", "[[events]]", "changes at a time of the run", &event_options(), &event},
       {"relaxation", "[relaxation]", "vortices in 3D: aligns vorticity with the curl of the flow",
        &relaxation_options(), &relaxation},
       {"sweep", "[sweep]", "runs for several values of keys, and several seeds", &sweep, nullptr},
       {"sweep.pictures", "[[sweep.pictures]]", "a picture of all runs of a sweep", &sweep_picture_options(),
        &picture}});
  return all;
}

}  // namespace

std::vector<ScenarioTable> const& scenario_tables() { return once<make_tables>(); }

}  // namespace boltzmann
