// Run list: the runs with results below a folder, and the start page to select one of them.
#pragma once

#include <boltzmann/window/choice_source.hpp>
#include <boltzmann/window/web_server.hpp>

#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// Folders with runs, of scenarios or programs, at most four levels deep, by name. Links are not followed. Each request
/// repeats the search.
class RunList {
 public:
  explicit RunList(std::string folder) : folder_(std::move(folder)) {}

  /// True if there is at least one.
  bool any() const;
  /// {"ok": true, "scenarios": [...]} as in Gallery::scenarios(), with the names of folders below this one; pictures
  /// are those that the run has drawn.
  nlohmann::json runs();
  /// The folder of that name. Throws Error if there is no such run, or it has no trajectory.
  std::string find(std::string const& name) const;
  /// The picture at "/run/3.png"; nothing if it does not exist. May be called from any thread.
  std::optional<WebFile> picture(std::string_view path) const;

 private:
  std::vector<std::string> names(std::size_t most) const;

  std::string folder_;
  mutable std::mutex mutex_;
  std::vector<std::string> pictures_;  ///< their paths, by number
};

class RunListSource final : public ChoiceSource {
 public:
  RunListSource(RunList& list, Clients& clients, std::string const& folder, std::string message = "")
      : ChoiceSource(clients, "Runs in " + folder, std::move(message)), list_(list) {}

  nlohmann::json hello() const override;
  /// Waits until a client selects a run, and returns its folder; nothing if a client quits.
  std::optional<std::string> run() {
    wait();
    return choice_;
  }

 private:
  bool chosen() const override { return choice_.has_value(); }
  nlohmann::json answer(std::string const& what, nlohmann::json const& request) override;

  RunList& list_;
  std::optional<std::string> choice_;
};

}  // namespace boltzmann
