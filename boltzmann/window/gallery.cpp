// The replies of the gallery.
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/scenario/document.hpp>
#include <boltzmann/window/gallery.hpp>

#include <fmt/format.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

namespace boltzmann {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t max_bytes = 4 << 20;      // of a scenario in the folder
constexpr std::size_t max_values = 10'000;      // of `set`
constexpr std::size_t max_letters = 1'000'000;  // of one value

/// A scenario of the gallery and its file.
struct Choice {
  std::string name, path;
  bool own = false;
};

bool is_shipped(std::vector<std::string> const& shipped, std::string const& name) {
  return std::find(shipped.begin(), shipped.end(), name) != shipped.end();
}

std::string shipped_path(std::string const& name) { return (fs::path(scenario_folder()) / (name + ".toml")).string(); }

/// All files that may be scenarios. User files are not yet validated.
std::vector<Choice> choices(std::string const& folder) {
  auto const shipped = shipped_scenarios();
  std::vector<Choice> all;
  for (auto const& name : shipped) all.push_back({name, shipped_path(name), false});
  std::error_code failure;
  if (fs::equivalent(folder, scenario_folder(), failure)) return all;
  std::vector<Choice> own;
  for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end; entry.increment(failure)) {
    std::error_code ignored;
    auto const& path = entry->path();
    if (path.extension() != ".toml" || !entry->is_regular_file(ignored) || entry->file_size(ignored) > max_bytes ||
        ignored)
      continue;
    std::string const stem = path.stem().string();
    if (not_utf8(stem)) continue;  // JSON can't represent it
    own.push_back({is_shipped(shipped, stem) ? stem + ".toml" : stem, path.string(), true});
  }
  std::sort(own.begin(), own.end(), [](Choice const& a, Choice const& b) { return a.name < b.name; });
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

Choice choice(std::string const& name, std::string const& folder) {
  auto const all = choices(folder);
  std::vector<std::string> names;
  for (auto const& one : all) {
    if (one.name == name) return one;
    names.push_back(one.name);
  }
  throw Error(fmt::format("there is no scenario '{}'{}", name, did_you_mean(name, names)));
}

/// Paths and values. Names come last, so that paths use the old names.
ScenarioValues values_of(json const& set) {
  if (set.is_null()) return {};
  if (!set.is_object()) throw Error("'set' must be an object of paths and values");
  if (set.size() > max_values) throw Error("'set' has too many values");
  ScenarioValues values;
  for (auto const& [path, value] : set.items()) {
    if (!value.is_string() && !value.is_null())
      throw Error(fmt::format("the value of '{}' must be a text of TOML, or null: the key is left out", path));
    auto const text = value.is_null() ? std::nullopt : std::optional(value.get<std::string>());
    if (text && text->size() > max_letters) throw Error(fmt::format("the value of '{}' is too long", path));
    if (path.empty() || path.find_first_of("= \t\r\n") == 0 || path.find('=') != std::string::npos)
      throw Error(fmt::format("'{}' is no path of a value", path));
    values.emplace_back(path, text);
  }
  std::stable_partition(values.begin(), values.end(),
                        [](auto const& value) { return !value.first.ends_with(".name"); });
  return values;
}

Overrides overrides_of(ScenarioValues const& values) {
  Overrides overrides;
  overrides.by_page = true;
  for (auto const& [path, value] : values)
    if (value)
      overrides.set.push_back(path + "=" + *value);
    else
      overrides.without.push_back(path);
  return overrides;
}

/// Removes the folder of the scenario's file, which is a path on the server, from a line: "copper.toml:25:1: ...".
std::string without_folder(std::string const& line, std::string const& path) {
  auto const slash = path.rfind('/');
  if (path.empty() || slash == std::string::npos || !line.starts_with(path)) return line;
  return line.substr(slash + 1);
}

/// One line of a ScenarioErrors. The path is that of the value that is set, or missing, where the error is; or null.
json error_of(std::string const& told, ScenarioErrors const& errors, ScenarioValues const& values,
              std::string const& file) {
  std::string const line = without_folder(told, file);
  std::vector<std::string> needed;
  for (auto const& key : errors.absent)
    if (key.otherwise == "needed" && line.find(fmt::format("needs '{}'", key_of(key.path))) != std::string::npos)
      needed.push_back(key.path);
  if (needed.size() == 1) return {{"path", needed.front()}, {"message", line}};
  for (auto const& [path, value] : values) {
    if (!value) {
      if (line.find(fmt::format("no '{}'", key_of(path))) != std::string::npos)
        return {{"path", path}, {"message", line}};
      continue;
    }
    std::string prefix = "--set " + path + "=" + *value + ": ";
    std::replace(prefix.begin(), prefix.end(), '\n', ' ');
    if (line.starts_with(prefix)) return {{"path", path}, {"message", line.substr(prefix.size())}};
  }
  return {{"path", nullptr}, {"message", line}};
}

json limit(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json json_of(ScenarioParameter const& parameter) {
  return {{"path", parameter.path},
          {"group", parameter.group},
          {"name", parameter.name},
          {"kind", parameter.kind},
          {"value", parameter.value},
          {"unit", parameter.unit},
          {"base_unit", parameter.base_unit},
          {"units", parameter.units},
          {"low", limit(parameter.low)},
          {"high", limit(parameter.high)},
          {"low_excluded", parameter.low_excluded},
          {"words", parameter.words},
          {"comment", parameter.comment},
          {"doc", parameter.doc},
          {"otherwise", parameter.otherwise}};
}

json json_of(std::vector<ScenarioParameter> const& parameters) {
  json list = json::array();
  for (auto const& parameter : parameters) list.push_back(json_of(parameter));
  return list;
}

/// Numbers that are not finite become null.
json json_of(std::vector<double> const& numbers, double factor) {
  json list = json::array();
  for (double const number : numbers) list.push_back(limit(number * factor));
  return list;
}

/// The curves of typed laws, for small plots: one per text.
json curves_of(ScenarioSimulation const& scenario) {
  constexpr std::size_t points = 160;
  json list = json::array();
  std::string last;
  for (auto const& typed : scenario.typed_laws) {
    if (std::exchange(last, typed.path) == typed.path) continue;  // one of several
    auto const curve = curve_of(typed, points);
    if (curve.distance.empty()) continue;
    auto const length = scenario.units.display(dimensions::length), energy = scenario.units.display(dimensions::energy);
    list.push_back({{"path", typed.path},
                    {"length_unit", length.unit},
                    {"energy_unit", energy.unit},
                    {"distance", json_of(curve.distance, length.factor)},
                    {"force", json_of(curve.force, 1)},
                    {"energy", json_of(curve.energy, energy.factor)}});
  }
  return list;
}

json refusal(std::string const& error) { return {{"error", error}}; }

json refusal(ScenarioErrors const& errors, ScenarioValues const& values, std::string const& file) {
  json list = json::array();
  for (auto const& line : errors.lines) list.push_back(error_of(line, errors, values, file));
  std::string first = list.empty() ? errors.what() : list[0]["message"].get<std::string>();
  if (list.size() > 1) first += fmt::format(" (and {} more)", list.size() - 1);
  json refused = {{"error", first}, {"errors", list}};
  if (!errors.absent.empty()) refused["absent"] = json_of(errors.absent);
  if (!errors.parameters.empty()) refused["parameters"] = json_of(errors.parameters);
  return refused;
}

/// The reply of function(file), or the reason for a failure. The function sets `file` to the path of the scenario.
template <class Function>
json answer(ScenarioValues const& values, Function const& function) {
  std::string file;
  try {
    return function(file);
  } catch (ScenarioErrors const& errors) {
    return refusal(errors, values, file);
  } catch (std::exception const& error) {
    return refusal(without_folder(error.what(), file));
  }
}

/// True if the name is that of a file, without a path to another folder.
bool is_plain_name(std::string_view name) {
  return !name.empty() && name.size() <= 100 && name.front() != '.' && name.front() != '-' &&
         name.find("..") == std::string_view::npos && std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return c >= 0x80 || std::isalnum(c) || c == '-' || c == '_' || c == '.' || c == ' ' || c == '+' || c == ',';
         });
}

