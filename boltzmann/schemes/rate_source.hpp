// RateSource: the rates of an ensemble's driven fields, for an integrator that evaluates them where it uses them.
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <cstddef>

namespace boltzmann {

/// Where rates stand: doubles from those of one driven field (and behind them, of one diffusion coefficient) to those of
/// the next, from component to component, and from particle to particle.
struct RatePlaces {
  double* numbers = nullptr;
  std::size_t rate = 0, component = 1, particle = 1;

  double* of(std::size_t k, std::size_t c, std::size_t i) const {
    return numbers + k * rate + c * component + i * particle;
  }
};

/// Those of an ensemble: AnyEnsemble::rate().
inline RatePlaces rates_of(AnyEnsemble& ensemble) {
  return {ensemble.rate(0), ensemble.size() * ensemble.rate_stride(), 1, ensemble.rate_stride()};
}

/// What a scheme hands to the integrator of an ensemble; it holds as long as the scheme. Rates depend on a particle's
/// row, on sums and on the time, so an integrator can have them of a few particles at a time, whose rows it is about to
/// change: a pass over all rows less, and no way through memory for the rates.
class RateSource {
 public:
  virtual ~RateSource() = default;
  /// True: from the next calculation on the scheme leaves the rates to whoever asks evaluate(), until somebody looks at
  /// the particles (Scheme::complete()), or may do so.
  void take(bool taken) { taken_ = taken; }
  /// At a calculation: whether it leaves them out.
  bool leave() { return left_ = taken_; }
  /// Whether the last calculation has left them out: else they stand in the ensemble.
  bool left() const { return left_; }
  /// Writes the rates of the particles from `begin` to before `end`, by their rows and sums of now, at the time of the
  /// last calculation: components as AnyEnsemble::rate() has them, each a column of so many doubles, of which the first is
  /// of `begin`. Those of sums are left alone.
  virtual void evaluate(std::size_t begin, std::size_t end, double* rates, std::size_t column) const = 0;

 private:
  bool taken_ = false, left_ = false;
};

}  // namespace boltzmann
