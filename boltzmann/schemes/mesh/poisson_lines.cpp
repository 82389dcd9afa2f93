// Sine, cosine and exponential modes by Fourier transforms, and their slopes.
#include <boltzmann/schemes/mesh/poisson_lines.hpp>

#include <cstring>

namespace boltzmann::poisson {

Lines::Lines(Axis const& axis, Layout layout, bool with_slope) : axis_(&axis), layout_(layout) {
  std::size_t const n = axis.modes;
  std::size_t count = layout == Layout::row ? 1 : block_width;
  width_ = count;
  using enum FourierKind;
  switch (axis.kind) {
    case Kind::single:
      break;
    case Kind::periodic:
    case Kind::open:
      if (layout == Layout::complex_columns) count /= 2;
      forward_ = {layout == Layout::row               ? real_to_complex
                  : layout == Layout::complex_columns ? complex_forward
                                                      : real_to_halfcomplex,
                  n, count};
      backward_ = {layout == Layout::row               ? complex_to_real
                   : layout == Layout::complex_columns ? complex_backward
                                                       : halfcomplex_to_real,
                   n, count};
      if (with_slope) slope_ = backward_;
      break;
    case Kind::dirichlet:
      forward_ = backward_ = {sine, n, count};
      if (with_slope) slope_ = {cosine, n + 2, count};
      break;
    case Kind::neumann:
      forward_ = backward_ = {cosine, n, count};
      if (with_slope && n > 2) slope_ = {sine, n - 2, count};
      break;
    case Kind::dirichlet_neumann:
      forward_ = {sine_to_halves, n, count};
      backward_ = {halves_to_sine, n, count};
      if (with_slope) slope_ = {halves_to_cosine, n, count};
      break;
    case Kind::neumann_dirichlet:
      forward_ = {cosine_to_halves, n, count};
      backward_ = {halves_to_cosine, n, count};
      if (with_slope) slope_ = {halves_to_sine, n, count};
      break;
  }
}

void Lines::forward(double* a, double* b) const {
  if (!forward_) return copy(a, b);
  if (axis_->kind == Kind::open) std::fill(a + axis_->samples * width_, a + axis_->modes * width_, 0.0);
  forward_.execute(a, b);
}

Nodes Lines::backward(double* b, double* a) const {
  if (backward_)
    backward_.execute(b, a);
  else
    copy(b, a);
  return {axis_->first, axis_->samples};
}

Nodes Lines::slope(double* b, double* a, double factor) const {
  std::size_t const n = axis_->modes, w = width_;
  double const* const slope = axis_->slope.data();
  Nodes nodes{0, n};
  switch (axis_->kind) {
    case Kind::single:
      std::fill_n(a, w, 0.0);
      return {0, 1};
    case Kind::periodic:
    case Kind::open:
      nodes.count = axis_->nodes;
      if (layout_ == Layout::real_columns)
        rotate_halfcomplex(b, factor);
      else
        rotate_complex(b, factor);
      break;
    case Kind::dirichlet:
      nodes.count = n + 2;
      std::fill_n(b + (n + 1) * w, w, 0.0);
      for (std::size_t j = n; j-- > 0;)
        for (std::size_t c = 0; c < w; ++c) b[(j + 1) * w + c] = factor * slope[j] * b[j * w + c];
      std::fill_n(b, w, 0.0);
      break;
    case Kind::neumann:
      nodes = {1, n - 2};
      for (std::size_t j = 1; j + 1 < n; ++j)
        for (std::size_t c = 0; c < w; ++c) b[(j - 1) * w + c] = factor * slope[j] * b[j * w + c];
      if (n == 2) return nodes;
      break;
    case Kind::dirichlet_neumann:
    case Kind::neumann_dirichlet:
      nodes.first = axis_->kind == Kind::neumann_dirichlet ? 1 : 0;
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t c = 0; c < w; ++c) b[j * w + c] *= factor * slope[j];
      break;
  }
  slope_.execute(b, a);
  return nodes;
}

void Lines::rotate_complex(double* b, double factor) const {
  std::size_t const rows = layout_ == Layout::row ? axis_->modes / 2 + 1 : axis_->modes;
  std::size_t const pairs = layout_ == Layout::row ? 1 : width_ / 2;
  for (std::size_t j = 0; j < rows; ++j) {
    double const f = factor * axis_->slope[j];
    for (std::size_t c = 0; c < pairs; ++c, b += 2) {
      double const real = b[0];
      b[0] = -f * b[1];
      b[1] = f * real;
    }
  }
}

void Lines::rotate_halfcomplex(double* b, double factor) const {
  std::size_t const n = axis_->modes, w = width_;
  std::fill_n(b, w, 0.0);
  if (n % 2 == 0) std::fill_n(b + n / 2 * w, w, 0.0);
  for (std::size_t j = 1; 2 * j < n; ++j)
    for (std::size_t c = 0; c < w; ++c) {
      double const f = factor * axis_->slope[j], real = b[j * w + c];
      b[j * w + c] = -f * b[(n - j) * w + c];
      b[(n - j) * w + c] = f * real;
    }
}

void load(double const* from, std::size_t stride, std::size_t rows, std::size_t columns, double* block) {
  if (columns == block_width) {
    for (std::size_t j = 0; j < rows; ++j)
      std::memcpy(block + j * block_width, from + j * stride, sizeof(double[block_width]));
    return;
  }
  for (std::size_t j = 0; j < rows; ++j) {
    std::copy_n(from + j * stride, columns, block + j * block_width);
    std::fill_n(block + j * block_width + columns, block_width - columns, 0.0);
  }
}
void store(double const* block, std::size_t rows, std::size_t columns, double* to, std::size_t stride) {
  if (columns == block_width) {
    for (std::size_t j = 0; j < rows; ++j)
      std::memcpy(to + j * stride, block + j * block_width, sizeof(double[block_width]));
    return;
  }
  for (std::size_t j = 0; j < rows; ++j) std::copy_n(block + j * block_width, columns, to + j * stride);
}
void store_nodes(double const* block, Nodes nodes, std::size_t all, std::size_t columns, double* to,
                 std::size_t stride) {
  for (std::size_t j = 0; j < nodes.first; ++j) std::fill_n(to + j * stride, columns, 0.0);
  store(block, nodes.count, columns, to + nodes.first * stride, stride);
  for (std::size_t j = nodes.first + nodes.count; j < all; ++j) std::fill_n(to + j * stride, columns, 0.0);
}
void store_row(double const* values, Nodes nodes, std::size_t all, double* to) {
  std::fill_n(to, nodes.first, 0.0);
  std::copy_n(values, nodes.count, to + nodes.first);
  std::fill(to + nodes.first + nodes.count, to + all, 0.0);
}

}  // namespace boltzmann::poisson
