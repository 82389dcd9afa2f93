// Laws: for each one and every dimension, force against the gradient of the energy, Newton's third law, packs against
// scalars, limits and parameters; then values worked out by hand.
#include <gtest/gtest.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/pack.hpp>
#include <boltzmann/laws/drag.hpp>
#include <boltzmann/laws/fene.hpp>
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/laws/morse.hpp>
#include <boltzmann/laws/rydberg.hpp>
#include <boltzmann/laws/soft.hpp>
#include <boltzmann/laws/spring.hpp>
#include <boltzmann/laws/tether.hpp>
#include <boltzmann/laws/uniform.hpp>
#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/rows.hpp>
#include <boltzmann/particles/tethered.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <tests/seed.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <ostream>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace boltzmann::laws_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

// ---- what is generated for every pair law that has an energy ----

enum class AtZero { singular, regular };

/// One law in one dimension. `near` to `far` are the distances that are tried.
template <int D, template <int, class> class ParticleClass>
struct CaseBase {
  static constexpr int dimension = D;
  using P = ParticleClass<D, double>;
  static constexpr double near = 0.8, far = 3;
  static constexpr char const* variant = "";
  static constexpr double conditioning = 1;  ///< how much the law magnifies the rounding error of a distance
};
template <int D>
struct LennardJonesCase : CaseBase<D, Newton> {
  static constexpr char const* name = "lennard-jones";
  static constexpr AtZero at_zero = AtZero::singular;
  static auto law() { return LennardJones{.depth = 1.7, .r0 = 1.2}; }
  static auto wrong_laws() {
    return std::vector<LennardJones>{{-1, 1}, {1, 0}, {1, -1}, {nan_value, 1}, {1, infinity}};
  }
};
template <int D>
struct MorseCase : CaseBase<D, Newton> {
  static constexpr char const* name = "morse";
  static constexpr double conditioning = 6;
  static constexpr AtZero at_zero = AtZero::regular;
  static auto law() { return Morse{.depth = 1.7, .r0 = 1.2, .a = 2.3}; }
  static auto wrong_laws() {
    return std::vector<Morse>{{-1, 1, 1}, {1, 0, 1}, {1, 1, 0}, {1, 1, -2}, {1, nan_value, 1}, {1, 1, infinity}};
  }
};
template <int D>
struct RydbergCase : CaseBase<D, Newton> {
  static constexpr char const* name = "rydberg";
  static constexpr double conditioning = 6;
  static constexpr AtZero at_zero = AtZero::regular;
  static auto law() { return Rydberg{.depth = 1.7, .r0 = 1.2, .a = 4.5}; }
  static auto wrong_laws() {
    return std::vector<Rydberg>{{-1, 1, 1},        {1, 0, 1},        {1, 1, 0},           {1, 1, -2},
                                {1, nan_value, 1}, {1, 1, infinity}, {1, 1, 1, nan_value}};
  }
};
template <int D>
struct CubicRydbergCase : RydbergCase<D> {
  static constexpr char const* variant = "cubic";
  static auto law() { return Rydberg{.depth = 1.7, .r0 = 1.2, .a = 4.5, .alpha = 0.185}; }
};
template <int D>
struct SpringCase : CaseBase<D, Newton> {
  static constexpr char const* name = "spring";
  static constexpr AtZero at_zero = AtZero::regular;
  static auto law() { return Spring{.stiffness = 3.1, .rest_length = 1.4}; }
  static auto wrong_laws() { return std::vector<Spring>{{-1, 1}, {1, -1}, {nan_value, 1}, {1, infinity}}; }
};
template <int D>
struct SoftCase : CaseBase<D, Newton> {
  static constexpr char const* name = "soft";
  static constexpr AtZero at_zero = AtZero::regular;
  static auto law() { return Soft{.repulsion = 25, .range = 3.5}; }
  static auto wrong_laws() { return std::vector<Soft>{{-1, 1}, {1, 0}, {1, -1}, {nan_value, 1}, {1, infinity}}; }
};
template <int D>
struct FeneCase : CaseBase<D, Newton> {
  static constexpr char const* name = "fene";
  static constexpr AtZero at_zero = AtZero::regular;
  static auto law() { return Fene{.stiffness = 3.1, .max_length = 9}; }
  static auto wrong_laws() { return std::vector<Fene>{{-1, 1}, {1, 0}, {1, -1}, {nan_value, 1}, {1, infinity}}; }
};
template <int D>
struct SlackSpringCase : SpringCase<D> {
  static constexpr char const* variant = "slack";
  static auto law() { return Spring{.stiffness = 3.1}; }
};
template <int D>
struct CoulombCase : CaseBase<D, Coulomb> {
  static constexpr char const* name = "coulomb";
  static constexpr AtZero at_zero = D == 1 ? AtZero::regular : AtZero::singular;  // in 1D the field is bounded
  static auto law() { return coulomb(1.3); }
  static auto wrong_laws() {
    return std::vector<LaplaceLaw>{coulomb(nan_value), coulomb(infinity), coulomb(1, -0.1), coulomb(1, infinity)};
  }
};
template <int D>
struct SoftCoulombCase : CoulombCase<D> {
  static constexpr char const* variant = "softened";
  static constexpr AtZero at_zero = AtZero::regular;
  static auto law() { return coulomb(1.3, 0.7); }
};
template <int D>
struct GravityCase : CaseBase<D, Kepler> {
  static constexpr char const* name = "gravity";
  static constexpr AtZero at_zero = D == 1 ? AtZero::regular : AtZero::singular;
  static auto law() { return gravity(0.9); }
  static auto wrong_laws() { return std::vector<LaplaceLaw>{gravity(nan_value), gravity(1, -1)}; }
};
template <int D>
struct SoftGravityCase : GravityCase<D> {
  static constexpr char const* variant = "softened";
  static constexpr AtZero at_zero = AtZero::regular;
  static auto law() { return gravity(0.9, 0.4); }
};

