// Splits and merges rows, and selects the pairs to merge.
#include <boltzmann/core/number.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/neighbours/cells.hpp>
#include <boltzmann/schemes/smooth/rezone.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <tuple>
#include <vector>

namespace boltzmann {
namespace {

using Offset = std::array<double, 3>;

constexpr double usual_offset = 0.1;  // in units of the range

/// An ensemble with the offsets of the fields that rezoning changes.
struct Rows {
  AnyEnsemble& ensemble;
  int dimension, mass, position, velocity, energy, range;

  explicit Rows(AnyEnsemble& of)
      : ensemble(of),
        dimension(of.dimension()),
        mass(place(of, "mass", 1)),
        position(place(of, "position", dimension)),
        velocity(place(of, "velocity", dimension)),
        energy(place(of, "specific_energy", 1)),
        range(place(of, "range", 1)) {}

  static int place(AnyEnsemble const& of, char const* name, int components) {
    Field const& field = of.field(name);
    if (field.components != components)
      throw Error(fmt::format("rezoning: the field {} of ensemble '{}' has {} components; {} are needed", name,
                              of.name(), field.components, components));
    return field.offset;
  }
  void check_row(std::size_t i) const {
    if (i >= ensemble.size())
      throw Error(
          fmt::format("rezoning: ensemble '{}' has no particle {}; it has {}", ensemble.name(), i, ensemble.size()));
  }
};

void check_dimension_of(AnyEnsemble const& ensemble, Box const& box) {
  if (box.dimension() != ensemble.dimension())
    throw Error(fmt::format("rezoning: ensemble '{}' is {}-dimensional, the box {}-dimensional", ensemble.name(),
                            ensemble.dimension(), box.dimension()));
}

/// Moves half of row i into row `half`.
void halve(Rows const& rows, std::size_t i, std::size_t half, double const* offset) {
  double* const a = rows.ensemble.row(i);
  double* const b = rows.ensemble.row(half);
  a[rows.mass] *= 0.5;
  a[rows.range] *= std::pow(2, -1.0 / rows.dimension);
  std::memcpy(b, a, rows.ensemble.stride() * sizeof(double));
  for (int k = 0; k < rows.dimension; ++k) {
    a[rows.position + k] += offset[k];
    b[rows.position + k] -= offset[k];
  }
}

Vector<3> in_space(double const* components, int dimension) {
  Vector<3> result{};
  std::copy_n(components, dimension, result.component);
  return result;
}

/// Merges row j into row i; row j is unchanged. Returns the lost angular momentum.
Vector<3> take_up(Rows const& rows, Box const& box, std::size_t i, std::size_t j) {
  double* const a = rows.ensemble.row(i);
  double const* const b = rows.ensemble.row(j);
  int const d = rows.dimension;
  double const mass = a[rows.mass] + b[rows.mass], share = b[rows.mass] / mass, reduced = a[rows.mass] * share;
  if (!(mass > 0))
    throw Error(fmt::format("rezoning: particles {} and {} of ensemble '{}' have the mass {:.6g}; it must be positive",
                            i, j, rows.ensemble.name(), mass));
  Offset apart{}, relative{}, centre{};
  for (int k = 0; k < d; ++k) {
    apart[k] = b[rows.position + k] - a[rows.position + k];
    relative[k] = b[rows.velocity + k] - a[rows.velocity + k];
  }
  box.nearest_image(apart.data());
  for (int k = 0; k < d; ++k) centre[k] = a[rows.position + k] + share * apart[k];
  double const volume = std::pow(a[rows.range], d) + std::pow(b[rows.range], d);
  for (std::size_t k = 0; k < rows.ensemble.doubles(); ++k) a[k] += share * (b[k] - a[k]);
  auto const v = in_space(relative.data(), d);
  a[rows.mass] = mass;
  a[rows.range] = d == 1 ? volume : d == 2 ? std::sqrt(volume) : std::cbrt(volume);
  a[rows.energy] += 0.5 * reduced * norm2(v) / mass;
  std::copy_n(centre.data(), d, a + rows.position);
  return cross(in_space(apart.data(), d), v) * reduced;
}

/// Removes the marked rows; the others move up in their order.
void remove(AnyEnsemble& ensemble, std::vector<char> const& gone) {
  std::size_t next = 0;
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    if (gone[i]) continue;
    if (next != i) std::memcpy(ensemble.row(next), ensemble.row(i), ensemble.stride() * sizeof(double));
    ++next;
  }
  ensemble.resize(next);
}

/// A direction that is unique to each pair of numbers.
Offset offset_of(Rows const& rows, std::size_t i, std::size_t size) {
  Stream stream(size, 0, i, Purpose::selection);
  double const length = usual_offset * rows.ensemble.row(i)[rows.range];
  if (rows.dimension == 1) return {length, 0, 0};
  double const angle = 2 * pi * stream.uniform();
  if (rows.dimension == 2) return {length * std::cos(angle), length * std::sin(angle), 0};
  double const height = 2 * stream.uniform() - 1, flat = length * std::sqrt(1 - height * height);
  return {flat * std::cos(angle), flat * std::sin(angle), length * height};
}

bool within(std::array<double, 3> const& low, std::array<double, 3> const& high, double const* x, int dimension) {
  for (int k = 0; k < dimension; ++k)
    if (!(x[k] >= low[k] && x[k] < high[k])) return false;
  return true;
}

/// Shortens the offset if a half would be too near to a wall. Returns false if there is no room to split.
bool make_fit(Box const& box, double const* x, int dimension, Offset& offset) {
  double wanted = 0, left = 0;
  for (int k = 0; k < dimension; ++k) {
    wanted += offset[k] * offset[k];
    double room = std::fabs(offset[k]);
    for (auto const end : {Box::End::low, Box::End::high})
      if (box.walled(k, end))
        room = std::min(room, std::max(0.5 * (end == Box::End::low ? x[k] - box.low(k) : box.high(k) - x[k]), 0.0));
    offset[k] = std::clamp(offset[k], -room, room);
    left += offset[k] * offset[k];
  }
  if (left < 0.01 * wanted) return false;
  for (double const sign : {-1.0, 1.0}) {
    Offset half{};
    for (int k = 0; k < dimension; ++k) half[k] = x[k] + sign * offset[k];
    for (Region const& region : box.regions())
      if (within(region.low, region.high, x, dimension) != within(region.low, region.high, half.data(), dimension))
        return false;
  }
  return true;
}

/// A row to be split.
struct Split {
  std::size_t row;
  Offset offset;
};
/// Two candidates for merging. The first in order merges first.
struct NearPair {
  double square_of_distance;
  std::uint32_t i, j;
  auto key() const { return std::tie(square_of_distance, i, j); }
};

/// A position, and its periodic images that may be near to particles in the box.
std::vector<Offset> with_images(Offset const& place, Box const& box, double reach) {
  std::vector<Offset> all{place};
  for (int k = 0; k < box.dimension(); ++k) {
    if (!box.periodic(k)) continue;
    for (std::size_t n = all.size(); n-- > 0;)
      for (double const shift : {-1.0, 1.0}) {
        double const image = place[k] + shift * box.length(k);
        if (image < box.low(k) - reach || image > box.high(k) + reach) continue;
        all.push_back(all[n]);
        all.back()[k] = image;
      }
  }
  return all;
}

/// The pairs of candidates to merge.
std::vector<std::array<std::size_t, 2>> pairs_of(Rows const& rows, Box const& box,
                                                 std::vector<std::size_t> const& candidates, Rezoning const& rezoning) {
  int const d = rows.dimension;
  std::vector<Offset> places(candidates.size());
  double largest = 0;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    double const* const row = rows.ensemble.row(candidates[c]);
    for (int k = 0; k < d; ++k) {
      double const x = row[rows.position + k];
      places[c][k] = box.periodic(k) ? box.wrapped(x, k) : x;
    }
    largest = std::max(largest, row[rows.range]);
  }
  double const reach = rezoning.merge_within * largest;
  if (!(reach > 0) || candidates.size() < 2) return {};
  Cells const cells(d, places.data()->data(), std::tuple_size_v<Offset>, places.size(), reach);

