// Truncated kernels: their closed forms in s are sampled on a long mesh, and transformed to the doubled mesh.
#include <boltzmann/core/fourier.hpp>
#include <boltzmann/core/number.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/mesh/open_kernel.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace boltzmann {
namespace {

constexpr std::size_t lines_at_once = 8;

/// Transforms an array of [outer][n][inner] along the middle axis, in place: cosines of all n numbers, or sines of the
/// inner ones, in which case the first and last become zero.
void transform(double* data, std::size_t outer, std::size_t n, std::size_t inner, bool sines) {
  if (n == 1) return;
  std::size_t const first = sines ? 1 : 0, length = n - 2 * first;
  std::size_t const total = outer * inner;
  if (length > 0) {
    LineTransform const lines(sines ? FourierKind::sine : FourierKind::cosine, length, lines_at_once);
    FourierArray in(length * lines_at_once), out(length * lines_at_once);
    for (std::size_t begin = 0; begin < total; begin += lines_at_once) {
      std::size_t const count = std::min(lines_at_once, total - begin);
      std::fill_n(in.data(), in.size(), 0.0);
      auto const at = [&](std::size_t line) { return data + line / inner * n * inner + line % inner; };
      for (std::size_t c = 0; c < count; ++c)
        for (std::size_t j = 0; j < length; ++j) in[j * lines_at_once + c] = at(begin + c)[(j + first) * inner];
      lines.execute(in.data(), out.data());
      for (std::size_t c = 0; c < count; ++c)
        for (std::size_t j = 0; j < length; ++j) at(begin + c)[(j + first) * inner] = out[j * lines_at_once + c];
    }
  }
  if (!sines) return;
  for (std::size_t line = 0; line < total; ++line) {
    double* const start = data + line / inner * n * inner + line % inner;
    start[0] = start[(n - 1) * inner] = 0;
  }
}

/// The value of a kernel at its truncation radius. It is subtracted before the transform, so that the truncated kernel
/// is continuous and rings less, and added again on the nodes.
double value_at(int axes, double k, double radius) {
  switch (axes) {
    case 1:
      return k > 0 ? std::exp(-k * radius) / (2 * k) : -radius / 2;
    case 2:
      if (k > 0) return k * radius < 700 ? std::cyl_bessel_k(0.0, k * radius) / (2 * pi) : 0;
      return -std::log(radius) / (2 * pi);
    default:
      return 1 / (4 * pi * radius);
  }
}

}  // namespace

OpenKernel::OpenKernel(std::vector<OpenAxis> axes) : axes_(std::move(axes)) {
  double diagonal2 = 0, widest = 0;
  for (auto const& axis : axes_) {
    double const length = static_cast<double>(axis.cells) * axis.spacing;
    diagonal2 += length * length;
    widest = std::max(widest, axis.spacing);
  }
  radius_ = std::sqrt(diagonal2) + 2 * widest;
  for (auto const& axis : axes_) {
    double const nodes = static_cast<double>(axis.cells) + std::ceil(radius_ / axis.spacing);
    fine_.push_back(std::max(axis.doubled, fast_even_length(static_cast<std::size_t>(nodes))));
  }
}

std::size_t OpenKernel::table_size() const {
  std::size_t size = 1;
  for (auto const& axis : axes_) size *= axis.doubled / 2 + 1;
  return size;
}

std::size_t OpenKernel::scratch_size() const {
  std::array<std::size_t, 3> fine{1, 1, 1}, kept{1, 1, 1};
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    fine[a] = fine_[a] / 2 + 1;
    kept[a] = axes_[a].doubled / 2 + 1;
  }
  return fine[0] * fine[1] + kept[0] * kept[1] * fine[2];
}

std::vector<double> OpenKernel::potential(double k2, int threads) const { return table(k2, -1, threads); }

std::vector<double> OpenKernel::slope(double k2, int axis, int threads) const { return table(k2, axis, threads); }

