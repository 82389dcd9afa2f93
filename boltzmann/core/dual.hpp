// Numbers with derivatives: a number that is computed from the separation r of two particles carries its gradient with
// respect to r (automatic differentiation, forward mode). Laws that are written as an energy use it:
// laws/by_energy.hpp.
//
// Most energies depend on r.r alone. So a derivative is one number along the separation. It has D further numbers only
// if a law uses components of r:
//   Radial       gradient = 2 slope r
//   Anisotropic  gradient = 2 slope r + rest
// Every operation is written once for both kinds and for plain numbers, whose derivative is the empty struct `Flat`.
#pragma once

#include <boltzmann/core/pack.hpp>
#include <boltzmann/core/vector.hpp>

#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace boltzmann {

/// The derivative of a plain number.
struct Flat {};

/// The derivative of a function of r.r: d/d(r.r).
template <class Real>
struct Radial {
  Real slope;
  static Radial zero() { return {Real(0.0)}; }
};

/// The derivative of any function of r: 2 slope r + rest.
template <int D, class Real>
struct Anisotropic {
  Real slope;
  Vector<D, Real> rest;

  Anisotropic() = default;
  Anisotropic(Real const& along, Vector<D, Real> const& other) : slope(along), rest(other) {}
  Anisotropic(Radial<Real> const& a) : slope(a.slope), rest(zero().rest) {}  // NOLINT: every radial one is one

  static Anisotropic zero() {
    Anisotropic d;
    d.slope = Real(0.0);
    for (int k = 0; k < D; ++k) d.rest[k] = Real(0.0);
    return d;
  }
};

// The operations on derivatives that the rules of differentiation need: sums, differences, multiples, and select().
namespace detail {

template <class Real>
Flat times(Real const&, Flat) {
  return {};
}
template <class Real>
Radial<Real> times(Real const& s, Radial<Real> const& a) {
  return {s * a.slope};
}
template <int D, class Real>
Anisotropic<D, Real> times(Real const& s, Anisotropic<D, Real> const& a) {
  return {s * a.slope, a.rest * s};
}

/// f applied to the numbers of two derivatives; the wider kind of the two comes out.
template <class Real, class Function>
Radial<Real> each(Radial<Real> const& a, Radial<Real> const& b, Function f) {
  return {f(a.slope, b.slope)};
}
template <int D, class Real, class Function>
Anisotropic<D, Real> each(Anisotropic<D, Real> const& a, Anisotropic<D, Real> const& b, Function f) {
  return {f(a.slope, b.slope), map(a.rest, b.rest, f)};
}
template <int D, class Real, class Function>
Anisotropic<D, Real> each(Radial<Real> const& a, Anisotropic<D, Real> const& b, Function f) {
  return each(Anisotropic<D, Real>(a), b, f);
}
template <int D, class Real, class Function>
Anisotropic<D, Real> each(Anisotropic<D, Real> const& a, Radial<Real> const& b, Function f) {
  return each(a, Anisotropic<D, Real>(b), f);
}

template <class A, class B>
auto plus(A const& a, B const& b) {
  if constexpr (std::is_same_v<A, Flat>)
    return b;
  else if constexpr (std::is_same_v<B, Flat>)
    return a;
  else
    return each(a, b, [](auto const& x, auto const& y) { return x + y; });
}
template <class A>
A negative(A const& a) {
  return each(a, a, [](auto const& x, auto const&) { return -x; });
}
inline Flat negative(Flat) { return {}; }
template <class A, class B>
auto minus(A const& a, B const& b) {
  if constexpr (std::is_same_v<A, Flat>)
    return negative(b);
  else if constexpr (std::is_same_v<B, Flat>)
    return a;
  else
    return each(a, b, [](auto const& x, auto const& y) { return x - y; });
}
template <class Condition, class A, class B>
auto choose(Condition const& condition, A const& a, B const& b) {
  if constexpr (std::is_same_v<A, Flat>)
    return choose(condition, B::zero(), b);
  else if constexpr (std::is_same_v<B, Flat>)
    return choose(condition, a, A::zero());
  else
    return each(a, b, [&](auto const& x, auto const& y) { return select(condition, x, y); });
}

}  // namespace detail

/// A number and how it changes with the separation of two particles. `Real` is double or a Pack.
template <class Real, class Derivative>
struct Dual {
  Real value;
  Derivative derivative;

