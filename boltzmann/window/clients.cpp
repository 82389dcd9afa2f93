// The views of each browser, and the messages in both directions. Messages of browsers arrive on the server's thread,
// which only queues them.
#include <boltzmann/core/clock.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/nesting.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/window/clients.hpp>
#include <boltzmann/window/page.hpp>
#include <boltzmann/window/wire.hpp>

#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

namespace boltzmann {
namespace {

using nlohmann::json;

constexpr std::size_t max_views = 8;
constexpr std::size_t max_requests = 256;  // unanswered, of one browser
constexpr std::uint64_t never_drawn = ~std::uint64_t{0};
constexpr double watching_seconds = 10;  // a slow page may take several seconds for one picture

/// The page. Its only script has a nonce that is unique to this answer.
WebFile page() {
  constexpr std::string_view script = "<script type=\"module\"";
  std::string html(page_html()), nonce = random_token();
  if (auto const at = html.find(script); at != std::string::npos)
    html.insert(at + script.size(), " nonce=\"" + nonce + "\"");
  return {"text/html; charset=utf-8", std::make_shared<std::string const>(std::move(html)), std::move(nonce)};
}

struct Wanted {
  int id;
  json view;
  std::string key;  // equal for views that show the same
  std::uint64_t drawn = never_drawn;
};

struct Browser {
  // Written by the server's thread.
  bool ready = false;
  std::int64_t rows = 0, table = -1;
  Clock::time_point last_ready{};
  std::size_t requests = 0;
  // Used by the simulation's thread.
  std::vector<Wanted> views;
  std::uint64_t scene = never_drawn, notice = never_drawn, crowd = never_drawn;
  std::optional<std::pair<std::string, std::size_t>> selected;
  bool selection_changed = false;
};

struct Said {
  std::uint64_t browser;
  json request;  // null: the browser has just connected
};

// A view, with numbers that are not finite removed.
json view_of(json const& given) {
  if (!given.is_object()) throw Error("a view is an object, {\"id\":1,\"diagnosis\":\"Particles\"}");
  if (!given.contains("diagnosis") || !given["diagnosis"].is_string()) throw Error("a view names its \"diagnosis\"");
  json view = given;
  view.erase("id");
  return view;
}

}  // namespace

struct Clients::State {
  std::mutex mutex;
  std::condition_variable stirred;
  std::map<std::uint64_t, Browser> browsers;
  std::deque<Said> said;
  std::atomic<bool> calls{false}, ready{false};
  std::uint64_t crowd = 0;  // changes with the number of browsers
  std::uint64_t event_count = 0,
                handled_count = 0;  // number of events, and its value when they were last handled
  Source* show = nullptr;
  std::unique_ptr<WebServer> server;  // on rank 0; other ranks have no clients
  // The same for its own thread: valid from the start of the server until its thread has ended.
  std::atomic<WebServer*> speaks{nullptr};

  /// A browser that is ready, with views to send.
  struct Turn {
    std::uint64_t id;
    std::vector<Wanted> views;
    std::int64_t rows;
    std::optional<std::pair<std::string, std::size_t>> selected;
  };
  /// All browsers with views to send. Their views are marked as drawn.
  std::vector<Turn> turns(std::uint64_t scene, std::uint64_t notice, ShownTable const* table);

  void joined(std::uint64_t id) {
    std::scoped_lock const lock(mutex);
    browsers[id] = {};
    ++crowd;
    said.push_back({id, nullptr});
    call();
  }

  void left(std::uint64_t id) {
    std::scoped_lock const lock(mutex);
    browsers.erase(id);
    ++crowd;
    stir();
  }

  void call() {
    calls.store(true, std::memory_order_relaxed);
    stir();
  }

  void stir() {
    ++event_count;
    stirred.notify_all();
  }

  void heard(std::uint64_t id, std::string_view text) {
    json request = nested_too_deep(text) ? json() : json::parse(text, nullptr, false);
    if (!request.is_object() || !request.contains("do") || !request["do"].is_string()) {
      if (WebServer* const open = speaks)
        open->send(id, reply_message(nullptr, {{"error", "this message is not a request such as {\"do\": \"play\"}"}}));
      return;
    }
    std::unique_lock lock(mutex);
    auto const found = browsers.find(id);
    if (found == browsers.end()) return;
    if (request["do"] == "next") {
      auto& browser = found->second;
      browser.ready = true;
      browser.last_ready = Clock::now();
      browser.rows = request.value("rows", json()).is_number_integer() ? request["rows"].get<std::int64_t>() : 0;
      browser.table = request.value("table", json()).is_number_integer() ? request["table"].get<std::int64_t>() : -1;
      ready.store(true, std::memory_order_relaxed);
      stir();
      return;
    }
    if (found->second.requests >= max_requests) {
      lock.unlock();
      if (WebServer* const open = speaks) open->dismiss(id, "too many requests at a time");
      return;
    }
    ++found->second.requests;
    said.push_back({id, std::move(request)});
    call();
  }

