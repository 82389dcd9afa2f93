// Modes of an axis for each combination of ends.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/fourier.hpp>
#include <boltzmann/core/number.hpp>
#include <boltzmann/schemes/mesh/poisson_axis.hpp>

#include <fmt/format.h>

#include <cmath>

namespace boltzmann::poisson {

namespace {

Kind kind_of(FieldEnds const& ends, char name) {
  using enum FieldBoundary;
  for (FieldBoundary const both : {periodic, open})
    if ((ends.low == both) != (ends.high == both))
      throw Error(fmt::format("mesh: axis {} is {} at its low end and {} at its high end; {} must be both or none",
                              name, to_string(ends.low), to_string(ends.high), to_string(both)));
  if (ends.low == periodic) return Kind::periodic;
  if (ends.low == open) return Kind::open;
  if (ends.low == dirichlet) return ends.high == dirichlet ? Kind::dirichlet : Kind::dirichlet_neumann;
  return ends.high == dirichlet ? Kind::neumann_dirichlet : Kind::neumann;
}

}  // namespace

Axis make_axis(MeshGrid const& grid, FieldEnds const& ends, int a) {
  char const name = "xyz"[a];
  Axis axis;
  axis.kind = kind_of(ends, name);
  if (grid.periodic[a] != (axis.kind == Kind::periodic))
    throw Error(fmt::format("mesh: axis {} of the mesh is {}periodic, but the potential's ends are {} and {}", name,
                            grid.periodic[a] ? "" : "not ", to_string(ends.low), to_string(ends.high)));
  std::size_t const least = axis.kind == Kind::dirichlet ? 2 : 1;
  if (grid.nodes[a] < 1 || grid.cells(a) < least)
    throw Error(fmt::format("mesh: axis {} has {} cell(s); with the ends {} and {} it needs {} or more", name,
                            grid.nodes[a] < 1 ? 0 : grid.cells(a), to_string(ends.low), to_string(ends.high), least));
  if (!(grid.spacing[a] > 0 && std::isfinite(grid.spacing[a])))
    throw Error(fmt::format("mesh: the spacing along {} is {}; it must be finite and > 0", name, grid.spacing[a]));
  axis.nodes = grid.nodes[a];
  std::size_t const n = axis.cells = grid.cells(a);
  axis.spacing = grid.spacing[a];
  axis.samples = axis.modes = n;
  std::size_t logical = 2 * n;
  switch (axis.kind) {
    case Kind::dirichlet:
      axis.samples = axis.modes = n - 1;
      axis.first = 1;
      break;
    case Kind::neumann:
      axis.samples = axis.modes = n + 1;
      break;
    case Kind::dirichlet_neumann:
      axis.first = 1;
      break;
    case Kind::open:
      axis.samples = n + 1;
      axis.modes = logical = fast_even_length(2 * n + 2);
      break;
    case Kind::periodic:
      logical = n;
      break;
    default:
      break;
  }
  axis.scale = 1 / static_cast<double>(logical);
  return axis;
}

void fill_tables(Axis& axis, PoissonForm form) {
  axis.eigenvalue.assign(axis.modes, 0);
  axis.slope.assign(axis.modes, 0);
  std::size_t const n = axis.modes;
  double const length = static_cast<double>(axis.cells) * axis.spacing;
  for (std::size_t j = 0; j < n; ++j) {
    double k = 0;
    switch (axis.kind) {
      case Kind::single:
        return;
      case Kind::open:
        axis.slope[j] = j == 0 || 2 * j == n ? 0 : 2 * j < n ? 1 : -1;
        continue;
      case Kind::periodic:
        k = 2 * pi * static_cast<double>(axis.folded(j)) / length;
        axis.slope[j] = 2 * j == n ? 0 : 2 * j < n ? -k : k;
        break;
      case Kind::dirichlet:
        k = pi * static_cast<double>(j + 1) / length;
        axis.slope[j] = -k;
        break;
      case Kind::neumann:
        k = pi * static_cast<double>(j) / length;
        axis.slope[j] = k;
        break;
      case Kind::dirichlet_neumann:
      case Kind::neumann_dirichlet:
        k = pi * (static_cast<double>(j) + 0.5) / length;
        axis.slope[j] = axis.kind == Kind::dirichlet_neumann ? -k : k;
        break;
    }
    double const difference = 2 / axis.spacing * std::sin(k * axis.spacing / 2);
    axis.eigenvalue[j] = form == PoissonForm::spectral ? k * k : difference * difference;
  }
}

Difference difference_at(Axis const& axis, std::size_t j) {
  std::size_t const last = axis.nodes - 1;
  double const w = 1 / (2 * axis.spacing);
  if (axis.kind == Kind::periodic) return {{j == 0 ? last : j - 1, j == last ? 0 : j + 1}, {w, -w}};
  if (j > 0 && j < last) return {{j - 1, j + 1}, {w, -w}};
  double const sign = j == 0 ? 1 : -1;
  auto const inward = [&](std::size_t steps) { return j == 0 ? steps : last - steps; };
  switch (axis.kind) {
    case Kind::open:
      if (last < 2) return {{inward(0), inward(1)}, {2 * sign * w, -2 * sign * w}};
      return {{inward(0), inward(1), inward(2)}, {3 * sign * w, -4 * sign * w, sign * w}, 3};
    case Kind::dirichlet:
    case Kind::dirichlet_neumann:
    case Kind::neumann_dirichlet:
      if (axis.kind == Kind::dirichlet || (axis.kind == Kind::dirichlet_neumann) == (j == 0))
        return {{inward(1), inward(1)}, {-sign * w, -sign * w}};
      [[fallthrough]];
    default:
      return {{j, j}, {0, 0}};
  }
}

}  // namespace boltzmann::poisson
