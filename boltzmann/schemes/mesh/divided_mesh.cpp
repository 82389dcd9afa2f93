// A mesh over the ranks of a team: each counts its own particles, sums of integers have no order, and all ranks solve the
// whole mesh.
#include <boltzmann/schemes/mesh/mesh_work.hpp>

namespace boltzmann {

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

/// Strengths of this rank's particles as they are now; where any rank has others than before, those of all.
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

/// deposit() in a divided run, for all ranks.
void MeshScheme::deposit_share(Work& work) {
  agree_on_strengths(work);
  auto const outside = count(work, work.per_strength, Whose::own);
  auto counts = work.tallies.sum();
  Team& team = division_->team();
  auto const first = ~team.meet(Team::Occasion::exchanges, {~outside}).most[0];
  if (first != no_particle) {
    division_->make_whole();
    refuse_outside(first);
  }
  team.sum(counts);
  work.ghosts.fold(counts, 1 / (work.per_strength * work.grid.cell_volume()), work.density.components[0], threads());
  add_background(work);
}

}  // namespace boltzmann
