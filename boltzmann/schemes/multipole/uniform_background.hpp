// UniformBackground: the uniform density that neutralises a box with periodic axes only. Private to this module.
#pragma once

#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/vector.hpp>
#include <boltzmann/schemes/multipole/image_lattice.hpp>

#include <array>
#include <vector>

namespace boltzmann {

/// The background of one density: its potential is c sum q |x - y|^2, c for a unit strength.
template <int D>
class UniformBackground {
 public:
  /// `amount`: strength of each particle. Positions are relative to this origin.
  template <class Points, class Amount>
  void find(ImageLattice const& lattice, Points const& particles, Amount const& amount,
            std::array<double, 3> const& origin) {
    double volume = 1;
    for (int a = 0; a < D; ++a) volume *= lattice.edges[a];
    of_square_ = D == 3 ? 2 * pi / (3 * volume) : pi / (2 * volume);
    origin_ = origin;
    ExactSum strength, second, first[D];
    for (auto const& p : particles) {
      double const q = amount(p);
      strength += q;
      for (int a = 0; a < D; ++a) {
        double const x = p.position[a] - origin[static_cast<std::size_t>(a)];
        second += q * x * x;
        first[a] += q * x;
      }
    }
    strength_ = strength.value(), second_ = second.value();
    for (int a = 0; a < D; ++a) first_[a] = first[a].value();
  }
  /// False before find() has been called.
  bool exists() const { return of_square_ != 0; }

  /// At a place, over the constant of the law.
  Vector<D> field(double const* place) const {
    Vector<D> field;
    for (int a = 0; a < D; ++a) field[a] = -2 * of_square_ * (strength_ * from_origin(place, a) - first_[a]);
    return field;
  }
  double potential(double const* place) const {
    double value = second_;
    for (int a = 0; a < D; ++a) {
      double const x = from_origin(place, a);
      value += x * (strength_ * x - 2 * first_[a]);
    }
    return of_square_ * value;
  }

 private:
  double from_origin(double const* place, int a) const { return place[a] - origin_[static_cast<std::size_t>(a)]; }

  double of_square_ = 0;
  std::array<double, 3> origin_{};
  double strength_ = 0, second_ = 0;  // of all particles: sums of strength, and times squared position
  Vector<D> first_{};                 // and times position
};

}  // namespace boltzmann
