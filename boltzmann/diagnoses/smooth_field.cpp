// Sums over the particles near a point, their images sorted into cells.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/diagnoses/smooth_field.hpp>
#include <boltzmann/diagnoses/unknown.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace boltzmann {
namespace {

constexpr std::size_t points_per_task = 512;
constexpr double max_images = 1e9;

/// Numbers of a field at a point: its value, gradient and the upper triangle of its second derivatives.
constexpr std::size_t parts(int dimension, Derivatives derivatives) {
  auto const d = static_cast<std::size_t>(dimension);
  return 1 + (derivatives == Derivatives::none ? 0 : d) + (derivatives == Derivatives::second ? d * (d + 1) / 2 : 0);
}

/// The range of one particle; 0: its own.
struct Ranges {
  double common;
  int offset = -1;
  Ranges(AnyEnsemble const& ensemble, double range) : common(range) {
    if (common != 0) return;
    Field const* own = ensemble.find_field("range");
    if (own == nullptr)
      throw Error(fmt::format("ensemble '{}' of class {} has no range of its own; a smooth field of it needs one",
                              ensemble.name(), ensemble.class_name()));
    offset = own->offset;
  }
  double of(double const* row) const { return offset < 0 ? common : row[offset]; }
};

/// Approximate number of images of a particle within reach of the box, including itself. Error if its range is not
/// valid there.
double expected_images(AnyEnsemble const& ensemble, std::size_t i, double range, Box const& box) {
  if (!(range > 0) || std::isinf(range))
    throw Error(
        fmt::format("particle {} of ensemble '{}' has the range {}; it must be above 0", i, ensemble.name(), range));
  double images = 1;
  for (int a = 0; a < box.dimension(); ++a) {
    if (box.boundary(a) != Boundary::periodic && box.boundary(a) != Boundary::mirror) continue;
    images *= 1 + 2 * range / box.length(a);
    if (box.boundary(a) == Boundary::mirror && range > box.length(a))
      throw Error(
          fmt::format("particle {} of ensemble '{}' has the range {}; between mirrors along {} it can be {} "
                      "at most",
                      i, ensemble.name(), range, "xyz"[a], box.length(a)));
  }
  return images;
}

/// Eq 9 and the quotient rule: with F = rho f, grad f = (grad F - f grad rho) / rho, and so on. `sums` has the parts of
/// rho, F those of rho f (again of rho for the density itself). Stores the results for point p of the field.
void take_quotient(double const* sums, double const* F, bool quotient, std::size_t p, std::size_t D,
                   Derivatives derivatives, FieldValues& field) {
  double const rho = sums[0], scale = !quotient ? 1 : rho > 0 ? 1 / rho : unknown;
  double const f = F[0] * scale;
  field.value[p] = f;
  if (derivatives == Derivatives::none) return;
  double* gradient = &field.gradient[p * D];
  for (std::size_t a = 0; a < D; ++a) gradient[a] = quotient ? (F[1 + a] - f * sums[1 + a]) * scale : F[1 + a];
  if (derivatives != Derivatives::second) return;
  double* hessian = &field.hessian[p * D * D];
  std::size_t at = 1 + D;
  for (std::size_t a = 0; a < D; ++a)
    for (std::size_t b = a; b < D; ++b, ++at)
      hessian[a * D + b] = hessian[b * D + a] =
          quotient ? (F[at] - gradient[a] * sums[1 + b] - gradient[b] * sums[1 + a] - f * sums[at]) * scale : F[at];
}

}  // namespace

double fitting_range(Ensembles of, Box const& box) {
  std::size_t const count = number_of_particles(of);
  if (count == 0) throw Error("a smooth field needs particles, and there are none");
  double const spacing = std::pow(box.volume() / static_cast<double>(count), 1.0 / box.dimension());
  return spacing * (box.dimension() == 1 ? 3 : box.dimension() == 2 ? 2.5 : 2);
}

