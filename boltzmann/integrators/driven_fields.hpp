// Driven fields: advances fields that have rates of their own, in the stages of the method that moves the particles.
#pragma once

#include <boltzmann/integrators/integrator.hpp>

#include <memory>

namespace boltzmann {

/// Wraps an integrator so that it also advances the fields of the ensemble that have rates (AnyEnsemble::driven()), by
/// the same method. Euler, rk2 and rk4 apply unchanged. Leap-frog uses the mean of the rates at both ends of the step;
/// the second rate is computed for predicted fields and velocities (second order, one evaluation a step). Gauss-radau
/// advances them as first-order equations. Fields that diffuse take a random step of variance 2 D dt per component at
/// the end of each step. Error if the method does not support driven fields. Returns the same integrator if there are
/// none.
std::unique_ptr<Integrator> with_driven_fields(std::unique_ptr<Integrator> integrator, AnyEnsemble& ensemble);

/// The equations of the fields that such an integrator advances, for a method without stages; null: none.
EquationsOfMotion* equations_of_fields(Integrator& integrator);

}  // namespace boltzmann
