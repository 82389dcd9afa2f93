// Tail corrections: the contributions of pairs beyond the cut-off to energy and virial, for a uniform distribution
// there.
//   PairScheme pairs(box, 3);
//   pairs.shifted(false);                        // energies as the law has them
//   pairs.internal(atoms, lennard_jones);
//   TailCorrection tail(box);
//   tail.internal(atoms, FormulaLaw::energy("4*((1/r)^12 - (1/r)^6)"), 3);
//   simulation.add(tail);
#pragma once

#include <boltzmann/laws/formula_law.hpp>
#include <boltzmann/schemes/scheme.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

/// A scheme beside pairs that exerts no forces, because those of homogeneous surroundings cancel. Beyond the cut-off
/// the pair distribution is taken as g(r) = 1 (Allen and Tildesley, Computer Simulation of Liquids, section 2.8), in
/// the dimension of the box.
class TailCorrection final : public Scheme {
 public:
  /// Throws Error unless all axes are periodic.
  explicit TailCorrection(Box box);
  ~TailCorrection() override;

  /// Adds the tail of the energy of pairs within an ensemble, and between two. The law may read constant fields of the
  /// particles, if there are at most 64 combinations of their values: each two have an integral of their own. Throws
  /// Error if the law is no energy, reads other fields, or falls off no faster than 1/r^D, so that its tail diverges.
  void internal(AnyEnsemble& ensemble, FormulaLaw const& law, double cutoff) {
    between(ensemble, ensemble, law, cutoff);
  }
  void between(AnyEnsemble& a, AnyEnsemble& b, FormulaLaw const& law, double cutoff);

  void add_influences(double) override {}
  std::optional<std::uint64_t> revision() const override { return revision_with({}); }
  EnergyAndVirial measure(double time = 0) override;
  bool follows_box() const override { return true; }
  std::string shear_refused() const override { return ""; }
  double length_scale(AnyEnsemble const&) const override { return __builtin_inf(); }
  std::string explain(AnyEnsemble const&, std::size_t) const override { return ""; }
  void make_reversible(double) override {}
  std::string undivided() const override { return ""; }

 private:
  struct Tail;
  std::size_t number_of(AnyEnsemble const& ensemble) const;

  std::vector<std::unique_ptr<Tail>> tails_;
};

/// The integral of u(r) over space beyond a distance, in D dimensions. Throws Error if it diverges.
double integral_beyond(double distance, int dimension, std::function<double(double)> const& energy);

}  // namespace boltzmann
