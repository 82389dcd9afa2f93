// Conversion between ensembles and points, and control of the accuracy.
#include <boltzmann/core/clock.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/schemes/multipole/error_samples.hpp>
#include <boltzmann/schemes/multipole/multipole_engine.hpp>
#include <boltzmann/schemes/multipole/multipole_scheme.hpp>
#include <boltzmann/schemes/vortices/vortex_source.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace boltzmann {
namespace {

constexpr std::size_t checked_every = 64;
/// For fewer particles, summing all pairs is as fast.
constexpr std::size_t summed_directly = 1500;

double digits_of(double tolerance) { return -std::log10(tolerance); }

/// True if the system repeats along some axis.
bool repeats(Box const& box) {
  for (int a = 0; a < box.dimension(); ++a)
    if (box.periodic(a) || repeats_between_walls(box, a)) return true;
  return false;
}

/// The order at which expansions and pairs take about equally long for this tolerance. In a periodic box images take
/// part of the time.
int order_for(double tolerance, Box const& box) {
  double const digits = digits_of(tolerance);
  double const order = box.dimension() == 2 ? 3 + 2 * digits : repeats(box) ? 1 + 1.6 * digits : 2.5 + 2 * digits;
  return std::clamp(static_cast<int>(std::lround(order)), 2, highest_expansion_order);
}

void check_tolerance(double tolerance) {
  if (!(tolerance >= 1e-10 && tolerance <= 0.1))
    throw Error(fmt::format("multipoles: a tolerance of {}; it must be between 1e-10 and 0.1", tolerance));
}

/// Relative accuracy of the reference sums.
constexpr double better = 1e-3;

void check_box(Box const& box, bool of_vortices) {
  if (box.dimension() == 1)
    throw Error("multipoles: the box has one dimension, where a mesh or pairs do it; expansions are for 2 and 3");
  for (int a = 0; a < box.dimension(); ++a)
    if (box.boundary(a) == Boundary::mirror && !of_vortices)
      throw Error(
          fmt::format("multipoles: axis {} is mirror; fields of multipoles need open or periodic axes (use [mesh] "
                      "between walls; flows of vortices may have mirrors)",
                      "xyz"[a]));
  if (!box.regions().empty()) throw Error("multipoles: the box has regions, which the field would not feel");
  if (of_vortices) check_walls_of_flow(box, "multipoles");
}

}  // namespace

MultipoleScheme::MultipoleScheme(Box box, double tolerance, std::optional<LaplaceLaw> law)
    : Scheme(box), law_(law), tolerance_(tolerance) {
  check_tolerance(tolerance);
  check_box(box, !law);
}

MultipoleScheme::MultipoleScheme(Box box, LaplaceLaw const& law, double tolerance)
    : MultipoleScheme(box, tolerance, law) {
  engine_ = multipole_engine(law, box);
}

MultipoleScheme::MultipoleScheme(Box box, VortexLaw const& law, double tolerance)
    : MultipoleScheme(box, tolerance, std::nullopt) {
  vortex_law_ = law;
  engine_ = multipole_engine(law, box);
}

MultipoleScheme::~MultipoleScheme() = default;

void MultipoleScheme::background(bool yes) {
  for (int a = 0; yes && a < box().dimension(); ++a)
    if (!box().periodic(a))
      throw Error(
          fmt::format("multipoles: a uniform background is for a box that is periodic along all axes, and axis {} is "
                      "open; leave it out: here strengths need not cancel",
                      "xyz"[a]));
  if (yes && !law_ && box().dimension() == 3)
    throw Error(
        "multipoles: vorticity has no uniform background in 3D, since the flow would stretch it: what vortices carry "
        "has "
        "to cancel");
  background_ = yes;
  changed();
}

void MultipoleScheme::add(AnyEnsemble& ensemble, SourceKind const& kind) { load(ensemble, kind, true); }

void MultipoleScheme::add_test_particles(AnyEnsemble& ensemble, SourceKind const& kind) { load(ensemble, kind, false); }

