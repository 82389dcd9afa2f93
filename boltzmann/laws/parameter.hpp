// Parameters of laws: what a law says of itself, once, in its struct. Its checks, scenarios, `bzm show` and the
// reference pages are made from that.
#pragma once

#include <boltzmann/core/dimension.hpp>
#include <boltzmann/core/number_range.hpp>

#include <string_view>
#include <tuple>

namespace boltzmann {

/// What a shipped law is: `static constexpr LawText text{...}` in its struct.
struct LawText {
  std::string_view name;     ///< the word in scenarios: "lennard-jones"
  std::string_view doc;      ///< one line
  std::string_view formula;  ///< the energy, or the influence where there is no energy
  std::string_view target;   ///< the least class of the particle that is influenced
  std::string_view source;   ///< the least class of the particle that influences; empty: it comes from outside
  int least_dimension = 1, greatest_dimension = 3;
  bool has_energy = true;
  std::string_view in_programs = {};  ///< what a program writes; empty: the struct's name
};

/// What one number of a law, or one vector, may be.
struct LawParameter {
  std::string_view name;
  Dimension dimension;  ///< the same in 1D, 2D and 3D: in fewer dimensions particles are sheets and rods of unit size
  std::string_view doc;
  NumberRange range = any_number;
  std::string_view default_text = {};  ///< as a scenario would write it; empty: required
  bool in_reduced_base = true;         ///< false: the default has units, so a base without units needs the value
  bool axial = false;                  ///< of a vector: that of a rotation, which in 2D is one number, out of the plane
  bool vector = false;                 ///< one number for each dimension of the space
};

/// A parameter and the member of the law that it is. `static constexpr auto parameters()` gives a tuple of these.
template <class Law, class Value>
struct LawMember {
  Value Law::*member;
  LawParameter parameter;
};
template <class Law, class Value>
LawMember(Value Law::*, LawParameter) -> LawMember<Law, Value>;

/// Throws Error, "morse: r0 = -1 must be positive", if the value is not finite or outside the range.
void check_parameter(std::string_view law, std::string_view parameter, double value, NumberRange const& range);

namespace detail {
inline void check_value(std::string_view law, LawParameter const& parameter, double value) {
  check_parameter(law, parameter.name, value, parameter.range);
}
template <class Vector>
void check_value(std::string_view law, LawParameter const& parameter, Vector const& value) {
  for (double const x : value.component) check_parameter(law, parameter.name, x, parameter.range);
}
}  // namespace detail

/// "law": it has parameters, but does not say what it is.
template <class Law>
constexpr std::string_view name_of_law() {
  if constexpr (requires { Law::text; })
    return Law::text.name;
  else
    return "law";
}

/// Throws Error at the first parameter that can't be, and as the law's own check() does, if it has one.
template <class Law>
void check_law(Law const& law) {
  if constexpr (requires { Law::parameters(); })
    std::apply([&](auto const&... of) { (detail::check_value(name_of_law<Law>(), of.parameter, law.*of.member), ...); },
               Law::parameters());
  if constexpr (requires { law.check(); }) law.check();
}

}  // namespace boltzmann
