// The particles of friction and noise: ensembles, their state laws, and pairs from neighbour lists.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/dissipation/members.hpp>
#include <boltzmann/dissipation/splitting.hpp>
#include <boltzmann/dissipation/typed_friction.hpp>
#include <boltzmann/formulas/machine_code.hpp>
#include <boltzmann/particles/share_sums.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace boltzmann {
namespace {

constexpr double nowhere = 1e150;  // its square is finite
constexpr double noticeable = 0.01;
constexpr std::size_t sampled = 1000;

}  // namespace

std::string PairDissipation::Member::who(std::size_t row) const {
  return fmt::format("particle {} of '{}'", copy->order()[row], ensemble->name());
}

DissipationKernels const& dissipation_kernels_for(int dimension, bool projected) {
  return for_instruction_set([](auto set) -> DissipationKernelTable const& { return dissipation_kernels<set()>(); })
      .of[dimension - 1][projected ? 1 : 0];
}

PairDissipation::PairDissipation(PairScheme& scheme, double boltzmann_constant)
    : scheme_(scheme), boltzmann_constant_(boltzmann_constant), splitting_(std::make_unique<Splitting>()) {
  if (!(boltzmann_constant > 0) || !std::isfinite(boltzmann_constant))
    throw Error(fmt::format("Boltzmann's constant is positive, not {}", boltzmann_constant));
}

PairDissipation::~PairDissipation() = default;

PairDissipation::Member& PairDissipation::member(AnyEnsemble& ensemble) {
  for (auto& member : members_)
    if (member->ensemble == &ensemble) return *member;
  auto const at = [&](char const* name) {
    Field const* field = ensemble.find_field(name);
    return field ? field->offset : -1;
  };
  auto made = std::make_unique<Member>();
  made->ensemble = &ensemble;
  for (char const* name : {"mass", "velocity"})
    if (at(name) < 0)
      throw Error(fmt::format("friction can't act on ensemble '{}': class {} has no {}", ensemble.name(),
                              ensemble.class_name(), name));
  made->mass = at("mass");
  made->velocity = at("velocity");
  made->energy = at("internal_energy");
  made->temperature = at("temperature");
  made->copy = &scheme_.neighbourhood().copy(ensemble);
  scheme_.add(ensemble);
  members_.push_back(std::move(made));
  return *members_.back();
}

void PairDissipation::state(AnyEnsemble& ensemble, StateLaw law) {
  if (!ensemble.find_field("internal_energy"))
    throw Error(fmt::format("ensemble '{}' of class {} has no internal energies that a state law could be of",
                            ensemble.name(), ensemble.class_name()));
  member(ensemble).law = std::move(law);
}

void PairDissipation::internal(AnyEnsemble& ensemble, DissipationLaw const& dissipation) {
  couple(ensemble, ensemble, dissipation);
}

void PairDissipation::between(AnyEnsemble& a, AnyEnsemble& b, DissipationLaw const& dissipation) {
  if (&a == &b) return couple(a, a, dissipation);
  couple(a, b, dissipation);
}

