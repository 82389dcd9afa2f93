// Kepler's problem: universal variables, elements and back.
#include <boltzmann/core/error.hpp>
#include <boltzmann/exact/checks.hpp>
#include <boltzmann/exact/kepler.hpp>

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace boltzmann::exact {
namespace {

constexpr char const* name_of_kepler = "Kepler's problem";

void check_orbit_state(OrbitState const& state, double mu) {
  check_positive(name_of_kepler, "constant mu = G (M + m)", mu);
  for (std::size_t a = 0; a < 3; ++a) {
    check_finite(name_of_kepler, "position", state.position[a]);
    check_finite(name_of_kepler, "velocity", state.velocity[a]);
  }
  if (norm2(state.position) == 0) throw Error(fmt::format("{}: the body is in the centre", name_of_kepler));
}

/// The root of an increasing function with its slope between two numbers: Newton's method, with bisection where a step
/// leaves the bracket.
template <class Function>
double increasing_root(Function function, double low, double high) {
  double x = 0.5 * (low + high);
  for (int iteration = 0; iteration < 200; ++iteration) {
    auto const [value, slope] = function(x);
    if (value == 0) return x;
    (value < 0 ? low : high) = x;
    double next = x - value / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - x) <= 2 * std::numeric_limits<double>::epsilon() * std::abs(next)) return next;
    x = next;
  }
  return x;
}

struct Value {
  double value, slope;
};

/// G_k(s) = s^k (1/k! - beta s^2/(k+2)! + (beta s^2)^2/(k+4)! ...) for k = 0 to 3, beta = mu/a.
struct Universal {
  double g0, g1, g2, g3;
};

Universal universal(double s, double beta) {
  double const x = beta * s * s;
  if (std::abs(x) < 0.1) {  // where differences of sines and their arguments would cancel
    double c2 = 0, c3 = 0, t2 = 0.5, t3 = 1.0 / 6;
    for (int n = 2; n < 20; n += 2) {
      c2 += t2, c3 += t3;
      t2 *= -x / ((n + 1) * (n + 2)), t3 *= -x / ((n + 2) * (n + 3));
    }
    return {1 - x * c2, s * (1 - x * c3), s * s * c2, s * s * s * c3};
  }
  double const root = std::sqrt(std::abs(beta)), angle = root * s;
  double const half = beta > 0 ? std::sin(angle / 2) : std::sinh(angle / 2);
  double const g1 = (beta > 0 ? std::sin(angle) : std::sinh(angle)) / root;
  double const g0 = beta > 0 ? std::cos(angle) : std::cosh(angle);
  return {g0, g1, 2 * half * half / std::abs(beta), (s - g1) / beta};
}

}  // namespace

OrbitState kepler(OrbitState const& start, double mu, double time) {
  check_orbit_state(start, mu);
  check_finite(name_of_kepler, "time", time);
  double const distance = magnitude(start.position), beta = 2 * mu / distance - norm2(start.velocity);
  if (beta > 0) time = std::remainder(time, orbit_period(mu / beta, mu));
  if (time == 0) return start;
  if (time < 0) {
    OrbitState const mirrored = kepler({start.position, -start.velocity}, mu, -time);
    return {mirrored.position, -mirrored.velocity};
  }
  double const radial = dot(start.position, start.velocity);
  auto const radius_at = [&](Universal const& g) { return distance * g.g0 + radial * g.g1 + mu * g.g2; };
  auto const late = [&](double s) {
    auto const g = universal(s, beta);
    return Value{distance * g.g1 + radial * g.g2 + mu * g.g3 - time, radius_at(g)};
  };
  double far = time / distance;
  while (late(far).value < 0) far *= 2;  // NaN after an overflow counts as far enough
  auto const g = universal(increasing_root(late, 0, far), beta);
  double const radius = radius_at(g);
  return {start.position * (1 - mu * g.g2 / distance) + start.velocity * (distance * g.g1 + radial * g.g2),
          start.position * (-mu * g.g1 / (distance * radius)) + start.velocity * (1 - mu * g.g2 / radius)};
}

