// Copies and compares rows.
#include <boltzmann/core/vector.hpp>
#include <boltzmann/window/run_start.hpp>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr std::size_t too_many = 4 << 20;  // number of particles above which the start is not stored

}  // namespace

std::string no_rewind(Simulation const& simulation) {
  if (!simulation.dissipations().empty()) return "friction and noise can't be run backwards";
  if (!simulation.barostats().empty()) return "a box that is stretched can't be run backwards";
  if (simulation.has_events()) return "events can't be run backwards";
  if (!simulation.adaptations().empty()) return "particles come and go between steps, which can't be run backwards";
  return "";
}

void RunStart::keep(Simulation const& simulation) {
  kept_ = true;
  std::size_t number = 0;
  for (auto const* ensemble : simulation.ensembles()) number += ensemble->size();
  if (!no_rewind(simulation).empty() || number > too_many) return;
  for (auto const* ensemble : simulation.ensembles()) rows_.push_back(copy_rows(*ensemble));
}

std::optional<RunStart::Missed> RunStart::missed(Simulation const& simulation) const {
  if (rows_.empty()) return std::nullopt;
  Missed most;
  Box const& box = simulation.schemes().front()->box();
  for (std::size_t e = 0; e < rows_.size(); ++e) {
    AnyEnsemble const& ensemble = *simulation.ensembles()[e];
    Field const* const field = ensemble.find_field("velocity");
    if (ensemble.size() != rows_[e].size) return std::nullopt;
    for (std::size_t i = 0; i < ensemble.size(); ++i) {
      double const* const now = ensemble.row(i);
      double const* const then = rows_[e].rows.data() + i * rows_[e].stride;
      double way2 = 0, change2 = 0;
      for (int a = 0; a < ensemble.dimension(); ++a) {
        double way = now[a] - then[a];
        if (a < box.dimension() && box.periodic(a)) way -= box.length(a) * std::round(way / box.length(a));
        way2 += way * way;
        if (field) change2 += square(now[field->offset + a] - then[field->offset + a]);
      }
      most.position = std::max(most.position, std::sqrt(way2));
      most.velocity = std::max(most.velocity, std::sqrt(change2));
    }
  }
  return most;
}

}  // namespace boltzmann
