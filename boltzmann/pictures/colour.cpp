// The named colours, the species palette and the colour maps. Maps are interpolated between a few nodes in OKLab, where
// equal steps look equal.
#include <boltzmann/core/error.hpp>
#include <boltzmann/pictures/colour.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
#include <string>

namespace boltzmann {
namespace {

struct Lab {
  double lightness, a, b;
};

constexpr Colour hex(unsigned rgb) {
  return {static_cast<float>((rgb >> 16) & 255) / 255, static_cast<float>((rgb >> 8) & 255) / 255,
          static_cast<float>(rgb & 255) / 255, 1};
}

double to_linear(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }
double to_screen(double l) {
  l = std::clamp(l, 0.0, 1.0);
  return l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055;
}

// The matrices of OKLab (B. Ottosson 2020, public domain).
Lab to_lab(Colour c) {
  double const r = to_linear(c.red), g = to_linear(c.green), b = to_linear(c.blue);
  double const l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  double const m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  double const s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

Colour from_lab(Lab const& lab) {
  double const l = std::pow(lab.lightness + 0.3963377774 * lab.a + 0.2158037573 * lab.b, 3);
  double const m = std::pow(lab.lightness - 0.1055613458 * lab.a - 0.0638541728 * lab.b, 3);
  double const s = std::pow(lab.lightness - 0.0894841775 * lab.a - 1.2914855480 * lab.b, 3);
  return {static_cast<float>(to_screen(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s)),
          static_cast<float>(to_screen(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s)),
          static_cast<float>(to_screen(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)), 1};
}

Lab polar(double lightness, double chroma, double hue_degrees) {
  double const hue = hue_degrees * std::numbers::pi / 180;
  return {lightness, chroma * std::cos(hue), chroma * std::sin(hue)};
}

// A smooth curve through evenly spaced nodes (Catmull-Rom).
Lab through(std::span<Lab const> nodes, double t) {
  auto const last = static_cast<int>(nodes.size()) - 1;
  double const at = t * last;
  int const i = std::clamp(static_cast<int>(at), 0, last - 1);
  double const f = at - i;
  auto node = [&](int k) {
    auto reflect = [&](int edge, int inner) {
      Lab const& e = nodes[static_cast<std::size_t>(edge)];
      Lab const& n = nodes[static_cast<std::size_t>(inner)];
      return Lab{2 * e.lightness - n.lightness, 2 * e.a - n.a, 2 * e.b - n.b};
    };
    if (k < 0) return reflect(0, 1);
    if (k > last) return reflect(last, last - 1);
    return nodes[static_cast<std::size_t>(k)];
  };
  Lab const p = node(i - 1), q = node(i), r = node(i + 1), s = node(i + 2);
  auto cubic = [f](double a, double b, double c, double d) {
    return b + 0.5 * f * (c - a + f * (2 * a - 5 * b + 4 * c - d + f * (3 * (b - c) + d - a)));
  };
  return {cubic(p.lightness, q.lightness, r.lightness, s.lightness), cubic(p.a, q.a, r.a, s.a),
          cubic(p.b, q.b, r.b, s.b)};
}

Colour compute(ColourMap map, double t) {
  switch (map) {
    case ColourMap::viridis: {
      // Nine nodes of the well-known map of S. van der Walt and N. Smith, interpolated by a spline.
      static std::array<Lab, 9> const nodes = {to_lab(hex(0x440154)), to_lab(hex(0x472d7b)), to_lab(hex(0x3b528b)),
                                               to_lab(hex(0x2c728e)), to_lab(hex(0x21918c)), to_lab(hex(0x28ae80)),
                                               to_lab(hex(0x5ec962)), to_lab(hex(0xaddc30)), to_lab(hex(0xfde725))};
      return from_lab(through(nodes, t));
    }
    case ColourMap::ember: {
      static std::array<Lab, 6> const nodes = {polar(0.16, 0.03, 300), polar(0.32, 0.125, 322), polar(0.48, 0.175, 4),
                                               polar(0.64, 0.19, 37),  polar(0.80, 0.155, 72),  polar(0.96, 0.09, 104)};
      return from_lab(through(nodes, t));
    }
    case ColourMap::grey:
      return from_lab({0.18 + 0.76 * t, 0, 0});
    case ColourMap::diverging: {
      static std::array<Lab, 5> const nodes = {polar(0.42, 0.135, 262), polar(0.70, 0.105, 248),
                                               polar(0.965, 0.004, 90), polar(0.70, 0.125, 38), polar(0.42, 0.145, 22)};
      return from_lab(through(nodes, t));
    }
    case ColourMap::cyclic:
      return from_lab(polar(0.73, 0.106, 25 + 360 * t));
  }
  return no_value_grey;
}

constexpr int levels = 1024;

std::array<Colour, levels + 1> map_table(ColourMap map) {
  std::array<Colour, levels + 1> table;
  for (int i = 0; i <= levels; ++i) table[static_cast<std::size_t>(i)] = compute(map, static_cast<double>(i) / levels);
  return table;
}

struct Named {
  std::string name;
  Colour colour;
};

std::array<Named, 13> const& named_colours() {
  static std::array<Named, 13> const table = {{{"white", hex(0xffffff)},
                                               {"black", hex(0x15181c)},
                                               {"blue", hex(0x2f6fd0)},
                                               {"navy", hex(0x1c2f66)},
                                               {"lightblue", hex(0x8ec5ea)},
                                               {"seagreen", hex(0x2e8b6f)},
                                               {"green", hex(0x3f9b3a)},
                                               {"yellow", hex(0xf2cc2f)},
                                               {"brown", hex(0x8a5a34)},
                                               {"orange", hex(0xee8a2a)},
                                               {"pink", hex(0xee8fb2)},
                                               {"red", hex(0xd23b3b)},
                                               {"ink", ink}}};
  return table;
}

}  // namespace

Colour colour_named(std::string_view name) {
  for (auto const& entry : named_colours())
    if (entry.name == name) return entry.colour;
  auto is_digit = [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; };
  if (name.size() == 7 && name[0] == '#' && std::all_of(name.begin() + 1, name.end(), is_digit))
    return hex(static_cast<unsigned>(std::stoul(std::string(name.substr(1)), nullptr, 16)));
  throw Error("unknown colour '" + std::string(name) + "'" + choices(name, colour_names(), "allowed are #rrggbb and"));
}

std::span<std::string const> colour_names() {
  static std::array<std::string, 13> const names = [] {
    std::array<std::string, 13> all;
    std::transform(named_colours().begin(), named_colours().end(), all.begin(), [](Named const& n) { return n.name; });
    return all;
  }();
  return names;
}

Colour species_colour(int index) {
  if (index < 0) return no_value_grey;
  static constexpr std::array<Colour, 8> palette = {hex(0x337fd4), hex(0xe07416), hex(0x26ab97), hex(0xb12075),
                                                    hex(0x68b1e6), hex(0xf3b034), hex(0x7c499f), hex(0x975f34)};
  Colour const base = palette[static_cast<std::size_t>(index) % palette.size()];
  switch (index / static_cast<int>(palette.size()) % 3) {
    case 1:
      return mixed(base, hex(0xffffff), 0.4);
    case 2:
      return mixed(base, hex(0x000000), 0.4);
    default:
      return base;
  }
}

Colour mixed(Colour a, Colour b, double fraction) {
  auto const f = static_cast<float>(fraction);
  return {a.red + f * (b.red - a.red), a.green + f * (b.green - a.green), a.blue + f * (b.blue - a.blue),
          a.alpha + f * (b.alpha - a.alpha)};
}

Colour with_alpha(Colour colour, double alpha) {
  colour.alpha = static_cast<float>(alpha);
  return colour;
}

Colour map_colour(ColourMap map, double zero_to_one) {
  if (std::isnan(zero_to_one)) return no_value_grey;
  static std::array<std::array<Colour, levels + 1>, 5> const tables = {
      map_table(ColourMap::viridis), map_table(ColourMap::ember), map_table(ColourMap::grey),
      map_table(ColourMap::diverging), map_table(ColourMap::cyclic)};
  auto const level = static_cast<std::size_t>(std::lround(std::clamp(zero_to_one, 0.0, 1.0) * levels));
  return tables[static_cast<std::size_t>(map)][level];
}

ColourMap colour_map_named(std::string_view name) {
  auto const names = colour_map_names();
  auto const found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw Error("unknown colour map '" + std::string(name) + "'" + choices(name, names, "allowed are"));
  return static_cast<ColourMap>(found - names.begin());
}

std::span<std::string const> colour_map_names() {
  static std::array<std::string, 5> const names = {"viridis", "ember", "grey", "diverging", "cyclic"};
  return names;
}

double perceived_lightness(Colour colour) { return to_lab(colour).lightness; }

}  // namespace boltzmann
