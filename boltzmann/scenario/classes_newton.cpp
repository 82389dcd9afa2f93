// Classes moved by forces.
#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/particles/meso.hpp>
#include <boltzmann/particles/pendulum.hpp>
#include <boltzmann/particles/tethered.hpp>
#include <boltzmann/scenario/class_variant.hpp>

namespace boltzmann::detail {

std::vector<ParticleClass> newton_classes() {
  return {
      {"Newton",
       "a classical particle: mass and velocity",
       true,
       {variant_of<Newton<1>>(), variant_of<Newton<2>>(), variant_of<Newton<3>>()}},
      {"Meso",
       "a molecule or a lump of matter: a classical particle with an internal energy",
       true,
       {variant_of<Meso<1>>(), variant_of<Meso<2>>(), variant_of<Meso<3>>()}},
      {"Tethered",
       "a classical particle that may be tethered to an anchor of its own",
       true,
       {variant_of<Tethered<1>>(), variant_of<Tethered<2>>(), variant_of<Tethered<3>>()}},
      {"Pendulum", "a bob on an arm; its position is the angle from the vertical", true, {variant_of<Pendulum<1>>()}}};
}

}  // namespace boltzmann::detail
