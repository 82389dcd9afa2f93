// The passes of SPAM over pairs of particles: density, gradients, rates (steps 2, 3 and 5 of its recipe). Each is a
// law: the contribution of q to p. With slope = w'(r)/r and r = q - p, grad_p w = -slope r.
#pragma once

#include <boltzmann/laws/weight.hpp>
#include <boltzmann/schemes/smooth/smooth_point.hpp>

namespace boltzmann {

/// Parameters of the passes besides the particles.
struct PassParameters {
  double range = 0;  ///< of all particles, if it is common
  double push = 0;   ///< P / rho^2, if it is the same for all
  /// The shares of a particle's pressure work on a pair that heat the particle itself and the other one. Half each in
  /// Eq 14; all and nothing keep each particle on its isentrope.
  double own_share = 0.5, other_share = 0.5;
  double alpha = 0, beta = 0;  ///< artificial viscosity (Monaghan 1992)
  double by_volume = 0;        ///< 1: all rates weight neighbours by their volume
};

template <class Real>
struct DensitySum {
  Real density;  ///< Eq 8 without the particle itself
};
template <class Real>
struct VariableDensitySum {
  Real density;
  Real stretch;  ///< Sum m r w'(r): dependence of the density on the range, d rho / d ln(range) = -(D rho + stretch)
};
template <int D, class Real>
struct GradientSum {
  Tensor<D, Real> velocity;  ///< [a][b] = d v_b / d x_a
  Vector<D, Real> temperature;
};
template <int D, class Real>
struct AccelerationSum {
  Vector<D, Real> acceleration;
};
template <int D, class Real>
struct RateSum {
  Vector<D, Real> acceleration;
  Real heating;      ///< de/dt
  Real compression;  ///< d rho / dt
};
// For compilers without deduction for aggregates.
template <class Real>
DensitySum(Real) -> DensitySum<Real>;
template <class Real>
VariableDensitySum(Real, Real) -> VariableDensitySum<Real>;
template <int D, class Real>
GradientSum(Tensor<D, Real>, Vector<D, Real>) -> GradientSum<D, Real>;
template <int D, class Real>
AccelerationSum(Vector<D, Real>) -> AccelerationSum<D, Real>;
template <int D, class Real>
RateSum(Vector<D, Real>, Real, Real) -> RateSum<D, Real>;

namespace detail {

/// The weight factors of a pair: by each particle's own range, or by the common range.
template <class Shape, bool variable, class P>
[[gnu::always_inline]] inline auto weigh_by(P const& p, decltype(P::range) const& r2,
                                            PassParameters const& parameters) {
  using Real = std::remove_cvref_t<decltype(r2)>;
  if constexpr (variable)
    return weigh<Shape, P::dimension>(r2, p.range, Real(1.0 / p.range));
  else
    return weigh<Shape, P::dimension>(r2, Real(parameters.range), Real(1.0 / parameters.range));
}

}  // namespace detail

/// Eq 8.
template <class Shape, bool variable>
struct DensityPass {
  PassParameters parameters;

  template <class P>
  auto operator()(P const& p, P const& q) const {
    auto const r = q.position - p.position;
    auto const r2 = dot(r, r);
    auto const w = detail::weigh_by<Shape, variable>(p, r2, parameters);
    if constexpr (variable)
      return VariableDensitySum{q.mass * w.value, q.mass * r2 * w.slope};
    else
      return DensitySum{q.mass * w.value};
  }
};

/// Eq 18, 19 with the mean density of Eq 17.
template <class Shape, bool variable, bool geometric>
struct GradientPass {
  PassParameters parameters;

  template <class P>
  auto operator()(P const& p, P const& q) const {
    auto const r = q.position - p.position;
    auto const w = detail::weigh_by<Shape, variable>(p, dot(r, r), parameters);
    auto const by_density = [&] {
      if constexpr (geometric)
        return rsqrt(p.density * q.density);
      else
        return 2.0 / (p.density + q.density);
    }();
    auto const gradient = r * (-q.mass * w.slope * by_density);
    return GradientSum{outer(gradient, q.velocity - p.velocity), gradient * (q.temperature - p.temperature)};
  }
};

/// Eq 13 if P / rho^2 is the same for all (Eq 20).
template <class Shape>
struct UniformPass {
  PassParameters parameters;

  template <class P>
  auto operator()(P const& p, P const& q) const {
    auto const r = q.position - p.position;
    auto const w = detail::weigh_by<Shape, false>(p, dot(r, r), parameters);
    return AccelerationSum{r * (2.0 * parameters.push * q.mass * w.slope)};
  }
};

/// The terms of rates: pressure only, with artificial viscosity, or all.
enum class RateTerms { pressure, viscous, all };

/// Eq 13, 14 and the continuity equation, with the grad-h factors of variable ranges inside push, stress and heat.
/// Artificial viscosity: Pi = (-alpha c mu + beta mu^2) / rho with means of both particles, mu = h v.r / (r^2 +
/// h^2/100) for approaching pairs, h the smoothing length (Monaghan 1992).
///
/// With `volumes` neighbours are weighted by volume: d rho_i / dt = rho_i Sum (m_j / rho_j) (v_i - v_j).grad w, and
/// P_i / (rho_i rho_j) in place of P_i / rho_i^2 in Eq 13, 14, which conserves energy with it.
template <class Shape, bool variable, RateTerms terms, bool volumes = false>
struct RatePass {
  PassParameters parameters;

  template <class P>
  auto operator()(P const& p, P const& q) const {
    using Real = std::remove_cvref_t<decltype(p.mass)>;
    auto const r = q.position - p.position, v = q.velocity - p.velocity;
    auto const r2 = dot(r, r), approach = dot(v, r);
    Real const slope_p = detail::weigh_by<Shape, variable>(p, r2, parameters).slope;
    Real slope_q = slope_p;
    if constexpr (variable) slope_q = detail::weigh_by<Shape, variable>(q, r2, parameters).slope;
    auto from_p = r * (slope_p * p.push), from_q = r * (slope_q * q.push);
    Real heat = 0.0;
    if constexpr (terms == RateTerms::all) {
      from_p += stress_times(p.stress, r) * slope_p;
      from_q += stress_times(q.stress, r) * slope_q;
      heat = dot(p.heat, r) * slope_p + dot(q.heat, r) * slope_q;
    }
    Real compression = slope_p * approach;
    if constexpr (volumes) {
      Real const ratio = p.density / q.density, inverse = q.density / p.density;
      from_p *= ratio;
      from_q *= inverse;
      compression *= ratio;
    }
    auto push = from_p + from_q;
    Real work = parameters.own_share * dot(from_p, v) + parameters.other_share * dot(from_q, v);
    if constexpr (terms != RateTerms::pressure) {
      Real h = Shape::smoothing_length * parameters.range;
      if constexpr (variable) h = 0.5 * Shape::smoothing_length * (p.range + q.range);
      Real const mu = h * min(approach, Real(0.0)) / (r2 + 0.01 * h * h);
      Real switched = 1.0;
      if constexpr (terms == RateTerms::all) switched = 0.5 * (p.shear_switch + q.shear_switch);
      Real const viscosity = switched * mu *
                             (parameters.beta * mu - parameters.alpha * 0.5 * (p.sound_speed + q.sound_speed)) * 2.0 /
                             (p.density + q.density);
      Real const drag = viscosity * 0.5 * (slope_p + slope_q);
      push += r * drag;
      work += 0.5 * drag * approach;
    }
    return RateSum{push * q.mass, q.mass * (work + heat), q.mass * compression};
  }
};

}  // namespace boltzmann
