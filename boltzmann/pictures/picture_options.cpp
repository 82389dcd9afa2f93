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
          .add("frequency", &Dispersion::frequency, number(dimensions::frequency, not_negative), "at k = 0")
          .add("speed", &Dispersion::speed, number(dimensions::velocity, not_negative), "of short waves");
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
  all.add("file", &Picture::file, text(), "in the run's folder; .png, .svg or .pdf");
  all.add("x", &Picture::x, name_of_quantity(), "what is to the right");
  all.add("y", &Picture::y, name_of_quantity(), "what is upwards, or shown in colours");
  all.add("colour", &Picture::colour, name_of_quantity(),
          "a quantity of the particles: a field, `\"speed\"`, `\"kinetic-energy\"`, `\"potential-energy\"`, or a "
          "formula of them",
          "by ensemble");
  all.add("size", &Picture::size, name_of_quantity(),
          "the same for diameters: the largest value gets that of its ensemble", "the ensemble's");
  all.add("vectors", &Picture::vectors, name_of_quantity(),
          "2D and 3D: arrows at the particles, of `\"velocity\"`, `\"influence\"` or a field", "none");
  all.add("low", &Picture::low, number(of_what_is_shown), "the value at the lower end of the colours",
          "the smallest there is");
  all.add("high", &Picture::high, number(of_what_is_shown), "the value at their upper end", "the largest there is");
  all.add("logarithmic", &Picture::logarithmic, flag(),
          "values on a logarithmic axis; what is not positive, or 12 decades below the largest, is left out");
  all.add("trace", &Picture::trace, flag(), "also the tracks through all frames of the trajectory");
  all.add("slice", &Picture::slice, word({"x", "y", "z"}), "3D: the axis that the slice is normal to");
  all.add("at", &Picture::at, number(dimensions::length), "3D: where on that axis", "in the middle");
  all.add_of<Picture>(
      "levels",
      [](Picture& p) -> OptionPlace {
        return CountOrList{&p.level_count, &p.levels};
      },
      {OptionKind::Form::count_or_numbers, of_what_is_shown, {1, 1000}}, "how many levels, or which, ascending");
  all.add_of<Picture>("weight", weight_of, word(weight_words().names()), "how particles are spread over space");
  all.add("range", &Picture::smoothing, &Smoothing::range, number(dimensions::length, positive),
          "how far they are spread", "each particle's own, or one that fits");
  all.add("cells", &Picture::cells, whole(1, 100'000), "cells along the longest side of the picture");
  all.add("streamlines", &Picture::streamlines, whole(0, 200), "2D: lines along the flow, so many beside each other",
          "none");
  all.add("streaklines", &Picture::streaklines, flag(),
          "particles of class Dye as lines, in order of release, one for each place; in 3D of `\"cartesian\"` alone");
  all.add("gap", &Picture::gap, number(dimensions::length, positive),
          "streaklines have gaps where neighbours are further apart, or one between them has been taken away",
          "a tenth of the longest side");
  all.add("bins", &Picture::bins, whole(1, 100'000), "bins");
  all.add_of<Picture>("curve", curves_of, tables(),
                      "`{ frequency = wp, speed = c }` draws omega^2 = wp^2 + c^2 k^2; or a list of them", "none");
  all.add("azimuth", &Picture::projection, &Projection::azimuth, degrees(), "3D: from where one looks, round z");
  all.add("elevation", &Picture::projection, &Projection::elevation, degrees(), "3D: and how high above the xy plane");
  all.add("most", &Picture::most, whole(0, 1e9), "one of every n particles, so that so many are drawn at most; 0: all");
  all.add("region", &Picture::region, numbers(dimensions::length),
          "only the particles inside: `[[low, high], ...]`, a pair for each axis that is shown", "all");
  return all;
}

OptionTable const& members() { return once<make_members>(); }

/// To add a drawing, add an entry here with its three functions; declare them in picture_scene.hpp and define them in a
/// source file of its own (picture_....cpp).
std::vector<Drawing> make_drawings() {  // long: a table, an entry for each drawing
  std::vector<OptionKey> const style{{"colour"}, {"size"}};
  std::vector<OptionKey> const ends{{"low"}, {"high"}};
  std::vector<OptionKey> const axis_ends{{"low", "the lower end of the axis of values"}, {"high", "its upper end"}};
  std::vector<OptionKey> const seen{{"trace"}, {"most"}, {"region"}};
  std::vector<OptionKey> const slices{{"slice"}, {"at"}}, dye{{"streaklines"}, {"gap"}};
  OptionKey const field{"y", "`\"density\"`, or a quantity of the particles", "`\"density\"`"};
  OptionKey const bins{"bins", "how many", "as many as fit"};
  std::vector<OptionKey> const smoothing{{"weight"}, {"range"}, {"cells", "", "`300`", "", whole(2, 4000)}};
  using Keys = std::vector<OptionKey>;
  auto const all = [](std::initializer_list<Keys> parts) {
    Keys keys;
    for (auto const& part : parts) keys.insert(keys.end(), part.begin(), part.end());
    return members().only(keys);
  };
  using namespace pictures;
  return {
      {"cartesian", "particles in space; in 1D, where space is a line, in phase space",
       all({style, {{"vectors"}}, ends, seen, dye, {{"azimuth"}, {"elevation"}}}), draw_particles, check_particles,
       dimension_of_colour},
      {"phase-space", "particles by two of their quantities",
       all({{{"x", "a quantity of the particles", "`\"position.x\"`"}, {"y", "another", "`\"velocity.x\"`"}},
            style,
            ends,
            seen}),
       draw_phase_space, check_phase_space, dimension_of_colour},
      {"histogram", "how often a quantity has which value",
       all({{{"x", "a quantity of the particles", "`\"speed\"`"},
             bins,
             {"low", "where the bins begin"},
             {"high", "where they end"},
             {"logarithmic"}}}),
       draw_histogram, check_histogram, dimension_of_histogram},
      {"spectrum", "the power of a quantity over wave numbers, or of a column over frequencies",
       all({{{"x", "`\"position.x\"`, another axis, or `\"time\"`", "`\"position.x\"`"},
             {"y", "a quantity of the particles; over time a column of diagnoses.csv", "`\"velocity.x\"`"}}}),
       draw_spectrum, check_spectrum, nullptr},
      {"time-series", "columns of diagnoses.csv over time, or over one of them",
       all({{{"x", "a column, to the right: a temperature on a ramp, a volume", "`\"time\"`"},
             {"y", "columns, with commas: `\"kinetic energy, total energy\"`", "all of the first's dimension"},
             {"logarithmic"}}}),
       draw_time_series, check_time_series, nullptr},
      {"curves", "functions that diagnoses gather over the run: radial distributions, correlations, ...",
       all({{{"y",
              "tables, with commas, by the names of their files: `\"radial-distribution\"`; of a column that is not "
              "the "
              "second `\"radial-distribution: coordination number\"`",
              "the first table"}},
            axis_ends,
            {{"logarithmic"}}}),
       draw_curves, check_curves, nullptr},
      {"profile", "matter in bins along an axis, each quantity in its own unit",
       all({{{"x", "`\"position.x\"`, y or z", "`\"position.x\"`"},
             {"y",
              "with commas: `number`, `density`, `velocity.x`, `kinetic-temperature`, `kinetic-temperature.x`, "
              "`internal-temperature`, `pressure.xx`, `internal-energy`, `potential-energy`, `specific-energy`",
              "`\"density\"`"},
             {"bins", "at most; fewer, so that each has 50 particles in the mean", "`300`"}},
            axis_ends,
            {{"logarithmic"}}}),
       draw_profiles, check_profiles, dimension_of_profile},
      {"mesh", "what a mesh has on its nodes",
       all({{{"y", "`\"potential\"`, `\"density\"`, `\"field.x\"`, ...", "`\"potential\"`"}}, slices, ends}), draw_mesh,
       check_mesh, dimension_on_mesh},
      {"wave-spectrum",
       "the power of a quantity of a mesh over wave number and frequency, as its diagnosis recorded it",
       all({{{"y", "which of those recorded, by its quantity", "the first"}, {"curve"}}}), draw_wave_spectrum,
       check_waves, nullptr},
      {"flow", "the flow of vortices, with streams from outside, in colours; in 3D on a slice",
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
      {"streamlines", "lines along the flow of vortices in 2D",
       all({{{"streamlines", "so many beside each other", "`25`", "", whole(1, 200)},
             {"cells", "of the grid on which the flow is found", "`200`", "", whole(2, 2000)}}}),
       draw_flow, check_flow, dimension_of_flow},
      {"map", "a field of the particles in colours; in 1D a curve", all({{field}, slices, ends, smoothing}),
       draw_smooth_field, check_smooth_field, dimension_of_smooth_field},
      {"contours", "the same as lines", all({{field}, slices, ends, {{"levels", "", "8"}}, smoothing}),
       draw_smooth_field, check_smooth_field, dimension_of_smooth_field},
      {"bands", "the same as shades between levels",
       all({{field}, slices, {{"levels", "", "the mean over the picture alone"}}, smoothing}), draw_smooth_field,
       check_smooth_field, dimension_of_smooth_field},
  };
}

}  // namespace

OptionTable const& picture_options() {
  static OptionTable const table = [] {
    OptionTable all;
    all.add("drawing", &Picture::drawing, word(drawing_names()), "what is drawn");
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
