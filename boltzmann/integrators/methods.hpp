// The methods of integration in their textbook forms, on the equations of motion of the particle class (P::equations).
#pragma once

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/integrators/integrator.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/motion.hpp>
#include <boltzmann/particles/smooth.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace boltzmann {
namespace detail {

inline constexpr std::size_t integrator_grain = 2048;

template <class P>
inline constexpr bool has_velocity = requires(P p) {
  p.velocity;
  p.mass;
};

/// Calls f(x, ...) for one number, or for each component of vectors.
template <class F>
[[gnu::always_inline]] inline void each_component(F const& f, double const& x) {
  f(x);
}
template <class F, class... Real>
[[gnu::always_inline]] inline void each_component(F const& f, double& x, Real&... more) {
  f(x, more...);
}
template <class F, int D>
[[gnu::always_inline]] inline void each_component(F const& f, Vector<D> const& x) {
  for (int a = 0; a < D; ++a) f(x.component[a]);
}
template <class F, int D, class... V>
[[gnu::always_inline]] inline void each_component(F const& f, Vector<D>& x, V&... more) {
  [&]<std::size_t... A>(std::index_sequence<A...>) {
    auto const one = [&](auto a) { f(x.component[a], more.component[a]...); };
    (one(std::integral_constant<std::size_t, A>{}), ...);
  }
  (std::make_index_sequence<D>{});
}
template <class F, int D, class... T>
[[gnu::always_inline]] inline void each_component(F const& f, Tensor<D>& x, T&... more) {
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) f(x.component[a][b], more.component[a][b]...);
}

template <class F, int D>
[[gnu::always_inline]] inline void each_component(F const& f, Tensor<D> const& x) {
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) f(x.component[a][b]);
}

/// True if a scheme may advance some fields of P inside a step (see Solid).
template <class P>
inline constexpr bool may_lag = requires(P& p) {
  p.lag;
  p.kick;
};
/// True for the position among the fields that the equations of motion name.
template <class P, class Member>
inline constexpr bool is_position = std::is_same_v<Member, decltype(&P::position)>;

/// True if P has equations of motion of its own, on a vector as influence.
template <class P>
inline constexpr bool has_own_kicks =
    !std::is_same_v<P, Newton<P::dimension>> && std::is_same_v<typename P::Influence, Vector<P::dimension>>;

/// True if a rate of P, other than that of the position, depends on a field that has such a rate (a friction or a
/// Coriolis force in the equations of the class). Determined by evaluation.
template <class P>
bool kicks_read_what_they_change() {
  static_assert(sizeof(P) % sizeof(double) == 0);
  constexpr std::size_t numbers = sizeof(P) / sizeof(double);
  auto const rates = [](P const& p, std::vector<double>& all) {
    typename P::Influence influence;
    each_component([](double& x) { x = 0.75; }, influence);
    P::equations(p, influence, [&](auto member, auto const& derivative) {
      if constexpr (!is_position<P, decltype(member)>)
        each_component([&](double const& rate) { all.push_back(rate); }, derivative);
    });
  };
  for (std::uint64_t trial = 0; trial < 16; ++trial) {
    Stream stream(0, trial, 0, Purpose::velocity);
    P p;
    for (std::size_t k = 0; k < numbers; ++k) reinterpret_cast<double*>(&p)[k] = 0.5 + stream.uniform();
    std::vector<double> before, after;
    rates(p, before);
    P changed = p;
    P::equations(p, typename P::Influence{}, [&](auto member, auto const&) {
      if constexpr (!is_position<P, decltype(member)>)
        each_component([&](double& x) { x += stream.uniform(); }, changed.*member);
    });
    rates(changed, after);
    for (std::size_t k = 0; k < before.size(); ++k)
      if (std::isfinite(before[k]) && before[k] != after[k]) return true;
  }
  return false;
}

/// The same for classes for which it is not known at compile time.
template <class P>
bool kicks_are_solved() {
  if constexpr (has_own_kicks<P>) {
    static bool const reads = kicks_read_what_they_change<P>();
    return reads;
  } else {
    return false;
  }
}

/// x rounded to a multiple of the quantum (a power of two), half to even: the same for x and -x.
[[gnu::always_inline]] inline double on_grid(double x, double quantum) {
  double const rounding = 1.5 * 4503599627370496.0 * quantum;
  return (x + rounding) - rounding;
}

