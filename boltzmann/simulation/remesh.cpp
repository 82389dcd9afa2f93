// Deposits vortices on a lattice: dense arrays over all reachable nodes, filled in the order of the particles.
#include <boltzmann/core/error.hpp>
#include <boltzmann/simulation/remesh.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace boltzmann {
namespace {

constexpr std::uint32_t no_particle = std::numeric_limits<std::uint32_t>::max();
constexpr double max_nodes = 4e7;
constexpr double fit = 1e-6;  // tolerance of the periodicity of a lattice along a periodic axis

using Node = std::array<std::int64_t, 3>;

/// The node at or below a point, and the distance above it in spacings.
struct Below {
  Node node{};
  std::array<double, 3> fraction{};
};

/// The positions of nodes along an axis: unlimited, or one period.
class Nodes {
 public:
  Nodes(Box const& box, double spacing) : box_(box) {
    for (int a = 0; a < box.dimension(); ++a) {
      spacing_[a] = spacing;
      if (!box.periodic(a)) continue;
      period_[a] = std::max<std::int64_t>(1, std::llround(box.length(a) / spacing));
      spacing_[a] = box.length(a) / static_cast<double>(period_[a]);
      if (std::abs(spacing_[a] / spacing - 1) <= fit) continue;
      auto const fewer = static_cast<double>(std::max<std::int64_t>(1, std::floor(box.length(a) / spacing)));
      throw Error(
          fmt::format("remesh: the spacing {} does not divide the periodic axis {} of {}; the nearest that do are "
                      "{} and {}",
                      spacing, "xyz"[a], box.length(a), box.length(a) / (fewer + 1), box.length(a) / fewer));
    }
  }
  bool periodic(int axis) const { return period_[axis] > 0; }
  std::int64_t period(int axis) const { return period_[axis]; }
  double volume() const {
    double product = 1;
    for (int a = 0; a < box_.dimension(); ++a) product *= spacing_[a];
    return product;
  }
  double place(std::int64_t node, int axis) const {
    return box_.low(axis) + (static_cast<double>(node) + 0.5) * spacing_[axis];
  }
  Below below(double const* x) const {
    Below below;
    for (int a = 0; a < box_.dimension(); ++a) {
      double const at = (x[a] - box_.low(a)) / spacing_[a] - 0.5, whole = std::floor(at);
      if (!(std::abs(whole) < 1e15)) throw Error("a place is too far away, or no number");
      below.node[a] = static_cast<std::int64_t>(whole);
      below.fraction[a] = at - whole;
    }
    return below;
  }
  /// True if the limits of the box allow a node there.
  bool inside(std::array<double, 3> const& x) const {
    for (int a = 0; a < box_.dimension(); ++a) {
      if (box_.boundary(a) == Boundary::open || periodic(a)) continue;
      if ((box_.walled(a, Box::End::low) && x[a] < box_.low(a)) ||
          (box_.walled(a, Box::End::high) && x[a] > box_.high(a)))
        return false;
    }
    return std::all_of(box_.regions().begin(), box_.regions().end(), [&](Region const& region) {
      bool within = true;
      for (int a = 0; a < box_.dimension(); ++a) within = within && x[a] > region.low[a] && x[a] < region.high[a];
      return within == (region.side == Region::Side::keep_in);
    });
  }

 private:
  Box const& box_;
  std::array<double, 3> spacing_{1, 1, 1};
  std::array<std::int64_t, 3> period_{};
};

/// The nodes of one particle: `count` along each axis from `first` on, with their weights.
struct Shares {
  Node first{};
  int count = 1;
  std::array<std::array<double, 6>, 3> weight{{{1}, {1}, {1}}};
};

/// Quadratic interpolation on three nodes; the first is `from` spacings from the point.
std::array<double, 6> quadratic_weights(double from) {
  double const x = -from - 1;  // from the middle one
  return {0.5 * x * (x - 1), 1 - x * x, 0.5 * x * (x + 1)};
}

class Mesh {
 public:
  Mesh(AnyEnsemble& ensemble, Box const& box, Remeshing const& how)
      : ensemble_(ensemble),
        how_(how),
        dimension_(box.dimension()),
        components_(ensemble.field("vorticity").components),
        vorticity_(ensemble.field("vorticity").offset),
        nodes_(box, how.spacing),
        limited_(how.allowed || !box.regions().empty()) {
    for (int a = 0; a < dimension_; ++a) limited_ = limited_ || !(box.boundary(a) == Boundary::open || box.periodic(a));
    find_range();
  }

