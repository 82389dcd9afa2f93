// Gallery show: the start page, where a scenario is chosen, changed, saved and run.
#pragma once

#include <boltzmann/window/audience.hpp>
#include <boltzmann/window/gallery.hpp>

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace boltzmann {

class GalleryShow final : public Show {
 public:
  /// `message` is said to those who come: how the last run ended.
  GalleryShow(Gallery const& gallery, Audience& audience, std::string message = "");
  ~GalleryShow() override;
  GalleryShow(GalleryShow const&) = delete;
  GalleryShow& operator=(GalleryShow const&) = delete;

  struct Choice {
    std::string name;    ///< of the scenario
    nlohmann::json set;  ///< what is changed of it
    std::string out;     ///< the folder of the results, or empty
  };
  /// Until somebody runs a scenario; nothing: somebody has quit.
  std::optional<Choice> run();

  nlohmann::json hello() const override;
  nlohmann::json status() const override;
  std::uint64_t scene() const override { return 1; }
  std::uint64_t notice() const override { return notice_; }
  nlohmann::json perform(nlohmann::json const& request) override;
  std::shared_ptr<Canvas const> draw(nlohmann::json const& view) override;
  PictureFile picture(nlohmann::json const& request) override;
  nlohmann::json particle(std::string const& ensemble, std::size_t number) const override;

 private:
  Gallery const& gallery_;
  Audience& audience_;
  std::string message_;
  std::optional<Choice> choice_;
  bool quit_ = false;
  std::uint64_t notice_ = 1;
};

}  // namespace boltzmann