void MultipoleScheme::load(AnyEnsemble& ensemble, SourceKind const& kind, bool acts) {
  engine_->check(ensemble, kind, acts);
  for (auto const& one : loaded_)
    if (one.ensemble == &ensemble) {
      if (one.acts == acts) return;
      throw Error(fmt::format("multipoles: '{}' can't make the field and be test particles", ensemble.name()));
    }
  Scheme::add(ensemble);
  loaded_.push_back({&ensemble, kind, acts});
}

/// Records nearness while the object exists.
class MultipoleScheme::Watched {
 public:
  explicit Watched(MultipoleEngine& engine) : engine_(engine) { engine.watch(true); }
  ~Watched() { engine_.watch(false); }
  Watched(Watched const&) = delete;
  Watched& operator=(Watched const&) = delete;

 private:
  MultipoleEngine& engine_;
};

ErrorSamples MultipoleScheme::choose_samples() const {
  std::size_t particles = 0;  // and no places
  for (auto const& one : loaded_) particles += one.ensemble->size();
  // At higher orders, fewer particles contribute most of the error: at 1e-10 fifty of 100,000 contribute half of it.
  // (Images make samples expensive.)
  double const order = order_ > 0 ? order_ : order_for(tolerance_, box());
  double const more = std::clamp(order * order / 64, 1.0, box().any_periodic() ? 2.0 : 12.0);
  return {*engine_, particles, static_cast<std::size_t>(200 * more), better * tolerance_, threads()};
}

std::size_t MultipoleScheme::leaf() const {
  double const digits = digits_of(tolerance_);
  return box().dimension() == 2 || digits < 4.1 ? 48 : digits < 7.2 ? 90 : 100;
}

/// Calculates with an order and a criterion for which the error of the samples is between an eighth and two fifths of
/// the tolerance, if there is one. This margin guarantees the tolerance for all particles. The first call searches for
/// the order with the least work.
void MultipoleScheme::tune(bool with_potential) {
  Watched const watched(*engine_);
  ErrorSamples samples = choose_samples();
  double const field = samples.typical_field();
  if (order_ == 0) order_ = order_for(tolerance_, box());
  if (!std::isfinite(field) || field == 0) {  // coincident particles, or no sources: the caller reports it
    engine_->choose({order_, leaf(), 1});
    engine_->calculate(with_potential, threads());
    return;
  }
  bool const first = criterion_ == 0;
  Fit best = fit(order_, first ? 4 * tolerance_ * field : criterion_, samples, with_potential);
  // Higher orders leave less work to pairs, and take longer. So reduce the larger part. (Not in a periodic box, where
  // each order needs its own lattice sums.)
  int const step = best.of_pairs > 0.5 ? 2 : -2;
  while (first && !repeats(box()) && !everything_is_summed() && best.order + step >= 2 &&
         best.order + step <= highest_expansion_order) {
    Fit const next = fit(best.order + step, best.criterion * (step > 0 ? 4 : 0.25), samples, with_potential);
    if (!(next.work < 0.97 * best.work)) {
      best = fit(best.order, best.criterion, samples, with_potential);
      break;
    }
    best = next;
  }
  order_ = best.order, criterion_ = best.criterion;
}

/// Calculates with expansions of this order, and a criterion that gives the desired error.
MultipoleScheme::Fit MultipoleScheme::fit(int order, double criterion, ErrorSamples& samples, bool with_potential) {
  double const shortest = 1.5;  // least ratio of two criteria that justifies another calculation between them
  int in_vain = 0, between = 0;
  double last_measured = __builtin_inf(), last_work = 0;
  double good = 0, bad = __builtin_inf();  // sufficient and insufficient criteria
  for (int attempt = 0;; ++attempt) {
    engine_->choose({order, leaf(), criterion});
    engine_->calculate(with_potential, threads());
    measured_ = samples.error();
    double const work = engine_->work();
    bool const enough = measured_ <= 0.4 * tolerance_, too_much = measured_ < tolerance_ / 8;
    (enough ? good : bad) = criterion;
    // In a crystal, errors jump and no criterion is in between. With few particles in a periodic box, no pairs of nodes
    // use expansions.
    bool const settled = between >= 3 || bad < shortest * good || attempt >= 12 || work == last_work;
    if (everything_is_summed() || (enough && (!too_much || settled)))
      return {order, criterion, work, static_cast<double>(engine_->cost().pairs) / work};
    // More expansions and pairs without a better error.
    in_vain = good == 0 && measured_ > 0.7 * last_measured ? in_vain + 1 : 0;
    last_measured = measured_, last_work = work;
    if (in_vain == 4)
      throw PhysicsFailure(
          fmt::format("multipoles: the tolerance {:.0e} is not reached, the error is {:.1e}: what "
                      "particles feel cancels to less than rounding allows",
                      tolerance_, measured_));
    double const change = 0.25 * tolerance_ / std::max(measured_, 1e-3 * tolerance_);
    if (good > 0 && std::isfinite(bad))
      criterion = settled ? good : (++between, std::sqrt(good * bad));
    else
      criterion *= enough ? std::min(change, 20.0) : std::max(0.8 * change, 0.01);
  }
}

