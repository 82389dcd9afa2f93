// Reads [multipole]: gravity or electrostatics by expansions.
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/schemes/multipole/multipole_options.hpp>
#include <boltzmann/schemes/multipole/multipole_scheme.hpp>

namespace boltzmann {

void read_multipole(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[multipole]", reading.context);
  auto const law = read_field_law(section, multipole_options(), reading);
  MultipoleOptions options;
  read_options(section, keys_but_of_the_law(multipole_options()), &options, {.dimension = reading.dimension});
  Item const* grid = section.find("grid");
  auto const cells = grid ? read_cells(*grid, "grid", reading) : std::nullopt;
  section.finish();
  if (!law || !reading.box || reading.context.mistakes.count() != before) return;
  catch_errors(reading, table.place, [&] {
    auto scheme = std::make_unique<MultipoleScheme>(*reading.box, *law, options.tolerance);
    scheme->background(options.background);
    if (cells) scheme->grid(*cells);
    reading.result->schemes.push_back(std::move(scheme));
  });
}

void add_to_multipole(Item const& table, Reading& reading) {
  if (auto* const scheme = reading.result->scheme<MultipoleScheme>())
    add_sources(
        table, "[multipole]", scheme->constant(),
        [&](AnyEnsemble& ensemble, SourceKind const& kind) { scheme->add(ensemble, kind); }, reading,
        [&](AnyEnsemble& ensemble, SourceKind const& kind) { scheme->add_test_particles(ensemble, kind); });
}

}  // namespace boltzmann
