// A plain scalar oracle of pair dissipation: all pairs, nearest images, the same noise. Nothing of it comes from
// the engine but the shape of a normal and the state laws.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/pack_random.hpp>
#include <boltzmann/dissipation/dissipation_law.hpp>
#include <boltzmann/integrators/integrator.hpp>
#include <boltzmann/laws/state_law.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace boltzmann {

inline constexpr Convention all_conventions[] = {Convention::fixed_temperature, Convention::constant_noise,
                                                 Convention::constant_friction, Convention::deterministic};

inline DissipationLaw friction_of(Convention convention, double range) {
  DissipationLaw d;
  d.convention = convention;
  d.friction = 3;
  d.range = range;
  d.temperature = convention == Convention::constant_friction ? 0 : 1.3;
  return d;
}

using Four = std::array<std::uint32_t, 4>;

/// Philox4x32-10 (Salmon, Moraes, Dror and Shaw, SC11).
inline Four philox_by_hand(Four c, std::uint32_t k0, std::uint32_t k1) {
  for (int round = 0; round < 10; ++round) {
    std::uint64_t const a = std::uint64_t{0xD2511F53} * c[0], b = std::uint64_t{0xCD9E8D57} * c[2];
    c = {static_cast<std::uint32_t>(b >> 32) ^ c[1] ^ k0, static_cast<std::uint32_t>(b),
         static_cast<std::uint32_t>(a >> 32) ^ c[3] ^ k1, static_cast<std::uint32_t>(a)};
    k0 += 0x9E3779B9;
    k1 += 0xBB67AE85;
  }
  return c;
}

/// The four normals of a pair: `low` and `high` are the numbers of its particles (of one ensemble: in ascending order;
/// of two: in that of the ensembles).
inline std::array<double, 4> normals_of_pair(std::uint32_t low, std::uint32_t high, std::uint32_t coupling,
                                             std::uint32_t dissipation, StepContext const& context) {
  auto const word =
      philox_by_hand({low, high, static_cast<std::uint32_t>(context.step),
                      coupling | dissipation << 8U | static_cast<std::uint32_t>(context.step >> 32) << 16U},
                     static_cast<std::uint32_t>(context.seed), static_cast<std::uint32_t>(context.seed >> 32));
  detail::Words<2> const zero{};
  auto const first = normals<2>(zero + word[0], zero + word[1]), second = normals<2>(zero + word[2], zero + word[3]);
  return {first[0][0], first[1][0], second[0][0], second[1][0]};
}

struct OracleBody {
  int kind;  // which ensemble
  std::uint32_t number;
  std::array<double, 3> position{}, velocity{};
  double mass = 1, energy = 0;
};

/// Dissipation between the ensembles `a` and `b`. The first coupling has the number 0; one inside an ensemble takes one
/// number, one between two takes two.
struct OracleCoupling {
  DissipationLaw dissipation;
  int a = 0, b = 0;
  std::uint32_t number = 0;
  std::uint32_t owner = 0;  // the number of the dissipation in its simulation
};

struct OracleStrength {
  double friction, noise;  // gamma_ij dt, sigma_ij sqrt(dt)
};

/// `square`: of the relative velocity in `directions` directions.
inline OracleStrength oracle_strength(DissipationLaw const& d, double k, double dt, double ti, double ci, double tj,
                                      double cj, double reduced_mass, double square, int directions) {
  double const beta = (1 / ti + 1 / tj) / (2 * k), gamma = d.friction;
  switch (d.convention) {
    case Convention::fixed_temperature:
      return {gamma * dt, std::sqrt(2 * gamma * k * d.temperature * dt)};
    case Convention::constant_noise: {
      double const sigma2 = 2 * gamma * k * d.temperature;
      return {0.5 * sigma2 * beta * dt, std::sqrt(sigma2 * dt)};
    }
    case Convention::constant_friction:
      return {gamma * (1 + (1 / (ti * ti * ci) + 1 / (tj * tj * cj)) / (4 * k * beta * beta)) * dt,
              std::sqrt(2 * gamma / beta * dt)};
    case Convention::deterministic:
      break;
  }
  double const outside = reduced_mass * square / (k * (directions + 2));
  return {gamma * dt * (outside - 0.5 * (ti + tj)) / d.temperature, 0};
}