bool MultipoleScheme::sums_directly() const { return engine_->count() <= summed_directly && !repeats(box()); }

bool MultipoleScheme::everything_is_summed() const { return engine_->cost().translations == 0 && !repeats(box()); }

void MultipoleScheme::calculate_field(bool with_potential) {
  engine_->collect(loaded_, background_, threads());
  choose_and_calculate(with_potential);
}

void MultipoleScheme::choose_and_calculate(bool with_potential) {
  if (sums_directly()) {
    measured_ = 0;
    engine_->choose({2, engine_->count() + 1, 1});
    engine_->calculate(with_potential, threads());
  } else if (criterion_ == 0 || until_check_ == 0) {
    tune(with_potential);
    until_check_ = checked_every;
  } else {
    engine_->choose({order_, leaf(), criterion_});
    engine_->calculate(with_potential, threads());
    --until_check_;
  }
}

std::vector<VortexSource> MultipoleScheme::vortices() const {
  std::vector<VortexSource> all;
  for (auto const& one : loaded_)
    if (vortex_law_ && one.acts) all.push_back({one.ensemble, *vortex_law_, tolerance_, background_});
  return all;
}

/// Shares the work of all ranks in a divided run, while the object exists.
class MultipoleScheme::Together {
 public:
  explicit Together(MultipoleScheme& scheme) : engine_(*scheme.engine_) {
    if (!scheme.division_) return;
    scheme.division_->make_whole();
    engine_.divide(&scheme.division_->team());
  }
  ~Together() { engine_.divide(nullptr); }
  Together(Together const&) = delete;
  Together& operator=(Together const&) = delete;

 private:
  MultipoleEngine& engine_;
};

void MultipoleScheme::add_influences(double /*time*/) {
  Together const together(*this);
  calculate_field(false);
  last_ = chosen_and_taken();
  counted_ = sums_directly() ? 0 : engine_->checksum();
  engine_->add_influences(loaded_, threads());
}

/// A calculation for observers, which does not affect later calculations.
class MultipoleScheme::Look {
 public:
  explicit Look(MultipoleScheme& scheme)
      : scheme_(scheme),
        criterion_(scheme.criterion_),
        measured_(scheme.measured_),
        order_(scheme.order_),
        until_check_(scheme.until_check_) {}
  ~Look() {
    scheme_.criterion_ = criterion_, scheme_.measured_ = measured_;
    scheme_.order_ = order_, scheme_.until_check_ = until_check_;
  }
  Look(Look const&) = delete;
  Look& operator=(Look const&) = delete;

 private:
  MultipoleScheme& scheme_;
  double criterion_, measured_;
  int order_;
  std::size_t until_check_;
};

EnergyAndVirial MultipoleScheme::measure(double /*time*/) {
  Look const look(*this);
  Together const together(*this);
  calculate_field(true);
  return engine_->measure(loaded_);
}

void MultipoleScheme::calculate_at(double const* places, std::size_t count) {
  engine_->collect(loaded_, background_, threads());
  engine_->add(places, count);
  choose_and_calculate(true);
}

