// Live run: a simulation that goes on while it is looked at; PLAY, STEP, REWD, STOP and QUIT.
#pragma once

#include <boltzmann/recording/progress.hpp>
#include <boltzmann/window/clients.hpp>
#include <boltzmann/window/views.hpp>

#include <cstdint>
#include <functional>
#include <memory>

namespace boltzmann {

class Recording;

struct LiveOptions {
  bool play = false;                  ///< begins at once, at full speed, and ends with its last step when nobody looks
  std::int64_t steps_per_frame = -1;  ///< 0: full speed; -1: so that all steps take some ten seconds
  std::string name = {}, description = {};
  /// Called ten times a second while no steps are done; the run ends when it returns false.
  std::function<bool()> between_steps = {};
};

class LiveRun final : public Source {
 public:
  /// Observes the simulation of the views, which must outlive it. `recording` may be null.
  LiveRun(Views& views, Clients& clients, Recording* recording, LiveOptions const& options = {});
  ~LiveRun() override;
  LiveRun(LiveRun const&) = delete;
  LiveRun& operator=(LiveRun const&) = delete;

  /// Does what the clients wants, until it quits; `steps` are planned. Rethrows what a step has thrown, then.
  void run(std::uint64_t steps);

  nlohmann::json hello() const override;
  nlohmann::json status() const override;
  std::uint64_t scene() const override;
  std::uint64_t notice() const override;
  nlohmann::json perform(nlohmann::json const& request) override;
  std::shared_ptr<Canvas const> draw(nlohmann::json const& view) override;
  PictureFile picture(nlohmann::json const& request) override;
  nlohmann::json particle(std::string const& ensemble, std::size_t number) const override;
  ShownTable const* table() const override;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

/// A run that clients watch in views, from its beginning to its end, with progress and records as run_with_progress
/// has them (which see). `recording` may be null. While it goes on, its folder says where the window is.
RunReport run_live(Views& views, Clients& clients, Recording* recording, std::uint64_t steps,
                   LiveOptions const& options = {}, bool quiet = false);

}  // namespace boltzmann
