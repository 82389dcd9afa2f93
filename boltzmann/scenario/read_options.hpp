// From the keys of a section to the members of a struct, by its table of options. Private to this room.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/pictures/picture.hpp>
#include <boltzmann/scenario/section.hpp>

#include <functional>
#include <optional>

namespace boltzmann {

/// What a table can't know.
struct OptionMeaning {
  int dimension = 0;  ///< of space; 0: not known
  /// Of the quantity that is shown, asked for when all other options have been read. Nothing, or no function: it is not
  /// known, and such options are allowed without being read.
  std::function<std::optional<Dimension>()> shown = {};
  /// Reads ensembles and particles, which only the reader of the scenario knows.
  std::function<void(Option const& option, OptionPlace const& place)> of_scenario = {};
};

/// Reads those of the options that the section has; the members of the others stay as they are. Everything wrong is a
/// mistake at its place.
void read_options(Section& section, OptionTable const& options, void* object, OptionMeaning const& meaning);

/// What the table of a picture's options does not say: keys that mean nothing beside others, or in this space. A box
/// that is not known is null.
void check_picture_keys(Section& section, Picture const& picture, int dimension, Box const* box);

}  // namespace boltzmann
