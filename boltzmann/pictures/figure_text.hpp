// Text in figures, with raised and lowered parts: "v_{x} (10^{5} cm s^{−1})". Private to the figure sources (needs
// Cairo).
#pragma once

#include <cairo.h>
#include <boltzmann/pictures/figure_plan.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// A part of a text: its level is 0 on the line, 1 raised, −1 lowered.
struct TextPart {
  std::string text;
  int level = 0;
};

/// Splits at ^{...} and _{...}. Characters that are not UTF-8 or not printable become '?'.
std::vector<TextPart> text_parts(std::string_view markup);

/// Draws and measures in the sans-serif font.
class TextPen {
 public:
  /// With outlines, letters are placed exactly (raster); as text, they can be selected and searched (vector files).
  TextPen(cairo_t* cairo, bool outlines) : cairo_(cairo), outlines_(outlines) {}

  double width(std::string_view markup, Font font) const;
  void draw(FigurePlan::Text const& text) const;

 private:
  void choose(Font font, int level) const;

  cairo_t* cairo_;
  bool outlines_;
};

}  // namespace boltzmann
