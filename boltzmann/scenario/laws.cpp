// From the word of a law to its kernels, and why a class can't have it.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/scenario/law_binding.hpp>
#include <boltzmann/scenario/laws.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {
namespace {

BoundLaw bind(LawInfo const& law, LawParameters const& parameters, int dimension,
              std::vector<LawBinder> const& binders = law_binders()) {
  for (auto const& binder : binders)
    if (binder.name == law.name) return binder.bind({dimension, parameters});
  throw Error(fmt::format("law '{}' can be used in programs only, not in scenarios", law.name));
}

/// Why particles of this ensemble can't take the part of `least` in the law; empty if nothing is known against it.
std::string missing(LawInfo const& law, std::string_view least, AnyEnsemble const& ensemble, bool is_target) {
  ParticleClass const* wanted = find_class(least);
  ParticleClass const* actual = find_class(ensemble.class_name());
  int const dimension = ensemble.dimension();
  if (dimension < law.least_dimension || dimension > law.greatest_dimension)
    return law.least_dimension == law.greatest_dimension
               ? fmt::format("law '{}' exists in {}D only; the box is {}D", law.name, law.least_dimension, dimension)
               : fmt::format("law '{}' exists in {}D to {}D; the box is {}D", law.name, law.least_dimension,
                             law.greatest_dimension, dimension);
  if (!wanted || !actual) return "";
  if (is_target && wanted->classical != actual->classical)
    return fmt::format("law '{}' gives {}; particles of class {} are moved by {}", law.name,
                       wanted->classical ? "a force" : "the velocity of a flow", ensemble.class_name(),
                       actual->classical ? "forces" : "a flow");
  ClassVariant const* variant = wanted->in(dimension);
  if (!variant) return "";
  for (auto const& field : variant->fields) {
    Field const* own = ensemble.find_field(field.name);
    if (own && own->dimension == field.dimension && own->components == field.components) continue;
    if (own)
      return fmt::format("law '{}' needs a {} that is a {}; that of class {} is a {}", law.name, field.name,
                         name_of(field.dimension), ensemble.class_name(), name_of(own->dimension));
    std::vector<std::string> with;
    for (auto const& candidate : particle_classes())
      if (ClassVariant const* in_space = candidate.in(dimension))
        for (auto const& f : in_space->fields)
          if (f.name == field.name && f.dimension == field.dimension) with.push_back(candidate.name);
    return fmt::format("law '{}' needs {}; class {} has none; classes with one: {}", law.name, with_article(field.name),
                       ensemble.class_name(), with.empty() ? "none" : join(with));
  }
  return "";
}

void require(LawInfo const& law, AnyEnsemble const& ensemble, bool is_target) {
  std::string const why = missing(law, is_target ? law.target : law.source, ensemble, is_target);
  if (!why.empty()) throw Error(why);
}

Error unfit(LawInfo const& law, AnyEnsemble const& ensemble) {
  return Error(fmt::format("law '{}' can't act on class {}; its least class is {}", law.name, ensemble.class_name(),
                           law.target));
}

void install_one_way(PairScheme& scheme, LawInfo const& law, BoundLaw const& bound, AnyEnsemble& target,
                     AnyEnsemble& source, double cutoff) {
  require(law, target, true);
  require(law, source, false);
  for (auto const& choice : bound.pairs)
    if (choice.target(target) && choice.source(source)) {
      scheme.add_pairs(target, source, choice.kernels, bound.law, bound.traits, cutoff);
      return;
    }
  throw Error(fmt::format("law '{}' between class {} and class {} can't be run from a scenario", law.name,
                          target.class_name(), source.class_name()));
}

}  // namespace

