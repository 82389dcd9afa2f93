// Free expansions (scenarios/free-expansion.toml, free-expansion-1d.toml): the entropy that a gas gains though nothing
// heats it, what is conserved, smooth particles as atoms, and rarefactions into vacuum.
#include <tests/physics/smooth_gas.hpp>

#include <boltzmann/diagnoses/entropy.hpp>
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/laws/materials/isentropic_gas.hpp>
#include <boltzmann/loaders/jitter.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace boltzmann {
namespace {

/// n x n particles of mass 1 in the middle of a box four times as large, on a jittered lattice of spacing 1.
struct Fourfold {
  double n;
  Box box;
  Ensemble<Smooth<2>> gas{"gas"};
  SmoothScheme scheme;

  Fourfold(std::size_t count, double range, Boundary boundary)
      : n(static_cast<double>(count)), box(Vector{0.0, 0.0}, Vector{2 * n, 2 * n}, boundary), scheme(box) {
    fill<2>(gas, Vector{n / 2, n / 2}, 1, {count, count});
    jitter(gas, 0.1, 1);
    for (auto& p : gas) p.mass = 1, p.range = range;
    scheme.material(gas, QuadraticGas{});
  }
  double entropy(double Entropy::*how) {
    scheme.complete(0);
    return smooth_entropy({gas}, box).with_fluctuations.*how;
  }
};

struct Gain {
  double sum, integral, energy_drift, momentum, without, full;
};

/// Over two sound times.
Gain expand(std::size_t count, double range, Boundary boundary) {
  Fourfold run(count, range, boundary);
  Simulation simulation(run.scheme, 0.25);
  simulation.integrate(run.gas, Method::rk4);
  double const energy = total_energy(run.scheme, run.gas);
  SmoothEntropy const before = smooth_entropy({run.gas}, run.box);
  simulation.run(static_cast<std::uint64_t>(2 * run.box.length(0) / 0.25));
  Gain gain{};
  gain.energy_drift = std::abs(total_energy(run.scheme, run.gas) / energy - 1);
  gain.momentum = momentum_share(run.gas);
  SmoothEntropy const after = smooth_entropy({run.gas}, run.box);
  gain.sum = after.with_fluctuations.sum - before.with_fluctuations.sum;
  gain.integral = after.with_fluctuations.integral - before.with_fluctuations.integral;
  gain.without = after.without_fluctuations.sum - before.without_fluctuations.sum;
  gain.full = after.with_all_motion.sum - before.with_all_motion.sum;
  std::printf("range %g: sum %.4f integral %.4f without %.4f full %.4f energy %.2e momentum %.2e\n", range, gain.sum,
              gain.integral, gain.without, gain.full, gain.energy_drift, gain.momentum);
  return gain;
}

// 4,096 particles, against an independent program's numbers. ln 4 = 1.386 is approached from below as the range grows.
TEST(FreeExpansion, GainsTheEntropyOfFourfoldSpace) {
  Gain const near = expand(64, 3, Boundary::periodic), far = expand(64, 6, Boundary::periodic);
  EXPECT_NEAR(near.sum, 0.652, 0.02 * 0.652);
  EXPECT_NEAR(near.integral, 0.921, 0.02 * 0.921);
  EXPECT_NEAR(far.sum, 1.150, 0.02 * 1.150);
  EXPECT_NEAR(far.integral, 1.179, 0.02 * 1.179);
  for (Gain const& gain : {near, far}) {
    EXPECT_LT(gain.energy_drift, 2e-6);
    EXPECT_LT(gain.momentum, 1e-14);
    EXPECT_NEAR(gain.without, 0, 0.02);  // each particle stays on its isentrope
    EXPECT_GT(gain.full, gain.sum);
  }
  EXPECT_GT(far.sum, near.sum);
  EXPECT_LT(far.integral, std::log(4));
}

// With P = rho^2 / 2 the acceleration is Eq 20: atoms with the weight as pair potential.
struct WeightAsPotential {
  double range;
  static constexpr Symmetry symmetry = Symmetry::antisymmetric;
  template <class P, class Q>
  auto operator()(P const& p, Q const& q) const {
    using Real = decltype(p.mass);
    auto const r = q.position - p.position;
    auto const w = weigh<Lucy, 2>(dot(r, r), Real(range), Real(1 / range));
    return Interaction{r * w.slope, w.value};
  }
  double length_scale() const { return range; }
};

TEST(FreeExpansion, IsMolecularDynamicsWithTheWeightAsPotential) {
  for (double const range : {3.0, 6.0}) {
    Fourfold run(24, range, Boundary::periodic);
    Ensemble<Newton<2>> atoms("atoms", run.gas.size());
    for (std::size_t i = 0; i < atoms.size(); ++i) atoms[i].position = run.gas[i].position, atoms[i].mass = 1;
    PairScheme pairs(run.box, range);
    pairs.internal(atoms, WeightAsPotential{range});
    Simulation continuum(run.scheme, 0.25), molecules(pairs, 0.25);
    continuum.integrate(run.gas, Method::rk4);
    molecules.integrate(atoms, Method::rk4);
    double const energy = total_energy(run.scheme, run.gas);
    continuum.run(200);
    molecules.run(200);
    double apart = 0, moved = 0;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
      apart = std::max(apart, magnitude(atoms[i].position - run.gas[i].position));
      moved = std::max(moved, magnitude(run.gas[i].velocity) * 50);
    }
    EXPECT_LT(apart, 1e-10) << "range " << range;
    EXPECT_GT(moved, 20);
    // The potential energy, with w(0)/2 for each, is the internal energy.
    double kinetic = 0;
    for (auto const& a : atoms) kinetic += 0.5 * norm2(a.velocity);
    double const self = 0.5 * weight_at(WeightShape::lucy, 2, 0, range).value * static_cast<double>(atoms.size());
    EXPECT_NEAR(kinetic + pairs.measure().potential + self, energy, 1e-5 * energy);
  }
}