OrbitElements orbit_elements(OrbitState const& state, double mu) {
  check_orbit_state(state, mu);
  double const distance = magnitude(state.position);
  Vector<3> const spin = cross(state.position, state.velocity);
  if (norm2(spin) == 0)
    throw Error(fmt::format("{}: a body that moves straight to the centre or from it has no elements", name_of_kepler));
  Vector<3> const normal = spin / magnitude(spin);
  Vector<3> const towards = cross(state.velocity, spin) / mu - state.position / distance;  // the Laplace-Runge-Lenz
                                                                                           // vector
  double const e = magnitude(towards), beta = 2 * mu / distance - norm2(state.velocity);
  bool const flat = normal[0] == 0 && normal[1] == 0;
  Vector<3> const node =
      flat ? Vector{1., 0., 0.} : Vector{-normal[1], normal[0], 0.} / std::hypot(normal[0], normal[1]);
  Vector<3> const axis = e == 0 ? node : towards / e;
  double const anomaly = std::atan2(dot(cross(normal, axis), state.position), dot(axis, state.position));
  double mean = 0;
  if (beta > 0) {
    double const E = 2 * std::atan2(std::sqrt(std::fmax(1 - e, 0)) * std::sin(anomaly / 2),
                                    std::sqrt(1 + e) * std::cos(anomaly / 2));
    mean = E - e * std::sin(E);
  } else if (beta < 0) {
    double const H = 2 * std::atanh(std::sqrt(std::fmax(e - 1, 0) / (e + 1)) * std::tan(anomaly / 2));
    mean = e * std::sinh(H) - H;
  }
  return {.semi_major_axis = mu / beta,
          .eccentricity = e,
          .inclination = std::atan2(std::hypot(normal[0], normal[1]), normal[2]),
          .node = std::atan2(node[1], node[0]),
          .pericentre = std::atan2(dot(cross(normal, node), axis), dot(node, axis)),
          .mean_anomaly = mean};
}

OrbitState orbit_state(OrbitElements const& elements, double mu) {
  check_positive(name_of_kepler, "constant mu = G (M + m)", mu);
  double const a = elements.semi_major_axis, e = elements.eccentricity;
  check_finite(name_of_kepler, "semi-major axis", a);
  check_not_negative(name_of_kepler, "eccentricity", e);
  check_finite(name_of_kepler, "inclination", elements.inclination);
  check_finite(name_of_kepler, "node", elements.node);
  check_finite(name_of_kepler, "pericentre", elements.pericentre);
  if (!(a * (1 - e) > 0))
    throw Error(
        fmt::format("{}: the semi-major axis is positive for eccentricities below 1 and negative above, not {} "
                    "with the eccentricity {}",
                    name_of_kepler, a, e));
  double const E = eccentric_anomaly(elements.mean_anomaly, e), node = elements.node, turn = elements.pericentre,
               tilt = elements.inclination;
  bool const ellipse = e < 1;
  double const c = ellipse ? std::cos(E) : std::cosh(E), s = ellipse ? std::sin(E) : std::sinh(E);
  double const part = ellipse ? 1 - e * c : e * c - 1, width = std::sqrt(std::abs(1 - e * e));
  double const speed = std::sqrt(mu / std::abs(a)) / part;
  Vector const along{std::cos(node), std::sin(node), 0.};
  Vector const across{-std::sin(node) * std::cos(tilt), std::cos(node) * std::cos(tilt), std::sin(tilt)};
  Vector const to = along * std::cos(turn) + across * std::sin(turn);
  Vector const beside = across * std::cos(turn) - along * std::sin(turn);
  return {to * (a * (c - e)) + beside * (std::abs(a) * width * s), to * (-speed * s) + beside * (speed * width * c)};
}

double orbit_period(double semi_major_axis, double mu) {
  check_positive(name_of_kepler, "semi-major axis", semi_major_axis);
  check_positive(name_of_kepler, "constant mu = G (M + m)", mu);
  return 2 * pi * semi_major_axis * std::sqrt(semi_major_axis / mu);
}

double eccentric_anomaly(double mean_anomaly, double e) {
  check_finite(name_of_kepler, "mean anomaly", mean_anomaly);
  check_not_negative(name_of_kepler, "eccentricity", e);
  if (e == 1) throw Error(fmt::format("{}: a parabola (eccentricity 1) has no eccentric anomaly", name_of_kepler));
  if (e < 1) {
    auto const mean = [&](double E) { return Value{E - e * std::sin(E) - mean_anomaly, 1 - e * std::cos(E)}; };
    return increasing_root(mean, mean_anomaly - e, mean_anomaly + e);
  }
  double far = 1;
  while (e * std::sinh(far) - far < std::abs(mean_anomaly)) far *= 2;
  auto const mean = [&](double H) { return Value{e * std::sinh(H) - H - mean_anomaly, e * std::cosh(H) - 1}; };
  return increasing_root(mean, -far, far);
}

}  // namespace boltzmann::exact
