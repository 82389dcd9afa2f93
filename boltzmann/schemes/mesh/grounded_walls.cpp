// The field at Dirichlet ends.
#include <boltzmann/core/number.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/schemes/mesh/grounded_walls.hpp>
#include <boltzmann/schemes/mesh/poisson_lines.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace boltzmann {
namespace {

/// Correction of a density that is 1 at a low Dirichlet end and falls to 0 at the other one (or stays 1 up to a Neumann
/// end), relative to the spectral form from its values on the inner nodes. `density` is added to that on the nodes, so
/// that all modes of the mesh have their exact amplitudes. `field` is that of all shorter waves. `smeared` is the field
/// at nodes due to WallClouds::smear, except for the uniform field of its dipole.
struct Lift {
  std::vector<double> density, field, smeared;
};
Lift make_lift(MeshGrid const& grid, FieldEnds const& ends, int a, std::vector<double> const& smear) {
  bool const both = ends.high == FieldBoundary::dirichlet;
  poisson::Axis axis = poisson::make_axis(grid, ends, a);
  poisson::fill_tables(axis, PoissonForm::spectral);
  poisson::Lines const lines(axis, poisson::Layout::row, true);
  std::size_t const size = poisson::Lines::buffer_size(axis, poisson::Layout::row);
  FourierArray modes(size), nodes(size);
  double const h = axis.spacing, length = static_cast<double>(axis.cells) * h;
  // The exact amplitudes of both densities are 2 / (k L). Transforms double their input.
  auto const fill = [&](auto const& amplitude) {
    std::fill_n(modes.data(), size, 0.0);
    for (std::size_t j = 0; j < axis.modes; ++j) modes[j] = amplitude(std::sqrt(axis.eigenvalue[j])) / length;
  };
  // Computes function(node, field) for a density with amplitudes k^2 times those given to fill().
  auto const slopes = [&](auto const& function) {
    poisson::Nodes const range = lines.slope(modes.data(), nodes.data(), 1);
    for (std::size_t j = 0; j < axis.nodes; ++j)
      function(j, j >= range.first && j < range.first + range.count ? nodes[j - range.first] : 0.0);
  };
  Lift lift{std::vector<double>(axis.nodes), std::vector<double>(axis.nodes), std::vector<double>(axis.nodes)};
  fill([](double k) { return 1 / k; });
  poisson::Nodes const range = lines.backward(modes.data(), nodes.data());
  for (std::size_t j = 0; j < range.count; ++j) {
    double const x = static_cast<double>(j + range.first) * h;
    lift.density[j + range.first] = nodes[j] - (both ? 1 - x / length : 1);
  }
  fill([](double k) { return 1 / (k * k * k); });
  slopes([&](std::size_t j, double slope) {
    double const x = static_cast<double>(j) * h;
    lift.field[j] = (both ? x - x * x / (2 * length) - length / 3 : x - length) - slope;
  });
  double dipole = smear[0] * h * h / 12;  // of lift.density, and of the nodes
  for (std::size_t i = 1; i < smear.size(); ++i) dipole += smear[i] * static_cast<double>(i) * h * h;
  fill([&](double k) {
    double sum = smear[0] * (1 / k - 0.5 * h / std::tan(0.5 * k * h));  // of lift.density
    for (std::size_t i = 1; i < smear.size(); ++i) sum += smear[i] * h * std::sin(k * static_cast<double>(i) * h);
    return sum / (k * k);
  });
  slopes([&](std::size_t j, double slope) {
    lift.smeared[j] = slope + smear[0] * lift.field[j] - (both ? dipole / length : 0);
  });
  return lift;
}

}  // namespace

GroundedWalls::GroundedWalls(MeshGrid const& grid, std::array<FieldEnds, 3> const& ends, PoissonForm form, int order)
    : grid_(grid), ends_(ends), form_(form), order_(order), clouds_(wall_clouds(order)) {
  for (int a = 0; a < grid.dimension; ++a)
    for (bool const high : {false, true}) {
      if ((high ? ends[a].high : ends[a].low) != FieldBoundary::dirichlet) continue;
      Wall& wall = walls_.emplace_back();
      wall.axis = a;
      wall.high = high;
      wall.at.resize(grid.size() / grid.nodes[a]);
      wall.far.resize(wall.at.size());
      if (form != PoissonForm::spectral) continue;
      Lift const lift = make_lift(grid, high ? FieldEnds{ends[a].high, ends[a].low} : ends[a], a, clouds_.smear);
      wall.lift = lift.density;
      wall.rest = lift.field;
      if (clouds_.smear.size() > 1) wall.smeared = lift.smeared;
    }
}

/// The first node inside from a wall that is out of range of all particles in the first cell, and of those in range of
/// the wall node.
std::size_t GroundedWalls::far_node(int axis) const {
  return std::min(clouds_.smear.size() - 1 + static_cast<std::size_t>(order_), grid_.nodes[axis] - 1);
}

