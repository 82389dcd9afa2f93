// The regularised incomplete gamma functions and their inverses, by logarithms: accurate also far out in the tails.
#pragma once

namespace boltzmann {

/// ln(x^a e^-x / Gamma(a + 1)): the logarithm of Poisson's probability of a events where x are expected, a >= 0, x > 0.
double log_poisson(double a, double x);

/// ln P(a, x), the integral of t^(a - 1) e^-t / Gamma(a) from 0 to x, and ln Q(a, x), that from x to infinity: 1 = P +
/// Q. For a > 0, x >= 0. The relative error of P and Q is about 1e-13 for a up to 1e6. The cost is about 9 sqrt(a)
/// terms.
double log_lower_gamma(double a, double x);
double log_upper_gamma(double a, double x);

/// The x at which ln P(a, x), or ln Q(a, x), has this negative value.
double lower_gamma_quantile(double a, double log_fraction);
double upper_gamma_quantile(double a, double log_fraction);

}  // namespace boltzmann
