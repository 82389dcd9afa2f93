// Freshness: whether the influences that stand in the ensembles are those that the next step begins with.
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <cstdint>
#include <optional>
#include <span>

namespace boltzmann {

/// Of all rows, whatever their meaning.
std::uint64_t rows_checksum(std::span<AnyEnsemble* const> ensembles, bool with_influences = false);

/// While a run goes on nobody else changes particles: influences hold from their calculation until particles move.
/// Between two runs anybody may change them: influences are then found anew, except those of velocities inside the
/// step, which can't be had again from its end; they are kept, and hold for rows of the same checksum.
class Freshness {
 public:
  /// While it lives, a run goes on.
  struct Run {
    bool& running;
    ~Run() { running = false; }
  };

  bool hold() const { return hold_; }
  /// Influences have been calculated, for particles as they are.
  void calculated() { hold_ = true; }
  /// Particles have moved, or what else influences depend on has changed.
  void outdated() { hold_ = false; }
  /// Particles have been changed between two steps by something else than their motion.
  void particles_changed() {
    hold_ = false;
    kept_.reset();
  }

  /// Whether some influences are of velocities inside the step.
  bool inside_step() const { return inside_step_; }
  void inside_step(bool some) { inside_step_ = some; }
  /// A run begins with these particles, which may have been changed since the last one.
  [[nodiscard]] Run begin_run(std::span<AnyEnsemble* const> ensembles) {
    hold_ = are_kept_for(ensembles);
    running_ = true;
    return {running_};
  }
  /// A run has ended with these particles.
  void end_run(std::span<AnyEnsemble* const> ensembles) { keep(hold_ && inside_step_, ensembles); }
  /// Influences have been restored, or not, with these particles, where a run had been.
  void restored(bool with_influences, std::span<AnyEnsemble* const> ensembles) {
    hold_ = false;
    keep(with_influences, ensembles);
  }
  /// Whether these particles' influences belong to the state: they hold, and can't be had again.
  bool belong_to_state(std::span<AnyEnsemble* const> ensembles) const {
    return inside_step_ && hold_ && (running_ || are_kept_for(ensembles));
  }

 private:
  bool are_kept_for(std::span<AnyEnsemble* const> ensembles) const {
    return kept_ && *kept_ == rows_checksum(ensembles);
  }
  void keep(bool so, std::span<AnyEnsemble* const> ensembles) {
    kept_ = so ? std::optional(rows_checksum(ensembles)) : std::nullopt;
  }

  bool hold_ = false, running_ = false, inside_step_ = false;
  std::optional<std::uint64_t> kept_;  // the checksum of the rows that they are for
};

}  // namespace boltzmann
