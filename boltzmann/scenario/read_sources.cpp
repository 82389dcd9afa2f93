// Reads what schemes of fields (mesh, multipoles) share: the law that makes the field, and whom it acts on.
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/scenario/reading.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {

std::optional<LaplaceLaw> read_field_law(Section& section, OptionTable const& keys, Reading& reading) {
  bool const softened = keys.find("softening") != nullptr;
  Item const* word = section.need("law", "law = \"coulomb\"");
  auto const name = word ? read_word(*word, "law", {"coulomb", "gravity"}, reading.context) : std::nullopt;
  section.explain(*keys.find("law"));
  if (!name) {
    section.mark_used("k");
    section.mark_used("G");
    if (softened) section.mark_used("softening");
    return std::nullopt;
  }
  auto parameters = find_law(*name)->parameters;
  if (!softened) std::erase_if(parameters, [](Parameter const& parameter) { return parameter.name == "softening"; });
  auto const values = read_parameters(section, fmt::format("law '{}'", *name), parameters, reading);
  if (!values) return std::nullopt;
  double const k = values->front().second.front(), softening = softened ? values->back().second.front() : 0;
  return *name == "coulomb" ? coulomb(k, softening) : gravity(k, softening);
}

OptionTable keys_but_of_the_law(OptionTable const& all) {
  std::vector<OptionKey> keys;
  for (auto const& key : all.keys())
    if (key != "law" && key != "k" && key != "G" && key != "softening") keys.push_back({key});
  return all.only(keys);
}

namespace {

/// Whom the scheme may act on: those that are named, or all. Null where one could not be read.
std::vector<ReadEnsemble*> chosen_ensembles(Section& section, Reading& reading) {
  std::vector<ReadEnsemble*> on;
  Item const* item = section.find("on");
  if (!item) {
    for (auto& ensemble : reading.ensembles) on.push_back(&ensemble);
  } else if (!item->is(Item::Kind::array)) {
    on.push_back(reading.ensemble(*item, "on"));
  } else {
    if (item->elements.empty())
      reading.mistake(item->place, "on: no ensemble; name one or more, or leave it out: all that fit");
    for (auto const& word : item->elements) {
      on.push_back(reading.ensemble(word, "on"));
      if (on.back() && std::find(on.begin(), on.end() - 1, on.back()) != on.end() - 1)
        reading.mistake(word.place, fmt::format("on: '{}' twice", on.back()->name));
    }
  }
  return on;
}

}  // namespace

bool add_sources(Item const& table, char const* heading, double constant,
                 std::function<void(AnyEnsemble&, SourceKind const&)> const& add, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, heading, reading.context);
  bool const chosen = section.has("on"), repel = constant > 0;
  char const* const fitting = repel ? "Coulomb" : "Kepler";
  auto const refuse = [&](std::string const& what) {
    reading.mistake(section.place("on"), what);
    return false;
  };
  bool any = false;
  for (auto* ensemble : chosen_ensembles(section, reading)) {
    if (!ensemble || !ensemble->particles || !ensemble->kind) return false;
    SourceKind const kind = ensemble->kind->in(reading.dimension)->source;
    bool const can = kind.strengths != nullptr && kind.sign * constant > 0;
    if (!chosen && !(can && kind.own)) continue;
    if (!kind.strengths)
      return refuse(fmt::format("on: '{}' is of class {}, which makes no field; the class that does: {}",
                                ensemble->name, ensemble->kind->name, fitting));
    if (!can)
      return refuse(fmt::format(
          "on: '{}' is of class {}, which the law '{}' does not act on; write law = \"{}\", "
          "or choose class {}",
          ensemble->name, ensemble->kind->name, repel ? "coulomb" : "gravity", repel ? "gravity" : "coulomb", fitting));
    any = true;
    catch_errors(reading, chosen ? section.place("on") : ensemble->place, [&] { add(*ensemble->particles, kind); });
  }
  if (!any && !reading.ensembles.empty() && reading.context.mistakes.count() == before)
    reading.mistake(table.place, fmt::format("{}: no ensemble makes a field; class {} does{}", heading, fitting,
                                             repel ? "" : ", and with 'on' any other that has a mass"));
  return reading.context.mistakes.count() == before;
}

}  // namespace boltzmann
