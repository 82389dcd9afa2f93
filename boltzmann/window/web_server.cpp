// The web server, on Boost.Beast: the one place that knows of sockets.
//
// Everything happens on one thread. Who connects is a Connection: it has asked for nothing yet, or is being answered; one
// request a connection. Who opens a socket becomes a Browser. Each keeps a clock of its own and is closed when it runs
// out, so that nothing that the other side does or leaves undone can hold anything for long.
#define BOOST_ASIO_DISABLE_FENCED_BLOCK  // one thread has nobody to keep in step with
#include <boltzmann/core/error.hpp>
#include <boltzmann/window/web_server.hpp>

#include <fcntl.h>
#include <pthread.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <boost/asio/basic_stream_socket.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <deque>
#include <limits>
#include <list>
#include <thread>
#include <unordered_map>
#include <utility>

namespace boltzmann {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;
using tcp = asio::ip::tcp;
// Sockets and clocks of this context only, which spares every operation an indirection.
using Executor = asio::io_context::executor_type;
using Socket = asio::basic_stream_socket<tcp, Executor>;
using Acceptor = asio::basic_socket_acceptor<tcp, Executor>;
using Timer = asio::basic_waitable_timer<Clock, asio::wait_traits<Clock>, Executor>;
using Request = http::request<http::empty_body>;

// A message leaves in frames of at most so many bytes: between two of them a pong may be sent, a browser may be let go,
// and a slow line shows that it is alive.
constexpr std::size_t frame_bytes = 1U << 18U;
// Read at a time.
constexpr std::size_t piece_bytes = 1U << 14U;
// A closed connection may finish reading what it was told for so long, and may still say so much.
constexpr double close_timeout = 1;
constexpr std::size_t close_bytes = 1U << 18U;
// At the end of the server, all browsers together.
constexpr double end_seconds = 0.1;

constexpr std::pair<char const*, char const*> common_headers[] = {
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cache-Control", "no-store"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
};

constexpr char const* policy_name = "Content-Security-Policy";

/// Of scripts, those that know the nonce alone.
std::string policy(std::string const& nonce) {
  std::string const scripts = nonce.empty() ? "'none'" : "'nonce-" + nonce + "'";
  return "default-src 'none'; script-src " + scripts +
         "; style-src 'unsafe-inline'; img-src 'self' data: blob:; media-src blob:; connect-src 'self'; "
         "base-uri 'none'; form-action 'none'; frame-ancestors http://localhost:* http://127.0.0.1:* 'self'";
}

Clock::duration clock_time(double seconds) { return std::chrono::duration_cast<Clock::duration>(Seconds(seconds)); }

bool is_alphanumeric(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

std::string percent_encoded(std::string_view text) {
  std::string result;
  for (char const c : text) {
    if (is_alphanumeric(c) || c == '-' || c == '.' || c == '_' || c == '~') {
      result += c;
    } else {
      auto const byte = static_cast<unsigned char>(c);
      result += {'%', "0123456789ABCDEF"[byte / 16], "0123456789ABCDEF"[byte % 16]};
    }
  }
  return result;
}

int hexadecimal(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Nothing if a % is not followed by two hexadecimal digits.
std::optional<std::string> percent_decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      result += text[i];
      continue;
    }
    if (i + 2 >= text.size()) return {};
    int const high = hexadecimal(text[i + 1]);
    int const low = hexadecimal(text[i + 2]);
    if (high < 0 || low < 0) return {};
    result += static_cast<char>(16 * high + low);
    i += 2;
  }
  return result;
}

/// The path of a request, decoded; nothing if it could lead out of the folder in which somebody looks for it.
std::optional<std::string> clean_path(std::string_view target) {
  auto path = percent_decoded(target.substr(0, target.find_first_of("?#")));
  if (!path || !path->starts_with('/') || path->find("..") != std::string::npos) return {};
  for (char const c : *path) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == '\\') return {};
  }
  return path;
}

