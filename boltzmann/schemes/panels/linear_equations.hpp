// Linear equations with a full matrix, factorised once and solved for many right-hand sides.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace boltzmann {

class LinearEquations {
 public:
  LinearEquations() = default;
  /// Factorises a matrix of size x size numbers, row after row: L U with the largest pivot of each column (G. H. Golub
  /// and C. F. Van Loan, Matrix Computations, section 3.4). Throws Error if it is singular to rounding.
  LinearEquations(std::vector<double> matrix, std::size_t size);

  std::size_t size() const { return size_; }
  /// Replaces the right-hand side by the solution.
  void solve(std::span<double> numbers) const;

 private:
  std::vector<double> factors_;
  std::vector<std::size_t> rows_;  // permutation of the rows
  std::size_t size_ = 0;
  mutable std::vector<double> permuted_;
};

}  // namespace boltzmann
