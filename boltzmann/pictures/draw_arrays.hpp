// Drawings: particles in space, phase space, spectra, time series and fields on a canvas, from plain arrays of numbers.
#pragma once

#include <boltzmann/pictures/canvas.hpp>
#include <boltzmann/schemes/mesh/mesh_field.hpp>

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

/// What draw_cartesian shows besides positions. Arrays hold one element per particle or are empty; they are only read
/// while drawing.
struct CartesianStyle {
  std::string title;
  std::string unit;        // of lengths
  double unit_factor = 1;  // lengths times this are in that unit
  std::array<std::string, 3> axes = {"x", "y", "z"};

  std::span<double const> value = {};  // colours the particles, with a colour bar
  std::string value_name, value_unit;
  double value_factor = 1;                                      // values times this are in that unit
  double value_low = std::numeric_limits<double>::quiet_NaN();  // NaN: automatic (diverging: -a..a)
  double value_high = std::numeric_limits<double>::quiet_NaN();
  ColourMap map = ColourMap::viridis;

  std::span<int const> species = {};       // colours the particles if there is no value
  std::vector<std::string> species_names;  // makes a legend
  std::vector<Colour> species_colours;     // of each species; the palette's where there is none

  std::span<double const> diameter = {};  // of each particle, in length units
  double common_diameter = 0;             // of all; 0 and no diameters: points of a fitting size

  std::vector<std::array<double, 2>> box;                // {low, high} for each axis: the outline; may be empty
  std::array<bool, 3> periodic = {false, false, false};  // connections longer than half the box go through the wall

  std::span<std::array<std::size_t, 2> const> connections = {};
  std::array<std::span<double const>, 3> velocity = {};  // arrows; the longest spans 1.5 particle distances
  std::string velocity_unit;
};

/// Particles of two dimensions where they are, one unit as long on x as on y; a cloud for each species.
/// Throws Error if arrays differ in length or a connection names a particle that doesn't exist.
Canvas draw_cartesian(std::span<double const> x, std::span<double const> y, CartesianStyle const& style = {});

/// Particles of three dimensions: a space, with the box for its axes (around the particles, if the style has none).
Canvas draw_cartesian(std::span<double const> x, std::span<double const> y, std::span<double const> z,
                      CartesianStyle const& style = {}, Projection const& projection = {});

/// One species or one quantity: y over x, with its name.
struct Series {
  std::string label;
  std::span<double const> x, y;
  std::optional<Colour> colour = {};  // the palette's without one
};

/// A point for each particle, a colour for each species (velocity over position, for example).
Canvas draw_phase_space(std::span<Series const> species, Axis x, Axis y, std::string title = "");
/// The same of clouds, whose names make a legend if there are several without values; they get points of a fitting
/// size.
Canvas draw_phase_space(std::vector<Canvas::Cloud> clouds, Axis x, Axis y, std::string title = "");

/// Density over frequency (or wave number); y is logarithmic if log_density, whatever the axis says.
Canvas draw_spectrum(std::span<double const> frequency, std::span<double const> density, Axis x, Axis y,
                     bool log_density = true, std::string title = "");

/// A curve for each quantity over time; the time axis ends where the series end.
Canvas draw_time_series(std::span<Series const> series, Axis x, Axis y, std::string title = "");

/// A curve for each quantity along an axis of space, with a mark at each bin where there are few enough to tell them
/// apart; bins without a value (NaN) are gaps.
Canvas draw_profile(std::span<Series const> series, Axis x, Axis y, std::string title = "");

/// How often values occur.
struct Histogram {
  double low = 0, width = 1;    ///< of the first bin: it holds low <= value < low + width, the last one its end as well
  std::vector<double> density;  ///< of each bin: the part of all finite values in it, over its width
  std::size_t count = 0;        ///< finite values, inside low..high or not
  std::size_t outside = 0;
};
/// Bins between low and high (NaN: the smallest and the largest value of all samples together); as many as asked for,
/// or with 0 bins of width 2 (interquartile range) / N^{1/3} of the sample that asks for the most (D. Freedman and
/// P. Diaconis 1981), between 10 and 200 of them. Nothing if no value is finite.
std::vector<Histogram> histograms(std::span<std::span<double const> const> samples, std::size_t bins = 0,
                                  double low = std::numeric_limits<double>::quiet_NaN(),
                                  double high = std::numeric_limits<double>::quiet_NaN());

/// Stairs for each histogram, named by `labels`; the axis of x shows the bins. On a logarithmic y axis empty bins fall
/// below the picture.
Canvas draw_histogram(std::span<Histogram const> histograms, std::span<std::string const> labels,
                      std::span<Colour const> colours, Axis x, Axis y, std::string title = "");

/// What the ends of a colour bar stand for.
struct ColourEnds {
  double low = std::numeric_limits<double>::quiet_NaN();  // NaN: the smallest and the largest finite value, or -a and a
  double high = std::numeric_limits<double>::quiet_NaN();  // with the diverging map
  double factor = 1;                                       // values times this are in the bar's unit
};

/// Values on a mesh (columns x rows, row by row from the low end of y) that fills the axes from low to high (NaN: 0 and
/// the number of cells), with a colour bar.
Canvas draw_field(int columns, int rows, std::span<double const> values, Axis x, Axis y, std::string value_name,
                  std::string value_unit, ColourMap map = ColourMap::viridis, std::string title = "",
                  ColourEnds const& ends = {});

/// The lines along which values on the nodes of a plane grid are at the levels, coloured by level, with a colour bar
/// from the lowest to the highest one unless `ends` says otherwise. Axes without ends show the whole grid.
Canvas draw_contours(MeshGrid const& grid, std::span<double const> values, std::span<double const> levels, Axis x,
                     Axis y, std::string value_name, std::string value_unit, std::string title = "",
                     ColourEnds const& ends = {});

/// What is between levels (ascending) in one shade each, the lowest darkest; the legend tells the levels. With the mean
/// for the only level, what is above average is white and what is below it black. The mesh is as in draw_field.
Canvas draw_bands(int columns, int rows, std::span<double const> values, std::span<double const> levels, Axis x, Axis y,
                  std::string const& value_name, std::string const& value_unit, std::string title = "",
                  double factor = 1);

}  // namespace boltzmann
