// The page: the window's one HTML file, embedded in the program.
#pragma once

#include <string_view>

namespace boltzmann {

/// window/page.html as it was when the library was built: script and style stand in it, and nothing else is fetched. It
/// is built from window/web by Node (window/web/README.md) and kept in the repository.
std::string_view page_html();

}  // namespace boltzmann
