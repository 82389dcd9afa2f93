// Reads [[barostat]]: a pressure that is maintained by deforming the box.
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/scenario/time_formula.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {
namespace {

/// One axis or a list of axes, by number.
std::vector<int> read_stretched_axes(Item const& item, Reading& reading) {
  std::vector<int> axes;
  auto const take = [&](Item const& word) {
    auto const axis = read_word(word, "axes", axis_names(reading.dimension), reading.context);
    if (!axis) return;
    int const a = (*axis)[0] - 'x';
    if (std::find(axes.begin(), axes.end(), a) != axes.end())
      reading.mistake(word.place, fmt::format("axes: {} is named twice", *axis));
    axes.push_back(a);
  };
  if (!item.is(Item::Kind::array))
    take(item);
  else if (item.elements.empty())
    reading.mistake(item.place, "axes: an array without any; leave it out for all");
  else
    for (Item const& word : item.elements) take(word);
  return axes;
}

/// The values of barostat number `n` that events may set.
void add_settable(std::size_t n, Reading& reading) {
  auto const add = [&](char const* key, Dimension dimension, void (Barostat::*set)(double)) {
    reading.settable.push_back(settable_number(
        fmt::format("barostat.{}.{}", n, key), dimension, barostat_options().find(key)->kind.range,
        [n, set](Simulation& simulation, double value) { (simulation.barostats()[n].get()->*set)(value); }));
  };
  add("pressure", dimensions::energy / pow(dimensions::length, reading.dimension), &Barostat::pressure);
  add("temperature", dimensions::temperature, &Barostat::temperature);
}

void read_one_barostat(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "barostat", reading.context);
  ReadBarostat barostat{{}, table.place};
  OptionTable known = barostat_options();
  for (auto& formula : read_time_formulas(section, known, {"pressure", "temperature"}, reading))
    (formula.key == "pressure" ? barostat.pressure : barostat.temperature) = std::move(formula.value);
  read_options(section, known, &barostat.options, {.dimension = reading.dimension});
  if (Item const* axes = section.find("axes"); axes && reading.dimension > 0)
    barostat.options.axes = read_stretched_axes(*axes, reading);
  section.finish();
  if (reading.context.mistakes.count() != before || !reading.box) return;
  if (barostat.temperature) barostat.options.temperature = barostat.temperature(0);
  for (int a = 0; a < reading.dimension; ++a) {
    auto const& axes = barostat.options.axes;
    if (!reading.box->periodic(a) && (axes.empty() || std::find(axes.begin(), axes.end(), a) != axes.end()))
      reading.mistake(section.place("axes"),
                      fmt::format("barostat: axis {} is {}; periodic axes are stretched, name those with 'axes' (for a "
                                  "piston move a wall)",
                                  "xyz"[a], to_string(reading.box->boundary(a))));
  }
  if (reading.context.mistakes.count() != before) return;
  add_settable(reading.barostats.size(), reading);
  reading.barostats.push_back(std::move(barostat));
}

}  // namespace

void read_barostats(Section& document, Reading& reading) {
  for (Item const* table : find_tables(document, "barostat", true)) read_one_barostat(*table, reading);
  // Trial deformations of the box would include jumps of the energy that forces and virial don't have.
  if (!reading.barostats.empty() && reading.jump)
    reading.mistake(
        *reading.jump,
        "barostat: the energy of this law jumps at its cut-off, by which the pressure would be another than its "
        "forces'; add tail = true here, or leave out shifted = false in [run]");
}

void add_barostats(Reading& reading) {
  for (auto const& read : reading.barostats)
    catch_errors(reading, read.place, [&] {
      Barostat barostat(read.options, reading.boltzmann_constant());
      if (read.pressure) barostat.pressure(read.pressure);
      if (read.temperature) barostat.temperature(read.temperature);
      reading.result->simulation->add(std::move(barostat));
    });
}

}  // namespace boltzmann
