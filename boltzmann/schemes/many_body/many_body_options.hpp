// Options of atoms that feel their surroundings: what scenarios say of them, with their keys.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/core/words.hpp>
#include <boltzmann/laws/embedded_atoms.hpp>
#include <boltzmann/laws/stillinger_weber.hpp>

#include <functional>
#include <optional>
#include <string>

namespace boltzmann {

/// Which laws embedded atoms have.
enum class MetalPotential { sutton_chen, gupta, formulas, file };
Words<MetalPotential> const& metal_potential_words();

/// Whom they act on, and which elements these are, is read by the reader of the scenario.
struct EmbeddedAtomOptions {
  MetalPotential potential = MetalPotential::sutton_chen;
  SuttonChen sutton_chen{};
  Gupta gupta{};
  std::function<double(double)> pair, density, embedding;  ///< of formulas, which the reader of the scenario reads
  std::string file;
  double cutoff = 0;
  std::optional<double> from, skin;
};
/// The keys of all potentials, and those of one.
OptionTable const& embedded_atom_options();
OptionTable embedded_atom_options(MetalPotential potential);
/// Error as of EmbeddedAtoms.
EmbeddedAtoms embedded_atoms(EmbeddedAtomOptions const& options, UnitSystem const& units);

struct StillingerWeberOptions {
  StillingerWeber law{};
  std::optional<double> skin;
};
OptionTable const& stillinger_weber_options();

}  // namespace boltzmann
