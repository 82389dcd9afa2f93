// Nesting of a text of TOML or JSON: parsers of these texts are recursive, so its depth is limited.
#pragma once

#include <cstddef>
#include <string_view>

namespace boltzmann {

/// The greatest depth that is accepted.
constexpr std::size_t deepest_nesting = 64;

/// True if brackets, or the dots of a key, are nested deeper than deepest_nesting. Quotes and comments do not count.
bool nested_too_deep(std::string_view text);

}  // namespace boltzmann
