// The source's crystal of mesoparticles: a lattice of PVDF molecules in two dimensions (units: angstrom, ps, amu, K).
#pragma once

#include <boltzmann/dissipation/langevin_bath.hpp>
#include <boltzmann/dissipation/pair_dissipation.hpp>
#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/loaders/internal_energy_load.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/meso.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

namespace boltzmann::pvdf {

inline constexpr double amu = 1.66053906660e-27, boltzmann_constant = 1.380649e-23 / (amu * 1e4);
inline constexpr double mass = 64.03, spacing = 5.13, cutoff = 15, heat_capacity = 16 * boltzmann_constant;
inline constexpr double friction = 1.5e-14 / amu * 1e-12;
inline constexpr double newton_per_metre = 1e-24 / amu;  // in amu / ps^2

/// V(r) = -eps (1 + d + alpha d^3) exp(-d), d = lambda (r / r0 - 1): written down again, apart from the shipped law.
inline auto law() {
  double const depth = 1.612e-20 / (amu * 1e4), lambda = 7.90, alpha = 0.185, r0 = 5.07;
  return antisymmetric([=](auto const& p, auto const& q) {
    auto const r = q.position - p.position;
    auto const distance = sqrt(dot(r, r));
    auto const d = lambda * (distance / r0 - 1.0);
    auto const e = depth * exp(-d);
    // dV/dd = eps e^-d (d + alpha d^3 - 3 alpha d^2)
    auto const slope = e * d * (1.0 + alpha * d * (d - 3.0)) * (lambda / r0);
    return Interaction{r * (slope / distance), -e * (1.0 + d + alpha * d * d * d)};
  });
}

inline DissipationLaw dissipation(double times_gamma = 1) {
  return {.convention = Convention::constant_friction,
          .friction = times_gamma * friction,
          .range = cutoff,
          .exponent = 2,
          .projected = false};
}

/// A crystal that fills a periodic box, with the spacing without pressure or another.
struct Crystal {
  Crystal(std::size_t nx, std::size_t ny, double distance = spacing)
      : molecules("molecules", nx * ny), scheme(box(nx, ny, distance), cutoff), dpd(scheme, boltzmann_constant) {
    block_load(molecules, {Lattice::triangular, distance, {nx, ny, 1}});
    for (auto& p : molecules) p.mass = mass;
    scheme.internal(molecules, law());
    dpd.state(molecules, StateLaw(heat_capacity));
  }
  static Box box(std::size_t nx, std::size_t ny, double distance) {
    auto const length = repeat_lengths({Lattice::triangular, distance, {nx, ny, 1}}, 2);
    return Box(Vector{0.0, 0.0}, Vector{length[0], length[1]}, Boundary::periodic);
  }

  Ensemble<Meso<2>> molecules;
  PairScheme scheme;
  PairDissipation dpd;
};

}  // namespace boltzmann::pvdf
