// A few particles far ahead of all others: their neighbours are found anew, nobody else's, and all influences stay
// right, with the same bits for any thread count and after a resume.
#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <cstdio>
#include <cstring>
#include <random>
#include <string>

namespace boltzmann::fast_particles_test {
namespace {

constexpr auto smooth_law = [](auto const& p, auto const& q) {
  auto const r = q.position - p.position;
  return r * (1.0 / (0.3 + dot(r, r)) * q.mass);
};

constexpr double cutoff = 1.0, skin = 0.2;

/// A slow crowd and three fast particles, moved by hand.
template <int D>
struct Crowd {
  Box box;
  Ensemble<Newton<D>> atoms;
  PairScheme scheme;
  std::mt19937_64 random{test_seed(5)};
  std::vector<std::size_t> fast{1, 100, 101};

  static Box make_box(Boundary kind) {
    double const edge = D == 1 ? 300 : D == 2 ? 30 : 9;
    Vector<D> low, high;
    for (int a = 0; a < D; ++a) low[a] = -0.3 * edge, high[a] = 0.7 * edge;
    return Box(low, high, kind);
  }
  explicit Crowd(Boundary kind, int threads = 1) : box(make_box(kind)), atoms("atoms", 3000), scheme(box, cutoff) {
    scheme.skin(skin);
    scheme.threads(threads);
    scheme.internal(atoms, smooth_law);
    for (auto& p : atoms) {
      for (int a = 0; a < D; ++a) p.position[a] = std::uniform_real_distribution(box.low(a), box.high(a))(random);
      p.mass = std::uniform_real_distribution(0.5, 2.0)(random);
    }
    for (std::size_t const i : fast)
      for (int a = 0; a < D; ++a) atoms[i].velocity[a] = i == 100 ? -0.17 + 0.05 * a : 0.13 + 0.02 * a;
  }
  void step() {
    for (auto& p : atoms)
      for (int a = 0; a < D; ++a) p.position[a] += std::uniform_real_distribution(-1e-4, 1e-4)(random);
    for (std::size_t const i : fast) atoms[i].position = atoms[i].position + atoms[i].velocity;
    box.apply(atoms);
  }
  int builds() const {
    int calculations = 0, built = 0;
    std::sscanf(scheme.report().c_str(), "%d influence calculations, lists built %d", &calculations, &built);
    return built;
  }
  /// The influence on one particle by every other's nearest image.
  Vector<D> brute_force(std::size_t i) const {
    Vector<D> sum{};
    for (std::size_t j = 0; j < atoms.size(); ++j) {
      if (j == i) continue;
      Newton<D> q = atoms[j];
      auto d = q.position - atoms[i].position;
      box.nearest_image(&d[0]);
      if (!(norm2(d) < cutoff * cutoff)) continue;
      q.position = atoms[i].position + d;
      sum += smooth_law(static_cast<Newton<D> const&>(atoms[i]), q);
    }
    return sum;
  }
  std::vector<double> influences() const {
    return {atoms.influence(0), atoms.influence(0) + atoms.size() * atoms.influence_size()};
  }
};

template <int D>
void stay_right(Boundary kind) {
  SCOPED_TRACE(std::to_string(D) + "D " + to_string(kind));
  Crowd<D> one(kind), two(kind, 2);
  std::size_t checked = 0;
  for (int n = 0; n < 150; ++n) {
    one.scheme.calculate();
    two.scheme.calculate();
    ASSERT_EQ(one.influences(), two.influences()) << "step " << n;
    for (std::size_t i = 0; i < one.atoms.size(); ++i) {
      // The fast ones and all that are near them, and some others.
      bool near = i % 500 == 0;
      for (std::size_t const f : one.fast) {
        auto d = one.atoms[i].position - one.atoms[f].position;
        one.box.nearest_image(&d[0]);
        near = near || norm2(d) < 2;
      }
      if (!near) continue;
      ++checked;
      auto const right = one.brute_force(i);
      ASSERT_LT(magnitude(one.atoms.influence_on(i) - right), 1e-12 * (1 + magnitude(right)))
          << "particle " << i << " at step " << n;
    }
    one.step();
    two.step();
  }
  EXPECT_GT(checked, 150 * one.fast.size());
  // In 150 steps each of the fast ones has gone more than 100 skins; alone they don't rebuild everybody's list each
  // time.
  EXPECT_LE(one.builds(), 20) << one.scheme.report();
  EXPECT_NE(one.scheme.report().find("around fast particles"), std::string::npos) << one.scheme.report();
}

TEST(FastParticles, InfluencesStayRight) {
  for (Boundary const kind : {Boundary::periodic, Boundary::reflecting, Boundary::open}) {
    stay_right<1>(kind);
    stay_right<2>(kind);
    stay_right<3>(kind);
  }
}

template <int D>
void resume(Boundary kind, int at, bool moved_since) {
  Crowd<D> whole(kind), again(kind);
  for (int n = 0; n < at; ++n) {
    whole.step();
    whole.scheme.calculate();
  }
  if (moved_since) whole.step();
  auto const state = whole.scheme.state();
  again.random = whole.random;
  std::memcpy(again.atoms.row(0), whole.atoms.row(0), whole.atoms.size() * whole.atoms.stride() * sizeof(double));
  again.scheme.restore(state);
  EXPECT_EQ(again.scheme.state(), state);
  for (int n = 0; n < 25; ++n) {
    whole.scheme.calculate();
    again.scheme.calculate();
    ASSERT_EQ(whole.influences(), again.influences())
        << D << "D " << to_string(kind) << ", saved at " << at << ", step " << n;
    whole.step();
    again.step();
  }
}

TEST(FastParticles, AResumedRunHasTheSameBits) {
  for (Boundary const kind : {Boundary::periodic, Boundary::open})
    for (int const at : {1, 8, 23})
      for (bool const moved_since : {false, true}) {
        resume<2>(kind, at, moved_since);
        resume<3>(kind, at, moved_since);
      }
}

TEST(FastParticles, ABallThroughACrowdOfAnotherEnsemble) {
  for (Boundary const kind : {Boundary::periodic, Boundary::reflecting}) {
    Crowd<3> crowd(kind);
    Ensemble<Newton<3>> balls("balls", 2);
    balls[0].position = {0.1, 0.2, 0.3};
    balls[1].position = {2.1, 1.2, -0.3};
    balls[0].mass = 7;
    crowd.scheme.between(crowd.atoms, balls, smooth_law);
    for (int n = 0; n < 100; ++n) {
      crowd.scheme.calculate();
      PairScheme fresh(crowd.box, cutoff);
      fresh.skin(0.05);
      Ensemble<Newton<3>> atoms("atoms", crowd.atoms.size()), same("balls", 2);
      std::memcpy(atoms.row(0), crowd.atoms.row(0), atoms.size() * atoms.stride() * sizeof(double));
      std::memcpy(same.row(0), balls.row(0), 2 * same.stride() * sizeof(double));
      fresh.internal(atoms, smooth_law);
      fresh.between(atoms, same, smooth_law);
      fresh.calculate();
      for (std::size_t i = 0; i < atoms.size(); ++i)
        ASSERT_LT(magnitude(atoms.influence_on(i) - crowd.atoms.influence_on(i)),
                  1e-12 * (1 + magnitude(atoms.influence_on(i))))
            << i << " at step " << n;
      for (std::size_t i = 0; i < 2; ++i)
        ASSERT_LT(magnitude(same.influence_on(i) - balls.influence_on(i)),
                  1e-12 * (1 + magnitude(same.influence_on(i))));
      balls[0].position = balls[0].position + Vector{0.11, 0.07, -0.05};
      crowd.box.apply(balls);
      crowd.step();
    }
    EXPECT_LE(crowd.builds(), 20) << crowd.scheme.report();
  }
}

}  // namespace
}  // namespace boltzmann::fast_particles_test
