// Reads [multipole]: gravity, electrostatics or vortex flow by expansions.
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/schemes/multipole/multipole_options.hpp>
#include <boltzmann/schemes/multipole/multipole_scheme.hpp>

#include <memory>

namespace boltzmann {
namespace {

/// Whether the law is that of vortices, which has no numbers.
bool names_vortices(Section& section) {
  Item const* word = section.find("law");
  if (!word || !word->is(Item::Kind::text) || word->text != "biot-savart") return false;
  section.explain(*multipole_options().find("law"));
  for (char const* key : {"k", "G", "softening"})
    section.refuse(key, "the law 'biot-savart' has none (each vortex has a core); leave it out");
  return true;
}

}  // namespace

void read_multipole(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[multipole]", reading.context);
  bool const vortices = names_vortices(section);
  auto const law = vortices ? std::nullopt : read_field_law(section, multipole_options(), reading, {"biot-savart"});
  MultipoleOptions options;
  read_options(section, keys_but_of_the_law(multipole_options()), &options, {.dimension = reading.dimension});
  Item const* grid = section.find("grid");
  auto const cells = grid ? read_cells(*grid, "grid", reading) : std::nullopt;
  Place const place_of_background = section.has("background") ? section.place("background") : table.place;
  section.finish();
  if (!(law || vortices) || !reading.box || reading.context.mistakes.count() != before) return;
  catch_errors(reading, table.place, [&] {
    auto scheme = vortices ? std::make_unique<MultipoleScheme>(*reading.box, BiotSavart{}, options.tolerance)
                           : std::make_unique<MultipoleScheme>(*reading.box, *law, options.tolerance);
    if (cells) scheme->grid(*cells);
    catch_errors(reading, place_of_background, [&] { scheme->background(options.background); });
    reading.result->schemes.push_back(std::move(scheme));
  });
}

void add_to_multipole(Item const& table, Reading& reading) {
  if (auto* const scheme = reading.result->scheme<MultipoleScheme>())
    add_sources(
        table, "[multipole]", scheme->law(),
        [&](AnyEnsemble& ensemble, SourceKind const& kind) { scheme->add(ensemble, kind); }, reading,
        [&](AnyEnsemble& ensemble, SourceKind const& kind) { scheme->add_test_particles(ensemble, kind); });
}

}  // namespace boltzmann
