// Text in figures, with raised and lowered parts: "v_{x} (10^{5} cm s^{−1})". Private to the figure sources (needs
// Cairo).
#pragma once

#include <cairo.h>

#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// A part of a text: its level is 0 on the line, 1 raised, −1 lowered.
struct TextPart {
  std::string text;
  int level = 0;
};

/// Splits at ^{...} and _{...}. What is not UTF-8 or not printable becomes '?'.
std::vector<TextPart> text_parts(std::string_view markup);

enum class Weight { normal, bold };

/// Draws and measures in the sans-serif font; sizes are heights of the font in device units.
class TextPen {
 public:
  /// As outlines, letters stand exactly where they should (pixels); as text, they can be selected and searched (vector
  /// files).
  TextPen(cairo_t* cairo, bool outlines) : cairo_(cairo), outlines_(outlines) {}

  double width(std::string_view markup, double size, Weight weight = Weight::normal) const;
  /// The baseline begins at (x, y) for align = 0, ends there for align = 1. Rotated: the text runs upwards.
  void draw(std::string_view markup, double x, double y, double size, double align = 0, Weight weight = Weight::normal,
            bool rotated = false) const;
  /// Breaks at spaces so that each line is at most `most` wide (a longer word stands alone).
  std::vector<std::string> wrapped(std::string_view markup, double size, double most,
                                   Weight weight = Weight::normal) const;

 private:
  void choose(double size, Weight weight) const;

  cairo_t* cairo_;
  bool outlines_;
};

}  // namespace boltzmann