/// The rows of an ensemble as particles of P, the class whose motion applies.
template <class P>
class MovingRows {
 public:
  explicit MovingRows(AnyEnsemble& ensemble) : ensemble_(ensemble) {}
  AnyEnsemble& whole() const { return ensemble_; }
  std::size_t size() const { return ensemble_.size(); }
  std::size_t stride() const { return ensemble_.stride(); }
  double* row(std::size_t i) const { return ensemble_.row(i); }
  P& operator[](std::size_t i) const { return *reinterpret_cast<P*>(ensemble_.row(i)); }
  typename P::Influence& influence_on(std::size_t i) const {
    return *reinterpret_cast<typename P::Influence*>(ensemble_.influence(i));
  }

 private:
  AnyEnsemble& ensemble_;
};

template <class P>
class MethodOf : public Integrator {
 public:
  explicit MethodOf(AnyEnsemble& ensemble, Method method) : ensemble_(ensemble), method_(method) {}
  Method method() const override { return method_; }
  bool accompany(Companion* companion) override {
    companion_ = companion;
    return true;
  }

 protected:
  /// Calls rate(member, derivative) for every field of particle i that changes in time (Eq 3.5, 3.8, ...). All
  /// derivatives are computed before the first call, so that rate may write to the particle.
  template <class Rate>
  [[gnu::always_inline]] void equations(std::size_t i, Rate const& rate) const {
    P const& p = ensemble_[i];
    typename P::Influence const& influence = ensemble_.influence_on(i);
    P derivatives;
    P::equations(p, influence, [&](auto member, auto const& derivative) {
      each_component([](double& to, double const& from) { to = from; }, derivatives.*member, derivative);
    });
    P::equations(p, influence, [&](auto member, auto const&) { rate(member, derivatives.*member); });
  }

  /// Calls function(i, LargestMove&) for every particle of this rank. The loop has one compiled instance, for one
  /// thread and for several: in two instances the compiler may contract a product and a sum differently. The loop is
  /// not vectorised: numbers of a row are written singly, and vector loads of them would stall. Local copies in
  /// `function` stay in registers.
  template <class Function>
  void each(Function const& function) {
    auto const own_loop = [&function](Stretch const* first, Stretch const* last)
        __attribute__((noinline, optimize("no-tree-vectorize"))) {
      Function const own = function;
      LargestMove part;
      for (; first != last; ++first)
        for (std::size_t i = first->begin, end = first->end; i < end; ++i) own(i, part);
      return part;
    };
    auto const loop = [&own_loop, this](Stretch const* first, Stretch const* last) {
      return companion_ ? in_blocks(*companion_, own_loop, first, last) : own_loop(first, last);
    };
    move_ = {};
    if (Share const* const share = ensemble_.whole().share()) {
      auto const& stretches = share->stretches;
      std::vector<LargestMove> parts(stretches.size());
      for_stretches(stretches, threads_for(share->size, 1, threads_), [&](Stretch const* first, Stretch const* last) {
        parts[static_cast<std::size_t>(first - stretches.data())] = loop(first, last);
      });
      for (auto const& part : parts) move_.take(part);
      return;
    }
    std::size_t const size = ensemble_.size();
    if (threads_for(size, 1, threads_) == 1) {
      Stretch const all{0, size};
      move_ = loop(&all, &all + 1);
      return;
    }
    std::vector<LargestMove> parts((size + integrator_grain - 1) / integrator_grain);
    for_ranges(size, integrator_grain, threads_, [&](std::size_t begin, std::size_t end) {
      Stretch const range{begin, end};
      parts[begin / integrator_grain] = loop(&range, &range + 1);
    });
    for (auto const& part : parts) move_.take(part);
  }

  /// The same loop, block by block, with a companion.
  template <class Loop>
  static LargestMove in_blocks(Companion& companion, Loop const& loop, Stretch const* first, Stretch const* last) {
    LargestMove all;
    Companion::Own const own = [&all, &loop](std::size_t begin, std::size_t end) {
      Stretch const block{begin, end};
      all.take(loop(&block, &block + 1));
    };
    for (; first != last; ++first)
      for (std::size_t begin = first->begin, end = begin; begin < first->end; begin = end) {
        end = std::min(begin + Companion::most_particles, first->end);
        companion.around(begin, end, own);
      }
    return all;
  }

