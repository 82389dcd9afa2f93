// Words: the names of the values of an enumeration in scenarios, and their meanings.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// Throws Error, "unknown convention 'x'; there are a, b; did you mean 'a'?".
[[noreturn]] void refuse_word(std::string_view what, std::string_view word, std::vector<std::string> const& words);

template <class Value>
struct Word {
  Value value;
  std::string_view name, doc;  ///< of one line
};

/// All values of an enumeration, in the order of their documentation.
template <class Value>
class Words {
 public:
  /// `what` describes them in messages: "convention".
  Words(std::string_view what, std::initializer_list<Word<Value>> words) : what_(what), words_(words) {}

  auto begin() const { return words_.begin(); }
  auto end() const { return words_.end(); }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (auto const& word : words_) all.emplace_back(word.name);
    return all;
  }
  /// "?": there is no such value.
  std::string name(Value value) const {
    for (auto const& word : words_)
      if (word.value == value) return std::string(word.name);
    return "?";
  }
  /// Error with all names, and the nearest.
  Value named(std::string_view name) const {
    for (auto const& word : words_)
      if (word.name == name) return word.value;
    refuse_word(what_, name, names());
  }

 private:
  std::string_view what_;
  std::vector<Word<Value>> words_;
};

}  // namespace boltzmann
