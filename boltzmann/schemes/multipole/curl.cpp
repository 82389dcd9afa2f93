// Derivatives of sum conj(Y_n^m) F_n^m, from d/dz Y_n^m = Y_(n-1)^m and (d/dx -+ i d/dy) Y_n^m = -+ Y_(n-1)^(m-+1).
#include <boltzmann/schemes/multipole/curl.hpp>
#include <boltzmann/schemes/multipole/solid_harmonics.hpp>

#include <complex>

namespace boltzmann {
namespace {

using multipole::imaginary_at;
using multipole::real_at;

class LocalExpansion {
 public:
  LocalExpansion(ExpansionView const& tables, double const* numbers) : tables_(tables), numbers_(numbers) {}

  /// F_n^m of the derivative along an axis.
  std::complex<double> derivative(int axis, int n, int m) const {
    if (axis == 2) return at(n + 1, m);
    auto const below = at(n + 1, m - 1), above = at(n + 1, m + 1);
    return axis == 0 ? 0.5 * (below - above) : std::complex<double>(0, 0.5) * (below + above);
  }

 private:
  /// Without the factor it is stored with, also of negative m: F_n^-m = (-1)^m conj F_n^m.
  std::complex<double> at(int n, int m) const {
    if (n > tables_.order || m > n || -m > n) return 0;
    int const k = m < 0 ? -m : m;
    std::complex<double> const one(numbers_[real_at(n, k)], k > 0 ? numbers_[imaginary_at(n, k)] : 0);
    double const f = tables_.unscale[n * (tables_.order + 1) + k];
    return m < 0 ? std::conj(one) * (k % 2 != 0 ? -f : f) : one * f;
  }

  ExpansionView const& tables_;
  double const* numbers_;
};

}  // namespace

void curl(ExpansionView const& tables, double const* components, std::size_t stride, double radius, double* curl) {
  for (std::size_t i = 0; i < 3; ++i) {
    std::size_t const j = (i + 1) % 3, k = (i + 2) % 3;
    LocalExpansion const second(tables, components + j * stride), third(tables, components + k * stride);
    double* const numbers = curl + i * stride;
    for (int n = 0; n <= tables.order; ++n)
      for (int m = 0; m <= n; ++m) {
        auto const one = third.derivative(static_cast<int>(j), n, m) - second.derivative(static_cast<int>(k), n, m);
        double const f = tables.scale[n * (tables.order + 1) + m] / radius;
        numbers[real_at(n, m)] = f * one.real();
        if (m > 0) numbers[imaginary_at(n, m)] = f * one.imag();
      }
  }
}

}  // namespace boltzmann
