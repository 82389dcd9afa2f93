// Gallery: the scenarios that can be run, their parameters, and how a changed one is checked, saved and loaded. What
// the window's start page asks for; the answers are those of protocol.md.
#pragma once

#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/window/web_server.hpp>

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace boltzmann {

/// The shipped scenarios, and behind them those of a folder (*.toml), which are the user's own. An own one that has the
/// name of a shipped one is called NAME.toml. Files are looked at when they are asked for. `set` is an object of paths,
/// as --set takes them, and values as texts of TOML.
///
/// All answers of functions that return JSON are whole replies but for their type and id: {"ok": true, ...} or
/// {"error": "one line", ...}.
class Gallery {
 public:
  explicit Gallery(std::string folder = ".");

  /// {"scenarios": [{"name", "title", "description", "particles", "steps", "dimension", "picture", "own"}]}: particles
  /// and steps are null where they are not known without making the particles.
  nlohmann::json scenarios() const;
  /// {"name", "title", "description", "text", "parameters", "absent", "own"}, where the last are keys that its tables
  /// could have, too; of a scenario with mistakes no parameters, but "errors".
  nlohmann::json scenario(std::string const& name) const;
  /// Would it run? If not, "errors": [{"path": which of those set is wrong, or null, "message"}]. Either way "absent"
  /// as it is with these values, as far as it is known.
  nlohmann::json check(std::string const& name, nlohmann::json const& set) const;
  /// The same, and whether its results may go into the folder `out`, which is below the present one ("": a new one).
  nlohmann::json check_run(std::string const& name, nlohmann::json const& set, std::string const& out) const;
  /// Writes the scenario with these values into the folder, as `as`.toml; {"path"}. Refuses what is not right, and to
  /// replace a file unless told.
  nlohmann::json save(std::string const& name, nlohmann::json const& set, std::string const& as, bool replace) const;
  /// Ready to run. Throws ScenarioErrors, or Error for an unknown name.
  std::unique_ptr<ScenarioSimulation> load(std::string const& name, nlohmann::json const& set) const;
  /// "/gallery/copper.png": nothing if there is no such picture. May be called from any thread.
  std::optional<WebFile> picture(std::string_view path) const;

 private:
  std::string folder_;
};

/// Where the pictures of shipped scenarios are, NAME.png: beside those in the source tree and where they are installed.
std::string gallery_folder();

}  // namespace boltzmann
