// The invariant law of internal energies: their distribution in equilibrium with a heat bath.
#pragma once

#include <boltzmann/laws/state_law.hpp>

#include <cstddef>
#include <vector>

namespace boltzmann {

/// The distribution of StateLaw::draw, prepared once for many draws. Its density in eps, exp(s(eps) / k - eps / (k T)),
/// is highest where the state law has the temperature T of the bath. It is integrated over temperatures, from point to
/// point of the table by Gauss-Legendre quadrature. Where the heat capacity is constant it is an incomplete gamma
/// function. For lumps with more than 1e16 k double precision resolves only the mean and the variance: a normal
/// distribution.
class InvariantLaw {
 public:
  /// Keeps a reference to the state law. Error if temperature or k is not positive.
  InvariantLaw(StateLaw const& law, double temperature, double boltzmann_constant);

  /// The fraction below an energy.
  double distribution(double energy) const;
  /// Its inverse, accurate to about 1e-13. Error if u is not in (0, 1).
  double quantile(double u) const;

 private:
  /// A range of temperatures, in which the heat capacity is linear and the density smooth.
  struct Panel {
    double start, width;
    double capacity, slope;  // of the heat capacity, at the start
    double exponent;         // at the start, zero at the maximum
    double mass = 0, below = 0, above = 0;
  };
  /// The tail below, or above, a temperature: the heat capacity is constant there.
  struct End {
    double temperature = 0, alpha = 0;    // the heat capacity is alpha k
    double log_below = 0, log_above = 0;  // of the gamma distribution's fractions
    double mass = 0, others = 0;          // of the law: in this tail, and everywhere else
  };

  double scaled(double temperature, End const& end) const;  // the variable of the gamma function
  double exponent_in(Panel const& panel, double t) const;
  double integral(Panel const& panel, double width) const;
  void cover(double first, double last);
  void add_panels(double from, double to, double exponent);
  End end(double temperature, double capacity, double exponent, bool low) const;
  std::size_t panel_at(double temperature) const;

  StateLaw const& law_;
  double bath_, k_;
  double sharp_ = 0;  // temperature over its standard deviation, if the law is too sharp for the panels
  double low_exponent_ = 0, high_exponent_ = 0;  // at the ends
  End low_, high_;
  std::vector<Panel> panels_;  // ascending
  double total_ = 0;
};

}  // namespace boltzmann
