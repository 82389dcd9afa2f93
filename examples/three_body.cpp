// Three bodies on a figure-8 (Chenciner and Montgomery): after one period each is back where it was.
#include <boltzmann/boltzmann.hpp>

#include <cstdio>

using namespace boltzmann;

int main(int argc, char** argv) {
  return run_program(argc, argv, "results/three-body-cpp", [](Program& program) {
    double const period = 6.32591398;
    Ensemble<Kepler<3>> bodies("bodies", 3);
    bodies[0].position = {0.97000436, -0.24308753, 0};
    bodies[1].position = {-0.97000436, 0.24308753, 0};
    bodies[2].velocity = {-0.93240737, -0.86473146, 0};
    bodies[0].velocity = bodies[1].velocity = bodies[2].velocity * -0.5;
    bodies.appearance.diameter = 0.1;

    PairScheme space(Box(Vector{-1.5, -1.0, -1.0}, Vector{1.5, 1.0, 1.0}));
    space.internal(bodies, gravity(1.0));

    int const steps = 2000;
    Simulation simulation(space, period / steps);
    simulation.integrate(bodies, Method::rk4);

    Recording recording = program.recording(simulation);
    recording.diagnoses(20, {"energies", "angular-momentum"});
    recording.trajectory(20);
    recording.picture({.trace = true});
    program.run(recording, steps);
    std::printf("after one period body 0 is %.1e from where it was\n",
                magnitude(bodies[0].position - Vector{0.97000436, -0.24308753, 0.0}));
  });
}
