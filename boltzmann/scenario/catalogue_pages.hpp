// Catalogue pages: lists of available names (scenarios, classes, laws, ...), and a page of text for each.
#pragma once

#include <string>
#include <vector>

namespace boltzmann {

/// A name and its description in one line.
struct Named {
  std::string name, doc;
};

/// "scenarios", "classes", "laws", ...
std::vector<std::string> listed_kinds();
/// The names of a kind. Throws Error that lists the kinds if it is unknown.
std::vector<Named> listed(std::string const& kind);

/// The page of a name: a scenario, a class, a law, a key, a unit, ... Throws Error with the most similar name if it is
/// unknown.
std::string catalogue_page(std::string const& name);

/// The places where a key is allowed, "[run]", "loader random", and as a field "class Coulomb".
std::vector<std::string> places_of_key(std::string const& key);

}  // namespace boltzmann
