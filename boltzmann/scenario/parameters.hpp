// Parameters of a scenario: the values of its text that can be changed and their allowed ranges; and the outline of a
// scenario for a list, from its text only.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

/// A value of a scenario's text, and the values that its reader allows there; or an absent key that one of its tables
/// accepts. Keys of [sweep] are not included.
struct ScenarioParameter {
  std::string path;   ///< as in --set: "run.step", "ensembles.atoms.mass", "influences.0.depth"
  std::string group;  ///< the top-level table: "run", "ensembles.atoms"; empty: none
  std::string name;   ///< the rest of the path: "step", "load.spacing"
  /// "quantity", "integer", "number", "word", "boolean", "text" or "vector" (an array of these); for an absent key also
  /// "any", with the allowed values in `doc`.
  std::string kind;
  std::string value;      ///< as TOML, as written; for an absent key its default, or empty if `otherwise` describes it
  std::string unit;       ///< display unit of the base; empty: a pure number, or not a number
  std::string base_unit;  ///< the unit of a plain number: "amu", "3.273 fs"; empty: a pure number, or not a number
  std::vector<std::string> units;  ///< possible units, that of the value first
  /// Limits of a number, in `unit`; of a vector, those of its elements. Some limits are unknown without the other
  /// values.
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool low_excluded = false;       ///< it must be above `low`
  std::vector<std::string> words;  ///< allowed words
  std::string comment;             ///< after the value, without the #
  std::string doc;                 ///< description in one line; only of scenarios that a page has requested
  std::string otherwise;           ///< for an absent key: the behaviour without it, in words
};

/// Properties of a scenario that are known without loading its particles.
struct ScenarioOutline {
  std::string title, description;
  int dimension = 0;                     ///< of the box
  std::optional<double> steps;           ///< of a run by default; nothing: it depends on the state
  std::optional<std::size_t> particles;  ///< nothing: unknown without loading them
};

/// Throws ScenarioErrors if the text is not TOML or, without [box] or [[ensembles]], not a scenario; `file` is the name
/// in messages.
ScenarioOutline outline_scenario(std::string const& text, std::string const& file);

/// Paths (as in --set) and values: TOML, or a text without quotation marks. No value: the key is removed.
using ScenarioValues = std::vector<std::pair<std::string, std::optional<std::string>>>;

/// Replaces values in the text; everything else, including comments and layout, is unchanged. A new key is added after
/// the others of its table; a removed one disappears with its line. Throws Error if there is no such place, and
/// ScenarioErrors if the text is not TOML.
std::string with_values(std::string const& text, ScenarioValues const& values);

}  // namespace boltzmann
