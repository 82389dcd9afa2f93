// The web server, with Boost.Beast.
//
// Everything runs on one thread. A Connection is a client whose request is pending or being answered, one request per
// connection. A client that opens a socket becomes a Browser. Each has a timer and is closed when it expires, so that a
// peer that does not respond can't block the server for long.
#include <boltzmann/core/error.hpp>
#include <boltzmann/window/web_browser.hpp>

#include <fcntl.h>
#include <pthread.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <list>
#include <thread>
#include <unordered_map>
#include <utility>

namespace boltzmann {

WebPart WebPart::of(std::string text) {
  auto const owner = std::make_shared<std::string const>(std::move(text));
  return {owner, owner->data(), owner->size()};
}

WebMessage WebMessage::of_text(std::string text) { return {false, {WebPart::of(std::move(text))}}; }

std::size_t WebMessage::bytes() const {
  std::size_t sum = 0;
  for (auto const& part : parts) sum += part.bytes;
  return sum;
}

namespace web {
namespace {

namespace http = boost::beast::http;
using Acceptor = asio::basic_socket_acceptor<tcp, Executor>;

// The number of bytes that a closed connection may still send.
constexpr std::size_t close_bytes = 1U << 18U;
// The fraction of handshake_seconds that a client without the token certainly has to send its request.
constexpr double least_handshake = 0.02;
// The time to close all browsers at the end of the server.
constexpr double end_seconds = 0.1;

/// Answers a connection that there is no room, and closes it immediately.
void reject(Socket& socket) {
  std::string const text = "Too many connections.\n";
  std::string const answer = response_head(503, text_type, text.size()) + text;
  error_code ignored;
  char heard[4096];
  socket.non_blocking(true, ignored);
  socket.read_some(asio::buffer(heard), ignored);  // closing with unread data would cut off the answer
  socket.write_some(asio::buffer(answer), ignored);
  socket.shutdown(Socket::shutdown_send, ignored);
  socket.close(ignored);
}

class Connection;

/// The data of one server: connections and browsers.
struct Server {
  WebEvents events;
  WebLimits limits;
  std::string token;
  asio::io_context context{1};
  Acceptor acceptor{context};
  Timer pause{context};     // before the next accept, after a failure or if there is no place
  Timer patience{context};  // for the last browsers, at the end
  bool ending = false;
  std::list<std::shared_ptr<Connection>> visitors;  // in order of arrival
  std::unordered_map<std::uint64_t, std::shared_ptr<Browser>> browsers;
  std::uint64_t last_browser = 0;
  std::uint16_t port = 0;
  std::thread thread;

  void listen(std::uint16_t wanted);
  void accept();
  void accept_after(double seconds);
  void welcome(Socket socket);
  void forget(Connection const* visitor);
  void forget(std::uint64_t browser);
  bool room_for_browser();
  void end();
  /// Calls a function with a browser, on the server's thread, if it still exists.
  template <class Function>
  void with(std::uint64_t browser, Function function) {
    asio::post(context, [this, browser, function = std::move(function)]() mutable {
      auto const found = browsers.find(browser);
      if (found == browsers.end()) return;
      auto const there = found->second;
      function(*there);
    });
  }
};

/// A connection and its single request, until it is answered.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Server& state, Socket socket)
      : state_(state),
        socket_(std::move(socket)),
        timer_(state.context),
        heard_(std::max<std::size_t>(state.limits.request_bytes, 256) + 4096) {}

  bool known() const { return known_; }
  Clock::time_point since() const { return since_; }

  void begin() {
    parser_.header_limit(static_cast<std::uint32_t>(state_.limits.request_bytes));
    parser_.body_limit(std::numeric_limits<std::uint64_t>::max());  // checked below
    close_after(state_.limits.handshake_seconds);
    http::async_read_header(socket_, heard_, parser_, [self = shared_from_this()](error_code error, std::size_t) {
      if (!self->closed_) self->heard(error);
    });
  }

  /// Closes it to make room for another.
  void evict() {
    if (closed_) return;
    if (!answered_) reject(socket_);
    close();
  }

  void close() {
    if (closed_) return;
    closed_ = true;
    timer_.cancel();
    error_code ignored;
    socket_.close(ignored);
    state_.forget(this);
  }

 private:
  void close_after(double seconds) {
    timer_.expires_after(clock_time(seconds));
    timer_.async_wait([self = shared_from_this()](error_code error) {
      // A timer that expired just before it was reset does not count.
      if (!error && self->timer_.expiry() <= Clock::now()) self->close();
    });
  }

