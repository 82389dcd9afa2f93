// Stored samples, and comparisons with later ones.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/diagnoses/chosen.hpp>
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/diagnoses/statistics.hpp>
#include <boltzmann/diagnoses/time_correlation.hpp>
#include <boltzmann/diagnoses/unknown.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace boltzmann {
namespace {

/// Subtracts the mean over all particles.
void subtract_mean(std::vector<double>& values, std::size_t D) {
  auto const count = static_cast<double>(values.size() / D);
  for (std::size_t a = 0; a < D; ++a) {
    ExactSum sum;
    for (std::size_t k = a; k < values.size(); k += D) sum += values[k];
    double const mean = sum.value() / count;
    for (std::size_t k = a; k < values.size(); k += D) values[k] -= mean;
  }
}

/// The sums over particles of the contributions of their components, and of the squares.
template <class OfComponent>
std::array<double, 2> sums_over(std::span<double const> then, std::span<double const> now, std::size_t D,
                                OfComponent of) {
  ExactSum sum, squares;
  for (std::size_t k = 0; k < now.size(); k += D) {
    double value = 0;
    for (std::size_t a = 0; a < D; ++a) value += of(then[k + a], now[k + a]);
    sum += value;
    squares += value * value;
  }
  return {sum.value(), squares.value()};
}

}  // namespace

std::vector<double> running_integral(std::span<double const> values, double spacing) {
  std::vector<double> integral;
  for (std::size_t k = 0; k < values.size(); ++k)
    integral.push_back(k == 0 ? 0.0 : integral.back() + 0.5 * spacing * (values[k - 1] + values[k]));
  return integral;
}

TimeCorrelation::TimeCorrelation(std::vector<AnyEnsemble const*> const& available, Options options)
    : options_(std::move(options)), prefixed_(!options_.ensembles.empty() || available.size() > 1) {
  check_chosen(available, options_.ensembles, options_.particles);
  auto const names = chosen_names(available, options_.ensembles);
  if (!options_.label.empty() && names.size() != 1)
    throw Error(fmt::format("a label belongs to one ensemble; name one of {}", join(names)));
  for (auto const& name : names) {
    Followed& one = followed_.emplace_back();
    one.name = name;
    one.sums = one.squares = one.numbers = std::vector<double>(options_.count + 1, 0.0);
  }
  if (options_.every < 1 || options_.count < 1 || options_.origins < 1)
    throw Error("a time correlation needs samples ('every'), lags ('count') and origins, one or more of each");
  dimension_ = available.front()->dimension();
  spacing_ = std::max<std::size_t>(1, (options_.count + options_.origins - 1) / options_.origins);
}

std::vector<std::uint32_t> TimeCorrelation::members(AnyEnsemble const& ensemble) const {
  return members_of(ensemble, options_.particles);
}

void TimeCorrelation::note_time(Sample const& sample) {
  if (looks_ == 1) interval_ = sample.time - first_time_;
  if (looks_ > 1 && std::abs(sample.time - last_time_ - interval_) > 1e-6 * std::abs(interval_))
    throw Error(
        fmt::format("a time correlation needs equal sampling intervals; {} follows {}, before that the interval was {}",
                    sample.time, last_time_, interval_));
  if (looks_ == 0) first_time_ = sample.time;
  last_time_ = sample.time;
  ++looks_;
}

void TimeCorrelation::follow(Sample const& sample) {
  auto const step = static_cast<double>(sample.step);
  if (sample.time < options_.since || (begun_ != 0 && step == step_)) return;
  bool const first = begun_ == 0;
  begun_ = 1;
  step_ = step;
  for (auto& one : followed_) {
    AnyEnsemble const& ensemble = ensemble_of(sample, one.name);
    auto const D = static_cast<std::size_t>(dimension_);
    std::size_t const size = options_.particles.empty() ? ensemble.size() : options_.particles.size();
    if (!first && one.now.size() != D * size)
      throw Error(fmt::format("a time correlation follows the {} particles of '{}', which has {} now",
                              one.now.size() / D, one.name, ensemble.size()));
    see(ensemble, sample.box, first, one);
  }
  if (sample.step % static_cast<std::int64_t>(options_.every) != 0) return;
  auto const look = static_cast<std::size_t>(looks_);
  note_time(sample);
  for (auto& one : followed_) {
    for (auto& origin : one.origins) ++origin.age;
    if (!one.origins.empty() && one.origins.front().age > options_.count) one.origins.pop_front();
    std::vector<double> kept;
    if (options_.subtract_drift) {
      kept = one.now;
      subtract_mean(one.now, static_cast<std::size_t>(dimension_));
    }
    if (look % spacing_ == 0) one.origins.push_back({0, one.now});
    compare(one);
    if (options_.subtract_drift) one.now = std::move(kept);
  }
}

