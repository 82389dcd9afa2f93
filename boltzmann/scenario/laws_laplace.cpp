// Kernels of Green's function of the Laplacian: charges and masses.
#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/scenario/law_binding.hpp>

namespace boltzmann::detail {

std::vector<LawBinder> laplace_laws() {
  return {{"coulomb",
           [](LawValues const& v) {
             BoundLaw bound = bind_law(coulomb(v("k"), v("softening")));
             bind_pairs<LaplaceLaw>(bound, Layouts<Coulomb<1>>{});
             bind_pairs<LaplaceLaw>(bound, Layouts<Coulomb<2>>{});
             bind_pairs<LaplaceLaw>(bound, Layouts<Coulomb<3>>{});
             bind_connections<LaplaceLaw>(bound, Layouts<Coulomb<1>, Coulomb<2>, Coulomb<3>>{});
             return bound;
           }},
          {"gravity", [](LawValues const& v) {
             BoundLaw bound = bind_law(gravity(v("G"), v("softening")));
             bind_pairs<LaplaceLaw>(bound, Layouts<Kepler<1>, LongKepler<1>>{});
             bind_pairs<LaplaceLaw>(bound, Layouts<Kepler<2>>{});
             bind_pairs<LaplaceLaw>(bound, Layouts<Kepler<3>, LongKepler<3>>{});
             bind_connections<LaplaceLaw>(bound,
                                          Layouts<Kepler<1>, LongKepler<1>, Kepler<2>, Kepler<3>, LongKepler<3>>{});
             return bound;
           }}};
}

}  // namespace boltzmann::detail
