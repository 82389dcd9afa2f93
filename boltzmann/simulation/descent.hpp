// Descent: the steps of FIRE, for the particles of several ensembles. Private to this module.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace boltzmann {

/// An ensemble that is minimised.
struct Descending {
  AnyEnsemble* ensemble;
  Box const* box;
  double length;                        ///< over which its law changes
  double distance;                      ///< the limit of a particle's motion in a step
  std::vector<bool> rests;              ///< per particle, whether it rests; empty: none does
  std::vector<double> velocities = {};  ///< of the descent, D numbers a particle
};

/// The largest force, and its particle.
struct LargestForce {
  double square = 0;
  std::size_t part = 0, particle = 0;
};

class Descent {
 public:
  /// `influences` calculates them for the current particles. All particles have the same mass in the descent, so that
  /// heavy and light ones relax equally fast.
  Descent(std::vector<Descending>& parts, double mass, double step, std::uint64_t seed, int threads,
          std::function<void()> influences);

  /// Calculates the forces at the current positions; particles whose force is not finite are first moved apart. Error
  /// if that fails.
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