struct OracleMatter {
  Box box;
  double k = 1;
  std::vector<OracleBody> bodies;
  std::vector<StateLaw const*> laws;  // of each ensemble; null: at a fixed temperature
  double heat = 0;

  OracleMatter(Box const& box, double k, std::vector<AnyEnsemble*> const& ensembles,
               std::vector<StateLaw const*> state_laws)
      : box(box), k(k), laws(std::move(state_laws)) {
    int const dimension = box.dimension();
    for (int kind = 0; auto const* ensemble : ensembles) {
      int const v = ensemble->field("velocity").offset, m = ensemble->field("mass").offset;
      Field const* energy = ensemble->find_field("internal_energy");
      for (std::size_t i = 0; i < ensemble->size(); ++i) {
        double const* row = ensemble->row(i);
        OracleBody body{kind, static_cast<std::uint32_t>(i), {}, {}, row[m], energy ? row[energy->offset] : 0};
        std::copy_n(row, dimension, body.position.begin());
        std::copy_n(row + v, dimension, body.velocity.begin());
        bodies.push_back(body);
      }
      ++kind;
    }
  }

  /// One step of the simultaneous dissipation.
  void simultaneous(std::vector<OracleCoupling> const& couplings, StepContext const& context, bool corrector) {
    std::size_t const count = bodies.size();
    std::vector<double> temperature(count, 1), capacity(count, 1);
    for (std::size_t i = 0; i < count; ++i)
      if (StateLaw const* law = laws[static_cast<std::size_t>(bodies[i].kind)]) {
        temperature[i] = law->temperature(bodies[i].energy);
        capacity[i] = law->heat_capacity(temperature[i]);
      }
    std::vector<std::array<double, 3>> velocity(count), push(count), predicted(count);
    std::vector<double> loss(count);
    for (std::size_t i = 0; i < count; ++i) velocity[i] = bodies[i].velocity;
    auto const act = [&] {
      std::fill(push.begin(), push.end(), std::array<double, 3>{});
      std::fill(loss.begin(), loss.end(), 0.0);
      for (auto const& coupling : couplings)
        each_pair(coupling, [&](std::size_t i, std::size_t j, double chi, std::array<double, 3> const& direction) {
          exchange(coupling, context, i, j, chi, direction, temperature, capacity, velocity, push, loss, !corrector);
        });
    };
    // The mean of the velocities before and after the try before; a second try where heat is shared.
    bool const shares = std::any_of(laws.begin(), laws.end(), [](auto const* law) { return law != nullptr; });
    for (int n = 0; n < (corrector ? shares ? 2 : 1 : 0); ++n) {
      act();
      predicted = push;
      for (std::size_t i = 0; i < count; ++i)
        for (int a = 0; a < 3; ++a) velocity[i][a] = bodies[i].velocity[a] + 0.5 * push[i][a] / bodies[i].mass;
    }
    act();
    for (std::size_t i = 0; i < count; ++i) {
      OracleBody& body = bodies[i];
      double lost = loss[i];
      for (int a = 0; a < 3; ++a) {
        lost += push[i][a] * (push[i][a] - predicted[i][a]) / (2 * body.mass);
        body.velocity[a] += push[i][a] / body.mass;
      }
      if (laws[static_cast<std::size_t>(body.kind)])
        body.energy -= lost;
      else
        heat += lost;
    }
  }

