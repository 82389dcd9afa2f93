// Engines: convert ensembles to points for expansions, and results at the points to influences. Private to this module.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/boundaries/flow_images.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/schemes/multipole/multipole_field.hpp>
#include <boltzmann/schemes/scheme.hpp>
#include <boltzmann/schemes/source_kind.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

/// An ensemble that acts, or that only feels the field.
struct LoadedSources {
  AnyEnsemble* ensemble;
  SourceKind kind;
  bool acts;
};

/// The engine of one law in two or three dimensions.
class MultipoleEngine {
 public:
  virtual ~MultipoleEngine() = default;

  /// Throws Error unless the law acts between particles of this class.
  virtual void check(AnyEnsemble const& ensemble, SourceKind const& kind, bool acts) const = 0;
  /// Collects all particles of these ensembles. Throws PhysicsFailure if a position is not finite; Error if all axes
  /// are periodic and strengths don't cancel, without a background.
  virtual void collect(std::vector<LoadedSources> const& loaded, bool background, int threads) = 0;
  /// Adds passive places after the particles.
  virtual void add(double const* places, std::size_t count) = 0;
  virtual std::size_t count() const = 0;
  /// The checksum of the collected points.
  virtual std::uint64_t checksum() const = 0;

  /// From now on the ranks of this team, which have all collected the same points, share the work; null: no longer.
  virtual void divide(Team* team) = 0;
  virtual void choose(MultipoleChoice const& choice) = 0;
  virtual void calculate(bool with_potential, int threads) = 0;
  /// Enables recording of nearness to the acceptance criterion: see MultipoleField.
  virtual void watch(bool yes) = 0;
  virtual std::vector<float> const& nearness() const = 0;
  /// The influences on these particles by direct sums, to this relative accuracy.
  virtual std::vector<double> exact(std::vector<std::size_t> const& particles, double error, int threads) const = 0;
  virtual std::size_t dimension() const = 0;
  virtual std::size_t width() const = 0;  ///< numbers per particle
  /// The results: a field or a velocity, and possibly more.
  virtual std::vector<double> const& field() const = 0;
  virtual std::vector<double> const& potential() const = 0;
  virtual MultipoleChoice const& choice() const = 0;
  virtual MultipoleCost const& cost() const = 0;
  virtual double work() const = 0;  ///< of the last calculation, in units of pairs
  virtual std::size_t bytes() const = 0;

  virtual double constant() const = 0;  ///< of the field 1/r^(D-1) of a unit strength
  /// Errors are relative to at least this field, in case all influences cancel.
  virtual double least_field() const = 0;
  virtual bool feels(std::size_t i) const = 0;
  /// The number of parts of a result that have different units and are compared separately.
  virtual int parts() const { return 1; }
  struct Squares {
    double error, felt;
  };
  virtual Squares compare(int part, std::size_t i, double const* found, double const* exact) const = 0;

  /// Adds the results of the last calculation to the influences (in a divided run, of this rank's particles).
  virtual void add_influences(std::vector<LoadedSources> const& loaded, int threads) const = 0;
  virtual EnergyAndVirial measure(std::vector<LoadedSources> const& loaded) const = 0;
  /// True if the influences on coincident particles are infinite.
  virtual bool singular() const = 0;
};

/// Throws Error unless the law has an effect.
std::unique_ptr<MultipoleEngine> multipole_engine(LaplaceLaw const& law, Box const& box);
std::unique_ptr<MultipoleEngine> multipole_engine(VortexLaw const& law, Box const& box);
/// The results are the velocity and its gradient. Throws Error unless space has 3 dimensions.
std::unique_ptr<MultipoleEngine> slopes_engine(VortexLaw const& law, Box const& box);

/// True if an axis has mirror walls at both of its ends.
inline bool repeats_between_walls(Box const& box, int axis) {
  return box.boundary(axis) == Boundary::mirror && box.walled(axis, Box::End::low) && box.walled(axis, Box::End::high);
}

/// Throws Error with the sum of all strengths and remedies.
inline void refuse_sum(double total, char const* help) {
  throw Error(
      fmt::format("multipoles: the strengths sum to {:.6g}, and a periodic box has no field unless they cancel; "
                  "{}",
                  total, help));
}
constexpr char const* use_background =
    "add particles of the other sign, or a uniform background: background(true), in scenarios background = true";

/// The common part of all laws.
template <class Kind>
class EngineOf : public MultipoleEngine {
 public:
  static constexpr int D = Kind::dimension;
  using Field = MultipoleField<Kind>;
  using Point = typename Field::Point;

  EngineOf(typename Kind::Law const& law, Box const& box) : law_(law), multipoles_(law, lattice_of(box)) {
    ImageLattice const lattice = lattice_of(box);
    for (int a = 0; a < D; ++a) low_[a] = box.low(a), edges_[a] = lattice.edges[a];
  }

