// Kernels of external laws on classical particles: drag, tether, uniform fields.
#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/laws/drag.hpp>
#include <boltzmann/laws/tether.hpp>
#include <boltzmann/laws/uniform.hpp>
#include <boltzmann/particles/tethered.hpp>
#include <boltzmann/scenario/law_binding.hpp>

namespace boltzmann::detail {
namespace {

template <int D>
BoundLaw uniform_gravity(LawValues const& v) {
  using Law = UniformGravity<D>;
  BoundLaw bound = bind_law(Law{v.as_vector<D>("acceleration")});
  bind_externals<Law>(bound, typename NewtonLayouts<D>::type{});
  return bound;
}

template <int D>
BoundLaw uniform_electric_field(LawValues const& v) {
  using Law = UniformElectricField<D>;
  BoundLaw bound = bind_law(Law{v.as_vector<D>("field")});
  bind_externals<Law>(bound, Layouts<Coulomb<D>>{});
  return bound;
}

}  // namespace

std::vector<LawBinder> external_laws() {
  return {{"drag",
           [](LawValues const& v) {
             BoundLaw bound = bind_law(Drag{v("friction")});
             bind_on_newton<Drag>(bound);
             return bound;
           }},
          {"tether",
           [](LawValues const&) {
             BoundLaw bound = bind_law(Tether{});
             bind_externals<Tether>(bound, Layouts<Tethered<1>, Tethered<2>, Tethered<3>>{});
             return bound;
           }},
          {"uniform-gravity",
           [](LawValues const& v) {
             return v.dimension == 1   ? uniform_gravity<1>(v)
                    : v.dimension == 2 ? uniform_gravity<2>(v)
                                       : uniform_gravity<3>(v);
           }},
          {"uniform-electric-field", [](LawValues const& v) {
             return v.dimension == 1   ? uniform_electric_field<1>(v)
                    : v.dimension == 2 ? uniform_electric_field<2>(v)
                                       : uniform_electric_field<3>(v);
           }}};
}

}  // namespace boltzmann::detail