/// The value of token= in the query; nothing unless there is exactly one.
std::optional<std::string> token_in(std::string_view target) {
  std::optional<std::string> found;
  target = target.substr(0, target.find('#'));
  auto const question = target.find('?');
  if (question == std::string_view::npos) return {};
  std::string_view query = target.substr(question + 1);
  while (!query.empty()) {
    auto const end = std::min(query.find('&'), query.size());
    if (query.substr(0, end).starts_with("token=")) {
      if (found) return {};
      found = percent_decoded(query.substr(6, end - 6));
      if (!found) return {};
    }
    query.remove_prefix(std::min(end + 1, query.size()));
  }
  return found;
}

/// Takes as long for a nearly right token as for a wrong one.
bool same_token(std::string_view right, std::string_view given) {
  unsigned volatile difference = right.size() == given.size() ? 0 : 1;
  for (std::size_t i = 0; i < right.size(); ++i) {
    unsigned const byte = given.empty() ? 0U : static_cast<unsigned char>(given[i % given.size()]);
    difference = difference | (static_cast<unsigned char>(right[i]) ^ byte);
  }
  return difference == 0;
}

/// Whether Host names this machine by itself; any port, because `ssh -L` may change it.
bool is_this_machine(std::string_view host) {
  for (std::string_view const name : {"127.0.0.1", "localhost", "[::1]"}) {
    if (!host.starts_with(name)) continue;
    std::string_view const rest = host.substr(name.size());
    if (rest.empty()) return true;
    return rest.size() >= 2 && rest.size() <= 6 && rest[0] == ':' &&
           std::all_of(rest.begin() + 1, rest.end(), [](char c) { return c >= '0' && c <= '9'; });
  }
  return false;
}

std::string_view view(boost::string_view text) { return {text.data(), text.size()}; }

/// What is said instead of what was asked for; empty if all is well so far.
struct Refusal {
  int status = 0;
  std::string text;
};

/// Host, Origin, token and method, in this order, so that a stranger learns nothing of what is here.
Refusal check(Request const& request, std::string_view token, bool upgrade) {
  if (request.count(http::field::host) != 1 || !is_this_machine(view(request[http::field::host]))) {
    return {403, "The window is at 127.0.0.1 or localhost only."};
  }
  auto const origins = request.count(http::field::origin);
  if (origins > 1 || (upgrade && origins == 0) ||
      (origins == 1 && view(request[http::field::origin]) != "http://" + std::string(request[http::field::host]))) {
    return {403, "The window answers its own page only."};
  }
  auto const given = token_in(view(request.target()));
  if (!given || !same_token(token, *given)) {
    return {403, "The token is missing or wrong: open the whole address that was printed, with ?token=..."};
  }
  if (request.method() != http::verb::get) return {405, "Only GET."};
  return {};
}

char const* status_text(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 400:
      return "Bad Request";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 413:
      return "Payload Too Large";
    case 426:
      return "Upgrade Required";
    case 431:
      return "Request Header Fields Too Large";
    case 503:
      return "Service Unavailable";
    default:
      return "Internal Server Error";
  }
}

std::string response_head(int status, std::string_view type, std::size_t bytes, std::string const& nonce = "") {
  std::string head = "HTTP/1.1 " + std::to_string(status) + " " + status_text(status) +
                     "\r\nConnection: close\r\nContent-Length: " + std::to_string(bytes) + "\r\nContent-Type: ";
  head += type;
  head += std::string("\r\n") + policy_name + ": " + policy(nonce);
  for (auto const& [name, value] : common_headers) head += std::string("\r\n") + name + ": " + value;
  if (status == 405) head += "\r\nAllow: GET";
  if (status == 426) head += "\r\nUpgrade: websocket";
  if (status == 503) head += "\r\nRetry-After: 1";
  return head + "\r\n\r\n";
}

