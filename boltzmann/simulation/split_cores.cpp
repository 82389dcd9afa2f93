// Splits wide cores into narrower ones with the same moments, and merges.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/vector.hpp>
#include <boltzmann/simulation/split_cores.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

namespace boltzmann {
namespace {

constexpr double alike = 0.99;  // the least cosine of the angle between vortices that merge

/// Offsets of fields of vortices in a row.
struct Places {
  int dimension, vorticity, components, core, volume;

  explicit Places(AnyEnsemble const& ensemble) : dimension(ensemble.dimension()) {
    for (char const* name : {"vorticity", "core"})
      if (!ensemble.find_field(name))
        throw Error(fmt::format("split_cores: '{}' is of class {}, which has no {}; vortices are split",
                                ensemble.name(), ensemble.class_name(), name));
    vorticity = ensemble.field("vorticity").offset;
    components = ensemble.field("vorticity").components;
    core = ensemble.field("core").offset;
    Field const* const field = ensemble.find_field("volume");
    volume = field ? field->offset : -1;
  }
  Vector<3> vorticity_of(double const* row) const {
    Vector<3> all{};
    for (int k = 0; k < components; ++k) all[k] = row[vorticity + k];
    return all;
  }
};

std::size_t split_wide(AnyEnsemble& ensemble, Places const& at, CoreSplitting const& splitting) {
  int const dimension = at.dimension, children = 2 * dimension;
  std::size_t const before = ensemble.size(), doubles = ensemble.doubles();
  std::vector<std::size_t> wide;
  for (std::size_t i = 0; i < before; ++i) {
    double const core = ensemble.row(i)[at.core];
    if (!std::isfinite(core))
      throw PhysicsFailure(
          fmt::format("split_cores: the core of particle {} of '{}' is not finite", i, ensemble.name()));
    if (core > splitting.above) wide.push_back(i);
  }
  ensemble.resize(before + wide.size() * static_cast<std::size_t>(children - 1));
  std::size_t next = before;
  std::vector<double> old(doubles);
  for (std::size_t const i : wide) {
    std::copy_n(ensemble.row(i), doubles, old.begin());
    double const core = old[static_cast<std::size_t>(at.core)],
                 away = core * std::sqrt(dimension * (1 - splitting.ratio * splitting.ratio));
    // Successive crosses are rotated, so that they leave no pattern.
    double const turned = 2 * pi * std::fmod(0.6180339887498949 * static_cast<double>(i + 1), 1.0);
    for (int child = 0; child < children; ++child) {
      double* const row = ensemble.row(child == 0 ? i : next++);
      std::copy(old.begin(), old.end(), row);
      double const sign = child % 2 == 0 ? 1 : -1;
      std::array<double, 3> offset{};
      if (child < 2)
        offset = {std::cos(turned), std::sin(turned), 0};
      else if (child < 4)
        offset = {-std::sin(turned), std::cos(turned), 0};
      else
        offset = {0, 0, 1};
      for (int a = 0; a < dimension; ++a) row[a] += sign * away * offset[static_cast<std::size_t>(a)];
      for (int k = 0; k < at.components; ++k) row[at.vorticity + k] /= children;
      row[at.core] = splitting.ratio * core;
      if (at.volume >= 0) row[at.volume] /= children;
    }
  }
  if (!wide.empty()) ensemble.clear_influence();
  return wide.size();
}

/// Particles sorted into cells, to search near ones.
class ByCell {
 public:
  ByCell(AnyEnsemble const& ensemble, int dimension, double size) : dimension_(dimension), size_(size) {
    for (std::size_t i = 0; i < ensemble.size(); ++i) cells_[cell(ensemble.row(i))].push_back(i);
  }
  template <class F>
  void each_near(double const* x, F const& f) const {
    Cell const middle = cell(x);
    Cell c{};
    int const m[3] = {1, dimension_ > 1 ? 1 : 0, dimension_ > 2 ? 1 : 0};
    for (int k = -m[2]; k <= m[2]; ++k)
      for (int j = -m[1]; j <= m[1]; ++j)
        for (int i = -m[0]; i <= m[0]; ++i) {
          c = {middle[0] + i, middle[1] + j, middle[2] + k};
          if (auto const found = cells_.find(c); found != cells_.end())
            for (std::size_t const particle : found->second) f(particle);
        }
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell(double const* x) const {
    Cell c{};
    for (int a = 0; a < dimension_; ++a) c[static_cast<std::size_t>(a)] = std::llround(std::floor(x[a] / size_));
    return c;
  }
  int dimension_;
  double size_;
  std::map<Cell, std::vector<std::size_t>> cells_;
};

std::size_t merge_near(AnyEnsemble& ensemble, Places const& at, CoreSplitting const& splitting) {
  int const dimension = at.dimension;
  double widest = 0;
  for (std::size_t i = 0; i < ensemble.size(); ++i) widest = std::max(widest, ensemble.row(i)[at.core]);
  if (!(splitting.merge_within > 0 && widest > 0)) return 0;
  ByCell const cells(ensemble, dimension, splitting.merge_within * widest);
  struct Pair {
    double distance2;
    std::size_t i, j;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    double const* const p = ensemble.row(i);
    cells.each_near(p, [&](std::size_t j) {
      if (j <= i) return;
      double const* const q = ensemble.row(j);
      double distance2 = 0;
      for (int a = 0; a < dimension; ++a) distance2 += square(p[a] - q[a]);
      if (distance2 < square(splitting.merge_within * std::min(p[at.core], q[at.core])))
        pairs.push_back({distance2, i, j});
    });
  }
  std::sort(pairs.begin(), pairs.end(), [](Pair const& a, Pair const& b) {
    return std::tie(a.distance2, a.i, a.j) < std::tie(b.distance2, b.i, b.j);
  });
  std::vector<char> taken(ensemble.size(), 0), gone(ensemble.size(), 0);
  std::size_t merges = 0;
  for (auto const& [distance2, i, j] : pairs) {
    if (taken[i] || taken[j]) continue;
    double* const p = ensemble.row(i);
    double const* const q = ensemble.row(j);
    Vector<3> const one = at.vorticity_of(p), other = at.vorticity_of(q);
    double const of_one = magnitude(one), of_other = magnitude(other), sum = of_one + of_other;
    if (!(sum > 0) || dot(one, other) < alike * of_one * of_other) continue;
    double const part = of_other / sum;
    double const core2 =
        (1 - part) * square(p[at.core]) + part * square(q[at.core]) + part * (1 - part) * distance2 / dimension;
    if (core2 > square(splitting.above)) continue;
    for (int a = 0; a < dimension; ++a) p[a] += part * (q[a] - p[a]);
    for (int k = 0; k < at.components; ++k) p[at.vorticity + k] += q[at.vorticity + k];
    p[at.core] = std::sqrt(core2);
    if (at.volume >= 0) p[at.volume] += q[at.volume];
    taken[i] = taken[j] = gone[j] = 1;
    ++merges;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    if (gone[i]) continue;
    if (kept != i) std::copy_n(ensemble.row(i), ensemble.doubles(), ensemble.row(kept));
    ++kept;
  }
  ensemble.resize(kept);
  if (merges > 0) ensemble.clear_influence();
  return merges;
}

}  // namespace

void CoreSplitting::check() const {
  auto const wrong = [](char const* key, double value, char const* what) {
    return Error(fmt::format("split_cores: {} = {} must be {}", key, value, what));
  };
  if (!(above > 0 && std::isfinite(above))) throw wrong("above", above, "a positive length");
  if (!(ratio >= 0.5 && ratio <= 0.95)) throw wrong("ratio", ratio, "between 0.5 and 0.95");
  if (!(merge_within >= 0 && merge_within <= 1)) throw wrong("merge_within", merge_within, "between 0 and 1");
}

CoresSplit split_cores(AnyEnsemble& ensemble, CoreSplitting const& splitting) {
  splitting.check();
  Places const places(ensemble);
  CoresSplit done;
  done.splits = split_wide(ensemble, places, splitting);
  done.merges = merge_near(ensemble, places, splitting);
  return done;
}

CoreSplitter::CoreSplitter(AnyEnsemble& ensemble, Box const& box, CoreSplitting const& splitting)
    : ensemble_(&ensemble), splitting_(splitting) {
  splitting.check();
  for (int a = 0; a < box.dimension(); ++a)
    if (box.boundary(a) != Boundary::open && !box.periodic(a))
      throw Error(
          fmt::format("split_cores: axis {} is {}: of a split some might be beyond its ends; it needs open or "
                      "periodic axes",
                      "xyz"[a], to_string(box.boundary(a))));
  if (!box.regions().empty())
    throw Error("split_cores: of a split some might be in a region of the box; leave these out");
  Places const places(ensemble);
}

void CoreSplitter::change() {
  CoresSplit const now = split_cores(*ensemble_, splitting_);
  done_.splits += now.splits;
  done_.merges += now.merges;
}

std::string CoreSplitter::report(UnitSystem const&) const {
  return fmt::format("'{}': {} split{}, {} merger{}, {} vortices now", ensemble_->name(), done_.splits,
                     done_.splits == 1 ? "" : "s", done_.merges, done_.merges == 1 ? "" : "s", ensemble_->size());
}

std::vector<double> CoreSplitter::state() const {
  return {static_cast<double>(done_.splits), static_cast<double>(done_.merges)};
}

void CoreSplitter::restore(std::span<double const> state) {
  if (state.size() != 2) throw Error("the checkpoint does not fit this simulation: it has no splitting of cores");
  done_ = {static_cast<std::size_t>(state[0]), static_cast<std::size_t>(state[1])};
}

OptionTable const& core_splitting_options() {
  using namespace option;
  static OptionTable const all = [] {
    using S = CoreSplittingOptions;
    OptionTable table;
    table.add("every", &S::every, whole(1, std::numeric_limits<double>::infinity()), "steps between splittings");
    table.add_said("on", ensembles(), "ensembles to split, each by itself", "all of class `Spreading`");
    table.add("above", &S::how, &CoreSplitting::above, number(dimensions::length, positive),
              "widest core; wider ones are split into 4 in 2D, 6 in 3D");
    table.add("ratio", &S::how, &CoreSplitting::ratio, number(dimensions::none, {0.5, 0.95, false}),
              "core of the new vortices, relative to the old one");
    table.add("merge_within", &S::how, &CoreSplitting::merge_within, number(dimensions::none, {0, 1, false}),
              "merge two vortices of like direction nearer than this part of the narrower core, if the result is not "
              "wider than `above`; 0: no merges");
    table.at("every").needed = std::string("5");
    table.at("above").needed = "0.1";
    return table;
  }();
  return all;
}

}  // namespace boltzmann