  std::vector<NearPair> near;
  auto const look = [&](std::uint32_t i, double const* seen_from) {
    double const* const a = rows.ensemble.row(candidates[i]);
    cells.near(seen_from, [&](std::size_t begin, std::size_t end) {
      for (std::size_t item = begin; item < end; ++item) {
        std::uint32_t const j = cells.items()[item];
        if (j <= i) continue;
        double const* const b = rows.ensemble.row(candidates[j]);
        if (!(a[rows.mass] + b[rows.mass] <= rezoning.largest_mass)) continue;
        Offset apart{};
        for (int k = 0; k < d; ++k) apart[k] = places[j][k] - places[i][k];
        box.nearest_image(apart.data());
        double const r2 = norm2(in_space(apart.data(), d));
        if (r2 < square(rezoning.merge_within * std::min(a[rows.range], b[rows.range]))) near.push_back({r2, i, j});
      }
    });
  };
  for (std::uint32_t i = 0; i < candidates.size(); ++i) {
    for (Offset const& place : with_images(places[i], box, reach)) look(i, place.data());
  }
  std::sort(near.begin(), near.end(), [](NearPair const& a, NearPair const& b) { return a.key() < b.key(); });

  std::vector<std::array<std::size_t, 2>> result;
  std::vector<char> taken(candidates.size(), 0);
  for (NearPair const& pair : near) {
    if (taken[pair.i] || taken[pair.j]) continue;
    taken[pair.i] = taken[pair.j] = 1;
    result.push_back({candidates[pair.i], candidates[pair.j]});
  }
  return result;
}

}  // namespace

