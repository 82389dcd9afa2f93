// External influences: laws that act on single particles.
#pragma once

#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/particles/rows.hpp>
#include <boltzmann/schemes/pair/pair_kernels.hpp>
#include <boltzmann/schemes/rate_source.hpp>
#include <boltzmann/schemes/rotation.hpp>

#include <cstddef>
#include <cstdint>

namespace boltzmann {

struct ExternalTask {
  double const* rows = nullptr;
  std::size_t row_stride = 0;           ///< doubles from row to row
  std::uint32_t const* only = nullptr;  ///< the particles on which it acts; null: all
  double time = 0;
  double* influence = nullptr;
  double* energy = nullptr;  ///< measuring: energy of each particle in the field
  // For laws that give rates instead of an influence:
  RatePlaces rates, sums;  ///< layout of the results, and of the sums of particle 0
  std::size_t first = 0;   ///< the first particle of the results
  bool store = false;      ///< true: store; false: add
};

using ExternalKernel = void (*)(void const* law, ExternalTask const& task, std::size_t begin, std::size_t end);

struct ExternalKernels {
  ExternalKernel influence = nullptr, measure = nullptr;
  RotationKernel rotate = nullptr;  ///< for laws that only rotate velocities (see UniformMagneticField)
  bool has_energy = false;
  bool depends_on_time = false;
};

/// True if law(p) or law(p, time) can be called for this class.
template <class Law, class P>
concept ExternalLaw = requires(Law const& law, P const& p) {
  law(p);
}
|| requires(Law const& law, P const& p) { law(p, 0.0); };

namespace detail {

template <class P, class Law>
[[gnu::always_inline]] inline auto external_result(Law const& law, P const& p, double time) {
  if constexpr (requires { law(p, time); })
    return law(p, time);
  else
    return law(p);
}

template <Pass pass, int W, class P, class Law>
[[gnu::flatten]] void over_particles(void const* the_law, ExternalTask const& task, std::size_t begin,
                                     std::size_t end) {
  Held<Law> law = *static_cast<Law const*>(the_law);
  double const* const rows = task.rows;
  std::size_t const stride = stride_of<P, Law>(task.row_stride);
  constexpr std::size_t components = sizeof(typename P::Influence) / sizeof(double);
  for (std::size_t k = begin; k < end; ++k) {
    std::size_t const i = task.only ? task.only[k] : k;
    P const& p = particle_at<P>(rows + i * stride);
    auto const result = external_result(law, p, task.time);
    if constexpr (pass == Pass::measure) {
      if constexpr (has_energy<decltype(result)>) task.energy[i] += result.energy;
    } else {
      auto const influence = as_array<double>(influence_of(result));
      static_assert(
          std::tuple_size_v<decltype(influence)> == components,
          "the law returns something else than the influence that the particle class wants (see Particle::Influence)");
      for (std::size_t c = 0; c < components; ++c) task.influence[i * components + c] += influence[c];
    }
  }
}

/// Rotates each velocity by atan(Omega time). Two such rotations of half a step each are Boris' rotation by 2
/// atan(Omega dt/2), which has the exact drift in crossed fields.
template <int W, class P, class Law>
[[gnu::flatten]] void turn_particles(void const* the_law, RotationTask const& task, std::size_t begin,
                                     std::size_t end) {
  Held<Law> law = *static_cast<Law const*>(the_law);
  double* const rows = task.rows;
  std::size_t const stride = stride_of<P, Law>(task.row_stride);
  for (std::size_t k = begin; k < end; ++k) {
    P& p = particle_at<P>(rows + (task.only ? task.only[k] : k) * stride);
    p.velocity = turned(p.velocity, law.rotation(p) * task.time);
  }
}

template <int W, class P, class Law>
constexpr RotationKernel rotation_kernel() {
  if constexpr (requires(Law const& law, P const& p) { law.rotation(p); })
    return turn_particles<W, P, Law>;
  else
    return nullptr;
}

}  // namespace detail

template <class P, class Law, int W = native_width<double>>
constexpr ExternalKernels external_kernels() {
  using detail::Pass;
  using Result = decltype(detail::external_result(std::declval<Law const&>(), std::declval<P const&>(), 0.0));
  return {detail::over_particles<Pass::influence, W, P, Law>, detail::over_particles<Pass::measure, W, P, Law>,
          detail::rotation_kernel<W, P, Law>(), detail::has_energy<Result>,
          requires(Law const& law, P const& p){law(p, 0.0);
}
};  // namespace boltzmann
}

}  // namespace boltzmann