  void add(double const* places, std::size_t count) final {
    for (std::size_t k = 0; k < count; ++k) {
      Point point{};
      for (int a = 0; a < D; ++a) {
        point.position[a] = inside(places[k * D + static_cast<std::size_t>(a)], a);
        if (!(std::abs(point.position[a]) < furthest))
          throw Error(fmt::format("multipoles: place {} is not finite, or too far to be squared", k));
      }
      points_.push_back(point);
    }
  }
  std::size_t count() const final { return points_.size(); }
  std::uint64_t checksum() const final {
    std::uint64_t sum = 0xcbf29ce484222325;  // hash of Fowler, Noll and Vo, by words
    auto const add = [&](double number) { sum = (sum ^ std::bit_cast<std::uint64_t>(number)) * 0x100000001b3; };
    for (Point const& p : points_) {
      for (int a = 0; a < D; ++a) add(p.position[a]);
      for (int k = 0; k < Kind::densities; ++k) add(Kind::amount(p, k));
    }
    return sum;
  }
  void divide(Team* team) final { multipoles_.divide(team); }
  void choose(MultipoleChoice const& choice) final { multipoles_.choose(choice); }
  void calculate(bool with_potential, int threads) final { multipoles_.calculate(points_, with_potential, threads); }
  void watch(bool yes) final { multipoles_.watch(yes); }
  std::vector<float> const& nearness() const final { return multipoles_.nearness(); }
  std::vector<double> exact(std::vector<std::size_t> const& particles, double error, int threads) const final {
    return multipoles_.direct(points_, particles, error, threads);
  }
  std::size_t dimension() const final { return D; }
  std::size_t width() const final { return Kind::width; }
  std::vector<double> const& field() const final { return multipoles_.field(); }
  std::vector<double> const& potential() const final { return multipoles_.potential(); }
  MultipoleChoice const& choice() const final { return multipoles_.choice(); }
  MultipoleCost const& cost() const final { return multipoles_.cost(); }
  double work() const final { return multipoles_.work(); }
  std::size_t bytes() const final { return multipoles_.bytes() + points_.capacity() * sizeof(Point); }
  double constant() const final { return std::abs(Kind::constant(law_)); }

 protected:
  static constexpr double furthest = 1e140;  // squares and their sums must not overflow

  bool periodic() const { return *std::min_element(edges_.begin(), edges_.end()) > 0; }
  bool any_periodic() const { return *std::max_element(edges_.begin(), edges_.end()) > 0; }

  /// Points of all ensembles: their positions, and data that `fill` adds to each point.
  template <class Fill>
  void collect_points(std::vector<LoadedSources> const& loaded, int threads, Fill const& fill) {
    std::size_t total = 0, at = 0;
    for (auto const& one : loaded) total += one.ensemble->size();
    points_.assign(total, Point{});
    for (auto const& one : loaded) {
      AnyEnsemble const& ensemble = *one.ensemble;
      auto const collect = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          Point& point = points_[at + i];
          for (int a = 0; a < D; ++a) {
            double const x = point.position[a] = inside(ensemble.row(i)[a], a);
            if (!(std::abs(x) < furthest))
              throw PhysicsFailure(fmt::format("particle {} of '{}' is at a position that is not finite{}", i,
                                               ensemble.name(), std::isfinite(x) ? ", or too far to be squared" : ""));
          }
          fill(one, i, at + i, point);
        }
      };
      for_ranges(ensemble.size(), 4096, threads_for(ensemble.size(), 1, threads), collect);
      at += ensemble.size();
    }
  }

  /// The mean distance of neighbours.
  double spacing() const {
    std::array<double, 3> least{}, most{};
    double volume = 1, shortest = 0;
    for (int a = 0; a < D; ++a)
      if (edges_[a] > 0 && !(shortest > 0 && shortest < edges_[a])) shortest = edges_[a];
    for (int a = 0; a < D; ++a) {
      if (points_.empty()) return 1;
      least[a] = most[a] = points_.front().position[a];
      for (auto const& p : points_)
        least[a] = std::min(least[a], p.position[a]), most[a] = std::max(most[a], p.position[a]);
      volume *= edges_[a] > 0 ? edges_[a] : std::max(most[a] - least[a], shortest);
    }
    return std::pow(volume / static_cast<double>(points_.size()), 1.0 / D);
  }

  typename Kind::Law law_;
  Field multipoles_;
  std::vector<Point> points_;

 private:
  /// A periodic axis has its length as period, an axis between two walls twice its length.
  static ImageLattice lattice_of(Box const& box) {
    ImageLattice lattice;
    for (int a = 0; a < D; ++a) {
      if (box.periodic(a)) lattice.edges[a] = box.length(a);
      if (repeats_between_walls(box, a)) lattice.edges[a] = 2 * box.length(a);
    }
    return lattice;
  }
  /// Wraps into the box along periodic axes.
  double inside(double x, int a) const {
    return edges_[a] > 0 ? x - edges_[a] * std::floor((x - low_[a]) / edges_[a]) : x;
  }

  std::array<double, D> low_, edges_;
};

}  // namespace boltzmann