std::size_t split(AnyEnsemble& ensemble, std::size_t i, std::span<double const> offset) {
  Rows const rows(ensemble);
  rows.check_row(i);
  if (offset.size() != static_cast<std::size_t>(rows.dimension))
    throw Error(fmt::format("rezoning: the offset of a half has {} components in {} dimensions", offset.size(),
                            rows.dimension));
  for (double const x : offset)
    if (!std::isfinite(x)) throw Error(fmt::format("rezoning: an offset of {} is not finite", x));
  Offset copy{};  // a copy, because it may be one of the rows, which resizing moves
  std::copy(offset.begin(), offset.end(), copy.begin());
  std::size_t const half = ensemble.size();
  ensemble.resize(half + 1);
  halve(rows, i, half, copy.data());
  ensemble.clear_influence();
  return half;
}

std::size_t split(AnyEnsemble& ensemble, std::size_t i) {
  Rows const rows(ensemble);
  rows.check_row(i);
  Offset const offset = offset_of(rows, i, ensemble.size());
  return split(ensemble, i, std::span(offset.data(), static_cast<std::size_t>(rows.dimension)));
}

Merged merge(AnyEnsemble& ensemble, Box const& box, std::size_t i, std::size_t j) {
  Rows const rows(ensemble);
  check_dimension_of(ensemble, box);
  rows.check_row(i);
  rows.check_row(j);
  if (i == j)
    throw Error(fmt::format("rezoning: particle {} of ensemble '{}' can't merge with itself", i, ensemble.name()));
  auto const lost = take_up(rows, box, i, j);
  std::vector<char> gone(ensemble.size(), 0);
  gone[j] = 1;
  remove(ensemble, gone);
  ensemble.clear_influence();
  return {j < i ? i - 1 : i, lost};
}

Words<Rezoning::By> const& rezone_by_words() {
  static Words<Rezoning::By> const all{"measure of size",
                                       {{Rezoning::By::density, "density", "mass in a volume"},
                                        {Rezoning::By::volume, "volume", "the space that a particle takes"}}};
  return all;
}

void Rezoning::check() const {
  auto const refuse = [](std::string const& what) { throw Error("rezoning: " + what); };
  if (!(split_above >= 0) || !(merge_below >= 0))
    refuse(fmt::format("split_above = {:.6g} and merge_below = {:.6g} must be zero or positive", split_above,
                       merge_below));
  if (!(smallest_mass >= 0) || !(largest_mass > smallest_mass))
    refuse(fmt::format("smallest_mass = {:.6g} must be zero or positive, and below largest_mass = {:.6g}",
                       smallest_mass, largest_mass));
  if (!(merge_within > 0 && merge_within <= 1))
    refuse(fmt::format("merge_within = {:.6g} must be above 0, at most 1", merge_within));
  bool const splits = std::isfinite(split_above), merges = merge_below > 0;
  if (by == By::density) {
    if (splits && smallest_mass == 0) refuse("to split by density needs a smallest_mass, where it ends");
    if (merges && !std::isfinite(largest_mass)) refuse("to merge by density needs a largest_mass, where it ends");
    if (merge_below > split_above)
      refuse(fmt::format("merge_below = {:.6g} must not be above split_above = {:.6g}", merge_below, split_above));
  } else if (merge_below > 0.5 * split_above) {
    refuse(fmt::format("merge_below = {:.6g} must not be above half of split_above = {:.6g}, the volume of a half",
                       merge_below, split_above));
  }
  if (region)
    for (int k = 0; k < 3; ++k)
      if (!(region->low[k] <= region->high[k]))
        refuse(fmt::format("the region from {:.6g} to {:.6g} on axis {} has its ends exchanged", region->low[k],
                           region->high[k], k));
}

