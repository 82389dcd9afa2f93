// Sections of cells of equal area across the line.
#include <boltzmann/core/error.hpp>
#include <boltzmann/loaders/vortex_tube_load.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace boltzmann {
namespace {

/// The cells of a section: one in the middle, and 8 k in layer k, all of the same area (G. S. Winckelmans and
/// A. Leonard 1993).
struct TubeSection {
  struct Cell {
    double across, up, weight;  ///< weights sum to 1
  };
  std::vector<Cell> cells;
  double core, spacing;  ///< of the elements
};

TubeSection section_of(VortexTube const& tube) {
  constexpr double furthest = 3.3;  // cut-off of the profile, in standard deviations
  double const wanted = tube.core_radius / std::sqrt(2.0), sides = 2.0 * static_cast<double>(tube.layers) + 1;
  TubeSection section;
  if (tube.layers == 0) {
    section.cells = {{0, 0, 1}};
    section.core = wanted, section.spacing = wanted / tube.overlap;
    return section;
  }
  // The cores of the elements widen the profile: the squares of both widths add up to the wanted one.
  double const per_deviation = tube.overlap * std::sqrt(pi) * furthest / sides;
  double const deviation = wanted / std::sqrt(1 + square(per_deviation)), cell = furthest * deviation / sides;
  section.spacing = std::sqrt(pi) * cell;
  section.core = tube.overlap * section.spacing;
  // Each cell gets the part of a Gaussian inside it.
  auto const outside = [&](double cells) { return std::exp(-0.5 * square(cells * cell / deviation)); };
  section.cells.push_back({0, 0, 1 - outside(1)});
  for (std::size_t k = 1; k <= tube.layers; ++k) {
    double const layer = static_cast<double>(k), radius = cell * (1 + 12 * layer * layer) / (6 * layer);
    double const part = (outside(2 * layer - 1) - outside(2 * layer + 1)) / (8 * layer);
    for (std::size_t j = 0; j < 8 * k; ++j) {
      double const angle = 2 * pi * (static_cast<double>(j) + 0.5) / (8 * layer);
      section.cells.push_back({radius * std::cos(angle), radius * std::sin(angle), part});
    }
  }
  double sum = 0, moment = 0;
  for (auto const& one : section.cells) sum += one.weight;
  for (auto& one : section.cells) {
    one.weight /= sum;
    moment += one.weight * (square(one.across) + square(one.up)) / 2;
  }
  for (auto& one : section.cells) one.across *= deviation / std::sqrt(moment), one.up *= deviation / std::sqrt(moment);
  return section;
}

void check(double length, VortexTube const& tube) {
  auto const positive = [](char const* what, double value) {
    if (!(value > 0 && std::isfinite(value)))
      throw Error(fmt::format("vortex tube: the {} must be positive, not {}", what, value));
  };
  positive("core radius", tube.core_radius);
  positive("overlap", tube.overlap);
  positive("length of the line", length);
  if (!std::isfinite(tube.circulation)) throw Error("vortex tube: the circulation is not finite");
  if (tube.layers > 50) throw Error(fmt::format("vortex tube: {} layers; at most 50 are allowed", tube.layers));
  if (tube.core_radius > length / 2 / pi)
    throw Error(fmt::format("vortex tube: a core radius of {} is wider than a ring of the line, {}, would be",
                            tube.core_radius, length / 2 / pi));
}

std::size_t sections_of(double length, TubeSection const& section, VortexTube const& tube) {
  if (tube.sections > 0) return tube.sections;
  return std::max<std::size_t>(8, static_cast<std::size_t>(std::lround(length / section.spacing)));
}

}  // namespace

std::size_t vortex_tube_count(double length, VortexTube const& tube) {
  check(length, tube);
  TubeSection const section = section_of(tube);
  return sections_of(length, section, tube) * section.cells.size();
}