  void heard(error_code error) {
    if (error == http::error::header_limit || error == http::error::buffer_overflow) {
      return answer(431, "The request is too long.");
    }
    if (error && error.category() == make_error_code(http::error::bad_method).category() &&
        error != http::error::end_of_stream && error != http::error::partial_message) {
      return answer(400, "The request can't be read.");
    }
    if (error) return close();

    WebRequest const& request = parser_.get();
    bool const upgrade = request.count(http::field::upgrade) > 0;
    Refusal const refusal = check_request(request, state_.token, upgrade);
    known_ = refusal.status == 0 || refusal.status == 405;
    if (refusal.status != 0) return answer(refusal.status, refusal.text);
    if (parser_.chunked()) return answer(400, "A request has no body here.");
    if (parser_.content_length() && *parser_.content_length() > 0) {
      return answer(413, "A request has no body here.");
    }
    auto const path = clean_path(request);
    if (path == "/socket") return open_socket(request);
    if (upgrade) return answer(404, "No socket here.");
    std::optional<WebFile> file;
    try {
      if (path && state_.events.file) file = state_.events.file(*path);
    } catch (std::exception const&) {
      return answer(500, "It can't be made.");
    }
    if (!file || !file->content) return answer(404, "There is nothing here.");
    send(200, file->type, file->content, file->nonce);
  }

  void open_socket(WebRequest const& request);

  void answer(int status, std::string const& text) {
    send(status, text_type, std::make_shared<std::string const>(text + "\n"));
  }

  void send(int status, std::string_view type, std::shared_ptr<std::string const> content,
            std::string const& nonce = "") {
    answered_ = true;
    content_ = std::move(content);
    head_ = response_head(status, type, content_->size(), nonce);
    bool const head_only = parser_.get().method() == http::verb::head;
    std::array<asio::const_buffer, 2> const buffers = {asio::buffer(head_),
                                                       asio::buffer(*content_, head_only ? 0 : content_->size())};
    // A client with the token may read slowly, but not stop reading.
    auto const go_on = [self = shared_from_this()](error_code error, std::size_t sent) -> std::size_t {
      if (self->closed_ || error) return 0;
      if (self->known_ || sent == 0) {
        self->close_after(self->known_ ? self->state_.limits.idle_seconds : self->state_.limits.handshake_seconds);
      }
      return frame_bytes;
    };
    asio::async_write(socket_, buffers, go_on, [self = shared_from_this()](error_code error, std::size_t) {
      if (self->closed_) return;
      if (error) return self->close();
      self->close_after(close_timeout);
      error_code ignored;
      self->socket_.shutdown(Socket::shutdown_send, ignored);
      self->heard_.clear();
      self->wait_for_end();
    });
  }

  /// Closing with unread data would cut off the answer, so read until the other side has closed.
  void wait_for_end() {
    socket_.async_read_some(asio::buffer(scrap_), [self = shared_from_this()](error_code error, std::size_t bytes) {
      if (self->closed_) return;
      self->farewell_ += bytes;
      if (error || self->farewell_ > close_bytes) return self->close();
      self->wait_for_end();
    });
  }

