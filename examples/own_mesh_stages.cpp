// The four stages of a mesh (section 4.4 of the 1990 thesis), each replaced by a function of one's own and compared
// with what is built in: cloud-in-cell assignment, a solver by relaxation, central differences, linear interpolation.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

/// Calls f(node, weight) for the two nodes around x.
void around(MeshGrid const& grid, double x, auto const& f) {
  double const cell = std::floor((x - grid.low[0]) / grid.spacing[0]),
               right = (x - grid.low[0]) / grid.spacing[0] - cell;
  auto const n = grid.nodes[0], i = static_cast<std::size_t>(cell) % n;
  f(i, 1 - right);
  f((i + 1) % n, right);
}

void own_mesh_stages(Program& program) {
  Box const box({0}, {16}, Boundary::periodic);
  double const charge = 16.0 / 2000;
  Ensemble<Coulomb<1>> electrons("electrons", 2000);
  for (auto& p : electrons) p.mass = charge, p.charge = -charge;
  random_load(electrons, box, {.seed = program.seed()});
  maxwellian_load(electrons, {.temperature = charge, .seed = program.seed()});

  MeshScheme built_in(box, {32}, coulomb(1 / (4 * pi))), mesh(box, {32}, coulomb(1 / (4 * pi)));
  for (auto* scheme : {&built_in, &mesh}) {
    scheme->background(true);
    scheme->add(electrons);
  }

  mesh.density_assignment([&](MeshScheme&, MeshField& density) {
    density.components = {std::vector<double>(density.grid.size(), 1.0)};  // the background
    for (auto const& p : electrons)
      around(density.grid, p.position[0],
             [&](auto i, double weight) { density.at(i) += p.charge * weight / density.grid.spacing[0]; });
  });
  mesh.potential_calculation([](MeshScheme& scheme, MeshField const& density, MeshField& potential) {
    auto const n = density.grid.nodes[0];
    double const h2 = density.grid.spacing[0] * density.grid.spacing[0];
    for (int sweep = 0; sweep < 2000; ++sweep)  // successive over-relaxation, from the last potential on
      for (std::size_t i = 0; i < n; ++i) {
        double const both = potential.at((i + n - 1) % n) + potential.at((i + 1) % n);
        potential.at(i) += 1.8 * (0.5 * (both + h2 * scheme.constant() * density.at(i)) - potential.at(i));
      }
    auto& phi = potential.components[0];  // of which the mean is free: zero, as energies are counted
    double const mean = std::accumulate(phi.begin(), phi.end(), 0.0) / static_cast<double>(n);
    for (double& value : phi) value -= mean;
  });
  mesh.influence_field([](MeshScheme&, MeshField const& potential, MeshField& field) {
    auto const n = potential.grid.nodes[0];
    for (std::size_t i = 0; i < n; ++i)
      field.at(i) = (potential.at((i + n - 1) % n) - potential.at((i + 1) % n)) / (2 * potential.grid.spacing[0]);
  });
  mesh.interpolation([&](MeshScheme&, MeshField const& field, AnyEnsemble const&, std::vector<double>& E) {
    E.assign(electrons.size(), 0);
    for (std::size_t p = 0; p < electrons.size(); ++p)
      around(field.grid, electrons[p].position[0], [&](auto i, double weight) { E[p] += weight * field.at(i); });
  });

  built_in.calculate();
  std::vector<double> forces;
  for (std::size_t p = 0; p < electrons.size(); ++p) forces.push_back(electrons.influence_on(p)[0]);
  mesh.calculate();
  double largest = 0, difference = 0;
  for (std::size_t p = 0; p < electrons.size(); ++p) {
    largest = std::max(largest, std::abs(forces[p]));
    difference = std::max(difference, std::abs(electrons.influence_on(p)[0] - forces[p]));
  }
  std::printf("the two meshes' forces differ by %.1e of the largest\n", difference / largest);

  Simulation simulation(mesh, 0.1);
  Recording recording = program.recording(simulation);
  recording.diagnoses(5, {"energies", "momentum"}).trajectory(50).picture({.drawing = "mesh", .y = "potential"});
  program.run(recording, 200);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/own-mesh-stages-cpp", own_mesh_stages); }