SmoothField::SmoothField(Ensembles of, Box const& box, Smoothing const& smoothing, int threads)
    : box_(box), shape_(smoothing.shape), threads_(threads), ensembles_(of.begin(), of.end()) {
  if (!(smoothing.range >= 0) || std::isinf(smoothing.range))
    throw Error(fmt::format("the range of a smooth field must be above 0, it is {}", smoothing.range));
  ExactSum sum_of_ranges, expected;
  for (auto const* ensemble : ensembles_) {
    if (ensemble->dimension() != box.dimension())
      throw Error(fmt::format("ensemble '{}' has {} dimensions, the box of its smooth field {}", ensemble->name(),
                              ensemble->dimension(), box.dimension()));
    Ranges const ranges(*ensemble, smoothing.range);
    for (std::size_t i = 0; i < ensemble->size(); ++i) {
      double const range = ranges.of(ensemble->row(i));
      expected += expected_images(*ensemble, i, range, box);
      largest_range_ = std::max(largest_range_, range);
      sum_of_ranges += range;
    }
    size_ += ensemble->size();
  }
  double const images = expected.value();
  if (images > max_images)
    throw Error(
        fmt::format("smooth fields with a range of {} in this box need {:.1e} images of particles; {:.0e} are "
                    "allowed",
                    largest_range_, images, max_images));
  mean_range_ = size_ > 0 ? sum_of_ranges.value() / static_cast<double>(size_) : 0;
  sources_.reserve(static_cast<std::size_t>(images) + size_ / 8);
  collect_sources(smoothing.range);
  if (sources_.empty()) return;
  static_assert(sizeof(Source) == 6 * sizeof(double));
  cells_ = Cells(box.dimension(), sources_[0].position.data(), 6, sources_.size(), largest_range_, threads_);
  auto const sorted = [&](auto const& from) {
    auto to = from;
    for (std::size_t k = 0; k < to.size(); ++k) to[k] = from[cells_.items()[k]];
    return to;
  };
  sources_ = sorted(sources_);
  origins_ = sorted(origins_);
}

void SmoothField::collect_sources(double common_range) {
  int const D = box_.dimension();
  Images const seen(box_);
  std::uint32_t particle = 0;
  for (auto const* ensemble : ensembles_) {
    Ranges const ranges(*ensemble, common_range);
    Field const* mass = ensemble->find_field("mass");
    for (std::size_t i = 0; i < ensemble->size(); ++i, ++particle) {
      double const* row = ensemble->row(i);
      if (!std::all_of(row, row + D, [](double x) { return std::isfinite(x); })) continue;
      std::array<double, 3> home{};
      for (int a = 0; a < D; ++a) home[a] = box_.periodic(a) ? box_.wrapped(row[a], a) : row[a];
      double const range = ranges.of(row);
      // The images whose weight extends into the box.
      seen.each(home.data(), range, [&](Turns const& turns, std::array<double, 3> const& at) {
        sources_.push_back({at, mass ? row[mass->offset] : 1.0, range, 1 / range});
        auto& walls = origins_.emplace_back(Origin{particle, {}}).walls;
        for (int a = 0; a < D; ++a)
          if (!box_.periodic(a) || (box_.sheared() && a == box_.shear().gradient))
            walls[a] = static_cast<signed char>(turns[a]);
      });
    }
  }
}

std::vector<double> SmoothField::of_sources(SmoothColumn const& column) const {
  if (column.values.size() != size_)
    throw Error(fmt::format("a smooth field of {} particles can't be made of {} numbers", size_, column.values.size()));
  std::vector<double> values(sources_.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    auto const& [particle, side] = origins_[k];
    Turns const walls{side[0], side[1], side[2]};
    values[k] = column.values[particle];
    if (column.image && walls != Turns{}) values[k] = column.image(values[k], particle, walls);
  }
  return values;
}

// Adds up m w, and m f w for every column, with their derivatives.
template <class Shape, int D>
void SmoothField::sum(double const* point, double const* const* columns, std::size_t count, Derivatives derivatives,
                      double* sums) const {
  std::size_t const size = parts(D, derivatives);
  cells_.near(point, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      Source const& source = sources_[k];
      double way[D], r2 = 0;
      for (int a = 0; a < D; ++a) {
        way[a] = point[a] - source.position[a];
        r2 += way[a] * way[a];
      }
      if (!(r2 < source.range * source.range)) continue;
      auto const weight = weigh<Shape, D>(r2, source.range, source.inverse_range);
      double part[parts(D, Derivatives::second)];
      part[0] = source.mass * weight.value;
      if (derivatives != Derivatives::none)
        for (int a = 0; a < D; ++a) part[1 + a] = source.mass * weight.slope * way[a];
      if (derivatives == Derivatives::second) {
        // w'' along the vector to the particle, w'/r across it.
        double const q = std::sqrt(r2) * source.inverse_range;
        double norm = Shape::template norm<D> * source.inverse_range * source.inverse_range;
        for (int a = 0; a < D; ++a) norm *= source.inverse_range;
        double const bent = norm * Shape::template curvature<D>(q) - weight.slope;
        double const along = r2 > 0 ? source.mass * bent / r2 : 0;
        std::size_t at = 1 + D;
        for (int a = 0; a < D; ++a)
          for (int b = a; b < D; ++b, ++at)
            part[at] = along * way[a] * way[b] + (a == b ? source.mass * weight.slope : 0);
      }
      for (std::size_t p = 0; p < size; ++p) sums[p] += part[p];
      for (std::size_t c = 0; c < count; ++c) {
        double const f = columns[c][k];
        for (std::size_t p = 0; p < size; ++p) sums[(c + 1) * size + p] += f * part[p];
      }
    }
  });
}

