// Kernels of the Rydberg law and of springs.
#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/laws/rydberg.hpp>
#include <boltzmann/laws/spring.hpp>
#include <boltzmann/scenario/law_binding.hpp>

namespace boltzmann::detail {

std::vector<LawBinder> bond_laws() {
  return {{"rydberg",
           [](LawValues const& v) {
             return bind_between_newton(Rydberg{v("depth"), v("r0"), v("a")});
           }},
          {"spring", [](LawValues const& v) {
             return bind_between_newton(Spring{v("stiffness"), v("rest_length")});
           }}};
}

}  // namespace boltzmann::detail