  Dual() = default;
  Dual(Real const& v, Derivative const& d) : value(v), derivative(d) {}
  template <class Number>
  requires std::convertible_to<Number, Real> Dual(Number const& number)  // NOLINT: a number is one that doesn't change
      : value(number), derivative(Derivative::zero()) {}
  template <class Other>
  requires(!std::is_same_v<Other, Derivative> && std::convertible_to<Other, Derivative>)
      Dual(Dual<Real, Other> const& a)  // NOLINT: a radial number is one of any kind
      : value(a.value), derivative(a.derivative) {}

  Dual& operator+=(Dual const& b) { return *this = *this + b; }
  Dual& operator-=(Dual const& b) { return *this = *this - b; }
  Dual& operator*=(Dual const& b) { return *this = *this * b; }
  Dual& operator/=(Dual const& b) { return *this = *this / b; }
};
template <class Real, class Derivative>
Dual(Real, Derivative) -> Dual<Real, Derivative>;

namespace detail {

template <class T>
struct DualTraits {
  static constexpr bool is_dual = false;
};
template <class R, class Derivative>
struct DualTraits<Dual<R, Derivative>> {
  static constexpr bool is_dual = true;
  using Real = R;
};
template <class T>
concept AnyDual = DualTraits<T>::is_dual;

/// The plain number type of an operation on A and B, one of which is a Dual.
template <class A, class B, bool first = AnyDual<A>>
struct NumberOf {
  using type = typename DualTraits<A>::Real;
};
template <class A, class B>
struct NumberOf<A, B, false> {
  using type = typename DualTraits<B>::Real;
};
template <class A, class B>
using number_of = typename NumberOf<A, B>::type;

template <class A, class B>
concept DualOperands = (AnyDual<A> && AnyDual<B>) || (AnyDual<A> && std::convertible_to<B, number_of<A, B>>) ||
                       (AnyDual<B> && std::convertible_to<A, number_of<A, B>>);

template <class Real, class A>
Real value_of(A const& a) {
  if constexpr (AnyDual<A>)
    return a.value;
  else
    return Real(a);
}
template <class A>
auto derivative_of(A const& a) {
  if constexpr (AnyDual<A>)
    return a.derivative;
  else
    return Flat{};
}

/// f(x) by the chain rule.
template <class Real, class Derivative>
Dual<Real, Derivative> chain(Dual<Real, Derivative> const& x, Real const& value, Real const& slope) {
  return {value, times(slope, x.derivative)};
}

}  // namespace detail

// ---- arithmetic ----

template <class A, class B>
requires detail::DualOperands<A, B>
auto operator+(A const& a, B const& b) {
  using Real = detail::number_of<A, B>;
  return Dual{Real(detail::value_of<Real>(a) + detail::value_of<Real>(b)),
              detail::plus(detail::derivative_of(a), detail::derivative_of(b))};
}
template <class A, class B>
requires detail::DualOperands<A, B>
auto operator-(A const& a, B const& b) {
  using Real = detail::number_of<A, B>;
  return Dual{Real(detail::value_of<Real>(a) - detail::value_of<Real>(b)),
              detail::minus(detail::derivative_of(a), detail::derivative_of(b))};
}
template <class A, class B>
requires detail::DualOperands<A, B>
auto operator*(A const& a, B const& b) {
  using Real = detail::number_of<A, B>;
  Real const x = detail::value_of<Real>(a), y = detail::value_of<Real>(b);
  return Dual{Real(x * y),
              detail::plus(detail::times(y, detail::derivative_of(a)), detail::times(x, detail::derivative_of(b)))};
}
/// One division for value and derivative together.
template <class A, class B>
requires detail::DualOperands<A, B>
auto operator/(A const& a, B const& b) {
  using Real = detail::number_of<A, B>;
  if constexpr (!detail::AnyDual<B>) {
    return a * Real(1.0 / detail::value_of<Real>(b));
  } else {
    Real const inverse = 1.0 / b.value;
    Real const quotient = detail::value_of<Real>(a) * inverse;
    return Dual{quotient, detail::minus(detail::times(inverse, detail::derivative_of(a)),
                                        detail::times(Real(quotient * inverse), b.derivative))};
  }
}
template <class Real, class Derivative>
Dual<Real, Derivative> operator-(Dual<Real, Derivative> const& a) {
  return {-a.value, detail::negative(a.derivative)};
}
template <class Real, class Derivative>
Dual<Real, Derivative> operator+(Dual<Real, Derivative> const& a) {
  return a;
}

// ---- comparisons, of the values ----

