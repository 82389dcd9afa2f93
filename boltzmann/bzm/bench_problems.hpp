// The problems of bzm bench. Private to this module.
#pragma once

#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <cstddef>
#include <memory>

namespace boltzmann::bzm {

/// A simulation that is ready to run, and the number of pair interactions that a step computes (each pair counts
/// twice).
struct Problem {
  std::unique_ptr<AnyEnsemble> particles;
  std::unique_ptr<PairScheme> scheme;
  std::unique_ptr<Simulation> simulation;
  double pairs = 0;
};

/// Lennard-Jones at density 0.8442 and temperature 1.44, cut-off 2.5, periodic: the melt of every code's benchmarks, of
/// 4 cells^3 atoms.
Problem melt(std::size_t cells);

}  // namespace boltzmann::bzm
