// A small client of HTTP and WebSocket on POSIX sockets, for tests and benchmarks: polite by default, and able to
// misbehave.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boltzmann {

/// A TCP connection to 127.0.0.1. Reading and writing give up after `patience` seconds.
class WebConnection {
 public:
  /// Throws std::runtime_error if nobody listens. receive_bytes: of the socket's buffer (0: the system's choice).
  explicit WebConnection(std::uint16_t port, int receive_bytes = 0) {
    descriptor_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (descriptor_ < 0) throw std::runtime_error("no socket");
    if (receive_bytes > 0) ::setsockopt(descriptor_, SOL_SOCKET, SO_RCVBUF, &receive_bytes, sizeof receive_bytes);
    int const one = 1;
    ::setsockopt(descriptor_, IPPROTO_TCP, TCP_NODELAY, &one, sizeof one);
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(port);
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(descriptor_, reinterpret_cast<sockaddr const*>(&place), sizeof place) != 0) {
      ::close(descriptor_);
      throw std::runtime_error("nobody listens at port " + std::to_string(port));
    }
  }
  WebConnection(WebConnection&& other) noexcept
      : patience(other.patience), descriptor_(std::exchange(other.descriptor_, -1)), ahead_(std::move(other.ahead_)) {}
  WebConnection& operator=(WebConnection&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    std::swap(ahead_, other.ahead_);
    patience = other.patience;
    return *this;
  }
  ~WebConnection() { close(); }

  void close() {
    if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  }
  /// Says nothing more, but listens.
  void shut() { ::shutdown(descriptor_, SHUT_WR); }
  /// Closes by a reset, as a process that is killed may.
  void reset() {
    linger const now{1, 0};
    ::setsockopt(descriptor_, SOL_SOCKET, SO_LINGER, &now, sizeof now);
    close();
  }

  /// False if the other side has gone, or takes nothing more.
  bool write(std::string_view bytes) {
    auto const until = end_of_patience();
    while (!bytes.empty()) {
      if (!wait(POLLOUT, until)) return false;
      auto const sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      if (sent < 0 && errno == EAGAIN) continue;
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }

  using Time = std::chrono::steady_clock::time_point;
  Time end_of_patience() const {
    return std::chrono::steady_clock::now() +
           std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(patience));
  }

  /// Exactly so many bytes; false if they don't come.
  bool read(char* to, std::size_t bytes) { return read(to, bytes, end_of_patience()); }
  bool read(char* to, std::size_t bytes, Time until) {
    std::size_t const known = std::min(bytes, ahead_.size());
    std::copy_n(ahead_.begin(), known, to);
    ahead_.erase(0, known);
    for (std::size_t done = known; done < bytes;) {
      // Without asking poll() first where there is something already.
      auto some = ::recv(descriptor_, to + done, bytes - done, MSG_DONTWAIT);
      if (some < 0 && errno == EAGAIN) {
        if (!wait(POLLIN, until)) return false;
        continue;
      }
      if (some <= 0) return false;
      done += static_cast<std::size_t>(some);
    }
    return true;
  }

  /// Everything until `end` (with it), or until the connection is closed.
  std::string read_until(std::string_view end) {
    auto const until = end_of_patience();
    std::string text = std::exchange(ahead_, {});
    for (;;) {
      if (auto const found = text.find(end); !end.empty() && found != std::string::npos) {
        ahead_ = text.substr(found + end.size());
        text.resize(found + end.size());
        return text;
      }
      char bytes[65536];
      if (!wait(POLLIN, until)) return text;
      auto const some = ::recv(descriptor_, bytes, sizeof bytes, 0);
      if (some <= 0) return text;
      text.append(bytes, static_cast<std::size_t>(some));
    }
  }

  /// Whether the other side closes within so many seconds; what it says until then is dropped.
  bool closed_within(double seconds) {
    patience = seconds;
    auto const until = end_of_patience();
    for (;;) {
      char bytes[65536];
      if (!wait(POLLIN, until)) return false;
      if (::recv(descriptor_, bytes, sizeof bytes, 0) <= 0) return true;
    }
  }

  double patience = 10;

 private:
  bool wait(short what, Time until) const {
    auto const left = std::chrono::duration<double, std::milli>(until - std::chrono::steady_clock::now()).count();
    pollfd one{descriptor_, what, 0};
    return left > 0 && ::poll(&one, 1, static_cast<int>(left) + 1) > 0;
  }

  int descriptor_ = -1;
  std::string ahead_;  // read, but not asked for yet
};

/// An answer to a request; status 0: there was none.
struct WebAnswer {
  int status = 0;
  std::map<std::string, std::string> headers;  // names in lower case
  std::string body;
};

inline WebAnswer read_answer(WebConnection& connection) {
  WebAnswer answer;
  std::string const head = connection.read_until("\r\n\r\n");
  if (!head.starts_with("HTTP/1.1 ") || !head.ends_with("\r\n\r\n")) return answer;
  answer.status = std::atoi(head.c_str() + 9);
  for (std::size_t at = head.find("\r\n") + 2; at + 2 < head.size();) {
    auto const end = head.find("\r\n", at);
    auto const colon = head.find(": ", at);
    std::string name = head.substr(at, colon - at);
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    answer.headers[name] = head.substr(colon + 2, end - colon - 2);
    at = end + 2;
  }
  if (answer.status != 101) answer.body = connection.read_until("");
  return answer;
}