void PairDissipation::couple(AnyEnsemble& target, AnyEnsemble& source, DissipationLaw const& dissipation) {
  dissipation.check();
  Box const& box = scheme_.box();
  for (int a = 0; a < box.dimension(); ++a) {
    if (box.boundary(a) == Boundary::mirror)
      throw Error(fmt::format(
          "axis {} is a mirror: friction between pairs needs a reflecting, periodic or open axis there", "xyz"[a]));
    if (box.periodic(a) && dissipation.range > 0.5 * box.length(a) * (1 + 1e-12))
      throw Error(
          fmt::format("the range {} of friction is longer than half of the periodic axis {}, which allows at most {}: "
                      "two particles must not meet twice",
                      dissipation.range, "xyz"[a], 0.5 * box.length(a)));
  }
  if (couplings_.size() > 200) throw Error("a dissipation has at most 100 kinds of friction");
  Member &first = member(target), &second = member(source);
  bool const fixed = dissipation.convention == Convention::fixed_temperature;
  for (auto* one : {&first, &second}) {
    if (one->dissipates && one->at_fixed_temperature != fixed)
      throw Error(
          fmt::format("friction on ensemble '{}' is at a fixed temperature in one place and with internal "
                      "energies in another; it can't be both",
                      one->ensemble->name()));
    if (!fixed && one->energy < 0)
      throw Error(fmt::format("convention {} needs internal energies, and ensemble '{}' of class {} has none",
                              to_string(dissipation.convention), one->ensemble->name(), one->ensemble->class_name()));
    one->dissipates = true;
    one->at_fixed_temperature = fixed;
  }
  auto const number = static_cast<std::uint32_t>(couplings_.size());
  auto const add = [&](Member& on, Member& of, bool is_first) {
    auto coupling = std::make_unique<Coupling>();
    coupling->target = &on;
    coupling->source = &of;
    coupling->dissipation = dissipation;
    if (dissipation.typed) {
      coupling->typed = dissipation.typed->program();
      coupling->typed.code = machine_code(coupling->typed, dissipation_kernels_for(box.dimension(), true).code_width);
    }
    coupling->list = scheme_.neighbourhood().add(*on.ensemble, *of.ensemble, dissipation.range);
    scheme_.neighbourhood().keep_together();
    coupling->number = number;
    coupling->first = is_first;
    couplings_.push_back(std::move(coupling));
  };
  add(first, second, true);
  if (&first != &second) add(second, first, false);
}

std::vector<AnyEnsemble*> PairDissipation::ensembles() const {
  std::vector<AnyEnsemble*> all;
  for (auto const& member : members_)
    if (member->dissipates) all.push_back(member->ensemble);
  return all;
}

void PairDissipation::check() {
  if (metropolis_ && method_ != DissipationMethod::shardlow)
    throw Error("the Metropolis correction accepts or refuses pairs one by one: it needs the method shardlow");
  if (corrector_ && method_ != DissipationMethod::simultaneous)
    throw Error("the corrector belongs to the method simultaneous; shardlow needs none");
  for (auto const& coupling : couplings_)
    if (metropolis_ && (coupling->dissipation.convention == Convention::deterministic ||
                        coupling->dissipation.convention == Convention::fixed_temperature))
      throw Error(
          fmt::format("the Metropolis correction is for friction with noise and internal energies, not for "
                      "convention {}",
                      to_string(coupling->dissipation.convention)));
  for (auto const& member : members_) {
    if (!member->dissipates) continue;
    AnyEnsemble const& ensemble = *member->ensemble;
    if (!member->at_fixed_temperature && !member->law)
      throw Error(
          fmt::format("ensemble '{}' has internal energies but no heat capacity; set heat_capacity", ensemble.name()));
    for (std::size_t i = 0; i < ensemble.size(); ++i) {
      double const* row = ensemble.row(i);
      if (!(row[member->mass] > 0))
        throw Error(fmt::format("particle {} of '{}' has the mass {}: friction needs positive masses", i,
                                ensemble.name(), row[member->mass]));
      if (member->has_energy() && !(row[member->energy] > 0 && std::isfinite(row[member->energy])))
        throw Error(fmt::format("particle {} of '{}' has the internal energy {}: it must be positive", i,
                                ensemble.name(), row[member->energy]));
    }
  }
}

void PairDissipation::box_changed() {
  Box const& box = scheme_.box();
  for (auto const& coupling : couplings_)
    for (int a = 0; a < box.dimension(); ++a)
      if (box.periodic(a) && coupling->dissipation.range > 0.5 * box.length(a) * (1 + 1e-12))
        throw PhysicsFailure(fmt::format("the box has shrunk to {} along {}, less than twice the range {} of friction",
                                         box.length(a), "xyz"[a], coupling -> dissipation.range));
}

void PairDissipation::act_in_flow(Box const&) {
  if (method_ == DissipationMethod::shardlow)
    throw Error(
        "shear: shardlow takes pairs one by one between particles, not their images that flow; take the method "
        "simultaneous");
}

