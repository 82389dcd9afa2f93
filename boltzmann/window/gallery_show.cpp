// The requests of the start page, handed to the gallery.
#include <boltzmann/core/error.hpp>
#include <boltzmann/window/gallery_show.hpp>

namespace boltzmann {
namespace {

using nlohmann::json;

std::string need_text(json const& request, char const* key) {
  if (!request.contains(key) || !request[key].is_string())
    throw Error(std::string("the request needs a text \"") + key + "\"");
  return request[key].get<std::string>();
}

std::string text_or_nothing(json const& request, char const* key) {
  return request.contains(key) ? need_text(request, key) : std::string();
}

json changes(json const& request) {
  if (!request.contains("set") || request["set"].is_null()) return json::object();
  if (!request["set"].is_object()) throw Error("\"set\" is an object, {\"run.steps\": \"100\"}");
  for (auto const& value : request["set"])
    if (!value.is_string()) throw Error("what is set is written as in a scenario file, as a text");
  return request["set"];
}

}  // namespace

GalleryShow::GalleryShow(Gallery const& gallery, Audience& audience, std::string message)
    : gallery_(gallery), audience_(audience), message_(std::move(message)) {}

GalleryShow::~GalleryShow() { audience_.close(); }

std::optional<GalleryShow::Choice> GalleryShow::run() {
  audience_.open(*this);
  while (!quit_ && !choice_) {
    audience_.attend();
    audience_.present();
    audience_.wait(1);
  }
  return choice_;
}

json GalleryShow::hello() const {
  json const none = json::array();
  std::string const why = "there is no simulation yet";
  return {{"type", "hello"},
          {"kind", "gallery"},
          {"title", "Boltzmann"},
          {"description", ""},
          {"name", ""},
          {"folder", ""},
          {"message", message_},
          {"dimension", 0},
          {"planned", 0},
          {"box", {{"low", none}, {"high", none}, {"boundary", none}}},
          {"length_unit", ""},
          {"length_factor", 1},
          {"time_unit", ""},
          {"step_size", ""},
          {"step_size_number", 0},
          {"steps_per_frame", 1},
          {"ensembles", none},
          {"quantities", none},
          {"vectors", none},
          {"diagnoses", none},
          {"columns", none},
          {"can", {{"rewind", why}, {"step_size", why}, {"checkpoint", why}, {"seek", why}, {"quit", ""}}},
          {"maps", json::object()},
          {"colours", none}};
}

json GalleryShow::status() const {
  return {{"state", quit_ ? "ended" : "paused"},
          {"step", 0},
          {"time", ""},
          {"time_number", 0},
          {"planned", 0},
          {"steps_per_second", 0},
          {"message", message_},
          {"missed", nullptr}};
}

json GalleryShow::perform(json const& request) {
  std::string const what = request["do"];
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
  if (what == "quit") {
    quit_ = true;
    ++notice_;
    return json::object();
  }
  throw Error("the gallery can't '" + what + "'; it takes scenarios, scenario, check, save, run and quit");
}

std::shared_ptr<Canvas const> GalleryShow::draw(json const&) { throw Error("the gallery has no particles to show"); }
PictureFile GalleryShow::picture(json const&) { throw Error("the gallery has no particles to show"); }
json GalleryShow::particle(std::string const&, std::size_t) const { return nullptr; }

}  // namespace boltzmann
