// B-splines: the weights with which a particle's strength is spread over nearby nodes, and a field interpolated to it.
#pragma once

namespace boltzmann {

/// Weights of order p (Hockney and Eastwood, ch. 5): 1 nearest grid point, 2 cloud in cell, 3 triangular shaped cloud,
/// ... Node base + k has the weight k.
inline constexpr int highest_order = 7;

/// The offset from a position to its first node: base = floor(s) - nodes_before, with s the position in cells, plus one
/// half if the order is odd.
constexpr int nodes_before(int order) { return (order - 1) / 2; }

/// The weights of the p nodes from base on, for the fraction f = s - floor(s) in [0, 1): M_p(f + p - 1 - k), by
/// M_m(x) = [x M_{m-1}(x) + (m - x) M_{m-1}(x - 1)] / (m - 1).
template <int p, class Real>
[[gnu::always_inline]] inline void spline_weights(Real f, Real* weights) {
  if constexpr (p == 1) {
    weights[0] = Real(1);
  } else if constexpr (p == 2) {
    weights[0] = Real(1) - f;
    weights[1] = f;
  } else if constexpr (p == 3) {
    Real const g = Real(1) - f;
    weights[0] = Real(0.5) * g * g;
    weights[2] = Real(0.5) * f * f;
    weights[1] = Real(0.5) + f * g;
  } else {
    Real lower[p - 1];
    spline_weights<p - 1>(f, lower);  // lower[k] = M_{p-1}(f + p - 2 - k)
    for (int k = 0; k < p; ++k) {
      Real const x = f + Real(p - 1 - k);
      Real weight = Real(0);
      if (k > 0) weight += x * lower[k - 1];
      if (k < p - 1) weight += (Real(p) - x) * lower[k];
      weights[k] = weight * Real(1.0 / (p - 1));
    }
  }
}

}  // namespace boltzmann
