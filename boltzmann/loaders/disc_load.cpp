// A disc as a sum of uniform ones, whose gravity is known.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/vector.hpp>
#include <boltzmann/loaders/disc_load.hpp>
#include <boltzmann/loaders/ensemble_seed.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr double usual_edge = 5;         // radii
constexpr std::size_t table_size = 200;  // distances
constexpr int discs_in_heap = 100;       // on either side of a point

void check_disc(AnyEnsemble const& ensemble, DiscOptions const& options) {
  if (ensemble.dimension() == 1) throw Error("disc load: on a line there is no disc");
  for (auto const& [what, value] : {std::pair{"radius", options.radius}, {"constant G", options.G}})
    if (!(value > 0) || !std::isfinite(value))
      throw Error(fmt::format("disc load: the {} must be positive, it is {}", what, value));
  for (auto const& [what, value] :
       {std::pair{"mass", options.mass}, {"central mass", options.central_mass}, {"edge", options.edge}})
    if (!(value >= 0) || !std::isfinite(value))
      throw Error(fmt::format("disc load: the {} must not be negative, it is {}", what, value));
  if (options.profile == DiscProfile::uniform && options.edge > 0)
    throw Error("disc load: a uniform disc ends at its radius; leave the edge out");
}

/// The gravity of a uniform disc of radius a and surface density 1 / (4 G), in its plane. (From its potential -E(R/a) a
/// inside, and from its rings.)
double uniform_disc(double a, double R) {
  double const k = R < a ? R / a : a / R;
  if (k == 0) return 0;
  double const inside = std::comp_ellint_1(k) - std::comp_ellint_2(k);
  return R < a ? inside / k : inside;
}

/// Two directions normal to this one; the second is a quarter turn from the first about it.
std::array<Vector<3>, 2> plane_across(Vector<3> normal) {
  double const length = magnitude(normal);
  if (!(length > 0 && std::isfinite(length))) throw Error("disc load: the normal has no direction");
  normal = normal * (1 / length);
  Vector<3> first = std::abs(normal[0]) < 0.9 ? Vector<3>{1, 0, 0} : Vector<3>{0, 1, 0};
  first -= normal * dot(first, normal);
  first = first * (1 / magnitude(first));
  return {first, cross(normal, first)};
}

void set_mean_of(AnyEnsemble& ensemble, int offset, std::array<double, 3> const& mean) {
  for (int a = 0; a < ensemble.dimension(); ++a) {
    ExactSum sum;
    for (std::size_t i = 0; i < ensemble.size(); ++i) sum += ensemble.row(i)[offset + a];
    double const shift = mean[static_cast<std::size_t>(a)] - sum.value() / static_cast<double>(ensemble.size());
    for (std::size_t i = 0; i < ensemble.size(); ++i) ensemble.row(i)[offset + a] += shift;
  }
}

}  // namespace

Words<DiscProfile> const& disc_profile_words() {
  static Words<DiscProfile> const all{
      "profile",
      {{DiscProfile::exponential, "exponential", "the surface density falls as exp(-R / radius): spiral galaxies"},
       {DiscProfile::kuzmin, "kuzmin", "as (R^2 + radius^2)^(-3/2)"},
       {DiscProfile::uniform, "uniform", "the same up to the radius"}}};
  return all;
}

DiscGravity::DiscGravity(DiscOptions const& options, int dimension)
    : options_(options),
      dimension_(dimension),
      edge_(options.profile == DiscProfile::uniform ? options.radius
            : options.edge > 0                      ? options.edge
                                                    : usual_edge * options.radius) {
  if (dimension_ == 2 || options.mass == 0) return;
  table_.resize(table_size + 1);
  for (std::size_t k = 0; k <= table_size; ++k) {
    double const root = std::min(static_cast<double>(k), table_size - 0.5) / table_size;  // infinite at the edge
    table_[k] = of_the_disc(edge_ * root * root);
  }
}

double DiscGravity::mass_within(double R) const {
  auto const of_infinite = [&](double r) {
    double const y = r / options_.radius;
    if (options_.profile == DiscProfile::uniform) return y * y;
    if (options_.profile == DiscProfile::kuzmin) return 1 - 1 / std::sqrt(1 + y * y);
    return 1 - (1 + y) * std::exp(-y);
  };
  return of_infinite(std::min(R, edge_)) / of_infinite(edge_);
}

