// Counts open brackets and dots outside quotes and comments.
#include <boltzmann/core/nesting.hpp>

#include <algorithm>

namespace boltzmann {
namespace {

/// The end of a text in quotes that begins at `at`.
std::size_t after_quotes(std::string_view text, std::size_t at) {
  char const quote = text[at];
  auto const three = text.substr(at, 3);
  bool const long_one = three.size() == 3 && three[1] == quote && three[2] == quote;
  for (std::size_t i = at + (long_one ? 3 : 1); i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"')
      ++i;
    else if (text[i] == '\n' && !long_one)
      return i;  // an error, which the parser reports
    else if (text[i] == quote && !long_one)
      return i + 1;
    else if (text[i] == quote && text.substr(i, 3) == three)
      return std::min(text.find_first_not_of(quote, i), i + 5);  // the text may end in two quotes
  }
  return text.size();
}

}  // namespace

bool nested_too_deep(std::string_view text) {
  std::ptrdiff_t brackets = 0, dots = 0;
  for (std::size_t i = 0; i < text.size();) {
    char const c = text[i];
    if (c == '"' || c == '\'') {
      i = after_quotes(text, i);
      continue;
    }
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    if (c == '[' || c == '{') ++brackets;
    if (c == ']' || c == '}') --brackets;
    if (c == '.')
      ++dots;
    else if (c == ',' || c == '=' || c == '\n' || c == '[' || c == '{')
      dots = 0;
    if (brackets + dots > static_cast<std::ptrdiff_t>(deepest_nesting)) return true;
    ++i;
  }
  return false;
}

}  // namespace boltzmann
