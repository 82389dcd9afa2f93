// Angular laws: the energy of three particles by the angle at the middle one, of four by their dihedral angle.
#pragma once

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/laws/parameter.hpp>

#include <cmath>
#include <numbers>

namespace boltzmann {

/// The result of an angular law, law(angle), generic in the number type: the energy, and its derivative by the angle.
template <class Real>
struct AngularEnergy {
  Real energy;
  Real slope;
};
template <class Real>
AngularEnergy(Real, Real) -> AngularEnergy<Real>;

/// U = stiffness (angle - rest_angle)^2 / 2; angles are between 0 and pi.
struct HarmonicAngle {
  double stiffness, rest_angle;

  static constexpr LawText text{.name = "harmonic-angle",
                                .doc = "three particles: a spring of the angle at the middle one",
                                .formula = "stiffness (angle - rest_angle)^2 / 2",
                                .target = "Newton",
                                .source = "Newton",
                                .least_dimension = 2,
                                .typed = TypedLawText("0.5*stiffness*(angle - rest_angle)^2")};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&HarmonicAngle::stiffness, {"stiffness", dimensions::energy, "energy of a radian", not_negative}},
        ParameterOf{&HarmonicAngle::rest_angle,
                    {"rest_angle", dimensions::angle, "angle without torque", {0, std::numbers::pi}}}};
  }

  template <class Real>
  auto operator()(Real const& angle) const {
    Real const bent = angle - rest_angle;
    return AngularEnergy{0.5 * stiffness * bent * bent, stiffness * bent};
  }
};

/// U = stiffness (cos(angle) - cos(rest_angle))^2 / 2.
struct HarmonicCosine {
  double stiffness, rest_angle;

  static constexpr LawText text{.name = "harmonic-cosine",
                                .doc = "three particles: a spring of the cosine of the angle at the middle one",
                                .formula = "stiffness (cos(angle) - cos(rest_angle))^2 / 2",
                                .target = "Newton",
                                .source = "Newton",
                                .least_dimension = 2,
                                .typed = TypedLawText("0.5*stiffness*(cos(angle) - cos(rest_angle))^2")};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&HarmonicCosine::stiffness,
                    {"stiffness", dimensions::energy, "energy of a cosine that is one off, twice it", not_negative}},
        ParameterOf{&HarmonicCosine::rest_angle,
                    {"rest_angle", dimensions::angle, "angle without torque", {0, std::numbers::pi}}}};
  }

  template <class Real>
  auto operator()(Real const& angle) const {
    using std::cos, std::sin;
    Real const off = cos(angle) - std::cos(rest_angle);
    return AngularEnergy{0.5 * stiffness * off * off, -stiffness * off * sin(angle)};
  }
};

/// U = stiffness (1 + cos(angle)): a chain of these is the discrete worm-like chain, with <cos(pi - angle)> =
/// coth(x) - 1/x, x = stiffness / k T, in 3D.
struct ChainBending {
  double stiffness;

  static constexpr LawText text{.name = "chain-bending",
                                .doc = "three particles: it is straightened, as a worm-like chain",
                                .formula = "stiffness (1 + cos(angle))",
                                .target = "Newton",
                                .source = "Newton",
                                .least_dimension = 2,
                                .typed = TypedLawText("stiffness*(1 + cos(angle))")};
  static constexpr auto parameters() {
    return std::tuple{ParameterOf{&ChainBending::stiffness,
                                  {"stiffness", dimensions::energy, "half the energy of folding it up", not_negative}}};
  }

  template <class Real>
  auto operator()(Real const& angle) const {
    using std::cos, std::sin;
    return AngularEnergy{stiffness * (1.0 + cos(angle)), -stiffness * sin(angle)};
  }
};

/// U = stiffness (1 + cos(multiplicity dihedral - phase)), one term of a Fourier series. Dihedrals are between -pi and
/// pi, 0 where the outer two are on one side (cis), pi in a planar zigzag (trans).
struct FourierDihedral {
  double stiffness, multiplicity, phase;

