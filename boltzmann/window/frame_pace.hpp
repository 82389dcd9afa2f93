// FramePace: throttles drawing. It decides after which steps of a run a frame is drawn, so that drawing stays within
// its share of the time.
#pragma once

#include <boltzmann/core/clock.hpp>
#include <boltzmann/window/clients.hpp>

#include <cstdint>
#include <functional>

namespace boltzmann {

class FramePace {
 public:
  /// `patient`: an observation costs more than a step, so that clients wait until it fits into its share of the time,
  /// but at most a third of a second.
  explicit FramePace(Clients& clients, bool patient = false) : clients_(clients), patient_(patient) {}

  /// 0: unthrottled.
  std::int64_t steps_per_frame() const { return steps_per_frame_; }
  void steps_per_frame(std::int64_t steps) { steps_per_frame_ = steps; }

  /// Starts at this step.
  void start(std::int64_t step);
  /// True if clients should observe this step. Called after every step, often more than once; the decision for a step
  /// holds until the next step. `needed`: a client is waiting; `hurried`: currently unthrottled.
  bool due(std::int64_t step, bool needed, bool hurried);
  /// The number of steps until the next frame, if frames are at a fixed interval of steps.
  std::int64_t steps_to_frame(bool hurried) const;
  /// The first step since the last frame is done: the time in between was the cost of the frame.
  void resumed(bool hurried);
  /// Draws for the clients, and waits if steps are faster than the requested pace, until `turned` returns true because
  /// another action was requested.
  void draw(bool hurried, std::function<bool()> const& turned);

  /// Measured over half a second or more, from calls with the current step.
  void count(std::int64_t step);
  double steps_per_second() const { return steps_per_second_; }

 private:
  bool paced(bool hurried) const { return steps_per_frame_ > 0 && !hurried && clients_.watched(); }
  bool decide(bool hurried);
  void keep_pace(std::function<bool()> const& turned);
  Clock::time_point afford();

  bool answers_now() const;

  Clients& clients_;
  bool patient_;
  std::int64_t steps_per_frame_ = 0;
  std::int64_t decided_step_ = 0;  // the step of the decision due_
  bool decided_ = false, due_ = false;
  std::int64_t since_frame_ = 0;                                   // steps
  std::int64_t steps_since_clock_ = 0, steps_between_clocks_ = 1;  // steps without reading the clock
  Clock::time_point next_frame_{}, next_affordable_{}, begun_frame_{}, last_look_{};
  Clock::time_point counted_since_{};
  std::int64_t counted_from_ = 0;
  double steps_per_second_ = 0;
};

}  // namespace boltzmann
