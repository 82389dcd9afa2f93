// Transport coefficients by Green-Kubo: the autocorrelation of fluxes of the whole system.
#pragma once

#include <boltzmann/core/words.hpp>
#include <boltzmann/diagnoses/diagnosis.hpp>

#include <cstddef>
#include <deque>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

enum class Transport {
  viscosity,          ///< of shear, by the traceless stress
  conductivity,       ///< electrical, by the current of charges
  heat_conductivity,  ///< by the flux of energy, for one class of particles with pair influences
};
Words<Transport> const& transport_words();

struct GreenKuboOptions {
  Transport quantity = Transport::viscosity;
  std::size_t count = 200;  ///< the longest lag, in rows
  double since = 0;         ///< the time of the first row that counts
};

/// The integral over the lag of a flux's autocorrelation in equilibrium (Kubo 1957), in D dimensions, volume V:
/// viscosity: <P(0):P(t)> V / ((D - 1)(D + 2) k T), P the symmetric traceless stress (Daivis and Evans 1994);
/// conductivity: <J(0).J(t)> / (D V k T), J = sum q v;
/// heat conductivity: the same for J = sum (e v + W v), divided by T once more, e a particle's energy and W its half of
/// its pairs' virial (Irving and Kirkwood), velocities relative to the common one.
/// T is the mean temperature over the rows, by the motion of particles relative to the common one. Column: the integral
/// up to the longest lag; NaN while there are fewer rows. Table: the autocorrelation and the running integral.
class GreenKubo final : public Diagnosis {
 public:
  using Options = GreenKuboOptions;
  /// Error if a simulation has no such coefficient: no shear in 1D, no charges, several ensembles that carry heat.
  GreenKubo(std::vector<AnyEnsemble const*> const& available, Options const& options);

  std::vector<Column> columns() const override;
  Options const& options() const { return options_; }
  void check(Box const& box) const override { refuse_shear(box, "green-kubo"); }
  void measure(Sample const& sample, std::vector<double>& values) override;
  bool needs_energies() const override { return options_.quantity == Transport::heat_conductivity; }
  bool needs_virial() const override { return options_.quantity != Transport::conductivity; }
  std::vector<GatheredTable> tables() const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  /// <flux(0).flux(t)> at lags 0, 1, ... rows, and the coefficient up to that lag.
  std::vector<double> autocorrelation() const;
  std::vector<double> coefficient() const;

 private:
  std::vector<double> flux(Sample const& sample) const;
  std::string name() const;
  Dimension flux_dimension() const;
  Dimension coefficient_dimension() const;

  Options options_;
  int dimension_;
  double rows_ = 0, first_time_ = 0, last_time_ = 0, interval_ = 0;
  double temperature_ = 0, volume_ = 0, constant_ = 1;  // means over rows; Boltzmann's constant
  std::deque<std::vector<double>> fluxes_;              // of the last rows, latest first
  std::vector<double> sums_, numbers_;                  // for each lag
};

}  // namespace boltzmann
