// Texts in TOML: quotation marks and escapes.
#pragma once

#include <string>

namespace boltzmann {

/// "a \"word\"" with its quotation marks; a long text begins on a line of its own and keeps its ends of lines. Control
/// characters are escaped.
std::string toml_text(std::string const& text, bool long_text = false);

}  // namespace boltzmann
