// Ensembles: rows, descriptors and sizes of every shipped class; classes of a user's own with fields, influences,
// equations and strengths of their own, against exact solutions.
#include "../schemes/oracle.hpp"

#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/pendulum.hpp>
#include <boltzmann/particles/tethered.hpp>
#include <boltzmann/particles/tracer.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <cmath>
#include <cstring>
#include <memory>
#include <ostream>
#include <random>
#include <string>
#include <vector>

namespace boltzmann::ensemble_test {
namespace {

// Classes of a user's own: new fields in 1D, 2D and 3D.
template <class Real = double>
struct Grain : Newton<1, Real> {
  static constexpr char const* class_name = "Grain";
  Real internal_energy;

  static FieldTable fields() {
    return Newton<1, Real>::fields().add(&Grain::internal_energy, "internal_energy", dimensions::energy,
                                         "heat in the grain");
  }
};

template <class Real = double>
struct Ion : Coulomb<2, Real> {
  static constexpr char const* class_name = "Ion";
  Vector<2, Real> dipole;
  Real colour_charge;

  static FieldTable fields() {
    return Coulomb<2, Real>::fields()
        .add(&Ion::dipole, "dipole", dimensions::charge * dimensions::length, "dipole moment")
        .add(&Ion::colour_charge, "colour_charge", dimensions::charge, "of another field");
  }
};

template <int D, class Real = double>
struct Dye : Tracer<D, Real> {
  static constexpr char const* class_name = "Dye";
  Real concentration;

