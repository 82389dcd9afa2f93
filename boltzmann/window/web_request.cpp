// Identifies requests by their headers.
#include <boltzmann/window/web_request.hpp>

#include <algorithm>
#include <charconv>

namespace boltzmann {
namespace {

namespace http = boost::beast::http;

bool is_alphanumeric(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Nothing if a % is not followed by two hexadecimal digits.
std::optional<std::string> percent_decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned byte = static_cast<unsigned char>(text[i]);
    if (text[i] == '%') {
      if (i + 2 >= text.size()) return {};
      char const *const digits = text.data() + i + 1, *const end = digits + 2;
      if (std::from_chars(digits, end, byte, 16).ptr != end) return {};
      i += 2;
    }
    result += static_cast<char>(byte);
  }
  return result;
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

/// Constant time: takes as long for a nearly right token as for a wrong one.
bool same_token(std::string_view right, std::string_view given) {
  unsigned volatile difference = right.size() == given.size() ? 0 : 1;
  for (std::size_t i = 0; i < right.size(); ++i) {
    unsigned const byte = given.empty() ? 0U : static_cast<unsigned char>(given[i % given.size()]);
    difference = difference | (static_cast<unsigned char>(right[i]) ^ byte);
  }
  return difference == 0;
}

/// True if Host names this machine, with any port, because `ssh -L` may change it.
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

}  // namespace

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

std::optional<std::string> clean_path(WebRequest const& request) {
  auto const target = view(request.target());
  auto path = percent_decoded(target.substr(0, target.find_first_of("?#")));
  if (!path || !path->starts_with('/') || path->find("..") != std::string::npos) return {};
  for (char const c : *path) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == '\\') return {};
  }
  return path;
}

Refusal check_request(WebRequest const& request, std::string_view token, bool upgrade) {
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

std::array<std::pair<char const*, std::string>, 5> security_headers(std::string const& nonce) {
  std::string const scripts = nonce.empty() ? "'none'" : "'nonce-" + nonce + "'";
  return {{{"Content-Security-Policy",
            "default-src 'none'; script-src " + scripts +
                "; style-src 'unsafe-inline'; img-src 'self' data: blob:; media-src blob:; connect-src 'self'; "
                "base-uri 'none'; form-action 'none'; frame-ancestors http://localhost:* http://127.0.0.1:* 'self'"},
           {"X-Content-Type-Options", "nosniff"},
           {"Referrer-Policy", "no-referrer"},
           {"Cache-Control", "no-store"},
           {"Cross-Origin-Resource-Policy", "same-origin"}}};
}

std::string response_head(int status, std::string_view type, std::size_t bytes, std::string const& nonce) {
  std::string head = "HTTP/1.1 " + std::to_string(status) + " ";
  head += view(http::obsolete_reason(static_cast<http::status>(status)));
  head += "\r\nConnection: close\r\nContent-Length: " + std::to_string(bytes) + "\r\nContent-Type: ";
  head += type;
  for (auto const& [name, value] : security_headers(nonce)) head += std::string("\r\n") + name + ": " + value;
  if (status == 405) head += "\r\nAllow: GET";
  if (status == 426) head += "\r\nUpgrade: websocket";
  if (status == 503) head += "\r\nRetry-After: 1";
  return head + "\r\n\r\n";
}

}  // namespace boltzmann
