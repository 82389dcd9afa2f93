// A run over the ranks of a team: each advances its share of the particles, and all have the bits of one.
#include <boltzmann/core/team.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <algorithm>
#include <cstring>

namespace boltzmann {
namespace {

/// A move as all ranks know it: the furthest, the first of equals, and the first particle that is not finite.
LargestMove over_all_ranks(Team& team, LargestMove const& mine) {
  std::string const bytes(reinterpret_cast<char const*>(&mine), sizeof mine);
  LargestMove all;
  for (auto const& of_rank : team.gather(bytes)) {
    LargestMove one;
    std::memcpy(&one, of_rank.data(), sizeof one);
    if (one.square > all.square || (one.square == all.square && one.particle < all.particle))
      all.square = one.square, all.particle = one.particle;
    all.not_finite = std::min(all.not_finite, one.not_finite);
  }
  return all;
}

}  // namespace

std::string Simulation::undivided() const {
  if (team().size() > Division::most_ranks) return "more than 65,536 ranks";
  for (auto const* dissipation : dissipations_)
    if (auto why = dissipation->undivided(); !why.empty()) return why;
  if (!barostats_.empty()) return "a barostat";
  if (schemes_.front()->box().sheared()) return "a sheared box";
  if (!changes_.empty()) return "adaptations of the particles";
  if (!events_.empty()) return "events";
  if (substeps_) return "steps that are divided into substeps";
  if (!gauss_radau_.parts().empty()) return "gauss-radau";
  if (!slow_.empty()) return "forces that are calculated every few steps";
  if (std::count_if(schemes_.begin(), schemes_.end(), [](auto const* scheme) { return scheme->shares_out(); }) > 1)
    return "several schemes that have neighbour lists";
  for (auto const* scheme : schemes_) {
    if (auto why = scheme->undivided(); !why.empty()) return why;
  }
  std::size_t particles = 0;
  for (auto const& part : parts_) {
    if (auto why = part.integrator->undivided(); !why.empty()) return why;
    particles += part.ensemble->size();
  }
  return particles < divided_from_ ? "few particles" : "";
}

/// Whether the run goes on by shares from here.
bool Simulation::divide() {
  Team& here = team();
  if (here.alone() || here.depth() != 1 || !undivided().empty()) return false;
  if (!division_ || &division_->team() != &here) {
    division_ = std::make_unique<Division>(here);
    for (auto* ensemble : ensembles_) division_->add(*ensemble);
    division_->carry([this](AnyEnsemble const& ensemble) {
      if (Part* const part = part_of(ensemble))
        for (auto const& [numbers, count] : part->integrator->carried())
          division_->gather(ensemble, numbers, count, count);
    });
  }
  division_->begin();
  for (auto* dissipation : dissipations_) dissipation->divide(division_.get());
  for (auto* scheme : schemes_) scheme->divide(division_.get());
  return true;
}

/// Everything is everybody's again, as far as it is known here.
void Simulation::end_division() {
  if (!division_ || !division_->goes_on()) return;
  for (auto* dissipation : dissipations_) dissipation->divide(nullptr);
  for (auto* scheme : schemes_) scheme->divide(nullptr);
  division_->end();
}

/// For whoever looks at them.
void Simulation::gather_particles() const {
  division_->moved();  // some of their fields have been completed
  division_->make_whole();
  if (!whole_.steps) division_->gather_influences();  // whole steps leave those that there were
}

void Simulation::check_moves_together() {
  bool too_far = false;
  for (auto const& part : parts_) {
    LargestMove const& move = part.integrator->largest_move();
    too_far = too_far || move.not_finite != LargestMove::nobody || !(move.square <= part.longest_move2);
  }
  if (division_->team().meet(Team::Occasion::step_ends, {too_far ? 1 : 0}).most[0] == 0) return;
  division_->make_whole();
  for (auto const& part : parts_) check_move(part, over_all_ranks(division_->team(), part.integrator->largest_move()));
}

}  // namespace boltzmann
