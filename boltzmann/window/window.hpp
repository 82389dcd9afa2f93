// Window: watch and steer a simulation in a browser. Two lines of a program:
//
//   Window window(recording);        // prints its address
//   window.run(2000);                // in place of run_with_progress
//
// PLAY, STEP, REWD, STOP and QUIT are on the page; any number of browsers may look, come and go, and none of them can
// hold the simulation up.
#pragma once

#include <boltzmann/pictures/canvas.hpp>
#include <boltzmann/pictures/picture.hpp>
#include <boltzmann/recording/progress.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace boltzmann {

class Recording;

struct WindowOptions {
  std::uint16_t port = 0;  ///< 0: a free one
  bool play = false;       ///< begins at once, at full speed, and ends with the last step if nobody looks then
  bool quiet = false;      ///< prints neither the address nor progress
  std::string title = {}, description = {}, name = {};
};

class Window {
 public:
  /// A window on a run that is recorded, with its pictures and its measured quantities. Listens on 127.0.0.1 at once
  /// and prints its address. Error if the port is taken.
  explicit Window(Recording& recording, WindowOptions options = {});
  /// A window on a simulation without files.
  Window(Simulation& simulation, UnitSystem const& units, WindowOptions options = {});
  ~Window();
  Window(Window const&) = delete;
  Window& operator=(Window const&) = delete;

  /// Adds a drawing of your own to the list: draw(canvas, scheme) or draw(canvas), called between two steps whenever
  /// somebody wants to see it. In place of the one of that name, if there is one.
  ///
  ///   window.install("Kinetic", [&](Canvas& canvas) {
  ///     for (auto const& atom : atoms) canvas.point(atom.position[0], dot(atom.velocity, atom.velocity) / 2);
  ///   });
  template <class Draw>
  void install(std::string name, Draw draw) {
    if constexpr (std::invocable<Draw&, Canvas&>)
      install_drawing(std::move(name), std::move(draw));
    else
      install_drawing(std::move(name), [this, draw = std::move(draw)](Canvas& canvas) mutable {
        draw(canvas, static_cast<Scheme const&>(*simulation().schemes().front()));
      });
  }
  /// A picture by its names of fields: add("Speed along x", {.drawing = "phase-space", .x = "position.x", .y =
  /// "speed"}). Error if it can't be drawn of this simulation.
  void add(std::string name, Picture picture);
  /// The colours of the ensembles that have none of their own, by name or "#rrggbb". Error for another word.
  void colours(std::vector<std::string> const& names);

  /// "http://127.0.0.1:40123/?token=..."
  std::string address() const;
  Simulation& simulation() const;

  /// Runs as somebody at the window wants, until QUIT or Ctrl-C; `steps` are planned. Records, and prints what
  /// run_with_progress prints; throws what it throws.
  RunReport run(std::uint64_t steps);

 private:
  void install_drawing(std::string name, std::function<void(Canvas&)> draw);
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace boltzmann