constexpr char const* plain_text = "text/plain; charset=utf-8";

/// Tells a connection that there is no room, and closes it, at once.
void reject(Socket& socket) {
  std::string const text = "Too many connections.\n";
  std::string const answer = response_head(503, plain_text, text.size()) + text;
  error_code ignored;
  char heard[4096];
  socket.non_blocking(true, ignored);
  socket.read_some(asio::buffer(heard), ignored);  // closing over unread bytes would cut off the answer
  socket.write_some(asio::buffer(answer), ignored);
  socket.shutdown(Socket::shutdown_send, ignored);
  socket.close(ignored);
}

/// At most `bytes` of UTF-8, cut between two characters.
std::string shortened(std::string text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0U) == 0x80U) --bytes;
  text.resize(bytes);
  return text;
}

/// Buffers that lie elsewhere: copied by the library as two pointers.
struct Slice {
  using value_type = asio::const_buffer;
  using const_iterator = asio::const_buffer const*;
  const_iterator first;
  const_iterator last;
  const_iterator begin() const { return first; }
  const_iterator end() const { return last; }
};

}  // namespace

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

namespace {

class Connection;
class Browser;

/// What belongs together in one server: its place, its visitors, its browsers.
struct Server {
  WebEvents events;
  WebLimits limits;
  std::string token;
  asio::io_context context{1};
  Acceptor acceptor{context};
  Timer pause{context};     // before the next accept, where the last one failed
  Timer patience{context};  // with the last browsers, at the end
  bool ending = false;
  std::list<std::shared_ptr<Connection>> visitors;  // in the order in which they came
  std::unordered_map<std::uint64_t, std::shared_ptr<Browser>> browsers;
  std::uint64_t last_browser = 0;
  std::uint16_t port = 0;
  std::thread thread;

  void listen(std::uint16_t wanted);
  void accept();
  void welcome(Socket socket);
  void forget(Connection const* visitor);
  void forget(std::uint64_t browser);
  bool room_for_browser();
  void end();
};

/// A connection and its one request, until it is answered.
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
    parser_.body_limit(std::numeric_limits<std::uint64_t>::max());  // it is looked at below
    close_after(state_.limits.handshake_seconds);
    http::async_read_header(socket_, heard_, parser_, [self = shared_from_this()](error_code error, std::size_t) {
      if (!self->closed_) self->heard(error);
    });
  }

  /// Makes room for another.
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
      // A wait that was over just when its clock was set anew is no end.
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

    Request const& request = parser_.get();
    bool const upgrade = request.count(http::field::upgrade) > 0;
    Refusal const refusal = check(request, state_.token, upgrade);
    known_ = refusal.status == 0 || refusal.status == 405;
    if (refusal.status != 0) return answer(refusal.status, refusal.text);
    if (parser_.chunked()) return answer(400, "A request has no body here.");
    if (parser_.content_length() && *parser_.content_length() > 0) {
      return answer(413, "A request has no body here.");
    }
    auto const path = clean_path(view(request.target()));
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

  void open_socket(Request const& request);

  void answer(int status, std::string const& text) {
    send(status, plain_text, std::make_shared<std::string const>(text + "\n"));
  }

  void send(int status, std::string_view type, std::shared_ptr<std::string const> content,
            std::string const& nonce = "") {
    answered_ = true;
    content_ = std::move(content);
    head_ = response_head(status, type, content_->size(), nonce);
    bool const head_only = parser_.get().method() == http::verb::head;
    std::array<asio::const_buffer, 2> const buffers = {asio::buffer(head_),
                                                       asio::buffer(*content_, head_only ? 0 : content_->size())};
    // Whoever knows the token may read slowly, but not stop reading.
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

  /// Closing over unread bytes would cut off the answer: reads until the other side has closed.
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
  bool known_ = false;  // has shown the token
  bool answered_ = false;
  bool closed_ = false;
};

