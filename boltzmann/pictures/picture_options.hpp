// The options of a picture, drawing by drawing. This table is used by scenarios, `bzm render`, pages, run files and the
// guide.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/pictures/picture.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// All members of a Picture except its palette, which belongs to the window.
OptionTable const& picture_options();

namespace pictures {
class Scene;
struct Question;
}  // namespace pictures

/// A kind of picture: its options besides `drawing` and `file`, and its functions.
struct Drawing {
  std::string name, doc;
  OptionTable options;
  Canvas (*draw)(pictures::Scene& scene);
  void (*check)(pictures::Question const& question);
  std::optional<Dimension> (*dimension)(pictures::Question const& question);  ///< of the values shown; null: a pure
                                                                              ///< number
};
std::vector<Drawing> const& drawings();
/// Throws Error for an unknown name, with the most similar one.
Drawing const& drawing_named(std::string_view name);

}  // namespace boltzmann
