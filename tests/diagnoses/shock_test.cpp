// Shocks: lines, fronts and jumps of known answers, a shock made by hand that satisfies the jumps, and one in a gas of
// hard discs, whose Hugoniot is known.
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/diagnoses/shock.hpp>
#include <boltzmann/diagnoses/slab.hpp>
#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/loaders/jitter.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/meso.hpp>
#include <boltzmann/particles/tracer.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <string>

namespace boltzmann::shock_test {
namespace {

// ---- Lines ----

TEST(ShockLine, ExactAndByHand) {
  std::vector<double> x, y;
  for (int i = 0; i < 20; ++i) {
    x.push_back(1e6 + i);
    y.push_back(7 - 2.5 * i);
  }
  LineFit const exact = fit_line(x, y);
  EXPECT_NEAR(exact.slope.mean, -2.5, 1e-12);
  EXPECT_NEAR(exact.intercept.mean, 7 + 2.5e6, 1e-5);
  EXPECT_NEAR(exact.slope.error, 0, 1e-10);
  // (0, 0), (1, 2), (2, 1): slope 1/2, residuals -1/2, 1, -1/2: variance 3/2 over one degree of freedom.
  LineFit const three = fit_line(std::vector{0.0, 1.0, 2.0}, std::vector{0.0, 2.0, 1.0});
  EXPECT_NEAR(three.slope.mean, 0.5, 1e-15);
  EXPECT_NEAR(three.intercept.mean, 0.5, 1e-15);
  EXPECT_NEAR(three.slope.error, std::sqrt(1.5 / 2), 1e-15);

  auto const two = fit_line(std::vector{0.0, 1.0}, std::vector{0.0, 2.0});
  EXPECT_EQ(two.slope.mean, 2);
  EXPECT_TRUE(std::isnan(two.slope.error));
  EXPECT_TRUE(std::isnan(fit_line({}, {}).slope.mean));
  EXPECT_TRUE(std::isnan(fit_line(std::vector{1.0, 1.0}, std::vector{0.0, 2.0}).slope.mean));
  EXPECT_EQ(message([] { fit_line(std::vector{1.0}, {}); }), "a line through points needs as many y as x, not 0 and 1");
}

TEST(ShockLine, ErrorOfNoisyData) {
  // 6400 lines with noise of 0.3: the slopes scatter by 0.3 / sqrt(Sxx), which is what the errors say.
  std::mt19937_64 random(test_seed(4));
  std::normal_distribution noise(0.0, 0.3);
  double squares = 0, errors = 0, sxx = 0;
  for (int i = 0; i < 30; ++i) sxx += (i - 14.5) * (i - 14.5);
  for (int line = 0; line < 6400; ++line) {
    LineSums sums;
    for (int i = 0; i < 30; ++i) sums.add(i, 2 + 0.7 * i + noise(random));
    squares += (sums.fit().slope.mean - 0.7) * (sums.fit().slope.mean - 0.7) / 6400;
    errors += sums.fit().slope.error * sums.fit().slope.error / 6400;
  }
  EXPECT_NEAR(std::sqrt(squares * sxx), 0.3, 5 * 0.3 / std::sqrt(2 * 6400.0));  // 5 standard errors
  EXPECT_NEAR(std::sqrt(errors * sxx), 0.3, 0.01);
}

// ---- Fronts ----

TEST(ShockFront, CrossesTheMiddle) {
  std::vector<double> const x{0, 1, 2, 3, 4, 5, 6, 7};
  std::vector<double> const v{3, 3, 3, 2, 0.5, 0, 0, 0};
  // 1.5 lies between x = 3 (2) and x = 4 (0.5).
  EXPECT_NEAR(front_position(x, v, 0, 3, Box::End::high), 3 + 1.0 / 3, 1e-14);
  std::vector<double> const back(v.rbegin(), v.rend());
  EXPECT_NEAR(front_position(x, back, 0, 3, Box::End::low), 7 - 3 - 1.0 / 3, 1e-14);
  // A moving body that is stopped: from -3 to 0; a rarefaction: from 5 down to 2.
  std::vector<double> stopped, thinned;
  for (double const one : v) stopped.push_back(one - 3), thinned.push_back(5 - one);
  EXPECT_NEAR(front_position(x, stopped, -3, 0, Box::End::high), 3 + 1.0 / 3, 1e-14);
  EXPECT_NEAR(front_position(x, thinned, 5, 2, Box::End::high), 3 + 1.0 / 3, 1e-14);
  // Empty bins are passed over, a single noisy one is no front.
  std::vector<double> gaps = v;
  gaps[4] = gaps[7] = NAN;
  EXPECT_NEAR(front_position(x, gaps, 0, 3, Box::End::high), 3 + 2 * 0.25, 1e-14);
  std::vector<double> spike = v;
  spike[6] = 9;
  EXPECT_NEAR(front_position(x, spike, 0, 3, Box::End::high), 3 + 1.0 / 3, 1e-14);
  // None: nothing happens, everything has happened, no bins, no known level.
  EXPECT_TRUE(std::isnan(front_position(x, std::vector<double>(8, 0.1), 0, 3, Box::End::high)));
  EXPECT_TRUE(std::isnan(front_position(x, std::vector<double>(8, 2.9), 0, 3, Box::End::high)));
  EXPECT_TRUE(std::isnan(front_position({}, {}, 0, 3, Box::End::high)));
  EXPECT_TRUE(std::isnan(front_position(x, v, 0, NAN, Box::End::high)));
  EXPECT_EQ(message([&] { front_position(x, {}, 0, 3, Box::End::low); }), "a front in 8 bins with 0 values");
}

TEST(ShockFront, OfNoisyData) {
  // tanh profiles with 10 % noise: the middle is found within a bin.
  std::mt19937_64 random(test_seed(9));
  std::normal_distribution noise(0.0, 0.2);
  double worst = 0;
  for (int trial = 0; trial < 100; ++trial) {
    double const middle = 30 + 0.37 * trial;
    std::vector<double> x, v;
    for (int i = 0; i < 100; ++i) {
      x.push_back(i + 0.5);
      v.push_back(1 + std::tanh((middle - x.back()) / 1.5) + noise(random));
    }
    worst = std::max(worst, std::abs(front_position(x, v, 0, 2, Box::End::high) - middle));
  }
  EXPECT_LT(worst, 1);
}

// ---- Jumps ----

TEST(ShockJumps, OfAnIdealGasOfMachThree) {
  // gamma 5/3, Mach 3 into rho 1, P 1 (NACA 1135): P ratio 11, density ratio 3.
  double const gamma = 5.0 / 3, c = std::sqrt(gamma), us = 3 * c + 0.7, ratio = 3, up = 0.7 + 3 * c * (1 - 1 / ratio);
  ShockState const ahead{1, 0.7, 1, 1 / (gamma - 1)};
  ShockState behind{ratio, up, 11, 11 / ratio / (gamma - 1)};
  JumpResiduals const zero = jump_residuals(ahead, behind, us);
  EXPECT_NEAR(zero.mass, 0, 1e-14);
  EXPECT_NEAR(zero.momentum, 0, 1e-14);
  EXPECT_NEAR(zero.energy, 0, 1e-14);
  // The mirror image runs the other way.
  JumpResiduals const mirrored =
      jump_residuals({1, -0.7, 1, ahead.specific_energy}, {ratio, -up, 11, behind.specific_energy}, -us);
  EXPECT_NEAR(mirrored.mass, 0, 1e-14);
  EXPECT_NEAR(mirrored.momentum, 0, 1e-14);
  EXPECT_NEAR(mirrored.energy, 0, 1e-14);
  // Each fails by what is put wrong.
  EXPECT_NEAR(jump_residuals(ahead, {1.05 * ratio, up, 11, behind.specific_energy}, us).mass, 0.05, 1e-14);
  EXPECT_NEAR(jump_residuals(ahead, {ratio, up, 11.5, behind.specific_energy}, us).momentum, 0.05, 1e-14);
  EXPECT_NEAR(jump_residuals(ahead, {ratio, up, 11, behind.specific_energy + 0.2}, us).energy, 0.05, 1e-14);
}

// ---- The instrument ----

using Values = std::map<std::string, double>;

Values look(Diagnosis& shock, Sample const& sample) {
  std::vector<double> values;
  shock.measure(sample, values);
  auto const columns = shock.columns();
  EXPECT_EQ(values.size(), columns.size());
  Values named;
  for (std::size_t c = 0; c < columns.size(); ++c) named[columns[c].name] = values[c];
  EXPECT_EQ(named.size(), columns.size());
  return named;
}

/// A crystal of mesoparticles that a piston of velocity 1 compresses behind a front of velocity 2.5: places,
/// velocities, energies and virials set by hand so that the jumps close. `sign` -1: from the high end.
struct Made {
  static constexpr double up = 1, us = 2.5, spacing = 0.5, mass = 3, length = 200, thickness = 10;
  static constexpr double thermal0 = 0.2, thermal = 0.6;  // speeds
  static constexpr double rho0 = mass / (spacing * spacing), p0 = 4;
  static constexpr double rho = rho0 * us / (us - up), p = p0 + rho0 * us * up;
  static constexpr double e0 = 3, e = e0 + 0.5 * (p + p0) * (1 / rho0 - 1 / rho);

