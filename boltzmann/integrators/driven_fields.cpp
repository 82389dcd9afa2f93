// The stages of each method, for fields with rates of their own.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/integrators/driven_fields.hpp>
#include <boltzmann/integrators/field_kernels.hpp>
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

/// The driven fields of all particles as numbers for Gauss-Radau.
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

/// Advances fields in addition to an integrator, block by block within the integrator's own loop if it accepts a
/// companion.
class WithDrivenFields final : public Integrator, private Companion {
 public:
  WithDrivenFields(std::unique_ptr<Integrator> inner, AnyEnsemble& ensemble)
      : inner_(std::move(inner)), ensemble_(ensemble), equations_(ensemble) {
    Field const* velocity = ensemble.find_field("velocity");
    // No integrator predicts the velocity of classes that move by Newton's law alone.
    bool const newton = ensemble.moves_as() == typeid(Newton<1>) || ensemble.moves_as() == typeid(Newton<2>) ||
                        ensemble.moves_as() == typeid(Newton<3>);
    if (method() == Method::leap_frog && newton && velocity) velocity_ = velocity->offset;
    arrays_ = ensemble.driven().size();
    for (std::size_t k = 0; k < ensemble.driven().size(); ++k) {
      auto const& field = ensemble.driven()[k];
      for (std::size_t c = 0; c < components(k) && !field.sum; ++c)
        numbers_.push_back({static_cast<std::size_t>(field.offset) + c, k, c});
      arrays_ += field.diffuses ? 1 : 0;
      found_elsewhere_ = found_elsewhere_ || field.diffuses || field.sum;
    }
  }

  Method method() const override { return inner_->method(); }
  int stages() const override { return inner_->stages(); }
  double time_after(int stage) const override { return inner_->time_after(stage); }
  bool same_for_all() const override { return inner_->same_for_all(); }
  std::span<std::uint32_t const> resting() const override { return inner_->resting(); }
  std::vector<Carried> carried() override {
    auto all = inner_->carried();
    std::size_t const size = ensemble_.size();
    for (auto* numbers : {&start_, &sum_})  // the number of particles has changed
      for (std::size_t k = 0; size > 0 && numbers->size() % size == 0 && k < numbers->size() / size; ++k)
        all.push_back({numbers->data() + k * size, 1});
    std::size_t const D = static_cast<std::size_t>(ensemble_.dimension());
    if (!velocities_.empty() && velocities_.size() == D * size) all.push_back({velocities_.data(), D});
    return all;
  }
  std::string undivided() const override { return inner_->undivided(); }
  void divide(Division* division) override { inner_->divide(division); }
  bool has_groups() const override { return inner_->has_groups(); }
  bool predicts_velocities() const override { return inner_->predicts_velocities(); }
  double* half_step_velocities() override {
    return velocity_ >= 0 ? velocities_.data() : inner_->half_step_velocities();
  }
  bool takes_rotations() const override { return inner_->takes_rotations(); }
  void rotate(std::vector<Rotation> rotations) override { inner_->rotate(std::move(rotations)); }
  /// The rates of leap-frog belong to the state between its steps, and remain in the scheme.
  void rates_from(RateSource* source) override {
    bool const fits = arrays_ * ensemble_.rate_stride() <= most_numbers;
    source_ = fits && method() != Method::leap_frog ? source : nullptr;
  }
  EquationsOfMotion* equations_of_motion() override { return inner_->equations_of_motion(); }
  EquationsOfMotion* equations_of_fields() { return equations_of_motion() ? &equations_ : nullptr; }

  Motion advance(int stage, StepContext const& context) override {
    inner_->threads(threads_);
    stage_ = stage;
    context_ = &context;
    kernel_ = kernel();
    not_finite_ = LargestMove::nobody;
    make_room();
    bool const together = inner_->accompany(this);
    if (!together) over_particles([this](std::size_t begin, std::size_t end) { before(begin, end); });
    Motion const motion = inner_->advance(stage, context);
    if (!together)
      over_particles([this](std::size_t begin, std::size_t end) { after({begin, end, rates_of(ensemble_), 0}); });
    inner_->accompany(nullptr);
    if (source_) source_->take(together);
    move_ = inner_->largest_move();
    move_.not_finite = std::min(move_.not_finite, not_finite_);
    return motion;
  }

