// Averages of velocities at the particles and on a grid, and the logarithm of the heat.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/diagnoses/entropy.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace boltzmann {
namespace {

constexpr double max_nodes = 4e6;

/// <v^2> and <(v - <v>)^2> at points, the density and further averages, in one pass.
struct Averages {
  std::vector<double> density, square, fluctuation;
  std::vector<std::vector<double>> others;
};

/// The components of the velocity and its square, with their values in images beyond walls.
std::vector<SmoothColumn> velocity_columns(SmoothField const& field) {
  std::vector<SmoothColumn> columns;
  columns.reserve(static_cast<std::size_t>(field.dimension()) + 1);
  for (int a = 0; a < field.dimension(); ++a) columns.push_back(field.column(std::string("velocity.") + "xyz"[a]));
  SmoothColumn squares{std::vector<double>(field.size())};
  for (auto const& component : columns)
    for (std::size_t i = 0; i < squares.values.size(); ++i) squares.values[i] += square(component.values[i]);
  if (field.box().any_wall())
    squares.image = [velocity = columns](double, std::size_t i, Turns const& walls) {
      double v2 = 0;
      for (auto const& component : velocity) v2 += square(component.image(component.values[i], i, walls));
      return v2;
    };
  columns.push_back(std::move(squares));
  return columns;
}

Averages averages(SmoothField const& field, std::span<double const> points,
                  std::vector<SmoothColumn> const& others = {}) {
  auto columns = velocity_columns(field);
  std::size_t const at_square = columns.size(), axes = at_square - 1;
  columns.insert(columns.end(), others.begin(), others.end());
  auto fields = field.values(points, columns);
  Averages result{std::move(fields[0].value), std::move(fields[at_square].value), {}, {}};
  for (std::size_t p = 0; p < result.square.size(); ++p) {
    double mean = 0;
    for (std::size_t a = 1; a <= axes; ++a) mean += square(fields[a].value[p]);
    double const difference = result.square[p] - mean;  // rounding may make it negative
    result.fluctuation.push_back(difference < 0 ? 0 : difference);
  }
  for (std::size_t c = at_square + 1; c < fields.size(); ++c) result.others.push_back(std::move(fields[c].value));
  return result;
}

}  // namespace

std::vector<double> velocity_fluctuation(SmoothField const& field, std::span<double const> points) {
  return averages(field, points).fluctuation;
}

bool has_entropy(AnyEnsemble const& ensemble) {
  return carries_momentum(ensemble) && ensemble.find_field("specific_energy") != nullptr;
}

SmoothEntropy smooth_entropy(Ensembles of, Box const& box, EntropyOptions const& options, int threads) {
  for (auto const* ensemble : of)
    if (!has_entropy(*ensemble))
      throw Error(fmt::format("ensemble '{}' of class {} has no entropy: it needs mass, velocity and specific_energy",
                              ensemble->name(), ensemble->class_name()));
  int const D = box.dimension();
  double const gamma = options.gamma == 0 ? 1 + 2.0 / D : options.gamma;
  if (!(gamma > 1)) throw Error(fmt::format("an entropy needs a gamma above 1, it is {}", options.gamma));
  if (std::all_of(of.begin(), of.end(), [](auto const* ensemble) { return ensemble->size() == 0; })) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    return {{nan, nan}, {nan, nan}, {nan, nan}};
  }
  SmoothField const field(of, box, options.smoothing, threads);
  auto const count = static_cast<double>(field.size());
  auto const per_particle = [&](double heat, double density) {
    return std::log(heat) / (gamma - 1) - std::log(density);
  };

  std::array<Entropy, 3> entropy;
  SmoothColumn const energy = field.column("specific_energy");
  Averages const own = averages(field, field.positions());
  for (std::size_t k = 0; k < 3; ++k) {
    ExactSum sum;
    for (std::size_t i = 0; i < field.size(); ++i) {
      double const motion = k == 0 ? own.fluctuation[i] : k == 1 ? 0 : own.square[i];
      sum += per_particle(energy.values[i] + motion / 2, own.density[i]);
    }
    entropy[k].sum = sum.value() / count;
  }

  auto cells = options.cells;
  if (cells.empty()) {
    auto const wanted = [&](int a) { return std::min(std::ceil(4 * box.length(a) / field.mean_range()), 1e9); };
    double nodes = 1;
    for (int a = 0; a < D; ++a) nodes *= wanted(a);
    double const fewer = nodes > max_nodes ? std::pow(max_nodes / nodes, 1.0 / D) : 1;
    for (int a = 0; a < D; ++a) cells.push_back(static_cast<std::size_t>(std::ceil(fewer * wanted(a))));
  }
  SmoothColumn inverse_mass = field.column("mass");
  for (double& m : inverse_mass.values) m = 1 / m;
  MeshGrid const grid = make_grid(box, cells);
  Averages const there = averages(field, points_on_grid(grid), {energy, inverse_mass});
  MeshField density{"entropy", dimensions::none, grid, {std::vector<double>(grid.size())}};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t p = 0; p < grid.size(); ++p) {
      double const rho = there.density[p];
      double const motion = k == 0 ? there.fluctuation[p] : k == 1 ? 0 : there.square[p];
      density.components[0][p] =
          rho > 0 ? rho * there.others[1][p] * per_particle(there.others[0][p] + motion / 2, rho) : 0;
    }
    entropy[k].integral = integral(density) / count;
  }
  return {entropy[0], entropy[1], entropy[2]};
}

}  // namespace boltzmann
