// Shardlow's splitting: one pair after the other, each by an implicit step that conserves its momentum and its energy
// (Shardlow).
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/dissipation/splitting.hpp>
#include <boltzmann/dissipation/strength.hpp>
#include <boltzmann/dissipation/typed_friction.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

/// One end of a pair.
struct End {
  double* velocity;
  double inverse_mass;
  double* energy;       // null at a fixed temperature
  StateLaw const* law;  // null likewise
};

/// The weight of a pair: chi or, if friction depends on temperatures, the square of the distance.
struct Weighing {
  double chi, square;
  TypedFriction const* typed;  // null if chi is known
};

/// The factors of v and the normal: gamma chi^2 dt, sigma chi sqrt(dt).
struct Weighed {
  double friction, noise;
};

Weighed strength_of(PairNoise const& n, Weighing const& weighing, End const& i, End const& j, double energy_i,
                    double energy_j, double square, int directions) {
  double const inverse_masses = i.inverse_mass + j.inverse_mass;
  auto const weighed = [](Strength<double> const& s, double chi, double change) {
    return Weighed{s.friction * chi * chi + s.by_change * change, s.noise * chi};
  };
  if (!i.law) return weighed({n, 0, 0, 0, inverse_masses, square, 1.0 * directions}, weighing.chi, 0);
  double const ti = i.law->temperature(energy_i), tj = j.law->temperature(energy_j);
  double const curvatures = n.convention == Convention::constant_friction
                                ? 1 / (ti * ti * i.law->heat_capacity(ti)) + 1 / (tj * tj * j.law->heat_capacity(tj))
                                : 0;
  Strength<double> const strength(n, 1 / ti + 1 / tj, 1 / (ti * tj), curvatures, inverse_masses, square,
                                  1.0 * directions);
  if (!weighing.typed) return weighed(strength, weighing.chi, 0);
  auto const at = weighing.typed->at(weighing.square, 2 / (1 / ti + 1 / tj));
  return weighed(strength, at.strength, at.change);
}

/// The entropy gain for an energy; for small changes without a difference of large numbers.
double entropy_gain(StateLaw const& law, double energy, double gained) {
  return std::abs(gained) < 1e-4 * energy ? gained / law.temperature(energy + 0.5 * gained)
                                          : law.entropy(energy + gained) - law.entropy(energy);
}

/// log of the probability density of a normal of mean 0 in this number of directions, up to a constant.
double log_normal(double square, double deviation, int directions) {
  return -0.5 * square / (deviation * deviation) - directions * std::log(deviation);
}

/// The pairs of one coupling, one after the other.
template <int D, bool projected>
class PairSteps {
 public:
  static constexpr int directions = projected ? 1 : D;

  /// `typed`: friction that depends on temperatures, or null.
  PairSteps(PairNoise const& noise, TypedFriction const* typed, bool metropolis, StepContext const& context)
      : noise_(noise), typed_(typed), metropolis_(metropolis), context_(context) {}

  ExactSum heat;
  std::uint64_t proposed = 0, refused = 0;

  /// Pair k of the block of columns. False if an internal energy would not be positive.
  bool step(double const* columns, std::size_t k, End const& i, End const& j, std::uint64_t number_i,
            std::uint64_t number_j) {
    double const chi = columns[k];
    if (chi == 0) return true;
    double v[directions], normal[directions + 1];
    double const* direction = columns + geometry_block;
    if constexpr (projected) {
      v[0] = 0;
      for (int a = 0; a < D; ++a)
        v[0] += (i.velocity[a] - j.velocity[a]) * direction[static_cast<std::size_t>(a) * geometry_block + k];
    } else {
      for (int a = 0; a < D; ++a) v[a] = i.velocity[a] - j.velocity[a];
    }
    for (int a = 0; a <= directions; ++a) normal[a] = columns[static_cast<std::size_t>(4 + a) * geometry_block + k];
    // Each coupling has a value of its own, and so have (a1, b2) and (a2, b1): the two ensembles number their particles
    // separately.
    std::uint64_t const kind = (noise_.tag & 0xffU) + (!noise_.same && number_i > number_j ? 1 : 0);
    Stream chance = Stream::pair(
        context_.seed, context_.step | (noise_.tag >> 8U & 0xffU) << 48U, number_i, number_j,
        static_cast<Purpose>(static_cast<std::uint32_t>(Purpose::pair_noise) | static_cast<std::uint32_t>(kind) << 8U));
    double const behind = columns[weight_column * geometry_block + k];
    if (!exchange_momentum({chi, behind, typed_}, v, normal, i, j, columns, k, chance)) return false;
    if (noise_.conduction == 0) return true;
    return conduct(typed_ ? typed_->at(behind, 1).weight : behind, normal[directions], i, j, chance);
  }

