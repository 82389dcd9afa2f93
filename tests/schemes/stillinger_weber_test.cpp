// Atoms with bonds against plain loops over triples: energies, forces by differences, the virial by scaling the box.
#include "many_body_oracle.hpp"

#include <boltzmann/boltzmann.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>

namespace boltzmann::stillinger_weber_test {
namespace {

using many_body_oracle::Sample;
using many_body_oracle::take;
using many_body_oracle::total;

constexpr Boundary periodic = Boundary::periodic, open = Boundary::open, reflecting = Boundary::reflecting;

/// Of no element: bonds so long that each atom has many.
StillingerWeber law() {
  StillingerWeber law{0.7, 1.4};
  law.a = 2.3;
  law.lambda = 5;
  law.cosine = -0.2;
  law.p = 5, law.q = 1;
  return law;
}

template <int D>
void agrees(int cells, std::array<Boundary, D> const& kinds) {
  Sample<D> const sample(cells, 1.7, 0.25, kinds);
  auto const energies = many_body_oracle::stillinger_weber(sample, law());
  Ensemble<Newton<D>> atoms("atoms");
  take(atoms, sample.places);
  StillingerWeberScheme scheme(sample.box, law());
  scheme.add(atoms);
  auto const measures = scheme.measure();
  EXPECT_NEAR(measures.potential, total(energies), 1e-12 * std::abs(total(energies)) * double(energies.size()));
  scheme.calculate();
  Vector<D> sum{}, size{};
  for (std::size_t i = 0; i < energies.size(); ++i) {
    EXPECT_NEAR(measures.per_particle[0][i], energies[i], 1e-11);
    for (int k = 0; k < D; ++k) sum[k] += atoms.influence_on(i)[k], size[k] += std::abs(atoms.influence_on(i)[k]);
  }
  for (int k = 0; k < D; ++k) EXPECT_LT(std::abs(sum[k]), 1e-14 * double(energies.size()) * size[k]);
  auto const energy = [&](Sample<D> const& moved) { return total(many_body_oracle::stillinger_weber(moved, law())); };
  for (std::size_t const i : {std::size_t{0}, energies.size() / 2}) {
    auto const force = many_body_oracle::force_by_differences<D>(sample, i, 1e-3, energy);
    for (int k = 0; k < D; ++k) EXPECT_NEAR(atoms.influence_on(i)[k], force[k], 1e-7 * (1 + std::abs(force[k])));
  }
  for (int axis = 0; axis < D; ++axis) {
    auto const at = [&](double strain) {
      std::array<double, 3> factor{1, 1, 1};
      factor[static_cast<std::size_t>(axis)] += strain;
      return energy(sample.scaled(factor));
    };
    double const h = 1e-4, slope = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
    EXPECT_NEAR(measures.virial[axis][axis], -slope, 1e-6 * (1 + std::abs(slope)));
    for (int b = 0; b < D; ++b) EXPECT_NEAR(measures.virial[axis][b], measures.virial[b][axis], 1e-10);
  }
}

TEST(StillingerWeber, AgreesWithTriplesInAnySpace) {
  agrees<1>(7, {periodic});
  agrees<2>(4, {periodic, reflecting});
  agrees<2>(4, {open, open});
  agrees<3>(3, {periodic, periodic, open});
}

struct Silicon {
  Ensemble<Newton<3>> atoms{"atoms", 0};
  Box box;
  StillingerWeberScheme scheme;
  explicit Silicon(std::size_t cells = 3) : box(make_box(cells)), scheme(box, StillingerWeber{1, 1}) {
    block_load(atoms, block(cells));
    for (std::size_t i = 0; i < atoms.size(); ++i) {
      for (int a = 0; a < 3; ++a)
        atoms[i].position[a] = atoms[i].position[a] + 0.04 * std::sin(1.0 + double(i * (2 * std::size_t(a) + 1)));
      atoms[i].velocity = {0.1 * std::sin(double(i)), 0.1 * std::cos(2.0 * double(i)), 0.1 * std::sin(3.0 * double(i))};
    }
    scheme.add(atoms);
  }
  static LatticeBlock block(std::size_t cells) {
    return {Lattice::diamond, std::pow(2, 1.0 / 6), {cells, cells, cells}};
  }
  static Box make_box(std::size_t cells) {
    auto const length = repeat_lengths(block(cells), 3);
    return Box({0, 0, 0}, {length[0], length[1], length[2]}, periodic);
  }
  std::vector<double> rows() const { return {atoms.row(0), atoms.row(0) + atoms.size() * atoms.stride()}; }
};

TEST(StillingerWeber, HasTheSameBitsForAnyThreads) {
  many_body_oracle::same_bits_for_any_threads<Silicon>(11, 0.005);  // 10648 atoms: every loop is shared
}

TEST(StillingerWeber, KeepsTheEnergyGoesOnAndBack) {
  many_body_oracle::keeps_its_energy_and_goes_on<Silicon>(1e-3);
  Silicon back;
  Simulation there(back.scheme, 0.01);
  there.integrate(back.atoms, Method::reversible_leap_frog);
  there.run(1);
  there.rewind(1);
  auto const rounded = back.rows();
  there.run(50);
  EXPECT_NE(back.rows(), rounded);
  there.rewind(50);
  EXPECT_EQ(back.rows(), rounded);
}

TEST(StillingerWeber, RefusesNumbersThatCannotBe) {
  Box const box({0, 0, 0}, {10, 10, 10}, periodic);
  EXPECT_EQ(message([&] {
              StillingerWeberScheme(box, StillingerWeber{1, -1});
            }),
            "Stillinger-Weber: sigma = -1 must be positive");
  auto flat = law();
  flat.cosine = -2;
  EXPECT_EQ(message([&] { StillingerWeberScheme(box, flat); }),
            "Stillinger-Weber: cosine = -2 must be between -1 and 1");
  EXPECT_EQ(message([&] {
              StillingerWeberScheme(box, StillingerWeber{1, 6});
            }),
            "the cut-off 10.8 of the atoms is longer than the periodic axis x, which allows at most 10");
}

}  // namespace
}  // namespace boltzmann::stillinger_weber_test
