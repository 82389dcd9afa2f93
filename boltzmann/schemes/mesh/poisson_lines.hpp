// Lines: the transforms of one axis, and blocks of lines that are transformed together. Private to the solver.
#pragma once

#include <boltzmann/core/fourier.hpp>
#include <boltzmann/schemes/mesh/poisson_axis.hpp>

#include <algorithm>
#include <cstddef>

namespace boltzmann::poisson {

constexpr std::size_t block_width = 16;  ///< number of doubles (two cache lines): the columns that are transformed
                                         ///< together

enum class Layout {
  row,              ///< one line; periodic and open: complex modes 0 .. n/2
  complex_columns,  ///< block_width / 2 complex lines (or pairs of real lines, because all operations are linear)
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

  /// The size in doubles of each of the two arrays of a call.
  static std::size_t buffer_size(Axis const& axis, Layout layout) {
    return (axis.modes + 2) * (layout == Layout::row ? 1 : block_width);
  }

  /// Transforms samples in `a` to modes in `b`. The call destroys the array that it reads.
  void forward(double* a, double* b) const;
  /// Transforms modes in `b` to samples in `a`, without normalisation.
  Nodes backward(double* b, double* a) const;
  /// Transforms modes in `b` to factor (-d/dx) at nodes. The derivative of exp(i k x) is i k exp(i k x); that of a sine
  /// series is a cosine series and vice versa. Along an open axis the modes are already those of the slope, without
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

/// Copies columns of an array to a block, and back.
void load(double const* from, std::size_t stride, std::size_t rows, std::size_t columns, double* block);
void store(double const* block, std::size_t rows, std::size_t columns, double* to, std::size_t stride);
/// Copies the nodes of an axis that a block or row has; writes zero at the others.
void store_nodes(double const* block, Nodes nodes, std::size_t all, std::size_t columns, double* to,
                 std::size_t stride);
void store_row(double const* values, Nodes nodes, std::size_t all, double* to);

}  // namespace boltzmann::poisson
