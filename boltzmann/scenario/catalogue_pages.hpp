// Catalogue pages: lists of what there is (scenarios, classes, laws, ...), and a page of text for each.
#pragma once

#include <string>
#include <vector>

namespace boltzmann {

/// A name and what it is, one line.
struct Named {
  std::string name, doc;
};

/// "scenarios", "classes", "laws", ...
std::vector<std::string> listed_kinds();
/// What there is of a kind. Error naming the kinds if it is none of them.
std::vector<Named> listed(std::string const& kind);

/// All that is known under a name: a scenario, a class, a law, a key, a unit, ... Error with the nearest name if there is
/// nothing.
std::string catalogue_page(std::string const& name);

/// Where a key may stand, "[run]", "loader random", and as a field "class Coulomb".
std::vector<std::string> places_of_key(std::string const& key);

}  // namespace boltzmann
