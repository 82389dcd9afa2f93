// From ensembles to points and back, and how an accuracy is kept.
#include <boltzmann/core/clock.hpp>
#include <boltzmann/core/compensated_sum.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/multipole/multipole_field.hpp>
#include <boltzmann/schemes/multipole/multipole_scheme.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace boltzmann {
namespace {

/// Of particles whose influence is compared with a direct sum: 200, or more as long as that takes hardly any time.
std::size_t sample_count(std::size_t candidates, std::size_t particles) {
  return std::min(candidates, std::max<std::size_t>(200, 20'000'000 / std::max<std::size_t>(1, particles)));
}

constexpr std::size_t checked_every = 64;
constexpr double furthest = 1e140;  // squares and sums of squares are numbers, too
/// Times the mean: where a sample is further off, a few particles may have errors that no sample shows.
constexpr double usual_largest = 5;

/// Below, to sum all pairs is as fast.
constexpr std::size_t summed_directly = 1500;

/// The order at which expansions and pairs take about as long for this tolerance.
int order_for(double tolerance, int dimension) {
  double const digits = -std::log10(tolerance);
  double const order = dimension == 3 ? 1 + 1.6 * digits : 3 + 2 * digits;
  return std::clamp(static_cast<int>(std::lround(order)), 2, highest_expansion_order);
}

ImageLattice lattice_of(Box const& box) {
  ImageLattice lattice;
  for (int a = 0; a < box.dimension(); ++a)
    if (box.periodic(a)) lattice.edges[a] = box.length(a);
  return lattice;
}

void check_tolerance(double tolerance) {
  if (!(tolerance >= 1e-10 && tolerance <= 0.1))
    throw Error(fmt::format("multipoles: a tolerance of {}; it must be between 1e-10 and 0.1", tolerance));
}

/// Truth is so much better than what is compared with it.
constexpr double better = 1e-3;

}  // namespace

/// The field of points in two or three dimensions.
struct MultipoleScheme::Engine {
  virtual ~Engine() = default;
  /// All particles of these ensembles with their strengths. PhysicsFailure if a position is not finite.
  virtual void collect(std::vector<Loaded> const& loaded, int threads) = 0;
  /// Places that feel the field, behind the particles.
  virtual void add(double const* places, std::size_t count) = 0;
  virtual std::size_t count() const = 0;
  virtual void choose(MultipoleChoice const& choice) = 0;
  virtual void calculate(bool with_potential, int threads) = 0;
  /// The field at these particles by direct sums, to this part of it.
  virtual std::vector<double> exact(std::vector<std::size_t> const& particles, double error, int threads) const = 0;
  virtual double spacing() const = 0;  ///< in the mean, of neighbours
  virtual std::vector<double> const& field() const = 0;
  virtual std::vector<double> const& potential() const = 0;
  virtual MultipoleChoice const& choice() const = 0;
  virtual MultipoleCost const& cost() const = 0;
  virtual double work() const = 0;  ///< of the last calculation, in pairs
  virtual std::size_t bytes() const = 0;
};

template <int D>
struct MultipoleScheme::EngineIn final : Engine {
  using Point = typename MultipoleField<D>::Point;

  EngineIn(LaplaceLaw const& law, Box const& box) : multipoles(law, lattice_of(box)) {
    for (int a = 0; a < D; ++a) low[a] = box.low(a), edges[a] = box.periodic(a) ? box.length(a) : 0;
  }

