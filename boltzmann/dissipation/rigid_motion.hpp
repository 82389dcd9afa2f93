// Motion with rigid bonds: the leap-frog that conserves their lengths, and the correction after baths.
#pragma once

#include <boltzmann/dissipation/dissipation.hpp>
#include <boltzmann/integrators/integrator.hpp>
#include <boltzmann/schemes/molecules/rigid_bonds.hpp>

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

/// Leap-frog with rigid bonds, replacing the ensemble's own.
std::unique_ptr<Integrator> with_rigid_bonds(std::shared_ptr<RigidBonds> bonds, std::unique_ptr<Integrator> inner);

/// The correction after baths: removes velocities that stretch bonds. Add it after the baths; its heat is the removed
/// energy.
class RigidVelocities final : public Dissipation {
 public:
  explicit RigidVelocities(std::shared_ptr<RigidBonds> bonds) : bonds_(std::move(bonds)) {}
  std::vector<AnyEnsemble*> ensembles() const override { return {&bonds_->ensemble()}; }
  void check() override {}
  void advance(StepContext const&) override { heat_ += bonds_->correct_velocities(threads(), division()); }
  std::string undivided() const override { return ""; }
  void divide(Division* division) override {
    Dissipation::divide(division);
    if (division) bonds_->keep_together(*division);
  }
  double heat() const override { return heat_; }
  bool keeps_momentum() const override { return true; }
  std::string kind() const override { return "rigid bonds"; }
  std::vector<double> state() const override { return {heat_}; }
  void restore(std::span<double const> state) override;

 private:
  std::shared_ptr<RigidBonds> bonds_;
  double heat_ = 0;
};

}  // namespace boltzmann