  /// Registers an array with an entry for each particle, or none; an array of another size is outdated.
  template <class T>
  void carry(std::vector<T>& of_particles, std::vector<Integrator::Carried>& all) const {
    static_assert(sizeof(T) % sizeof(double) == 0);
    if (!of_particles.empty() && of_particles.size() == ensemble_.size())
      all.push_back({reinterpret_cast<double*>(of_particles.data()), sizeof(T) / sizeof(double)});
  }

  MovingRows<P> ensemble_;

 private:
  Method method_;
  Companion* companion_ = nullptr;
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
    this->each([this, dt](std::size_t i, LargestMove& move) {
      P& p = this->ensemble_[i];
      auto const start = p.position;
      this->equations(i, [&](auto member, auto const& derivative) {
        each_component([&](double& x, double rate) { x += dt * rate; }, p.*member, derivative);
      });
      move.take(norm2(p.position - start), i);
    });
    return Motion::final;
  }
};

/// The drift of the position and the kick of everything else, as the leap-frogs alternate them.
template <class P>
class Alternating : public MethodOf<P> {
 public:
  using MethodOf<P>::MethodOf;
  int stages() const override { return 2; }
  double time_after(int) const override { return 1; }

 protected:
  /// increment(x, dx) applies an increment to a field.
  template <class Increment>
  [[gnu::always_inline]] void kick(std::size_t i, double dt, Increment const& increment) {
    P& p = this->ensemble_[i];
    this->equations(i, [&](auto member, auto const& derivative) {
      if constexpr (!is_position<P, decltype(member)>)
        each_component([&](double& x, double rate) { increment(x, dt * rate); }, p.*member, derivative);
    });
  }
  template <class Increment>
  [[gnu::always_inline]] void drift(std::size_t i, double dt, LargestMove& move, Increment const& increment) {
    P& p = this->ensemble_[i];
    auto const start = p.position;
    this->equations(i, [&](auto member, auto const& derivative) {
      if constexpr (is_position<P, decltype(member)>)
        each_component([&](double& x, double rate) { increment(x, dt * rate); }, p.*member, derivative);
    });
    move.take(norm2(p.position - start), i);
  }
  /// A kick of the fields that the scheme does not advance (see Solid); increment(x, dx).
  template <class Increment>
  void kick_but_lagging(std::size_t i, double dt, Increment const& increment) {
    bool const completed = this->ensemble_.influence_on(i).is_completed != 0;
    P& p = this->ensemble_[i];
    this->equations(i, [&](auto member, auto const& derivative) {
      if constexpr (!is_position<P, decltype(member)>) {
        double const time = completed && P::lags(member) ? 0 : dt;
        each_component([&](double& x, double rate) { increment(x, time * rate); }, p.*member, derivative);
      }
    });
  }
  /// Both halves of the first kick of leap-frog and the drift between them. The second half is a prediction; its
  /// increments are stored in `predicted`. The heat of half a kick is the work at its mean velocity.
  void kick_before_scheme(std::size_t i, double dt, LargestMove& move, double* predicted, double* half_step) {
    P& p = this->ensemble_[i];
    auto const& influence = this->ensemble_.influence_on(i);
    auto const start = p.velocity;
    kick_but_lagging(i, 0.5 * dt, [](double& x, double dx) { x += dx; });
    p.correct_heat(influence, (p.velocity - start) * 0.5, 0.5 * dt);
    drift(i, dt, move, [](double& x, double dx) { x += dx; });
    auto const middle = p.velocity;
    each_component([&](double x) { *half_step++ = x; }, middle);
    double const heat = p.specific_energy;
    kick_but_lagging(i, 0.5 * dt, [&](double& x, double dx) {
      *predicted++ = dx;
      x += dx;
    });
    p.kick = p.velocity - middle;
    p.ahead = 0;
    if (influence.is_completed != 0) {
      p.lag = dt;
      p.ahead = heat - p.specific_energy;  // the scheme predicts it
      p.specific_energy = heat;
    }
  }
  /// The second kick. The heating is corrected to the velocity at its end, also for the kick that follows.
  void kick_after_scheme(std::size_t i, double dt, double const* predicted) {
    P& p = this->ensemble_[i];
    auto& influence = this->ensemble_.influence_on(i);
    auto const start = p.velocity;
    p.specific_energy -= p.ahead;
    kick_but_lagging(i, 0.5 * dt, [&](double& x, double dx) { x += dx - *predicted++; });
    auto const change = p.velocity - start;
    p.correct_heat(influence, (change - p.kick) * 0.5, 0.5 * dt);
    influence.heating -= dot(influence.inner_force, change);
    p.kick = {};
    p.lag = p.ahead = 0;
  }
  /// Runs the second kick, and keeps the largest move of the drift.
  template <class Function>
  void each_again(Function const& function) {
    auto const drifted = this->move_;
    this->each(function);
    if (this->move_.not_finite == LargestMove::nobody) this->move_ = drifted;
  }
};

