// StillingerWeberScheme: silicon and its like, by bonds at given angles.
//
//   StillingerWeberScheme scheme(box, StillingerWeber::silicon(units));
//   scheme.add(silicon);
#pragma once

#include <boltzmann/laws/stillinger_weber.hpp>
#include <boltzmann/schemes/many_body/many_body_scheme.hpp>

namespace boltzmann {

class StillingerWeberScheme final : public ManyBodyScheme {
 public:
  /// Error if a number of the law can't be, and as of ManyBodyScheme, from its cut-off.
  StillingerWeberScheme(Box box, StillingerWeber const& law);

  /// Adds atoms; those of all ensembles are of one kind. Error if no force moves them.
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
