// What a user may say of a picture, drawing by drawing: the table that scenarios, `bzm render`, pages, run files and
// the guide have it from.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/pictures/picture.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// All members of a Picture but its palette, which is that of a window.
OptionTable const& picture_options();

namespace pictures {
class Scene;
struct Question;
}  // namespace pictures

/// A kind of picture: what can be said of it besides `drawing` and `file`, and who draws it.
struct Drawing {
  std::string name, doc;
  OptionTable options;
  Canvas (*draw)(pictures::Scene& scene);
  void (*check)(pictures::Question const& question);
  std::optional<Dimension> (*dimension)(pictures::Question const& question);  ///< of what is shown; null: a pure number
};
std::vector<Drawing> const& drawings();
/// Error for a name that there is not, with the nearest.
Drawing const& drawing_named(std::string_view name);

}  // namespace boltzmann
