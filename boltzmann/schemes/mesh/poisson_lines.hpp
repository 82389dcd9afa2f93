// Lines: the transforms of one axis, and blocks of lines that are transformed at once. Private to the solver.
#pragma once

#include <boltzmann/core/fourier.hpp>
#include <boltzmann/schemes/mesh/poisson_axis.hpp>

#include <algorithm>
#include <cstddef>

namespace boltzmann::poisson {

constexpr std::size_t block_width = 16;  ///< doubles, two cache lines: so many columns are transformed at once

enum class Layout {
  row,              ///< one line; periodic and open: complex modes 0 .. n/2
  complex_columns,  ///< block_width / 2 complex lines (or pairs of real ones: all that is done is linear)
  real_columns,     ///< block_width real lines
};

/// A range of nodes; the others are zero.
struct Nodes {
  std::size_t first, count;
};

class Lines {
 public:
  Lines() = default;
  Lines(Axis const& axis, Layout layout, bool with_slope);

  /// Doubles that each of the two arrays of a call must have.
  static std::size_t buffer_size(Axis const& axis, Layout layout) {
    return (axis.modes + 2) * (layout == Layout::row ? 1 : block_width);
  }

  /// Samples in `a` to modes in `b`. Either array is destroyed by what reads it.
  void forward(double* a, double* b) const;
  /// Modes in `b` to samples in `a`, not divided by anything.
  Nodes backward(double* b, double* a) const;
  /// Modes in `b` to factor (-d/dx) at nodes. The derivative of exp(i k x) is i k exp(i k x), that of a sine series is
  /// a cosine series and the other way around; along an open axis the modes are those of the slope already, without
  /// their i and sign.
  Nodes slope(double* b, double* a, double factor) const;

 private:
  void copy(double const* from, double* to) const { std::copy_n(from, axis_->modes * width_, to); }

  void rotate_complex(double* b, double factor) const;
  void rotate_halfcomplex(double* b, double factor) const;

  Axis const* axis_ = nullptr;
  Layout layout_ = Layout::row;
  std::size_t width_ = 1;
  LineTransform forward_, backward_, slope_;
};

/// Columns of an array to a block, and back.
void load(double const* from, std::size_t stride, std::size_t rows, std::size_t columns, double* block);
void store(double const* block, std::size_t rows, std::size_t columns, double* to, std::size_t stride);
/// The nodes of an axis that a block or row has; zero at the others.
void store_nodes(double const* block, Nodes nodes, std::size_t all, std::size_t columns, double* to,
                 std::size_t stride);
void store_row(double const* values, Nodes nodes, std::size_t all, double* to);

}  // namespace boltzmann::poisson
