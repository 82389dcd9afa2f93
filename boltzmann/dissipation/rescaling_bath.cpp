// Kinetic energies of baths, and the rescaling of velocities.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/dissipation/rescaling_bath.hpp>
#include <boltzmann/particles/degrees_of_freedom.hpp>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr std::size_t rescaling_grain = 2048;

/// Terms of all particles of this rank.
template <std::size_t K, class Function>
void add_terms_of(std::array<ExactSum, K>& sums, AnyEnsemble const& ensemble, int threads, Function const& f) {
  if (!ensemble.share()) return add_terms(sums, ensemble.size(), threads, f);
  for (auto const& [begin, end] : ensemble.share()->stretches)
    add_terms(sums, end - begin, 1,
              [&, first = begin](std::size_t i, std::array<double, K>& terms) { f(first + i, terms); });
}

}  // namespace

void RescalingBath::settle(Surroundings const& surroundings) {
  auto const own = ensembles();
  takes_all_ = !block() && std::all_of(surroundings.massive.begin(), surroundings.massive.end(), [&](auto const* one) {
    return std::find(own.begin(), own.end(), one) != own.end();
  });
  for (std::size_t a = 0; a < 3; ++a) kept_[a] = takes_all_ && surroundings.momentum_is_kept[a];
  bool const rigid = std::any_of(own.begin(), own.end(), [](auto const* one) { return !one->mobility.taken.empty(); });
  if (block() && rigid)
    throw Error("the heat bath of '" + own.front()->name() +
                "' scales velocities in a block, which would cut rigid bonds at its faces; let it act everywhere");
  if (block() || own.empty()) return;
  Motion const now = motion();
  if (!(degrees(now) > 0))
    throw Error("the heat bath of '" + own.front()->name() +
                "' has no degree of freedom to act on: one particle whose momentum is conserved does not get warm");
  if (!(now.kinetic > 0) && !surroundings.equilibrates)
    throw Error("the heat bath of '" + own.front()->name() +
                "' scales velocities, but no particle moves: give the ensemble a temperature");
}

RescalingBath::Motion RescalingBath::motion() const {
  Motion all;
  bool const relative = std::find(kept_.begin(), kept_.end(), true) != kept_.end();
  if (relative) {
    std::array<ExactSum, 4> total;  // momentum, mass
    for (auto const* ensemble : ensembles()) {
      int const mass = ensemble->field("mass").offset, velocity = ensemble->field("velocity").offset;
      add_terms_of(total, *ensemble, threads(), [&](std::size_t i, std::array<double, 4>& terms) {
        double const* const row = ensemble->row(i);
        if (!ensemble->mobility.moves(i)) return;
        for (int a = 0; a < ensemble->dimension(); ++a) terms[a] = row[mass] * row[velocity + a];
        terms[3] = row[mass];
      });
    }
    if (division()) division()->sum(total);
    for (std::size_t a = 0; a < 3; ++a)
      if (kept_[a]) all.common[a] = total[a].value() / total[3].value();
  }
  std::array<ExactSum, 2> sums;  // kinetic energy, degrees of freedom
  for (auto const* ensemble : ensembles()) {
    int const mass = ensemble->field("mass").offset, velocity = ensemble->field("velocity").offset;
    add_terms_of(sums, *ensemble, threads(), [&](std::size_t i, std::array<double, 2>& terms) {
      double const* const row = ensemble->row(i);
      if (!acts_on(*ensemble, i)) return;
      double square = 0;
      for (int a = 0; a < ensemble->dimension(); ++a) {
        double const v = row[velocity + a] - all.common[a];
        square += v * v;
      }
      terms[0] = 0.5 * row[mass] * square;
      terms[1] = freedom_of(*ensemble, i);
    });
  }
  if (division()) division()->sum(sums);
  all.kinetic = sums[0].value();
  all.freedom = sums[1].value();
  return all;
}

double RescalingBath::degrees(Motion const& motion) const {
  if (ensembles().empty()) return 0;
  return freedom_left(motion.freedom, ensembles().front()->dimension(), {kept_, 1}, 1);
}

double RescalingBath::degrees_of_freedom() const { return degrees(motion()); }
double RescalingBath::kinetic_energy() const {
  Carried const carried(*this);
  return motion().kinetic;
}

void RescalingBath::advance(StepContext const& context) {
  Carried const carried(*this);
  Motion const now = motion();
  double const freedom = degrees(now), kT = boltzmann_constant() * temperature_at(context.time);
  if (!(freedom > 0)) return;  // no moving particle is in its block
  if (!(now.kinetic > 0)) {
    if (kT > 0) throw PhysicsFailure("a heat bath scales velocities, but no particle in it moves");
    return;
  }
  double const scale = factor(now.kinetic, freedom, kT, context);
  for (auto* ensemble : ensembles()) {
    int const velocity = ensemble->field("velocity").offset, dimension = ensemble->dimension();
    for_share(*ensemble, rescaling_grain, threads_for(ensemble->size(), 1, threads()),
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                  double* row = ensemble->row(i);
                  if (!acts_on(*ensemble, i)) continue;
                  for (int a = 0; a < dimension; ++a) {
                    double& v = row[velocity + a];
                    v = now.common[a] + scale * (v - now.common[a]);
                  }
                }
              });
  }
  add_heat((scale * scale - 1) * now.kinetic);
}

}  // namespace boltzmann
