// The calculations on each smooth particle between the passes: its material, on rows of the user's own class.
#pragma once

#include <boltzmann/laws/material.hpp>
#include <boltzmann/particles/rows.hpp>
#include <boltzmann/schemes/smooth/passes.hpp>
#include <boltzmann/schemes/smooth/solid_passes.hpp>
#include <boltzmann/schemes/smooth/transport_passes.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>

namespace boltzmann {

/// Summary of the states of some particles.
struct Found {
  static constexpr std::size_t nobody = static_cast<std::size_t>(-1);
  std::size_t not_finite = nobody;  ///< the first particle whose state is not finite
  double sound_rate = 0;            ///< the largest sound speed / range
};

/// The particles of one ensemble among the sorted rows of all, as plain memory.
struct MaterialTask {
  double* particles = nullptr;             ///< rows of the ensemble
  double* influence = nullptr;             ///< of the ensemble
  std::uint32_t first = 0;                 ///< number of its first particle among all
  std::uint32_t const* order = nullptr;    ///< sorted row -> number of the particle among all
  std::uint32_t const* members = nullptr;  ///< the sorted rows of this ensemble; null: all
  double* fluid = nullptr;                 ///< SmoothFluid's block of sorted rows
  double* transport = nullptr;             ///< SmoothTransport's first block; null: no pass reads it
  double* matter = nullptr;                ///< SmoothMatter's first block; null: no pass reads it
  double* solid = nullptr;                 ///< SmoothSolid's first block; null: no hourglass control
  std::size_t block_stride = 0;            ///< stride of its blocks
  double const* density = nullptr;         ///< sums of the density pass; null: the density is the particle's own
  double const* gradients = nullptr;       ///< sums of the gradient pass
  double const* motion = nullptr;          ///< sums of the motion pass
  double const* rates = nullptr;           ///< sums of the rate pass, or of the transport pass
  double const* solid_sums = nullptr;      ///< of the passes of solids
  double* factor = nullptr;                ///< grad-h factor of each sorted row; null: all have one range
  bool adaptive = false;                   ///< ranges follow densities; else factors are 1
  double self = 0;                         ///< w(0) range^D
  Found* found = nullptr;                  ///< one for each range of members that begins at a multiple of the grain
  bool uniform = false;                    ///< rates consist of accelerations only
  bool continuity = false;                 ///< densities evolve
  bool balsara = false;
  double shortest = 0, longest = 0;  ///< limits of variable ranges
  double spacings = 0;               ///< range = spacings (mass / density)^(1/D) between them
  std::size_t particle_stride = 0;   ///< stride of the ensemble's rows
};

using MaterialKernel = void (*)(void const* material, MaterialTask const& task, std::size_t begin, std::size_t end);

/// The kernels of a material for a class.
struct MaterialKernels {
  MaterialKernel state = nullptr;      ///< computes density and state, into the particles and SmoothFluid's block
  MaterialKernel fluxes = nullptr;     ///< writes SmoothMatter's blocks, and rates of further fields into the influence
  MaterialKernel rates = nullptr;      ///< adds to the influence
  MaterialKernel motion = nullptr;     ///< writes the local motion into SmoothTransport's blocks
  MaterialKernel transport = nullptr;  ///< adds to the influence
  double (*diffusivity)(void const* material, double const* particle) = nullptr;      ///< null: none
  double (*shear_stiffness)(void const* material, double const* particle) = nullptr;  ///< null: none
  MaterialKernel cohesion = nullptr;     ///< writes SmoothSolid's first block
  MaterialKernel strain = nullptr;       ///< advances solids, adds to the influence
  MaterialKernel solid_force = nullptr;  ///< adds the forces of the passes of solids to the influence
  bool needs_gradients = false, has_transport = false, conducts = false, barotropic = false, constant_push = false;
  double push = 0;  ///< where it is constant
};

namespace detail {

inline constexpr std::size_t material_grain = 2048;  // particles of a range

template <class P, class Body>
[[gnu::always_inline]] inline void each_member(MaterialTask const& task, std::size_t begin, std::size_t end,
                                               Body const& body) {
  for (std::size_t n = begin; n < end; ++n) {
    std::size_t const k = task.members ? task.members[n] : n, i = task.order[k] - task.first;
    body(k, i, *reinterpret_cast<Row<P>*>(task.particles + i * task.particle_stride));
  }
}

template <int D>
double power(double x) {
  return D == 1 ? x : D == 2 ? x * x : x * x * x;
}

/// True if a particle's range is at one of its limits, and its density keeps it there: its range is then constant.
template <class P>
bool is_held(MaterialTask const& task, P const& p) {
  constexpr int D = P::dimension;
  double const wanted = power<D>(task.spacings) * p.mass / p.density;  // range^D
  return (p.range >= task.longest && wanted >= power<D>(task.longest)) ||
         (p.range <= task.shortest && wanted <= power<D>(task.shortest));
}

/// From the sums of the density pass, unless the density is a field of the particle.
template <class P>
void find_density(MaterialTask const& task, std::size_t k, P& p) {
  if (!task.density) return;
  double const self = p.mass * task.self / power<P::dimension>(p.range);
  if (task.factor)
    p.density = reinterpret_cast<VariableDensitySum<double> const*>(task.density)[k].density + self;
  else
    p.density = reinterpret_cast<DensitySum<double> const*>(task.density)[k].density + self;
}

template <class M, class P>
TransportCoefficients transport_of(M const& material, P const& p) {
  if constexpr (has_transport<M, P>)
    return material.transport(p);
  else
    return {};
}

/// The viscosity acting on relative velocities of pairs. In 1D there is no shear: half of the bulk viscosity acts on
/// expanding pairs.
template <int D>
double pair_viscosity(TransportCoefficients const& transport) {
  return D == 1 ? 0.5 * transport.bulk_viscosity : transport.shear_viscosity;
}

inline double resistance(double conductance) {
  return conductance > 1 / unlimited_resistance ? 1 / conductance : unlimited_resistance;
}

/// A tensor X with X . m = b, for a symmetric m without negative eigenvalues. Null directions of m are omitted, so that
/// products are also those of least squares there.
template <int D>
Tensor<D> solved(Tensor<D> b, Tensor<D> m) {
  constexpr double least = 1e-12;  // smaller pivots, relative to the trace, are rounding errors
  double const smallest = least * trace(m);
  int order[D], found = 0;
  bool used[D]{};
  for (; found < D; ++found) {
    int p = -1;
    for (int q = 0; q < D; ++q)
      if (!used[q] && m[q][q] > (p < 0 ? smallest : m[p][p])) p = q;
    if (p < 0) break;
    used[p] = true;
    order[found] = p;
    for (int q = 0; q < D; ++q) {
      if (used[q]) continue;
      double const factor = m[q][p] / m[p][p];
      for (int c = 0; c < D; ++c) m[q][c] -= factor * m[p][c];
      for (int a = 0; a < D; ++a) b[a][q] -= factor * b[a][p];
    }
  }
  Tensor<D> x{};
  for (int k = found; k-- > 0;)
    for (int a = 0; a < D; ++a) {
      int const p = order[k];
      double sum = b[a][p];
      for (int later = k + 1; later < found; ++later) sum -= m[p][order[later]] * x[a][order[later]];
      x[a][p] = sum / m[p][p];
    }
  return x;
}

/// The rotation W for which Sum w |v - W r|^2 is least.
template <int D>
Tensor<D> rotation_of(MotionSum<D, double> const& sums) {
  auto const turning = sums.flow - transpose(sums.flow);
  double const size = trace(sums.moments);
  if (D == 1 || !(size > 0)) return {};
  if constexpr (D == 3) {
    // The derivatives with respect to W_ab vanish: three equations. They are singular if all neighbours are on one
    // line, and then the rotation about it is zero.
    auto const& m = sums.moments;
    Tensor<3> const matrix{m[0][0] + m[1][1], m[1][2],  -m[0][2], m[1][2],          m[0][0] + m[2][2],
                           m[0][1],           -m[0][2], m[0][1],  m[1][1] + m[2][2]};
    auto const x = solved(Tensor<3>{turning[0][1], turning[0][2], turning[1][2], 0, 0, 0, 0, 0, 0}, matrix);
    return {0, x[0][0], x[0][1], -x[0][0], 0, x[0][2], -x[0][1], -x[0][2], 0};
  } else {
    return turning * (1 / size);
  }
}

template <class P, class M>
void find_state(void const* the_material, MaterialTask const& task, std::size_t begin, std::size_t end) {
  constexpr int D = P::dimension;
  M const& material = *static_cast<M const*>(the_material);
  Found& found = task.found[begin / material_grain];
  each_member<P>(task, begin, end, [&](std::size_t k, std::size_t i, P& p) {
    find_density(task, k, p);
    if (task.density && task.factor) {
      double const stretch = reinterpret_cast<VariableDensitySum<double> const*>(task.density)[k].stretch;
      task.factor[k] = task.adaptive && stretch < 0 && !is_held(task, p) ? -D * p.density / stretch : 1;
    }
    if constexpr (is_barotropic<M>) p.specific_energy = material.energy(p.density);
    State const state = material.state(p);
    p.pressure = state.pressure;
    p.temperature = state.temperature;
    p.sound_speed = state.sound_speed;
    if (!std::isfinite(state.pressure + state.sound_speed) && i < found.not_finite) found.not_finite = i;
    found.sound_rate = max(found.sound_rate, state.sound_speed / p.range);
    double* const fluid = task.fluid + row_block * k;
    fluid[0] = p.density;
    fluid[1] = state.pressure / (p.density * p.density) * (task.factor ? task.factor[k] : 1);
    fluid[2] = state.temperature;
    fluid[3] = state.sound_speed;
    if (task.transport) {
      TransportCoefficients const transport = transport_of(material, p);
      double* const values = task.transport + row_block * k;
      values[0] = p.mass / p.density;
      values[1] = resistance(pair_viscosity<D>(transport));
      values[2] = resistance(transport.conductivity);
    }
  });
}

/// Adds a force whose heat the scheme calculates.
template <class Influence, class Force>
void push(Influence& influence, Force const& force) {
  influence.force += force;
  if constexpr (requires { influence.inner_force; }) influence.inner_force += force;
}

/// From the sums of the motion pass to the input of the transport pass. With few neighbours (sprays), the normaliser is
/// at most twice that of a continuum, so that forces are zero at the edge of the range.
template <class P, class M>
void find_motion(void const* the_material, MaterialTask const& task, std::size_t begin, std::size_t end) {
  constexpr int D = P::dimension;
  M const& material = *static_cast<M const*>(the_material);
  each_member<P>(task, begin, end, [&](std::size_t k, std::size_t, P& p) {
    auto const& sums = reinterpret_cast<MotionSum<D, double> const*>(task.motion)[k];
    double* const block = task.transport + row_block * k;
    double const spread = max(sums.spread, 0.5 * D), normaliser = D / spread, expansion = normaliser * sums.approach;
    // The part of the pair viscosity that opposes isotropic expansion, at most what the pairs dissipate.
    double const in_pairs = sums.resistance > 0 ? 2.0 / D * spread / sums.resistance : 0;
    block[2] /= normaliser;
    block[3] = normaliser * (transport_of(material, p).bulk_viscosity - in_pairs) * expansion;
    // The gradient G for which Sum w |v - G r|^2 is least.
    auto const gradient = solved<D>(sums.flow, sums.moments);
    auto const motion = (rotation_of(sums) - gradient * (1 - rest_share)) * normaliser;
    block[task.block_stride] = normaliser * rest_share;
    for (std::size_t n = 1; n <= D * D; ++n)
      block[(1 + n / row_block) * task.block_stride + n % row_block] = motion[(n - 1) / D][(n - 1) % D];
  });
}

template <class P, class M>
void add_transport(void const*, MaterialTask const& task, std::size_t begin, std::size_t end) {
  constexpr int D = P::dimension;
  each_member<P>(task, begin, end, [&](std::size_t k, std::size_t i, P& p) {
    auto& influence = reinterpret_cast<typename P::Influence*>(task.influence)[i];
    auto const& sums = reinterpret_cast<TransportSum<D, double> const*>(task.rates)[k];
    double const volume = p.mass / p.density;
    if constexpr (is_barotropic<M>) {
      influence.force += sums.force * volume;
    } else {
      push(influence, sums.force * volume);
      influence.heating += sums.heating * volume;
    }
  });
}

/// Balsara's switch: |div v| / (|div v| + |curl v| + 1e-4 c/h).
template <int D>
double shear_switch(Tensor<D> const& gradient, double sound_speed, double range) {
  double curl2 = 0;
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < a; ++b) curl2 += square(gradient[a][b] - gradient[b][a]);
  double const div = std::abs(trace(gradient)), rest = std::sqrt(curl2) + 2e-4 * sound_speed / range;
  return div + rest > 0 ? div / (div + rest) : 1;
}

/// True if the material and the class have the data that the passes of solids need. In 1D there is no shear.
template <class M, class P>
inline constexpr bool is_solid = P::dimension > 1 &&
                                 requires(M const& material, P const& p, typename P::Influence& influence) {
  material.shear_stiffness(p);
  p.damage;
  p.hourglass_strain;
  influence.hourglass_rate;
};

template <class P, class M>
void find_cohesion(void const* the_material, MaterialTask const& task, std::size_t begin, std::size_t end) {
  [[maybe_unused]] M const& material = *static_cast<M const*>(the_material);
  each_member<P>(task, begin, end, [&](std::size_t k, std::size_t, P& p) {
    find_density(task, k, p);
    double* const block = task.solid + row_block * k;
    double const per_volume = p.density / p.mass;
    block[0] = P::dimension == 2 ? std::sqrt(per_volume) : std::cbrt(per_volume);
    block[1] = 0;
    if constexpr (is_solid<M, P>)
      if (material.shear_stiffness(p) > 0) block[1] = std::clamp(1 - p.damage, 0.0, 1.0);
    block[2] = p.mass / p.density;
    auto middle = p.velocity;
    if constexpr (is_solid<M, P>) middle -= p.kick;
    for (std::size_t a = 0; a < P::dimension; ++a)
      task.solid[(3 + a) / row_block * task.block_stride + row_block * k + (3 + a) % row_block] = middle[a];
  });
}

/// L of the correction: a bounded form of 1 / B. B^7 / (B^8 + e^8), normalised to 1 for B = 1, is at most 6.9. The
/// torque of the stress T on a particle is the antisymmetric part of B.L.T, so L.B must be close to 1 also at corners.
template <int D>
Tensor<D> correction_of(Tensor<D> const& spread) {
  constexpr double e8 = 1e-8;
  auto const square = dot(spread, spread), fourth = dot(square, square);
  return dot(dot(dot(fourth, square), spread), inverse(dot(fourth, fourth) + Tensor<D>::identity() * e8)) * (1 + e8);
}

/// The vector b for which Sum phi r (1 - b.r) = 0. If all neighbours lie on a line or in a plane, b is along it.
template <int D>
Vector<D> tilt_of(SolidSum<D, double> const& sums) {
  double const size = trace(sums.near_spread);
  if (!(size > 0)) return {};
  return dot(inverse(sums.near_spread / size + Tensor<D>::identity() * 1e-10), sums.offset / size);
}

/// The arrangement of the neighbours of a solid particle.
template <int D>
struct Surroundings {
  SolidSum<D, double> const& sums;
  Tensor<D> l;
  Vector<D> tilt;
  double scale;  ///< of hourglass control

