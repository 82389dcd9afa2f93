// Laws as compiled formulas: programs, and the fields of the particles that they read.
#pragma once

#include <boltzmann/formulas/formula_program.hpp>

#include <memory>
#include <vector>

namespace boltzmann {

struct PairNumbers;

/// A law between p and q as programs. Their columns are the components of q.position - p.position, its square, and
/// these fields of q; the constants of a row are these fields of p. A result multiplies q.position - p.position, or
/// there is one for each of its components. The measuring program appends the energy, if there is one.
struct PairProgram {
  FormulaProgram influence, measure;
  std::vector<int> of_p, of_q;  ///< offsets of fields in a row, in doubles; sorted
  bool along = true;            ///< on the line of centres
  bool has_energy = false;
  bool antisymmetric = false;  ///< obeys Newton's third law
  bool velocity_dependent = false;
  double least_square = boltzmann::least_square;  ///< 0: it diverges for two coincident particles
  std::shared_ptr<PairNumbers const> numbers;     ///< the same law, one pair at a time
};

/// An external influence. Columns are these fields of a particle; the constant of a row is the time. There is a result
/// for each component; the measuring program gives the energy.
struct ExternalProgram {
  FormulaProgram influence, measure;
  std::vector<int> of_p;
  bool has_energy = false;
  bool velocity_dependent = false, depends_on_time = false;
};

/// All rates of driven fields, and the diffusion coefficients of those that diffuse. Columns are these fields of a
/// particle, then these components of sums; the constant of a row is the time. Result k is one component of one of them
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
