// Loads columns of a file into fields of ensembles, with checks.
#include <boltzmann/core/elements.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/loaders/particle_frame.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace boltzmann {
namespace {

/// A unit of the file in the simulation's. Error if its dimension is wrong.
double factor_of(std::string const& column, std::string const& unit, Dimension dimension, FrameOptions const& options) {
  if (dimension == dimensions::length && options.length) return *options.length;
  if (dimension == dimensions::velocity && options.velocity) return *options.velocity;
  if (unit.empty() || options.units.is_reduced()) return 1;
  if (auto const own = options.units.display(dimension); own.unit == unit && own.factor == 1) return 1;
  bool const is_number = (unit[0] >= '0' && unit[0] <= '9' && !unit.starts_with("1/")) || unit[0] == '.';
  auto const quantity = parse_quantity(is_number ? unit : "1 " + unit);
  if (quantity.dimension != dimension)
    throw Error(fmt::format("the file's {} is in {}, {} is needed", boltzmann::quoted(column), boltzmann::quoted(unit),
                            with_article(name_of(dimension))));
  return options.units.from_si(quantity.si, dimension);
}

/// The words that match a species: its own, and the types of which it is the label.
std::set<std::string> meanings(ParticleFrame const& frame, std::string const& species) {
  std::set<std::string> words{species};
  for (auto const& [label, type] : frame.labels)
    if (label == species) words.insert(type);
  return words;
}

std::vector<std::size_t> of_species(ParticleFrame const& frame, std::string const& species) {
  auto const words = meanings(frame, species);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < frame.size(); ++i)
    if (species.empty() || words.contains(frame.species[i])) chosen.push_back(i);
  return chosen;
}

/// The field for a column; null if none matches.
Field const* field_for(AnyEnsemble const& ensemble, FileColumn const& column) {
  Field const* field = ensemble.find_field(column.name);
  if (field == nullptr) return nullptr;
  bool const spatial = column.components == 3 && field->components == ensemble.dimension();
  return column.components == field->components || spatial ? field : nullptr;
}

void fill(AnyEnsemble& ensemble, Field const& field, FileColumn const& column, std::vector<std::size_t> const& chosen,
          double unit) {
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    double const* values = column.values.data() + chosen[k] * static_cast<std::size_t>(column.components);
    for (int c = 0; c < field.components; ++c) ensemble.row(k)[field.offset + c] = unit * values[c];
    for (int c = field.components; c < column.components; ++c)
      if (values[c] != 0)
        throw Error(
            fmt::format("particle {} of the file has {} in component {} of its {}; ensemble '{}' has {} "
                        "dimension{}, where it must be 0",
                        chosen[k], values[c], "xyz"[c], column.name, ensemble.name(), ensemble.dimension(),
                        ensemble.dimension() == 1 ? "" : "s"));
  }
}

}  // namespace

FileColumn const* ParticleFrame::find(std::string_view name) const {
  for (auto const& column : columns)
    if (column.name == name) return &column;
  return nullptr;
}

std::vector<std::string> left_aside(AnyEnsemble const& ensemble, ParticleFrame const& frame,
                                    std::vector<std::string> const& given) {
  std::vector<std::string> unread, replaced, all;
  for (auto const& column : frame.columns) {
    bool const empty = std::all_of(column.values.begin(), column.values.end(), [](double value) { return value == 0; });
    if (column.used || empty) continue;
    Field const* field = ensemble.find_field(column.name);
    if (field_for(ensemble, column) == nullptr)
      unread.push_back(
          field ? fmt::format("{} ({} numbers, the field has {})", column.name, column.components, field->components)
                : column.name);
    else if (std::find(given.begin(), given.end(), column.name) != given.end())
      replaced.push_back(column.name);
  }
  if (!replaced.empty()) all.push_back(join(replaced) + " (the scenario gives other values)");
  if (!unread.empty()) all.push_back(fmt::format("{} (a class with fields of these names gets them)", join(unread)));
  all.insert(all.end(), frame.left_aside.begin(), frame.left_aside.end());
  return all;
}

std::vector<double> element_masses(ParticleFrame const& frame, std::string const& species, UnitSystem const& units) {
  std::vector<double> masses;
  if (!frame.elements) return masses;
  std::map<std::string_view, std::optional<double>> known;
  for (auto const i : of_species(frame, species)) {
    auto const [entry, is_new] = known.try_emplace(frame.species[i]);
    if (is_new) {
      bool const number = frame.species[i].find_first_not_of("0123456789") == std::string::npos;
      if (!number || frame.labels.empty()) entry->second = element_mass(frame.species[i], units);
      for (auto const& [label, type] : frame.labels)  // a type's number is not an atomic number
        if (type == frame.species[i] && !entry->second) entry->second = element_mass(label, units);
    }
    if (!entry->second) return {};
    masses.push_back(*entry->second);
  }
  return masses;
}

std::string lattice_misfit(ParticleFrame const& frame, Box const& box, FrameOptions const& options) {
  if (!frame.lattice) return "";
  auto const* position = frame.find("position");
  double const unit = factor_of("lattice", position ? position->unit : "", dimensions::length, options);
  auto const& units = options.units;
  for (int a = 0; a < box.dimension(); ++a) {
    if (!box.periodic(a) || !frame.periodic[static_cast<std::size_t>(a)]) continue;
    double const edge = unit * (*frame.lattice)[static_cast<std::size_t>(4 * a)], wanted = box.length(a);
    for (int b = 0; b < 3; ++b)
      if (b != a && ((*frame.lattice)[static_cast<std::size_t>(3 * a + b)] != 0 ||
                     (*frame.lattice)[static_cast<std::size_t>(3 * b + a)] != 0))
        return fmt::format("the file's lattice is skew along {}; a periodic box has right angles", "xyz"[a]);
    if (!(std::abs(edge - wanted) <= 1e-6 * wanted + unit * frame.rounding))
      return fmt::format("the file's lattice is {} long along {}, the periodic box {}; they must be the same",
                         units.text(edge, dimensions::length, 8), "xyz"[a], units.text(wanted, dimensions::length, 8));
  }
  return "";
}

std::vector<std::string> words_of_species(ParticleFrame const& frame, std::string const& species) {
  auto words = meanings(frame, species);
  if (species.empty()) words = {frame.species.begin(), frame.species.end()};
  return {words.begin(), words.end()};
}

std::size_t count_species(ParticleFrame const& frame, std::string const& species) {
  if (species.empty()) return frame.size();
  if (auto const count = of_species(frame, species).size(); count > 0) return count;
  std::vector<std::string> all = frame.species;
  for (auto const& [label, type] : frame.labels) all.push_back(label);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  throw Error(fmt::format("the file has no particle of species '{}'{}", species, choices(species, all, "it has")));
}

std::size_t frame_load(AnyEnsemble& ensemble, ParticleFrame const& frame, FrameOptions const& options) {
  count_species(frame, options.species);
  auto const chosen = of_species(frame, options.species);
  if (ensemble.size() != chosen.size()) {
    if (!options.resize)
      throw Error(fmt::format("ensemble '{}' has {} particles, the file has {}", ensemble.name(), ensemble.size(),
                              chosen.size()));
    ensemble.resize(chosen.size());
  }
  for (auto const& column : frame.columns) {
    Field const* const field = field_for(ensemble, column);
    if (field == nullptr) continue;
    fill(ensemble, *field, column, chosen, factor_of(column.name, column.unit, field->dimension, options));
  }
  return chosen.size();
}

}  // namespace boltzmann
