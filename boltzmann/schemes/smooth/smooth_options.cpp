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
          .add("alpha", &ArtificialViscosity::alpha, number(dimensions::none, not_negative),
               "linear term, for weak shocks")
          .add("beta", &ArtificialViscosity::beta, number(dimensions::none, not_negative),
               "quadratic term, against interpenetration")
          .add("balsara", &ArtificialViscosity::balsara, flag(), "reduce it in shear (Balsara)");
  return all;
}

OptionTable const& variable_range_options() {
  static OptionTable const all =
      OptionTable()
          .add("spacings", &VariableRange::spacings, number(dimensions::none, positive),
               "range = spacings (mass / density)^(1/D)")
          .add("shortest", &VariableRange::shortest, number(dimensions::length, not_negative), "shortest range")
          .add("longest", &VariableRange::longest, number(dimensions::length, positive), "longest range",
               "four times the longest initial one, limited by the box");
  return all;
}

OptionTable make_smooth_options() {
  using S = SmoothOptions;
  OptionTable all;
  all.add("weight", &S::weight, weight_words(), "kernel, the distribution of a particle over its range");
  all.add("density", &S::density, density_from_words(),
          "sum of the kernel at a particle, or evolved from the ensembles' `density`; `\"volumes\"` for contacts of "
          "different densities");
  all.add("mean_density", &S::mean_density, mean_density_words(), "correction of gradients");
  all.add("heating", &S::heating, heating_words(),
          "heating by the pressure work of a pair: shared equally, or by each particle's own pressure");
  all.add("artificial_viscosity", &S::artificial_viscosity, artificial_viscosity_options(),
          "{ alpha = 1, beta = 2, balsara = false }", "artificial viscosity, for shocks; `{}` sets these values",
          "none");
  all.add("variable_range", &S::variable_range, variable_range_options(), "{ spacings = 3 }",
          "adaptive ranges spacings (mass / density)^(1/D), between `shortest` and `longest`", "constant ranges");
  all.add("skin", &S::skin, number(dimensions::length, not_negative), "reach of neighbour lists beyond the ranges",
          "automatic");
  all.add_said("rezone", "a table, or several as `[[smooth.rezone]]`", "splits and merges particles during the run",
               "none");
  return all;
}

OptionKind density_or_volume() {
  OptionKind kind = number(of_what_is_shown, not_negative);
  kind.words = {"criterion: density, or volume mass / density"};
  return kind;
}

OptionTable make_rezone_options() {
  using R = RezoneOptions;
  OptionTable all;
  all.add("every", &R::every, whole(1, std::numeric_limits<double>::infinity()), "steps between rezonings");
  all.add_said("on", ensembles(), "ensembles to rezone", "all smooth particles");
  all.add("by", &R::policy, &Rezoning::by, rezone_by_words(),
          "density, or mass / density, the space that a particle takes");
  all.add("split_above", &R::policy, &Rezoning::split_above, density_or_volume(),
          "split particles above this density or volume; 0: all", "no splits");
  all.add("merge_below", &R::policy, &Rezoning::merge_below, density_or_volume(),
          "merge particles below this density or volume with the nearest one", "no merges");
  all.add("smallest_mass", &R::policy, &Rezoning::smallest_mass, number(dimensions::mass, not_negative),
          "smallest mass after a split; needed to split by density");
  all.add("largest_mass", &R::policy, &Rezoning::largest_mass, number(dimensions::mass, positive),
          "largest mass after a merge; needed to merge by density", "no limit");
  all.add("merge_within", &R::policy, &Rezoning::merge_within, number(dimensions::none, {0, 1, true}),
          "largest distance for a merge, in ranges of the smaller particle");
  all.add("low", &R::low, vector(dimensions::length), "with `high`: only particles in this block", "everywhere");
  all.add("high", &R::high, vector(dimensions::length), "its upper edges", "everywhere");
  all.at("every").needed = "20";
  return all;
}

}  // namespace

OptionTable const& smooth_options() { return once<make_smooth_options>(); }
OptionTable const& rezone_options() { return once<make_rezone_options>(); }

}  // namespace boltzmann
