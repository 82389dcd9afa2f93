// Laws: the shipped laws by name, for code that selects the law at run time.
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
  external,  ///< external: law(p)
};

struct BoundLaw;

/// A shipped law: the description of its struct, its header, and its construction from parameters.
struct LawInfo : LawText {
  LawKind kind;
  Symmetry symmetry;  ///< of pair laws; one_way is always possible
  bool velocity_dependent;
  std::string header;  ///< for programs
  std::string type;    ///< name in a program: "LennardJones", "gravity"
  std::vector<Parameter> parameters;
  BoundLaw (*bind)(ParameterValues const& values, int dimension);
  BoundLaw (*bind_on_smooth)(ParameterValues const& values,
                             int dimension) = nullptr;  ///< null: it does not act on smooth particles
};

/// The laws of shipped_laws.list, which scenarios can name, pair laws first.
std::vector<LawInfo> const& scenario_laws();
/// nullptr for an unknown name.
LawInfo const* find_law(std::string_view name);
/// The same; throws Error with the most similar name if it is unknown.
LawInfo const& law_info(std::string_view name);

/// The direction in which a pair law acts.
enum class LawUse { internal, between, one_way };

/// Installs a pair law in a scheme: within `a` (internal), between two ensembles, or from `b` on `a` (one_way);
/// `single`: summed in single precision. Throws Error, "law 'coulomb' needs a charge; class Newton has none; classes
/// with one: Coulomb", if it does not fit the classes.
void install_pairs(PairScheme& scheme, LawInfo const& law, ParameterValues const& parameters, LawUse use,
                   AnyEnsemble& a, AnyEnsemble& b, double cutoff, bool single = false);
/// Installs a pair law over fixed pairs of one ensemble. Throws Error as above, and those of connected_pairs().
void install_connections(PairScheme& scheme, LawInfo const& law, ParameterValues const& parameters,
                         AnyEnsemble& ensemble, std::vector<Connection> const& connections);
/// Installs an external law on all particles or the selected ones. Throws Error as above.
void install_external(PairScheme& scheme, LawInfo const& law, ParameterValues const& parameters, AnyEnsemble& ensemble,
                      std::vector<std::uint32_t> const* only);
/// Changes the parameters of an installed law, by its index among those of the scheme.
void change_external(PairScheme& scheme, std::size_t number, LawInfo const& law, ParameterValues const& parameters);
/// The same on smooth particles.
void install_external(SmoothScheme& scheme, LawInfo const& law, ParameterValues const& parameters,
                      AnyEnsemble& ensemble);

}  // namespace boltzmann