/// Alternating kicks and drifts, of fourth order if influences depend on positions (and time) only: the method SRKN6b
/// of S. Blanes and P. C. Moan, J. Comput. Appl. Math. 142, 313 (2002), Table 3. It is symmetric, so its second half
/// has the coefficients of the first in reverse order. The last kick of a step and the first of the next have the same
/// influences: six evaluations a step.
template <class P>
class Symplectic4 final : public Alternating<P> {
 public:
  using Alternating<P>::Alternating;
  int stages() const override { return 7; }
  double time_after(int stage) const override {
    double time = 0;
    for (int k = 0; k <= stage; ++k) time += drifts[k];
    return stage >= 5 ? 1 : time;
  }
  Motion advance(int stage, StepContext const& context) override {
    double const of_kick = kicks[stage] * context.dt, of_drift = drifts[stage] * context.dt;
    auto const plain = [](double& x, double dx) { x += dx; };
    if (stage == 6) {
      this->each_again([this, of_kick, plain](std::size_t i, LargestMove& move) {
        this->kick(i, of_kick, plain);
        move.take(norm2(this->ensemble_[i].velocity), i);
      });
      return Motion::none;
    }
    if (stage == 0) {
      start_.resize(this->ensemble_.size());
      for (std::size_t i = 0; i < start_.size(); ++i) start_[i] = this->ensemble_[i].position;
    }
    this->each([this, of_kick, of_drift, plain](std::size_t i, LargestMove& move) {
      this->kick(i, of_kick, plain);
      LargestMove part;
      this->drift(i, of_drift, part, plain);
      move.take(norm2(this->ensemble_[i].position - start_[i]), i);
    });
    return stage == 5 ? Motion::final : Motion::intermediate;
  }
  std::vector<Integrator::Carried> carried() override {
    std::vector<Integrator::Carried> all;
    this->carry(start_, all);
    return all;
  }

 private:
  static constexpr double b1 = 0.0829844064174052, b2 = 0.396309801498368, b3 = -0.0390563049223486;
  static constexpr double a1 = 0.245298957184271, a2 = 0.604872665711080, a3 = 0.5 - (a1 + a2);
  static constexpr double kicks[] = {b1, b2, b3, 1 - 2 * (b1 + b2 + b3), b3, b2, b1};
  static constexpr double drifts[] = {a1, a2, a3, a3, a2, a1, 0};

  std::vector<decltype(P::position)> start_;
};

/// The numbers for Gauss-Radau: positions, velocities and accelerations of classes that move by Newton's law; for other
/// classes every number that changes in time, and its rate.
template <class P>
class GaussRadauMethod final : public MethodOf<P>, public EquationsOfMotion {
 public:
  using MethodOf<P>::MethodOf;
  int stages() const override { return 0; }
  double time_after(int) const override { return 1; }
  Motion advance(int, StepContext const&) override { return Motion::none; }
  EquationsOfMotion* equations_of_motion() override { return this; }

