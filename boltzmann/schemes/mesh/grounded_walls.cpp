// The field at Dirichlet ends.
#include <boltzmann/core/number.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/schemes/mesh/ghosts.hpp>
#include <boltzmann/schemes/mesh/grounded_walls.hpp>
#include <boltzmann/schemes/mesh/poisson_lines.hpp>
#include <boltzmann/schemes/mesh/spline.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace boltzmann {
namespace {

/// How a density that is 1 at a low Dirichlet end, and falls to 0 at the other one (or stays 1 up to a Neumann end),
/// differs from what its values on the inner nodes make of it in the spectral form: `lift` is added to the density on
/// the nodes, so that all modes of the mesh have their exact amplitudes; `rest` is the field of all shorter waves.
struct Lift {
  std::vector<double> density, field;
};
Lift make_lift(MeshGrid const& grid, FieldEnds const& ends, int a) {
  bool const both = ends.high == FieldBoundary::dirichlet;
  poisson::Axis axis = poisson::make_axis(grid, ends, a);
  poisson::fill_tables(axis, PoissonForm::spectral);
  poisson::Lines const lines(axis, poisson::Layout::row, true);
  std::size_t const size = poisson::Lines::buffer_size(axis, poisson::Layout::row);
  FourierArray modes(size), nodes(size);
  double const length = static_cast<double>(axis.cells) * axis.spacing;
  // The exact amplitudes of both densities are 2 / (k L). Transforms double what they are given.
  auto const fill = [&](int power) {
    std::fill_n(modes.data(), size, 0.0);
    for (std::size_t j = 0; j < axis.modes; ++j) {
      double const k = std::sqrt(axis.eigenvalue[j]);
      modes[j] = 1 / (k * length) / (power == 0 ? 1 : k * k);
    }
  };
  Lift lift{std::vector<double>(axis.nodes), std::vector<double>(axis.nodes)};
  fill(0);
  poisson::Nodes range = lines.backward(modes.data(), nodes.data());
  for (std::size_t j = 0; j < range.count; ++j) {
    double const x = static_cast<double>(j + range.first) * axis.spacing;
    lift.density[j + range.first] = nodes[j] - (both ? 1 - x / length : 1);
  }
  fill(2);
  range = lines.slope(modes.data(), nodes.data(), 1);
  for (std::size_t j = 0; j < axis.nodes; ++j) {
    double const x = static_cast<double>(j) * axis.spacing;
    bool const known = j >= range.first && j < range.first + range.count;
    lift.field[j] =
        (both ? x - x * x / (2 * length) - length / 3 : x - length) - (known ? nodes[j - range.first] : 0.0);
  }
  return lift;
}

}  // namespace

GroundedWalls::GroundedWalls(MeshGrid const& grid, std::array<FieldEnds, 3> const& ends, PoissonForm form, int order)
    : grid_(grid), ends_(ends), form_(form), order_(order) {
  for (int a = 0; a < grid.dimension; ++a)
    for (bool const high : {false, true}) {
      if ((high ? ends[a].high : ends[a].low) != FieldBoundary::dirichlet) continue;
      Wall& wall = walls_.emplace_back();
      wall.axis = a;
      wall.high = high;
      wall.at.resize(grid.size() / grid.nodes[a]);
      wall.far.resize(wall.at.size());
      if (form != PoissonForm::spectral) continue;
      Lift const lift = make_lift(grid, high ? FieldEnds{ends[a].high, ends[a].low} : ends[a], a);
      wall.lift = lift.density;
      wall.rest = lift.field;
    }
  fill_spread(order);
}

