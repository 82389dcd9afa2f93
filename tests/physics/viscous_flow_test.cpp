// Viscous flows and conduction of heat against series and closed solutions, in 2D and 3D, on lattices and on disordered
// starts, with all weights and all ways to know the density. tests/schemes/transport_test.cpp has the operator itself.
#include <tests/physics/smooth_gas.hpp>
#include <tests/seed.hpp>

#include <boltzmann/laws/materials/elastic.hpp>
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/laws/materials/newtonian.hpp>
#include <boltzmann/laws/materials/stiffened_gas.hpp>
#include <boltzmann/laws/materials/tait.hpp>
#include <boltzmann/laws/uniform.hpp>
#include <boltzmann/loaders/jitter.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <numbers>

namespace boltzmann::viscous_flow_test {
namespace {

constexpr double pi = std::numbers::pi;

/// u(y, t) between walls at 0 and 1 from rest: under the acceleration g, and with the upper wall at the speed U.
double channel_flow(double y, double t, double viscosity, double acceleration, double wall_speed) {
  double u = 0.5 * acceleration / viscosity * y * (1 - y) + wall_speed * y;
  for (int n = 1; n < 200; ++n) {
    double const wave = std::sin(n * pi * y) * std::exp(-square(n * pi) * viscosity * t);
    if (n % 2 == 1) u -= 4 * acceleration / (viscosity * std::pow(n * pi, 3)) * wave;
    u += (n % 2 == 0 ? 2 : -2) * wall_speed / (n * pi) * wave;
  }
  return u;
}

struct Setting {
  std::size_t rows = 25;
  double range = 3;   ///< in spacings
  double jitter = 0;  ///< the largest move, in spacings
  WeightShape shape = WeightShape::wendland;
  DensityFrom density = DensityFrom::continuity;
  bool variable = false;
  double acceleration = 1, wall_speed = 0;
};

/// A channel along x between walls at y = 0 and 1, density 1.
template <int D>
struct Channel {
  static constexpr double viscosity = 0.5;
  Setting setting;
  Box box;
  Ensemble<Smooth<D>> fluid{"fluid"};
  std::unique_ptr<SmoothScheme> scheme;
  std::unique_ptr<Simulation> simulation;

