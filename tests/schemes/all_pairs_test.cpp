// The kernels over all pairs against the scalar oracle, for every width of packs, and the same bits for every division
// into ranges.
#include "oracle.hpp"

#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/schemes/pair/single_precision.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <cstring>
#include <random>

namespace boltzmann::all_pairs_test {
namespace {

template <class P>
void scatter(Ensemble<P>& particles, unsigned seed) {
  std::mt19937_64 random(test_seed(seed));
  for (auto& p : particles) {
    for (int a = 0; a < P::dimension; ++a) p.position[a] = std::uniform_real_distribution(-1.0, 1.0)(random);
    p.mass = std::uniform_real_distribution(0.5, 2.0)(random);
    if constexpr (requires { p.charge; }) p.charge = std::uniform_real_distribution(-1.0, 1.0)(random);
  }
}

/// What a kernel gives for ranges that end at the given places.
struct Output {
  std::vector<double> influence, energy, virial;
  bool operator==(Output const& other) const {
    auto const same = [](auto const& a, auto const& b) {
      return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
    };
    return same(influence, other.influence) && same(energy, other.energy) && same(virial, other.virial);
  }
};

template <class P, class Q, class Law>
Output run(PairKernels const& kernels, Ensemble<P> const& target, Ensemble<Q> const& source, Law const& law,
           std::vector<std::size_t> ends, bool overwrite = false) {
  Output out;
  out.influence.assign(target.size() * target.influence_size(), overwrite ? 1e9 : 0.0);
  out.energy.assign(target.size(), 0.0);
  out.virial.assign(9 * target.size(), 0.0);
  PairTask task;
  task.target = target.row(0);
  task.targets = target.size();
  task.source = source.row(0);
  task.sources = source.size();
  task.same = static_cast<void const*>(&target) == static_cast<void const*>(&source);
  task.overwrite = overwrite;
  task.influence = out.influence.data();
  task.energy = out.energy.data();
  task.virial = out.virial.data();
  std::size_t begin = 0;
  ends.push_back(target.size());
  for (auto const end : ends) {
    if (end > begin) {
      kernels.all(&law, task, begin, end);
      kernels.all_measure(&law, task, begin, end);
    }
    begin = std::max(begin, end);
  }
  return out;
}

template <class P, class Q, class Law>
std::vector<double> virial(Ensemble<P> const& target, Ensemble<Q> const& source, Law const& law) {
  constexpr int D = P::dimension;
  bool const same = static_cast<void const*>(&target) == static_cast<void const*>(&source);
  std::vector<double> result(9 * target.size(), 0.0);
  for (std::size_t i = 0; i < target.size(); ++i)
    for (std::size_t j = 0; j < source.size(); ++j) {
      if (same && i == j) continue;
      auto const force = law(target[i], source[j]).force;
      auto const r = source[j].position - target[i].position;
      for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) result[9 * i + 3 * a + b] -= 0.5 * r[a] * force[b];
    }
  return result;
}

template <class P, class Q, class Law>
double largest_term(Ensemble<P> const& target, Ensemble<Q> const& source, Law const& law) {
  double most = 0;
  for (std::size_t i = 0; i < target.size(); ++i)
    for (std::size_t j = 0; j < source.size(); ++j)
      if (static_cast<void const*>(&target) != static_cast<void const*>(&source) || i != j)
        most = std::max(most, magnitude(law(target[i], source[j]).force));
  return most;
}

double largest(std::vector<double> const& a) {
  double most = 0;
  for (double const x : a) most = std::max(most, std::abs(x));
  return most;
}

/// The kernels over all pairs alone: those of lists needn't be compiled for every width here.
template <int W, class P, class Q, class Law>
constexpr PairKernels all_pairs_kernels() {
  PairKernels kernels;
  kernels.all = detail::over_all<detail::Pass::influence, W, P, Q, Law>;
  kernels.all_measure = detail::over_all<detail::Pass::measure, W, P, Q, Law>;
  kernels.has_energy = detail::gives_energy<P, Q, Law>;
  return kernels;
}

template <class P, class Q, class Law>
void compare(PairKernels const& kernels, int width, Ensemble<P> const& target, Ensemble<Q> const& source,
             Law const& law, char const* what) {
  SCOPED_TRACE(testing::Message() << what << ", W = " << width << ", " << target.size() << " by " << source.size());
  ASSERT_TRUE(kernels.has_energy);
  Vector<P::dimension> low{}, high{};
  for (int a = 0; a < P::dimension; ++a) low[a] = -1, high[a] = 1;
  auto const expected = oracle::influences(target, source, law, Box(low, high), no_cutoff);
  auto const moments = virial(target, source, law);
  Output const whole = run(kernels, target, source, law, {});
  double scale = largest_term(target, source, law);  // a sum may be far smaller
  for (auto const& influence : expected.influence) scale = std::max(scale, largest(influence));
  std::size_t const n = target.influence_size();
  for (std::size_t i = 0; i < target.size(); ++i)
    for (std::size_t c = 0; c < n; ++c)
      ASSERT_NEAR(whole.influence[i * n + c], expected.influence[i][c], 1e-13 * scale) << "particle " << i;
  double energy = 0, size = 0;
  for (double const e : whole.energy) energy += e, size += std::abs(e);
  EXPECT_NEAR(energy, expected.energy, 1e-13 * (size + 1));
  for (std::size_t k = 0; k < moments.size(); ++k)
    ASSERT_NEAR(whole.virial[k], moments[k], 1e-13 * largest(moments)) << "number " << k;

  for (std::size_t const grain : {1, 3, 8, 16, 50}) {
    std::vector<std::size_t> ends;
    for (std::size_t end = grain; end < target.size(); end += grain) ends.push_back(end);
    EXPECT_TRUE(run(kernels, target, source, law, ends) == whole) << "ranges of " << grain;
  }
  EXPECT_TRUE(run(kernels, target, source, law, {target.size() / 3}, true).influence == whole.influence);
}

template <int W, class P, class Q, class Law>
void compare(Ensemble<P> const& target, Ensemble<Q> const& source, Law const& law, char const* what) {
  compare(all_pairs_kernels<W, P, Q, Law>(), W, target, source, law, what);
}

template <int W, class P, class Law>
void compare_counts(Law const& law, char const* what) {
  for (std::size_t const count : {0, 1, 2, 3, 7, 8, 9, 15, 16, 17, 33, 100}) {
    Ensemble<P> particles("particles", count);
    scatter(particles, 1);
    compare<W>(particles, particles, law, what);
  }
  for (std::size_t const targets : {0, 1, 5, 16, 19})
    for (std::size_t const sources : {0, 1, 6, 70}) {
      Ensemble<P> a("a", targets), b("b", sources);
      scatter(a, 2);
      scatter(b, 3);
      compare<W>(a, b, law, what);
    }
}

template <class Width>
class AllPairs : public testing::Test {};
using Widths =
    testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 4>, std::integral_constant<int, 8>>;
TYPED_TEST_SUITE(AllPairs, Widths);

TYPED_TEST(AllPairs, EqualTheOracle) {
  constexpr int W = TypeParam::value;
  compare_counts<W, Kepler<3>>(gravity(1, 0.05), "softened gravity");
  compare_counts<W, Kepler<3>>(gravity(1), "gravity");
  compare_counts<W, Coulomb<2>>(coulomb(1), "charges in 2D");
  compare_counts<W, Coulomb<1>>(coulomb(1), "charges in 1D");
}

TYPED_TEST(AllPairs, BeyondOneGroupOfSources) {
  constexpr int W = TypeParam::value;
  for (std::size_t const count : {1023, 1024, 1025, 1041, 2100}) {
    Ensemble<Kepler<3>> stars("stars", count);
    scatter(stars, 4);
    compare<W>(stars, stars, gravity(1, 0.05), "softened gravity");
  }
}

TYPED_TEST(AllPairs, OfDifferentClasses) {
  constexpr int W = TypeParam::value;
  auto const law = [](auto const& p, auto const& q) {
    auto const r = q.position - p.position;
    auto const s = 1.0 / (0.1 + dot(r, r)) * p.mass * q.mass;
    return Interaction{r * s, s};
  };
  Ensemble<Coulomb<3>> ions("ions", 21);
  scatter(ions, 5);
  Ensemble<Newton<3>> stars("stars", 40);
  scatter(stars, 6);
  compare<W>(ions, stars, law, "ions by atoms");
  compare<W>(stars, ions, law, "atoms by ions");
}

/// Two at one place: they have no direction, all others don't notice.
TYPED_TEST(AllPairs, NothingButTheOwnPairIsNotANumber) {
  constexpr int W = TypeParam::value;
  Ensemble<Kepler<3>> stars("stars", 20);
  scatter(stars, 7);
  stars[0].position = {0, 0, 0};  // where rows behind the last one are
  stars[3].position = stars[11].position;
  auto const law = gravity(1);
  auto const out = run(all_pairs_kernels<W, Kepler<3>, Kepler<3>, LaplaceLaw>(), stars, stars, law, {});
  for (std::size_t i = 0; i < stars.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_EQ(std::isfinite(out.influence[3 * i + c]), i != 3 && i != 11) << "particle " << i;
}

/// Each velocity against the sum of the law over doubles, relative to the sum of the speeds that it is made of; and the
/// same bits for every division into ranges.
template <class Law>
void compare_velocities(PairKernels const& kernels, Ensemble<Vortex<2>> const& vortices, Law const& law,
                        double allowed) {
  Output const whole = run(kernels, vortices, vortices, law, {});
  for (std::size_t i = 0; i < vortices.size(); ++i) {
    Vector<2> velocity{};
    double speeds = 1e-300;
    for (std::size_t j = 0; j < vortices.size(); ++j) {
      if (i == j) continue;
      auto const one = law(vortices[i], vortices[j]);
      velocity += one, speeds += magnitude(one);
    }
    for (std::size_t c = 0; c < 2; ++c)
      ASSERT_NEAR(whole.influence[2 * i + c], velocity[static_cast<int>(c)], allowed * speeds) << "vortex " << i;
  }
  for (std::size_t const grain : {7, 32, 64, 100}) {
    std::vector<std::size_t> ends;
    for (std::size_t end = grain; end < vortices.size(); end += grain) ends.push_back(end);
    EXPECT_TRUE(run(kernels, vortices, vortices, law, ends) == whole) << "ranges of " << grain;
  }
}

TYPED_TEST(AllPairs, VorticesInDoubleAndInSinglePrecision) {
  constexpr int W = TypeParam::value;
  using V = Vortex<2>;
  for (std::size_t const count : {1, 2, 17, 130, 600}) {
    Ensemble<V> vortices("vortices", count);
    std::mt19937_64 random(test_seed(9));
    std::uniform_real_distribution anywhere(-1.0, 1.0);
    for (auto& p : vortices) {
      p.position = {anywhere(random), anywhere(random)};
      p.vorticity = {anywhere(random)}, p.core = 0.05 * std::abs(anywhere(random));
    }
    // Two at one place and without a core: they don't move each other.
    if (count > 2) vortices[1].position = vortices[count - 1].position, vortices[1].core = vortices[count - 1].core = 0;
    SCOPED_TRACE(testing::Message() << count << " vortices, W = " << W);
    auto const each = [&](auto const& law) {
      using Law = std::remove_cvref_t<decltype(law)>;
      constexpr auto in_double = all_pairs_kernels<W, V, V, Law>();
      compare_velocities(in_double, vortices, law, 1e-14);
      compare_velocities(in_single_precision<W, V, V, Law>(in_double), vortices, law, 1e-5);
    };
    each(BiotSavart{}), each(AlgebraicBiotSavart{});
  }
}

// Rows of images stand wherever memory is: of many numbers some are at odd places.
TEST(AllPairsOfAScheme, InSinglePrecisionBesideAWallAreThoseInDouble) {
  using V = Vortex<2>;
  std::mt19937_64 random(test_seed(10));
  std::uniform_real_distribution anywhere(0.0, 1.0);
  for (std::size_t count = 26; count < 34; ++count) {
    Box box(Vector{0., 0.}, Vector{1., 1.}, {Boundary::open, Boundary::mirror});
    box.open_end(1, Box::End::high);
    Ensemble<V> vortices("vortices", count);
    for (auto& p : vortices) p.position = {anywhere(random), anywhere(random)}, p.vorticity = {1}, p.core = 0.1;
    PairScheme in_double(box), in_single(box);
    in_double.internal(vortices, BiotSavart{});
    add_in_single_precision(in_single, vortices, vortices, BiotSavart{});
    in_double.calculate();
    std::vector<double> const wanted(vortices.influence(0), vortices.influence(0) + 2 * count);
    in_single.calculate();
    for (std::size_t k = 0; k < wanted.size(); ++k) EXPECT_NEAR(vortices.influence(0)[k], wanted[k], 1e-3);
  }
}

TEST(AllPairsOfAScheme, HaveTheSameBitsForAnyNumberOfThreads) {
  Ensemble<Kepler<3>> stars("stars", 1500);
  scatter(stars, 8);
  PairScheme scheme(Box(Vector{-1.0, -1.0, -1.0}, Vector{1.0, 1.0, 1.0}));
  scheme.internal(stars, gravity(1, 0.01));
  scheme.threads(1);
  scheme.calculate();
  std::vector<double> const one(stars.influence(0), stars.influence(0) + 3 * stars.size());
  for (int const threads : {2, 3, 7}) {
    scheme.threads(threads);
    scheme.calculate();
    EXPECT_EQ(std::memcmp(one.data(), stars.influence(0), one.size() * sizeof(double)), 0) << threads << " threads";
  }
}

}  // namespace
}  // namespace boltzmann::all_pairs_test