  AnyEnsemble& ensemble() override { return this->ensemble_.whole(); }
  bool second_order() const override { return newton; }
  std::size_t numbers() const override {
    if (newton) return P::dimension;
    std::size_t count = 0;
    P const none{};
    P::equations(none, typename P::Influence{},
                 [&](auto, auto const& derivative) { count += sizeof(derivative) / sizeof(double); });
    return count;
  }
  void read(double* numbers, double* velocities) override {
    std::size_t const count = this->numbers();
    this->each([this, numbers, velocities, count](std::size_t i, LargestMove&) {
      P& p = this->ensemble_[i];
      double* to = numbers + count * i;
      if constexpr (newton) {
        for (std::size_t a = 0; a < P::dimension; ++a) to[a] = p.position[a];
        for (std::size_t a = 0; a < P::dimension; ++a) velocities[count * i + a] = p.velocity[a];
      } else {
        this->equations(i, [&](auto member, auto const&) { each_component([&](double& x) { *to++ = x; }, p.*member); });
      }
    });
  }
  void write(double const* numbers, double const* velocities) override {
    std::size_t const count = this->numbers();
    this->each([this, numbers, velocities, count](std::size_t i, LargestMove&) {
      P& p = this->ensemble_[i];
      double const* from = numbers + count * i;
      if constexpr (newton) {
        for (std::size_t a = 0; a < P::dimension; ++a) p.position[a] = from[a];
        for (std::size_t a = 0; a < P::dimension; ++a) p.velocity[a] = velocities[count * i + a];
      } else {
        this->equations(i,
                        [&](auto member, auto const&) { each_component([&](double& x) { x = *from++; }, p.*member); });
      }
    });
    this->move_ = {};
  }
  void rates(double* rates) override {
    std::size_t const count = this->numbers();
    this->each([this, rates, count](std::size_t i, LargestMove&) {
      double* to = rates + count * i;
      this->equations(i, [&](auto member, auto const& derivative) {
        if constexpr (!newton || !is_position<P, decltype(member)>)
          each_component([&](double const& rate) { *to++ = rate; }, derivative);
      });
    });
  }

 private:
  static constexpr bool newton = std::is_same_v<P, Newton<P::dimension>>;
};

/// With rotations (magnetic fields): turn, kick, drift; kick, turn. That is Boris' push, as seen from the whole steps.
/// If influences depend on the kicked fields (P::velocity_dependent), fields at the end of the drift are predicted; the
/// second kick subtracts the prediction and adds its own, which keeps second order. If the equations of the class
/// themselves depend on these fields, the second kick is solved for the fields at its end (see VelocityForces).
template <class P>
class LeapFrog final : public Alternating<P> {
 public:
  using Alternating<P>::Alternating;
  bool predicts_velocities() const override { return predicts; }
  double* half_step_velocities() override { return half_steps_.empty() ? nullptr : half_steps_.data(); }
  bool takes_rotations() const override { return true; }
  void rotate(std::vector<Rotation> rotations) override { rotations_ = std::move(rotations); }
  /// Rotations turn all particles before any is moved.
  bool accompany(Companion* companion) override { return rotations_.empty() && MethodOf<P>::accompany(companion); }
  Motion advance(int stage, StepContext const& context) override {
    double const dt = context.dt;
    auto const plain = [](double& x, double dx) { x += dx; };
    std::size_t const kicked = predicts ? this->kicked() : 0;
    if (stage == 0) {
      for (auto const& rotation : rotations_) turn(rotation, 0.5 * dt);
      if constexpr (predicts) kicks_.resize(kicked * this->ensemble_.size());
      if constexpr (predicts && may_lag<P>) half_steps_.resize(P::dimension * this->ensemble_.size());
      this->each([this, dt, plain, kicked](std::size_t i, LargestMove& move) {
        if constexpr (predicts && may_lag<P>)
          return this->kick_before_scheme(i, dt, move, kicks_.data() + kicked * i,
                                          half_steps_.data() + P::dimension * i);
        this->kick(i, 0.5 * dt, plain);
        this->drift(i, dt, move, plain);
        if constexpr (predicts) {
          double* predicted = kicks_.data() + kicked * i;
          this->kick(i, 0.5 * dt, [&](double& x, double dx) {
            *predicted++ = dx;
            x += dx;
          });
        }
      });
      return Motion::final;
    }
    if constexpr (has_own_kicks<P>)
      if (kicks_are_solved<P>()) return kick_to_solution(dt), end_of_step(dt);
    this->each_again([this, dt, plain, kicked](std::size_t i, LargestMove& move) {
      if constexpr (predicts) {
        double const* predicted = kicks_.data() + kicked * i;
        if constexpr (may_lag<P>)
          this->kick_after_scheme(i, dt, predicted);
        else
          this->kick(i, 0.5 * dt, [&](double& x, double dx) { x += dx - *predicted++; });
      } else {
        this->kick(i, 0.5 * dt, plain);
      }
      move.take(norm2(this->ensemble_[i].velocity), i);
    });
    return end_of_step(dt);
  }
  std::vector<Integrator::Carried> carried() override {
    if (kicks_.empty() || kicks_.size() != kicked() * this->ensemble_.size()) return {};
    return {{kicks_.data(), kicked()}};
  }

