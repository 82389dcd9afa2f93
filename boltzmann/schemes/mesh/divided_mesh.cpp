// A mesh divided among the ranks of a team. Each rank counts its own particles, and solves a part of the mesh. Sums of
// integers do not depend on the order.
#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/mesh/mesh_work.hpp>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>

namespace boltzmann {
namespace {

// Smaller meshes are solved faster on each rank than parts can be exchanged. Whole steps would wait for other ranks
// twice, with little other work, so their threshold is higher.
constexpr std::size_t nodes_worth_dividing = 1U << 14U, of_whole_steps = 1U << 19U;

}  // namespace

std::string MeshScheme::undivided() const {
  return has_users_stage() ? "stages of a mesh that are the program's" : pairs_.undivided();
}

void MeshScheme::divide(Division* division) {
  division_ = division;
  agreed_ = measured_ = false;
  pairs_.threads(threads());
  pairs_.divide(division);
}

void MeshScheme::bring_particles() {
  pairs_.threads(threads());
  if (!pairs_.ensembles().empty()) pairs_.bring_particles();
}

/// Updates the strengths of this rank's particles. If they have changed on any rank, exchanges those of all.
void MeshScheme::agree_on_strengths(Work& work) {
  bool changed = !agreed_;
  for (auto const& loaded : loaded_)
    if (loaded->refresh_share(threads())) changed = true;
  if (division_->team().meet(Team::Occasion::exchanges, {changed ? 1 : 0}).most[0] == 0) return;
  for (auto const& loaded : loaded_) division_->gather(*loaded->ensemble, loaded->strengths.data(), 1, 1);
  agreed_ = true;
  work.total_strength = total_strength();
  check_neutral();
  work.per_strength = scale_of_counts();
}

/// The ranks that solve the mesh together; null: each solves all of it.
SolvingRanks const* MeshScheme::solving_ranks(Work& work, bool whole_steps) const {
  std::size_t const least = whole_steps ? of_whole_steps : nodes_worth_dividing;
  if (!division_ || work.grid.dimension == 1 || work.grid.size() < least) return nullptr;
  work.ranks = {&division_->team(), {}};
  return &work.ranks;
}

/// The planes of nodes in the range of this rank's particles, with a margin.
std::vector<char> MeshScheme::planes_read(Work const& work) const {
  int const a = work.grid.dimension - 1;
  std::size_t const ghosts = work.ghosts.nodes(a);
  std::vector<std::atomic<char>> met(ghosts);
  for (auto const& loaded : loaded_) {
    AssignTask const task = task_for(work, *loaded);
    auto const cells = static_cast<double>(task.cells[a]);
    for_share(*loaded->ensemble, mesh_grain, threads_for(loaded->ensemble->share()->size, 1, threads()),
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                  double s = (task.rows[i * task.stride + a] - task.low[a]) * task.per_length[a];
                  if (task.periodic[a] && !(s >= 0 && s < cells)) s -= cells * std::floor(s / cells);
                  met[static_cast<std::size_t>(std::clamp(s, 0.0, cells))].store(1, std::memory_order_relaxed);
                }
              });
  }
  std::vector<char> read(work.grid.nodes[a]);
  for (std::size_t g = 0; g < ghosts; ++g)
    if (met[g])
      for (std::size_t node = g > 0 ? g - 1 : 0; node <= std::min(g + order_ + 1, ghosts - 1); ++node)
        read[work.ghosts.mesh_node(a, node)] = 1;
  return read;
}

/// Exchanges which planes each rank reads.
void MeshScheme::learn_readers(Work& work) const {
  auto const mine = planes_read(work);
  Team& team = *work.ranks.team;
  auto const ranks = static_cast<std::size_t>(team.size()), words = (mine.size() + 63) / 64;
  std::vector<std::int64_t> bits(ranks * words);  // only the bits of this rank are set here
  for (std::size_t l = 0; l < mine.size(); ++l)
    bits[static_cast<std::size_t>(team.rank()) * words + l / 64] |= std::int64_t{mine[l]} << l % 64;
  team.sum(bits);
  work.ranks.reads.assign(ranks, std::vector<char>(mine.size()));
  for (std::size_t r = 0; r < ranks; ++r)
    for (std::size_t l = 0; l < mine.size(); ++l)
      work.ranks.reads[r][l] = static_cast<char>(bits[r * words + l / 64] >> l % 64 & 1);
}

/// Sends the counts of each plane to the rank that solves it.
void MeshScheme::sum_in_planes(Work& work, std::int64_t* counts) const {
  Team& team = *work.ranks.team;
  auto const rank = static_cast<std::size_t>(team.rank()), ranks = static_cast<std::size_t>(team.size());
  std::size_t const plane = work.ghosts.plane();
  int const a = work.grid.dimension - 1;
  auto const for_planes = [&](std::size_t from, std::size_t to, auto const& function) {
    auto const [begin, end] = work.ranks.part(to, work.grid.nodes[a]);
    for (std::size_t l = begin; l < end; ++l)
      if (work.ranks.reads[from][l]) function(counts + work.ghosts.place(a, l) * plane);
  };
  std::vector<std::size_t> sent(ranks), received(ranks);
  for (std::size_t r = 0; r < ranks; ++r)
    if (r != rank) {
      for_planes(rank, r, [&](std::int64_t*) { sent[r] += plane; });
      for_planes(r, rank, [&](std::int64_t*) { received[r] += plane; });
    }
  team.meet(Team::Occasion::exchanges);
  team.exchange(
      sent, received,
      [&](std::size_t r, double* to) {
        for_planes(rank, r, [&](std::int64_t const* at) {
          std::memcpy(to, at, plane * sizeof *at);
          to += plane;
        });
      },
      [&](std::size_t r, double const* from) {
        for_planes(r, rank, [&](std::int64_t* at) {
          for (std::size_t i = 0; i < plane; ++i, ++from) at[i] += std::bit_cast<std::int64_t>(*from);
        });
      });
}

/// deposit() in a divided run; a collective call. Either all ranks need the solution, or each needs the field at its
/// own particles.
SolvingRanks const* MeshScheme::deposit_share(Work& work, Whose readers) {
  agree_on_strengths(work);
  auto const outside = count(work, work.per_strength, Whose::own);
  std::int64_t* const counts = work.tallies.sum();
  Team& team = division_->team();
  auto const first = ~team.meet(Team::Occasion::exchanges, {~outside}).most[0];
  if (first != no_particle) {
    division_->make_whole();
    refuse_outside(first);
  }
  auto const* const ranks = solving_ranks(work, false);
  double const unit = 1 / (work.per_strength * work.grid.cell_volume());
  auto& density = work.density.components[0];
  work.others = nullptr;
  if (ranks && readers == Whose::own && !work.walls.lifts()) {
    learn_readers(work);
    work.ghosts.fold_planes(counts);
    sum_in_planes(work, counts);
    auto const [begin, end] =
        ranks->part(static_cast<std::size_t>(team.rank()), work.grid.nodes[work.grid.dimension - 1]);
    work.ghosts.fold_in_planes(counts, unit, density, threads(), begin, end);
    work.planes = {begin, end};
    work.others = &team;
  } else {
    team.sum({counts, work.ghosts.size()});
    if (work.ghosts.smears()) work.unfolded.assign(counts, counts + work.ghosts.size());
    work.ghosts.fold(counts, unit, density, threads());
  }
  add_background(work);
  return ranks;
}

}  // namespace boltzmann
