// Descent: the steps of FIRE, on the particles of several ensembles. Private to this room.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace boltzmann {

/// An ensemble that moves downhill.
struct Descending {
  AnyEnsemble* ensemble;
  Box const* box;
  double length;                        ///< over which its law changes
  double distance;                      ///< no particle is moved further in a step
  std::vector<bool> rests;              ///< of each particle, whether it stays; empty: none does
  std::vector<double> velocities = {};  ///< of the descent, D numbers a particle
};

/// The largest force there is, and on whom.
struct LargestForce {
  double square = 0;
  std::size_t part = 0, particle = 0;
};

class Descent {
 public:
  /// `influences` calculates them for particles as they stand. All particles have the same mass, whatever theirs are, so
  /// that slow ones find their places as soon as quick ones.
  Descent(std::vector<Descending>& parts, double mass, double step, std::uint64_t seed, int threads,
          std::function<void()> influences);

  /// Forces at the places of now; particles whose force is not finite are moved apart first. Error if that does not help.
  void calculate();
  void step();
  LargestForce const& largest() const { return largest_; }
  std::size_t separated() const { return separated_; }

 private:
  void halve();
  void move();
  void bring_back(Descending& part);
  bool separate();
  void press_on_walls(Descending& part);

  std::vector<Descending>& parts_;
  double mass_, step_, longest_, shortest_;
  std::uint64_t seed_;
  int threads_;
  std::function<void()> influences_;
  double mixing_;
  int downhill_ = 0;
  LargestForce largest_;
  std::size_t separated_ = 0;
  std::uint64_t calls_ = 0;
};

}  // namespace boltzmann