 private:
  static constexpr bool predicts = depends_on_velocity<P>;
  Motion end_of_step(double dt) {
    // In reverse order, so that the step is symmetric in time. A finite velocity stays finite.
    for (auto rotation = rotations_.rbegin(); rotation != rotations_.rend(); ++rotation) turn(*rotation, 0.5 * dt);
    return Motion::none;
  }
  /// x = x_half + (dt/2) rate(x) for all kicked fields, by iteration; particles without convergence count as not
  /// finite.
  void kick_to_solution(double dt) {
    constexpr int most_turns = 200;
    std::size_t const kicked = this->kicked();
    this->each_again([this, dt, kicked](std::size_t i, LargestMove& move) {
      P& p = this->ensemble_[i];
      if constexpr (predicts) {
        double const* predicted = kicks_.data() + kicked * i;
        this->equations(i, [&](auto member, auto const&) {
          if constexpr (!is_position<P, decltype(member)>)
            each_component([&](double& x) { x -= *predicted++; }, p.*member);
        });
      }
      P half = p;
      double change = 1, before = 2;
      for (int turn = 0; turn < most_turns && change > 0; ++turn) {
        before = std::exchange(change, 0);
        this->equations(i, [&](auto member, auto const& derivative) {
          if constexpr (!is_position<P, decltype(member)>)
            each_component(
                [&](double& x, double const& from, double rate) {
                  double const next = from + 0.5 * dt * rate;
                  change = std::max(change, std::abs(next - x) / (std::abs(next) + std::abs(from) + 1e-300));
                  x = next;
                },
                p.*member, half.*member, derivative);
        });
        if (turn > 2 && change >= before && change < 1e-12) break;  // only rounding is left
      }
      move.take(change < 1e-12 ? norm2(p.velocity) : std::numeric_limits<double>::infinity(), i);
    });
  }
  /// The number of kicked numbers of a particle.
  static std::size_t kicked() {
    std::size_t count = 0;
    P const nobody{};
    P::equations(nobody, typename P::Influence{}, [&](auto member, auto const& derivative) {
      if constexpr (!is_position<P, decltype(member)>) count += sizeof(derivative) / sizeof(double);
    });
    return count;
  }
  void turn(Rotation const& rotation, double time) {
    auto const& only = rotation.only;
    std::size_t const count = only ? only->size() : this->ensemble_.size();
    RotationTask const task{this->ensemble_.row(0), this->ensemble_.stride(), only ? only->data() : nullptr, time};
    auto const turn = [&](std::size_t begin, std::size_t end) { rotation.kernel(rotation.law, task, begin, end); };
    int const threads = threads_for(count, 1, this->threads_);
    if (only)
      for_ranges(count, integrator_grain, threads, turn);
    else
      for_share(this->ensemble_.whole(), integrator_grain, threads, turn);
  }

  std::vector<Rotation> rotations_;
  std::vector<double> kicks_;       // of the prediction, kicked() numbers a particle
  std::vector<double> half_steps_;  // half_step_velocities() of classes with fields that lag
};

