// Classes of continuum mechanics: smooth particles of fluids and solids.
#include <boltzmann/particles/smooth.hpp>
#include <boltzmann/scenario/class_variant.hpp>

namespace boltzmann::detail {

std::vector<ParticleClass> smooth_classes() {
  return {{"Smooth",
           "a piece of a continuum, spread over its range; its matter is the material of its ensemble",
           true,
           {variant_of<Smooth<1>>(), variant_of<Smooth<2>>(), variant_of<Smooth<3>>()},
           Matter::fluid},
          {"Solid",
           "a piece of a solid: a smooth particle with strength, which remembers how it has been sheared",
           true,
           {variant_of<Solid<1>>(), variant_of<Solid<2>>(), variant_of<Solid<3>>()},
           Matter::solid}};
}

}  // namespace boltzmann::detail
