// Wire format: canvases as bytes for the page (protocol.md). Single precision, each array once, without copies of large
// arrays.
#pragma once

#include <boltzmann/pictures/canvas.hpp>
#include <boltzmann/window/source.hpp>
#include <boltzmann/window/web_server.hpp>

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <memory>
#include <vector>

namespace boltzmann {

/// A binary message under construction: a header in JSON, and arrays in the payload.
class BinaryMessage {
 public:
  /// Adds an array to the payload, and returns its description for the header.
  nlohmann::json array(std::vector<float> values);
  nlohmann::json array(std::vector<double> values);
  nlohmann::json array(std::vector<std::uint32_t> values);
  nlohmann::json array(std::vector<unsigned char> values);
  /// The same for an array with another owner.
  nlohmann::json array(std::shared_ptr<void const> owner, std::vector<float> const& values);
  nlohmann::json array(std::shared_ptr<void const> owner, std::vector<std::uint32_t> const& values);

  /// The message. Moves the payload out.
  WebMessage finish(nlohmann::json const& head);

 private:
  nlohmann::json add(std::shared_ptr<void const> owner, void const* data, std::size_t bytes, std::size_t count,
                     char const* as);
  std::vector<WebPart> payload_;
  std::size_t bytes_ = 0;
};

/// A canvas in the format of the page; its arrays are added to the message. Clouds are not copied, so the canvas is
/// shared.
nlohmann::json canvas_json(std::shared_ptr<Canvas const> const& canvas, BinaryMessage& message);

/// The rows of a table from `from` on, in the format of an update; they are added to the message.
nlohmann::json table_json(ShownTable const& table, std::size_t from, BinaryMessage& message);

/// "#rrggbb", or "#rrggbbaa" if it is not opaque; ink is #010101.
std::string colour_text(Colour colour);

/// Every colour map as 256 colours, by name.
nlohmann::json colour_maps_json();

}  // namespace boltzmann
