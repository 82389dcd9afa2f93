// Default methods of ensembles.
#include <boltzmann/integrators/driven_fields.hpp>
#include <boltzmann/integrators/methods.hpp>
#include <boltzmann/particles/panel.hpp>
#include <boltzmann/particles/spreading.hpp>
#include <boltzmann/particles/vortex.hpp>

#include <typeinfo>

namespace boltzmann {
namespace {

struct Usual {
  std::type_info const* moves_as;
  Method method;
  std::unique_ptr<Integrator> (*make)(AnyEnsemble&, Method);
};

template <class P>
Usual usual() {
  return {&typeid(P), usual_method<P>(), detail::method_of<P>};
}

/// For particles that never move.
template <class P>
std::unique_ptr<Integrator> stay(AnyEnsemble& ensemble, Method method) {
  return std::make_unique<detail::Deactivate<P>>(ensemble, method);
}

/// For the class like which the ensemble moves.
Usual const& usual_of(AnyEnsemble const& ensemble) {
  static Usual const all[] = {usual<Newton<1>>(),
                              usual<Newton<2>>(),
                              usual<Newton<3>>(),
                              usual<Tracer<1>>(),
                              usual<Tracer<2>>(),
                              usual<Tracer<3>>(),
                              usual<Smooth<1>>(),
                              usual<Smooth<2>>(),
                              usual<Smooth<3>>(),
                              usual<Solid<1>>(),
                              usual<Solid<2>>(),
                              usual<Solid<3>>(),
                              usual<Viscous<2>>(),
                              usual<Viscous<3>>(),
                              usual<Diffusive<2>>(),
                              usual<Inviscid<3>>(),
                              usual<Spreading<2>>(),
                              usual<Spreading<3>>(),
                              {&typeid(Panel<2>), Method::deactivate, stay<Panel<2>>}};
  for (auto const& one : all)
    if (*one.moves_as == ensemble.moves_as()) return one;
  throw Error("ensemble '" + ensemble.name() + "' has no integrator: its class " + ensemble.class_name() +
              " has equations of motion of its own; call integrate(ensemble, Method::...), one of " +
              join(method_words().names()));
}

}  // namespace

Method usual_method(AnyEnsemble const& ensemble) { return usual_of(ensemble).method; }

std::unique_ptr<Integrator> usual_integrator(AnyEnsemble& ensemble) {
  auto const& usual = usual_of(ensemble);
  return with_driven_fields(usual.make(ensemble, usual.method), ensemble);
}

}  // namespace boltzmann