  Remeshed run() {
    std::vector<std::uint32_t> const left = deposit();
    double const core = how_.core > 0 ? how_.core : 1.5 * how_.spacing;
    Remeshed done = choose();
    replace(left, core);
    done.left_as_they_are = left.size();
    return done;
  }

 private:
  /// Finds the block of nodes that particles can reach, with its margin.
  void find_range() {
    std::array<double, 6> none{};
    reach_ = remesh_weights(how_.kernel, 0, none);
    int const more = std::max(limited_ ? 4 : 0, reach_) + how_.margin;
    Node low{}, high{};
    for (int a = 0; a < dimension_; ++a) {
      low[a] = std::numeric_limits<std::int64_t>::max();
      high[a] = std::numeric_limits<std::int64_t>::min();
    }
    for (std::size_t i = 0; i < ensemble_.size(); ++i) {
      Node const node = below(i).node;
      for (int a = 0; a < dimension_; ++a) low[a] = std::min(low[a], node[a]), high[a] = std::max(high[a], node[a]);
    }
    double total = 1;
    for (int a = 0; a < dimension_; ++a) {
      if (nodes_.periodic(a))
        low[a] = 0, high[a] = nodes_.period(a) - 1;
      else
        low[a] -= more, high[a] += more;
      counts_[a] = high[a] - low[a] + 1;
      total *= static_cast<double>(counts_[a]);
    }
    if (total > max_nodes)
      throw Error(
          fmt::format("remesh: the vortices of '{}' are spread over {:.3g} nodes of spacing {}, more than {:.3g}; "
                      "take a wider spacing, or remove some that are far away",
                      ensemble_.name(), total, how_.spacing, max_nodes));
    low_ = low;
    auto const size = static_cast<std::size_t>(total);
    strength_.assign(size * static_cast<std::size_t>(components_), 0.0);
    most_.assign(size, 0.0F);
    giver_.assign(size, no_particle);
    if (limited_) state_.assign(size, 0);
  }

  Below below(std::size_t i) const {
    double const* const row = ensemble_.row(i);
    for (int k = 0; k < components_; ++k)
      if (!std::isfinite(row[vorticity_ + k]))
        throw PhysicsFailure(
            fmt::format("remesh: the vorticity of particle {} of '{}' is not finite", i, ensemble_.name()));
    try {
      return nodes_.below(row);
    } catch (Error const& error) {
      throw PhysicsFailure(fmt::format("remesh: particle {} of '{}': {}", i, ensemble_.name(), error.what()));
    }
  }

  /// The index of a node in the arrays.
  std::size_t at(Node node) const {
    std::size_t number = 0;
    for (int a = dimension_ - 1; a >= 0; --a) {
      std::int64_t n = node[a] - low_[a];
      if (nodes_.periodic(a)) n = ((n % counts_[a]) + counts_[a]) % counts_[a];
      number = number * static_cast<std::size_t>(counts_[a]) + static_cast<std::size_t>(n);
    }
    return number;
  }
  std::array<double, 3> place(std::size_t number) const {
    std::array<double, 3> x{};
    for (int a = 0; a < dimension_; ++a) {
      auto const count = static_cast<std::size_t>(counts_[a]);
      x[a] = nodes_.place(low_[a] + static_cast<std::int64_t>(number % count), a);
      number /= count;
    }
    return x;
  }
  bool allowed(std::size_t number) {
    if (!limited_) return true;
    if (state_[number] == 0) {
      auto const x = place(number);
      state_[number] = nodes_.inside(x) && (!how_.allowed || how_.allowed(x)) ? 1 : 2;
    }
    return state_[number] == 1;
  }

  /// Calls f(index, weight) for each of these nodes, x fastest.
  template <class F>
  void each(Shares const& shares, F const& f) const {
    int const n = shares.count, ny = dimension_ > 1 ? n : 1, nz = dimension_ > 2 ? n : 1;
    for (int k = 0; k < nz; ++k)
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < n; ++i) {
          double weight = shares.weight[0][static_cast<std::size_t>(i)];
          if (dimension_ > 1) weight *= shares.weight[1][static_cast<std::size_t>(j)];
          if (dimension_ > 2) weight *= shares.weight[2][static_cast<std::size_t>(k)];
          f(at({shares.first[0] + i, shares.first[1] + j, shares.first[2] + k}), weight);
        }
  }
  bool all_allowed(Shares const& shares) {
    if (!limited_) return true;
    bool all = true;
    each(shares, [&](std::size_t number, double weight) { all = all && (weight == 0 || allowed(number)); });
    return all;
  }

