// Laws: the shipped laws by name, for code that learns the law at run time.
#pragma once

#include <boltzmann/laws/catalogue.hpp>
#include <boltzmann/scenario/classes.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boltzmann {

/// The laws that scenarios can name: the catalogue, and those of pendulums.
std::vector<LawInfo> const& scenario_laws();
/// nullptr if there is none of that name.
LawInfo const* find_law(std::string_view name);

/// Parameters of a law by name, in the simulation's base; a vector has one number for each dimension.
using LawParameters = std::vector<std::pair<std::string, std::vector<double>>>;

/// How a pair law acts.
enum class LawUse { internal, between, one_way };

/// Installs a pair law in a scheme: within `a` (internal), between two ensembles, or of `b` on `a` (one_way). Error,
/// "law 'coulomb' needs a charge; class Newton has none; classes with one: Coulomb", if the classes can't have it.
void install_pairs(PairScheme& scheme, LawInfo const& law, LawParameters const& parameters, LawUse use, AnyEnsemble& a,
                   AnyEnsemble& b, double cutoff);
/// A pair law over fixed pairs of one ensemble. Errors as above, and those of connected_pairs().
void install_connections(PairScheme& scheme, LawInfo const& law, LawParameters const& parameters, AnyEnsemble& ensemble,
                         std::vector<Connection> const& connections);
/// An external law on all particles or the chosen ones. Errors as above.
void install_external(PairScheme& scheme, LawInfo const& law, LawParameters const& parameters, AnyEnsemble& ensemble,
                      std::vector<std::uint32_t> const* only);
/// The same on smooth particles.
void install_external(SmoothScheme& scheme, LawInfo const& law, LawParameters const& parameters, AnyEnsemble& ensemble);

}  // namespace boltzmann
