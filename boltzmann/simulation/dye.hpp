// DyeSource: releases tracers at fixed places during a run. Tracers of one place form a streakline, which pictures draw
// if the class is Dye.
//
//   simulation.adapt(5, DyeSource(dye, {.from = {-2, 0.1}}));
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/particles/dye.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/simulation/adaptation.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace boltzmann {

struct DyeOptions {
  std::array<double, 3> from{};             ///< as many numbers as space has axes
  std::optional<std::array<double, 3>> to;  ///< the other end of a line
  std::size_t places = 1;                   ///< on the line, including both ends
  std::size_t limit = 100000;               ///< of particles in the ensemble
  std::size_t first_place = 1;              ///< number of the place `from`, if several sources share an ensemble
  std::int64_t every = 1;                   ///< in steps; for scenarios
};
/// The keys of a scenario; the ensemble is read by other code.
OptionTable const& dye_options();

/// Each change appends one tracer for each place, while the ensemble has at most `limit`: rows of one place are
/// `places` apart, the oldest first. If the class has the fields `place` and `release` (Dye), they record the place and
/// the number of the change. Changes that added nothing count, so that a gap is visible.
class DyeSource final : public Adaptation {
 public:
  /// The ensemble must outlive it. Error if its class is no tracer, or an option is invalid.
  DyeSource(AnyEnsemble& ensemble, DyeOptions const& options);

  void change() override;
  std::string report(UnitSystem const& units) const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  /// Number of tracers released so far.
  std::size_t released() const { return released_; }

 private:
  AnyEnsemble* ensemble_;
  DyeOptions options_;
  std::size_t released_ = 0, changes_ = 0;
};

}  // namespace boltzmann
