// The prose rules of CONTRIBUTING.md: no forbidden words, sentences of at most 22 words on average, lines of at most 120
// columns, no broken links. Pages keep them. Sources, docstrings and scenarios are rewritten step by step, so their counts may only fall.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <ostream>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boltzmann::prose_test {
namespace {

namespace fs = std::filesystem;

constexpr double longest_mean_sentence = 22;  // words
constexpr std::size_t longest_line = 120;     // columns
constexpr std::size_t longest_page = 5000;    // words, without tables and code

/// Words and phrases that the rules forbid.
constexpr std::string_view forbidden[] = {
    "who",      "whom",      "whoever",  "whomever",         "nobody",
    "somebody", "everybody", "anybody",  "is told",          "are told",
    "be told",  "was told",  "is said",  "are said",         "be said",
    "says",     "hears of",  "hear of",  "knows of",         "know of",
    "so many",  "as a rule", "the rule", "knows nothing of", "what comes from outside"};

/// A phrase that a page may have all the same.
struct Exception {
  std::string_view page, phrase, reason;
};
std::vector<Exception> const exceptions{};

std::string text_of(fs::path const& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

fs::path source(std::string_view path) { return fs::path(BOLTZMANN_SOURCE) / path; }

std::vector<fs::path> files_below(std::string_view folder, std::vector<std::string> const& endings) {
  std::vector<fs::path> all;
  for (auto const& file : fs::recursive_directory_iterator(source(folder)))
    if (std::find(endings.begin(), endings.end(), file.path().extension()) != endings.end()) all.push_back(file.path());
  std::sort(all.begin(), all.end());
  return all;
}

/// Words in lower case. Any other character separates words, except apostrophes and hyphens inside a word.
std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> all;
  std::string word;
  for (std::size_t k = 0; k <= text.size(); ++k) {
    unsigned char const c = k < text.size() ? static_cast<unsigned char>(text[k]) : ' ';
    if (std::isalnum(c) != 0 || c == '_' || (!word.empty() && (c == '\'' || c == '-')))
      word += static_cast<char>(std::tolower(c));
    else if (!word.empty())
      all.push_back(std::exchange(word, ""));
  }
  return all;
}

std::vector<std::string_view> forbidden_in(std::string_view text) {
  static auto const phrases = [] {
    std::vector<std::vector<std::string>> all;
    for (auto const phrase : forbidden) all.push_back(words_of(phrase));
    return all;
  }();
  std::vector<std::string_view> found;
  auto const words = words_of(text);
  for (std::size_t k = 0; k < words.size(); ++k)
    for (std::size_t i = 0; i < phrases.size(); ++i)
      if (k + phrases[i].size() <= words.size() && std::equal(phrases[i].begin(), phrases[i].end(), words.begin() + k))
        found.push_back(forbidden[i]);
  return found;
}

/// A paragraph, an item of a list, a heading or a row of a table, on one line.
struct Paragraph {
  enum Kind { text, heading, row, head } kind;
  std::size_t line;
  std::string prose;
};

/// Inline code becomes one word, and links lose their targets.
std::string plain(std::string_view markdown) {
  std::string out;
  for (std::size_t k = 0; k < markdown.size(); ++k) {
    char const c = markdown[k];
    std::size_t end = std::string_view::npos;
    if (c == '`' && (end = markdown.find('`', k + 1)) != std::string_view::npos) {
      out += "CODE";
      k = end;
    } else if (c == ']' && markdown.substr(k, 2) == "](" && (end = markdown.find(')', k)) != std::string_view::npos) {
      k = end;
    } else if (c != '*' && c != '[') {
      out += c;
    }
  }
  return out;
}

std::vector<std::string> lines_of(fs::path const& page) {
  std::vector<std::string> all;
  std::ifstream file(page);
  for (std::string line; std::getline(file, line);) all.push_back(line);
  return all;
}

/// The lines that are prose; code, generated tables and comments of HTML are empty.
std::vector<std::string> prose_lines(fs::path const& page) {
  auto lines = lines_of(page);
  bool fenced = false, generated = false, indented = false, before_is_empty = true;
  for (auto& line : lines) {
    bool const fence = line.find("```") == line.find_first_not_of(' ') && !line.empty();
    if (line.starts_with("<!-- made from")) generated = true;
    indented = line.starts_with("    ") && (indented || before_is_empty);
    before_is_empty = line.empty();
    bool const code = fenced || fence || generated || indented || line.starts_with("<");
    if (line.starts_with("<!-- end")) generated = false;
    if (fence) fenced = !fenced;
    if (code) line.clear();
  }
  return lines;
}

bool begins_item(std::string_view line) {
  std::size_t const at = std::min(line.find_first_not_of(" >"), line.size());
  std::string_view const rest = line.substr(at);
  if (rest.starts_with("- ") || rest.starts_with("* ")) return true;
  std::size_t const digits = std::min(rest.find_first_not_of("0123456789"), rest.size());
  return digits > 0 && rest.substr(digits).starts_with(". ");
}

std::vector<Paragraph> paragraphs(fs::path const& page) {
  std::vector<Paragraph> all;
  bool open = false;
  auto const lines = prose_lines(page);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    auto const& line = lines[k];
    auto const first = line.find_first_not_of(' ');
    if (first == std::string::npos) {
      open = false;
    } else if (line[first] == '|') {
      bool const head = k + 1 < lines.size() && lines[k + 1].find("|---") != std::string::npos;
      all.push_back({head ? Paragraph::head : Paragraph::row, k + 1, plain(line)});
      open = false;
    } else if (line[first] == '#') {
      all.push_back({Paragraph::heading, k + 1, plain(line)});
      open = false;
    } else if (open && !begins_item(line)) {
      all.back().prose += " " + plain(line);
    } else {
      all.push_back({Paragraph::text, k + 1, plain(line)});
      open = true;
    }
  }
  return all;
}