void vortex_tube_load(AnyEnsemble& ensemble, std::function<Vector<3>(double)> const& curve, VortexTube const& tube) {
  if (ensemble.dimension() != 3) throw Error("vortex tube: space has three dimensions there");
  int const vorticity = ensemble.field("vorticity").offset, core = ensemble.field("core").offset;
  // The arc length up to each of many points of the curve.
  constexpr std::size_t points = 4096;
  std::vector<double> lengths{0};
  for (std::size_t k = 0; k < points; ++k)
    lengths.push_back(lengths.back() +
                      magnitude(curve(static_cast<double>(k + 1) / points) - curve(static_cast<double>(k) / points)));
  double const length = lengths.back();
  check(length, tube);
  TubeSection const section = section_of(tube);
  std::size_t const sections = sections_of(length, section, tube);
  ensemble.resize(sections * section.cells.size());
  auto const slope = [&](double u) {
    double const small = 1e-4;
    return (curve(u + small) - curve(u - small)) * (1 / (2 * small));
  };
  // The direction across the line is transported along it with the least rotation.
  Vector<3> across{0, 0, 0};
  std::size_t at = 0, k = 0;
  for (std::size_t s = 0; s < sections; ++s) {
    double const wanted = length * static_cast<double>(s) / static_cast<double>(sections);
    while (k + 1 < points && lengths[k + 1] <= wanted) ++k;
    double const u =
        (static_cast<double>(k) + (wanted - lengths[k]) / (lengths[k + 1] - lengths[k])) / static_cast<double>(points);
    Vector<3> const middle = curve(u), tangent = slope(u) * (1 / magnitude(slope(u)));
    if (s == 0) {
      Vector<3> const away = std::abs(tangent[2]) < 0.9 ? Vector<3>{0, 0, 1} : Vector<3>{1, 0, 0};
      across = cross(tangent, away);
    }
    across -= tangent * dot(across, tangent);
    across = across * (1 / magnitude(across));
    Vector<3> const up = cross(tangent, across);
    // Rotation of the direction per unit length, towards the bend of the line: inside the bend vorticity lines are
    // shorter.
    double const small = 1e-4;
    Vector<3> const before = slope(u - small), after = slope(u + small);
    Vector<3> const bend =
        (after * (1 / magnitude(after)) - before * (1 / magnitude(before))) * (1 / (2 * small * magnitude(slope(u))));
    for (auto const& cell : section.cells) {
      Vector<3> const from_middle = across * cell.across + up * cell.up;
      double const part = length / static_cast<double>(sections) * (1 - dot(bend, from_middle));
      double* const row = ensemble.row(at++);
      for (int a = 0; a < 3; ++a) {
        row[a] = middle[a] + from_middle[a];
        row[vorticity + a] = tangent[a] * (tube.circulation * cell.weight * part);
      }
      row[core] = section.core;
    }
  }
}

void vortex_ring_load(AnyEnsemble& ensemble, VortexRing const& ring) {
  if (!(ring.radius > 0 && std::isfinite(ring.radius)))
    throw Error(fmt::format("vortex ring: the radius must be positive, not {}", ring.radius));
  Vector<3> normal{ring.normal[0], ring.normal[1], ring.normal[2]};
  double const size = magnitude(normal);
  if (!(size > 0 && std::isfinite(size))) throw Error("vortex ring: the normal has no direction");
  normal = normal * (1 / size);
  Vector<3> first = std::abs(normal[0]) < 0.9 ? Vector<3>{1, 0, 0} : Vector<3>{0, 1, 0};
  first -= normal * dot(first, normal);
  first = first * (1 / magnitude(first));
  Vector<3> const second = cross(normal, first), centre{ring.centre[0], ring.centre[1], ring.centre[2]};
  vortex_tube_load(
      ensemble,
      [&](double u) { return centre + (first * std::cos(2 * pi * u) + second * std::sin(2 * pi * u)) * ring.radius; },
      ring.tube);
}

}  // namespace boltzmann
