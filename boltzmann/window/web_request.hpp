// Web request: what of it is checked before anything is answered, and the heads of answers. Private to this room.
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
/// The path of a request, decoded; nothing if it could lead out of the folder in which somebody looks for it.
std::optional<std::string> clean_path(WebRequest const& request);

/// What is said instead of what was asked for; status 0 if all is well so far.
struct Refusal {
  int status = 0;
  std::string text;
};
/// Host, Origin, token and method, in this order, so that a stranger learns nothing of what is here.
Refusal check_request(WebRequest const& request, std::string_view token, bool upgrade);

/// Headers of every answer; of the scripts in it a browser runs those that know the nonce alone.
std::array<std::pair<char const*, std::string>, 5> security_headers(std::string const& nonce = "");
std::string response_head(int status, std::string_view type, std::size_t bytes, std::string const& nonce = "");

}  // namespace boltzmann