class Randomness {
 public:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  template <int D>
  Vector<D> direction() {
    for (;;) {
      Vector<D> v;
      for (int k = 0; k < D; ++k) v[k] = uniform(-1, 1);
      double const length = magnitude(v);
      if (length > 0.1 && length < 1) return v / length;
    }
  }
  /// A particle with every field filled, at the origin of nothing in particular.
  template <class P>
  P particle() {
    std::array<double, row_doubles<P>> values;
    for (double& x : values) x = uniform(0.5, 2);
    return std::bit_cast<P>(values);
  }

 private:
  std::mt19937_64 engine_{test_seed(99)};
};

/// -dE/dx by central differences of two step sizes: error of the fourth order.
template <int D>
Vector<D> minus_gradient(std::function<double(Vector<D> const&)> const& energy, Vector<D> const& x) {
  double const h = 1e-3;
  Vector<D> result;
  for (int k = 0; k < D; ++k) {
    auto const slope = [&](double step) {
      Vector<D> forward = x, back = x;
      forward[k] += step;
      back[k] -= step;
      return (energy(forward) - energy(back)) / (2 * step);
    };
    result[k] = -(4 * slope(h / 2) - slope(h)) / 3;
  }
  return result;
}

template <int D>
void expect_near(Vector<D> const& force, Vector<D> const& expected, double relative) {
  EXPECT_LT(magnitude(force - expected), relative * (1 + magnitude(expected)));
}

/// Rows of a particle p, last, and of W others about it.
template <class P, int W>
[[gnu::noinline]] std::vector<Row<P>> rows_about(Randomness& random, double near, double far) {
  std::vector<Row<P>> rows(W + 1);
  static_cast<P&>(rows[W]) = random.particle<P>();
  for (int lane = 0; lane < W; ++lane) {
    static_cast<P&>(rows[lane]) = random.particle<P>();
    rows[lane].position = rows[W].position + random.direction<P::dimension>() * random.uniform(near, far);
  }
  return rows;
}

/// What a law gives, as numbers: one after the other, each for all lanes.
template <class P, int W, class Law>
[[gnu::noinline]] std::vector<double> numbers_of_packs(Law const& law, double const* data) {
  using Real = Pack<double, W>;
  auto const result = law(broadcast<P, Real>(data + W * row_stride<P>),
                          load_rows<P, W>([&](int lane) { return data + lane * row_stride<P>; }));
  constexpr std::size_t numbers = sizeof(result) / sizeof(Real);
  auto const columns = std::bit_cast<std::array<Real, numbers>>(result);
  std::vector<double> all;
  for (auto const& column : columns)
    for (int lane = 0; lane < W; ++lane) all.push_back(column[lane]);
  return all;
}
template <class P, class Law>
[[gnu::noinline]] std::vector<double> numbers_of(Law const& law, P const& p, P const& q) {
  auto const result = law(p, q);
  auto const numbers = std::bit_cast<std::array<double, sizeof(result) / sizeof(double)>>(result);
  return {numbers.begin(), numbers.end()};
}

void expect_lane(std::vector<double> const& packs, int width, int lane, std::vector<double> const& expected,
                 double conditioning) {
  ASSERT_EQ(packs.size(), expected.size() * static_cast<std::size_t>(width));
  double size = 1;  // a component may cancel: the error is that of the largest, or of a typical number of the law
  for (double x : expected) size = std::max(size, std::fabs(x));
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_NEAR(packs[k * width + lane], expected[k], 4e-15 * conditioning * size) << k;
}

template <class P, int W, class Law>
void expect_packs_are_scalars(Law const& law, double near, double far, double conditioning = 1) {
  Randomness random;
  for (int trial = 0; trial < 200; ++trial) {
    auto const rows = rows_about<P, W>(random, near, far);
    auto const packs = numbers_of_packs<P, W>(law, reinterpret_cast<double const*>(rows.data()));
    for (int lane = 0; lane < W; ++lane)
      expect_lane(packs, W, lane, numbers_of<P>(law, rows[W], rows[lane]), conditioning);
  }
}

/// A case as the tests see it, which are compiled once and not for each: rows of doubles, the position first.
struct PairLaw {
  std::string name, variant;
  int dimension;
  AtZero at_zero;
  double near, far, conditioning;
  std::size_t doubles, stride;
  /// The force on p, and the energy last.
  std::vector<double> (*numbers)(double const* p, double const* q);
  /// The same of `width` q's and p, as rows one after the other: each number for all lanes.
  std::vector<double> (*packs)(int width, double const* rows);
  void (*check)();
  std::vector<bool> (*wrong_are_refused)();
  double length_scale;
};
void PrintTo(PairLaw const& law, std::ostream* out) { *out << law.name << " " << law.variant; }

bool refuses(auto const& law) {
  try {
    check_parameters(law);
  } catch (Error const&) {
    return true;
  }
  return false;
}

template <class Case>
PairLaw pair_law() {
  using P = typename Case::P;
  static_assert(symmetry_of<decltype(Case::law())>() == Symmetry::antisymmetric);
  return {.name = Case::name,
          .variant = Case::variant,
          .dimension = Case::dimension,
          .at_zero = Case::at_zero,
          .near = Case::near,
          .far = Case::far,
          .conditioning = Case::conditioning,
          .doubles = row_doubles<P>,
          .stride = row_stride<P>,
          .numbers =
              [](double const* p, double const* q) {
                return numbers_of<P>(Case::law(), *reinterpret_cast<P const*>(p), *reinterpret_cast<P const*>(q));
              },
          .packs =
              [](int width, double const* rows) {
                std::vector<Row<P>> aligned(width + 1);
                std::memcpy(&aligned[0].position[0], rows, aligned.size() * sizeof(Row<P>));
                double const* const data = &aligned[0].position[0];
                auto const law = Case::law();
                return width == 2   ? numbers_of_packs<P, 2>(law, data)
                       : width == 4 ? numbers_of_packs<P, 4>(law, data)
                                    : numbers_of_packs<P, 8>(law, data);
              },
          .check = [] { check_parameters(Case::law()); },
          .wrong_are_refused =
              [] {
                std::vector<bool> refused;
                for (auto const& wrong : Case::wrong_laws()) refused.push_back(refuses(wrong));
                return refused;
              },
          .length_scale = length_scale_of(Case::law())};
}

