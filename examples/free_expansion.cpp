// Free expansion (figures 2 and 3 of Hoover and Hoover's SPAM): 16,384 smooth particles of a gas with P = rho^2 / 2 fly
// apart into four times their space. Nothing heats the gas, and its entropy grows.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void free_expansion(Program& program) {
  double const side = 256, sound_time = side;  // the speed of sound is 1 at the start
  Box const box({0, 0}, {side, side}, Boundary::periodic);
  Ensemble<Smooth<2>> gas("gas");
  fill_load(gas, {.spacing = 1, .low = {64, 64}, .high = {192, 192}, .density = 1, .range = 6});
  jitter(gas, {.most = 0.1});

  SmoothScheme scheme(box, WeightShape::lucy);
  scheme.material(gas, QuadraticGas{});  // forces then need no density: Eq 20
  Simulation simulation(scheme, 0.8);
  simulation.integrate(gas, Method::rk4);

  scheme.complete(0);
  SmoothEntropy const before = smooth_entropy({gas}, box);
  Recording recording = program.recording(simulation);
  recording.diagnoses(40, {"energies", "momentum", "entropy"}).trajectory(320);
  // Figure 2: above the mean, and below.
  recording.picture({.drawing = "bands", .y = "density"});
  recording.picture({.drawing = "bands", .y = "kinetic-energy", .file = "kinetic-energy.png"});
  recording.picture({.drawing = "time-series",
                     .y = "entropy sum, entropy integral, entropy sum with all motion",
                     .file = "entropy.png"});
  program.run_for(recording, 2 * sound_time);

  SmoothEntropy const after = smooth_entropy({gas}, box);
  auto const print = [](char const* what, Entropy const& now, Entropy const& then) {
    std::printf("%-22s sum %6.3f  integral %6.3f\n", what, now.sum - then.sum, now.integral - then.integral);
  };
  std::printf("Gain of entropy / N k after two sound times; ln 4 = 1.386 is approached as the range grows\n");
  print("with fluctuations", after.with_fluctuations, before.with_fluctuations);
  print("without fluctuations", after.without_fluctuations, before.without_fluctuations);
  print("with all motion", after.with_all_motion, before.with_all_motion);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/free-expansion-cpp", free_expansion); }
