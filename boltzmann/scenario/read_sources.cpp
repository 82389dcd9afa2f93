// Reads the common keys of schemes of fields (mesh, multipoles): the law of the field, and its ensembles.
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/schemes/flow_classes.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {

std::optional<LaplaceLaw> read_field_law(Section& section, OptionTable const& keys, Reading& reading,
                                         std::vector<std::string> const& other_laws) {
  bool const softened = keys.find("softening") != nullptr;
  Item const* word = section.need("law", "law = \"coulomb\"");
  std::vector<std::string> words{"coulomb", "gravity"};
  words.insert(words.end(), other_laws.begin(), other_laws.end());
  auto const name = word ? read_word(*word, "law", words, reading.context) : std::nullopt;
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
    if (key != "law" && key != "k" && key != "G" && key != "softening" && key != "transposed") keys.push_back({key});
  return all.only(keys);
}

std::vector<NamedEnsemble> named_ensembles(Item const* item, std::string_view key, Reading& reading) {
  std::vector<NamedEnsemble> named;
  if (!item) return named;
  bool const list = item->is(Item::Kind::array);
  if (list && item->elements.empty())
    reading.mistake(item->place, fmt::format("{}: no ensemble; name one or more, or leave it out", key));
  std::vector<Item> const one{*item};
  for (Item const& word : list ? item->elements : one) {
    ReadEnsemble* const ensemble = reading.ensemble(word, key);
    if (!ensemble) continue;
    if (std::any_of(named.begin(), named.end(), [&](NamedEnsemble const& other) { return other.ensemble == ensemble; }))
      reading.mistake(word.place, fmt::format("{}: '{}' twice", key, ensemble->name));
    named.push_back({ensemble, word.place});
  }
  return named;
}

void refuse_twice(Item const& second, std::string_view key, Reading& reading) {
  reading.mistake(second.place,
                  fmt::format("{0}: '{1}' twice; within one ensemble write on = \"{1}\"", key, second.text));
}

std::pair<ReadEnsemble*, ReadEnsemble*> two_ensembles(Item const& between, Reading& reading) {
  bool const list = between.is(Item::Kind::array);
  if (!list || between.elements.size() != 2) {
    reading.mistake(between.place,
                    fmt::format("between: the names of two ensembles are needed, [\"a\", \"b\"], not {}{}",
                                describe(between), list ? fmt::format(" of {}", between.elements.size()) : ""));
    return {};
  }
  ReadEnsemble *const a = reading.ensemble(between.elements[0], "between"), *const b = reading.ensemble(
                                                                                between.elements[1], "between");
  if (!a || a != b) return {a, b};
  refuse_twice(between.elements[1], "between", reading);
  return {};
}

namespace {

/// The ensembles between which a law can act.
class Fitting {
 public:
  explicit Fitting(std::optional<LaplaceLaw> const& law) : vortices_(!law), sign_(law ? law->constant : 0) {}

  /// True if it acts on an ensemble by default.
  bool is_made_for_it(SourceKind const& kind) const { return vortices_ ? kind.vorticity >= 0 : fits(kind) && kind.own; }
  /// Why a class can't create the field, or, as test particles, can't feel it; empty if it can.
  std::string lack(SourceKind const& kind, bool test) const {
    if (vortices_ && test)
      return kind.carried && kind.vorticity < 0 ? "" : "which feels no flow without making one; class Tracer does";
    if (vortices_)
      return kind.vorticity >= 0 ? "" : fmt::format("which has no vorticity; classes {} have", classes_with_vorticity);
    if (fits(kind)) return "";
    if (!kind.strengths) return fmt::format("which makes no field; the class that does: {}", name());
    return fmt::format("which the law '{}' does not act on; write law = \"{}\", or choose class {}",
                       sign_ > 0 ? "coulomb" : "gravity", sign_ > 0 ? "gravity" : "coulomb", name());
  }
  std::string nobody() const {
    if (vortices_) return fmt::format("no ensemble makes a flow; classes {} do", classes_with_vorticity);
    return fmt::format("no ensemble makes a field; class {} does{}", name(),
                       sign_ > 0 ? "" : ", and with 'on' any other that has a mass");
  }

 private:
  bool fits(SourceKind const& kind) const { return kind.strengths != nullptr && kind.sign * sign_ > 0; }
  char const* name() const { return sign_ > 0 ? "Coulomb" : "Kepler"; }

  bool vortices_;
  double sign_;
};

}  // namespace

bool add_sources(Item const& table, char const* heading, std::optional<LaplaceLaw> const& law, AddToField const& add,
                 Reading& reading, AddToField const& test) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, heading, reading.context);
  Fitting const fitting(law);
  auto const kind_of = [&](ReadEnsemble const& ensemble) { return ensemble.kind->in(reading.dimension)->source; };
  auto const give = [&](ReadEnsemble& ensemble, char const* key, AddToField const& to) {
    SourceKind const kind = kind_of(ensemble);
    Place const place = section.has(key) ? section.place(key) : ensemble.place;
    std::string const lack = fitting.lack(kind, std::string_view(key) == "test_particles");
    if (lack.empty()) return catch_errors(reading, place, [&] { to(*ensemble.particles, kind); });
    reading.mistake(place, fmt::format("{}: '{}' is of class {}, {}", key, ensemble.name, ensemble.kind->name, lack));
    return false;
  };
  auto const named = [&](char const* key) {
    std::vector<ReadEnsemble*> all;
    for (auto const& one : named_ensembles(section.find(key), key, reading)) all.push_back(one.ensemble);
    return all;
  };
  std::vector<ReadEnsemble*> const tests = test ? named("test_particles") : std::vector<ReadEnsemble*>{};
  std::vector<ReadEnsemble*> on = named("on");
  if (!section.has("on"))
    for (auto& ensemble : reading.ensembles) on.push_back(&ensemble);
  for (auto const& all : {on, tests})
    for (auto const* ensemble : all)
      if (!ensemble->particles || !ensemble->kind) return false;
  if (!section.has("on"))  // those that are made for it, but for test particles
    std::erase_if(on, [&](ReadEnsemble const* ensemble) {
      SourceKind const kind = kind_of(*ensemble);
      return !fitting.is_made_for_it(kind) || std::find(tests.begin(), tests.end(), ensemble) != tests.end();
    });
  for (auto* ensemble : on)
    if (!give(*ensemble, "on", add)) return false;
  for (auto* ensemble : tests)
    if (!give(*ensemble, "test_particles", test)) return false;
  if (on.empty() && !section.has("on") && !reading.ensembles.empty() && reading.context.mistakes.count() == before)
    reading.mistake(table.place, fmt::format("{}: {}", heading, fitting.nobody()));
  return reading.context.mistakes.count() == before;
}

}  // namespace boltzmann