  void collect(std::vector<Loaded> const& loaded, int threads) override {
    std::size_t total = 0;
    for (auto const& one : loaded) total += one.ensemble->size();
    points.resize(total);
    std::size_t at = 0;
    for (auto const& one : loaded) {
      AnyEnsemble const& ensemble = *one.ensemble;
      for_ranges(ensemble.size(), 4096, threads_for(ensemble.size(), 1, threads),
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t i = begin; i < end; ++i) {
                     Point& point = points[at + i];
                     for (int a = 0; a < D; ++a) {
                       double const x = point.position[a] = inside(ensemble.row(i)[a], a);
                       if (!(std::abs(x) < furthest))
                         throw PhysicsFailure(fmt::format("particle {} of '{}' is at a position that is not finite{}",
                                                          i, ensemble.name(),
                                                          std::isfinite(x) ? ", or too far to be squared" : ""));
                     }
                     point.amount = one.acts ? one.strengths[i] : 0;
                   }
                 });
      at += ensemble.size();
    }
  }
  void add(double const* places, std::size_t count) override {
    for (std::size_t k = 0; k < count; ++k) {
      Point point{};
      for (int a = 0; a < D; ++a) {
        point.position[a] = inside(places[k * D + a], a);
        if (!(std::abs(point.position[a]) < furthest))
          throw Error(fmt::format("multipoles: place {} is not finite, or too far to be squared", k));
      }
      points.push_back(point);
    }
  }
  std::size_t count() const override { return points.size(); }
  void choose(MultipoleChoice const& choice) override { multipoles.choose(choice); }
  void calculate(bool with_potential, int threads) override { multipoles.calculate(points, with_potential, threads); }
  std::vector<double> exact(std::vector<std::size_t> const& particles, double error, int threads) const override {
    return multipoles.direct(points, particles, error, threads);
  }
  double spacing() const override {
    std::array<double, 3> least{}, most{};
    double volume = 1, shortest = 0;
    for (int a = 0; a < D; ++a)
      if (edges[a] > 0 && !(shortest > 0 && shortest < edges[a])) shortest = edges[a];
    for (int a = 0; a < D; ++a) {
      if (points.empty()) return 1;
      least[a] = most[a] = points.front().position[a];
      for (auto const& p : points)
        least[a] = std::min(least[a], p.position[a]), most[a] = std::max(most[a], p.position[a]);
      volume *= edges[a] > 0 ? edges[a] : std::max(most[a] - least[a], shortest);
    }
    return std::pow(volume / static_cast<double>(points.size()), 1.0 / D);
  }
  std::vector<double> const& field() const override { return multipoles.field(); }
  std::vector<double> const& potential() const override { return multipoles.potential(); }
  MultipoleChoice const& choice() const override { return multipoles.choice(); }
  MultipoleCost const& cost() const override { return multipoles.cost(); }
  double work() const override { return multipoles.work(); }
  std::size_t bytes() const override { return multipoles.bytes() + points.capacity() * sizeof(Point); }

  /// Into the box, along periodic axes.
  double inside(double x, int a) const { return edges[a] > 0 ? x - edges[a] * std::floor((x - low[a]) / edges[a]) : x; }

  MultipoleField<D> multipoles;
  std::vector<Point> points;
  std::array<double, D> low, edges;
};

MultipoleScheme::MultipoleScheme(Box box, LaplaceLaw const& law, double tolerance)
    : Scheme(box), law_(law), tolerance_(tolerance) {
  law.check();
  if (law.constant == 0) throw Error("multipoles: the constant of the law is 0: nobody would feel anything");
  check_tolerance(tolerance);
  if (box.dimension() == 1)
    throw Error("multipoles: the box has one dimension, where a mesh or pairs do it; expansions are for 2 and 3");
  for (int a = 0; a < box.dimension(); ++a)
    if (box.boundary(a) == Boundary::mirror)
      throw Error(
          fmt::format("multipoles: axis {} is mirror; there are fields of open and of periodic axes (a mesh "
                      "has them between walls)",
                      "xyz"[a]));
  if (!box.regions().empty()) throw Error("multipoles: the box has regions, which the field would not feel");
  if (box.dimension() == 2)
    engine_ = std::make_unique<EngineIn<2>>(law, box);
  else
    engine_ = std::make_unique<EngineIn<3>>(law, box);
}

