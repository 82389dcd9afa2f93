// A cold plasma on a mesh oscillates with the frequency that the mesh's own theory gives, in one to three dimensions.
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>
#include <tests/schemes/mesh_systems.hpp>

#include <gtest/gtest.h>

namespace boltzmann::mesh_plasma_test {
namespace {

using namespace boltzmann::mesh_tests;

struct Wave {
  std::size_t cells;  ///< along each axis
  int mode;           ///< along x; along the other axes none
  int order;
  PoissonForm form;
  double step;  ///< wp dt
  bool general = false;
};

struct Measured {
  double frequency;     ///< of the oscillation, in units of wp
  double acceleration;  ///< at the start: of the displaced wave, as a part of its displacement
};

/// Electrons on a lattice of `per_cell` to a cell and axis, displaced along x by a small sine wave. The frequency comes
/// from the times at which the wave of velocities changes its sign: waves that don't oscillate have none.
template <int D>
Measured measure_wave(Wave const& wave, std::size_t per_cell) {
  std::size_t const side = wave.cells * per_cell;
  std::size_t count = 1;
  for (int a = 0; a < D; ++a) count *= side;
  Ensemble<Coulomb<D>> electrons("electrons", count);
  double const k = 2 * std::numbers::pi * wave.mode, amplitude = 1e-4 / static_cast<double>(side);
  std::vector<double> start(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t rest = i;
    for (int a = 0; a < D; ++a) {
      electrons[i].position[a] = (static_cast<double>(rest % side) + 0.5) / static_cast<double>(side);
      rest /= side;
    }
    start[i] = electrons[i].position[0];
    electrons[i].position[0] += amplitude * std::sin(k * start[i]);
    // wp = 1 with density 1 of charge and of mass, and C = 1.
    electrons[i].charge = -1 / static_cast<double>(count);
    electrons[i].mass = 1 / static_cast<double>(count);
  }
  MeshScheme mesh(box_of(filled<D>(1.0), Boundary::periodic), std::vector<std::size_t>(D, wave.cells), LaplaceLaw{1});
  mesh.background(true);
  mesh.assignment(wave.order);
  mesh.form(wave.form);
  if (wave.general)
    mesh.density_assignment([](MeshScheme& scheme, MeshField& density) { scheme.assign_density(density); });
  mesh.add(electrons);
  mesh.calculate();
  Measured result{0, 0};
  for (std::size_t i = 0; i < count; ++i) result.acceleration += electrons.influence_on(i)[0] * std::sin(k * start[i]);
  result.acceleration *= 2 / amplitude;
  Simulation simulation(mesh, wave.step);
  simulation.integrate(electrons, Method::leap_frog);
  double before = 0, first = 0, last = 0;
  int crossings = 0;
  simulation.observe(1, [&](Simulation const& s) {
    double now = 0;
    for (std::size_t i = 0; i < count; ++i) now += electrons[i].velocity[0] * std::sin(k * start[i]);
    if (before * now < 0) {
      double const time = s.time() - wave.step * now / (now - before);
      if (crossings++ == 0) first = time;
      last = time;
    }
    before = now;
  });
  simulation.run(static_cast<std::uint64_t>(std::lround((D == 3 ? 16 : 40) / wave.step)));
  result.frequency = std::numbers::pi * (crossings - 1) / (last - first);
  return result;
}

/// What the mesh makes of the field 1/k: in differences sin(kh)/h over (2 sin(kh/2)/h)^2.
double field_of(Wave const& wave, double q) {
  return wave.form == PoissonForm::spectral ? 1 / q : std::cos(q) / std::sin(q);
}

/// wc^2 of VERIFICATION, what a displaced wave is pulled back with: CIC with differences cos q (sin q/q)^3.
double pull(Wave const& wave) {
  double const q = std::numbers::pi * wave.mode / static_cast<double>(wave.cells);  // k h/2
  return q * field_of(wave, q) * std::pow(std::sin(q) / q, 2 * wave.order);
}

/// The frequency of the whole with leap-frog, sin(w dt/2) = wc dt/2: the mesh has waves that differ by whole turns in a
/// cell for one, so that the oscillation consists of all of them (Birdsall and Langdon, section 8.10).
double exact_frequency(Wave const& wave) {
  double const q = std::numbers::pi * wave.mode / static_cast<double>(wave.cells);
  double sum = q * std::pow(std::sin(q) / q, 2 * wave.order);
  for (int m = 1; m < 1000; ++m)
    for (double const alias : {q + std::numbers::pi * m, q - std::numbers::pi * m})
      sum += alias * std::pow(std::sin(q) / alias, 2 * wave.order);
  return 2 / wave.step * std::asin(std::sqrt(sum * field_of(wave, q)) * wave.step / 2);
}

template <int D>
void expect_dispersion(Wave const& wave, std::size_t per_cell) {
  auto const measured = measure_wave<D>(wave, per_cell);
  double const exact = exact_frequency(wave);
  EXPECT_NEAR(-measured.acceleration / pull(wave), 1, 1e-3) << D << "D, order " << wave.order << ", mode " << wave.mode;
  EXPECT_NEAR(measured.frequency / exact, 1, 1e-3)
      << D << "D, order " << wave.order << ", mode " << wave.mode << " of " << wave.cells
      << (wave.form == PoissonForm::spectral ? ", spectral" : "");
  EXPECT_GT(std::abs(exact - 1), 0.005);  // far enough from the frequency without a mesh
}

TEST(ColdPlasma, FormulasOfThePage) {
  // CIC with differences wp^2 cos q (sin q/q)^3, TSC (sin q/q)^5 cos q, CIC spectral (sin q/q)^4.
  double const q = std::numbers::pi / 8, s = std::sin(q) / q;
  EXPECT_NEAR(pull({8, 1, 2, PoissonForm::finite_difference, 0.1}), std::cos(q) * s * s * s, 1e-12);
  EXPECT_NEAR(pull({8, 1, 3, PoissonForm::finite_difference, 0.1}), std::cos(q) * std::pow(s, 5), 1e-12);
  EXPECT_NEAR(pull({8, 1, 2, PoissonForm::spectral, 0.1}), std::pow(s, 4), 1e-12);
  // On long waves the others don't matter.
  Wave const wave{64, 2, 2, PoissonForm::finite_difference, 0.2};
  EXPECT_NEAR(exact_frequency(wave), 10 * std::asin(0.1 * std::sqrt(pull(wave))), 1e-4);
}

TEST(ColdPlasma, Dispersion1D) {
  for (bool const general : {false, true})
    for (auto const form : {PoissonForm::finite_difference, PoissonForm::spectral})
      for (int const order : {2, 3})
        for (int const mode : {1, 2, 4}) expect_dispersion<1>({16, mode, order, form, 0.2, general}, 64);
  // Large steps, and orders that only the general path has.
  expect_dispersion<1>({16, 3, 2, PoissonForm::finite_difference, 1.0}, 64);
  expect_dispersion<1>({16, 3, 5, PoissonForm::spectral, 0.2}, 64);
}

TEST(ColdPlasma, Dispersion2D) {
  for (auto const form : {PoissonForm::finite_difference, PoissonForm::spectral})
    for (int const order : {2, 3})
      for (int const mode : {1, 2}) expect_dispersion<2>({8, mode, order, form, 0.2}, 16);
}

TEST(ColdPlasma, Dispersion3D) {
  for (auto const form : {PoissonForm::finite_difference, PoissonForm::spectral})
    for (int const order : {2, 3}) expect_dispersion<3>({8, 1, order, form, 0.2}, 6);
}

}  // namespace
}  // namespace boltzmann::mesh_plasma_test