 private:
  static constexpr std::size_t most_numbers = 48;  // of a particle's rates, the capacity of a block

  void make_room() {
    std::size_t const size = ensemble_.size();
    start_.resize(numbers_.size() * size);
    if (method() == Method::rk4) sum_.resize(numbers_.size() * size);
    if (velocity_ >= 0) velocities_.resize(static_cast<std::size_t>(ensemble_.dimension()) * size);
  }

  // ---- Blocks ----

  /// Particles [begin, end), and their rates; the first rates are those of particle `first`.
  struct Block {
    std::size_t begin, end;
    RatePlaces rates;
    std::size_t first;
  };

  void around(std::size_t begin, std::size_t end, Own const& own) override {
    if (!source_ || !source_->left()) {
      before(begin, end);
      own(begin, end);
      return after({begin, end, rates_of(ensemble_), 0});
    }
    std::size_t const D = ensemble_.rate_stride();
    double numbers[most_numbers * most_particles];
    source_->evaluate(begin, end, numbers, most_particles);
    before(begin, end);
    own(begin, end);
    after({begin, end, {numbers, D * most_particles, most_particles, 1}, begin});
  }
  void before(std::size_t begin, std::size_t end) {
    if (velocity_ < 0) return;
    if (stage_ == 0)
      each_velocity(begin, end, [](double& v, double& kept) { kept = v; });
    else if (stage_ == 1)
      each_velocity(begin, end, [](double& v, double& kept) { v = kept; });
  }
  void after(Block const& block) {
    if (velocity_ >= 0 && stage_ == 0) predict_velocities(block.begin, block.end);
    bool const finite = advance_fields(block);
    if (stage_ + 1 < stages()) return;
    diffuse(block);
    take_periods_off(block);
    if (!finite || found_elsewhere_) find_not_finite(block);
  }
  /// For driven field k, or for a diffusion coefficient.
  std::size_t components(std::size_t k) const {
    return k < ensemble_.driven().size() ? static_cast<std::size_t>(ensemble_.driven()[k].components) : 1;
  }
  template <class F>
  void over_particles(F const& f) {
    for_share(ensemble_, field_grain, threads_for(ensemble_.size(), 1, threads_), f);
  }

  // ---- Fields ----

  /// The kernel of this stage of the method.
  FieldKernel kernel() const {
    FieldKernelTable const& kernels =
        for_instruction_set([](auto set) -> FieldKernelTable const& { return field_kernels<decltype(set)::value>(); });
    auto const stage = static_cast<std::size_t>(stage_);
    switch (method()) {
      case Method::euler:
        return kernels.euler;
      case Method::leap_frog:
        return kernels.leap_frog[stage];
      case Method::rk2:
      case Method::random_walk:
        return kernels.rk2[stage];
      default:
        return kernels.rk4[stage];
    }
  }
  /// False if a number is not finite afterwards.
  bool advance_fields(Block const& block) {
    std::size_t const size = ensemble_.size();
    constexpr std::size_t together = 16;
    FieldColumn columns[together];
    bool finite = true;
    for (std::size_t first = 0; first < numbers_.size(); first += together) {
      std::size_t const count = std::min(numbers_.size() - first, together);
      for (std::size_t k = 0; k < count; ++k) {
        auto const& number = numbers_[first + k];
        double* const start = start_.data() + (first + k) * size + block.begin;
        columns[k] = {ensemble_.row(block.begin) + number.offset,
                      block.rates.of(number.rate, number.component, block.begin - block.first), block.rates.particle,
                      start, sum_.empty() ? start : sum_.data() + (first + k) * size + block.begin};
      }
      finite = kernel_({columns, count, ensemble_.stride(), block.end - block.begin}, context_->dt) && finite;
    }
    return finite;
  }

