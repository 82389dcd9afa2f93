// Frozen: an integrator that keeps selected particles of an ensemble in place. Private to this module.
#pragma once

#include <boltzmann/integrators/integrator.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace boltzmann {

/// Advances all particles except the frozen ones (DEACTIVATE of the 1990 thesis for single particles: the fixed end of
/// the rod). Frozen particles act on others as before, feel no influences, and are at rest.
class Frozen final : public Integrator {
 public:
  Frozen(AnyEnsemble& ensemble, std::vector<std::uint32_t> which, std::unique_ptr<Integrator> inner)
      : ensemble_(ensemble), which_(std::move(which)), inner_(std::move(inner)) {}

  Method method() const override { return inner_->method(); }
  int stages() const override { return inner_->stages(); }
  double time_after(int stage) const override { return inner_->time_after(stage); }
  void prepare(FixedPoint const& grid) override { inner_->prepare(grid); }
  bool same_for_all() const override { return false; }
  std::span<std::uint32_t const> resting() const override { return which_; }
  std::span<double const> taken_freedom() const override { return inner_->taken_freedom(); }
  std::vector<Carried> carried() override { return inner_->carried(); }
  std::string undivided() const override { return inner_->undivided(); }
  void divide(Division* division) override { inner_->divide(division); }
  bool has_groups() const override { return inner_->has_groups(); }
  bool predicts_velocities() const override { return inner_->predicts_velocities(); }
  double* half_step_velocities() override { return inner_->half_step_velocities(); }
  bool takes_rotations() const override { return inner_->takes_rotations(); }
  void rotate(std::vector<Rotation> rotations) override { inner_->rotate(std::move(rotations)); }

  Motion advance(int stage, StepContext const& context) override {
    std::size_t const doubles = ensemble_.doubles();
    kept_.resize(which_.size() * doubles);
    for (std::size_t k = 0; k < which_.size(); ++k) {
      std::copy_n(ensemble_.row(which_[k]), doubles, kept_.data() + k * doubles);
      std::fill_n(ensemble_.influence(which_[k]), ensemble_.influence_size(), 0.0);
    }
    inner_->threads(threads_);
    Motion const motion = inner_->advance(stage, context);
    for (std::size_t k = 0; k < which_.size(); ++k)
      std::copy_n(kept_.data() + k * doubles, doubles, ensemble_.row(which_[k]));
    move_ = inner_->largest_move();
    return motion;
  }

 private:
  AnyEnsemble& ensemble_;
  std::vector<std::uint32_t> which_;
  std::unique_ptr<Integrator> inner_;
  std::vector<double> kept_;
};

}  // namespace boltzmann
