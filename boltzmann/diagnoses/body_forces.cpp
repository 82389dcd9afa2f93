// Differences between successive samples.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/body_forces.hpp>

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace boltzmann {

BodyForces::BodyForces(std::vector<AnyEnsemble const*> const& available,
                       std::optional<std::array<double, 3>> const& stream, double length)
    : length_(length) {
  for (auto const* ensemble : available)
    if (is_body(*ensemble)) bodies_.push_back(ensemble->name());
  if (bodies_.empty()) throw Error("there is no body; [[bodies]] are");
  if (stream) stream_ = {(*stream)[0], (*stream)[1]};
  if (length_ > 0 && !(std::hypot(stream_[0], stream_[1]) > 0))
    throw Error("coefficients need the velocity of the stream; add stream = [1, 0]");
}

std::vector<Column> BodyForces::columns() const {
  using namespace dimensions;
  Dimension const force = velocity * velocity * length;
  std::vector<Column> all{{"force x", force}, {"force y", force}};
  if (length_ > 0) all.push_back({"drag coefficient", none}), all.push_back({"lift coefficient", none});
  for (auto const& name : bodies_)
    for (char const* axis : {"x", "y"}) all.push_back({name + " pressure " + axis, force});
  return all;
}

namespace {

/// The pressure force on a body, from the change of its sheet since a time. Pressures of neighbouring panels differ by
/// half of the changes along each of them.
std::array<double, 2> pressure_force(AnyEnsemble const& body, double const* before, double const* shed, double passed) {
  int const normal = body.field("normal").offset, length = body.field("length").offset;
  int const sheet = body.field("sheet").offset;
  double rising = 0, half_before = 0, x = 0, y = 0, around = 0;
  std::size_t const count = body.size();
  auto const slope = [&](std::size_t i) {
    double const* const row = body.row(i);
    return -(row[sheet] - before[i] + shed[i]) / passed * row[length];
  };
  for (std::size_t i = 0; i < count; ++i) around += slope(i);  // zero up to rounding, as the pressure is single-valued
  for (std::size_t i = 0; i < count; ++i) {
    double const* const row = body.row(i);
    double const half = 0.5 * (slope(i) - around / static_cast<double>(count));
    rising += half_before + half, half_before = half;
    double const pressure = rising - 0.25 * (row[sheet] * row[sheet] + before[i] * before[i]);
    x -= pressure * row[normal] * row[length], y -= pressure * row[normal + 1] * row[length];
  }
  return {x, y};
}

}  // namespace

void BodyForces::follow(Sample const& sample) {
  if (!last_) return;
  double const passed = sample.time - last_->followed_until;
  if (passed == 0) return;
  // Within a step kutta changes the circulation; at its end vortices may be removed.
  double const now = flow_impulse(sample.ensembles).circulation, gone = sample.taken.circulation - last_->gone;
  last_->circulation_time += 0.5 * (last_->circulation + now + gone) * passed;
  last_->circulation = now, last_->gone = sample.taken.circulation;
  std::size_t at = 0;
  for (auto const* ensemble : sample.ensembles) {
    if (!is_body(*ensemble)) continue;
    int const flux = ensemble->field("flux").offset;
    for (std::size_t i = 0; i < ensemble->size() && at < last_->shed.size(); ++i, ++at)
      last_->shed[at] += ensemble->row(i)[flux] * passed;
  }
  last_->followed_until = sample.time;
}

void BodyForces::measure(Sample const& sample, std::vector<double>& values) {
  follow(sample);
  FlowImpulse const flow = flow_impulse(sample.ensembles);
  Look now;
  now.time = now.followed_until = sample.time;
  now.impulse = {flow.impulse[0] + sample.taken.impulse[0], flow.impulse[1] + sample.taken.impulse[1]};
  now.circulation = flow.circulation, now.gone = sample.taken.circulation;
  std::vector<AnyEnsemble const*> bodies;
  for (auto const* ensemble : sample.ensembles)
    if (is_body(*ensemble)) {
      bodies.push_back(ensemble);
      int const sheet = ensemble->field("sheet").offset;
      for (std::size_t i = 0; i < ensemble->size(); ++i) now.sheet.push_back(ensemble->row(i)[sheet]);
    }
  bool const known = last_ && now.time != last_->time && last_->sheet.size() == now.sheet.size();
  if (!known) {
    values.insert(values.end(), columns().size(), std::numeric_limits<double>::quiet_NaN());
  } else {
    double const passed = now.time - last_->time, circulation = last_->circulation_time / passed;
    double const fx = -(now.impulse[0] - last_->impulse[0]) / passed + circulation * stream_[1];
    double const fy = -(now.impulse[1] - last_->impulse[1]) / passed - circulation * stream_[0];
    values.push_back(fx), values.push_back(fy);
    if (length_ > 0) {
      double const speed = std::hypot(stream_[0], stream_[1]), unit = 0.5 * speed * speed * length_;
      values.push_back((fx * stream_[0] + fy * stream_[1]) / speed / unit);
      values.push_back((fy * stream_[0] - fx * stream_[1]) / speed / unit);
    }
    std::size_t at = 0;
    for (auto const* body : bodies) {
      auto const force = pressure_force(*body, &last_->sheet[at], &last_->shed[at], passed);
      values.insert(values.end(), force.begin(), force.end());
      at += body->size();
    }
  }
  now.shed.assign(now.sheet.size(), 0.0);
  last_ = std::move(now);
}

std::vector<double> BodyForces::state() const {
  if (!last_) return {};
  Look const& l = *last_;
  std::vector<double> all{l.time,        l.impulse[0], l.impulse[1],      l.followed_until,
                          l.circulation, l.gone,       l.circulation_time};
  all.insert(all.end(), l.sheet.begin(), l.sheet.end());
  all.insert(all.end(), l.shed.begin(), l.shed.end());
  return all;
}

void BodyForces::restore(std::span<double const> state) {
  last_.reset();
  if (state.empty()) return;
  constexpr std::size_t before_panels = 7;
  if (state.size() < before_panels || (state.size() - before_panels) % 2 != 0)
    throw Error("the checkpoint does not fit this simulation: it has no forces on bodies");
  auto const panels = state.begin() + before_panels;
  auto const half = panels + static_cast<std::ptrdiff_t>((state.size() - before_panels) / 2);
  last_ =
      Look{state[0], {state[1], state[2]}, state[3], state[4], state[5], state[6], {panels, half}, {half, state.end()}};
}

}  // namespace boltzmann
