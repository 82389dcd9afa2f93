// Parameters of laws and materials by name: the connection between a scenario and the structs.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/core/vector.hpp>
#include <boltzmann/laws/parameter.hpp>

#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace boltzmann {

/// Values by name, in the simulation's units; a vector has one number per dimension.
using ParameterValues = std::vector<std::pair<std::string, std::vector<double>>>;

/// Throws Error for an unknown name.
std::vector<double> const& value_of(ParameterValues const& values, std::string_view name);

/// The documentation of parameters.
OptionTable options_of(std::vector<Parameter> const& parameters);

/// The parameters of a law or a material.
template <class T>
std::vector<Parameter> parameters_of() {
  std::vector<Parameter> all;
  auto const described = []<class Value>(ParameterOf<T, Value> const& of) {
    Parameter parameter = of.parameter;
    parameter.vector = !std::is_same_v<Value, double>;
    return parameter;
  };
  if constexpr (requires { T::parameters(); })
    std::apply([&](auto const&... of) { (all.push_back(described(of)), ...); }, T::parameters());
  return all;
}

namespace detail {
inline void give(std::vector<double> const& value, double& member) { member = value.front(); }
template <int D>
void give(std::vector<double> const& value, Vector<D>& member) {
  for (int a = 0; a < D; ++a) member[a] = value.at(static_cast<std::size_t>(a));
}
}  // namespace detail

/// Throws Error if one is missing.
template <class T>
void set_parameters(T& law, ParameterValues const& values) {
  if constexpr (requires { T::parameters(); })
    std::apply([&](auto const&... of) { (detail::give(value_of(values, of.parameter.name), law.*of.member), ...); },
               T::parameters());
}
template <class T>
T made_from(ParameterValues const& values) {
  T law{};
  set_parameters(law, values);
  return law;
}

}  // namespace boltzmann
