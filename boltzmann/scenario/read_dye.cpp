// Reads [[dye]]: places where tracers are released during the run.
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/simulation/dye.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {
namespace {

void read_dye(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[[dye]]", reading.context);
  DyeOptions options;
  read_options(section, dye_options(), &options, {.dimension = reading.dimension});
  Item const* const on = section.find("on");
  ReadEnsemble* const ensemble = on ? reading.ensemble(*on, "on") : nullptr;
  auto const check_inside = [&](char const* key, std::array<double, 3> const& place) {
    for (int a = 0; reading.box && a < reading.dimension; ++a) {
      double const x = place[static_cast<std::size_t>(a)];
      if (reading.box->boundary(a) != Boundary::open && !(x >= reading.box->low(a) && x <= reading.box->high(a)))
        section.mistake(key, fmt::format("{} = {} is outside the box", "xyz"[a], x));
    }
  };
  if (reading.context.mistakes.count() == before) {
    check_inside("from", options.from);
    if (options.to) check_inside("to", *options.to);
  }
  section.finish();
  if (!ensemble || !ensemble->particles || reading.context.mistakes.count() != before) return;
  if (ensemble->integrator && !ensemble->integrator->same_for_all())
    return reading.mistake(on->place,
                           fmt::format("dye: some particles of '{}' are frozen, by their numbers, and more are added; "
                                       "make an ensemble of those",
                                       ensemble->name));
  for (auto const& earlier : reading.dyes)  // places are numbered through all sources of an ensemble
    if (earlier.ensemble == ensemble->particles) options.first_place += earlier.options.places;
  catch_errors(reading, table.place, [&] { DyeSource(*ensemble->particles, options); });
  reading.dyes.push_back({ensemble->particles, options});
}

}  // namespace

void read_dyes(Section& document, Reading& reading) {
  for (Item const* table : find_tables(document, "dye")) read_dye(*table, reading);
}

void add_dyes(Reading const& reading) {
  for (auto const& dye : reading.dyes)
    reading.result->simulation->adapt(static_cast<std::uint64_t>(dye.options.every),
                                      DyeSource(*dye.ensemble, dye.options));
}

}  // namespace boltzmann