/// A socket: what waits to be sent, and the signs of life.
class Browser : public std::enable_shared_from_this<Browser> {
 public:
  Browser(Server& state, std::uint64_t id, Socket socket)
      : state_(state), id_(id), stream_(std::in_place, std::move(socket)), timer_(state.context) {
    stream_->auto_fragment(false);
    stream_->read_message_max(state.limits.message_bytes);
    stream_->set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(policy_name, policy(""));
      for (auto const& [name, value] : common_headers) response.set(name, value);
      response.set(http::field::server, "boltzmann");
    }));
    stream_->control_callback([this](websocket::frame_type, boost::beast::string_view) { said_something(); });
  }

  void begin(Request const& request) {
    tick();
    stream_->async_accept(request, [self = shared_from_this()](error_code error) {
      if (self->finished_) return;
      if (error) return self->finish();
      self->joined_ = true;
      self->alive_ = Clock::now();
      self->tell([&] {
        if (self->state_.events.joined) self->state_.events.joined(self->id_);
      });
      if (!self->closing_) self->read();
      if (!self->writing_ && !self->queue_.empty()) self->write();
    });
  }

  bool leaving() const { return leaving_ || finished_; }
  /// When it has said something last.
  Clock::time_point spoke() const { return spoke_; }

  void send(WebMessage message) {
    if (leaving_ || finished_) return;
    std::size_t const bytes = message.bytes();
    if (queue_.size() + 1 > state_.limits.waiting_messages || waiting_ + bytes > state_.limits.waiting_bytes) {
      // The message that is on its way ends in the middle: a socket may be closed between two frames.
      queue_.resize(writing_ ? 1 : 0);
      given_up_ = true;
      return leave(websocket::close_code::policy_error, "too slow: what was sent is not being read", close_timeout);
    }
    waiting_ += bytes;
    queue_.push_back(std::move(message));
    if (joined_ && !writing_) write();
  }

  /// Closes after what is waiting; gives up when nothing has moved for so long.
  void leave(websocket::close_code code, std::string reason, double seconds) {
    if (leaving_ || finished_) return;
    leaving_ = true;
    reason_ = {code, shortened(std::move(reason), 120)};
    alive_ = Clock::now();
    grace_ = seconds;
    if (!joined_) return finish();
    if (!writing_) write();
  }

  void finish() {
    if (finished_) return;
    finished_ = true;
    auto const self = shared_from_this();
    timer_.cancel();
    error_code ignored;
    stream_->next_layer().close(ignored);
    if (!writing_) queue_.clear();
    state_.forget(id_);
    if (joined_) {
      tell([&] {
        if (state_.events.left) state_.events.left(id_);
      });
    }
    destroy_stream(16);
  }

 private:
  /// What fails in the program behind an event is that browser's end, not the server's.
  template <class Event>
  void tell(Event const& event) {
    try {
      event();
    } catch (std::exception const&) {
      leave(websocket::close_code::internal_error, "internal error", close_timeout);
    }
  }

  /// A wrong frame that comes while the stream is being closed makes the library's reader and closer wait for each
  /// other for ever (1.74), also after the socket has been closed; only the end of the stream, which owns both, ends
  /// them. All else that was going on has found the socket closed before so many other things are done.
  void destroy_stream(int later) {
    asio::post(state_.context, [self = shared_from_this(), later] {
      if (later > 0) return self->destroy_stream(later - 1);
      self->stream_.reset();
    });
  }

  /// Piece by piece: between two pieces of the library's own async_read a close may come, and change what it goes on
  /// with.
  void read() {
    stream_->async_read_some(incoming_.prepare(piece_bytes),
                             [self = shared_from_this()](error_code error, std::size_t bytes) {
                               if (self->finished_ || self->closing_) return;
                               if (error) return self->finish();
                               self->said_something();
                               self->incoming_.commit(bytes);
                               if (self->stream_->is_message_done()) self->heard();
                               if (!self->finished_ && !self->closing_) self->read();
                             });
  }

  /// Any frame is a sign of life; but who is to leave can't put it off by talking.
  void said_something() {
    if (!leaving_) alive_ = Clock::now();
  }

  void heard() {
    spoke_ = Clock::now();
    if (!leaving_) pass_on();
    incoming_.consume(incoming_.size());
  }

  void pass_on() {
    if (!stream_->got_text()) return leave(websocket::close_code::unknown_data, "text only", close_timeout);
    auto const data = incoming_.data();
    tell([&] {
      if (state_.events.said) state_.events.said(id_, {static_cast<char const*>(data.data()), data.size()});
    });
  }

  /// The next frame of the message in front.
  void write() {
    if (queue_.empty() || (given_up_ && !writing_)) {
      if (leaving_) close();
      return;
    }
    WebMessage const& message = queue_.front();
    slice_.clear();
    std::size_t room = frame_bytes;
    while (part_ < message.parts.size() && room > 0) {
      WebPart const& part = message.parts[part_];
      std::size_t const some = std::min(room, part.bytes - offset_);
      if (some > 0) slice_.emplace_back(static_cast<char const*>(part.data) + offset_, some);
      room -= some;
      offset_ += some;
      if (offset_ == part.bytes) {
        ++part_;
        offset_ = 0;
      }
    }
    bool const last = part_ == message.parts.size();
    writing_ = true;
    stream_->binary(message.binary);
    stream_->async_write_some(last, Slice{slice_.data(), slice_.data() + slice_.size()},
                              [self = shared_from_this(), last](error_code error, std::size_t) {
                                self->writing_ = false;
                                if (self->finished_) return self->queue_.clear();
                                if (error) return self->finish();
                                self->written(last);
                              });
  }

  void written(bool last) {
    alive_ = Clock::now();
    if (last) {
      waiting_ -= queue_.front().bytes();
      queue_.pop_front();
      part_ = 0;
      offset_ = 0;
    }
    write();
  }

  void close() {
    if (closing_) return;
    closing_ = true;
    queue_.clear();
    alive_ = Clock::now();
    grace_ = std::min(grace_, close_timeout);
    stream_->async_close(reason_, [self = shared_from_this()](error_code) { self->finish(); });
  }

  /// Looks at the clock: whether the other side still lives, whether it takes its leave.
  void tick() {
    auto const seconds = std::clamp(state_.limits.idle_seconds / 8, 0.01, 1.0);
    timer_.expires_after(clock_time(seconds));
    timer_.async_wait([self = shared_from_this()](error_code error) {
      if (error || self->finished_) return;
      if (self->is_over()) return self->finish();
      self->tick();
    });
  }

  bool is_over() {
    double const silent = Seconds(Clock::now() - alive_).count();
    if (!joined_) return silent > state_.limits.handshake_seconds;
    if (leaving_) return silent > grace_;
    // The library has closed it after a wrong frame, and now waits for the other side to close, too.
    if (!stream_->is_open()) return std::exchange(broken_, true);
    if (silent > state_.limits.idle_seconds) return true;
    if (silent > state_.limits.idle_seconds / 2 && !pinging_) {
      pinging_ = true;
      stream_->async_ping({}, [self = shared_from_this()](error_code) { self->pinging_ = false; });
    }
    return false;
  }

  Server& state_;
  std::uint64_t id_;
  std::optional<websocket::stream<Socket, false>> stream_;
  Timer timer_;
  Clock::time_point alive_ = Clock::now(), spoke_ = alive_;
  boost::beast::flat_buffer incoming_;
  std::deque<WebMessage> queue_;
  std::size_t waiting_ = 0;  // bytes in the queue
  std::size_t part_ = 0;     // where the next frame begins in the message in front
  std::size_t offset_ = 0;
  std::vector<asio::const_buffer> slice_;  // the frame that is being written
  websocket::close_reason reason_;
  double grace_ = 0;
  bool joined_ = false;
  bool writing_ = false;
  bool pinging_ = false;
  bool broken_ = false;
  bool leaving_ = false;   // nothing new is sent, nothing heard is told
  bool given_up_ = false;  // and what waits is not sent either
  bool closing_ = false;   // the last frame is on its way
  bool finished_ = false;
};

