// The page's bytes, put into the object file by the assembler: there is no text of a hundred kilobytes to compile.
#include <boltzmann/window/page.hpp>

// BOLTZMANN_PAGE: the path of page.html, from CMakeLists.txt, which also gives its digest, so that no cache of compilers
// takes an older page's object for this one's.
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
