// Web request: checks of a request before it is answered, and the headers of answers. Private to this module.
#pragma once

#include <array>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace boltzmann {

using WebRequest = boost::beast::http::request<boost::beast::http::empty_body>;

constexpr char const* text_type = "text/plain; charset=utf-8";

std::string percent_encoded(std::string_view text);
/// The path of a request, decoded; nothing if it could lead out of the served folder.
std::optional<std::string> clean_path(WebRequest const& request);

/// The answer to a rejected request; status 0 if it is accepted.
struct Refusal {
  int status = 0;
  std::string text;
};
/// Checks Host, Origin, token and method, in this order, so that a client without the token learns nothing about the
/// contents.
Refusal check_request(WebRequest const& request, std::string_view token, bool upgrade);

/// Headers of every answer. A browser runs only scripts with the nonce.
std::array<std::pair<char const*, std::string>, 5> security_headers(std::string const& nonce = "");
std::string response_head(int status, std::string_view type, std::size_t bytes, std::string const& nonce = "");

}  // namespace boltzmann