void Connection::open_socket(Request const& request) {
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
  auto const browser = std::make_shared<Browser>(state_, id, std::move(socket_));
  close();
  state_.browsers.emplace(id, browser);
  browser->begin(request);
}

void Server::listen(std::uint16_t wanted) {
  tcp::endpoint const place(asio::ip::address_v4::loopback(), wanted);
  try {
    acceptor.open(place.protocol());
    ::fcntl(acceptor.native_handle(), F_SETFD, FD_CLOEXEC);  // programs that are started don't hold the port
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
    if (!error) {
      welcome(std::move(socket));
      return accept();
    }
    // Too many open files, for one: others may close some.
    pause.expires_after(clock_time(0.1));
    pause.async_wait([this](error_code) {
      if (!ending) accept();
    });
  });
}

/// At most half of the places are for strangers, who have not shown the token; they have a tenth of the handshake's
/// time for certain, and more as long as nobody else wants their place. So strangers who keep silent can't lock out a
/// browser.
void Server::welcome(Socket socket) {
  ::fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC);
  error_code ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  auto const is_stranger = [](auto const& visitor) { return !visitor->known(); };
  auto const strangers = static_cast<std::size_t>(std::count_if(visitors.begin(), visitors.end(), is_stranger));
  if (strangers >= std::max<std::size_t>(limits.connections / 2, 1) ||
      visitors.size() + browsers.size() >= limits.connections) {
    auto const oldest = std::find_if(visitors.begin(), visitors.end(), is_stranger);
    if (oldest == visitors.end() || Clock::now() - (*oldest)->since() < clock_time(limits.handshake_seconds / 10)) {
      return reject(socket);
    }
    auto const leaver = *oldest;
    leaver->evict();
  }
  auto const visitor = std::make_shared<Connection>(*this, std::move(socket));
  visitors.push_back(visitor);
  visitor->begin();
}