  Shares by_kernel(Below const& below) const {
    Shares shares;
    shares.count = 2 * reach_;
    for (int a = 0; a < dimension_; ++a) {
      remesh_weights(how_.kernel, below.fraction[a], shares.weight[static_cast<std::size_t>(a)]);
      shares.first[a] = below.node[a] + 1 - reach_;
    }
    return shares;
  }
  /// Finds the nearest block of allowed nodes; false if there is none nearby.
  bool find_block(Below const& below, Shares& shares) {
    struct Block {
      Node shift;
      double distance;
    };
    std::vector<Block> blocks;
    int const most = 3, my = dimension_ > 1 ? most : 0, mz = dimension_ > 2 ? most : 0;
    for (int k = -mz; k <= mz; ++k)
      for (int j = -my; j <= my; ++j)
        for (int i = -most; i <= most; ++i) {
          Block block{{i, j, k}, 0};
          for (int a = 0; a < dimension_; ++a)
            block.distance += square(static_cast<double>(block.shift[a]) - below.fraction[a]);
          blocks.push_back(block);
        }
    std::stable_sort(blocks.begin(), blocks.end(),
                     [](Block const& a, Block const& b) { return a.distance < b.distance; });
    for (Block const& block : blocks) {
      shares.count = 3;
      for (int a = 0; a < dimension_; ++a) {
        shares.first[a] = below.node[a] + block.shift[a] - 1;
        shares.weight[static_cast<std::size_t>(a)] =
            quadratic_weights(static_cast<double>(block.shift[a]) - 1 - below.fraction[a]);
      }
      if (all_allowed(shares)) return true;
    }
    return false;
  }

  /// Deposits all vorticity on nodes; returns the particles for which there is no place.
  std::vector<std::uint32_t> deposit() {
    std::vector<std::uint32_t> left;
    for (std::size_t i = 0; i < ensemble_.size(); ++i) {
      Below const from = below(i);
      Shares shares = by_kernel(from);
      auto const particle = static_cast<std::uint32_t>(i);
      if (!all_allowed(shares) && !find_block(from, shares)) {
        left.push_back(particle);
        continue;
      }
      double const* const vorticity = ensemble_.row(i) + vorticity_;
      each(shares, [&](std::size_t number, double weight) {
        if (weight == 0) return;
        for (int k = 0; k < components_; ++k)
          strength_[number * static_cast<std::size_t>(components_) + static_cast<std::size_t>(k)] +=
              weight * vorticity[k];
        auto const size = static_cast<float>(std::abs(weight));
        if (giver_[number] != no_particle && size <= most_[number]) return;
        most_[number] = size;
        giver_[number] = particle;
      });
    }
    return left;
  }

  double magnitude_at(std::size_t number) const {
    double square = 0;
    for (int k = 0; k < components_; ++k) {
      double const x = strength_[number * static_cast<std::size_t>(components_) + static_cast<std::size_t>(k)];
      square += x * x;
    }
    return std::sqrt(square);
  }

