// Escapes letter by letter.
#include <boltzmann/core/toml_text.hpp>

#include <fmt/format.h>

namespace boltzmann {

std::string toml_text(std::string const& text, bool long_text) {
  std::string result = long_text ? "\"\"\"\n" : "\"";
  for (char const c : text) {
    bool const control = static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
    if (c == '"' || c == '\\')
      (result += '\\') += c;
    else if (control && !(c == '\n' && long_text))
      result += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    else
      result += c;
  }
  return result + (long_text ? "\"\"\"" : "\"");
}

}  // namespace boltzmann
