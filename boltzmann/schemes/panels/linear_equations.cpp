// Gaussian elimination, by rows.
#include <boltzmann/core/error.hpp>
#include <boltzmann/schemes/panels/linear_equations.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace boltzmann {

LinearEquations::LinearEquations(std::vector<double> matrix, std::size_t size)
    : factors_(std::move(matrix)), rows_(size), size_(size), permuted_(size) {
  std::iota(rows_.begin(), rows_.end(), std::size_t{0});
  double largest = 0;
  for (double const x : factors_) largest = std::max(largest, std::abs(x));
  for (std::size_t k = 0; k < size; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < size; ++i)
      if (std::abs(factors_[i * size + k]) > std::abs(factors_[pivot * size + k])) pivot = i;
    if (!(std::abs(factors_[pivot * size + k]) > 1e-14 * largest))
      throw Error("the equations of the panels are singular: two panels are at one place, or bodies touch");
    if (pivot != k) {
      std::swap_ranges(&factors_[k * size], &factors_[k * size] + size, &factors_[pivot * size]);
      std::swap(rows_[k], rows_[pivot]);
    }
    double const inverse = 1 / factors_[k * size + k];
    double const* const above = &factors_[k * size];
    for (std::size_t i = k + 1; i < size; ++i) {
      double* const row = &factors_[i * size];
      double const part = row[k] *= inverse;
      if (part == 0) continue;
      for (std::size_t j = k + 1; j < size; ++j) row[j] -= part * above[j];
    }
  }
}

void LinearEquations::solve(std::span<double> numbers) const {
  for (std::size_t i = 0; i < size_; ++i) permuted_[i] = numbers[rows_[i]];
  for (std::size_t i = 0; i < size_; ++i) {
    double sum = permuted_[i];
    double const* const row = &factors_[i * size_];
    for (std::size_t j = 0; j < i; ++j) sum -= row[j] * permuted_[j];
    permuted_[i] = sum;
  }
  for (std::size_t i = size_; i-- > 0;) {
    double sum = permuted_[i];
    double const* const row = &factors_[i * size_];
    for (std::size_t j = i + 1; j < size_; ++j) sum -= row[j] * permuted_[j];
    permuted_[i] = sum / row[i];
  }
  std::copy(permuted_.begin(), permuted_.end(), numbers.begin());
}

}  // namespace boltzmann
