// Splines of embedded atoms, from functions or points, with common knots.
#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/embedded_atoms.hpp>
#include <boltzmann/laws/parameter.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr std::size_t coarsest = 16, finest_of_functions = 8192;

/// From 1 at `from` to 0 at the cut-off, with three continuous derivatives.
double smooth_end(double r, double from, double cutoff) {
  if (r <= from) return 1;
  if (r >= cutoff) return 0;
  double const x = (r - from) / (cutoff - from);
  return 1 - x * x * x * x * (35 + x * (-84 + x * (70 - 20 * x)));
}

EmbeddedReach settled(EmbeddedReach reach) {
  check_parameter("embedded atoms", "cutoff", reach.cutoff, positive);
  if (reach.switch_from < 0) reach.switch_from = 0.9 * reach.cutoff;
  if (reach.first < 0) reach.first = 0.05 * reach.cutoff;
  if (!(reach.first > 0 && reach.first < reach.switch_from && reach.switch_from <= reach.cutoff))
    throw Error(
        fmt::format("embedded atoms: first = {:.6g}, switch_from = {:.6g}, cutoff = {:.6g}: the first must be "
                    "positive, each no more than "
                    "the next",
                    reach.first, reach.switch_from, reach.cutoff));
  return reach;
}

SuttonChen const& checked(SuttonChen const& law) {
  check_parameter("Sutton-Chen", "epsilon", law.epsilon, positive);
  check_parameter("Sutton-Chen", "a", law.a, positive);
  check_parameter("Sutton-Chen", "n", law.n, positive);
  check_parameter("Sutton-Chen", "m", law.m, positive);
  check_parameter("Sutton-Chen", "c", law.c, positive);
  return law;
}

Gupta const& checked(Gupta const& law) {
  check_parameter("Gupta", "A", law.A, positive);
  check_parameter("Gupta", "xi", law.xi, positive);
  check_parameter("Gupta", "p", law.p, positive);
  check_parameter("Gupta", "q", law.q, positive);
  check_parameter("Gupta", "r0", law.r0, positive);
  return law;
}

}  // namespace

EmbeddedAtoms::EmbeddedAtoms(std::vector<EmbeddedElement> elements, Between const& pair, Between const& density,
                             EmbeddedReach const& reach, Tolerance tolerance)
    : EmbeddedAtoms(
          std::move(elements),
          [&, in = settled(reach)](std::size_t a, std::size_t b, PerOctave fineness) {
            auto const ended = [&](double r) { return pair(a, b, r) * smooth_end(r, in.switch_from, in.cutoff); };
            return Table(ended, in.first, in.cutoff, fineness);
          },
          [&, in = settled(reach)](std::size_t a, std::size_t b, PerOctave fineness) {
            auto const ended = [&](double r) { return density(a, b, r) * smooth_end(r, in.switch_from, in.cutoff); };
            return Table(ended, in.first, in.cutoff, fineness);
          },
          finest_of_functions, tolerance.relative) {
  if (error_ > tolerance.relative)
    throw Error(fmt::format(
        "embedded atoms: {} intervals from {:.6g} to {:.6g} still have the relative error {:.3g}, above the tolerance "
        "{:.3g}",
        intervals_, first_, cutoff_, error_, tolerance.relative));
}

EmbeddedAtoms::EmbeddedAtoms(SuttonChen const& law, EmbeddedReach const& reach)
    : EmbeddedAtoms([law = checked(law)](double r) { return law.epsilon * std::pow(law.a / r, law.n); },
                    [law](double r) { return std::pow(law.a / r, law.m); },
                    [law](auto const& density) { return -law.c * law.epsilon * sqrt(density); }, reach) {}

EmbeddedAtoms::EmbeddedAtoms(Gupta const& law, EmbeddedReach const& reach)
    : EmbeddedAtoms([law = checked(law)](double r) { return 2 * law.A * std::exp(-law.p * (r / law.r0 - 1)); },
                    [law](double r) { return law.xi * law.xi * std::exp(-2 * law.q * (r / law.r0 - 1)); },
                    [](auto const& density) { return -sqrt(density); }, reach) {}

EmbeddedAtoms::EmbeddedAtoms(std::vector<EmbeddedElement> elements, Tabulate const& pair, Tabulate const& density,
                             std::size_t finest, double tolerance)
    : elements_(std::move(elements)) {
  if (elements_.empty()) throw Error("embedded atoms: no element; one or more are needed");
  std::size_t const count = elements_.size();
  std::vector<Table> densities, energies;
  for (std::size_t fineness = coarsest;; fineness *= 2) {
    densities.clear(), energies.clear();
    error_ = 0;
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = 0; b < count; ++b) {
        densities.push_back(density(a, b, PerOctave{fineness}));
        energies.push_back(pair(std::max(a, b), std::min(a, b), PerOctave{fineness}));
        error_ = std::max({error_, densities.back().error().relative, energies.back().error().relative});
      }
    if (error_ <= tolerance || fineness >= finest) break;
  }
  Table const& one = densities.front();
  first_ = one.first();
  cutoff_ = one.last();
  // The first interval is preceded by one for the straight line that continues the splines.
  knots_ = one.knots();
  knots_.least = knots_.knot(--knots_.first_row);
  intervals_ = one.intervals() + 1;
  double const before = knots_.knot(knots_.first_row + 1) - knots_.least;
  std::size_t const lines = count > 1 ? 2 : 1;
  auto all = std::make_shared<std::vector<Line>>(count * count * intervals_ * lines);
  auto const fill = [&](std::size_t line, int block, Table const& table) {
    double* const c = (*all)[line].c + 4 * block;
    double const* from = table.coefficients();
    c[0] = from[0] - before * from[1];
    c[1] = from[1];
    for (std::size_t k = 1; k < intervals_; ++k, from += 4) std::copy_n(from, 4, c + 8 * lines * k);
  };
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = 0; b < count; ++b) {
      std::size_t const line = (a * count + b) * intervals_ * lines;
      fill(line, 0, densities[a * count + b]);
      fill(line, 1, energies[a * count + b]);
      if (count > 1) fill(line + 1, 0, densities[b * count + a]);
    }
  lines_ = std::move(all);
}

EmbeddedTables EmbeddedAtoms::tables() const {
  auto const count = static_cast<std::int64_t>(elements_.size());
  EmbeddedTables all{knots_, lines_->front().c, count, 0};
  all.pair_stride = static_cast<std::int64_t>(intervals_) * all.line();
  return all;
}

double EmbeddedAtoms::value(double r, std::size_t a, std::size_t b, int block) const {
  if (!(r < cutoff_)) return 0;
  EmbeddedTables const all = tables();
  std::int64_t const row = all.knots.row(all.knots.inside(r * r));
  double const* const c = all.rows + static_cast<std::int64_t>(a * elements_.size() + b) * all.pair_stride +
                          (row - all.knots.first_row) * all.line() + 4 * block;
  double const d = r * r - all.knots.knot(row);
  return c[0] + d * (c[1] + d * (c[2] + d * c[3]));
}

}  // namespace boltzmann