template <template <int> class... Case>
std::vector<PairLaw> in_every_dimension() {
  return {pair_law<Case<1>>()..., pair_law<Case<2>>()..., pair_law<Case<3>>()...};
}
std::vector<PairLaw> pair_laws() {
  return in_every_dimension<LennardJonesCase, MorseCase, RydbergCase, CubicRydbergCase, SpringCase, SlackSpringCase,
                            SoftCase, FeneCase, CoulombCase, SoftCoulombCase, GravityCase, SoftGravityCase>();
}

class PairLawOf : public testing::TestWithParam<PairLaw> {
 protected:
  using Numbers = std::vector<double>;

  PairLaw const& law() const { return GetParam(); }
  std::size_t dimension() const { return static_cast<std::size_t>(law().dimension); }

  /// A row with every field filled.
  Numbers particle() {
    Numbers row(law().stride);
    for (std::size_t k = 0; k < law().doubles; ++k) row[k] = random.uniform(0.5, 2);
    return row;
  }
  /// One at a distance between near and far of p.
  Numbers particle_near(Numbers const& p) {
    Numbers q = particle();
    Numbers const direction = dimension() == 1   ? components(random.direction<1>())
                              : dimension() == 2 ? components(random.direction<2>())
                                                 : components(random.direction<3>());
    double const distance = random.uniform(law().near, law().far);
    for (std::size_t k = 0; k < dimension(); ++k) q[k] = p[k] + direction[k] * distance;
    return q;
  }
  Numbers numbers(Numbers const& p, Numbers const& q) const { return law().numbers(p.data(), q.data()); }
  Numbers force(Numbers const& p, Numbers const& q) const {
    auto all = numbers(p, q);
    all.pop_back();
    return all;
  }
  double energy(Numbers const& p, Numbers const& q) const { return numbers(p, q).back(); }

  static Numbers components(auto const& vector) { return {std::begin(vector.component), std::end(vector.component)}; }
  static double size(Numbers const& vector) {
    double sum = 0;
    for (double const x : vector) sum += x * x;
    return std::sqrt(sum);
  }

