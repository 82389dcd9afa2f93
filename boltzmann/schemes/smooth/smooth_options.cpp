// The keys of smooth schemes and of rezoning.
#include <boltzmann/core/once.hpp>
#include <boltzmann/schemes/smooth/smooth_options.hpp>

#include <limits>

namespace boltzmann {
namespace {

using namespace option;

OptionTable const& artificial_viscosity_options() {
  static OptionTable const all =
      OptionTable()
          .add("alpha", &ArtificialViscosity::alpha, number(dimensions::none, not_negative), "for weak shocks")
          .add("beta", &ArtificialViscosity::beta, number(dimensions::none, not_negative),
               "against particles that run through each other")
          .add("balsara", &ArtificialViscosity::balsara, flag(), "less of it in shear");
  return all;
}

OptionTable const& variable_range_options() {
  static OptionTable const all =
      OptionTable()
          .add("spacings", &VariableRange::spacings, number(dimensions::none, positive),
               "range = spacings (mass / density)^(1/D)")
          .add("shortest", &VariableRange::shortest, number(dimensions::length, not_negative), "no range is shorter")
          .add("longest", &VariableRange::longest, number(dimensions::length, positive), "none is longer",
               "four times the longest at the start, or what the box allows");
  return all;
}

OptionTable make_smooth_options() {
  using S = SmoothOptions;
  OptionTable all;
  all.add("weight", &S::weight, weight_words(), "how a particle is spread over its range");
  all.add(
      "density", &S::density, density_from_words(),
      "the sum of the weights around a particle, or it evolves from `density` of the ensembles on; `\"volumes\"` for "
      "matter of different densities in contact");
  all.add("mean_density", &S::mean_density, mean_density_words(), "in gradients");
  all.add("heating", &S::heating, heating_words(),
          "who is heated by the work of pressure on a pair: both by the same, or each by its own");
  all.add("artificial_viscosity", &S::artificial_viscosity, artificial_viscosity_options(),
          "{ alpha = 1, beta = 2, balsara = false }", "for shocks; `{}` has these values", "none");
  all.add("variable_range", &S::variable_range, variable_range_options(), "{ spacings = 3 }",
          "ranges that follow the density, range = spacings (mass / density)^(1/D), between `shortest` and `longest`",
          "each particle keeps its own");
  all.add("skin", &S::skin, number(dimensions::length, not_negative),
          "by how much neighbour lists reach further than the ranges", "chosen for you");
  all.add_said("rezone", "a table, or several as `[[smooth.rezone]]`",
               "particles that are split and merged while the run goes on", "none");
  return all;
}

OptionKind density_or_volume() {
  OptionKind kind = number(of_what_is_shown, not_negative);
  kind.words = {"a density, or a volume"};
  return kind;
}

OptionTable make_rezone_options() {
  using R = RezoneOptions;
  OptionTable all;
  all.add("every", &R::every, whole(1, std::numeric_limits<double>::infinity()),
          "so many steps from one rezoning to the next");
  all.add_said("on", ensembles(), "who is rezoned", "all that are smooth");
  all.add("by", &R::policy, &Rezoning::by, rezone_by_words(),
          "density, or mass / density, the space that a particle takes");
  all.add("split_above", &R::policy, &Rezoning::split_above, density_or_volume(),
          "split those whose density, or volume, is larger; 0 splits all", "nothing is split");
  all.add("merge_below", &R::policy, &Rezoning::merge_below, density_or_volume(),
          "merge those whose density, or volume, is smaller, each with its nearest", "nothing merges");
  all.add("smallest_mass", &R::policy, &Rezoning::smallest_mass, number(dimensions::mass, not_negative),
          "no half is lighter; needed to split by density");
  all.add("largest_mass", &R::policy, &Rezoning::largest_mass, number(dimensions::mass, positive),
          "no sum is heavier; needed to merge by density", "no limit");
  all.add("merge_within", &R::policy, &Rezoning::merge_within, number(dimensions::none, {0, 1, true}),
          "how near two must be to merge, in ranges of the smaller");
  all.add("low", &R::low, vector(dimensions::length), "with `high` the corners of a block: only particles in it",
          "everywhere");
  all.add("high", &R::high, vector(dimensions::length), "the other corner", "everywhere");
  all.at("every").needed = "20";
  return all;
}

}  // namespace

OptionTable const& smooth_options() { return once<make_smooth_options>(); }
OptionTable const& rezone_options() { return once<make_rezone_options>(); }

}  // namespace boltzmann