template <class A, class B>
requires detail::DualOperands<A, B>
auto operator<(A const& a, B const& b) {
  using Real = detail::number_of<A, B>;
  return detail::value_of<Real>(a) < detail::value_of<Real>(b);
}
template <class A, class B>
requires detail::DualOperands<A, B>
auto operator<=(A const& a, B const& b) {
  using Real = detail::number_of<A, B>;
  return detail::value_of<Real>(a) <= detail::value_of<Real>(b);
}
template <class A, class B>
requires detail::DualOperands<A, B>
auto operator>(A const& a, B const& b) { return b < a; }
template <class A, class B>
requires detail::DualOperands<A, B>
auto operator>=(A const& a, B const& b) { return b <= a; }
template <class A, class B>
requires detail::DualOperands<A, B>
auto operator==(A const& a, B const& b) {
  using Real = detail::number_of<A, B>;
  return detail::value_of<Real>(a) == detail::value_of<Real>(b);
}
template <class A, class B>
requires detail::DualOperands<A, B>
auto operator!=(A const& a, B const& b) {
  using Real = detail::number_of<A, B>;
  return detail::value_of<Real>(a) != detail::value_of<Real>(b);
}

/// a where the condition holds, else b, with the derivative of the selected one.
template <class Condition, class A, class B>
requires detail::DualOperands<A, B>
auto select(Condition const& condition, A const& a, B const& b) {
  using Real = detail::number_of<A, B>;
  return Dual{Real(select(condition, detail::value_of<Real>(a), detail::value_of<Real>(b))),
              detail::choose(condition, detail::derivative_of(a), detail::derivative_of(b))};
}
template <class A, class B>
requires detail::DualOperands<A, B>
auto min(A const& a, B const& b) { return select(b < a, b, a); }
template <class A, class B>
requires detail::DualOperands<A, B>
auto max(A const& a, B const& b) { return select(a < b, b, a); }

// ---- functions ----

namespace detail {
inline constexpr double two_over_root_pi = 1.12837916709551257390;
}

template <class Real, class Derivative>
Dual<Real, Derivative> square(Dual<Real, Derivative> const& x) {
  return detail::chain(x, Real(x.value * x.value), Real(2.0 * x.value));
}
template <class Real, class Derivative>
Dual<Real, Derivative> cube(Dual<Real, Derivative> const& x) {
  Real const x2 = x.value * x.value;
  return detail::chain(x, Real(x2 * x.value), Real(3.0 * x2));
}
/// At zero, where sqrt has no slope, the slope is set to zero: the distance of two coincident particles has no
/// direction.
template <class Real, class Derivative>
Dual<Real, Derivative> sqrt(Dual<Real, Derivative> const& x) {
  Real const root = sqrt(x.value);
  return detail::chain(x, root, select(x.value == 0.0, Real(0.0), Real(0.5 / root)));
}
template <class Real, class Derivative>
Dual<Real, Derivative> rsqrt(Dual<Real, Derivative> const& x) {
  Real const y = rsqrt(x.value);
  return detail::chain(x, y, Real(-0.5 * y * (y * y)));
}
template <class Real, class Derivative>
Dual<Real, Derivative> reciprocal(Dual<Real, Derivative> const& x) {
  Real const y = reciprocal(x.value);
  return detail::chain(x, y, Real(-(y * y)));
}
template <class Real, class Derivative>
Dual<Real, Derivative> exp(Dual<Real, Derivative> const& x) {
  Real const y = exp(x.value);
  return detail::chain(x, y, y);
}
template <class Real, class Derivative>
Dual<Real, Derivative> expm1(Dual<Real, Derivative> const& x) {
  Real const y = expm1(x.value);
  return detail::chain(x, y, Real(y + 1.0));
}
template <class Real, class Derivative>
Dual<Real, Derivative> log(Dual<Real, Derivative> const& x) {
  return detail::chain(x, Real(log(x.value)), Real(1.0 / x.value));
}
template <class Real, class Derivative>
Dual<Real, Derivative> sin(Dual<Real, Derivative> const& x) {
  return detail::chain(x, Real(sin(x.value)), Real(cos(x.value)));
}
template <class Real, class Derivative>
Dual<Real, Derivative> cos(Dual<Real, Derivative> const& x) {
  return detail::chain(x, Real(cos(x.value)), Real(-sin(x.value)));
}
template <class Real, class Derivative>
Dual<Real, Derivative> tanh(Dual<Real, Derivative> const& x) {
  Real const y = tanh(x.value);
  return detail::chain(x, y, Real(1.0 - y * y));
}
template <class Real, class Derivative>
Dual<Real, Derivative> erf(Dual<Real, Derivative> const& x) {
  return detail::chain(x, Real(erf(x.value)), Real(detail::two_over_root_pi * exp(-(x.value * x.value))));
}
template <class Real, class Derivative>
Dual<Real, Derivative> erfc(Dual<Real, Derivative> const& x) {
  return detail::chain(x, Real(erfc(x.value)), Real(-detail::two_over_root_pi * exp(-(x.value * x.value))));
}
template <class Real, class Derivative>
Dual<Real, Derivative> exponential_integral(Dual<Real, Derivative> const& x) {
  return detail::chain(x, Real(exponential_integral(x.value)), Real(-exp(-x.value) / x.value));
}
/// At zero, where abs has no slope, the slope is set to zero, the mean of both sides.
template <class Real, class Derivative>
Dual<Real, Derivative> abs(Dual<Real, Derivative> const& x) {
  Real const sign = select(x.value < 0.0, Real(-1.0), select(x.value > 0.0, Real(1.0), Real(0.0)));
  return detail::chain(x, Real(abs(x.value)), sign);
}

