// Text lines: reads a particle file line by line, and splits words. Private to this module.
#pragma once

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/input_file.hpp>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace boltzmann {

/// The words between blanks.
std::vector<std::string_view> words_of(std::string_view line);

/// The whole word as a number; false if it is not a number.
template <class Number>
bool parse_word(std::string_view word, Number& number) {
  if (word.starts_with('+')) word.remove_prefix(1);
  auto const [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc{} && end == word.data() + word.size();
}

/// The lines of a file, with their numbers for messages.
class TextLines {
 public:
  /// `what` describes the file, "XYZ file". Error if it can't be opened.
  TextLines(std::string const& path, std::string_view what);

  /// The next line; false at the end.
  bool next();
  /// The next line. Error, "the file ends before WHAT", if there is none.
  std::string const& need(std::string_view what);
  /// Makes the current line the next one again.
  void back() { again_ = true; }
  std::string const& line() const { return line_; }
  std::vector<std::string_view> words() const { return words_of(line_); }

  /// "path:line: what", for the last line.
  Error error(std::string const& what) const;
  Error ended(std::string const& what) const;

  /// A finite number, described by `what`. Error if the word is not one.
  double number(std::string_view word, std::string_view what) const;
  /// Appends `count` finite numbers, the words from `first` on.
  void numbers(std::vector<std::string_view> const& words, std::size_t first, std::size_t count, std::string_view what,
               std::vector<double>& out) const;
  /// A whole number, 0 or more.
  std::size_t count(std::string_view word, std::string_view what) const;

 private:
  std::string path_;
  std::unique_ptr<std::istream> file_;
  std::string line_;
  std::size_t number_ = 0;
  bool again_ = false;
};

/// Error for duplicate numbers, at the line of the second one: identifiers of particles.
class Identifiers {
 public:
  void add(TextLines const& lines, std::int64_t id);

 private:
  std::unordered_set<std::int64_t> known_;
};

/// "the file has 3 frames, there is no frame 7 (the first is 0)"
std::string no_frame(std::size_t frames, std::size_t wanted);

}  // namespace boltzmann
