// Searches folders for runs.
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/scenario/stored_run.hpp>
#include <boltzmann/window/run_list.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

namespace boltzmann {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int deepest = 4;
constexpr std::size_t max_entries = 200'000;  // to search
constexpr std::size_t max_runs = 5'000;

/// picture.png, or the first by name; empty if there is none.
std::string picture_in(fs::path const& run) {
  std::error_code failure;
  if (fs::is_regular_file(run / "picture.png", failure)) return (run / "picture.png").string();
  std::string first;
  for (fs::directory_iterator entry(run, failure), end; !failure && entry != end; entry.increment(failure))
    if (std::error_code ignored; entry->path().extension() == ".png" && entry->is_regular_file(ignored))
      if (auto const path = entry->path().string(); first.empty() || path < first) first = path;
  return first;
}

}  // namespace

std::vector<std::string> RunList::names(std::size_t most) const {
  std::vector<std::string> found;
  std::error_code failure;
  std::size_t seen = 0;
  fs::recursive_directory_iterator entry(folder_, fs::directory_options::skip_permission_denied, failure), end;
  for (; !failure && entry != end && found.size() < most && ++seen < max_entries; entry.increment(failure)) {
    std::error_code ignored;
    if (entry->is_symlink(ignored) || !entry->is_directory(ignored)) continue;
    bool const run = holds_run(entry->path().string());
    if (run) found.push_back(entry->path().lexically_relative(folder_).string());
    if (run || entry.depth() + 1 >= deepest) entry.disable_recursion_pending();
  }
  std::sort(found.begin(), found.end());
  return found;
}

bool RunList::any() const { return !names(1).empty(); }

json RunList::runs() {
  json list = json::array();
  std::vector<std::string> pictures;
  for (auto const& name : names(max_runs)) {
    std::string const run = folder_ + "/" + name;
    json one{{"name", name},     {"title", name}, {"description", ""}, {"particles", nullptr},
             {"steps", nullptr}, {"own", false},  {"picture", nullptr}};
    try {
      auto const outline = outline_stored_run(run);
      if (!outline.title.empty()) one["title"] = outline.title;
      one["description"] = outline.description;
      one["dimension"] = outline.dimension;
      if (outline.particles) one["particles"] = *outline.particles;
      if (outline.steps) one["steps"] = *outline.steps;
      json(one).dump();  // JSON can't represent names that are not UTF-8
    } catch (std::exception const&) {
      continue;  // of another program, or damaged
    }
    if (auto picture = picture_in(run); !picture.empty()) {
      one["picture"] = fmt::format("/run/{}.png", pictures.size());
      pictures.push_back(std::move(picture));
    }
    list.push_back(std::move(one));
  }
  std::scoped_lock const lock(mutex_);
  pictures_ = std::move(pictures);
  return {{"ok", true}, {"scenarios", std::move(list)}};
}

std::string RunList::find(std::string const& name) const {
  auto const all = names(max_runs);
  if (std::find(all.begin(), all.end(), name) == all.end())
    throw Error(fmt::format("there is no run '{}'{}", boltzmann::quoted(name), did_you_mean(name, all)));
  std::string const run = folder_ + "/" + name;
  if (std::error_code ignored; !fs::exists(run + "/trajectory.h5", ignored))
    throw Error(fmt::format("'{}' has no trajectory.h5 to show: the run stored none", run));
  return run;
}

std::optional<WebFile> RunList::picture(std::string_view path) const {
  constexpr std::string_view prefix = "/run/", ending = ".png";
  if (!path.starts_with(prefix) || !path.ends_with(ending)) return std::nullopt;
  path.remove_prefix(prefix.size());
  path.remove_suffix(ending.size());
  std::size_t number = 0;
  auto const [rest, error] = std::from_chars(path.data(), path.data() + path.size(), number);
  if (error != std::errc() || rest != path.data() + path.size()) return std::nullopt;
  std::string file;
  {
    std::scoped_lock const lock(mutex_);
    if (number >= pictures_.size()) return std::nullopt;
    file = pictures_[number];
  }
  try {
    return WebFile{"image/png", std::make_shared<std::string>(read_text(file))};
  } catch (Error const&) {
    return std::nullopt;
  }
}

json RunListSource::hello() const {
  json result = ChoiceSource::hello();
  result["runs"] = true;
  return result;
}

json RunListSource::answer(std::string const& what, json const& request) {
  if (what == "scenarios") return list_.runs();
  if (what == "run") {
    choice_ = list_.find(need_text(request, "name"));
    return json::object();
  }
  throw Error("a list of runs can't '" + what + "'; it takes scenarios, run and quit");
}

}  // namespace boltzmann
