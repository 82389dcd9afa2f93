// The viscous and heat-conducting operator of smooth particles: exact coefficients on lattices, what is conserved, where
// entropy is produced, and no mode that is not damped. The time integrals are in tests/physics/viscous_flow_test.cpp.
#include <boltzmann/core/random.hpp>
#include <boltzmann/laws/material.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

namespace boltzmann::transport_test {
namespace {

/// No pressure: all that acts is viscosity and conduction.
struct Bare {
  TransportCoefficients coefficients;
  State state(auto const& p) const { return {.temperature = p.specific_energy, .sound_speed = 1}; }
  TransportCoefficients transport(auto const&) const { return coefficients; }
};

template <int D>
Vector<D> everywhere(double x) {
  Vector<D> v{};
  for (int a = 0; a < D; ++a) v[a] = x;
  return v;
}

/// A lattice of spacing 1 around the origin, density 1, in open space; particle 0 is at the origin.
template <int D, class Field>
std::unique_ptr<Ensemble<Smooth<D>>> lattice(double range, int half, Field const& field) {
  std::vector<Vector<D>> sites{Vector<D>{}};
  int const n = 2 * half + 1, count = D == 1 ? n : D == 2 ? n * n : n * n * n;
  for (int i = 0; i < count; ++i) {
    int const index[3] = {i % n - half, i / n % n - half, i / n / n - half};
    Vector<D> site{};
    for (int a = 0; a < D; ++a) site[a] = index[a];
    if (norm2(site) > 0) sites.push_back(site);
  }
  auto matter = std::make_unique<Ensemble<Smooth<D>>>("matter", sites.size());
  for (std::size_t i = 0; i < sites.size(); ++i) {
    auto& p = (*matter)[i];
    p.position = sites[i];
    p.mass = p.density = 1;
    p.range = range;
    field(p);
  }
  return matter;
}

template <int D>
SmoothInfluence<D, double> at_the_origin(Ensemble<Smooth<D>>& matter, TransportCoefficients const& transport,
                                         WeightShape shape) {
  SmoothScheme scheme(Box(everywhere<D>(-100), everywhere<D>(100), Boundary::open), shape);
  scheme.material(matter, Bare{transport});
  scheme.density_from(DensityFrom::continuity);
  scheme.calculate();
  return matter.influence_on(0);
}

/// Numbers that are no symmetry of the lattice.
double some(int a, int b = 0, int c = 0) { return std::sin(1.3 + 2.1 * a + 3.7 * b + 5.9 * c); }

template <int D>
void expect_exact_coefficients(double range, TransportCoefficients const& transport, WeightShape shape) {
  Tensor<D> gradient{};    // [a][b] = d v_b / d x_a
  double second[D][D][D];  // v_c = sum of second[c][a][b] x_a x_b
  for (int c = 0; c < D; ++c)
    for (int a = 0; a < D; ++a) {
      gradient[a][c] = some(a, c);
      for (int b = 0; b < D; ++b) second[c][a][b] = some(a, b, c);
    }
  int const half = static_cast<int>(2 * range) + 2;
  // Linear: the heat of 2 eta E:E + (zeta - 2 eta / D) (div v)^2, and no force.
  auto linear = lattice<D>(range, half, [&](auto& p) { p.velocity = dot(p.position, gradient); });
  auto const heated = at_the_origin(*linear, transport, shape);
  auto const strain = symmetric_part(gradient);
  double const eta = D == 1 ? 0 : transport.shear_viscosity, zeta = transport.bulk_viscosity;
  double const heat = 2 * eta * contraction(strain, strain) + (zeta - 2 * eta / D) * square(trace(strain));
  EXPECT_NEAR(heated.heating, heat, 1e-11 * (eta + zeta) + 1e-100) << D << "D, range " << range;
  EXPECT_LT(magnitude(heated.force), 1e-12 * (eta + zeta) + 1e-100);
  // Quadratic: the force eta laplacian v + (eta (1 - 2/D) + zeta) grad div v, the heat kappa laplacian T.
  auto quadratic = lattice<D>(range, half, [&](auto& p) {
    for (int c = 0; c < D; ++c)
      for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) p.velocity[c] += second[c][a][b] * p.position[a] * p.position[b];
  });
  auto const pushed = at_the_origin(*quadratic, transport, shape);
  for (int c = 0; c < D; ++c) {
    double laplacian = 0, along = 0;
    for (int a = 0; a < D; ++a) {
      laplacian += 2 * second[c][a][a];
      along += second[a][a][c] + second[a][c][a];
    }
    double const force = eta * laplacian + (eta * (1 - 2.0 / D) + zeta) * along;
    EXPECT_NEAR(pushed.force[c], force, 1e-11 * (eta + zeta) + 1e-100) << D << "D, range " << range << ", axis " << c;
  }
  auto warm =
      lattice<D>(range, half, [](auto& p) { p.specific_energy = 1000 + 3 * norm2(p.position) + p.position[0]; });
  EXPECT_NEAR(at_the_origin(*warm, transport, shape).heating, transport.conductivity * 6 * D, 1e-9);
}

TEST(Transport, CoefficientsAreExactOnLattices) {
  for (auto const shape : {WeightShape::lucy, WeightShape::wendland, WeightShape::quintic_spline})
    for (TransportCoefficients const& transport :
         {TransportCoefficients{0.7, 0, 0.3}, TransportCoefficients{0.7, 0.2, 0.3}, TransportCoefficients{0.1, 2, 0.3},
          TransportCoefficients{0, 0.5, 0}, TransportCoefficients{0.5, 5. / 3 * 0.5, 0.1}}) {
      expect_exact_coefficients<1>(3, transport, shape);
      expect_exact_coefficients<2>(2.4, transport, shape);
      expect_exact_coefficients<2>(3, transport, shape);
      expect_exact_coefficients<3>(2.2, transport, shape);
    }
}

/// Fluids of different viscosities and masses at random places in open space, with ranges of their own.
template <int D>
struct Drop {
  Ensemble<Smooth<D>> oil{"oil", 120}, water{"water", 130};
  SmoothScheme scheme{Box(everywhere<D>(-50), everywhere<D>(50), Boundary::open), WeightShape::wendland};

