// A law among several ensembles with parameters that depend on the species: tables and mixing rules. Private to this
// module.
#pragma once

#include <boltzmann/scenario/reading.hpp>

#include <vector>

namespace boltzmann {

/// Expands a table with `among` to tables of [[influences]], one within each ensemble and one between each two. A
/// parameter that is a table by names, { argon = ..., krypton = ..., "argon-krypton" = ... }, is in each of them the
/// number for these two; `mixing` defines how missing numbers follow from those of both species. Returns nothing if
/// there is an error, which is then a mistake.
std::vector<Item> influences_among(Item const& table, Reading& reading);

}  // namespace boltzmann
