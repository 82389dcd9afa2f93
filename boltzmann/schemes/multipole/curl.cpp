// Derivatives of sum conj(Y_n^m) F_n^m, from d/dz Y_n^m = Y_(n-1)^m and (d/dx -+ i d/dy) Y_n^m = -+ Y_(n-1)^(m-+1), and of
// sum conj(M_n^m) T_n^m, from d/dz T_n^m = -T_(n+1)^m and (d/dx -+ i d/dy) T_n^m = -+ T_(n+1)^(m-+1).
#include <boltzmann/schemes/multipole/curl.hpp>
#include <boltzmann/schemes/multipole/solid_harmonics.hpp>

#include <complex>

namespace boltzmann {
namespace {

using multipole::imaginary_at;
using multipole::real_at;

/// One component: a local expansion, or moments.
class Component {
 public:
  Component(ExpansionView const& tables, double const* numbers, bool moments)
      : order_(tables.order), factors_(moments ? tables.scale : tables.unscale), numbers_(numbers), moments_(moments) {}

  /// The coefficient (n, m) of the derivative along an axis.
  std::complex<double> derivative(int axis, int n, int m) const {
    int const from = moments_ ? n - 1 : n + 1;
    if (axis == 2) return moments_ ? -at(from, m) : at(from, m);
    auto const below = at(from, m - 1), above = at(from, m + 1);
    return axis == 0 ? 0.5 * (below - above) : std::complex<double>(0, 0.5) * (below + above);
  }

 private:
  /// Without the stored factor, also for negative m: F_n^-m = (-1)^m conj F_n^m.
  std::complex<double> at(int n, int m) const {
    if (n < 0 || n > order_ || m > n || -m > n) return 0;
    int const k = m < 0 ? -m : m;
    std::complex<double> const one(numbers_[real_at(n, k)], k > 0 ? numbers_[imaginary_at(n, k)] : 0);
    double const f = factors_[n * (order_ + 1) + k];
    return m < 0 ? std::conj(one) * (k % 2 != 0 ? -f : f) : one * f;
  }

  int order_;
  double const *factors_, *numbers_;
  bool moments_;
};

/// `factors` are those of the result's coefficients.
void curl(Component const (&components)[3], ExpansionView const& to, double const* factors, double radius, double* curl,
          std::size_t stride) {
  for (std::size_t i = 0; i < 3; ++i) {
    std::size_t const j = (i + 1) % 3, k = (i + 2) % 3;
    double* const numbers = curl + i * stride;
    for (int n = 0; n <= to.order; ++n)
      for (int m = 0; m <= n; ++m) {
        auto const one =
            components[k].derivative(static_cast<int>(j), n, m) - components[j].derivative(static_cast<int>(k), n, m);
        double const f = factors[n * (to.order + 1) + m] / radius;
        numbers[real_at(n, m)] = f * one.real();
        if (m > 0) numbers[imaginary_at(n, m)] = f * one.imag();
      }
  }
}

}  // namespace

void curl_of_local(ExpansionView const& tables, double const* components, std::size_t stride, double radius,
                   double* out) {
  Component const all[3] = {
      {tables, components, false}, {tables, components + stride, false}, {tables, components + 2 * stride, false}};
  curl(all, tables, tables.scale, radius, out, stride);
}

void curl_of_moments(ExpansionView const& tables, double const* components, std::size_t stride, double radius,
                     ExpansionView const& further, double* out, std::size_t out_stride) {
  Component const all[3] = {
      {tables, components, true}, {tables, components + stride, true}, {tables, components + 2 * stride, true}};
  curl(all, further, further.unscale, radius, out, out_stride);
}

}  // namespace boltzmann
