// Integrals of energies and virials beyond the cut-off, by Gauss-Legendre quadrature.
#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/pair_numbers.hpp>
#include <boltzmann/schemes/pair/tail_correction.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace boltzmann {
namespace {

constexpr int most_shells = 60;         // each twice as wide as the previous one
constexpr double largest_ratio = 0.99;  // of successive shells
constexpr double negligible = 1e-16;
constexpr std::size_t most_kinds = 64;

/// The numbers of a particle that a law reads.
using Kind = std::vector<double>;

/// The energy of a pair as a function of distance.
class EnergyOfDistance {
 public:
  EnergyOfDistance(FormulaLaw const& law, AnyEnsemble const& a, AnyEnsemble const& b)
      : program_(law.between(a, b)),
        numbers_(*program_.numbers),
        law_(numbers_.law),
        inputs_(numbers_.inputs),
        square_(static_cast<std::size_t>(a.dimension())) {
    if (!program_.has_energy) throw Error("a tail needs the energy of the law; it has none");
    if (!program_.along || program_.velocity_dependent)
      throw Error(
          "a tail is that of an energy which knows the distance of two particles and fields of them that do not "
          "change, and nothing else");
  }
  std::vector<int> const& of_target() const { return program_.of_p; }
  std::vector<int> const& of_source() const { return program_.of_q; }

  void choose(Kind const& p, Kind const& q) {
    set(program_.of_p, numbers_.of_target, p);
    set(program_.of_q, numbers_.of_source, q);
  }
  double operator()(double r) {
    inputs_[0] = r;
    inputs_[square_] = r * r;
    law_.run(inputs_);
    return law_[1];
  }

 private:
  void set(std::vector<int> const& offsets, std::vector<PairNumbers::RowInput> const& rows, Kind const& values) {
    for (std::size_t k = 0; k < offsets.size(); ++k)
      for (auto const& row : rows)
        if (row.offset == offsets[k]) inputs_[row.input] = values[k];
  }

  PairProgram program_;
  PairNumbers const& numbers_;
  Calculation law_;
  std::vector<double> inputs_;  // the separation, then its square, then fields
  std::size_t square_;
};

/// The kinds of particles of an ensemble that differ in these numbers of their rows.
struct Kinds {
  std::vector<Kind> all;
  std::vector<double> count;
  std::vector<std::size_t> of;  // the kind of each particle

  Kinds(AnyEnsemble const& ensemble, std::vector<int> const& offsets) : of(ensemble.size()) {
    std::map<Kind, std::size_t> numbers;
    Kind values(offsets.size());
    for (std::size_t i = 0; i < ensemble.size(); ++i) {
      for (std::size_t k = 0; k < offsets.size(); ++k) values[k] = ensemble.row(i)[offsets[k]];
      auto const [at, is_new] = numbers.try_emplace(values, all.size());
      if (is_new) {
        if (all.size() == most_kinds)
          throw Error(fmt::format(
              "a tail is that of at most {} kinds of particles; the fields that the law reads make more of '{}'",
              most_kinds, ensemble.name()));
        all.push_back(values);
        count.push_back(0);
      }
      of[i] = at->second;
      ++count[at->second];
    }
  }
};

/// The surface of the unit sphere: 2, 2 pi, 4 pi.
double surface(int dimension) {
  return dimension == 1 ? 2 : dimension == 2 ? 2 * std::numbers::pi : 4 * std::numbers::pi;
}

double volume_of(Box const& box) {
  double volume = 1;
  for (int a = 0; a < box.dimension(); ++a) volume *= box.length(a);
  return volume;
}

/// Gauss-Legendre quadrature, eight points on each side.
double integral(double low, double high, std::function<double(double)> const& f) {
  constexpr std::array<std::array<double, 2>, 8> points{{{0.0950125098376374402, 0.1894506104550684963},
                                                         {0.2816035507792589132, 0.1826034150449235889},
                                                         {0.4580167776572273863, 0.1691565193950025382},
                                                         {0.6178762444026437484, 0.1495959888165767321},
                                                         {0.7554044083550030339, 0.1246289712555338720},
                                                         {0.8656312023878317439, 0.0951585116824927848},
                                                         {0.9445750230732325761, 0.0622535239386478929},
                                                         {0.9894009349916499326, 0.0271524594117540949}}};
  double const middle = (low + high) / 2, half = (high - low) / 2;
  double sum = 0;
  for (auto const& [x, weight] : points) sum += weight * (f(middle - half * x) + f(middle + half * x));
  return sum * half;
}

}  // namespace

double integral_beyond(double distance, int dimension, std::function<double(double)> const& energy) {
  double total = 0, shell = 0, ratio = 1;
  int quiet = 0;  // successive shells without a contribution
  for (int k = 0; k < most_shells; ++k) {
    double const low = std::ldexp(distance, k), before = shell;
    shell = integral(low, 2 * low, [&](double r) { return std::pow(r, dimension - 1) * energy(r); });
    total += shell;
    ratio = shell / before;
    quiet = std::abs(shell) <= negligible * std::abs(total) ? quiet + 1 : 0;
    if (quiet == 3) return surface(dimension) * total;
  }
  // A slow power law: the remaining shells are a geometric series.
  if (ratio > 0 && ratio < largest_ratio) return surface(dimension) * (total + shell * ratio / (1 - ratio));
  throw Error(fmt::format(
      "its tail has no end: in {}D an energy must fall off faster than 1/r^{}, from the cut-off {} on it does "
      "not",
      dimension, dimension, distance));
}

