// EmbeddedAtomScheme: metals with embedded-atom potentials.
//
//   EmbeddedAtomScheme scheme(box, EmbeddedAtoms(SuttonChen{...}, {.cutoff = 7.2}));
//   scheme.add(copper);
#pragma once

#include <boltzmann/laws/embedded_atoms.hpp>
#include <boltzmann/schemes/many_body/many_body_scheme.hpp>

#include <string_view>

namespace boltzmann {

class EmbeddedAtomScheme final : public ManyBodyScheme {
 public:
  /// Throws Error as ManyBodyScheme does for the cut-off of the atoms.
  EmbeddedAtomScheme(Box box, EmbeddedAtoms atoms);

  /// Adds atoms of an element. The name may be omitted if there is only one element. Several ensembles may have the
  /// same element. Throws Error if the element is unknown, or forces do not move the particles.
  void add(AnyEnsemble& ensemble, std::string_view element = "");

  EmbeddedAtoms const& atoms() const { return atoms_; }
  double length_scale(AnyEnsemble const& ensemble) const override;
  std::vector<std::string> warnings(double step_size) override;
  std::string summary() const override;

 protected:
  Passes passes() const override;
  void answer(Atoms const& atoms) const override;

 private:
  bool alloy() const { return atoms_.elements().size() > 1; }

  EmbeddedAtoms atoms_;
  EmbeddedTables tables_;
};

}  // namespace boltzmann