void check(AnyEnsemble const& ensemble, Box const& box, Rezoning const& rezoning) {
  rezoning.check();
  check_dimension_of(ensemble, box);
  for (char const* name : {"mass", "specific_energy", "range", "density"}) Rows::place(ensemble, name, 1);
  for (char const* name : {"position", "velocity"}) Rows::place(ensemble, name, ensemble.dimension());
}

namespace {

/// The rows to split and the candidates for merging in the current state.
struct Chosen {
  std::vector<Split> splits;
  std::vector<std::size_t> candidates;  ///< for merging
};
Chosen chosen_of(AnyEnsemble& ensemble, Rows const& rows, Box const& box, Rezoning const& rezoning) {
  int const density = Rows::place(ensemble, "density", 1), d = rows.dimension;

  Chosen chosen;
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    double const* const row = ensemble.row(i);
    double const* const x = row + rows.position;
    bool finite = std::isfinite(row[rows.mass]) && std::isfinite(row[rows.range]);
    for (int k = 0; k < d; ++k) finite = finite && std::isfinite(x[k]);
    if (!finite)
      throw PhysicsFailure(
          fmt::format("rezoning: particle {} of ensemble '{}' has a position, range or mass that is not finite", i,
                      ensemble.name()));
    if (!(row[rows.mass] > 0))
      throw Error(fmt::format("rezoning: particle {} of ensemble '{}' has the mass {:.6g}; it must be positive", i,
                              ensemble.name(), row[rows.mass]));
    if (rezoning.region && !within(rezoning.region->low, rezoning.region->high, x, d)) continue;
    if (!(row[density] > 0))
      throw Error(fmt::format(
          "rezoning: particle {} of ensemble '{}' has the density {:.6g}; calculate densities before rezoning", i,
          ensemble.name(), row[density]));
    double const size = rezoning.by == Rezoning::By::density ? row[density] : row[rows.mass] / row[density];
    if (size > rezoning.split_above && row[rows.mass] / 2 >= rezoning.smallest_mass) {
      Offset offset = offset_of(rows, i, ensemble.size());
      if (make_fit(box, x, d, offset)) chosen.splits.push_back({i, offset});
    } else if (size < rezoning.merge_below) {
      chosen.candidates.push_back(i);
    }
  }
  return chosen;
}

}  // namespace

Rezoned rezone(AnyEnsemble& ensemble, Box const& box, Rezoning const& rezoning) {
  check(ensemble, box, rezoning);
  Rows const rows(ensemble);
  int const d = rows.dimension;
  auto [splits, candidates] = chosen_of(ensemble, rows, box, rezoning);
  auto const pairs = pairs_of(rows, box, candidates, rezoning);
  Rezoned result{splits.size(), pairs.size(), {}};
  if (splits.empty() && pairs.empty()) return result;

  auto const wrap = [&](std::size_t i) {
    double* const x = ensemble.row(i) + rows.position;
    for (int k = 0; k < d; ++k)
      if (box.periodic(k)) x[k] = box.wrapped(x[k], k);
  };
  std::vector<char> gone(ensemble.size(), 0);
  for (auto const& [i, j] : pairs) {
    result.angular_momentum_lost += take_up(rows, box, i, j);
    wrap(i);
    gone[j] = 1;
  }
  std::size_t seen = 0, gone_before = 0;
  for (Split& split : splits) {
    for (; seen < split.row; ++seen) gone_before += static_cast<std::size_t>(gone[seen]);
    split.row -= gone_before;
  }
  remove(ensemble, gone);
  std::size_t half = ensemble.size();
  ensemble.resize(half + splits.size());
  for (Split const& split : splits) {
    halve(rows, split.row, half, split.offset.data());
    wrap(split.row);
    wrap(half++);
  }
  ensemble.clear_influence();
  return result;
}

}  // namespace boltzmann
