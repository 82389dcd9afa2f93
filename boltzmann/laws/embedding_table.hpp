// The energy of atoms in densities as a table: a spline in the root of the density.
#pragma once

#include <boltzmann/laws/embedded_atoms.hpp>

#include <functional>
#include <utility>
#include <vector>

namespace boltzmann {

/// Beyond the largest density it is continued as a straight line.
class EmbeddingTable final : public Embedding {
 public:
  /// Through energies at densities 0, spacing, 2 spacing, ... Error as of Table.
  EmbeddingTable(std::vector<double> const& energies, double spacing);
  /// F(density) up to the largest one. Error as of Table.
  EmbeddingTable(std::function<double(double)> const& energy, double greatest);

  void at(double const* density, std::size_t size, double* energy, double* slope) const override;

 private:
  Table table_;  // of r^2 = density
};

}  // namespace boltzmann