  static Box make_box(Setting const& s) {
    Vector<D> low{}, high{};
    std::array<Boundary, D> boundaries;
    for (int a = 0; a < D; ++a) {
      high[a] = a == 1 ? 1 : 8.0 / static_cast<double>(s.rows);
      boundaries[static_cast<std::size_t>(a)] = a == 1 ? Boundary::mirror : Boundary::periodic;
    }
    Box box(low, high, boundaries);
    box.wall(1, Box::End::low, {.slips = false});
    Wall upper{.slips = false};
    upper.velocity[0] = s.wall_speed;
    box.wall(1, Box::End::high, upper);
    return box;
  }
  explicit Channel(Setting const& s) : setting(s), box(make_box(s)) {
    double const spacing = 1 / static_cast<double>(s.rows);
    fill_load(fluid, box, {.spacing = spacing, .density = 1, .range = s.range * spacing});
    jitter(fluid, {s.jitter * spacing, test_seed(7) + 1});
    for (auto& p : fluid) p.density = 1, p.position[1] = std::clamp(p.position[1], 0.01 * spacing, 1 - 0.01 * spacing);
    scheme = std::make_unique<SmoothScheme>(box, s.shape);
    scheme->material(fluid, Newtonian<Tait>{{.reference_density = 1, .sound_speed = 2.5}, viscosity});
    scheme->density_from(s.density);
    if (s.variable) scheme->variable_range({.spacings = s.range});
    UniformGravity<D> gravity{};
    gravity.acceleration[0] = s.acceleration;
    scheme->external(fluid, gravity);
    simulation = std::make_unique<Simulation>(*scheme, 1e-6);
    simulation->integrate(fluid, Method::leap_frog);
  }
  /// Root mean square of v_x less the exact one, by the largest speed.
  double error_at(double time) {
    run_by_courant(*simulation, *scheme, time, 0.8, 1);
    double square_of_error = 0;
    for (auto const& p : fluid)
      square_of_error += square(p.velocity[0] - channel_flow(p.position[1], simulation->time(), viscosity,
                                                             setting.acceleration, setting.wall_speed));
    double const largest = std::max(setting.acceleration / (8 * viscosity), setting.wall_speed);
    return std::sqrt(square_of_error / static_cast<double>(fluid.size())) / largest;
  }
};

/// While the flow starts, and where it has come to 0.98 of its end.
template <int D>
std::array<double, 2> channel_errors(Setting const& setting) {
  Channel<D> channel(setting);
  double const starting = channel.error_at(0.1), late = channel.error_at(0.8);
  std::printf("%dD rows %zu range %.1f jitter %.1f shape %d density %d var %d a %.0f U %.1f: %.4f %.4f\n", D,
              setting.rows, setting.range, setting.jitter, int(setting.shape), int(setting.density), setting.variable,
              setting.acceleration, setting.wall_speed, starting, late);
  return {starting, late};
}

template <int D>
void expect_channel(Setting const& setting, double bound) {
  for (double const error : channel_errors<D>(setting))
    EXPECT_LT(error, bound) << setting.rows << " rows, " << D << "D";
}

Setting with(auto Setting::*member, auto value, Setting setting = {}) {
  setting.*member = value;
  return setting;
}
Setting couette(Setting setting = {}) {
  setting.acceleration = 0;
  setting.wall_speed = 0.25;
  return setting;
}

TEST(ViscousFlow, PoiseuilleAndCouetteOnALattice) {
  for (Setting const& flow : {Setting{}, couette()}) {
    auto const coarse = channel_errors<2>(with(&Setting::rows, std::size_t{12}, flow)),
               middle = channel_errors<2>(flow), fine = channel_errors<2>(with(&Setting::rows, std::size_t{50}, flow));
    for (std::size_t const k : {0, 1}) {
      EXPECT_LT(middle[k], 0.006);
      EXPECT_LT(middle[k], 0.6 * coarse[k]);
      EXPECT_LT(fine[k], 0.6 * middle[k]);
    }
  }
}

TEST(ViscousFlow, PoiseuilleAndCouetteOnADisorderedStart) {
  for (Setting const& flow : {Setting{}, couette()})
    // Summed densities of a disordered start have pressures of their own, whose flow is no matter of viscosity.
    for (auto const& [density, jitter] :
         {std::pair{DensityFrom::summation, 0.1}, {DensityFrom::continuity, 0.2}, {DensityFrom::volumes, 0.2}})
      expect_channel<2>(with(&Setting::jitter, jitter, with(&Setting::density, density, flow)), 0.02);
}

TEST(ViscousFlow, PoiseuilleWithEveryWeightRangeAndDensity) {
  for (auto const shape : {WeightShape::lucy, WeightShape::cubic_spline, WeightShape::quintic_spline})
    expect_channel<2>(with(&Setting::shape, shape), 0.02);
  for (double const range : {2.4, 4.0}) expect_channel<2>(with(&Setting::range, range), 0.02);
  expect_channel<2>(with(&Setting::density, DensityFrom::summation), 0.02);
  expect_channel<2>(with(&Setting::density, DensityFrom::volumes), 0.02);
  expect_channel<2>(with(&Setting::variable, true, with(&Setting::density, DensityFrom::summation)), 0.02);
}

TEST(ViscousFlow, PoiseuilleAndCouetteIn3D) {
  Setting setting;
  setting.range = 2.4;
  expect_channel<3>(setting, 0.02);
  expect_channel<3>(with(&Setting::jitter, 0.2, couette(setting)), 0.02);
}

/// Two fluids, one upon the other, dragged by the upper wall: the stress is the same in both.
TEST(ViscousFlow, TwoFluidsShareTheStress) {
  for (double const ratio : {5.0, 0.1}) {
    constexpr double lower_viscosity = 0.5, speed = 0.25, spacing = 0.04;
    Box box(Vector{0.0, 0.0}, Vector{8 * spacing, 26 * spacing}, {Boundary::periodic, Boundary::mirror});
    box.wall(1, Box::End::low, {.slips = false});
    box.wall(1, Box::End::high, {.slips = false, .velocity = {speed}});
    Ensemble<Smooth<2>> lower("lower"), upper("upper");
    fill<2>(lower, Vector{0.0, 0.0}, spacing, {8, 13});
    fill<2>(upper, Vector{0.0, 13 * spacing}, spacing, {8, 13});
    for (auto* fluid : {&lower, &upper})
      for (auto& p : *fluid) {
        p.density = 1;
        p.mass = square(spacing);
        p.range = 3 * spacing;
      }
    SmoothScheme scheme(box, WeightShape::wendland);
    Tait const liquid{.reference_density = 1, .sound_speed = 5};
    scheme.material(lower, Newtonian<Tait>{liquid, lower_viscosity});
    scheme.material(upper, Newtonian<Tait>{liquid, ratio * lower_viscosity});
    scheme.density_from(DensityFrom::continuity);
    Simulation simulation(scheme, 1e-6);
    simulation.integrate(lower, Method::leap_frog);
    simulation.integrate(upper, Method::leap_frog);
    run_by_courant(simulation, scheme, 4 / std::min(1.0, ratio), 0.8, 1);
    double const height = 26 * spacing, between = speed * ratio / (1 + ratio);  // the speed where they touch
    double square_of_error = 0;
    for (auto* fluid : {&lower, &upper})
      for (auto const& p : *fluid) {
        double const y = p.position[1] / (height / 2);
        square_of_error += square(p.velocity[0] - (y < 1 ? between * y : between + (speed - between) * (y - 1)));
      }
    EXPECT_LT(std::sqrt(square_of_error / 208) / speed, 0.01) << ratio;
    auto const slope = [&](Ensemble<Smooth<2>> const& fluid) {
      return (fluid[8 * 9].velocity[0] - fluid[8 * 3].velocity[0]) / (6 * spacing);
    };
    EXPECT_NEAR(slope(lower) / slope(upper) / ratio, 1, 0.01);
  }
}

/// The part of a fluid's velocity in a wave along the last axis.
template <int D>
double wave_of(Ensemble<Smooth<D>> const& fluid, int component) {
  double sum = 0, norm = 0;
  for (auto const& p : fluid) {
    double const wave = std::sin(2 * pi * p.position[D - 1]);
    sum += p.velocity[component] * wave;
    norm += square(wave);
  }
  return sum / norm;
}

/// A periodic box with one wave along its last axis, of length 1.
template <int D>
struct Wave {
  Box box;
  Ensemble<Smooth<D>> fluid{"fluid"};
  SmoothScheme scheme;
  std::unique_ptr<Simulation> simulation;