  Randomness random;
};
INSTANTIATE_TEST_SUITE_P(Laws, PairLawOf, testing::ValuesIn(pair_laws()), [](auto const& info) {
  std::string name = info.param.name + (info.param.variant.empty() ? "" : "_" + info.param.variant) + "_" +
                     std::to_string(info.param.dimension) + "D";
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST_P(PairLawOf, ForceIsMinusTheGradientOfTheEnergy) {
  for (int trial = 0; trial < 200; ++trial) {
    Numbers const p = particle(), q = particle_near(p);
    Numbers const found = force(p, q);
    Numbers difference(dimension()), expected(dimension());
    for (std::size_t k = 0; k < dimension(); ++k) {
      // Central differences of two step sizes: error of the fourth order.
      auto const slope = [&](double step) {
        Numbers forward = p, back = p;
        forward[k] += step;
        back[k] -= step;
        return (energy(forward, q) - energy(back, q)) / (2 * step);
      };
      double const h = 1e-3;
      expected[k] = -(4 * slope(h / 2) - slope(h)) / 3;
      difference[k] = found[k] - expected[k];
    }
    EXPECT_LT(size(difference), 1e-7 * (1 + size(expected)));
  }
}

TEST_P(PairLawOf, NewtonsThirdLawHoldsToTheLastBit) {
  for (int trial = 0; trial < 200; ++trial) {
    Numbers const p = particle(), q = particle_near(p);
    Numbers const on_p = force(p, q), on_q = force(q, p);
    Numbers r(dimension());
    for (std::size_t k = 0; k < dimension(); ++k) {
      EXPECT_EQ(on_p[k], -on_q[k]);
      r[k] = q[k] - p[k];
    }
    EXPECT_EQ(energy(p, q), energy(q, p));
    Numbers torque;  // the force is central
    for (std::size_t j = 0; j < dimension(); ++j)
      for (std::size_t k = 0; k < j; ++k) torque.push_back(r[j] * on_p[k] - r[k] * on_p[j]);
    if (dimension() > 1) {
      EXPECT_LT(size(torque), 1e-14 * size(r) * size(on_p));
    }
  }
}

TEST_P(PairLawOf, PacksAreScalars) {
  for (int const width : {2, 4, 8})
    for (int trial = 0; trial < 200; ++trial) {
      Numbers const p = particle();
      Numbers rows;
      std::vector<Numbers> others;
      for (int lane = 0; lane < width; ++lane) {
        others.push_back(particle_near(p));
        rows.insert(rows.end(), others.back().begin(), others.back().end());
      }
      rows.insert(rows.end(), p.begin(), p.end());
      Numbers const packs = law().packs(width, rows.data());
      for (int lane = 0; lane < width; ++lane)
        expect_lane(packs, width, lane, numbers(p, others[lane]), law().conditioning);
    }
}

TEST_P(PairLawOf, TwoParticlesAtOnePlace) {
  Numbers const p = particle();
  Numbers q = particle();
  for (std::size_t k = 0; k < dimension(); ++k) q[k] = p[k];
  Numbers rows;
  for (int lane = 0; lane < 8; ++lane) rows.insert(rows.end(), q.begin(), q.end());
  rows.insert(rows.end(), p.begin(), p.end());
  Numbers const result = numbers(p, q), packs = law().packs(8, rows.data());
  for (std::size_t k = 0; k < dimension(); ++k) {
    if (law().at_zero == AtZero::singular) {
      EXPECT_FALSE(std::isfinite(result[k]));
      EXPECT_FALSE(std::isfinite(packs[8 * k + 3]));
    } else {
      EXPECT_EQ(result[k], 0);
      EXPECT_EQ(packs[8 * k + 3], 0);
    }
  }
  EXPECT_EQ(std::isfinite(result.back()), law().at_zero == AtZero::regular);
}

TEST_P(PairLawOf, ChecksItsParameters) {
  EXPECT_NO_THROW(law().check());
  auto const refused = law().wrong_are_refused();
  EXPECT_FALSE(refused.empty());
  for (std::size_t k = 0; k < refused.size(); ++k) EXPECT_TRUE(refused[k]) << k;
  EXPECT_GT(law().length_scale, 0);
}

TEST(Laws, EveryPairLawOfTheCatalogueIsTestedHere) {
  // Of those named here there are tests of their own, of the last one in vorticity_exchange_test.cpp.
  std::set<std::string> tested{"biot-savart", "biot-savart-algebraic", "biot-savart-gaussian", "pendulum-coupling",
                               "vorticity-exchange"};
  for (auto const& law : pair_laws()) tested.insert(law.name);
  std::set<std::string> shipped;
  for (auto const& law : scenario_laws())
    if (law.kind == LawKind::pair) shipped.insert(std::string(law.name));
  EXPECT_EQ(tested, shipped);
}

/// Of a user: two parameters, and nothing else said of it.
struct Screened {
  double strength, decay;
  static constexpr auto parameters() {
    return std::tuple{ParameterOf{&Screened::strength, {"strength", dimensions::energy, "at the range"}},
                      ParameterOf{&Screened::decay, {"decay", dimensions::wave_number, "by distance", positive}}};
  }
};
TEST(Laws, ThoseOfUsersAreCheckedByTheirParameters) {
  EXPECT_NO_THROW(check_parameters(Screened{-1, 1}));
  for (auto const& wrong : {Screened{1, 0}, Screened{nan_value, 1}}) {
    std::string said;
    try {
      check_parameters(wrong);
    } catch (Error const& error) {
      said = error.what();
    }
    EXPECT_EQ(said, wrong.decay == 0 ? "law: decay = 0 must be positive" : "law: strength = nan must be finite");
  }
}

TEST(Laws, ParameterErrorsAreOneReadableLine) {
  try {
    check_parameters(Morse{.depth = 1, .r0 = -1, .a = 1});
    FAIL();
  } catch (Error const& error) {
    EXPECT_STREQ(error.what(), "morse: r0 = -1 must be positive");
  }
}

// ---- values ----

/// Two particles at a distance along the first axis, p left of q.
template <class P>
std::pair<P, P> at_distance(double r) {
  P p{}, q{};
  q.position[0] = r;
  if constexpr (requires { p.mass; }) p.mass = q.mass = 1;
  return {p, q};
}
template <class P, class Law>
double energy_at(Law const& law, double r) {
  auto const [p, q] = at_distance<P>(r);
  return law(p, q).energy;
}
/// Towards q: positive if it attracts.
template <class P, class Law>
double attraction_at(Law const& law, double r) {
  auto const [p, q] = at_distance<P>(r);
  return law(p, q).force[0];
}

TEST(LennardJones, Values) {
  LennardJones const law{.depth = 2, .r0 = 1.5};
  using P = Newton<3>;
  EXPECT_DOUBLE_EQ(energy_at<P>(law, 1.5), -2);
  EXPECT_NEAR(attraction_at<P>(law, 1.5), 0, 1e-13);
  EXPECT_NEAR(energy_at<P>(law, 1.5 / std::pow(2, 1.0 / 6)), 0, 1e-13);  // sigma
  EXPECT_DOUBLE_EQ(energy_at<P>(law, 3), 2 * (1.0 / 4096 - 2.0 / 64));
  EXPECT_DOUBLE_EQ(attraction_at<P>(law, 3), 0.123046875);  // 12 depth/r (2^-6 - 2^-12)
  EXPECT_LT(attraction_at<P>(law, 1.4), 0);
  EXPECT_EQ(law.length_scale(), 1.5);
}

TEST(Morse, Values) {
  double const ln2 = std::log(2.0);
  Morse const law{.depth = 2, .r0 = 1, .a = ln2};
  using P = Newton<2>;
  EXPECT_DOUBLE_EQ(energy_at<P>(law, 1), -2);
  EXPECT_NEAR(attraction_at<P>(law, 1), 0, 1e-15);
  EXPECT_DOUBLE_EQ(energy_at<P>(law, 2), -1.5);
  EXPECT_DOUBLE_EQ(attraction_at<P>(law, 2), ln2);
  EXPECT_NEAR(energy_at<P>(law, 0), 0, 1e-15);  // e = 2 at the centre of this one
  EXPECT_LT(attraction_at<P>(law, 0.5), 0);
  double const h = 1e-4;  // stiffness 2 depth a^2
  EXPECT_NEAR((attraction_at<P>(law, 1 + h) - attraction_at<P>(law, 1 - h)) / (2 * h), 4 * ln2 * ln2, 1e-6);
}

TEST(Rydberg, Values) {
  Rydberg const law{.depth = 3, .r0 = 2, .a = 4};
  using P = Newton<3>;
  EXPECT_DOUBLE_EQ(energy_at<P>(law, 2), -3);
  EXPECT_DOUBLE_EQ(attraction_at<P>(law, 2), 0);
  EXPECT_DOUBLE_EQ(energy_at<P>(law, 2.5), -6 / std::exp(1));  // x = 1
  EXPECT_DOUBLE_EQ(attraction_at<P>(law, 2.5), 6 / std::exp(1));
  EXPECT_NEAR(energy_at<P>(law, 1.5), 0, 1e-14);  // x = -1
  double const h = 1e-4;                          // stiffness depth (a/r0)^2
  EXPECT_NEAR((attraction_at<P>(law, 2 + h) - attraction_at<P>(law, 2 - h)) / (2 * h), 12, 1e-5);

  Rydberg const cubic{.depth = 3, .r0 = 2, .a = 4, .alpha = 0.2};  // the minimum and the stiffness are the same
  EXPECT_DOUBLE_EQ(energy_at<P>(cubic, 2), -3);
  EXPECT_DOUBLE_EQ(attraction_at<P>(cubic, 2), 0);
  EXPECT_NEAR((attraction_at<P>(cubic, 2 + h) - attraction_at<P>(cubic, 2 - h)) / (2 * h), 12, 1e-4);
  EXPECT_DOUBLE_EQ(energy_at<P>(cubic, 2.5), -6.6 / std::exp(1));     // x = 1: 1 + x + 0.2 x^3 = 2.2
  EXPECT_DOUBLE_EQ(attraction_at<P>(cubic, 2.5), 3.6 / std::exp(1));  // 6 x (1 - 0.6 x + 0.2 x^2)
  EXPECT_NEAR(energy_at<P>(cubic, 1.5), 0.6 * std::exp(1), 1e-14);    // x = -1: -3 (-0.2)
  EXPECT_NEAR(attraction_at<P>(cubic, 1.5), -10.8 * std::exp(1), 1e-13);
}

TEST(Soft, Values) {
  Soft const law{.repulsion = 25, .range = 2};
  using P = Newton<3>;
  EXPECT_DOUBLE_EQ(attraction_at<P>(law, 0.5), -25 * 0.75);  // Groot and Warren's a (1 - r / rc)
  EXPECT_DOUBLE_EQ(energy_at<P>(law, 0), 25);                // a rc / 2
  EXPECT_DOUBLE_EQ(energy_at<P>(law, 1), 25 * 0.25);
  EXPECT_EQ(attraction_at<P>(law, 2), 0);
  EXPECT_EQ(energy_at<P>(law, 2.5), 0);
  EXPECT_EQ(attraction_at<P>(law, 2.5), 0);
}

TEST(Spring, Values) {
  Spring const law{.stiffness = 5, .rest_length = 2};
  EXPECT_DOUBLE_EQ(energy_at<Newton<3>>(law, 3), 2.5);
  EXPECT_DOUBLE_EQ(attraction_at<Newton<3>>(law, 3), 5);
  EXPECT_DOUBLE_EQ(attraction_at<Newton<1>>(law, 0.5), -7.5);  // compressed: pushes p to the left, away from q
  EXPECT_DOUBLE_EQ(attraction_at<Newton<1>>(law, -0.5), 7.5);
  EXPECT_EQ(law.length_scale(), 2);
  EXPECT_EQ((Spring{.stiffness = 1}.length_scale()), infinity);
}

template <int D>
Interaction<D, double> charges(LaplaceLaw const& law, double r) {
  auto [p, q] = at_distance<Coulomb<D>>(r);
  p.charge = 2;
  q.charge = 3;
  return law(p, q);
}
template <int D>
Interaction<D, double> masses(LaplaceLaw const& law, double r) {
  auto [p, q] = at_distance<Kepler<D>>(r);
  p.mass = 3;
  q.mass = 5;
  return law(p, q);
}

TEST(Laplace, ChargesByTheGeneralRule) {
  auto const law = coulomb(1);  // cgs: E = 2 pi e, 2 e/r, e/r^2
  EXPECT_DOUBLE_EQ(charges<1>(law, 2).force[0], -12 * pi);
  EXPECT_DOUBLE_EQ(charges<1>(law, 2).energy, -24 * pi);
  EXPECT_DOUBLE_EQ(charges<2>(law, 2).force[0], -6);
  EXPECT_DOUBLE_EQ(charges<2>(law, 2).energy, -12 * std::log(2.0));
  EXPECT_DOUBLE_EQ(charges<3>(law, 2).force[0], -1.5);
  EXPECT_DOUBLE_EQ(charges<3>(law, 2).energy, 3);
  EXPECT_DOUBLE_EQ(charges<3>(LaplaceLaw{.constant = 1}, 2).force[0], -6 / (4 * pi * 4));
}

TEST(Laplace, MassesAttractByTheGeneralRule) {
  auto const law = gravity(1);
  EXPECT_DOUBLE_EQ(masses<1>(law, 2).force[0], 30 * pi);
  EXPECT_DOUBLE_EQ(masses<1>(law, 2).energy, 60 * pi);
  EXPECT_DOUBLE_EQ(masses<2>(law, 2).force[0], 15);
  EXPECT_DOUBLE_EQ(masses<2>(law, 2).energy, 30 * std::log(2.0));
  EXPECT_DOUBLE_EQ(masses<3>(law, 2).force[0], 3.75);
  EXPECT_DOUBLE_EQ(masses<3>(law, 2).energy, -7.5);

  auto [stone, earth] = at_distance<Kepler<3>>(6.371e6);
  earth.mass = 5.9722e24;
  EXPECT_NEAR(gravity(6.6743e-11)(stone, earth).force[0], 9.8203, 1e-3);
}

TEST(Laplace, OneConventionInEveryDimension) {
  // A row of charges in 3D is one charge in 2D; a row of those is one in 1D.
  auto const law = coulomb(1);
  Coulomb<3> p3{};
  p3.charge = 1;
  p3.position = {1, 0, 0};
  double const spacing = 0.05;
  double field = 0;
  for (int k = -20000; k <= 20000; ++k) {
    Coulomb<3> q{};
    q.charge = spacing;
    q.position = {0, 0, k * spacing};
    field += law(p3, q).force[0];
  }
  Coulomb<2> p2{}, q2{};
  p2.charge = q2.charge = 1;
  p2.position = {1, 0};
  EXPECT_NEAR(field, law(p2, q2).force[0], 1e-5);

  field = 0;
  for (int k = -1000000; k <= 1000000; ++k) {
    Coulomb<2> q{};
    q.charge = spacing;
    q.position = {0, k * spacing};
    field += law(p2, q).force[0];
  }
  Coulomb<1> p1{}, q1{};
  p1.charge = q1.charge = 1;
  p1.position = {1};
  EXPECT_NEAR(field, law(p1, q1).force[0], 4 / 5e4 + 1e-6);  // the ends of the row are missing: 2 * 2/L
}

TEST(Laplace, PlummerSoftening) {
  auto const law = coulomb(1, 4);  // sqrt(3^2 + 4^2) = 5
  EXPECT_DOUBLE_EQ(charges<3>(law, 3).force[0], -6 * 3.0 / 125);
  EXPECT_DOUBLE_EQ(charges<3>(law, 3).energy, 6.0 / 5);
  EXPECT_DOUBLE_EQ(charges<2>(law, 3).force[0], -12 * 3.0 / 25);
  EXPECT_DOUBLE_EQ(charges<1>(law, 3).force[0], -12 * pi * 3 / 5);
  EXPECT_EQ(law.length_scale(), 4);
  EXPECT_EQ(coulomb(1).length_scale(), infinity);
}

TEST(Laplace, ClassesMayDiffer) {
  Coulomb<3> p{};
  Newton<3> plain{};
  Tethered<3> tethered{};
  p.position = {1.1, 0, 0};
  LennardJones const law{.depth = 1, .r0 = 1};
  EXPECT_GT(law(p, plain).energy, -1);
  EXPECT_EQ(law(p, tethered).energy, law(p, plain).energy);
  static_assert(!std::is_invocable_v<LaplaceLaw, Newton<3>, Newton<3>>, "particles without strength have no field");
}

// ---- vortices ----

template <class P = Vortex<2>>
P vortex2(double x, double y, double circulation, double core = 1e-3) {
  P v{};
  v.position = {x, y};
  v.vorticity = {circulation};
  v.core = core;
  return v;
}
template <class P = Vortex<3>>
P vortex3(Vector<3> position, Vector<3> vorticity, double core = 0) {
  P v{};
  v.position = position;
  v.vorticity = vorticity;
  v.core = core;
  return v;
}

TEST(BiotSavart, PairsIn2D) {
  BiotSavart const law;
  double const gamma = 3, d = 2;
  auto const p = vortex2(0, 0, gamma), q = vortex2(d, 0, -gamma);
  // Opposite circulations: both move at Gamma / (2 pi d), in the same direction.
  EXPECT_EQ(law(p, q), law(q, p));
  EXPECT_DOUBLE_EQ(law(q, p)[1], gamma / (2 * pi * d));
  EXPECT_DOUBLE_EQ(law(q, p)[0], 0);
  // Equal ones circle each other at Gamma / (pi d^2), counterclockwise.
  auto const r = vortex2(d, 0, gamma);
  EXPECT_DOUBLE_EQ(law(r, p)[1] / (d / 2), gamma / (pi * d * d));
  EXPECT_DOUBLE_EQ(law(p, r)[1], -law(r, p)[1]);
  // A viscous vortex carries no other field into the law.
  EXPECT_EQ(law(vortex2<Viscous<2>>(d, 0, 1), vortex2<Inviscid<2>>(0, 0, gamma)), law(r, p));
}

TEST(BiotSavart, CoreIn2D) {
  BiotSavart const law;
  double const gamma = 3, core = 0.5;
  auto const q = vortex2(1, 1, gamma, core);
  auto const speed = [&](double r) {
    Tracer<2> p{};
    p.position = {1 + r * 0.6, 1 + r * 0.8};
    auto const v = law(p, q);
    EXPECT_NEAR(v[0] * 0.6 + v[1] * 0.8, 0, 1e-15);  // it circles
    return magnitude(v);
  };
  EXPECT_EQ(speed(0), 0);
  EXPECT_NEAR(speed(0.25), gamma / (2 * pi * core * core) * 0.25, 1e-14);
  EXPECT_NEAR(speed(0.5 - 1e-12), speed(0.5 + 1e-12), 1e-10);
  EXPECT_NEAR(speed(0.5), gamma / (2 * pi * 0.5), 1e-14);
  EXPECT_NEAR(speed(2), gamma / (2 * pi * 2), 1e-14);
  // Even a point vortex is finite at its centre.
  Tracer<2> p{};
  p.position = {1, 1};
  EXPECT_EQ(law(p, vortex2(1, 1, gamma, 0)), (Vector{0.0, 0.0}));
}

TEST(BiotSavart, StraightVortexIn3DIsOneIn2D) {
  BiotSavart const law;
  Tracer<3> p{};
  p.position = {0.6, 0.8, 0};
  Vector<3> velocity{};
  double const spacing = 0.02;
  for (int k = -50000; k <= 50000; ++k) velocity += law(p, vortex3({0, 0, k * spacing}, {0, 0, 3 * spacing}));
  EXPECT_NEAR(velocity[0], -0.8 * 3 / (2 * pi), 1e-6);  // counterclockwise about +z
  EXPECT_NEAR(velocity[1], 0.6 * 3 / (2 * pi), 1e-6);
  EXPECT_EQ(velocity[2], 0);
}

TEST(BiotSavart, RingIn3D) {
  // At the centre of a ring of radius R the fluid moves at Gamma / (2 R); with a core, R^2 becomes R^2 + core^2 in the
  // denominator: Gamma R^2 / (2 (R^2 + core^2)^(3/2)).
  BiotSavart const law;
  int const elements = 400;
  double const radius = 2, gamma = 3;
  for (double const core : {0.0, 1.5}) {
    Vector<3> velocity{};
    for (int k = 0; k < elements; ++k) {
      double const phi = 2 * pi * k / elements, weight = gamma * 2 * pi * radius / elements;
      velocity += law(Tracer<3>{}, vortex3({radius * std::cos(phi), radius * std::sin(phi), 0},
                                           {-weight * std::sin(phi), weight * std::cos(phi), 0}, core));
    }
    EXPECT_NEAR(velocity[2], gamma * radius * radius / (2 * std::pow(radius * radius + core * core, 1.5)), 1e-12);
    EXPECT_NEAR(velocity[0], 0, 1e-13);
  }
}

/// The part of a vortex's vorticity that is inside a radius, from its distribution, by Simpson's rule.
double inside(double (*distribution)(double), int dimension, double radius) {
  int const intervals = 2000;
  double sum = 0;
  for (int k = 0; k <= intervals; ++k) {
    double const r = radius * k / intervals, shell = dimension == 2 ? 2 * pi * r : 4 * pi * r * r;
    sum += (k == 0 || k == intervals ? 1 : k % 2 == 1 ? 4 : 2) * shell * distribution(r);
  }
  return sum * radius / (3 * intervals);
}

template <class Law>
void expect_core(Law const& law, double (*in_plane)(double), double (*in_space)(double), double end_in_plane) {
  double const core = 0.3, gamma = 5;
  for (double const t : {1e-5, 1e-3, 0.02, 0.3, 0.7, 0.77, 0.775, 0.78, 1.1, 2.0, 5.0, 20.0}) {
    double const r = t * core;
    Tracer<2> p{};
    p.position = {1 + r * 0.6, 1 + r * 0.8};
    auto const v = law(p, vortex2(1, 1, gamma, core));
    double const speed = gamma / (2 * pi * r) * inside(in_plane, 2, std::min(t, end_in_plane));
    EXPECT_NEAR(v[0], -0.8 * speed, 1e-7 * speed) << t;
    EXPECT_NEAR(v[1], 0.6 * speed, 1e-7 * speed) << t;
    Tracer<3> e{};
    e.position = {r * 0.6, 0, r * 0.8};
    double const turning = gamma / (4 * pi * r * r) * inside(in_space, 3, t);
    EXPECT_NEAR(law(e, vortex3({0, 0, 0}, {0, 0, gamma}, core))[1], 0.6 * turning, 1e-7 * turning) << t;
  }
  // At its own place, with a core and without; and without a core all of them are point vortices.
  for (double const radius : {0.0, core}) {
    EXPECT_EQ(law(vortex2(1, 1, 1, core), vortex2(1, 1, gamma, radius)), (Vector{0.0, 0.0}));
    EXPECT_EQ(law(vortex3({1, 2, 3}, {1, 0, 0}), vortex3({1, 2, 3}, {0, 1, 0}, radius)), (Vector{0.0, 0.0, 0.0}));
  }
  EXPECT_NEAR(law(vortex2(2, 0, 1), vortex2(0, 0, gamma, 0))[1], gamma / (4 * pi), 1e-15);
  EXPECT_NEAR(law(vortex3({2, 0, 0}, {}), vortex3({0, 0, 0}, {0, 0, gamma}))[1], gamma / (16 * pi), 1e-15);
}

TEST(BiotSavart, CoresHaveTheVorticityThatTheySay) {
  expect_core(
      BiotSavart{}, [](double) { return 1 / pi; }, [](double r) { return 3 / (4 * pi) * std::pow(1 + r * r, -2.5); },
      1);
  expect_core(
      AlgebraicBiotSavart{}, [](double r) { return 2 / pi * std::pow(1 + r * r, -3); },
      [](double r) { return 15 / (8 * pi) * std::pow(1 + r * r, -3.5); }, 99);
  expect_core(
      GaussianBiotSavart{}, [](double r) { return std::exp(-r * r / 2) / (2 * pi); },
      [](double r) { return std::exp(-r * r / 2) * std::pow(2 * pi, -1.5); }, 99);
}

/// The classic form is the gradient of the velocity along the vorticity; the transposed one the gradient of the velocity
/// in the direction of the vorticity, and what one loses by it the other gains.
template <class Law>
void expect_stretching() {
  Randomness random;
  for (int trial = 0; trial < 100; ++trial) {
    auto p = random.particle<Inviscid<3>>();
    auto q = random.particle<Viscous<3>>();
    double const distance = random.uniform(0.1, 2);
    q.position = p.position + random.direction<3>() * distance;
    q.core = random.uniform(0.2, 0.8), p.core = q.core;
    auto const classic = Law{.transposed = 0}(p, q), transposed = Law{}(p, q), mixed = Law{.transposed = 0.5}(p, q);
    static_assert(std::is_same_v<decltype(classic), VortexInfluence<double> const>);
    auto const velocity_at = [&](Vector<3> const& step) {
      Tracer<3> e{};
      e.position = p.position + step;
      return Law{}(e, q);
    };
    EXPECT_EQ(classic.velocity, velocity_at({}));
    EXPECT_EQ(transposed.velocity, velocity_at({}));
    double const h = 1e-4;
    auto const along = [&](Vector<3> const& d) {
      return (8 * (velocity_at(d * h) - velocity_at(d * -h)) - (velocity_at(d * (2 * h)) - velocity_at(d * (-2 * h)))) /
             (12 * h);
    };
    auto const expected = along(p.vorticity);
    EXPECT_LT(magnitude(classic.stretching - expected), 1e-8 * (1 + magnitude(expected)));
    for (int a = 0; a < 3; ++a) {
      Vector<3> axis{};
      axis[a] = 1;
      double const slope = dot(along(axis), p.vorticity);
      EXPECT_NEAR(transposed.stretching[a], slope, 1e-8 * (1 + std::abs(slope)));
      EXPECT_NEAR(mixed.stretching[a], 0.5 * (classic.stretching[a] + transposed.stretching[a]),
                  1e-14 * magnitude(classic.stretching));
    }
    Inviscid<3> back{};
    back.position = q.position, back.vorticity = q.vorticity;
    Viscous<3> source{};
    source.position = p.position, source.vorticity = p.vorticity, source.core = q.core;
    EXPECT_LT(magnitude(Law{}(back, source).stretching + transposed.stretching),
              1e-13 * (1e-3 + magnitude(transposed.stretching)));
  }
}

TEST(BiotSavart, StretchingIsTheGradientOfTheVelocity) {
  expect_stretching<BiotSavart>();
  expect_stretching<AlgebraicBiotSavart>();
  expect_stretching<GaussianBiotSavart>();
  // At one place: finite, without a core too.
  BiotSavart const law{.transposed = 0};
  auto p = vortex3<Inviscid<3>>({1, 2, 3}, {1, 0, 0}), q = vortex3<Inviscid<3>>({1, 2, 3}, {0, 1, 0});
  EXPECT_EQ(law(p, q).velocity, (Vector{0.0, 0.0, 0.0}));
  EXPECT_EQ(law(p, q).stretching, (Vector{0.0, 0.0, 0.0}));
  q.core = 1;
  EXPECT_EQ(law(p, q).velocity, (Vector{0.0, 0.0, 0.0}));
  EXPECT_DOUBLE_EQ(law(p, q).stretching[2], -1 / (4 * pi));  // y x x = -z
}

template <class Law>
void expect_vortex_packs() {
  Law const law;
  expect_packs_are_scalars<Vortex<2>, 2>(law, 0.2, 3);
  expect_packs_are_scalars<Vortex<2>, 4>(law, 0.2, 3);
  expect_packs_are_scalars<Vortex<2>, 8>(law, 0.2, 3);
  expect_packs_are_scalars<Viscous<2>, 8>(law, 0.2, 3);
  expect_packs_are_scalars<Vortex<3>, 2>(law, 0.2, 3);
  expect_packs_are_scalars<Inviscid<3>, 4>(law, 0.2, 3);
  expect_packs_are_scalars<Viscous<3>, 8>(law, 0.2, 3);
}
TEST(BiotSavart, PacksAreScalars) {
  expect_vortex_packs<BiotSavart>();
  expect_vortex_packs<AlgebraicBiotSavart>();
  expect_vortex_packs<GaussianBiotSavart>();
  static_assert(!std::is_invocable_v<BiotSavart, Vortex<2>, Tracer<2>>, "a test particle moves nobody");
  static_assert(std::is_invocable_v<decltype(one_way(BiotSavart{})), Tracer<2>, Vortex<2>>);
  static_assert(symmetry_of<decltype(one_way(BiotSavart{}))>() == Symmetry::one_way);
}

// ---- from outside ----

template <int D>
struct Dimension_ : std::integral_constant<int, D> {};
template <class D>
class ExternalLawIn : public testing::Test {};
using Dimensions = testing::Types<Dimension_<1>, Dimension_<2>, Dimension_<3>>;
TYPED_TEST_SUITE(ExternalLawIn, Dimensions);

template <class P, class Law>
void expect_minus_gradient(Law const& law) {
  Randomness random;
  for (int trial = 0; trial < 50; ++trial) {
    P p = random.particle<P>();
    auto const force = law(p).force;
    auto const expected = minus_gradient<P::dimension>(
        [&, p](auto const& x) mutable {
          p.position = x;
          return law(p).energy;
        },
        p.position);
    expect_near<P::dimension>(force, expected, 1e-9);
    EXPECT_GT(magnitude(force), 0);
  }
}

template <int D>
Vector<D> some_vector() {
  Vector<D> v;
  for (int k = 0; k < D; ++k) v[k] = 1.5 - k;
  return v;
}

TYPED_TEST(ExternalLawIn, ForceIsMinusTheGradientOfTheEnergy) {
  constexpr int D = TypeParam::value;
  expect_minus_gradient<Newton<D>>(UniformGravity<D>{some_vector<D>()});
  expect_minus_gradient<Coulomb<D>>(UniformElectricField<D>{some_vector<D>()});
  expect_minus_gradient<Tethered<D>>(Tether{});
}

TYPED_TEST(ExternalLawIn, Values) {
  constexpr int D = TypeParam::value;
  Tethered<D> p{};
  p.mass = 2;
  p.stiffness = 3;
  p.position[0] = 5;
  p.anchor[0] = 1;
  p.velocity[0] = -7;
  EXPECT_DOUBLE_EQ(Tether{}(p).force[0], -12);
  EXPECT_DOUBLE_EQ(Tether{}(p).energy, 24);
  EXPECT_DOUBLE_EQ(Drag{0.5}(p)[0], 3.5);
  Vector<D> g{};
  g[0] = -9.8;
  EXPECT_DOUBLE_EQ(UniformGravity<D>{g}(p).force[0], -19.6);
  EXPECT_DOUBLE_EQ(UniformGravity<D>{g}(p).energy, 98);  // m g h
  Coulomb<D> electron{};
  electron.charge = -1.5;
  electron.position[0] = 4;
  EXPECT_DOUBLE_EQ(UniformElectricField<D>{g}(electron).force[0], 14.7);
  EXPECT_DOUBLE_EQ(UniformElectricField<D>{g}(electron).energy, -58.8);

  auto const flow = UniformFlow<D>{some_vector<D>()};
  EXPECT_EQ(flow(Tracer<D>{}), some_vector<D>());
  if constexpr (D == 2) {
    EXPECT_EQ(flow(Viscous<2>{}), some_vector<D>());
  }
  if constexpr (D == 3) {
    EXPECT_EQ(flow(Viscous<3>{}).velocity, some_vector<D>());
    EXPECT_EQ(flow(Viscous<3>{}).stretching, (Vector{0.0, 0.0, 0.0}));
  }

  static_assert(depends_on_velocity<Drag>() && !depends_on_velocity<Tether>());
  g[D - 1] = nan_value;
  EXPECT_THROW(check_parameters(UniformGravity<D>{g}), Error);
  EXPECT_THROW(check_parameters(UniformElectricField<D>{g}), Error);
  EXPECT_THROW(check_parameters(UniformFlow<D>{g}), Error);
  EXPECT_THROW(check_parameters(Drag{-1}), Error);
  EXPECT_NO_THROW(check_parameters(Drag{0}));
}

}  // namespace
}  // namespace boltzmann::laws_test