/// True if the path is below the folder in which the window was opened; a page can't access others.
bool is_plain_folder(std::string_view path) {
  if (path.size() > 400) return false;
  while (true) {
    auto const slash = path.find('/');
    if (!is_plain_name(path.substr(0, slash))) return false;
    if (slash == std::string_view::npos) return true;
    path.remove_prefix(slash + 1);
  }
}

/// Why results can't be written into `out` below the folder; empty if they can. Links are followed if they stay below
/// it.
std::string wrong_place(fs::path const& folder, std::string const& out) {
  std::error_code failure;
  fs::path const root = fs::canonical(folder, failure);
  fs::path at = folder;
  for (auto const& name : fs::path(out)) {
    at /= name;
    if (!fs::exists(fs::symlink_status(at, failure))) return "";
    fs::path const there = fs::canonical(at, failure);
    if (failure) return fmt::format("'{}' is a link that leads nowhere", at.lexically_normal().string());
    if (std::mismatch(root.begin(), root.end(), there.begin(), there.end()).first != root.end())
      return fmt::format("'{}' is a link that leads out of the present folder", at.lexically_normal().string());
    if (!fs::is_directory(there, failure)) return fmt::format("'{}' is a file", at.lexically_normal().string());
  }
  return "";
}

json picture_of(std::string const& name) {
  std::error_code failure;
  if (!fs::is_regular_file(fs::path(gallery_folder()) / (name + ".png"), failure)) return nullptr;
  return "/gallery/" + name + ".png";
}