  double sign;
  Box box;
  Ensemble<Meso<2>> lumps;
  std::vector<AnyEnsemble*> all{&lumps};
  std::vector<AnyEnsemble const*> available{&lumps};
  std::vector<double> start;
  EnergyAndVirial measures = EnergyAndVirial::known();
  double extra_energy = 0;  // behind the front, per mass: 0 closes

  explicit Made(double sign = 1)
      : sign(sign),
        box(Vector{sign > 0 ? 0 : -length, 0.0}, Vector{sign > 0 ? length : 0, thickness},
            {Boundary::reflecting, Boundary::periodic}),
        lumps("lumps", static_cast<std::size_t>(length * thickness / (spacing * spacing))) {
    box.wall(0, sign > 0 ? Box::End::low : Box::End::high, {.velocity = {sign * up, 0, 0}});
    auto const rows = static_cast<std::size_t>(thickness / spacing);
    for (std::size_t i = 0; i < lumps.size(); ++i) {
      start.push_back((static_cast<double>(i / rows) + 0.5) * spacing);
      lumps[i].position[1] = (static_cast<double>(i % rows) + 0.5) * spacing;
      lumps[i].mass = mass;
    }
  }
  Sample at(double time) {
    box.move_walls(time);
    measures = EnergyAndVirial::known();
    measures.per_particle = {{}};
    measures.virial_per_particle = {{}};
    for (std::size_t i = 0; i < lumps.size(); ++i) {
      bool const passed = start[i] < us * time;
      double const x = passed ? start[i] + up * (time - start[i] / us) : start[i];
      double const heat = passed ? thermal : thermal0, one = i % 2 == 0 ? 1 : -1, two = i / 2 % 2 == 0 ? 1 : -1;
      lumps[i].position[0] = sign * x;
      lumps[i].velocity = {sign * (passed ? up : 0) + one * heat, two * heat};
      lumps[i].internal_energy = mass * ((passed ? e + extra_energy : e0) + 7 - heat * heat);
      lumps[i].temperature = passed ? 500 : 300;
      measures.per_particle[0].push_back(-7 * mass);
      double const volume = mass / (passed ? rho : rho0), pressure = passed ? p : p0;
      std::vector<double> virial(9, 0.0);
      virial[0] = pressure * volume - mass * heat * heat;
      virial[4] = 2 * virial[0];
      auto& virials = measures.virial_per_particle[0];
      virials.insert(virials.end(), virial.begin(), virial.end());
    }
    return Sample{all, box, &measures, 1, time, 0};
  }
};

void closes(Made& made, ShockOptions const& options) {
  Shock shock(made.available, options);
  Values v;
  for (int k = 0; k <= 80; ++k) v = look(shock, made.at(k));  // the front leaves the crystal at 80
  EXPECT_GT(shock.looks(), 40U);
  EXPECT_LT(shock.looks(), 75U);
  EXPECT_NEAR(v.at("shock speed") / (made.sign * Made::us), 1, 0.002);
  EXPECT_LT(v.at("shock speed error"), 0.01 * Made::us);
  EXPECT_NEAR(v.at("density behind") / Made::rho, 1, 0.01);
  EXPECT_NEAR(v.at("density ahead") / Made::rho0, 1, 0.01);
  EXPECT_NEAR(v.at("velocity behind"), made.sign * Made::up, 0.002);
  EXPECT_NEAR(v.at("velocity ahead"), 0, 0.002);
  EXPECT_NEAR(v.at("pressure behind") / Made::p, 1, 0.01);
  EXPECT_NEAR(v.at("pressure ahead") / Made::p0, 1, 0.01);
  EXPECT_NEAR(v.at("specific energy behind") / Made::e, 1, 1e-4);
  EXPECT_NEAR(v.at("specific energy ahead") / Made::e0, 1, 1e-4);
  EXPECT_NEAR(v.at("kinetic temperature x behind") / (Made::mass * Made::thermal * Made::thermal), 1, 1e-3);
  EXPECT_NEAR(v.at("kinetic temperature ahead") / (Made::mass * Made::thermal0 * Made::thermal0), 1, 1e-3);
  EXPECT_NEAR(v.at("internal temperature behind"), 500, 1e-7);
  EXPECT_NEAR(v.at("internal temperature ahead"), 300, 1e-7);
  EXPECT_NEAR(v.at("mass jump residual"), 0, 0.01);
  EXPECT_NEAR(v.at("momentum jump residual"), 0, 0.01);
  EXPECT_NEAR(v.at("energy jump residual"), 0, 0.01);
}

TEST(Shock, ThatSatisfiesTheJumpsCloses) {
  Made up, down(-1), by_density, windowed, beside;
  closes(up, {});
  closes(down, {});
  closes(by_density, {.quantity = "density"});
  closes(beside, {.far = 16});
  closes(windowed, {.count = 300, .margin = 8, .near = 5, .far = 20});
}

TEST(Shock, ThatDoesNotIsCaught) {
  Made made;
  made.extra_energy = 0.1 * (Made::e - Made::e0);
  Shock shock(made.available, {});
  Values v;
  for (int k = 0; k <= 70; ++k) v = look(shock, made.at(k));
  EXPECT_NEAR(v.at("energy jump residual"), 0.1, 0.01);
  EXPECT_NEAR(v.at("mass jump residual"), 0, 0.01);
}

TEST(Shock, PositionsBeginAtATime) {
  Made made;
  Shock shock(made.available, {.since = 30, .margin = 5});
  auto v = look(shock, made.at(0));
  EXPECT_TRUE(std::isnan(v.at("front position")) && std::isnan(v.at("density behind")));
  v = look(shock, made.at(20));
  EXPECT_NEAR(v.at("front position"), 50, 1);
  EXPECT_EQ(shock.looks(), 0U);
  EXPECT_TRUE(std::isnan(v.at("shock speed")) && std::isnan(v.at("mass jump residual")));
  look(shock, made.at(30));
  v = look(shock, made.at(40));
  EXPECT_EQ(shock.looks(), 2U);
  EXPECT_NEAR(v.at("shock speed"), 2.5, 0.05);
  // A checkpoint in between changes nothing; nor does what happens after the front has left.
  Shock other(made.available, {.since = 30, .margin = 5});
  other.restore(shock.state());
  EXPECT_EQ(look(other, made.at(50)), look(shock, made.at(50)));
  EXPECT_EQ(other.state(), shock.state());
  look(shock, made.at(79));
  EXPECT_EQ(shock.looks(), 3U);
  look(shock, made.at(60));
  EXPECT_EQ(shock.looks(), 3U);
  EXPECT_EQ(message([&] {
              other.restore(std::vector<double>{1, 2});
            }),
            "the checkpoint does not fit this diagnosis: a shock remembers other sums");
  Shock fresh(made.available, {});
  EXPECT_TRUE(fresh.state().empty());
  fresh.restore({});
  EXPECT_EQ(fresh.looks(), 0U);
}

TEST(Shock, WithoutEnergiesKeepsItsSpeed) {
  Made made;
  Shock shock(made.available, {});
  EXPECT_TRUE(shock.needs_energies());
  Values v;
  for (int k = 0; k < 60; ++k) {
    Sample const full = made.at(k);
    v = look(shock, Sample{full.ensembles, full.box, nullptr, 1, full.time, 0});
  }
  EXPECT_NEAR(v.at("shock speed"), 2.5, 0.01);
  EXPECT_NEAR(v.at("mass jump residual"), 0, 0.01);
  EXPECT_TRUE(std::isnan(v.at("momentum jump residual")) && std::isnan(v.at("energy jump residual")));
}

TEST(Shock, Refusals) {
  Made made;
  auto const says = [&](ShockOptions const& options) { return message([&] { Shock(made.available, options); }); };
  EXPECT_EQ(says({.axis = 2}), "a shock along axis z: the space has 2 axes");
  EXPECT_EQ(says({.quantity = "pressure"}), "the front of a shock shows in 'velocity' or 'density', not in 'pressure'");
  EXPECT_EQ(says({.near = 5, .far = 4}), "behind a shock the window's near end, 5, must be nearer than its far end, 4");
  EXPECT_EQ(says({.margin = -1}), "the distances of a shock's windows must not be negative: margin -1, near 0");
  EXPECT_EQ(message([] { Shock({}, {}); }), "a shock needs particles to run through; the simulation has none");
  Ensemble<Tracer<2>> vortices("vortices", 1);
  EXPECT_EQ(message([&] { Shock({&vortices}, {}); }),
            "a shock needs particles with a mass and a velocity; no ensemble that was chosen has both");
  Shock across(made.available, {.axis = 1});
  EXPECT_EQ(message([&] { look(across, made.at(0)); }),
            "a shock runs from one end of an axis to the other; the axis y is periodic");
  Box const open(Vector{0.0, 0.0}, Vector{200.0, 10.0});
  Sample const sample = made.at(0);
  Shock lost(made.available, {});
  EXPECT_EQ(
      message([&] {
        look(lost, Sample{sample.ensembles, open, nullptr, 1, 0, 0});
      }),
      "no wall at an end of x runs into the matter; set end = \"low\" or \"high\", the end from which the shock comes");
  Ensemble<Meso<2>> none("lumps");
  std::vector<AnyEnsemble*> const empty{&none};
  Shock nothing({&none}, {});
  EXPECT_EQ(message([&] {
              look(nothing, Sample{empty, made.box, nullptr, 1, 0, 0});
            }),
            "a shock needs particles to run through; there are none in its ensembles");
}

TEST(Shock, IsInTheCatalogue) {
  Made made;
  DiagnosisParameters with{.available = made.available};
  with.axis = "x";
  with.end = "low";
  with.quantity = "density";
  with.count = 200;
  with.margin = 5;
  with.near = 4;
  with.far = 30;
  auto const shock = make_diagnosis("shock", with);
  Values v;
  for (int k = 0; k <= 60; ++k) v = look(*shock, made.at(k));
  EXPECT_NEAR(v.at("shock speed"), 2.5, 0.01);
  EXPECT_NEAR(v.at("mass jump residual"), 0, 0.01);
  auto const columns = shock->columns();
  ASSERT_EQ(columns.size(), 3 + 2 * 8 + 3U);
  EXPECT_EQ(columns[3].name, "density behind");
  EXPECT_EQ(columns[3].dimension, dimensions::mass / dimensions::area);
  EXPECT_EQ(columns[5].dimension, dimensions::energy / dimensions::area);
  with.end = "left";
  EXPECT_EQ(message([&] { make_diagnosis("shock", with); }),
            "a shock comes from the end 'low' or 'high' of its axis, not 'left'");
  with.end = "";
  with.from = 3;
  EXPECT_NE(message([&] { make_diagnosis("shock", with); }).find("diagnosis shock has no option from"),
            std::string::npos);
}

// ---- A shock in a gas of nearly hard discs ----

/// A steep, finite repulsion: V = height (1 - r^2)^3.
constexpr double height = 100;
constexpr auto repulsion = [](auto const& p, auto const& q) {
  auto const r = q.position - p.position;
  auto const inside = 1.0 - dot(r, r);
  return Interaction{r * (-6 * height * inside * inside), height * inside * inside * inside};
};

/// The integral of f(r, V(r)) over r from 0 to 1.
double over_pairs(auto const& f) {
  double sum = 0;
  int const steps = 2000;
  for (int i = 0; i < steps; ++i) {
    double const r = (i + 0.5) / steps, inside = 1 - r * r;
    sum += f(r, height * inside * inside * inside) / steps;
  }
  return sum;
}
/// The part of the plane that hard discs fill that stand for it: their diameter is Barker and Henderson's.
double filling(double density, double temperature) {
  double const d = over_pairs([&](double, double v) { return 1 - std::exp(-v / temperature); });
  return std::numbers::pi / 4 * density * d * d;
}
/// P = n k T Z (Henderson 1975), and the potential energy of a particle from the pairs at contact.
double pressure_of(double density, double temperature) {
  double const y = filling(density, temperature);
  return density * temperature * (1 + y * y / 8) / ((1 - y) * (1 - y));
}
double potential_of(double density, double temperature) {
  double const y = filling(density, temperature), contact = (1 - 7 * y / 16) / ((1 - y) * (1 - y));
  return std::numbers::pi * density * contact *
         over_pairs([&](double r, double v) { return v * std::exp(-v / temperature) * r; });
}

// The gas ahead is cold and even (particles anywhere in cells of a lattice). Standard errors, of eight runs: 0.5 % of
// the speed of the front and of the density, 0.7 % of the temperature, 1.5 % of what is left of jumps, by the pressure.
TEST(Shock, InAGasOfHardDiscs) {
  double const n0 = 0.2, t0 = 1e-4, up = 1, length = 300, thickness = 40;
  // m = k = 1. Solve the three jumps for us.
  double const p0 = pressure_of(n0, t0), e0 = t0 + potential_of(n0, t0);
  double low = up * 1.05, high = up * 4, t = 1, n = 0;
  for (int i = 0; i < 40; ++i) {
    double const us = 0.5 * (low + high), p = p0 + n0 * us * up;
    n = n0 * us / (us - up);
    double const e = e0 + 0.5 * (p + p0) * (1 / n0 - 1 / n);
    for (int k = 0; k < 20; ++k) t = e - potential_of(n, t);
    (pressure_of(n, t) > p ? low : high) = us;  // a slower front: denser, so that the gas resists more
  }
  double const us = low;

  Box const box(Vector{0.0, 0.0}, Vector{length, thickness}, {Boundary::reflecting, Boundary::periodic});
  Ensemble<Newton<2>> gas("gas");
  Filling const even{Lattice::square, 1 / std::sqrt(n0), {0, 0, 0}, {length, thickness, 0}};
  for (auto const& site : filling_sites(even, 2)) gas.add({{{site[0], site[1]}}, 1, {}});
  jitter(gas, {.most = 0.6, .seed = test_seed(12)});
  maxwellian_load(gas, {.temperature = t0, .seed = test_seed(12), .remove_drift = true});
  PairScheme scheme(box);
  scheme.internal(gas, repulsion, 1);
  scheme.skin(0.5);
  scheme.box().wall(0, Box::End::low, {.velocity = {up, 0, 0}});
  Simulation simulation(scheme, 0.02);
  simulation.integrate(gas, Method::leap_frog);
  Shock shock({&gas}, {.since = 40, .margin = 20, .near = 25});
  Values v;
  simulation.observe(10, [&](Simulation const& s) {
    EnergyAndVirial const measures = s.measure();
    v = look(shock, Sample{scheme.ensembles(), scheme.box(), &measures, 1, s.time(), s.step()});
  });
  simulation.run(6500);
  EXPECT_GT(shock.looks(), 200U);
  EXPECT_NEAR(v.at("shock speed") / us, 1, 0.035);
  EXPECT_LT(v.at("shock speed error") / us, 0.01);
  EXPECT_NEAR(v.at("density behind") / n, 1, 0.035);
  EXPECT_NEAR(v.at("velocity behind"), up, 0.02);
  EXPECT_NEAR(v.at("kinetic temperature behind") / t, 1, 0.04);
  EXPECT_NEAR(v.at("kinetic temperature x behind") / v.at("kinetic temperature y behind"), 1, 0.04);
  for (char const* jump : {"mass jump residual", "momentum jump residual", "energy jump residual"})
    EXPECT_NEAR(v.at(jump), 0, 0.075) << jump;
}

// ---- In scenarios ----

std::string scenario(std::string const& more) {
  return "[box]\nlow = [0, 0]\nhigh = [\"60 angstrom\", \"20 angstrom\"]\nboundary = [\"reflecting\", \"periodic\"]\n"
         "[[box.walls]]\naxis = \"x\"\nend = \"low\"\nvelocity = [\"5 angstrom/ps\", 0]\n"
         "[units]\nbase = \"custom\"\nlength = \"1 angstrom\"\nmass = \"1 amu\"\ntime = \"1 ps\"\n[run]\nstep = \"1 "
         "fs\"\nsteps = 10\n"
         "[[ensembles]]\nname = \"argon\"\nclass = \"Newton\"\nnumber = 192\nmass = \"40 amu\"\n"
         "load = { kind = \"block\", lattice = \"square\", spacing = \"2.5 angstrom\", counts = [24, 8], origin = "
         "[\"1 angstrom\", \"1 angstrom\"] }\n" +
         more;
}

TEST(ShockScenarios, ReadSlabsShocksAndProfiles) {
  auto const run = parse_scenario(
      scenario("[[diagnoses]]\nkind = \"slab\"\nfrom = \"20 angstrom\"\nto = \"40 angstrom\"\ncount = 2\n"
               "[[diagnoses]]\nkind = \"slab\"\naxis = \"y\"\nlabel = \"layer\"\n"
               "[[diagnoses]]\nkind = \"shock\"\nend = \"low\"\nquantity = \"density\"\nmargin = \"3 angstrom\"\n"
               "near = \"4 angstrom\"\nfar = \"1 nm\"\nsince = \"2 ps\"\ncount = 100\n"
               "[[output.pictures]]\ndrawing = \"profile\"\ny = \"kinetic-temperature.x, internal-temperature\"\n"
               "bins = 20\nhigh = \"400 K\"\n"),
      "test.toml");
  ASSERT_EQ(run->diagnoses.size(), 3U);
  EXPECT_EQ(run->diagnoses[0]->columns()[0].name, "slab 1 kinetic temperature");
  auto const& slab = dynamic_cast<Slab const&>(*run->diagnoses[0]).options();
  EXPECT_EQ(slab.from, 20);
  EXPECT_EQ(slab.to, 40);
  EXPECT_EQ(dynamic_cast<Slab const&>(*run->diagnoses[1]).options().axis, 1);
  auto const& shock = dynamic_cast<Shock const&>(*run->diagnoses[2]).options();
  EXPECT_EQ(shock.end, Box::End::low);
  EXPECT_EQ(shock.quantity, "density");
  EXPECT_EQ(shock.margin, 3);
  EXPECT_EQ(shock.near, 4);
  EXPECT_NEAR(shock.far, 10, 1e-12);
  EXPECT_EQ(shock.since, 2);
  EXPECT_EQ(shock.count, 100U);
  ASSERT_EQ(run->output.pictures.size(), 1U);
  EXPECT_EQ(run->output.pictures[0].bins, 20);
  EXPECT_EQ(run->output.pictures[0].high, 400);
  EXPECT_NO_THROW(run->simulation->run(5));
}

TEST(ShockScenarios, MistakesHaveOneLine) {
  auto const expect = [](std::string const& more, std::string const& part) {
    std::string const says = message([&] { parse_scenario(scenario(more), "test.toml"); });
    EXPECT_NE(says.find(part), std::string::npos) << part << "\nis not in\n" << says;
    EXPECT_EQ(says.find('\n'), std::string::npos) << says;
  };
  std::string const slab = "[[diagnoses]]\nkind = \"slab\"\n", shock = "[[diagnoses]]\nkind = \"shock\"\n",
                    picture = "[[output.pictures]]\ndrawing = \"profile\"\n";
  expect(slab + "from = \"59.7 angstrom\"\n", "a slab along x from 59.7 to 60 has no particle at the start");
  expect(slab + "from = 3\nto = 2\n", "its begin must be below its end");
  expect(slab + "from = \"3 K\"\n", "from");
  expect(slab + "axis = \"z\"\n", "'z'");
  expect(slab + "since = 3\n", "unknown key 'since'");
  expect(slab + slab, "there is a column 'slab kinetic temperature' already; names must differ (give a label)");
  expect(shock + "axis = \"y\"\n", "the axis y is periodic");
  expect(shock + "end = \"left\"\n", "'left'");
  expect(shock + "quantity = \"velocty\"\n", "did you mean 'velocity'?");
  expect(shock + "near = 5\nfar = 4\n", "must be nearer than its far end");
  expect(picture + "y = \"densty\"\n", "did you mean 'density'?");
  expect(picture + "x = \"position.z\"\n", "a profile in 2D is over position.x or position.y");
  expect(picture + "bins = 0\n", "bins");
  expect(picture + "colour = \"speed\"\n", "unknown key 'colour'");
}

}  // namespace
}  // namespace boltzmann::shock_test
