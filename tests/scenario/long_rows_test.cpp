// The laws of scenarios on classes with longer rows than those that they are compiled for: the same bits, by whatever
// traversal.
#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/core/tensor.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/pendulum.hpp>
#include <boltzmann/particles/tethered.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/scenario/law_binding.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace boltzmann::long_rows_test {
namespace {

template <class P, class Real>
struct LongRow : rebind_t<P, Real> {
  Tensor<3, Real> more;
};
template <class P>
using Long = LongRow<P, double>;

}  // namespace
}  // namespace boltzmann::long_rows_test

template <class P, class Old, class Real>
struct boltzmann::detail::rebind<boltzmann::long_rows_test::LongRow<P, Old>, Real> {
  using type = boltzmann::long_rows_test::LongRow<P, Real>;
};

namespace boltzmann::long_rows_test {
namespace {

static_assert(row_doubles<Long<Newton<3>>> > 12 && row_doubles<Long<Newton<2>>> > 8);

using Particles = std::unique_ptr<AnyEnsemble>;

/// Every field of every particle has a number of its own; what no law knows is so large that it would be seen.
template <class P>
Particles particles(std::size_t count, unsigned seed) {
  auto ensemble = std::make_unique<Ensemble<P>>("seed " + std::to_string(seed), count);
  std::mt19937_64 random(seed);
  for (std::size_t i = 0; i < count; ++i) {
    for (auto const& field : ensemble->fields())
      for (int c = 0; c < field.components; ++c)
        ensemble->row(i)[field.offset + c] =
            std::uniform_real_distribution(0.5, field.name == "position" ? 9.5 : 2.0)(random);
    if constexpr (requires(P p) { p.more; })
      for (auto& row : (*ensemble)[i].more.component)
        for (double& x : row) x = 1e300;
  }
  return ensemble;
}

struct Class {
  std::string_view name;
  int dimension;
  Particles (*plain)(std::size_t count, unsigned seed);
  Particles (*longer)(std::size_t count, unsigned seed);
};
template <class... P>
std::vector<Class> classes_of() {
  return {{P::class_name, P::dimension, particles<P>, particles<Long<P>>}...};
}
std::vector<Class> const& classes() {
  static auto const all =
      classes_of<Newton<1>, Newton<2>, Newton<3>, Kepler<1>, Kepler<2>, Kepler<3>, Coulomb<1>, Coulomb<2>, Coulomb<3>,
                 Tethered<1>, Tethered<2>, Tethered<3>, Pendulum<1>, Tracer<1>, Tracer<2>, Tracer<3>, Vortex<2>,
                 Vortex<3>, Inviscid<2>, Inviscid<3>, Viscous<2>, Viscous<3>, Diffusive<2>, Diffusive<3>>();
  return all;
}
std::vector<Class> classes_named(std::string_view name, int dimension) {
  std::vector<Class> found;
  for (auto const& entry : classes())
    if (entry.name == name && entry.dimension == dimension) found.push_back(entry);
  return found;
}
/// Those that can be both: q acts on p.
std::vector<Class> classes_among(LawInfo const& law, int dimension) {
  if (law.source != "Vortex") return classes_named(law.target, dimension);
  std::vector<Class> found;
  for (char const* name : {"Vortex", "Inviscid", "Viscous", "Diffusive"})
    for (auto const& entry : classes_named(name, dimension)) found.push_back(entry);
  return found;
}

ParameterValues parameters_of(LawInfo const& law) {
  ParameterValues values;
  for (auto const& parameter : law.parameters)
    values.push_back({std::string(parameter.name), parameter.name == "rates"        ? std::vector{0.7, -0.7, 0.0}
                                                   : parameter.name == "gradient"   ? std::vector{0.6, -0.7, 0.0}
                                                   : parameter.vector               ? std::vector{0.7, 0.6, 0.9}
                                                   : parameter.name == "range"      ? std::vector{20.0}
                                                   : parameter.name == "max_length" ? std::vector{20.0}
                                                                                    : std::vector{0.7}});
  return values;
}

Box box(int dimension, Boundary boundary) {
  auto const in = [&]<int D>(std::integral_constant<int, D>) {
    Vector<D> low{}, high{};
    for (int a = 0; a < D; ++a) high[a] = 10;
    return Box(low, high, boundary);
  };
  return dimension == 1   ? in(std::integral_constant<int, 1>{})
         : dimension == 2 ? in(std::integral_constant<int, 2>{})
                          : in(std::integral_constant<int, 3>{});
}

std::vector<LawInfo> laws(LawKind kind) {
  std::vector<LawInfo> found;
  for (auto const& law : scenario_laws())
    if (law.kind == kind) found.push_back(law);
  return found;
}

/// Everything that a scheme gives for these particles.
std::vector<double> results(PairScheme& scheme, std::initializer_list<AnyEnsemble const*> ensembles) {
  scheme.calculate();
  std::vector<double> all;
  for (auto const* ensemble : ensembles)
    all.insert(all.end(), ensemble->influence(0),
               ensemble->influence(0) + ensemble->size() * ensemble->influence_size());
  EnergyAndVirial const measures = scheme.measure();
  for (auto const& energies : measures.per_particle) all.insert(all.end(), energies.begin(), energies.end());
  for (auto const& virials : measures.virial_per_particle) all.insert(all.end(), virials.begin(), virials.end());
  all.push_back(measures.external);
  return all;
}

void expect_same(std::vector<double> const& plain, std::vector<double> const& longer) {
  ASSERT_EQ(plain.size(), longer.size());
  EXPECT_EQ(std::memcmp(plain.data(), longer.data(), plain.size() * sizeof(double)), 0);
  EXPECT_TRUE(std::any_of(plain.begin(), plain.end(), [](double x) { return x != 0 && std::isfinite(x); }));
}

constexpr std::size_t many = 150;

TEST(LongRows, OfPairLawsByListAllPairsAndFew) {
  struct Way {
    std::size_t count;
    double cutoff;
  };
  for (LawInfo const& law : laws(LawKind::pair))
    for (int dimension = law.least_dimension; dimension <= law.greatest_dimension; ++dimension)
      for (Class const& entry : classes_among(law, dimension))
        for (Way const way : {Way{many, 2.5}, Way{many, no_cutoff}, Way{2, no_cutoff}, Way{3, no_cutoff},
                              Way{4, no_cutoff}, Way{24, no_cutoff}}) {
          SCOPED_TRACE(testing::Message() << law.name << " in " << dimension << "D, " << way.count << " of "
                                          << entry.name << ", cut-off " << way.cutoff);
          auto const run = [&](auto make) {
            Particles const ensemble = make(way.count, 1);
            PairScheme scheme(box(dimension, way.cutoff < no_cutoff ? Boundary::periodic : Boundary::open));
            install_pairs(scheme, law, parameters_of(law), LawUse::internal, *ensemble, *ensemble, way.cutoff);
            return results(scheme, {ensemble.get()});
          };
          expect_same(run(entry.plain), run(entry.longer));
        }
}

TEST(LongRows, BetweenClassesOfDifferentLength) {
  for (LawInfo const& law : laws(LawKind::pair))
    for (int dimension = law.least_dimension; dimension <= law.greatest_dimension; ++dimension)
      for (Class const& target : classes_named(law.target, dimension))
        for (Class const& source : classes_among(law, dimension))
          for (double const cutoff : {2.5, no_cutoff}) {
            SCOPED_TRACE(testing::Message() << law.name << " in " << dimension << "D of " << source.name << " on "
                                            << target.name << ", cut-off " << cutoff);
            auto const run = [&](auto make_target, auto make_source) {
              Particles const a = make_target(many, 1), b = make_source(many / 2, 2);
              PairScheme scheme(box(dimension, cutoff < no_cutoff ? Boundary::periodic : Boundary::open));
              auto const use = law.target == law.source ? LawUse::between : LawUse::one_way;
              install_pairs(scheme, law, parameters_of(law), use, *a, *b, cutoff);
              return results(scheme, {a.get(), b.get()});
            };
            auto const plain = run(target.plain, source.plain);
            expect_same(plain, run(target.longer, source.plain));
            expect_same(plain, run(target.plain, source.longer));
            expect_same(plain, run(target.longer, source.longer));
          }
}

TEST(LongRows, OfConnections) {
  for (LawInfo const& law : laws(LawKind::pair))
    for (int dimension = law.least_dimension; dimension <= law.greatest_dimension; ++dimension)
      for (Class const& entry : classes_among(law, dimension)) {
        SCOPED_TRACE(testing::Message() << law.name << " in " << dimension << "D, of " << entry.name);
        auto const run = [&](auto make) {
          Particles const ensemble = make(many, 1);
          PairScheme scheme(box(dimension, Boundary::periodic));
          install_connections(scheme, law, parameters_of(law), *ensemble, {{0, many - 1, 1}, {3, many - 20, 7}});
          return results(scheme, {ensemble.get()});
        };
        expect_same(run(entry.plain), run(entry.longer));
      }
}

TEST(LongRows, OfWhatComesFromOutside) {
  std::vector<std::uint32_t> const some = {1, 2, 5, 77};
  for (LawInfo const& law : laws(LawKind::external))
    for (int dimension = law.least_dimension; dimension <= law.greatest_dimension; ++dimension)
      for (Class const& entry : classes_named(law.target, dimension))
        for (auto const* only : {static_cast<std::vector<std::uint32_t> const*>(nullptr), &some}) {
          SCOPED_TRACE(testing::Message()
                       << law.name << " in " << dimension << "D, on " << (only ? "some " : "every ") << entry.name);
          auto const run = [&](auto make) {
            Particles const ensemble = make(many, 1);
            PairScheme scheme(box(dimension, Boundary::open));
            install_external(scheme, law, parameters_of(law), *ensemble, only);
            return results(scheme, {ensemble.get()});
          };
          expect_same(run(entry.plain), run(entry.longer));
        }
}

TEST(LongRows, TurnInAMagneticField) {
  auto const run = [](auto ensemble) {
    PairScheme scheme(box(3, Boundary::open));
    install_external(scheme, *find_law("uniform-magnetic-field"), {{"field", {0.1, 0.2, 3}}}, *ensemble, nullptr);
    install_pairs(scheme, *find_law("coulomb"), {{"k", {1}}, {"softening", {0.1}}}, LawUse::internal, *ensemble,
                  *ensemble, no_cutoff);
    Simulation simulation(scheme, 0.001);
    simulation.integrate(*ensemble, Method::leap_frog);
    simulation.run(20);
    std::vector<double> all;
    for (auto const& ion : *ensemble)
      for (int a = 0; a < 3; ++a) all.push_back(ion.position[a]), all.push_back(ion.velocity[a]);
    return all;
  };
  auto const ions = [](auto like) {
    auto ensemble = std::make_unique<Ensemble<decltype(like)>>("ions", 30);
    std::mt19937_64 random(3);
    auto const number = [&] { return std::uniform_real_distribution(1.0, 9.0)(random); };
    for (auto& ion : *ensemble) ion.position = {number(), number(), number()}, ion.velocity = {number(), number(), 0};
    for (auto& ion : *ensemble) ion.charge = 1;
    return ensemble;
  };
  expect_same(run(ions(Coulomb<3>{})), run(ions(Long<Coulomb<3>>{})));
}

/// So that no law is forgotten above.
TEST(LongRows, AreThoseOfEveryLaw) {
  for (LawInfo const& law : scenario_laws()) {
    std::size_t used = 0;
    for (int dimension = 1; dimension <= 3; ++dimension) used += classes_named(law.target, dimension).size();
    EXPECT_GT(used, 0U) << law.name << " acts on no class of these tests";
  }
}

}  // namespace
}  // namespace boltzmann::long_rows_test
