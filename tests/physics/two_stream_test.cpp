// Two streams (section 6.4 of the 1990 thesis, scenarios/two-stream.toml): which wave grows, how fast, and the vortices
// that it ends in.
#include <tests/physics/mesh_factor.hpp>
#include <tests/physics/shipped.hpp>
#include <tests/physics/waves.hpp>

#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/exact/plasma.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/loaders/sinusoidal_load.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <map>

namespace boltzmann::two_stream_test {
namespace {

constexpr double pi = std::numbers::pi;

// Appendix A.4, in cgs: 2000 sheets in 1e6 cm, each for ten electrons per square centimeter.
struct Thesis {
  UnitSystem units = UnitSystem::cgs();
  double length = 1e6, per_sheet = 10, sheets = 2000;
  double charge = units(constants::elementary_charge), mass = units(constants::electron_mass);
  double energy = units(constants::boltzmann) * 16000;
  double thermal = std::sqrt(energy / mass);
  double plasma_frequency = std::sqrt(4 * pi * sheets * per_sheet * charge * charge / (length * mass));
  double wave_number(int mode) const { return 2 * pi * mode / length; }
  /// The growth rate of a mode, on a mesh of so many cells (0: none).
  double growth(int mode, double cells = 0) const {
    double const factor = cells == 0 ? 1 : mesh_factor(2, false, {pi * mode / cells}, {1});
    return exact::two_stream_growth(std::sqrt(factor) * plasma_frequency, 5 * thermal, thermal, wave_number(mode));
  }
};

// Roots by 30-digit arithmetic: 0.283970, 0.332551, 0.315702, 0.212591 wp for modes 2 to 5; mode 1 and 6 don't grow.
TEST(TwoStream, TheThirdModeShouldGrowFastest) {
  Thesis const thesis;
  EXPECT_NEAR(thesis.plasma_frequency, 7.98e3, 3);
  EXPECT_NEAR(thesis.wave_number(3) * 5 * thesis.thermal / thesis.plasma_frequency, 0.58173, 1e-4);
  EXPECT_NEAR(thesis.growth(2) / thesis.plasma_frequency, 0.283970, 2e-5);
  EXPECT_NEAR(thesis.growth(3) / thesis.plasma_frequency, 0.332551, 2e-5);
  EXPECT_NEAR(thesis.growth(4) / thesis.plasma_frequency, 0.315702, 2e-5);
  EXPECT_NEAR(thesis.growth(5) / thesis.plasma_frequency, 0.212591, 2e-5);
  EXPECT_EQ(thesis.growth(6), 0);
}

// The thesis' streams with a quiet start and a tiny ripple. Each mode by itself grows as kinetic theory has it: between
// 6/gamma, when what damps of the ripple is gone, and the time at which it has grown by e^4 more.
TEST(TwoStream, ModesGrowAsTheoryHasIt) {
  Thesis const thesis;
  std::map<int, double> rates;
  for (int const mode : {2, 3, 4}) {
    Box const box(Vector{0.0}, Vector{thesis.length}, Boundary::periodic);
    MeshScheme mesh(box, {128}, coulomb(1));
    mesh.background(true);
    Ensemble<Coulomb<1>> right("right", 65536), left("left", 65536);
    for (auto* stream : {&right, &left}) {
      double const weight = thesis.per_sheet * thesis.sheets / 2 / static_cast<double>(stream->size());
      for (auto& p : *stream) p.charge = -weight * thesis.charge, p.mass = weight * thesis.mass;
      quiet_load(*stream, box);
      maxwellian_load(*stream, {.temperature = 16000 * weight,
                                .boltzmann_constant = thesis.units(constants::boltzmann),
                                .drift = {(stream == &right ? 5 : -5) * thesis.thermal},
                                .quiet = true});
      mesh.add(*stream);
    }
    velocity_ripple(right, box, {.wave = wave_of_mode(box, 0, mode), .amplitude = 1e-3 * thesis.thermal});
    double const step = 0.1 / thesis.plasma_frequency, gamma = thesis.growth(mode, 128);
    Simulation simulation(mesh, step);
    simulation.integrate(right, Method::leap_frog);
    simulation.integrate(left, Method::leap_frog);
    std::vector<double> times, amplitudes;
    simulation.observe(2, [&](Simulation const& s) {
      times.push_back(s.time());
      amplitudes.push_back(std::abs(mode_of(mesh_field(mesh, "field"), 0, {mode, 0, 0})));
    });
    simulation.run(static_cast<std::uint64_t>(8 / gamma / step));
    rates[mode] = growth_rate(times, amplitudes, 4 / gamma, 8 / gamma);
    EXPECT_NEAR(rates[mode] / gamma, 1, 0.015) << "mode " << mode;
    EXPECT_NEAR(rates[mode] / thesis.growth(mode), 1, 0.03) << "mode " << mode;
  }
  EXPECT_GT(rates[3], 1.02 * rates[4]);
  EXPECT_GT(rates[3], 1.1 * rates[2]);
}

/// How strongly the density of electrons slower than a third of a stream is modulated with so many periods, for modes 1
/// to 6. The slow ones are those that turn around in a vortex; there are none between vortices' centres.
std::array<double, 7> slow_electrons(ScenarioSimulation& run, double fastest) {
  std::array<std::complex<double>, 7> sums{};
  for (char const* name : {"stream 1", "stream 2"}) {
    auto& electrons = ensemble(run, name);
    Field const& velocity = *electrons.find_field("velocity");
    for (std::size_t i = 0; i < electrons.size(); ++i) {
      if (std::abs(electrons.row(i)[velocity.offset]) > fastest) continue;
      for (std::size_t mode = 0; mode < sums.size(); ++mode)
        sums[mode] += std::polar(1.0, -2 * pi * static_cast<double>(mode) * electrons.row(i)[0] / 1e6);
    }
  }
  std::array<double, 7> result;
  for (std::size_t mode = 0; mode < sums.size(); ++mode) result[mode] = std::abs(sums[mode]);
  return result;
}

void expect_three_vortices(ScenarioSimulation& run) {
  auto const slow = slow_electrons(run, 8e7);
  EXPECT_GT(slow[0], 100);  // at the start there are none
  for (std::size_t const mode : {1u, 2u, 4u, 5u}) EXPECT_GT(slow[3], 1.3 * slow[mode]) << "mode " << mode;
}

// The thesis' run as it is shipped: random positions, a ripple of 20 %, 2000 electrons. After 120 steps the picture
// shows three vortices (of this seed: others give other ones, but roundings don't grow in so few steps); over 1000
// steps energy drifts by less than 0.5 %, and momentum stays.
TEST(TwoStream, ThreeVorticesInTheThesisRun) {
  Overrides own;
  own.seed = 5;
  auto const run = shipped("two-stream", own);
  ASSERT_EQ(ensemble(*run, "ions").size(), 2000u);
  EXPECT_LT(slow_electrons(*run, 8e7)[0], 5);
  double const start = total_energy(*run);
  auto const momentum = [&] {
    double sum = 0, size = 0;
    for (auto const& e : run->ensembles) {
      Field const &v = *e->find_field("velocity"), &m = *e->find_field("mass");
      for (std::size_t i = 0; i < e->size(); ++i) {
        sum += e->row(i)[m.offset] * e->row(i)[v.offset];
        size += std::abs(e->row(i)[m.offset] * e->row(i)[v.offset]);
      }
    }
    return std::pair(sum, size);
  };
  auto const [momentum_before, size] = momentum();
  double largest = 0;
  for (int k = 0; k < 25; ++k) {
    run->simulation->run(40);
    largest = std::max(largest, std::abs(total_energy(*run) / start - 1));
    if (run->simulation->step() == 120) expect_three_vortices(*run);
  }
  EXPECT_EQ(run->simulation->step(), 1000);
  EXPECT_LT(largest, 0.005);
  EXPECT_GT(largest, 1e-6);  // it is measured
  EXPECT_LT(std::abs(momentum().first - momentum_before), 1e-13 * size);
}

// Without noise the ripple of the thesis makes three vortices, whatever chance would have made of it.
TEST(TwoStream, ThreeVorticesFromAQuietStart) {
  Overrides quiet;
  quiet.set = {"ensembles.0.load.quiet=true", "ensembles.0.quiet=true",        "ensembles.1.load.kind='quiet'",
               "ensembles.1.quiet=true",      "ensembles.2.load.kind='quiet'", "ensembles.2.quiet=true"};
  auto const run = shipped("two-stream", quiet);
  run->simulation->run(120);
  expect_three_vortices(*run);
}

}  // namespace
}  // namespace boltzmann::two_stream_test
