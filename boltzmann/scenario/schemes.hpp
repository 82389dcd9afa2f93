// Schemes: the schemes that a scenario can have, each by a table of its own. Private to this module.
#pragma once

#include <boltzmann/scenario/tables.hpp>

#include <vector>

namespace boltzmann {

struct Item;
struct Reading;

/// A scheme that has a table. Particles that fit none of these belong to pairs.
struct SchemeEntry {
  ScenarioTable told;
  std::vector<ScenarioTable> inner;                   ///< tables within its table
  void (*read)(Item const& table, Reading& reading);  ///< creates the scheme, before the ensembles are read
  void (*add)(Item const& table, Reading& reading);   ///< adds its ensembles, if it could be created
};

/// In the order in which their influences are added.
std::vector<SchemeEntry> const& scheme_entries();

}  // namespace boltzmann
