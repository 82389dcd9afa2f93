// Kernels of dissipative pair flow.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/flows/flow_kernels.hpp>
#include <boltzmann/flows/flow_point.hpp>
#include <boltzmann/particles/rows.hpp>

namespace boltzmann {
namespace detail {

template <int W>
using Reals = Pack<double, W>;

/// chi = x^exponent, x = 1 - r / range; `x` is zero or more.
template <int W>
[[gnu::always_inline]] inline Reals<W> weight_of(Reals<W> x, PairNoise const& noise) {
  if (noise.twice_exponent < 0) return pow(max(x, Reals<W>(1e-300)), Reals<W>(noise.exponent));
  Reals<W> chi = (noise.twice_exponent & 1) ? sqrt(x) : Reals<W>(1.0);
  for (int k = noise.twice_exponent; k > 1; k -= 2) chi *= x;
  return chi;
}

/// Normals of a pair, which know its two particles, whichever is looked at first; and a sign that does not.
template <int W, int count>
struct PairNormals {
  Reals<W> normal[count + count % 2];
  Reals<W> sign;  ///< 1, or -1 if the two change places

  [[gnu::always_inline]] PairNormals(Reals<W> target, Reals<W> source, PairNoise const& noise) {
    // Numbers are whole: under this exponent they stand in the low bits.
    Bits<W> const i = bits_of<W>(target + 0x1p52), j = bits_of<W>(source + 0x1p52);
    Bits<W> const one = bits_of<W>(Reals<W>(1.0));
    Bits<W> low, high;
    if (noise.same) {
      Bits<W> const swapped = i > j;
      low = swapped ? j : i;
      high = swapped ? i : j;
      sign = from_bits<W>(one | (swapped & sign_bit));
    } else {
      low = noise.first ? i : j;
      high = noise.first ? j : i;
      sign = noise.first ? 1.0 : -1.0;
    }
    RandomWords<W> counter;
    counter.word[0] = (Words<W>)low;
    counter.word[1] = (Words<W>)high;
    counter.word[2] = Words<W>{} + noise.step;
    counter.word[3] = Words<W>{} + noise.tag;
    auto const words = philox4x32<W>(counter, noise.key);
    auto const first = normals<W>(words.word[0], words.word[1]);
    normal[0] = first[0];
    normal[1] = first[1];
    if constexpr (count > 2) {
      auto const second = normals<W>(words.word[2], words.word[3]);
      normal[2] = second[0];
      normal[3] = second[1];
    }
  }
};

/// What one particle gets from another: momentum, and the energy that both lose; what the first loses besides, and the
/// second gains.
template <int W, int D>
struct Exchange {
  Vector<D, Reals<W>> momentum;
  Reals<W> loss, transfer;
};

/// Friction gamma_ij dt and noise sigma_ij sqrt(dt) of a pair: Eq 4 of the source as VERIFICATION puts it right.
template <int W>
struct Strength {
  Reals<W> friction, noise;

