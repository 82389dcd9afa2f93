// The methods for pieces of a continuum.
#include <boltzmann/integrators/methods.hpp>

namespace boltzmann::detail {

template std::unique_ptr<Integrator> method_of<Smooth<1>>(AnyEnsemble&, Method);
template std::unique_ptr<Integrator> method_of<Smooth<2>>(AnyEnsemble&, Method);
template std::unique_ptr<Integrator> method_of<Smooth<3>>(AnyEnsemble&, Method);
template std::unique_ptr<Integrator> method_of<Solid<1>>(AnyEnsemble&, Method);
template std::unique_ptr<Integrator> method_of<Solid<2>>(AnyEnsemble&, Method);
template std::unique_ptr<Integrator> method_of<Solid<3>>(AnyEnsemble&, Method);

}  // namespace boltzmann::detail
