// Rezoner: splits and merges the particles of an ensemble by a policy, and counts.
//
//   simulation.adapt(20, Rezoner(gas, scheme.box(), {.split_above = 2, .smallest_mass = 0.2}));
#pragma once

#include <boltzmann/schemes/smooth/rezone.hpp>
#include <boltzmann/simulation/adaptation.hpp>

namespace boltzmann {

class Rezoner final : public Adaptation {
 public:
  /// Ensemble and box must outlive it. Error if the policy can't be met, or the ensemble lacks a field.
  Rezoner(AnyEnsemble& ensemble, Box const& box, Rezoning const& rezoning);

  void change() override;
  std::string report(UnitSystem const& units) const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  /// Totals of all steps so far.
  Rezoned const& done() const { return done_; }

 private:
  AnyEnsemble* ensemble_;
  Box const* box_;
  Rezoning rezoning_;
  Rezoned done_;
};

}  // namespace boltzmann
