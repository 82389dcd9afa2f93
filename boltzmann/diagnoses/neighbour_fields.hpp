// Neighbour fields: what is around each particle, as fields of its class that files, pictures, diagnoses and formulas know.
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
  std::string field;      ///< of one number, which nothing else changes
  double range = 0;       ///< neighbours are nearer than that; positive
  std::size_t order = 0;  ///< 0: how many they are; l: how far their directions are those of a crystal (BondOrder)
  /// Neighbours are particles of these; none: of all ensembles of the scheme.
  std::vector<AnyEnsemble*> among = {};
};

/// A scheme beside others that moves nobody: whenever somebody looks, and only then, it finds fields of particles by their
/// neighbours. So influences may not read these fields. Images are neighbours as other particles are: those beyond
/// periodic ends, also of a sheared box, as many as there are within the range, and those beyond the walls of mirror axes,
/// a particle's own among them. Of a particle without neighbours the bond order is NaN.
class NeighbourFields final : public Scheme {
 public:
  explicit NeighbourFields(Box box) : Scheme(std::move(box)) {}

  /// Error if the ensemble has no such field or it is not one number, the range is not positive, or a bond order is asked
  /// for on a line or above 16.
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
