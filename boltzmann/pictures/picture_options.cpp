// The members of a picture with their keys, and the members that each drawing uses.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/once.hpp>
#include <boltzmann/laws/weight.hpp>
#include <boltzmann/pictures/picture_options.hpp>
#include <boltzmann/pictures/picture_scene.hpp>

#include <fmt/format.h>

#include <initializer_list>

namespace boltzmann {
namespace {

using namespace option;

OptionTable const& dispersion_options() {
  static OptionTable const table =
      OptionTable()
          .add("frequency", &Dispersion::frequency, number(dimensions::frequency, not_negative), "frequency at k = 0")
          .add("speed", &Dispersion::speed, number(dimensions::velocity, not_negative), "speed of short waves");
  return table;
}

OptionPlace curves_of(Picture& picture) {
  auto* const curves = &picture.curves;
  return OptionList{&dispersion_options(), [=] { return curves->size(); },
                    [=](std::size_t k) -> void* { return &(*curves)[k]; },
                    [=]() -> void* { return &curves->emplace_back(); }, [=] { curves->clear(); }};
}

OptionPlace weight_of(Picture& picture) { return named_value(&picture.smoothing.shape, weight_words()); }

/// The members from which drawings choose.
OptionTable make_members() {
  OptionTable all;
  all.add("file", &Picture::file, text(), "path in the run's folder: .png, .svg or .pdf");
  all.add("x", &Picture::x, name_of_quantity(), "horizontal axis");
  all.add("y", &Picture::y, name_of_quantity(), "vertical axis, or quantity shown by colour");
  all.add("colour", &Picture::colour, name_of_quantity(),
          "colour by a field, `\"speed\"`, `\"kinetic-energy\"`, `\"potential-energy\"` or a formula of them",
          "by ensemble");
  all.add("size", &Picture::size, name_of_quantity(),
          "diameter by a quantity; the largest value gets the ensemble's diameter", "that of the ensemble");
  all.add("vectors", &Picture::vectors, name_of_quantity(),
          "2D and 3D: arrows of `\"velocity\"`, `\"influence\"` or a field", "none");
  all.add("low", &Picture::low, number(of_what_is_shown), "value at the lower end of the colours", "the smallest");
  all.add("high", &Picture::high, number(of_what_is_shown), "value at the upper end of the colours", "the largest");
  all.add("logarithmic", &Picture::logarithmic, flag(),
          "logarithmic values; leaves out values that are not positive or 12 decades below the largest");
  all.add("trace", &Picture::trace, flag(), "also draw tracks through all frames of the trajectory");
  all.add("slice", &Picture::slice, word({"x", "y", "z"}), "3D: axis normal to the slice");
  all.add("at", &Picture::at, number(dimensions::length), "3D: position of the slice on that axis", "the middle");
  all.add_of<Picture>(
      "levels",
      [](Picture& p) -> OptionPlace {
        return CountOrList{&p.level_count, &p.levels};
      },
      {OptionKind::Form::count_or_numbers, of_what_is_shown, {1, 1000}},
      "number of levels, or a list of ascending levels");
  all.add_of<Picture>("weight", weight_of, word(weight_words().names()), "kernel that spreads particles over space");
  all.add("range", &Picture::smoothing, &Smoothing::range, number(dimensions::length, positive), "range of the kernel",
          "that of each particle, or automatic");
  all.add("cells", &Picture::cells, whole(1, 100'000), "cells along the longest side of the picture");
  all.add("streamlines", &Picture::streamlines, whole(0, 200), "2D: streamlines, this number side by side", "none");
  all.add("streaklines", &Picture::streaklines, flag(),
          "join particles of class Dye in order of release, one line for each place; in 3D only with `\"cartesian\"`");
  all.add("gap", &Picture::gap, number(dimensions::length, positive),
          "largest distance of neighbours on a streakline; wider gaps, and removed particles, interrupt it",
          "a tenth of the longest side");
  all.add("bins", &Picture::bins, whole(1, 100'000), "bins");
  all.add_of<Picture>(
      "curve", curves_of, tables(),
      "dispersion curve: `{ frequency = wp, speed = c }` draws omega^2 = wp^2 + c^2 k^2; or a list of them", "none");
  all.add("azimuth", &Picture::projection, &Projection::azimuth, degrees(), "3D: direction of view around z");
  all.add("elevation", &Picture::projection, &Projection::elevation, degrees(), "3D: angle of view above the xy plane");
  all.add("most", &Picture::most, whole(0, 1e9), "draw every n-th particle, to keep to this number; 0: all");
  all.add("region", &Picture::region, numbers(dimensions::length),
          "only particles inside `[[low, high], ...]`, a pair for each axis shown", "all");
  return all;
}

OptionTable const& members() { return once<make_members>(); }

/// To add a drawing, add an entry here with its three functions; declare them in picture_scene.hpp and define them in a
/// source file of its own (picture_....cpp).
std::vector<Drawing> make_drawings() {  // long: a table, an entry for each drawing
  std::vector<OptionKey> const style{{"colour"}, {"size"}};
  std::vector<OptionKey> const ends{{"low"}, {"high"}};
  std::vector<OptionKey> const axis_ends{{"low", "lower end of the axis of values"},
                                         {"high", "upper end of the axis of values"}};
  std::vector<OptionKey> const seen{{"trace"}, {"most"}, {"region"}};
  std::vector<OptionKey> const slices{{"slice"}, {"at"}}, dye{{"streaklines"}, {"gap"}};
  OptionKey const field{"y", "`\"density\"`, or a quantity of the particles", "`\"density\"`"};
  OptionKey const bins{"bins", "number of bins", "automatic"};
  std::vector<OptionKey> const smoothing{{"weight"}, {"range"}, {"cells", "", "`300`", "", whole(2, 4000)}};
  using Keys = std::vector<OptionKey>;
  auto const all = [](std::initializer_list<Keys> parts) {
    Keys keys;
    for (auto const& part : parts) keys.insert(keys.end(), part.begin(), part.end());
    return members().only(keys);
  };
  using namespace pictures;
  return {
      {"cartesian", "particles in space; in 1D in phase space",
       all({style, {{"vectors"}}, ends, seen, dye, {{"azimuth"}, {"elevation"}}}), draw_particles, check_particles,
       dimension_of_colour},
      {"phase-space", "particles by two of their quantities",
       all({{{"x", "a quantity of the particles", "`\"position.x\"`"}, {"y", "another", "`\"velocity.x\"`"}},
            style,
            ends,
            seen}),
       draw_phase_space, check_phase_space, dimension_of_colour},
      {"histogram", "histogram of a quantity",
       all({{{"x", "a quantity of the particles", "`\"speed\"`"},
             bins,
             {"low", "lower end of the bins"},
             {"high", "upper end of the bins"},
             {"logarithmic"}}}),
       draw_histogram, check_histogram, dimension_of_histogram},
      {"spectrum", "power of a quantity over wave number, or of a column over frequency",
       all({{{"x", "`\"position.x\"`, another axis, or `\"time\"`", "`\"position.x\"`"},
             {"y", "a quantity of the particles; over time a column of diagnoses.csv", "`\"velocity.x\"`"}}}),
       draw_spectrum, check_spectrum, nullptr},
      {"time-series", "columns of diagnoses.csv over time or another column",
       all({{{"x", "column of the horizontal axis, such as temperature or volume", "`\"time\"`"},
             {"y", "columns, separated by commas: `\"kinetic energy, total energy\"`",
              "all with the dimension of the first"},
             {"logarithmic"}}}),
       draw_time_series, check_time_series, nullptr},
      {"curves", "functions that diagnoses average over the run: radial distributions, correlations, ...",
       all({{{"y",
              "files of tables, separated by commas: `\"radial-distribution\"`; for a column other than the second "
              "`\"radial-distribution: coordination number\"`",
              "the first table"}},
            axis_ends,
            {{"logarithmic"}}}),
       draw_curves, check_curves, nullptr},
      {"profile", "profiles: bins along an axis, each quantity with its own scale",
       all({{{"x", "`\"position.x\"`, y or z", "`\"position.x\"`"},
             {"y",
              "separated by commas: `number`, `density`, `velocity.x`, `kinetic-temperature`, `kinetic-temperature.x`, "
              "`internal-temperature`, `pressure.xx`, `internal-energy`, `potential-energy`, `specific-energy`",
              "`\"density\"`"},
             {"bins", "largest number of bins; fewer keep 50 particles per bin on average", "`300`"}},
            axis_ends,
            {{"logarithmic"}}}),
       draw_profiles, check_profiles, dimension_of_profile},
      {"mesh", "quantities on the nodes of a mesh",
       all({{{"y", "`\"potential\"`, `\"density\"`, `\"field.x\"`, ...", "`\"potential\"`"}}, slices, ends}), draw_mesh,
       check_mesh, dimension_on_mesh},
      {"wave-spectrum", "power of a recorded quantity of a mesh over wave number and frequency",
       all({{{"y", "the recorded quantity", "the first"}, {"curve"}}}), draw_wave_spectrum, check_waves, nullptr},
      {"flow", "flow of vortices and streams in colours; in 3D on a slice",
       all({{{"y",
              "`\"vorticity\"`, `\"speed\"`, `\"velocity.x\"`, ...; in 3D, where `\"vorticity\"` is its magnitude, "
              "also `\"vorticity.x\"`, ..., and `\"Q\"`",
              "`\"vorticity\"`"}},
            slices,
            ends,
            {{"streamlines"}},
            dye,
            {{"cells", "", "`200`", "", whole(2, 2000)}}}),
       draw_flow, check_flow, dimension_of_flow},
      {"streamlines", "streamlines of the flow of vortices in 2D",
       all({{{"streamlines", "lines side by side", "`25`", "", whole(1, 200)},
             {"cells", "cells of the grid of the flow", "`200`", "", whole(2, 2000)}}}),
       draw_flow, check_flow, dimension_of_flow},
      {"map", "a field of the particles in colours; in 1D a curve", all({{field}, slices, ends, smoothing}),
       draw_smooth_field, check_smooth_field, dimension_of_smooth_field},
      {"contours", "the same as contour lines", all({{field}, slices, ends, {{"levels", "", "8"}}, smoothing}),
       draw_smooth_field, check_smooth_field, dimension_of_smooth_field},
      {"bands", "the same as filled contours",
       all({{field}, slices, {{"levels", "", "average over this picture only"}}, smoothing}), draw_smooth_field,
       check_smooth_field, dimension_of_smooth_field},
  };
}

}  // namespace

OptionTable const& picture_options() {
  static OptionTable const table = [] {
    OptionTable all;
    all.add("drawing", &Picture::drawing, word(drawing_names()), "kind of picture");
    for (auto const& option : members()) all.add(option);
    return all;
  }();
  return table;
}

std::vector<Drawing> const& drawings() { return once<make_drawings>(); }

std::vector<std::string> const& drawing_names() {
  static std::vector<std::string> const names = [] {
    std::vector<std::string> all;
    for (auto const& drawing : drawings()) all.push_back(drawing.name);
    return all;
  }();
  return names;
}

Drawing const& drawing_named(std::string_view name) {
  for (auto const& drawing : drawings())
    if (drawing.name == name) return drawing;
  throw Error(
      fmt::format("unknown drawing '{}'{}", name, choices(name, drawing_names(), "there are", "bzm list drawings")));
}

}  // namespace boltzmann
