// What stands on the nodes beyond the ends of a mesh, by the boundary there.
#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/mesh/ghosts.hpp>
#include <boltzmann/schemes/mesh/spline.hpp>

#include <algorithm>

namespace boltzmann {
namespace {

void add(std::int64_t* to, std::int64_t const* from, std::size_t count, double parity) {
  if (parity > 0)
    for (std::size_t i = 0; i < count; ++i) to[i] += from[i];
  else
    for (std::size_t i = 0; i < count; ++i) to[i] -= from[i];
}

}  // namespace

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

void Ghosts::fold_planes(std::int64_t* counts) const {
  int const a = dimension_ - 1;
  if (a == 0) return;  // its planes are single nodes, and belong to a row
  for (std::size_t g = 0; g < nodes(a); ++g)
    if (!own(a, g)) add(counts + place(a, mesh_node(a, g)) * plane(), counts + g * plane(), plane(), parity(a, g));
}

void Ghosts::fold(std::int64_t* counts, double unit, std::vector<double>& density, int threads) const {
  fold_planes(counts);
  fold_in_planes(counts, unit, density, threads, 0, dimension_ == 1 ? 1 : mesh_nodes_[dimension_ - 1]);
}

void Ghosts::fold_in_planes(std::int64_t* counts, double unit, std::vector<double>& density, int threads,
                            std::size_t first, std::size_t last) const {
  // One axis after the other, the last first: rows are then whole pieces of memory until x.
  std::size_t const nx = nodes(0), ny = nodes(1);
  if (dimension_ == 3)
    for (std::size_t l = first; l < last; ++l) {
      std::int64_t* const at = counts + place(2, l) * plane();
      for (std::size_t g = 0; g < ny; ++g)
        if (!own(1, g)) add(at + place(1, mesh_node(1, g)) * nx, at + g * nx, nx, parity(1, g));
    }
  // On a wall, images stand where the particles do.
  auto const on_wall = [&](int a, std::size_t node) {
    if (a >= dimension_ || ends_[a].low == FieldBoundary::periodic || ends_[a].low == FieldBoundary::open) return 1.0;
    FieldBoundary const wall = node == 0                    ? ends_[a].low
                               : node == mesh_nodes_[a] - 1 ? ends_[a].high
                                                            : FieldBoundary::open;
    return wall == FieldBoundary::neumann ? 2.0 : wall == FieldBoundary::dirichlet ? 0.0 : 1.0;
  };
  std::size_t const mx = mesh_nodes_[0], my = mesh_nodes_[1], of_plane = dimension_ == 3 ? my : 1;
  density.resize(mx * my * mesh_nodes_[2]);
  for_ranges((last - first) * of_plane, std::max<std::size_t>(1, 32768 / mx), threads,
             [&](std::size_t begin, std::size_t end) {
               for (std::size_t row = first * of_plane + begin; row < first * of_plane + end; ++row) {
                 std::size_t const j = row % my, k = row / my;
                 std::int64_t* const from = counts + (place(2, k) * ny + place(1, j)) * nx;
                 for (std::size_t g = 0; g < nx; ++g)
                   if (!own(0, g)) {
                     std::int64_t& to = from[place(0, mesh_node(0, g))];
                     to += parity(0, g) > 0 ? from[g] : -from[g];
                   }
                 double const factor = unit * on_wall(1, j) * on_wall(2, k);
                 double* const to = density.data() + row * mx;
                 for (std::size_t i = 0; i < mx; ++i) to[i] = factor * static_cast<double>(from[place(0, i)]);
                 to[0] *= on_wall(0, 0);
                 if (mx > 1) to[mx - 1] *= on_wall(0, mx - 1);
               }
             });
}

}  // namespace boltzmann