  /// Selects in chosen_ the nodes that become particles.
  Remeshed choose() {
    std::size_t const size = giver_.size();
    double greatest = 0, total = 0;
    for (std::size_t n = 0; n < size; ++n) {
      double const here = magnitude_at(n);
      greatest = std::max(greatest, here), total += here;
    }
    chosen_.assign(size, 0);
    for (std::size_t n = 0; n < size; ++n) {
      double const here = magnitude_at(n);
      chosen_[n] = here > 0 && here >= how_.threshold * greatest;
    }
    for (int layer = 0; layer < how_.margin; ++layer)
      for (int a = 0; a < dimension_; ++a) widen(a);
    struct Weak {
      double magnitude;
      std::size_t number;
    };
    std::vector<Weak> weak;
    for (std::size_t n = 0; n < size; ++n)
      if (double const here = magnitude_at(n); !chosen_[n] && here > 0) weak.push_back({here, n});
    std::stable_sort(weak.begin(), weak.end(), [](Weak const& a, Weak const& b) { return a.magnitude < b.magnitude; });
    Remeshed done;
    for (Weak const& one : weak) {
      if (done.magnitudes_lost + one.magnitude > how_.max_loss * total) {
        chosen_[one.number] = 1;
        continue;
      }
      done.magnitudes_lost += one.magnitude;
      ++done.removed;
      Vector<3> strength{}, at{};
      for (int k = 0; k < components_; ++k)
        strength[components_ == 1 ? 2 : k] =
            strength_[one.number * static_cast<std::size_t>(components_) + static_cast<std::size_t>(k)];
      auto const x = place(one.number);
      for (int a = 0; a < dimension_; ++a) at[a] = x[static_cast<std::size_t>(a)];
      done.vorticity_lost += strength;
      done.impulse_lost += cross(at, strength) * (dimension_ == 2 ? 1 : 0.5);
    }
    return done;
  }

  /// Adds one layer along an axis around the chosen nodes. Nodes without contributions get their other fields from the
  /// neighbour.
  void widen(int axis) {
    std::vector<char> const before = chosen_;
    std::size_t stride = 1;
    for (int a = 0; a < axis; ++a) stride *= static_cast<std::size_t>(counts_[a]);
    auto const count = static_cast<std::size_t>(counts_[axis]);
    for (std::size_t n = 0; n < before.size(); ++n) {
      if (before[n]) continue;
      std::size_t const here = n / stride % count;
      auto const neighbour = [&](bool up) {
        if (up ? here + 1 < count : here > 0) return up ? n + stride : n - stride;
        if (!nodes_.periodic(axis)) return n;
        return up ? n - here * stride : n + (count - 1 - here) * stride;
      };
      for (std::size_t const next : {neighbour(false), neighbour(true)}) {
        if (!before[next] || !allowed(n)) continue;
        chosen_[n] = 1;
        if (giver_[n] == no_particle) giver_[n] = giver_[next];
        break;
      }
    }
  }

  void replace(std::vector<std::uint32_t> const& left, double core) {
    auto const doubles = ensemble_.doubles();
    auto const position = static_cast<std::size_t>(ensemble_.field("position").offset),
               core_at = static_cast<std::size_t>(ensemble_.field("core").offset);
    Field const* const volume = ensemble_.find_field("volume");
    auto const count = static_cast<std::size_t>(std::count(chosen_.begin(), chosen_.end(), 1));
    std::vector<double> rows((count + left.size()) * doubles);
    double* row = rows.data();
    for (std::size_t n = 0; n < chosen_.size(); ++n) {
      if (!chosen_[n]) continue;
      std::copy_n(ensemble_.row(giver_[n]), doubles, row);
      auto const x = place(n);
      for (int a = 0; a < dimension_; ++a) row[position + static_cast<std::size_t>(a)] = x[a];
      std::copy_n(&strength_[n * static_cast<std::size_t>(components_)], components_, row + vorticity_);
      row[core_at] = core;
      if (volume) row[volume->offset] = nodes_.volume();
      row += doubles;
    }
    for (std::uint32_t const i : left) {
      std::copy_n(ensemble_.row(i), doubles, row);
      row += doubles;
    }
    ensemble_.resize(count + left.size());
    for (std::size_t i = 0; i < ensemble_.size(); ++i)
      std::copy_n(rows.data() + i * doubles, doubles, ensemble_.row(i));
    ensemble_.clear_influence();
  }

  AnyEnsemble& ensemble_;
  Remeshing const& how_;
  int dimension_, components_, vorticity_, reach_ = 2;
  Nodes nodes_;
  bool limited_;
  Node low_{};
  std::array<std::int64_t, 3> counts_{1, 1, 1};
  std::vector<double> strength_;
  std::vector<float> most_;           // the largest contribution of one particle,
  std::vector<std::uint32_t> giver_;  // and that particle
  std::vector<char> state_;           // 1: allowed, 2: not, 0: not yet determined
  std::vector<char> chosen_;
};

}  // namespace

Words<RemeshKernel> const& remesh_kernel_words() {
  static Words<RemeshKernel> const words{
      "kernel",
      {{RemeshKernel::m4, "m4", "M4' of Monaghan: 4 nodes an axis, keeps the moments 0 to 2"},
       {RemeshKernel::m6, "m6", "M6* of Bergdorf and Koumoutsakos: 6 nodes an axis, keeps the moments 0 to 4"}}};
  return words;
}

