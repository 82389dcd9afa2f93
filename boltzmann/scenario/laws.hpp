// Laws: the shipped laws by name, for code that learns the law at run time.
#pragma once

#include <boltzmann/laws/interaction.hpp>

#include <boltzmann/scenario/classes.hpp>
#include <boltzmann/scenario/law_parameters.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boltzmann {

enum class LawKind {
  pair,      ///< between two particles: law(p, q)
  external,  ///< from outside: law(p)
};

struct BoundLaw;

/// A shipped law: what its struct says of itself, where it stands, and how it is made from its parameters.
struct LawInfo : LawText {
  LawKind kind;
  Symmetry symmetry;  ///< of pair laws; one_way can always be asked for
  bool velocity_dependent;
  std::string header;  ///< for programs
  std::string type;    ///< what a program writes: "LennardJones", "gravity"
  std::vector<Parameter> parameters;
  BoundLaw (*bind)(ParameterValues const& values, int dimension);
  BoundLaw (*bind_on_smooth)(ParameterValues const& values,
                             int dimension) = nullptr;  ///< none: it does not act on smooth particles
};

/// Those of shipped_laws.list: the laws that scenarios can name, pair laws first.
std::vector<LawInfo> const& scenario_laws();
/// nullptr if there is none of that name.
LawInfo const* find_law(std::string_view name);
/// The same; Error with the nearest name if there is none.
LawInfo const& law_info(std::string_view name);

/// How a pair law acts.
enum class LawUse { internal, between, one_way };

/// Installs a pair law in a scheme: within `a` (internal), between two ensembles, or of `b` on `a` (one_way); `single`:
/// summed in single precision. Error,
/// "law 'coulomb' needs a charge; class Newton has none; classes with one: Coulomb", if the classes can't have it.
void install_pairs(PairScheme& scheme, LawInfo const& law, ParameterValues const& parameters, LawUse use,
                   AnyEnsemble& a, AnyEnsemble& b, double cutoff, bool single = false);
/// A pair law over fixed pairs of one ensemble. Errors as above, and those of connected_pairs().
void install_connections(PairScheme& scheme, LawInfo const& law, ParameterValues const& parameters,
                         AnyEnsemble& ensemble, std::vector<Connection> const& connections);
/// An external law on all particles or the chosen ones. Errors as above.
void install_external(PairScheme& scheme, LawInfo const& law, ParameterValues const& parameters, AnyEnsemble& ensemble,
                      std::vector<std::uint32_t> const* only);
/// Other parameters of one that is installed, by its number among those of the scheme.
void change_external(PairScheme& scheme, std::size_t number, LawInfo const& law, ParameterValues const& parameters);
/// The same on smooth particles.
void install_external(SmoothScheme& scheme, LawInfo const& law, ParameterValues const& parameters,
                      AnyEnsemble& ensemble);

}  // namespace boltzmann
