// DyeSource: tracers are released at fixed places while a run goes on; those of one place make a streakline, which
// pictures draw if they are of class Dye.
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
  std::size_t places = 1;                   ///< on the line, both ends included
  std::size_t limit = 100000;               ///< of particles in the ensemble
  std::size_t first_place = 1;              ///< number of the place `from`, where several sources share an ensemble
  std::int64_t every = 1;                   ///< steps; for scenarios
};
/// The keys of a scenario; the ensemble is read by code.
OptionTable const& dye_options();

/// Each change appends one tracer for each place, as long as the ensemble has no more than `limit`: rows of one place are
/// `places` apart, the oldest first. Where the class has the fields `place` and `release` (Dye), these say at which place,
/// and by which change: one that added nothing counts, so that a gap can be seen.
class DyeSource final : public Adaptation {
 public:
  /// The ensemble must outlive it. Error if it is not one of tracers, or an option can't be.
  DyeSource(AnyEnsemble& ensemble, DyeOptions const& options);

  void change() override;
  std::string report(UnitSystem const& units) const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  /// So far.
  std::size_t released() const { return released_; }

 private:
  AnyEnsemble* ensemble_;
  DyeOptions options_;
  std::size_t released_ = 0, changes_ = 0;
};

}  // namespace boltzmann
