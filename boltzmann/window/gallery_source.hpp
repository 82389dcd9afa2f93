// Gallery show: the start page, where a scenario is chosen, changed, saved and run.
#pragma once

#include <boltzmann/window/choice_source.hpp>
#include <boltzmann/window/gallery.hpp>

#include <optional>
#include <string>

namespace boltzmann {

class GallerySource final : public ChoiceSource {
 public:
  /// `message` is said to those who come: how the last run ended.
  GallerySource(Gallery const& gallery, Clients& clients, std::string message = "")
      : ChoiceSource(clients, "Boltzmann", std::move(message)), gallery_(gallery) {}

  struct Choice {
    std::string name;    ///< of the scenario
    nlohmann::json set;  ///< what is changed of it
    std::string out;     ///< the folder of the results, or empty
  };
  /// Until somebody runs a scenario; nothing: somebody has quit.
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
