// Laws that are formulas, ready to be run: programs, and which fields of the particles they read.
#pragma once

#include <boltzmann/formulas/formula_program.hpp>

#include <memory>
#include <vector>

namespace boltzmann {

struct PairNumbers;

/// A law between p and q as programs. Their columns are the components of q.position - p.position, its square, and then
/// these fields of q; the values of a row are these fields of p. A result multiplies q.position - p.position, or there is
/// one for each of its components; the measuring program has the energy behind it, if there is one.
struct PairProgram {
  FormulaProgram influence, measure;
  std::vector<int> of_p, of_q;  ///< where fields stand in a row, in doubles; sorted
  bool along = true;            ///< on the line of centres
  bool has_energy = false;
  bool antisymmetric = false;  ///< known to obey Newton's third law
  bool velocity_dependent = false;
  double least_square = boltzmann::least_square;  ///< 0: it is not finite for two particles at one place
  std::shared_ptr<PairNumbers const> numbers;     ///< the same law, one pair at a time
};

/// An influence from outside. Columns are these fields of a particle; the value of a row is the time. There is a result
/// for each component, and of the measuring program the energy.
struct ExternalProgram {
  FormulaProgram influence, measure;
  std::vector<int> of_p;
  bool has_energy = false;
  bool velocity_dependent = false, depends_on_time = false;
};

/// All rates of driven fields, and the diffusion coefficients of those that diffuse. Columns are these fields of a
/// particle, then these components of sums; the value of a row is the time. Result k is one component of one of them
/// (AnyEnsemble::rate()).
struct RateProgram {
  struct Result {
    std::size_t rate, component;
  };
  FormulaProgram program;
  std::vector<int> of_p;
  std::vector<Result> sums;
  std::vector<Result> results;
  bool velocity_dependent = false, depends_on_time = false;
};

}  // namespace boltzmann