/// The Fourier transform of (kernel - its value at R) for r < R, at s^2 = s2. With k = 0:
///   one axis (1 - cos sR)/s^2, two (1 - J0(sR))/s^2, three (1 - sin(sR)/(sR))/s^2;
/// with k > 0:
///   one [1 - e^(-kR) (cos sR - (s/k) sin sR)]/(k^2+s^2) - e^(-kR) sin(sR)/(ks),
///   two [1 + sR J1(sR) K0(kR) - kR J0(sR) K1(kR)]/(k^2+s^2) - R K0(kR) J1(sR)/s.
double OpenKernel::transformed(double k2, double s2) const {
  double const r = radius_, k = std::sqrt(k2), s = std::sqrt(s2), x = s * r, y = k * r;
  if (axes_.size() == 3) return s > 0 ? (1 - std::sin(x) / x) / s2 : r * r / 6;
  if (axes_.size() == 1) {
    double const half = std::sin(x / 2);
    if (k == 0) return s > 0 ? 2 * half * half / s2 : r * r / 2;
    double const decay = std::exp(-y);
    if (s == 0) return (-std::expm1(-y) - y * decay) / k2;
    return (1 - decay * (std::cos(x) - s / k * std::sin(x))) / (k2 + s2) - decay * std::sin(x) / (k * s);
  }
  if (k == 0) return s > 0 ? (1 - ::j0(x)) / s2 : r * r / 4;
  bool const far = y > 700;
  double const k0 = far ? 0 : std::cyl_bessel_k(0.0, y), k1 = far ? 0 : std::cyl_bessel_k(1.0, y);
  if (s == 0) return (1 - y * k1) / k2 - r * r / 2 * k0;
  double const j1 = ::j1(x);
  return (1 + x * j1 * k0 - y * ::j0(x) * k1) / (k2 + s2) - r * k0 * j1 / s;
}

std::vector<double> OpenKernel::table(double k2, int slope_axis, int threads) const {
  std::array<std::size_t, 3> fine{1, 1, 1}, kept{1, 1, 1};
  std::array<double, 3> step{0, 0, 0};  // of s
  double scale = 1;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    fine[a] = fine_[a] / 2 + 1;
    kept[a] = axes_[a].doubled / 2 + 1;
    step[a] = 2 * pi / (static_cast<double>(fine_[a]) * axes_[a].spacing);
    scale /= static_cast<double>(fine_[a]);
  }

  // Transform from s to the nodes; keep only distances within the doubled mesh.
  std::size_t const kept_plane = kept[0] * kept[1];
  std::vector<double> tall(kept_plane * fine[2]);
  for_ranges(fine[2], 1 + fine[2] / 16, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<double> plane(fine[0] * fine[1]);
    for (std::size_t c = begin; c < end; ++c) {
      double const sz = static_cast<double>(c) * step[2];
      for (std::size_t b = 0; b < fine[1]; ++b)
        for (std::size_t a = 0; a < fine[0]; ++a) {
          double const sx = static_cast<double>(a) * step[0], sy = static_cast<double>(b) * step[1];
          double const factor = slope_axis < 0 ? 1 : slope_axis == 0 ? sx : slope_axis == 1 ? sy : sz;
          plane[b * fine[0] + a] = factor * transformed(k2, sx * sx + sy * sy + sz * sz);
        }
      transform(plane.data(), fine[1], fine[0], 1, slope_axis == 0);
      for (std::size_t b = 0; b < fine[1]; ++b)
        std::copy_n(&plane[b * fine[0]], kept[0], &plane[b * kept[0]]);  // to the front, which has already been read
      transform(plane.data(), 1, fine[1], kept[0], slope_axis == 1);
      std::copy_n(plane.data(), kept_plane, &tall[c * kept_plane]);
    }
  });
  transform(tall.data(), 1, fine[2], kept_plane, slope_axis == 2);
  tall.resize(kept_plane * kept[2]);

  // Add the value at the cut-off, multiply by the volume of a node, and transform to the modes of the doubled mesh.
  double const constant = slope_axis < 0 ? value_at(static_cast<int>(axes_.size()), std::sqrt(k2), radius_) : 0;
  double volume = 1;
  for (auto const& axis : axes_) volume *= axis.spacing;
  double const sign = slope_axis < 0 ? 1 : -1;
  for (double& value : tall) value = sign * value * scale + constant * volume;
  transform(tall.data(), kept[1] * kept[2], kept[0], 1, slope_axis == 0);
  transform(tall.data(), kept[2], kept[1], kept[0], slope_axis == 1);
  transform(tall.data(), 1, kept[2], kept_plane, slope_axis == 2);
  return tall;
}

}  // namespace boltzmann
