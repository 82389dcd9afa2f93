// State laws: temperature, heat capacity and entropy as functions of an internal energy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace boltzmann {

class Stream;

/// The caloric state law of a particle's internal degrees of freedom, from their heat capacity Cv(T): the energy is the
/// integral of Cv from 0 to T, the entropy that of Cv / T, so that 1 / T = ds / d eps to rounding. Between the
/// temperatures of a table Cv is linear; outside them it has the first and the last value.
class StateLaw {
 public:
  /// A constant Cv, energy per temperature: eps = Cv T. Error if it is not positive.
  explicit StateLaw(double heat_capacity);
  /// Cv at ascending temperatures, at least two. Error if something is not positive or not ascending.
  StateLaw(std::vector<double> temperatures, std::vector<double> heat_capacities);
  /// Cv(T) as a function, tabulated on [lowest, highest], 0 < lowest < highest, so finely that energies between its
  /// points are accurate to about 1e-6 for smooth functions. Error if it is not positive and finite there.
  StateLaw(std::function<double(double)> const& heat_capacity, double lowest, double highest);

  bool constant() const { return temperature_.empty(); }
  /// The energy at a temperature, zero or more.
  double energy(double temperature) const;
  /// The temperature of an energy; not positive if the energy is not.
  double temperature(double energy) const;
  double heat_capacity(double temperature) const;
  /// s(eps), up to a constant (zero at the first temperature of a table, at the energy 1 of a constant heat capacity).
  /// For positive energies.
  double entropy(double energy) const;

  /// Draws an internal energy in equilibrium with a heat bath: the density is proportional to
  /// exp(s(eps) / k - eps / (k T)) (Eq 5 of the DPDE source; for constant Cv the Gamma distribution of shape
  /// Cv / k + 1 and scale k T). Uses one number of the stream. Error if temperature or k is not positive.
  double draw(double temperature, double boltzmann_constant, Stream& stream) const;
  /// The fraction of that distribution below an energy, and its inverse for u in (0, 1).
  double distribution(double energy, double temperature, double boltzmann_constant) const;
  double quantile(double u, double temperature, double boltzmann_constant) const;

 private:
  friend class InvariantLaw;  // integrates from point to point

  void check_and_integrate();
  std::size_t piece_of_energy(double energy) const;
  std::size_t piece_of_temperature(double temperature) const;

  double heat_capacity_ = 0;  // if constant
  // At the points of a table: linear in between, so that energies are quadratic.
  std::vector<double> temperature_, capacity_, energy_, entropy_;
  std::vector<double> slope_;  // of the heat capacity, from each point to the next
  // An index for the search of energies: the leading bits of a number, counted from those of the first point, give the
  // pieces.
  std::vector<std::uint32_t> first_piece_;
  std::uint64_t first_bits_ = 0;
  int shift_ = 0;
};

}  // namespace boltzmann
