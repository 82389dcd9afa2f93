// Window: observe and control a simulation in a browser. Two lines of a program:
//   Window window(recording);        // prints its address
//   window.run(2000);                // in place of run_with_progress
//
// PLAY, STEP, REWD, STOP and QUIT are on the page. Any number of browsers may connect and disconnect, and none of them
// can delay the simulation.
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
  std::uint16_t port = 0;  ///< 0: any free port
  bool play = false;       ///< starts immediately, unthrottled, and ends with the last step if no browser is connected
  bool quiet = false;      ///< prints neither the address nor progress
  std::string title = {}, description = {}, name = {};
};

class Window {
 public:
  /// A window of a run that is recorded, with its pictures and its measured quantities. Listens on 127.0.0.1
  /// immediately and prints its address. Throws Error if the port is in use.
  explicit Window(Recording& recording, WindowOptions options = {});
  /// A window of a simulation without files.
  Window(Simulation& simulation, UnitSystem const& units, WindowOptions options = {});
  ~Window();
  Window(Window const&) = delete;
  Window& operator=(Window const&) = delete;

  /// Adds a drawing of your own to the list: draw(canvas, scheme) or draw(canvas), called between two steps when a
  /// browser shows it. It replaces one of the same name.
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
  /// Adds a picture, given by the names of its fields: add("Speed along x", {.drawing = "phase-space", .x =
  /// "position.x", .y = "speed"}). Throws Error if it can't be drawn of this simulation.
  void add(std::string name, Picture picture);
  /// The colours of ensembles without one of their own, by name or "#rrggbb". Throws Error for any other word.
  void colours(std::vector<std::string> const& names);

  /// "http://127.0.0.1:40123/?token=..."
  std::string address() const;
  Simulation& simulation() const;

  /// Runs under control of the browsers, until QUIT or Ctrl-C; `steps` are planned. Records, prints and throws as
  /// run_with_progress does.
  RunReport run(std::uint64_t steps);

 private:
  void install_drawing(std::string name, std::function<void(Canvas&)> draw);
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace boltzmann
