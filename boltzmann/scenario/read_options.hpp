// Reads keys of a section into the members of a struct, by its table of options. Private to this module.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/pictures/picture.hpp>
#include <boltzmann/scenario/section.hpp>

#include <functional>
#include <optional>

namespace boltzmann {

/// Information that a table does not have.
struct OptionMeaning {
  int dimension = 0;  ///< of space; 0: unknown
  /// The dimension of the displayed quantity, requested after all other options have been read. Nothing, or no
  /// function: it is unknown, and such options are allowed without being read.
  std::function<std::optional<Dimension>()> shown = {};
  /// Reads ensembles and particles; the reader of the scenario provides it.
  std::function<void(Option const& option, OptionPlace const& place)> of_scenario = {};
};

/// Reads the options that the section has; the members of the others are unchanged. Errors become mistakes at their
/// places.
void read_options(Section& section, OptionTable const& options, void* object, OptionMeaning const& meaning);

/// Checks that a table can't express: keys of a picture that have no effect with others, or in this space. The box is
/// null if unknown.
void check_picture_keys(Section& section, Picture const& picture, int dimension, Box const* box);

}  // namespace boltzmann