  static FieldTable fields() {
    return Tracer<D, Real>::fields().add(&Dye::concentration, "concentration", dimensions::none, "how much of it");
  }
};

/// A field as the class's own member.
struct Member {
  char const* name;
  double* first;
  int components;
};
template <int D>
Member member(char const* name, Vector<D>& x) {
  return {name, x.component, D};
}
Member member(char const* name, double& x) { return {name, &x, 1}; }

/// Every member that one of the classes has, of particle i.
template <class P>
std::vector<Member> members(AnyEnsemble& ensemble, std::size_t i) {
  P& p = static_cast<Ensemble<P>&>(ensemble)[i];
  std::vector<Member> all{member("position", p.position)};
  if constexpr (requires { p.mass; }) all.push_back(member("mass", p.mass));
  if constexpr (requires { p.velocity; }) all.push_back(member("velocity", p.velocity));
  if constexpr (requires { p.charge; }) all.push_back(member("charge", p.charge));
  if constexpr (requires { p.stiffness; }) all.push_back(member("stiffness", p.stiffness));
  if constexpr (requires { p.anchor; }) all.push_back(member("anchor", p.anchor));
  if constexpr (requires { p.vorticity; }) all.push_back(member("vorticity", p.vorticity));
  if constexpr (requires { p.core; }) all.push_back(member("core", p.core));
  if constexpr (requires { p.viscosity; }) all.push_back(member("viscosity", p.viscosity));
  if constexpr (requires { p.volume; }) all.push_back(member("volume", p.volume));
  if constexpr (requires { p.length; }) all.push_back(member("length", p.length));
  if constexpr (requires { p.bob_mass; }) all.push_back(member("bob_mass", p.bob_mass));
  if constexpr (requires { p.pivot; }) all.push_back(member("pivot", p.pivot));
  if constexpr (requires { p.internal_energy; }) all.push_back(member("internal_energy", p.internal_energy));
  if constexpr (requires { p.dipole; }) all.push_back(member("dipole", p.dipole));
  if constexpr (requires { p.colour_charge; }) all.push_back(member("colour_charge", p.colour_charge));
  if constexpr (requires { p.concentration; }) all.push_back(member("concentration", p.concentration));
  return all;
}

/// What the tests do with a class: they are compiled once and not for each.
struct AnyClass {
  std::string name;
  int dimension;
  std::size_t doubles, influence_size;
  std::unique_ptr<AnyEnsemble> (*make)(std::string, std::size_t);
  double* (*first)(AnyEnsemble&);                 ///< of the row where begin() is
  std::ptrdiff_t (*length)(AnyEnsemble&);         ///< from begin() to end()
  bool (*consistent)(AnyEnsemble&, std::size_t);  ///< [i] and begin() + i are one particle, whose position is first
  void (*add)(AnyEnsemble&, std::size_t);         ///< a copy of particle i
  void (*add_at)(AnyEnsemble&, double);           ///< a particle of zeros but for the first coordinate
  std::vector<Member> (*members)(AnyEnsemble&, std::size_t);
};

void PrintTo(AnyClass const& of, std::ostream* out) { *out << of.name; }

template <class P>
AnyClass any_class() {
  static constexpr auto of = [](AnyEnsemble& e) -> Ensemble<P>& { return static_cast<Ensemble<P>&>(e); };
  return {.name = P::class_name,
          .dimension = P::dimension,
          .doubles = sizeof(P) / sizeof(double),
          .influence_size = sizeof(typename P::Influence) / sizeof(double),
          .make = [](std::string name, std::size_t size) -> std::unique_ptr<AnyEnsemble> {
            return std::make_unique<Ensemble<P>>(std::move(name), size);
          },
          .first = [](AnyEnsemble& e) { return &of(e).begin()->position[0]; },
          .length = [](AnyEnsemble& e) { return of(e).end() - of(e).begin(); },
          .consistent =
              [](AnyEnsemble& e, std::size_t i) {
                return e.row(i) == &of(e)[i].position[0] && static_cast<P*>(of(e).begin() + i) == &of(e)[i];
              },
          .add = [](AnyEnsemble& e, std::size_t i) { of(e).add(of(e)[i]); },
          .add_at =
              [](AnyEnsemble& e, double x) {
                P p{};
                p.position[0] = x;
                of(e).add(p);
              },
          .members = members<P>};
}

template <class... P>
std::vector<AnyClass> all_of() {
  return {any_class<P>()...};
}

class EnsembleOf : public testing::TestWithParam<AnyClass> {};
INSTANTIATE_TEST_SUITE_P(
    Classes, EnsembleOf,
    testing::ValuesIn(all_of<Particle<1>, Particle<2>, Particle<3>, Newton<1>, Newton<2>, Newton<3>, Laplace<1>,
                             Laplace<2>, Laplace<3>, Coulomb<1>, Coulomb<2>, Coulomb<3>, Kepler<1>, Kepler<2>,
                             Kepler<3>, Tethered<1>, Tethered<2>, Tethered<3>, Tracer<1>, Tracer<2>, Tracer<3>,
                             Vortex<2>, Vortex<3>, Inviscid<2>, Inviscid<3>, Viscous<2>, Viscous<3>, Diffusive<2>,
                             Diffusive<3>, Pendulum<>, Grain<>, Ion<>, Dye<1>, Dye<2>, Dye<3>>()),
    [](auto const& info) { return info.param.name + std::to_string(info.param.dimension) + "D"; });

/// Every double of row i, the padding too.
std::vector<double> whole_row(AnyEnsemble const& e, std::size_t i) { return {e.row(i), e.row(i) + e.stride()}; }

/// Bytes, so that 0.0 and -0.0 differ.
bool all_bytes_zero(double const* begin, double const* end) {
  std::vector<double> const zero(end - begin, 0.0);
  return std::memcmp(begin, zero.data(), zero.size() * sizeof(double)) == 0;
}

/// A new particle: nothing but zeros, and mass one where there is a mass.
void expect_new(AnyEnsemble const& e, std::size_t i) {
  auto row = whole_row(e, i);
  if (Field const* mass = e.find_field("mass")) {
    EXPECT_EQ(row[mass->offset], 1.0) << "mass of " << i;
    row[mass->offset] = 0;
  }
  EXPECT_TRUE(all_bytes_zero(row.data(), row.data() + row.size())) << "row " << i;
}

/// Numbers into every double of the class.
void number(AnyEnsemble& e) {
  for (std::size_t i = 0; i < e.size(); ++i)
    for (std::size_t k = 0; k < e.doubles(); ++k)
      e.row(i)[k] = 1000 * static_cast<double>(i + 1) + static_cast<double>(k);
}

TEST_P(EnsembleOf, RowsAreTheUsersStructsIn32Bytes) {
  auto const& of = GetParam();
  auto const made = of.make("e", 5);
  auto& e = *made;
  EXPECT_EQ(e.dimension(), of.dimension);
  EXPECT_EQ(e.class_name(), of.name);
  EXPECT_EQ(e.stride() % 4, 0u);
  EXPECT_EQ(e.doubles(), of.doubles);
  EXPECT_GE(e.stride(), e.doubles());
  EXPECT_LT(e.stride(), e.doubles() + 4);
  EXPECT_EQ(e.influence_size(), of.influence_size);
  EXPECT_EQ(of.length(e), 5);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(e.row(i)) % 32, 0u);
    EXPECT_TRUE(of.consistent(e, i)) << "the position comes first";
    expect_new(e, i);
  }
  EXPECT_EQ(e.field("position").offset, 0);
  EXPECT_EQ(e.field("position").components, of.dimension);
}

