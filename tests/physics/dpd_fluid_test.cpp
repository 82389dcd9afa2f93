// The fluid of Groot and Warren (J. Chem. Phys. 107, 4423, 1997): a = 25, density 3, sigma = 3, at temperature 1.
//
// Pressure: molecular dynamics of the same forces with a Langevin bath by another program, and a plain program of this
// model with steps of 0.01, agree on 23.65 and 23.640(6); the latter has the diffusion coefficient 0.292 (four units of
// time and more).
#include <tests/physics/statistics.hpp>
#include <tests/seed.hpp>

#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/dissipation/pair_dissipation.hpp>
#include <boltzmann/laws/soft.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

namespace boltzmann::dpd_fluid_test {
namespace {

constexpr double known_pressure = 23.645, known_diffusion = 0.292;

class DpdFluid : public testing::TestWithParam<DissipationMethod> {};

TEST_P(DpdFluid, TemperaturePressureAndDiffusion) {
  double const side = 8, dt = 0.04;
  Ensemble<Newton<3>> fluid("fluid", 1536);
  Box const box(Vector{0.0, 0.0, 0.0}, Vector{side, side, side}, Boundary::periodic);
  random_load(fluid, box, {.seed = test_seed(2)});
  maxwellian_load(fluid, {.temperature = 1, .seed = 2, .remove_drift = true});
  PairScheme scheme(box, 1);
  scheme.internal(fluid, Soft{25, 1});
  PairDissipation dpd(scheme, 1);
  dpd.internal(fluid, {.convention = Convention::fixed_temperature, .friction = 4.5, .temperature = 1, .range = 1});
  dpd.method(GetParam());
  dpd.corrector(GetParam() == DissipationMethod::simultaneous);
  Simulation simulation(scheme, dt);
  simulation.add(dpd);
  simulation.seed(test_seed(1));
  simulation.integrate(fluid, Method::leap_frog);
  simulation.run(500);

  std::vector<double> temperatures, pressures;
  std::vector<Vector<3>> velocity_sum(fluid.size());
  // Displacements over four and over one unit of time, from the places unwrapped step by step.
  int const every = 5, looks = 500, longest = 20, shortest = 5;  // of 0.2 each
  std::vector<std::vector<Vector<3>>> track;
  std::vector<Vector<3>> place(fluid.size()), last(fluid.size());
  for (std::size_t i = 0; i < fluid.size(); ++i) place[i] = last[i] = fluid[i].position;
  for (int look = 0; look < looks; ++look) {
    simulation.run(every);
    temperatures.push_back(temperature(fluid, 1, {.subtract_drift = true}).total);
    auto const p = pressure_tensor(fluid, simulation.measure(), box);
    pressures.push_back((p[0][0] + p[1][1] + p[2][2]) / 3);
    for (std::size_t i = 0; i < fluid.size(); ++i) {
      auto d = fluid[i].position - last[i];
      box.nearest_image(&d[0]);
      place[i] += d;
      last[i] = fluid[i].position;
    }
    track.push_back(place);
  }
  auto const displacement = [&](int lag) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t from = 0; from + lag < track.size(); from += 5, ++count)
      for (std::size_t i = 0; i < fluid.size(); ++i) sum += norm2(track[from + lag][i] - track[from][i]);
    return sum / static_cast<double>(count * fluid.size());
  };
  double const diffusion = (displacement(longest) - displacement(shortest)) / (6 * every * dt * (longest - shortest));
  auto const t = estimate(temperatures, 20), p = estimate(pressures, 20);
  std::printf("%s: temperature %.4f(%.4f) pressure %.3f(%.3f) diffusion %.4f\n", to_string(GetParam()).c_str(), t.mean,
              t.error, p.mean, p.error, diffusion);
  // Standard errors (of 10 runs) are 0.003, 0.008 and 0.0015; the step makes 0.01, 0.025 and -0.005. Five and that:
  EXPECT_NEAR(t.mean, 1, 0.026);
  EXPECT_NEAR(p.mean, known_pressure, 0.1);
  EXPECT_NEAR(diffusion / known_diffusion, 1, 0.05);
  auto const total = momentum(fluid);
  EXPECT_LT(std::hypot(total[0], total[1], total[2]), 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Methods, DpdFluid,
                         testing::Values(DissipationMethod::simultaneous, DissipationMethod::shardlow));

}  // namespace
}  // namespace boltzmann::dpd_fluid_test
