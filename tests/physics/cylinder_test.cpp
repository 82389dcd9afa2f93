// Flow past a cylinder (section 6.5): the circle theorem, and streamlines that test particles stay on.
#include "shipped.hpp"

#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/particles/vortex.hpp>

#include <gtest/gtest.h>

#include <complex>

namespace boltzmann::cylinder_test {
namespace {

struct Line {
  std::complex<double> z;
  double circulation;
};

std::vector<Line> vortices_of(ScenarioSimulation& run) {
  std::vector<Line> lines;
  for (auto& e : run.ensembles)
    if (Field const* w = e->find_field("vorticity"))
      for (std::size_t i = 0; i < e->size(); ++i) lines.push_back({{e->row(i)[0], e->row(i)[1]}, e->row(i)[w->offset]});
  return lines;
}

// psi = - sum Gamma / (2 pi) ln |z - z_k|, with u = d psi / dy, v = - d psi / dx.
double stream_function(std::vector<Line> const& lines, std::complex<double> z) {
  double sum = 0;
  for (auto const& line : lines)
    if (line.circulation != 0) sum -= line.circulation / (2 * pi) * std::log(std::abs(z - line.z));
  return sum;
}

AnyEnsemble& tracers_of(ScenarioSimulation& run) {
  for (auto& e : run.ensembles)
    if (!e->find_field("vorticity")) return *e;
  throw std::runtime_error("no tracers");
}

TEST(Cylinder, StreamFunctionStaysConstantAlongEachTrack) {
  auto const run = shipped("cylinder");
  auto const lines = vortices_of(*run);
  auto& tracers = tracers_of(*run);
  ASSERT_GE(tracers.size(), 100u);
  std::vector<double> start(tracers.size());
  std::vector<std::complex<double>> from(tracers.size());
  double scale = 0;
  for (std::size_t i = 0; i < tracers.size(); ++i) {
    from[i] = {tracers.row(i)[0], tracers.row(i)[1]};
    start[i] = stream_function(lines, from[i]);
    scale = std::max(scale, std::abs(start[i]));
  }
  run->simulation->run(run->steps);
  double drift = 0, furthest = 0;
  for (std::size_t i = 0; i < tracers.size(); ++i) {
    std::complex<double> const z{tracers.row(i)[0], tracers.row(i)[1]};
    drift = std::max(drift, std::abs(stream_function(lines, z) - start[i]));
    furthest = std::max(furthest, std::abs(z - from[i]));
  }
  std::printf("[ CYLINDER ] stream function drifts by %.2g of %.2g; the furthest track is %.3g long\n", drift, scale,
              furthest);
  EXPECT_GT(furthest, 4);
  EXPECT_LT(drift, 1e-5);
}

TEST(Cylinder, NoFlowThroughTheCylinderAndTheCircleTheoremAlongIt) {
  auto const run = shipped("cylinder");
  auto const lines = vortices_of(*run);
  double const R = 1;
  Ensemble<Vortex<2>> vortices("vortices", lines.size());
  for (std::size_t k = 0; k < lines.size(); ++k) {
    vortices[k].position = {lines[k].z.real(), lines[k].z.imag()};
    vortices[k].vorticity = {lines[k].circulation};
  }
  int const count = 72;
  Ensemble<Tracer<2>> rim("rim", count);
  for (int i = 0; i < count; ++i)
    rim[i].position = {R * std::cos(2 * pi * i / count), R * std::sin(2 * pi * i / count)};
  PairScheme field(Box(Vector{-4., -4.}, Vector{4., 4.}));
  field.between(rim, vortices, one_way(BiotSavart{}));
  field.calculate();
  // Circle theorem for the outer vortices: w'(z) of each, its image and its balance in the centre.
  using Complex = std::complex<double>;
  for (int i = 0; i < count; ++i) {
    Vector<2> const v = rim.influence_on(i), n = rim[i].position;
    EXPECT_NEAR(dot(v, n), 0, 1e-12);
    Complex const z{n[0], n[1]};
    Complex conjugate_velocity = 0;
    for (auto const& line : lines)
      if (std::abs(line.z) > R) {
        Complex const image = R * R / std::conj(line.z);
        conjugate_velocity +=
            Complex(0, -line.circulation / (2 * pi)) * (1.0 / (z - line.z) - 1.0 / (z - image) + 1.0 / z);
      }
    EXPECT_NEAR(v[0], conjugate_velocity.real(), 1e-12);
    EXPECT_NEAR(v[1], -conjugate_velocity.imag(), 1e-12);
  }
  // Far vortices make a nearly uniform stream: on the flanks the speed is 2 U within the curvature of that stream.
  double U = 0;
  for (auto const& line : lines)
    if (std::abs(line.z) > R) U += std::abs(line.circulation) / (2 * pi * std::abs(line.z));
  EXPECT_NEAR(magnitude(rim.influence_on(count / 4)), 2 * U, 0.01 * 2 * U);
}

}  // namespace
}  // namespace boltzmann::cylinder_test