TEST_P(EnsembleOf, DescriptorsPointAtTheMembers) {
  auto const made = GetParam().make("e", 3);
  auto& e = *made;
  // Writes through the member, reads through the descriptor.
  auto const written = [](std::size_t k, std::size_t i, int c) {
    return 100.0 * static_cast<double>(k + 1) + 10.0 * static_cast<double>(i) + c;
  };
  for (std::size_t i = 0; i < e.size(); ++i) {
    auto const members = GetParam().members(e, i);
    for (std::size_t k = 0; k < members.size(); ++k)
      for (int c = 0; c < members[k].components; ++c) members[k].first[c] = written(k, i, c);
  }
  auto const members = GetParam().members(e, 0);
  for (std::size_t k = 0; k < members.size(); ++k) {
    char const* const name = members[k].name;
    Field const* field = e.find_field(name);
    ASSERT_NE(field, nullptr) << name;
    EXPECT_EQ(field->components, members[k].components) << name;
    EXPECT_FALSE(field->doc.empty()) << name;
    for (int c = 0; c < field->components; ++c) {
      auto const column = e.column(*field, c);
      ASSERT_EQ(column.size(), 3u);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(e.row(i)[field->offset + c], written(k, i, c)) << name;
        EXPECT_EQ(column[i], written(k, i, c)) << name;
      }
    }
  }
  EXPECT_EQ(members.size(), e.fields().size()) << "a field without a test";
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(all_bytes_zero(e.row(i) + e.doubles(), e.row(i) + e.stride()));
}

TEST_P(EnsembleOf, ResizeKeepsOldRowsAndMakesNewOnesZero) {
  auto const made = GetParam().make("e", 3);
  auto& e = *made;
  std::vector<std::vector<double>> old;
  auto const remember = [&] {
    number(e);
    old.clear();
    for (std::size_t i = 0; i < e.size(); ++i) old.push_back(whole_row(e, i));
  };
  remember();
  for (std::size_t const size : {4, 5, 40, 1000}) {
    e.resize(size);
    ASSERT_EQ(e.size(), size);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(e.row(0)) % 32, 0u);
    for (std::size_t i = 0; i < old.size(); ++i) ASSERT_EQ(whole_row(e, i), old[i]);
    for (std::size_t i = old.size(); i < size; ++i) expect_new(e, i);
    for (std::size_t i = 0; i < size; ++i)
      EXPECT_TRUE(all_bytes_zero(e.influence(i), e.influence(i) + e.influence_size()));
    remember();
  }
  // Smaller and larger again: what was cut off does not come back.
  e.resize(2);
  e.resize(30);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(whole_row(e, i), old[i]);
  for (std::size_t i = 2; i < 30; ++i) expect_new(e, i);
}

TEST_P(EnsembleOf, NobodyIsAnEnsembleToo) {
  auto const made = GetParam().make("nobody", 0);
  auto& e = *made;
  EXPECT_EQ(e.size(), 0u);
  EXPECT_EQ(GetParam().length(e), 0);
  EXPECT_TRUE(e.column(e.field("position")).empty());
  e.clear_influence();
  e.resize(2);
  e.resize(0);
  EXPECT_EQ(e.size(), 0u);
  GetParam().add_at(e, 7);
  ASSERT_EQ(e.size(), 1u);
  EXPECT_EQ(*GetParam().first(e), 7);
}

TEST_P(EnsembleOf, AddAppendsACopyAlsoOfOneOfItsOwn) {
  auto const made = GetParam().make("e", 1);
  auto& e = *made;
  number(e);
  auto const first = whole_row(e, 0);
  for (std::size_t n = 1; n < 200; ++n) {
    GetParam().add(e, 0);  // the memory that it refers to moves now and then
    ASSERT_EQ(e.size(), n + 1);
    ASSERT_EQ(whole_row(e, n), first) << "particle " << n;
  }
  EXPECT_EQ(whole_row(e, 0), first);
}

