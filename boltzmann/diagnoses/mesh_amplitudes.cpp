// Counts on nodes and their transform, of which only the wanted waves are kept from axis to axis.
#include <boltzmann/core/fourier.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/diagnoses/mesh_amplitudes.hpp>
#include <boltzmann/schemes/mesh/spline.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>

namespace boltzmann {
namespace {

constexpr int spline_order = MeshAmplitudes::order;
constexpr std::size_t fewest_nodes = 8;
constexpr double rounding = 0x1.8p52;  // added to a number, it leaves the nearest integer in its low bits

/// The slot of an axis: the last slot is that of contiguous nodes.
int slot_of(int axis, int dimension) { return axis == dimension - 1 ? 2 : axis; }

double sinc(double x) { return x == 0 ? 1 : std::sin(x) / x; }

/// The nodes along an axis over which a position is spread.
struct Spread {
  std::size_t first = 0;  // the others may wrap around to 0
  double weights[spline_order] = {1, 0, 0, 0, 0, 0};
};

Spread spread(double part, std::size_t nodes, double shift) {
  static_assert(spline_order % 2 == 0, "an even spline is counted from the node before a place");
  double const s = (part - std::floor(part)) * static_cast<double>(nodes) + shift, before = std::floor(s);
  Spread found;
  spline_weights<spline_order>(s - before, found.weights);
  found.first = (static_cast<std::size_t>(before) + nodes - nodes_before(spline_order)) % nodes;
  return found;
}

/// The largest power of two for scaling weights so that no sum overflows, nor a weight exceeds the range of `rounding`.
double scale_for(std::size_t particles) {
  return std::ldexp(1.0, std::min(50, 62 - static_cast<int>(std::bit_width(particles))));
}

}  // namespace

/// Lines along the last axis have padding for nodes that wrap around to their beginning.
struct MeshAmplitudes::Counts {
  std::array<std::size_t, 3> nodes;
  double scale;
  std::size_t line = nodes[2] + spline_order - 1;
  std::vector<std::int64_t> numbers = std::vector<std::int64_t>(nodes[0] * nodes[1] * line);

  template <int D>
  void spread_all(std::vector<double const*> const& rows, Box const& box, double shift, int threads) {
    // Each range has planes of its own, and processes all particles: integer sums are independent of their order.
    std::size_t const grain =
        D == 1 ? 1 : (nodes[0] + static_cast<std::size_t>(threads) - 1) / static_cast<std::size_t>(threads);
    for_ranges(nodes[0], grain, threads_for(rows.size(), spline_order * spline_order, threads),
               [&](std::size_t begin, std::size_t end) {
                 for (double const* row : rows) add<D>(row, box, shift, begin, end);
               });
  }
  void clear() { std::fill(numbers.begin(), numbers.end(), 0); }
  double value(std::size_t x, std::size_t y, std::size_t z) const {
    std::int64_t const* const at = &numbers[(x * nodes[1] + y) * line];
    return static_cast<double>(z + 1 < spline_order ? at[z] + at[nodes[2] + z] : at[z]);
  }

