// Resolves units by name in styles and formats, and computes conversion factors.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/files/unit_change.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {
namespace {

constexpr double largest_of_atoms = 1e-8;  // in m; runs with shorter units of length are those of atoms

/// A unit as parse_quantity reads it: with a number before it.
std::string as_quantity(std::string const& unit) {
  bool const is_number =
      !unit.empty() && ((unit[0] >= '0' && unit[0] <= '9' && !unit.starts_with("1/")) || unit[0] == '.');
  return is_number ? unit : "1 " + unit;
}

}  // namespace

UnitChange::UnitChange(std::string const& wanted, ExportFormat const& format, TrajectoryReader const& reader) {
  std::string length;
  for (auto const& field : reader.ensembles().front().fields)
    if (field.name == "position") length = field.unit;
  if (auto words = unit_style_names(); !wanted.empty() && wanted != "run") {
    words.emplace_back("run");
    if (std::find(words.begin(), words.end(), wanted) == words.end())
      throw Error(fmt::format("there are no units '{}'{}", wanted, choices(wanted, words)));
  }
  if (format.own_units && !wanted.empty())
    throw Error(fmt::format("a file of format {} is in {}; leave out the units", format.name, format.own_units->doc));
  if (length.empty()) {
    if (!wanted.empty() && wanted != "run")
      throw Error(fmt::format("the run has pure numbers, which can't become units of '{}'", wanted));
    name_ = "none";
    return;
  }
  if (format.own_units) {
    name_ = format.own_units->doc;
    style_ = format.own_units;
    return;
  }
  bool const atoms = parse_quantity(as_quantity(length)).si < largest_of_atoms;
  name_ = !wanted.empty() ? wanted : !format.of_atoms ? "run" : atoms ? "metal" : "si";
  if (name_ != "run") style_ = &unit_style(name_);
}

UnitChange::Change UnitChange::operator()(std::string const& unit) const {
  if (unit.empty() || !style_) return {unit, 1};
  auto const quantity = parse_quantity(as_quantity(unit));
  std::string const target = style_->unit(quantity.dimension);
  if (target == unit || target.empty()) return {unit, 1};
  return {target, quantity.si / parse_quantity(as_quantity(target)).si};
}

}  // namespace boltzmann