  Drop(TransportCoefficients const& of_oil, TransportCoefficients const& of_water, double spread) {
    fill(oil, 5, spread);
    fill(water, 6, spread);
    scheme.material(oil, Bare{of_oil});
    scheme.material(water, Bare{of_water});
  }
  void fill(Ensemble<Smooth<D>>& fluid, unsigned key, double spread) {
    for (std::size_t i = 0; i < fluid.size(); ++i) {
      Stream s(test_seed(key), 0, i, Purpose::position);
      auto& p = fluid[i];
      for (int a = 0; a < D; ++a) p.position[a] = 6 * s.uniform(), p.velocity[a] = s.normal();
      p.mass = 0.5 + s.uniform();
      p.specific_energy = 1 + s.uniform();
      p.range = 1.7 + spread * s.uniform();
    }
  }
  template <class Function>
  void each(Function const& f) {
    for (auto* fluid : {&oil, &water})
      for (std::size_t i = 0; i < fluid->size(); ++i) f((*fluid)[i], fluid->influence_on(i));
  }
};

/// r_a F_b - r_b F_a
template <int D>
Tensor<D> moment(Vector<D> const& r, Vector<D> const& force) {
  return outer(r, force) - outer(force, r);
}

template <int D>
void expect_conservation(TransportCoefficients const& oil, TransportCoefficients const& water, double spread) {
  Drop<D> drop(oil, water, spread);
  drop.scheme.calculate();
  Vector<D> momentum{};
  Tensor<D> angular{};
  double energy = 0, forces = 0, moments = 0, powers = 0;
  drop.each([&](auto const& p, auto const& influence) {
    momentum += influence.force;
    angular += moment<D>(p.position, influence.force);
    energy += dot(influence.force, p.velocity) + influence.heating;
    forces += magnitude(influence.force);
    moments += magnitude(influence.force) * magnitude(p.position);
    powers += std::abs(influence.heating);
    if (oil.conductivity == 0) {
      EXPECT_GE(influence.heating, -1e-13);  // no entropy is lost
    }
  });
  ASSERT_GT(powers, 1);
  EXPECT_LT(magnitude(momentum), 1e-14 * forces);
  EXPECT_LT(std::abs(energy), 2e-14 * powers);
  EXPECT_LT(std::sqrt(contraction(angular, angular)), 1e-13 * moments) << D << "D";
}

TEST(Transport, MomentumAngularMomentumAndEnergyAreConserved) {
  for (double const spread : {0.0, 0.6})
    for (auto const& [oil, water] : {std::pair{TransportCoefficients{2, 0, 0}, TransportCoefficients{0.1, 0.3, 0}},
                                     {TransportCoefficients{2, 9, 0}, TransportCoefficients{2, 0, 0}},
                                     {TransportCoefficients{2, 0.5, 0}, TransportCoefficients{0, 0, 0}},
                                     {TransportCoefficients{1, 0, 4}, TransportCoefficients{1, 0, 0.5}}}) {
      expect_conservation<2>(oil, water, spread);
      expect_conservation<3>(oil, water, spread);
    }
}

// A drop that turns as a rigid body: no force, no heat.
template <int D>
void expect_free_rotation(double spread) {
  Drop<D> drop({2, 0.5, 0}, {0.3, 0, 0}, spread);
  for (auto* fluid : {&drop.oil, &drop.water})
    for (auto& p : *fluid) {
      auto const r = p.position;
      p.velocity = {};
      p.velocity[0] = -3 * r[1];
      p.velocity[1] = 3 * r[0];
    }
  drop.scheme.calculate();
  drop.each([&](auto const&, auto const& influence) {
    EXPECT_LT(magnitude(influence.force), 1e-10);
    EXPECT_LT(std::abs(influence.heating), 1e-10);
  });
}

TEST(Transport, ADropTurnsFreely) {
  for (double const spread : {0.0, 0.6}) {
    expect_free_rotation<2>(spread);
    expect_free_rotation<3>(spread);
  }
}

// Heat flows from hot to cold between each two, whatever their conductivities; none through one that does not conduct.
TEST(Transport, HeatFlowsFromHotToCold) {
  Drop<3> drop({0, 0, 2}, {0, 0, 0.01}, 0.4);
  drop.scheme.calculate();
  double heat = 0, entropy = 0, flow = 0;
  drop.each([&](auto const& p, auto const& influence) {
    heat += influence.heating;
    entropy += influence.heating / p.temperature;
    flow += std::abs(influence.heating);
    EXPECT_LT(magnitude(influence.force), 1e-90);
  });
  EXPECT_LT(std::abs(heat), 1e-14 * flow);
  EXPECT_GT(entropy, 0.1 * flow);
  Drop<3> insulated({0, 0, 2}, {0, 0, 0}, 0.4);
  insulated.scheme.calculate();
  for (std::size_t i = 0; i < insulated.water.size(); ++i) {
    EXPECT_LT(std::abs(insulated.water.influence_on(i).heating), 1e-90);
  }
}

// The shortest waves that a lattice has, each with kinetic energy or heat that viscosity and conduction must take: rows
// that slide against their neighbours, along an axis and along the diagonal, and a checkerboard of temperatures. A field
// exp(i k x) in a continuum loses nu k^2 of itself; here k = pi / spacing, and at least 0.25 of that is required.
template <int D>
void expect_damping(double range, WeightShape shape) {
  double const pi = std::numbers::pi;
  auto const alternate = [](double x) { return std::abs(std::fmod(x, 2)) < 0.5 ? 1.0 : -1.0; };
  int const half = static_cast<int>(2 * range) + 2;
  TransportCoefficients const transport{0.7, 0.1, 0.4};
  auto rows = lattice<D>(range, half, [&](auto& p) { p.velocity[0] = alternate(p.position[1]); });
  EXPECT_LT(at_the_origin(*rows, transport, shape).force[0], -0.25 * 0.7 * pi * pi) << D << "D, range " << range;
  auto diagonal = lattice<D>(range, half, [&](auto& p) {
    p.velocity[0] = alternate(p.position[0] + p.position[1]);
    p.velocity[1] = -p.velocity[0];
  });
  EXPECT_LT(at_the_origin(*diagonal, transport, shape).force[0], -0.25 * 0.7 * pi * pi);
  auto along = lattice<D>(range, half, [&](auto& p) { p.velocity[0] = alternate(p.position[0]); });
  EXPECT_LT(at_the_origin(*along, transport, shape).force[0], -0.25 * 0.7 * pi * pi);
  auto board = lattice<D>(range, half, [&](auto& p) {
    double sum = 0;
    for (int a = 0; a < D; ++a) sum += p.position[a];
    p.specific_energy = 2 + alternate(sum);
  });
  EXPECT_LT(at_the_origin(*board, transport, shape).heating, -0.15 * 0.4 * pi * pi);
}

TEST(Transport, NoWaveIsLeftUndamped) {
  for (auto const shape : {WeightShape::lucy, WeightShape::cubic_spline}) {
    expect_damping<2>(2.4, shape);
    expect_damping<2>(3, shape);
    expect_damping<3>(2.4, shape);
  }
}

}  // namespace
}  // namespace boltzmann::transport_test