void TimeCorrelation::compare(Followed& one) const {
  auto const D = static_cast<std::size_t>(dimension_);
  for (auto const& origin : one.origins) {
    auto const [sum, squares] = compared(origin.values, one.now);
    one.sums[origin.age] += sum;
    one.squares[origin.age] += squares;
    one.numbers[origin.age] += static_cast<double>(one.now.size() / D);
  }
}

void TimeCorrelation::measure(Sample const& sample, std::vector<double>& values) {
  follow(sample);
  for (auto const& one : followed_) add_values(one, values);
}

std::vector<double> TimeCorrelation::lags(Followed const& followed) const {
  std::vector<double> lags;
  for (std::size_t k = 0; k < followed.numbers.size() && followed.numbers[k] > 0; ++k)
    lags.push_back(static_cast<double>(k) * std::abs(interval_));
  return lags;
}

std::vector<double> TimeCorrelation::means(Followed const& followed) const {
  std::vector<double> means;
  for (std::size_t k = 0; k < followed.numbers.size() && followed.numbers[k] > 0; ++k)
    means.push_back(followed.sums[k] / followed.numbers[k]);
  return means;
}

std::vector<double> TimeCorrelation::state() const {
  std::vector<double> state{looks_, begun_, step_, first_time_, last_time_, interval_};
  for (auto const& one : followed_) {
    for (auto const* list : {&one.now, &one.last, &one.sums, &one.squares, &one.numbers}) add_list(state, *list);
    state.push_back(static_cast<double>(one.origins.size()));
    for (auto const& origin : one.origins) {
      state.push_back(static_cast<double>(origin.age));
      add_list(state, origin.values);
    }
  }
  return state;
}

void TimeCorrelation::restore(std::span<double const> state) {
  StateReader reader(state);
  for (double* number : {&looks_, &begun_, &step_, &first_time_, &last_time_, &interval_}) *number = reader.next();
  for (auto& one : followed_) {
    for (auto* list : {&one.now, &one.last, &one.sums, &one.squares, &one.numbers}) *list = reader.list();
    if (one.sums.size() != options_.count + 1 || one.numbers.size() != one.sums.size())
      throw Error("the checkpoint does not fit this diagnosis: it has other lags");
    one.origins.clear();
    for (auto left = static_cast<std::size_t>(reader.next()); left > 0; --left) {
      auto const age = static_cast<std::size_t>(reader.next());
      one.origins.push_back({age, reader.list()});
      if (age > options_.count || one.origins.back().values.size() != one.now.size())
        throw Error("the checkpoint does not fit this diagnosis: it follows other particles");
    }
  }
  reader.finish();
}

// ---- Velocities ----

VelocityAutocorrelation::VelocityAutocorrelation(std::vector<AnyEnsemble const*> const& available,
                                                 Options const& options)
    : TimeCorrelation(available, options) {
  for (auto const& one : followed())
    for (auto const* ensemble : available)
      if (ensemble->name() == one.name && !has_velocities(*ensemble))
        throw Error(fmt::format("ensemble '{}' of class {} has no velocity", one.name, ensemble->class_name()));
}

std::vector<Column> VelocityAutocorrelation::columns() const {
  std::vector<Column> columns;
  for (auto const& one : followed())
    columns.push_back({labelled(label(one), "diffusion coefficient from velocities"), dimensions::diffusivity});
  return columns;
}

void VelocityAutocorrelation::see(AnyEnsemble const& ensemble, Box const&, bool, Followed& followed) const {
  auto const D = static_cast<std::size_t>(dimension());
  Velocities const velocities = velocities_of(ensemble);
  auto const which = members(ensemble);
  followed.now.resize(D * which.size());
  for (std::size_t k = 0; k < which.size(); ++k) std::copy_n(velocities[which[k]], D, &followed.now[D * k]);
}

std::array<double, 2> VelocityAutocorrelation::compared(std::span<double const> then,
                                                        std::span<double const> now) const {
  return sums_over(then, now, static_cast<std::size_t>(dimension()), [](double a, double b) { return a * b; });
}

void VelocityAutocorrelation::add_values(Followed const& followed, std::vector<double>& values) const {
  auto const c = means(followed);
  bool const whole = c.size() == options().count + 1;  // otherwise it is too short
  values.push_back(whole ? running_integral(c, std::abs(interval())).back() / dimension() : unknown);
}

