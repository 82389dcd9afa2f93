// Moments of clouds at a wall.
#include <boltzmann/schemes/mesh/spline.hpp>
#include <boltzmann/schemes/mesh/wall_clouds.hpp>

#include <cmath>

namespace boltzmann {
namespace {

/// The B-spline M_p of Hockney and Eastwood, on [0, p].
double spline_at(int p, double x) {
  if (p == 1) return x >= 0 && x < 1 ? 1 : 0;
  return (x * spline_at(p - 1, x) + (p - x) * spline_at(p - 1, x - 1)) / (p - 1);
}

/// The count on node j of particles with density x^power inside a wall at x = 0, in cells.
double counted(int order, int node, int power) {
  // Weights are polynomials of at most the sixth degree in each half cell: Gauss' rule of four points is exact.
  constexpr double at[4] = {0.0694318442029737, 0.3300094782075719, 0.6699905217924281, 0.9305681557970263};
  constexpr double share[4] = {0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269};
  double sum = 0;
  for (int half = 0; half < 4 * order; ++half)
    for (int i = 0; i < 4; ++i) {
      double const x = (half + at[i]) / 2;
      sum += share[i] / 2 * (power == 1 ? x : 1) * spline_at(order, node - x + 0.5 * order);
    }
  return sum;
}

}  // namespace

WallClouds wall_clouds(int order) {
  WallClouds clouds;
  int const reach = nodes_before(order);
  for (int j = 0; j <= reach; ++j) {
    double const beyond = j == 0 ? 0 : counted(order, -j, 0);
    clouds.smear.push_back(counted(order, j, 0) - beyond - (j == 0 ? 0.5 : 1));
    clouds.slope.push_back(counted(order, j, 1) + counted(order, -j, 1));
  }
  // Counts beyond the wall are added to it twice, and its cell has half the size of others.
  for (int j = 1; j <= reach; ++j) clouds.smear[0] += 2 * counted(order, -j, 0);
  clouds.smear[0] *= 2;
  return clouds;
}

void extrapolate_to_wall(WallClouds const& clouds, double* line, std::size_t count, std::size_t stride, bool high) {
  std::size_t const next = clouds.slope.size();
  if (next >= count) return;
  auto const at = [&](std::size_t j) -> double& { return line[(high ? count - 1 - j : j) * stride]; };
  double const step = (at(next) - at(0)) / (static_cast<double>(next) - clouds.slope[0]);
  for (std::size_t j = 0; j < next; ++j) at(j) -= (clouds.slope[j] - static_cast<double>(j)) * step;
}

}  // namespace boltzmann