int remesh_weights(RemeshKernel kernel, double fraction, std::array<double, 6>& weights) {
  double const f = fraction, g = 1 - fraction;
  if (kernel == RemeshKernel::m4) {
    auto const near = [](double x) { return 1 - x * x * (2.5 - 1.5 * x); };
    auto const far = [](double x) { return -0.5 * x * (1 - x) * (1 - x); };  // at 1 + x
    weights = {far(f), near(f), near(g), far(g), 0, 0};
    return 2;
  }
  auto const first = [](double x) { return 1 - x * x * (1.25 + x * (35.0 / 12 - x * (5.25 - x * (25.0 / 12)))); };
  auto const second = [](double x) {  // at 1 + x
    return x * (x - 1) * (16 + x * (x * (25 * x - 39))) / 24;
  };
  auto const third = [](double x) {  // at 2 + x
    double const y = x - 1;
    return -x * y * y * y * (5 * x + 2) / 24;
  };
  weights = {third(f), second(f), first(f), first(g), second(g), third(g)};
  return 3;
}

void Remeshing::check() const {
  auto const wrong = [](char const* key, double value, char const* what) {
    return Error(fmt::format("remesh: {} = {} must be {}", key, value, what));
  };
  if (!(spacing > 0 && std::isfinite(spacing))) throw wrong("spacing", spacing, "a positive length");
  if (!(core >= 0 && std::isfinite(core))) throw wrong("core", core, "a length, zero or more");
  if (!(threshold >= 0 && threshold < 1)) throw wrong("threshold", threshold, "at least 0 and below 1");
  if (!(max_loss >= 0 && max_loss < 1)) throw wrong("max_loss", max_loss, "at least 0 and below 1");
  if (margin < 0 || margin > 100) throw wrong("margin", margin, "between 0 and 100");
}

void check(AnyEnsemble const& ensemble, Box const& box, Remeshing const& remeshing) {
  remeshing.check();
  for (char const* name : {"vorticity", "core"})
    if (!ensemble.find_field(name))
      throw Error(fmt::format("remesh: '{}' is of class {}, which has no {}; vortices are remeshed", ensemble.name(),
                              ensemble.class_name(), name));
  Nodes const nodes(box, remeshing.spacing);
}

Remeshed remesh(AnyEnsemble& ensemble, Box const& box, Remeshing const& remeshing) {
  check(ensemble, box, remeshing);
  if (ensemble.size() == 0) return {};
  return Mesh(ensemble, box, remeshing).run();
}

OptionTable const& remesh_options() {
  using namespace option;
  static OptionTable const all = [] {
    using R = RemeshOptions;
    OptionTable table;
    table.add("every", &R::every, whole(1, std::numeric_limits<double>::infinity()), "steps between remeshings");
    table.add_said("on", ensembles(), "ensembles to remesh, each by itself", "all with vorticity");
    table.add("spacing", &R::how, &Remeshing::spacing, number(dimensions::length, positive),
              "spacing of the nodes, at the places of the loader `fill`; must divide periodic axes");
    table.add("kernel", &R::how, &Remeshing::kernel, remesh_kernel_words(),
              "kernel: `\"m4\"`: M4' of Monaghan, 4 nodes an axis, keeps the moments 0 to 2; `\"m6\"`: M6* of Bergdorf "
              "and Koumoutsakos, 6 nodes, moments 0 to 4");
    table.add("core", &R::how, &Remeshing::core, number(dimensions::length, not_negative), "core of the new vortices",
              "1.5 spacings");
    table.add("threshold", &R::how, &Remeshing::threshold, number(dimensions::none, {0, 1, false}),
              "weak nodes, below this part of the largest vorticity, are removed");
    table.add("max_loss", &R::how, &Remeshing::max_loss, number(dimensions::none, {0, 1, false}),
              "largest part of the total magnitude that may be removed at a time");
    table.add("margin", &R::how, &Remeshing::margin, whole(0, 100),
              "layers of nodes kept around strong ones, into which vorticity can spread");
    table.at("every").needed = "10";
    table.at("spacing").needed = "0.05";
    return table;
  }();
  return all;
}

}  // namespace boltzmann
