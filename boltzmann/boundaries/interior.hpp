// Interior: what is further from all ends of a box than a reach, and so has no images within reach of the box.
#pragma once

#include <boltzmann/boundaries/box.hpp>

#include <array>

namespace boltzmann {

class Interior {
 public:
  Interior(Box const& box, Box::Edges const& edges, double reach)
      : dimension_(box.sheared() ? 0 : box.dimension()) {  // in a sheared one images come from anywhere along the flow
    for (int a = 0; a < dimension_; ++a) low_[a] = edges[a] + reach, high_[a] = edges[3 + a] - reach;
  }
  bool holds(double const* x) const {
    bool inside = dimension_ > 0;
    for (int a = 0; a < dimension_; ++a) inside = inside && x[a] > low_[a] && x[a] < high_[a];
    return inside;
  }

 private:
  int dimension_;
  std::array<double, 3> low_{}, high_{};
};

}  // namespace boltzmann
