// Flows that a sheared box drives (Lees and Edwards): what is exact, and the viscosities of fluids against published
// values, theory and the power that their baths take up.
#include <tests/physics/statistics.hpp>
#include <tests/seed.hpp>

#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/dissipation/langevin_bath.hpp>
#include <boltzmann/dissipation/pair_dissipation.hpp>
#include <boltzmann/dissipation/velocity_rescaling.hpp>
#include <boltzmann/laws/angular.hpp>
#include <boltzmann/laws/fene.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/laws/materials/newtonian.hpp>
#include <boltzmann/laws/materials/tait.hpp>
#include <boltzmann/laws/soft.hpp>
#include <boltzmann/laws/spring.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/smooth.hpp>
#include <boltzmann/schemes/many_body/embedded_atom_scheme.hpp>
#include <boltzmann/schemes/molecules/molecule_scheme.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <numbers>
#include <vector>

namespace boltzmann::shear_flow_test {
namespace {

template <int D>
Box sheared(double side, Shear const& shear) {
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = 0, high[a] = side;
  Box box(low, high, Boundary::periodic);
  box.shear(shear);
  return box;
}

template <int D>
double peculiar_energy(Ensemble<Newton<D>> const& e, Box const& box) {
  double sum = 0;
  for (auto const& p : e) {
    auto c = p.velocity;
    c[box.shear().flow] -= box.flow_velocity(&p.position[0]);
    sum += 0.5 * p.mass * norm2(c);
  }
  return sum;
}

// ---- exact --------------------------------------------------------------------------------------------------------

/// Without collisions every particle goes straight on, seen from where its images were at the start.
template <int D>
void expect_straight_lines(Shear const& shear) {
  double const side = 3, dt = 0.01;
  PairScheme scheme(sheared<D>(side, shear), 1);
  Ensemble<Newton<D>> gas("gas", 60);
  random_load(gas, scheme.box(), {.seed = test_seed(1)});
  for (auto& p : gas) p.mass = 1;
  maxwellian_load(gas, {.temperature = 1, .seed = test_seed(2), .remove_drift = true});
  scheme.add(gas);
  auto start = std::vector(gas.begin(), gas.end());
  if (shear.established)
    for (auto& p : start) p.velocity[shear.flow] += shear.rate * (p.position[shear.gradient] - side / 2);
  Simulation simulation(scheme, dt);
  int crossings = 0;
  for (int n = 1; n <= 8; ++n) {
    simulation.run(100);
    double const t = simulation.time(), slide = shear.rate * side * t;
    for (std::size_t i = 0; i < gas.size(); ++i) {
      Vector<D> x = start[i].position + t * start[i].velocity, v = start[i].velocity;
      double const up = std::floor(x[shear.gradient] / side);
      x[shear.flow] -= up * slide;
      v[shear.flow] -= up * shear.rate * side;
      crossings += up != 0 ? 1 : 0;
      for (int a = 0; a < D; ++a) {
        double const apart = (gas[i].position[a] - x[a]) / side;
        ASSERT_NEAR(apart, std::nearbyint(apart), 1e-11) << i << " " << a;
        ASSERT_NEAR(gas[i].velocity[a], v[a], 1e-11) << i << " " << a;
        ASSERT_TRUE(gas[i].position[a] >= 0 && gas[i].position[a] < side);
      }
    }
  }
  EXPECT_GT(crossings, 100);
}

TEST(ShearFlow, WithoutCollisionsEveryParticleGoesStraightOn) {
  expect_straight_lines<2>({0.7, 0, 1, false});
  expect_straight_lines<2>({-2, 1, 0, true});
  expect_straight_lines<3>({1.3, 2, 0, true});
}

/// A spring of length 1 with a dashpot.
struct Dashpot {
  static constexpr bool velocity_dependent = true;
  static constexpr Symmetry symmetry = Symmetry::antisymmetric;
  template <class P>
  auto operator()(P const& p, P const& q) const {
    return 3.0 * (p.position - q.position) + 2.0 * (q.velocity - p.velocity);
  }
};

// Two particles on both sides of the gradient's end, as the images have slid by more than a box.
TEST(ShearFlow, AcrossTheGradientActsTheImageThatIsThere) {
  double const side = 4, rate = 0.6, t = 2;  // the slide is 4.8
  PairScheme scheme(sheared<2>(side, {rate, 0, 1, false}), 1);
  Ensemble<Newton<2>> two("two", 2);
  two[0].mass = two[1].mass = 1;
  two[0].position = {1.0, 3.9};
  two[1].position = {0.5, 0.2};  // its image above is at 0.5 + 4.8 - 4, 4.2
  two[1].velocity = {0.1, -0.3};
  scheme.internal(two, Dashpot{});
  scheme.box().move_walls(t);
  scheme.calculate(t);
  Vector<2> const apart{1.0 - 1.3, 3.9 - 4.2}, faster{0.1 + rate * side, -0.3};
  auto const exact = 3.0 * apart + 2.0 * faster;
  for (int a = 0; a < 2; ++a) {
    EXPECT_NEAR(two.influence_on(0)[a], exact[a], 1e-12);
    EXPECT_NEAR(two.influence_on(1)[a], -exact[a], 1e-12);
  }
}

/// Liquids and metals, with baths or without: what the work of the shear stress and the bath give is what they have.
/// d(E)/dt = - P_yx V rate + bath, E with velocities relative to the flow.
template <int D>
void expect_balance(Ensemble<Newton<D>>& atoms, Scheme& scheme, HeatBath* bath, Scheme* molecules = nullptr) {
  double const dt = 0.001;
  Simulation simulation(scheme, dt);
  if (molecules) simulation.add(*molecules);
  if (bath) {
    bath->on(atoms);
    simulation.add(*bath);
  }
  simulation.seed(test_seed(4));
  simulation.run(0);
  Box const& box = scheme.box();
  auto const energy = [&](EnergyAndVirial const& now) {
    return peculiar_energy(atoms, box) + now.potential - now.heat;
  };
  auto const power_of = [&](EnergyAndVirial const& now) {
    return -pressure_tensor(atoms, now, box)[1][0] * box.volume() * box.shear().rate;
  };
  auto const at_start = simulation.measure();
  double const before = energy(at_start);
  double work = 0, power = power_of(at_start);
  for (int n = 0; n < 2000; ++n) {
    simulation.run(1);
    double const now = power_of(simulation.measure());
    work += 0.5 * dt * (power + now);
    power = now;
  }
  EXPECT_GT(work, 20);
  EXPECT_NEAR((energy(simulation.measure()) - before) / work, 1, 0.01) << D;
}

template <int D>
struct Block {
  Ensemble<Newton<D>> atoms{"atoms"};
  double side;

