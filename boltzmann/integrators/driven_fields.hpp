// Driven fields: advances fields that have rates of their own, in the stages of the method that moves the particles.
#pragma once

#include <boltzmann/integrators/integrator.hpp>

#include <memory>

namespace boltzmann {

/// The integrator, and beside it the fields of the ensemble that have rates (AnyEnsemble::driven()), by the same method:
/// euler, rk2 and rk4 as they are, leap-frog by the mean of the rates at both ends of the step, the second of them for
/// predicted fields and velocities (second order, one evaluation a step), gauss-radau as first-order equations. Fields
/// that diffuse take a random step of variance 2 D dt for each component at the end of each step. Error if the method
/// can't do that. The same integrator if there are no such fields.
std::unique_ptr<Integrator> with_driven_fields(std::unique_ptr<Integrator> integrator, AnyEnsemble& ensemble);

/// What a method without stages works on beside what moves: the fields that such an integrator advances; null: none.
EquationsOfMotion* equations_of_fields(Integrator& integrator);

}  // namespace boltzmann