PairNoise PairDissipation::Coupling::noise(StepContext const& context, double k, std::uint32_t owner) const {
  DissipationLaw const& d = dissipation;
  PairNoise n;
  n.convention = d.convention;
  n.inverse_range = 1 / d.range;
  n.range2 = d.range * d.range;
  n.exponent = d.exponent;
  double const twice = 2 * d.exponent;
  n.twice_exponent = twice == std::floor(twice) && twice <= 16 ? static_cast<int>(twice) : -1;
  if (d.typed) {
    n.typed = &typed;
    n.of_temperature = d.typed->of_temperature();
    n.greatest_square = d.typed->greatest_square();
  }
  n.friction = d.friction * context.dt;
  n.amplitude =
      std::sqrt(2 * d.friction * k * context.dt * (d.convention == Convention::constant_friction ? 1 : d.temperature));
  n.temperature = d.temperature;
  n.boltzmann_constant = k;
  n.conduction = d.conduction * context.dt;
  n.conduction_noise = std::sqrt(2 * k * n.conduction);
  n.same = same();
  n.first = first;
  n.step = context.step & 0xffffffffU;
  n.tag = number | owner << 8U | (context.step >> 32U) << 16U;
  n.key = PhiloxKey(context.seed);
  return n;
}

/// A point from a row of the sorted copy, and further fields from the ensemble.
void PairDissipation::Member::take_point(std::size_t k, double const* from) {
  double* to = point(k);
  int const D = dimension();
  std::copy_n(copy->rows() + row_block * k, D, to);
  std::copy_n(from + velocity, D, to + velocity_at());
  to[inverse_mass_at()] = 1 / from[mass];
  double inverse = 1, curvature = 0;
  if (has_energy()) {
    double const t = law->temperature(from[energy]);
    inverse = 1 / t;
    curvature = inverse * inverse / law->heat_capacity(t);
  }
  double* heat = to + 2 * D + 1;
  heat[0] = inverse;
  heat[1] = curvature;
}

void PairDissipation::Member::take_sentinel_and_images(int threads) {
  double* sentinel = point(owned());
  std::fill_n(sentinel, stride(), 1.0);
  std::fill_n(sentinel, dimension(), nowhere);
  for_stretches(copy->images(), threads, [&](Stretch const* images, Stretch const* last) {
    for (; images != last; ++images)
      for (std::size_t k = owned() + 1 + images->begin; k < owned() + 1 + images->end; ++k) {
        std::copy_n(point(copy->owner(k)), stride(), point(k));
        std::copy_n(copy->rows() + row_block * k, dimension(), point(k));
      }
  });
}

/// False if lists and sorted copies are not those of the current positions.
bool PairDissipation::take_points() {
  Box const& box = scheme_.box();
  std::atomic<bool> current = scheme_.neighbourhood().builds() > 0;
  for (auto& member : members_) {
    if (!member->dissipates) continue;
    Member& m = *member;
    SortedCopy const& copy = *m.copy;
    int const dimension = m.dimension();
    if (copy.owned() != m.ensemble->size()) current = false;
    if (!current) return false;
    std::array<double, 3> half{nowhere, nowhere, nowhere};  // a larger difference means that it has been wrapped
    for (int a = 0; a < dimension; ++a)
      if (box.periodic(a)) half[a] = 0.5 * box.length(a);
    if (box.sheared()) {  // an image may be anywhere along the flow
      if (!copy.is_current()) return false;
      half.fill(-1);
    }
    m.points.resize(m.stride() * (copy.total() + 1));
    int const threads = threads_for(copy.owned(), 2, this->threads());
    auto const take = [&](std::vector<Stretch> const& stretches, bool own) {
      for_stretches(stretches, threads, [&](Stretch const* rows, Stretch const* last) {
        for (; rows != last; ++rows)
          for (std::size_t k = rows->begin; k < rows->end; ++k) {
            double const* row = m.ensemble->row(copy.order()[k]);
            m.take_point(k, row);
            for (int a = 0; own && a < dimension; ++a)
              if (double const x = m.point(k)[a]; x != row[a] && !(std::abs(x - row[a]) > half[a])) current = false;
          }
      });
    };
    take(copy.followed(), true);
    take(copy.others(), false);
    m.take_sentinel_and_images(threads);
    if (current && box.sheared()) m.carry_along_flow();
  }
  return current;
}

namespace {
/// Entries of rows, in the groups of DissipationTask.
struct Groups {
  std::vector<std::uint32_t>& words;
  std::uint32_t sentinel, taken = 0;  // of the current row

