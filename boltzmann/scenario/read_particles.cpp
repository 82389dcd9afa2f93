// Reads selections of particles of an ensemble: numbers, all, those at the edge, those where a formula is true.
#include <boltzmann/loaders/fields.hpp>
#include <boltzmann/scenario/field_formulas.hpp>
#include <boltzmann/scenario/field_values.hpp>
#include <boltzmann/scenario/reading.hpp>

#include <fmt/format.h>

#include <numeric>

namespace boltzmann {

std::vector<std::uint32_t> all_indices(AnyEnsemble const& particles) {
  std::vector<std::uint32_t> all(particles.size());
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

namespace {

std::optional<std::vector<std::uint32_t>> particles_where(Item const& where, char const* key,
                                                          AnyEnsemble const& ensemble, Reading& reading) {
  auto formula = read_formula(where, key, formula_names(ensemble.fields(), ensemble.dimension(), reading), {}, reading);
  if (!formula) return std::nullopt;
  std::vector<std::uint32_t> which;
  for (std::size_t i = 0; i < ensemble.size(); ++i)
    if ((*formula)(ensemble.row(i)) != 0) which.push_back(static_cast<std::uint32_t>(i));
  if (which.empty() && ensemble.size() > 0 && where.is(Item::Kind::text))
    reading.note(fmt::format("warning: {}: '{}' is true for no particle of '{}' (line {})", key, where.text,
                             ensemble.name(), where.place.line));
  return which;
}

std::optional<std::vector<std::uint32_t>> numbered_particles(Item const& item, char const* key,
                                                             AnyEnsemble const* ensemble, Reading& reading) {
  std::vector<std::uint32_t> which;
  for (auto const& element : item.elements) {
    auto const i = read_integer(element, key, 0, 4'000'000'000, reading.context);
    if (!i) return std::nullopt;
    if (ensemble && static_cast<std::size_t>(*i) >= ensemble->size()) {
      reading.mistake(element.place, fmt::format("{}: there is no particle {}; '{}' has {}, numbered from 0 to {}", key,
                                                 *i, ensemble->name(), ensemble->size(), ensemble->size() - 1));
      return std::nullopt;
    }
    which.push_back(static_cast<std::uint32_t>(*i));
  }
  return which;
}

}  // namespace

std::optional<std::vector<std::uint32_t>> read_chosen(Item const& item, char const* key, AnyEnsemble const* ensemble,
                                                      Reading& reading) {
  if (item.is(Item::Kind::array)) return numbered_particles(item, key, ensemble, reading);
  return ensemble ? particles_where(item, key, *ensemble, reading) : std::nullopt;
}

std::optional<std::vector<std::uint32_t>> read_particles(Section& section, AnyEnsemble const* ensemble,
                                                         Reading& reading, bool parts) {
  Item const* margin_item = section.find("margin");
  auto const margin = section.quantity("margin", dimensions::length, not_negative);
  Item const* item = section.find("particles");
  Item const* where = parts ? nullptr : section.find("where");
  if (item && !parts) section.refuse("where", "'particles' also chooses them; leave one out");
  if (item && item->is(Item::Kind::array) && item->elements.empty())
    reading.note(fmt::format("warning: particles: the list is empty (line {})", item->place.line));
  if (where) return item || !ensemble ? std::nullopt : particles_where(*where, "where", *ensemble, reading);
  if (!item) return std::nullopt;
  bool const edge = item->is(Item::Kind::text) && item->text == "edge";
  if (!edge) section.refuse("margin", "it belongs to particles = \"edge\"");
  if (item->is(Item::Kind::array)) return numbered_particles(*item, "particles", ensemble, reading);
  if (!item->is(Item::Kind::text)) {
    reading.mistake(item->place, fmt::format("particles: an array of numbers, \"edge\" or \"all\" is needed, not {}",
                                             describe(*item)));
    return std::nullopt;
  }
  if (!read_word(*item, "particles", {"all", "edge"}, reading.context)) return std::nullopt;
  if (edge && !margin_item)
    reading.mistake(item->place,
                    "particles = \"edge\" needs a 'margin': those nearer than it to a face of the block "
                    "that encloses all, e.g. margin = \"1.5 angstrom\"");
  if (!ensemble || (edge && !margin)) return std::nullopt;
  if (!edge) return all_indices(*ensemble);
  auto which = edge_particles(*ensemble, *margin);
  if (which.empty() && ensemble->size() > 0)
    reading.note(fmt::format("warning: particles: no particle of '{}' is nearer to the edge than the margin (line {})",
                             ensemble->name(), item->place.line));
  return which;
}

}  // namespace boltzmann
