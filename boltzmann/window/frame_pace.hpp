// FramePace: after which steps of a run a frame is drawn, so that drawing takes its share of the time and no more.
#pragma once

#include <boltzmann/core/clock.hpp>
#include <boltzmann/window/clients.hpp>

#include <cstdint>
#include <functional>

namespace boltzmann {

class FramePace {
 public:
  /// `patient`: a look costs more than a step, so that those who call wait until it fits into its share of the time, but
  /// a third of a second at most.
  explicit FramePace(Clients& clients, bool patient = false) : clients_(clients), patient_(patient) {}

  /// 0: steps are as fast as they can be.
  std::int64_t steps_per_frame() const { return steps_per_frame_; }
  void steps_per_frame(std::int64_t steps) { steps_per_frame_ = steps; }

  /// Steps go on from here.
  void start(std::int64_t step);
  /// Whether anybody should look at this step: asked after every step, often more than once; what is said of a step
  /// holds until the next one. `needed`: somebody has to; `hurried`: steps are as fast as they can be, for now.
  bool due(std::int64_t step, bool needed, bool hurried);
  /// How many steps there are until the next frame, if it comes after so many.
  std::int64_t steps_to_frame(bool hurried) const;
  /// A step has been done since the last frame: all that passed in between, the frame has cost.
  void resumed(bool hurried);
  /// Draws for those who look, and waits where steps are faster than was asked for, until `turned` says that something
  /// else is wanted.
  void draw(bool hurried, std::function<bool()> const& turned);

  /// Counted over half a second or more, by looks at a step.
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
  std::int64_t decided_step_ = 0;  // the step that due_ is about
  bool decided_ = false, due_ = false;
  std::int64_t since_frame_ = 0;                                   // steps
  std::int64_t steps_since_clock_ = 0, steps_between_clocks_ = 1;  // steps without a look at the clock
  Clock::time_point next_frame_{}, next_affordable_{}, begun_frame_{}, last_look_{};
  Clock::time_point counted_since_{};
  std::int64_t counted_from_ = 0;
  double steps_per_second_ = 0;
};

}  // namespace boltzmann
