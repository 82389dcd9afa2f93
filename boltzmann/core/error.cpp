// The nearest allowed word, for messages that help.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/renamed_words.hpp>
#include <boltzmann/core/words.hpp>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <utility>
#include <vector>

namespace boltzmann {
namespace {

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

/// Insertions, deletions, substitutions and swaps of neighbouring letters.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1), above, above_that;
  std::iota(row.begin(), row.end(), 0U);
  auto const same = [&](std::size_t i, std::size_t j) { return lower(a[i - 1]) == lower(b[j - 1]); };
  for (std::size_t i = 1; i <= a.size(); ++i) {
    above_that = std::exchange(above, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same(i, j) ? 0 : 1)});
      if (i > 1 && j > 1 && same(i, j - 1) && same(i - 1, j)) row[j] = std::min(row[j], above_that[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::string nearest(std::string_view word, std::span<std::string const> candidates) {
  std::string best;
  std::size_t best_distance = word.size() + 1000;
  for (auto const& candidate : candidates) {
    auto const [shorter, longer] = std::minmax({word.size(), candidate.size()});
    std::size_t const most = std::min(longer / 3 + 1, longer / 2);  // short words have half of their letters in common
    if (longer - shorter > most || longer - shorter >= best_distance) continue;  // at least as far
    std::size_t const distance = edit_distance(word, candidate);
    if (distance < best_distance && distance <= most) {
      best = candidate;
      best_distance = distance;
    }
  }
  if (!best.empty() || word.size() < 3) return best;
  for (auto const& candidate : candidates)  // "temp", "vel": the shortest word that begins so
    if (candidate.size() > word.size() && edit_distance(word, candidate.substr(0, word.size())) == 0 &&
        (best.empty() || candidate.size() < best.size()))
      best = candidate;
  return best;
}

std::string did_you_mean(std::string_view word, std::span<std::string const> candidates) {
  auto const among = [&](std::string_view one) {
    return std::find(candidates.begin(), candidates.end(), one) != candidates.end();
  };
  for (auto const& [before, now] : renamed_words)
    if (word == before && among(now)) return "; it is '" + std::string(now) + "' now";
  std::string small = " " + std::string(word) + " ";
  std::transform(small.begin(), small.end(), small.begin(), lower);
  for (auto const& [here, elsewhere] : words_elsewhere)
    if ((" " + std::string(elsewhere) + " ").find(small) != std::string::npos && among(here))
      return "; it is called '" + std::string(here) + "' here";
  std::string const best = nearest(word, candidates);
  return best.empty() ? "" : "; did you mean '" + best + "'?";
}

std::string choices(std::string_view word, std::span<std::string const> names, std::string_view verb,
                    std::string_view where) {
  return choices_with(did_you_mean(word, names), names, verb, where);
}

std::string choices_with(std::string_view hint, std::span<std::string const> names, std::string_view verb,
                         std::string_view where) {
  std::string begin(verb);
  if (verb == "there are" && names.size() <= 1) begin = "there is";
  if (verb == "allowed are" && names.size() <= 1) begin = "allowed is";
  if (names.empty()) return "; " + begin + (verb == "there are" ? " none" : " nothing") + std::string(hint);
  if (names.size() <= most_names) return "; " + begin + " " + join(names) + std::string(hint);
  std::string const list = begin + " " + join(names.first(most_names)) + " and " +
                           std::to_string(names.size() - most_names) + " more" +
                           (where.empty() ? "" : " (" + std::string(where) + " shows all)");
  if (hint.empty()) return "; " + list;
  std::string text(hint);
  if (text.back() != '?') return text + "; " + list;
  return text + " " + static_cast<char>(std::toupper(static_cast<unsigned char>(list[0]))) + list.substr(1);
}

namespace {

/// Bytes of the letter of UTF-8 that begins here; 0 if there is none.
std::size_t letter_bytes(std::string_view text) {
  auto const byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0U; };
  unsigned const first = byte(0);
  std::size_t const count = first < 0x80   ? 1
                            : first < 0xc2 ? 0
                            : first < 0xe0 ? 2
                            : first < 0xf0 ? 3
                            : first < 0xf5 ? 4
                                           : 0;
  for (std::size_t k = 1; k < count; ++k)
    if ((byte(k) & 0xc0U) != 0x80) return 0;
  if ((first == 0xe0 && byte(1) < 0xa0) || (first == 0xed && byte(1) >= 0xa0)) return 0;
  return (first == 0xf0 && byte(1) < 0x90) || (first == 0xf4 && byte(1) >= 0x90) ? 0 : count;
}

}  // namespace

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string shown(text.substr(0, longest));
  for (std::size_t k = 0; k < shown.size();) {
    // Bytes beyond the end of `shown` belong to a letter that is cut; they are dropped below.
    std::size_t const count = letter_bytes(text.substr(k));
    unsigned char const letter = static_cast<unsigned char>(shown[k]);
    if (count == 0 || letter < ' ' || letter == 127) shown[k] = '?';
    k += std::max<std::size_t>(count, 1);
  }
  while (shown.size() < text.size() && !shown.empty() &&
         (static_cast<unsigned char>(text[shown.size()]) & 0xc0U) == 0x80)
    shown.pop_back();  // no half letters of UTF-8
  return shown.size() < text.size() ? shown + "..." : shown;
}

std::string some_of(std::span<std::string const> words) {
  constexpr std::size_t longest = 300;
  std::string all = join(words);
  if (all.size() <= longest) return all;
  std::size_t shown = 0, length = 0;
  while (length + words[shown].size() < longest / 2) length += words[shown++].size() + 2;
  return join(words.first(shown)) + " and " + std::to_string(words.size() - shown) + " more";
}

std::string join(std::span<std::string const> words, std::string_view separator) {
  std::string text;
  for (auto const& word : words) {
    if (!text.empty()) text += separator;
    text += word;
  }
  return text;
}

void refuse_word(std::string_view what, std::string_view word, std::vector<std::string> const& words) {
  throw Error("unknown " + std::string(what) + " '" + std::string(word) + "'" + choices(word, words));
}

}  // namespace boltzmann
