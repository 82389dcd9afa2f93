// The assembler includes the page in the object file, because compiling a text of a hundred kilobytes is slow.
#include <boltzmann/window/page.hpp>

// BOLTZMANN_PAGE is the path of page.html, from CMakeLists.txt. The digest, also from there, prevents a compiler cache
// from using an object with an older page.
asm(".pushsection .rodata\n"
    ".global boltzmann_window_page\n"
    ".hidden boltzmann_window_page\n"
    "boltzmann_window_page:\n"
    ".incbin \"" BOLTZMANN_PAGE
    "\"\n"
    ".global boltzmann_window_page_end\n"
    ".hidden boltzmann_window_page_end\n"
    "boltzmann_window_page_end:\n"
    ".byte 0\n"
    ".popsection\n");

extern "C" {
extern char const boltzmann_window_page[];      // NOLINT: an address is all that it has
extern char const boltzmann_window_page_end[];  // NOLINT
}

namespace boltzmann {

std::string_view page_html() { return {boltzmann_window_page, boltzmann_window_page_end}; }

}  // namespace boltzmann
