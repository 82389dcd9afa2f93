// What ranks_test.cpp runs on several ranks: two bodies on a circle, and whatever RANKS_PROGRAM says goes wrong.
#include <boltzmann/boltzmann.hpp>

#include <cstdlib>
#include <new>
#include <string>
#include <thread>

using namespace boltzmann;

namespace {

void circle(Program& program) {
  char const* const said = std::getenv("RANKS_PROGRAM");
  std::string const what = said ? said : "";
  int const rank = team().rank();
  std::printf("begins\n");
  Ensemble<Kepler<2>> bodies("bodies", 2);
  bodies[0].position = {0.5, 0};
  bodies[1].position = {-0.5, 0};
  bodies[0].velocity = {0, std::sqrt(0.5)};
  bodies[1].velocity = {0, -std::sqrt(0.5)};
  if (what == "other particles" && rank == 1) bodies[0].position[0] += 1e-15;
  if (what == "file" && rank == 2) throw Error("'masses.csv' is not on this machine");
  if (what == "exit" && rank == 1) std::exit(7);
  PairScheme space(Box(Vector{-1.0, -1.0}, Vector{1.0, 1.0}));
  space.internal(bodies, gravity(1.0));
  Simulation simulation(space, 0.05);
  Recording recording = program.recording(simulation);
  recording.diagnoses(1, {"energies"}).trajectory(10);
  simulation.observe(1, [&](Simulation const& now) {
    if (now.step() != 30) return;
    if (what == "observer" && rank == 2) throw Error("a file of rank 2 can't be read");
    if (what == "memory" && rank == 1) throw std::bad_alloc();
    if (what == "late" && rank == 1) std::this_thread::sleep_for(std::chrono::seconds(60));
  });
  if (what == "first only" && rank > 0) return;
  program.run(recording, 100);
  std::printf("ends at %.17g\n", bodies[0].position[0]);
}

}  // namespace

int main(int argc, char** argv) { return run_program(argc, argv, "circle", circle); }
