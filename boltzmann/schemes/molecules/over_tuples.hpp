// The traversal of tuples. Each lane is a tuple, and a block of them is processed together; each tuple writes the
// forces on its members into its own slots.
#pragma once

#include <boltzmann/laws/angular.hpp>
#include <boltzmann/schemes/molecules/tuple_geometry.hpp>
#include <boltzmann/schemes/molecules/tuple_task.hpp>
#include <boltzmann/schemes/pair/over_connections.hpp>

#include <concepts>

namespace boltzmann {

/// True if law(angle) accepts packs and returns an AngularEnergy.
template <class Law>
concept AngularLaw = requires(Law const& law, Pack<double> const& angle) {
  { law(angle) } -> std::same_as<AngularEnergy<Pack<double>>>;
};

namespace detail {

inline constexpr std::size_t block_tuples = 128;

/// The derivatives with respect to the angles of a block, and the energies.
template <int W, class Law>
class AngularBlock {
 public:
  using Real = Pack<double, W>;
  static constexpr std::size_t packs = block_tuples / W;

  explicit AngularBlock(Law const& law) : law_(law) {}
  void angle(std::size_t k, Real value) { angle_[k] = value; }
  template <bool measure>
  void run(std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      auto const result = law_(angle_[k]);
      slope_[k] = result.slope;
      if constexpr (measure) energy_[k] = result.energy;
    }
  }
  Real slope(std::size_t k) const { return slope_[k]; }
  Real energy(std::size_t k) const { return energy_[k]; }

 private:
  Law law_;
  Real angle_[packs], slope_[packs], energy_[packs];
};

/// The positions of a member of W tuples from `first` on. Past the end, the last tuple is repeated.
template <class Geometry, int W>
[[gnu::always_inline]] inline Vector<Geometry::dimension, Pack<double, W>> member_positions(TupleTask const& task,
                                                                                            std::size_t first,
                                                                                            std::size_t end,
                                                                                            int member) {
  Vector<Geometry::dimension, Pack<double, W>> x;
  for (std::size_t lane = 0; lane < W; ++lane) {
    std::size_t const tuple = first + lane < end ? first + lane : end - 1;
    double const* row = task.target + task.members[tuple * Geometry::members + member] * task.target_row_stride;
    for (int a = 0; a < Geometry::dimension; ++a) x[a].native[lane] = row[a];
  }
  return x;
}

/// Tuples are computed independently, so the result has the same bits for every division into ranges.
template <bool measure, int W, class Geometry, class Law>
void over_tuples(void const* the_law, TupleTask const& task, std::size_t begin, std::size_t end) {
  using Real = Pack<double, W>;
  constexpr int N = Geometry::members, D = Geometry::dimension;
  AngularBlock<W, Law> block(*static_cast<Law const*>(the_law));
  TupleAngle<N, D, Real> tuples[block_tuples / W];
  for (std::size_t from = begin; from < end; from += block_tuples) {
    std::size_t const to = end - from < block_tuples ? end : from + block_tuples, packs = (to - from + W - 1) / W;
    for (std::size_t k = 0; k < packs; ++k) {
      Vector<D, Real> steps[N - 1];
      auto here = member_positions<Geometry, W>(task, from + k * W, to, 0);
      for (int m = 1; m < N; ++m) {
        auto const next = member_positions<Geometry, W>(task, from + k * W, to, m);
        steps[m - 1] = next - here;
        if (task.sheared) nearest_layer(steps[m - 1], task);
        nearest_image(steps[m - 1], task);
        here = next;
      }
      tuples[k] = Geometry::at(steps);
      block.angle(k, tuples[k].angle);
    }
    block.template run<measure>(packs);
    for (std::size_t k = 0; k < packs; ++k) {
      std::size_t const first = from + k * W, lanes = to - first < W ? to - first : W;
      Real const torque = -block.slope(k);
      Real virial[D * D];
      for (auto& x : virial) x = Real(0.0);
      for (int m = 0; m < N; ++m) {
        Vector<D, Real> force = tuples[k].slope[m] * torque;
        if constexpr (measure) {
          for (int a = 0; a < D; ++a)
            for (int b = 0; b < D; ++b) virial[a * D + b] += tuples[k].arm[m][a] * force[b];
        } else {
          Real const rounding = task.rounding;
          for (int a = 0; a < D; ++a) force[a] = (force[a] + rounding) - rounding;
          for (std::size_t lane = 0; lane < lanes; ++lane)
            for (int a = 0; a < D; ++a)
              task.influence[task.slot[(first + lane) * N + m] * D + a] = force[a].native[lane];
        }
      }
      if constexpr (measure)
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          task.energy[first + lane] = block.energy(k).native[lane];
          for (int a = 0; a < D; ++a)
            for (int b = 0; b < D; ++b) task.virial[9 * (first + lane) + 3 * a + b] = virial[a * D + b].native[lane];
        }
    }
  }
}

}  // namespace detail

template <class Geometry, class Law, int W = native_width<double>>
constexpr TupleKernels tuple_kernels() {
  return {detail::over_tuples<false, W, Geometry, Law>, detail::over_tuples<true, W, Geometry, Law>};
}

}  // namespace boltzmann