  void take(std::uint32_t entry, std::uint32_t number) {
    if (taken % list_padding == 0) words.resize(words.size() + 2 * list_padding);
    std::uint32_t* const group = words.data() + words.size() - 2 * list_padding;
    group[taken % list_padding] = entry;
    group[list_padding + taken % list_padding] = number;
    ++taken;
  }
  void end_row() {
    while (taken % list_padding != 0) take(sentinel, 0);
    taken = 0;
  }
};
}  // namespace

/// Every pair of the chunk once, in the order of the neighbour lists; pairs with particles of other chunks, other
/// ensembles and images from both sides.
void PairDissipation::Coupling::take_piece(std::size_t piece, NeighbourList const& neighbours) {
  SortedCopy const& of = *source->copy;
  auto const [begin, end] = target->pieces[piece];
  std::uint32_t const low = item_of_row(target->pieces[piece].low());
  entries[piece].clear();
  Groups groups{entries[piece], item_of_row(of.sentinel())};
  std::vector<std::size_t> start;
  for (std::size_t k = begin; k < end; ++k) {
    start.push_back(groups.words.size());
    std::uint32_t const* j = neighbours.rows()[k];
    std::uint32_t const self = item_of_row(k);
    std::uint32_t read = 0;
    for (int ring = 0; ring < list_rings; ++ring) {
      for (std::uint32_t const stop = neighbours.lengths(ring)[k]; read < stop; ++read) {
        bool const twice = same() && j[read] >= low && j[read] <= self;
        if (!twice && j[read] != groups.sentinel) groups.take(j[read], of.order()[of.owner(j[read] / 4)]);
      }
      length[ring][k] = groups.taken;
    }
    groups.end_row();
  }
  for (std::size_t k = begin; k < end; ++k) row[k] = groups.words.data() + start[k - begin];
  take_border(piece, neighbours);
}

/// Pairs with earlier rows of the same chunk, from the side of these rows; found in the lists of the piece.
void PairDissipation::Coupling::take_border(std::size_t piece, NeighbourList const& neighbours) {
  auto const [begin, end] = target->pieces[piece];
  std::uint32_t const low = item_of_row(target->pieces[piece].low()), high = item_of_row(begin);
  Border& border = borders[piece] = {};
  if (!same() || low == high) return;
  struct Pair {
    std::uint32_t row;
    int ring;
    std::uint32_t item;
    auto operator<=>(Pair const&) const = default;
  };
  std::vector<Pair> pairs;
  for (std::size_t k = begin; k < end; ++k) {
    std::uint32_t const* j = neighbours.rows()[k];
    std::uint32_t read = 0;
    for (int ring = 0; ring < list_rings; ++ring)
      for (std::uint32_t const stop = neighbours.lengths(ring)[k]; read < stop; ++read)
        if (j[read] >= low && j[read] < high) pairs.push_back({j[read] / 4, ring, item_of_row(k)});
  }
  if (pairs.empty()) return;
  std::sort(pairs.begin(), pairs.end());
  border.begin = pairs.front().row;
  Groups groups{border.entries, item_of_row(target->copy->sentinel())};
  std::vector<std::size_t> start;
  auto pair = pairs.begin();
  for (std::size_t i = border.begin; i <= pairs.back().row; ++i) {
    start.push_back(groups.words.size());
    for (int ring = 0; ring < list_rings; ++ring) {
      for (; pair != pairs.end() && pair->row == i && pair->ring == ring; ++pair)
        groups.take(pair->item, target->copy->order()[pair->item / 4]);
      border.length[ring].push_back(groups.taken);
    }
    groups.end_row();
  }
  for (std::size_t const at : start) border.row.push_back(groups.words.data() + at);
}

std::string PairDissipation::undivided() const {
  return method_ == DissipationMethod::shardlow ? "pairs that are taken one by one (shardlow)" : "";
}

void PairDissipation::divide(Division* division) {
  Dissipation::divide(division);
  if (division) division->read_rows();
  for (auto& coupling : couplings_) coupling->builds = ~std::size_t{0};  // invalidates their pairs
}

