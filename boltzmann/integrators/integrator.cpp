// Names of the methods.
#include <boltzmann/integrators/integrator.hpp>

#include <boltzmann/core/error.hpp>

#include <array>
#include <utility>

namespace boltzmann {
namespace {

constexpr std::array<std::pair<Method, char const*>, 7> names{{{Method::euler, "euler"},
                                                               {Method::leap_frog, "leap-frog"},
                                                               {Method::rk2, "rk2"},
                                                               {Method::rk4, "rk4"},
                                                               {Method::reversible_leap_frog, "reversible-leap-frog"},
                                                               {Method::random_walk, "random-walk"},
                                                               {Method::deactivate, "deactivate"}}};

}  // namespace

std::string to_string(Method method) {
  for (auto const& [value, name] : names)
    if (value == method) return name;
  return "?";
}

std::vector<std::string> method_names() {
  std::vector<std::string> all;
  for (auto const& entry : names) all.emplace_back(entry.second);
  return all;
}

Method method_named(std::string_view name) {
  for (auto const& [value, text] : names)
    if (name == text) return value;
  auto const all = method_names();
  throw Error("unknown integrator '" + std::string(name) + "'; there are " + join(all) + did_you_mean(name, all));
}

}  // namespace boltzmann
