// Converts the options of a struct to and from messages of a page.
#pragma once

#include <boltzmann/core/options.hpp>

#include <nlohmann/json_fwd.hpp>

namespace boltzmann {

/// The value of an option; null: automatic.
nlohmann::json option_json(Option const& option, void* object);

/// Sets the value; null: that of `plain`. Throws Error, "'low' is a number", and leaves the object unchanged.
void take(Option const& option, nlohmann::json const& value, void* object, void* plain);

}  // namespace boltzmann
