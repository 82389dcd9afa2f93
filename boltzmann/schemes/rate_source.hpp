// RateSource: the rates of an ensemble's driven fields, for an integrator that evaluates them when it needs them.
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <cstddef>

namespace boltzmann {

/// Strides of rates in doubles: from one driven field (with its diffusion coefficient) to the next, from component to
/// component, and from particle to particle.
struct RatePlaces {
  double* numbers = nullptr;
  std::size_t rate = 0, component = 1, particle = 1;

  double* of(std::size_t k, std::size_t c, std::size_t i) const {
    return numbers + k * rate + c * component + i * particle;
  }
};

/// The strides of AnyEnsemble::rate().
inline RatePlaces rates_of(AnyEnsemble& ensemble) {
  return {ensemble.rate(0), ensemble.size() * ensemble.rate_stride(), 1, ensemble.rate_stride()};
}

/// Given by a scheme to the integrator of an ensemble; valid as long as the scheme. Rates depend only on a particle's
/// row, on sums and on the time. So an integrator can evaluate them for a few particles at a time, whose rows it then
/// changes. This saves a pass over all rows, and the memory traffic of the rates.
class RateSource {
 public:
  virtual ~RateSource() = default;
  /// If `taken`, later calculations omit the rates and leave them to evaluate(). A calculation still stores them if
  /// observers read the particles (Scheme::complete()) or may do so.
  void take(bool taken) { taken_ = taken; }
  /// Called in a calculation; returns true if it omits the rates.
  bool leave() { return left_ = taken_; }
  /// True if the last calculation has omitted the rates; otherwise the ensemble has them.
  bool left() const { return left_; }
  /// Writes the rates of the particles [begin, end) from their current rows and sums, at the time of the last
  /// calculation. Components are in the order of AnyEnsemble::rate(), each in a column of fixed length whose first
  /// entry belongs to `begin`. Rates of sums are not changed.
  virtual void evaluate(std::size_t begin, std::size_t end, double* rates, std::size_t column) const = 0;

 private:
  bool taken_ = false, left_ = false;
};

}  // namespace boltzmann
