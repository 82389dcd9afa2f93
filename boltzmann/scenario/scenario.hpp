// Scenario: a simulation as a file. Converts a TOML text to a simulation that is ready to run, and reports all mistakes
// of the file together.
#pragma once

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/diagnoses/diagnosis.hpp>
#include <boltzmann/dissipation/dissipation.hpp>
#include <boltzmann/pictures/picture.hpp>
#include <boltzmann/scenario/overrides.hpp>
#include <boltzmann/scenario/parameters.hpp>
#include <boltzmann/scenario/sweep.hpp>
#include <boltzmann/scenario/typed_law.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

class PairScheme;

/// All mistakes of a scenario: one line each, `file:line:column: what was found; what is allowed; the most similar
/// word`.
struct ScenarioErrors : Error {
  explicit ScenarioErrors(std::vector<std::string> all, std::vector<ScenarioParameter> absent = {},
                          std::vector<ScenarioParameter> parameters = {});
  std::vector<std::string> lines;
  std::vector<ScenarioParameter> parameters;  ///< as in ScenarioSimulation, as far as they could be read
  std::vector<ScenarioParameter> absent;      ///< as in ScenarioSimulation, as far as the tables could be read
};

/// A picture of a scenario, or (by its name) a view in the window.
struct PicturePlan : Picture {
  std::string name = {};
};

/// Output intervals.
struct OutputPlan {
  std::int64_t diagnoses = 0, trajectory = 0, mesh = 0, checkpoint = 0;  ///< steps between two; 0: never
  std::vector<PicturePlan> pictures;
};

/// A class derived by a scenario, as text.
struct DerivedClassText {
  std::string name, base, doc;
  std::vector<Field> fields;                               ///< additional ones
  std::vector<std::pair<std::string, std::string>> rates;  ///< "d charge / dt" and its formula
};

/// A scenario that is ready to run. Owns everything.
struct ScenarioSimulation {
  std::string name, title, description;
  UnitSystem units;
  bool reduced = false;  ///< pure numbers: no units in files and pictures
  std::vector<std::unique_ptr<AnyEnsemble>> ensembles;
  std::vector<std::unique_ptr<Scheme>> schemes;  ///< one or more; their influences are added
  PairScheme* pairs = nullptr;  ///< one of them, or the part of a mesh scheme for pairs; null if all particles are
                                ///< smooth
  std::vector<std::unique_ptr<Dissipation>> dissipations;  ///< friction and noise
  std::unique_ptr<Simulation> simulation;
  std::vector<std::unique_ptr<Diagnosis>> diagnoses;
  std::int64_t steps = 0;
  std::string stop;  ///< a condition that ends the run early; empty: none
  std::function<bool(std::int64_t step, std::span<double const> values)> stop_when;  ///< the same, for Recording
  OutputPlan output;
  std::vector<PicturePlan> views;  ///< drawings for the window, by name
  std::optional<SweepPlan> sweep;  ///< for a scenario that runs for several values or seeds
  std::string resolved;            ///< the scenario as TOML with all overrides applied, stored beside the results
  std::vector<ScenarioParameter> parameters;  ///< the values of the text with their allowed ranges
  std::vector<ScenarioParameter> absent;      ///< further keys that its tables accept; only for a page
  std::vector<DerivedClassText> classes;      ///< derived classes
  std::vector<TypedLaw> typed_laws;           ///< of pairs
  std::vector<std::string> notes;             ///< "note: ..." or "warning: ...": unused parts of files, empty groups
  std::vector<std::pair<std::string, std::string>> elements;  ///< by ensemble: "atoms", "Cu"

  Box const& box() const { return schemes.front()->box(); }
  /// The scheme of this type, scheme<MeshScheme>(); null if there is none.
  template <class S>
  S* scheme() const {
    for (auto const& one : schemes)
      if (auto* found = dynamic_cast<S*>(one.get())) return found;
    return nullptr;
  }
};

/// The text of a scenario, and its origin.
struct ScenarioText {
  std::string text;
  std::string file;    ///< precedes line and column in messages
  std::string name;    ///< of the scenario: that of the file without its extension
  std::string folder;  ///< base of relative paths; empty: the current folder
};
/// The text of a file, or of standard input for the path "-", with the name "stdin". Throws Error if it can't be read.
ScenarioText read_scenario(std::string const& path);

/// Creates a simulation from a text. Throws ScenarioErrors with all its mistakes.
std::unique_ptr<ScenarioSimulation> load_scenario(ScenarioText const& text, Overrides const& overrides = {});
/// Reads a scenario file. Throws ScenarioErrors with all its mistakes, or Error if the file can't be read.
std::unique_ptr<ScenarioSimulation> load_scenario(std::string const& path, Overrides const& overrides = {});
/// The same from text; `name` is the name of the file in messages.
std::unique_ptr<ScenarioSimulation> parse_scenario(std::string const& text, std::string const& name,
                                                   Overrides const& overrides = {});

/// Adds a diagnosis to an existing simulation, as the last of its `diagnoses`. The text has one table [[diagnoses]].
/// Throws ScenarioErrors, without changes, if it can't be measured.
void add_diagnosis(std::unique_ptr<ScenarioSimulation>& scenario, ScenarioText const& text);

/// The folder of shipped scenarios, and the names in it ("copper", ...), sorted.
std::string scenario_folder();
std::vector<std::string> shipped_scenarios();
/// The path of a scenario given as file, as shipped name or as "-", standard input. Throws Error with the most similar
/// name.
std::string find_scenario(std::string const& file_or_name);

}  // namespace boltzmann
