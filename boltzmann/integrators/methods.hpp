// The methods of integration, each as its textbook has it, on the equations of motion that the particle class gives
// (P::rate).
#pragma once

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/integrators/integrator.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <vector>

namespace boltzmann {
namespace detail {

inline constexpr std::size_t integrator_grain = 8192;

template <class P>
inline constexpr bool has_velocity = requires(P p) {
  p.velocity;
  p.mass;
};
template <class P>
inline constexpr bool has_viscosity = requires(P p) {
  p.viscosity;
};

/// p + a rate, field by field.
template <class P>
[[gnu::always_inline]] inline P moved(P const& p, double a, P const& rate) {
  using Doubles = std::array<double, row_doubles<P>>;
  auto x = std::bit_cast<Doubles>(p);
  auto const dx = std::bit_cast<Doubles>(rate);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] += a * dx[k];
  return std::bit_cast<P>(x);
}

/// x rounded to a multiple of the quantum (a power of two), half to even: the same for x and -x.
[[gnu::always_inline]] inline double on_grid(double x, double quantum) {
  double const rounding = 1.5 * 4503599627370496.0 * quantum;
  return (x + rounding) - rounding;
}

template <class P>
class MethodOf : public Integrator {
 public:
  explicit MethodOf(Ensemble<P>& ensemble, Method method) : ensemble_(ensemble), method_(method) {}
  Method method() const override { return method_; }

 protected:
  /// The time derivative of every field of particle i (Eq 3.5, 3.8, ...).
  [[gnu::always_inline]] P rate(std::size_t i) const {
    P const& p = ensemble_[i];
    return P::template rate<P>(p, ensemble_.influence_on(i));
  }

  /// Calls function(i, LargestMove&) for every particle.
  template <class Function>
  void each(Function const& function) {
    std::size_t const size = ensemble_.size();
    move_ = {};
    if (size <= integrator_grain || threads_ <= 1) {
      for (std::size_t i = 0; i < size; ++i) function(i, move_);
      return;
    }
    std::vector<LargestMove> parts((size + integrator_grain - 1) / integrator_grain);
    for_ranges(size, integrator_grain, threads_, [&](std::size_t begin, std::size_t end) {
      LargestMove part;
      for (std::size_t i = begin; i < end; ++i) function(i, part);
      parts[begin / integrator_grain] = part;
    });
    for (auto const& part : parts) move_.take(part);
  }

  Ensemble<P>& ensemble_;

 private:
  Method method_;
};

template <class P>
class Deactivate final : public MethodOf<P> {
 public:
  using MethodOf<P>::MethodOf;
  int stages() const override { return 0; }
  double time_after(int) const override { return 1; }
  Motion advance(int, StepContext const&) override { return Motion::none; }
};

template <class P>
class EulerMethod final : public MethodOf<P> {
 public:
  using MethodOf<P>::MethodOf;
  int stages() const override { return 1; }
  double time_after(int) const override { return 1; }
  Motion advance(int, StepContext const& context) override {
    double const dt = context.dt;
    this->each([&](std::size_t i, LargestMove& move) {
      P& p = this->ensemble_[i];
      P const next = moved(p, dt, this->rate(i));
      move.take(norm2(next.position - p.position), i);
      p = next;
    });
    return Motion::final;
  }
};

template <class P>
class LeapFrog final : public MethodOf<P> {
 public:
  using MethodOf<P>::MethodOf;
  int stages() const override { return 2; }
  double time_after(int) const override { return 1; }
  Motion advance(int stage, StepContext const& context) override {
    double const dt = context.dt;
    if (stage == 0) {
      this->each([&](std::size_t i, LargestMove& move) {
        P& p = this->ensemble_[i];
        kick(p, i, 0.5 * dt);
        auto const drift = dt * this->rate(i).position;
        move.take(norm2(drift), i);
        p.position += drift;
      });
      return Motion::final;
    }
    auto const moved_in_drift = this->move_;
    this->each([&](std::size_t i, LargestMove& move) {
      P& p = this->ensemble_[i];
      kick(p, i, 0.5 * dt);
      move.take(norm2(p.velocity), i);
    });
    if (this->move_.not_finite == LargestMove::nobody) this->move_ = moved_in_drift;
    return Motion::none;
  }

 private:
  [[gnu::always_inline]] void kick(P& p, std::size_t i, double dt) {
    auto const position = p.position;
    p = moved(p, dt, this->rate(i));
    p.position = position;
  }
};

template <class P>
class ReversibleLeapFrog final : public MethodOf<P> {
 public:
  using MethodOf<P>::MethodOf;
  int stages() const override { return 2; }
  double time_after(int) const override { return 1; }
  void prepare(FixedPoint const& grid) override {
    grid_ = grid;
    for (P& p : this->ensemble_) {
      p.position = map(p.position, [&](double x) { return on_grid(x, grid.position); });
      p.velocity = map(p.velocity, [&](double v) { return on_grid(v, grid.velocity); });
    }
  }
  Motion advance(int stage, StepContext const& context) override {
    double const dt = context.dt;
    auto const kick = [&](P& p, std::size_t i) {
      p.velocity += map(this->rate(i).velocity, [&](double a) { return on_grid(0.5 * dt * a, grid_.velocity); });
    };
    // Beyond this, numbers are no longer multiples of their quantum.
    double const furthest = 2251799813685248.0 * grid_.position, fastest = 2251799813685248.0 * grid_.velocity;
    if (stage == 0) {
      this->each([&](std::size_t i, LargestMove& move) {
        P& p = this->ensemble_[i];
        kick(p, i);
        auto const drift = map(p.velocity, [&](double v) { return on_grid(dt * v, grid_.position); });
        move.take(norm2(drift), i);
        p.position += drift;
        if (!(norm2(p.position) < furthest * furthest)) move.take(std::numeric_limits<double>::infinity(), i);
      });
      return Motion::final;
    }
    auto const moved_in_drift = this->move_;
    this->each([&](std::size_t i, LargestMove& move) {
      P& p = this->ensemble_[i];
      kick(p, i);
      if (!(norm2(p.velocity) < fastest * fastest)) move.take(std::numeric_limits<double>::infinity(), i);
    });
    if (this->move_.not_finite == LargestMove::nobody) this->move_ = moved_in_drift;
    return Motion::none;
  }