TEST(Ensemble, UnknownFieldsAreRefusedWithTheNearestWord) {
  Ensemble<Ion<>> ions("plasma", 2);
  EXPECT_EQ(ions.find_field("velocities"), nullptr);
  EXPECT_EQ(ions.find_field(""), nullptr);
  EXPECT_EQ(&ions.field("charge"), ions.find_field("charge"));
  auto const message = [&](char const* name) -> std::string {
    try {
      ions.field(name);
    } catch (Error const& error) {
      return error.what();
    }
    return "";
  };
  auto const text = message("velocty");
  for (char const* part : {"'plasma'", "class Ion", "no field 'velocty'", "position, mass, velocity, charge, dipole",
                           "did you mean 'velocity'?"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
  EXPECT_NE(message("color_charge").find("did you mean 'colour_charge'?"), std::string::npos);
  EXPECT_EQ(message("enthalpy_of_mixing").find("did you mean"), std::string::npos);
}

// A class may say nothing about its new fields: they are in the rows, without a name.
template <class Real>
struct Quiet : Newton<3, Real> {
  Real secret;
};

template <class Real = double>
struct Dipole {
  Real moment;
};
template <class Real = double>
struct Magnet : Newton<2, Real>, Dipole<Real> {
  static constexpr char const* class_name = "Magnet";
  static FieldTable fields() {
    return Newton<2, Real>::fields().add(&Magnet::moment, "moment", dimensions::none, "magnetic moment");
  }
};
TEST(Ensemble, AClassOfTwoParentsIsRefused) {
  EXPECT_EQ(message([] { Ensemble<Magnet<>> magnets("magnets"); }),
            "class Magnet: its fields 'position' and 'moment' have the same place; a particle class derives from one "
            "class alone");
}

TEST(Ensemble, AClassWithoutTableOfItsOwnHasItsParentsFields) {
  Ensemble<Quiet<double>> e("e", 2);
  e[1].secret = 5;
  EXPECT_EQ(e.fields().size(), 3u);
  EXPECT_EQ(e.doubles(), 8u);
  EXPECT_EQ(e.row(1)[7], 5);
  EXPECT_EQ(e.row(0)[7], 0);
  std::string const why = message([&] { e.field("secret"); });
  EXPECT_NE(why.find("; its class holds more, which its fields() does not name"), std::string::npos) << why;
}

// ---- equations of one's own ---------------------------------------------------------------------------------------

// Heat that leaks out of an oscillator: de/dt = x - e / leak besides Newton's law.
template <class Real = double>
struct Leaky : Newton<1, Real> {
  static constexpr char const* class_name = "Leaky";
  Real internal_energy, leak, clock;

  static void equations(auto const& p, auto const& force, auto const& rate) {
    Newton<1, Real>::equations(p, force, rate);
    rate(&Leaky::internal_energy, p.position[0] - p.internal_energy * p.leak);
    rate(&Leaky::clock, 1.0);
  }
};

struct LeakyError {
  double position, internal_energy;
};

/// x = cos t; e' = x - k e, e(0) = 1: e = (k cos t + sin t) / (1 + k^2) + C exp(-k t).
LeakyError leaky_error(Method method, double leak, int steps) {
  double const end = 2;
  Ensemble<Leaky<>> e("e", 3);
  for (auto& p : e) {
    p.position = {1};
    p.internal_energy = 1;
    p.leak = leak;
  }
  PairScheme scheme(Box(Vector{-9.}, Vector{9.}));
  scheme.external(e, [](auto const& p) { return -1.0 * p.position; });
  Simulation simulation(scheme, end / steps);
  simulation.integrate(e, method);
  simulation.run(steps);
  double const particular = 1 / (1 + leak * leak);
  double const exact =
      particular * (leak * std::cos(end) + std::sin(end)) + (1 - particular * leak) * std::exp(-leak * end);
  EXPECT_NEAR(e[2].clock, end, 1e-12) << to_string(method);
  EXPECT_EQ(e[2].leak, leak) << "a field that no equation names is touched";
  EXPECT_EQ(whole_row(e, 0), whole_row(e, 2));
  return {std::abs(e[2].position[0] - std::cos(end)), std::abs(e[2].internal_energy - exact)};
}

TEST(UsersEquations, AFieldWithARateOfItsOwnConvergesToTheExactSolution) {
  struct Case {
    Method method;
    double order, order_leaking;
    double accuracy;
  };
  // The second kick of leap-frog is solved for fields whose rates depend on themselves: of second order, too.
  for (auto const& c : {Case{Method::euler, 1, 1, 2e-2}, Case{Method::leap_frog, 2, 2, 5e-3},
                        Case{Method::rk2, 2, 2, 2e-4}, Case{Method::rk4, 4, 4, 1e-8}})
    for (double const leak : {0.0, 0.7}) {
      auto const coarse = leaky_error(c.method, leak, 100), fine = leaky_error(c.method, leak, 200);
      double const expected = leak == 0 ? c.order : c.order_leaking;
      double const order = std::log2(coarse.internal_energy / fine.internal_energy);
      EXPECT_NEAR(order, expected, 0.15) << to_string(c.method) << " leak " << leak;
      EXPECT_NEAR(std::log2(coarse.position / fine.position), c.order, 0.15) << to_string(c.method);
      EXPECT_LT(fine.internal_energy, c.accuracy) << to_string(c.method) << " leak " << leak;
    }
}

// ---- an influence of one's own --------------------------------------------------------------------------------------

template <class Real>
struct HeatFlow {
  Vector<3, Real> pull;
  Real heating;
};

template <class Real>
HeatFlow(Vector<3, Real>, Real) -> HeatFlow<Real>;

/// A lump with a temperature; lumps pull and heat each other.
template <class Real = double>
struct Lump : Newton<3, Real> {
  static constexpr char const* class_name = "Lump";
  using Influence = HeatFlow<Real>;
  Real temperature, capacity;

  static void equations(auto const& p, auto const& influence, auto const& rate) {
    Newton<3, Real>::equations(p, influence.pull, rate);
    rate(&Lump::temperature, influence.heating / p.capacity);
  }
  static FieldTable fields() {
    return Newton<3, Real>::fields()
        .add(&Lump::temperature, "temperature", dimensions::temperature, "of the lump")
        .add(&Lump::capacity, "capacity", dimensions::none, "heat capacity");
  }
};

struct Contact {
  double stiffness, conductance;
  auto operator()(auto const& p, auto const& q) const {
    auto const r = q.position - p.position;
    return HeatFlow{r * stiffness, (q.temperature - p.temperature) * conductance};
  }
};

TEST(UsersInfluence, TwoLumpsExchangeHeatWhileTheyOscillate) {
  double const m[2] = {1.5, 0.5}, capacity[2] = {2, 0.5}, T[2] = {10, 300};
  Contact const contact{3.0, 0.25};
  double const frequency = std::sqrt(contact.stiffness * (1 / m[0] + 1 / m[1]));
  double const decay = contact.conductance * (1 / capacity[0] + 1 / capacity[1]);
  for (auto const& [method, accuracy] : {std::pair{Method::rk4, 1e-9}, std::pair{Method::rk2, 1e-4},
                                         std::pair{Method::leap_frog, 2e-3}, std::pair{Method::euler, 2e-2}}) {
    Ensemble<Lump<>> lumps("lumps", 2);
    for (int i = 0; i < 2; ++i) {
      lumps[i].position = {i == 0 ? 1.0 : -0.5, i == 0 ? 0.0 : 2.0, 0};
      lumps[i].mass = m[i];
      lumps[i].capacity = capacity[i];
      lumps[i].temperature = T[i];
    }
    auto const start = lumps[1].position - lumps[0].position;
    PairScheme scheme(Box(Vector{-9., -9., -9.}, Vector{9., 9., 9.}));
    scheme.internal(lumps, contact);
    Simulation simulation(scheme, 0.005);
    simulation.integrate(lumps, method);
    simulation.run(300);
    double const t = simulation.time();
    double const difference = (T[1] - T[0]) * std::exp(-decay * t);
    EXPECT_NEAR((lumps[1].temperature - lumps[0].temperature) / difference, 1, accuracy) << to_string(method);
    // Heat and momentum go from one to the other and nowhere else.
    EXPECT_NEAR(capacity[0] * lumps[0].temperature + capacity[1] * lumps[1].temperature,
                capacity[0] * T[0] + capacity[1] * T[1], 1e-10);
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(m[0] * lumps[0].velocity[a] + m[1] * lumps[1].velocity[a], 0, 1e-12);
      EXPECT_NEAR(lumps[1].position[a] - lumps[0].position[a], start[a] * std::cos(frequency * t), 3 * accuracy)
          << to_string(method);
    }
  }
}

template <class P>
void scatter(Ensemble<P>& particles, Box const& box, unsigned seed) {
  std::mt19937_64 random(test_seed(seed));
  for (std::size_t i = 0; i < particles.size(); ++i) {
    for (std::size_t k = 0; k < particles.doubles(); ++k)
      particles.row(i)[k] = std::uniform_real_distribution(0.5, 2.0)(random);
    for (int a = 0; a < P::dimension; ++a)
      particles[i].position[a] = std::uniform_real_distribution(box.low(a), box.high(a))(random);
  }
}

/// The largest difference between the influences and the sum of the oracle's results, relative to the largest.
template <class P>
double difference(Ensemble<P> const& particles, std::initializer_list<oracle::Result> results) {
  double largest = 0, scale = 0;
  for (std::size_t i = 0; i < particles.size(); ++i)
    for (std::size_t c = 0; c < particles.influence_size(); ++c) {
      double expected = 0;
      for (auto const& result : results) expected += result.influence[i][c];
      largest = std::max(largest, std::abs(particles.influence(i)[c] - expected));
      scale = std::max(scale, std::abs(expected));
    }
  EXPECT_GT(scale, 0);
  return largest / scale;
}

TEST(UsersInfluence, IsSummedByPacksOverListsAsOverAllPairs) {
  for (std::size_t const count : {5, 24, 25, 67})
    for (double const cutoff : {no_cutoff, 1.9}) {
      Box const box(Vector{0., 0., 0.}, Vector{4., 4., 4.}, cutoff == no_cutoff ? Boundary::open : Boundary::periodic);
      Ensemble<Lump<>> lumps("lumps", count);
      scatter(lumps, box, 4);
      PairScheme scheme(box, cutoff);
      scheme.internal(lumps, Contact{0.5, 2.0});
      scheme.calculate();
      EXPECT_LT(difference(lumps, {oracle::influences(lumps, lumps, Contact{0.5, 2.0}, box, cutoff)}), 1e-13)
          << count << " cutoff " << cutoff;
    }
}

// ---- a strength of one's own ----------------------------------------------------------------------------------------

/// A chain of monomers, each with a quarter of a charge.
template <class Real = double>
struct Polymer : Laplace<3, Real> {
  static constexpr char const* class_name = "Polymer";
  static constexpr double sign = 1;
  Real monomers;
  Real strength() const { return 0.25 * monomers; }
};

TEST(UsersStrength, IsWhatTheLaplaceLawSees) {
  // Coulomb's law by hand: k s s' / r^2 = 2 * (8/4) * 3 / 5^2 along (3, 4, 0) / 5.
  Ensemble<Polymer<>> polymers("polymers", 1);
  Ensemble<Coulomb<3>> ions("ions", 1);
  polymers[0].monomers = 8;
  ions[0].position = {3, 4, 0};
  ions[0].charge = 3;
  PairScheme scheme(Box(Vector{-9., -9., -9.}, Vector{9., 9., 9.}));
  scheme.between(polymers, ions, coulomb(2));
  scheme.calculate();
  double const force = 2 * 2 * 3 / 25.0;
  Vector<3> const expected{0.6 * force, 0.8 * force, 0};
  for (int a = 0; a < 3; ++a) {
    EXPECT_NEAR(ions.influence(0)[a], expected[a], 1e-15);
    EXPECT_NEAR(polymers.influence(0)[a], -expected[a], 1e-15);
  }
  EXPECT_NEAR(scheme.measure().potential, 2 * 2 * 3 / 5.0, 1e-14);
}

TEST(UsersStrength, InManyByPacks) {
  Box const box(Vector{0., 0., 0.}, Vector{4., 4., 4.});
  Ensemble<Polymer<>> polymers("polymers", 60);
  Ensemble<Kepler<3>> stars("stars", 9);
  scatter(polymers, box, 1);
  scatter(stars, box, 2);
  PairScheme scheme(box);
  scheme.internal(polymers, coulomb(1.5, 0.1));
  scheme.between(stars, polymers, gravity(0.5, 0.1));
  scheme.calculate();
  EXPECT_LT(difference(polymers, {oracle::influences(polymers, polymers, coulomb(1.5, 0.1), box, no_cutoff),
                                  oracle::influences(polymers, stars, gravity(0.5, 0.1), box, no_cutoff)}),
            1e-13);
  EXPECT_LT(difference(stars, {oracle::influences(stars, polymers, gravity(0.5, 0.1), box, no_cutoff)}), 1e-13);
}

// ---- several classes in one scheme ----------------------------------------------------------------------------------

/// Different on the two sides, as on pendulums: each ensemble reads the other's own fields.
struct IonAndDye {
  auto operator()(auto const& p, auto const& q) const {
    auto const r = q.position - p.position;
    if constexpr (requires { q.concentration; })
      return r * (q.concentration * p.charge) + p.dipole * q.concentration;
    else
      return (q.dipole + r) * (q.colour_charge / (1.0 + dot(r, r)));
  }
};
struct DyeAndAtom {
  auto operator()(auto const& p, auto const& q) const {
    auto const r = q.position - p.position;
    if constexpr (requires { q.mass; })
      return r * q.mass;
    else
      return r * (p.mass * q.concentration * q.concentration);
  }
};
struct AtomAndIon {
  auto operator()(auto const& p, auto const& q) const {
    auto const r = q.position - p.position;
    if constexpr (requires { q.charge; })
      return r * q.charge + q.velocity;
    else
      return r * p.colour_charge - q.velocity;
  }
};

TEST(SeveralClasses, BetweenLawsActInBothDirections) {
  for (double const cutoff : {no_cutoff, 1.7})
    for (std::size_t const dyes : {0, 1, 3, 50}) {
      Box const box(Vector{-1., 2.}, Vector{4., 6.}, cutoff == no_cutoff ? Boundary::open : Boundary::periodic);
      Ensemble<Ion<>> ions("ions", 31);
      Ensemble<Dye<2>> dye("dye", dyes);
      Ensemble<Newton<2>> atoms("atoms", 8);
      scatter(ions, box, 1);
      scatter(dye, box, 2);
      scatter(atoms, box, 3);
      PairScheme scheme(box, cutoff);
      scheme.between(ions, dye, IonAndDye{});
      scheme.between(dye, atoms, DyeAndAtom{});
      scheme.between(atoms, ions, AtomAndIon{});
      scheme.calculate();
      auto const from = [&](auto const& p, auto const& q, auto const& law) {
        return oracle::influences(p, q, law, box, cutoff);
      };
      EXPECT_LT(difference(ions, {from(ions, dye, IonAndDye{}), from(ions, atoms, AtomAndIon{})}), 1e-13) << dyes;
      EXPECT_LT(difference(atoms, {from(atoms, ions, AtomAndIon{}), from(atoms, dye, DyeAndAtom{})}), 1e-13) << dyes;
      if (dyes > 0) {
        EXPECT_LT(difference(dye, {from(dye, atoms, DyeAndAtom{}), from(dye, ions, IonAndDye{})}), 1e-13) << dyes;
      }
    }
}

/// A pair of masses of two classes and two methods on one spring: x = cos(w t) about the centre of mass, which rests.
TEST(SeveralClasses, AGrainAndAnAtomOnOneSpring) {
  Ensemble<Grain<>> grain("grain", 1);
  Ensemble<Newton<1>> atom("atom", 1);
  grain[0].mass = 3;
  grain[0].position = {0.25};
  atom[0].position = {-0.75};
  PairScheme scheme(Box(Vector{-9.}, Vector{9.}));
  scheme.between(grain, atom, [](auto const& p, auto const& q) { return (q.position - p.position) * 2.0; });
  Simulation simulation(scheme, 0.001);
  simulation.integrate(grain, Method::leap_frog);
  simulation.integrate(atom, Method::leap_frog);
  simulation.run(2000);
  double const frequency = std::sqrt(2.0 * (1 / 3.0 + 1));
  EXPECT_NEAR(grain[0].position[0], 0.25 * std::cos(frequency * 2), 1e-6);
  EXPECT_NEAR(atom[0].position[0], -0.75 * std::cos(frequency * 2), 1e-6);
  EXPECT_EQ(grain[0].internal_energy, 0);
}

TEST(SeveralClasses, AConnectedEnsembleKeepsItsSize) {
  Ensemble<Grain<>> grains("grains", 4);
  PairScheme scheme(Box(Vector{-9.}, Vector{9.}));
  scheme.connect(grains, {{0, 3, 1}}, [](auto const& p, auto const& q) { return q.position - p.position; });
  for (std::size_t const size : {40, 3}) {
    grains.resize(size);
    EXPECT_THROW(scheme.calculate(), Error) << size;
    EXPECT_THROW(scheme.measure(), Error) << size;
  }
  grains.resize(4);
  grains[3].position = {2};
  scheme.calculate();
  EXPECT_EQ(grains.influence(2)[0], 2);
}

// ---- the stretching of vorticity ------------------------------------------------------------------------------------

// One element q at the origin with vorticity (0, 0, 1) turns the fluid as v = (-y, x, 0) / (4 pi s^3), s^2 = r^2 +
// core^2. At p = (1, 0, 0) the derivative of v along omega = (a, b, c) is by hand
//   (omega . grad) v = 1/(4 pi) [(-b, a, 0) / s^3 - 3 a (0, 1, 0) / s^5].
TEST(Inviscid3, StretchingIsTheDerivativeOfTheFlowAlongTheVorticity) {
  double const a = 5, b = 2, c = 3, s = 2;
  Ensemble<Inviscid<3>> elements("elements", 2);
  elements[0].position = {1, 0, 0};
  elements[0].vorticity = {a, b, c};
  elements[1].vorticity = {0, 0, 1};
  elements[1].core = std::sqrt(3.0);
  PairScheme scheme(Box(Vector{-9., -9., -9.}, Vector{9., 9., 9.}));
  scheme.internal(elements, BiotSavart{.transposed = 0});
  scheme.calculate();
  double const s3 = s * s * s, s5 = s3 * s * s;
  VortexInfluence<double> const on_p = elements.influence_on(0);
  Vector<3> const velocity{0, 1 / (4 * pi * s3), 0};
  Vector<3> const stretching{-b / (4 * pi * s3), (a / s3 - 3 * a / s5) / (4 * pi), 0};
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(on_p.velocity[k], velocity[k], 1e-15);
    EXPECT_NEAR(on_p.stretching[k], stretching[k], 1e-15);
  }
  // p has no core: at q, r = (-1, 0, 0) and s = 1, v = omega_p x r / (4 pi).
  VortexInfluence<double> const on_q = elements.influence_on(1);
  EXPECT_NEAR(on_q.velocity[0], 0, 1e-15);
  EXPECT_NEAR(on_q.velocity[1], -c / (4 * pi), 1e-15);
  EXPECT_NEAR(on_q.velocity[2], b / (4 * pi), 1e-15);
  // (omega_q . grad) v with omega_q = (0, 0, 1): d/dz of omega_p x r / r^3 = omega_p x (0, 0, 1) = (b, -a, 0).
  EXPECT_NEAR(on_q.stretching[0], b / (4 * pi), 1e-15);
  EXPECT_NEAR(on_q.stretching[1], -a / (4 * pi), 1e-15);
  EXPECT_NEAR(on_q.stretching[2], 0, 1e-15);
  // One Euler step: position and vorticity take dt times their rates, the core stays.
  Simulation simulation(scheme, 0.01);
  simulation.integrate(elements, Method::euler);
  simulation.run(1);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(elements[0].position[k], (k == 0 ? 1 : 0) + 0.01 * velocity[k], 1e-15);
    EXPECT_NEAR(elements[0].vorticity[k], (k == 0 ? a : k == 1 ? b : c) + 0.01 * stretching[k], 1e-15);
  }
  EXPECT_EQ(elements[1].core, std::sqrt(3.0));
}

