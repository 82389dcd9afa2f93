// M. R. Shirts' check of ensembles (J. Chem. Theory Comput. 9, 909 (2013)): at two temperatures the logarithm of the ratio
// of the distributions of the energy is a straight line with the slope of -(1/kT2 - 1/kT1), at two pressures that of the
// volumes one with the slope -(P2 - P1) / kT.
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/dissipation/nose_hoover.hpp>
#include <boltzmann/dissipation/velocity_rescaling.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include "statistics.hpp"

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace boltzmann::ensembles_test {
namespace {

/// 27 atoms, and what they are looked at for.
struct Fluid {
  Ensemble<Newton<3>> atoms{"atoms"};
  PairScheme scheme;
  Simulation simulation;
  std::vector<double> energies, volumes;

  explicit Fluid(double spacing) : scheme(box(spacing), 1.8), simulation(scheme, 0.004) {
    atoms.resize(27);
    for (std::size_t i = 0; i < 27; ++i) {
      atoms[i].mass = 1;
      Stream stream(test_seed(1), 0, i, Purpose::user);
      for (int a = 0; a < 3; ++a) atoms[i].velocity[a] = stream.normal();
      atoms[i].position = {spacing * (0.5 + static_cast<double>(i % 3)),
                           spacing * (0.5 + static_cast<double>(i / 3 % 3)),
                           spacing * (0.5 + static_cast<double>(i / 9))};
    }
    scheme.internal(atoms, LennardJones{1, 1.12});
    simulation.seed(test_seed(2));
  }
  static Box box(double spacing) {
    double const side = 3 * spacing;
    return Box({0.0, 0.0, 0.0}, {side, side, side}, Boundary::periodic);
  }
  void run(int samples, int every) {
    simulation.run(2000);
    simulation.observe(static_cast<std::uint64_t>(every), [&](Simulation const& now) {
      double const drift =
          std::pow(momentum(atoms)[0], 2) + std::pow(momentum(atoms)[1], 2) + std::pow(momentum(atoms)[2], 2);
      energies.push_back(kinetic_energy(atoms) - drift / 54 + now.measure().potential);
      volumes.push_back(scheme.box().volume());
    });
    simulation.run(static_cast<std::uint64_t>(samples * every));
  }
};

/// The slope of ln(p2 / p1) of the samples by maximum likelihood: those of p2 among all have the part 1 / (1 + exp(-a - b
/// x)). From part `from` to part `to` of each series.
double slope(std::vector<double> const& first, std::vector<double> const& second, double from = 0, double to = 1) {
  double middle = 0, width = 0;
  for (auto const* series : {&first, &second}) middle += 0.5 * estimate(*series).mean;
  for (double const x : first) width += std::abs(x - middle) / static_cast<double>(first.size());
  double a = 0, b = 0;
  for (int iteration = 0; iteration < 40; ++iteration) {  // Newton
    double g0 = 0, g1 = 0, h00 = 0, h01 = 0, h11 = 0;
    for (auto const* series : {&first, &second}) {
      auto const n = static_cast<double>(series->size());
      for (auto i = static_cast<std::size_t>(from * n); i < static_cast<std::size_t>(to * n); ++i) {
        double const x = ((*series)[i] - middle) / width, p = 1 / (1 + std::exp(-a - b * x));
        double const left = (series == &second ? 1 : 0) - p, weight = p * (1 - p);
        g0 += left, g1 += left * x;
        h00 += weight, h01 += weight * x, h11 += weight * x * x;
      }
    }
    double const determinant = h00 * h11 - h01 * h01;
    a += (h11 * g0 - h01 * g1) / determinant;
    b += (h00 * g1 - h01 * g0) / determinant;
  }
  return b / width;
}

void expect_slope(std::vector<double> const& first, std::vector<double> const& second, double right,
                  std::string const& what) {
  std::vector<double> parts;
  for (int k = 0; k < 10; ++k) parts.push_back(slope(first, second, 0.1 * k, 0.1 * (k + 1)));
  double const error = estimate(parts).error, found = slope(first, second);
  EXPECT_NEAR(found, right, 5 * error) << what;
  EXPECT_LT(error, 0.08 * std::abs(right)) << what;
}

template <class Bath>
void expect_canonical(double rate, int every, std::string const& what) {
  std::vector<double> energies[2];
  double const temperature[2] = {1.3, 1.9};
  for (int const k : {0, 1}) {
    Fluid fluid(1.25);
    Bath bath(temperature[k], rate, 1);
    bath.on(fluid.atoms);
    fluid.simulation.add(bath);
    fluid.run(2400, every);
    energies[k] = fluid.energies;
  }
  expect_slope(energies[0], energies[1], 1 / temperature[0] - 1 / temperature[1], what);
}

TEST(Ensembles, TwoTemperatures) {
  expect_canonical<VelocityRescaling>(8, 20, "velocity rescaling");
  expect_canonical<NoseHooverChain>(8, 40, "chain of Nose and Hoover");
}

TEST(Ensembles, TwoPressures) {
  std::vector<double> volumes[2];
  double const pressure[2] = {1.0, 1.6}, temperature = 2;
  for (int const k : {0, 1}) {
    Fluid fluid(1.35);
    VelocityRescaling bath(temperature, 8, 1);
    bath.on(fluid.atoms);
    fluid.simulation.add(bath);
    fluid.simulation.add(Barostat(
        {.pressure = pressure[k], .temperature = temperature, .compressibility = 0.3, .rate = 20, .every = 5}, 1));
    fluid.run(3200, 30);
    volumes[k] = fluid.volumes;
  }
  expect_slope(volumes[0], volumes[1], (pressure[0] - pressure[1]) / temperature, "volumes");
}

}  // namespace
}  // namespace boltzmann::ensembles_test
