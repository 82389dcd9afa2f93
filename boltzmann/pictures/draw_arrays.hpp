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

/// The data of draw_cartesian besides positions. Arrays have one element per particle or are empty; they are only read
/// during the call.
struct CartesianStyle {
  std::string title;
  std::string unit;        // of lengths
  double unit_factor = 1;  // factor from lengths to that unit
  std::array<std::string, 3> axes = {"x", "y", "z"};

  std::span<double const> value = {};  // values for the colours of particles, with a colour bar
  std::string value_name, value_unit;
  double value_factor = 1;                                      // factor from values to that unit
  double value_low = std::numeric_limits<double>::quiet_NaN();  // NaN: automatic (diverging: -a..a)
  double value_high = std::numeric_limits<double>::quiet_NaN();
  ColourMap map = ColourMap::viridis;

  std::span<int const> species = {};       // species for the colours of particles without values
  std::vector<std::string> species_names;  // entries of the legend
  std::vector<Colour> species_colours;     // per species; default: the palette

  std::span<double const> diameter = {};  // of each particle, in units of length
  double common_diameter = 0;             // of all particles; 0 without diameters: points of a suitable size

  std::vector<std::array<double, 2>> box;                // {low, high} per axis, drawn as an outline; may be empty
  std::array<bool, 3> periodic = {false, false, false};  // connections longer than half the box cross the wall

  std::span<std::array<std::size_t, 2> const> connections = {};
  std::array<std::span<double const>, 3> velocity = {};  // arrows; the longest has the length of 1.5 particle distances
  std::string velocity_unit;
};

/// Particles in two dimensions, with the same scale on x and y and a cloud per species. Throws Error if arrays differ
/// in length or a connection names a particle that doesn't exist.
Canvas draw_cartesian(std::span<double const> x, std::span<double const> y, CartesianStyle const& style = {});

/// Particles in three dimensions: a space, with the box as its axes (around the particles, if the style has no box).
Canvas draw_cartesian(std::span<double const> x, std::span<double const> y, std::span<double const> z,
                      CartesianStyle const& style = {}, Projection const& projection = {});

/// One species or one quantity: y over x, with its name.
struct Series {
  std::string label;
  std::span<double const> x, y;
  std::optional<Colour> colour = {};  // empty: from the palette
};

/// A point per particle and a colour per species (velocity over position, for example).
Canvas draw_phase_space(std::span<Series const> species, Axis x, Axis y, std::string title = "");
/// The same for clouds. Their names make a legend if there are several without values; points have a suitable size.
Canvas draw_phase_space(std::vector<Canvas::Cloud> clouds, Axis x, Axis y, std::string title = "");

/// Density over frequency (or wave number). y is logarithmic if log_density, regardless of the axis.
Canvas draw_spectrum(std::span<double const> frequency, std::span<double const> density, Axis x, Axis y,
                     bool log_density = true, std::string title = "");

/// A curve per quantity over time; the time axis ends where the series end.
Canvas draw_time_series(std::span<Series const> series, Axis x, Axis y, std::string title = "");

/// A curve per quantity along an axis of space. Bins have marks if there are few enough to distinguish them; bins
/// without a value (NaN) are gaps.
Canvas draw_profile(std::span<Series const> series, Axis x, Axis y, std::string title = "");

/// The distribution of values.
struct Histogram {
  double low = 0, width = 1;    ///< of the first bin: low <= value < low + width; the last bin includes its end
  std::vector<double> density;  ///< per bin: the fraction of all finite values in it, over its width
  std::size_t count = 0;        ///< finite values, inside or outside of low..high
  std::size_t outside = 0;
};
/// Bins between low and high (NaN: the smallest and the largest value of all samples together). If the number of bins
/// is 0, their width is 2 (interquartile range) / N^{1/3} of the sample that gives the most bins (D. Freedman and P.
/// Diaconis 1981), limited to between 10 and 200 bins. Empty if no value is finite.
std::vector<Histogram> histograms(std::span<std::span<double const> const> samples, std::size_t bins = 0,
                                  double low = std::numeric_limits<double>::quiet_NaN(),
                                  double high = std::numeric_limits<double>::quiet_NaN());

/// A step curve per histogram, named by `labels`, over the bins. On a logarithmic y axis empty bins fall below the
/// picture.
Canvas draw_histogram(std::span<Histogram const> histograms, std::span<std::string const> labels,
                      std::span<Colour const> colours, Axis x, Axis y, std::string title = "");

/// The values at the ends of a colour bar.
struct ColourEnds {
  double low = std::numeric_limits<double>::quiet_NaN();  // NaN: the smallest and the largest finite value, or -a and a
  double high = std::numeric_limits<double>::quiet_NaN();  // with the diverging map
  double factor = 1;                                       // factor from values to the bar's unit
};

/// Values on a mesh (columns x rows, row by row from the low end of y) that fills the axes from low to high (NaN: 0 and
/// the number of cells), with a colour bar.
Canvas draw_field(int columns, int rows, std::span<double const> values, Axis x, Axis y, std::string value_name,
                  std::string value_unit, ColourMap map = ColourMap::viridis, std::string title = "",
                  ColourEnds const& ends = {});

/// Contour lines of values on the nodes of a plane grid, coloured by level, with a colour bar from the lowest to the
/// highest level unless `ends` is set. Axes without ends show the whole grid.
Canvas draw_contours(MeshGrid const& grid, std::span<double const> values, std::span<double const> levels, Axis x,
                     Axis y, std::string value_name, std::string value_unit, std::string title = "",
                     ColourEnds const& ends = {});

/// Uniform shades between levels (ascending), the lowest darkest, with the levels in the legend. With the mean as the
/// only level, values above average are white and others black. The mesh is as in draw_field.
Canvas draw_bands(int columns, int rows, std::span<double const> values, std::span<double const> levels, Axis x, Axis y,
                  std::string const& value_name, std::string const& value_unit, std::string title = "",
                  double factor = 1);

}  // namespace boltzmann
