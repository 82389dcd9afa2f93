// P3M against Madelung constants and Ewald sums: forces to the accuracy that is asked for, energies, and a molten salt.
#include <boltzmann/schemes/mesh/ewald.hpp>
#include <boltzmann/schemes/mesh/p3m_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>
#include <tests/schemes/mesh_systems.hpp>
#include <tests/seed.hpp>

#include <gtest/gtest.h>

#include <memory>

namespace boltzmann::p3m_scheme_test {
namespace {

using namespace boltzmann::mesh_tests;

constexpr double four_pi = 4 * std::numbers::pi;

template <int D>
EwaldSums<D> exact_sums(Ensemble<Coulomb<D>> const& charges, Vector<D> const& edges, double constant = four_pi) {
  std::vector<double> q;
  for (auto const& p : charges) q.push_back(p.charge);
  return ewald_sums<D>(positions(charges), q, edges, constant);
}

// ---- crystals ----

TEST(P3M, MadelungConstants) {
  for (double const accuracy : {1e-4, 1e-7}) {
    Ensemble<Coulomb<3>> salt("salt", 64);
    for (int i = 0; i < 64; ++i) {
      int const x = i % 4, y = i / 4 % 4, z = i / 16;
      salt[static_cast<std::size_t>(i)].position = {x + 0.2, y + 0.6, z + 0.9};
      salt[static_cast<std::size_t>(i)].charge = (x + y + z) % 2 == 0 ? 1 : -1;
    }
    P3MScheme scheme(box_of(filled<3>(4.0), Boundary::periodic), coulomb(1), accuracy);
    scheme.add(salt);
    auto const measures = scheme.measure();
    EXPECT_NEAR(measures.potential / -32, 1.747564594633182, accuracy * 2);
    for (double const e : measures.per_particle[0]) EXPECT_NEAR(e * -2, 1.747564594633182, accuracy * 5);
    // Forces vanish; the error is a part of that between two neighbours.
    scheme.calculate();
    EXPECT_LT(rms(forces(salt)), 3 * accuracy);

    if (accuracy < 1e-5) continue;
    Ensemble<Coulomb<3>> caesium("caesium", 54);
    for (std::size_t i = 0; i < 27; ++i) {
      Vector<3> const corner{double(i % 3), double(i / 3 % 3), double(i / 9)};
      caesium[2 * i].position = corner;
      caesium[2 * i + 1].position = corner + 0.5;
      caesium[2 * i].charge = 1, caesium[2 * i + 1].charge = -1;
    }
    P3MScheme other(box_of(filled<3>(3.0), Boundary::periodic), coulomb(1), accuracy);
    other.add(caesium);
    EXPECT_NEAR(other.measure().potential / -27 * std::sqrt(0.75), 1.762674773070988, accuracy * 2);
  }
}

// ---- the accuracy that is asked for ----

/// One exact sum, compared at each accuracy.
template <int D>
void expect_accuracies(std::vector<double> const& accuracies, Vector<D> const& edges, std::size_t count, bool charged,
                       unsigned seed) {
  Ensemble<Coulomb<D>> charges("charges");
  scatter<D>(charges, count, Vector<D>{}, edges, seed);
  if (charged)
    for (std::size_t i = 0; i < count; ++i) charges[i].charge = 0.3 + 0.01 * static_cast<double>(i % 97);
  auto const exact = exact_sums<D>(charges, edges, coulomb(0.7).constant);
  for (double const accuracy : accuracies) {
    P3MScheme scheme(box_of(edges, Boundary::periodic), coulomb(0.7), accuracy);
    scheme.add(charges);
    if (charged) {
      EXPECT_TRUE(has(failure([&] { scheme.calculate(); }), "background(true)"));
      scheme.background(true);
    }
    scheme.calculate();
    double const error = relative_error(forces(charges), exact.force);
    EXPECT_LT(error, 2 * accuracy) << D << "D, " << charged << " order " << scheme.parameters().order;
    EXPECT_GT(error, 0.5 * accuracy) << D << "D, " << charged << " order " << scheme.parameters().order;
    auto const measures = scheme.measure();
    double sum = 0, largest = 0, squares = 0;
    for (std::size_t i = 0; i < count; ++i) {
      sum += measures.per_particle[0][i];
      largest = std::max(largest, std::abs(measures.per_particle[0][i]));
      squares += std::pow(measures.per_particle[0][i] - 0.5 * charges[i].charge * exact.potential[i], 2);
    }
    EXPECT_NEAR(sum, measures.potential, 1e-12 * largest * static_cast<double>(count));
    double const typical = std::sqrt(squares / static_cast<double>(count));
    EXPECT_LT(typical, 20 * accuracy * (1 + largest)) << D;
    EXPECT_NEAR(measures.potential, exact.energy, 4 * typical * std::sqrt(static_cast<double>(count)) + 1e-11 * largest)
        << D << "D, " << charged;
  }
}

TEST(P3M, ForcesAreAsAccurateAsAsked) {
  for (bool const charged : {false, true}) {
    auto const accuracies = charged ? std::vector{1e-3, 1e-6} : std::vector{1e-3, 1e-4, 1e-5, 1e-6, 1e-7};
    // Sheets of one sign add up to such forces that their rounding is above 1e-7.
    expect_accuracies<1>(charged ? std::vector{1e-3} : accuracies, {3.0}, 400, charged, 61);
    expect_accuracies<2>(accuracies, {2.0, 3.0}, 400, charged, 62);
    expect_accuracies<3>(accuracies, {2.0, 1.5, 2.5}, 300, charged, 63);
  }
}

// ---- several classes ----

template <int D, class Real = double>
struct Bead : Laplace<D, Real> {
  static constexpr char const* class_name = "Bead";
  Real valence, weight;
  Real strength() const { return valence * weight; }
};

// ---- the virial ----

/// Against the change of Ewald's energy where the box and what is in it are stretched along one axis.
template <int D>
void expect_virial_of_ewald(Vector<D> const& edges, bool charged, unsigned seed) {
  Ensemble<Coulomb<D>> charges("charges");
  scatter<D>(charges, 60, Vector<D>{}, edges, seed);
  if (charged)
    for (std::size_t i = 0; i < 60; ++i) charges[i].charge = 0.3 + 0.01 * static_cast<double>(i % 97);
  P3MScheme scheme(box_of(edges, Boundary::periodic), coulomb(0.7), 1e-6);
  scheme.add(charges);
  if (charged) scheme.background(true);
  auto const measures = scheme.measure();
  double const constant = coulomb(0.7).constant;
  double trace = 0, squares = 0;
  for (auto const& p : charges) squares += square(p.charge);
  for (int a = 0; a < D; ++a) {
    auto const stretched = [&](double factor) {
      Ensemble<Coulomb<D>> others("others");
      for (auto p : charges) {
        p.position[a] *= factor;
        others.add(p);
      }
      Vector<D> longer = edges;
      longer[a] *= factor;
      return exact_sums<D>(others, longer, constant).energy;
    };
    double const expected = -(stretched(1 + 1e-4) - stretched(1 - 1e-4)) / 2e-4;
    EXPECT_NEAR(measures.virial[a][a], expected, 2e-4 * (std::abs(expected) + std::abs(measures.potential)))
        << D << "D, charged " << charged << ", axis " << a;
    for (int b = 0; b < a; ++b)
      EXPECT_NEAR(measures.virial[a][b], measures.virial[b][a], 1e-9 * std::abs(measures.potential));
    trace += measures.virial[a][a];
  }
  // Energies that go with the inverse length, with its logarithm, with the length.
  if (charged) return;
  double const exact = D == 3 ? measures.potential : D == 2 ? -constant * squares / (4 * pi) : -measures.potential;
  EXPECT_NEAR(trace, exact, 3e-4 * (std::abs(exact) + std::abs(measures.potential))) << D;
}

TEST(P3M, VirialIsThatOfEwald) {
  for (bool const charged : {false, true}) {
    expect_virial_of_ewald<1>({1.3}, charged, 81);
    expect_virial_of_ewald<2>({1.0, 1.4}, charged, 82);
    expect_virial_of_ewald<3>({1.0, 1.3, 0.9}, charged, 83);
  }
}

// Two charges that are near each other in a large box, and all that is off the diagonal: - r_a F_b of the pair.
TEST(P3M, VirialOfAPairIsItsOwn) {
  Ensemble<Coulomb<3>> charges("charges", 2);
  Vector<3> const r{0.3, 0.5, -0.4};
  charges[0].position = {4, 5, 6};
  charges[1].position = charges[0].position + r;
  charges[0].charge = 2, charges[1].charge = -2;
  P3MScheme scheme(box_of(filled<3>(12.0), Boundary::periodic), coulomb(1), 1e-5);
  scheme.add(charges);
  auto const virial = scheme.measure().virial;
  double const strength = 4 / cube(magnitude(r));
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      EXPECT_NEAR(virial[a][b], -strength * r[a] * r[b], 0.02 * strength * norm2(r)) << a << b;
}

// ---- boxes that change ----

template <int D>
void expect_to_follow(Vector<D> const& edges, Vector<D> const& factors, double growth, unsigned seed) {
  Ensemble<Coulomb<D>> charges("charges");
  scatter<D>(charges, 200, Vector<D>{}, edges, seed);
  P3MScheme scheme(box_of(edges, Boundary::periodic), coulomb(0.7), 1e-4);
  scheme.add(charges);
  scheme.calculate();
  auto const before = scheme.parameters();
  double const chosen = std::hypot(before.error_near, before.error_mesh);
  Vector<D> now = edges;
  auto const stretch = [&](Vector<D> const& by) {
    for (auto& p : charges)
      for (int a = 0; a < D; ++a) p.position[a] *= by[a];
    for (int a = 0; a < D; ++a) now[a] *= by[a];
    Box::Edges to{};
    for (int a = 0; a < D; ++a) to[3 + static_cast<std::size_t>(a)] = now[a];
    scheme.box().edges(to);
    scheme.box_changed();
  };
  auto const error = [&] {  // rms of forces, and the energy's
    auto const exact = exact_sums<D>(charges, now, coulomb(0.7).constant);
    scheme.calculate();
    auto const measures = scheme.measure();
    double largest = 0, squares = 0;
    for (std::size_t i = 0; i < charges.size(); ++i) {
      largest = std::max(largest, std::abs(measures.per_particle[0][i]));
      squares += std::pow(measures.per_particle[0][i] - 0.5 * charges[i].charge * exact.potential[i], 2);
    }
    EXPECT_LT(std::sqrt(squares / 200), 20e-4 * (1 + largest)) << D;
    EXPECT_NEAR(measures.potential, exact.energy, 4 * std::sqrt(squares)) << D;
    return relative_error(forces(charges), exact.force) * rms(exact.force);
  };
  EXPECT_LT(error(), 2 * chosen) << D;
  stretch(factors);
  EXPECT_LT(error(), 2 * chosen) << D;
  EXPECT_FALSE(scheme.box_settled()) << D;
  EXPECT_EQ(scheme.parameters().cells, before.cells);
  stretch(filled<D>(growth));
  EXPECT_GT(error(), 2 * chosen) << D;
  EXPECT_TRUE(scheme.box_settled()) << D;
  EXPECT_NE(scheme.parameters().alpha, before.alpha);
  EXPECT_LT(error(), 2 * chosen) << D;
  EXPECT_FALSE(scheme.box_settled()) << D;
}

TEST(P3M, FollowsItsBoxAndChoosesAnewWhereItHasGrown) {
  expect_to_follow<1>({3.0}, {0.95}, 3, 91);
  expect_to_follow<2>({1.0, 1.4}, {0.97, 1.02}, 1.8, 92);
  expect_to_follow<3>({1.0, 1.3, 0.9}, {0.97, 1.01, 1.02}, 1.8, 93);
  // What is near, too: pairs() beside the mesh.
  Ensemble<Coulomb<3>> charges("charges", 2);
  charges[0].charge = 1, charges[1].charge = -1;
  charges[1].position = {0.5, 0, 0};
  P3MScheme scheme(box_of(filled<3>(4.0), Boundary::periodic), coulomb(1), 1e-4);
  scheme.add(charges);
  scheme.calculate();
  scheme.box().edges({0, 0, 0, 5, 5, 5});
  scheme.box_changed();
  EXPECT_EQ(scheme.pairs().box().edges(), scheme.box().edges());
}

TEST(P3M, SeveralClasses) {
  Vector<3> const edges{1.0, 1.3, 0.9};
  Ensemble<Coulomb<3>> ions("ions"), nobody("nobody");
  Ensemble<Bead<3>> beads("beads", 30);
  scatter<3>(ions, 31, Vector<3>{}, edges, 71);
  std::mt19937_64 random(test_seed(72));
  std::uniform_real_distribution<double> uniform(0, 1);
  for (std::size_t i = 0; i < 30; ++i) {
    for (int a = 0; a < 3; ++a) beads[i].position[a] = edges[a] * uniform(random);
    beads[i].valence = i % 2 == 0 ? -2 : 2;
    beads[i].weight = i == 0 ? 0.5 : i < 2 ? 0.0 : 1.0;
  }
  beads[0].valence = -2, beads[0].weight = 0.5, beads[1].weight = 0;
  P3MScheme scheme(box_of(edges, Boundary::periodic), coulomb(1), 1e-6);
  scheme.add(ions);
  scheme.add(nobody);
  scheme.add(beads);
  auto all = positions(ions);
  std::vector<double> q;
  for (auto const& p : ions) q.push_back(p.charge);
  for (auto const& p : beads) all.push_back(p.position), q.push_back(p.strength());
  scheme.background(true);
  scheme.calculate();
  auto const exact = ewald_sums<3>(all, q, edges, four_pi);
  auto both = forces(ions);
  for (auto const& f : forces(beads)) both.push_back(f);
  EXPECT_LT(relative_error(both, exact.force), 2e-6);
  EXPECT_EQ(magnitude(forces(beads)[1]), 0);  // without strength
  EXPECT_NEAR(scheme.measure().potential, exact.energy, 1e-3);
  EXPECT_EQ(scheme.measure().per_particle.size(), 3U);
  // Gravity.
  Ensemble<Kepler<3>> stars("stars", 40);
  for (auto& p : stars) {
    p.mass = 0.5 + uniform(random);
    for (int a = 0; a < 3; ++a) p.position[a] = edges[a] * uniform(random);
  }
  P3MScheme cosmos(box_of(edges, Boundary::periodic), gravity(0.3), 1e-4);
  cosmos.background(true);
  cosmos.add(stars);
  cosmos.calculate();
  std::vector<double> masses;
  for (auto const& p : stars) masses.push_back(p.mass);
  auto const of_stars = ewald_sums<3>(positions(stars), masses, edges, gravity(0.3).constant);
  EXPECT_LT(relative_error(forces(stars), of_stars.force), 2e-4);
  EXPECT_NEAR(cosmos.measure().potential, of_stars.energy, 1e-3 * std::abs(of_stars.energy));
}

// What else acts does not change what accuracy means, and what other schemes have added stays.
TEST(P3M, AccuracyIsThatOfItsOwnForces) {
  auto const edges = filled<3>(2.0);
  Ensemble<Coulomb<3>> charges("charges");
  scatter<3>(charges, 200, Vector<3>{}, edges, 73);
  auto const box = box_of(edges, Boundary::periodic);
  P3MScheme alone(box, coulomb(1), 1e-5), together(box, coulomb(1), 1e-5);
  alone.add(charges);
  together.add(charges);
  together.external(charges, [](auto const& p) { return p.velocity * 0.0 + 1e6; });
  EXPECT_EQ(alone.parameters().alpha, together.parameters().alpha);
  EXPECT_EQ(alone.parameters().cells, together.parameters().cells);
  P3MScheme fresh(box, coulomb(1), 1e-5);
  fresh.add(charges);
  for (std::size_t i = 0; i < charges.size(); ++i) charges.influence(i)[1] = 1e4;
  fresh.add_influences(0);
  auto const added = forces(charges);
  fresh.calculate();
  for (std::size_t i = 0; i < charges.size(); ++i) EXPECT_NEAR(added[i][1] - 1e4, charges.influence_on(i)[1], 1e-9);
}

// ---- few and none ----

TEST(P3M, NoneOneAndTwo) {
  auto const box = box_of(filled<3>(2.0), Boundary::periodic);
  for (std::size_t const count : {0, 1, 2}) {
    Ensemble<Coulomb<3>> charges("charges", count);
    for (std::size_t i = 0; i < count; ++i) {
      charges[i].position = {0.3 + 0.4 * static_cast<double>(i), 1.1, 0.2 + 0.1 * static_cast<double>(i * i)};
      charges[i].charge = 1 + static_cast<double>(i);
    }
    P3MScheme scheme(box, coulomb(1), 1e-5);
    scheme.background(true);
    scheme.add(charges);
    scheme.calculate();
    auto const exact = exact_sums<3>(charges, filled<3>(2.0));
    double const scale = 0.25 + 4 * static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i)
      EXPECT_LT(magnitude(charges.influence_on(i) - exact.force[i]), 1e-4 * scale) << count;
    EXPECT_NEAR(scheme.measure().potential, exact.energy, 1e-4 * scale) << count;
  }
  // Without strength.
  Ensemble<Coulomb<3>> plain("plain", 3);
  for (std::size_t i = 0; i < 3; ++i) plain[i].position[0] = 0.5 * static_cast<double>(i);
  P3MScheme scheme(box, coulomb(1), 1e-5);
  scheme.add(plain);
  scheme.calculate();
  EXPECT_EQ(rms(forces(plain)), 0);
  EXPECT_EQ(scheme.measure().potential, 0);
}

// ---- runs ----

/// r^-12 between all: keeps ions apart.
struct Repulsion {
  static constexpr Symmetry symmetry = Symmetry::antisymmetric;
  template <class P, class Q>
  auto operator()(P const& p, Q const& q) const {
    auto const r = q.position - p.position;
    auto const inverse2 = 1.0 / dot(r, r), inverse6 = inverse2 * inverse2 * inverse2;
    auto const energy = 0.1 * inverse6 * inverse6;
    return Interaction{r * (-12.0 * energy * inverse2), energy};
  }
};

struct MoltenSalt {
  Ensemble<Coulomb<3>> sodium{"sodium", 108}, chlorine{"chlorine", 108};
  std::unique_ptr<P3MScheme> scheme;
  std::unique_ptr<Simulation> simulation;

