// The shock in the crystal of PVDF: a point of its Hugoniot line from states in equilibrium and the jump conditions,
// and the same point from a shock that a piston drives.
#include <tests/physics/pvdf.hpp>
#include <tests/physics/statistics.hpp>
#include <tests/seed.hpp>

#include <boltzmann/diagnoses/measures.hpp>

#include <gtest/gtest.h>

namespace boltzmann::hugoniot_test {
namespace {

constexpr double area = pvdf::spacing * pvdf::spacing * 0.86602540378443865, rho0 = pvdf::mass / area;

/// Of matter in equilibrium: normal stress along x (amu / ps^2), energy per molecule, temperatures.
struct State {
  Estimate stress, energy, kinetic, internal;
};

/// Waits (ps; first half as long in a bath, if there is one), then measures as long.
State equilibrium(pvdf::Crystal& crystal, double dt, double time, std::shared_ptr<Dissipation> const& bath) {
  auto& molecules = crystal.molecules;
  Simulation simulation(crystal.scheme, dt);
  simulation.add(crystal.dpd);
  simulation.seed(test_seed(1));
  simulation.integrate(molecules, Method::leap_frog);
  auto const steps = static_cast<std::uint64_t>(time / dt);
  if (bath) simulation.equilibrate(bath, steps / 2);
  simulation.run(steps);
  double const n = static_cast<double>(molecules.size());
  std::vector<double> stress, energy, kinetic, internal;
  for (std::uint64_t sample = 0; sample < steps / 10; ++sample) {
    simulation.run(10);
    auto const measures = simulation.measure();
    stress.push_back(pressure_tensor(molecules, measures, crystal.scheme.box())[0][0]);
    energy.push_back((kinetic_energy(molecules) + measures.potential + measures.internal) / n);
    kinetic.push_back(temperature(molecules, pvdf::boltzmann_constant, {.subtract_drift = true}).total);
    double inverse = 0;
    for (auto const& p : molecules) inverse += pvdf::heat_capacity / p.internal_energy / n;
    internal.push_back(1 / inverse);
  }
  return {estimate(stress, 10), estimate(energy, 10), estimate(kinetic, 10), estimate(internal, 10)};
}

// The crystal at rho / rho0 = 1.395, compressed alike in both directions (it has yielded), with the energy that the
// jump conditions ask at the stress 6.59 N/m, has that stress and 758 K: a point of the Hugoniot line, at u_p = 2000
// m/s and u_s = 7063 m/s.
TEST(Hugoniot, TheKnownPointFromStatesInEquilibrium) {
  double const k = pvdf::boltzmann_constant, compression = 1.395, known = 6.59 * pvdf::newton_per_metre;
  auto const bath = [&](pvdf::Crystal& crystal, double kelvin) -> std::shared_ptr<Dissipation> {
    crystal.dpd.internal(crystal.molecules,
                         pvdf::dissipation(10));  // tenfold friction changes no state in equilibrium
    internal_energy_load(crystal.molecules, StateLaw(pvdf::heat_capacity),
                         {.temperature = kelvin, .boltzmann_constant = k, .seed = test_seed(3)});
    auto langevin = std::make_shared<LangevinBath>(kelvin, 2, k);
    langevin->on(crystal.molecules);
    return langevin;
  };
  pvdf::Crystal before(20, 20), after(20, 20, pvdf::spacing / std::sqrt(compression));
  auto const ahead = equilibrium(before, 0.005, 8, bath(before, 300));
  double const p0 = ahead.stress.mean, dv = area * (1 - 1 / compression);
  // Of 400 energies that vary by a quarter: five standard errors.
  EXPECT_NEAR(ahead.internal.mean, 300, 5 * 300 * std::sqrt(17.0) / 16 / 20);
  EXPECT_NEAR(p0 / pvdf::newton_per_metre, 0, 0.01);
  // What 300 K lacks, at the heat capacity of a molecule: 17 k inside, 2 k of the crystal's motion.
  double const wanted = ahead.energy.mean + 19 * k * (300 - ahead.internal.mean) + (known + p0) / 2 * dv;

  auto& molecules = after.molecules;
  double const n = static_cast<double>(molecules.size());
  auto const warm = equilibrium(after, 0.0025, 4, bath(after, 758));
  double inside = 0;
  for (auto const& p : molecules) inside += p.internal_energy / n;
  for (auto& p : molecules) p.internal_energy *= 1 + (wanted - warm.energy.mean) / inside;
  auto const behind = equilibrium(after, 0.0025, 10, nullptr);
  EXPECT_NEAR(behind.energy.mean, wanted, 5 * k);
  double const p = behind.stress.mean, up = std::sqrt((p - p0) / rho0 * (1 - 1 / compression));
  double const us = up * compression / (compression - 1);
  std::printf("P0 %.4f(%.4f) P %.4f(%.4f) N/m, T_kin %.1f(%.1f) T_int %.1f(%.1f), u_p %.3f u_s %.3f angstrom/ps\n",
              p0 / pvdf::newton_per_metre, ahead.stress.error / pvdf::newton_per_metre, p / pvdf::newton_per_metre,
              behind.stress.error / pvdf::newton_per_metre, behind.kinetic.mean, behind.kinetic.error,
              behind.internal.mean, behind.internal.error, up, us);
  EXPECT_NEAR(behind.kinetic.mean / behind.internal.mean, 1, 0.03);
  EXPECT_NEAR(behind.internal.mean / 758, 1, 0.03);
  EXPECT_NEAR(p / known, 1, 0.01);
  EXPECT_NEAR(up / 20, 1, 0.01);
  EXPECT_NEAR(us / 70.63, 1, 0.01);
}

// A piston at 2000 m/s, friction tenfold so that the wave is thin. Mass, momentum and energy behind it.
TEST(Hugoniot, ADrivenShockMeetsTheSamePoint) {
  double const k = pvdf::boltzmann_constant, up = 20, dt = 0.0025;
  std::size_t const nx = 280, ny = 12;
  LatticeBlock const block{Lattice::triangular, pvdf::spacing, {nx, ny, 1}};
  auto const lengths = repeat_lengths(block, 2);
  Ensemble<Meso<2>> molecules("molecules", nx * ny);
  block_load(molecules, {Lattice::triangular, pvdf::spacing, {nx, ny, 1}, {pvdf::spacing / 2, 0, 0}});
  for (auto& p : molecules) p.mass = pvdf::mass;
  Box box(Vector{0.0, 0.0}, Vector{lengths[0] + pvdf::spacing / 2, lengths[1]},
          {Boundary::reflecting, Boundary::periodic});
  box.wall(0, Box::End::low, {.velocity = {up, 0, 0}});
  PairScheme scheme(box, pvdf::cutoff);
  scheme.internal(molecules, pvdf::law());
  PairDissipation dpd(scheme, k);
  dpd.state(molecules, StateLaw(pvdf::heat_capacity));
  dpd.internal(molecules, pvdf::dissipation(10));
  dpd.corrector(true);
  internal_energy_load(molecules, StateLaw(pvdf::heat_capacity),
                       {.temperature = 300, .boltzmann_constant = k, .seed = test_seed(3)});
  Simulation simulation(scheme, dt);
  simulation.add(dpd);
  simulation.seed(test_seed(1));
  simulation.integrate(molecules, Method::leap_frog);
  auto const bath = std::make_shared<LangevinBath>(300, 2, k);
  bath->on(molecules);
  simulation.equilibrate(bath, 800);

  // The front: where the mean velocity of slices has fallen to half.
  auto const front = [&] {
    double const width = 8;
    std::vector<double> sum(static_cast<std::size_t>(lengths[0] / width) + 2), count(sum.size());
    for (auto const& p : molecules) {
      auto const slice = static_cast<std::size_t>(p.position[0] / width);
      sum[slice] += p.velocity[0], ++count[slice];
    }
    std::size_t i = sum.size() - 1;
    while (i > 0 && (count[i] == 0 || sum[i] / count[i] < up / 2)) --i;
    double const here = sum[i] / count[i], next = count[i + 1] > 0 ? sum[i + 1] / count[i + 1] : 0;
    return width * (static_cast<double>(i) + 0.5 + (here - up / 2) / (here - next));
  };
  auto const energy = [&] {
    auto const m = simulation.measure();
    return kinetic_energy(molecules) + m.potential + m.internal - m.work;
  };
  simulation.run(1);
  double const start = energy();
  std::vector<double> times, places, density, stress, kinetic, internal, velocity;
  while (simulation.time() < 18.5) {
    simulation.run(40);
    double const t = simulation.time(), at = front();
    if (t < 4) continue;
    times.push_back(t);
    places.push_back(at);
    // Behind: from beyond what the start, a stronger shock, has heated to where the wave has passed for a while.
    double const from = up * t + 250, to = at - 200;
    if (to - from < 100) continue;
    auto const m = simulation.measure();
    double n = 0, u = 0, thermal = 0, inverse = 0, momentum_flow = 0;
    for (std::size_t i = 0; i < molecules.size(); ++i)
      if (molecules[i].position[0] > from && molecules[i].position[0] < to) {
        ++n;
        u += molecules[i].velocity[0];
      }
    u /= n;
    for (std::size_t i = 0; i < molecules.size(); ++i) {
      auto const& p = molecules[i];
      if (p.position[0] <= from || p.position[0] >= to) continue;
      double const vx = p.velocity[0] - u;
      thermal += p.mass * (vx * vx + p.velocity[1] * p.velocity[1]) / (2 * n * k);
      momentum_flow += p.mass * vx * vx + m.virial_per_particle[0][9 * i];
      inverse += pvdf::heat_capacity / p.internal_energy / n;
    }
    velocity.push_back(u);
    density.push_back(n * pvdf::mass / ((to - from) * lengths[1]));
    stress.push_back(momentum_flow / ((to - from) * lengths[1]));
    kinetic.push_back(thermal);
    internal.push_back(1 / inverse);
  }
  double tt = 0, tx = 0, t0 = 0, x0 = 0;
  for (std::size_t i = 0; i < times.size(); ++i)
    t0 += times[i] / double(times.size()), x0 += places[i] / double(times.size());
  for (std::size_t i = 0; i < times.size(); ++i)
    tt += (times[i] - t0) * (times[i] - t0), tx += (times[i] - t0) * (places[i] - x0);
  double const us = tx / tt;
  ASSERT_GE(density.size(), 20u);
  double const rho = estimate(density).mean, p = estimate(stress).mean;
  std::printf("u_s %.2f angstrom/ps, rho/rho0 %.4f, P %.3f N/m, T_kin %.1f T_int %.1f, u %.2f\n", us, rho / rho0,
              p / pvdf::newton_per_metre, estimate(kinetic).mean, estimate(internal).mean, estimate(velocity).mean);
  EXPECT_NEAR(us / 71.7, 1, 0.025);
  EXPECT_NEAR(rho / rho0 / 1.39, 1, 0.015);
  EXPECT_NEAR(p / pvdf::newton_per_metre / 6.64, 1, 0.04);
  EXPECT_NEAR(estimate(velocity).mean / up, 1, 0.02);
  EXPECT_NEAR(estimate(internal).mean / 765, 1, 0.06);
  EXPECT_NEAR(estimate(kinetic).mean / estimate(internal).mean, 1.05, 0.07);  // it still falls
  // Mass and momentum through the front; what the piston has done is in the matter.
  EXPECT_NEAR(rho * (us - up) / (rho0 * us), 1, 0.035);
  EXPECT_NEAR(p / (rho0 * us * up), 1, 0.035);
  double const work = simulation.measure().work;
  EXPECT_NEAR(energy(), start, 2e-3 * work);
  EXPECT_GT(work, 0);
}

}  // namespace
}  // namespace boltzmann::hugoniot_test