  static WebMessage reply_message(json const& number, json fields) {
    fields["type"] = "reply";
    fields["id"] = number;
    if (!fields.contains("error")) fields["ok"] = true;
    return WebMessage::of_text(fields.dump(-1, ' ', false, json::error_handler_t::replace));
  }
  void reply(std::uint64_t id, json const& number, json fields) {
    server->send(id, reply_message(number, std::move(fields)));
  }

  void greet(std::uint64_t id) {
    if (show) server->send(id, WebMessage::of_text(show->hello().dump(-1, ' ', false, json::error_handler_t::replace)));
  }

  Browser* find(std::uint64_t id) {
    auto const found = browsers.find(id);
    return found == browsers.end() ? nullptr : &found->second;
  }

  // Handles requests that concern only this browser. A wrong request changes nothing.
  bool of_browser(std::uint64_t id, json const& request) {
    std::string const what = request["do"];
    if (what == "views") {
      auto const& list = request.value("views", json());
      if (!list.is_array() || list.empty() || list.size() > max_views)
        throw Error(fmt::format("\"views\" is a list of 1 to {} views", max_views));
      std::vector<Wanted> views;
      for (auto const& given : list) {
        json const view = view_of(given);
        if (!given.contains("id") || !given["id"].is_number_integer()) throw Error("a view has a number, its \"id\"");
        views.push_back({given["id"].get<int>(), view, view.dump(-1, ' ', false, json::error_handler_t::replace)});
      }
      std::scoped_lock const lock(mutex);
      if (Browser* browser = find(id)) {
        for (auto& view : views)
          for (auto const& old : browser->views)
            if (old.id == view.id && old.key == view.key) view.drawn = old.drawn;
        browser->views = std::move(views);
      }
      return true;
    }
    if (what == "select") {
      std::optional<std::pair<std::string, std::size_t>> selected;
      if (request.contains("ensemble")) {
        if (!request["ensemble"].is_string() || !request.value("particle", json()).is_number_unsigned())
          throw Error("select needs the name of an \"ensemble\" and the number of a \"particle\"");
        selected = {request["ensemble"].get<std::string>(), request["particle"].get<std::size_t>()};
        if (show->particle(selected->first, selected->second).is_null())
          throw Error(fmt::format("there is no particle {} of '{}'", selected->second, selected->first));
      }
      std::scoped_lock const lock(mutex);
      if (Browser* browser = find(id)) {
        browser->selected = selected;
        browser->selection_changed = true;
      }
      return true;
    }
    return false;
  }

