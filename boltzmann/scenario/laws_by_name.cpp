// The laws of scenarios: how each is made from its parameters, and on which rows it runs.
#include <boltzmann/laws/drag.hpp>
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/laws/magnetic.hpp>
#include <boltzmann/laws/morse.hpp>
#include <boltzmann/laws/pendulum.hpp>
#include <boltzmann/laws/rydberg.hpp>
#include <boltzmann/laws/soft.hpp>
#include <boltzmann/laws/spring.hpp>
#include <boltzmann/laws/tether.hpp>
#include <boltzmann/laws/uniform.hpp>
#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/scenario/law_binding.hpp>
#include <boltzmann/schemes/smooth/force_on.hpp>

namespace boltzmann {
namespace {

/// Law<D>{vector} for the dimension of the space.
template <template <int> class Law, template <int> class Rows>
BoundLaw uniform(LawValues const& v, std::string_view name) {
  return v.dimension == 1   ? bind_law<Rows<1>>(Law<1>{v.as_vector<1>(name)})
         : v.dimension == 2 ? bind_law<Rows<2>>(Law<2>{v.as_vector<2>(name)})
                            : bind_law<Rows<3>>(Law<3>{v.as_vector<3>(name)});
}

template <int D>
BoundLaw smooth_gravity(LawValues const& v) {
  return bind_law<OnSmoothIn<D>>(ForceOn<UniformGravity<D>>{{v.as_vector<D>("acceleration")}});
}

}  // namespace

std::vector<LawBinder> const& law_binders() {
  using Values = LawValues const&;
  static std::vector<LawBinder> const all = {
      {"lennard-jones",
       [](Values v) {
         return bind_law<NewtonRows>(LennardJones{v("depth"), v("r0")});
       }},
      {"morse",
       [](Values v) {
         return bind_law<NewtonRows>(Morse{v("depth"), v("r0"), v("a")});
       }},
      {"rydberg",
       [](Values v) {
         return bind_law<NewtonRows>(Rydberg{v("depth"), v("r0"), v("a"), v("alpha")});
       }},
      {"spring",
       [](Values v) {
         return bind_law<NewtonRows>(Spring{v("stiffness"), v("rest_length")});
       }},
      {"soft",
       [](Values v) {
         return bind_law<NewtonRows>(Soft{v("repulsion"), v("range")});
       }},
      {"coulomb", [](Values v) { return bind_law<CoulombRows>(coulomb(v("k"), v("softening"))); }},
      {"gravity", [](Values v) { return bind_law<KeplerRows>(gravity(v("G"), v("softening"))); }},
      {"biot-savart", [](Values) { return bind_law<VortexRows>(BiotSavart{}); }},
      {"pendulum-coupling",
       [](Values v) {
         return bind_law<PendulumRows>(PendulumCoupling{v("stiffness"), v("rest_length")});
       }},
      {"pendulum-gravity", [](Values v) { return bind_law<OnPendulum>(PendulumGravity{v("acceleration")}); }},
      {"drag", [](Values v) { return bind_law<OnNewton>(Drag{v("friction")}); }},
      {"tether", [](Values) { return bind_law<OnTethered>(Tether{}); }},
      {"uniform-gravity", [](Values v) { return uniform<UniformGravity, OnNewtonIn>(v, "acceleration"); }},
      {"uniform-electric-field", [](Values v) { return uniform<UniformElectricField, OnCoulombIn>(v, "field"); }},
      {"uniform-magnetic-field",
       [](Values v) {
         return v.dimension == 2 ? bind_law<OnCoulombIn<2>>(UniformMagneticField<2>{v.as_vector<1>("field")})
                                 : bind_law<OnCoulombIn<3>>(UniformMagneticField<3>{v.as_vector<3>("field")});
       }},
      {"uniform-flow", [](Values v) { return uniform<UniformFlow, OnFlowIn>(v, "velocity"); }},
  };
  return all;
}

std::vector<LawBinder> const& smooth_law_binders() {
  using Values = LawValues const&;
  static std::vector<LawBinder> const all = {
      {"drag", [](Values v) { return bind_law<OnSmooth>(ForceOn<Drag>{{v("friction")}}); }},
      {"uniform-gravity",
       [](Values v) {
         return v.dimension == 1   ? smooth_gravity<1>(v)
                : v.dimension == 2 ? smooth_gravity<2>(v)
                                   : smooth_gravity<3>(v);
       }},
  };
  return all;
}

}  // namespace boltzmann
