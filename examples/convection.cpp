// Rayleigh-Benard convection with smooth particles (figure 4 of Hoover and Hoover's SPAM): a fluid between a hot
// floor and a cold ceiling, walls of odd mirror images; Nusselt's number is in diagnoses.csv.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void convection(Program& program) {
  // Units: the height, the mean temperature, the gas constant and the mean density are one.
  double const rayleigh = 10000, prandtl = 0.71;
  double const width = 4, spacing = 0.05, difference = 0.4, gamma = 1.02, cv = 1 / (gamma - 1), cp = gamma * cv;
  // P + stiffness = rho T. Only gradients of the pressure drive anything; a pressure as such makes particles
  // crystallise, and a crystal does not flow. So most of it is left out; the rest suffices to keep the fluid under
  // pressure.
  StiffenedGas const fluid{.gamma = gamma, .stiffness = 0.6, .cv = cv};
  // Gravity as Hoover chose it: at rest the density is the same everywhere, for the warmer has more to carry.
  double const gravity = difference, free_fall = std::sqrt(gravity * difference);
  // Ra = g (dT/H - g/cp) H^4 / (T nu kappa), Pr = nu / kappa: only what is steeper than the adiabat drives the flow.
  double const diffusivity = std::sqrt(gravity * (difference - gravity / cp) / (rayleigh * prandtl));
  double const viscosity = prandtl * diffusivity, conductivity = diffusivity * cp;

  Box box({0, 0}, {width, 1}, {Boundary::periodic, Boundary::mirror});
  box.wall(1, Box::End::low, {.slips = false, .temperature = 1 + difference / 2});
  box.wall(1, Box::End::high, {.slips = false, .temperature = 1 - difference / 2});

  Ensemble<Smooth<2>> particles("fluid");
  fill_load(particles, box, {.spacing = spacing, .density = 1, .range = 5 * spacing});
  double const stir = 0.3 * free_fall;  // two pairs of rolls, turning gently
  for (auto& p : particles) {
    double const x = pi * p.position[0], y = pi * p.position[1];
    p.specific_energy = cv * (1 + difference * (0.5 - p.position[1])) + fluid.stiffness;  // density 1
    p.velocity = {-stir * std::sin(x) * std::cos(y), stir * std::cos(x) * std::sin(y)};
  }

  SmoothScheme scheme(box, WeightShape::wendland);
  scheme.material(particles, Newtonian<StiffenedGas>{fluid, viscosity, 0, conductivity});
  scheme.external(particles, UniformGravity<2>{{0, -gravity}});

  double const duration = 40 / free_fall;
  Simulation simulation(scheme, 0.5 * scheme.courant_step());
  Recording recording = program.recording(simulation);
  recording.diagnoses(10, {"energies"});
  auto const& flux = recording.diagnose<HeatFlux>(10, {.axis = 1, .conductivity = conductivity, .since = duration / 2});
  recording.picture({.drawing = "map", .y = "temperature"});
  recording.picture({.drawing = "contours", .y = "temperature", .file = "contours.png"});
  program.run_for(recording, duration);
  std::printf("Nusselt's number: %.2f, spread %.2f, over the second half of the run\n", flux.mean(), flux.spread());
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/convection-cpp", convection); }
