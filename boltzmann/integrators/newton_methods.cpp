// The methods for everything that moves as Newton says.
#include <boltzmann/integrators/methods.hpp>

namespace boltzmann::detail {

template std::unique_ptr<Integrator> method_of<Newton<1>>(AnyEnsemble&, Method);
template std::unique_ptr<Integrator> method_of<Newton<2>>(AnyEnsemble&, Method);
template std::unique_ptr<Integrator> method_of<Newton<3>>(AnyEnsemble&, Method);

}  // namespace boltzmann::detail
