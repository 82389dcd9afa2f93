// Clients: the browsers that look at a window. What each of them shows, what they have said, and who is ready for the
// next update; a browser gets one only when it has asked, so that a slow one delays nobody and one that never reads
// costs nothing.
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
  /// Listens at once; in a team of ranks, rank 0 does. `file` gives further files by path; it is called on another
  /// thread. Errors as of WebServer.
  explicit Clients(std::uint16_t port = 0, std::function<std::optional<WebFile>(std::string_view path)> file = {},
                   std::string token = "");
  ~Clients();
  Clients(Clients const&) = delete;
  Clients& operator=(Clients const&) = delete;

  std::string address() const;
  std::uint16_t port() const;

  /// What is shown from now on; every browser is told.
  void open(Source& show);
  /// Nothing is, for now.
  void close();
  /// The last word to all.
  void bye(std::string const& message);

  /// Whether a browser has said something that wants an answer, or has come. One load: may be asked after every step.
  bool calls() const { return calls_.load(std::memory_order_relaxed); }
  /// Whether one is ready for an update. One load.
  bool ready() const { return ready_.load(std::memory_order_relaxed); }
  /// How many have their socket open; and whether one of them waits for an update, or has asked for one within the last
  /// ten seconds.
  int viewers() const;
  bool watched() const;

  /// Answers what has been said. Returns whether there was anything.
  bool handle_requests();
  /// Sends what is new to all that are ready. Returns whether anything was sent.
  bool send_updates();
  /// Waits until something has happened since the last handle_requests(), but not longer than this.
  void wait(double seconds);

 private:
  struct State;
  std::shared_ptr<State> state_;
  std::atomic<bool>& calls_;
  std::atomic<bool>& ready_;
};

}  // namespace boltzmann