// The same rule as a numerical derivative of the flow of many elements, which the packs have summed.
TEST(Inviscid3, StretchingOfManyIsTheDerivativeOfTheirFlow) {
  Box const box(Vector{0., 0., 0.}, Vector{2., 2., 2.});
  Ensemble<Inviscid<3>> elements("elements", 45);
  Ensemble<Tracer<3>> probes("probes", 2);
  scatter(elements, box, 8);
  PairScheme scheme(box);
  scheme.internal(elements, BiotSavart{.transposed = 0});
  scheme.calculate();
  EXPECT_LT(difference(elements, {oracle::influences(elements, elements, BiotSavart{.transposed = 0}, box, no_cutoff)}),
            1e-13);
  for (std::size_t const i : {0, 7, 44}) {
    double const h = 1e-5;
    auto const omega = elements[i].vorticity;
    Vector<3> flow[2];
    for (int side = 0; side < 2; ++side) {
      Tracer<3> probe{elements[i].position + omega * (side == 0 ? -h : h)};
      flow[side] = {0, 0, 0};
      for (std::size_t j = 0; j < elements.size(); ++j)
        if (j != i) flow[side] += BiotSavart{.transposed = 0}(probe, elements[j]);
    }
    auto const derivative = (flow[1] - flow[0]) / (2 * h);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(elements.influence_on(i).stretching[k], derivative[k], 1e-7);
  }
}

}  // namespace
}  // namespace boltzmann::ensemble_test
