// Wire: canvases as bytes for the page (protocol.md). Single precision, each array once, nothing copied that is large.
#pragma once

#include <boltzmann/pictures/canvas.hpp>
#include <boltzmann/window/source.hpp>
#include <boltzmann/window/web_server.hpp>

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <memory>
#include <vector>

namespace boltzmann {

/// A binary message that is being put together: a head in JSON, and arrays in the payload.
class BinaryMessage {
 public:
  /// Takes an array into the payload; returns what stands for it in the head.
  nlohmann::json array(std::vector<float> values);
  nlohmann::json array(std::vector<double> values);
  nlohmann::json array(std::vector<std::uint32_t> values);
  nlohmann::json array(std::vector<unsigned char> values);
  /// The same for an array that something else owns.
  nlohmann::json array(std::shared_ptr<void const> owner, std::vector<float> const& values);
  nlohmann::json array(std::shared_ptr<void const> owner, std::vector<std::uint32_t> const& values);

  /// The message. The payload is gone afterwards.
  WebMessage finish(nlohmann::json const& head);

 private:
  nlohmann::json add(std::shared_ptr<void const> owner, void const* data, std::size_t bytes, std::size_t count,
                     char const* as);
  std::vector<WebPart> payload_;
  std::size_t bytes_ = 0;
};

/// A canvas as the page wants it: its arrays go into the message. Clouds are not copied, so the canvas is shared.
nlohmann::json canvas_json(std::shared_ptr<Canvas const> const& canvas, BinaryMessage& message);

/// The rows of a table from `from` on, which go into the message, as an update has them.
nlohmann::json table_json(ShownTable const& table, std::size_t from, BinaryMessage& message);

/// "#rrggbb", or "#rrggbbaa" where it is not opaque; ink is #010101.
std::string colour_text(Colour colour);

/// Every colour map as 256 colours, by name.
nlohmann::json colour_maps_json();

}  // namespace boltzmann
