// The sites of the lattices, and particles on them.
#include <boltzmann/core/error.hpp>
#include <boltzmann/loaders/fields.hpp>
#include <boltzmann/loaders/lattice.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

namespace boltzmann {
namespace {

using Place = std::array<double, 3>;

/// A lattice kind in one dimension of space: the edges of its cell and its sites, in units of the spacing.
struct Cell {
  Place edges;
  std::vector<Place> sites;
  double shift = 0;  // of every second row, along x
};

Cell cell_of(Lattice kind, int dimension) {
  auto const refuse = [&](char const* where) {
    return Error(fmt::format("lattice {} exists in {} only, the space has {} dimension{}", to_string(kind), where,
                             dimension, dimension == 1 ? "" : "s"));
  };
  switch (kind) {
    case Lattice::square:
      break;
    case Lattice::triangular:
      if (dimension != 2) throw refuse("2D");
      return {{1, std::numbers::sqrt3 / 2, 1}, {{0, 0, 0}}, 0.5};
    case Lattice::fcc: {
      if (dimension != 3) throw refuse("3D");
      double const a = std::numbers::sqrt2, h = a / 2;
      return {{a, a, a}, {{0, 0, 0}, {h, h, 0}, {h, 0, h}, {0, h, h}}};
    }
    case Lattice::bcc: {
      if (dimension != 3) throw refuse("3D");
      double const a = 2 / std::numbers::sqrt3, h = a / 2;
      return {{a, a, a}, {{0, 0, 0}, {h, h, h}}};
    }
    case Lattice::diamond: {
      if (dimension != 3) throw refuse("3D");
      double const a = 4 / std::numbers::sqrt3, h = a / 2, q = a / 4;
      return {{a, a, a},
              {{0, 0, 0},
               {h, h, 0},
               {h, 0, h},
               {0, h, h},
               {q, q, q},
               {h + q, h + q, q},
               {h + q, q, h + q},
               {q, h + q, h + q}}};
    }
    case Lattice::hcp: {  // every second layer is in hollows of the first
      if (dimension != 3) throw refuse("3D");
      double const row = std::numbers::sqrt3 / 2, hollow = row / 3, layer = std::numbers::sqrt2 / std::numbers::sqrt3;
      return {{1, 2 * row, 2 * layer}, {{0, 0, 0}, {0.5, row, 0}, {0.5, hollow, layer}, {0, row + hollow, layer}}};
    }
  }
  return {{1, 1, 1}, {{0, 0, 0}}};
}

void check(LatticeBlock const& block, int dimension) {
  if (!(block.spacing > 0) || !std::isfinite(block.spacing))
    throw Error(fmt::format("lattice: the spacing must be a positive length, not {}", block.spacing));
  for (int a = 0; a < dimension; ++a)
    if (!std::isfinite(block.origin[a])) throw Error("lattice: the origin is not finite");
}

}  // namespace

Words<Lattice> const& lattice_words() {
  static Words<Lattice> const all{"lattice",
                                  {{Lattice::square, "square", "a line in 1D, square in 2D, simple cubic in 3D"},
                                   {Lattice::triangular, "triangular", "2D: 6 neighbours"},
                                   {Lattice::fcc, "fcc", "3D, face-centred cubic: 12 neighbours"},
                                   {Lattice::bcc, "bcc", "3D, body-centred cubic: 8 neighbours"},
                                   {Lattice::hcp, "hcp", "3D, hexagonal close packing: 12 neighbours"},
                                   {Lattice::diamond, "diamond", "3D, two fcc lattices in each other: 4 neighbours"}}};
  return all;
}
std::string to_string(Lattice kind) { return lattice_words().name(kind); }

std::size_t site_count(LatticeBlock const& block, int dimension) {
  check(block, dimension);
  std::size_t count = cell_of(block.kind, dimension).sites.size();
  for (int a = 0; a < dimension; ++a)
    if (__builtin_mul_overflow(count, block.counts[a], &count) || count > std::numeric_limits<std::uint32_t>::max())
      throw Error(fmt::format("lattice: a block of {} cells has too many sites", fmt::join(block.counts, " x ")));
  return count;
}

std::vector<Place> lattice_sites(LatticeBlock const& block, int dimension) {
  std::vector<Place> places;
  places.reserve(site_count(block, dimension));
  Cell const cell = cell_of(block.kind, dimension);
  std::size_t const rows = dimension > 1 ? block.counts[1] : 1, layers = dimension > 2 ? block.counts[2] : 1;
  for (std::size_t z = 0; z < layers; ++z)
    for (std::size_t y = 0; y < rows; ++y)
      for (std::size_t x = 0; x < block.counts[0]; ++x)
        for (Place const& site : cell.sites) {
          Place const number{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
          Place place{0, 0, 0};
          for (int a = 0; a < dimension; ++a)
            place[a] = block.origin[a] +
                       block.spacing * (number[a] * cell.edges[a] + site[a] + (a == 0 && y % 2 == 1 ? cell.shift : 0));
          places.push_back(place);
        }
  return places;
}

Place repeat_lengths(LatticeBlock const& block, int dimension) {
  check(block, dimension);
  Cell const cell = cell_of(block.kind, dimension);
  Place lengths{0, 0, 0};
  for (int a = 0; a < dimension; ++a) lengths[a] = static_cast<double>(block.counts[a]) * cell.edges[a] * block.spacing;
  return lengths;
}

LatticeBlock centred(LatticeBlock block, Box const& box) {
  block.origin = {0, 0, 0};
  auto const places = lattice_sites(block, box.dimension());
  if (places.empty()) return block;
  for (int a = 0; a < box.dimension(); ++a) {
    auto const [low, high] =
        std::minmax_element(places.begin(), places.end(), [a](Place const& p, Place const& q) { return p[a] < q[a]; });
    block.origin[a] = box.low(a) + 0.5 * (box.length(a) - (*high)[a] - (*low)[a]);
  }
  return block;
}

double spacing_for_density(Lattice kind, int dimension, double number_density) {
  if (!(number_density > 0) || !std::isfinite(number_density))
    throw Error(fmt::format("lattice: the number density must be positive, not {}", number_density));
  Cell const cell = cell_of(kind, dimension);
  double volume = 1;
  for (int a = 0; a < dimension; ++a) volume *= cell.edges[a];
  return std::pow(static_cast<double>(cell.sites.size()) / (volume * number_density), 1.0 / dimension);
}

double spacing_for_constant(Lattice kind, int dimension, double lattice_constant) {
  return lattice_constant / cell_of(kind, dimension).edges[0];
}

namespace {

/// The number of cells along each axis.
std::array<double, 3> cells_of(Filling const& filling, int dimension) {
  check(LatticeBlock{filling.kind, filling.spacing, {1, 1, 1}, filling.low}, dimension);
  Cell const cell = cell_of(filling.kind, dimension);
  std::array<double, 3> cells{1, 1, 1};
  for (int a = 0; a < dimension; ++a) {
    double const length = filling.high[a] - filling.low[a];
    if (!(length > 0) || !std::isfinite(length))
      throw Error(fmt::format("lattice: a block from {} to {} can't be filled", filling.low[a], filling.high[a]));
    double const wanted = length / (cell.edges[a] * filling.spacing);
    bool const pairs = filling.kind == Lattice::triangular && a == 1;
    cells[a] = pairs ? 2 * std::max(1.0, std::round(wanted / 2)) : std::max(1.0, std::round(wanted));
  }
  return cells;
}

/// For cells with several sites, the outermost are equally far from both ends.
void fill_cells(Filling const& filling, Cell const& cell, std::array<double, 3> const& cells,
                std::vector<Place>& places) {
  Place furthest{0, 0, 0};  // of the sites of a cell, relative to its edges
  for (Place const& site : cell.sites)
    for (std::size_t a = 0; a < 3; ++a) furthest[a] = std::max(furthest[a], site[a] / cell.edges[a]);
  for (double z = 0; z < cells[2]; ++z)
    for (double y = 0; y < cells[1]; ++y)
      for (double x = 0; x < cells[0]; ++x)
        for (Place const& site : cell.sites) {
          Place const number{x, y, z};
          Place place{0, 0, 0};
          for (std::size_t a = 0; a < 3; ++a)
            place[a] = filling.low[a] + (filling.high[a] - filling.low[a]) / cells[a] *
                                            (number[a] + site[a] / cell.edges[a] + 0.5 * (1 - furthest[a]));
          places.push_back(place);
        }
}

}  // namespace

std::size_t filling_count(Filling const& filling, int dimension) {
  auto const cells = cells_of(filling, dimension);
  double const count =
      cells[0] * cells[1] * cells[2] * static_cast<double>(cell_of(filling.kind, dimension).sites.size());
  if (count > std::numeric_limits<std::uint32_t>::max())
    throw Error(fmt::format("lattice: a block of {:.0f} cells has too many sites", count));
  return static_cast<std::size_t>(count);
}

std::vector<Place> filling_sites(Filling const& filling, int dimension) {
  std::size_t const count = filling_count(filling, dimension);
  auto const cells = cells_of(filling, dimension);
  bool const shifted = filling.kind == Lattice::triangular;
  Cell const cell = cell_of(filling.kind, dimension);
  std::vector<Place> places;
  places.reserve(count);
  if (cell.sites.size() > 1) {
    fill_cells(filling, cell, cells, places);
    return places;
  }
  for (std::size_t k = 0; k < count; ++k) {
    auto const x = static_cast<std::size_t>(cells[0]), y = static_cast<std::size_t>(cells[1]);
    std::array<std::size_t, 3> const number{k % x, k / x % y, k / x / y};
    Place place{0, 0, 0};
    for (int a = 0; a < dimension; ++a) {
      double const middle = shifted && a == 0 ? (number[1] % 2 == 0 ? 0.25 : 0.75) : 0.5;
      double const part = (static_cast<double>(number[a]) + middle) / cells[a];
      place[a] = filling.low[a] + part * (filling.high[a] - filling.low[a]);
    }
    places.push_back(place);
  }
  return places;
}

double site_volume(Filling const& filling, int dimension) {
  auto const cells = cells_of(filling, dimension);
  double volume = 1;
  for (int a = 0; a < dimension; ++a) volume *= (filling.high[a] - filling.low[a]) / cells[a];
  return volume / static_cast<double>(cell_of(filling.kind, dimension).sites.size());
}

double spacing_for_number(Filling filling, int dimension, std::size_t number) {
  double volume = 1;
  for (int a = 0; a < dimension; ++a) volume *= filling.high[a] - filling.low[a];
  double const even = spacing_for_density(filling.kind, dimension, static_cast<double>(number) / volume);
  if (dimension == 1) return even;  // any number is possible
  Cell const cell = cell_of(filling.kind, dimension);
  // The numbers of cells are constant between two of these.
  double const from = even / 1.5, to = even * 1.5;
  std::vector<double> changes{from, to};
  for (int a = 0; a < dimension; ++a)
    for (double half = 0.5; true; half += 0.5) {
      double const change = (filling.high[a] - filling.low[a]) / (cell.edges[a] * half);
      if (change < from) break;
      if (change < to) changes.push_back(change);
    }
  std::sort(changes.begin(), changes.end());
  double best = 0;
  std::size_t below = 0, above = 0;
  for (std::size_t k = 0; k + 1 < changes.size(); ++k) {
    filling.spacing = 0.5 * (changes[k] + changes[k + 1]);
    std::size_t const count = filling_count(filling, dimension);
    if (count == number && std::abs(filling.spacing - even) < std::abs(best - even)) best = filling.spacing;
    if (count < number) below = std::max(below, count);
    if (count > number) above = above == 0 ? count : std::min(above, count);
  }
  if (best > 0) return best;
  throw Error(fmt::format("lattice: no number of {} cells that fills this block has {} sites; {} or {} would do",
                          to_string(filling.kind), number, below, above));
}

namespace {

/// An ensemble without particles gets one for each site.
void place_on(std::vector<Place> const& places, double spacing, AnyEnsemble& ensemble, std::string const& of_what) {
  if (ensemble.size() == 0) ensemble.resize(places.size());
  if (ensemble.size() != places.size())
    throw Error(fmt::format("ensemble '{}' has {} particles, the {} has {} sites", ensemble.name(), ensemble.size(),
                            of_what, places.size()));
  if (ensemble.appearance.diameter == 0) ensemble.appearance.diameter = spacing;
  for (std::size_t k = 0; k < places.size(); ++k) std::copy_n(places[k].data(), ensemble.dimension(), ensemble.row(k));
}

}  // namespace

std::size_t block_load(AnyEnsemble& ensemble, LatticeBlock const& block) {
  place_on(lattice_sites(block, ensemble.dimension()), block.spacing, ensemble,
           fmt::format("{} lattice of {} cells", to_string(block.kind),
                       fmt::join(std::span(block.counts).first(ensemble.dimension()), " x ")));
  return ensemble.size();
}

std::size_t fill_load(AnyEnsemble& ensemble, Filling const& filling) {
  for (auto const& [what, value] : {std::pair("density", filling.density), {"range", filling.range}})
    if (!(value >= 0) || !std::isfinite(value))
      throw Error(fmt::format("a {} must be a number, zero or more; it is {}", what, value));
  place_on(filling_sites(filling, ensemble.dimension()), filling.spacing, ensemble,
           fmt::format("{} lattice that fills the block", to_string(filling.kind)));
  if (filling.density > 0) set_field(ensemble, "mass", filling.density * site_volume(filling, ensemble.dimension()));
  if (filling.range > 0) set_field(ensemble, "range", filling.range);
  return ensemble.size();
}

std::size_t fill_load(AnyEnsemble& ensemble, Box const& box, Filling filling) {
  for (int a = 0; a < box.dimension(); ++a) filling.low[a] = box.low(a), filling.high[a] = box.high(a);
  return fill_load(ensemble, filling);
}

}  // namespace boltzmann
