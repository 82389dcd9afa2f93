// Tables of the guide that are made from tables of options: they say what the options say.
// BOLTZMANN_WRITE_REFERENCE=1 writes them instead.
#include <boltzmann/core/options.hpp>
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/scenario/classes.hpp>
#include <boltzmann/simulation/picture_options.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace boltzmann {
namespace {

/// A kind of thing with options, such as a drawing.
struct Kind {
  std::string name, doc;
  OptionTable const& options;
};

/// The kinds, and their options: one row for those that mean the same in several.
std::string kinds_and_options(std::string const& head, std::vector<Kind> const& kinds, void* plain) {
  struct Row {
    Option option;
    std::vector<std::string> kinds;
  };
  std::vector<Row> rows;
  std::string text = head + "\n|---|---|---|\n";
  for (auto const& kind : kinds) {
    std::string keys;
    for (auto const& option : kind.options) {
      keys += (keys.empty() ? "`" : " `") + option.key + "`";
      auto const same = [&](Row const& row) {
        return row.option.key == option.key && row.option.doc == option.doc &&
               row.option.otherwise == option.otherwise && allowed(row.option) == allowed(option);
      };
      auto const found = std::find_if(rows.begin(), rows.end(), same);
      if (found != rows.end())
        found->kinds.push_back(kind.name);
      else
        rows.push_back({option, {kind.name}});
    }
    text += "| `" + kind.name + "` | " + kind.doc + " | " + keys + " |\n";
  }
  text += "\n| key | what it is | | without it | of |\n|---|---|---|---|---|\n";
  for (auto const& [option, of] : rows) {
    auto const value = option.otherwise.empty() ? toml_value(option, plain) : "";
    std::string const otherwise = !option.needed.empty()      ? "(needed)"
                                  : !option.otherwise.empty() ? option.otherwise
                                  : value.empty()             ? ""
                                                              : "`" + value + "`";
    text += "| `" + option.key + "` | " + option.doc + " | " + allowed(option) + " | " + otherwise + " | " +
            (of.size() == kinds.size() ? "all" : join(of)) + " |\n";
  }
  return text;
}

std::string pictures() {
  Picture plain;
  std::vector<Kind> kinds;
  for (auto const& drawing : drawings()) kinds.push_back({drawing.name, drawing.doc, drawing.options});
  return kinds_and_options("| drawing | shows | keys |", kinds, &plain);
}

std::string diagnoses() {
  DiagnosisParameters plain;
  std::vector<Kind> kinds;
  for (auto const& kind : diagnosis_kinds()) kinds.push_back({kind.name, kind.doc, kind.options});
  return kinds_and_options("| kind | columns | keys |", kinds, &plain);
}

/// The classes with their fields.
std::string classes() {
  std::string text = "| class | space | fields besides the position | |\n|---|---|---|---|\n";
  for (auto const& one : particle_classes()) {
    std::string space, fields;
    for (auto const& variant : one.variants)
      space += (space.empty() ? "" : " ") + std::to_string(variant.dimension) + "D";
    for (auto const& field : one.variants.back().fields)
      if (field.name != "position") fields += (fields.empty() ? "`" : " `") + field.name + "`";
    text += "| `" + one.name + "` | " + space + " | " + fields + " | " + one.doc + " |\n";
  }
  return text;
}

TEST(Reference, TablesOfTheGuideAreThoseOfTheOptions) {
  struct Table {
    std::string page, name, text;
  };
  for (auto const& table : {Table{"scenarios.md", "pictures", pictures()},
                            {"scenarios.md", "diagnoses", diagnoses()},
                            {"scenarios.md", "classes", classes()}}) {
    std::string const path = std::string(BOLTZMANN_SOURCE) + "/docs/guide/" + table.page;
    std::string page = read_text(path);
    std::string const begin = "<!-- made from options: " + table.name + " -->\n", end = "<!-- end -->";
    auto const from = page.find(begin);
    ASSERT_NE(from, std::string::npos) << table.page << " has no table '" << table.name << "'";
    auto const at = from + begin.size(), count = page.find(end, at) - at;
    if (std::getenv("BOLTZMANN_WRITE_REFERENCE") != nullptr)
      TextFile(path, TextFile::Mode::replace).write(page.replace(at, count, table.text));
    else
      EXPECT_EQ(page.substr(at, count), table.text) << "BOLTZMANN_WRITE_REFERENCE=1 "
                                                    << "tests/docs_tests writes it";
  }
}

// What the page of troubles quotes is said somewhere.
TEST(Reference, TroublesAreMessagesThatThereAre) {
  namespace fs = std::filesystem;
  std::string sources;
  for (auto const& file : fs::recursive_directory_iterator(std::string(BOLTZMANN_SOURCE) + "/boltzmann")) {
    auto const ending = file.path().extension();
    if (file.path().string().find("node_modules") == std::string::npos && (ending == ".cpp" || ending == ".hpp"))
      sources += read_text(file.path().string());
  }
  // Literals that go on in the next line.
  std::string joined;
  for (std::size_t at = 0; at < sources.size(); ++at) {
    auto const next = sources.find_first_not_of(" \n", at + 1);
    if (sources[at] == '"' && at + 1 < sources.size() && sources[at + 1] == '\n' && sources[next] == '"')
      at = next;
    else
      joined += sources[at];
  }
  std::istringstream page(read_text(std::string(BOLTZMANN_SOURCE) + "/docs/guide/troubleshooting.md"));
  int quoted = 0;
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("| `")) continue;
    std::string message = line.substr(3, line.find('`', 3) - 3);
    for (std::size_t dots; !message.empty(); message = dots == std::string::npos ? "" : message.substr(dots + 4)) {
      dots = message.find("...");
      std::string const part = message.substr(0, dots == std::string::npos ? dots : dots - 1);
      EXPECT_NE(joined.find(part), std::string::npos) << part;
      ++quoted;
      if (dots != std::string::npos && dots + 4 > message.size()) break;
    }
  }
  EXPECT_GT(quoted, 10);
}

}  // namespace
}  // namespace boltzmann