 private:
  bool exchange_momentum(Weighing const& weighing, double const* v, double const* normal, End const& i, End const& j,
                         double const* columns, std::size_t k, Stream& chance) {
    double const reduced = 1 / (i.inverse_mass + j.inverse_mass);
    double const ei = i.energy ? *i.energy : 0, ej = j.energy ? *j.energy : 0;
    double before = 0;
    for (int a = 0; a < directions; ++a) before += v[a] * v[a];
    auto const now = strength_of(noise_, weighing, i, j, ei, ej, before, directions);
    // v' = ((1 - c) v + (s / mu) U) / (1 + c), c = a / 2mu
    double const c = 0.5 * now.friction / reduced, s = now.noise / reduced;
    double const keep = (1 - c) / (1 + c), kick = s / (1 + c);
    double gained[directions], after = 0;
    for (int a = 0; a < directions; ++a) {
      double const then = keep * v[a] + kick * normal[a];
      gained[a] = then - v[a];
      after += then * then;
    }
    double moved = 0;  // half of the energy gain of the motion: (v' - v).(v' + v) mu / 4
    for (int a = 0; a < directions; ++a) moved += gained[a] * (2 * v[a] + gained[a]);
    moved *= 0.25 * reduced;
    if (i.energy) {
      double const left_i = ei - moved, left_j = ej - moved;
      if (metropolis_) {
        ++proposed;
        if (!accepted(weighing, v, gained, keep, kick, after, i, j, moved, chance)) {
          ++refused;
          return true;
        }
      } else if (!(left_i > 0 && left_j > 0)) {
        return false;
      }
      *i.energy = left_i;
      *j.energy = left_j;
    } else {
      heat += 2 * moved;
      if (!std::isfinite(moved)) return false;
    }
    for (int a = 0; a < D; ++a) {
      double push = reduced * gained[projected ? 0 : a];
      if constexpr (projected) push *= columns[static_cast<std::size_t>(1 + a) * geometry_block + k];
      i.velocity[a] += push * i.inverse_mass;
      j.velocity[a] -= push * j.inverse_mass;
    }
    return true;
  }

  /// Metropolis and Hastings: for given energy and momentum, the density of v is exp((s_i + s_j) / k).
  bool accepted(Weighing const& weighing, double const* v, double const* gained, double keep, double kick, double after,
                End const& i, End const& j, double moved, Stream& chance) const {
    double const u = chance.uniform();
    double const left_i = *i.energy - moved, left_j = *j.energy - moved;
    if (!(left_i > 0 && left_j > 0)) return false;
    double const reduced = 1 / (i.inverse_mass + j.inverse_mass);
    auto const then = strength_of(noise_, weighing, i, j, left_i, left_j, after, directions);
    double const c = 0.5 * then.friction / reduced, s = then.noise / reduced;
    double const keep_back = (1 - c) / (1 + c), kick_back = s / (1 + c);
    double there = 0, back = 0;
    for (int a = 0; a < directions; ++a) {
      double const now = v[a] + gained[a];
      there += (now - keep * v[a]) * (now - keep * v[a]);
      back += (v[a] - keep_back * now) * (v[a] - keep_back * now);
    }
    double const entropy = entropy_gain(*i.law, *i.energy, -moved) + entropy_gain(*j.law, *j.energy, -moved);
    double const log_ratio = entropy / noise_.boltzmann_constant + log_normal(back, kick_back, directions) -
                             log_normal(there, kick, directions);
    return std::log(u) < log_ratio;
  }

  /// eps_i gains kappa chi^2 (1/Ti - 1/Tj) dt + sqrt(2 k kappa dt) chi U, eps_j loses it.
  bool conduct(double chi, double normal, End const& i, End const& j, Stream& chance) {
    if (!i.energy) return true;
    double const u = metropolis_ ? chance.uniform() : 0;
    auto const drift = [&](double ei, double ej) {
      return noise_.conduction * chi * chi * (1 / i.law->temperature(ei) - 1 / j.law->temperature(ej));
    };
    double const deviation = noise_.conduction_noise * chi, ei = *i.energy, ej = *j.energy;
    double const there = drift(ei, ej), gained = there + deviation * normal;
    double const then_i = ei + gained, then_j = ej - gained;
    bool const positive = then_i > 0 && then_j > 0;
    if (metropolis_) {
      ++proposed;
      bool accept = positive;
      if (positive) {
        double const back = drift(then_i, then_j);
        double const entropy = entropy_gain(*i.law, ei, gained) + entropy_gain(*j.law, ej, -gained);
        double const log_ratio = entropy / noise_.boltzmann_constant -
                                 0.5 * (-gained - back) * (-gained - back) / (deviation * deviation) +
                                 0.5 * (gained - there) * (gained - there) / (deviation * deviation);
        accept = std::log(u) < log_ratio;
      }
      if (!accept) {
        ++refused;
        return true;
      }
    } else if (!positive) {
      return false;
    }
    *i.energy = then_i;
    *j.energy = then_j;
    return true;
  }