/// The pieces of all rows, or of those of this rank. Threads get roughly equal parts if there are few chunks; each
/// further cut duplicates the work of pairs across it.
std::vector<PairDissipation::Piece> PairDissipation::pieces(Member const& m) const {
  constexpr std::size_t few = 8;
  auto const& own = scheme_.neighbourhood().own(*m.copy);
  std::size_t rows = 0, done = 0;
  for (auto const& [begin, end] : own) rows += end - begin;
  auto const used = static_cast<std::size_t>(threads_for(rows, 4, threads()));
  std::size_t const parts = rows < few * used * dissipation_chunk ? used : 1;
  auto const part_end = [&](std::size_t part) { return rows * part / parts; };
  std::vector<Piece> pieces;
  std::size_t part = 1;
  for (auto const& [first, last] : own)
    for (std::size_t begin = first; begin < last; begin = pieces.back().end) {
      while (part_end(part) <= done) ++part;
      std::size_t const chunk_end = (begin / dissipation_chunk + 1) * dissipation_chunk;
      std::size_t const end = std::min({last, chunk_end, begin + (part_end(part) - done)});
      pieces.push_back({begin, end});
      done += end - begin;
    }
  return pieces;
}

void PairDissipation::take_lists() {
  Neighbourhood const& neighbourhood = scheme_.neighbourhood();
  for (auto& member : members_) {
    if (!member->dissipates) continue;
    auto now = pieces(*member);
    if (now == member->pieces) continue;
    member->pieces = std::move(now);
    for (auto& coupling : couplings_)
      if (coupling->target == member.get()) coupling->builds = ~std::size_t{0};
  }
  for (auto& coupling : couplings_) {
    Coupling& c = *coupling;
    Member const& m = *c.target;
    if (c.builds == neighbourhood.version() && c.moves == neighbourhood.moves()) continue;
    NeighbourList const& list = neighbourhood.list(c.list);
    std::vector<std::size_t> pieces;
    if (c.builds == neighbourhood.version() && c.moves + 1 == neighbourhood.moves()) {
      std::size_t piece = 0;
      for (std::uint32_t const row : list.rebuilt()) {  // ascending
        while (m.pieces[piece].end <= row) ++piece;
        if (pieces.empty() || pieces.back() != piece) pieces.push_back(piece);
      }
    } else {
      c.entries.resize(m.pieces.size());
      c.borders.resize(m.pieces.size());
      c.row.resize(m.owned());
      for (auto& length : c.length) length.resize(m.owned());
      for (std::size_t piece = 0; piece < m.pieces.size(); ++piece) pieces.push_back(piece);
    }
    c.builds = neighbourhood.version();
    c.moves = neighbourhood.moves();
    for_ranges(pieces.size(), 1, threads_for(m.owned(), 2, threads()), [&](std::size_t first, std::size_t last) {
      for (std::size_t n = first; n < last; ++n) c.take_piece(pieces[n], list);
    });
  }
}

void PairDissipation::advance(StepContext const& context) {
  if (!(context.dt > 0)) throw Error(fmt::format("friction and noise need a positive step, not {}", context.dt));
  // Runs for comparison may have no dissipation.
  if (std::all_of(couplings_.begin(), couplings_.end(), [](auto const& c) { return c->vanishes(); })) return;
  if (division()) scheme_.neighbourhood().refresh(threads());  // other dissipations have changed velocities since
  if (!take_points()) {
    scheme_.neighbourhood().refresh(threads());
    take_points();
  }
  if (method_ == DissipationMethod::simultaneous)
    simultaneous(context);
  else
    shardlow(context);
}

void PairDissipation::update_derived_fields() {
  for (auto const& member : members_) {
    if (!member->law || member->temperature < 0) continue;
    for (std::size_t i = 0; i < member->ensemble->size(); ++i) {
      double* row = member->ensemble->row(i);
      row[member->temperature] = member->law->temperature(row[member->energy]);
    }
  }
}

bool PairDissipation::derives(AnyEnsemble const& ensemble, Field const& field) const {
  return std::any_of(members_.begin(), members_.end(), [&](auto const& member) {
    return member->ensemble == &ensemble && member->law && member->temperature == field.offset;
  });
}

