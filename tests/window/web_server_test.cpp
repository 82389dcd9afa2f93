// The web server against browsers, slow and rude ones, and attackers: who is refused, what arrives, and that everybody
// else notices nothing.
#include <gtest/gtest.h>
#include <boltzmann/window/web_server.hpp>

#include <atomic>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <map>
#include <mutex>
#include <numeric>
#include <random>
#include <set>
#include <thread>

#include "tests/message.hpp"
#include "tests/window/web_client.hpp"

namespace boltzmann::web_server_test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using Kind = WebReceived::Kind;

constexpr char const* token = "0123456789abcdef0123456789abcdef";
std::string const page = "<!doctype html><title>A page</title>" + std::string(100'000, '.');

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// A server that answers every message with "heard: ..." and writes down what happens.
class House {
 public:
  explicit House(WebLimits limits = {}) {
    WebEvents events;
    events.joined = [this](std::uint64_t id) { note([&] { joined.push_back(id); }); };
    events.left = [this](std::uint64_t id) { note([&] { left.push_back(id); }); };
    events.said = [this](std::uint64_t id, std::string_view text) {
      note([&] { said.emplace_back(text); });
      if (text == "sleep") std::this_thread::sleep_for(200ms);
      if (text == "throw") throw std::runtime_error("an event that fails");
      std::string answer = "heard: ";
      answer += text;
      here().send(id, WebMessage::of_text(answer));
    };
    events.file = [this](std::string_view path) -> std::optional<WebFile> {
      note([&] { paths.emplace_back(path); });
      if (path == "/throw") throw std::runtime_error("a file that fails");
      if (path != "/") return std::nullopt;
      return WebFile{"text/html; charset=utf-8", std::make_shared<std::string const>(page)};
    };
    std::scoped_lock const lock(mutex_);
    server_ = std::make_unique<WebServer>(events, 0, token, limits);
  }

  WebServer& here() {
    std::scoped_lock const lock(mutex_);
    return *server_;
  }
  std::uint16_t port() { return here().port(); }

  template <class Condition>
  bool soon(Condition const& condition, double seconds = 10) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::duration<double>(seconds), condition);
  }
  template <class Value>
  Value now(Value const& value) {
    std::scoped_lock const lock(mutex_);
    return value;
  }

  /// A polite browser, by which everything still works.
  void expect_all_well(std::string const& after) {
    SCOPED_TRACE("after: " + after);
    WebAnswer const answer = get(port(), std::string("/?token=") + token);
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.body, page);
    WebSocketClient browser(port(), token);
    ASSERT_TRUE(browser.say("well?"));
    EXPECT_EQ(browser.hear(), "heard: well?");
  }

  /// A socket, and the number that the server knows it by.
  std::pair<WebSocketClient, std::uint64_t> visit(int receive_bytes = 0) {
    std::size_t const before = now(joined).size();
    WebSocketClient client(port(), token, receive_bytes);
    EXPECT_TRUE(soon([&] { return joined.size() > before; }));
    return {std::move(client), now(joined).back()};
  }

  std::vector<std::uint64_t> joined, left;
  std::vector<std::string> said, paths;

 private:
  template <class Change>
  void note(Change const& change) {
    std::scoped_lock const lock(mutex_);
    change();
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::unique_ptr<WebServer> server_;  // closed before what it writes to
};

std::string host_line(std::uint16_t port) { return "Host: " + own_host(port) + "\r\n"; }

WebMessage binary(std::vector<char> bytes) {
  auto const owner = std::make_shared<std::vector<char> const>(std::move(bytes));
  return {true, {{owner, owner->data(), owner->size()}}};
}

TEST(WebServer, serves_a_page_and_carries_messages) {
  House house;
  house.expect_all_well("nothing");
  WebAnswer const answer = get(house.port(), std::string("/?token=") + token);
  EXPECT_EQ(answer.headers.at("content-type"), "text/html; charset=utf-8");
  EXPECT_EQ(answer.headers.at("content-length"), std::to_string(page.size()));
  EXPECT_EQ(house.here().address(), "http://127.0.0.1:" + std::to_string(house.port()) + "/?token=" + token);
  EXPECT_EQ(house.now(house.said), std::vector<std::string>{"well?"});
  EXPECT_EQ(house.now(house.paths), (std::vector<std::string>{"/", "/"}));
}

TEST(WebServer, all_answers_carry_the_headers_that_keep_others_out) {
  House house;
  std::string const right = std::string("?token=") + token;
  WebSocketClient const socket(house.port(), token);
  for (WebAnswer const& answer : {get(house.port(), "/" + right), get(house.port(), "/nothing" + right),
                                  get(house.port(), "/"), ask(house.port(), "nonsense\r\n\r\n"), socket.answer}) {
    SCOPED_TRACE(answer.status);
    auto const policy = answer.headers.at("content-security-policy");
    for (char const* part : {"default-src 'none'", "script-src 'none'", "connect-src 'self'",
                             "frame-ancestors http://localhost:* http://127.0.0.1:* 'self'"}) {
      EXPECT_NE(policy.find(part), std::string::npos) << part;
    }
    EXPECT_EQ(answer.headers.at("x-content-type-options"), "nosniff");
    EXPECT_EQ(answer.headers.at("referrer-policy"), "no-referrer");
    EXPECT_EQ(answer.headers.at("cache-control"), "no-store");
    EXPECT_EQ(answer.headers.at("cross-origin-resource-policy"), "same-origin");
    EXPECT_EQ(answer.headers.count("access-control-allow-origin"), 0U);
  }
}

TEST(WebServer, only_this_machine_can_connect) {
  House house;
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(house.port());
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK + 1);  // 127.0.0.2: reached by who listens everywhere
  int const descriptor = ::socket(AF_INET, SOCK_STREAM, 0);
  EXPECT_NE(::connect(descriptor, reinterpret_cast<sockaddr const*>(&place), sizeof place), 0);
  ::close(descriptor);
}

struct Request {
  char const* what;
  std::string text;
  int status;
};