  static constexpr LawText text{.name = "fourier-dihedral",
                                .doc = "four particles: one term of a Fourier series of the dihedral",
                                .formula = "stiffness (1 + cos(multiplicity dihedral - phase))",
                                .target = "Newton",
                                .source = "Newton",
                                .least_dimension = 3,
                                .typed = TypedLawText("stiffness*(1 + cos(multiplicity*dihedral - phase))")};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&FourierDihedral::stiffness, {"stiffness", dimensions::energy, "half the height of the barriers"}},
        ParameterOf{&FourierDihedral::multiplicity,
                    {"multiplicity", dimensions::none, "how many barriers there are, a whole number", not_negative}},
        ParameterOf{&FourierDihedral::phase,
                    {"phase", dimensions::angle, "multiplicity times where the highest is", any_number, "0"}}};
  }
  void check() const {
    if (multiplicity != std::floor(multiplicity))
      throw Error("fourier-dihedral: multiplicity is a whole number: the energy must be the same after a turn");
  }

  template <class Real>
  auto operator()(Real const& dihedral) const {
    using std::cos, std::sin;
    Real const turned = multiplicity * dihedral - phase;
    return AngularEnergy{stiffness * (1.0 + cos(turned)), -stiffness * multiplicity * sin(turned)};
  }
};

/// U = stiffness d^2 / 2, d the periodic difference between the dihedral and rest_angle: keeps four particles in one
/// plane (an improper dihedral), or fixes a double bond.
struct HarmonicDihedral {
  double stiffness, rest_angle;

  static constexpr LawText text{
      .name = "harmonic-dihedral",
      .doc = "four particles: a spring of the dihedral, by the shortest way round",
      .formula = "stiffness d^2 / 2, d = dihedral - rest_angle by the shortest way",
      .target = "Newton",
      .source = "Newton",
      .least_dimension = 3,
      .typed = TypedLawText("0.5*stiffness*(dihedral - rest_angle - 2*pi*floor((dihedral - rest_angle)/(2*pi) + "
                            "0.5))^2")};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&HarmonicDihedral::stiffness,
                    {"stiffness", dimensions::energy, "energy of a radian", not_negative}},
        ParameterOf{&HarmonicDihedral::rest_angle, {"rest_angle", dimensions::angle, "dihedral without torque"}}};
  }

  template <class Real>
  auto operator()(Real const& dihedral) const {
    constexpr double to_integer = 6755399441055744.0;  // 3/2 2^52: adding and subtracting it rounds
    constexpr double turn = 2 * std::numbers::pi;
    Real const off = dihedral - rest_angle;
    Real const turns = (off * (1 / turn) + to_integer) - to_integer;
    Real const d = off - turns * turn;
    return AngularEnergy{0.5 * stiffness * d * d, stiffness * d};
  }
};

/// U = sum c_n cos(psi)^n, psi = dihedral - pi, n up to 5: J.-P. Ryckaert and A. Bellemans, Faraday Discuss. Chem. Soc.
/// 66, 95 (1978).
struct RyckaertBellemans {
  double c0, c1, c2, c3, c4, c5;

  static constexpr LawText text{
      .name = "ryckaert-bellemans",
      .doc = "four particles: powers of the cosine of the dihedral, as of alkanes",
      .formula =
          "c0 + c1 cos(psi) + c2 cos(psi)^2 + c3 cos(psi)^3 + c4 cos(psi)^4 + c5 cos(psi)^5, psi = dihedral - pi",
      .target = "Newton",
      .source = "Newton",
      .least_dimension = 3,
      .typed = TypedLawText("c0 - cos(dihedral)*(c1 - cos(dihedral)*(c2 - cos(dihedral)*(c3 - cos(dihedral)*(c4 - "
                            "cos(dihedral)*c5))))")};
  static constexpr auto parameters() {
    using R = RyckaertBellemans;
    return std::tuple{
        ParameterOf{&R::c0, {"c0", dimensions::energy, "constant, so that trans has the energy zero", any_number, "0"}},
        ParameterOf{&R::c1, {"c1", dimensions::energy, "coefficient of the cosine", any_number, "0"}},
        ParameterOf{&R::c2, {"c2", dimensions::energy, "coefficient of its square", any_number, "0"}},
        ParameterOf{&R::c3, {"c3", dimensions::energy, "coefficient of its third power", any_number, "0"}},
        ParameterOf{&R::c4, {"c4", dimensions::energy, "coefficient of its fourth power", any_number, "0"}},
        ParameterOf{&R::c5, {"c5", dimensions::energy, "coefficient of its fifth power", any_number, "0"}}};
  }

  template <class Real>
  auto operator()(Real const& dihedral) const {
    using std::cos, std::sin;
    Real const x = -cos(dihedral);
    return AngularEnergy{c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * c5)))),
                         sin(dihedral) * (c1 + x * (2 * c2 + x * (3 * c3 + x * (4 * c4 + x * (5 * c5)))))};
  }
};

}  // namespace boltzmann
