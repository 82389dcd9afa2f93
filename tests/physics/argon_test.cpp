// Liquid argon (scenarios/argon.toml): structure and transport of the fluid of Lennard and Jones near its triple point.
//
// L. Verlet, Phys. Rev. 165, 201 (1968), has the first peak of g(r) there at 1.09 sigma, about 3 high.
#include "tests/bzm/command.hpp"

#include <tests/physics/shipped.hpp>

#include <boltzmann/core/units.hpp>
#include <boltzmann/diagnoses/average.hpp>
#include <boltzmann/diagnoses/radial_distribution.hpp>
#include <boltzmann/diagnoses/structure_factor.hpp>
#include <boltzmann/files/csv.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/scenario/scenario_recording.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace boltzmann::argon_test {
namespace {

constexpr double sigma = 3.405, depth_in_kelvin = 119.8;

template <class D>
D const& diagnosis(Recording const& recording) {
  for (auto const* one : recording.instruments())
    if (auto const* found = dynamic_cast<D const*>(one)) return *found;
  throw Error("no such diagnosis");
}

/// The pressure of pairs, - rho^2 / 6 times the integral of r u'(r) g(r) 4 pi r^2, in units of depth / sigma^3.
double pressure_of_pairs(RadialDistribution const& found, double density) {
  auto const r = found.distances(), g = found.g();
  double const width = (r[1] - r[0]) / sigma;
  double sum = 0;
  for (std::size_t k = 0; k < r.size(); ++k) {
    double const x = r[k] / sigma;
    if (x > 2.5 || g[k] == 0) continue;
    double const s6 = std::pow(x, -6), derivative = -24 * (2 * s6 * s6 - s6) / x;
    sum += width * 4 * std::numbers::pi * x * x * g[k] * x * derivative;
  }
  return -density * density / 6 * sum;
}

TEST(Argon, IsALiquid) {
  test::Folder folder;
  Overrides overrides;
  overrides.set = {"diagnoses.3.count=800", "diagnoses.4.every=500"};
  overrides.steps = 2500;
  auto const run = shipped("argon", overrides);
  auto const recording = make_recording(*run, (folder / "run").string(), {});
  run_with_progress(*recording, static_cast<std::uint64_t>(run->steps), {.quiet = true});
  auto const rows = read_csv((folder / "run/diagnoses.csv").string());
  auto const last = [&](std::string const& name) {
    for (std::size_t c = 0; c < rows.header.size(); ++c)
      if (rows.header[c].substr(0, rows.header[c].find(" (")) == name) return rows.columns[c].back();
    throw Error("there is no column " + name);
  };

  double const temperature = last("temperature mean") / depth_in_kelvin;
  // The bath leaves it with one energy out of those that a temperature has: five standard errors of 864 atoms.
  EXPECT_NEAR(temperature, 0.722, 0.08);
  EXPECT_NEAR(last("g peak distance") / sigma, 1.09, 0.015);
  EXPECT_NEAR(last("g peak"), 3.0, 0.12);
  // Its partners are those of the pressure: what pairs add to rho k T.
  auto const& g = diagnosis<RadialDistribution>(*recording);
  UnitSystem const base = run->units;
  double const unit = base(constants::boltzmann) * depth_in_kelvin / (sigma * sigma * sigma);
  double const pressure = diagnosis<Average>(*recording).mean(2).mean / unit;
  EXPECT_NEAR(pressure_of_pairs(g, 0.8442) + 0.8442 * temperature, pressure, 0.025);
  double neighbours = 0;
  for (std::size_t k = 0; k < g.distances().size(); ++k)
    if (g.distances()[k] < 1.55 * sigma) neighbours = g.coordination()[k];
  EXPECT_NEAR(neighbours, 12.6, 0.5);
  EXPECT_NEAR(g.g().back(), 1, 0.02);

  // The crystal has gone: its peak (111) would be 864 high.
  auto const& waves = diagnosis<StructureFactor>(*recording);
  auto const s = waves.s_of_modes();
  EXPECT_LT(*std::max_element(s.begin(), s.end()), 30);
  EXPECT_NEAR(last("S peak wave number") * sigma, 6.8, 0.4);
  // Two ways to one coefficient.
  double const by_velocities = last("diffusion coefficient from velocities"),
               by_places = last("diffusion coefficient from displacements");
  EXPECT_NEAR(by_velocities / by_places, 1, 0.12);
  double const speed = std::sqrt(base(constants::boltzmann) * depth_in_kelvin / base(39.948 * units::amu));
  std::printf("T* %.4f, peak %.3f at %.4f, neighbours %.2f, P* %.3f = %.3f, S %.2f at %.3f, D* %.4f = %.4f\n",
              temperature, last("g peak"), last("g peak distance") / sigma, neighbours, pressure,
              pressure_of_pairs(g, 0.8442) + 0.8442 * temperature, last("S peak"), last("S peak wave number") * sigma,
              by_velocities / (sigma * speed), by_places / (sigma * speed));
}

}  // namespace
}  // namespace boltzmann::argon_test
