// Selects the kernels of a law by name, and explains why a class can't have it.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/scenario/law_binding.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/scenario/single_kernels.hpp>

#include <fmt/format.h>

namespace boltzmann {
namespace {

/// Why particles of this ensemble lack a field of `least` that the law needs; empty if they do not.
std::string missing(LawInfo const& law, std::string_view least, AnyEnsemble const& ensemble, bool is_target) {
  ParticleClass const* wanted = find_class(least);
  ParticleClass const* actual = find_class(ensemble.class_name());
  int const dimension = ensemble.dimension();
  if (dimension < law.least_dimension || dimension > law.greatest_dimension)
    return law.least_dimension == law.greatest_dimension
               ? fmt::format("law '{}' exists in {}D only; the box is {}D", law.name, law.least_dimension, dimension)
               : fmt::format("law '{}' exists in {}D to {}D; the box is {}D", law.name, law.least_dimension,
                             law.greatest_dimension, dimension);
  if (!wanted) return "";
  // Classes derived by a scenario are not in the table.
  bool const classical = actual ? actual->classical : ensemble.find_field("mass") && ensemble.find_field("velocity");
  if (is_target && wanted->classical != classical)
    return fmt::format("law '{}' gives {}; particles of class {} are moved by {}", law.name,
                       wanted->classical ? "a force" : "the velocity of a flow", ensemble.class_name(),
                       classical ? "forces" : "a flow");
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

/// Enables single precision for sums over all pairs of a law. Throws Error if it is not available.
void sum_in_single_precision(LawInfo const& law, BoundLaw& bound, double cutoff) {
  auto const& kernels =
      for_instruction_set([](auto set) -> SingleKernels const& { return single_kernels<decltype(set)::value>(); });
  bool const algebraic = law.name == AlgebraicBiotSavart::text.name;
  if (!algebraic && law.name != BiotSavart::text.name)
    throw Error(fmt::format("precision: law '{}' has no single precision; laws with it: {}, {}", law.name,
                            BiotSavart::text.name, AlgebraicBiotSavart::text.name));
  if (cutoff != no_cutoff) throw Error("precision: single precision is for sums over all pairs; leave out the cut-off");
  auto const& of_law = algebraic ? kernels.algebraic : kernels.plain;
  for (std::size_t k = 0; k < bound.pairs.size(); ++k)
    bound.pairs[k].kernels.all = of_law.at(k), bound.pairs[k].kernels.few = nullptr;
}

Error unfit(LawInfo const& law, AnyEnsemble const& ensemble) {
  if (law.target == "Tracer" && static_cast<int>(ensemble.influence_size()) > ensemble.dimension())
    return Error(fmt::format(
        "law '{}' can't act on class {}, whose vorticity is stretched: the stream has vorticity, too, which "
        "vortices would bend; in 3D classes Tracer and Vortex have it",
        law.name, ensemble.class_name()));
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

LawInfo const* find_law(std::string_view name) {
  for (auto const& law : scenario_laws())
    if (law.name == name) return &law;
  return nullptr;
}

LawInfo const& law_info(std::string_view name) {
  if (LawInfo const* law = find_law(name)) return *law;
  std::vector<std::string> names;
  for (auto const& law : scenario_laws()) names.emplace_back(law.name);
  throw Error(fmt::format("unknown law '{}'{}", name, choices(name, names, "there are", "bzm list laws")));
}

void install_pairs(PairScheme& scheme, LawInfo const& law, ParameterValues const& parameters, LawUse use,
                   AnyEnsemble& a, AnyEnsemble& b, double cutoff, bool single) {
  BoundLaw bound = law.bind(parameters, a.dimension());
  if (single) sum_in_single_precision(law, bound, cutoff);
  if (use == LawUse::between && !bound.one_way) {
    // Both directions or none: check the second before the first is installed.
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

void install_connections(PairScheme& scheme, LawInfo const& law, ParameterValues const& parameters,
                         AnyEnsemble& ensemble, std::vector<Connection> const& connections) {
  require(law, ensemble, true);
  require(law, ensemble, false);
  BoundLaw const bound = law.bind(parameters, ensemble.dimension());
  for (auto const& choice : bound.connections)
    if (choice.ensemble(ensemble))
      return scheme.add_connections(ensemble, connections, choice.kernels, bound.law, bound.traits);
  throw unfit(law, ensemble);
}

void install_external(PairScheme& scheme, LawInfo const& law, ParameterValues const& parameters, AnyEnsemble& ensemble,
                      std::vector<std::uint32_t> const* only) {
  require(law, ensemble, true);
  BoundLaw const bound = law.bind(parameters, ensemble.dimension());
  for (auto const& choice : bound.externals)
    if (choice.ensemble(ensemble)) return scheme.add_external(ensemble, choice.kernels, bound.law, bound.traits, only);
  throw unfit(law, ensemble);
}

void change_external(PairScheme& scheme, std::size_t number, LawInfo const& law, ParameterValues const& parameters) {
  BoundLaw const bound = law.bind(parameters, scheme.box().dimension());
  scheme.replace_external(number, bound.law, bound.traits);
}

void install_external(SmoothScheme& scheme, LawInfo const& law, ParameterValues const& parameters,
                      AnyEnsemble& ensemble) {
  require(law, ensemble, true);
  if (!law.bind_on_smooth) {
    std::vector<std::string> names;
    for (auto const& other : scenario_laws())
      if (other.bind_on_smooth) names.emplace_back(other.name);
    throw Error(
        fmt::format("law '{}' does not act on smooth particles; external laws that do are {}", law.name, join(names)));
  }
  BoundLaw const bound = law.bind_on_smooth(parameters, ensemble.dimension());
  for (auto const& choice : bound.externals)
    if (choice.ensemble(ensemble)) return scheme.add_external(ensemble, choice.kernels, bound.law);
  throw unfit(law, ensemble);
}

}  // namespace boltzmann
