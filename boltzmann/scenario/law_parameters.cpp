// Parameters of laws and materials: reading, and documentation.
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/scenario/law_parameters.hpp>
#include <boltzmann/scenario/reading.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace boltzmann {
namespace {

bool has_default(Parameter const& parameter, bool reduced_base) {
  bool const there =
      parameter.default_in == DefaultIn::all || (parameter.default_in == DefaultIn::reduced) == reduced_base;
  return parameter.unlimited || (!parameter.default_text.empty() && there);
}

/// "1 eV": in a unit close to the unit of the base.
std::string example_of(Parameter const& parameter, bool is_vector, int space, UnitSystem const& base) {
  if (is_vector) return space == 3 ? "[0, 0, -1]" : "[0, -1]";
  Dimension const dimension = parameter.dimension.in(space);
  auto const units = example_units(dimension);
  std::string const number = parameter.range.contains(1) ? "1" : "1.4";
  if (base.is_reduced()) return number;
  auto const own = base.display(dimension).unit;  // that of the scenario, if it has a name
  try {
    if (auto const one = parse_quantity("1 " + own); one.has_unit && one.dimension == dimension)
      return fmt::format("\"{} {}\"", number, own);
  } catch (Error const&) {
  }
  if (units.empty()) return number;
  auto const away = [&](std::string const& unit) {
    return std::abs(std::log(base.from_si(parse_quantity("1 " + unit).si, dimension)));
  };
  auto const nearest =
      std::min_element(units.begin(), units.end(), [&](auto const& a, auto const& b) { return away(a) < away(b); });
  return fmt::format("\"{} {}\"", number, *nearest);
}

Option option_of(Parameter const& parameter) {
  auto const [dimension, by_space] = parameter.dimension;
  OptionKind kind = parameter.vector ? option::vector(dimension) : option::number(dimension, parameter.range);
  kind.by_space = by_space;
  Option option{std::string(parameter.name), kind, std::string(parameter.doc), "", "", [](void*) -> OptionPlace {
                  return std::monostate{};
                }};
  if (parameter.unlimited)
    option.otherwise = "no limit";
  else if (parameter.default_text.empty())
    option.needed = "1";
  else
    option.otherwise =
        fmt::format("`{}`{}", parameter.default_text,
                    parameter.default_in == DefaultIn::all       ? ""
                    : parameter.default_in == DefaultIn::reduced ? " in the base `\"reduced\"`, else needed"
                                                                 : ", but needed in the base `\"reduced\"`");
  return option;
}

}  // namespace

std::vector<double> const& value_of(ParameterValues const& values, std::string_view name) {
  for (auto const& [key, value] : values)
    if (key == name) return value;
  throw Error(fmt::format("the parameter '{}' is missing", name));
}

OptionTable options_of(std::vector<Parameter> const& parameters) {
  OptionTable all;
  for (auto const& parameter : parameters) {
    all.add(option_of(parameter));
    if (parameter.also.empty()) continue;
    Option other = option_of(parameter);
    other.key = parameter.also;
    other.needed = "";
    other.otherwise = "";
    other.doc = fmt::format(
        "instead of `{0}`{1}", parameter.name,
        parameter.also_times == 1 ? "" : fmt::format(", which is {:.7g} {}", parameter.also_times, parameter.also));
    all.add(other);
  }
  return all;
}

std::optional<ParameterValues> read_parameters(Section& section, std::string_view owner,
                                               std::vector<Parameter> const& parameters, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  auto const& units = reading.context.units;
  int const space = reading.dimension;
  ParameterValues values;
  for (auto const& parameter : parameters) {
    std::string const name(parameter.name);
    bool const is_vector = parameter.vector && (!parameter.axial || space == 3);
    Dimension const dimension = parameter.dimension.in(space);
    Item const* item = section.find(name);
    std::string const also(parameter.also);
    Item const* const other = also.empty() ? nullptr : section.find(also);
    if (item && other) {
      reading.mistake(other->place, fmt::format("{}: '{}' is given, too; leave one of them out", also, name));
      continue;
    }
    if (other) {
      if (auto const value = read_quantity(*other, also, dimension, reading.context, parameter.range))
        values.push_back({name, {*value * parameter.also_times}});
      continue;
    }
    bool const shown = !parameter.unlimited && has_default(parameter, units.is_reduced());
    section.explain(option_of(parameter), shown ? std::string(parameter.default_text) : "",
                    space == 0 && parameter.dimension.by_space != 0 ? std::nullopt : std::optional(dimension));
    if (!item && !has_default(parameter, units.is_reduced())) {
      reading.mistake(section.place(), fmt::format("{} needs '{}'{}, {}; add e.g. {} = {}", owner, name,
                                                   also.empty() ? "" : " (or '" + also + "')", parameter.doc, name,
                                                   example_of(parameter, is_vector, space == 0 ? 3 : space, units)));
    } else if (!item) {
      values.push_back(
          {name, std::vector<double>(is_vector ? static_cast<std::size_t>(std::max(space, 1)) : 1,
                                     parameter.unlimited ? std::numeric_limits<double>::infinity()
                                                         : in_units(parameter.default_text, dimension, units))});
    } else if (space == 0 && (is_vector || parameter.dimension.by_space != 0)) {
      continue;  // its range is unknown
    } else if (is_vector || (parameter.vector && item->is(Item::Kind::array))) {
      if (auto const value = read_vector(*item, name, is_vector ? space : 1, dimension, reading.context))
        values.push_back({name, *value});
    } else if (auto const value = read_quantity(*item, name, dimension, reading.context, parameter.range)) {
      values.push_back({name, {*value}});
    }
  }
  if (reading.context.mistakes.count() != before) return std::nullopt;
  return values;
}

}  // namespace boltzmann