double DiscGravity::radius_of(double part) const {
  double low = 0, high = edge_;
  for (int k = 0; k < 60; ++k) (mass_within(0.5 * (low + high)) < part ? low : high) = 0.5 * (low + high);
  return 0.5 * (low + high);
}

/// The surface density and its slope, for a disc of mass 1.
std::array<double, 2> DiscGravity::surface(double R) const {
  double const a = options_.radius, y = R / a;
  if (options_.profile == DiscProfile::uniform) return {1 / (pi * a * a), 0};
  bool const kuzmin = options_.profile == DiscProfile::kuzmin;
  double const at_edge = edge_ / a,
               whole = kuzmin ? 1 - 1 / std::sqrt(1 + at_edge * at_edge) : 1 - (1 + at_edge) * std::exp(-at_edge);
  double const middle = 1 / (2 * pi * a * a * whole);
  if (kuzmin) return {middle * std::pow(1 + y * y, -1.5), middle * 3 * y / a * std::pow(1 + y * y, -2.5)};
  return {middle * std::exp(-y), middle / a * std::exp(-y)};
}

/// The acceleration by a disc of mass 1 and G = 1: a sum of uniform discs of all radii a, weighted by the decrease of
/// the density there. The substitution a = R -+ L t^3 removes the logarithm at a = R; discs far from it are added up
/// separately.
double DiscGravity::of_the_disc(double R) const {
  double sum = 0;
  auto const add = [&](double from, double to, double power) {
    for (int k = 0; k < discs_in_heap; ++k) {
      double const t = (k + 0.5) / discs_in_heap, a = from + (to - from) * std::pow(t, power);
      sum += std::abs(to - from) * power * std::pow(t, power - 1) / discs_in_heap * surface(a)[1] * uniform_disc(a, R);
    }
  };
  double const middle = R > 2 * options_.radius ? options_.radius : 0;
  if (middle > 0) add(0, middle, 1);
  add(R, middle, 3);
  add(R, edge_, 3);
  return 4 * (sum + surface(edge_)[0] * uniform_disc(edge_, R));
}

double DiscGravity::acceleration(double R) const {
  if (!(R > 0)) return 0;
  double const G = options_.G;
  if (dimension_ == 2) return 2 * G * (options_.mass * mass_within(R) + options_.central_mass) / R;
  double const middle = G * options_.central_mass / (R * R);
  if (table_.empty()) return middle;
  if (R >= edge_) return middle + G * options_.mass * of_the_disc(R);
  double const at = std::sqrt(R / edge_) * table_size;
  auto const k = std::min(static_cast<std::size_t>(at), table_size - 1);
  double const part = at - static_cast<double>(k);
  return middle + G * options_.mass * ((1 - part) * table_[k] + part * table_[k + 1]);
}

double DiscGravity::circular_velocity(double R) const { return std::sqrt(R * acceleration(R)); }

void disc_load(AnyEnsemble& ensemble, DiscOptions const& options) {
  check_disc(ensemble, options);
  int const D = ensemble.dimension(), mass = ensemble.field("mass").offset,
            velocity = ensemble.field("velocity").offset;
  auto const [first, second] =
      plane_across(D == 3 ? Vector<3>{options.normal[0], options.normal[1], options.normal[2]} : Vector<3>{0, 0, 1});
  DiscGravity const gravity(options, D);
  std::uint64_t const key = ensemble_seed(options.seed, ensemble.name(), "disc");
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    double* const row = ensemble.row(i);
    if (options.mass > 0) row[mass] = options.mass / static_cast<double>(ensemble.size());
    Stream stream(key, 0, i, Purpose::position);
    double const R = gravity.radius_of(stream.uniform()), angle = 2 * pi * stream.uniform();
    double const speed = gravity.circular_velocity(R);
    auto const outwards = first * std::cos(angle) + second * std::sin(angle),
               along = second * std::cos(angle) - first * std::sin(angle);
    for (int a = 0; a < D; ++a) {
      row[a] = R * outwards[a];
      row[velocity + a] = speed * along[a];
    }
  }
  if (ensemble.size() == 0) return;
  set_mean_of(ensemble, 0, options.centre);
  set_mean_of(ensemble, velocity, options.drift);
}

}  // namespace boltzmann
