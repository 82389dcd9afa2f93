// Brings influences and derived fields up to date with rows that may have been written.
#include <boltzmann/simulation/simulation.hpp>

#include <algorithm>

namespace boltzmann {

void Simulation::update_derived_fields() const {
  for (auto* scheme : schemes_) scheme->complete(time());
  for (auto* dissipation : dissipations_) dissipation->update_derived_fields();
}

bool Simulation::derives(AnyEnsemble const& ensemble, Field const& field) const {
  auto const by = [&](auto const* one) { return one->derives(ensemble, field); };
  return std::any_of(schemes_.begin(), schemes_.end(), by) ||
         std::any_of(dissipations_.begin(), dissipations_.end(), by);
}

void Simulation::refresh() {
  if (running_) return refresh_in_run();
  if (!checked_) {
    make_ready();
  } else {
    if (influences_.kept() && influences_.hold_for(dependence(true))) return;
    take_particles();
    calculate(time());
  }
  check_influences();
  update_derived_fields();
  influences_.keep(dependence(true));
}

/// From an observer, or from an adaptation that may have changed rows.
void Simulation::refresh_in_run() {
  bool const changed = rows_before_change_ && checksum() != *rows_before_change_;
  if (!changed && influences_.hold()) return;
  if (is_divided())
    throw Error("influences are not up to date here, in a run that is divided over ranks; read them in an observer");
  store_rows();
  if (changed) take_particles();
  influences_.outdated();
  calculate(time());
  if (whole_.steps) influences_.outdated();  // whole steps do not keep influences
  update_derived_fields();
  if (rows_before_change_) rows_before_change_ = checksum();
}

}  // namespace boltzmann