TEST(WebServer, requests_of_strangers_are_refused) {
  House house;
  std::string const host = host_line(house.port());
  std::string const own = own_host(house.port());
  std::string const right = std::string("/?token=") + token;
  std::string const get_right = "GET " + right + " HTTP/1.1\r\n";
  std::string const digits = token;
  std::vector<Request> const requests = {
      {"no token", "GET / HTTP/1.1\r\n" + host + "\r\n", 403},
      {"empty token", "GET /?token= HTTP/1.1\r\n" + host + "\r\n", 403},
      {"wrong token", "GET /?token=" + std::string(32, '0') + " HTTP/1.1\r\n" + host + "\r\n", 403},
      {"shorter token", "GET /?token=" + digits.substr(1) + " HTTP/1.1\r\n" + host + "\r\n", 403},
      {"its beginning", "GET /?token=" + digits.substr(0, 16) + " HTTP/1.1\r\n" + host + "\r\n", 403},
      {"longer token", "GET /?token=" + digits + "0 HTTP/1.1\r\n" + host + "\r\n", 403},
      {"token twice over", "GET /?token=" + digits + digits + " HTTP/1.1\r\n" + host + "\r\n", 403},
      {"two tokens", "GET " + right + "&token=" + digits + " HTTP/1.1\r\n" + host + "\r\n", 403},
      {"token in capitals", "GET /?TOKEN=" + digits + " HTTP/1.1\r\n" + host + "\r\n", 403},
      {"token as a path", "GET /" + digits + " HTTP/1.1\r\n" + host + "\r\n", 403},
      {"token after #", "GET /#?token=" + digits + " HTTP/1.1\r\n" + host + "\r\n", 403},
      {"token with a broken %", "GET " + right + "%4 HTTP/1.1\r\n" + host + "\r\n", 403},
      {"token in a header", "GET / HTTP/1.1\r\n" + host + "Cookie: token=" + digits + "\r\n\r\n", 403},
      {"unknown path without token", "GET /nothing HTTP/1.1\r\n" + host + "\r\n", 403},
      {"no Host", get_right + "\r\n", 403},
      {"two Hosts", get_right + host + host + "\r\n", 403},
      {"DNS rebinding", get_right + "Host: evil.example\r\n\r\n", 403},
      {"DNS rebinding with our port", get_right + "Host: evil.example:" + own.substr(10) + "\r\n\r\n", 403},
      {"a name that begins like ours", get_right + "Host: localhost.evil.example\r\n\r\n", 403},
      {"an address that begins like ours", get_right + "Host: 127.0.0.1.evil.example:80\r\n\r\n", 403},
      {"another address", get_right + "Host: 0.0.0.0\r\n\r\n", 403},
      {"a port of letters", get_right + "Host: localhost:http\r\n\r\n", 403},
      {"a port without digits", get_right + "Host: localhost:\r\n\r\n", 403},
      {"a name in the Host", get_right + "Host: me@127.0.0.1\r\n\r\n", 403},
      {"foreign Origin", get_right + host + "Origin: http://evil.example\r\n\r\n", 403},
      {"Origin null", get_right + host + "Origin: null\r\n\r\n", 403},
      {"Origin of another port", get_right + host + "Origin: http://127.0.0.1:1\r\n\r\n", 403},
      {"Origin of another name", get_right + host + "Origin: http://localhost:" + own.substr(10) + "\r\n\r\n", 403},
      {"Origin by https", get_right + host + "Origin: https://" + own + "\r\n\r\n", 403},
      {"two Origins", get_right + host + "Origin: http://" + own + "\r\nOrigin: http://" + own + "\r\n\r\n", 403},
      {"POST without token", "POST / HTTP/1.1\r\n" + host + "\r\n", 403},
      {"POST", "POST " + right + " HTTP/1.1\r\n" + host + "Content-Length: 0\r\n\r\n", 405},
      {"POST with a body", "POST " + right + " HTTP/1.1\r\n" + host + "Content-Length: 4\r\n\r\nquit", 405},
      {"PUT", "PUT " + right + " HTTP/1.1\r\n" + host + "\r\n", 405},
      {"DELETE", "DELETE " + right + " HTTP/1.1\r\n" + host + "\r\n", 405},
      {"OPTIONS", "OPTIONS " + right + " HTTP/1.1\r\n" + host + "\r\n", 405},
      {"CONNECT", "CONNECT " + right + " HTTP/1.1\r\n" + host + "\r\n", 405},
      {"a method of its own", "QUIT " + right + " HTTP/1.1\r\n" + host + "\r\n", 405},
      {"GET with a body", get_right + host + "Content-Length: 4\r\n\r\nquit", 413},
      {"GET with a body that never comes", get_right + host + "Content-Length: 999999999999\r\n\r\n", 413},
      {"GET with chunks", get_right + host + "Transfer-Encoding: chunked\r\n\r\n4\r\nquit\r\n0\r\n\r\n", 400},
      {"two lengths", get_right + host + "Content-Length: 0\r\nContent-Length: 4\r\n\r\nquit", 400},
      {"a length of letters", get_right + host + "Content-Length: four\r\n\r\n", 400},
      {"a negative length", get_right + host + "Content-Length: -1\r\n\r\n", 400},
      {"length and chunks", get_right + host + "Content-Length: 4\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", 400},
      {"no HTTP", "hello\r\n\r\n", 400},
      {"HTTP/2", "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", 400},
      {"TLS", std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11) + std::string(64, 'x') + "\r\n", 400},
      {"a null in the target", "GET /" + std::string(1, '\0') + " HTTP/1.1\r\n" + host + "\r\n", 400},
      {"a space in a name", get_right + host + "A name: x\r\n\r\n", 400},
      {"a header that is too long", get_right + host + "X: " + std::string(17'000, 'x') + "\r\n\r\n", 431},
      {"a target that is too long", "GET /" + std::string(100'000, 'x') + " HTTP/1.1\r\n" + host + "\r\n", 431},
      {"unknown path", "GET /nothing" + right.substr(1) + " HTTP/1.1\r\n" + host + "\r\n", 404},
      {"out of the folder", "GET /gallery/../../etc/passwd" + right.substr(1) + " HTTP/1.1\r\n" + host + "\r\n", 404},
      {"the same hidden", "GET /%2e%2e/passwd" + right.substr(1) + " HTTP/1.1\r\n" + host + "\r\n", 404},
      {"a null hidden", "GET /%00" + right.substr(1) + " HTTP/1.1\r\n" + host + "\r\n", 404},
      {"as to a proxy", "GET http://evil.example/?token=" + digits + " HTTP/1.1\r\n" + host + "\r\n", 404},
      {"socket without upgrade", "GET /socket" + right.substr(1) + " HTTP/1.1\r\n" + host + "\r\n", 426},
      {"a file that can't be made", "GET /throw" + right.substr(1) + " HTTP/1.1\r\n" + host + "\r\n", 500},
  };
  for (auto const& request : requests) {
    WebAnswer const answer = ask(house.port(), request.text);
    EXPECT_EQ(answer.status, request.status) << request.what;
    EXPECT_LT(answer.body.size(), 120U) << request.what;
    EXPECT_EQ(answer.body.find(token), std::string::npos) << request.what;
  }
  std::string lines;
  for (int i = 0; i < 5000; ++i) lines += "X" + std::to_string(i) + ": x\r\n";
  EXPECT_EQ(ask(house.port(), get_right + host + lines + "\r\n").status, 431);
  WebAnswer const head = ask(house.port(), "HEAD " + right + " HTTP/1.1\r\n" + host + "\r\n");
  EXPECT_EQ(head.status, 405);
  EXPECT_EQ(head.headers.at("allow"), "GET");
  EXPECT_EQ(head.body, "");
  EXPECT_TRUE(house.now(house.joined).empty());
  EXPECT_TRUE(house.now(house.said).empty());
  for (auto const& path : house.now(house.paths)) EXPECT_TRUE(path == "/nothing" || path == "/throw") << path;
  house.expect_all_well("strangers");
}

TEST(WebServer, every_refused_request_leaves_the_others_alone) {
  House house;
  std::string const host = host_line(house.port());
  for (std::string const& rude :
       {std::string("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"), "GET /?token=x HTTP/1.1\r\n" + host + "\r\n",
        "GET /?token=" + std::string(token) + " HTTP/1.1\r\n" + host + "Origin: http://evil.example\r\n\r\n",
        "POST / HTTP/1.1\r\n" + host + "Content-Length: 100000\r\n\r\n" + std::string(100'000, 'x'),
        std::string(1'000'000, 'x'), std::string(1, '\0'), std::string()}) {
    WebConnection connection(house.port());
    connection.write(rude);
    house.expect_all_well(rude.substr(0, 80));
  }
}

TEST(WebServer, the_names_of_this_machine_are_right_by_any_port) {
  House house;
  std::string const line = std::string("GET /?token=") + token + " HTTP/1.1\r\nHost: ";
  for (std::string const host : {"127.0.0.1", "localhost", "[::1]", "127.0.0.1:9", "localhost:8888", "[::1]:65535"}) {
    EXPECT_EQ(ask(house.port(), line + host + "\r\n\r\n").status, 200) << host;
    EXPECT_EQ(ask(house.port(), line + host + "\r\nOrigin: http://" + host + "\r\n\r\n").status, 200) << host;
  }
  EXPECT_EQ(get(house.port(), std::string("/?a=b&token=") + token + "&c").status, 200);
  EXPECT_EQ(get(house.port(), std::string("/?token=%30") + (token + 1)).status, 200);
}

TEST(WebServer, sockets_of_strangers_are_refused) {
  House house;
  std::string const right = WebSocketClient::upgrade(house.port(), std::string("/socket?token=") + token);
  auto const with = [&](std::string const& found, std::string const& instead) {
    std::string text = right;
    auto const at = text.find(found);
    EXPECT_NE(at, std::string::npos) << found;
    return text.replace(at, found.size(), instead);
  };
  std::string const own = own_host(house.port());
  std::vector<Request> const requests = {
      {"no token", with(std::string("?token=") + token, ""), 403},
      {"wrong token", with(token, "x"), 403},
      {"no Origin", with("Origin: http://" + own + "\r\n", ""), 403},
      {"foreign Origin", with("Origin: http://" + own, "Origin: http://evil.example"), 403},
      {"Origin null", with("Origin: http://" + own, "Origin: null"), 403},
      {"Origin of another port", with("Origin: http://" + own, "Origin: http://127.0.0.1:1"), 403},
      {"DNS rebinding", with("Host: " + own, "Host: evil.example"), 403},
      {"rebinding that is consistent",
       with("Host: " + own + "\r\nOrigin: http://" + own, "Host: evil.example\r\nOrigin: http://evil.example"), 403},
      {"no Host", with("Host: " + own + "\r\n", ""), 403},
      {"POST", with("GET", "POST"), 405},
      {"another path", with("/socket", "/"), 404},
      {"no version", with("Sec-WebSocket-Version: 13\r\n", ""), 400},
      {"an old version", with("Version: 13", "Version: 8"), 400},
      {"no key", with("Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n", ""), 400},
      {"a short key", with("dGhlIHNhbXBsZSBub25jZQ==", "x"), 400},
      {"HTTP/1.0", with("HTTP/1.1", "HTTP/1.0"), 400},
      {"no Connection", with("Connection: Upgrade\r\n", ""), 400},
      {"another protocol", with("Upgrade: websocket", "Upgrade: h2c"), 400},
      {"a body", with("Upgrade: websocket", "Content-Length: 4\r\nUpgrade: websocket") + "quit", 413},
      {"frames before the answer", right + WebSocketClient::frame(0x81, "early"), 400},
  };
  for (auto const& request : requests) {
    EXPECT_EQ(ask(house.port(), request.text).status, request.status) << request.what;
    house.expect_all_well(request.what);
  }
  EXPECT_EQ(house.now(house.joined).size(), requests.size());  // the good ones only
  for (auto const& text : house.now(house.said)) EXPECT_EQ(text, "well?");
}

struct Frames {
  char const* what;
  std::string bytes;
  int code;  // of the close that answers it; 0: it just ends
};

TEST(WebServer, wrong_frames_end_their_socket_and_no_other) {
  auto const frame = WebSocketClient::frame;
  House house;
  auto [other, id] = house.visit();
  std::vector<Frames> const attacks = {
      {"not masked", frame(0x81, "hello", false, {}), 1002},
      {"reserved bit 1", frame(0xC1, "hello", true, {}), 1002},
      {"reserved bit 2", frame(0xA1, "hello", true, {}), 1002},
      {"reserved bit 3", frame(0x91, "hello", true, {}), 1002},
      {"opcode 3", frame(0x83, "hello", true, {}), 1002},
      {"opcode 11", frame(0x8B, "", true, {}), 1002},
      {"a ping in two frames", frame(0x09, "hello", true, {}), 1002},
      {"a close in two frames", frame(0x08, "", true, {}), 1002},
      {"a ping that is too long", frame(0x89, std::string(126, 'x'), true, {}), 1002},
      {"nothing to go on with", frame(0x80, "hello", true, {}), 1002},
      {"a message within a message", frame(0x01, "hel", true, {}) + frame(0x81, "lo", true, {}), 1002},
      {"a length with its top bit", frame(0x81, "", true, std::uint64_t{1} << 63), 1009},
      {"a huge length", frame(0x81, "", true, (std::uint64_t{1} << 63) - 1), 1009},
      {"a length of 2^32", frame(0x81, "hello", true, std::uint64_t{1} << 32), 1009},
      {"huge in frames",
       frame(0x01, std::string(200'000, 'x'), true, {}) +
           frame(0x80, "", true, std::uint64_t{0} - 200'000 - (std::uint64_t{1} << 63)),
       1009},
      {"a short length said long", std::string("\x81\xfe\x00\x05\x00\x00\x00\x00hello", 13), 1002},
      {"text that is no UTF-8", frame(0x81, "\xff\xfe", true, {}), 1007},
      {"text that ends in a character", frame(0x81, "\xe2\x82", true, {}), 1007},
      {"a surrogate", frame(0x81, "\xed\xa0\x80", true, {}), 1007},
      {"an overlong character", frame(0x81, "\xc0\xaf", true, {}), 1007},
      {"UTF-8 cut wrong between frames", frame(0x01, "\xe2", true, {}) + frame(0x80, "x", true, {}), 1007},
      {"a close of one byte", frame(0x88, "x", true, {}), 1002},
      {"a close with a wrong code", frame(0x88, "\x03\xed", true, {}), 1002},
      {"binary", frame(0x82, "hello", true, {}), 1003},
      {"an event that fails", frame(0x81, "throw", true, {}), 1011},
  };
  std::size_t ended = 0;
  for (auto const& attack : attacks) {
    {
      WebSocketClient client(house.port(), token);
      client.connection().write(attack.bytes);
      auto const end = client.end();
      EXPECT_EQ(end.kind, Kind::closed) << attack.what;
      EXPECT_EQ(end.code, attack.code) << attack.what << ": " << end.reason;
    }
    ASSERT_TRUE(other.say("still here"));
    EXPECT_EQ(other.hear(), "heard: still here") << attack.what;
    house.expect_all_well(attack.what);
    ended += 2;
    EXPECT_TRUE(house.soon([&] { return house.left.size() == ended; })) << attack.what;
  }
  for (auto const& text : house.now(house.said)) {
    EXPECT_TRUE(text == "well?" || text == "still here" || text == "throw") << text;
  }
}

TEST(WebServer, who_breaks_the_rules_and_stays_is_put_out) {
  WebLimits limits;
  limits.idle_seconds = 2;
  House house(limits);
  WebSocketClient client(house.port(), token);
  client.connection().write(WebSocketClient::frame(0x83, "", true));
  std::vector<char> buffer;
  // Says no farewell: neither a close frame nor the end of the connection.
  EXPECT_TRUE(house.soon([&] { return house.left.size() == 1; }, 3));
  house.expect_all_well("a wrong frame and silence");
}

TEST(WebServer, right_frames_of_every_form_arrive) {
  auto const frame = WebSocketClient::frame;
  House house;
  WebSocketClient client(house.port(), token);
  auto& wire = client.connection();
  wire.write(frame(0x01, "a", true, {}) + frame(0x00, "", true, {}) + frame(0x89, "between", true, {}) +
             frame(0x00, "b", true, {}) + frame(0x80, "c", true, {}));
  EXPECT_EQ(client.hear(), "heard: abc");
  wire.write(frame(0x81, "", true, {}));
  EXPECT_EQ(client.hear(), "heard: ");
  wire.write(frame(0x8a, "a pong that nobody asked for", true, {}) + frame(0x81, "\xe2\x82\xac", true, {}));
  EXPECT_EQ(client.hear(), "heard: \xe2\x82\xac");
  for (char const c : frame(0x81, "byte by byte", true, {})) {
    wire.write({&c, 1});
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(client.hear(), "heard: byte by byte");
  std::string many;
  for (int i = 0; i < 1000; ++i) many += frame(0x81, std::to_string(i), true, {});
  std::thread writer([&] { wire.write(many); });
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(client.hear(), "heard: " + std::to_string(i));
  writer.join();
}

TEST(WebServer, a_message_over_the_limit_closes_and_one_at_it_does_not) {
  WebLimits limits;
  limits.message_bytes = 100'000;
  House house(limits);
  {
    WebSocketClient client(house.port(), token);
    std::string const largest(100'000, 'x');
    client.say(largest);
    EXPECT_EQ(client.hear(), "heard: " + largest);
    client.say(largest + "x");
    EXPECT_EQ(client.end().code, 1009);
  }
  WebSocketClient client(house.port(), token);
  for (int i = 0; i < 101; ++i) {
    client.connection().write(WebSocketClient::frame(i == 0 ? 0x01 : 0x00, std::string(1000, 'x')));
  }
  EXPECT_EQ(client.end().code, 1009);
  EXPECT_EQ(house.now(house.said).size(), 1U);
  house.expect_all_well("messages over the limit");
}

// Kind: a service that refuses its user because of others that do nothing. Siblings: sockets that are silent from the
// start, that send half of a request, that come in a crowd or again and again while pages are asked for.
TEST(WebServer, silent_connections_never_make_a_page_fail) {
  WebLimits limits;
  limits.connections = 32;
  limits.handshake_seconds = 3;
  House house(limits);
  auto [browser, id] = house.visit();
  for (std::string const& half : {std::string(), std::string("GET /?tok")}) {
    std::vector<std::unique_ptr<WebConnection>> silent;
    auto const start = Clock::now();
    for (int i = 0; i < 30; ++i) {
      for (int k = 0; k < 5; ++k) {
        silent.push_back(std::make_unique<WebConnection>(house.port()));
        silent.back()->write(half);
      }
      ASSERT_EQ(get(house.port(), std::string("/?token=") + token).status, 200) << i;
    }
    EXPECT_LT(seconds_since(start), 10) << "of at most 0.06 s for every 16 of them";
    browser.say("still here");
    EXPECT_EQ(browser.hear(), "heard: still here");
    house.expect_all_well("150 silent connections");
    auto const end = Clock::now();
    for (auto& connection : silent) EXPECT_TRUE(connection->closed_within(10));
    EXPECT_LT(seconds_since(end), 4.5);
  }
  house.expect_all_well("silent connections that have been closed");
}

// As many watchers of a run as the documented limit says, and a plain refusal above it.
TEST(WebServer, hundreds_of_browsers_are_served_up_to_the_limit) {
  WebLimits limits;
  EXPECT_EQ(limits.connections, 512U) << "docs/how-to/use-the-window.md gives 384";
  limits.connections = 320;
  House house(limits);
  std::vector<WebSocketClient> browsers;
  int refused = 0;
  for (int i = 0; i < 260; ++i) {
    try {
      browsers.emplace_back(house.port(), token);
    } catch (std::runtime_error const& error) {
      EXPECT_STREQ(error.what(), "no socket: 503");
      ++refused;
    }
  }
  EXPECT_EQ(browsers.size(), 240U);
  EXPECT_EQ(refused, 20);
  for (auto& browser : browsers) {
    ASSERT_TRUE(browser.say("one of many"));
    ASSERT_EQ(browser.hear(), "heard: one of many");
  }
  browsers.pop_back();
  browsers.pop_back();
  EXPECT_TRUE(house.soon([&] { return house.left.size() == 2; }));
  house.expect_all_well("hundreds of browsers");
}

TEST(WebServer, half_open_connections_are_closed_in_time) {
  WebLimits limits;
  limits.handshake_seconds = 0.5;
  House house(limits);
  std::string const host = host_line(house.port());
  std::string const upgrade = WebSocketClient::upgrade(house.port(), std::string("/socket?token=") + token);
  for (std::string const& half : {std::string(), std::string("G"), std::string("GET /?token="),
                                  "GET / HTTP/1.1\r\n" + host, upgrade.substr(0, upgrade.size() - 2)}) {
    WebConnection connection(house.port());
    connection.write(half);
    auto const start = Clock::now();
    EXPECT_TRUE(connection.closed_within(10)) << half;
    EXPECT_GT(seconds_since(start), 0.3) << half;
    EXPECT_LT(seconds_since(start), 1.5) << half;
    house.expect_all_well("half of a request: " + half);
  }
  // One byte at a time is no better.
  WebConnection drip(house.port());
  auto const start = Clock::now();
  while (seconds_since(start) < 5 && drip.write("x") && !drip.closed_within(0.05)) continue;
  EXPECT_LT(seconds_since(start), 1.5);
  // Who asks and says no more is answered.
  WebConnection shut(house.port());
  shut.write(std::string("GET /?token=") + token + " HTTP/1.1\r\n" + host + "\r\n");
  shut.shut();
  EXPECT_EQ(read_answer(shut).body, page);
  house.expect_all_well("drips");
}

TEST(WebServer, who_does_not_read_an_answer_is_closed) {
  WebLimits limits;
  limits.idle_seconds = 1;
  limits.connections = 4;
  auto const large = std::make_shared<std::string const>(20'000'000, 'x');
  WebEvents events;
  events.file = [&](std::string_view) { return WebFile{"text/plain", large}; };
  WebServer server(events, 0, token, limits);
  std::vector<WebConnection> greedy;
  for (int i = 0; i < 4; ++i) {
    greedy.emplace_back(server.port(), 4096);
    greedy.back().write(std::string("GET /?token=") + token + " HTTP/1.1\r\n" + host_line(server.port()) + "\r\n");
  }
  auto const start = Clock::now();
  while (large.use_count() < 5 && seconds_since(start) < 60) std::this_thread::sleep_for(1ms);
  EXPECT_EQ(get(server.port(), std::string("/?token=") + token).status, 503);
  while (large.use_count() > 1 && seconds_since(start) < 60) std::this_thread::sleep_for(10ms);
  EXPECT_EQ(large.use_count(), 1);
  EXPECT_EQ(get(server.port(), std::string("/?token=") + token).body.size(), large->size());
}

TEST(WebServer, scripts_of_a_file_have_its_nonce) {
  WebEvents events;
  events.file = [](std::string_view) {
    return WebFile{"text/html", std::make_shared<std::string const>("<script nonce=\"abc\"></script>"), "abc"};
  };
  WebServer const server(events, 0, token);
  auto const policy = get(server.port(), std::string("/?token=") + token).headers.at("content-security-policy");
  EXPECT_NE(policy.find("script-src 'nonce-abc';"), std::string::npos) << policy;
  EXPECT_EQ(random_token().size(), 32U);
  EXPECT_NE(random_token(), random_token());
}

TEST(WebServer, who_keeps_all_sockets_and_says_nothing_makes_room) {
  WebLimits limits;
  limits.connections = 4;  // 3 sockets
  limits.handshake_seconds = 3;
  WebServer const server({}, 0, token, limits);
  auto const status = [&] {
    WebConnection connection(server.port());
    connection.write(WebSocketClient::upgrade(server.port(), std::string("/socket?token=") + token));
    return read_answer(connection).status;
  };
  WebSocketClient first(server.port(), token), second(server.port(), token), third(server.port(), token);
  EXPECT_EQ(status(), 503);  // nobody has been silent for long
  auto const start = Clock::now();
  while (seconds_since(start) < 3.3) {
    for (auto* busy : {&first, &third}) busy->say("well");
    std::this_thread::sleep_for(50ms);
  }
  WebSocketClient page(server.port(), token);
  EXPECT_EQ(second.end().code, 1013);
  EXPECT_EQ(status(), 503);  // the others go on talking
}

TEST(WebServer, an_event_that_fails_ends_its_browser_only) {
  std::atomic<int> left{0};
  WebEvents events;
  events.joined = [](std::uint64_t id) {
    if (id % 2 == 1) throw std::runtime_error("no");
  };
  events.left = [&](std::uint64_t) {
    ++left;
    throw std::runtime_error("no");
  };
  WebServer server(events, 0, token);
  for (int i = 0; i < 3; ++i) {
    WebSocketClient first(server.port(), token);
    WebSocketClient second(server.port(), token);
    EXPECT_EQ(first.end().code, 1011);
    server.send(2 * static_cast<std::uint64_t>(i) + 2, WebMessage::of_text("hello"));
    EXPECT_EQ(second.hear(), "hello");
  }
  auto const start = Clock::now();
  while (left < 6 && seconds_since(start) < 60) std::this_thread::sleep_for(5ms);
  EXPECT_EQ(left, 6);
}

TEST(WebServer, parts_become_one_message) {
  House house;
  auto [browser, id] = house.visit();
  std::mt19937 random(1);
  for (std::size_t const most : {std::size_t{0}, std::size_t{1}, std::size_t{100}, std::size_t{300'000}}) {
    WebMessage message{true, {}};
    std::string expected;
    for (int part = 0; part < (most > 1000 ? 30 : 2000); ++part) {
      std::string bytes(std::uniform_int_distribution<std::size_t>(0, most)(random), ' ');
      for (auto& c : bytes) c = static_cast<char>(random());
      expected += bytes;
      message.parts.push_back(WebPart::of(std::move(bytes)));
    }
    EXPECT_EQ(message.bytes(), expected.size());
    house.here().send(id, message);
    std::vector<char> buffer;
    auto const received = browser.receive(buffer);
    EXPECT_EQ(received.kind, Kind::binary);
    EXPECT_TRUE(std::string_view(buffer.data(), received.bytes) == expected);
  }
  house.here().send(id, {});
  std::vector<char> buffer;
  auto const empty = browser.receive(buffer);
  EXPECT_EQ(empty.kind, Kind::text);
  EXPECT_EQ(empty.bytes, 0U);
}

TEST(WebServer, large_messages_arrive_whole_and_in_order_at_every_browser) {
  House house;
  constexpr std::size_t count = 3'000'000;  // 12 MB
  auto const numbers = std::make_shared<std::vector<std::uint32_t>>(count);
  std::iota(numbers->begin(), numbers->end(), 1U);
  WebMessage const message{true, {WebPart::of("head"), {numbers, numbers->data(), 4 * count}}};
  std::vector<std::pair<WebSocketClient, std::uint64_t>> browsers;
  for (int i = 0; i < 3; ++i) browsers.push_back(house.visit());
  std::vector<std::thread> readers;
  std::atomic<int> right{0};
  for (auto& [client, id] : browsers) {
    for (int i = 0; i < 4; ++i) {
      house.here().send(id, message);
      house.here().send(id, WebMessage::of_text("number " + std::to_string(i)));
    }
    readers.emplace_back([&right, &browser = client, &numbers = *numbers] {
      std::vector<char> buffer;
      for (int i = 0; i < 4; ++i) {
        auto const received = browser.receive(buffer);
        if (received.kind == Kind::binary && received.bytes == 4 + 4 * count &&
            std::memcmp(buffer.data() + 4, numbers.data(), 4 * count) == 0) {
          ++right;
        }
        if (browser.hear() == "number " + std::to_string(i)) ++right;
      }
    });
  }
  for (auto& reader : readers) reader.join();
  EXPECT_EQ(right, 3 * 4 * 2);
  EXPECT_GT(browsers[0].first.frames, 8U);  // between its frames a ping gets through
}

/// Bytes whose owners are counted.
struct Counted {
  std::atomic<int> alive{0};
  WebMessage message(std::size_t bytes) {
    ++alive;
    auto* const data = new std::vector<char>(bytes, 'x');
    std::shared_ptr<void const> owner(data->data(), [this, data](void const*) {
      delete data;
      --alive;
    });
    return {true, {{owner, data->data(), bytes}}};
  }
};

TEST(WebServer, a_browser_that_never_reads_costs_a_bounded_amount_and_is_let_go) {
  Counted counted;
  WebLimits limits;
  limits.waiting_bytes = 16 << 20;
  House house(limits);
  auto [good, good_id] = house.visit();
  auto [deaf, deaf_id] = house.visit(4096);
  int most = 0;
  for (int i = 0; i < 100; ++i) {
    house.here().send(deaf_id, counted.message(1 << 20));
    good.say("after " + std::to_string(i));
    ASSERT_EQ(good.hear(), "heard: after " + std::to_string(i));
    most = std::max(most, counted.alive.load());
  }
  EXPECT_LE(most, 17);
  EXPECT_GE(most, 10);
  EXPECT_TRUE(house.soon([&, id = deaf_id] { return house.left == std::vector{id}; }, 5));
  for (int i = 0; i < 100 && counted.alive > 0; ++i) std::this_thread::sleep_for(20ms);
  EXPECT_EQ(counted.alive, 0);
  house.here().send(deaf_id, counted.message(100));  // to nobody
  house.expect_all_well("a deaf browser");
  EXPECT_EQ(counted.alive, 0);
}

TEST(WebServer, a_browser_that_reads_too_slowly_is_told_why) {
  WebLimits limits;
  limits.waiting_messages = 5;
  House house(limits);
  auto [slow, id] = house.visit(4096);
  for (int i = 0; i < 8; ++i) house.here().send(id, binary(std::vector<char>(1 << 20)));
  auto const end = slow.end();
  EXPECT_EQ(end.code, 1008);
  EXPECT_EQ(end.reason, "too slow: what was sent is not being read");
  EXPECT_TRUE(house.soon([&] { return house.left.size() == 1; }));
  house.expect_all_well("a slow browser");
}

TEST(WebServer, joined_and_left_are_pairs) {
  WebLimits limits;
  limits.connections = 64;
  auto house = std::make_unique<House>(limits);
  std::vector<std::thread> crowd;
  std::atomic<int> opened{0};
  for (int thread = 0; thread < 4; ++thread) {
    crowd.emplace_back([&, thread] {
      for (int i = 0; i < 40; ++i) {
        WebSocketClient client(house->port(), token);
        ++opened;
        switch ((i + thread) % 5) {
          case 0:
            client.connection().close();
            break;
          case 1:
            client.connection().reset();
            break;
          case 2:
            client.connection().write(WebSocketClient::frame(0x88, "\x03\xe8"));
            EXPECT_EQ(client.end().code, 1000);
            break;
          case 3:
            client.say("hello");
            client.connection().close();
            break;
          default:
            client.connection().write(WebSocketClient::frame(0x81, "half of a mess", true, 100));
            client.connection().shut();
        }
      }
    });
  }
  // Whoever has joined is sent something, and some are dismissed, from another thread.
  std::thread program([&] {
    for (int i = 0; i < 300; ++i) {
      auto const here = house->now(house->joined);
      for (std::size_t j = here.size() < 20 ? 0 : here.size() - 20; j < here.size(); ++j) {
        house->here().send(here[j], binary(std::vector<char>(10'000)));
        if ((here[j] + i) % 50 == 0) house->here().dismiss(here[j], "enough");
      }
      std::this_thread::sleep_for(1ms);
    }
  });
  for (auto& thread : crowd) thread.join();
  program.join();
  EXPECT_TRUE(house->soon([&] { return house->left.size() == 160; }));
  auto joined = house->now(house->joined);
  auto left = house->now(house->left);
  EXPECT_EQ(joined.size(), 160U);
  EXPECT_EQ(std::set(joined.begin(), joined.end()).size(), 160U);
  std::sort(joined.begin(), joined.end());
  std::sort(left.begin(), left.end());
  EXPECT_EQ(joined, left);
  house->expect_all_well("a crowd");
}

/// What nobody would say: a request or frames with some bytes wrong, cut off, or in a wrong order.
class Babbler {
 public:
  explicit Babbler(unsigned seed) : random_(seed) {}

  unsigned upto(unsigned n) { return random_() % n; }

  std::string request(std::uint16_t port) {
    std::string text = upto(3) > 0 ? WebSocketClient::upgrade(port, std::string("/socket?token=") + token)
                                   : std::string("GET /?token=") + token + " HTTP/1.1\r\n" + host_line(port) + "\r\n";
    for (unsigned i = upto(4) == 0 ? 1 + upto(4) : 0; i > 0; --i) {
      auto const at = upto(static_cast<unsigned>(text.size()) - 5);
      text.replace(at, upto(5), upto(5), static_cast<char>(random_()));
    }
    return text;
  }

  std::string frame() {
    static constexpr unsigned firsts[] = {0x81, 0x81, 0x82, 0x88, 0x89, 0x8a, 0x01, 0x00, 0x80, 0x83, 0xc1, 0x09};
    unsigned const first = firsts[upto(12)];
    std::string payload(upto(5) > 0 ? upto(100) : upto(3500), 'x');
    if (first == 0x88) payload = std::string("\x03") + static_cast<char>(0xe8 + upto(16)) + "x";
    if (upto(10) == 0 && !payload.empty()) payload[upto(static_cast<unsigned>(payload.size()))] = '\xff';
    std::optional<std::uint64_t> declared;
    if (upto(20) == 0) declared = std::uint64_t{random_()} << upto(33);
    auto bytes = WebSocketClient::frame(first, payload, upto(20) > 0, declared);
    if (upto(10) == 0) bytes.resize(upto(static_cast<unsigned>(bytes.size())));
    return bytes;
  }

 private:
  std::mt19937 random_;
};

TEST(WebServer, a_crowd_that_babbles_harms_nobody) {
  WebLimits limits;
  limits.handshake_seconds = 0.5;
  limits.message_bytes = 3000;
  limits.waiting_bytes = 4 << 20;
  auto house = std::make_unique<House>(limits);
  std::vector<std::thread> crowd;
  for (unsigned thread = 0; thread < 4; ++thread) {
    crowd.emplace_back([&house = *house, thread] {
      Babbler babbler(thread);
      for (int i = 0; i < 150; ++i) {
        WebConnection connection(house.port(), babbler.upto(2) == 0 ? 4096 : 0);
        connection.patience = 0.02;
        connection.write(babbler.request(house.port()));
        connection.read_until("\r\n\r\n");
        for (unsigned frames = babbler.upto(10); frames > 0; --frames) {
          connection.write(babbler.frame());
          auto const joined = house.now(house.joined);
          if (joined.empty() || babbler.upto(4) > 0) continue;
          auto const id = joined[joined.size() - 1 - babbler.upto(4) % joined.size()];
          if (babbler.upto(2) == 0) house.here().dismiss(id, "enough");
          house.here().send(id, binary(std::vector<char>(babbler.upto(2'000'000))));
        }
        if (babbler.upto(3) == 0) connection.reset();
        if (babbler.upto(3) == 0) connection.closed_within(0.01);
      }
    });
  }
  for (auto& thread : crowd) thread.join();
  EXPECT_GT(house->now(house->joined).size(), 50U);
  EXPECT_TRUE(house->soon([&] { return house->left.size() == house->joined.size(); }));
  house->expect_all_well("babble");
}

TEST(WebServer, nothing_comes_from_a_browser_after_it_has_left) {
  std::mutex mutex;
  std::map<std::uint64_t, int> state;  // 1 joined, 2 left
  std::atomic<int> wrong{0};
  std::atomic<int> gone{0};
  WebEvents events;
  events.joined = [&](std::uint64_t id) {
    std::scoped_lock const lock(mutex);
    if (std::exchange(state[id], 1) != 0) ++wrong;
  };
  events.said = [&](std::uint64_t id, std::string_view) {
    std::scoped_lock const lock(mutex);
    if (state[id] != 1) ++wrong;
  };
  events.left = [&](std::uint64_t id) {
    std::scoped_lock const lock(mutex);
    if (std::exchange(state[id], 2) != 1) ++wrong;
    ++gone;
  };
  WebServer server(events, 0, token);
  for (int i = 0; i < 50; ++i) {
    WebSocketClient client(server.port(), token);
    for (int j = 0; j < 100; ++j) client.connection().write(WebSocketClient::frame(0x81, "hello"));
    if (i % 2 == 0) client.connection().reset();
    server.dismiss(static_cast<std::uint64_t>(i), "enough");
  }
  auto const start = Clock::now();
  while (gone < 50 && seconds_since(start) < 60) std::this_thread::sleep_for(5ms);
  EXPECT_EQ(gone, 50);
  EXPECT_EQ(wrong, 0);
}

TEST(WebServer, a_dismissed_browser_gets_what_waits_and_the_reason) {
  House house;
  auto [browser, id] = house.visit();
  for (int i = 0; i < 20; ++i) house.here().send(id, binary(std::vector<char>(1'000'000, static_cast<char>(i))));
  house.here().dismiss(id, "the run has ended");
  house.here().send(id, WebMessage::of_text("too late"));
  std::vector<char> buffer;
  for (int i = 0; i < 20; ++i) {
    auto const received = browser.receive(buffer);
    ASSERT_EQ(received.bytes, 1'000'000U);
    EXPECT_EQ(buffer[0], i);
    EXPECT_EQ(buffer[999'999], i);
  }
  auto const end = browser.receive(buffer);
  EXPECT_EQ(end.kind, Kind::closed);
  EXPECT_EQ(end.code, 1000);
  EXPECT_EQ(end.reason, "the run has ended");
  browser.connection().close();
  EXPECT_TRUE(house.soon([&, id = id] { return house.left == std::vector{id}; }));

  // A reason that is too long is cut between two characters.
  auto [other, other_id] = house.visit();
  std::string letters = "x";
  for (int i = 0; i < 100; ++i) letters += "\xc3\xa4";
  house.here().dismiss(other_id, letters);
  EXPECT_EQ(other.end().reason, letters.substr(0, 119));
  house.expect_all_well("farewells");
}

TEST(WebServer, a_dismissed_browser_that_does_nothing_is_gone_in_time) {
  Counted counted;
  WebLimits limits;
  limits.handshake_seconds = 0.5;
  House house(limits);
  auto [idle, idle_id] = house.visit();
  auto [deaf, deaf_id] = house.visit(4096);
  for (int i = 0; i < 20; ++i) house.here().send(deaf_id, counted.message(1 << 20));
  house.here().dismiss(idle_id, "goodbye");
  house.here().dismiss(deaf_id, "goodbye");
  idle.say("this is heard by nobody");
  EXPECT_TRUE(house.soon([&] { return house.left.size() == 2; }, 4));
  for (int i = 0; i < 100 && counted.alive > 0; ++i) std::this_thread::sleep_for(20ms);
  EXPECT_EQ(counted.alive, 0);
  house.expect_all_well("stubborn browsers");
}

TEST(WebServer, a_wrong_answer_to_a_farewell_holds_nobody) {
  auto const frame = WebSocketClient::frame;
  WebLimits limits;
  limits.handshake_seconds = 0.5;
  auto house = std::make_unique<House>(limits);
  std::vector<std::string> const answers = {
      frame(0x83, "no such opcode", true, {}), frame(0x81, "not masked", false, {}), frame(0x88, "x", true, {}),
      frame(0x89, "a ping", true, {}) + frame(0x88, "x", true, {}), frame(0x81, "", true, std::uint64_t{1} << 40)};
  std::vector<WebSocketClient> clients;
  auto const dismiss_and_answer = [&](std::string const& answer) {
    auto [client, id] = house->visit();
    client.polite = false;
    house->here().dismiss(id, "goodbye");
    EXPECT_EQ(client.end().reason, "goodbye");
    client.connection().write(answer);
    clients.push_back(std::move(client));
  };
  for (auto const& answer : answers) dismiss_and_answer(answer);
  EXPECT_TRUE(house->soon([&] { return house->left.size() == answers.size(); }));
  house->expect_all_well("wrong answers");
  for (auto const& answer : answers) dismiss_and_answer(answer);
  std::this_thread::sleep_for(50ms);
  auto const start = Clock::now();
  house.reset();
  EXPECT_LT(seconds_since(start), 1);
}

TEST(WebServer, a_wrong_frame_that_crosses_a_farewell_holds_nobody) {
  auto house = std::make_unique<House>();
  auto [other, other_id] = house->visit();
  auto [client, id] = house->visit();
  // While the server's thread sleeps, both come: it sees them at the same time.
  other.say("sleep");
  std::this_thread::sleep_for(50ms);
  client.connection().write(WebSocketClient::frame(0x83, "no such opcode"));
  house->here().dismiss(id, "goodbye");
  EXPECT_TRUE(house->soon([&, id = id] { return house->left == std::vector{id}; }));
  std::promise<void> ended;
  std::thread end([&] {
    house.reset();
    ended.set_value();
  });
  if (ended.get_future().wait_for(10s) != std::future_status::ready) {
    std::fputs("the server does not end\n", stderr);
    std::abort();
  }
  end.join();
}

TEST(WebServer, who_is_dismissed_cannot_stay_by_talking) {
  WebLimits limits;
  limits.handshake_seconds = 0.5;
  House house(limits);
  auto [client, id] = house.visit(4096);
  house.here().send(id, binary(std::vector<char>(20'000'000)));
  house.here().dismiss(id, "goodbye");
  auto const start = Clock::now();
  while (house.now(house.left).empty() && seconds_since(start) < 10) {
    client.connection().write(WebSocketClient::frame(0x8a, "pong") + WebSocketClient::frame(0x81, "but"));
    std::this_thread::sleep_for(50ms);
  }
  EXPECT_LT(seconds_since(start), 5);
  EXPECT_TRUE(house.now(house.said).empty());
}

TEST(WebServer, who_answers_no_ping_is_gone_and_who_does_may_be_silent) {
  WebLimits limits;
  limits.idle_seconds = 1;
  House house(limits);
  auto [silent, silent_id] = house.visit();
  auto [polite, polite_id] = house.visit();
  polite.connection().patience = 2.5;
  EXPECT_EQ(polite.end().kind, Kind::nothing);
  EXPECT_GE(polite.pings, 3);
  EXPECT_EQ(house.now(house.left), std::vector{silent_id});
  polite.say("hello");
  EXPECT_EQ(polite.hear(), "heard: hello");
}

TEST(WebServer, a_slow_line_is_alive_as_long_as_something_moves) {
  WebLimits limits;
  limits.idle_seconds = 1;
  House house(limits);
  auto [slow, id] = house.visit(65536);
  house.here().send(id, binary(std::vector<char>(16'000'000)));
  // 16 MB in some 3 s, in one message: the pong comes only behind it.
  auto const start = Clock::now();
  std::vector<char> bytes(1'000'000);
  for (int i = 0; i < 16; ++i) {
    ASSERT_TRUE(slow.connection().read(bytes.data(), bytes.size())) << i;
    std::this_thread::sleep_for(180ms);
  }
  EXPECT_GT(seconds_since(start), 2);
  EXPECT_TRUE(house.now(house.left).empty());
}

TEST(WebServer, a_port_can_be_chosen_and_is_one_servers_own) {
  WebServer first({}, 0, "");
  EXPECT_EQ(first.token().size(), 32U);
  EXPECT_EQ(first.token().find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(message([&] { WebServer second({}, first.port(), ""); }),
            "port " + std::to_string(first.port()) +
                " on 127.0.0.1 is taken; choose another by --port, or leave it out for a free one");
  std::uint16_t port = 0;
  {
    WebServer third({}, 0, "a token/of one's own");
    port = third.port();
    EXPECT_NE(port, first.port());
    EXPECT_NE(third.token(), first.token());
    EXPECT_EQ(third.address(), "http://127.0.0.1:" + std::to_string(port) + "/?token=a%20token%2Fof%20one%27s%20own");
    EXPECT_EQ(get(port, "/?token=a%20token%2Fof%20one%27s%20own").status, 404);
    WebSocketClient const browser(port, "a%20token%2Fof%20one%27s%20own");
  }
  // Free again at once, though connections have just been closed.
  WebServer const fourth({}, port, token);
  EXPECT_EQ(fourth.port(), port);
  EXPECT_EQ(get(port, std::string("/?token=") + token).status, 404);
}

TEST(WebServer, ends_quickly_whatever_the_others_do) {
  double best = 1e9;
  for (int trial = 0; trial < 3; ++trial) {
    std::vector<WebConnection> rude;
    std::vector<WebSocketClient> browsers;
    std::atomic<int> joined{0};
    std::atomic<int> left{0};
    WebEvents events;
    events.joined = [&](std::uint64_t) { ++joined; };
    events.left = [&](std::uint64_t) { ++left; };
    events.file = [](std::string_view) {
      return WebFile{"text/plain", std::make_shared<std::string const>(20'000'000, 'x')};
    };
    auto server = std::make_unique<WebServer>(events, 0, token);
    for (int i = 0; i < 8; ++i) rude.emplace_back(server->port());
    for (int i = 0; i < 4; ++i) rude[static_cast<std::size_t>(i)].write("GET /?tok");
    rude[4].write(std::string("GET /?token=") + token + " HTTP/1.1\r\n" + host_line(server->port()) + "\r\n");
    rude[5].write("GET / HTTP/1.1\r\n\r\n");
    for (int i = 0; i < 6; ++i) browsers.emplace_back(server->port(), token, 4096);
    while (joined < 6) std::this_thread::sleep_for(1ms);
    for (std::uint64_t id = 1; id <= 3; ++id) server->send(id, binary(std::vector<char>(20'000'000)));
    server->dismiss(4, "goodbye");
    browsers[4].connection().write(WebSocketClient::frame(0x83, "wrong"));
    std::thread reader([&] {
      auto const end = browsers[5].end();
      EXPECT_EQ(end.code, 1001);
      EXPECT_EQ(end.reason, "the window is closed");
    });
    std::this_thread::sleep_for(20ms);
    auto const start = Clock::now();
    server.reset();
    best = std::min(best, seconds_since(start));
    reader.join();
    EXPECT_EQ(joined, left);
  }
#ifdef BOLTZMANN_SANITIZED
  constexpr double soon = 2;  // what looks on takes its time
#else
  constexpr double soon = 0.2;
#endif
  EXPECT_LT(best, soon);

  auto const start = Clock::now();
  for (int i = 0; i < 20; ++i) WebServer const unused({}, 0, "");
  EXPECT_LT(seconds_since(start), 2);
}

TEST(WebServer, what_has_been_sent_before_the_end_arrives) {
  auto house = std::make_unique<House>();
  auto visit = house->visit();
  house->here().send(visit.second, WebMessage::of_text("bye"));
  std::string heard;
  WebReceived end;
  std::thread reader([&] {
    heard = visit.first.hear();
    end = visit.first.end();
  });
  house.reset();
  reader.join();
  EXPECT_EQ(heard, "bye");
  EXPECT_EQ(end.code, 1001);
}

}  // namespace
}  // namespace boltzmann::web_server_test
