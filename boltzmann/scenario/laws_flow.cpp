// Kernels of flows: vortices and a uniform stream.
#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/laws/uniform.hpp>
#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/scenario/law_binding.hpp>

namespace boltzmann::detail {
namespace {

template <int D>
BoundLaw uniform_flow(LawValues const& v) {
  using Law = UniformFlow<D>;
  BoundLaw bound = bind_law(Law{v.as_vector<D>("velocity")});
  if constexpr (D == 1) bind_externals<Law>(bound, Layouts<Euler<1>>{});
  if constexpr (D == 2) bind_externals<Law>(bound, Layouts<Euler<2>, Viscous<2>>{});
  if constexpr (D == 3) bind_externals<Law>(bound, Layouts<Euler<3>, Vortex<3>, Inviscid<3>>{});
  return bound;
}

}  // namespace

std::vector<LawBinder> flow_laws() {
  return {{"biot-savart",
           [](LawValues const&) {
             BoundLaw bound = bind_law(BiotSavart{});
             bind_pairs<BiotSavart>(bound, Layouts<Vortex<2>, Viscous<2>, Euler<2>>{},
                                    Layouts<Vortex<2>, Viscous<2>>{});
             bind_pairs<BiotSavart>(bound, Layouts<Inviscid<3>, Vortex<3>, Euler<3>>{}, Layouts<Vortex<3>>{});
             bind_connections<BiotSavart>(bound, Layouts<Vortex<2>, Viscous<2>, Inviscid<3>, Vortex<3>>{});
             return bound;
           }},
          {"uniform-flow", [](LawValues const& v) {
             return v.dimension == 1 ? uniform_flow<1>(v) : v.dimension == 2 ? uniform_flow<2>(v) : uniform_flow<3>(v);
           }}};
}

}  // namespace boltzmann::detail
