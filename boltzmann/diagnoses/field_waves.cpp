// Real transforms along x, complex ones along y and z.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/fourier.hpp>
#include <boltzmann/diagnoses/field_waves.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace boltzmann {

FieldWaves::FieldWaves(MeshField const& field, std::size_t component)
    : grid_(field.grid), half_(field.grid.nodes[0] / 2 + 1) {
  for (int a = 0; a < grid_.dimension; ++a)
    if (!grid_.periodic[a])
      throw Error(fmt::format("waves of '{}': the axis {} is not periodic, so that no waves belong to it", field.name,
                              "xyz"[a]));
  auto const& values = field.components[component];
  if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }))
    throw Error(fmt::format("waves of '{}': it has no value at some nodes", field.name));

  std::size_t const nx = grid_.nodes[0], ny = grid_.nodes[1], nz = grid_.nodes[2];
  amplitude_.resize(half_ * ny * nz);
  FourierArray line(nx), waves(2 * half_);
  LineTransform const along_x(FourierKind::real_to_complex, nx);
  for (std::size_t row = 0; row < ny * nz; ++row) {
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(row * nx), nx, line.data());
    along_x.execute(line.data(), waves.data());
    for (std::size_t k = 0; k < half_; ++k) amplitude_[row * half_ + k] = {waves[2 * k], waves[2 * k + 1]};
  }
  // `planes` times: `length` numbers of `lines` interleaved lines.
  auto const transform = [&](std::size_t planes, std::size_t length, std::size_t lines) {
    if (length < 2) return;
    LineTransform const along(FourierKind::complex_forward, length, lines);
    FourierArray input(2 * length * lines), output(2 * length * lines);
    for (std::size_t plane = 0; plane < planes; ++plane) {
      auto* start = amplitude_.data() + plane * length * lines;
      for (std::size_t k = 0; k < length * lines; ++k)
        input[2 * k] = start[k].real(), input[2 * k + 1] = start[k].imag();
      along.execute(input.data(), output.data());
      for (std::size_t k = 0; k < length * lines; ++k) start[k] = {output[2 * k], output[2 * k + 1]};
    }
  };
  transform(nz, ny, half_);
  transform(1, nz, half_ * ny);
  for (auto& c : amplitude_) c /= static_cast<double>(grid_.size());
}

std::complex<double> FieldWaves::amplitude(std::array<int, 3> const& periods) const {
  for (int a = 0; a < 3; ++a)
    if (2 * std::abs(static_cast<long>(periods[a])) > static_cast<long>(grid_.nodes[a]))
      throw Error(fmt::format("{} periods along {}: the grid shows up to {} of them", periods[a], "xyz"[a],
                              grid_.nodes[a] / 2));
  bool const other = periods[0] < 0;
  auto const at = [&](int a) {
    auto const n = static_cast<long>(grid_.nodes[a]);
    long const k = other ? -periods[a] : periods[a];
    return static_cast<std::size_t>((k + n) % n);
  };
  auto const c = amplitude_[(at(2) * grid_.nodes[1] + at(1)) * half_ + at(0)];
  return other ? std::conj(c) : c;
}

double FieldWaves::wave_number(int axis, int periods) const {
  return 2 * std::numbers::pi * periods / (static_cast<double>(grid_.nodes[axis]) * grid_.spacing[axis]);
}

FieldWaves::Power FieldWaves::power() const {
  double width = 0, greatest = 0;
  std::array<double, 3> unit{0, 0, 0};
  for (int a = 0; a < grid_.dimension; ++a) {
    unit[a] = wave_number(a, 1);
    width = a == 0 ? unit[a] : std::min(width, unit[a]);
    std::size_t const most = grid_.nodes[a] / 2;
    greatest += std::pow(unit[a] * static_cast<double>(most), 2);
  }
  auto const nearest_interval = [&](double k) { return static_cast<std::size_t>(std::lround(k / width)); };
  Power result;
  result.power.assign(nearest_interval(std::sqrt(greatest)) + 1, 0.0);
  for (std::size_t k = 0; k < result.power.size(); ++k) result.wave_number.push_back(width * static_cast<double>(k));
  auto const signed_number = [&](int a, std::size_t k) {
    return unit[a] * (2 * k > grid_.nodes[a] ? static_cast<double>(k) - static_cast<double>(grid_.nodes[a])
                                             : static_cast<double>(k));
  };
  std::size_t at = 0;
  for (std::size_t z = 0; z < grid_.nodes[2]; ++z)
    for (std::size_t y = 0; y < grid_.nodes[1]; ++y)
      for (std::size_t x = 0; x < half_; ++x, ++at) {
        double const k = std::hypot(signed_number(0, x), signed_number(1, y), signed_number(2, z));
        // Waves that are not stored have the opposite direction along x, and the same power.
        double const twice = x == 0 || 2 * x == grid_.nodes[0] ? 1 : 2;
        auto const interval = std::min(nearest_interval(k), result.power.size() - 1);
        result.power[interval] += twice * std::norm(amplitude_[at]);
      }
  return result;
}

}  // namespace boltzmann