double PairDissipation::internal_energy() const {
  ExactSum sum;
  std::vector<AnyEnsemble const*> of;
  for (auto const& member : members_) {
    if (!member->law) continue;
    of.push_back(member->ensemble);
    for_each_row_of_sums(*member->ensemble, [&](double const* row) { sum += row[member->energy]; });
  }
  add_up(of, {&sum, 1});
  return sum.value();
}

/// The mean force of friction on i is -g v_ij, along the line of centres if it is projected (see warnings()).
std::array<std::array<double, 3>, 3> PairDissipation::virial() {
  std::array<ExactSum, 9> sums;
  Neighbourhood& neighbourhood = scheme_.neighbourhood();
  neighbourhood.refresh(threads());
  take_points();
  int const ring = neighbourhood.ring();
  for (auto const& coupling : couplings_) {
    Member &m = *coupling->target, &of = *coupling->source;
    NeighbourList const& list = neighbourhood.list(coupling->list);
    int const D = m.dimension(), v = m.velocity_at();
    auto const of_row = [&](std::size_t k, std::array<double, 9>& terms) {
      double const* const p = m.point(k);
      std::uint32_t const* j = list.rows()[k];
      for (std::uint32_t const* const last = j + list.lengths(ring)[k]; j < last; ++j) {
        double const* const q = of.point(*j / 4);
        double r[3] = {}, along = 0, r2 = 0;
        for (int a = 0; a < D; ++a) r[a] = p[a] - q[a], r2 += r[a] * r[a];
        double const friction = coupling->mean_friction(p, q, r2);
        if (friction == 0) continue;
        for (int a = 0; a < D; ++a) along += r[a] * (p[v + a] - q[v + a]);
        for (int a = 0; a < D; ++a)
          for (int b = 0; b < D; ++b)  // half of the pair's contribution
            terms[static_cast<std::size_t>(3 * a + b)] -=
                0.5 * friction * r[a] * (coupling->dissipation.projected ? along / r2 * r[b] : p[v + b] - q[v + b]);
      }
    };
    for (auto const& [first, last] : neighbourhood.own(*m.copy))
      add_terms(sums, last - first, threads(),
                [&, first = first](std::size_t k, std::array<double, 9>& terms) { of_row(first + k, terms); });
  }
  if (division()) division()->sum(sums);
  std::array<std::array<double, 3>, 3> virial{};
  for (std::size_t n = 0; n < sums.size(); ++n) virial[n / 3][n % 3] = sums[n].value();
  return virial;
}

/// Friction times weight, without the step, for the points of a pair with the squared distance r2.
double PairDissipation::Coupling::mean_friction(double const* p, double const* q, double r2) const {
  DissipationLaw const& d = dissipation;
  double const x = 1 - std::sqrt(r2) / d.range;
  if (!(x > 0) || r2 == 0) return 0;
  auto const inverse_temperature = static_cast<std::size_t>(2 * target->dimension() + 1);
  double const inverse_temperatures = p[inverse_temperature] + q[inverse_temperature];
  double const chi = d.typed ? d.typed->at(r2, 2 / inverse_temperatures).strength : std::pow(x, d.exponent);
  double const friction = d.friction * chi * chi;
  return d.convention == Convention::constant_noise ? friction * 0.5 * d.temperature * inverse_temperatures : friction;
}

