// Source: the contents of a window, for its clients: a live run, a stored one, or the gallery of scenarios.
#pragma once

#include <boltzmann/pictures/canvas.hpp>

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace boltzmann {

/// Measured quantities over time, from which a page draws curves. Row by row: step, time, and one number per column.
struct ShownTable {
  int number = 0;  ///< changes when existing rows have changed
  std::size_t columns = 0;
  std::vector<double> values;

  std::size_t rows() const { return columns > 0 ? values.size() / columns : 0; }
  /// Adds a row. When there are `most` rows, every other one is removed and the number changes.
  void add(std::vector<double> const& row);
  static constexpr std::size_t most = 20'000;
};

/// A picture as a file.
struct PictureFile {
  std::string name, type, content;  ///< "copper-120.png", "image/png"
  std::vector<double> frame;        ///< left, top, width and height of the drawing in pixels
};

/// The members of messages are those of protocol.md. All functions are called on the simulation's thread.
class Source {
 public:
  virtual ~Source() = default;

  /// The complete first message.
  virtual nlohmann::json hello() const = 0;
  /// The members of an update, without views, table, selected and viewers.
  virtual nlohmann::json status() const = 0;
  /// Changes when views may have changed (a step was done), and when the status changes.
  virtual std::uint64_t scene() const = 0;
  virtual std::uint64_t notice() const = 0;

  /// Executes a request of a page, and returns the members of the reply. Throws Error with one line on failure.
  virtual nlohmann::json perform(nlohmann::json const& request) = 0;
  /// The current drawing of a view. Throws Error with one line.
  virtual std::shared_ptr<Canvas const> draw(nlohmann::json const& view) = 0;
  /// The same as a file, for the request "picture".
  virtual PictureFile picture(nlohmann::json const& request) = 0;
  /// The fields of a particle; null if it does not exist.
  virtual nlohmann::json particle(std::string const& ensemble, std::size_t number) const = 0;
  virtual ShownTable const* table() const { return nullptr; }
};

}  // namespace boltzmann
