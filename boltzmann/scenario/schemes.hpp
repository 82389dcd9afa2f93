// Schemes: which schemes a scenario can have, each by a table of its own. Private to this room.
#pragma once

#include <boltzmann/scenario/tables.hpp>

#include <vector>

namespace boltzmann {

struct Item;
struct Reading;

/// A scheme that has a table; particles that none of these takes are supervised by pairs.
struct SchemeEntry {
  ScenarioTable told;
  std::vector<ScenarioTable> inner;                   ///< tables within its table
  void (*read)(Item const& table, Reading& reading);  ///< makes the scheme; the ensembles are not read yet
  void (*add)(Item const& table, Reading& reading);   ///< gives it its ensembles, if it could be made
};

/// In the order in which their influences are added.
std::vector<SchemeEntry> const& scheme_entries();

}  // namespace boltzmann