  /// A random step of variance 2 D dt; the coefficients follow the rates.
  void diffuse(Block const& block) {
    std::size_t place = ensemble_.driven().size();
    for (std::size_t k = 0; k < ensemble_.driven().size(); ++k) {
      auto const field = ensemble_.driven()[k];
      if (!field.diffuses) continue;
      double const* const coefficients = block.rates.of(place++, 0, block.begin - block.first);
      for (std::size_t i = block.begin; i < block.end; ++i) {
        double const coefficient = coefficients[(i - block.begin) * block.rates.particle];
        double const deviation = std::sqrt(2 * coefficient * std::abs(context_->dt));
        // Each field of a particle has a stream of its own.
        Stream stream(context_->seed, context_->step, (static_cast<std::uint64_t>(k) << 48) | i,
                      Purpose::field_diffusion);
        double* const x = ensemble_.row(i) + field.offset;
        for (int c = 0; c < field.components; ++c) x[c] += deviation * stream.normal();
      }
    }
  }

  /// Wraps angles and other periodic fields into their period.
  void take_periods_off(Block const& block) {
    for (auto const& field : ensemble_.driven()) {
      if (!(field.period > 0)) continue;
      for (std::size_t i = block.begin; i < block.end; ++i)
        for (int c = 0; c < field.components; ++c) {
          double& x = ensemble_.row(i)[field.offset + c];
          if (!(std::abs(x) <= 0.5 * field.period)) x -= field.period * std::nearbyint(x / field.period);
        }
    }
  }

  /// Finds the first particle with a field that is not finite.
  void find_not_finite(Block const& block) {
    for (auto const& field : ensemble_.driven())
      for (int c = 0; c < field.components; ++c) {
        for (std::size_t i = block.begin; i < block.end; ++i)
          if (!std::isfinite(ensemble_.row(i)[field.offset + c])) {
            std::lock_guard const lock(found_);
            not_finite_ = std::min(not_finite_, i);
            break;
          }
      }
  }

  // ---- Velocities ----
  // Leap-frog calculates influences in the middle of its kicks, where the velocity is that of the half step. Rates, and
  // laws that read the velocity, get the velocity at the end of the step, predicted by the last acceleration. The inner
  // method gets its own velocity back.

  template <class F>
  void each_velocity(std::size_t begin, std::size_t end, F const& f) {
    switch (ensemble_.dimension()) {
      case 1:
        return each_velocity_in<1>(begin, end, f);
      case 2:
        return each_velocity_in<2>(begin, end, f);
      default:
        return each_velocity_in<3>(begin, end, f);
    }
  }
  template <std::size_t D, class F>
  void each_velocity_in(std::size_t begin, std::size_t end, F const& f) {
    std::size_t const row = ensemble_.stride();
    double* velocity = ensemble_.row(begin) + velocity_;
    double* kept = velocities_.data() + begin * D;
    for (std::size_t i = begin; i < end; ++i, velocity += row, kept += D)
      for (std::size_t c = 0; c < D; ++c) f(velocity[c], kept[c]);
  }
  void predict_velocities(std::size_t begin, std::size_t end) {
    each_velocity(begin, end, [](double& v, double& kept) {
      double const half = v;
      v = half + (half - kept);
      kept = half;
    });
  }

  std::unique_ptr<Integrator> inner_;
  AnyEnsemble& ensemble_;
  FieldEquations equations_;
  struct Number {
    std::size_t offset, rate, component;
  };
  std::vector<Number> numbers_;   // advanced numbers: offsets in a row, and their rates
  std::size_t arrays_ = 0;        // of rates and diffusion coefficients
  int velocity_ = -1;             // its offset in a row, if it is predicted
  bool found_elsewhere_ = false;  // some numbers are not advanced by kernels
  RateSource* source_ = nullptr;
  std::vector<double> start_, sum_, velocities_;
  // State of the current stage:
  int stage_ = 0;
  StepContext const* context_ = nullptr;
  FieldKernel kernel_ = nullptr;
  std::mutex found_;
  std::size_t not_finite_ = LargestMove::nobody;
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
