// Parameters of a scenario: the values of its text that can be changed, with what each may be; and what a list of
// scenarios shows of one, found from its text alone.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

/// A value of a scenario's text, and what the reader that has read it allows there; or a key that one of its tables
/// could have, too. There are none of [sweep].
struct ScenarioParameter {
  std::string path;   ///< as --set takes it: "run.step", "ensembles.atoms.mass", "influences.0.depth"
  std::string group;  ///< the table at the top that it stands in: "run", "ensembles.atoms"; empty: at the top itself
  std::string name;   ///< the rest of the path: "step", "load.spacing"
  /// "quantity", "integer", "number", "word", "boolean", "text" or "vector" (an array of these); of a key that is
  /// absent also "any": `doc` says what is allowed.
  std::string kind;
  std::string value;  ///< as TOML, as it was written; of a key that is absent its default, empty: `otherwise` says it
  std::string unit;   ///< in which the base shows such a quantity; empty: a pure number, or none
  std::string base_unit;  ///< what a plain number counts there: "amu", "3.273 fs"; empty: a pure number, or none
  std::vector<std::string> units;  ///< some that it may be written in, that of the value first
  /// Of a number, in `unit`; of a vector those of its elements. Not all limits are known without the other values.
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool low_excluded = false;       ///< it must be above `low`
  std::vector<std::string> words;  ///< of a word, all that are allowed
  std::string comment;             ///< behind it, without the #
  std::string doc;                 ///< what it means, one line; only of scenarios that a page has asked for
  std::string otherwise;           ///< of a key that is absent: what holds without it, in words
};

/// What can be said of a scenario without making its particles.
struct ScenarioOutline {
  std::string title, description;
  int dimension = 0;                     ///< of the box
  std::optional<double> steps;           ///< of a run that is not told otherwise; nothing: it depends on the state
  std::optional<std::size_t> particles;  ///< nothing: it takes more than a look to count them
};

/// Throws ScenarioErrors if the text is not TOML or, having no [box] or no [[ensembles]], no scenario; `file` stands
/// for it in messages.
ScenarioOutline outline_scenario(std::string const& text, std::string const& file);

/// Paths (of --set) and values: TOML, or a text without its quotation marks. Without a value: the key is left out.
using ScenarioValues = std::vector<std::pair<std::string, std::optional<std::string>>>;

/// The text with other values in it and everything else, comments and layout, as it was. A key that its table does not
/// have yet stands behind the others; one that is left out goes with its line. Throws Error if there is no such place, and ScenarioErrors if the text is not
/// TOML.
std::string with_values(std::string const& text, ScenarioValues const& values);

}  // namespace boltzmann
