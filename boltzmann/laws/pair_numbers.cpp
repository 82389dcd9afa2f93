// Samples a law over distances: its wells, slopes and singularities.
#include <boltzmann/laws/pair_numbers.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace boltzmann {
namespace {

constexpr std::size_t distances = 400;  // of the samples
constexpr std::size_t pairs = 6;        // of particles
constexpr double rounding = 1e-9;       // of forces
constexpr double out_of_range = 1e100;  // a diverging force

/// The law between two particles of these ensembles, at a given distance in a fixed direction.
class PairSampler {
 public:
  PairSampler(PairNumbers const& law, AnyEnsemble const& target, AnyEnsemble const& source)
      : along_(law.along),
        has_energy_(law.has_energy),
        dimension_(static_cast<std::size_t>(target.dimension())),
        law_(law.law),
        numbers_(law),
        target_(target),
        source_(source),
        inputs_(law.inputs) {}

  /// Selects pair k of several, spread over the ensembles.
  void choose(std::size_t k) {
    std::size_t const p = k * (target_.size() - 1) / (pairs - 1);
    std::size_t q = (pairs - 1 - k) * (source_.size() - 1) / (pairs - 1);
    if (&target_ == &source_ && q == p) q = (p + 1) % source_.size();
    for (auto const [offset, input] : numbers_.of_target) inputs_[input] = target_.row(p)[offset];
    for (auto const [offset, input] : numbers_.of_source) inputs_[input] = source_.row(q)[offset];
    // A direction for each pair, not along an axis or a diagonal.
    static constexpr std::array<double, 3> parts{0.48, 0.64, 0.6};
    double const square = dimension_ == 1 ? 1 : dimension_ == 2 ? 0.64 : 1;
    for (std::size_t c = 0; c < dimension_; ++c)
      direction_[c] = dimension_ == 1 ? 1 : parts[(c + k) % dimension_] / (dimension_ == 2 ? std::sqrt(square) : 1);
  }
  /// The force that pushes p away from q, along their line.
  double force(double r) {
    for (std::size_t c = 0; c < dimension_; ++c) inputs_[c] = r * direction_[c];
    inputs_[dimension_] = r * r;
    law_.run(inputs_);
    if (along_) return -law_[0] * r;
    double sum = 0;
    for (std::size_t c = 0; c < dimension_; ++c) sum -= law_[c] * direction_[c];
    return sum;
  }
  /// At the distance of the last force.
  double energy() const { return has_energy_ ? law_[along_ ? 1 : dimension_] : 0; }

 private:
  bool along_, has_energy_;
  std::size_t dimension_;
  Calculation law_;
  PairNumbers const& numbers_;
  AnyEnsemble const &target_, &source_;
  std::vector<double> inputs_;
  std::array<double, 3> direction_{};
};

/// Forces at the distances reach/n, 2 reach/n, ..., reach.
struct Curve {
  double step;
  std::vector<double> forces, energies;
  double distance(std::size_t k) const { return step * static_cast<double>(k + 1); }
};

/// The width of the innermost well, where a force turns from repulsion to attraction; 0 if there is none.
double width_of_well(Curve const& curve) {
  for (std::size_t k = 0; k + 1 < curve.forces.size(); ++k) {
    if (!(curve.forces[k] > 0 && curve.forces[k + 1] <= 0)) continue;
    double const stiffness = (curve.forces[k] - curve.forces[k + 1]) / curve.step;
    // The work from the bottom outwards, over the attractive part.
    double depth = 0, strongest = 0, of_all = 0;
    for (std::size_t j = k + 1; j < curve.forces.size() && curve.forces[j] <= 0; ++j) {
      depth -= curve.forces[j] * curve.step;
      strongest = std::max(strongest, -curve.forces[j]);
    }
    for (std::size_t j = curve.forces.size() / 2; j < curve.forces.size(); ++j)
      of_all = std::max(of_all, std::fabs(curve.forces[j]));
    if (strongest < rounding * of_all) return 0;  // zero up to rounding: a force that has been switched off
    return depth > 0 ? std::sqrt(2 * depth / stiffness) : 0;
  }
  return 0;
}

/// For a force that stays finite: its greatest value over its steepest slope.
double length_of_change(Curve const& curve) {
  double greatest = 0, steepest = 0;
  for (std::size_t k = 0; k < curve.forces.size(); ++k) {
    greatest = std::max(greatest, std::fabs(curve.forces[k]));
    if (k > 0) steepest = std::max(steepest, std::fabs(curve.forces[k] - curve.forces[k - 1]) / curve.step);
  }
  return steepest > 0 ? greatest / steepest : __builtin_inf();
}

/// True if a force diverges at small distances: at half the distance it is much greater.
bool is_singular(PairSampler& sampler, double near) {
  double const there = std::fabs(sampler.force(near)), nearer = std::fabs(sampler.force(near / 2));
  return !(nearer < 1.4 * there) && nearer > 0;
}

/// True if there is a pair to sample.
bool are_pairs(AnyEnsemble const& target, AnyEnsemble const& source, double reach) {
  if (target.size() == 0 || source.size() == 0 || (&target == &source && target.size() < 2)) return false;
  return reach > 0 && std::isfinite(reach);
}

}  // namespace