  Surroundings(MaterialTask const& task, std::size_t k)
      : sums(reinterpret_cast<SolidSum<D, double> const*>(task.solid_sums)[k]),
        l(correction_of(sums.spread)),
        tilt(tilt_of(sums)),
        scale(HourglassStencil::scale<D> /
              max(sums.weight / (task.solid[row_block * k] * HourglassStencil::crowd<D>), 1.0)) {}
  Vector<D> hourglass_velocity() const { return (sums.velocity - dot(tilt, sums.near_gradient)) * scale; }
};

/// The strain-driven fields at a later time.
template <class P>
void advance(P& p, typename P::Influence const& rates, double time) {
  p.density += rates.density_rate * time;
  p.stress += rates.stress_rate * time;
  p.plastic_strain += rates.plastic_rate * time;
  p.damage += rates.damage_rate * time;
  p.hourglass_strain += rates.hourglass_rate * time;
}

template <class Influence>
void add(Influence& to, Influence const& more) {
  static_assert(std::is_trivially_copyable_v<Influence> && sizeof(Influence) % sizeof(double) == 0);
  auto* const sum = reinterpret_cast<double*>(&to);
  auto const* const x = reinterpret_cast<double const*>(&more);
  for (std::size_t c = 0; c < sizeof(Influence) / sizeof(double); ++c) sum[c] += x[c];
}

/// An estimate of the heating of a particle by strains of the given rates: V (G h . dh/dt - P : grad v).
template <class M, class P>
double strain_power(M const& material, P const& p, Gradients<P::dimension> const& gradients,
                    Vector<P::dimension> const& hourglass_velocity) {
  double sum = dot(p.hourglass_strain, hourglass_velocity) * material.shear_stiffness(p) -
               material.state(p).pressure * trace(gradients.velocity);
  if constexpr (has_fluxes<M, P>)
    sum -= contraction(transpose(material.fluxes(p, gradients).pressure), gradients.velocity);
  return sum * p.mass / p.density;
}

/// The rates of the strain-driven fields. Fields that lag are advanced with them by the midpoint rule: from the
/// velocities of the half step and the state in the middle.
template <class P, class M>
void find_strain(void const* the_material, MaterialTask const& task, std::size_t begin, std::size_t end) {
  if constexpr (is_solid<M, P>) {
    M const& material = *static_cast<M const*>(the_material);
    each_member<P>(task, begin, end, [&](std::size_t k, std::size_t i, P& p) {
      Surroundings<P::dimension> const around(task, k);
      auto const hourglass_velocity = around.hourglass_velocity();
      Gradients<P::dimension> gradients{dot(around.l, around.sums.gradient), {}};
      // Converts from the positions at the end of the step to those in the middle: x -> x - v lag / 2.
      gradients.velocity += dot(gradients.velocity, gradients.velocity) * (p.lag / 2);
      auto const rates_at = [&](P const& state) {
        typename P::Influence rates{};
        rates.hourglass_rate = hourglass_velocity;
        if (task.continuity) rates.density_rate = -state.density * trace(gradients.velocity);
        if constexpr (has_rates<M, P>) material.rates(state, gradients, rates);
        return rates;
      };
      auto rates = rates_at(p);
      if (p.lag != 0) {
        P middle = p;
        advance(middle, rates, p.lag / 2);
        rates = rates_at(middle);
        advance(p, rates, p.lag);
        double const heat = strain_power(material, middle, gradients, hourglass_velocity) * (p.lag / 2) / p.mass;
        p.specific_energy += heat;
        p.ahead += heat;
        p.lag = 0;
      }
      rates.is_completed = 1;
      add(reinterpret_cast<typename P::Influence*>(task.influence)[i], rates);
    });
  }
}

/// The input of the force pass of solids for a particle. The pressure is corrected only if the density evolves.
template <int D>
void write_strength(MaterialTask const& task, std::size_t k, Surroundings<D> const& around, Tensor<D> const& stress,
                    double pressure, double volume, Vector<D> const& hourglass_stress) {
  Tensor<D> corrected = stress;
  if (task.continuity) corrected += Tensor<D>::identity() * pressure;
  auto const correction = (dot(around.l, corrected) - corrected) * volume;
  double values[2 * D + D * D], *value = values;
  for (double const x : hourglass_stress.component) *value++ = x * volume * around.scale;
  for (double const x : around.tilt.component) *value++ = x;
  for (auto const& row : correction.component)
    for (double const x : row) *value++ = x;
  for (std::size_t c = 0; c < std::size(values); ++c)
    task.solid[(2 + c / row_block) * task.block_stride + row_block * k + c % row_block] = values[c];
}

/// Nothing for materials without strength.
template <int D>
void clear_strength(MaterialTask const& task, std::size_t k) {
  for (std::size_t c = 0; c < 2 * D + D * D; ++c)
    task.solid[(2 + c / row_block) * task.block_stride + row_block * k + c % row_block] = 0;
}

template <class P>
void add_solid_force(void const*, MaterialTask const& task, std::size_t begin, std::size_t end) {
  each_member<P>(task, begin, end, [&](std::size_t k, std::size_t i, P&) {
    auto const& found = reinterpret_cast<SolidForce<P::dimension, double> const*>(task.solid_sums)[k];
    auto& influence = reinterpret_cast<typename P::Influence*>(task.influence)[i];
    push(influence, found.force);
    influence.heating += found.heating;
  });
}

template <class P, class M>
void find_fluxes(void const* the_material, MaterialTask const& task, std::size_t begin, std::size_t end) {
  constexpr int D = P::dimension;
  [[maybe_unused]] M const& material = *static_cast<M const*>(the_material);
  each_member<P>(task, begin, end, [&](std::size_t k, std::size_t i, P& p) {
    Gradients<D> gradients{};
    if (task.gradients) {
      auto const& sums = reinterpret_cast<GradientSum<D, double> const*>(task.gradients)[k];
      gradients = {sums.velocity, sums.temperature};
    }
    double values[1 + D * (D + 1) / 2 + D] = {};
    values[0] = task.balsara ? shear_switch(gradients.velocity, p.sound_speed, p.range) : 1;
    auto const write = [&](Fluxes<D> const& fluxes) {
      double const by_density2 = (task.factor ? task.factor[k] : 1) / (p.density * p.density);
      double* value = values + 1;
      for (int a = 0; a < D; ++a)
        for (int b = a; b < D; ++b) *value++ = fluxes.pressure[a][b] * by_density2;
      for (int a = 0; a < D; ++a) *value++ = fluxes.heat[a] * by_density2;
    };
    [[maybe_unused]] auto& influence = reinterpret_cast<typename P::Influence*>(task.influence)[i];
    if constexpr (is_solid<M, P>) {
      Surroundings<D> const around(task, k);
      gradients.velocity = dot(around.l, around.sums.gradient);
      Fluxes<D> fluxes{};
      if constexpr (has_fluxes<M, P>) fluxes = material.fluxes(p, gradients);
      write(fluxes);
      write_strength<D>(task, k, around, fluxes.pressure, p.pressure, p.mass / p.density,
                        p.hourglass_strain * material.shear_stiffness(p));
    } else {
      if constexpr (has_fluxes<M, P>) write(material.fluxes(p, gradients));
      if constexpr (has_rates<M, P>) material.rates(static_cast<P const&>(p), gradients, influence);
      if (task.solid) clear_strength<D>(task, k);
    }
    for (std::size_t c = 0; c < std::size(values); ++c)
      task.matter[c / row_block * task.block_stride + row_block * k + c % row_block] = values[c];
  });
}

template <class P, class M>
void add_rates(void const*, MaterialTask const& task, std::size_t begin, std::size_t end) {
  constexpr int D = P::dimension;
  each_member<P>(task, begin, end, [&](std::size_t k, std::size_t i, P& p) {
    auto& influence = reinterpret_cast<typename P::Influence*>(task.influence)[i];
    if (task.uniform) {
      influence.force += reinterpret_cast<Vector<D> const*>(task.rates)[k] * p.mass;
      return;
    }
    auto const& rates = reinterpret_cast<RateSum<D, double> const*>(task.rates)[k];
    if constexpr (is_barotropic<M>) {
      influence.force += rates.acceleration * p.mass;
    } else {
      push(influence, rates.acceleration * p.mass);
      influence.heating += rates.heating * p.mass;
    }
    if constexpr (!is_solid<M, P>)
      if (task.continuity) influence.density_rate += rates.compression;
    if (task.adaptive) {
      if (!is_held(task, p)) influence.range_rate -= p.range / (D * p.density) * task.factor[k] * rates.compression;
    }
  });
}

}  // namespace detail

