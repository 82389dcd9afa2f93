// The stages of each method, for fields that have rates of their own.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/integrators/driven_fields.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/newton.hpp>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>
#include <vector>

namespace boltzmann {
namespace {

constexpr std::size_t field_grain = 2048;

/// The driven fields of all particles as numbers that Gauss-Radau advances.
class FieldEquations final : public EquationsOfMotion {
 public:
  explicit FieldEquations(AnyEnsemble& ensemble) : ensemble_(ensemble) {
    for (auto const& field : ensemble.driven())
      if (!field.sum) numbers_ += static_cast<std::size_t>(field.components);
  }
  AnyEnsemble& ensemble() override { return ensemble_; }
  bool second_order() const override { return false; }
  std::size_t numbers() const override { return numbers_; }
  void read(double* numbers, double*) override {
    each([&](std::size_t at, double& x, double) { numbers[at] = x; });
  }
  void write(double const* numbers, double const*) override {
    each([&](std::size_t at, double& x, double) { x = numbers[at]; });
  }
  void rates(double* rates) override {
    each([&](std::size_t at, double&, double rate) { rates[at] = rate; });
  }

 private:
  template <class F>
  void each(F const& f) {
    std::size_t first = 0;
    for (std::size_t k = 0; k < ensemble_.driven().size(); ++k) {
      auto const field = ensemble_.driven()[k];
      if (field.sum) continue;
      double const* rate = ensemble_.rate(k);
      std::size_t const stride = ensemble_.rate_stride(), components = static_cast<std::size_t>(field.components);
      for (std::size_t i = 0; i < ensemble_.size(); ++i) {
        double* const x = ensemble_.row(i) + field.offset;
        for (std::size_t c = 0; c < components; ++c) f(i * numbers_ + first + c, x[c], rate[i * stride + c]);
      }
      first += components;
    }
  }

  AnyEnsemble& ensemble_;
  std::size_t numbers_ = 0;
};

class WithDrivenFields final : public Integrator {
 public:
  WithDrivenFields(std::unique_ptr<Integrator> inner, AnyEnsemble& ensemble)
      : inner_(std::move(inner)), ensemble_(ensemble), equations_(ensemble), numbers_(equations_.numbers()) {
    Field const* velocity = ensemble.find_field("velocity");
    // Of classes that move by Newton's law alone nobody predicts the velocity.
    bool const newton = ensemble.moves_as() == typeid(Newton<1>) || ensemble.moves_as() == typeid(Newton<2>) ||
                        ensemble.moves_as() == typeid(Newton<3>);
    if (method() == Method::leap_frog && newton && velocity) velocity_ = velocity->offset;
  }

  Method method() const override { return inner_->method(); }
  int stages() const override { return inner_->stages(); }
  double time_after(int stage) const override { return inner_->time_after(stage); }
  bool same_for_all() const override { return inner_->same_for_all(); }
  std::span<std::uint32_t const> resting() const override { return inner_->resting(); }
  std::vector<Carried> carried() override {
    auto all = inner_->carried();
    std::size_t const size = ensemble_.size();
    for (auto* numbers : {&start_, &sum_})
      for (std::size_t k = 0; size > 0 && k < numbers->size() / size; ++k)
        all.push_back({numbers->data() + k * size, 1});
    if (!velocities_.empty()) all.push_back({velocities_.data(), static_cast<std::size_t>(ensemble_.dimension())});
    return all;
  }
  std::string undivided() const override { return inner_->undivided(); }
  void divide(Division* division) override { inner_->divide(division); }
  bool has_groups() const override { return inner_->has_groups(); }
  bool takes_rotations() const override { return inner_->takes_rotations(); }
  void rotate(std::vector<Rotation> rotations) override { inner_->rotate(std::move(rotations)); }
  EquationsOfMotion* equations_of_motion() override { return inner_->equations_of_motion(); }
  EquationsOfMotion* equations_of_fields() { return equations_of_motion() ? &equations_ : nullptr; }

