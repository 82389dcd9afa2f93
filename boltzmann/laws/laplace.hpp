// Green's function of the Laplacian (section 3.5 of the 1990 thesis): gravity and electrostatics in one, two and three
// dimensions.
#pragma once

#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/parameter.hpp>

namespace boltzmann {

/// The field of strengths s with div E = C s: a particle of strength s makes
///   1D (C/2) s sgn x,  2D (C/2 pi) s r/r^2,  3D (C/4 pi) s r/r^3,
/// and a pair has the energy
///   1D -(C/2) s s' |x|,  2D -(C/2 pi) s s' ln r,  3D (C/4 pi) s s'/r.
/// C = 4 pi k for charges (k = 1 in cgs, 1/(4 pi eps0) in SI), C = -4 pi G for masses. (Listing C.5 differs from its
/// own mesh by 2 pi in 1D and by 2 in 2D, and C.8 makes masses repel; mesh and multipole schemes use the formulas
/// above.) In 2D particles are rods one length unit long, in 1D sheets of one unit of area. With a softening, r is
/// sqrt(r^2 + softening^2) (Plummer), and two coincident particles exert no force on each other.
struct LaplaceLaw {
  static constexpr Symmetry symmetry = Symmetry::antisymmetric;

  double constant;
  double softening = 0;

  template <class P, class Q>
  requires requires(P const& p, Q const& q) { p.strength() * q.strength(); }
  auto operator()(P const& p, Q const& q) const {
    constexpr int D = P::dimension;
    auto const r = q.position - p.position;
    auto const square = dot(r, r) + softening * softening;
    auto const inverse = rsqrt(square);
    auto const strengths = p.strength() * q.strength();
    if constexpr (D == 1) {
      using Real = std::remove_cvref_t<decltype(square)>;
      auto const c = constant / 2 * strengths;
      return Interaction{r * (-c * select(square > 0.0, inverse, Real(0.0))), -c * sqrt(square)};
    } else if constexpr (D == 2) {
      auto const c = constant / (2 * pi) * strengths;
      return Interaction{r * (-c * (inverse * inverse)), -0.5 * c * log(square)};
    } else {
      auto const c = constant / (4 * pi) * strengths * inverse;
      return Interaction{r * (-c * (inverse * inverse)), c};
    }
  }

  double length_scale() const { return softening > 0 ? softening : __builtin_inf(); }
  void check() const {
    check_parameter("laplace", "constant", constant, any_number);
    check_parameter("laplace", "softening", softening, not_negative);
  }
};

inline constexpr Parameter softening_parameter{"softening", dimensions::length,
                                               "Plummer's length, within which the force is weaker", not_negative, "0"};

/// Charges, under the name of their law in scenarios: force k s s'/r^2 in 3D; k = 1 in cgs, units(constants::coulomb)
/// in any base.
struct CoulombLaw {
  double k;
  double softening = 0;

  static constexpr LawText text{
      .name = "coulomb",
      .doc = "charges: like ones repel; in 1D sheets, in 2D rods of unit length",
      .formula = "k q q'/r in 3D, -2 k q q' ln r in 2D, -2 pi k q q' |x| in 1D; r^2 -> r^2 + softening^2",
      .target = "Coulomb",
      .source = "Coulomb",
      .in_programs = "coulomb",
      .typed = {"", "", "k*p.charge*q.charge/sqrt(r^2 + softening^2)"}};
  static constexpr auto parameters() {
    return std::tuple{ParameterOf{&CoulombLaw::k,
                                  {"k", dimensions::energy * dimensions::length / pow(dimensions::charge, 2),
                                   "Coulomb's constant: 1 in cgs, 1/(4 pi eps0) in SI", positive,
                                   "8.9875517923e9 N m^2/C^2", DefaultIn::those_with_units}},
                      ParameterOf{&CoulombLaw::softening, softening_parameter}};
  }
  LaplaceLaw law() const { return {4 * pi * k, softening}; }
};

/// Masses, under the name of their law in scenarios: force G m m'/r^2 in 3D; units(constants::gravitation) in any base.
struct GravityLaw {
  double G;
  double softening = 0;

  static constexpr LawText text{
      .name = "gravity",
      .doc = "masses attract; in 1D sheets, in 2D rods of unit length",
      .formula = "-G m m'/r in 3D, 2 G m m' ln r in 2D, 2 pi G m m' |x| in 1D; r^2 -> r^2 + softening^2",
      .target = "Kepler",
      .source = "Kepler",
      .in_programs = "gravity",
      .typed = {"", "", "-G*p.mass*q.mass/sqrt(r^2 + softening^2)"}};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&GravityLaw::G,
                    {"G", dimensions::volume / (dimensions::mass * pow(dimensions::time, 2)), "Newton's constant",
                     positive, "6.67430e-11 m^3/(kg s^2)", DefaultIn::those_with_units}},
        ParameterOf{&GravityLaw::softening, softening_parameter}};
  }
  LaplaceLaw law() const { return {-4 * pi * G, softening}; }
};

/// Like charges repel.
inline LaplaceLaw coulomb(double k, double softening = 0) { return CoulombLaw{k, softening}.law(); }

/// Masses attract.
inline LaplaceLaw gravity(double G, double softening = 0) { return GravityLaw{G, softening}.law(); }

}  // namespace boltzmann
