// The table of atom styles, according to the page "read_data" of LAMMPS' manual.
#include <boltzmann/core/error.hpp>
#include <boltzmann/loaders/lammps_styles.hpp>
#include <boltzmann/loaders/text_lines.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace boltzmann {
namespace {

constexpr std::array styles{
    AtomStyle{"atomic", "id type x y z"},
    AtomStyle{"charge", "id type q x y z"},
    AtomStyle{"bond", "id mol type x y z"},
    AtomStyle{"angle", "id mol type x y z"},
    AtomStyle{"molecular", "id mol type x y z"},
    AtomStyle{"full", "id mol type q x y z"},
    AtomStyle{"sphere", "id type diameter density x y z", true},
    AtomStyle{"bpm/sphere", "id mol type diameter density x y z", true},
    AtomStyle{"dipole", "id type q x y z mux muy muz"},
};

}  // namespace

AtomStyle const* find_atom_style(std::string_view name) {
  for (auto const& style : styles)
    if (style.name == name) return &style;
  return nullptr;
}

std::vector<std::string> atom_style_names() {
  std::vector<std::string> names;
  for (auto const& style : styles) names.emplace_back(style.name);
  return names;
}

std::vector<std::string> atom_styles_of(std::size_t words) {
  std::vector<std::string> names;
  for (auto const& style : styles)
    if (auto const own = words_of(style.columns).size(); words == own || words == own + 3)
      names.emplace_back(style.name);
  return names.empty() ? atom_style_names() : names;
}

std::string unknown_style(std::string_view name) {
  auto const names = atom_style_names();
  return fmt::format("'{}' can't be read{}", quoted(name), choices(name, names, "those that can are"));
}

void sort_by_identifier(ParticleFrame& frame, std::vector<std::pair<std::int64_t, std::size_t>> order) {
  if (std::is_sorted(order.begin(), order.end())) return;
  std::sort(order.begin(), order.end());
  std::vector<std::string> species;
  for (auto const& [id, i] : order) species.push_back(frame.species[i]);
  frame.species = std::move(species);
  for (auto& column : frame.columns) {
    auto const n = static_cast<std::size_t>(column.components);
    std::vector<double> values;
    values.reserve(column.values.size());
    for (auto const& [id, i] : order)
      values.insert(values.end(), column.values.begin() + static_cast<std::ptrdiff_t>(i * n),
                    column.values.begin() + static_cast<std::ptrdiff_t>((i + 1) * n));
    column.values = std::move(values);
  }
}

}  // namespace boltzmann
