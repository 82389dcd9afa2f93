// The generated tables of docs/reference agree with the option tables. BOLTZMANN_WRITE_REFERENCE=1 writes them instead.
#include <boltzmann/core/options.hpp>
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/dissipation/dissipation_options.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/formulas/formula_functions.hpp>
#include <boltzmann/pictures/picture_options.hpp>
#include <boltzmann/scenario/classes.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/scenario/load_options.hpp>
#include <boltzmann/scenario/materials.hpp>
#include <boltzmann/scenario/tables.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {
namespace {

/// A kind of thing with options, such as a drawing.
struct Kind {
  std::string name, doc;
  OptionTable const& options;
  void* plain;  ///< an object as it is without options
};

/// An option, and the kinds that have it.
struct Row {
  Option option;
  std::string usual;  ///< its default value, as TOML
  std::vector<std::string> kinds;
};

/// Adds a row, or the kind to the row of an equal option.
void add(std::vector<Row>& rows, Option const& option, std::string const& usual, std::string const& kind) {
  auto const same = [&](Row const& row) {
    return row.option.key == option.key && row.option.doc == option.doc && row.option.otherwise == option.otherwise &&
           row.usual == usual && allowed(row.option) == allowed(option);
  };
  auto const found = std::find_if(rows.begin(), rows.end(), same);
  if (found != rows.end())
    found->kinds.push_back(kind);
  else
    rows.push_back({option, usual, {kind}});
}

std::string default_of(Row const& row) {
  return !row.option.needed.empty()      ? "(needed)"
         : !row.option.otherwise.empty() ? row.option.otherwise
         : row.usual.empty()             ? ""
                                         : "`" + row.usual + "`";
}

std::string keys_of(std::vector<Row> const& rows, std::size_t kinds) {
  std::string text = "\n| Key | Meaning | Value | Default | Of |\n|---|---|---|---|---|\n";
  for (auto const& row : rows)
    text += "| `" + row.option.key + "` | " + row.option.doc + " | " + allowed(row.option) + " | " + default_of(row) +
            " | " + (row.kinds.size() == kinds ? "all" : join(row.kinds)) + " |\n";
  return text;
}

/// The kinds, and their options.
std::string kinds_and_options(std::string const& head, std::vector<Kind> const& kinds) {
  std::vector<Row> rows;
  std::string text = head + "\n|---|---|---|\n";
  for (auto const& kind : kinds) {
    std::string keys;
    for (auto const& option : kind.options) {
      keys += (keys.empty() ? "`" : " `") + option.key + "`";
      add(rows, option, toml_value(option, kind.plain), kind.name);
    }
    text += "| `" + kind.name + "` | " + kind.doc + " | " + keys + " |\n";
  }
  return text + keys_of(rows, kinds.size());
}

/// The keys of one table.
std::string keys_of(OptionTable const& options, void* plain) {
  std::vector<Row> rows;
  for (auto const& option : options) add(rows, option, toml_value(option, plain), "");
  std::string text = "| Key | Meaning | Value | Default |\n|---|---|---|---|\n";
  for (auto const& row : rows)
    text += "| `" + row.option.key + "` | " + row.option.doc + " | " + allowed(row.option) + " | " + default_of(row) +
            " |\n";
  return text;
}

std::string pictures() {
  Picture plain;
  std::vector<Kind> kinds;
  for (auto const& drawing : drawings()) kinds.push_back({drawing.name, drawing.doc, drawing.options, &plain});
  return kinds_and_options("| Drawing | Shows | Keys |", kinds);
}

std::string diagnoses() {
  DiagnosisParameters plain;
  std::vector<Kind> kinds;
  for (auto const& kind : diagnosis_kinds()) kinds.push_back({kind.name, kind.doc, kind.options, &plain});
  return kinds_and_options("| Kind | Columns | Keys |", kinds);
}

/// The laws with their parameters.
std::string laws() {
  auto const cell = [](std::string_view text) {
    std::string cell;
    for (char const c : text) cell += c == '|' ? std::string("\\|") : std::string(1, c);
    return cell;
  };
  std::vector<Row> rows;
  std::string text = "| Law | Meaning | On, by | Parameters | Energy, or influence |\n|---|---|---|---|---|\n";
  for (auto const& law : scenario_laws()) {
    std::string keys;
    for (auto const& option : options_of(law.parameters)) {
      keys += (keys.empty() ? "`" : " `") + option.key + "`";
      add(rows, option, "", std::string(law.name));
    }
    text += "| `" + std::string(law.name) + "` | " + cell(law.doc) + " | " + std::string(law.target) +
            (law.source.empty() ? ", from outside" : ", " + std::string(law.source)) + " | " + keys + " | " +
            cell(law.formula) + " |\n";
  }
  return text + keys_of(rows, scenario_laws().size());
}

std::string materials() {
  std::vector<OptionTable> parameters;
  parameters.reserve(material_catalogue().size());
  std::vector<Kind> kinds;
  for (auto const& material : material_catalogue()) {
    parameters.push_back(options_of(material.parameters));
    kinds.push_back({std::string(material.name), std::string(material.doc) + ": " + std::string(material.formula),
                     parameters.back(), nullptr});
  }
  return kinds_and_options("| `material = { kind = ...` | Meaning | Keys |", kinds);
}
std::string loaders() {
  LoadOptions plain;
  std::vector<Kind> kinds;
  for (auto const& kind : load_kinds())
    kinds.push_back({kind.name, kind.doc + (kind.counted ? "; needs `number`" : ""), kind.options, &plain});
  return kinds_and_options("| `load = { kind = ...` | Initial positions | Keys |", kinds);
}

std::string dissipations() {
  DissipationOptions pairs;
  BathOptions bath;
  std::vector<Kind> kinds;
  for (auto const& kind : dissipation_kinds())
    kinds.push_back({kind.name, kind.doc, kind.options,
                     &kind.options == &dissipation_options() ? static_cast<void*>(&pairs) : &bath});
  return kinds_and_options("| Kind | Meaning | Keys |", kinds);
}

/// The words of a text, in lines of at most 100 columns.
std::string wrapped(std::string_view text) {
  std::istringstream words{std::string(text)};
  std::string lines, line;
  for (std::string word; words >> word;) {
    if (!line.empty() && line.size() + 1 + word.size() > 100) {
      lines += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return lines + line;
}

/// The functions of formulas, and what holds for all formulas.
std::string formula_functions_and_rules() {
  std::string text = "| Function | Meaning | Error below (ulp) |\n|---|---|---|\n";
  for (auto const& function : formula_function_table())
    text += fmt::format("| `{}` | {} | {} |\n", function.name, function.doc,
                        function.error > 0    ? fmt::format("{:g}", function.error)
                        : function.error == 0 ? "exact"
                                              : "sum of products");
  for (auto const& rule : formula_rules) text += fmt::format("\n{}\n", wrapped(rule));
  return text;
}

/// The classes with their fields.
std::string classes() {
  std::string text = "| Class | Space | Fields besides the position | Meaning |\n|---|---|---|---|\n";
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

/// "[[box.walls]]" is on the page box.md.
std::string page_of(std::string const& heading) {
  auto const from = heading.find_first_not_of('[');
  return "scenario/" + heading.substr(from, heading.find_first_of(".]", from) - from) + ".md";
}

/// Option tables link to topics. Their pages, as seen from docs/reference/scenario:
struct Topic {
  std::string_view link, page;
};
constexpr Topic topics[] = {
    {"#formulas", "../formulas.md"},
    {"#laws-that-are-typed", "../../how-to/write-a-formula-law.md"},
    {"#molecules", "../../how-to/build-molecules.md"},
    {"#load", "load.md"},
    {"#material", "material.md"},
    {"#classes", "classes.md"},
    {"#energies-as-papers-have-them", "influences.md#cut-offs-and-tails"},
    {"ensembles.md#events", "events.md"},
    {"units.md#results", "../units.md#results"},
};

/// The text with links to pages instead of topics.
std::string linked(std::string text) {
  for (auto const& [link, page] : topics) {
    std::string const from = "](" + std::string(link) + ")", to = "](" + std::string(page) + ")";
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  }
  return text;
}

TEST(Reference, TablesAreThoseOfTheOptions) {
  struct Table {
    std::string page, name, text;
  };
  std::vector<Table> tables{{"scenario/pictures.md", "pictures", pictures()},
                            {"scenario/diagnoses.md", "diagnoses", diagnoses()},
                            {"scenario/laws.md", "laws", laws()},
                            {"scenario/dissipation.md", "dissipation", dissipations()},
                            {"scenario/load.md", "loaders", loaders()},
                            {"scenario/ensembles.md", "classes", classes()},
                            {"scenario/material.md", "materials", materials()},
                            {"formulas.md", "formula functions", formula_functions_and_rules()},
                            {"scenario/material.md", "fluxes", keys_of(options_of(flux_parameters()), nullptr)},
                            {"scenario/material.md", "elastic", keys_of(options_of(elastic_parameters()), nullptr)}};
  for (auto const& table : scenario_tables())
    tables.push_back({page_of(table.heading), table.heading, keys_of(*table.options, table.plain)});
  for (auto const& table : tables) {
    std::string const path = std::string(BOLTZMANN_SOURCE) + "/docs/reference/" + table.page;
    std::string page = read_text(path), text = linked(table.text);
    std::string const begin = "<!-- made from options: " + table.name + " -->\n", end = "<!-- end -->";
    auto const from = page.find(begin);
    ASSERT_NE(from, std::string::npos) << table.page << " has no table '" << table.name << "'";
    auto const at = from + begin.size(), count = page.find(end, at) - at;
    if (std::getenv("BOLTZMANN_WRITE_REFERENCE") != nullptr)
      TextFile(path, TextFile::Mode::replace).write(page.replace(at, count, text));
    else
      EXPECT_EQ(page.substr(at, count), text) << "run BOLTZMANN_WRITE_REFERENCE=1 tests/docs_tests";
  }
}

// Every message that the page of troubleshooting quotes is in the sources.
TEST(Reference, TroublesAreMessagesThatThereAre) {
  namespace fs = std::filesystem;
  std::string sources;
  for (auto const& file : fs::recursive_directory_iterator(std::string(BOLTZMANN_SOURCE) + "/boltzmann")) {
    auto const ending = file.path().extension();
    if (file.path().string().find("node_modules") == std::string::npos && (ending == ".cpp" || ending == ".hpp"))
      sources += read_text(file.path().string());
  }
  // Join literals that continue on the next line.
  std::string joined;
  for (std::size_t at = 0; at < sources.size(); ++at) {
    auto const next = sources.find_first_not_of(" \n", at + 1);
    if (sources[at] == '"' && at + 1 < sources.size() && sources[at + 1] == '\n' && sources[next] == '"')
      at = next;
    else
      joined += sources[at];
  }
  std::istringstream page(read_text(std::string(BOLTZMANN_SOURCE) + "/docs/reference/troubleshooting.md"));
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
