// A vortex beside a cylinder of panels, of radius 1 about the origin: its image and one at the centre carry it around.
#pragma once

#include <boltzmann/boltzmann.hpp>

namespace boltzmann::test {

struct VortexBesideCylinder {
  Ensemble<Vortex<2>> vortex{"vortex", 1};
  Ensemble<Panel<2>> cylinder{"cylinder"};
  Box box{{-4, -4}, {4, 4}};
  PairScheme pairs{box};
  PanelScheme bodies{box};
  /// Exactly -Gamma R^2 / (2 pi r^2 (r^2 - R^2)), for a body without circulation.
  double angular_velocity;

  VortexBesideCylinder(double r, double circulation) : angular_velocity(-circulation / (2 * pi * r * r * (r * r - 1))) {
    vortex[0].position = {r, 0};
    vortex[0].vorticity[0] = circulation;
    pairs.between(cylinder, vortex, one_way(BiotSavart{}));
    bodies.add_body(cylinder, circle_outline({0, 0}, 1, 200));
    bodies.add(vortex);
  }
};

}  // namespace boltzmann::test
