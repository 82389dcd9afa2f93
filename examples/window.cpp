// A window on a gas that is heated by compression: a program that is always in one, with drawings and colours of its
// own in it.
//
//   build/release/examples/window             prints an address; PLAY, STEP, REWD, STOP, QUIT are on that page
//   build/release/examples/window --play      starts immediately; exits when finished if no browser is connected
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void gas_in_a_window(Program& program) {
  Ensemble<Newton<2>> light("light"), heavy("heavy");
  block_load(light, {Lattice::square, 1.2, {20, 10}, {1, 1}});
  block_load(heavy, {Lattice::square, 1.2, {20, 10}, {1, 14}});
  for (auto& atom : heavy) atom.mass = 4, atom.velocity = {0, -1};
  light.appearance.diameter = heavy.appearance.diameter = 1;

  PairScheme gas(Box({0, 0}, {26, 26}, Boundary::reflecting), 2.5);
  for (auto* ensemble : {&light, &heavy}) gas.internal(*ensemble, LennardJones{1, 1});
  gas.between(light, heavy, LennardJones{1, 1});

  Simulation simulation(gas, 0.002);
  Recording recording = program.recording(simulation);
  recording.diagnoses(10, {"energies", "temperature"}).trajectory(50).picture({.colour = "speed"});

  program.in_window([](Window& window) {
    window.colours({"orange", "navy"});
    window.add("Speed along x",
               {.drawing = "phase-space", .x = "position.x", .y = "speed", .colour = "kinetic-energy"});
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
  });
  program.run(recording, 3000);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/window-cpp", gas_in_a_window); }
