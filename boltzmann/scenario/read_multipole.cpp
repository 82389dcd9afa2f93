// Reads [multipole]: gravity, electrostatics or vortex flow by expansions.
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/schemes/multipole/multipole_options.hpp>
#include <boltzmann/schemes/multipole/multipole_scheme.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {
namespace {

std::vector<std::string> vortex_laws() {
  std::vector<std::string> names;
  for (auto const& law : scenario_laws())
    if (law.source == "Vortex") names.emplace_back(law.name);
  return names;
}

/// The law of vortices, if the word names one.
std::optional<VortexLaw> read_vortex_law(Section& section, Reading& reading) {
  Item const* word = section.find("law");
  auto const names = vortex_laws();
  if (!word || !word->is(Item::Kind::text) || std::find(names.begin(), names.end(), word->text) == names.end())
    return std::nullopt;
  read_word(*word, "law", names, reading.context);  // which notes it for forms
  section.explain(*multipole_options().find("law"));
  for (char const* key : {"k", "G", "softening"})
    section.refuse(key, fmt::format("the law '{}' has none (each vortex has a core); leave it out", word->text));
  auto const values =
      read_parameters(section, fmt::format("law '{}'", word->text), find_law(word->text)->parameters, reading);
  double const transposed = values ? values->front().second.front() : 1;
  if (word->text == AlgebraicBiotSavart::text.name) return AlgebraicBiotSavart{transposed};
  if (word->text == GaussianBiotSavart::text.name) return GaussianBiotSavart{transposed};
  return BiotSavart{transposed};
}

}  // namespace

void read_multipole(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[multipole]", reading.context);
  auto const vortices = read_vortex_law(section, reading);
  auto const law = vortices ? std::nullopt : read_field_law(section, multipole_options(), reading, vortex_laws());
  MultipoleOptions options;
  read_options(section, keys_but_of_the_law(multipole_options()), &options, {.dimension = reading.dimension});
  Place const place_of_background = section.has("background") ? section.place("background") : table.place;
  section.finish();
  if (!(law || vortices) || !reading.box || reading.context.mistakes.count() != before) return;
  catch_errors(reading, table.place, [&] {
    auto scheme = vortices ? std::make_unique<MultipoleScheme>(*reading.box, *vortices, options.tolerance)
                           : std::make_unique<MultipoleScheme>(*reading.box, *law, options.tolerance);
    if (!options.grid.empty()) scheme->grid(options.grid);
    catch_errors(reading, place_of_background, [&] { scheme->background(options.background); });
    if (options.every > 1) reading.slow.emplace_back(scheme.get(), options.every);
    reading.result->schemes.push_back(std::move(scheme));
  });
}

void add_to_multipole(Item const& table, Reading& reading) {
  auto* const scheme = reading.result->scheme<MultipoleScheme>();
  if (!scheme) return;
  add_sources(
      table, "[multipole]", scheme->law(),
      [&](AnyEnsemble& ensemble, SourceKind const& kind) {
        scheme->add(ensemble, kind);
        reading.acts_on_bodies.insert(ensemble.name());
      },
      reading, [&](AnyEnsemble& ensemble, SourceKind const& kind) { scheme->add_test_particles(ensemble, kind); });
  if (reading.bodies && !scheme->law())
    for (auto* body : reading.bodies->bodies()) scheme->add_test_particles(*body, source_kind<Panel<2>>());
}

}  // namespace boltzmann
