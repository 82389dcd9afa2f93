// Kernels of laws with a well: Lennard-Jones and Morse.
#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/laws/morse.hpp>
#include <boltzmann/scenario/law_binding.hpp>

namespace boltzmann::detail {

std::vector<LawBinder> well_laws() {
  return {{"lennard-jones",
           [](LawValues const& v) {
             return bind_between_newton(LennardJones{v("depth"), v("r0")});
           }},
          {"morse", [](LawValues const& v) {
             return bind_between_newton(Morse{v("depth"), v("r0"), v("a")});
           }}};
}

}  // namespace boltzmann::detail
