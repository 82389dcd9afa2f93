// Web browser: an open socket of a page with its queue of messages and its timeouts. Private to this module.
#pragma once

#include <boltzmann/window/asio_types.hpp>
#include <boltzmann/window/web_request.hpp>
#include <boltzmann/window/web_server.hpp>

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann::web {

namespace websocket = boost::beast::websocket;

/// Is closed when its timer expires, so that a peer that does not respond blocks nothing for long.
class Browser : public std::enable_shared_from_this<Browser> {
 public:
  /// `forget` is called after it has closed; events and limits must outlive it.
  Browser(std::uint64_t id, Socket socket, WebEvents const& events, WebLimits const& limits,
          std::function<void()> forget);

  /// Answers the request that opens the socket.
  void begin(WebRequest const& request);
  void send(WebMessage message);
  /// Closes after the queue has been sent. Gives up if nothing is sent for this time.
  void leave(websocket::close_code code, std::string reason, double seconds);
  void finish();

  bool leaving() const { return leaving_ || finished_; }
  /// The time of the last message from it.
  Clock::time_point spoke() const { return spoke_; }

 private:
  template <class Event>
  void tell(Event const& event);
  void destroy_stream(int later);
  void read();
  void said_something();
  void heard();
  void pass_on();
  bool next_slice();
  void write();
  void written(bool last);
  void close();
  void tick();
  bool is_over();

  std::uint64_t id_;
  WebEvents const& events_;
  WebLimits const& limits_;
  std::function<void()> forget_;
  std::optional<websocket::stream<Socket, false>> stream_;
  Timer timer_;
  Clock::time_point alive_ = Clock::now(), spoke_ = alive_;
  boost::beast::flat_buffer incoming_;
  std::deque<WebMessage> queue_;
  std::size_t waiting_ = 0;  // bytes in the queue
  std::size_t part_ = 0;     // offset of the next frame in the first message
  std::size_t offset_ = 0;
  std::vector<asio::const_buffer> slice_;  // the frame being written
  websocket::close_reason reason_;
  double grace_ = 0;
  bool joined_ = false;
  bool writing_ = false;
  bool pinging_ = false;
  bool broken_ = false;
  bool leaving_ = false;   // new messages are neither queued nor reported
  bool given_up_ = false;  // the queue is not sent either
  bool closing_ = false;   // the last frame is being sent
  bool finished_ = false;
};

}  // namespace boltzmann::web