  explicit MoltenSalt(double dt, int threads = 1, Method method = Method::leap_frog) {
    std::mt19937_64 random(test_seed(81));
    std::normal_distribution<double> normal;
    for (int i = 0; i < 216; ++i) {
      int const x = i % 6, y = i / 6 % 6, z = i / 36;
      auto& ion = ((x + y + z) % 2 == 0 ? sodium : chlorine)[static_cast<std::size_t>(i / 2)];
      ion.position = {x + 0.5, y + 0.5, z + 0.5};
      for (int a = 0; a < 3; ++a) ion.velocity[a] = 0.3 * normal(random);
      ion.charge = (x + y + z) % 2 == 0 ? 1 : -1;
    }
    scheme = std::make_unique<P3MScheme>(box_of(filled<3>(6.0), Boundary::periodic), coulomb(1), 1e-4);
    scheme->add(sodium);
    scheme->add(chlorine);
    scheme->pairs().internal(sodium, Repulsion{}, 2.5);
    scheme->pairs().internal(chlorine, Repulsion{}, 2.5);
    scheme->pairs().between(sodium, chlorine, Repulsion{}, 2.5);
    scheme->threads(threads);
    simulation = std::make_unique<Simulation>(*scheme, dt);
    simulation->integrate(sodium, method);
    simulation->integrate(chlorine, method);
  }
  double energy() {
    double sum = scheme->measure().potential;
    for (auto const* ions : {&sodium, &chlorine})
      for (auto const& p : *ions) sum += 0.5 * p.mass * norm2(p.velocity);
    return sum;
  }
};

TEST(P3MRuns, MoltenSaltConservesEnergy) {
  double deviation[2];
  for (int k = 0; k < 2; ++k) {
    MoltenSalt salt(k == 0 ? 0.02 : 0.01);
    salt.simulation->run(10);
    double const start = salt.energy();
    double const kinetic = 0.5 * 216 * 3 * 0.09;
    deviation[k] = 0;
    for (int n = 0; n < 10; ++n) {
      salt.simulation->run(k == 0 ? 10 : 20);
      deviation[k] = std::max(deviation[k], std::abs(salt.energy() - start) / kinetic);
    }
    Vector<3> momentum{}, first{};
    for (auto const* ions : {&salt.sodium, &salt.chlorine})
      for (auto const& p : *ions) momentum += p.velocity;
    MoltenSalt again(0.01);
    for (auto const* ions : {&again.sodium, &again.chlorine})
      for (auto const& p : *ions) first += p.velocity;
    EXPECT_LT(magnitude(momentum - first), 1e-9);
  }
  EXPECT_LT(deviation[0], 0.02);
  EXPECT_LT(deviation[1], 0.005);
}

TEST(P3MRuns, SavedAndContinued) {
  MoltenSalt straight(0.01);
  straight.simulation->run(5);
  auto const state = straight.simulation->state();
  MoltenSalt on(0.01);
  on.simulation->run(12);
  for (int const threads : {1, 3}) {
    MoltenSalt later(0.01, threads);
    for (std::size_t i = 0; i < 108; ++i) {
      later.sodium[i] = straight.sodium[i];
      later.chlorine[i] = straight.chlorine[i];
    }
    later.simulation->restore(5, 0.01, straight.simulation->seed(), state);
    EXPECT_EQ(later.scheme->parameters().alpha, straight.scheme->parameters().alpha);
    later.simulation->run(7);
    EXPECT_TRUE(bits(on.sodium) == bits(later.sodium)) << threads;
    EXPECT_TRUE(bits(on.chlorine) == bits(later.chlorine)) << threads;
  }
  MoltenSalt other(0.01);
  auto short_state = state;
  short_state.resize(9);
  EXPECT_TRUE(has(failure([&] { other.simulation->restore(5, 0.01, 1, short_state); }), "does not fit"));
}

TEST(P3MRuns, ReversibleToTheLastBit) {
  MoltenSalt salt(0.01, 2, Method::reversible_leap_frog);
  salt.simulation->check();
  auto const start = bits(salt.sodium);
  salt.simulation->run(20);
  EXPECT_FALSE(bits(salt.sodium) == start);
  salt.simulation->rewind(20);
  EXPECT_TRUE(bits(salt.sodium) == start);
}

// ---- errors ----

TEST(P3MErrors, AreOneLine) {
  auto const of = [](Boundary boundary, double accuracy, LaplaceLaw const& law = coulomb(1)) {
    return failure([&] { P3MScheme(box_of(filled<3>(1.0), boundary), law, accuracy); });
  };
  EXPECT_TRUE(has(of(Boundary::open, 1e-3), "axis x of the box is open"));
  EXPECT_TRUE(has(of(Boundary::reflecting, 1e-3), "periodic in every direction"));
  EXPECT_TRUE(has(failure([] {
                    P3MScheme(Box(Vector<2>{0.0, 0.0}, Vector<2>{1.0, 1.0}, {Boundary::periodic, Boundary::reflecting}),
                              coulomb(1), 1e-3);
                  }),
                  "axis y of the box is reflecting"));
  for (double const accuracy : {0.0, -1e-3, 1e-11, 0.2, std::nan("")})
    EXPECT_TRUE(has(of(Boundary::periodic, accuracy), "between 1e-10 and 0.1")) << accuracy;
  EXPECT_EQ(of(Boundary::periodic, 1e-10), "no failure");
  EXPECT_TRUE(has(of(Boundary::periodic, 1e-3, coulomb(1, 0.1)), "softening"));
  // Two charges in a long flat box: the cut-off can't be longer than half the shortest edge.
  Ensemble<Coulomb<3>> charges("charges", 2);
  charges[0].charge = 1, charges[1].charge = -1, charges[1].position = {50.0, 0.0, 0.0};
  P3MScheme flat(Box(Vector{0.0, 0.0, 0.0}, Vector{100.0, 100.0, 0.01}, Boundary::periodic), coulomb(1), 1e-8);
  flat.add(charges);
  EXPECT_TRUE(has(failure([&] { flat.calculate(); }), "can't be reached")) << failure([&] { flat.calculate(); });
}

TEST(P3MErrors, PairsBesideTheMeshWarnOfLongStepsInUnits) {
  Ensemble<Coulomb<3>> charges("charges", 2);
  charges[0].charge = 1, charges[1].charge = -1, charges[1].position = {0.5, 0.0, 0.0};
  charges[0].velocity = {10.0, 0.0, 0.0}, charges[1].velocity = {-10.0, 0.0, 0.0};
  P3MScheme scheme(box_of(filled<3>(1.0), Boundary::periodic), coulomb(1), 1e-3);
  scheme.add(charges);
  scheme.pairs().internal(charges, LennardJones{1, 0.1}, 0.3);
  scheme.speak_in(UnitSystem(1 * units::angstrom, 1 * units::amu, 1 * units::picosecond));
  EXPECT_NEAR(scheme.collision_step(), 0.00083, 1e-12);  // a quarter of 0.1 at three thermal speeds, two digits
  EXPECT_TRUE(has(scheme.warnings(0.1).front(), "particles of 'charges' meet at speeds up to 30 angstrom/ps"))
      << scheme.warnings(0.1).front();
  EXPECT_EQ(scheme.warnings(1e-4).size(), 1U) << "nothing but what P3M has chosen";
}

TEST(P3MErrors, LostParticle) {
  Ensemble<Coulomb<3>> charges("charges", 2);
  charges[0].charge = 1, charges[1].charge = -1, charges[1].position = {0.5, 0.0, 0.0};
  P3MScheme scheme(box_of(filled<3>(1.0), Boundary::periodic), coulomb(1), 1e-3);
  scheme.add(charges);
  scheme.calculate();
  charges[1].position[2] = std::nan("");
  EXPECT_TRUE(has(failure([&] { scheme.calculate(); }), "particle 1 of 'charges' has a position that is not finite"));
}

}  // namespace
}  // namespace boltzmann::p3m_scheme_test