  /// `square`: of the relative velocity; `directions`: in how many directions that is.
  [[gnu::always_inline]] Strength(PairNoise const& n, Reals<W> inverse_temperatures, Reals<W> curvatures,
                                  Reals<W> inverse_masses, Reals<W> product, Reals<W> square, double directions) {
    switch (n.convention) {
      case Convention::fixed_temperature:
        friction = n.friction;
        noise = std::sqrt(n.noise2);
        break;
      case Convention::constant_friction: {
        Reals<W> const mean = 0.5 * inverse_temperatures;  // k beta
        Reals<W> const root = rsqrt(mean), inverse = root * root;
        friction = n.friction * (1.0 + 0.25 * n.boltzmann_constant * curvatures * (inverse * inverse));
        noise = std::sqrt(n.noise2) * root;
        break;
      }
      case Convention::constant_noise:
        friction = (0.5 * n.friction * n.temperature) * inverse_temperatures;
        noise = std::sqrt(n.noise2);
        break;
      case Convention::deterministic: {
        // The pair's kinetic temperature, so weighted that the exchange is in balance for Maxwell's velocities.
        Reals<W> const outside = square / (inverse_masses * (n.boltzmann_constant * (directions + 2)));
        Reals<W> const inside = 0.5 * inverse_temperatures / product;
        friction = (n.friction / n.temperature) * (outside - inside);
        noise = 0.0;
        break;
      }
    }
  }
};

template <int W, int D, bool projected, bool conducts>
[[gnu::always_inline]] inline Exchange<W, D> exchange(FlowPoint<D, Reals<W>> const& p, FlowPoint<D, Reals<W>> const& q,
                                                      PairNoise const& noise, double asymmetry) {
  constexpr int directions = projected ? 1 : D;
  Vector<D, Reals<W>> const d = p.position - q.position;
  Reals<W> const r2 = norm2(d);
  Reals<W> const safe = max(r2, Reals<W>(1e-300));
  Reals<W> const inverse = rsqrt(safe);
  auto const near = r2 < noise.range2;
  Reals<W> const x = max(1.0 - safe * inverse * noise.inverse_range, Reals<W>(0.0));
  Reals<W> const chi = select(near, weight_of<W>(x, noise), Reals<W>(0.0)), chi2 = chi * chi;
  PairNormals<W, directions + (conducts ? 1 : 0)> const random(p.number, q.number, noise);
  Vector<D, Reals<W>> const v = p.velocity - q.velocity;
  Exchange<W, D> result;
  Reals<W> const inverse_masses = p.inverse_mass + q.inverse_mass;
  Reals<W> const inverse_temperatures = p.inverse_temperature + q.inverse_temperature;
  Reals<W> const product = p.inverse_temperature * q.inverse_temperature;
  if constexpr (projected) {
    Vector<D, Reals<W>> const e = d * inverse;
    Reals<W> const u = dot(v, e);
    Strength<W> const s(noise, inverse_temperatures, p.curvature + q.curvature, inverse_masses, product, u * u, 1);
    Reals<W> const push = s.noise * chi * random.normal[0] - s.friction * chi2 * u;
    result.momentum = e * push;
    result.loss = 0.5 * push * u;
    result.transfer = asymmetry * push * push * (q.inverse_mass - p.inverse_mass);
  } else {
    Strength<W> const s(noise, inverse_temperatures, p.curvature + q.curvature, inverse_masses, product, norm2(v), D);
    Reals<W> const amplitude = s.noise * chi * random.sign, drag = s.friction * chi2;
    for (int a = 0; a < D; ++a) result.momentum[a] = amplitude * random.normal[a] - drag * v[a];
    result.loss = 0.5 * dot(result.momentum, v);
    result.transfer = asymmetry * norm2(result.momentum) * (q.inverse_mass - p.inverse_mass);
  }
  if constexpr (conducts)
    result.transfer -= noise.conduction * chi2 * (p.inverse_temperature - q.inverse_temperature) +
                       noise.conduction_noise * chi * random.sign * random.normal[directions];
  return result;
}

/// Adds W rows of four numbers, given as columns, to where `row(lane)` points.
template <int W, class RowOf>
[[gnu::always_inline]] inline void scatter(RowOf row, Reals<W> const (&columns)[4]) {
  if constexpr (W == 8) {
    typedef double Octet __attribute__((vector_size(64)));
    Octet const a = columns[0].native, b = columns[1].native, c = columns[2].native, d = columns[3].native;
    Octet const ab0 = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
    Octet const ab1 = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
    Octet const cd0 = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14);
    Octet const cd1 = __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
    Octet const r04 = __builtin_shufflevector(ab0, cd0, 0, 1, 8, 9, 4, 5, 12, 13);
    Octet const r15 = __builtin_shufflevector(ab1, cd1, 0, 1, 8, 9, 4, 5, 12, 13);
    Octet const r26 = __builtin_shufflevector(ab0, cd0, 2, 3, 10, 11, 6, 7, 14, 15);
    Octet const r37 = __builtin_shufflevector(ab1, cd1, 2, 3, 10, 11, 6, 7, 14, 15);
    auto const add = [&](int lane, Quad value) { *reinterpret_cast<Quad*>(row(lane)) += value; };
    add(0, __builtin_shufflevector(r04, r04, 0, 1, 2, 3));
    add(1, __builtin_shufflevector(r15, r15, 0, 1, 2, 3));
    add(2, __builtin_shufflevector(r26, r26, 0, 1, 2, 3));
    add(3, __builtin_shufflevector(r37, r37, 0, 1, 2, 3));
    add(4, __builtin_shufflevector(r04, r04, 4, 5, 6, 7));
    add(5, __builtin_shufflevector(r15, r15, 4, 5, 6, 7));
    add(6, __builtin_shufflevector(r26, r26, 4, 5, 6, 7));
    add(7, __builtin_shufflevector(r37, r37, 4, 5, 6, 7));
  } else {
    for (int lane = 0; lane < W; ++lane)
      for (int c = 0; c < 4; ++c) row(lane)[c] += columns[c][lane];
  }
}

template <int W, int D, bool projected, bool conducts>
[[gnu::always_inline]] inline void order_free_rows(FlowTask const& task) {
  constexpr std::size_t stride = flow_point_stride(D), blocks = stride / 4;
  PairNoise const& noise = task.noise;
  double const* const source = task.source;
  std::size_t const count = task.end - task.begin;
  Reals<W> const zero = 0.0;
  for (std::size_t i = task.begin; i < task.end; ++i) {
    auto const p = broadcast<FlowPoint<D>, Reals<W>>(task.target + stride * i);
    Vector<D, Reals<W>> momentum;
    for (int a = 0; a < D; ++a) momentum[a] = zero;
    Reals<W> loss = zero;
    std::uint32_t const* j = task.row[i];
    for (std::uint32_t const* const last = j + task.length[i]; j < last; j += W) {
      auto const q = load_rows<FlowPoint<D>, W>([&](int lane) { return source + blocks * j[lane]; });
      auto const pair = exchange<W, D, projected, conducts>(p, q, noise, task.asymmetry);
      momentum += pair.momentum;
      loss += pair.loss + pair.transfer;
      if (!task.scatter) continue;
      Reals<W> columns[4] = {zero, zero, zero, zero};
      for (int a = 0; a < D; ++a) columns[a] = -pair.momentum[a];
      columns[D] = pair.loss - pair.transfer;
      scatter<W>(
          [&](int lane) {
            std::size_t const place = j[lane] / 4 - task.begin;
            return task.sums + 4 * (place < count ? place : count);
          },
          columns);
    }
    double* const sums = task.sums + 4 * (i - task.begin);
    for (int a = 0; a < D; ++a) sums[a] += sum(momentum[a]);
    sums[D] += sum(loss);
  }
}

template <int W, int D, bool projected>
[[gnu::flatten]] void order_free(FlowTask const& task) {
  if (task.noise.conduction > 0)
    order_free_rows<W, D, projected, true>(task);
  else
    order_free_rows<W, D, projected, false>(task);
}

template <int W, int D, bool projected>
[[gnu::flatten]] void geometry(GeometryTask const& task) {
  constexpr std::size_t stride = flow_point_stride(D);
  constexpr int directions = projected ? 1 : D;
  auto const store = [&](std::size_t column, std::size_t k, Reals<W> x) {
    *reinterpret_cast<typename Reals<W>::Native*>(task.columns + column * geometry_block + k) = x.native;
  };
  for (std::size_t k = 0; k < task.count; k += W) {
    auto const pair = [&](int lane) { return task.pairs[k + lane < task.count ? k + lane : task.count - 1]; };
    auto const p = load_rows<FlowPoint<D>, W>([&](int lane) { return task.first + stride * pair(lane).first; });
    auto const q = load_rows<FlowPoint<D>, W>([&](int lane) { return task.second + stride * pair(lane).seen; });
    Vector<D, Reals<W>> const d = p.position - q.position;
    Reals<W> const r2 = norm2(d), safe = max(r2, Reals<W>(1e-300)), inverse = rsqrt(safe);
    Reals<W> const x = max(1.0 - safe * inverse * task.noise.inverse_range, Reals<W>(0.0));
    store(0, k, select(r2 < task.noise.range2, weight_of<W>(x, task.noise), Reals<W>(0.0)));
    if constexpr (projected)
      for (int a = 0; a < D; ++a) store(1 + a, k, d[a] * inverse);
    PairNormals<W, directions + 1> const random(p.number, q.number, task.noise);
    for (int a = 0; a < directions; ++a) store(4 + a, k, projected ? random.normal[a] : random.normal[a] * random.sign);
    store(4 + directions, k, random.normal[directions] * random.sign);
  }
}

template <int W, int D, bool projected>
constexpr FlowKernels flow_kernels_of() {
  return {order_free<W, D, projected>, geometry<W, D, projected>};
}

template <InstructionSet set>
struct FlowTable {
  static constexpr int W = native_width<double>;
  static constexpr FlowKernelTable table{{{flow_kernels_of<W, 1, false>(), flow_kernels_of<W, 1, true>()},
                                          {flow_kernels_of<W, 2, false>(), flow_kernels_of<W, 2, true>()},
                                          {flow_kernels_of<W, 3, false>(), flow_kernels_of<W, 3, true>()}}};
};

}  // namespace detail

template <>
FlowKernelTable const& flow_kernels<this_set>() {
  return detail::FlowTable<this_set>::table;
}

}  // namespace boltzmann
