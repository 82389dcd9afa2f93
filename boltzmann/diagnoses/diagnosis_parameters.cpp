// The members of DiagnosisParameters with their keys.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/diagnosis_parameters.hpp>

namespace boltzmann {

int dimension_of(DiagnosisParameters const& parameters) {
  if (parameters.available.empty()) throw Error("a diagnosis needs an ensemble; the simulation has none");
  return parameters.available.front()->dimension();
}

OptionTable const& diagnosis_options() {  // long: a table, a row for each key
  using namespace option;
  using P = DiagnosisParameters;
  static OptionTable const table = [] {
    OptionTable all;
    all.add("ensembles", &P::ensembles, ensembles(), "ensembles, with columns for each", "the whole system");
    all.add("label", &P::label, text(), "name of the columns", "that of the ensemble");
    all.add("particles", &P::particles, particles(), "a group of particles of one ensemble, as in `[[ensembles.set]]`",
            "all");
    all.add("partners", &P::partners, particles("numbers, or a [formula](../formulas.md) that is true for them"),
            "particles of the same ensemble that form pairs with the group: `\"charge > 0\"`", "the group itself");
    all.add("similar_velocity", &P::similar_velocity, vector(dimensions::velocity),
            "select a group by its velocity at the first sample", "all");
    all.add("tolerance", &P::tolerance, number(dimensions::velocity, not_negative), "tolerance of that velocity");
    all.add("subtract_drift", &P::subtract_drift, flag(), "subtract the mean velocity and divide by N - 1");
    all.add("about_centre_of_mass", &P::about_centre_of_mass, flag(),
            "about the centre of mass; else about the origin");
    all.add("quantity", &P::quantity, name_of_quantity(), "the quantity");
    all.add("formula", &P::formula, text(), "a [formula](../formulas.md)");
    all.add_said("parameters", "a table of quantities", "constants of the formula: `{ depth = \"0.1 eV\" }`", "none");
    all.add_said("where", "a table of [formulas](../formulas.md)",
                 "named parts of the formula: `{ e = \"0.5*mass*speed^2\" }`", "none");
    all.add("mode", &P::mode, wholes(-1e9, 1e9), "periods in the box along each axis");
    all.add("axis", &P::axis, axis_word(), "axis of the measurement");
    all.add("modes", &P::modes, whole(1, __builtin_inf()), "number of waves", "all, up to 256");
    all.add("by", &P::by, word({"direct", "mesh"}),
            "`\"direct\"`: exact sums; `\"mesh\"`: all at once, with errors of 1e-5 of the particles, faster for many "
            "waves",
            "`\"direct\"`");
    all.add("weight", &P::weight, weight_words(), "kernel of the averages");
    all.add("range", &P::range, number(dimensions::length, positive), "range of the kernel", "that of each particle");
    all.add("gamma", &P::gamma, number(dimensions::none, {1, __builtin_inf(), true}), "ratio of specific heats",
            "1 + 2/D");
    all.add("conductivity", &P::conductivity,
            number_by_space(dimensions::energy * dimensions::length * dimensions::length /
                                (dimensions::time * dimensions::temperature),
                            -1, positive),
            "conductivity of the material");
    all.add("since", &P::since, number(dimensions::time), "start of the averages", "the start");
    all.add("from", &P::from, number(dimensions::length), "initial lower end of the slab", "the end of the box");
    all.add("to", &P::to, number(dimensions::length), "initial upper end of the slab", "the end of the box");
    all.add("count", &P::count, whole(1, 100'000), "number");
    all.add("end", &P::end, word({"low", "high"}), "end of the axis from which a shock comes",
            "the one whose wall runs into the matter");
    all.add("margin", &P::margin, number(dimensions::length, positive),
            "distance left out at the front and at the end of the matter", "5 % of the matter");
    all.add("near", &P::near, number(dimensions::length, positive), "near end of the window behind the front",
            "two margins behind it");
    all.add("far", &P::far, number(dimensions::length, positive), "far end of the window",
            "a margin before the driven end");
    all.add("stream", &P::stream, vector(dimensions::velocity), "velocity of the undisturbed flow", "none");
    all.add("length", &P::length, number(dimensions::length, positive), "length for drag and lift coefficients",
            "no coefficients");
    all.add("order", &P::order, whole(1, 16), "order of the harmonics");
    all.add("columns", &P::columns, name_of_quantity(),
            "columns of diagnoses above, separated by commas: `\"pressure, temperature\"`", "all");
    all.add("every", &P::every, whole(1, 1e9), "steps between samples");
    all.add("origins", &P::origins, whole(1, 10'000), "number of time origins kept at once");
    return all;
  }();
  return table;
}

}  // namespace boltzmann
