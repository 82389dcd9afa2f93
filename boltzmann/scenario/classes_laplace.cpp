// Classes with the Green function of the Laplacian as their influence.
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/scenario/class_variant.hpp>

namespace boltzmann::detail {

std::vector<ParticleClass> laplace_classes() {
  return {{"Coulomb",
           "a charged particle",
           true,
           {variant_of<Coulomb<1>>(), variant_of<Coulomb<2>>(), variant_of<Coulomb<3>>()}},
          {"Kepler",
           "a gravitating particle",
           true,
           {variant_of<Kepler<1>>(), variant_of<Kepler<2>>(), variant_of<Kepler<3>>()}}};
}

}  // namespace boltzmann::detail
