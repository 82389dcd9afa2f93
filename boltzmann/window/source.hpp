// Source: what a window shows, as its clients sees it: a run that goes on, a stored one, or the gallery of scenarios.
#pragma once

#include <boltzmann/pictures/canvas.hpp>

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace boltzmann {

/// Measured quantities over time: what a page draws curves of. Row by row: step, time, and one number a column.
struct ShownTable {
  int number = 0;  ///< another one when rows have changed that were there before
  std::size_t columns = 0;
  std::vector<double> values;

  std::size_t rows() const { return columns > 0 ? values.size() / columns : 0; }
  /// Adds a row; from `most` rows on, every other one goes and the number changes.
  void add(std::vector<double> const& row);
  static constexpr std::size_t most = 20'000;
};

/// A picture as a file.
struct PictureFile {
  std::string name, type, content;  ///< "copper-120.png", "image/png"
  std::vector<double> frame;        ///< left, top, width and height of the drawing in pixels
};

/// The fields of the messages are those of protocol.md. All functions are called on the simulation's thread.
class Source {
 public:
  virtual ~Source() = default;

  /// The message that begins it, whole.
  virtual nlohmann::json hello() const = 0;
  /// The fields of an update, but for views, table, selected and viewers.
  virtual nlohmann::json status() const = 0;
  /// Another number when something can look different (a step was done), and when the status is another.
  virtual std::uint64_t scene() const = 0;
  virtual std::uint64_t notice() const = 0;

  /// Does what a page asks for; returns the fields of the reply. Error with one line if it can't be done.
  virtual nlohmann::json perform(nlohmann::json const& request) = 0;
  /// What a view shows now. Error with one line.
  virtual std::shared_ptr<Canvas const> draw(nlohmann::json const& view) = 0;
  /// The same as a file, as the request "picture" has it.
  virtual PictureFile picture(nlohmann::json const& request) = 0;
  /// The fields of a particle; null if there is none.
  virtual nlohmann::json particle(std::string const& ensemble, std::size_t number) const = 0;
  virtual ShownTable const* table() const { return nullptr; }
};

}  // namespace boltzmann
