// A potential that is screened as in an electrolyte: laplacian phi - phi/lambda^2 = -C rho, by iteration in 1D.
#include <boltzmann/boltzmann.hpp>

#include <cmath>
#include <cstdio>

using namespace boltzmann;

int main() {
  MeshScheme mesh(Box({0}, {20}, Boundary::periodic), {200}, coulomb(1));
  double const lambda = 1;
  mesh.potential_calculation([lambda](MeshScheme& scheme, MeshField const& density, MeshField& potential) {
    std::size_t const n = density.grid.nodes[0];
    double const h2 = density.grid.spacing[0] * density.grid.spacing[0];
    for (int sweep = 0; sweep < 4000; ++sweep)  // Gauss and Seidel
      for (std::size_t i = 0; i < n; ++i)
        potential.at(i) = (potential.at((i + 1) % n) + potential.at((i + n - 1) % n) +
                           h2 * scheme.constant() * density.at(i)) / (2 + h2 / (lambda * lambda));
  });
  mesh.background(true);  // screening makes any box neutral
  Ensemble<Coulomb<1>> ions("ions", 1);
  ions[0].position = {10.};
  ions[0].charge = 1;
  mesh.add(ions);
  MeshField const& potential = *mesh.mesh_fields()[1];
  double const ratio = potential.at(130) / potential.at(120);  // one lambda further
  std::printf("falls by %.4f, exp(-1) = %.4f\n", ratio, std::exp(-1.0));
  return std::abs(ratio / std::exp(-1.0) - 1) < 0.01 ? 0 : 1;
}