  PairNoise const& noise_;
  TypedFriction const* typed_;
  bool metropolis_;
  StepContext const& context_;
};

}  // namespace

template <int D, bool projected>
void PairDissipation::Splitting::run_in(Edge& edge, Part const& part, PairNoise const& noise, bool metropolis,
                                        StepContext const& context) {
  Member &first = *part.coupling->target, &second = *part.coupling->source;
  auto const& kernels = dissipation_kernels_for(D, projected);
  auto const end = [](Member& m, std::uint32_t row) {
    double* point = m.point(row);
    bool const has_energy = m.has_energy();
    return End{point + m.velocity_at(), point[m.inverse_mass_at()], has_energy ? &m.energies[row] : nullptr,
               has_energy ? &*m.law : nullptr};
  };
  alignas(64) double columns[geometry_columns * geometry_block];
  auto const* typed = part.coupling->dissipation.typed.get();
  PairSteps<D, projected> steps(noise, noise.of_temperature ? typed : nullptr, metropolis, context);
  for (std::size_t start = 0; start < part.pairs.size(); start += geometry_block) {
    GeometryTask task;
    task.first = first.points.data();
    task.second = second.points.data();
    task.first_number = first.copy->order();
    task.second_number = second.copy->order();
    task.pairs = part.pairs.data() + start;
    task.count = std::min(geometry_block, part.pairs.size() - start);
    task.columns = columns;
    task.noise = noise;
    kernels.geometry(task);
    for (std::size_t k = 0; k < task.count; ++k) {
      DissipationPair const& pair = task.pairs[k];
      End const i = end(first, pair.first), j = end(second, pair.second);
      if (!steps.step(columns, k, i, j, first.copy->order()[pair.first], second.copy->order()[pair.second]))
        throw PhysicsFailure(
            i.energy ? fmt::format("friction and noise would take more internal energy from {} ({:.4g}) or {} "
                                   "({:.4g}) than there is; take a smaller step, or metropolis",
                                   first.who(pair.first), *i.energy, second.who(pair.second), *j.energy)
                     : fmt::format("friction between {} and {} is not finite", first.who(pair.first),
                                   second.who(pair.second)));
    }
  }
  edge.heat->add(steps.heat);
  edge.proposed += steps.proposed;
  edge.refused += steps.refused;
}

void PairDissipation::Splitting::run(Edge& edge, Part const& part, PairNoise const& noise, bool metropolis,
                                     StepContext const& context) {
  int const dimension = part.coupling->target->dimension();
  bool const projected = part.coupling->dissipation.projected;
  auto const run = dimension == 1   ? projected ? run_in<1, true> : run_in<1, false>
                     : dimension == 2 ? projected ? run_in<2, true> : run_in<2, false>
                     : projected ? run_in<3, true>
                                    : run_in<3, false>;
  run(edge, part, noise, metropolis, context);
}

/// Calls function(member, row) for all particles with friction, in parallel over each member's chunks.
template <class Function>
void PairDissipation::for_dissipating(Function const& function) {
  for (auto& member : members_) {
    Member& m = *member;
    if (!m.dissipates) continue;
    for_ranges(m.owned(), dissipation_chunk, threads_for(m.owned(), 2, threads()),
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t k = begin; k < end; ++k) function(m, k);
               });
  }
}

void PairDissipation::shardlow(StepContext const& context) {
  for (auto& member : members_)
    if (member->dissipates && member->has_energy()) member->energies.resize(member->owned());
  for_dissipating([](Member& m, std::size_t k) {
    if (m.has_energy()) m.energies[k] = m.ensemble->row(m.copy->order()[k])[m.energy];
  });
  Splitting& splitting = *splitting_;
  splitting.take_pairs(scheme_.neighbourhood(), members_, couplings_, threads());

  std::size_t particles = 0;
  for (auto const& member : members_) particles += member->dissipates ? member->owned() : 0;
  for (auto const& colour : splitting.colours)
    for_ranges(colour.size(), 1, threads_for(particles, 4, threads()), [&](std::size_t begin, std::size_t end) {
      for (std::size_t e = begin; e < end; ++e) {
        Splitting::Edge& edge = splitting.edges[colour[e]];
        edge.heat.emplace();
        edge.proposed = edge.refused = 0;
        for (auto const& part : edge.parts)
          splitting.run(edge, part, part.coupling->noise(context, boltzmann_constant_, number()), metropolis_, context);
      }
    });
  ExactSum heat;
  for (auto const& edge : splitting.edges) {
    if (edge.heat) heat.add(*edge.heat);
    proposed_ += edge.proposed;
    refused_ += edge.refused;
  }
  heat_ += heat.value();
  for_dissipating([](Member& m, std::size_t k) {
    double* row = m.ensemble->row(m.copy->order()[k]);
    std::copy_n(m.point(k) + m.velocity_at(), m.dimension(), row + m.velocity);
    if (m.has_energy()) row[m.energy] = m.energies[k];
  });
}

}  // namespace boltzmann
