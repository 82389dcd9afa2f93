// Gallery source: the start page, on which a scenario is selected, modified, saved and run.
#pragma once

#include <boltzmann/window/choice_source.hpp>
#include <boltzmann/window/gallery.hpp>

#include <optional>
#include <string>

namespace boltzmann {

class GallerySource final : public ChoiceSource {
 public:
  /// `message` is shown on the page: how the last run ended.
  GallerySource(Gallery const& gallery, Clients& clients, std::string message = "")
      : ChoiceSource(clients, "Boltzmann", std::move(message)), gallery_(gallery) {}

  struct Choice {
    std::string name;    ///< of the scenario
    nlohmann::json set;  ///< the modified values
    std::string out;     ///< the folder of the results, or empty
  };
  /// Waits until a client runs a scenario; nothing if a client quits.
  std::optional<Choice> run() {
    wait();
    return choice_;
  }

 private:
  bool chosen() const override { return choice_.has_value(); }
  nlohmann::json answer(std::string const& what, nlohmann::json const& request) override;

  Gallery const& gallery_;
  std::optional<Choice> choice_;
};

}  // namespace boltzmann