/// x^y. An argument that is a plain number costs no derivative.
template <class A, class B>
requires detail::DualOperands<A, B>
auto pow(A const& a, B const& b) {
  using Real = detail::number_of<A, B>;
  Real const x = detail::value_of<Real>(a), y = detail::value_of<Real>(b), value = pow(x, y);
  auto const by_base = [&] {  // y x^(y-1), at zero too
    Real const zero = 0.0, one = 1.0;
    Real const at_zero =
        select(y == one, one, select(y > one, zero, select(y == zero, zero, Real(y * __builtin_inf()))));
    return Real(select(x == zero, at_zero, Real(y * value / x)));
  };
  if constexpr (!detail::AnyDual<B>)
    return Dual{value, detail::times(by_base(), a.derivative)};
  else if constexpr (!detail::AnyDual<A>)
    return Dual{value, detail::times(Real(value * log(x)), b.derivative)};
  else
    return Dual{
        value, detail::plus(detail::times(by_base(), a.derivative), detail::times(Real(value * log(x)), b.derivative))};
}

// ---- the separation, and vectors made of it ----

/// `factor` times the separation r of two particles. Its dot products with itself are radial; everything else made of
/// it (components, sums with other vectors) carries a whole gradient.
template <int D, class Real>
struct Displacement {
  static constexpr int dimension = D;
  using Component = Dual<Real, Anisotropic<D, Real>>;

  Vector<D, Real> r;
  Real factor;

  Component operator[](std::size_t k) const {
    auto derivative = Anisotropic<D, Real>::zero();
    derivative.rest[k] = factor;
    return {factor * r[k], derivative};
  }
};

namespace detail {

template <class T>
struct VectorTraits {
  static constexpr bool is_vector = false, has_derivative = false, is_displacement = false;
};
template <int D, class T>
struct VectorTraits<Vector<D, T>> {
  static constexpr bool is_vector = true, has_derivative = AnyDual<T>, is_displacement = false;
  using Component = T;
};
template <int D, class Real>
struct VectorTraits<Displacement<D, Real>> {
  static constexpr bool is_vector = true, has_derivative = true, is_displacement = true;
  using Component = typename Displacement<D, Real>::Component;
};

/// Pairs of vectors that vector.hpp does not combine, one of which has derivatives.
template <class A, class B>
concept VectorOperands = VectorTraits<A>::is_vector && VectorTraits<B>::is_vector &&
                         (VectorTraits<A>::has_derivative || VectorTraits<B>::has_derivative) &&
                         (VectorTraits<A>::is_displacement || VectorTraits<B>::is_displacement ||
                          !std::is_same_v<typename VectorTraits<A>::Component, typename VectorTraits<B>::Component>);

/// Any such vector as a vector of `Component`.
template <class Component, class A>
auto components_of(A const& a) {
  constexpr int D = A::dimension;
  Vector<D, Component> result;
  for (int k = 0; k < D; ++k) result[k] = a[k];
  return result;
}
template <class A, class B>
using common_component =
    decltype(std::declval<typename VectorTraits<A>::Component>() + std::declval<typename VectorTraits<B>::Component>());

template <class A, class B, class Function>
auto with_common_component(A const& a, B const& b, Function f) {
  using Component = common_component<A, B>;
  return f(components_of<Component>(a), components_of<Component>(b));
}

}  // namespace detail

