// The members of smooth schemes and of rezoning with their keys.
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
  all.add_of<S>(
      "weight", [](S& s) -> OptionPlace { return named_value(&s.weight, weight_words()); },
      word(weight_words().names()), "how a particle is spread over its range");
  all.add_of<S>(
      "density", [](S& s) -> OptionPlace { return named_value(&s.density, density_from_words()); },
      word(density_from_words().names()),
      "the sum of the weights around a particle, or it evolves from `density` of the ensembles on; `\"volumes\"` for "
      "matter of different densities in contact");
  all.add_of<S>(
      "mean_density", [](S& s) -> OptionPlace { return named_value(&s.mean_density, mean_density_words()); },
      word(mean_density_words().names()), "in gradients");
  all.add_of<S>(
      "heating", [](S& s) -> OptionPlace { return named_value(&s.heating, heating_words()); },
      word(heating_words().names()),
      "who is heated by the work of pressure on a pair: both by the same, or each by its own");
  all.add_of<S>(
      "artificial_viscosity",
      [](S& s) -> OptionPlace {
        return OptionGroup{&artificial_viscosity_options(),
                           [&s]() -> void* { return &s.artificial_viscosity.emplace(); }};
      },
      group("{ alpha = 1, beta = 2, balsara = false }"), "for shocks; `{}` has these values", "none");
  all.add_of<S>(
      "variable_range",
      [](S& s) -> OptionPlace {
        return OptionGroup{&variable_range_options(), [&s]() -> void* { return &s.variable_range.emplace(); }};
      },
      group("{ spacings = 3 }"),
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
  auto const policy = [](double Rezoning::*member) {
    return [member](R& r) -> OptionPlace { return &(r.policy.*member); };
  };
  OptionTable all;
  all.add("every", &R::every, whole(1, std::numeric_limits<double>::infinity()),
          "so many steps from one rezoning to the next");
  all.add_said("on", "the name of an ensemble, or a list", "who is rezoned", "all that are smooth");
  all.add_of<R>(
      "by", [](R& r) -> OptionPlace { return named_value(&r.policy.by, rezone_by_words()); },
      word(rezone_by_words().names()), "density, or mass / density, the space that a particle takes");
  all.add_of<R>("split_above", policy(&Rezoning::split_above), density_or_volume(),
                "split those whose density, or volume, is larger; 0 splits all", "nothing is split");
  all.add_of<R>("merge_below", policy(&Rezoning::merge_below), density_or_volume(),
                "merge those whose density, or volume, is smaller, each with its nearest", "nothing merges");
  all.add_of<R>("smallest_mass", policy(&Rezoning::smallest_mass), number(dimensions::mass, not_negative),
                "no half is lighter; needed to split by density");
  all.add_of<R>("largest_mass", policy(&Rezoning::largest_mass), number(dimensions::mass, positive),
                "no sum is heavier; needed to merge by density", "no limit");
  all.add_of<R>("merge_within", policy(&Rezoning::merge_within), number(dimensions::none, {0, 1, true}),
                "how near two must be to merge, in ranges of the smaller");
  all.add_said("low", "a length along each axis", "with `high` the corners of a block: only particles in it",
               "everywhere");
  all.add_said("high", "a length along each axis", "the other corner", "everywhere");
  all.at("every").needed = "20";
  return all;
}

}  // namespace

OptionTable const& smooth_options() { return once<make_smooth_options>(); }
OptionTable const& rezone_options() { return once<make_rezone_options>(); }

}  // namespace boltzmann
