// Freshness: whether the stored influences are those with which the next step begins.
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <cstdint>
#include <optional>
#include <span>

namespace boltzmann {

/// A checksum of all rows, and of influences as plain numbers; the same for any number of threads.
std::uint64_t rows_checksum(std::span<AnyEnsemble* const> ensembles, int threads, bool with_influences = true);

/// The dependences of influences: particles, and the schemes' revision (nothing: schemes can't detect changes).
struct Dependence {
  std::uint64_t rows = 0;
  std::optional<std::uint64_t> schemes = {};
  bool operator==(Dependence const&) const = default;
};

/// During a run only the run changes particles: influences are valid from their calculation until particles move.
/// Between two runs their dependences may change: influences stay valid if these are the same, else they are
/// recalculated. Influences that depend on velocities inside the step can't be recalculated at its end: for the same
/// particles they stay valid, even if schemes can't detect changes.
class Freshness {
 public:
  /// While it lives, a run is in progress.
  struct Run {
    bool& running;
    ~Run() { running = false; }
  };

  bool hold() const { return hold_; }
  /// Influences have been calculated for the current particles.
  void calculated() {
    hold_ = true;
    of_others_ = false;
  }
  /// Invalidates influences: particles have moved, or another dependence has changed.
  void outdated() { hold_ = false; }
  /// Particles have been changed between two steps, other than by their motion.
  void particles_changed() {
    hold_ = false;
    of_others_ = true;
    kept_.reset();
  }
  /// True if that has happened since influences were calculated: stored influences may belong to other particles.
  bool of_others() const { return of_others_; }

  /// True if some influences depend on velocities inside the step.
  bool inside_step() const { return inside_step_; }
  void inside_step(bool some) { inside_step_ = some; }
  /// True if the last run has left influences that may still be valid. Then begin_run() needs the current dependences.
  bool kept() const { return kept_.has_value(); }
  /// Begins a run; dependences may have changed since the last one ended.
  [[nodiscard]] Run begin_run(std::optional<Dependence> const& now) {
    hold_ = now && are_kept_for(*now);
    running_ = true;
    return {running_};
  }
  /// True if kept influences are valid for the current dependences.
  bool hold_for(Dependence const& now) const { return hold_ && are_kept_for(now); }
  /// Influences have been calculated between two runs, for these dependences.
  void keep(Dependence const& now) { kept_ = now; }
  /// Ends a run; `now` is called only if influences are valid.
  template <class Now>
  void end_run(Now const& now) {
    kept_ = hold_ ? std::optional<Dependence>(now()) : std::nullopt;
  }
  /// A state has been restored, with influences or without.
  void restored(bool with_influences, Dependence const& now) {
    hold_ = false;
    of_others_ = !with_influences;
    kept_ = with_influences ? std::optional(now) : std::nullopt;
  }
  /// True if influences are part of the state: they are valid, and can't be recalculated.
  bool belong_to_state(Dependence const& now) const { return inside_step_ && hold_ && (running_ || are_kept_for(now)); }

 private:
  bool are_kept_for(Dependence const& now) const { return kept_ == now && (inside_step_ || now.schemes); }

  bool hold_ = false, of_others_ = false, running_ = false, inside_step_ = false;
  std::optional<Dependence> kept_;  // for which influences were calculated
};

}  // namespace boltzmann