  /// Calls function(i, j, chi, unit vector from j to i) for all pairs within range, i < j or i of the first ensemble.
  template <class Function>
  void each_pair(OracleCoupling const& coupling, Function const& function) const {
    DissipationLaw const& d = coupling.dissipation;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (bodies[i].kind != coupling.a) continue;
      for (std::size_t j = coupling.a == coupling.b ? i + 1 : 0; j < bodies.size(); ++j) {
        if (bodies[j].kind != coupling.b) continue;
        std::array<double, 3> r{};
        for (int a = 0; a < 3; ++a) r[a] = bodies[i].position[a] - bodies[j].position[a];
        box.nearest_image(r.data());
        double const distance2 = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
        if (!(distance2 < d.range * d.range)) continue;
        double const distance = std::sqrt(distance2);
        for (double& x : r) x /= distance;
        function(i, j, std::pow(1 - distance / d.range, d.exponent), r);
      }
    }
  }

 private:
  void exchange(OracleCoupling const& coupling, StepContext const& context, std::size_t i, std::size_t j, double chi,
                std::array<double, 3> const& e, std::vector<double> const& t, std::vector<double> const& c,
                std::vector<std::array<double, 3>> const& u, std::vector<std::array<double, 3>>& push,
                std::vector<double>& loss, bool even_shares) const {
    DissipationLaw const& d = coupling.dissipation;
    int const directions = d.projected ? 1 : box.dimension();
    double const mi = bodies[i].mass, mj = bodies[j].mass, reduced = mi * mj / (mi + mj);
    auto const normal = normals_of_pair(bodies[i].number, bodies[j].number, coupling.number, coupling.owner, context);
    std::array<double, 3> v{}, p{};
    double along = 0, square = 0;
    for (int a = 0; a < 3; ++a) v[a] = u[i][a] - u[j][a], along += v[a] * e[a], square += v[a] * v[a];
    if (d.projected) square = along * along;
    auto const s = oracle_strength(d, k, context.dt, t[i], c[i], t[j], c[j], reduced, square, directions);
    double work = 0, p2 = 0;
    for (int a = 0; a < box.dimension(); ++a) {
      p[a] = d.projected ? (s.noise * chi * normal[0] - s.friction * chi * chi * along) * e[a]
                         : s.noise * chi * normal[a] - s.friction * chi * chi * v[a];
      work += p[a] * v[a];
      p2 += p[a] * p[a];
    }
    double transfer = even_shares ? 0.25 * p2 * (1 / mj - 1 / mi) : 0;
    if (d.conduction > 0)
      transfer -= d.conduction * context.dt * chi * chi * (1 / t[i] - 1 / t[j]) +
                  std::sqrt(2 * k * d.conduction * context.dt) * chi * normal[directions];
    for (int a = 0; a < 3; ++a) push[i][a] += p[a], push[j][a] -= p[a];
    loss[i] += 0.5 * work + transfer;
    loss[j] += 0.5 * work - transfer;
  }
};

/// The largest deviation of ensembles from the oracle: of velocities (absolute, where they are small), and of energies
/// (relative).
inline double deviation(OracleMatter const& matter, std::vector<AnyEnsemble*> const& ensembles) {
  double largest = 0;
  auto const take = [&](double found, double right, double scale) {
    double const d = std::abs(found - right) / scale;
    if (!(d <= largest)) largest = d;  // NaN, too
  };
  for (auto const& body : matter.bodies) {
    AnyEnsemble const& ensemble = *ensembles[static_cast<std::size_t>(body.kind)];
    double const* row = ensemble.row(body.number);
    for (int a = 0; a < ensemble.dimension(); ++a) {
      double const right = body.velocity[a];
      take(row[ensemble.field("velocity").offset + a], right, 1 + std::abs(right));
    }
    if (matter.laws[static_cast<std::size_t>(body.kind)])
      take(row[ensemble.field("internal_energy").offset], body.energy, std::abs(body.energy));
  }
  return largest;
}

}  // namespace boltzmann