bool ends_sentence(std::string word) {
  word.erase(0, word.find_first_not_of("(\"'"));
  while (!word.empty() && std::string_view(")\"'").find(word.back()) != std::string_view::npos) word.pop_back();
  if (word.empty() || std::string_view(".!?").find(word.back()) == std::string_view::npos) return false;
  for (std::string_view const abbreviation : {"e.g.", "i.e.", "vs.", "Eq.", "Eqs.", "Fig.", "No."})
    if (word == abbreviation) return false;
  return word.size() != 2 || std::isupper(static_cast<unsigned char>(word[0])) == 0;  // an initial
}

/// Sentences and their words. The end of a paragraph or of an item ends a sentence.
std::pair<std::size_t, std::size_t> sentences(std::vector<Paragraph> const& all) {
  std::size_t count = 0, words = 0;
  for (auto const& paragraph : all) {
    if (paragraph.kind != Paragraph::text) continue;
    std::istringstream in(paragraph.prose);
    bool inside = false;
    for (std::string word; in >> word;) {
      if (std::none_of(word.begin(), word.end(), [](unsigned char c) { return std::isalnum(c) != 0; })) continue;
      ++words;
      inside = !ends_sentence(word);
      if (!inside) ++count;
    }
    if (inside) ++count;
  }
  return {count, words};
}

