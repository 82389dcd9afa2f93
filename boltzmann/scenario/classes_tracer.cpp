// Classes advected by a flow: fluid particles and vortices.
#include <boltzmann/particles/dye.hpp>
#include <boltzmann/particles/spreading.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/scenario/class_variant.hpp>

namespace boltzmann::detail {

std::vector<ParticleClass> tracer_classes() {
  return {{"Tracer",
           "a fluid particle; its influence is the velocity of the flow",
           false,
           {variant_of<Tracer<1>>(), variant_of<Tracer<2>>(), variant_of<Tracer<3>>()}},
          {"Dye",
           "a tracer that [[dye]] releases, and that remembers where and when: pictures join those of one place",
           false,
           {variant_of<Dye<1>>(), variant_of<Dye<2>>(), variant_of<Dye<3>>()}},
          {"Vortex",
           "an element of vorticity whose vorticity stays as it is",
           false,
           {variant_of<Vortex<2>>(), variant_of<Vortex<3>>()}},
          {"Inviscid",
           "a vortex without viscosity; in 3D the flow stretches and turns its vorticity",
           false,
           {variant_of<Inviscid<2>>(), variant_of<Inviscid<3>>()}},
          {"Viscous",
           "a vortex in a viscous fluid; it diffuses by a random walk",
           false,
           {variant_of<Viscous<2>>(), variant_of<Viscous<3>>()}},
          {"Diffusive",
           "a vortex in a viscous fluid; it exchanges vorticity with its neighbours by the law 'vorticity-exchange'",
           false,
           {variant_of<Diffusive<2>>(), variant_of<Diffusive<3>>()}},
          {"Spreading",
           "a vortex in a viscous fluid; its core grows, and can be split by [[split_cores]]",
           false,
           {variant_of<Spreading<2>>(), variant_of<Spreading<3>>()}}};
}

}  // namespace boltzmann::detail
