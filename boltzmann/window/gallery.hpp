// Gallery: the scenarios that can be run and their parameters; checks, saves and loads modified scenarios. It serves
// the window's start page; the replies are those of protocol.md.
#pragma once

#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/window/web_server.hpp>

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace boltzmann {

/// The shipped scenarios, followed by the user's scenarios in a folder (*.toml). A user's scenario with the name of a
/// shipped one is listed as NAME.toml. Files are read for each request. `set` is an object of paths, as for --set, and
/// values as TOML texts.
///
/// All functions that return JSON return whole replies without type and id: {"ok": true, ...} or {"error": "one line",
/// ...}.
class Gallery {
 public:
  explicit Gallery(std::string folder = ".");

  /// {"scenarios": [{"name", "title", "description", "particles", "steps", "dimension", "picture", "own"}]}. Particles
  /// and steps are null if they are unknown without loading the particles.
  nlohmann::json scenarios() const;
  /// {"name", "title", "description", "text", "parameters", "absent", "own"}, where "absent" are the further keys that
  /// its tables accept. For a scenario with mistakes there are no parameters, but "errors".
  nlohmann::json scenario(std::string const& name) const;
  /// Checks that it would run. If not, "errors": [{"path": which of those set is wrong, or null, "message"}]. In either
  /// case "absent" with these values, as far as known.
  nlohmann::json check(std::string const& name, nlohmann::json const& set) const;
  /// The same, and checks that its results may be written into the folder `out`, which is below the current one ("": a
  /// new one).
  nlohmann::json check_run(std::string const& name, nlohmann::json const& set, std::string const& out) const;
  /// Writes the scenario with these values into the folder, as `as`.toml; {"path"}. Refuses invalid values, and to
  /// replace a file unless `replace` is set.
  nlohmann::json save(std::string const& name, nlohmann::json const& set, std::string const& as, bool replace) const;
  /// Loads the scenario, ready to run. Throws ScenarioErrors, or Error for an unknown name.
  std::unique_ptr<ScenarioSimulation> load(std::string const& name, nlohmann::json const& set) const;
  /// The picture at "/gallery/copper.png"; nothing if it does not exist. May be called from any thread.
  std::optional<WebFile> picture(std::string_view path) const;

 private:
  std::string folder_;
};

/// The folder with the pictures of shipped scenarios, NAME.png: beside the scenarios in the source tree and in the
/// installation.
std::string gallery_folder();

}  // namespace boltzmann
