// Lines, words and numbers, and their error messages.
#include <boltzmann/loaders/text_lines.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> found;
  constexpr std::string_view blank = " \t\r\n\v\f";
  while (true) {
    std::size_t const begin = line.find_first_not_of(blank);
    if (begin == std::string_view::npos) return found;
    std::size_t const end = std::min(line.find_first_of(blank, begin), line.size());
    found.push_back(line.substr(begin, end - begin));
    line.remove_prefix(end);
  }
}

TextLines::TextLines(std::string const& path, std::string_view what)
    : path_(path), file_(open_text(path, std::string(what))) {}

bool TextLines::next() {
  if (again_) {
    again_ = false;
    return true;
  }
  if (!read_line(*file_, line_, path_)) return false;
  if (line_.ends_with('\r')) line_.pop_back();
  ++number_;
  return true;
}

std::string const& TextLines::need(std::string_view what) {
  if (!next()) throw ended(fmt::format("the file ends before {}", what));
  return line_;
}

Error TextLines::error(std::string const& what) const { return Error(fmt::format("{}:{}: {}", path_, number_, what)); }
Error TextLines::ended(std::string const& what) const {
  return Error(fmt::format("{}:{}: {}", path_, number_ + 1, what));
}

double TextLines::number(std::string_view word, std::string_view what) const {
  double value = 0;
  if (!parse_word(word, value) || !std::isfinite(value))
    throw error(fmt::format("'{}' is not a number ({})", boltzmann::quoted(word), boltzmann::quoted(what)));
  return value;
}

void TextLines::numbers(std::vector<std::string_view> const& words, std::size_t first, std::size_t count,
                        std::string_view what, std::vector<double>& out) const {
  if (words.size() < first + count)
    throw error(fmt::format("{} words are needed ({}), this line has {}", first + count, what, words.size()));
  for (std::size_t k = 0; k < count; ++k) out.push_back(number(words[first + k], what));
}

std::size_t TextLines::count(std::string_view word, std::string_view what) const {
  std::size_t value = 0;
  if (!parse_word(word, value)) throw error(fmt::format("'{}' is not {}", boltzmann::quoted(word), what));
  return value;
}

void Identifiers::add(TextLines const& lines, std::int64_t id) {
  if (!known_.insert(id).second) throw lines.error(fmt::format("there is an atom {} already", id));
}

std::string no_frame(std::size_t frames, std::size_t wanted) {
  return fmt::format("the file has {} frame{}, there is no frame {} (the first is 0)", frames, frames == 1 ? "" : "s",
                     wanted);
}

}  // namespace boltzmann