  Server& state_;
  Socket socket_;
  Timer timer_;
  Clock::time_point since_ = Clock::now();
  boost::beast::flat_buffer heard_;
  http::request_parser<http::empty_body> parser_;
  std::string head_;
  std::shared_ptr<std::string const> content_;
  std::array<char, 4096> scrap_;
  std::size_t farewell_ = 0;
  bool known_ = false;  // the client has sent the token
  bool answered_ = false;
  bool closed_ = false;
};

void Connection::open_socket(WebRequest const& request) {
  if (!websocket::is_upgrade(request)) {
    if (request.count(http::field::upgrade) > 0) return answer(400, "This is no way to open a socket.");
    return answer(426, "There is a socket here.");
  }
  if (request[http::field::sec_websocket_version] != "13") {
    return answer(400, "Only version 13 of the WebSocket protocol.");
  }
  if (request[http::field::sec_websocket_key].size() != 24 || heard_.size() > 0) {
    return answer(400, "This is no way to open a socket.");
  }
  if (!state_.room_for_browser()) return answer(503, "Too many windows are open.");
  auto const self = shared_from_this();
  std::uint64_t const id = ++state_.last_browser;
  auto const browser = std::make_shared<Browser>(id, std::move(socket_), state_.events, state_.limits,
                                                 [&server = state_, id] { server.forget(id); });
  close();
  state_.browsers.emplace(id, browser);
  browser->begin(request);
}

void Server::listen(std::uint16_t wanted) {
  tcp::endpoint const place(asio::ip::address_v4::loopback(), wanted);
  try {
    acceptor.open(place.protocol());
    ::fcntl(acceptor.native_handle(), F_SETFD, FD_CLOEXEC);  // child processes must not inherit the port
    acceptor.set_option(Acceptor::reuse_address(true));
    acceptor.bind(place);
    acceptor.listen();
    port = acceptor.local_endpoint().port();
  } catch (boost::system::system_error const& error) {
    std::string const what = "port " + std::to_string(wanted) + " on 127.0.0.1 ";
    std::string const advice = "; choose another by --port, or leave it out for a free one";
    if (error.code() == asio::error::address_in_use) throw Error(what + "is taken" + advice);
    throw Error(what + "can't be opened (" + error.code().message() + ")" + advice);
  }
}

void Server::accept() {
  acceptor.async_accept([this](error_code error, Socket socket) {
    if (ending) return;
    if (error) return accept_after(0.1);  // for example too many open files; others may be closed
    welcome(std::move(socket));
  });
}

/// Meanwhile the operating system queues new connections.
void Server::accept_after(double seconds) {
  pause.expires_after(clock_time(seconds));
  pause.async_wait([this](error_code) {
    if (!ending) accept();
  });
}

/// Connections without the token ("strangers") have at most half of the places. The oldest stranger makes room for a
/// new one, but only after the time to send its request; until then no connection is accepted. So silent connections
/// can't lock out a browser, which sends its request immediately.
void Server::welcome(Socket socket) {
  ::fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC);
  error_code ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  auto const is_stranger = [](auto const& visitor) { return !visitor->known(); };
  auto const strangers = static_cast<std::size_t>(std::count_if(visitors.begin(), visitors.end(), is_stranger));
  bool const full = visitors.size() + browsers.size() >= limits.connections;
  if (full || strangers >= std::max<std::size_t>(limits.connections / 2, 1)) {
    auto const oldest = std::find_if(visitors.begin(), visitors.end(), is_stranger);
    if (oldest == visitors.end()) {  // all places are in use
      reject(socket);
      return accept();
    }
    double const left = limits.handshake_seconds * least_handshake - seconds_since((*oldest)->since());
    if (left > 0) {
      pause.expires_after(clock_time(left));
      pause.async_wait([this, held = std::make_shared<Socket>(std::move(socket))](error_code) {
        if (!ending) welcome(std::move(*held));
      });
      return;
    }
    auto const leaver = *oldest;
    leaver->evict();
  }
  auto const visitor = std::make_shared<Connection>(*this, std::move(socket));
  visitors.push_back(visitor);
  visitor->begin();
  accept();
}

void Server::forget(Connection const* visitor) {
  visitors.remove_if([&](auto const& other) { return other.get() == visitor; });
}

void Server::forget(std::uint64_t browser) {
  browsers.erase(browser);
  if (ending && browsers.empty()) patience.cancel();
}

/// Ensures that silent browsers that occupy all places don't lock out a page.
bool Server::room_for_browser() {
  std::size_t staying = 0;
  std::shared_ptr<Browser> quietest;
  for (auto const& [id, browser] : browsers) {
    if (browser->leaving()) continue;
    ++staying;
    if (!quietest || browser->spoke() < quietest->spoke()) quietest = browser;
  }
  if (staying < std::max<std::size_t>(limits.connections / 4 * 3, 1)) return true;
  if (Clock::now() - quietest->spoke() < clock_time(limits.handshake_seconds)) return false;
  quietest->leave(websocket::close_code::try_again_later, "another page has taken this place", close_timeout);
  return true;
}

void Server::end() {
  ending = true;
  error_code ignored;
  acceptor.close(ignored);
  pause.cancel();
  for (auto const& visitor : std::list(visitors)) visitor->close();
  patience.expires_after(clock_time(end_seconds));
  patience.async_wait([this](error_code) {
    for (auto const& [id, browser] : std::unordered_map(browsers)) browser->finish();
  });
  for (auto const& [id, browser] : std::unordered_map(browsers)) {
    browser->leave(websocket::close_code::going_away, "the window is closed", end_seconds);
  }
  if (browsers.empty()) patience.cancel();
}

}  // namespace
}  // namespace web

struct WebServer::State : web::Server {};

std::string random_token() {
  unsigned char bytes[16];
  if (getentropy(bytes, sizeof bytes) != 0) throw Error("no random numbers from the system for the window's token");
  std::string token;
  for (unsigned const byte : bytes) {
    token += "0123456789abcdef"[byte / 16];
    token += "0123456789abcdef"[byte % 16];
  }
  return token;
}

WebServer::WebServer(WebEvents events, std::uint16_t port, std::string token, WebLimits limits)
    : state_(std::make_unique<State>()) {
  state_->events = std::move(events);
  state_->limits = limits;
  state_->token = token.empty() ? random_token() : std::move(token);
  state_->listen(port);
  state_->accept();
  // Signals are handled by the other threads of the program.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  for (int const own : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGPROF}) sigdelset(&all, own);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  try {
    state_->thread = std::thread([&state = *state_] {
      for (bool done = false; !done;) {
        try {
          state.context.run();
          done = true;
        } catch (std::exception const&) {
          // For example out of memory in one operation; the timer closes its connection.
        }
      }
    });
  } catch (...) {
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    throw;
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

WebServer::~WebServer() {
  web::asio::post(state_->context, [&state = *state_] { state.end(); });
  state_->thread.join();
}

std::uint16_t WebServer::port() const { return state_->port; }

std::string const& WebServer::token() const { return state_->token; }

std::string WebServer::address() const {
  return "http://127.0.0.1:" + std::to_string(state_->port) + "/?token=" + percent_encoded(state_->token);
}

void WebServer::send(std::uint64_t browser, WebMessage message) {
  state_->with(browser,
               [message = std::move(message)](web::Browser& there) mutable { there.send(std::move(message)); });
}

void WebServer::dismiss(std::uint64_t browser, std::string reason) {
  state_->with(browser,
               [reason = std::move(reason), seconds = state_->limits.handshake_seconds](web::Browser& there) mutable {
                 there.leave(web::websocket::close_code::normal, std::move(reason), seconds);
               });
}

}  // namespace boltzmann
