// Atoms that feel their surroundings, one after the other: energies by plain loops over neighbours and triples, forces by
// differences. What schemes must agree with.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/laws/stillinger_weber.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace boltzmann::many_body_oracle {

/// Atoms in a box that is periodic along some axes: on a square lattice, shaken.
template <int D>
struct Sample {
  Box box;
  std::vector<Vector<D>> places;

  static Box box_of(int cells, double spacing, std::array<Boundary, D> const& kinds) {
    Vector<D> low, high;
    for (int a = 0; a < D; ++a) low[a] = 0.5 - a, high[a] = low[a] + cells * spacing;
    return Box(low, high, kinds);
  }
  Sample(int cells, double spacing, double shake, std::array<Boundary, D> const& kinds, unsigned seed = 11)
      : box(box_of(cells, spacing, kinds)) {
    std::mt19937_64 random(test_seed(seed));
    std::uniform_real_distribution<double> uniform(-shake, shake);
    int sites = 1;
    for (int a = 0; a < D; ++a) sites *= cells;
    for (int k = 0; k < sites; ++k) {
      Vector<D> x;
      int rest = k;
      for (int a = 0; a < D; ++a, rest /= cells) x[a] = box.low(a) + spacing * (rest % cells + 0.5) + uniform(random);
      places.push_back(x);
    }
  }
  /// All of it larger by factors along the axes.
  Sample scaled(std::array<double, 3> const& factor) const {
    Sample result = *this;
    Vector<D> low, high;
    std::array<Boundary, D> kinds;
    for (int a = 0; a < D; ++a) {
      low[a] = factor[a] * box.low(a), high[a] = factor[a] * box.high(a), kinds[a] = box.boundary(a);
      for (auto& x : result.places) x[a] *= factor[a];
    }
    result.box = Box(low, high, kinds);
    return result;
  }

  /// The vectors to all that is nearer than the cut-off, images too, and whose they are.
  struct Neighbour {
    Vector<D> r;
    std::size_t number;
  };
  std::vector<Neighbour> around(std::size_t i, double cutoff) const {
    std::vector<Neighbour> found;
    int most[3] = {0, 0, 0};
    for (int a = 0; a < D; ++a)
      if (box.periodic(a)) most[a] = static_cast<int>(std::ceil(cutoff / box.length(a))) + 1;
    for (std::size_t j = 0; j < places.size(); ++j)
      for (int x = -most[0]; x <= most[0]; ++x)
        for (int y = -most[1]; y <= most[1]; ++y)
          for (int z = -most[2]; z <= most[2]; ++z) {
            int const turns[3] = {x, y, z};
            if (j == i && x == 0 && y == 0 && z == 0) continue;
            Vector<D> r = places[j] - places[i];
            for (int a = 0; a < D; ++a)
              if (turns[a] != 0) r[a] += turns[a] * box.length(a);
            if (norm2(r) < cutoff * cutoff) found.push_back({r, j});
          }
    return found;
  }
};

/// Of each atom: half of its pairs, and what embeds it. Functions of distance and the numbers of both atoms.
template <int D>
std::vector<double> embedded(Sample<D> const& sample, double cutoff,
                             std::function<double(double, std::size_t, std::size_t)> const& pair,
                             std::function<double(double, std::size_t, std::size_t)> const& density,
                             std::function<double(double, std::size_t)> const& embedding) {
  std::vector<double> energies;
  for (std::size_t i = 0; i < sample.places.size(); ++i) {
    double pairs = 0, around = 0;
    for (auto const& [r, j] : sample.around(i, cutoff)) {
      pairs += 0.5 * pair(magnitude(r), i, j);
      around += density(magnitude(r), i, j);
    }
    energies.push_back(pairs + embedding(around, i));
  }
  return energies;
}

/// As the paper has it: pairs, and triples with their angle.
template <int D>
std::vector<double> stillinger_weber(Sample<D> const& sample, StillingerWeber const& law) {
  std::vector<double> energies;
  for (std::size_t i = 0; i < sample.places.size(); ++i) {
    double energy = 0;
    auto const around = sample.around(i, law.cutoff());
    for (std::size_t j = 0; j < around.size(); ++j) {
      double const x = magnitude(around[j].r) / law.sigma;
      energy +=
          0.5 * law.epsilon * law.A * (law.B * std::pow(x, -law.p) - std::pow(x, -law.q)) * std::exp(1 / (x - law.a));
      for (std::size_t k = j + 1; k < around.size(); ++k) {
        double const y = magnitude(around[k].r) / law.sigma;
        double const cosine = dot(around[j].r, around[k].r) / (x * y * law.sigma * law.sigma);
        energy += law.lambda * law.epsilon * std::exp(law.gamma / (x - law.a)) * std::exp(law.gamma / (y - law.a)) *
                  (cosine - law.cosine) * (cosine - law.cosine);
      }
    }
    energies.push_back(energy);
  }
  return energies;
}

inline double total(std::vector<double> const& energies) {
  double sum = 0;
  for (double const energy : energies) sum += energy;
  return sum;
}

/// Minus the slope of a total energy by the place of one atom.
template <int D>
Vector<D> force_by_differences(Sample<D> sample, std::size_t i, double step,
                               std::function<double(Sample<D> const&)> const& energy) {
  Vector<D> force;
  for (int a = 0; a < D; ++a) {
    double const x = sample.places[i][a];
    auto const at = [&](double moved) {
      sample.places[i][a] = x + moved;
      double const result = energy(sample);
      sample.places[i][a] = x;
      return result;
    };
    force[a] = -(8 * (at(step) - at(-step)) - (at(2 * step) - at(-2 * step))) / (12 * step);
  }
  return force;
}

template <int D>
void take(Ensemble<Newton<D>>& atoms, std::vector<Vector<D>> const& places) {
  atoms.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) atoms[i].position = places[i];
}

/// A system of atoms, their scheme and rows(), of so many cells: the same for 1, 2 and 3 threads.
template <class System>
void same_bits_for_any_threads(std::size_t cells, double step) {
  auto const run = [&](int threads) {
    System many(cells);
    many.scheme.threads(threads);
    Simulation simulation(many.scheme, step);
    simulation.run(8);
    auto bits = many.rows();
    bits.push_back(simulation.measure().potential);
    return bits;
  };
  auto const one = run(1);
  EXPECT_EQ(one, run(2));
  EXPECT_EQ(one, run(3));
}

/// Its energy stays, to a part of that of its motion; in two pieces a run has the bits of one.
template <class System>
void keeps_its_energy_and_goes_on(double part) {
  System one, half, rest;
  Simulation simulation(one.scheme, 0.005);
  double const start = kinetic_energy(one.atoms) + simulation.measure().potential;
  simulation.run(150);
  double const motion = kinetic_energy(one.atoms);
  EXPECT_NEAR(motion + simulation.measure().potential, start, part * motion);
  Simulation before(half.scheme, 0.005);
  before.run(70);
  auto const state = before.state();
  for (std::size_t i = 0; i < half.atoms.size(); ++i) rest.atoms[i] = half.atoms[i];
  Simulation after(rest.scheme, 0.005);
  after.restore(70, 0.005, before.seed(), state);
  after.run(80);
  EXPECT_EQ(rest.rows(), one.rows());
}

}  // namespace boltzmann::many_body_oracle
