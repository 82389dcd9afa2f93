// Clients: the browsers connected to a window. Manages their views, their requests, and which of them are ready for the
// next update. A browser receives an update only on request, so that a slow one delays no other and one that never
// reads costs nothing.
#pragma once

#include <boltzmann/window/source.hpp>
#include <boltzmann/window/web_server.hpp>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace boltzmann {

class Clients {
 public:
  /// Starts to listen immediately; in a team of ranks, on rank 0. `file` returns further files by path; it is called on
  /// another thread. Throws Error as WebServer does.
  explicit Clients(std::uint16_t port = 0, std::function<std::optional<WebFile>(std::string_view path)> file = {},
                   std::string token = "");
  ~Clients();
  Clients(Clients const&) = delete;
  Clients& operator=(Clients const&) = delete;

  std::string address() const;
  std::uint16_t port() const;

  /// Sets the source to show, and notifies every browser.
  void open(Source& show);
  /// Removes the source.
  void close();
  /// Sends a last message to all.
  void bye(std::string const& message);

  /// True if a browser has sent a request that needs an answer, or has connected. A single load: may be called after
  /// every step.
  bool calls() const { return calls_.load(std::memory_order_relaxed); }
  /// True if a browser is ready for an update. A single load.
  bool ready() const { return ready_.load(std::memory_order_relaxed); }
  /// The number of open sockets; and whether a browser waits for an update, or has requested one within the last ten
  /// seconds.
  int viewers() const;
  bool watched() const;

  /// Answers pending requests. Returns true if there were any.
  bool handle_requests();
  /// Sends updates to all browsers that are ready. Returns true if any was sent.
  bool send_updates();
  /// Waits for an event since the last handle_requests(), at most for this time.
  void wait(double seconds);

 private:
  struct State;
  std::shared_ptr<State> state_;
  std::atomic<bool>& calls_;
  std::atomic<bool>& ready_;
};

}  // namespace boltzmann
