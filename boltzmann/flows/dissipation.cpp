// Names of conventions and methods, and what a dissipation may be.
#include <boltzmann/flows/dissipative_flow.hpp>

#include <boltzmann/core/error.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

namespace boltzmann {
namespace {

constexpr std::array<std::pair<Convention, char const*>, 4> conventions{
    {{Convention::fixed_temperature, "fixed-temperature"},
     {Convention::constant_noise, "constant-noise"},
     {Convention::constant_friction, "constant-friction"},
     {Convention::deterministic, "deterministic"}}};

constexpr std::array<std::pair<FlowMethod, char const*>, 2> methods{
    {{FlowMethod::order_free, "order-free"}, {FlowMethod::pair_splitting, "pair-splitting"}}};

template <class Table>
std::vector<std::string> names_of(Table const& table) {
  std::vector<std::string> all;
  for (auto const& entry : table) all.emplace_back(entry.second);
  return all;
}

template <class Table>
auto named(Table const& table, std::string_view name, char const* what) {
  for (auto const& [value, text] : table)
    if (name == text) return value;
  auto const all = names_of(table);
  throw Error(fmt::format("unknown {} '{}'; there are {}{}", what, name, join(all), did_you_mean(name, all)));
}

template <class Table, class Value>
std::string name_of(Table const& table, Value wanted) {
  for (auto const& [value, text] : table)
    if (value == wanted) return text;
  return "?";
}

}  // namespace

std::string to_string(Convention convention) { return name_of(conventions, convention); }
std::vector<std::string> convention_names() { return names_of(conventions); }
Convention convention_named(std::string_view name) { return named(conventions, name, "convention"); }
std::string to_string(FlowMethod method) { return name_of(methods, method); }
FlowMethod flow_method_named(std::string_view name) { return named(methods, name, "method of dissipation"); }

void Dissipation::check() const {
  auto const need = [](char const* name, double value, bool right, char const* allowed) {
    if (!std::isfinite(value) || !right)
      throw Error(fmt::format("dissipation: {} is {}, not {}", name, allowed, value));
  };
  need("friction", friction, friction >= 0, "zero or more");
  need("range", range, range > 0, "a positive length");
  need("exponent", exponent, exponent >= 0, "zero or more");
  need("conduction", conduction, conduction >= 0, "zero or more");
  if (convention == Convention::constant_friction) {
    if (temperature != 0)
      throw Error("dissipation: convention constant-friction knows no temperature but those of the particles");
  } else {
    need("temperature", temperature, temperature > 0, "positive for this convention");
  }
  if (convention == Convention::fixed_temperature && conduction > 0)
    throw Error("dissipation: at a fixed temperature there are no internal energies that could be conducted");
}

}  // namespace boltzmann
