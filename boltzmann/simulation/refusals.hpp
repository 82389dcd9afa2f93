// Diagnoses that a simulation can't serve, reported before its run.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

class Simulation;

/// For each diagnosis the reason why the simulation lacks the energies or the virial that it needs (refusal()), or
/// particles that it follows by number; empty if it has them. Energies are measured once, and only if a diagnosis needs
/// them. Errors are those of Simulation::check().
std::vector<std::string> refusals(Simulation& simulation, std::span<std::unique_ptr<Diagnosis> const> diagnoses);

}  // namespace boltzmann
