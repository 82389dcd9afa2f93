// How deep a text of TOML or JSON goes: their readers, and what they read, call themselves for each level.
#pragma once

#include <cstddef>
#include <string_view>

namespace boltzmann {

/// As deep as a text that is read may be.
constexpr std::size_t deepest_nesting = 64;

/// Whether brackets, or the dots of a key, go deeper than deepest_nesting; what stands in quotes or comments doesn't
/// count.
bool nested_too_deep(std::string_view text);

}  // namespace boltzmann
