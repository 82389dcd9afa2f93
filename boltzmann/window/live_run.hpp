// Live run: a simulation that is observed while it runs; PLAY, STEP, REWD, STOP and QUIT.
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
  bool play = false;                  ///< starts immediately, unthrottled, and ends with its last step if no browser is
                                      ///< connected
  std::int64_t steps_per_frame = -1;  ///< 0: unthrottled; -1: such that all steps take about ten seconds
  std::string name = {}, description = {};
  /// Called ten times a second while no steps are done. The run ends when it returns false.
  std::function<bool()> between_steps = {};
};

class LiveRun final : public Source {
 public:
  /// Observes the simulation of the views, which must outlive it. `recording` may be null.
  LiveRun(Views& views, Clients& clients, Recording* recording, LiveOptions const& options = {});
  ~LiveRun() override;
  LiveRun(LiveRun const&) = delete;
  LiveRun& operator=(LiveRun const&) = delete;

  /// Executes the clients' requests until one of them quits; `steps` are planned. Then rethrows the exception of a
  /// step.
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

/// Runs under control of clients with views, from start to end, with progress and records as in run_with_progress.
/// `recording` may be null. During the run, its folder contains the address of the window.
RunReport run_live(Views& views, Clients& clients, Recording* recording, std::uint64_t steps,
                   LiveOptions const& options = {}, bool quiet = false);

}  // namespace boltzmann
