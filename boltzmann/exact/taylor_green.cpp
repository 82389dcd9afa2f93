// The Taylor-Green vortices in the plane.
#include <boltzmann/exact/checks.hpp>
#include <boltzmann/exact/taylor_green.hpp>

#include <cmath>

namespace boltzmann::exact {

FlowState taylor_green(Vector<2> const& position, double time, double speed, double edge, double viscosity,
                       double density) {
  char const* const who = "Taylor and Green's vortices";
  check_finite(who, "position", position[0]);
  check_finite(who, "position", position[1]);
  check_not_negative(who, "time", time);
  check_finite(who, "speed", speed);
  check_positive(who, "edge", edge);
  check_not_negative(who, "viscosity", viscosity);
  check_positive(who, "density", density);
  double const k = 2 * pi / edge, x = k * position[0], y = k * position[1];
  double const now = speed * std::exp(-2 * k * k * viscosity * time);
  return {{-now * std::cos(x) * std::sin(y), now * std::sin(x) * std::cos(y)},
          2 * k * now * std::cos(x) * std::cos(y),
          -density / 4 * now * now * (std::cos(2 * x) + std::cos(2 * y))};
}

}  // namespace boltzmann::exact