LawSample sample_law(PairNumbers const& law, AnyEnsemble const& target, AnyEnsemble const& source, double reach,
                     double spacing) {
  LawSample sample;
  if (!are_pairs(target, source, reach)) return sample;
  PairSampler sampler(law, target, source);
  Curve curve{reach / distances, {}, {}};
  for (std::size_t k = 0; k < pairs; ++k) {
    sampler.choose(k);
    curve.forces.assign(distances, 0.0);
    std::size_t from = 0;  // forces at smaller distances overflow doubles
    for (std::size_t n = distances; n-- > 0;) {
      // A distance at the cut-off is excluded; the last sample is just within it.
      double const r = n + 1 == distances ? reach * (1 - 1e-12) : curve.distance(n);
      double const force = sampler.force(r);
      if (std::isfinite(force) && std::isfinite(sampler.energy())) {
        curve.forces[n] = force;
        continue;
      }
      from = n + 1;
      bool const overflow = from < distances && std::fabs(curve.forces[from]) > out_of_range;
      if (!overflow) sample.not_finite_at = std::max(sample.not_finite_at, r);
      break;
    }
    if (sample.not_finite_at > 0) continue;
    Curve const finite{curve.step, {curve.forces.begin() + static_cast<std::ptrdiff_t>(from), curve.forces.end()}, {}};
    double greatest = 0;
    for (std::size_t n = from; n < distances; ++n)
      if (curve.distance(n) >= std::min(spacing, 0.5 * reach))
        greatest = std::max(greatest, std::fabs(curve.forces[n]));
    if (greatest > 0) sample.left_at_reach = std::max(sample.left_at_reach, std::fabs(curve.forces.back()) / greatest);
    double length = width_of_well(finite);
    if (length == 0 && from == 0 && !is_singular(sampler, curve.step)) length = length_of_change(curve);
    if (length > 0) sample.length_scale = std::min(sample.length_scale, length);
  }
  return sample;
}

LawCurve law_curve(PairNumbers const& law, AnyEnsemble const& target, AnyEnsemble const& source, double reach,
                   std::size_t points) {
  LawCurve curve;
  if (!are_pairs(target, source, reach)) return curve;
  PairSampler sampler(law, target, source);
  sampler.choose(0);
  for (std::size_t k = 1; k <= points; ++k) {
    double const r = k == points ? reach * (1 - 1e-12) : reach * static_cast<double>(k) / static_cast<double>(points);
    curve.distance.push_back(r);
    curve.force.push_back(sampler.force(r));
    if (law.has_energy) curve.energy.push_back(sampler.energy());
  }
  return curve;
}

}  // namespace boltzmann
