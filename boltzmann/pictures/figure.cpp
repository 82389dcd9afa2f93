// Renders pages as PNG, SVG and PDF, in memory and to files.
#include <boltzmann/core/error.hpp>
#include <boltzmann/pictures/figure.hpp>
#include <boltzmann/pictures/figure_page.hpp>

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace boltzmann {
namespace {

struct CairoSurface {
  cairo_surface_t* surface;
  cairo_t* cairo;
  explicit CairoSurface(cairo_surface_t* made) : surface(made), cairo(cairo_create(made)) {}
  ~CairoSurface() {
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
  }
  CairoSurface(CairoSurface const&) = delete;
  CairoSurface& operator=(CairoSurface const&) = delete;
};

enum class Format { png, svg, pdf };

constexpr std::array<char const*, 3> format_names{"png", "svg", "pdf"};

/// The format for the extension of a path; the extension itself if it is unknown.
auto format_of(std::string const& path) {
  return std::find_if(format_names.begin(), format_names.end(),
                      [&](char const* name) { return path.ends_with(std::string(".") + name); });
}

cairo_status_t put(void* bytes, unsigned char const* data, unsigned length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<char const*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

// `what` is the context in errors: "can't write picture 'a.png'".
void check(FigureOptions const& options, std::string const& what) {
  auto allowed = [&](int pixels) { return pixels * options.scale >= 16 && pixels * options.scale <= 20000; };
  if (!allowed(options.width) || !allowed(options.height))
    throw Error(fmt::format("{}: its size is {} x {} pixels times {}; allowed are 16 to 20000 each way", what,
                            options.width, options.height, options.scale));
}

// Device units per pixel of a picture of 1200 x 900.
double unit_of(FigureOptions const& options) {
  return std::max(std::sqrt(static_cast<double>(options.width) * options.height / (1200.0 * 900)), 0.4);
}

// The size of raster pages is rounded to whole pixels.
Page page_of(cairo_t* cairo, FigureOptions const& options, double per_pixel, bool whole) {
  auto const side = [&](int pixels) {
    return whole ? static_cast<double>(std::lround(pixels * per_pixel)) : pixels * per_pixel;
  };
  return {cairo, side(options.width), side(options.height), unit_of(options) * per_pixel, options.dark};
}

cairo_status_t draw_png(Canvas const& canvas, FigureOptions const& options, std::string& bytes) {
  auto const side = [&](int pixels) { return static_cast<int>(std::lround(pixels * options.scale)); };
  CairoSurface target(cairo_image_surface_create(CAIRO_FORMAT_RGB24, side(options.width), side(options.height)));
  if (cairo_surface_status(target.surface) != CAIRO_STATUS_SUCCESS) return cairo_surface_status(target.surface);
  draw_page(canvas, page_of(target.cairo, options, options.scale, true));
  if (cairo_status(target.cairo) != CAIRO_STATUS_SUCCESS) return cairo_status(target.cairo);
  return cairo_surface_write_to_png_stream(target.surface, put, &bytes);
}

cairo_status_t draw_vectors(Canvas const& canvas, FigureOptions const& options, bool svg, std::string& bytes) {
  double const per_pixel = svg ? options.scale : options.scale * 72 / 150;
  double const width = options.width * per_pixel, height = options.height * per_pixel;
  CairoSurface target(svg ? cairo_svg_surface_create_for_stream(put, &bytes, width, height)
                          : cairo_pdf_surface_create_for_stream(put, &bytes, width, height));
  if (svg)
    cairo_svg_surface_set_document_unit(target.surface, CAIRO_SVG_UNIT_PX);
  else
    cairo_pdf_surface_set_metadata(target.surface, CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
  draw_page(canvas, page_of(target.cairo, options, per_pixel, false));
  cairo_status_t const drawn = cairo_status(target.cairo);
  cairo_surface_finish(target.surface);
  return drawn != CAIRO_STATUS_SUCCESS ? drawn : cairo_surface_status(target.surface);
}

std::string bytes_of(Canvas const& canvas, Format format, FigureOptions const& options, std::string const& what) {
  check(options, what);
  std::string bytes;
  cairo_status_t const status = format == Format::png ? draw_png(canvas, options, bytes)
                                                      : draw_vectors(canvas, options, format == Format::svg, bytes);
  if (status != CAIRO_STATUS_SUCCESS) throw Error(what + ": " + cairo_status_to_string(status));
  return bytes;
}

// Writes path + ".part", then renames it.
void write_whole(Canvas const& canvas, Format format, std::string const& path, FigureOptions const& options) {
  std::string const what = "can't write picture '" + path + "'";
  std::string const bytes = bytes_of(canvas, format, options, what);
  std::string const part = path + ".part";
  auto fail = [&](int reason) {
    std::remove(part.c_str());
    throw Error(what + ": " + std::strerror(reason));
  };
  std::FILE* file = std::fopen(part.c_str(), "wb");
  if (file == nullptr) throw Error(what + ": " + std::strerror(errno));
  errno = 0;
  bool const written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() && std::fflush(file) == 0;
  int const write_error = errno;
  bool const closed = std::fclose(file) == 0;
  if (!written) fail(write_error);
  if (!closed) fail(errno);
  if (std::rename(part.c_str(), path.c_str()) != 0) fail(errno);
}

}  // namespace

std::string picture_bytes(Canvas const& canvas, std::string const& format, FigureOptions const& options) {
  auto const found = std::find(format_names.begin(), format_names.end(), format);
  if (found == format_names.end()) throw Error("a picture is made as png, svg or pdf, not as '" + format + "'");
  return bytes_of(canvas, static_cast<Format>(found - format_names.begin()), options, "can't make a picture");
}

bool ends_as_picture(std::string const& path) { return format_of(path) != format_names.end(); }

void write_picture(Canvas const& canvas, std::string const& path, FigureOptions const& options) {
  if (!ends_as_picture(path))
    throw Error("can't write picture '" + path + "': the name must end in .png, .svg or .pdf");
  write_whole(canvas, static_cast<Format>(format_of(path) - format_names.begin()), path, options);
}

PictureLayout layout_of(Canvas const& canvas, FigureOptions const& options) {
  check(options, "can't lay a picture out");
  CairoSurface const anything(cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, 1));
  return layout_of(canvas, page_of(anything.cairo, options, options.scale, true));
}

}  // namespace boltzmann
