// Timing of frames, and the time that drawing may use.
#include <boltzmann/window/frame_pace.hpp>

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace boltzmann {
namespace {

constexpr double frames_per_second = 61;  // slightly above 60, because steps end at arbitrary times
constexpr double share_of_time = 0.035;   // fraction of the time of a run at full speed that drawing may use

Clock::duration period() { return clock_time(1 / frames_per_second); }

}  // namespace

void FramePace::start(std::int64_t step) {
  counted_since_ = last_look_ = next_frame_ = Clock::now();
  counted_from_ = step;
  decided_ = false;
  since_frame_ = 0;
}

bool FramePace::due(std::int64_t step, bool needed, bool hurried) {
  if (decided_ && step == decided_step_) return due_;
  decided_ = true;
  decided_step_ = step;
  due_ = needed || decide(hurried);
  if (due_) begun_frame_ = Clock::now();
  return due_;
}

bool FramePace::answers_now() const {
  if (!patient_) return true;
  auto const now = Clock::now();
  return now >= next_affordable_ || now >= begun_frame_ + clock_time(1.0 / 3);
}

bool FramePace::decide(bool hurried) {
  ++since_frame_;
  if (clients_.calls() && answers_now()) return true;
  if (paced(hurried)) return since_frame_ >= steps_per_frame_;
  if (!clients_.ready()) return false;
  // The clock is read some thousand times a second, not after every step.
  if (++steps_since_clock_ < steps_between_clocks_) return false;
  auto const now = Clock::now();
  double const took = seconds_between(last_look_, now);
  steps_between_clocks_ = took > 1e-3 ? std::max<std::int64_t>(steps_between_clocks_ / 2, 1)
                                      : std::min<std::int64_t>(2 * steps_between_clocks_, 1 << 20);
  last_look_ = now;
  steps_since_clock_ = 0;
  return now >= next_frame_;
}

std::int64_t FramePace::steps_to_frame(bool hurried) const {
  return paced(hurried) ? std::max<std::int64_t>(steps_per_frame_ - since_frame_, 1)
                        : std::numeric_limits<std::int64_t>::max();
}

void FramePace::resumed(bool hurried) {
  auto const affordable = afford();
  if (!paced(hurried)) next_frame_ = std::max(next_frame_, affordable);
}

void FramePace::draw(bool hurried, std::function<bool()> const& turned) {
  if (paced(hurried))
    keep_pace(turned);
  else if (clients_.send_updates())
    // Steps don't end when a frame is due. If a frame is late, the next one is scheduled earlier.
    next_frame_ = std::max({afford(), next_frame_ + period(), begun_frame_ + period() / 2});
}

/// Keeps the requested pace, even if browsers do not follow. If steps alone take longer, drawing is limited to its
/// share of the time.
void FramePace::keep_pace(std::function<bool()> const& turned) {
  bool const late = begun_frame_ > next_frame_ + period();
  if (!late || begun_frame_ >= next_affordable_)
    if (clients_.send_updates()) afford();
  if (since_frame_ < steps_per_frame_) return;
  since_frame_ = 0;
  for (auto now = Clock::now(); now < next_frame_ && !turned(); now = Clock::now()) {
    clients_.wait(std::min(seconds_between(now, next_frame_), 0.1));
    clients_.handle_requests();
    clients_.send_updates();
  }
  next_frame_ = std::max(next_frame_, Clock::now() - period()) + period();
}

/// The time at which the next drawing fits into its share, after one that has just been done.
Clock::time_point FramePace::afford() {
  auto const now = Clock::now();
  double const cost = seconds_between(begun_frame_, now) * (1 / share_of_time - 1);
  next_affordable_ = now + clock_time(cost);
  return next_affordable_;
}

void FramePace::count(std::int64_t step) {
  auto const now = Clock::now();
  double const passed = seconds_between(counted_since_, now);
  if (passed < 0.5) return;
  steps_per_second_ = static_cast<double>(std::abs(step - counted_from_)) / passed;
  counted_since_ = now;
  counted_from_ = step;
}

}  // namespace boltzmann
