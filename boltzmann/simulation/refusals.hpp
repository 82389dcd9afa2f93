// Which diagnoses a simulation can't serve, told before its run.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

class Simulation;

/// Why each diagnosis can't have the energies or the virial that it needs (refusal()), or the particles that it follows by
/// their numbers; empty where it can. Energies are measured once, and only if one of them needs them. Errors are those of
/// Simulation::check().
std::vector<std::string> refusals(Simulation& simulation, std::span<std::unique_ptr<Diagnosis> const> diagnoses);

}  // namespace boltzmann
