// The kinds of sources of expansions: strengths of charges and masses, and vorticity of vortices. Private to this
// module.
#pragma once

#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/particles/rows.hpp>
#include <boltzmann/schemes/mesh/point_source.hpp>
#include <boltzmann/schemes/multipole/multipole_kernels.hpp>
#include <boltzmann/schemes/multipole/softening.hpp>

#include <vector>

namespace boltzmann {

/// Strengths create a potential; the result is its field, on unit strength.
template <int D>
struct Charges {
  static constexpr int dimension = D;
  using Source = PointSource<D>;
  using Law = LaplaceLaw;
  static constexpr int densities = 1;  ///< number of expansions in parallel
  static constexpr int width = D;      ///< numbers per particle in the result
  static constexpr bool potential = true;
  static constexpr bool own_cores = false;  ///< true if each source has its own softening length

  static double constant(Law const& law) { return law.constant / (D == 3 ? 4 * pi : 2 * pi); }
  static double amount(Source const& p, int /*density*/) { return p.amount; }
  static double core(Law const& law, Source const&) { return law.softening; }
  static Law without_softening(Law const& law, std::vector<Row<Source>>&) { return {law.constant}; }
  static Softening softening(Law const&) { return Softening::plummer; }
  static double end_of_core(Law const&) { return 0; }
  /// Calls f(kernel, law) with the specialised kernel.
  template <class F>
  static void near(MultipoleKernels const& kernels, Law const& law, bool with_potential, F const& f) {
    f(with_potential ? kernels.near_with_potential : kernels.near, &law);
  }
};

/// Each component of vorticity creates a field E_k as charges do; the velocity is - sum_k E_k x e_k. The result is a
/// velocity, in 3D also the stretching of vorticity (Inviscid).
template <int D>
struct Vortices {
  static constexpr int dimension = D;
  using Source = Inviscid<D>;
  using Law = VortexLaw;
  static constexpr int densities = D == 3 ? 3 : 1;
  static constexpr int width = D == 3 ? 6 : 2;
  static constexpr bool potential = false;
  static constexpr bool own_cores = true;

  static double constant(Law const&) { return D == 3 ? 1 / (4 * pi) : 1 / (2 * pi); }
  static double amount(Source const& p, int density) { return p.vorticity[density]; }
  static double core(Law const&, Source const& p) { return p.core; }
  static Law without_softening(Law const& law, std::vector<Row<Source>>& sources) {
    for (auto& p : sources) p.core = 0;
    return law;
  }
  static Softening softening(Law const& law) {
    if (law.core == VortexCore::algebraic) return Softening::algebraic;
    return D == 3 && law.core == VortexCore::plain ? Softening::plummer : Softening::ends;
  }
  /// In units of cores: the radius beyond which a Gaussian is below 1e-11.
  static double end_of_core(Law const& law) { return law.core == VortexCore::gaussian ? 7 : 1; }
  template <class F>
  static void near(MultipoleKernels const& kernels, Law const& law, bool /*with_potential*/, F const& f) {
    law.visit([&](auto const& own) { f(kernels.near_vortices[static_cast<int>(law.core)], &own); });
  }

  /// Adds the effect of this gradient of velocity component a on the vorticity of p.
  static void add_slope(Law const& law, Source const& p, int a, Vector<3> const& slope, double* rate) {
    rate[a] += (1 - law.transposed) * dot(p.vorticity, slope);
    for (int b = 0; b < 3; ++b) rate[b] += law.transposed * p.vorticity[a] * slope[b];
  }
  /// The velocity from these fields.
  static Vector<D> velocity(Vector<D> const (&field)[densities]) {
    if constexpr (D == 2)
      return {-field[0][1], field[0][0]};
    else
      return {field[1][2] - field[2][1], field[2][0] - field[0][2], field[0][1] - field[1][0]};
  }
};

/// The same in 3D with the velocity gradient as the result: SlopedFlow.
struct VortexSlopes : Vortices<3> {
  static constexpr int width = 12;

  template <class F>
  static void near(MultipoleKernels const& kernels, Law const& law, bool /*with_potential*/, F const& f) {
    law.visit([&](auto const& own) { f(kernels.near_slopes[static_cast<int>(law.core)], &own); });
  }
  static void add_slope(Law const&, Source const&, int a, Vector<3> const& slope, double* slopes) {
    for (int b = 0; b < 3; ++b) slopes[3 * a + b] += slope[b];
  }
};

}  // namespace boltzmann
