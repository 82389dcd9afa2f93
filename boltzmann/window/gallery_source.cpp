// Forwards the requests of the start page to the gallery.
#include <boltzmann/core/error.hpp>
#include <boltzmann/window/gallery_source.hpp>

namespace boltzmann {
namespace {

using nlohmann::json;

std::string text_or_nothing(json const& request, char const* key) {
  return request.contains(key) ? need_text(request, key) : std::string();
}

json changes(json const& request) {
  if (!request.contains("set") || request["set"].is_null()) return json::object();
  if (!request["set"].is_object()) throw Error("\"set\" is an object, {\"run.steps\": \"100\"}");
  for (auto const& value : request["set"])
    if (!value.is_string() && !value.is_null())  // null: remove the key
      throw Error("values are written as in a scenario file, as texts");
  return request["set"];
}

}  // namespace

json GallerySource::answer(std::string const& what, json const& request) {
  if (what == "scenarios") return gallery_.scenarios();
  if (what == "scenario") return gallery_.scenario(need_text(request, "name"));
  if (what == "check") return gallery_.check(need_text(request, "name"), changes(request));
  if (what == "save")
    return gallery_.save(need_text(request, "name"), changes(request), need_text(request, "as"),
                         request.value("replace", json(false)) == json(true));
  if (what == "run") {
    Choice const choice{need_text(request, "name"), changes(request), text_or_nothing(request, "out")};
    json const answer = gallery_.check_run(choice.name, choice.set, choice.out);
    if (!answer.contains("error")) choice_ = choice;
    return answer;
  }
  throw Error("the gallery can't '" + what + "'; it takes scenarios, scenario, check, save, run and quit");
}

}  // namespace boltzmann
