// The exchange of vorticity between neighbours: viscosity without a random walk.
#pragma once

#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/parameter.hpp>
#include <boltzmann/particles/vortex.hpp>

namespace boltzmann {

/// Particle strength exchange, of P. Degond and S. Mas-Gallic, Math. Comput. 53, 485 (1989): the Laplacian of the
/// vorticity as an integral,
///   d Gamma_p / dt = nu / width^2 sum_q (V_p Gamma_q - V_q Gamma_p) eta(r),
/// eta = 2 exp(-r^2 / (2 width^2)) / (2 pi width^2)^(D/2), V the volume of a particle (in 2D its area), width its core
/// unless a width is given. The exchange is antisymmetric, so the sum of the vorticity is conserved. A ripple of wave
/// number k decays at (2 nu / width^2) (1 - exp(-width^2 k^2 / 2)) instead of nu k^2: an error of second order in the
/// width; the mean square radius grows at 2 D nu exactly, as far as sums over the particles approximate the integral.
/// That requires overlapping particles (a width of one spacing or more), also around the vorticity, so that it can
/// spread. Different cores enter by their mean square, different viscosities by their mean, which is the integral for
/// div(nu grad omega). A cut-off at 5 widths reduces the growth by 5e-5, at 6 widths by 3e-7.
struct VorticityExchange {
  static constexpr Symmetry symmetry = Symmetry::antisymmetric;

  double width = 0;

  static constexpr LawText text{
      .name = "vorticity-exchange",
      .doc = "viscosity without random numbers: neighbours exchange vorticity (particle strength exchange)",
      .formula =
          "vorticity changes by nu/width^2 (V omega' - V' omega) 2 exp(-r^2/(2 width^2))/(2 pi width^2)^(D/2), V "
          "the volume",
      .target = "Diffusive",
      .source = "Diffusive",
      .least_dimension = 2,
      .has_energy = false};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&VorticityExchange::width,
                    {"width", dimensions::length,
                     "standard deviation of the Gaussian by which neighbours count; 0: the core", not_negative, "0"}}};
  }

  template <class P, class Q>
  requires requires(P const& p, Q const& q) {
    p.volume* q.volume;
    p.viscosity + q.viscosity;
    p.vorticity - q.vorticity;
  }
  auto operator()(P const& p, Q const& q) const {
    auto const r = p.position - q.position;
    using Real = std::remove_cvref_t<decltype(r[0])>;
    Real const square = width > 0 ? Real(width * width) : Real(0.5 * (p.core * p.core + q.core * q.core));
    Real const inverse = 1.0 / square;
    Real gauss = exp(-0.5 * dot(r, r) * inverse) * inverse * (1 / (2 * pi));
    if constexpr (P::dimension == 3) gauss = gauss * sqrt(inverse * (1 / (2 * pi)));
    auto const exchange =
        (q.vorticity * p.volume - p.vorticity * q.volume) * ((p.viscosity + q.viscosity) * inverse * gauss);
    Vector<P::dimension, Real> none;
    for (int a = 0; a < P::dimension; ++a) none[a] = Real(0.0);
    return typename P::Influence{none, exchange};
  }
};

}  // namespace boltzmann
