// Arrays on the nodes of a mesh, and the resolution of the strengths counted there.
#include <boltzmann/core/team.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/mesh/mesh_work.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

namespace boltzmann {

double counts_per_strength(double greatest, std::size_t particles) {
  if (!(greatest > 0)) return 1;
  double const room = 61 - std::ceil(std::log2(static_cast<double>(particles) + 1));
  return std::exp2(std::min(48.0, room) - std::ceil(std::log2(greatest)));
}

void MeshScheme::Loaded::refresh(int threads) {
  strengths.resize(ensemble->size());
  for_ranges(ensemble->size(), mesh_grain, threads_for(ensemble->size(), 1, threads),
             [&](std::size_t begin, std::size_t end) {
               kind.strengths(ensemble->row(0), ensemble->stride(), begin, end, strengths.data());
             });
}

bool MeshScheme::Loaded::refresh_share(int threads) {
  strengths.resize(ensemble->size());
  std::atomic<bool> changed{false};
  for_share(*ensemble, mesh_grain, threads_for(ensemble->share()->size, 1, threads),
            [&](std::size_t begin, std::size_t end) {
              std::array<double, Share::longest> before;
              std::copy(strengths.data() + begin, strengths.data() + end, before.begin());
              kind.strengths(ensemble->row(0), ensemble->stride(), begin, end, strengths.data());
              if (!std::equal(strengths.data() + begin, strengths.data() + end, before.begin())) changed = true;
            });
  return changed;
}

MeshScheme::Work::Work(Ghosts the_ghosts, MeshGrid const& the_grid, std::array<FieldEnds, 3> const& ends,
                       PoissonForm form, int threads, GreensFunction const& green)
    : ghosts(std::move(the_ghosts)),
      grid(the_grid),
      solver(the_grid, ends, form, threads, green),
      walls(the_grid, ends, form, ghosts.order()) {
  using namespace dimensions;
  density = {"density", charge / (length * length * length), grid, std::vector<std::vector<double>>(1)};
  potential = {"potential", energy / charge, grid, std::vector<std::vector<double>>(1)};
  field = {"field", energy / charge / length, grid, std::vector<std::vector<double>>(grid.dimension)};
  tallies.resize(ghosts.size());
}

std::size_t MeshScheme::Work::bytes() const {
  std::size_t doubles = density.components[0].capacity() + potential.components[0].capacity();
  for (auto const& component : field.components) doubles += component.capacity();
  for (auto const& component : padded) doubles += component.capacity();
  return doubles * sizeof(double) + unfolded.capacity() * sizeof(std::int64_t) + tallies.bytes() + solver.bytes() +
         walls.bytes();
}

void pad(Ghosts const& ghosts, MeshField const& field, bool potential, std::vector<std::vector<double>>& padded,
         int threads, SolvingRanks const* ranks) {
  padded.resize(field.components.size());
  char const* const read =
      ranks && !ranks->reads.empty() ? ranks->reads[static_cast<std::size_t>(ranks->team->rank())].data() : nullptr;
  std::size_t const nx = ghosts.nodes(0), ny = ghosts.nodes(1), nz = ghosts.nodes(2);
  MeshGrid const& grid = field.grid;
  for (std::size_t c = 0; c < padded.size(); ++c) {
    padded[c].resize(ghosts.size());
    double const* from = field.components[c].data();
    double* to = padded[c].data();
    for_ranges(ny * nz, std::max<std::size_t>(1, 32768 / nx), threads, [&](std::size_t begin, std::size_t end) {
      std::vector<double> line(grid.nodes[0]);
      for (std::size_t row = begin; row < end; ++row) {
        std::size_t const j = row % ny, k = row / ny;
        if (read && !read[grid.dimension == 2 ? ghosts.mesh_node(1, j) : ghosts.mesh_node(2, k)]) continue;
        ghosts.row(from, potential ? -1 : static_cast<int>(c), j, k, line.data(), to + row * nx);
      }
    });
  }
}

}  // namespace boltzmann