/// Writes a file completely or not at all, after `check` has accepted it.
template <class Check>
void write_checked(std::string const& path, std::string const& text, bool replace, Check const& check) {
  std::string const part = fmt::format("{}.{}.part", path, getpid());
  struct Remove {
    std::string const& file;
    ~Remove() {
      std::error_code ignored;
      fs::remove(file, ignored);
    }
  } const remove{part};
  TextFile(part, TextFile::Mode::replace).write(text);
  check(part);
  // Creating a link fails if a file of that name exists, even if it was created after the check.
  int const failed = replace ? std::rename(part.c_str(), path.c_str()) : link(part.c_str(), path.c_str());
  if (failed == 0) return;
  if (errno == EEXIST) throw Error(fmt::format("there is a file '{}' already", path));
  throw Error(fmt::format("can't write '{}': {}", path, std::strerror(errno)));
}

}  // namespace

std::string gallery_folder() {
  fs::path root = fs::path(scenario_folder()).lexically_normal();
  if (!root.has_filename()) root = root.parent_path();  // of "scenarios/"
  root = root.parent_path();
  std::error_code failure;
  for (auto const& folder : {root / "docs" / "gallery", root / "gallery"})
    if (fs::is_directory(folder, failure)) return folder.string();
  return (root / "gallery").string();
}

Gallery::Gallery(std::string folder) : folder_(folder.empty() ? "." : std::move(folder)) {}

json Gallery::scenarios() const {
  json list = json::array();
  for (auto const& one : choices(folder_)) {
    ScenarioOutline outline;
    try {
      outline = outline_scenario(read_scenario(one.path).text, one.path);
    } catch (std::exception const&) {
      continue;  // a file of another program, or unreadable
    }
    list.push_back({{"name", one.name},
                    {"title", outline.title.empty() ? one.name : outline.title},
                    {"description", outline.description},
                    {"particles", outline.particles ? json(*outline.particles) : json(nullptr)},
                    {"steps", outline.steps ? json(*outline.steps) : json(nullptr)},
                    {"dimension", outline.dimension},
                    {"picture", one.own ? json(nullptr) : picture_of(one.name)},
                    {"own", one.own}});
  }
  return {{"ok", true}, {"scenarios", std::move(list)}};
}