template <class P>
class ReversibleLeapFrog final : public Alternating<P> {
 public:
  using Alternating<P>::Alternating;
  void prepare(FixedPoint const& grid) override {
    grid_ = grid;
    for (std::size_t i = 0; i < this->ensemble_.size(); ++i) {
      P& p = this->ensemble_[i];
      p.position = map(p.position, [&](double x) { return on_grid(x, grid.position); });
      p.velocity = map(p.velocity, [&](double v) { return on_grid(v, grid.velocity); });
    }
  }
  Motion advance(int stage, StepContext const& context) override {
    double const dt = context.dt;
    auto const of_velocity = [grid = grid_](double& v, double dv) { v += on_grid(dv, grid.velocity); };
    auto const of_position = [grid = grid_](double& x, double dx) { x += on_grid(dx, grid.position); };
    // Beyond this value numbers are no longer multiples of their quantum.
    double const furthest = square(2251799813685248.0 * grid_.position);
    double const fastest = square(2251799813685248.0 * grid_.velocity);
    double const infinite = std::numeric_limits<double>::infinity();
    if (stage == 0) {
      this->each([=, this](std::size_t i, LargestMove& move) {
        this->kick(i, 0.5 * dt, of_velocity);
        this->drift(i, dt, move, of_position);
        if (!(norm2(this->ensemble_[i].position) < furthest)) move.take(infinite, i);
      });
      return Motion::final;
    }
    this->each_again([=, this](std::size_t i, LargestMove& move) {
      this->kick(i, 0.5 * dt, of_velocity);
      if (!(norm2(this->ensemble_[i].velocity) < fastest)) move.take(infinite, i);
    });
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
    if (stage == 0) {
      start_.resize(this->ensemble_.size());
      this->each([this, dt](std::size_t i, LargestMove&) {
        P &p = this->ensemble_[i], &start = start_[i];
        this->equations(i, [&](auto member, auto const& derivative) {
          each_component(
              [&](double& x, double& x0, double rate) {
                x0 = x;
                x = x0 + 0.5 * dt * rate;
              },
              p.*member, start.*member, derivative);
        });
      });
      return Motion::intermediate;
    }
    this->each([this, dt](std::size_t i, LargestMove& move) {
      P &p = this->ensemble_[i], &start = start_[i];
      this->equations(i, [&](auto member, auto const& derivative) {
        each_component([&](double& x, double& x0, double rate) { x = x0 + dt * rate; }, p.*member, start.*member,
                       derivative);
      });
      move.take(norm2(p.position - start.position), i);
    });
    return Motion::final;
  }
  std::vector<Integrator::Carried> carried() override {
    std::vector<Integrator::Carried> all;
    this->carry(start_, all);
    return all;
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
  [[gnu::flatten]] Motion advance(int stage, StepContext const& context) override {
    double const dt = context.dt;
    switch (stage) {
      case 0:
        start_.resize(this->ensemble_.size());
        sum_.resize(this->ensemble_.size());
        each_field<false>([dt](double& x, double& x0, double& sum, double rate) {
          x0 = x;
          sum = rate;
          x = x0 + 0.5 * dt * rate;
        });
        return Motion::intermediate;
      case 1:
      case 2: {
        double const h = stage == 1 ? 0.5 * dt : dt;
        each_field<false>([h](double& x, double& x0, double& sum, double rate) {
          sum += 2 * rate;
          x = x0 + h * rate;
        });
        return Motion::intermediate;
      }
      default:
        each_field<true>([dt](double& x, double& x0, double& sum, double rate) { x = x0 + dt / 6 * (sum + rate); });
        return Motion::final;
    }
  }
  std::vector<Integrator::Carried> carried() override {
    std::vector<Integrator::Carried> all;
    this->carry(start_, all);
    this->carry(sum_, all);
    return all;
  }

 private:
  /// f(x, x at the start of the step, weighted sum of rates, rate) for every number that changes in time.
  template <bool at_end, class F>
  void each_field(F const& f) {
    this->each([this, f](std::size_t i, [[maybe_unused]] LargestMove& move) {
      P &p = this->ensemble_[i], &start = start_[i], &sum = sum_[i];
      this->equations(i, [&](auto member, auto const& derivative) {
        each_component(f, p.*member, start.*member, sum.*member, derivative);
      });
      if constexpr (at_end) move.take(norm2(p.position - start.position), i);
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
      if constexpr (walks_at_random<P>)
        for_share(this->ensemble_.whole(), integrator_grain, 1, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            P& p = this->ensemble_[i];
            Stream stream(context.seed, context.step, i, Purpose::random_walk);
            double const deviation = std::sqrt(2 * p.viscosity * std::abs(context.dt));
            for (int a = 0; a < P::dimension; ++a) p.position[a] += deviation * stream.normal();
          }
        });
    return motion;
  }
};

/// Moves the rows of an ensemble like class P; null if the method can't.
template <class P>
std::unique_ptr<Integrator> method_of(AnyEnsemble& ensemble, Method method) {
  switch (method) {
    case Method::deactivate:
      return std::make_unique<Deactivate<P>>(ensemble, method);
    case Method::random_walk:
      if constexpr (walks_at_random<P>) return std::make_unique<RandomWalk<P>>(ensemble, method);
      break;
    case Method::euler:
      if constexpr (!walks_at_random<P>) return std::make_unique<EulerMethod<P>>(ensemble, method);
      break;
    case Method::rk2:
      if constexpr (!walks_at_random<P>) return std::make_unique<Rk2<P>>(ensemble, method);
      break;
    case Method::rk4:
      if constexpr (!walks_at_random<P>) return std::make_unique<Rk4<P>>(ensemble, method);
      break;
    case Method::leap_frog:
      if constexpr (has_velocity<P>) return std::make_unique<LeapFrog<P>>(ensemble, method);
      break;
    case Method::reversible_leap_frog:
      if constexpr (has_velocity<P>)
        if (!kicks_are_solved<P>()) return std::make_unique<ReversibleLeapFrog<P>>(ensemble, method);
      break;
    case Method::symplectic_4:
      if constexpr (has_velocity<P> && !depends_on_velocity<P>)
        if (!kicks_are_solved<P>()) return std::make_unique<Symplectic4<P>>(ensemble, method);
      break;
    case Method::gauss_radau:
      if constexpr (!walks_at_random<P>) return std::make_unique<GaussRadauMethod<P>>(ensemble, method);
      break;
  }
  return nullptr;
}
// These are instantiated in the library.
extern template std::unique_ptr<Integrator> method_of<Newton<1>>(AnyEnsemble&, Method);
extern template std::unique_ptr<Integrator> method_of<Newton<2>>(AnyEnsemble&, Method);
extern template std::unique_ptr<Integrator> method_of<Newton<3>>(AnyEnsemble&, Method);
extern template std::unique_ptr<Integrator> method_of<Tracer<1>>(AnyEnsemble&, Method);
extern template std::unique_ptr<Integrator> method_of<Tracer<2>>(AnyEnsemble&, Method);
extern template std::unique_ptr<Integrator> method_of<Tracer<3>>(AnyEnsemble&, Method);
extern template std::unique_ptr<Integrator> method_of<Diffusive<2>>(AnyEnsemble&, Method);
extern template std::unique_ptr<Integrator> method_of<Inviscid<3>>(AnyEnsemble&, Method);
extern template std::unique_ptr<Integrator> method_of<Smooth<1>>(AnyEnsemble&, Method);
extern template std::unique_ptr<Integrator> method_of<Smooth<2>>(AnyEnsemble&, Method);
extern template std::unique_ptr<Integrator> method_of<Smooth<3>>(AnyEnsemble&, Method);
extern template std::unique_ptr<Integrator> method_of<Solid<1>>(AnyEnsemble&, Method);
extern template std::unique_ptr<Integrator> method_of<Solid<2>>(AnyEnsemble&, Method);
extern template std::unique_ptr<Integrator> method_of<Solid<3>>(AnyEnsemble&, Method);

}  // namespace detail

