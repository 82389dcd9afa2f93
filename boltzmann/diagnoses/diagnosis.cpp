// Reasons why a diagnosis lacks its data.
#include <boltzmann/diagnoses/diagnosis.hpp>

#include <boltzmann/core/error.hpp>

#include <fmt/format.h>

namespace boltzmann {

void refuse_shear(Box const& box, char const* diagnosis) {
  if (box.sheared())
    throw Error(fmt::format("{}: in a sheared box it can't be had; viscosity, temperature, pressure and profiles can",
                            diagnosis));
}

std::string refusal(Diagnosis const& diagnosis, EnergyAndVirial const& measures) {
  std::string const what = diagnosis.columns().empty() ? "" : diagnosis.columns().front().name;
  if (diagnosis.needs_energies() && !measures.unknown.empty())
    return fmt::format("the diagnosis of '{}' needs energies, and {} gives none", what, measures.unknown);
  if (diagnosis.needs_virial() && !measures.no_virial.empty())
    return fmt::format("the diagnosis of '{}' needs the virial, which can't be had: {}", what, measures.no_virial);
  return "";
}

}  // namespace boltzmann
