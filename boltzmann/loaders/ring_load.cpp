// Places on a circle.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/vector.hpp>
#include <boltzmann/loaders/ring_load.hpp>

#include <fmt/format.h>

#include <cmath>

namespace boltzmann {

void ring_load(AnyEnsemble& ensemble, RingOptions const& options) {
  if (ensemble.dimension() == 1) throw Error("ring load: on a line there is no circle");
  if (!(options.radius > 0 && std::isfinite(options.radius)))
    throw Error(fmt::format("ring load: the radius must be positive, not {}", options.radius));
  Vector<3> normal{0, 0, 1};
  if (ensemble.dimension() == 3) normal = {options.normal[0], options.normal[1], options.normal[2]};
  double const length = magnitude(normal);
  if (!(length > 0 && std::isfinite(length))) throw Error("ring load: the normal has no direction");
  normal = normal * (1 / length);
  // From the x axis, turned into the plane.
  Vector<3> first = std::abs(normal[0]) < 0.9 ? Vector<3>{1, 0, 0} : Vector<3>{0, 1, 0};
  first -= normal * dot(first, normal);
  first = first * (1 / magnitude(first));
  Vector<3> const second = cross(normal, first);
  for (std::size_t k = 0; k < ensemble.size(); ++k) {
    double const angle = 2 * pi * static_cast<double>(k) / static_cast<double>(ensemble.size());
    double const radius = options.radius * (1 + options.ripple * std::cos(static_cast<double>(options.mode) * angle));
    Vector<3> const from_centre = (first * std::cos(angle) + second * std::sin(angle)) * radius;
    for (int a = 0; a < ensemble.dimension(); ++a)
      ensemble.row(k)[a] = options.centre[static_cast<std::size_t>(a)] + from_centre[a];
  }
}

}  // namespace boltzmann
