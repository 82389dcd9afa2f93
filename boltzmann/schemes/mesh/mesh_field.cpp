// The nodes of a mesh over a box.
#include <boltzmann/core/error.hpp>
#include <boltzmann/schemes/mesh/mesh_field.hpp>

#include <fmt/format.h>

namespace boltzmann {

MeshGrid make_grid(Box const& box, std::vector<std::size_t> const& cells) {
  if (cells.size() != static_cast<std::size_t>(box.dimension()))
    throw Error(fmt::format("mesh: {} numbers of cells for {} ax{}; give one for each", cells.size(), box.dimension(),
                            box.dimension() == 1 ? "is" : "es"));
  MeshGrid grid;
  grid.dimension = box.dimension();
  for (int a = 0; a < box.dimension(); ++a) {
    if (cells[a] < 1) throw Error(fmt::format("mesh: axis {} has no cells; it needs 1 or more", "xyz"[a]));
    grid.periodic[a] = box.periodic(a);
    grid.nodes[a] = cells[a] + (grid.periodic[a] ? 0 : 1);
    grid.low[a] = box.low(a);
    grid.spacing[a] = box.length(a) / static_cast<double>(cells[a]);
  }
  return grid;
}

}  // namespace boltzmann