std::size_t columns(std::string_view line) {
  return static_cast<std::size_t>(
      std::count_if(line.begin(), line.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

/// A page of the documentation, by its path in the repository.
struct Page {
  std::string name;
};
void PrintTo(Page const& page, std::ostream* out) { *out << page.name; }

std::vector<Page> pages() {
  std::vector<Page> all{{"README.md"}, {"CONTRIBUTING.md"}};
  for (auto const& page : files_below("docs", {".md"})) all.push_back({fs::relative(page, source("")).string()});
  return all;
}

class Prose : public testing::TestWithParam<Page> {};
INSTANTIATE_TEST_SUITE_P(Page, Prose, testing::ValuesIn(pages()), [](testing::TestParamInfo<Page> const& info) {
  std::string name = info.param.name.substr(0, info.param.name.rfind('.'));
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
});

bool is_exception(std::string_view page, std::string_view phrase) {
  return std::any_of(exceptions.begin(), exceptions.end(),
                     [&](Exception const& one) { return one.page == page && one.phrase == phrase; });
}

void expect_no_forbidden_words(std::string const& page) {
  for (auto const& paragraph : paragraphs(source(page))) {
    for (auto const phrase : forbidden_in(paragraph.prose))
      EXPECT_TRUE(is_exception(page, phrase))
          << page << ":" << paragraph.line << ": write this without '" << phrase << "': " << paragraph.prose;
    bool const has_old_head =
        paragraph.kind == Paragraph::head && paragraph.prose.find("without it") != std::string::npos;
    EXPECT_FALSE(has_old_head) << page << ":" << paragraph.line << ": write 'Default' as the head of this column";
  }
}

void expect_short_sentences(std::string const& page) {
  auto const [count, words] = sentences(paragraphs(source(page)));
  EXPECT_LE(words, longest_page) << page << ": split this page";
  if (count < 5) return;
  EXPECT_LE(static_cast<double>(words), longest_mean_sentence * static_cast<double>(count))
      << page << ": " << words << " words in " << count << " sentences";
}

void expect_short_lines(std::string const& page) {
  auto const lines = prose_lines(source(page));
  for (std::size_t k = 0; k < lines.size(); ++k)
    EXPECT_TRUE(lines[k].starts_with("|") || columns(lines[k]) <= longest_line)
        << page << ":" << k + 1 << ": a line of " << columns(lines[k]) << " columns; wrap it at 100";
}

std::string without_code(std::string line) {
  for (std::size_t from = 0; (from = line.find('`', from)) != std::string::npos;) {
    std::size_t const to = line.find('`', from + 1);
    line.erase(from, to == std::string::npos ? to : to + 1 - from);
  }
  return line;
}

void expect_links_resolve(std::string const& page) {
  std::size_t number = 0;
  for (auto const& raw : prose_lines(source(page))) {
    ++number;
    std::string const line = without_code(raw);
    for (std::size_t at = 0; (at = line.find("](", at)) != std::string::npos; ++at) {
      std::string const link = line.substr(at + 2, line.find(')', at) - at - 2);
      std::string const target = link.substr(0, link.find('#'));
      if (target.empty() || target.find(':') != std::string::npos) continue;
      EXPECT_TRUE(fs::exists(source(page).parent_path() / target)) << page << ":" << number << ": broken link " << link;
    }
  }
}

TEST_P(Prose, KeepsTheRules) {
  expect_no_forbidden_words(GetParam().name);
  expect_short_sentences(GetParam().name);
  expect_short_lines(GetParam().name);
  expect_links_resolve(GetParam().name);
}

TEST(ProseCheck, FindsForbiddenWordsAcrossLinesAndCountsSentences) {
  EXPECT_EQ(forbidden_in("Somebody\nis told"), (std::vector<std::string_view>{"somebody", "is told"}));
  EXPECT_TRUE(forbidden_in("whose rules are known").empty());
  EXPECT_EQ(plain("[who](x) and `nobody`"), "who and CODE");
  std::vector<Paragraph> const two{{Paragraph::text, 1, "By X. Lin (e.g. in 1990). Three more words"}};
  EXPECT_EQ(sentences(two), (std::pair<std::size_t, std::size_t>{2, 9}));
}

TEST(ProseExceptions, AreFewAndNeeded) {
  EXPECT_LT(exceptions.size(), 20U);
  for (auto const& [page, phrase, reason] : exceptions) {
    bool needed = false;
    for (auto const& paragraph : paragraphs(source(page)))
      for (auto const found : forbidden_in(paragraph.prose)) needed = needed || found == phrase;
    EXPECT_TRUE(needed) << "remove the exception of '" << phrase << "' in " << page;
    EXPECT_FALSE(reason.empty());
  }
}

/// The end of the comment or literal that starts at `from`, or `from` if none starts there.
std::size_t end_of_comment_or_literal(std::string const& code, std::size_t from) {
  auto const after = [&](std::string const& what, std::size_t at) {
    std::size_t const end = code.find(what, at);
    return end == std::string::npos ? code.size() : end + what.size();
  };
  bool const in_word = from > 0 && std::isalnum(static_cast<unsigned char>(code[from - 1])) != 0;
  if (code.compare(from, 2, "//") == 0) return after("\n", from);
  if (code.compare(from, 2, "/*") == 0) return after("*/", from);
  if (code.compare(from, 2, "R\"") == 0 && !in_word)
    return after(")" + code.substr(from + 2, code.find('(', from) - from - 2) + "\"", from);
  char const quote = code[from];
  if (quote != '"' && (quote != '\'' || in_word)) return from;  // 10'000
  std::size_t at = from + 1;
  while (at < code.size() && code[at] != quote) at += code[at] == '\\' ? 2 : 1;
  return std::min(at + 1, code.size());
}

/// All comments of a source, and all its texts.
struct SourceProse {
  std::string comments, texts;
};
SourceProse prose_of(std::string const& code) {
  SourceProse all;
  for (std::size_t at = 0; at < code.size();) {
    std::size_t const end = end_of_comment_or_literal(code, at);
    if (end == at) {
      ++at;
      continue;
    }
    (code[at] == '/' ? all.comments : all.texts) += code.substr(at, end - at) + " ";
    at = end;
  }
  return all;
}

/// Fails if there are more forbidden words than `most`. Lower the number whenever the printed count is smaller.
void expect_at_most(std::size_t most, std::size_t found, char const* where) {
  std::printf("[ PROSE    ] %zu forbidden words in %s; %zu are allowed\n", found, where, most);
  EXPECT_LE(found, most) << where << " got new forbidden words; CONTRIBUTING.md (Prose) has the list";
}

TEST(ProseOfSources, HasNoMoreForbiddenWordsThanBefore) {
  std::size_t comments = 0, texts = 0, python = 0, scenarios = 0, page = 0;
  std::size_t other = forbidden_in(text_of(source("docs/bzm.1"))).size();
  for (auto const& file : files_below("boltzmann", {".cpp", ".hpp"})) {
    auto const prose = prose_of(text_of(file));
    comments += forbidden_in(prose.comments).size();
    texts += forbidden_in(prose.texts).size();
  }
  for (auto const& file : files_below("python/boltzmann", {".py"})) python += forbidden_in(text_of(file)).size();
  for (auto const& file : files_below("scenarios", {".toml"})) scenarios += forbidden_in(text_of(file)).size();
  for (auto const& file : files_below("boltzmann/window/web/src", {".ts"})) page += forbidden_in(text_of(file)).size();
  for (auto const& file : files_below("docs/notebooks", {".ipynb"})) other += forbidden_in(text_of(file)).size();
  expect_at_most(5, comments, "comments of boltzmann/");
  expect_at_most(0, texts, "texts of boltzmann/");
  expect_at_most(0, python, "python/boltzmann/");
  expect_at_most(0, scenarios, "scenarios/");
  expect_at_most(1, page, "boltzmann/window/web/src/");
  expect_at_most(0, other, "docs/bzm.1 and docs/notebooks/");
}

}  // namespace
}  // namespace boltzmann::prose_test
