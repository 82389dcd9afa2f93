// A window on a gas that is heated by compression: two lines open it, a few more add diagnoses and colours of one's
// own.
//
//   build/release/examples/window                   prints an address; PLAY, STEP, REWD, STOP, QUIT are on that page
//   build/release/examples/window FOLDER --play     begins at once, and ends by itself when nobody looks
#include <boltzmann/boltzmann.hpp>

#include <cstring>

using namespace boltzmann;

int main(int argc, char** argv) try {
  bool const play = argc > 2 && std::strcmp(argv[2], "--play") == 0;
  Ensemble<Newton<2>> light("light", 200), heavy("heavy", 200);
  block_load(light, Lattice::square, 1.2, {20, 10}, {1, 1});
  block_load(heavy, Lattice::square, 1.2, {20, 10}, {1, 14});
  for (auto& atom : heavy) atom.mass = 4, atom.velocity = {0.0, -1.0};
  light.appearance.diameter = heavy.appearance.diameter = 1;

  PairScheme gas(Box(Vector{0.0, 0.0}, Vector{26.0, 26.0}, Boundary::reflecting), 2.5);
  for (auto* ensemble : {&light, &heavy}) gas.internal(*ensemble, LennardJones{1, 1});
  gas.between(light, heavy, LennardJones{1, 1});

  Simulation simulation(gas, 0.002);
  simulation.integrate(light, Method::leap_frog);
  simulation.integrate(heavy, Method::leap_frog);

  Recording recording(simulation, UnitSystem::reduced(), argc > 1 ? argv[1] : "results/window-cpp", true);
  recording.diagnoses(10, {"energies", "temperature"});
  recording.trajectory(50);
  recording.picture({.colour = "speed"});

  Window window(recording, {.play = play});
  window.colours({"orange", "navy"});
  window.add("Speed along x", {.drawing = "phase-space", .x = "position.x", .y = "speed", .colour = "kinetic-energy"});
  // The kinetic energy of each particle over its height: the front of the heavy gas runs into the light one.
  window.install("Kinetic", [](Canvas& canvas, auto const& scheme) {
    canvas.axes({"y", ""}, {"kinetic energy", ""});
    for (auto const* ensemble : scheme.ensembles()) {
      auto const& y = quantity(*ensemble, "position.y");
      auto const& energy = quantity(*ensemble, "kinetic-energy");
      Colour const colour = colour_named(ensemble->name() == "light" ? "orange" : "navy");
      for (std::size_t i = 0; i < y.size(); ++i) canvas.point(y[i], energy[i], colour, 5);
    }
  });
  window.run(3000);
} catch (std::exception const& error) {
  return report(error);
}
