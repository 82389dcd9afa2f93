// Choice source: a start page for a selection, before there is a simulation.
#pragma once

#include <boltzmann/window/clients.hpp>

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

namespace boltzmann {

class ChoiceSource : public Source {
 public:
  ChoiceSource(Clients& clients, std::string title, std::string message);
  ~ChoiceSource() override;
  ChoiceSource(ChoiceSource const&) = delete;
  ChoiceSource& operator=(ChoiceSource const&) = delete;

  nlohmann::json hello() const override;
  nlohmann::json status() const override;
  std::uint64_t scene() const override { return 1; }
  std::uint64_t notice() const override { return notice_; }
  nlohmann::json perform(nlohmann::json const& request) final;
  std::shared_ptr<Canvas const> draw(nlohmann::json const& view) override;
  PictureFile picture(nlohmann::json const& request) override;
  nlohmann::json particle(std::string const& ensemble, std::size_t number) const override;

 protected:
  /// Waits until something is selected or a client quits.
  void wait();
  virtual bool chosen() const = 0;
  /// Performs any request other than "quit".
  virtual nlohmann::json answer(std::string const& what, nlohmann::json const& request) = 0;

 private:
  Clients& clients_;
  std::string title_, message_;
  bool quit_ = false;
  std::uint64_t notice_ = 1;
};

/// The text of a key of a request. Throws Error if it is missing.
std::string need_text(nlohmann::json const& request, char const* key);

}  // namespace boltzmann
