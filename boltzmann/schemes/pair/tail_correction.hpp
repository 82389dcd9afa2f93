// Tail corrections: what pairs beyond the cut-off would add to energy and virial, if particles stood there as everywhere.
//
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

/// A scheme beside pairs that moves nobody: homogeneous surroundings pull on all sides alike. Beyond the cut-off the pair
/// distribution is taken as g(r) = 1 (Allen and Tildesley, Computer Simulation of Liquids, section 2.8), in as many
/// dimensions as the box has.
class TailCorrection final : public Scheme {
 public:
  /// Error unless all axes are periodic.
  explicit TailCorrection(Box box);
  ~TailCorrection() override;

  /// Of the energy of pairs within an ensemble, and between two. It may know fields of the particles that do not change,
  /// as long as these make at most 64 kinds of them: each two have an integral of their own. Error if the law is no energy,
  /// one that knows more, or one that falls off no faster than 1/r^D, whose tail has no end.
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

/// The integral of u(r) over space beyond a distance, in D dimensions. Error if it has no end.
double integral_beyond(double distance, int dimension, std::function<double(double)> const& energy);

}  // namespace boltzmann
