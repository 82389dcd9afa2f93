// The members of DiagnosisParameters with their keys.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/diagnosis_parameters.hpp>

namespace boltzmann {

int dimension_of(DiagnosisParameters const& parameters) {
  if (parameters.available.empty()) throw Error("a diagnosis needs an ensemble to look at; the simulation has none");
  return parameters.available.front()->dimension();
}

OptionTable const& diagnosis_options() {  // long: a table, a row for each key
  using namespace option;
  using P = DiagnosisParameters;
  static OptionTable const table = [] {
    OptionTable all;
    all.add("ensembles", &P::ensembles, ensembles(), "one set of columns for each of them", "the system as a whole");
    all.add("label", &P::label, text(), "what the columns are called", "by the ensemble");
    all.add("particles", &P::particles, particles(), "a group of one ensemble, as in `[[ensembles.set]]`", "all");
    all.add("partners", &P::partners, particles("numbers, or a [formula](#formulas) that is true for them"),
            "those of the same ensemble that the group's pairs are with: `\"charge > 0\"`", "the group itself");
    all.add("similar_velocity", &P::similar_velocity, vector(dimensions::velocity),
            "a group: those of about this velocity at the first look", "all");
    all.add("tolerance", &P::tolerance, number(dimensions::velocity, not_negative),
            "within which a velocity is similar");
    all.add("subtract_drift", &P::subtract_drift, flag(), "without the mean velocity, over N - 1");
    all.add("about_centre_of_mass", &P::about_centre_of_mass, flag(), "else about the origin");
    all.add("quantity", &P::quantity, name_of_quantity(), "what is looked at");
    all.add("formula", &P::formula, text(), "a [formula](#formulas)");
    all.add_said("parameters", "a table of quantities", "numbers of the formula: `{ depth = \"0.1 eV\" }`", "none");
    all.add_said("where", "a table of [formulas](#formulas)",
                 "parts of the formula with names of their own: `{ e = \"0.5*mass*speed^2\" }`", "none");
    all.add("mode", &P::mode, wholes(-1e9, 1e9), "periods in the box along each axis");
    all.add("axis", &P::axis, axis_word(), "along which one looks");
    all.add("modes", &P::modes, whole(1, __builtin_inf()), "how many waves are kept",
            "as many as there are, up to 256");
    all.add(
        "by", &P::by, word({"direct", "mesh"}),
        "`\"direct\"`: wave by wave, exact; `\"mesh\"`: all at once, each sum to 1e-5 of the particles, for many of "
        "them",
        "`\"direct\"`");
    all.add("weight", &P::weight, weight_words(), "of the averages");
    all.add("range", &P::range, number(dimensions::length, positive), "of the weight", "each particle's own");
    all.add("gamma", &P::gamma, number(dimensions::none, {1, __builtin_inf(), true}), "the ratio of specific heats",
            "1 + 2/D");
    all.add("conductivity", &P::conductivity,
            number_by_space(dimensions::energy * dimensions::length * dimensions::length /
                                (dimensions::time * dimensions::temperature),
                            -1, positive),
            "of the material for heat");
    all.add("since", &P::since, number(dimensions::time), "when means begin", "the start");
    all.add("from", &P::from, number(dimensions::length), "where the slab begins at the start", "the end of the box");
    all.add("to", &P::to, number(dimensions::length), "where it ends", "the end of the box");
    all.add("count", &P::count, whole(1, 100'000), "how many");
    all.add("end", &P::end, word({"low", "high"}), "of the axis, from which a shock comes",
            "the one whose wall runs into the matter");
    all.add("margin", &P::margin, number(dimensions::length, positive),
            "what is left out beside the front and at the end of the matter", "5 % of the matter");
    all.add("near", &P::near, number(dimensions::length, positive), "where the window behind the front begins",
            "two margins behind it");
    all.add("far", &P::far, number(dimensions::length, positive), "where it ends", "a margin before the driven end");
    all.add("stream", &P::stream, vector(dimensions::velocity), "velocity of the undisturbed flow", "none");
    all.add("length", &P::length, number(dimensions::length, positive), "of drag and lift coefficients",
            "no coefficients");
    all.add("order", &P::order, whole(1, 16), "of the harmonics");
    all.add("columns", &P::columns, name_of_quantity(), "of diagnoses above, with commas: `\"pressure, temperature\"`",
            "all");
    all.add("every", &P::every, whole(1, 1e9), "steps from one look to the next");
    all.add("origins", &P::origins, whole(1, 10'000), "how many looks are remembered at a time to compare with");
    return all;
  }();
  return table;
}

}  // namespace boltzmann