 private:
  template <int D>
  void add(double const* row, Box const& box, double shift, std::size_t begin, std::size_t end) {
    auto const along = [&](int a, int slot) {
      return spread((row[a] - box.low(a)) / box.length(a), nodes[static_cast<std::size_t>(slot)], shift);
    };
    constexpr int planes = D > 1 ? spline_order : 1, lines = D > 2 ? spline_order : 1;
    Spread x, y;
    if constexpr (D > 1) {
      x = along(0, 0);
      std::size_t const last = (x.first + spline_order - 1) % nodes[0];
      bool const whole = begin == 0 && end == nodes[0];
      if (!whole && x.first <= last && (last < begin || x.first >= end)) return;
    }
    if constexpr (D > 2) y = along(1, 1);
    Spread const z = along(D - 1, 2);
    for (int i = 0; i < planes; ++i) {
      std::size_t plane = x.first + static_cast<std::size_t>(i);
      plane -= plane < nodes[0] ? 0 : nodes[0];
      if (plane < begin || plane >= end) continue;
      for (int j = 0; j < lines; ++j) {
        std::size_t at = y.first + static_cast<std::size_t>(j);
        at -= at < nodes[1] ? 0 : nodes[1];
        std::int64_t* const to = &numbers[(plane * nodes[1] + at) * line + z.first];
        double const weight = x.weights[i] * y.weights[j] * scale;
        for (int k = 0; k < spline_order; ++k)
          to[k] +=
              std::bit_cast<std::int64_t>(weight * z.weights[k] + rounding) - std::bit_cast<std::int64_t>(rounding);
      }
    }
  }
};

MeshAmplitudes::MeshAmplitudes(std::vector<double const*> const& rows, Box const& box, std::array<int, 3> const& most,
                               int threads)
    : dimension_(box.dimension()) {
  for (int a = 0; a < dimension_; ++a) {
    auto const slot = static_cast<std::size_t>(slot_of(a, dimension_));
    most_[slot] = most[static_cast<std::size_t>(a)];
    nodes_[slot] = std::max(fewest_nodes, fast_even_length(4 * static_cast<std::size_t>(most_[slot])));
  }
  amplitudes_.resize(place(most_) + 1);
  bool const finite = std::all_of(rows.begin(), rows.end(), [&](double const* row) {
    return std::all_of(row, row + dimension_, [](double x) { return std::isfinite(x); });
  });
  if (!finite) {
    std::fill(amplitudes_.begin(), amplitudes_.end(), Complex(std::nan(""), std::nan("")));
    return;
  }
  Counts counts{nodes_, scale_for(rows.size())};
  for (double const shift : {0.0, 0.5}) {
    if (dimension_ == 1) counts.spread_all<1>(rows, box, shift, threads);
    if (dimension_ == 2) counts.spread_all<2>(rows, box, shift, threads);
    if (dimension_ == 3) counts.spread_all<3>(rows, box, shift, threads);
    transform(counts, shift, threads);
    counts.clear();
  }
}

std::size_t MeshAmplitudes::place(std::array<int, 3> const& n) const {
  std::size_t at = 0;
  for (std::size_t slot = 0; slot < 3; ++slot) {
    int const from = slot < 2 ? -most_[slot] : 0;
    at = at * static_cast<std::size_t>(most_[slot] - from + 1) + static_cast<std::size_t>(n[slot] - from);
  }
  return at;
}

namespace {

/// The index of wave n in a transform of that length.
std::size_t number_of(int n, std::size_t length) {
  return n < 0 ? length - static_cast<std::size_t>(-n) : static_cast<std::size_t>(n);
}

}  // namespace

/// Transformed along the last two axes: of each plane the rows of waves -most .. most, 0 .. most in each.
std::vector<MeshAmplitudes::Complex> MeshAmplitudes::in_planes(Counts const& counts, int threads) const {
  std::size_t const planes = nodes_[0], lines = nodes_[1], line = nodes_[2];
  std::size_t const kept = static_cast<std::size_t>(most_[2]) + 1, rows = 2 * static_cast<std::size_t>(most_[1]) + 1;
  LineTransform const along_z(FourierKind::real_to_complex, line);
  LineTransform along_y;
  if (lines > 1) along_y = LineTransform(FourierKind::complex_forward, lines, kept);
  std::vector<Complex> all(planes * rows * kept);
  for_ranges(planes, 1, threads, [&](std::size_t begin, std::size_t end) {
    FourierArray numbers(line), waves(2 * (line / 2 + 1)), plane(2 * lines * kept), turned(2 * lines * kept);
    for (std::size_t x = begin; x < end; ++x) {
      for (std::size_t y = 0; y < lines; ++y) {
        for (std::size_t z = 0; z < line; ++z) numbers[z] = counts.value(x, y, z);
        along_z.execute(numbers.data(), waves.data());
        std::copy_n(waves.data(), 2 * kept, plane.data() + 2 * y * kept);
      }
      if (along_y) along_y.execute(plane.data(), turned.data());
      double const* const from = along_y ? turned.data() : plane.data();
      for (int n = -most_[1]; n <= most_[1]; ++n)
        for (std::size_t k = 0; k < kept; ++k) {
          double const* const at = from + 2 * (number_of(n, lines) * kept + k);
          all[(x * rows + static_cast<std::size_t>(n + most_[1])) * kept + k] = {at[0], at[1]};
        }
    }
  });
  return all;
}

/// Adds half of the result of a mesh that is shifted by `shift` cells.
void MeshAmplitudes::transform(Counts const& counts, double shift, int threads) {
  std::size_t const planes = nodes_[0], lines = nodes_[1], line = nodes_[2];
  std::size_t const kept = static_cast<std::size_t>(most_[2]) + 1, rows = 2 * static_cast<std::size_t>(most_[1]) + 1;
  threads = threads_for(planes * lines * line, 1.0, threads);
  auto const waves = in_planes(counts, threads);
  LineTransform along_x;
  if (planes > 1) along_x = LineTransform(FourierKind::complex_forward, planes, kept);
  std::array<std::vector<Complex>, 3> factor;  // 1 over the spline's transform, times the phase of the shift
  for (std::size_t slot = 0; slot < 3; ++slot)
    for (int n = -most_[slot]; n <= most_[slot]; ++n) {
      double const turns = n / static_cast<double>(nodes_[slot]);
      factor[slot].push_back(
          std::polar(std::pow(sinc(std::numbers::pi * turns), -spline_order), 2 * std::numbers::pi * shift * turns));
    }
  auto const of = [&](std::size_t slot, int n) { return factor[slot][static_cast<std::size_t>(n + most_[slot])]; };
  for_ranges(rows, 1, threads, [&](std::size_t begin, std::size_t end) {
    FourierArray row_of_x(2 * planes * kept), turned(2 * planes * kept);
    for (std::size_t row = begin; row < end; ++row) {
      for (std::size_t x = 0; x < planes; ++x)
        for (std::size_t k = 0; k < kept; ++k) {
          Complex const one = waves[(x * rows + row) * kept + k];
          row_of_x[2 * (x * kept + k)] = one.real();
          row_of_x[2 * (x * kept + k) + 1] = one.imag();
        }
      if (along_x) along_x.execute(row_of_x.data(), turned.data());
      double const* const from = along_x ? turned.data() : row_of_x.data();
      int const y = static_cast<int>(row) - most_[1];
      for (int x = -most_[0]; x <= most_[0]; ++x)
        for (int z = 0; z <= most_[2]; ++z) {
          double const* const at = from + 2 * (number_of(x, planes) * kept + static_cast<std::size_t>(z));
          amplitudes_[place({x, y, z})] += 0.5 / counts.scale * of(0, x) * of(1, y) * of(2, z) * Complex(at[0], at[1]);
        }
    }
  });
}

std::array<int, 3> MeshAmplitudes::in_slots(std::array<int, 3> const& mode) const {
  std::array<int, 3> n{0, 0, 0};
  for (int a = 0; a < dimension_; ++a)
    n[static_cast<std::size_t>(slot_of(a, dimension_))] = mode[static_cast<std::size_t>(a)];
  return n;
}

std::complex<double> MeshAmplitudes::operator()(std::array<int, 3> const& mode) const {
  auto const n = in_slots(mode);
  return n[2] < 0 ? std::conj(amplitudes_[place({-n[0], -n[1], -n[2]})]) : amplitudes_[place(n)];
}

std::array<std::size_t, 3> MeshAmplitudes::nodes() const {
  std::array<std::size_t, 3> all{1, 1, 1};
  for (int a = 0; a < dimension_; ++a)
    all[static_cast<std::size_t>(a)] = nodes_[static_cast<std::size_t>(slot_of(a, dimension_))];
  return all;
}

double MeshAmplitudes::bound(std::array<int, 3> const& mode) const {
  constexpr int far = 8;  // images further away sum to less than 1e-8 of the nearest
  auto const n = in_slots(mode);
  std::array<std::array<double, 2 * far + 1>, 3> ratio{};
  for (std::size_t slot = 0; slot < 3; ++slot)
    for (int m = -far; m <= far; ++m)
      ratio[slot][static_cast<std::size_t>(m + far)] =
          m == 0 ? 1 : std::pow(std::abs(n[slot] / (n[slot] + m * static_cast<double>(nodes_[slot]))), spline_order);
  double sum = 0;
  for (int x = -far; x <= far; ++x)
    for (int y = -far; y <= far; ++y)
      for (int z = -far; z <= far; ++z)
        if ((x + y + z) % 2 == 0 && (x != 0 || y != 0 || z != 0))
          sum += ratio[0][static_cast<std::size_t>(x + far)] * ratio[1][static_cast<std::size_t>(y + far)] *
                 ratio[2][static_cast<std::size_t>(z + far)];
  return sum;
}

}  // namespace boltzmann