template <int D>
void MultipoleScheme::calculate_at(std::vector<Vector<D>> const& places) {
  if (D != box().dimension())
    throw Error(fmt::format("multipoles: places of {} dimensions in a box of {}", D, box().dimension()));
  calculate_at(places.empty() ? nullptr : &places.front()[0], places.size());
}

template <int D>
std::vector<MultipoleScheme::FieldAt<D>> MultipoleScheme::field_at(std::vector<Vector<D>> const& places) {
  if (!law_) throw Error("multipoles: vortices make a flow, not a field: call velocity_at()");
  Look const look(*this);
  calculate_at(places);
  std::size_t const from = engine_->count() - places.size();
  std::vector<FieldAt<D>> all(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    for (int a = 0; a < D; ++a) all[k].field[a] = engine_->field()[(from + k) * D + static_cast<std::size_t>(a)];
    all[k].potential = engine_->potential()[from + k];
    if (!std::isfinite(all[k].potential))
      throw PhysicsFailure(fmt::format("multipoles: the field at place {} is not finite: a particle is there", k));
  }
  return all;
}
template std::vector<MultipoleScheme::FieldAt<2>> MultipoleScheme::field_at(std::vector<Vector<2>> const&);
template std::vector<MultipoleScheme::FieldAt<3>> MultipoleScheme::field_at(std::vector<Vector<3>> const&);

template <int D>
std::vector<Vector<D>> MultipoleScheme::velocity_at(std::vector<Vector<D>> const& places) {
  if (law_) throw Error("multipoles: charges and masses make a field, not a flow: call field_at()");
  Look const look(*this);
  calculate_at(places);
  std::size_t const width = engine_->width(), from = engine_->count() - places.size();
  std::vector<Vector<D>> all(places.size());
  for (std::size_t k = 0; k < places.size(); ++k)
    for (int a = 0; a < D; ++a) all[k][a] = engine_->field()[(from + k) * width + static_cast<std::size_t>(a)];
  return all;
}
template std::vector<Vector<2>> MultipoleScheme::velocity_at(std::vector<Vector<2>> const&);
template std::vector<Vector<3>> MultipoleScheme::velocity_at(std::vector<Vector<3>> const&);

std::unique_ptr<MultipoleScheme> MultipoleScheme::of_slopes(Box const& box, VortexLaw const& law, double tolerance) {
  std::unique_ptr<MultipoleScheme> scheme(new MultipoleScheme(box, tolerance, std::nullopt));
  scheme->engine_ = slopes_engine(law, box);
  return scheme;
}

std::vector<double> MultipoleScheme::slopes_at_particles() {
  calculate_field(false);
  return engine_->field();
}

std::vector<double> MultipoleScheme::slopes_at(double const* places, std::size_t count) {
  Look const look(*this);
  calculate_at(places, count);
  auto const from = static_cast<std::ptrdiff_t>((engine_->count() - count) * engine_->width());
  return {engine_->field().begin() + from, engine_->field().end()};
}

void MultipoleScheme::grid(std::vector<std::size_t> const& cells) {
  using namespace dimensions;
  grid_ = make_grid(box(), cells);
  potential_ = {"potential", energy / charge, *grid_, {}};
  field_ = {"field", energy / charge / length, *grid_, {}};
  if (!law_) field_ = {"velocity", velocity, *grid_, {}};
}

std::vector<MeshField const*> MultipoleScheme::mesh_fields() {
  if (!grid_) return {};
  auto const D = static_cast<std::size_t>(box().dimension());
  std::size_t const nodes = grid_->size(), width = engine_->width();
  std::vector<double> places(nodes * D);
  for (std::size_t n = 0; n < nodes; ++n) {
    std::size_t rest = n;
    for (std::size_t a = 0; a < D; ++a) {
      places[n * D + a] = grid_->position(static_cast<int>(a), rest % grid_->nodes[a]);
      rest /= grid_->nodes[a];
    }
  }
  Look const look(*this);
  calculate_at(places.data(), nodes);
  std::size_t const from = engine_->count() - nodes;
  field_.components.assign(D, std::vector<double>(nodes));
  for (std::size_t n = 0; n < nodes; ++n)
    for (std::size_t a = 0; a < D; ++a) field_.components[a][n] = engine_->field()[(from + n) * width + a];
  if (!law_) return {&field_};
  potential_.components = {
      {engine_->potential().begin() + static_cast<std::ptrdiff_t>(from), engine_->potential().end()}};
  for (double const value : potential_.components[0])
    if (!std::isfinite(value))
      throw PhysicsFailure("multipoles: the field at a node of the grid is not finite: a particle is there");
  return {&potential_, &field_};
}

