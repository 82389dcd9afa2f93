// Remesher: remeshes the vortices of an ensemble during a run, and counts.
//
//   simulation.adapt(10, Remesher(vortices, scheme.box(), {.spacing = 0.05, .threshold = 1e-4, .margin = 2}));
#pragma once

#include <boltzmann/simulation/adaptation.hpp>
#include <boltzmann/simulation/remesh.hpp>

namespace boltzmann {

class Remesher final : public Adaptation {
 public:
  /// Ensemble and box must outlive it. Error if the ensemble can't be remeshed with these options.
  Remesher(AnyEnsemble& ensemble, Box const& box, Remeshing remeshing);

  void change() override;
  std::string report(UnitSystem const& units) const override;
  /// The vorticity of weak nodes that were removed.
  FlowImpulse taken() const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  /// Totals of all remeshings so far; the other: their number.
  Remeshed const& done() const { return done_; }
  std::size_t times() const { return times_; }

 private:
  AnyEnsemble* ensemble_;
  Box const* box_;
  Remeshing remeshing_;
  Remeshed done_;
  std::size_t times_ = 0;
};

}  // namespace boltzmann
