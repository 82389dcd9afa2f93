// Mesh amplitudes: sums over many particles for all waves, by one Fourier transform instead of one sum per wave.
#pragma once

#include <boltzmann/boundaries/box.hpp>

#include <array>
#include <complex>
#include <cstddef>
#include <vector>

namespace boltzmann {

/// The sums over particles of exp(-2 pi i n (x - low)/L) for all waves n with |n_a| <= most[a], in a box that is
/// periodic along all axes. Each particle is spread over the nodes of a mesh by a B-spline of order 6, and the
/// transform is divided by that of the spline (Hockney and Eastwood, ch. 5). The mean with a second mesh, half a cell
/// further along all axes, has no images of odd order (interlacing, ibid.). There are at least four times as many nodes
/// as periods of a wave, so that the error per particle of amplitude 1 is at most bound(). Nodes count integers: the
/// same bits for any threads and order.
class MeshAmplitudes {
 public:
  static constexpr int order = 6;
  /// `rows` begin with positions. All sums are NaN if a position is not finite.
  MeshAmplitudes(std::vector<double const*> const& rows, Box const& box, std::array<int, 3> const& most, int threads);

  std::complex<double> operator()(std::array<int, 3> const& mode) const;

  /// The largest error of the amplitude of one particle: by images, sum over m != 0 with an even sum of its components
  /// of prod_a |n_a / (n_a + m_a M_a)|^6, which at n = M/4 along one axis is 7^-6 + 9^-6 + ... = 1.05e-5.
  double bound(std::array<int, 3> const& mode) const;
  /// Along the axes of the box; 1 along missing ones.
  std::array<std::size_t, 3> nodes() const;

 private:
  using Complex = std::complex<double>;
  struct Counts;
  std::vector<Complex> in_planes(Counts const& counts, int threads) const;
  void transform(Counts const& counts, double shift, int threads);
  std::size_t place(std::array<int, 3> const& n) const;
  std::array<int, 3> in_slots(std::array<int, 3> const& mode) const;

  // The last axis of the box is the last of these, the first one the first; missing axes have one node.
  int dimension_;
  std::array<std::size_t, 3> nodes_{1, 1, 1};
  std::array<int, 3> most_{0, 0, 0};
  std::vector<Complex> amplitudes_;  // of -most .. most along the first two, 0 .. most along the last
};

}  // namespace boltzmann
