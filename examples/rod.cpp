// A wave in a metal rod (section 6.2 of the 1990 thesis): lumps of copper connected by springs, the far end fixed.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;
using namespace boltzmann::units;

void rod(Program& program) {
  UnitSystem const units = UnitSystem::si();
  double const area = 1, spacing = 0.05, density = 8.96e3, young = units(120 * gigapascal);
  std::size_t const count = 100;

  Ensemble<Newton<1>> rod("rod", count - 1), wall("wall", 1);
  for (std::size_t i = 0; i < count; ++i) {
    auto& lump = i + 1 < count ? rod[i] : wall[0];
    lump.position = {2 + spacing * static_cast<double>(i)};
    lump.mass = area * spacing * density;
  }
  rod[0].position[0] += 0.01;

  PairScheme space(Box({0}, {10}));
  Spring const spring{.stiffness = area * young / spacing, .rest_length = spacing};
  space.connect(rod, {{0, count - 2, 1}}, spring);
  space.between(rod, wall, one_way([=](auto const& p, auto const& q) {
                  // Only the last lump touches the wall.
                  auto const near = q.position[0] - p.position[0] < 1.5 * spacing;
                  auto const force = spring(p, q).force;
                  return select(near, force, force * 0.0);
                }));

  Simulation simulation(space, 1e-6);
  simulation.integrate(rod, Method::rk4);
  simulation.integrate(wall, Method::deactivate);

  Recording recording = program.recording(simulation, units);
  recording.diagnoses(20, {"momentum"}).trajectory(100);
  recording.picture({.drawing = "phase-space", .x = "position.x", .y = "velocity.x"});
  program.run(recording, 1000);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/rod-cpp", rod); }
