// The leap-frog with rigid bonds (RATTLE), and the correction of velocities after baths.
#include <boltzmann/core/error.hpp>
#include <boltzmann/dissipation/rigid_motion.hpp>

#include <fmt/format.h>

namespace boltzmann {
namespace {

/// Kick, drift and the bonds; then the second kick and the velocities.
class RigidLeapFrog final : public Integrator {
 public:
  RigidLeapFrog(std::shared_ptr<RigidBonds> bonds, std::unique_ptr<Integrator> inner)
      : bonds_(std::move(bonds)), inner_(std::move(inner)) {
    if (inner_->method() != Method::leap_frog)
      throw Error(fmt::format("rigid bonds need the leap-frog; '{}' moves by {}", bonds_->ensemble().name(),
                              to_string(inner_->method())));
    if (!inner_->same_for_all())
      throw Error(
          fmt::format("some particles of '{}' are frozen, which rigid bonds do not know: tether the particle to its "
                      "place by a stiff spring (class Tethered, law tether), or give it a large mass",
                      bonds_->ensemble().name()));
  }

  Method method() const override { return inner_->method(); }
  int stages() const override { return inner_->stages(); }
  double time_after(int stage) const override { return inner_->time_after(stage); }
  std::span<double const> taken_freedom() const override { return bonds_->taken_freedom(); }
  void settle_velocities() override { bonds_->correct_velocities(threads_); }
  std::vector<Carried> carried() override { return inner_->carried(); }
  std::string undivided() const override { return inner_->undivided(); }
  void divide(Division* division) override {
    inner_->divide(division);
    if (division) bonds_->keep_together(*division);
  }
  bool has_groups() const override { return true; }
  bool predicts_velocities() const override { return inner_->predicts_velocities(); }
  bool takes_rotations() const override { return inner_->takes_rotations(); }
  void rotate(std::vector<Rotation> rotations) override { inner_->rotate(std::move(rotations)); }

  Motion advance(int stage, StepContext const& context) override {
    inner_->threads(threads_);
    if (stage == 0) bonds_->begin_step(threads_);
    Motion const motion = inner_->advance(stage, context);
    move_ = inner_->largest_move();
    if (move_.not_finite != LargestMove::nobody) return motion;  // the simulation reports it
    if (stage == 0)
      bonds_->correct_positions(context.dt, threads_);
    else
      bonds_->correct_velocities(threads_);
    return motion;
  }

 private:
  std::shared_ptr<RigidBonds> bonds_;
  std::unique_ptr<Integrator> inner_;
};

}  // namespace

std::unique_ptr<Integrator> with_rigid_bonds(std::shared_ptr<RigidBonds> bonds, std::unique_ptr<Integrator> inner) {
  return std::make_unique<RigidLeapFrog>(std::move(bonds), std::move(inner));
}

void RigidVelocities::restore(std::span<double const> state) {
  if (state.size() != 1) throw Error("the checkpoint has nothing about this simulation's rigid bonds");
  heat_ = state[0];
}

}  // namespace boltzmann