/// Clouds of more than two cells reach beyond a wall. What they count there is kept as a dipole (Ghosts), so the field
/// of a uniform density beside the wall is off by C h rho times these numbers.
void GroundedWalls::fill_spread(int order) {
  auto const reach = static_cast<std::size_t>(nodes_before(order)), cells = 2 * reach + 8;
  FieldEnds const ends{FieldBoundary::dirichlet, FieldBoundary::neumann};
  Ghosts const ghosts(1, {cells, 1, 1}, {ends, FieldEnds{}, FieldEnds{}}, order);
  // Weights are polynomials of at most the sixth degree in each half cell: Gauss' rule of four points is exact.
  constexpr double at[4] = {0.0694318442029737, 0.3300094782075719, 0.6699905217924281, 0.9305681557970263};
  constexpr double share[4] = {0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269};
  std::vector<double> padded(ghosts.nodes(0)), counts(cells + 1);
  auto const put = [&]<int p>(double s, double amount, std::integral_constant<int, p>) {
    double const t = p % 2 == 1 ? s + 0.5 : s;
    double weights[p];
    spline_weights<p>(t - std::floor(t), weights);
    for (int k = 0; k < p; ++k)
      padded[static_cast<std::size_t>(t) + static_cast<std::size_t>(k)] += amount * weights[k];
  };
  for (std::size_t half = 0; half < 2 * cells; ++half)
    for (int i = 0; i < 4; ++i) {
      double const s = (static_cast<double>(half) + at[i]) / 2, amount = share[i] / 2;
      switch (order) {
        case 1:
          put(s, amount, std::integral_constant<int, 1>());
          break;
        case 2:
          put(s, amount, std::integral_constant<int, 2>());
          break;
        case 3:
          put(s, amount, std::integral_constant<int, 3>());
          break;
        case 4:
          put(s, amount, std::integral_constant<int, 4>());
          break;
        case 5:
          put(s, amount, std::integral_constant<int, 5>());
          break;
        case 6:
          put(s, amount, std::integral_constant<int, 6>());
          break;
        default:
          put(s, amount, std::integral_constant<int, 7>());
          break;
      }
    }
  for (std::size_t g = 0; g < padded.size(); ++g) {
    auto const& term = ghosts.term(0, g);
    counts[term.node] += term.factor * padded[g];
    counts[0] += term.low * padded[g];
    counts[cells] += term.high * padded[g];
  }
  double before = 0;
  for (std::size_t i = 0; i <= reach; ++i) {
    spread_.push_back(before + 0.5 * counts[i] - (i == 0 ? 0.25 : static_cast<double>(i)));
    before += counts[i];
  }
}

/// function(node of the wall, index of the node so many nodes inside of it) for all that are on no other grounded wall.
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
    std::size_t const far = std::min(spread_.size() - 1 + static_cast<std::size_t>(order_), grid_.nodes[wall.axis] - 1);
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
  team->sum(bits);  // only one rank has each number
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
    if (wall.rest.empty())
      for_nodes(wall, 0, [&](std::size_t i, std::size_t node) { E[node] -= 0.5 * C * h * wall.at[i]; });
    else
      for (std::size_t j = 0; j < wall.rest.size(); ++j)
        for_nodes(wall, j, [&](std::size_t i, std::size_t node) { E[node] += C * wall.rest[j] * wall.at[i]; });
    for (std::size_t j = 1; j < spread_.size() && j < grid_.nodes[wall.axis]; ++j)
      for_nodes(wall, j,
                [&](std::size_t i, std::size_t node) { E[node] -= C * h * spread_[j] * (wall.far[i] - background); });
  }
}

void GroundedWalls::for_particles(std::vector<std::vector<double>>& field, double constant, double background) const {
  if (!taken_) return;
  for (Wall const& wall : walls_) {
    auto& E = field[static_cast<std::size_t>(wall.axis)];
    double const C = wall.high ? -constant : constant, h = grid_.spacing[wall.axis];
    // To the nearest node goes all charge of the half cell, and the mean field there is what acts on it.
    double const even = order_ == 1 ? 0 : 0.25;
    for_nodes(wall, 0, [&](std::size_t i, std::size_t node) {
      E[node] += C * h * (0.25 * wall.at[i] - even * wall.far[i] - spread_[0] * (wall.far[i] - background));
    });
  }
}

}  // namespace boltzmann
