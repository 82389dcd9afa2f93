// What stands on the nodes beyond the ends of a mesh, by the boundary there.
#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/mesh/ghosts.hpp>
#include <boltzmann/schemes/mesh/spline.hpp>

#include <algorithm>

namespace boltzmann {

Ghosts::Ghosts(int dimension, std::array<std::size_t, 3> const& cells, std::array<FieldEnds, 3> const& ends, int order)
    : dimension_(dimension), order_(order), before_(nodes_before(order)), cells_(cells), ends_(ends) {
  for (int a = 0; a < 3; ++a) {
    if (a >= dimension) {
      cells_[a] = 1;
      mesh_nodes_[a] = 1;
      to_[a] = {0};
      parity_[a] = {1};
      is_image_[a] = {0};
      continue;
    }
    auto const n = static_cast<std::int64_t>(cells[a]);
    bool const periodic = ends[a].low == FieldBoundary::periodic, open = ends[a].low == FieldBoundary::open;
    mesh_nodes_[a] = periodic ? cells[a] : open ? cells[a] + static_cast<std::size_t>(order) : cells[a] + 1;
    for (std::int64_t g = 0; g < n + order; ++g) {
      std::int64_t node = g - before_;
      double parity = 1;
      bool image = false;
      if (periodic) {
        node = (node % n + n) % n;
      } else if (open) {
        node = g;
      } else {
        // A mesh of few cells may be reflected more than once.
        while (node < 0 || node > n) {
          bool const low = node < 0;
          node = low ? -node : 2 * n - node;
          if ((low ? ends[a].low : ends[a].high) == FieldBoundary::dirichlet) parity = -parity;
          image = !image;
        }
      }
      to_[a].push_back(static_cast<std::uint32_t>(node));
      parity_[a].push_back(parity);
      is_image_[a].push_back(image);
    }
  }
}

void Ghosts::fold(std::vector<std::int64_t>& counts, double unit, std::vector<double>& density, int threads) const {
  // One axis after the other, the last first: rows are then whole pieces of memory until x.
  std::size_t const nx = nodes(0), ny = nodes(1), nz = nodes(2);
  auto const own = [&](int a, std::size_t g) {  // a node of the mesh itself
    if (a >= dimension_ || ends_[a].low == FieldBoundary::open) return true;
    return g >= static_cast<std::size_t>(before_) && g < static_cast<std::size_t>(before_) + mesh_nodes_[a];
  };
  auto const shift = [&](int a) {
    return a >= dimension_ || ends_[a].low == FieldBoundary::open ? std::size_t{0} : static_cast<std::size_t>(before_);
  };
  auto const add = [&](std::int64_t* to, std::int64_t const* from, std::size_t count, double parity) {
    if (parity > 0)
      for (std::size_t i = 0; i < count; ++i) to[i] += from[i];
    else
      for (std::size_t i = 0; i < count; ++i) to[i] -= from[i];
  };
  for (std::size_t g = 0; g < nz; ++g)
    if (!own(2, g)) {
      std::size_t const to = mesh_node(2, g) + shift(2);
      add(counts.data() + to * nx * ny, counts.data() + g * nx * ny, nx * ny, parity(2, g));
    }
  for (std::size_t k = 0; k < nz; ++k)
    for (std::size_t g = 0; g < ny; ++g)
      if (!own(1, g)) {
        std::size_t const to = mesh_node(1, g) + shift(1);
        add(counts.data() + (k * ny + to) * nx, counts.data() + (k * ny + g) * nx, nx, parity(1, g));
      }
  // On a wall, images stand where the particles do.
  auto const on_wall = [&](int a, std::size_t node) {
    if (a >= dimension_ || ends_[a].low == FieldBoundary::periodic || ends_[a].low == FieldBoundary::open) return 1.0;
    FieldBoundary const wall = node == 0                    ? ends_[a].low
                               : node == mesh_nodes_[a] - 1 ? ends_[a].high
                                                            : FieldBoundary::open;
    return wall == FieldBoundary::neumann ? 2.0 : wall == FieldBoundary::dirichlet ? 0.0 : 1.0;
  };
  std::size_t const mx = mesh_nodes_[0], my = mesh_nodes_[1], mz = mesh_nodes_[2];
  density.resize(mx * my * mz);
  for_ranges(my * mz, std::max<std::size_t>(1, 32768 / mx), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      std::size_t const j = row % my, k = row / my;
      std::int64_t* const from = counts.data() + ((k + shift(2)) * ny + j + shift(1)) * nx;
      for (std::size_t g = 0; g < nx; ++g)
        if (!own(0, g)) {
          std::int64_t& to = from[mesh_node(0, g) + shift(0)];
          to += parity(0, g) > 0 ? from[g] : -from[g];
        }
      double const factor = unit * on_wall(1, j) * on_wall(2, k);
      double* const to = density.data() + row * mx;
      for (std::size_t i = 0; i < mx; ++i) to[i] = factor * static_cast<double>(from[i + shift(0)]);
      to[0] *= on_wall(0, 0);
      if (mx > 1) to[mx - 1] *= on_wall(0, mx - 1);
    }
  });
}

}  // namespace boltzmann
