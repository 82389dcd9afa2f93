// The data of VelocityForces on schemes and ensembles. Private to velocity_forces*.cpp.
#pragma once

#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/share.hpp>
#include <boltzmann/schemes/velocity_influences.hpp>
#include <boltzmann/simulation/velocity_forces.hpp>

#include <array>
#include <string>
#include <vector>

namespace boltzmann {

/// A scheme, and its part that depends on velocities; null: the whole scheme does, and counts as `between`.
struct VelocityForces::Source {
  Scheme* scheme = nullptr;
  VelocityInfluences* part = nullptr;
  bool between = false;
  std::vector<AnyEnsemble*> outside;  // ensembles whose external laws are added here
  std::vector<AnyEnsemble*> targets;
  std::vector<std::vector<double>> others;  // of each target: influences that don't depend on velocities
};

/// An ensemble whose second kick is solved for.
struct VelocityForces::Kicked {
  static constexpr std::size_t grain = 2048;

  AnyEnsemble* ensemble;
  Integrator* integrator;
  int offset;  // of the velocity in a row
  std::size_t D;
  std::vector<double> rows, tried;  // before the kick; velocities for which influences were calculated
  double fastest;                   // square of the largest speed

  double* velocity(std::size_t i) const { return ensemble->row(i) + offset; }
  template <class F>
  void each(int threads, F const& f) const {
    for_share(*ensemble, grain, threads_for(ensemble->size(), 1, threads), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) f(i);
    });
  }
  template <class F>
  double most(int threads, F const& f) const;
  void keep_rows(int threads);
  void restore_rows(int threads);
  double change(int threads) const;
};

/// An ensemble on which external forces act during the drift.
struct VelocityForces::Drifting {
  Drifting(AnyEnsemble& of, Integrator& by);

  AnyEnsemble* ensemble;
  Integrator* integrator;
  int position, velocity, mass;       // offsets in a row
  std::vector<int> driven;            // numbers with rates of their own
  std::vector<double> rows, outside;  // at the start of the step: rows, and external influences
};

}  // namespace boltzmann