MultipoleScheme::~MultipoleScheme() = default;

void MultipoleScheme::add(AnyEnsemble& ensemble, SourceKind const& kind) { load(ensemble, kind, true); }

void MultipoleScheme::add_test_particles(AnyEnsemble& ensemble, SourceKind const& kind) { load(ensemble, kind, false); }

void MultipoleScheme::load(AnyEnsemble& ensemble, SourceKind const& kind, bool acts) {
  kind.check(ensemble, law_.constant, "multipoles");
  for (auto const& one : loaded_)
    if (one.ensemble == &ensemble) {
      if (one.acts == acts) return;
      throw Error(fmt::format("multipoles: '{}' can't make the field and be test particles", ensemble.name()));
    }
  Scheme::add(ensemble);
  loaded_.push_back({&ensemble, kind, acts, {}});
}

void MultipoleScheme::collect() {
  for (auto& one : loaded_) {
    one.strengths.resize(one.ensemble->size());
    one.kind.strengths(one.ensemble->row(0), 0, one.ensemble->size(), one.strengths.data());
  }
  check_neutral();
  engine_->collect(loaded_, threads());
}

void MultipoleScheme::check_neutral() const {
  for (int a = 0; a < box().dimension(); ++a)
    if (background_ || !box().periodic(a)) return;
  CompensatedSum total, all;
  for (auto const& one : loaded_)
    for (double const s : one.strengths)
      if (one.acts) total += s, all += std::abs(s);
  if (std::abs(total.value()) > 1e-9 * all.value())
    throw Error(fmt::format(
        "multipoles: the strengths sum to {:.6g}, and a periodic box has no field unless they cancel; add particles of "
        "the other sign, or a uniform background: background(true), in scenarios background = true",
        total.value()));
}

/// The mean square of what samples feel, without the fiftieth that feels most: a few that are near to each other would
/// count for all.
double MultipoleScheme::typical_square(std::vector<double> squares) {
  std::sort(squares.begin(), squares.end());
  std::size_t const kept = squares.size() - squares.size() / 50;
  CompensatedSum sum;
  for (std::size_t k = 0; k < kept; ++k) sum += squares[k];
  return kept > 0 ? sum.value() / static_cast<double>(kept) : 0;
}

/// Of the field 1/r^(D-1) of a unit strength.
double MultipoleScheme::constant_of_points() const {
  return std::abs(law_.constant) / (box().dimension() == 3 ? 4 * pi : 2 * pi);
}

/// In a crystal all that a particle feels may cancel: errors are measured by a hundredth of what a neighbour does.
double MultipoleScheme::least_field() const {
  if (!box().any_periodic()) return 0;
  double squares = 0;
  for (auto const& one : loaded_)
    for (double const s : one.strengths)
      if (one.acts) squares += s * s;
  return 1e-2 * constant_of_points() * std::sqrt(squares / static_cast<double>(engine_->count())) *
         std::pow(engine_->spacing(), 1 - box().dimension());
}

MultipoleScheme::SampledError MultipoleScheme::error_of(std::vector<std::size_t> const& chosen,
                                                        std::vector<double> const& exact) const {
  auto const D = static_cast<std::size_t>(box().dimension());
  auto const strengths = strengths_of_all();
  CompensatedSum errors;
  double largest = 0;
  double const least = square(least_field());
  std::vector<double> squares;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    double const strength = strengths[chosen[k]];
    double sum = square(strength) * least, error = 0;
    for (std::size_t a = 0; a < D; ++a) {
      error += square(strength * (engine_->field()[chosen[k] * D + a] - exact[k * D + a]));
      sum += square(strength * exact[k * D + a]);
    }
    errors += error;
    largest = std::max(largest, error);
    squares.push_back(sum);
  }
  double const typical = typical_square(squares), mean = errors.value() / static_cast<double>(chosen.size());
  return {typical > 0 ? std::sqrt(mean / typical) : 0, mean > 0 ? std::sqrt(largest / mean) : 0};
}