template <class A, class B>
requires detail::VectorOperands<A, B>
auto operator+(A const& a, B const& b) {
  return detail::with_common_component(a, b, [](auto const& x, auto const& y) { return x + y; });
}
template <class A, class B>
requires detail::VectorOperands<A, B>
auto operator-(A const& a, B const& b) {
  return detail::with_common_component(a, b, [](auto const& x, auto const& y) { return x - y; });
}
template <class A, class B>
requires detail::VectorOperands<A, B>
auto operator*(A const& a, B const& b) {
  return detail::with_common_component(a, b, [](auto const& x, auto const& y) { return x * y; });
}
template <class A, class B>
requires detail::VectorOperands<A, B>
auto operator/(A const& a, B const& b) {
  return detail::with_common_component(a, b, [](auto const& x, auto const& y) { return x / y; });
}
template <class A, class B>
requires detail::VectorOperands<A, B>
auto dot(A const& a, B const& b) {
  return detail::with_common_component(a, b, [](auto const& x, auto const& y) { return dot(x, y); });
}
template <class A, class B>
requires detail::VectorOperands<A, B>
auto cross(A const& a, B const& b) {
  return detail::with_common_component(a, b, [](auto const& x, auto const& y) { return cross(x, y); });
}

template <int D, class Real>
Displacement<D, Real> operator+(Displacement<D, Real> const& a, Displacement<D, Real> const& b) {
  return {a.r, a.factor + b.factor};
}
template <int D, class Real>
Displacement<D, Real> operator-(Displacement<D, Real> const& a, Displacement<D, Real> const& b) {
  return {a.r, a.factor - b.factor};
}
template <int D, class Real>
Displacement<D, Real> operator-(Displacement<D, Real> const& a) {
  return {a.r, -a.factor};
}
template <int D, class Real>
Displacement<D, Real> operator*(Displacement<D, Real> const& a, std::type_identity_t<Real> const& s) {
  return {a.r, a.factor * s};
}
template <int D, class Real>
Displacement<D, Real> operator*(std::type_identity_t<Real> const& s, Displacement<D, Real> const& a) {
  return a * s;
}
template <int D, class Real>
Displacement<D, Real> operator/(Displacement<D, Real> const& a, std::type_identity_t<Real> const& s) {
  return {a.r, a.factor / s};
}

template <int D, class Real>
Dual<Real, Radial<Real>> dot(Displacement<D, Real> const& a, Displacement<D, Real> const& b) {
  Real const factor = a.factor * b.factor;
  return {factor * dot(a.r, a.r), {factor}};
}
/// The dot product with a constant vector.
template <int D, class Real, class Number>
requires std::convertible_to<Number, Real>
auto dot(Displacement<D, Real> const& a, Vector<D, Number> const& b) {
  auto const scaled = detail::components_of<Real>(b) * a.factor;
  return Dual{Real(dot(a.r, scaled)), Anisotropic<D, Real>{Real(0.0), scaled}};
}
template <int D, class Real, class Number>
requires std::convertible_to<Number, Real>
auto dot(Vector<D, Number> const& b, Displacement<D, Real> const& a) { return dot(a, b); }

template <int D, class Real>
Dual<Real, Radial<Real>> norm2(Displacement<D, Real> const& a) {
  return dot(a, a);
}
template <int D, class Real>
Dual<Real, Radial<Real>> magnitude(Displacement<D, Real> const& a) {
  return sqrt(dot(a, a));
}

// A Dual acts on every component of a vector; vector.hpp has the products of vectors of Duals.
namespace detail {
template <class A, class S>
concept ScaledByDual = AnyDual<S> && VectorTraits<A>::is_vector &&
    (VectorTraits<A>::is_displacement || !VectorTraits<A>::has_derivative ||
     !std::convertible_to<S, typename VectorTraits<A>::Component>);
template <class A, class S, class Function>
auto with_number(A const& a, S const& s, Function f) {
  using Component = decltype(std::declval<typename VectorTraits<A>::Component>() * s);
  return f(components_of<Component>(a), Component(s));
}
}  // namespace detail

template <class A, class S>
requires detail::ScaledByDual<A, S>
auto operator*(A const& a, S const& s) {
  return detail::with_number(a, s, [](auto const& x, auto const& y) { return x * y; });
}
template <class A, class S>
requires detail::ScaledByDual<A, S>
auto operator*(S const& s, A const& a) { return a * s; }
template <class A, class S>
requires detail::ScaledByDual<A, S>
auto operator/(A const& a, S const& s) {
  return detail::with_number(a, s, [](auto const& x, auto const& y) { return x / y; });
}

}  // namespace boltzmann
