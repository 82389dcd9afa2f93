// The page: the window's one HTML file, embedded in the program.
#pragma once

#include <string_view>

namespace boltzmann {

/// The contents of window/page.html at build time. It includes script and style and loads nothing else. Node builds it
/// from window/web (window/web/README.md), and it is kept in the repository.
std::string_view page_html();

}  // namespace boltzmann
