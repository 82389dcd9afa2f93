// Parameters of laws and materials: each struct describes them once. Checks, scenarios, `bzm show` and the reference
// pages are made from that.
#pragma once

#include <boltzmann/core/dimension.hpp>
#include <boltzmann/core/number_range.hpp>

#include <limits>
#include <string_view>
#include <tuple>

namespace boltzmann {

/// A law as text, in the names of FormulaLaw: an energy if it has one, else an influence; empty: it can't be written as
/// text.
struct TypedLawText {
  std::string_view in[3];  ///< by dimension, from 1

  constexpr TypedLawText() = default;
  /// The same in all dimensions.
  constexpr explicit TypedLawText(std::string_view text) : in{text, text, text} {}
  constexpr TypedLawText(std::string_view in_1d, std::string_view in_2d, std::string_view in_3d)
      : in{in_1d, in_2d, in_3d} {}
};

/// The description of a shipped law: `static constexpr LawText text{...}` in its struct.
struct LawText {
  std::string_view name;     ///< the word in scenarios: "lennard-jones"
  std::string_view doc;      ///< one line
  std::string_view formula;  ///< the energy, or the influence where there is no energy
  std::string_view target;   ///< the base class of particles that are influenced
  std::string_view source;   ///< the base class of particles that influence; empty: an external law
  int least_dimension = 1, greatest_dimension = 3;
  bool has_energy = true;
  std::string_view in_programs = {};  ///< the expression in a program; empty: the struct's name
  TypedLawText typed = {};            ///< the same as a typed law
};

/// The description of a shipped material: `static constexpr MaterialText text{...}` in its struct.
struct MaterialText {
  std::string_view name;     ///< the word in scenarios: "ideal-gas"
  std::string_view doc;      ///< one line
  std::string_view formula;  ///< its equation of state
};

/// A dimension that may depend on that of the space, D: times length^(D by_space). Densities and pressures are by
/// volume (-1), which in 2D and 1D is an area and a length.
struct DimensionBySpace {
  Dimension dimension;
  int by_space = 0;

  constexpr DimensionBySpace(Dimension of, int power = 0) : dimension(of), by_space(power) {}
  constexpr Dimension in(int space) const { return dimension * pow(dimensions::length, by_space * space); }
};

/// The bases of units for which a default is valid.
enum class DefaultIn { all, those_with_units, reduced };

/// The allowed values of one number, or one vector, of a law or a material.
struct Parameter {
  std::string_view name;
  /// For laws the same in all dimensions: in 1D and 2D particles are sheets and rods of unit size.
  DimensionBySpace dimension;
  std::string_view doc;
  NumberRange range = any_number;
  std::string_view default_text = {};  ///< as in a scenario; empty: required, unless unlimited
  DefaultIn default_in = DefaultIn::all;
  bool unlimited = false;      ///< infinity is allowed, and is the default
  bool axial = false;          ///< of a vector: axial, in 2D one number, out of the plane
  bool vector = false;         ///< one number for each dimension of the space
  std::string_view also = {};  ///< another name for it in scenarios: "sigma" of r0; empty: none
  double also_times = 1;       ///< the parameter is the value of that name times this
};

/// The parameter with another name.
constexpr Parameter also(Parameter parameter, std::string_view word, double times = 1) {
  parameter.also = word;
  parameter.also_times = times;
  return parameter;
}

/// A parameter and the member of the struct for it. `static constexpr auto parameters()` returns a tuple of these.
template <class T, class Value>
struct ParameterOf {
  Value T::*member;
  Parameter parameter;
};
template <class T, class Value>
ParameterOf(Value T::*, Parameter) -> ParameterOf<T, Value>;

/// Throws Error, "morse: r0 = -1 must be positive", if the value is not finite or outside the range.
void check_parameter(std::string_view owner, std::string_view parameter, double value, NumberRange const& range);

namespace detail {
inline void check_value(std::string_view owner, Parameter const& parameter, double value) {
  if (parameter.unlimited && value == std::numeric_limits<double>::infinity()) return;
  check_parameter(owner, parameter.name, value, parameter.range);
}
template <class Vector>
void check_value(std::string_view owner, Parameter const& parameter, Vector const& value) {
  for (double const x : value.component) check_value(owner, parameter, x);
}
}  // namespace detail

/// "law": it has parameters, but no description.
template <class T>
constexpr std::string_view name_of_law() {
  if constexpr (requires { T::text; })
    return T::text.name;
  else
    return "law";
}

/// For a law or a material: throws Error at the first invalid parameter, and calls its own check(), if it has one.
template <class T>
void check_parameters(T const& law) {
  if constexpr (requires { T::parameters(); })
    std::apply([&](auto const&... of) { (detail::check_value(name_of_law<T>(), of.parameter, law.*of.member), ...); },
               T::parameters());
  if constexpr (requires { law.check(); }) law.check();
}

}  // namespace boltzmann
