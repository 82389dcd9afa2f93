// A law among several ensembles whose parameters differ from species to species: tables and mixing rules. Private to this
// room.
#pragma once

#include <boltzmann/scenario/reading.hpp>

#include <vector>

namespace boltzmann {

/// The tables of [[influences]], one within each ensemble and one between each two, that a table with `among` stands for:
/// a parameter that is a table by names, { argon = ..., krypton = ..., "argon-krypton" = ... }, is in each of them the
/// one number for these two; `mixing` says how numbers that are not there follow from those of both. None if something is
/// wrong, which is a mistake then.
std::vector<Item> influences_among(Item const& table, Reading& reading);

}  // namespace boltzmann