// Study 1: a gas of one degree of freedom, gamma = 3: P = 2 rho e, in twice its space.
struct Twofold {
  double sum, integral, energy_drift;
};
Twofold expand_1d(std::size_t count, double spacings, double until) {
  double const n = static_cast<double>(count);
  Box const box(Vector{0.0}, Vector{2 * n}, Boundary::mirror);
  Ensemble<Smooth<1>> gas("gas");
  fill<1>(gas, Vector{n / 2}, 1, {count});
  jitter(gas, 0.1, 1);
  for (auto& p : gas) p.mass = 1, p.range = spacings, p.specific_energy = 1.0 / 6;
  SmoothScheme scheme(box);
  scheme.material(gas, IdealGas{3});
  Simulation simulation(scheme, 0.1);
  simulation.integrate(gas, Method::rk4);
  double const energy = total_energy(scheme, gas);
  SmoothEntropy const before = smooth_entropy({gas}, box);
  simulation.run(static_cast<std::uint64_t>(until * 2 * n / 0.1));
  Twofold result{};
  result.energy_drift = std::abs(total_energy(scheme, gas) / energy - 1);
  SmoothEntropy const after = smooth_entropy({gas}, box);
  result.sum = after.with_fluctuations.sum - before.with_fluctuations.sum;
  result.integral = after.with_fluctuations.integral - before.with_fluctuations.integral;
  std::printf("1D range %g: sum %.4f integral %.4f energy %.1e\n", spacings, result.sum, result.integral,
              result.energy_drift);
  return result;
}
TEST(FreeExpansion1D, ApproachesTheEntropyOfTwofoldSpace) {
  for (double t : {2., 4., 8.})
    for (double s : {3., 6., 12., 24.}) expand_1d(512, s, t);
}

}  // namespace
}  // namespace boltzmann
