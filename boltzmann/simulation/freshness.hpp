// Freshness: whether the influences that stand in the ensembles are those that the next step begins with.
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <cstdint>
#include <optional>
#include <span>

namespace boltzmann {

/// Of all rows, and influences, whatever their meaning; the same for any number of threads.
std::uint64_t rows_checksum(std::span<AnyEnsemble* const> ensembles, int threads, bool with_influences = true);

/// What influences depend on: particles, and the schemes' revision (nothing: they can't tell whether they are the same).
struct Dependence {
  std::uint64_t rows = 0;
  std::optional<std::uint64_t> schemes = {};
  bool operator==(Dependence const&) const = default;
};

/// While a run goes on nobody else changes particles: influences hold from their calculation until particles move.
/// Between two runs anybody may change what they depend on: where it is the same, they hold, else they are found anew.
/// Influences of velocities inside the step can't be had again from its end: they hold for the same particles even if
/// schemes can't tell.
class Freshness {
 public:
  /// While it lives, a run goes on.
  struct Run {
    bool& running;
    ~Run() { running = false; }
  };

  bool hold() const { return hold_; }
  /// Influences have been calculated, for particles as they are.
  void calculated() {
    hold_ = true;
    of_others_ = false;
  }
  /// Particles have moved, or what else influences depend on has changed.
  void outdated() { hold_ = false; }
  /// Particles have been changed between two steps by something else than their motion.
  void particles_changed() {
    hold_ = false;
    of_others_ = true;
    kept_.reset();
  }
  /// Whether that has happened since they were calculated: what stands there may be of other particles.
  bool of_others() const { return of_others_; }

  /// Whether some influences are of velocities inside the step.
  bool inside_step() const { return inside_step_; }
  void inside_step(bool some) { inside_step_ = some; }
  /// Whether the last run has left influences that may still hold: if so, begin_run() has to know what is now.
  bool kept() const { return kept_.has_value(); }
  /// A run begins, and what is now may not be what was when the last one ended.
  [[nodiscard]] Run begin_run(std::optional<Dependence> const& now) {
    hold_ = now && are_kept_for(*now);
    running_ = true;
    return {running_};
  }
  /// Whether influences that were kept hold for what is now.
  bool hold_for(Dependence const& now) const { return hold_ && are_kept_for(now); }
  /// Influences have been calculated between two runs, for what is now.
  void keep(Dependence const& now) { kept_ = now; }
  /// A run has ended so: asked for only if influences hold.
  template <class Now>
  void end_run(Now const& now) {
    kept_ = hold_ ? std::optional<Dependence>(now()) : std::nullopt;
  }
  /// Influences have been restored, or not, where a run had been.
  void restored(bool with_influences, Dependence const& now) {
    hold_ = false;
    of_others_ = !with_influences;
    kept_ = with_influences ? std::optional(now) : std::nullopt;
  }
  /// Whether influences belong to the state: they hold, and can't be had again.
  bool belong_to_state(Dependence const& now) const { return inside_step_ && hold_ && (running_ || are_kept_for(now)); }

 private:
  bool are_kept_for(Dependence const& now) const { return kept_ == now && (inside_step_ || now.schemes); }

  bool hold_ = false, of_others_ = false, running_ = false, inside_step_ = false;
  std::optional<Dependence> kept_;  // what they are for
};

}  // namespace boltzmann
