// Measures and draws marked-up text with Cairo's font functions.
#include <boltzmann/pictures/figure_text.hpp>

#include <algorithm>
#include <numbers>

namespace boltzmann {
namespace {

constexpr double small = 0.7;  // size of raised and lowered text

// The length of the valid UTF-8 character at the beginning of the text, 0 if there is none.
std::size_t character_length(std::string_view text) {
  auto const byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return byte(0) >= 0x20 && byte(0) != 0x7f ? 1 : 0;
  std::size_t const length = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : 2;
  if (byte(0) < 0xc2 || byte(0) > 0xf4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  if ((byte(0) == 0xe0 && byte(1) < 0xa0) || (byte(0) == 0xed && byte(1) > 0x9f) ||
      (byte(0) == 0xf0 && byte(1) < 0x90) || (byte(0) == 0xf4 && byte(1) > 0x8f))
    return 0;
  return length;
}

double advance(cairo_t* cairo, std::string const& text) {
  cairo_text_extents_t extents;
  cairo_text_extents(cairo, text.c_str(), &extents);
  return extents.x_advance;
}

}  // namespace

std::vector<TextPart> text_parts(std::string_view markup) {
  std::vector<TextPart> parts(1);
  int level = 0;
  for (std::size_t i = 0; i < markup.size();) {
    bool const opens = level == 0 && (markup[i] == '^' || markup[i] == '_') && markup.substr(i + 1, 1) == "{" &&
                       markup.find('}', i) != std::string_view::npos;
    if (opens) {
      level = markup[i] == '^' ? 1 : -1;
      parts.push_back({"", level});
      i += 2;
    } else if (level != 0 && markup[i] == '}') {
      level = 0;
      parts.push_back({"", 0});
      ++i;
    } else {
      std::size_t const length = character_length(markup.substr(i));
      if (length == 0)
        parts.back().text += '?';
      else
        parts.back().text += markup.substr(i, length);
      i += length == 0 ? 1 : length;
    }
  }
  return parts;
}

// Selects the font; raised and lowered text is smaller.
void TextPen::choose(Font font, int level) const {
  cairo_select_font_face(cairo_, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         font.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo_, level == 0 ? font.size : small * font.size);
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(cairo_, options);
  cairo_font_options_destroy(options);
}

double TextPen::width(std::string_view markup, Font font) const {
  double sum = 0;
  for (auto const& part : text_parts(markup)) {
    choose(font, part.level);
    sum += advance(cairo_, part.text);
  }
  return sum;
}

void TextPen::draw(FigurePlan::Text const& text) const {
  double const total = text.align == 0 ? 0 : width(text.markup, text.font), size = text.font.size;
  cairo_save(cairo_);
  cairo_translate(cairo_, text.x, text.y);
  if (text.rotated) cairo_rotate(cairo_, -std::numbers::pi / 2);
  double at = -text.align * total;
  for (auto const& part : text_parts(text.markup)) {
    choose(text.font, part.level);
    cairo_move_to(cairo_, at, part.level > 0 ? -0.38 * size : part.level < 0 ? 0.16 * size : 0);
    if (outlines_) {
      cairo_text_path(cairo_, part.text.c_str());
      cairo_fill(cairo_);
    } else {
      cairo_show_text(cairo_, part.text.c_str());
    }
    at += advance(cairo_, part.text);
  }
  cairo_new_path(cairo_);
  cairo_restore(cairo_);
}

}  // namespace boltzmann