  Motion advance(int stage, StepContext const& context) override {
    inner_->threads(threads_);
    double const dt = context.dt;
    if (velocity_ >= 0 && stage == 0) keep_velocities();
    if (velocity_ >= 0 && stage == 1) take_back_velocities();
    Motion const motion = inner_->advance(stage, context);
    if (velocity_ >= 0 && stage == 0) predict_velocities();
    advance_fields(stage, dt);
    move_ = inner_->largest_move();
    if (stage + 1 == stages()) {
      diffuse(context);
      take_periods_off();
      find_not_finite();
    }
    return motion;
  }

 private:
  // ---- Fields ----

  void advance_fields(int stage, double dt) {
    start_.resize(numbers_ * ensemble_.size());
    switch (method()) {
      case Method::euler:
        return each([dt](double& x, double&, double&, double rate) { x += dt * rate; });
      case Method::leap_frog:
        if (stage == 0)
          return each([dt](double& x, double& first, double&, double rate) {
            first = rate;
            x += dt * rate;
          });
        return each([dt](double& x, double& first, double&, double rate) { x += 0.5 * dt * (rate - first); });
      case Method::rk2:
      case Method::random_walk:
        if (stage == 0)
          return each([dt](double& x, double& x0, double&, double rate) {
            x0 = x;
            x = x0 + 0.5 * dt * rate;
          });
        return each([dt](double& x, double& x0, double&, double rate) { x = x0 + dt * rate; });
      default:
        return by_rk4(stage, dt);
    }
  }
  void by_rk4(int stage, double dt) {
    sum_.resize(start_.size());
    if (stage == 0)
      return each([dt](double& x, double& x0, double& sum, double rate) {
        x0 = x;
        sum = rate;
        x = x0 + 0.5 * dt * rate;
      });
    if (stage == 3)
      return each([dt](double& x, double& x0, double& sum, double rate) { x = x0 + dt / 6 * (sum + rate); });
    double const h = stage == 1 ? 0.5 * dt : dt;
    each([h](double& x, double& x0, double& sum, double rate) {
      sum += 2 * rate;
      x = x0 + h * rate;
    });
  }

  /// f(x, number at the start of the step, sum of rates, rate) for every number that is driven.
  template <class F>
  void each(F const& f) {
    over_particles([ this, f ](std::size_t begin, std::size_t end) __attribute__((noinline)) {
      std::size_t const stride = ensemble_.rate_stride(), row = ensemble_.stride();
      std::size_t first = 0;
      for (std::size_t k = 0; k < ensemble_.driven().size(); ++k) {
        auto const field = ensemble_.driven()[k];
        if (field.sum) continue;
        std::size_t const components = static_cast<std::size_t>(field.components);
        double const* const rates = ensemble_.rate(k);
        double* const rows = ensemble_.row(0) + field.offset;
        for (std::size_t c = 0; c < components; ++c, ++first) {
          double *const start = start_.data() + first * ensemble_.size(), *const sum =
                                                                              sum_.data() +
                                                                              first *
                                                                                  (sum_.empty() ? 0 : ensemble_.size());
          double none = 0;
          bool const summed = !sum_.empty();
          for (std::size_t i = begin; i < end; ++i)
            f(rows[i * row + c], start[i], summed ? sum[i] : none, rates[i * stride + c]);
        }
      }
    });
  }
  template <class F>
  void over_particles(F const& f) {
    for_share(ensemble_, field_grain, threads_for(ensemble_.size(), 1, threads_), f);
  }

  /// A random step of variance 2 D dt; the coefficients stand behind the rates.
  void diffuse(StepContext const& context) {
    std::size_t place = ensemble_.driven().size();
    for (std::size_t k = 0; k < ensemble_.driven().size(); ++k) {
      auto const field = ensemble_.driven()[k];
      if (!field.diffuses) continue;
      double const* const coefficients = ensemble_.rate(place++);
      over_particles([&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          double const deviation = std::sqrt(2 * coefficients[i * ensemble_.rate_stride()] * std::abs(context.dt));
          // Fields of one particle have ids of their own.
          Stream stream(context.seed, context.step, (static_cast<std::uint64_t>(k) << 48) | i,
                        Purpose::field_diffusion);
          double* const x = ensemble_.row(i) + field.offset;
          for (int c = 0; c < field.components; ++c) x[c] += deviation * stream.normal();
        }
      });
    }
  }

