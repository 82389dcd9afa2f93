// Inputs for fuzzing that are like others but for something.
#pragma once

#include <cctype>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann::fuzz {

/// Another input than that: some bytes, words, lines or pieces of others.
class Mutator {
 public:
  Mutator(std::vector<std::string> const& pool, std::vector<std::string> const& words, std::uint64_t seed)
      : pool_(pool), words_(words), random_(seed) {}

  std::string next() {
    std::string text = pool_[below(pool_.size())];
    for (std::size_t k = 1 + below(4); k > 0; --k) change(text);
    return text;
  }

 private:
  std::size_t below(std::size_t n) {
    return n == 0 ? 0 : std::uniform_int_distribution<std::size_t>(0, n - 1)(random_);
  }
  std::string piece(std::string const& text) {
    std::size_t const at = below(text.size() + 1);
    return text.substr(at, below(std::min<std::size_t>(text.size() - at, 64) + 1));
  }
  /// The number or word around a place.
  static std::pair<std::size_t, std::size_t> token(std::string const& text, std::size_t at) {
    auto const part = [&](std::size_t k) {
      return k < text.size() && (std::isalnum(static_cast<unsigned char>(text[k])) || text[k] == '.' || text[k] == '-');
    };
    std::size_t from = at, to = at;
    while (from > 0 && part(from - 1)) --from;
    while (part(to)) ++to;
    return {from, to - from};
  }
  void change(std::string& text) {
    std::size_t const at = below(text.size() + 1);
    switch (below(words_.empty() ? 5 : 9)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(below(256));
        break;
      case 1:
        if (at < text.size()) text[at] = static_cast<char>(static_cast<unsigned char>(text[at]) ^ (1U << below(8)));
        break;
      case 2:
        text.erase(at, below(std::min<std::size_t>(text.size() - at, 40) + 1));
        break;
      case 3:
        text.insert(at, piece(pool_[below(pool_.size())]));
        break;
      case 4:
        if (below(20) == 0) text.resize(at);
        break;
      case 5:
        text.insert(at, words_[below(words_.size())]);
        break;
      case 6:
      case 7: {
        auto const [from, count] = token(text, at);
        text.replace(from, count, words_[below(words_.size())]);
        break;
      }
      default: {  // a line twice, or gone
        std::size_t const from = text.rfind('\n', at) + 1, to = text.find('\n', at);
        if (to == std::string::npos) break;
        std::string const line = text.substr(from, to + 1 - from);
        if (below(2) == 0)
          text.erase(from, line.size());
        else
          text.insert(from, line);
      }
    }
  }

  std::vector<std::string> const& pool_;
  std::vector<std::string> const& words_;
  std::mt19937_64 random_;
};

}  // namespace boltzmann::fuzz
