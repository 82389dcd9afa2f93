// Web server: one page, a few files and a socket for each browser, on this machine only. Knows nothing of simulations.
//
// It answers on 127.0.0.1 alone, and only who knows the token: every request and every upgrade is checked for its Host
// (a page of a foreign site that found a way to resolve to 127.0.0.1 would say another one), its Origin and the token.
// Nothing can be changed by GET; what a browser wants done, it says through its socket.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// Bytes that live as long as their owner.
struct WebPart {
  std::shared_ptr<void const> owner;
  void const* data;
  std::size_t bytes;

  static WebPart of(std::string text);
};

/// One message to a browser: text, or binary, in parts that are sent one behind the other. What owns the parts is
/// shared, so that several browsers can be sent the same bytes without a copy.
struct WebMessage {
  bool binary = false;
  std::vector<WebPart> parts;

  static WebMessage of_text(std::string text);
  std::size_t bytes() const;
};

/// A file of the page.
struct WebFile {
  std::string type;  ///< "text/html; charset=utf-8", "image/png"
  std::shared_ptr<std::string const> content;
  std::string nonce = {};  ///< of the scripts that stand in it: a browser runs no others
};

/// What the server tells of its browsers, from its own thread: the functions return at once.
struct WebEvents {
  std::function<void(std::uint64_t browser)> joined;                       ///< a socket is open
  std::function<void(std::uint64_t browser, std::string_view text)> said;  ///< a text message
  std::function<void(std::uint64_t browser)> left;                         ///< its socket is closed
  std::function<std::optional<WebFile>(std::string_view path)> file;  ///< GET path, without the query; nothing: 404
};

/// 128 random bits as 32 letters. Error if the system has none.
std::string random_token();

struct WebLimits {
  /// Sockets and requests at a time. Sockets (open pages) have three quarters of the places; one more page gets the place
  /// of the browser that has been silent for longest, if that is more than handshake_seconds, and is refused with 503
  /// otherwise. Connections that have not shown the token have half of the places; the oldest of them makes room for the
  /// next one.
  std::size_t connections = 512;
  std::size_t request_bytes = 16'384;                  ///< of a request's head; it has no body
  std::size_t message_bytes = 262'144;                 ///< of a message from a browser
  std::size_t waiting_bytes = std::size_t{256} << 20;  ///< of messages not yet sent to one browser; above, it is let go
  std::size_t waiting_messages = 256;                  ///< likewise
  double handshake_seconds = 5;  ///< a connection that has not said what it wants by then is closed
  double idle_seconds = 60;      ///< a browser that answers no ping for so long is gone
};

class WebServer {
 public:
  /// Listens at once, on a thread of its own. Port 0: a free one. Token: empty for a random one of 128 bits.
  /// Error if the port is taken (names it).
  WebServer(WebEvents events, std::uint16_t port = 0, std::string token = "", WebLimits limits = {});
  /// Closes all sockets.
  ~WebServer();
  WebServer(WebServer const&) = delete;
  WebServer& operator=(WebServer const&) = delete;

  std::uint16_t port() const;
  std::string const& token() const;
  /// "http://127.0.0.1:40123/?token=..."
  std::string address() const;

  /// Sends to a browser; returns at once. Nothing happens if it has left. May be called from any thread.
  void send(std::uint64_t browser, WebMessage message);
  /// Closes the socket of a browser after what is waiting has been sent, with a reason in at most 120 characters.
  void dismiss(std::uint64_t browser, std::string reason);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace boltzmann