json Gallery::scenario(std::string const& name) const {
  return answer({}, [&](std::string& file) -> json {
    Choice const one = choice(name, folder_);
    file = one.path;
    std::string const text = read_scenario(one.path).text;
    auto const outline = outline_scenario(text, one.path);
    json reply = {{"ok", true},
                  {"name", one.name},
                  {"title", outline.title.empty() ? one.name : outline.title},
                  {"description", outline.description},
                  {"text", text},
                  {"parameters", json::array()},
                  {"absent", json::array()},
                  {"picture", one.own ? json(nullptr) : picture_of(one.name)},
                  {"own", one.own}};
    try {
      auto const scenario = load_scenario(one.path, overrides_of({}));
      reply["parameters"] = json_of(scenario->parameters);
      reply["absent"] = json_of(scenario->absent);
      reply["curves"] = curves_of(*scenario);
    } catch (ScenarioErrors const& errors) {
      reply["errors"] = refusal(errors, {}, file)["errors"];
    }
    return reply;
  });
}

json Gallery::check(std::string const& name, json const& set) const {
  ScenarioValues values;
  try {
    values = values_of(set);
  } catch (Error const& error) {
    return refusal(error.what());
  }
  return answer(values, [&](std::string& file) -> json {
    file = choice(name, folder_).path;
    auto const scenario = load_scenario(file, overrides_of(values));
    return {{"ok", true},
            {"parameters", json_of(scenario->parameters)},
            {"absent", json_of(scenario->absent)},
            {"curves", curves_of(*scenario)}};
  });
}

json Gallery::check_run(std::string const& name, json const& set, std::string const& out) const {
  if (!out.empty() && !is_plain_folder(out))
    return refusal(
        fmt::format("'{}' is no folder for results; it is below the present one, of names of letters, digits, blanks "
                    "and - _ + , .",
                    out));
  if (std::string const wrong = wrong_place(folder_, out); !wrong.empty())
    return refusal(fmt::format("results can't go into '{}': {}; choose another folder", out, wrong));
  return check(name, set);
}

json Gallery::save(std::string const& name, json const& set, std::string const& as, bool replace) const {
  json const checked = check(name, set);
  if (!checked.contains("ok")) return checked;
  return answer({}, [&](std::string& /*file*/) -> json {
    if (!is_plain_name(as))
      throw Error(
          fmt::format("'{}' is no name for a scenario; letters, digits, blanks and - _ + , . are allowed, and no "
                      "folder",
                      as));
    std::string const file = as.ends_with(".toml") ? as : as + ".toml";
    if (is_shipped(shipped_scenarios(), file.substr(0, file.size() - 5)))
      throw Error(fmt::format("'{}' is the name of a shipped scenario; choose another one", as));
    std::string const path = (fs::path(folder_) / file).lexically_normal().string();
    std::error_code failure;
    if (!replace && fs::exists(fs::symlink_status(path, failure)))
      throw Error(fmt::format("there is a file '{}' already", path));
    std::string const text = with_values(read_scenario(choice(name, folder_).path).text, values_of(set));
    // Check again at its destination, because it may name other files.
    write_checked(path, text, replace, [&](std::string const& part) {
      try {
        load_scenario(part);
      } catch (ScenarioErrors const& errors) {
        std::string line = errors.lines.front();
        if (line.starts_with(part)) line.replace(0, part.size(), path);
        throw Error(line);
      }
    });
    return {{"ok", true}, {"path", fs::absolute(path).lexically_normal().string()}};
  });
}

std::unique_ptr<ScenarioSimulation> Gallery::load(std::string const& name, json const& set) const {
  return load_scenario(choice(name, folder_).path, overrides_of(values_of(set)));
}

std::optional<WebFile> Gallery::picture(std::string_view path) const {
  constexpr std::string_view prefix = "/gallery/", ending = ".png";
  if (!path.starts_with(prefix) || !path.ends_with(ending)) return std::nullopt;
  std::string_view const file = path.substr(prefix.size());
  if (!is_plain_name(file) || file.size() == ending.size()) return std::nullopt;
  std::ifstream in(fs::path(gallery_folder()) / file, std::ios::binary);
  if (!in) return std::nullopt;
  auto content = std::make_shared<std::string>(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  if (in.bad()) return std::nullopt;
  return WebFile{"image/png", std::move(content)};
}

}  // namespace boltzmann