/// Of particles, to what they feel.
std::vector<double> MultipoleScheme::strengths_of_all() const {
  std::vector<double> all;
  for (auto const& one : loaded_) all.insert(all.end(), one.strengths.begin(), one.strengths.end());
  return all;
}

/// Of those that feel something.
std::vector<std::size_t> MultipoleScheme::choose_samples() const {
  std::vector<std::size_t> all;
  auto const strengths = strengths_of_all();
  for (std::size_t i = 0; i < strengths.size(); ++i)
    if (strengths[i] != 0) all.push_back(i);
  std::size_t const samples = sample_count(all.size(), strengths.size());
  if (samples == all.size()) return all;
  std::vector<std::size_t> chosen;
  Stream stream(0, 0, strengths.size(), Purpose::selection);
  for (std::size_t k = 0; k < samples; ++k)
    chosen.push_back(all[static_cast<std::size_t>(stream.uniform() * static_cast<double>(all.size()))]);
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

std::size_t MultipoleScheme::leaf() const {
  int const order = order_for(tolerance_, box().dimension());
  return box().dimension() == 2 || order < 8 ? 48 : order < 13 ? 64 : 100;
}

/// Calculates with a criterion for which the error of the samples is between an eighth of the tolerance and two fifths
/// of it, where there is one: what is promised of all particles then holds for all.
void MultipoleScheme::tune(bool with_potential) {
  auto const chosen = choose_samples();
  auto const exact = engine_->exact(chosen, better * tolerance_, threads());
  if (order_ == 0) order_ = order_for(tolerance_, box().dimension());
  std::size_t const leaf = this->leaf();
  auto const D = static_cast<std::size_t>(box().dimension());
  std::vector<double> squares(chosen.size(), square(least_field()));
  for (std::size_t i = 0; i < exact.size(); ++i) squares[i / D] += square(exact[i]);
  double const field = std::sqrt(typical_square(squares)) / constant_of_points();
  if (!std::isfinite(field) || field == 0) {  // two at one place, or nobody who acts: whoever looks will say so
    engine_->choose({order_, leaf, 1});
    engine_->calculate(with_potential, threads());
    return;
  }
  if (criterion_ == 0) criterion_ = 4 * tolerance_ * field;
  // A lower order is tried where the error is still far below: it may be cheaper, though it leaves more to pairs.
  struct {
    int order;
    double criterion, cost;
  } before{0, 0, 0};
  int in_vain = 0;
  double last_measured = __builtin_inf();
  double most = 0;  // that one interaction may do at worst
  auto const calculate = [&] {
    engine_->choose({order_, leaf, criterion_});
    engine_->calculate(with_potential, threads());
    SampledError const error = error_of(chosen, exact);
    measured_ = error.mean;
    most = (error.largest < usual_largest ? 100 : 8) * tolerance_ * field;
  };
  for (int attempt = 0;; ++attempt) {
    calculate();
    bool const enough = measured_ <= 0.4 * tolerance_, too_much = measured_ < tolerance_ / 8;
    double const cost = engine_->work();
    if (before.order > 0 && !(enough && cost < before.cost)) {
      order_ = before.order, criterion_ = before.criterion;
      return calculate();
    }
    if (everything_is_summed() || (enough && (!too_much || attempt >= 12))) return;
    // More of expansions and pairs, and no better?
    in_vain = !enough && measured_ > 0.7 * last_measured ? in_vain + 1 : 0;
    last_measured = measured_;
    if (in_vain == 4)
      throw PhysicsFailure(
          fmt::format("multipoles: the tolerance {:.0e} is not reached, the error is {:.1e}: what "
                      "particles feel cancels to less than rounding allows",
                      tolerance_, measured_));
    double const change = 0.25 * tolerance_ / std::max(measured_, 1e-3 * tolerance_);
    if (enough && criterion_ >= most) {
      if (order_ == 2) return;
      before = {order_, criterion_, cost};
      --order_;
    } else {
      criterion_ =
          enough ? std::min(criterion_ * std::min(change, 20.0), most) : criterion_ * std::max(0.8 * change, 0.01);
    }
  }
}

bool MultipoleScheme::everything_is_summed() const {
  return engine_->cost().translations == 0 && !box().any_periodic();
}

void MultipoleScheme::calculate_field(bool with_potential) {
  collect();
  choose_and_calculate(with_potential);
}

void MultipoleScheme::choose_and_calculate(bool with_potential) {
  if (engine_->count() <= summed_directly && !box().any_periodic()) {
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

void MultipoleScheme::add_influences(double /*time*/) {
  calculate_field(false);
  last_ = chosen_and_taken();
  auto const D = static_cast<std::size_t>(box().dimension());
  std::size_t at = 0;
  for (auto const& one : loaded_) {
    AnyEnsemble& ensemble = *one.ensemble;
    for_ranges(ensemble.size(), 4096, threads_for(ensemble.size(), 1, threads()),
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i)
                   for (std::size_t a = 0; a < D; ++a)
                     ensemble.influence(i)[a] += one.strengths[i] * engine_->field()[(at + i) * D + a];
               });
    at += ensemble.size();
  }
}

/// Looking changes nothing that the next calculation depends on.
class MultipoleScheme::Look {
 public:
  explicit Look(MultipoleScheme& scheme) : scheme_(scheme), state_(scheme.state()) {}
  ~Look() { scheme_.restore(state_); }
  Look(Look const&) = delete;
  Look& operator=(Look const&) = delete;

 private:
  MultipoleScheme& scheme_;
  std::vector<double> state_;
};

EnergyAndVirial MultipoleScheme::measure(double /*time*/) {
  Look const look(*this);
  calculate_field(true);
  EnergyAndVirial measures = EnergyAndVirial::known();
  auto const D = static_cast<std::size_t>(box().dimension());
  CompensatedSum potential;
  std::array<std::array<CompensatedSum, 3>, 3> virial;
  std::size_t at = 0;
  bool reaction = true;
  for (auto const& one : loaded_) {
    reaction = reaction && one.acts;
    std::vector<double> energies(one.ensemble->size());
    for (std::size_t i = 0; i < energies.size(); ++i) {
      energies[i] = (one.acts ? 0.5 : 1) * one.strengths[i] * engine_->potential()[at + i];
      potential += energies[i];
      // The sum over pairs of r_a F_b, since the forces of all cancel: that over particles of their place and force.
      for (std::size_t a = 0; a < D; ++a)
        for (std::size_t b = 0; b < D; ++b)
          virial[a][b] += one.ensemble->row(i)[a] * one.strengths[i] * engine_->field()[(at + i) * D + b];
    }
    at += energies.size();
    measures.per_particle.push_back(std::move(energies));
  }
  measures.potential = potential.value();
  measures.driven = !reaction;  // who makes the field works on them
  if (box().any_periodic())
    measures.no_virial = "multipoles in a periodic box don't have it (P3M does)";
  else if (!reaction)
    measures.no_virial = "test particles feel forces that nobody feels in return";
  else
    for (std::size_t a = 0; a < D; ++a)
      for (std::size_t b = 0; b < D; ++b) measures.virial[a][b] = virial[a][b].value();
  return measures;
}

void MultipoleScheme::calculate_at(double const* places, std::size_t count, std::vector<double>& field,
                                   std::vector<double>& potential) {
  Look const look(*this);
  collect();
  std::size_t const particles = engine_->count();
  auto const D = static_cast<std::ptrdiff_t>(box().dimension());
  engine_->add(places, count);
  choose_and_calculate(true);
  auto const from = static_cast<std::ptrdiff_t>(particles);
  field.assign(engine_->field().begin() + from * D, engine_->field().end());
  potential.assign(engine_->potential().begin() + from, engine_->potential().end());
  for (std::size_t k = 0; k < count; ++k)
    if (!std::isfinite(potential[k]))
      throw PhysicsFailure(fmt::format("multipoles: the field at place {} is not finite: a particle is there", k));
}

template <int D>
std::vector<MultipoleScheme::FieldAt<D>> MultipoleScheme::field_at(std::vector<Vector<D>> const& places) {
  if (D != box().dimension())
    throw Error(fmt::format("multipoles: places of {} dimensions in a box of {}", D, box().dimension()));
  std::vector<double> field, potential;
  calculate_at(places.empty() ? nullptr : &places.front()[0], places.size(), field, potential);
  std::vector<FieldAt<D>> all(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    for (int a = 0; a < D; ++a) all[k].field[a] = field[k * D + static_cast<std::size_t>(a)];
    all[k].potential = potential[k];
  }
  return all;
}
template std::vector<MultipoleScheme::FieldAt<2>> MultipoleScheme::field_at(std::vector<Vector<2>> const&);
template std::vector<MultipoleScheme::FieldAt<3>> MultipoleScheme::field_at(std::vector<Vector<3>> const&);

void MultipoleScheme::grid(std::vector<std::size_t> const& cells) {
  using namespace dimensions;
  grid_ = make_grid(box(), cells);
  potential_ = {"potential", energy / charge, *grid_, {}};
  field_ = {"field", energy / charge / length, *grid_, {}};
}

std::vector<MeshField const*> MultipoleScheme::mesh_fields() {
  if (!grid_) return {};
  auto const D = static_cast<std::size_t>(box().dimension());
  std::size_t const nodes = grid_->size();
  std::vector<double> places(nodes * D), field, potential;
  for (std::size_t n = 0; n < nodes; ++n) {
    std::size_t rest = n;
    for (std::size_t a = 0; a < D; ++a) {
      places[n * D + a] = grid_->position(static_cast<int>(a), rest % grid_->nodes[a]);
      rest /= grid_->nodes[a];
    }
  }
  calculate_at(places.data(), nodes, field, potential);
  potential_.components = {std::move(potential)};
  field_.components.assign(D, std::vector<double>(nodes));
  for (std::size_t n = 0; n < nodes; ++n)
    for (std::size_t a = 0; a < D; ++a) field_.components[a][n] = field[n * D + a];
  return {&potential_, &field_};
}

MultipoleAccuracy MultipoleScheme::accuracy() {
  Look const look(*this);
  calculate_field(false);
  MultipoleAccuracy accuracy = chosen_and_taken();
  auto const chosen = choose_samples();
  if (accuracy.order > 0)
    accuracy.measured = error_of(chosen, engine_->exact(chosen, better * tolerance_, threads())).mean;
  return accuracy;
}

/// As it stands after a calculation.
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

// No step has to resolve a softening: among many particles one that passes near gives far less than all others do.
double MultipoleScheme::length_scale(AnyEnsemble const&) const { return __builtin_inf(); }

std::string MultipoleScheme::explain(AnyEnsemble const& ensemble, std::size_t i) const {
  return law_.softening > 0 ? "" : at_one_place(ensemble, i);
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

std::vector<double> MultipoleScheme::state() const {
  return {criterion_, measured_, static_cast<double>(order_), static_cast<double>(until_check_)};
}

void MultipoleScheme::restore(std::span<double const> state) {
  if (state.size() != 4)
    throw Error(fmt::format("multipoles: the state of a checkpoint has 4 numbers, not {}", state.size()));
  criterion_ = state[0], measured_ = state[1];
  order_ = static_cast<int>(state[2]), until_check_ = static_cast<std::size_t>(state[3]);
}

}  // namespace boltzmann