  static Box make_box(std::size_t n) {
    Vector<D> low{}, high{};
    for (int a = 0; a < D; ++a) high[a] = a == D - 1 ? 1 : 8.0 / static_cast<double>(n);
    return Box(low, high, Boundary::periodic);
  }
  template <class M>
  Wave(std::size_t n, double move, int component, M const& material)
      : box(make_box(n)), scheme(box, WeightShape::wendland) {
    double const spacing = 1 / static_cast<double>(n);
    fill_load(fluid, box, {.spacing = spacing, .density = 1, .range = 3 * spacing});
    jitter(fluid, {move * spacing, test_seed(8) + 1});
    for (auto& p : fluid) p.density = 1, p.velocity[component] = 0.02 * std::sin(2 * pi * p.position[D - 1]);
    scheme.material(fluid, material);
    scheme.density_from(DensityFrom::continuity);
    simulation = std::make_unique<Simulation>(scheme, 1e-6);
    simulation->integrate(fluid, Method::leap_frog);
  }
};

template <int D>
double shear_decay(std::size_t n, double move) {
  double const viscosity = 0.2, end = 0.15;
  Wave<D> wave(n, move, 0, Newtonian<Tait>{{.reference_density = 1, .sound_speed = 2}, viscosity});
  run_by_courant(*wave.simulation, wave.scheme, end, 0.5, 1);
  return std::log(0.02 / wave_of<D>(wave.fluid, 0)) / (viscosity * square(2 * pi) * end);
}

TEST(ViscousFlow, AShearWaveDecaysAtItsRate) {
  double const coarse = shear_decay<2>(16, 0), middle = shear_decay<2>(32, 0), fine = shear_decay<2>(64, 0);
  double const loose = shear_decay<2>(32, 0.2), space = shear_decay<3>(32, 0.2);
  std::printf("shear wave: %.4f %.4f %.4f, disordered %.4f, 3D %.4f\n", coarse, middle, fine, loose, space);
  EXPECT_NEAR(middle, 1, 0.02);
  EXPECT_NEAR(fine, 1, 0.005);
  EXPECT_NEAR(std::log2((coarse - 1) / (fine - 1)) / 2, 2, 0.4);
  EXPECT_NEAR(loose, 1, 0.02);
  EXPECT_NEAR(space, 1, 0.02);
}

/// The rate at which a standing wave of sound loses amplitude, by (bulk + 2 (1 - 1/D) shear) k^2 / (2 rho): from one
/// extreme of its velocity to the next of the same sign.
template <int D>
double sound_decay(double shear, double bulk) {
  Wave<D> wave(40, 0, D - 1, Newtonian<Tait>{{.reference_density = 1, .sound_speed = 5, .gamma = 1}, shear, bulk});
  double const step = 0.2 * wave.scheme.courant_step();
  wave.simulation->step_size(step);
  std::vector<double> extremes, times;
  double before = 0, now = 0;
  while (extremes.size() < 4) {
    wave.simulation->run(1);
    double const next = wave_of<D>(wave.fluid, D - 1);
    if (before != 0 && (now - before) * (next - now) < 0) {  // the parabola through three
      double const bend = before - 2 * now + next, off = 0.5 * (before - next) / bend;
      extremes.push_back(std::abs(now - 0.25 * (before - next) * off));
      times.push_back(wave.simulation->time() + (off - 1) * step);
    }
    before = now;
    now = next;
  }
  double const k2 = square(2 * pi), rate = std::log(extremes[1] / extremes[3]) / (times[3] - times[1]);
  return rate / (0.5 * k2 * (bulk + 2 * (1 - 1.0 / D) * shear));
}

TEST(ViscousFlow, BothViscositiesDampSound) {
  auto const expect = [](int dimension, double shear, double bulk, double found) {
    std::printf("sound, %dD, shear %.2f, bulk %.2f: %.4f\n", dimension, shear, bulk, found);
    EXPECT_NEAR(found, 1, 0.03) << dimension << "D, shear " << shear << ", bulk " << bulk;
  };
  expect(1, 0.3, 0.1, sound_decay<1>(0.3, 0.1));
  expect(2, 0, 0.1, sound_decay<2>(0, 0.1));
  expect(2, 0.1, 0, sound_decay<2>(0.1, 0));
  expect(2, 0.05, 0.15, sound_decay<2>(0.05, 0.15));
  expect(3, 0.05, 0.05, sound_decay<3>(0.05, 0.05));
}

/// No pressure, so that heat flows through matter at rest; the specific heat is 1.
struct Conductor {
  double conductivity;
  State state(auto const& p) const { return {.temperature = p.specific_energy, .sound_speed = 1}; }
  TransportCoefficients transport(auto const&) const { return {.conductivity = conductivity}; }
  double diffusivity(auto const& p) const { return conductivity / p.density; }
};

template <int D>
double heat_decay(double move) {
  Wave<D> wave(32, move, 0, Conductor{0.2});
  for (auto& p : wave.fluid) {
    p.velocity = {};
    p.specific_energy = 2 + 0.5 * std::sin(2 * pi * p.position[D - 1]);
  }
  double const end = 0.15;
  run_by_courant(*wave.simulation, wave.scheme, end, 0.5, 1);
  double sum = 0, norm = 0;
  for (auto const& p : wave.fluid) {
    double const sine = std::sin(2 * pi * p.position[D - 1]);
    sum += p.specific_energy * sine;
    norm += square(sine);
  }
  return std::log(0.5 / (sum / norm)) / (0.2 * square(2 * pi) * end);
}

TEST(ViscousFlow, AWaveOfTemperatureDecaysAtItsRate) {
  double const found[] = {heat_decay<1>(0), heat_decay<2>(0), heat_decay<2>(0.2), heat_decay<3>(0.2)};
  std::printf("heat wave: %.4f %.4f %.4f %.4f\n", found[0], found[1], found[2], found[3]);
  for (double const rate : found) EXPECT_NEAR(rate, 1, 0.035);  // disordered: 0.971
}

TEST(ViscousFlow, HeatFlowsThroughTwoConductorsBetweenWalls) {
  constexpr double spacing = 0.04, first = 0.5, second = 0.1;
  Box box(Vector{0.0, 0.0}, Vector{8 * spacing, 26 * spacing}, {Boundary::periodic, Boundary::mirror});
  box.wall(1, Box::End::low, {.temperature = 2});
  box.wall(1, Box::End::high, {.temperature = 1});
  Ensemble<Smooth<2>> lower("lower"), upper("upper");
  fill<2>(lower, Vector{0.0, 0.0}, spacing, {8, 13});
  fill<2>(upper, Vector{0.0, 13 * spacing}, spacing, {8, 13});
  for (auto* one : {&lower, &upper})
    for (auto& p : *one) {
      p.density = 1;
      p.mass = square(spacing);
      p.range = 3 * spacing;
      p.specific_energy = 1.5;
    }
  SmoothScheme scheme(box, WeightShape::wendland);
  scheme.material(lower, Conductor{first});
  scheme.material(upper, Conductor{second});
  scheme.density_from(DensityFrom::continuity);
  Simulation simulation(scheme, 0.8 * scheme.courant_step());
  simulation.integrate(lower, Method::rk2);
  simulation.integrate(upper, Method::rk2);
  simulation.run(static_cast<std::uint64_t>(8 / simulation.step_size()));
  double const between = (2 * first + 1 * second) / (first + second);  // the temperature where they touch
  for (auto* one : {&lower, &upper})
    for (auto const& p : *one) {
      double const y = p.position[1] / (13 * spacing);
      double const expected = y < 1 ? 2 + (between - 2) * y : between + (1 - between) * (y - 1);
      EXPECT_NEAR(p.specific_energy, expected, 0.01) << y;
    }
}

}  // namespace
}  // namespace boltzmann::viscous_flow_test
