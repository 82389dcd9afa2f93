// Field options: the keys common to all schemes of a field.
#pragma once

#include <boltzmann/core/options.hpp>

namespace boltzmann {

/// law, k, G, on: the reader of the scenario processes them.
void add_field_keys(OptionTable& table);

}  // namespace boltzmann