/// The tail of each particle of `a`, times the density of `b`.
struct TailCorrection::Tail {
  std::size_t a, b;  // indices in ensembles()
  double cutoff;
  int dimension;
  EnergyOfDistance law;
  struct Integrals {
    double energy, virial;  // over space beyond the cut-off: of u, and of - r du/dr
  };
  std::map<std::pair<Kind, Kind>, Integrals> known = {};

  Integrals const& between(Kind const& p, Kind const& q) {
    auto const [at, is_new] = known.try_emplace({p, q});
    if (!is_new) return at->second;
    law.choose(p, q);
    double const u = integral_beyond(cutoff, dimension, [&](double r) { return law(r); });
    // By parts: the integral of - r u' r^(D-1) is R^D u(R) + D times that of u r^(D-1).
    return at->second = {u, surface(dimension) * std::pow(cutoff, dimension) * law(cutoff) + dimension * u};
  }
};

TailCorrection::TailCorrection(Box box) : Scheme(std::move(box)) {
  for (int a = 0; a < this->box().dimension(); ++a)
    if (!this->box().periodic(a))
      throw Error(fmt::format("a tail is that of surroundings without end; axis {} is not periodic", "xyz"[a]));
}

TailCorrection::~TailCorrection() = default;

std::size_t TailCorrection::number_of(AnyEnsemble const& ensemble) const {
  auto const& all = ensembles();
  return static_cast<std::size_t>(std::find(all.begin(), all.end(), &ensemble) - all.begin());
}

void TailCorrection::between(AnyEnsemble& a, AnyEnsemble& b, FormulaLaw const& law, double cutoff) {
  if (!std::isfinite(cutoff) || !(cutoff > 0)) throw Error("a tail begins at a cut-off; there is none");
  if (law.at_cutoff != FormulaLaw::AtCutoff::cut)
    throw Error("a law that is shifted or switched ends at its cut-off; a tail belongs to one that is cut");
  auto tail = std::make_unique<Tail>(Tail{0, 0, cutoff, box().dimension(), EnergyOfDistance(law, a, b)});
  Kinds const of_a(a, tail->law.of_target()), of_b(b, tail->law.of_source());
  for (Kind const& p : of_a.all)
    for (Kind const& q : of_b.all) tail->between(p, q);
  add(a);
  add(b);
  tail->a = number_of(a), tail->b = number_of(b);
  tails_.push_back(std::move(tail));
  changed();
}

EnergyAndVirial TailCorrection::measure(double) {
  auto measures = EnergyAndVirial::known();
  measures.reciprocal = true;
  auto const& all = ensembles();
  int const D = box().dimension();
  for (auto const* ensemble : all) {
    measures.per_particle.emplace_back(ensemble->size(), 0.0);
    measures.virial_per_particle.emplace_back(9 * ensemble->size(), 0.0);
  }
  double const volume = volume_of(box());
  // Adds half of the tail of particles of these kinds with those of the other ensemble.
  auto const give = [&](std::size_t e, Kinds const& kinds, std::vector<Tail::Integrals> const& sums) {
    for (std::size_t i = 0; i < kinds.of.size(); ++i) {
      auto const& [energy, virial] = sums[kinds.of[i]];
      measures.per_particle[e][i] += energy;
      measures.potential += energy;
      for (int a = 0; a < D; ++a) {
        measures.virial_per_particle[e][9 * i + 4 * static_cast<std::size_t>(a)] += virial / D;
        measures.virial[static_cast<std::size_t>(a)][static_cast<std::size_t>(a)] += virial / D;
      }
    }
  };
  for (auto const& tail : tails_) {
    Kinds const of_a(*all[tail->a], tail->law.of_target()), of_b(*all[tail->b], tail->law.of_source());
    std::vector<Tail::Integrals> sums_a(of_a.all.size()), sums_b(of_b.all.size());
    for (std::size_t p = 0; p < of_a.all.size(); ++p)
      for (std::size_t q = 0; q < of_b.all.size(); ++q) {
        auto const [energy, virial] = tail->between(of_a.all[p], of_b.all[q]);
        double const for_a = 0.5 * of_b.count[q] / volume, for_b = 0.5 * of_a.count[p] / volume;
        sums_a[p].energy += for_a * energy, sums_a[p].virial += for_a * virial;
        sums_b[q].energy += for_b * energy, sums_b[q].virial += for_b * virial;
      }
    give(tail->a, of_a, sums_a);
    if (tail->a != tail->b) give(tail->b, of_b, sums_b);
  }
  return measures;
}

}  // namespace boltzmann
