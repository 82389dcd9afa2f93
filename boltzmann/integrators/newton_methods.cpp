// The methods for classes that move by Newton's law.
#include <boltzmann/integrators/methods.hpp>

namespace boltzmann::detail {

template std::unique_ptr<Integrator> method_of<Newton<1>>(AnyEnsemble&, Method);
template std::unique_ptr<Integrator> method_of<Newton<2>>(AnyEnsemble&, Method);
template std::unique_ptr<Integrator> method_of<Newton<3>>(AnyEnsemble&, Method);

}  // namespace boltzmann::detail