  /// Angles and the like are taken back into their period.
  void take_periods_off() {
    for (auto const& field : ensemble_.driven()) {
      if (!(field.period > 0)) continue;
      over_particles([&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          for (int c = 0; c < field.components; ++c) {
            double& x = ensemble_.row(i)[field.offset + c];
            if (!(std::abs(x) <= 0.5 * field.period)) x -= field.period * std::nearbyint(x / field.period);
          }
      });
    }
  }

  /// The first particle that has a field which is not finite.
  void find_not_finite() {
    std::mutex found;
    over_particles([&](std::size_t begin, std::size_t end) {
      for (auto const& field : ensemble_.driven())
        for (int c = 0; c < field.components; ++c) {
          double zero = 0;  // 0 times any number is 0, or NaN
          for (std::size_t i = begin; i < end; ++i) zero += 0 * ensemble_.row(i)[field.offset + c];
          for (std::size_t i = begin; i < end && zero != 0; ++i)
            if (!std::isfinite(ensemble_.row(i)[field.offset + c])) {
              std::lock_guard const lock(found);
              move_.not_finite = std::min(move_.not_finite, i);
              break;
            }
        }
    });
  }

  // ---- Velocities ----
  // Leap-frog calculates influences in the middle of its kicks, where the velocity is that of the half step. Rates (and
  // laws that read it) get the one that the step will end with, as far as the last acceleration tells; the inner method
  // gets its own back.

  template <class F>
  void each_velocity(F const& f) {
    std::size_t const D = static_cast<std::size_t>(ensemble_.dimension());
    velocities_.resize(D * ensemble_.size());
    over_particles([&, D](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        for (std::size_t c = 0; c < D; ++c)
          f(ensemble_.row(i)[static_cast<std::size_t>(velocity_) + c], velocities_[i * D + c]);
    });
  }
  void keep_velocities() {
    each_velocity([](double& v, double& kept) { kept = v; });
  }
  void predict_velocities() {
    each_velocity([](double& v, double& kept) {
      double const half = v;
      v = half + (half - kept);
      kept = half;
    });
  }
  void take_back_velocities() {
    each_velocity([](double& v, double& kept) { v = kept; });
  }

  std::unique_ptr<Integrator> inner_;
  AnyEnsemble& ensemble_;
  FieldEquations equations_;
  std::size_t numbers_;
  int velocity_ = -1;  // where it stands in a row, if it is predicted
  std::vector<double> start_, sum_, velocities_;
};

}  // namespace

EquationsOfMotion* equations_of_fields(Integrator& integrator) {
  auto* const with_fields = dynamic_cast<WithDrivenFields*>(&integrator);
  return with_fields ? with_fields->equations_of_fields() : nullptr;
}

std::unique_ptr<Integrator> with_driven_fields(std::unique_ptr<Integrator> integrator, AnyEnsemble& ensemble) {
  Method const method = integrator->method();
  auto const& driven = ensemble.driven();
  bool const some = std::any_of(driven.begin(), driven.end(), [](DrivenField const& field) { return !field.sum; });
  if (!some || method == Method::deactivate) return integrator;
  auto const refuse = [&](std::string const& why) {
    return Error("ensemble '" + ensemble.name() + "' of class " + ensemble.class_name() + " can't be advanced by " +
                 to_string(method) + ": " + why);
  };
  if (method == Method::reversible_leap_frog)
    throw refuse("fields with rates of their own can't be taken back to the bit; use leap-frog or rk4");
  if (method == Method::symplectic_4)
    throw refuse(
        "its order holds for positions and velocities, not for fields with rates of their own; use rk4, "
        "leap-frog or gauss-radau");
  bool diffuses = false, folded = false;
  for (auto const& field : driven) {
    diffuses = diffuses || field.diffuses;
    folded = folded || field.period > 0;
  }
  if (method == Method::gauss_radau && folded)
    throw refuse("a field with a period jumps, which is no smooth motion; leave out the period, or use rk4");
  if (method == Method::gauss_radau && diffuses)
    throw refuse("a field diffuses, and its random steps are no smooth motion; use rk4, rk2 or leap-frog");
  return std::make_unique<WithDrivenFields>(std::move(integrator), ensemble);
}

}  // namespace boltzmann