SmoothField::Sum SmoothField::sum_of_weight() const {
  Sum found = nullptr;
  for_weight(shape_, [&](auto shape) {
    using Shape = decltype(shape);
    constexpr Sum sums[] = {&SmoothField::sum<Shape, 1>, &SmoothField::sum<Shape, 2>, &SmoothField::sum<Shape, 3>};
    found = sums[dimension() - 1];
  });
  return found;
}

std::vector<FieldValues> SmoothField::values(std::span<double const> points, std::span<SmoothColumn const> columns,
                                             Derivatives derivatives) const {
  auto const D = static_cast<std::size_t>(dimension());
  if (points.size() % D != 0)
    throw Error(fmt::format("points in {} dimensions can't be made of {} coordinates", D, points.size()));
  std::size_t const count = points.size() / D, size = parts(dimension(), derivatives);
  std::vector<std::vector<double>> of;
  for (auto const& column : columns) of.push_back(of_sources(column));
  std::vector<double const*> of_columns;
  of_columns.reserve(of.size());
  for (auto const& column : of) of_columns.push_back(column.data());
  std::vector<FieldValues> fields(columns.size() + 1);
  for (auto& field : fields) {
    field.value.resize(count);
    if (derivatives != Derivatives::none) field.gradient.resize(count * D);
    if (derivatives == Derivatives::second) field.hessian.resize(count * D * D);
  }

  Sum const add = sum_of_weight();
  for_ranges(count, points_per_task, threads_, [&](std::size_t begin, std::size_t end) {
    std::vector<double> sums(fields.size() * size);
    for (std::size_t p = begin; p < end; ++p) {
      std::fill(sums.begin(), sums.end(), 0.0);
      double place[3] = {0, 0, 0};
      bool inside = !sources_.empty();
      for (std::size_t a = 0; a < D; ++a) {
        int const axis = static_cast<int>(a);
        double const x = points[p * D + a];
        place[a] = box_.periodic(axis) && std::isfinite(x) ? box_.wrapped(x, axis) : x;
        inside = inside && std::isfinite(x);
        if (box_.boundary(axis) != Boundary::mirror) continue;
        double const slack = 1e-12 * box_.length(axis);  // the last node of a grid is on the wall up to rounding
        if (box_.walled(axis, Box::End::low)) inside = inside && x >= box_.low(axis) - slack;
        if (box_.walled(axis, Box::End::high)) inside = inside && x <= box_.high(axis) + slack;
      }
      if (inside) (this->*add)(place, of_columns.data(), of_columns.size(), derivatives, sums.data());
      for (std::size_t c = 0; c < fields.size(); ++c)
        take_quotient(sums.data(), sums.data() + c * size, c > 0, p, D, derivatives, fields[c]);
    }
  });
  return fields;
}

FieldValues SmoothField::density(std::span<double const> points, Derivatives derivatives) const {
  return std::move(values(points, {}, derivatives)[0]);
}

FieldValues SmoothField::value(std::span<double const> points, SmoothColumn const& column,
                               Derivatives derivatives) const {
  return std::move(values(points, {&column, 1}, derivatives)[1]);
}

FieldValues SmoothField::value(std::span<double const> points, std::string_view quantity,
                               Derivatives derivatives) const {
  return quantity == "density" ? density(points, derivatives) : value(points, column(quantity), derivatives);
}

