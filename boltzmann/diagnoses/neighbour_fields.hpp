// Neighbour fields: properties of each particle's neighbourhood, as fields of its class for files, pictures, diagnoses
// and formulas.
//
//   NeighbourFields around(box);
//   around.find(atoms, {.field = "coordination", .range = 1.3});
//   simulation.add(around);
#pragma once

#include <boltzmann/schemes/scheme.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace boltzmann {

struct NeighbourField {
  std::string field;      ///< with one component, which nothing else changes
  double range = 0;       ///< limit of the distance of neighbours; positive
  std::size_t order = 0;  ///< 0: their number; l: the bond order of their directions (BondOrder)
  /// Neighbours are particles of these; empty: of all ensembles of the scheme.
  std::vector<AnyEnsemble*> among = {};
};

/// A scheme without influences: it computes fields of particles from their neighbours, only when an observer needs
/// them. So influences may not read these fields. Images count as neighbours: those beyond periodic ends, also of a
/// sheared box, as many as are within the range, and those beyond the walls of mirror axes, including a particle's own.
/// The bond order of a particle without neighbours is NaN.
class NeighbourFields final : public Scheme {
 public:
  explicit NeighbourFields(Box box) : Scheme(std::move(box)) {}

  /// Error if the ensemble has no such field or it has several components, the range is not positive, or a bond order
  /// is wanted on a line or above 16.
  void find(AnyEnsemble& ensemble, NeighbourField field);

  void complete(double time) override;
  bool derives(AnyEnsemble const& ensemble, Field const& field) const override;

  void add_influences(double /*time*/) override {}
  std::optional<std::uint64_t> revision() const override { return revision_with({}); }
  EnergyAndVirial measure(double time = 0) override;
  bool measures_sums() const override { return true; }
  bool follows_box() const override { return true; }
  std::string shear_refused() const override { return ""; }
  double length_scale(AnyEnsemble const& /*ensemble*/) const override { return __builtin_inf(); }
  bool translation_invariant() const override { return true; }
  std::string explain(AnyEnsemble const& /*ensemble*/, std::size_t /*i*/) const override { return ""; }
  void make_reversible(double /*quantum*/) override {}
  std::string undivided() const override { return ""; }
  void divide(Division* division) override { division_ = division; }

 private:
  struct Found {
    AnyEnsemble* ensemble;
    NeighbourField field;
    int offset;
  };
  template <int D>
  void find_in(Found const& found) const;

  std::vector<Found> found_;
  Division* division_ = nullptr;
};

}  // namespace boltzmann