  void answer(Said const& said) {
    json const number = said.request.value("id", json());
    try {
      if (!show) throw Error("nothing is shown at the moment");
      if (of_browser(said.browser, said.request)) return reply(said.browser, number, json::object());
      if (said.request["do"] == "picture") {
        PictureFile const file = show->picture(said.request);
        BinaryMessage message;
        std::vector<unsigned char> bytes(file.content.begin(), file.content.end());
        json head{{"type", "reply"},   {"id", number},      {"ok", true},
                  {"name", file.name}, {"mime", file.type}, {"file", message.array(std::move(bytes))}};
        if (!file.frame.empty()) head["box"] = file.frame;
        return server->send(said.browser, message.finish(head));
      }
      reply(said.browser, number, show->perform(said.request));
    } catch (json::exception const&) {
      reply(said.browser, number, {{"error", "a field of the request is of the wrong kind"}});
    } catch (std::exception const& error) {
      reply(said.browser, number, {{"error", error.what()}});
    }
  }
};

Clients::Clients(std::uint16_t port, std::function<std::optional<WebFile>(std::string_view)> file, std::string token)
    : state_(std::make_shared<State>()), calls_(state_->calls), ready_(state_->ready) {
  State* const state = state_.get();
  WebEvents events;
  events.joined = [state](std::uint64_t id) { state->joined(id); };
  events.left = [state](std::uint64_t id) { state->left(id); };
  events.said = [state](std::uint64_t id, std::string_view text) { state->heard(id, text); };
  events.file = [file = std::move(file)](std::string_view path) -> std::optional<WebFile> {
    if (path == "/") return page();
    return file ? file(path) : std::nullopt;
  };
  team().on_first([&] {
    state_->server = std::make_unique<WebServer>(std::move(events), port, std::move(token));
    state_->speaks = state_->server.get();
  });
}

Clients::~Clients() {
  state_->speaks = nullptr;
  state_->server.reset();
}

std::string Clients::address() const { return state_->server ? state_->server->address() : ""; }
std::uint16_t Clients::port() const { return state_->server ? state_->server->port() : std::uint16_t{0}; }

void Clients::open(Source& show) {
  state_->show = &show;
  std::vector<std::uint64_t> all;
  {
    std::scoped_lock const lock(state_->mutex);
    for (auto& [id, browser] : state_->browsers) {
      browser.views.clear();
      browser.selected.reset();
      browser.scene = browser.notice = browser.crowd = never_drawn;
      all.push_back(id);
    }
  }
  for (auto const id : all) state_->greet(id);
}

void Clients::close() { state_->show = nullptr; }

void Clients::bye(std::string const& message) {
  std::vector<std::uint64_t> all;
  {
    std::scoped_lock const lock(state_->mutex);
    for (auto& [id, browser] : state_->browsers) all.push_back(id);
  }
  for (auto const id : all) {
    state_->server->send(id, WebMessage::of_text(json{{"type", "bye"}, {"message", message}}.dump()));
    state_->server->dismiss(id, "the window is closed");
  }
}

int Clients::viewers() const {
  std::scoped_lock const lock(state_->mutex);
  return static_cast<int>(state_->browsers.size());
}

bool Clients::watched() const {
  auto const since = Clock::now() - std::chrono::duration<double>(watching_seconds);
  std::scoped_lock const lock(state_->mutex);
  for (auto const& [id, browser] : state_->browsers)
    if (browser.ready || browser.last_ready > since) return true;
  return false;
}

bool Clients::handle_requests() {
  std::deque<Said> said;
  {
    std::scoped_lock const lock(state_->mutex);
    said.swap(state_->said);
    state_->handled_count = state_->event_count;
    state_->calls.store(false, std::memory_order_relaxed);
    for (auto const& each : said)
      if (Browser* browser = state_->find(each.browser); browser && !each.request.is_null()) --browser->requests;
  }
  for (auto const& each : said) {
    if (each.request.is_null())
      state_->greet(each.browser);
    else
      state_->answer(each);
  }
  return !said.empty();
}

std::vector<Clients::State::Turn> Clients::State::turns(std::uint64_t scene, std::uint64_t notice,
                                                        ShownTable const* table) {
  std::vector<Turn> found;
  std::scoped_lock const lock(mutex);
  bool waiting = false;
  for (auto& [id, browser] : browsers) {
    if (!browser.ready) continue;
    bool news =
        browser.scene != scene || browser.notice != notice || browser.crowd != crowd || browser.selection_changed;
    if (table) {
      if (browser.table != table->number) browser.rows = 0;
      news = news || static_cast<std::size_t>(browser.rows) < table->rows();
    }
    Turn turn{id, {}, browser.rows, browser.selected};
    for (auto& view : browser.views)
      if (view.drawn != scene) {
        turn.views.push_back(view);
        view.drawn = scene;
      }
    if (!news && turn.views.empty()) {
      waiting = true;
      continue;
    }
    browser.ready = false;
    browser.selection_changed = false;
    browser.scene = scene;
    browser.notice = notice;
    browser.crowd = crowd;
    found.push_back(std::move(turn));
  }
  ready.store(waiting, std::memory_order_relaxed);
  return found;
}

namespace {

/// The drawings of one update, shared by browsers with equal views.
class Drawings {
 public:
  explicit Drawings(Source& show) : show_(show) {}

  /// The message about a view; null if there is nothing new.
  json of(Wanted const& view, BinaryMessage& message) {
    auto [found, fresh] = drawn_.try_emplace(view.key);
    if (fresh) found->second = draw(view);
    auto const& [canvas, error] = found->second;
    if (canvas) return {{"id", view.id}, {"canvas", canvas_json(canvas, message)}};
    return error.empty() ? json() : json{{"id", view.id}, {"error", error}};
  }

 private:
  using Drawn = std::pair<std::shared_ptr<Canvas const>, std::string>;  // or the reason for a failure

  Drawn draw(Wanted const& view) const try { return {show_.draw(view.view), ""}; } catch (json::exception const&) {
    return {nullptr, "a field of the view is of the wrong kind"};
  } catch (std::exception const& error) {
    return {nullptr, error.what()};
  }

  Source& show_;
  std::map<std::string, Drawn> drawn_;
};

}  // namespace

bool Clients::send_updates() {
  Source* const show = state_->show;
  if (!show) return false;
  ShownTable const* const table = show->table();
  auto const turns = state_->turns(show->scene(), show->notice(), table);
  if (turns.empty()) return false;
  Drawings drawings(*show);
  json const status = show->status();
  std::size_t const viewers = this->viewers();
  for (auto const& turn : turns) {
    BinaryMessage message;
    json head = status;
    head["type"] = "update";
    head["viewers"] = viewers;
    head["selected"] = turn.selected ? show->particle(turn.selected->first, turn.selected->second) : json();
    auto const known = static_cast<std::size_t>(std::max<std::int64_t>(turn.rows, 0));
    if (table && table->rows() > known) head["table"] = table_json(*table, known, message);
    json& views = head["views"] = json::array();
    for (auto const& view : turn.views)
      if (json one = drawings.of(view, message); !one.is_null()) views.push_back(std::move(one));
    state_->server->send(turn.id, message.finish(head));
  }
  return true;
}

void Clients::wait(double seconds) {
  std::unique_lock lock(state_->mutex);
  state_->stirred.wait_for(lock, std::chrono::duration<double>(seconds),
                           [&] { return state_->event_count != state_->handled_count; });
}

}  // namespace boltzmann
