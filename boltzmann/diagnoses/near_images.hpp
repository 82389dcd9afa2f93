// Near images: particles within a distance of a point, through periodic ends.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/neighbours/cells.hpp>

#include <array>
#include <cstddef>

namespace boltzmann {

/// Calls near(j, image) for particles j of `cells` that may be within `reach` of an image of x, x itself or one beyond
/// periodic ends. Distances are plain ones to that image: if reach is at most half of every periodic axis, each
/// particle is within it of one image at most.
template <int D, class Near>
void each_near(Cells const& cells, double const* x, Box const& box, double reach, Near const& near) {
  for (int n = 0; n < (D == 1 ? 3 : D == 2 ? 9 : 27); ++n) {
    std::array<int, 3> const turns{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
    double image[3] = {0, 0, 0};
    bool reaches = true;
    for (int a = 0; a < D; ++a) {
      image[a] = x[a] + turns[a] * box.length(a);
      reaches = reaches &&
                (turns[a] == 0 || (box.periodic(a) && image[a] > box.low(a) - reach && image[a] < box.high(a) + reach));
    }
    if (reaches)
      cells.near(image, reach, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) near(cells.items()[k], static_cast<double const*>(image));
      });
  }
}

}  // namespace boltzmann