  Block(Lattice lattice, double spacing, std::size_t count) {
    LatticeBlock const block{lattice, spacing, {count, count, count}};
    block_load(atoms, block);
    side = repeat_lengths(block, D)[0];
    for (auto& p : atoms) p.mass = 1.5;
    maxwellian_load(atoms, {.temperature = 1, .seed = test_seed(3), .remove_drift = true});
  }
  Box box() const { return sheared<D>(side, {0.8, 0, 1}); }
};

template <int D>
void expect_balance_of_liquid(HeatBath* bath) {
  Block<D> block(D == 2 ? Lattice::square : Lattice::fcc, D == 2 ? 1.1 : 1.3, D == 2 ? 8 : 3);
  PairScheme scheme(block.box(), 2);
  scheme.internal(block.atoms, LennardJones{1, 1});
  expect_balance(block.atoms, scheme, bath);
}

/// Chains through the lattice, which the flow stretches, turns and carries through the ends.
template <int D>
void expect_balance_of_melt(HeatBath* bath) {
  std::size_t const length = D == 2 ? 8 : 6;  // a row of the lattice
  Block<D> block(Lattice::square, 1.05, length);
  PairScheme scheme(block.box(), 1.122462048309373);
  MoleculeScheme molecules(block.box());
  auto const bonds = chain_bonds(block.atoms.size(), length);
  scheme.internal(block.atoms, LennardJones{1, 1.122462048309373});
  scheme.connect(block.atoms, connections_of(bonds), Fene{30, 1.5});
  molecules.angles(block.atoms, angles_along(bonds), HarmonicCosine{1, 2});
  expect_balance(block.atoms, scheme, bath, &molecules);
  for (auto const& bond : bonds) {
    auto apart = block.atoms[bond[1]].position - block.atoms[bond[0]].position;
    scheme.box().nearest_image(&apart[0]);
    EXPECT_LT(magnitude(apart), 1.4);
  }
}

TEST(ShearFlow, EnergyIsWhatStressAndBathGive) {
  expect_balance_of_liquid<2>(nullptr);
  expect_balance_of_liquid<3>(nullptr);
  LangevinBath langevin(1, 1, 1);
  expect_balance_of_liquid<2>(&langevin);
  VelocityRescaling rescaling(1, 2, 1);
  expect_balance_of_liquid<3>(&rescaling);
  expect_balance_of_melt<2>(nullptr);
  LangevinBath of_chains(1, 1, 1);
  expect_balance_of_melt<3>(&of_chains);
  Block<3> metal(Lattice::fcc, 1.1, 3);
  EmbeddedAtomScheme scheme(metal.box(),
                            EmbeddedAtoms(SuttonChen{0.1, 1.1 * std::numbers::sqrt2, 9, 6, 39.4}, {.cutoff = 2.2}));
  scheme.add(metal.atoms);
  expect_balance(metal.atoms, scheme, nullptr);
}

// Backwards images slide backwards, and who has crossed comes back.
TEST(ShearFlow, LeapFrogRetracesIt) {
  Ensemble<Newton<2>> atoms("atoms");
  LatticeBlock const block{Lattice::square, 1.1, {8, 8, 1}, {0.5, 0.5, 0}};  // nobody on an edge
  block_load(atoms, block);
  for (auto& p : atoms) p.mass = 1;
  maxwellian_load(atoms, {.temperature = 1, .seed = test_seed(10), .remove_drift = true});
  PairScheme scheme(sheared<2>(8 * 1.1, {0.8, 1, 0}), 2);
  scheme.internal(atoms, LennardJones{1, 1});
  Simulation simulation(scheme, 0.001);
  simulation.run(0);
  auto const start = std::vector(atoms.begin(), atoms.end());
  simulation.run(400);
  simulation.rewind(400);
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    auto apart = atoms[i].position - start[i].position;
    scheme.box().nearest_image(&apart[0]);
    EXPECT_LT(magnitude(apart), 1e-9) << i;
    EXPECT_LT(magnitude(atoms[i].velocity - start[i].velocity), 1e-8) << i;
  }
}

// Smooth particles on a lattice in the flow feel Newton's stress; those at the ends of the gradient like all others.
TEST(ShearFlow, SmoothParticlesHaveNewtonsStress) {
  std::size_t const n = 16;
  double const spacing = 1.0 / n, viscosity = 0.3, rate = 2;
  Ensemble<Smooth<2>> fluid("fluid", n * n);
  for (std::size_t i = 0; i < n * n; ++i) {
    auto& p = fluid[i];
    p.position = {(0.5 + static_cast<double>(i % n)) * spacing, (0.5 + static_cast<double>(i / n)) * spacing};
    p.velocity = {rate * (p.position[1] - 0.5), 0};
    p.mass = spacing * spacing;
    p.range = 5 * spacing;
  }
  SmoothScheme scheme(sheared<2>(1, {rate, 0, 1, false}), WeightShape::wendland);
  scheme.material(fluid, Newtonian<Tait>{{.reference_density = 1, .sound_speed = 10}, viscosity, 0, 0});
  for (double const t : {0.0, 0.25, 0.75}) {  // images are at whole spacings
    scheme.box().move_walls(t);
    auto const now = scheme.measure(t);
    EXPECT_NEAR(-now.virial[1][0] / rate / viscosity, 1, 0.02) << t;
    scheme.calculate(t);
    for (std::size_t i = 0; i < n * n; ++i)
      for (int a = 0; a < 2; ++a) EXPECT_NEAR(fluid.influence_on(i).force[a], 0, 1e-9) << i;
  }
}

// ---- friction between pairs ---------------------------------------------------------------------------------------

struct DpdFluid {
  Estimate viscosity;         // by the stress
  double by_friction, power;  // that part of it, and by the power of the bath
  double temperature;
  double slope, bent;  // of the profile of velocities over the rate; how far it is from a straight line
};

DpdFluid groot_and_warren(double side, double rate, double dt, int equilibration, int looks) {
  int const every = 5;
  Ensemble<Newton<3>> fluid("fluid", static_cast<std::size_t>(3 * side * side * side));
  PairScheme scheme(sheared<3>(side, {rate, 0, 1}), 1);
  random_load(fluid, scheme.box(), {.seed = test_seed(5)});
  for (auto& p : fluid) p.mass = 1;
  maxwellian_load(fluid, {.temperature = 1, .seed = test_seed(6), .remove_drift = true});
  scheme.internal(fluid, Soft{25, 1});
  PairDissipation bath(scheme, 1);
  bath.internal(fluid, {.convention = Convention::fixed_temperature, .friction = 4.5, .temperature = 1, .range = 1});
  bath.corrector(true);
  Simulation simulation(scheme, dt);
  simulation.add(bath);
  simulation.seed(test_seed(7));
  simulation.run(static_cast<std::uint64_t>(equilibration));
  Box const& box = scheme.box();
  std::vector<double> viscosities, by_friction, temperatures;
  double const volume = box.volume(), heat = simulation.measure().heat, start = simulation.time();
  double along = 0, square = 0;
  std::array<double, 8> count{}, velocity{};
  for (int look = 0; look < looks; ++look) {
    simulation.run(every);
    viscosities.push_back(-pressure_tensor(fluid, simulation.measure(), box)[1][0] / rate);
    by_friction.push_back(-bath.virial()[1][0] / volume / rate);
    temperatures.push_back(temperature(fluid, 1, {.subtract_drift = true, .box = &box}).total);
    for (auto const& p : fluid) {
      double const y = p.position[1] - side / 2;
      along += y * p.velocity[0];
      square += y * y;
      auto const bin = std::min<std::size_t>(static_cast<std::size_t>(8 * p.position[1] / side), 7);
      count[bin] += 1;
      velocity[bin] += p.velocity[0];
    }
  }
  double const power = -(simulation.measure().heat - heat) / (simulation.time() - start);
  double bent = 0;
  for (std::size_t bin = 0; bin < 8; ++bin)
    bent = std::max(bent, std::abs(velocity[bin] / count[bin] / (rate * side) - (static_cast<double>(bin) - 3.5) / 8));
  return {estimate(viscosities, 20),       estimate(by_friction, 20).mean, power / (volume * rate * rate),
          estimate(temperatures, 20).mean, along / square / rate,          bent};
}

/// Of particles at random that move with the flow alone, the stress by friction is the integral over pairs: a viscosity of
/// 2 pi gamma rho^2 / 1575 in 3D (R. D. Groot and P. B. Warren, J. Chem. Phys. 107, 4423 (1997)), pi gamma rho^2 / 480 in
/// 2D; without the projection on the lines of centres 2 pi gamma rho^2 / 315 and pi gamma rho^2 / 120.
template <int D>
void expect_friction(bool projected) {
  double const side = D == 3 ? 10 : 30, gamma = 4.5, rate = 0.4;
  Ensemble<Newton<D>> gas("gas", static_cast<std::size_t>(3 * std::pow(side, D)));
  PairScheme scheme(sheared<D>(side, {rate, 1, 0, false}), 1);
  random_load(gas, scheme.box(), {.seed = test_seed(5)});
  for (auto& p : gas) {
    p.mass = 1;
    p.velocity[1] = scheme.box().flow_velocity(&p.position[0]);
  }
  PairDissipation bath(scheme, 1);
  bath.internal(gas, {.convention = Convention::fixed_temperature,
                      .friction = gamma,
                      .temperature = 1,
                      .range = 1,
                      .projected = projected});
  double const exact = (D == 3 ? 2.0 / 1575 : 1.0 / 480) * (projected ? 1 : D + 2) * std::numbers::pi * gamma * 9;
  for (double const t : {0.0, 0.3, 7.0}) {
    scheme.box().move_walls(t);
    EXPECT_NEAR(-bath.virial()[0][1] / scheme.box().volume() / rate / exact, 1, 0.04) << D << "D " << t;
  }
}

TEST(ShearFlow, FrictionHasTheStressOfPairsAtRandom) {
  for (bool const projected : {true, false}) {
    expect_friction<2>(projected);
    expect_friction<3>(projected);
  }
}

// S. Bindgen and others, Phys. Fluids 33, 083615 (2021), have 0.875(5) in a flow at a rate of 0.067, of which friction
// makes 0.135(5), and 0.823(10) by the stresses of a fluid at rest, of which it makes 0.132 (10,000 particles, steps of
// 0.005; their numbers are in github.com/bindgens1/lees_edwards_implementation). Waves of shear in a box at rest (8 long,
// eight runs) decay as of a viscosity of 0.85(3); flows have 0.830(7) by their stress and 0.838 by their power at a rate of
// 0.3, with steps of 0.01, and 0.840(11) and 0.852 at 0.6, with steps of 0.02. Without the repulsion it is 1.328(14) and
// 1.342 at 0.2, published 1.353(6) and 1.322(7).
TEST(ShearFlow, ViscosityOfTheFluidOfGrootAndWarren) {
  auto const fluid = groot_and_warren(6, 0.6, 0.03, 400, 1000);
  std::printf("DPD: %.4f(%.4f), by friction %.4f, by power %.4f, T %.4f, slope %.4f, bent %.4f\n", fluid.viscosity.mean,
              fluid.viscosity.error, fluid.by_friction, fluid.power, fluid.temperature, fluid.slope, fluid.bent);
  EXPECT_NEAR(fluid.viscosity.mean, 0.845, 0.042);
  EXPECT_NEAR(fluid.by_friction, 0.1345, 0.0065);
  EXPECT_NEAR(fluid.power / fluid.viscosity.mean, 1, 0.035);
  EXPECT_NEAR(fluid.slope, 1, 0.02);
  EXPECT_LT(fluid.bent, 0.02);
}

// ---- the Lennard-Jones liquid -------------------------------------------------------------------------------------

// At rest it is 3.24(4) (M. Ferrario and others, Phys. Rev. A 44, 6936 (1991)), and falls with the rate: long runs of this
// one have 3.19(7), 2.75(4), 2.45(2) and 2.11(1) at 0.1, 0.25, 0.5 and 1. No published table of rates was at hand; a plain
// program, all pairs of 256 atoms with their kinetic energy rescaled, has 2.103(16) at 1.
TEST(ShearFlow, ViscosityOfTheLennardJonesLiquidAtItsTriplePoint) {
  double const density = 0.8442, temperature = 0.722, rate = 1;
  Ensemble<Newton<3>> atoms("atoms");
  LatticeBlock const block{Lattice::fcc, spacing_for_density(Lattice::fcc, 3, density), {4, 4, 4}};
  block_load(atoms, block);
  for (auto& p : atoms) p.mass = 1;
  maxwellian_load(atoms, {.temperature = temperature, .seed = test_seed(8), .remove_drift = true});
  PairScheme scheme(sheared<3>(repeat_lengths(block, 3)[0], {rate, 0, 1}), 2.5);
  scheme.internal(atoms, LennardJones{1, std::pow(2.0, 1.0 / 6)});
  VelocityRescaling bath(temperature, 1000, 1);  // the kinetic energy is that of the temperature, nearly
  bath.on(atoms);
  Simulation simulation(scheme, 0.004);
  simulation.add(bath);
  simulation.seed(test_seed(9));
  simulation.run(2000);
  std::vector<double> viscosities;
  double const heat = simulation.measure().heat, start = simulation.time(), volume = scheme.box().volume();
  for (int look = 0; look < 2400; ++look) {
    simulation.run(5);
    viscosities.push_back(-pressure_tensor(atoms, simulation.measure(), scheme.box())[1][0] / rate);
  }
  double const power = -(simulation.measure().heat - heat) / (simulation.time() - start) / (volume * rate * rate);
  auto const viscosity = estimate(viscosities, 20);
  std::printf("LJ: %.4f(%.4f), by power %.4f\n", viscosity.mean, viscosity.error, power);
  EXPECT_NEAR(viscosity.mean, 2.105, 0.095);  // five standard errors and 1 %
  EXPECT_NEAR(power / viscosity.mean, 1, 0.02);
}

// ---- state --------------------------------------------------------------------------------------------------------

/// Chains of four.
struct Dpd {
  Ensemble<Newton<3>> fluid{"fluid", 500};
  PairScheme scheme;
  MoleculeScheme molecules;
  PairDissipation friction;
  LangevinBath bath{1, 0.5, 1};
  Simulation simulation;

