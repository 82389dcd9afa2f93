// bzm list and bzm show: the names and pages of the catalogue.
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/scenario/catalogue_pages.hpp>
#include <boltzmann/scenario/schema.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace boltzmann::bzm {

int list(std::string const& kind, bool names_only) {
  if (!kind.empty()) listed(kind);  // throws if there is no such kind
  bool first = true;
  for (auto const& one : listed_kinds()) {
    if (kind.empty() ? one == "units" : kind != one) continue;
    auto const entries = listed(one);
    if (names_only) {
      for (auto const& entry : entries) fmt::print("{}\n", entry.name);
      continue;
    }
    fmt::print("{}{}\n", first ? "" : "\n", one);
    first = false;
    std::size_t width = 22;
    for (auto const& entry : entries) width = std::max(width, entry.name.size());
    for (auto const& entry : entries) fmt::print("  {:<{}}  {}\n", entry.name, width, entry.doc);
  }
  if (!names_only && kind.empty()) fmt::print("\nbzm show NAME explains one; bzm list units lists the units.\n");
  return 0;
}

int show_schema(std::string const& name) {
  if (!name.empty()) throw Error("--schema is of all that a scenario may have; leave '" + name + "' out");
  std::fputs(scenario_schema().c_str(), stdout);
  return 0;
}

int show(std::string const& name) {
  if (name.empty()) throw Error("bzm show needs a name that bzm list shows, or --schema");
  std::fputs(catalogue_page(name).c_str(), stdout);
  return 0;
}

}  // namespace boltzmann::bzm