 private:
  FixedPoint grid_;
};

template <class P>
class Rk2 : public MethodOf<P> {
 public:
  using MethodOf<P>::MethodOf;
  int stages() const override { return 2; }
  double time_after(int stage) const override { return stage == 0 ? 0.5 : 1; }
  Motion advance(int stage, StepContext const& context) override {
    double const dt = context.dt;
    start_.resize(this->ensemble_.size());
    if (stage == 0) {
      this->each([&](std::size_t i, LargestMove&) {
        P& p = this->ensemble_[i];
        start_[i] = p;
        p = moved(start_[i], 0.5 * dt, this->rate(i));
      });
      return Motion::intermediate;
    }
    this->each([&](std::size_t i, LargestMove& move) {
      P& p = this->ensemble_[i];
      p = moved(start_[i], dt, this->rate(i));
      move.take(norm2(p.position - start_[i].position), i);
    });
    return Motion::final;
  }

 private:
  std::vector<P> start_;
};

template <class P>
class Rk4 final : public MethodOf<P> {
 public:
  using MethodOf<P>::MethodOf;
  int stages() const override { return 4; }
  double time_after(int stage) const override { return stage < 2 ? 0.5 : 1; }
  Motion advance(int stage, StepContext const& context) override {
    double const dt = context.dt;
    start_.resize(this->ensemble_.size());
    sum_.resize(this->ensemble_.size());
    switch (stage) {
      case 0:
        this->each([&](std::size_t i, LargestMove&) {
          P& p = this->ensemble_[i];
          start_[i] = p;
          sum_[i] = this->rate(i);
          p = moved(start_[i], 0.5 * dt, sum_[i]);
        });
        return Motion::intermediate;
      case 1:
        inner(0.5 * dt);
        return Motion::intermediate;
      case 2:
        inner(dt);
        return Motion::intermediate;
      default:
        this->each([&](std::size_t i, LargestMove& move) {
          P& p = this->ensemble_[i];
          p = moved(start_[i], dt / 6, moved(sum_[i], 1.0, this->rate(i)));
          move.take(norm2(p.position - start_[i].position), i);
        });
        return Motion::final;
    }
  }

 private:
  void inner(double dt) {
    this->each([&](std::size_t i, LargestMove&) {
      P const rate = this->rate(i);
      sum_[i] = moved(sum_[i], 2.0, rate);
      this->ensemble_[i] = moved(start_[i], dt, rate);
    });
  }

  std::vector<P> start_, sum_;
};

template <class P>
class RandomWalk final : public Rk2<P> {
 public:
  using Rk2<P>::Rk2;
  Motion advance(int stage, StepContext const& context) override {
    Motion const motion = Rk2<P>::advance(stage, context);
    if (motion == Motion::final)
      if constexpr (has_viscosity<P>)
        for (std::size_t i = 0; i < this->ensemble_.size(); ++i) {
          P& p = this->ensemble_[i];
          Stream stream(context.seed, context.step, i, Purpose::random_walk);
          double const deviation = std::sqrt(2 * p.viscosity * std::abs(context.dt));
          for (int a = 0; a < P::dimension; ++a) p.position[a] += deviation * stream.normal();
        }
    return motion;
  }
};

}  // namespace detail

/// The integrator of an ensemble. Error if its class can't be advanced that way.
template <class P>
std::unique_ptr<Integrator> make_integrator(Ensemble<P>& ensemble, Method method) {
  auto const refuse = [&](std::string const& reason) -> std::unique_ptr<Integrator> {
    throw Error("ensemble '" + ensemble.name() + "' of class " + ensemble.class_name() + " can't be advanced by " +
                to_string(method) + ": " + reason);
  };
  if constexpr (!detail::has_velocity<P>)
    if (method == Method::leap_frog || method == Method::reversible_leap_frog)
      return refuse("the class has no velocity that a force could change; use euler, rk2 or rk4");
  if (detail::has_viscosity<P> && method != Method::random_walk && method != Method::deactivate)
    return refuse("viscous vortices diffuse; use random-walk (or the class Inviscid)");
  if (!detail::has_viscosity<P> && method == Method::random_walk)
    return refuse("the class has no viscosity; use euler, rk2 or rk4");
  switch (method) {
    case Method::euler:
      return std::make_unique<detail::EulerMethod<P>>(ensemble, method);
    case Method::rk2:
      return std::make_unique<detail::Rk2<P>>(ensemble, method);
    case Method::rk4:
      return std::make_unique<detail::Rk4<P>>(ensemble, method);
    case Method::random_walk:
      return std::make_unique<detail::RandomWalk<P>>(ensemble, method);
    case Method::deactivate:
      return std::make_unique<detail::Deactivate<P>>(ensemble, method);
    case Method::leap_frog:
      if constexpr (detail::has_velocity<P>) return std::make_unique<detail::LeapFrog<P>>(ensemble, method);
      break;
    case Method::reversible_leap_frog:
      if constexpr (detail::has_velocity<P>) return std::make_unique<detail::ReversibleLeapFrog<P>>(ensemble, method);
      break;
  }
  return refuse("unknown method");
}

}  // namespace boltzmann