  explicit Dpd(int threads)
      : scheme(sheared<3>(5.5, {1.7, 1, 2}), 1),
        molecules(scheme.box()),
        friction(scheme, 1),
        simulation(scheme, 0.01) {
    random_load(fluid, scheme.box(), {.seed = 3});
    for (auto& p : fluid) p.mass = 1;
    for (std::size_t i = 0; i < fluid.size(); ++i)
      if (i % 4 != 0) fluid[i].position = fluid[i - 1].position + Vector{0.4, 0.3, 0.2};
    scheme.box().wrap(fluid);
    auto const bonds = chain_bonds(fluid.size(), 4);
    scheme.connect(fluid, connections_of(bonds), Spring{10, 0.5});
    molecules.angles(fluid, angles_along(bonds), HarmonicCosine{2, 2});
    simulation.add(molecules);
    maxwellian_load(fluid, {.temperature = 1, .seed = 4});
    scheme.internal(fluid, Soft{25, 1});
    friction.internal(fluid,
                      {.convention = Convention::fixed_temperature, .friction = 4.5, .temperature = 1, .range = 1});
    friction.corrector(true);
    bath.on(fluid);
    simulation.add(friction);
    simulation.add(bath);
    simulation.threads(threads);
  }
  std::vector<double> rows() { return {fluid.row(0), fluid.row(0) + fluid.size() * fluid.stride()}; }
};

TEST(ShearFlow, HasTheSameBitsForAnyThreadsAndWhenItIsResumed) {
  Dpd whole(1), three(3), first(2), second(1);
  whole.simulation.run(300);
  three.simulation.run(300);
  EXPECT_EQ(whole.rows(), three.rows());
  for (std::uint64_t const at : {1, 137}) {
    Dpd half(2), rest(1);
    half.simulation.run(at);
    auto const rows = half.rows();
    std::memcpy(rest.fluid.row(0), rows.data(), rows.size() * sizeof(double));
    rest.simulation.restore(half.simulation.step(), half.simulation.step_size(), half.simulation.seed(),
                            half.simulation.state());
    rest.simulation.run(300 - at);
    EXPECT_EQ(whole.rows(), rest.rows()) << at;
    EXPECT_EQ(whole.simulation.measure().heat, rest.simulation.measure().heat);
  }
}

}  // namespace
}  // namespace boltzmann::shear_flow_test
