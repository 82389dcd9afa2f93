// Kernels of the laws of pendulums.
#include <boltzmann/laws/pendulum.hpp>
#include <boltzmann/particles/pendulum.hpp>
#include <boltzmann/scenario/law_binding.hpp>

namespace boltzmann::detail {

std::vector<LawBinder> pendulum_laws() {
  return {{"pendulum-coupling",
           [](LawValues const& v) {
             BoundLaw bound = bind_law(PendulumCoupling{v("stiffness"), v("rest_length")});
             bind_pairs<PendulumCoupling>(bound, Layouts<Pendulum<1>>{});
             bind_connections<PendulumCoupling>(bound, Layouts<Pendulum<1>>{});
             return bound;
           }},
          {"pendulum-gravity", [](LawValues const& v) {
             BoundLaw bound = bind_law(PendulumGravity{v("acceleration")});
             bind_externals<PendulumGravity>(bound, Layouts<Pendulum<1>>{});
             return bound;
           }}};
}

}  // namespace boltzmann::detail
