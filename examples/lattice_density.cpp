// How even is the density of a perfect lattice (study 3 of Hoover and Hoover's SPAM), and how right the gradient of a
// linear field on it (Eq 18)? For ten ranges; the particles have mass and spacing 1.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

// A material that writes down the gradients that it is given: no pressure, no fluxes.
struct Recorder {
  Gradients<2>* of_the_middle;
  State state(auto const&) const { return {}; }
  Fluxes<2> fluxes(auto const& p, Gradients<2> const& gradients) const {
    if (magnitude(p.position) < 0.5) *of_the_middle = gradients;
    return {};
  }
};

void lattice_density(Program&) {
  std::printf("range   1D min       1D max       2D min       2D max       gradient/exact\n");
  for (int k = 0; k < 10; ++k) {
    double const range = 1.5 + 0.5 * k;
    auto const line = lattice_density_extremes(1, WeightShape::lucy, range);
    auto const square = lattice_density_extremes(2, WeightShape::lucy, range);

    Ensemble<Smooth<2>> sheared("sheared");
    fill_load(sheared, {.spacing = 1, .low = {-15.5, -15.5}, .high = {15.5, 15.5}, .density = 1, .range = range});
    for (auto& p : sheared) p.velocity = {p.position[1], 0};
    Gradients<2> gradients{};
    SmoothScheme scheme(Box({-16, -16}, {16, 16}));
    scheme.material(sheared, Recorder{&gradients});
    scheme.calculate(0);
    std::printf("%4.1f %12.10f %12.10f %12.10f %12.10f  %.6f\n", range, line.least, line.greatest, square.least,
                square.greatest, gradients.velocity[1][0]);
  }
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/lattice-density-cpp", lattice_density); }
