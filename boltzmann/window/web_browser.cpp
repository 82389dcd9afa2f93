// Messages in frames, pings, and all ways of closing.
#include <boltzmann/window/web_browser.hpp>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <utility>

namespace boltzmann::web {
namespace {

// The size of a read.
constexpr std::size_t piece_bytes = 1U << 14U;

/// At most `bytes` of UTF-8, cut between two characters.
std::string shortened(std::string text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0U) == 0x80U) --bytes;
  text.resize(bytes);
  return text;
}

/// Buffers stored elsewhere; the library copies only two pointers.
struct Slice {
  using value_type = asio::const_buffer;
  using const_iterator = asio::const_buffer const*;
  const_iterator first;
  const_iterator last;
  const_iterator begin() const { return first; }
  const_iterator end() const { return last; }
};

}  // namespace

Browser::Browser(std::uint64_t id, Socket socket, WebEvents const& events, WebLimits const& limits,
                 std::function<void()> forget)
    : id_(id),
      events_(events),
      limits_(limits),
      forget_(std::move(forget)),
      stream_(std::in_place, std::move(socket)),
      timer_(stream_->get_executor()) {
  stream_->auto_fragment(false);
  stream_->read_message_max(limits.message_bytes);
  stream_->set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
    for (auto const& [name, value] : security_headers()) response.set(name, value);
    response.set(boost::beast::http::field::server, "boltzmann");
  }));
  stream_->control_callback([this](websocket::frame_type, boost::beast::string_view) { said_something(); });
}

void Browser::begin(WebRequest const& request) {
  tick();
  stream_->async_accept(request, [self = shared_from_this()](error_code error) {
    if (self->finished_) return;
    if (error) return self->finish();
    self->joined_ = true;
    self->alive_ = Clock::now();
    self->tell([&] {
      if (self->events_.joined) self->events_.joined(self->id_);
    });
    if (!self->closing_) self->read();
    if (!self->writing_ && !self->queue_.empty()) self->write();
  });
}

void Browser::send(WebMessage message) {
  if (leaving_ || finished_) return;
  std::size_t const bytes = message.bytes();
  if (queue_.size() + 1 > limits_.waiting_messages || waiting_ + bytes > limits_.waiting_bytes) {
    // The message being sent ends in the middle: a socket may be closed between two frames.
    queue_.resize(writing_ ? 1 : 0);
    given_up_ = true;
    return leave(websocket::close_code::policy_error, "too slow: what was sent is not being read", close_timeout);
  }
  waiting_ += bytes;
  queue_.push_back(std::move(message));
  if (joined_ && !writing_) write();
}

void Browser::leave(websocket::close_code code, std::string reason, double seconds) {
  if (leaving_ || finished_) return;
  leaving_ = true;
  reason_ = {code, shortened(std::move(reason), 120)};
  alive_ = Clock::now();
  grace_ = seconds;
  if (!joined_) return finish();
  if (!writing_) write();
}

void Browser::finish() {
  if (finished_) return;
  finished_ = true;
  auto const self = shared_from_this();
  timer_.cancel();
  error_code ignored;
  stream_->next_layer().close(ignored);
  if (!writing_) queue_.clear();
  forget_();
  if (joined_) {
    tell([&] {
      if (events_.left) events_.left(id_);
    });
  }
  destroy_stream(16);
}

/// An exception in a handler of the program closes that browser, not the server.
template <class Event>
void Browser::tell(Event const& event) {
  try {
    event();
  } catch (std::exception const&) {
    leave(websocket::close_code::internal_error, "internal error", close_timeout);
  }
}

/// If a wrong frame arrives while the stream is being closed, the library's reader and closer wait for each other
/// forever (1.74), even after the socket has been closed. Only destroying the stream, which owns both, ends them. All
/// other operations have seen the closed socket after this number of further operations.
void Browser::destroy_stream(int later) {
  asio::post(timer_.get_executor(), [self = shared_from_this(), later] {
    if (later > 0) return self->destroy_stream(later - 1);
    self->stream_.reset();
  });
}

/// Reads piece by piece: a close may occur between two pieces of the library's own async_read, and change its state.
void Browser::read() {
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

/// Any frame is a sign of life, but it does not postpone the end of a browser that is being closed.
void Browser::said_something() {
  if (!leaving_) alive_ = Clock::now();
}

void Browser::heard() {
  spoke_ = Clock::now();
  if (!leaving_) pass_on();
  incoming_.consume(incoming_.size());
}

void Browser::pass_on() {
  if (!stream_->got_text()) return leave(websocket::close_code::unknown_data, "text only", close_timeout);
  auto const data = incoming_.data();
  tell([&] {
    if (events_.said) events_.said(id_, {static_cast<char const*>(data.data()), data.size()});
  });
}

/// Prepares the next frame of the first message. Returns true if it is the last.
bool Browser::next_slice() {
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
  return part_ == message.parts.size();
}

void Browser::write() {
  if (queue_.empty() || (given_up_ && !writing_)) {
    if (leaving_) close();
    return;
  }
  bool const last = next_slice();
  writing_ = true;
  stream_->binary(queue_.front().binary);
  stream_->async_write_some(last, Slice{slice_.data(), slice_.data() + slice_.size()},
                            [self = shared_from_this(), last](error_code error, std::size_t) {
                              self->writing_ = false;
                              if (self->finished_) return self->queue_.clear();
                              if (error) return self->finish();
                              self->written(last);
                            });
}

void Browser::written(bool last) {
  alive_ = Clock::now();
  if (last) {
    waiting_ -= queue_.front().bytes();
    queue_.pop_front();
    part_ = 0;
    offset_ = 0;
  }
  write();
}

void Browser::close() {
  if (closing_) return;
  closing_ = true;
  queue_.clear();
  alive_ = Clock::now();
  grace_ = std::min(grace_, close_timeout);
  stream_->async_close(reason_, [self = shared_from_this()](error_code) { self->finish(); });
}

/// Checks the timeouts: of the other side's answers, and of its closing.
void Browser::tick() {
  auto const seconds = std::clamp(limits_.idle_seconds / 8, 0.01, 1.0);
  timer_.expires_after(clock_time(seconds));
  timer_.async_wait([self = shared_from_this()](error_code error) {
    if (error || self->finished_) return;
    if (self->is_over()) return self->finish();
    self->tick();
  });
}

bool Browser::is_over() {
  double const silent = seconds_since(alive_);
  if (!joined_) return silent > limits_.handshake_seconds;
  if (leaving_) return silent > grace_;
  // The library has closed it after a wrong frame, and waits for the other side to close.
  if (!stream_->is_open()) return std::exchange(broken_, true);
  if (silent > limits_.idle_seconds) return true;
  if (silent > limits_.idle_seconds / 2 && !pinging_) {
    pinging_ = true;
    stream_->async_ping({}, [self = shared_from_this()](error_code) { self->pinging_ = false; });
  }
  return false;
}

}  // namespace boltzmann::web