/// The answer to a request as it stands, line ends and all.
inline WebAnswer ask(std::uint16_t port, std::string_view request) {
  WebConnection connection(port);
  connection.write(request);
  return read_answer(connection);
}

inline std::string own_host(std::uint16_t port) { return "127.0.0.1:" + std::to_string(port); }

/// GET; target with its token. Further header lines, each with its line end.
inline WebAnswer get(std::uint16_t port, std::string const& target, std::string const& more = "") {
  return ask(port, "GET " + target + " HTTP/1.1\r\nHost: " + own_host(port) + "\r\n" + more + "\r\n");
}

/// What came through a socket.
struct WebReceived {
  enum class Kind { text, binary, closed, nothing };  // nothing: the connection has ended, or patience
  Kind kind = Kind::nothing;
  std::size_t bytes = 0;  // in the buffer that was handed over
  int code = 0;           // of a close; 0: without one
  std::string reason;
};

/// A WebSocket. Answers pings and a farewell while it waits for a message, if it is polite.
class WebSocketClient {
 public:
  /// Throws std::runtime_error if the upgrade is refused.
  WebSocketClient(std::uint16_t port, std::string const& token, int receive_bytes = 0)
      : connection_(port, receive_bytes) {
    connection_.write(upgrade(port, "/socket?token=" + token));
    answer = read_answer(connection_);
    if (answer.status != 101) throw std::runtime_error("no socket: " + std::to_string(answer.status));
  }

  /// The request that opens a socket.
  static std::string upgrade(std::uint16_t port, std::string const& target) {
    return "GET " + target + " HTTP/1.1\r\nHost: " + own_host(port) + "\r\nOrigin: http://" + own_host(port) +
           "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
           "dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
  }

  /// One frame, right or wrong. first: FIN, reserved bits and opcode. declared: the length that it claims to have.
  static std::string frame(unsigned first, std::string_view payload, bool masked = true,
                           std::optional<std::uint64_t> declared = {}) {
    std::uint64_t const length = declared.value_or(payload.size());
    unsigned const mask_bit = masked ? 0x80 : 0;
    std::string bytes(1, static_cast<char>(first));
    int const more = length < 126 ? 0 : length < 65536 ? 2 : 8;
    bytes += static_cast<char>(mask_bit | (more == 0 ? static_cast<unsigned>(length) : more == 2 ? 126U : 127U));
    for (int i = more - 1; i >= 0; --i) bytes += static_cast<char>(length >> (8 * i));
    if (!masked) return bytes + std::string(payload);
    std::string_view const key = "\x37\xfa\x21\x3d";
    bytes += key;
    for (std::size_t i = 0; i < payload.size(); ++i) bytes += static_cast<char>(payload[i] ^ key[i % 4]);
    return bytes;
  }

  bool say(std::string_view text) { return connection_.write(frame(0x81, text)); }

  /// The next message, put together from its frames, into a buffer that may be used again and again.
  WebReceived receive(std::vector<char>& buffer) {
    using Kind = WebReceived::Kind;
    auto const until = connection_.end_of_patience();
    WebReceived received;
    for (;;) {
      unsigned char head[2];
      if (!connection_.read(reinterpret_cast<char*>(head), 2, until)) return {};
      int const more = (head[1] & 0x7f) == 126 ? 2 : (head[1] & 0x7f) == 127 ? 8 : 0;
      unsigned char digits[8];
      if (!connection_.read(reinterpret_cast<char*>(digits), static_cast<std::size_t>(more), until)) return {};
      std::uint64_t length = more == 0 ? head[1] & 0x7f : 0;
      for (int i = 0; i < more; ++i) length = length << 8 | digits[i];
      unsigned const opcode = head[0] & 0x0f;
      if (opcode >= 8) {
        char payload[125];
        if (length > sizeof payload || !connection_.read(payload, length, until)) return {};
        if (opcode == 9 && polite) connection_.write(frame(0x8a, {payload, length}));
        if (opcode == 9) ++pings;
        if (opcode == 8) {
          received = {Kind::closed, 0, 0, ""};
          if (length >= 2) {
            received.code = static_cast<unsigned char>(payload[0]) << 8 | static_cast<unsigned char>(payload[1]);
            received.reason.assign(payload + 2, length - 2);
          }
          if (polite) connection_.write(frame(0x88, {payload, std::min<std::size_t>(length, 2)}));
          return received;
        }
        continue;
      }
      ++frames;
      if (opcode == 1) received.kind = Kind::text;
      if (opcode == 2) received.kind = Kind::binary;
      if (buffer.size() < received.bytes + length) buffer.resize(received.bytes + length);
      if (!connection_.read(buffer.data() + received.bytes, length, until)) return {};
      received.bytes += length;
      if ((head[0] & 0x80) != 0) return received;
    }
  }

  /// The next text or binary message; "" if the socket has been closed.
  std::string hear() {
    std::vector<char> buffer;
    auto const received = receive(buffer);
    return {buffer.data(), received.bytes};
  }

  /// How the socket ends; messages until then are dropped.
  WebReceived end() {
    std::vector<char> buffer;
    for (;;) {
      auto const received = receive(buffer);
      if (received.kind == WebReceived::Kind::closed || received.kind == WebReceived::Kind::nothing) return received;
    }
  }

  WebConnection& connection() { return connection_; }

  WebAnswer answer;    // to the upgrade
  bool polite = true;  // answers a ping, and a farewell
  int pings = 0;
  std::size_t frames = 0;

 private:
  WebConnection connection_;
};

}  // namespace boltzmann
