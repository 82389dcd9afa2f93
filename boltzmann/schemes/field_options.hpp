// Field options: the keys that all schemes of a field have.
#pragma once

#include <boltzmann/core/options.hpp>

namespace boltzmann {

/// law, k, G, on: the reader of the scenario knows them.
void add_field_keys(OptionTable& table);

}  // namespace boltzmann