std::vector<GatheredTable> VelocityAutocorrelation::tables() const {
  using namespace dimensions;
  std::vector<GatheredTable> tables;
  for (auto const& one : followed()) {
    auto const c = means(one);
    auto diffusion = running_integral(c, std::abs(interval()));
    for (double& d : diffusion) d /= dimension();
    std::vector<double> normalised, frequency, spectrum;
    for (double const x : c) normalised.push_back(x / c[0]);
    // From 0 to half the sampling frequency, as fine as the lags allow.
    std::size_t const n = c.size() < 2 ? 0 : c.size() - 1;
    double const dt = std::abs(interval());
    for (std::size_t k = 0; n > 0 && k <= n; ++k) {
      double sum = 0;
      for (std::size_t j = 0; j <= n; ++j) {
        double const phase = std::numbers::pi * static_cast<double>(j) / static_cast<double>(n);
        double const window = 0.5 * (1 + std::cos(phase));
        sum += (j == 0 || j == n ? 0.5 : 1.0) * c[j] * window * std::cos(phase * static_cast<double>(k));
      }
      frequency.push_back(static_cast<double>(k) / (2 * static_cast<double>(n) * dt));
      spectrum.push_back(4 * dt * sum);
    }
    tables.push_back({file_name("velocity-autocorrelation", label(one)),
                      {{"lag", dimensions::time},
                       {"velocity autocorrelation", velocity * velocity},
                       {"normalised", none},
                       {"diffusion coefficient", diffusivity}},
                      {lags(one), c, normalised, diffusion}});
    tables.push_back(
        {file_name("velocity-spectrum", label(one)),
         {{"frequency", dimensions::frequency}, {"velocity spectrum", velocity * velocity / dimensions::frequency}},
         {frequency, spectrum}});
  }
  return tables;
}

// ---- Displacements ----

MeanSquareDisplacement::MeanSquareDisplacement(std::vector<AnyEnsemble const*> const& available, Options const& options)
    : TimeCorrelation(available, options) {}

std::vector<Column> MeanSquareDisplacement::columns() const {
  std::vector<Column> columns;
  for (auto const& one : followed())
    columns.push_back({labelled(label(one), "diffusion coefficient from displacements"), dimensions::diffusivity});
  return columns;
}

void MeanSquareDisplacement::see(AnyEnsemble const& ensemble, Box const& box, bool first, Followed& followed) const {
  auto const D = static_cast<std::size_t>(dimension());
  auto const which = members(ensemble);
  if (first) followed.now.assign(D * which.size(), 0.0), followed.last.assign(D * which.size(), 0.0);
  for (std::size_t i = 0; i < which.size(); ++i) {
    double const* x = ensemble.row(which[i]);
    double moved[3] = {0, 0, 0};
    for (std::size_t a = 0; a < D; ++a) moved[a] = first ? 0 : x[a] - followed.last[D * i + a];
    box.nearest_image(moved);
    for (std::size_t a = 0; a < D; ++a) {
      followed.last[D * i + a] = x[a];
      followed.now[D * i + a] += moved[a];
    }
  }
}

std::array<double, 2> MeanSquareDisplacement::compared(std::span<double const> then,
                                                       std::span<double const> now) const {
  return sums_over(then, now, static_cast<std::size_t>(dimension()),
                   [](double a, double b) { return (b - a) * (b - a); });
}

void MeanSquareDisplacement::add_values(Followed const& followed, std::vector<double>& values) const {
  auto const r2 = means(followed), t = lags(followed);
  bool const whole = r2.size() == options().count + 1;
  std::size_t const half = r2.size() / 2;
  values.push_back(whole ? fit_line(std::span(t).subspan(half), std::span(r2).subspan(half)).slope.mean /
                               (2 * dimension())
                         : unknown);
}

std::vector<GatheredTable> MeanSquareDisplacement::tables() const {
  std::vector<GatheredTable> tables;
  double const D = dimension();
  for (auto const& one : followed()) {
    auto const r2 = means(one);
    std::vector<double> shape;
    for (std::size_t k = 0; k < r2.size(); ++k)
      shape.push_back(r2[k] > 0 ? D * one.squares[k] / one.numbers[k] / ((D + 2) * r2[k] * r2[k]) - 1 : unknown);
    tables.push_back({file_name("mean-square-displacement", label(one)),
                      {{"lag", dimensions::time},
                       {"mean square displacement", dimensions::area},
                       {"non-Gaussian parameter", dimensions::none}},
                      {lags(one), r2, shape}});
  }
  return tables;
}

}  // namespace boltzmann
