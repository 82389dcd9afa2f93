// StillingerWeberScheme: silicon and similar materials, with bonds at preferred angles.
//   StillingerWeberScheme scheme(box, StillingerWeber::silicon(units));
//   scheme.add(silicon);
#pragma once

#include <boltzmann/laws/stillinger_weber.hpp>
#include <boltzmann/schemes/many_body/many_body_scheme.hpp>

namespace boltzmann {

class StillingerWeberScheme final : public ManyBodyScheme {
 public:
  /// Throws Error if a parameter of the law is invalid, and as ManyBodyScheme does for its cut-off.
  StillingerWeberScheme(Box box, StillingerWeber const& law);

  /// Adds atoms. All ensembles have atoms of one kind. Throws Error if forces do not move the particles.
  void add(AnyEnsemble& ensemble) { add_atoms(ensemble, 0); }

  StillingerWeber const& law() const { return law_; }
  double length_scale(AnyEnsemble const& ensemble) const override;
  std::string summary() const override { return "atoms with bonds (Stillinger and Weber)"; }

 protected:
  Passes passes() const override;
  void answer(Atoms const& atoms) const override;

 private:
  StillingerWeber law_;
};

}  // namespace boltzmann
