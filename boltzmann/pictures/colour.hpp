// Colours: the named colours, a palette for species suitable for the colour-blind, and colour maps for values.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace boltzmann {

/// A colour of the screen (sRGB), each component in 0..1. alpha = 1 is opaque.
struct Colour {
  float red = 0, green = 0, blue = 0, alpha = 1;
  friend bool operator==(Colour const&, Colour const&) = default;
};

/// The colour of text and frames, resolved when the picture is rendered: nearly black on light paper, nearly white on
/// dark paper.
inline constexpr Colour ink{-1, -1, -1, 1};
constexpr bool is_ink(Colour colour) { return colour.red < 0; }

/// The colour of missing values: map_colour of a NaN.
inline constexpr Colour no_value_grey{0.62F, 0.62F, 0.62F, 1};

/// The twelve colours of the window of 1990 (white black blue navy lightblue seagreen green yellow brown orange pink
/// red), "ink", or "#rrggbb". Throws Error for any other word.
Colour colour_named(std::string_view name);
std::span<std::string const> colour_names();

/// The colour of the species with this index (0, 1, ...): eight colours of distinct hue and lightness, then lighter and
/// darker variants. Grey for negative indices.
Colour species_colour(int index);

/// Interpolates linearly in sRGB from a (fraction = 0) to b (fraction = 1); alpha likewise.
Colour mixed(Colour a, Colour b, double fraction);
Colour with_alpha(Colour colour, double alpha);

/// viridis: dark violet to yellow; ember: black over red to pale yellow; grey: dark to light; diverging: blue over
/// white to red, with 0.5 in the middle; cyclic: all hues at one lightness, for angles (0 and 1 are the same). The
/// lightness of the first three increases uniformly.
enum class ColourMap { viridis, ember, grey, diverging, cyclic };

/// The colour at a position in 0..1 of the map. Positions outside are clamped; NaN gives no_value_grey.
Colour map_colour(ColourMap map, double zero_to_one);

/// The map with this name. Throws Error that lists the names.
ColourMap colour_map_named(std::string_view name);
std::span<std::string const> colour_map_names();

/// Perceived lightness 0..1 of a colour (L of OKLab, B. Ottosson 2020).
double perceived_lightness(Colour colour);

}  // namespace boltzmann