SmoothColumn SmoothField::column(std::string_view name) const {
  auto const of = [&](std::string_view what) {
    std::vector<double> all;
    for (auto const* ensemble : ensembles_) {
      auto const part = quantity(*ensemble, what);
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  };
  SmoothColumn column{of(name)};
  if (!box_.any_wall() && !box_.sheared()) return column;
  if (name == "speed" || name == "kinetic-energy") {
    std::array<std::vector<double>, 3> velocity;
    for (int a = 0; a < dimension(); ++a) velocity[a] = of(std::string("velocity.") + "xyz"[a]);
    std::vector<double> const mass = name == "speed" ? std::vector<double>{} : of("mass");
    column.image = [box = box_, velocity, mass](double, std::size_t i, Turns const& walls) {
      double v2 = 0;
      for (int a = 0; a < box.dimension(); ++a)
        v2 += square(image_map(box, {ImageRule::velocity, a}, walls)(velocity[a][i]));
      return mass.empty() ? std::sqrt(v2) : 0.5 * mass[i] * v2;
    };
    return column;
  }
  auto const dot = name.rfind('.');
  bool const along_line = dimension() == 1 && (name == "velocity" || name == "position");
  std::string_view const field = name.substr(0, dot);
  std::string_view const letters = along_line ? "x" : dot == std::string_view::npos ? "" : name.substr(dot + 1);
  ImageRule const rule = field == "velocity"   ? ImageRule::velocity
                         : field == "position" ? ImageRule::position
                                               : ImageRule::normal_vector;
  std::vector<ImageComponent> rules;
  if (name == "temperature") rules = {{ImageRule::temperature}};
  for (char const letter : letters)
    if (letter >= 'x' && letter <= 'z') rules.push_back({rule, letter - 'x'});
  if (!rules.empty())
    column.image = [box = box_, rules](double value, std::size_t, Turns const& walls) {
      for (auto const& each : rules) value = image_map(box, each, walls)(value);
      return value;
    };
  return column;
}

QuantityMeaning SmoothField::meaning(std::string_view name) const {
  if (name == "density") {
    bool const massive = ensembles_.empty() || ensembles_.front()->find_field("mass") != nullptr;
    return {"density", "density",
            (massive ? dimensions::mass : dimensions::none) / pow(dimensions::length, dimension())};
  }
  if (ensembles_.empty()) throw Error(fmt::format("a smooth field of '{}' needs particles", name));
  return quantity_meaning(*ensembles_.front(), name);
}

MeshField SmoothField::on_grid(MeshGrid const& grid, std::string_view name) const {
  Field const* own = ensembles_.empty() || name == "density" ? nullptr : ensembles_.front()->find_field(name);
  if (own == nullptr || own->components == 1)
    return {std::string(name), meaning(name).dimension, grid, {value(points_on_grid(grid), name).value}};
  MeshField field{std::string(name), own->dimension, grid, {}};
  std::vector<SmoothColumn> columns;
  for (auto const& part : quantities(*ensembles_.front()))
    if (part.name.starts_with(std::string(name) + ".")) columns.push_back(column(part.name));
  auto fields = values(points_on_grid(grid), columns);
  for (std::size_t c = 1; c < fields.size(); ++c) field.components.push_back(std::move(fields[c].value));
  return field;
}

MeshField SmoothField::on_grid(MeshGrid const& grid, SmoothColumn const& column, std::string name,
                               Dimension dimension) const {
  return {std::move(name), dimension, grid, {value(points_on_grid(grid), column).value}};
}

std::vector<double> SmoothField::positions() const {
  std::vector<double> all;
  all.reserve(size_ * static_cast<std::size_t>(dimension()));
  for (auto const* ensemble : ensembles_)
    for (std::size_t i = 0; i < ensemble->size(); ++i)
      all.insert(all.end(), ensemble->row(i), ensemble->row(i) + dimension());
  return all;
}

std::vector<double> points_on_grid(MeshGrid const& grid) {
  std::vector<double> points;
  points.reserve(grid.size() * static_cast<std::size_t>(grid.dimension));
  for (std::size_t k = 0; k < grid.nodes[2]; ++k)
    for (std::size_t j = 0; j < grid.nodes[1]; ++j)
      for (std::size_t i = 0; i < grid.nodes[0]; ++i) {
        std::array<std::size_t, 3> const node{i, j, k};
        for (int a = 0; a < grid.dimension; ++a) points.push_back(grid.position(a, node[a]));
      }
  return points;
}

double integral(MeshField const& field, std::size_t component) {
  MeshGrid const& grid = field.grid;
  auto const share = [&](int axis, std::size_t node) {
    bool const end = axis < grid.dimension && !grid.periodic[axis] && grid.nodes[axis] > 1 &&
                     (node == 0 || node + 1 == grid.nodes[axis]);
    return end ? 0.5 : 1.0;
  };
  ExactSum sum;
  for (std::size_t k = 0; k < grid.nodes[2]; ++k)
    for (std::size_t j = 0; j < grid.nodes[1]; ++j) {
      double const of_line = share(1, j) * share(2, k);
      for (std::size_t i = 0; i < grid.nodes[0]; ++i)
        sum += of_line * share(0, i) * field.components[component][grid.index(i, j, k)];
    }
  return sum.value() * grid.cell_volume();
}

namespace {

/// One particle whose images are the lattice.
class LatticePoint final : public AnyEnsemble {
 public:
  explicit LatticePoint(int dimension) : AnyEnsemble("lattice", "lattice point", typeid(void), dimension, 4, 3, 0, {}) {
    attach(row_, 1);
  }
  void resize(std::size_t) override {}
  std::shared_ptr<void const> hold_rows() const override { return nullptr; }
  std::size_t bytes() const override { return sizeof(row_); }

 private:
  double row_[4] = {0, 0, 0, 0};
};

/// Climbs (sign 1) or descends from a point, along the axes and diagonals, in decreasing steps.
double climbed(SmoothField const& field, std::vector<double> point, double step, double sign) {
  auto const D = point.size();
  double best = sign * field.density(point).value[0];
  while (step > 1e-9) {
    std::vector<double> around;
    for (int k = 0; k < (D == 1 ? 3 : D == 2 ? 9 : 27); ++k)
      for (std::size_t a = 0; a < D; ++a)
        around.push_back(point[a] + step * (k / (a == 0 ? 1 : a == 1 ? 3 : 9) % 3 - 1));
    auto const values = field.density(around).value;
    std::size_t higher = values.size();
    for (std::size_t k = 0; k < values.size(); ++k)
      if (sign * values[k] > best) {
        best = sign * values[k];
        higher = k;
      }
    if (higher == values.size())
      step /= 2;
    else
      point.assign(around.begin() + static_cast<std::ptrdiff_t>(higher * D),
                   around.begin() + static_cast<std::ptrdiff_t>((higher + 1) * D));
  }
  return sign * best;
}

}  // namespace

DensityExtremes lattice_density_extremes(int dimension, WeightShape shape, double range) {
  if (dimension < 1 || dimension > 3) throw Error(fmt::format("a lattice has 1 to 3 dimensions, not {}", dimension));
  if (!(range > 0 && range <= 20))
    throw Error(fmt::format("the range on a lattice of spacing 1 must be above 0 and at most 20, it is {}", range));
  LatticePoint const lattice(dimension);
  Box const cell(dimension, {0, 0, 0}, {1, 1, 1}, {Boundary::periodic, Boundary::periodic, Boundary::periodic});
  SmoothField const field(lattice, cell, {shape, range});
  // An eighth of a cell, by symmetry; refined from the best points of a grid.
  std::size_t const along = dimension == 1 ? 65 : dimension == 2 ? 33 : 9;
  double const step = 0.5 / static_cast<double>(along - 1);
  MeshGrid grid;
  grid.dimension = dimension;
  for (int a = 0; a < dimension; ++a) grid.nodes[a] = along, grid.spacing[a] = step;
  auto const points = points_on_grid(grid);
  auto const values = field.density(points).value;
  auto const found = [&](double sign) {
    std::vector<std::size_t> order(values.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::size_t const starts = std::min<std::size_t>(6, order.size());
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(starts), order.end(),
                      [&](std::size_t a, std::size_t b) { return sign * values[a] > sign * values[b]; });
    double best = -std::numeric_limits<double>::infinity();
    auto const D = static_cast<std::size_t>(dimension);
    for (std::size_t s = 0; s < starts; ++s) {
      std::vector<double> const point(points.begin() + static_cast<std::ptrdiff_t>(order[s] * D),
                                      points.begin() + static_cast<std::ptrdiff_t>((order[s] + 1) * D));
      best = std::max(best, sign * climbed(field, point, step, sign));
    }
    return sign * best;
  };
  return {found(-1), found(1)};
}

}  // namespace boltzmann
