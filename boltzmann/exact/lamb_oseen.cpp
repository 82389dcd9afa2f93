// The Lamb-Oseen vortex.
#include <boltzmann/core/number.hpp>
#include <boltzmann/exact/checks.hpp>
#include <boltzmann/exact/lamb_oseen.hpp>

#include <cmath>

namespace boltzmann::exact {

VortexState lamb_oseen(double distance, double time, double circulation, double viscosity) {
  check_not_negative("Lamb and Oseen's vortex", "distance", distance);
  check_positive("Lamb and Oseen's vortex", "time", time);
  check_finite("Lamb and Oseen's vortex", "circulation", circulation);
  check_positive("Lamb and Oseen's vortex", "viscosity", viscosity);
  double const width = 4 * viscosity * time, part = distance * distance / width;
  double const velocity = distance == 0 ? 0 : -circulation / (2 * pi * distance) * std::expm1(-part);
  return {velocity, circulation / (pi * width) * std::exp(-part)};
}

}  // namespace boltzmann::exact