/// Calls function(node of the wall, index of the node `inside` nodes further in) for all nodes that are not on another
/// grounded wall.
template <class Function>
void GroundedWalls::for_nodes(Wall const& wall, std::size_t inward, Function const& function) const {
  std::array<std::size_t, 3> const n = grid_.nodes;
  int const a = wall.axis;
  auto const grounded = [&](int b, std::size_t node) {
    return b != a && ((node == 0 && ends_[b].low == FieldBoundary::dirichlet) ||
                      (node + 1 == n[b] && ends_[b].high == FieldBoundary::dirichlet));
  };
  std::size_t const there = wall.high ? n[a] - 1 - inward : inward;
  std::size_t on_wall = 0;
  std::array<std::size_t, 3> at{};
  for (at[2] = a == 2 ? there : 0; at[2] < (a == 2 ? there + 1 : n[2]); ++at[2])
    for (at[1] = a == 1 ? there : 0; at[1] < (a == 1 ? there + 1 : n[1]); ++at[1])
      for (at[0] = a == 0 ? there : 0; at[0] < (a == 0 ? there + 1 : n[0]); ++at[0], ++on_wall)
        if (!grounded(0, at[0]) && !grounded(1, at[1]) && !grounded(2, at[2]))
          function(on_wall, grid_.index(at[0], at[1], at[2]));
}

void GroundedWalls::take(std::vector<double> const& density, std::pair<std::size_t, std::size_t> planes, Team* team) {
  if (!any()) return;
  taken_ = true;
  std::size_t const plane = grid_.size() / grid_.nodes[grid_.dimension - 1];
  bool const all = !team;
  std::vector<std::int64_t> bits;
  for (Wall& wall : walls_) {
    std::size_t const far = far_node(wall.axis);
    for (auto* values : {&wall.at, &wall.far}) {
      std::fill(values->begin(), values->end(), 0.0);
      for_nodes(wall, values == &wall.at ? 0 : far, [&](std::size_t i, std::size_t node) {
        if (all || (node / plane >= planes.first && node / plane < planes.second)) (*values)[i] = density[node];
      });
      if (!all)
        for (double const value : *values) bits.push_back(std::bit_cast<std::int64_t>(value));
    }
  }
  if (all) return;
  team->sum(bits);  // each number is nonzero on one rank only
  auto next = bits.begin();
  for (Wall& wall : walls_)
    for (auto* values : {&wall.at, &wall.far})
      for (double& value : *values) value = std::bit_cast<double>(*next++);
}

std::vector<double> const& GroundedWalls::source(std::vector<double> const& density) {
  if (!lifts()) return density;
  source_ = density;
  for (int a = 0; a < grid_.dimension; ++a) {
    std::size_t const stride = a == 0 ? 1 : a == 1 ? grid_.nodes[0] : grid_.nodes[0] * grid_.nodes[1];
    std::size_t const n = grid_.nodes[a];
    std::vector<Wall const*> both;
    for (Wall const& wall : walls_)
      if (wall.axis == a) both.push_back(&wall);
    if (both.empty()) continue;
    for (std::size_t line = 0; line < source_.size() / n; ++line) {
      double* const first = source_.data() + line / stride * stride * n + line % stride;
      double const low = first[0], high = first[(n - 1) * stride];
      for (Wall const* wall : both)
        for (std::size_t j = 0; j < n; ++j)
          first[j * stride] += wall->high ? high * wall->lift[n - 1 - j] : low * wall->lift[j];
    }
  }
  return source_;
}

void GroundedWalls::correct(std::vector<std::vector<double>>& field, double constant, double background) const {
  if (!taken_) return;
  for (Wall const& wall : walls_) {
    auto& E = field[static_cast<std::size_t>(wall.axis)];
    double const C = wall.high ? -constant : constant, h = grid_.spacing[wall.axis];
    auto const smeared = [&](std::size_t j, double by) {
      for_nodes(wall, j, [&](std::size_t i, std::size_t node) { E[node] -= C * by * (wall.far[i] - background); });
    };
    if (form_ == PoissonForm::spectral) {
      for (std::size_t j = 0; j < wall.rest.size(); ++j)
        for_nodes(wall, j, [&](std::size_t i, std::size_t node) { E[node] += C * wall.rest[j] * wall.at[i]; });
      for (std::size_t j = 0; j < wall.smeared.size(); ++j) smeared(j, wall.smeared[j]);
      continue;
    }
    for_nodes(wall, 0, [&](std::size_t i, std::size_t node) { E[node] -= 0.5 * C * h * wall.at[i]; });
    double before = 0.5 * clouds_.smear[0];  // smeared between the wall and a node
    for (std::size_t j = 1; j < clouds_.smear.size() && j < grid_.nodes[wall.axis]; ++j) {
      smeared(j, h * (before + 0.5 * clouds_.smear[j]));
      before += clouds_.smear[j];
    }
  }
}

void GroundedWalls::for_particles(std::vector<std::vector<double>>& field, double constant, double background) const {
  if (!taken_) return;
  for (Wall const& wall : walls_) {
    auto& E = field[static_cast<std::size_t>(wall.axis)];
    double const C = wall.high ? -constant : constant, h = grid_.spacing[wall.axis];
    // The nearest node receives all charge of the half cell, and the mean field of the half cell acts on it.
    double const even = order_ == 1 ? 0 : 0.25;
    for_nodes(wall, 0, [&](std::size_t i, std::size_t node) {
      double const at_wall = wall.at[i] - clouds_.smear[0] * (wall.far[i] - background);
      E[node] += C * h * (0.25 * at_wall - even * wall.far[i]);
    });
  }
}

}  // namespace boltzmann
