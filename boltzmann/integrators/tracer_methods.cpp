// The methods for classes that move with a flow.
#include <boltzmann/integrators/methods.hpp>

namespace boltzmann::detail {

template std::unique_ptr<Integrator> method_of<Tracer<1>>(AnyEnsemble&, Method);
template std::unique_ptr<Integrator> method_of<Tracer<2>>(AnyEnsemble&, Method);
template std::unique_ptr<Integrator> method_of<Tracer<3>>(AnyEnsemble&, Method);
template std::unique_ptr<Integrator> method_of<Diffusive<2>>(AnyEnsemble&, Method);
template std::unique_ptr<Integrator> method_of<Inviscid<3>>(AnyEnsemble&, Method);

}  // namespace boltzmann::detail