MultipoleAccuracy MultipoleScheme::accuracy() {
  Look const look(*this);
  Watched const watched(*engine_);
  calculate_field(false);
  MultipoleAccuracy accuracy = chosen_and_taken();
  if (accuracy.order > 0) accuracy.measured = choose_samples().error();
  return accuracy;
}

/// The state after a calculation.
MultipoleAccuracy MultipoleScheme::chosen_and_taken() const {
  auto const& cost = engine_->cost();
  return {measured_, everything_is_summed() ? 0 : engine_->choice().order, cost.nodes, cost.translations, cost.pairs};
}

MultipoleScheme::Trial MultipoleScheme::try_tolerance(double tolerance) {
  check_tolerance(tolerance);
  Look const look(*this);
  double const own = std::exchange(tolerance_, tolerance);
  criterion_ = 0, order_ = 0;
  try {
    calculate_field(false);
    auto const since = Clock::now();
    calculate_field(false);
    double const seconds = seconds_since(since);
    Trial const trial{accuracy(), seconds};
    tolerance_ = own;
    return trial;
  } catch (...) {
    tolerance_ = own;
    throw;
  }
}

// No step has to resolve a softening: among many particles, a close encounter contributes much less than all others
// together.
double MultipoleScheme::length_scale(AnyEnsemble const&) const { return __builtin_inf(); }

std::string MultipoleScheme::explain(AnyEnsemble const& ensemble, std::size_t i) const {
  return engine_->singular() ? at_one_place(ensemble, i) : "";
}

void MultipoleScheme::make_reversible(double /*quantum*/) {
  throw Error(
      "the reversible leap-frog needs influences that are the same to the bit whatever was before; expansions are "
      "not: use leap-frog, or a pair scheme");
}

std::size_t MultipoleScheme::bytes() const { return engine_->bytes(); }

std::string MultipoleScheme::summary() const { return fmt::format("multipoles, errors below {:.0e}", tolerance_); }

std::string MultipoleScheme::report() const {
  if (!last_) return "";
  if (last_->order == 0) return fmt::format("multipoles: {} pairs, all summed directly", last_->pairs);
  return fmt::format(
      "multipoles of order {}: error {:.1e} of {:.0e}; {} nodes, {:.3g} translations and {:.3g} pairs a step",
      last_->order, last_->measured, tolerance_, last_->nodes, static_cast<double>(last_->translations),
      static_cast<double>(last_->pairs));
}

/// If the particles are those of the last influences, a resumed run repeats their calculation, unless the checkpoint
/// contains the influences.
std::vector<double> MultipoleScheme::state() const {
  double again = 0;
  if (counted_ != 0) {
    engine_->collect(loaded_, background_, threads());
    again = engine_->checksum() == counted_ ? 1 : 0;
  }
  return {criterion_, measured_, static_cast<double>(order_), static_cast<double>(until_check_), again};
}

void MultipoleScheme::restore(std::span<double const> state) {
  if (state.size() != 4 && state.size() != 5)  // 4: until version 902, with the repeated calculation in the count
    throw Error(fmt::format("multipoles: the state of a checkpoint has 5 numbers, not {}", state.size()));
  criterion_ = state[0], measured_ = state[1];
  order_ = static_cast<int>(state[2]);
  repeated_ = state.size() == 5 && state[4] != 0 ? 1 : 0;
  until_check_ = static_cast<std::size_t>(state[3]) + repeated_;
  counted_ = 0;
}

void MultipoleScheme::influences_restored() { until_check_ -= std::exchange(repeated_, 0); }

}  // namespace boltzmann
