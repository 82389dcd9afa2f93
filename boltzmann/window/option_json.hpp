// The options of a struct in messages from and to a page.
#pragma once

#include <boltzmann/core/options.hpp>

#include <nlohmann/json_fwd.hpp>

namespace boltzmann {

/// The value of an option; null: automatic.
nlohmann::json option_json(Option const& option, void* object);

/// Sets it; null: as in `plain`. Throws Error, "'low' is a number", and leaves the object as it was.
void take(Option const& option, nlohmann::json const& value, void* object, void* plain);

}  // namespace boltzmann
