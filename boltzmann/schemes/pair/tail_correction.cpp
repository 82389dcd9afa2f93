#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/pair_numbers.hpp>
#include <boltzmann/schemes/pair/tail_correction.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace boltzmann {
namespace {

constexpr int most_shells = 60;         // each twice as wide as the one before
constexpr double largest_ratio = 0.99;  // of one to the one before
constexpr double negligible = 1e-16;

/// The energy of a pair at a distance, of a law that knows nothing else.
class EnergyOfDistance {
 public:
  EnergyOfDistance(FormulaLaw const& law, AnyEnsemble const& a, AnyEnsemble const& b)
      : program_(law.between(a, b)),
        numbers_(*program_.numbers),
        law_(numbers_.law),
        inputs_(numbers_.inputs),
        square_(static_cast<std::size_t>(a.dimension())) {
    if (!program_.has_energy) throw Error("a tail needs the energy of the law; it has none");
    if (!program_.along || !program_.of_p.empty() || !program_.of_q.empty())
      throw Error("a tail is that of an energy which knows the distance of two particles, and nothing else of them");
  }
  double operator()(double r) {
    inputs_[0] = r;
    inputs_[square_] = r * r;
    law_.run(inputs_);
    return law_[1];
  }

 private:
  PairProgram program_;
  PairNumbers const& numbers_;
  Calculation law_;
  std::vector<double> inputs_;  // the separation, then its square
  std::size_t square_;
};

/// The sphere of radius 1: 2, 2 pi, 4 pi.
double surface(int dimension) {
  return dimension == 1 ? 2 : dimension == 2 ? 2 * std::numbers::pi : 4 * std::numbers::pi;
}

double volume_of(Box const& box) {
  double volume = 1;
  for (int a = 0; a < box.dimension(); ++a) volume *= box.length(a);
  return volume;
}

/// Gauss and Legendre's, of eight points on each side.
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
  int quiet = 0;  // shells one after the other that add nothing
  for (int k = 0; k < most_shells; ++k) {
    double const low = std::ldexp(distance, k), before = shell;
    shell = integral(low, 2 * low, [&](double r) { return std::pow(r, dimension - 1) * energy(r); });
    total += shell;
    ratio = shell / before;
    quiet = std::abs(shell) <= negligible * std::abs(total) ? quiet + 1 : 0;
    if (quiet == 3) return surface(dimension) * total;
  }
  // A power that falls off slowly: the shells behind these are a geometric series.
  if (ratio > 0 && ratio < largest_ratio) return surface(dimension) * (total + shell * ratio / (1 - ratio));
  throw Error(fmt::format(
      "its tail has no end: in {}D an energy must fall off faster than 1/r^{}, from the cut-off {} on it does "
      "not",
      dimension, dimension, distance));
}

TailCorrection::TailCorrection(Box box) : Scheme(std::move(box)) {
  for (int a = 0; a < this->box().dimension(); ++a)
    if (!this->box().periodic(a))
      throw Error(fmt::format("a tail is that of surroundings without end; axis {} is not periodic", "xyz"[a]));
}

std::size_t TailCorrection::number_of(AnyEnsemble const& ensemble) const {
  auto const& all = ensembles();
  return static_cast<std::size_t>(std::find(all.begin(), all.end(), &ensemble) - all.begin());
}

void TailCorrection::between(AnyEnsemble& a, AnyEnsemble& b, FormulaLaw const& law, double cutoff) {
  if (!std::isfinite(cutoff) || !(cutoff > 0)) throw Error("a tail begins at a cut-off; there is none");
  if (law.at_cutoff != FormulaLaw::AtCutoff::cut)
    throw Error("a law that is shifted or switched ends at its cut-off; a tail belongs to one that is cut");
  int const D = box().dimension();
  EnergyOfDistance energy(law, a, b);
  double const u = integral_beyond(cutoff, D, [&](double r) { return energy(r); });
  // By parts: the integral of - r u' r^(D-1) is R^D u(R) + D times that of u r^(D-1).
  double const w = surface(D) * std::pow(cutoff, D) * energy(cutoff) + D * u;
  add(a);
  add(b);
  tails_.push_back({number_of(a), number_of(b), u, w});
  if (&a != &b) tails_.push_back({number_of(b), number_of(a), u, w});
  changed();
}

EnergyAndVirial TailCorrection::measure(double) {
  auto measures = EnergyAndVirial::known();
  measures.reciprocal = true;
  auto const& all = ensembles();
  int const D = box().dimension();
  std::vector<double> energy(all.size(), 0.0), virial(all.size(), 0.0);  // of one particle, half of each of its pairs
  for (auto const& tail : tails_) {
    double const density = static_cast<double>(all[tail.b]->size()) / volume_of(box());
    energy[tail.a] += 0.5 * density * tail.energy;
    virial[tail.a] += 0.5 * density * tail.virial;
  }
  for (std::size_t e = 0; e < all.size(); ++e) {
    double const n = static_cast<double>(all[e]->size());
    measures.per_particle.emplace_back(all[e]->size(), energy[e]);
    auto& each = measures.virial_per_particle.emplace_back(9 * all[e]->size(), 0.0);
    measures.potential += n * energy[e];
    for (int a = 0; a < D; ++a) {
      measures.virial[static_cast<std::size_t>(a)][static_cast<std::size_t>(a)] += n * virial[e] / D;
      for (std::size_t i = 0; i < all[e]->size(); ++i) each[9 * i + 4 * static_cast<std::size_t>(a)] = virial[e] / D;
    }
  }
  return measures;
}

}  // namespace boltzmann
