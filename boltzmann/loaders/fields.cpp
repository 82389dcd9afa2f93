// Sets fields, with checks of their values.
#include <boltzmann/core/error.hpp>
#include <boltzmann/loaders/fields.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace boltzmann {
namespace {

Field const& fitting_field(AnyEnsemble const& ensemble, std::string_view name, std::span<double const> value) {
  Field const& field = ensemble.field(name);
  if (static_cast<int>(value.size()) != field.components)
    throw Error(fmt::format("{} of ensemble '{}' has {} component{}, the value has {}", name, ensemble.name(),
                            field.components, field.components == 1 ? "" : "s", value.size()));
  for (double const x : value)
    if (!std::isfinite(x)) throw Error(fmt::format("{} of ensemble '{}' can't be {}", name, ensemble.name(), x));
  return field;
}

}  // namespace

void set_field(AnyEnsemble& ensemble, std::string_view field, std::span<double const> value) {
  int const offset = fitting_field(ensemble, field, value).offset;
  for (std::size_t i = 0; i < ensemble.size(); ++i) std::copy(value.begin(), value.end(), ensemble.row(i) + offset);
}

void set_field(AnyEnsemble& ensemble, std::string_view field, std::span<double const> value,
               std::span<std::uint32_t const> which) {
  int const offset = fitting_field(ensemble, field, value).offset;
  for (std::uint32_t const i : which)
    if (i >= ensemble.size())
      throw Error(fmt::format("ensemble '{}' has {} particles, numbered from 0; there is no particle {}",
                              ensemble.name(), ensemble.size(), i));
  for (std::uint32_t const i : which) std::copy(value.begin(), value.end(), ensemble.row(i) + offset);
}

void set_field(AnyEnsemble& ensemble, std::string_view field, double value) {
  set_field(ensemble, field, std::span<double const>(&value, 1));
}

void set_field(AnyEnsemble& ensemble, std::string_view field, double value, std::span<std::uint32_t const> which) {
  set_field(ensemble, field, std::span<double const>(&value, 1), which);
}

std::vector<std::uint32_t> edge_particles(AnyEnsemble const& ensemble, double margin) {
  if (!(margin >= 0)) throw Error(fmt::format("edge particles: the margin must not be negative, it is {}", margin));
  std::array<double, 3> low{}, high{};
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < ensemble.size(); ++i)
    for (int a = 0; a < ensemble.dimension(); ++a) {
      low[a] = std::min(low[a], ensemble.row(i)[a]);
      high[a] = std::max(high[a], ensemble.row(i)[a]);
    }
  std::vector<std::uint32_t> edge;
  for (std::size_t i = 0; i < ensemble.size(); ++i)
    for (int a = 0; a < ensemble.dimension(); ++a)
      if (ensemble.row(i)[a] - low[a] < margin || high[a] - ensemble.row(i)[a] < margin) {
        edge.push_back(static_cast<std::uint32_t>(i));
        break;
      }
  return edge;
}

}  // namespace boltzmann
