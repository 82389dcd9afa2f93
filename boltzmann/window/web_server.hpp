// Web server: one page, a few files and a socket per browser, on this machine only. Independent of simulations.
// It listens on 127.0.0.1 and requires the token. Every request and every upgrade is checked for its Host (a page of
// another site whose name resolves to 127.0.0.1 would send a different one), its Origin and the token. GET changes
// nothing; a browser sends commands through its socket.
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

/// One message to a browser: text, or binary, in consecutive parts. The owners of parts are shared, so that several
/// browsers can receive the same bytes without a copy.
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
  std::string nonce = {};  ///< of the embedded scripts; a browser runs no others
};

/// Callbacks for events of browsers, on the server's thread. They must return immediately.
struct WebEvents {
  std::function<void(std::uint64_t browser)> joined;                       ///< a socket is open
  std::function<void(std::uint64_t browser, std::string_view text)> said;  ///< a text message
  std::function<void(std::uint64_t browser)> left;                         ///< its socket is closed
  std::function<std::optional<WebFile>(std::string_view path)> file;  ///< GET path, without the query; nothing: 404
};

/// 128 random bits as 32 letters. Throws Error if the system provides none.
std::string random_token();

struct WebLimits {
  /// The number of simultaneous sockets and requests. Sockets (open pages) have three quarters of the places. One more
  /// page replaces the browser that has been silent for longest, if longer than handshake_seconds; otherwise it is
  /// rejected with 503. Connections without the token have half of the places; the oldest of them makes room for a new
  /// one.
  std::size_t connections = 512;
  std::size_t request_bytes = 16'384;                  ///< of the headers of a request, which has no body
  std::size_t message_bytes = 262'144;                 ///< of a message from a browser
  std::size_t waiting_bytes = std::size_t{256} << 20;  ///< of messages queued for one browser; above, it is closed
  std::size_t waiting_messages = 256;                  ///< the same
  double handshake_seconds = 5;                        ///< a connection without a request after this time is closed
  double idle_seconds = 60;                            ///< a browser that answers no ping for this time is closed
};

class WebServer {
 public:
  /// Starts to listen immediately, on a thread of its own. Port 0: any free one. Token: empty for a random one of 128
  /// bits. Throws Error if the port is in use (with its number).
  WebServer(WebEvents events, std::uint16_t port = 0, std::string token = "", WebLimits limits = {});
  /// Closes all sockets.
  ~WebServer();
  WebServer(WebServer const&) = delete;
  WebServer& operator=(WebServer const&) = delete;

  std::uint16_t port() const;
  std::string const& token() const;
  /// "http://127.0.0.1:40123/?token=..."
  std::string address() const;

  /// Sends to a browser and returns immediately. No-op if it has left. May be called from any thread.
  void send(std::uint64_t browser, WebMessage message);
  /// Closes the socket of a browser after its queue has been sent, with a reason of at most 120 characters.
  void dismiss(std::uint64_t browser, std::string reason);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace boltzmann
