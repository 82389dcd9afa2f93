// Bond order: how similar the directions to a particle's neighbours are to those of a crystal.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace boltzmann {

struct BondOrderOptions {
  std::vector<std::string> ensembles = {};  ///< empty: all particles; one: its particles
  std::string label = {};                   ///< before the columns' names; empty: the ensemble
  double range = 0;                         ///< of neighbours; positive
  std::size_t order = 6;                    ///< l: 4 detects squares and cubes, 6 triangles and close packing
};

/// 3D: q_l of each particle by the spherical harmonics of the directions to its n neighbours, q_l^2 = 4 pi / (2 l + 1)
/// sum_m |sum_j Y_lm / n|^2, and the same for all bonds of the system together (Steinhardt, Nelson and Ronchetti 1983).
/// For l = 6 fcc has 0.575, hcp 0.485, bcc (8 neighbours) 0.629 and the icosahedron 0.663; in a liquid the global one
/// vanishes, the local ones do not. 2D: psi_l = |sum_j exp(i l theta_j) / n|, and the magnitude of the mean over
/// particles. Columns: the mean over particles with a neighbour, the global value, and the mean number of neighbours.
class BondOrder final : public Diagnosis {
 public:
  using Options = BondOrderOptions;
  /// Error in 1D, if the ensemble does not exist, or for an invalid range or order.
  BondOrder(std::vector<AnyEnsemble const*> const& available, Options options);

  std::vector<Column> columns() const override;
  /// Error if the range is more than half of a periodic axis.
  void check(Box const& box) const override;
  void measure(Sample const& sample, std::vector<double>& values) override;

  /// For each particle, in the order of the ensembles: its own order (NaN without neighbours) and its number of
  /// neighbours.
  struct Local {
    std::vector<double> order, neighbours;
    double whole;
  };
  Local local(Sample const& sample) const;

 private:
  template <int D>
  Local find(Sample const& sample) const;

  Options options_;
  std::string label_;
  int dimension_;
};

}  // namespace boltzmann