void Server::forget(Connection const* visitor) {
  visitors.remove_if([&](auto const& other) { return other.get() == visitor; });
}

void Server::forget(std::uint64_t browser) {
  browsers.erase(browser);
  if (ending && browsers.empty()) patience.cancel();
}

/// So that a program which keeps all places, and has nothing to say, doesn't lock out a page.
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

struct WebServer::State : Server {};

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
  // Signals are for the threads of the program, not for this one.
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
          // No memory for one operation, for one: the connection that it belonged to is closed by its clock.
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
  asio::post(state_->context, [&state = *state_] { state.end(); });
  state_->thread.join();
}

std::uint16_t WebServer::port() const { return state_->port; }

std::string const& WebServer::token() const { return state_->token; }

std::string WebServer::address() const {
  return "http://127.0.0.1:" + std::to_string(state_->port) + "/?token=" + percent_encoded(state_->token);
}

void WebServer::send(std::uint64_t browser, WebMessage message) {
  asio::post(state_->context, [&state = *state_, browser, message = std::move(message)]() mutable {
    auto const found = state.browsers.find(browser);
    if (found == state.browsers.end()) return;
    auto const there = found->second;
    there->send(std::move(message));
  });
}

void WebServer::dismiss(std::uint64_t browser, std::string reason) {
  asio::post(state_->context, [&state = *state_, browser, reason = std::move(reason)]() mutable {
    auto const found = state.browsers.find(browser);
    if (found == state.browsers.end()) return;
    auto const there = found->second;
    there->leave(websocket::close_code::normal, std::move(reason), state.limits.handshake_seconds);
  });
}

}  // namespace boltzmann
