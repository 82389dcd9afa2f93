// Leap-frog with forces that depend on velocities: external ones, during the drift.
#include <boltzmann/core/threads.hpp>
#include <boltzmann/simulation/velocity_forces_parts.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

namespace boltzmann {
namespace {

constexpr std::size_t most_of_block = 64;  // particles, whose rows fit the first-level cache
constexpr int most_midpoint_turns = 50;
constexpr double midpoint_found = 1e-14;    // relative change of a velocity
constexpr double midpoint_rounding = 1e-9;  // below it, changes that no longer decrease are rounding errors
constexpr double worth_a_response = 1e-6;   // above it, the response to velocities saves iterations
constexpr double response_shift = 0x1p-8;   // relative shift of a velocity

/// Solves (1 - B) x = b by elimination with pivots; leaves b unchanged if the matrix is singular.
void solve_response(int D, double const (&B)[3][3], double* b) {
  double m[3][4];
  for (int r = 0; r < D; ++r) {
    for (int c = 0; c < D; ++c) m[r][c] = (r == c ? 1 : 0) - B[r][c];
    m[r][D] = b[r];
  }
  for (int k = 0; k < D; ++k) {
    int pivot = k;
    for (int r = k + 1; r < D; ++r)
      if (std::abs(m[r][k]) > std::abs(m[pivot][k])) pivot = r;
    if (!(std::abs(m[pivot][k]) > 1e-12)) return;
    std::swap(m[k], m[pivot]);
    for (int r = 0; r < D; ++r) {
      double const factor = r == k ? 0 : m[r][k] / m[k][k];
      for (int c = k; c <= D; ++c) m[r][c] -= factor * m[k][c];
    }
  }
  for (int k = 0; k < D; ++k) b[k] = m[k][D] / m[k][k];
}

/// The midpoints of a step for a block of particles. Each is solved separately, so no bit depends on the others.
class Midpoints {
 public:
  /// Adds the influences at trial rows of particles `first` and following ones.
  using Outside = std::function<void(double const* rows, std::size_t first, std::size_t count, double* influence)>;
  struct Places {
    int position, velocity, mass, D;
    std::size_t stride;
  };
  Midpoints(Places places, double dt, Outside const& outside)
      : at_(places), half_(0.5 * dt), outside_(outside), rows_(most_of_block * places.stride / 4) {}

  double* row(std::size_t k) { return rows_.data()->numbers + k * at_.stride; }
  /// `start` is the row at the start of the step, `v` the velocity after the first half kick, `force` the external
  /// force at the start. row(k) has all other fields at the midpoint.
  void set(std::size_t k, double const* start, double const* v, double const* force) {
    One& one = all_[k];
    one.inverse_mass = 1 / start[at_.mass];
    one.state = State::searching;
    one.change = 1;
    for (int a = 0; a < at_.D; ++a) {
      one.x[a] = start[at_.position + a];
      one.v[a] = v[a];
      one.mid[a] = v[a] + half_ * one.inverse_mass * force[a];
    }
  }
  void leave_out(std::size_t k) { all_[k].state = State::found; }
  /// The first of `count` particles without convergence; count if all converged.
  std::size_t find(std::size_t first, std::size_t count) {
    for (int turn = 0; turn < most_midpoint_turns; ++turn) {
      evaluate(first, count, -1);
      bool all = true, respond = false;
      for (std::size_t k = 0; k < count; ++k) {
        One& one = all_[k];
        if (one.state == State::found) continue;
        judge(one, k, turn);
        all = all && one.state == State::found;
        respond = respond || (turn == 0 && one.responds);
      }
      if (all) return count;
      if (respond) find_response(first, count);
      for (std::size_t k = 0; k < count; ++k) {
        One& one = all_[k];
        if (one.state == State::found) continue;
        if (one.responds) solve_response(at_.D, one.response, one.step);
        for (int a = 0; a < at_.D; ++a) one.mid[a] += one.step[a];
      }
    }
    for (std::size_t k = 0; k < count; ++k)
      if (all_[k].state != State::found) return k;
    return count;
  }
  double mid(std::size_t k, int axis) const { return all_[k].mid[axis]; }

 private:
  enum class State { searching, found };
  struct alignas(32) Block {  // the alignment of rows
    double numbers[4];
  };
  struct One {
    double x[3], v[3], mid[3], step[3], shifted[3];
    double response[3][3];
    double inverse_mass, change;
    bool responds;
    State state;
  };

  double speed(double const* v) const {
    double sum = 0;
    for (int a = 0; a < at_.D; ++a) sum += v[a] * v[a];
    return std::sqrt(sum);
  }
  double shift(One const& one) const { return response_shift * speed(one.mid); }