std::vector<LawInfo> const& scenario_laws() {
  static std::vector<LawInfo> const all = [] {
    using enum AllowedRange;
    std::vector<LawInfo> laws = law_catalogue();
    laws.push_back({.name = "pendulum-coupling",
                    .kind = LawKind::pair,
                    .doc = "a spring from bob to bob; its two torques differ, the energy is conserved",
                    .formula = "stiffness (d - rest_length)^2 / 2, d the distance of the bobs",
                    .target = "Pendulum",
                    .source = "Pendulum",
                    .least_dimension = 1,
                    .greatest_dimension = 1,
                    .symmetry = Symmetry::general,
                    .has_energy = true,
                    .velocity_dependent = false,
                    .header = "boltzmann/laws/pendulum.hpp",
                    .type = "PendulumCoupling",
                    .parameters = {{"stiffness", dimensions::spring_constant, "force constant", non_negative},
                                   {"rest_length", dimensions::length, "distance at which it neither pulls nor pushes",
                                    non_negative, false, "0"}}});
    laws.push_back({.name = "pendulum-gravity",
                    .kind = LawKind::external,
                    .doc = "the weight of a bob as a torque",
                    .formula = "m g l (1 - cos angle)",
                    .target = "Pendulum",
                    .source = "",
                    .least_dimension = 1,
                    .greatest_dimension = 1,
                    .symmetry = Symmetry::general,
                    .has_energy = true,
                    .velocity_dependent = false,
                    .header = "boltzmann/laws/pendulum.hpp",
                    .type = "PendulumGravity",
                    .parameters = {{"acceleration", dimensions::acceleration, "g, downwards", any}}});
    return laws;
  }();
  return all;
}

LawInfo const* find_law(std::string_view name) {
  for (auto const& law : scenario_laws())
    if (law.name == name) return &law;
  return nullptr;
}

void install_pairs(PairScheme& scheme, LawInfo const& law, LawParameters const& parameters, LawUse use, AnyEnsemble& a,
                   AnyEnsemble& b, double cutoff) {
  BoundLaw const bound = bind(law, parameters, a.dimension());
  if (use == LawUse::between && !bound.one_way) {
    // Both ways or none: the second must be possible before the first is installed.
    require(law, a, true);
    require(law, b, false);
    require(law, b, true);
    require(law, a, false);
    install_one_way(scheme, law, bound, a, b, cutoff);
    install_one_way(scheme, law, bound, b, a, cutoff);
    return;
  }
  install_one_way(scheme, law, bound, a, use == LawUse::internal ? a : b, cutoff);
}

void install_connections(PairScheme& scheme, LawInfo const& law, LawParameters const& parameters, AnyEnsemble& ensemble,
                         std::vector<Connection> const& connections) {
  require(law, ensemble, true);
  require(law, ensemble, false);
  BoundLaw const bound = bind(law, parameters, ensemble.dimension());
  for (auto const& choice : bound.connections)
    if (choice.ensemble(ensemble))
      return scheme.add_connections(ensemble, connections, choice.kernels, bound.law, bound.traits);
  throw unfit(law, ensemble);
}

void install_external(PairScheme& scheme, LawInfo const& law, LawParameters const& parameters, AnyEnsemble& ensemble,
                      std::vector<std::uint32_t> const* only) {
  require(law, ensemble, true);
  BoundLaw const bound = bind(law, parameters, ensemble.dimension());
  for (auto const& choice : bound.externals)
    if (choice.ensemble(ensemble)) return scheme.add_external(ensemble, choice.kernels, bound.law, bound.traits, only);
  throw unfit(law, ensemble);
}

void install_external(SmoothScheme& scheme, LawInfo const& law, LawParameters const& parameters,
                      AnyEnsemble& ensemble) {
  require(law, ensemble, true);
  auto const& binders = smooth_law_binders();
  if (std::none_of(binders.begin(), binders.end(), [&](LawBinder const& binder) { return binder.name == law.name; })) {
    std::vector<std::string> names;
    for (auto const& binder : binders) names.emplace_back(binder.name);
    throw Error(
        fmt::format("law '{}' does not act on smooth particles; from outside there are {}", law.name, join(names)));
  }
  BoundLaw const bound = bind(law, parameters, ensemble.dimension(), binders);
  for (auto const& choice : bound.externals)
    if (choice.ensemble(ensemble)) return scheme.add_external(ensemble, choice.kernels, bound.law);
  throw unfit(law, ensemble);
}

}  // namespace boltzmann
