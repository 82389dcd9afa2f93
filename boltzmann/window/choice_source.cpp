// The replies of a start page: no simulation exists yet.
#include <boltzmann/core/error.hpp>
#include <boltzmann/window/choice_source.hpp>

namespace boltzmann {

using nlohmann::json;

std::string need_text(json const& request, char const* key) {
  if (!request.contains(key) || !request[key].is_string())
    throw Error(std::string("the request needs a text \"") + key + "\"");
  return request[key].get<std::string>();
}

ChoiceSource::ChoiceSource(Clients& clients, std::string title, std::string message)
    : clients_(clients), title_(std::move(title)), message_(std::move(message)) {}

ChoiceSource::~ChoiceSource() { clients_.close(); }

void ChoiceSource::wait() {
  clients_.open(*this);
  while (!quit_ && !chosen()) {
    clients_.handle_requests();
    clients_.send_updates();
    clients_.wait(1);
  }
}

// The page supplies the other members of a start page.
json ChoiceSource::hello() const {
  std::string const why = "there is no simulation yet";
  return {{"type", "hello"},
          {"kind", "gallery"},
          {"title", title_},
          {"message", message_},
          {"can", {{"rewind", why}, {"step_size", why}, {"checkpoint", why}, {"seek", why}, {"quit", ""}}}};
}

json ChoiceSource::status() const {
  return {{"state", quit_ ? "ended" : "paused"},
          {"step", 0},
          {"time", ""},
          {"time_number", 0},
          {"planned", 0},
          {"steps_per_second", 0},
          {"message", message_},
          {"missed", nullptr}};
}

json ChoiceSource::perform(json const& request) {
  std::string const what = request["do"];
  if (what != "quit") return answer(what, request);
  quit_ = true;
  ++notice_;
  return json::object();
}

std::shared_ptr<Canvas const> ChoiceSource::draw(json const&) { throw Error("there are no particles to show yet"); }
PictureFile ChoiceSource::picture(json const&) { throw Error("there are no particles to show yet"); }
json ChoiceSource::particle(std::string const&, std::size_t) const { return nullptr; }

}  // namespace boltzmann
