// A run over the ranks of a team: each rank advances its own particles, and the results are bit-for-bit those of one
// rank.
#include <boltzmann/core/team.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <algorithm>
#include <cstring>
#include <iterator>

namespace boltzmann {
namespace {

/// The largest move over all ranks, the first of equals, and the first particle that is not finite.
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
  if (!gauss_radau_.parts().empty()) return "gauss-radau";
  auto const lists = schemes_with_lists();
  if (lists.size() > 1 && lists[1]->has_points()) return "several schemes that have points of their own";
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

/// In the order in which they decide on owners: first schemes with points of their own, then those that are evaluated
/// often.
std::vector<Scheme*> Simulation::schemes_with_lists() const {
  std::vector<Scheme*> lists;
  std::copy_if(schemes_.begin(), schemes_.end(), std::back_inserter(lists),
               [](auto const* scheme) { return scheme->shares_out(); });
  std::stable_partition(lists.begin(), lists.end(), [this](auto const* scheme) { return every(*scheme) == 1; });
  std::stable_partition(lists.begin(), lists.end(), [](auto const* scheme) { return scheme->has_points(); });
  return lists;
}

/// State of particles, besides their rows, that exists until the step is done.
std::vector<Integrator::Carried> Simulation::held_inside_step(AnyEnsemble const& of) {
  Part* const part = part_of(of);
  if (!part) return {};
  auto all = part->integrator->carried();
  if (before_substep_.empty()) return all;
  double* kept = before_substep_.data();
  for (auto const* ensemble : ensembles_) {
    std::size_t const size = ensemble->size(), rows = size * ensemble->stride(),
                      influences = ensemble->influences().size();
    if (ensemble == &of && size > 0) {
      all.push_back({kept, ensemble->stride()});
      all.push_back({kept + rows, ensemble->influence_size()});
      for (std::size_t at = size * ensemble->influence_size(); at < influences; at += size * ensemble->rate_stride())
        all.push_back({kept + rows + at, ensemble->rate_stride()});
    }
    kept += rows + influences;
  }
  return all;
}

/// Starts the domain decomposition, if the run allows it.
void Simulation::divide() {
  Team& here = team();
  if (here.alone() || here.depth() != 1 || !undivided().empty()) return;
  here.meet(Team::Occasion::exchanges);  // an observer of a rank may have failed
  auto const fits = [this](auto const* ensemble) { return division_->owners(*ensemble).size() == ensemble->size(); };
  if (!division_ || &division_->team() != &here || !std::all_of(ensembles_.begin(), ensembles_.end(), fits)) {
    division_ = std::make_unique<Division>(here);
    for (auto* ensemble : ensembles_) division_->add(*ensemble);
  }
  division_->begin();
  for (auto& part : parts_) part.integrator->divide(division_.get());
  for (auto* dissipation : dissipations_) dissipation->divide(division_.get());
  // Schemes with lists come last; the first of them leads, and collects the rows that others read.
  for (auto* scheme : schemes_)
    if (!scheme->shares_out()) scheme->divide(division_.get());
  with_lists_ = schemes_with_lists();
  for (auto* scheme : with_lists_) scheme->divide(division_.get());
  if (!with_lists_.empty() && every(*with_lists_.front()) > 1) division_->brings_nothing();
}

/// End the domain decomposition: every rank advances all particles again, as far as rows are current here.
void Simulation::end_division() {
  if (!is_divided()) return;
  for (auto& part : parts_) part.integrator->divide(nullptr);
  for (auto* dissipation : dissipations_) dissipation->divide(nullptr);
  for (auto* scheme : schemes_) scheme->divide(nullptr);
  division_->carry({});
  division_->end();
}

/// Before all ranks change common data alike; divide() follows.
void Simulation::interrupt_division() {
  if (!is_divided()) return;
  gather_particles();
  end_division();
}

/// Gathers particles for observers.
void Simulation::gather_particles() const {
  division_->moved();  // some of their fields have been completed
  division_->make_whole();
  if (!whole_.steps) division_->gather_influences();  // whole steps keep no influences
}

/// True if global sums suffice for all observers of this step.
bool Simulation::sums_suffice() const {
  return std::all_of(observations_.begin(), observations_.end(),
                     [&](Observation const& one) {
                       return one.forgotten || !one.due(step_) || (one.sums && one.sums(step_));
                     }) &&
         std::all_of(schemes_.begin(), schemes_.end(), [](auto const* scheme) { return scheme->measures_sums(); });
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
