// What a page does, without a browser: asks for updates, takes binary messages apart, presses buttons.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <tests/window/web_client.hpp>
#include <vector>

namespace boltzmann {

/// A binary message: its head, and the arrays that it names.
struct WireMessage {
  nlohmann::json head;
  std::vector<char> bytes;
  std::size_t payload = 0;

  template <class T>
  std::span<T const> array(nlohmann::json const& stored) const {
    std::size_t const at = payload + stored["at"].get<std::size_t>(), count = stored["count"].get<std::size_t>();
    EXPECT_LE(at + count * sizeof(T), bytes.size());
    EXPECT_EQ(at % 8, 0U);
    return {reinterpret_cast<T const*>(bytes.data() + at), count};
  }
};

inline WireMessage decode(std::vector<char> bytes) {
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data(), 4);
  WireMessage message{nlohmann::json::parse(std::string_view(bytes.data() + 4, length)), std::move(bytes), 4 + length};
  EXPECT_EQ(message.payload % 8, 0U);
  return message;
}

class PageReader {
 public:
  /// By the address that a window prints.
  explicit PageReader(std::string const& address)
      : socket_(static_cast<std::uint16_t>(std::atoi(address.c_str() + std::strlen("http://127.0.0.1:"))),
                address.substr(address.find("token=") + 6)) {
    hello = next_of("hello").head;
  }

  void say(nlohmann::json const& request) { socket_.say(request.dump()); }
  void show(nlohmann::json const& views) { ask({{"do", "views"}, {"views", views}}); }

  /// Does it and waits for the answer.
  nlohmann::json ask(nlohmann::json request) { return ask_whole(std::move(request)).head; }
  WireMessage ask_whole(nlohmann::json request) {
    request["id"] = ++asked_;
    say(request);
    for (;;) {
      WireMessage message = receive();
      if (message.head.value("type", "") == "reply" && message.head["id"] == asked_) return message;
      keep(std::move(message));
    }
  }

  /// Asks for the next update and waits for it.
  WireMessage update() {
    if (!asked_next_) next();
    if (!updates_.empty()) return take();
    WireMessage message = next_of("update");
    asked_next_ = false;
    return message;
  }
  void next() {
    say({{"do", "next"}, {"rows", rows}, {"table", table}});
    asked_next_ = true;
  }

  /// Updates until one says so, for two minutes at most, on a machine that does much else.
  template <class Condition>
  WireMessage until(Condition condition) {
    auto const end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
    for (;;) {
      WireMessage message = update();
      if (condition(message.head)) return message;
      if (std::chrono::steady_clock::now() > end) {
        ADD_FAILURE() << "no such update; the last one: " << message.head.dump();
        return message;
      }
    }
  }
  WireMessage until_state(std::string const& state) {
    return until([&](nlohmann::json const& head) { return head["state"] == state; });
  }

  nlohmann::json hello;
  std::int64_t rows = 0, table = -1;
  WebSocketClient& socket() { return socket_; }

 private:
  WireMessage receive() {
    std::vector<char> buffer;
    auto const got = socket_.receive(buffer);
    buffer.resize(got.bytes);
    if (got.kind == WebReceived::Kind::text)
      return {nlohmann::json::parse(std::string_view(buffer.data(), buffer.size())), {}, 0};
    if (got.kind == WebReceived::Kind::binary) return decode(std::move(buffer));
    throw std::runtime_error("the socket is closed");
  }
  void keep(WireMessage message) {
    std::string const type = message.head.value("type", "");
    if (type == "hello") hello = message.head;
    if (type == "update") updates_.push_back(std::move(message));
  }
  WireMessage next_of(std::string const& type) {
    for (;;) {
      WireMessage message = receive();
      if (message.head.value("type", "") == type) return message;
      keep(std::move(message));
    }
  }
  WireMessage take() {
    WireMessage message = std::move(updates_.front());
    updates_.erase(updates_.begin());
    asked_next_ = false;
    return message;
  }

  WebSocketClient socket_;
  int asked_ = 0;
  bool asked_next_ = false;
  std::vector<WireMessage> updates_;
};

}  // namespace boltzmann
