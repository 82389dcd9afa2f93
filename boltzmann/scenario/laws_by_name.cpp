// The laws of scenarios, with the description of each struct, its construction from parameters, and its rows.
#include <boltzmann/scenario/law_binding.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/schemes/smooth/force_on.hpp>

#include <shipped_laws.hpp>  // the headers of the list

#include <algorithm>

namespace boltzmann {
namespace {

template <class Law>
LawInfo describe(char const* header, char const* type, BoundLaw (*bind)(ParameterValues const&, int)) {
  return {Law::text,
          Law::text.source.empty() ? LawKind::external : LawKind::pair,
          symmetry_of<LawOf<Law>>(),
          depends_on_velocity<LawOf<Law>>(),
          header,
          Law::text.in_programs.empty() ? type : std::string(Law::text.in_programs),
          parameters_of<Law>(),
          bind};
}

/// The rows of the struct for the space's dimension; none if it has rows for other dimensions only.
template <template <int> class Law, template <int> class Rows, template <class> class As, int... D>
BoundLaw bind_in(ParameterValues const& values, int dimension) {
  BoundLaw bound{};
  ((dimension == D ? void(bound = bind_law<Rows<D>>(As<Law<D>>{made_from<Law<D>>(values)})) : void()), ...);
  return bound;
}
template <class Law>
using Itself = Law;

template <class Law, class Rows>
LawInfo shipped(char const* header, char const* type) {
  return describe<Law>(
      header, type, [](ParameterValues const& values, int) { return bind_law<Rows>(law_of(made_from<Law>(values))); });
}
template <template <int> class Law, template <int> class Rows, int... D>
LawInfo shipped(char const* header, char const* type) {
  return describe<Law<std::max({D...})>>(header, type, bind_in<Law, Rows, Itself, D...>);
}

LawInfo& entry(std::vector<LawInfo>& laws, std::string_view name) {
  return *std::find_if(laws.begin(), laws.end(), [&](LawInfo const& law) { return law.name == name; });
}
template <class Law, class Rows>
void on_smooth(std::vector<LawInfo>& laws) {
  entry(laws, Law::text.name).bind_on_smooth = [](ParameterValues const& values, int) {
    return bind_law<Rows>(ForceOn<Law>{made_from<Law>(values)});
  };
}
template <template <int> class Law, template <int> class Rows, int... D>
void on_smooth(std::vector<LawInfo>& laws) {
  entry(laws, Law<std::max({D...})>::text.name).bind_on_smooth = bind_in<Law, Rows, ForceOn, D...>;
}

}  // namespace

std::vector<LawInfo> const& scenario_laws() {
  static std::vector<LawInfo> const all = [] {
    std::vector<LawInfo> laws{
#define LAW(header, Law, Rows) shipped<Law, Rows>("boltzmann/laws/" #header ".hpp", #Law),
#define LAW_IN(header, Law, Rows, ...) shipped<Law, Rows, __VA_ARGS__>("boltzmann/laws/" #header ".hpp", #Law),
#define LAW_ON_SMOOTH(header, Law, Rows)
#define LAW_ON_SMOOTH_IN(header, Law, Rows, ...)
#include <boltzmann/scenario/shipped_laws.list>
#undef LAW
#undef LAW_IN
#undef LAW_ON_SMOOTH
#undef LAW_ON_SMOOTH_IN
    };
#define LAW(header, Law, Rows)
#define LAW_IN(header, Law, Rows, ...)
#define LAW_ON_SMOOTH(header, Law, Rows) on_smooth<Law, Rows>(laws);
#define LAW_ON_SMOOTH_IN(header, Law, Rows, ...) on_smooth<Law, Rows, __VA_ARGS__>(laws);
#include <boltzmann/scenario/shipped_laws.list>
#undef LAW
#undef LAW_IN
#undef LAW_ON_SMOOTH
#undef LAW_ON_SMOOTH_IN
    return laws;
  }();
  return all;
}

}  // namespace boltzmann
