// What every method of dissipation keeps: the same bits for any number of threads and after a restart, noise of
// the right kind, readable errors.
#include "dissipation_oracle.hpp"
#include "meso_system.hpp"

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/dissipation/pair_dissipation.hpp>
#include <boltzmann/dissipation/typed_friction.hpp>
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/laws/soft.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/meso.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/schemes/mesh/p3m_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/files/temporary_folder.hpp>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <filesystem>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <sstream>

namespace boltzmann::pair_dissipation_test {
namespace {

enum class Kind { simultaneous, corrector, splitting, metropolis };
constexpr Kind all_kinds[] = {Kind::simultaneous, Kind::corrector, Kind::splitting, Kind::metropolis};

DissipationLaw usual(double range = 1.5) {
  DissipationLaw d;
  d.friction = 3;
  d.range = range;
  d.conduction = 5;
  return d;
}

/// A soft gas of two kinds of particles, one of which is very fast; between the kinds friction is typed.
struct Gas {
  Box box;
  Ensemble<Meso<2>> light{"light"}, heavy{"heavy"};
  PairScheme scheme;
  PairDissipation dpd;
  Simulation simulation;

  explicit Gas(Kind kind, std::size_t count = 400, int threads = 1)
      : box(cube<2>(std::sqrt(static_cast<double>(count)))), scheme(box, 1), dpd(scheme, 1), simulation(scheme, 0.004) {
    scatter(light, box, count - count / 4, Masses::unequal, 40, 1);
    scatter(heavy, box, count / 4, Masses::unequal, 40, 2);
    for (auto& p : heavy) p.mass *= 4;
    light[count / 2].velocity[0] = 60;
    scheme.internal(light, Soft{.repulsion = 20, .range = 1});
    dpd.state(light, StateLaw(20));
    dpd.state(heavy, StateLaw({0.5, 1, 4}, {15, 20, 25}));
    dpd.internal(light, usual());
    dpd.between(light, heavy,
                with_formulas(usual(1.2), {.weight = "cos(0.5*pi*r/range)", .friction = "3*exp(-r/4)*(T/2)^0.5"}));
    dpd.corrector(kind == Kind::corrector);
    dpd.method(kind == Kind::simultaneous || kind == Kind::corrector ? DissipationMethod::simultaneous
                                                                     : DissipationMethod::shardlow);
    dpd.metropolis(kind == Kind::metropolis);
    simulation.add(dpd);
    simulation.integrate(light, Method::leap_frog);
    simulation.integrate(heavy, Method::leap_frog);
    simulation.seed(test_seed(31));
    simulation.threads(threads);
  }

