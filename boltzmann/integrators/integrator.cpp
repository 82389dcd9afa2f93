// Names of the methods.
#include <boltzmann/integrators/integrator.hpp>

namespace boltzmann {

Words<Method> const& method_words() {
  static Words<Method> const all{
      "integrator",
      {{Method::euler, "euler", "first order, one evaluation a step; energy grows: for comparison, and for tracers"},
       {Method::leap_frog, "leap-frog",
        "second order, one evaluation a step, symplectic (velocity Verlet): energy stays bounded; for forces"},
       {Method::rk2, "rk2", "second-order Runge-Kutta (midpoint), two evaluations a step"},
       {Method::rk4, "rk4",
        "fourth-order Runge-Kutta, four evaluations a step: for few bodies, vortices and smooth motion"},
       {Method::reversible_leap_frog, "reversible-leap-frog",
        "leap-frog on a fixed-point grid: run backwards it returns to the start to the last bit"},
       {Method::symplectic_4, "symplectic-4",
        "fourth order, six evaluations a step, symplectic (Blanes and Moan): energy stays bounded; for planets and "
        "other smooth motion under forces that depend on positions only"},
       {Method::gauss_radau, "gauss-radau",
        "order 15, to rounding by default: steps of its own inside each step of the run, as long as the `tolerance` of "
        "`[run]` allows, for all ensembles together; for few bodies and close encounters"},
       {Method::random_walk, "random-walk", "rk2 and a random step of variance 2 nu dt on each axis: viscous vortices"},
       {Method::deactivate, "deactivate", "the particles stay where they are"}}};
  return all;
}

std::string to_string(Method method) { return method_words().name(method); }

}  // namespace boltzmann