template <class P, class M>
MaterialKernels material_kernels(M const& material) {
  MaterialKernels kernels;
  kernels.state = detail::find_state<P, M>;
  kernels.fluxes = detail::find_fluxes<P, M>;
  kernels.rates = detail::add_rates<P, M>;
  kernels.motion = detail::find_motion<P, M>;
  kernels.transport = detail::add_transport<P, M>;
  kernels.has_transport = kernels.conducts = has_transport<M, P>;
  if constexpr (requires { material.conducts(); }) kernels.conducts = material.conducts();
  if constexpr (requires(P const& p) { material.diffusivity(p); })
    kernels.diffusivity = [](void const* m, double const* particle) {
      return static_cast<M const*>(m)->diffusivity(static_cast<P const&>(*reinterpret_cast<Row<P> const*>(particle)));
    };
  if constexpr (P::dimension > 1) {
    kernels.cohesion = detail::find_cohesion<P, M>;
    kernels.strain = detail::find_strain<P, M>;
    kernels.solid_force = detail::add_solid_force<P>;
  }
  if constexpr (detail::is_solid<M, P>)
    kernels.shear_stiffness = [](void const* m, double const* particle) {
      return static_cast<M const*>(m)->shear_stiffness(
          static_cast<P const&>(*reinterpret_cast<Row<P> const*>(particle)));
    };
  kernels.barotropic = is_barotropic<M>;
  kernels.needs_gradients = has_fluxes<M, P> || has_rates<M, P> || detail::is_solid<M, P>;
  if constexpr (has_constant_push<M> && is_barotropic<M>) {
    kernels.constant_push = true;
    kernels.push = material.pressure_by_density2();
  }
  return kernels;
}

}  // namespace boltzmann
