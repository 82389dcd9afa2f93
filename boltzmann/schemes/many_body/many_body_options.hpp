// Options of atoms with many-body forces: the keys in scenarios.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/core/words.hpp>
#include <boltzmann/laws/embedded_atoms.hpp>
#include <boltzmann/laws/stillinger_weber.hpp>

#include <functional>
#include <optional>
#include <string>

namespace boltzmann {

/// The kinds of embedded-atom potential.
enum class MetalPotential { sutton_chen, gupta, formulas, file };
Words<MetalPotential> const& metal_potential_words();

/// The reader of the scenario processes the keys for ensembles and elements.
struct EmbeddedAtomOptions {
  MetalPotential potential = MetalPotential::sutton_chen;
  SuttonChen sutton_chen{};
  Gupta gupta{};
  std::function<double(double)> pair, density, embedding;  ///< for formulas, which the reader of the scenario parses
  std::string file;
  double cutoff = 0;
  std::optional<double> from, skin;
};
/// The keys of all potentials, and those of one.
OptionTable const& embedded_atom_options();
OptionTable embedded_atom_options(MetalPotential potential);
/// Throws Error as EmbeddedAtoms does.
EmbeddedAtoms embedded_atoms(EmbeddedAtomOptions const& options, UnitSystem const& units);

struct StillingerWeberOptions {
  StillingerWeber law{};
  std::optional<double> skin;
};
OptionTable const& stillinger_weber_options();

}  // namespace boltzmann
