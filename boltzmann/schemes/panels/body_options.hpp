// Body options: the keys in scenarios for a body in a flow.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/schemes/panels/panel_scheme.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

enum class BodyShape { circle, ellipse, naca, polygon, file };
Words<BodyShape> const& body_shape_words();

struct BodyOptions {
  std::string name;
  BodyShape shape = BodyShape::circle;
  std::optional<std::array<double, 3>> centre;
  double radius = 0, chord = 0;
  double angle = 0;  ///< in degrees
  std::optional<std::array<double, 3>> semi_axes;
  std::string naca;
  std::vector<std::array<double, 2>> points;
  std::string path;   ///< of the file
  double length = 0;  ///< of the file's unit; 0: that of the simulation
  int panels = 200;
  BodySheet sheet;
  std::string no_slip;
  Appearance appearance;
};
OptionTable const& body_options();
/// The keys of a body of this shape.
OptionTable body_options(BodyShape shape);
/// The outline for these options. Throws Error if they are invalid.
Outline outline_of(BodyOptions const& options);

}  // namespace boltzmann