  /// Influences at the midpoints, with one component of the velocity shifted if axis >= 0.
  void evaluate(std::size_t first, std::size_t count, int axis) {
    for (std::size_t k = 0; k < count; ++k) {
      One const& one = all_[k];
      for (int a = 0; a < at_.D; ++a) {
        double const v = one.mid[a] + (a == axis ? shift(one) : 0);
        row(k)[at_.position + a] = one.x[a] + half_ * v;
        row(k)[at_.velocity + a] = v;
      }
    }
    std::fill_n(influence_, count * static_cast<std::size_t>(at_.D), 0.0);
    outside_(row(0), first, count, influence_);
  }
  double velocity_after(One const& one, std::size_t k, int a) const {
    return one.v[a] +
           half_ * one.inverse_mass * influence_[k * static_cast<std::size_t>(at_.D) + static_cast<std::size_t>(a)];
  }
  void judge(One& one, std::size_t k, int turn) {
    double after[3];
    for (int a = 0; a < at_.D; ++a) {
      after[a] = velocity_after(one, k, a);
      one.step[a] = after[a] - one.mid[a];
    }
    double const scale = speed(after) + speed(one.v), before = std::exchange(one.change, speed(one.step));
    if (turn == 0) one.responds = one.change > worth_a_response * scale;
    bool const done = one.change <= midpoint_found * scale ||
                      (turn > 2 && one.change <= midpoint_rounding * scale && one.change > 0.25 * before);
    if (!done && std::isfinite(one.change)) return;
    one.state = State::found;  // the next stage reports numbers that are not finite
    std::copy_n(after, at_.D, one.mid);
  }
  /// The derivatives of the velocity by the midpoint's, from differences: exact for forces that are linear in it.
  void find_response(std::size_t first, std::size_t count) {
    for (int axis = 0; axis < at_.D; ++axis) {
      evaluate(first, count, axis);
      for (std::size_t k = 0; k < count; ++k) {
        One& one = all_[k];
        double const by = shift(one);
        for (int a = 0; a < at_.D; ++a)
          one.response[a][axis] = by > 0 ? (velocity_after(one, k, a) - (one.mid[a] + one.step[a])) / by : 0;
      }
    }
  }

  Places at_;
  double half_;
  Outside const& outside_;
  std::vector<Block> rows_;
  double influence_[3 * most_of_block];
  One all_[most_of_block];
};

}  // namespace

VelocityForces::Drifting::Drifting(AnyEnsemble& of, Integrator& by)
    : ensemble(&of),
      integrator(&by),
      position(of.field("position").offset),
      velocity(of.field("velocity").offset),
      mass(of.field("mass").offset) {
  for (auto const& field : of.driven())
    for (int c = 0; c < field.components && !field.sum; ++c) driven.push_back(field.offset + c);
}

void VelocityForces::begin_drift(AnyEnsemble& ensemble, double time, int threads) {
  Drifting* const one = drifting(ensemble);
  if (!one) return;
  std::size_t const stride = ensemble.stride(), D = ensemble.influence_size();
  one->rows.resize(ensemble.size() * stride);
  one->outside.assign(ensemble.size() * D, 0.0);
  for_share(ensemble, Kicked::grain, threads_for(ensemble.size(), 1, threads), [&](std::size_t begin, std::size_t end) {
    std::copy(ensemble.row(begin), ensemble.row(begin) + (end - begin) * stride, one->rows.data() + begin * stride);
    for (auto const& source : sources_)
      if (std::find(source->outside.begin(), source->outside.end(), &ensemble) != source->outside.end())
        source->part->add_from_outside(
            ensemble, {ensemble.row(begin), begin, end - begin, time, one->outside.data() + begin * D});
    double* const influence = ensemble.influence(0);
    for (std::size_t k = begin * D; k < end * D; ++k) influence[k] -= one->outside[k];
  });
}

void VelocityForces::end_drift(AnyEnsemble& ensemble, double time, double dt, int threads) {
  Drifting* const one = drifting(ensemble);
  if (!one) return;
  std::vector<Source const*> sources;
  for (auto const& source : sources_)
    if (std::find(source->outside.begin(), source->outside.end(), &ensemble) != source->outside.end())
      sources.push_back(source.get());
  Midpoints::Outside const outside = [&](double const* rows, std::size_t first, std::size_t count, double* influence) {
    for (auto const* source : sources)
      source->part->add_from_outside(ensemble, {rows, first, count, time + 0.5 * dt, influence});
  };
  std::vector<bool> rests;
  if (!one->integrator->resting().empty()) rests.resize(ensemble.size());
  for (std::uint32_t const i : one->integrator->resting()) rests[i] = true;
  std::size_t const stride = ensemble.stride(), D = ensemble.influence_size();
  double* const half_step = one->integrator->half_step_velocities();
  std::atomic<std::size_t> lost = ensemble.size();
  for_share(ensemble, Kicked::grain, threads_for(ensemble.size(), 1, threads), [&](std::size_t begin, std::size_t end) {
    Midpoints midpoints({one->position, one->velocity, one->mass, static_cast<int>(D), stride}, dt, outside);
    for (std::size_t first = begin; first < end; first += most_of_block) {
      std::size_t const count = std::min(most_of_block, end - first);
      for (std::size_t k = 0; k < count; ++k) {
        std::size_t const i = first + k;
        double const *start = one->rows.data() + i * stride, *now = ensemble.row(i);
        std::copy_n(start, stride, midpoints.row(k));
        for (int const c : one->driven) midpoints.row(k)[c] = 0.5 * (start[c] + now[c]);
        midpoints.set(k, start, half_step ? half_step + i * D : now + one->velocity, one->outside.data() + i * D);
        if (!rests.empty() && rests[i]) midpoints.leave_out(k);
      }
      if (std::size_t const k = midpoints.find(first, count); k < count) {
        std::size_t before = lost;
        while (first + k < before && !lost.compare_exchange_weak(before, first + k)) {
        }
      }
      for (std::size_t k = 0; k < count; ++k) {
        std::size_t const i = first + k;
        if (!rests.empty() && rests[i]) continue;
        double* const now = ensemble.row(i);
        for (std::size_t a = 0; a < D; ++a) {
          double& v = half_step ? half_step[i * D + a] : now[one->velocity + static_cast<int>(a)];
          double const mid = midpoints.mid(k, static_cast<int>(a)), change = 2 * (mid - v);
          now[one->position + static_cast<int>(a)] =
              one->rows[i * stride + static_cast<std::size_t>(one->position) + a] + dt * mid;
          v += change;
          if (half_step) now[one->velocity + static_cast<int>(a)] += change;
        }
      }
    }
  });
  if (lost < ensemble.size()) refuse(dt, fmt::format("of particle {} of '{}' ", lost.load(), ensemble.name()), 1);
}

}  // namespace boltzmann