/// The default method for particles of a class: the random walk for viscous vortices, leap-frog for forces, else the
/// fourth-order Runge-Kutta method.
template <class P>
constexpr Method usual_method() {
  return detail::walks_at_random<P> ? Method::random_walk : detail::has_velocity<P> ? Method::leap_frog : Method::rk4;
}

/// The same for an ensemble. Error if its class has equations of motion of its own, which no class of the library has.
Method usual_method(AnyEnsemble const& ensemble);
std::unique_ptr<Integrator> usual_integrator(AnyEnsemble& ensemble);

/// The integrator of an ensemble whose rows begin with those of P and that moves like P. Error if the method can't
/// advance it.
template <class P>
std::unique_ptr<Integrator> make_integrator_as(AnyEnsemble& ensemble, Method method) {
  if (auto integrator = detail::method_of<detail::MovesAs<P>>(ensemble, method)) return integrator;
  throw Error("ensemble '" + ensemble.name() + "' of class " + ensemble.class_name() + " can't be advanced by " +
              to_string(method) + ": " +
              (detail::walks_at_random<P>      ? "viscous vortices diffuse; use random-walk (or the class Inviscid)"
               : method == Method::random_walk ? "the class has no viscosity; use euler, rk2 or rk4"
               : detail::has_velocity<P> ? "its influences depend on velocities; use leap-frog, rk4 or gauss-radau"
                                         : "the class has no velocity that a force could change; use euler, "
                                           "rk2, rk4 or gauss-radau"));
}

/// The integrator of an ensemble. Error if the method can't advance its class.
template <class P>
std::unique_ptr<Integrator> make_integrator(Ensemble<P>& ensemble, Method method) {
  return make_integrator_as<P>(ensemble, method);
}

}  // namespace boltzmann