  std::vector<AnyEnsemble*> ensembles() { return {&light, &heavy}; }
  std::vector<std::uint64_t> bits() const {
    auto all = bits_of_rows(light);
    auto const more = bits_of_rows(heavy);
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

// ---- bits ----

TEST(PairDissipation, TheSameBitsForAnyNumberOfThreads) {
  for (Kind const kind : all_kinds) {
    Gas one(kind, 30000, 1);  // several chunks
    one.simulation.run(3);
    for (int const threads : {2, 3, 8}) {
      Gas more(kind, 30000, threads);
      more.simulation.run(3);
      ASSERT_TRUE(one.bits() == more.bits()) << static_cast<int>(kind) << " " << threads;
      ASSERT_EQ(one.simulation.measure().internal, more.simulation.measure().internal);
      ASSERT_EQ(one.dpd.report(), more.dpd.report());
    }
  }
}

TEST(PairDissipation, TheSameBitsAfterARestart) {
  for (Kind const kind : all_kinds) {
    Gas whole(kind);
    whole.simulation.run(83);
    EXPECT_GT(whole.scheme.neighbourhood().builds() + whole.scheme.neighbourhood().moves(), 3U);
    for (std::uint64_t const stop : {1, 17, 40, 41, 42}) {
      Gas begun(kind), resumed(kind, 400, 2);
      begun.simulation.run(stop);
      set_rows(resumed.light, bits_of_rows(begun.light));
      set_rows(resumed.heavy, bits_of_rows(begun.heavy));
      resumed.simulation.restore(begun.simulation.step(), begun.simulation.step_size(), begun.simulation.seed(),
                                 begun.simulation.state());
      resumed.simulation.run(83 - stop);
      ASSERT_TRUE(resumed.bits() == whole.bits()) << static_cast<int>(kind) << " " << stop;
      EXPECT_EQ(resumed.dpd.report(), whole.dpd.report());
      EXPECT_EQ(resumed.simulation.state(), whole.simulation.state());
    }
  }
}

TEST(PairDissipation, TheSameBitsAfterACheckpoint) {
  for (Kind const kind : all_kinds) {
    TemporaryFolder folder;
    Gas whole(kind);
    whole.simulation.run(60);
    {
      Gas begun(kind);
      Recording recording(begun.simulation, UnitSystem::reduced(), folder / "run");
      recording.checkpoint(10);
      begun.simulation.run(35);
    }
    Gas resumed(kind);
    Recording recording(resumed.simulation, UnitSystem::reduced(), folder / "run");
    recording.checkpoint(10);
    recording.resume();
    ASSERT_EQ(resumed.simulation.step(), 35);
    resumed.simulation.run(25);
    ASSERT_TRUE(resumed.bits() == whole.bits()) << static_cast<int>(kind);
  }
}

TEST(PairDissipation, LookingChangesNothing) {
  for (Kind const kind : all_kinds) {
    Gas one(kind), looked_at(kind);
    one.simulation.run(30);
    looked_at.simulation.observe(1, [](Simulation const& simulation) { EXPECT_GT(simulation.measure().internal, 0); });
    looked_at.dpd.warnings(0.004);
    looked_at.simulation.run(10);
    looked_at.dpd.warnings(0.004);
    looked_at.simulation.run(20);
    EXPECT_TRUE(one.bits() == looked_at.bits()) << static_cast<int>(kind);
  }
}

/// What another process prints that is forced to an instruction set.
std::vector<double> numbers_with(std::string const& set, int threads) {
  std::string const self = std::filesystem::read_symlink("/proc/self/exe").string();
  std::string const command = "BOLTZMANN_INSTRUCTIONS=" + set + " '" + self + "' --numbers " + std::to_string(threads);
  FILE* const pipe = popen(command.c_str(), "r");
  std::string text(1 << 20, ' ');
  text.resize(std::fread(text.data(), 1, text.size(), pipe));
  EXPECT_EQ(pclose(pipe), 0) << command;
  std::istringstream stream(text);
  return {std::istream_iterator<double>(stream), {}};
}

TEST(PairDissipation, EveryInstructionSetDoesTheSame) {
  auto const sets = instruction_sets();
  std::vector<double> first;
  for (auto const set : sets) {
    auto const numbers = numbers_with(to_string(set), 1);
    ASSERT_EQ(numbers.size(), 4U * 4 * 400);
    EXPECT_EQ(numbers, numbers_with(to_string(set), 3)) << to_string(set);
    if (first.empty()) first = numbers;
    for (std::size_t n = 0; n < numbers.size(); ++n)
      ASSERT_NEAR(numbers[n], first[n], 1e-9 * (1 + std::abs(first[n]))) << to_string(set) << " " << n;
  }
}

// ---- conservation ----

TEST(PairDissipation, KeepsMomentumAndEnergyBesideForces) {
  for (Kind const kind : all_kinds) {
    Gas gas(kind);
    auto const momentum = momentum_of(gas.ensembles());
    auto const total = [&] {
      auto const m = gas.simulation.measure();
      return m.potential + m.internal + kinetic_of(gas.ensembles());
    };
    double const energy = total(), internal = gas.simulation.measure().internal;
    gas.simulation.step_size(0.0005);
    gas.simulation.run(800);
    EXPECT_LT(distance(momentum_of(gas.ensembles()), momentum), 1e-9) << static_cast<int>(kind);
    EXPECT_GT(gas.simulation.measure().internal, internal + 100) << "the fast particle has not heated anybody";
    EXPECT_NEAR(total(), energy, 2e-5 * energy) << static_cast<int>(kind);
  }
}

TEST(PairDissipation, AngularMomentumOfProjectedFriction) {
  for (Kind const kind : all_kinds) {
    Ensemble<Meso<3>> drop("drop");
    Box const box = cube<3>(5, Boundary::open);
    scatter(drop, box, 200, Masses::unequal, 40);
    PairScheme scheme(box, 1);
    PairDissipation dpd(scheme, 1);
    dpd.state(drop, StateLaw(20));
    dpd.internal(drop, usual());
    dpd.corrector(kind == Kind::corrector);
    if (kind == Kind::splitting || kind == Kind::metropolis) dpd.method(DissipationMethod::shardlow);
    dpd.metropolis(kind == Kind::metropolis);
    auto const turning = [&] {
      std::array<double, 3> sum{};
      for (auto const& p : drop)
        for (int a = 0; a < 3; ++a) {
          int const b = (a + 1) % 3, c = (a + 2) % 3;
          sum[a] += p.mass * (p.position[b] * p.velocity[c] - p.position[c] * p.velocity[b]);
        }
      return sum;
    };
    auto const before = turning();
    double const motion = kinetic_of({&drop});
    for (std::uint64_t step = 0; step < 20; ++step) dpd.advance({0.005, step, test_seed(1)});
    EXPECT_GT(std::abs(kinetic_of({&drop}) - motion), 1);
    EXPECT_LT(distance(turning(), before), 1e-10) << static_cast<int>(kind);
  }
}

TEST(PairDissipation, APistonsWorkIsAllThatChangesTheEnergy) {
  // A gas without forces: to rounding.
  for (Kind const kind : all_kinds) {
    Ensemble<Meso<2>> gas("gas");
    PairScheme scheme(Box(Vector<2>{0, 0}, Vector<2>{12, 6}, {Boundary::reflecting, Boundary::periodic}), 1.5);
    scheme.box().wall(0, Box::End::low, Wall{.velocity = {1, 0, 0}});
    scatter(gas, scheme.box(), 120, Masses::unequal, 40);
    PairDissipation dpd(scheme, 1);
    dpd.state(gas, StateLaw(40));
    dpd.internal(gas, usual());
    dpd.corrector(kind == Kind::corrector);
    if (kind == Kind::splitting || kind == Kind::metropolis) dpd.method(DissipationMethod::shardlow);
    dpd.metropolis(kind == Kind::metropolis);
    Simulation simulation(scheme, 0.004);
    simulation.add(dpd);
    simulation.integrate(gas, Method::leap_frog);
    double const before = kinetic_of({&gas}) + internal_of({&gas}), internal = internal_of({&gas});
    simulation.run(1000);
    double const work = simulation.measure().work;
    EXPECT_GT(work, 20) << static_cast<int>(kind);
    EXPECT_GT(internal_of({&gas}), internal + 0.3 * work) << "friction has not taken the work up";
    EXPECT_NEAR(kinetic_of({&gas}) + internal_of({&gas}) - work, before, 1e-11 * before) << static_cast<int>(kind);
    for (auto const& p : gas) ASSERT_GE(p.position[0], scheme.box().low(0));
  }
}

TEST(PairDissipation, EmptyEnsembles) {
  for (Kind const kind : all_kinds)
    for (std::size_t const count : {0U, 1U, 5U}) {
      Ensemble<Meso<3>> some("some"), none("none");
      PairScheme scheme(cube<3>(4), 1);
      scatter(some, scheme.box(), count, Masses::unequal, 40);
      PairDissipation dpd(scheme, 1);
      for (auto* ensemble : {&none, &some}) dpd.state(*ensemble, StateLaw(40));
      dpd.internal(none, usual());
      dpd.between(none, some, usual());
      dpd.internal(some, usual());
      dpd.corrector(kind == Kind::corrector);
      if (kind == Kind::splitting || kind == Kind::metropolis) dpd.method(DissipationMethod::shardlow);
      dpd.metropolis(kind == Kind::metropolis);
      Simulation simulation(scheme, 0.01);
      simulation.add(dpd);
      for (auto* ensemble : {&none, &some}) simulation.integrate(*ensemble, Method::leap_frog);
      double const total = kinetic_of({&some}) + internal_of({&some});
      simulation.run(30);
      EXPECT_NEAR(kinetic_of({&some}) + internal_of({&some}), total, 1e-12 * total);
    }
}

template <int D, class Real = double>
struct HotIon : Coulomb<D, Real> {
  static constexpr char const* class_name = "HotIon";
  Real internal_energy;

  static FieldTable fields() {
    return Coulomb<D, Real>::fields().add(&HotIon::internal_energy, "internal_energy", dimensions::energy, "");
  }
};

TEST(PairDissipation, BesideTwoSchemes) {
  // Soft ions whose charges go through P3M, rubbed by the pair scheme: both boxes hold the same particles.
  for (Kind const kind : {Kind::simultaneous, Kind::splitting}) {
    Box const box(Vector<3>{0, 0, 0}, Vector<3>{6, 6, 6}, Boundary::periodic);
    Ensemble<HotIon<3>> ions("ions");
    scatter(ions, box, 216, Masses::equal, 40);
    for (std::size_t i = 0; i < ions.size(); ++i) {
      ions[i].charge = i % 2 == 0 ? 1 : -1;
      for (int a = 0; a < 3; ++a)
        ions[i].position[a] = 0.5 + static_cast<double>(i / (a == 0 ? 1 : a == 1 ? 6 : 36) % 6);
    }
    PairScheme near(box, 1.5);
    near.internal(ions, Soft{.repulsion = 60, .range = 1.5});
    P3MScheme far(box, coulomb(0.3), 1e-4);
    far.add(ions);
    PairDissipation dpd(near, 1);
    dpd.state(ions, StateLaw(20));
    dpd.internal(ions, usual());
    if (kind == Kind::splitting) dpd.method(DissipationMethod::shardlow);
    Simulation simulation(near, 0.002);
    simulation.add(far);
    simulation.add(dpd);
    simulation.integrate(ions, Method::leap_frog);
    auto const momentum = momentum_of({&ions});
    auto const total = [&] {
      auto const m = simulation.measure();
      return m.potential + m.internal + kinetic_of({&ions});
    };
    double const energy = total(), motion = kinetic_of({&ions});
    simulation.run(200);
    EXPECT_GT(std::abs(kinetic_of({&ions}) - motion), 0.02 * motion);
    EXPECT_NEAR(total(), energy, 1e-3 * motion);
    EXPECT_LT(distance(momentum_of({&ions}), momentum), 0.01);  // P3M's accuracy
  }
}

// ---- noise ----

TEST(Noise, PhiloxIsThatOfItsAuthors) {
  // Known answers that come with the authors' own library.
  EXPECT_EQ(philox_by_hand({0, 0, 0, 0}, 0, 0), (Four{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox_by_hand({~0U, ~0U, ~0U, ~0U}, ~0U, ~0U), (Four{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox_by_hand({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, 0xa4093822, 0x299f31d0),
            (Four{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Noise, NormalsAreThoseOfBoxAndMuller) {
  double const pi = std::acos(-1.0);
  for (std::uint32_t n = 0; n < 20000; ++n) {
    auto const word = philox_by_hand({n, 0, 0, 0}, 1, 2);
    std::uint32_t const radius = n == 0 ? 0 : n == 1 ? ~0U : word[0], angle = word[1];
    detail::Words<2> const zero{};
    auto const found = normals<2>(zero + radius, zero + angle);
    double const r = std::sqrt(-2 * std::log((radius + 0.5) / 4294967296.0));
    // Two bits choose a mirror image and a turn of the quadrant about the x axis.
    double const phi = ((angle & 0x3fffffffU) + 0.5) / 1073741824.0 * pi / 2 - pi / 4;
    double x = std::cos(phi), y = std::sin(phi);
    if (angle >> 31U) x = -x;
    if ((angle >> 30U) & 1U) std::swap(x, y);
    ASSERT_NEAR(found[0][1], r * x, 2e-9 * (1 + r));
    ASSERT_NEAR(found[1][1], r * y, 2e-9 * (1 + r));
  }
}

/// Chains of three particles, each of which touches the next, far from other chains. Nothing but noise of one
/// coupling or two: p[step][axis][n] is what particle n has got.
struct Chains {
  static constexpr std::size_t count = 10000;
  std::vector<std::array<std::vector<double>, 3>> push;
  double amplitude = 0;

  Chains(bool projected, int couplings, bool two_ensembles, DissipationMethod method, int steps = 3) {
    double const length = 6 * static_cast<double>(count);
    Box const box(Vector<3>{0, 0, 0}, Vector<3>{length, 6, 6}, Boundary::periodic);
    Ensemble<Newton<3>> ends("ends"), middles("middles");
    // Numbers have nothing to do with places.
    auto const place = [](std::size_t n) { return n * 7919 % count; };
    for (std::size_t n = 0; n < 3 * count; ++n) {
      Newton<3> p{};
      p.mass = 1;
      p.position = {6 * static_cast<double>(place(n / 3)) + 0.7 * static_cast<double>(n % 3), 3, 3};
      (two_ensembles && n % 3 == 1 ? middles : ends).add(p);
    }
    PairScheme scheme(box, 1);
    PairDissipation dpd(scheme, 1);
    dpd.method(method);
    DissipationLaw d;
    d.convention = Convention::fixed_temperature;
    d.friction = 1e-13;
    d.temperature = 1e13;
    d.range = 1;
    d.projected = projected;
    for (int c = 0; c < couplings; ++c) two_ensembles ? dpd.between(ends, middles, d) : dpd.internal(ends, d);
    double const dt = 0.5;
    amplitude = std::sqrt(2 * dt) * 0.3;
    for (int step = 0; step < steps; ++step) {
      for (auto* ensemble : {&ends, &middles})
        for (auto& p : *ensemble) p.velocity = {0, 0, 0};
      dpd.advance({dt, static_cast<std::uint64_t>(step), test_seed(12)});
      std::array<std::vector<double>, 3> got;
      for (std::size_t n = 0; n < 3 * count; ++n) {
        auto const& p = !two_ensembles ? ends[n] : n % 3 == 1 ? middles[n / 3] : ends[n / 3 * 2 + n % 3 / 2];
        for (std::size_t a = 0; a < 3; ++a) got[a].push_back(p.velocity[a]);
      }
      push.push_back(got);
    }
  }

  /// The number that particle 0 (or 2) of each chain has got, in units of the noise.
  std::vector<double> of(int step, std::size_t axis, std::size_t particle) const {
    std::vector<double> all;
    for (std::size_t n = 0; n < count; ++n) all.push_back(push[step][axis][3 * n + particle] / amplitude);
    return all;
  }
};

double mean(std::vector<double> const& x) {
  double sum = 0;
  for (double const one : x) sum += one;
  return sum / static_cast<double>(x.size());
}

double mean_product(std::vector<double> const& x, std::vector<double> const& y) {
  double sum = 0;
  for (std::size_t n = 0; n < x.size(); ++n) sum += x[n] * y[n];
  return sum / static_cast<double>(x.size());
}

/// Five standard errors of the mean of a variable of variance 1. What is drawn at a seed is the same on every
/// processor.
constexpr double five_errors = 0.05;

void expect_normal(std::vector<double> const& x, std::string const& what) {
  EXPECT_LT(std::abs(mean(x)), five_errors) << what;
  EXPECT_NEAR(mean_product(x, x), 1, std::sqrt(2) * five_errors) << what;
  double third = 0, fourth = 0;
  for (double const one : x) third += one * one * one, fourth += one * one * one * one;
  EXPECT_LT(std::abs(third / static_cast<double>(x.size())), std::sqrt(15) * five_errors) << what;
  EXPECT_NEAR(fourth / static_cast<double>(x.size()), 3, std::sqrt(96) * five_errors) << what;
}

TEST(Noise, IsNormalAndIndependent) {
  for (bool const two_ensembles : {false, true})
    for (bool const projected : {true, false})
      for (DissipationMethod const method : {DissipationMethod::simultaneous, DissipationMethod::shardlow}) {
        Chains const chains(projected, 1, two_ensembles, method);
        std::string const what =
            to_string(method) + (projected ? " projected" : "") + (two_ensembles ? " two ensembles" : "");
        std::vector<std::vector<double>> all;
        for (int step = 0; step < 3; ++step)
          for (std::size_t axis = 0; axis < (projected ? 1U : 3U); ++axis)
            for (std::size_t const particle : {0U, 2U}) all.push_back(chains.of(step, axis, particle));
        for (std::size_t i = 0; i < all.size(); ++i) {
          // Pair splitting: the second pair of a chain meets a middle that moves already, but friction is nothing.
          expect_normal(all[i], what);
          for (std::size_t j = 0; j < i; ++j)
            EXPECT_LT(std::abs(mean_product(all[i], all[j])), five_errors) << what << " " << i << " " << j;
        }
        for (int step = 0; step < 3; ++step)
          for (std::size_t axis = 0; axis < 3; ++axis) {
            auto const a = chains.of(step, axis, 0), b = chains.of(step, axis, 1), c = chains.of(step, axis, 2);
            for (std::size_t n = 0; n < a.size(); ++n) ASSERT_NEAR(a[n] + b[n] + c[n], 0, 1e-12);
            EXPECT_EQ(mean_product(a, a) > 0, !projected || axis == 0);
          }
      }
}

TEST(Noise, CouplingsHaveEachTheirOwn) {
  for (DissipationMethod const method : {DissipationMethod::simultaneous, DissipationMethod::shardlow})
    for (bool const two_ensembles : {false, true}) {
      Chains const one(true, 1, two_ensembles, method, 1), both(true, 2, two_ensembles, method, 1);
      auto const a = one.of(0, 0, 0), sum = both.of(0, 0, 0);
      std::vector<double> second(a.size());
      for (std::size_t n = 0; n < a.size(); ++n) second[n] = sum[n] - a[n];
      expect_normal(second, to_string(method));
      EXPECT_LT(std::abs(mean_product(a, second)), five_errors);
    }
}

// ---- what goes wrong ----

DissipationLaw changed(std::function<void(DissipationLaw&)> const& change) {
  DissipationLaw d = usual();
  change(d);
  return d;
}

std::string refusal(std::function<void(DissipationLaw&)> const& change) {
  return message([&] { changed(change).check(); });
}

double const nan = std::numeric_limits<double>::quiet_NaN();

TEST(DissipationErrors, Dissipations) {
  EXPECT_EQ(refusal([](auto&) {}), "no error");
  EXPECT_EQ(refusal([](auto& d) { d.friction = -1; }), "dissipation: friction is zero or more, not -1");
  EXPECT_EQ(refusal([](auto& d) { d.friction = nan; }), "dissipation: friction is zero or more, not nan");
  EXPECT_EQ(refusal([](auto& d) { d.range = 0; }), "dissipation: range is a positive length, not 0");
  EXPECT_EQ(refusal([](auto& d) { d.range = 1 / 0.0; }), "dissipation: range is a positive length, not inf");
  EXPECT_EQ(refusal([](auto& d) { d.exponent = -0.5; }), "dissipation: exponent is zero or more, not -0.5");
  EXPECT_EQ(refusal([](auto& d) { d.conduction = -2; }), "dissipation: conduction is zero or more, not -2");
  EXPECT_EQ(refusal([](auto& d) { d.temperature = 1; }),
            "dissipation: convention constant-friction knows no temperature but those of the particles");
  for (Convention const convention :
       {Convention::fixed_temperature, Convention::constant_noise, Convention::deterministic})
    EXPECT_EQ(refusal([&](auto& d) { d.convention = convention; }),
              "dissipation: temperature is positive for this convention, not 0");
  EXPECT_EQ(refusal([](auto& d) { d.convention = Convention::fixed_temperature, d.temperature = 1; }),
            "dissipation: at a fixed temperature there are no internal energies that could be conducted");
}

TEST(DissipationErrors, Names) {
  for (auto const& name : convention_words().names()) EXPECT_EQ(to_string(convention_words().named(name)), name);
  EXPECT_EQ(convention_words().names().size(), 4U);
  for (DissipationMethod const method : {DissipationMethod::simultaneous, DissipationMethod::shardlow})
    EXPECT_EQ(dissipation_method_words().named(to_string(method)), method);
  EXPECT_EQ(message([] { convention_words().named("constant-frictions"); }),
            "unknown convention 'constant-frictions'; there are fixed-temperature, constant-noise, constant-friction, "
            "deterministic; did you mean 'constant-friction'?");
  EXPECT_EQ(message([] { dissipation_method_words().named("splitting"); }),
            "unknown method of dissipation 'splitting'; there are simultaneous, shardlow");
}

TEST(DissipationErrors, EnsemblesAndBoxes) {
  Ensemble<Meso<2>> meso("meso", 3);
  Ensemble<Newton<2>> atoms("atoms", 3);
  Ensemble<Inviscid<2>> vortices("vortices", 3);
  for (auto& p : meso) p.internal_energy = 1;
  PairScheme scheme(cube<2>(4), 1);
  for (double const k : {0.0, -1.0, nan})
    EXPECT_EQ(message([&] { PairDissipation dpd(scheme, k); }).rfind("Boltzmann's constant is positive, not ", 0), 0U);
  PairDissipation dpd(scheme, 1);
  EXPECT_EQ(message([&] { dpd.internal(vortices, usual()); }),
            "friction can't act on ensemble 'vortices': class Inviscid has no mass");
  EXPECT_EQ(message([&] { dpd.state(atoms, StateLaw(2)); }),
            "ensemble 'atoms' of class Newton has no internal energies that a state law could be of");
  EXPECT_EQ(message([&] { dpd.internal(atoms, usual()); }),
            "convention constant-friction needs internal energies, and ensemble 'atoms' of class Newton has none");
  EXPECT_EQ(
      message([&] { dpd.internal(meso, usual(2.5)); }),
      "the range 2.5 of friction is longer than half of the periodic axis x, which allows at most 2: two particles "
      "must not meet twice");
  EXPECT_EQ(message([&] { dpd.internal(meso, usual(0)); }), "dissipation: range is a positive length, not 0");
  dpd.internal(meso, usual());
  EXPECT_EQ(message([&] { dpd.check(); }),
            "ensemble 'meso' has internal energies but no heat capacity; set heat_capacity");
  dpd.state(meso, StateLaw(2));
  EXPECT_EQ(message([&] { dpd.check(); }), "no error");
  EXPECT_EQ(message([&] {
              dpd.internal(meso, changed([](auto& d) {
                             d.convention = Convention::fixed_temperature, d.temperature = 1, d.conduction = 0;
                           }));
            }),
            "friction on ensemble 'meso' is at a fixed temperature in one place and with internal energies in another; "
            "it can't be both");
  meso[1].mass = 0;
  EXPECT_EQ(message([&] { dpd.check(); }), "particle 1 of 'meso' has the mass 0: friction needs positive masses");
  meso[1].mass = 1;
  for (double const energy : {0.0, -2.0, nan, 1 / 0.0}) {
    meso[2].internal_energy = energy;
    EXPECT_EQ(message([&] { dpd.check(); }).rfind("particle 2 of 'meso' has the internal energy ", 0), 0U) << energy;
  }
  Box mirrors(Vector<2>{0, 0}, Vector<2>{4, 4}, {Boundary::periodic, Boundary::mirror});
  PairScheme mirrored(mirrors, 1);
  PairDissipation behind(mirrored, 1);
  EXPECT_EQ(message([&] { behind.internal(meso, usual()); }),
            "axis y is a mirror: friction between pairs needs a reflecting, periodic or open axis there");
  Ensemble<Meso<2>> more("more", 1);
  PairDissipation full(scheme, 1);
  EXPECT_EQ(message([&] {
              for (int n = 0; n < 300; ++n) full.between(meso, more, usual());
            }),
            "a dissipation has at most 100 kinds of friction");
}

TEST(DissipationErrors, Methods) {
  Ensemble<Meso<2>> meso("meso", 3);
  for (auto& p : meso) p.internal_energy = 1;
  PairScheme scheme(cube<2>(4), 1);
  PairDissipation dpd(scheme, 1);
  dpd.state(meso, StateLaw(2));
  dpd.internal(meso, usual());
  dpd.metropolis(true);
  EXPECT_EQ(message([&] { dpd.check(); }),
            "the Metropolis correction accepts or refuses pairs one by one: it needs the method shardlow");
  dpd.method(DissipationMethod::shardlow);
  EXPECT_EQ(message([&] { dpd.check(); }), "no error");
  dpd.corrector(true);
  EXPECT_EQ(message([&] { dpd.check(); }), "the corrector belongs to the method simultaneous; shardlow needs none");
  dpd.corrector(false);
  dpd.internal(meso, changed([](auto& d) { d.convention = Convention::deterministic, d.temperature = 1; }));
  EXPECT_EQ(message([&] { dpd.check(); }),
            "the Metropolis correction is for friction with noise and internal energies, not for convention "
            "deterministic");
  EXPECT_EQ(message([&] { dpd.advance({0, 1, 1}); }), "friction and noise need a positive step, not 0");
  EXPECT_EQ(message([&] { dpd.advance({-0.1, 1, 1}); }), "friction and noise need a positive step, not -0.1");
  EXPECT_EQ(message([&] {
              dpd.restore(std::vector<double>{1, 2});
            }),
            "the checkpoint's friction and noise do not fit this simulation");
}

/// A cold soft gas of equal particles, and its dissipation.
struct Small {
  Ensemble<Meso<2>> matter{"matter"};
  PairScheme scheme;
  PairDissipation dpd;
  Simulation simulation;

  explicit Small(double dt = 0.002, double energy = 40, std::size_t count = 50)
      : scheme(cube<2>(6), 1), dpd(scheme, 1), simulation(scheme, dt) {
    scatter(matter, scheme.box(), count, Masses::unequal, energy);
    scheme.internal(matter, Soft{.repulsion = 5, .range = 1});
    dpd.state(matter, StateLaw(energy));
    dpd.internal(matter, usual());
  }
  void add() {
    simulation.add(dpd);
    simulation.integrate(matter, Method::leap_frog);
  }
};

TEST(DissipationErrors, Simulations) {
  for (Method const method :
       {Method::euler, Method::rk2, Method::rk4, Method::deactivate, Method::reversible_leap_frog}) {
    Small small;
    small.simulation.add(small.dpd);
    small.simulation.integrate(small.matter, method);
    EXPECT_EQ(message([&] { small.simulation.run(1); }),
              "friction and noise act on ensemble 'matter', which needs leap-frog for all its particles then, not " +
                  to_string(method));
  }
  Small small;
  small.add();
  small.simulation.run(3);
  EXPECT_EQ(message([&] { small.simulation.rewind(1); }), "a run with friction and noise can't go backwards");
  small.simulation.step_size(-0.002);
  EXPECT_EQ(message([&] { small.simulation.run(1); }), "friction and noise need a positive step, not -0.002");

  Small one, other;
  one.simulation.add(other.dpd);
  one.simulation.integrate(one.matter, Method::leap_frog);
  EXPECT_EQ(message([&] { one.simulation.run(1); }),
            "friction and noise act on ensemble 'matter', which no scheme of the simulation supervises");
}

std::string failure_of(auto const& call) {
  try {
    call();
  } catch (PhysicsFailure const& failure) {
    return failure.what();
  }
  return "no failure";
}

TEST(DissipationErrors, NegativeInternalEnergiesNameParticleAndStep) {
  for (bool const corrector : {false, true}) {
    Small small(0.05, 0.4);
    small.dpd.corrector(corrector);
    small.add();
    std::string const text = failure_of([&] { small.simulation.run(500); });
    EXPECT_EQ(
        text.rfind("step " + std::to_string(small.simulation.step() + 1) + ": the internal energy of particle ", 0), 0U)
        << text;
    EXPECT_NE(text.find(" of 'matter' would become -"), std::string::npos) << text;
    EXPECT_NE(text.find("friction and noise take more than there is; take a smaller step, or shardlow with "
                        "metropolis"),
              std::string::npos)
        << text;
    for (auto const& p : small.matter) EXPECT_GT(p.internal_energy, 0);
  }
}

TEST(DissipationErrors, NoNumbers) {
  for (bool const splitting : {false, true})
    for (bool const fixed : {false, true}) {
      Ensemble<Meso<2>> matter("matter");
      PairScheme scheme(cube<2>(4), 1);
      scatter(matter, scheme.box(), 40, Masses::unequal, 40);
      PairDissipation dpd(scheme, 1);
      DissipationLaw d = usual();
      if (fixed)
        d.convention = Convention::fixed_temperature, d.temperature = 1, d.conduction = 0;
      else
        dpd.state(matter, StateLaw(40));
      dpd.internal(matter, d);
      if (splitting) dpd.method(DissipationMethod::shardlow);
      dpd.advance({0.001, 0, 1});
      matter[7].velocity[1] = nan;
      EXPECT_NE(failure_of([&] {
                  dpd.advance({0.001, 1, 1});
                }).find("particle "),
                std::string::npos)
          << splitting << fixed;
    }
  Small small;
  small.add();
  small.simulation.run(2);
  small.matter[3].position[0] = nan;
  EXPECT_NE(failure_of([&] { small.simulation.run(1); }), "no failure");
}

TEST(PairDissipation, ParticlesAtOnePlace) {
  for (bool const projected : {true, false})
    for (bool const splitting : {false, true})
      for (bool const metropolis : {false, true}) {
        if (metropolis && !splitting) continue;
        Ensemble<Meso<2>> matter("matter");
        PairScheme scheme(cube<2>(4), 1);
        scatter(matter, scheme.box(), 10, Masses::unequal, 40);
        for (std::size_t i : {1, 2, 3}) matter[i].position = matter[0].position;
        PairDissipation dpd(scheme, 1);
        dpd.state(matter, StateLaw(40));
        DissipationLaw d = usual();
        d.projected = projected;
        dpd.internal(matter, d);
        if (splitting) dpd.method(DissipationMethod::shardlow);
        dpd.metropolis(metropolis);
        double const total = kinetic_of({&matter}) + internal_of({&matter});
        auto const momentum = momentum_of({&matter});
        for (std::uint64_t step = 0; step < 20; ++step) dpd.advance({0.01, step, test_seed(1)});
        EXPECT_NEAR(kinetic_of({&matter}) + internal_of({&matter}), total, 1e-12 * total)
            << projected << splitting << metropolis;
        EXPECT_LT(distance(momentum_of({&matter}), momentum), 1e-12);
      }
}

TEST(PairDissipation, MayBeAddedAfterARun) {
  Small small, from_there;
  small.simulation.integrate(small.matter, Method::leap_frog);
  small.simulation.run(20);
  auto const before = internal_of({&small.matter});
  small.simulation.add(small.dpd);
  small.simulation.run(1);
  EXPECT_GT(std::abs(internal_of({&small.matter}) - before), 1e-4);
  auto const momentum = momentum_of({&small.matter});
  small.simulation.run(50);
  EXPECT_LT(distance(momentum_of({&small.matter}), momentum), 1e-12);
}

TEST(PairDissipation, AdaptationsMayChangeTheNumberOfParticles) {
  for (DissipationMethod const method : {DissipationMethod::simultaneous, DissipationMethod::shardlow}) {
    // A run in which particles vanish and appear is one that goes on with others from there.
    Small whole;
    whole.dpd.method(method);
    whole.add();
    whole.simulation.adapt(10, [&] {
      if (whole.simulation.step() == 10) {
        whole.matter.resize(30);
      } else if (whole.simulation.step() == 20) {
        Meso<2> more = whole.matter[4];
        more.position = whole.scheme.box().low(0) < 0 ? Vector<2>{0.1, 0.2} : Vector<2>{1, 1};
        for (int n = 0; n < 3; ++n) {
          more.position[0] += 0.9;
          whole.matter.add(more);
        }
      }
    });
    whole.simulation.run(10);
    EXPECT_EQ(whole.matter.size(), 30U);
    for (int part = 0; part < 2; ++part) {
      Small fresh(0.002, 40, whole.matter.size());
      fresh.dpd.method(method);
      fresh.add();
      set_rows(fresh.matter, bits_of_rows(whole.matter));
      // The same noise: the same number of the step.
      fresh.simulation.check();
      fresh.simulation.restore(whole.simulation.step(), 0.002, whole.simulation.seed(), fresh.simulation.state());
      whole.simulation.run(5);
      fresh.simulation.run(5);
      for (std::size_t i = 0; i < whole.matter.size(); ++i) {
        // Splitting takes pairs in another order, which is second order in the step.
        double const tight = method == DissipationMethod::simultaneous ? 1e-10 : 2e-2;
        ASSERT_NEAR(fresh.matter[i].velocity[0], whole.matter[i].velocity[0], tight) << part;
        ASSERT_NEAR(fresh.matter[i].internal_energy, whole.matter[i].internal_energy, 10 * tight) << part;
      }
      whole.simulation.run(5);
    }
    EXPECT_EQ(whole.matter.size(), 33U);
    double const momentum = momentum_of({&whole.matter})[0];
    whole.simulation.run(5);
    EXPECT_NEAR(momentum_of({&whole.matter})[0], momentum, 1e-12);
  }
}

TEST(PairDissipation, Advice) {
  Small small;
  EXPECT_TRUE(small.dpd.warnings(1e-5).empty());
  ASSERT_EQ(small.dpd.warnings(0.1).size(), 1U);
  EXPECT_EQ(small.dpd.warnings(0.1)[0].rfind("warning: friction times step is ", 0), 0U);
  EXPECT_NE(small.dpd.warnings(0.1)[0].find("corrector"), std::string::npos);
  EXPECT_GT(small.dpd.bytes(), 1000U);
}

}  // namespace
}  // namespace boltzmann::pair_dissipation_test

/// With --numbers THREADS: prints what comes out with the instruction set that the environment names.
int main(int argc, char** argv) {
  if (argc == 3 && std::string(argv[1]) == "--numbers") {
    using namespace boltzmann::pair_dissipation_test;
    for (Kind const kind : all_kinds) {
      Gas gas(kind, 400, std::stoi(argv[2]));
      gas.simulation.run(5);
      for (auto* ensemble : gas.ensembles())
        for (std::size_t i = 0; i < ensemble->size(); ++i)
          std::printf("%.17g %.17g %.17g %.17g\n", ensemble->row(i)[0],
                      ensemble->row(i)[ensemble->field("velocity").offset],
                      ensemble->row(i)[ensemble->field("velocity").offset + 1],
                      ensemble->row(i)[ensemble->field("internal_energy").offset]);
    }
    return 0;
  }
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