std::vector<std::string> PairDissipation::warnings(double step_size) {
  // With the matrix G of friction (dv = -G v dt), x = G dt and noise of variance 2 x T, a step multiplies a mode of v
  // by 1 - x, with the corrector by 1 - x + x^2/2, with its second pass (internal energies) by 1 - x + x^2/2 - x^3/4.
  // So the error of its T is x/2, -x^2/4, x^3/8 to leading order. Motion mixes the modes, so the mean over them is not
  // known exactly. With s = dt tr(G^2) / tr(G), runs of fluids without forces were fitted by 0.45 s, -0.25 s^2 and 0.2
  // s^3, for s up to 0.2, 0.5 and 0.6; at small s the last two are off by up to 40 %. Sums are over some of the
  // particles, with isotropic lines of centres.
  double strongest = 0;
  Neighbourhood& neighbourhood = scheme_.neighbourhood();
  neighbourhood.refresh(threads());
  take_points();
  for (auto const& member : members_) {
    Member& m = *member;
    if (!m.dissipates) continue;
    double trace = 0, trace_of_square = 0;
    double const D = m.dimension();
    std::size_t const count = std::min(m.owned(), sampled);
    for (std::size_t n = 0; n < count; ++n) {
      std::size_t const k = n * m.owned() / count;
      double const* p = m.point(k);
      double rate = 0, squares = 0;
      for (auto const& coupling : couplings_) {
        if (coupling->target != &m) continue;
        bool const projected = coupling->dissipation.projected;
        NeighbourList const& list = neighbourhood.list(coupling->list);
        std::uint32_t const* j = list.rows()[k];
        for (std::uint32_t const* const last = j + list.lengths(list_rings - 1)[k]; j < last; ++j) {
          double const* q = coupling->source->point(*j / 4);
          double r2 = 0;
          for (int a = 0; a < m.dimension(); ++a) r2 += (p[a] - q[a]) * (p[a] - q[a]);
          double const friction = coupling->mean_friction(p, q, r2);
          double const own = friction * p[m.inverse_mass_at()], other = friction * q[m.inverse_mass_at()];
          rate += projected ? own / D : own;
          squares += own * (projected ? (1 - 1 / D) / D * own + other / D : other);
        }
      }
      trace += rate;
      trace_of_square += rate * rate + squares;
    }
    if (trace > 0) strongest = std::max(strongest, trace_of_square / trace * std::abs(step_size));
  }
  std::vector<std::string> lines;
  bool const simultaneous = method_ == DissipationMethod::simultaneous;
  bool const shares = std::any_of(members_.begin(), members_.end(), [](auto const& m) { return m->has_energy(); });
  double const s = strongest, error = !corrector_ ? 0.45 * s : shares ? 0.2 * s * s * s : -0.25 * s * s;
  // The step at which the error is no longer noticeable, relative to this one.
  double const shorter = std::pow(noticeable / std::abs(error), !corrector_ ? 1.0 : shares ? 1.0 / 3 : 0.5);
  if (simultaneous && std::abs(error) > noticeable)
    lines.push_back(fmt::format(
        "warning: friction times step is {:.3g} at the start: friction alone makes kinetic temperatures about "
        "{:.2g} % too {}{}; forces may heat besides at such a step; take {}a step {:.2g} times as long",
        s, 100 * std::abs(error), error > 0 ? "high" : "low", corrector_ ? ", even with the corrector" : "",
        corrector_ ? "" : "its corrector, shardlow or ", shorter));
  if (method_ == DissipationMethod::shardlow && strongest > 1)
    lines.push_back(
        fmt::format("warning: friction times step is {:.3g}, above 1: more than a velocity in a step", strongest));
  return lines;
}

std::string PairDissipation::report() const {
  if (!metropolis_ || proposed_ == 0) return "";
  return fmt::format("{} of {} pair moves refused ({:.2g} %)", refused_, proposed_,
                     100 * static_cast<double>(refused_) / static_cast<double>(proposed_));
}

std::size_t PairDissipation::bytes() const {
  std::size_t bytes = splitting_->bytes();
  for (auto const& member : members_)
    bytes += (member->points.capacity() + member->predicted.capacity() + member->energies.capacity()) * sizeof(double);
  auto const add = [&](auto const& row, auto const& lengths) {
    bytes += row.capacity() * sizeof(std::uint32_t*);
    for (auto const& length : lengths) bytes += length.capacity() * sizeof(std::uint32_t);
  };
  for (auto const& coupling : couplings_) {
    add(coupling->row, coupling->length);
    for (auto const& entries : coupling->entries) bytes += entries.capacity() * sizeof(std::uint32_t);
    for (auto const& border : coupling->borders) {
      add(border.row, border.length);
      bytes += border.entries.capacity() * sizeof(std::uint32_t);
    }
  }
  return bytes;
}

std::vector<double> PairDissipation::state() const {
  return {heat_, static_cast<double>(proposed_), static_cast<double>(refused_)};
}

void PairDissipation::restore(std::span<double const> state) {
  if (state.size() != 3) throw Error("the checkpoint's friction and noise do not fit this simulation");
  heat_ = state[0];
  proposed_ = static_cast<std::uint64_t>(state[1]);
  refused_ = static_cast<std::uint64_t>(state[2]);
}

}  // namespace boltzmann
