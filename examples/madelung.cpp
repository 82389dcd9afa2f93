// Madelung's constant of rock salt: the energy of a pair of ions in the field of all others, -1.747564594633 k q^2 / a.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

void madelung(Program& program) {
  Ensemble<Coulomb<3>> sodium("sodium"), chloride("chloride");
  LatticeBlock block{.kind = Lattice::fcc, .spacing = std::sqrt(2.0), .counts = {4, 4, 4}, .origin = {0.5, 0.5, 0.5}};
  Box const box({0, 0, 0}, {8, 8, 8}, Boundary::periodic);
  block_load(sodium, block);
  block.origin[0] += 1;
  block_load(chloride, block);
  for (auto& ion : sodium) ion.charge = 1;
  for (auto& ion : chloride) ion.charge = -1;

  MultipoleScheme scheme(box, coulomb(1), 1e-6);
  scheme.add(sodium);
  scheme.add(chloride);
  double const constant = -scheme.measure().potential / static_cast<double>(sodium.size());
  double const between = scheme.field_at<3>({{1.0, 1.0, 1.0}})[0].potential;  // as far from eight ions of each sign

  Simulation simulation(scheme, 0.01);
  Recording recording = program.recording(simulation);
  recording.diagnoses(5, {"energies"}).trajectory(5).picture({});
  program.run(recording, 10);
  std::printf("Madelung's constant %.10f; the potential between eight ions %.1e\n", constant, between);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/madelung-cpp", madelung); }
