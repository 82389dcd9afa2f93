// A sheared box: checks of what it does not support, and the initial flow of a run.
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {
namespace {

void check_method(AnyEnsemble const& ensemble, Integrator const& integrator) {
  Method const method = integrator.method();
  if (!carries_momentum(ensemble))
    throw Error(fmt::format("shear: ensemble '{}' of class {} has no velocities that change from image to image",
                            ensemble.name(), ensemble.class_name()));
  if (method == Method::deactivate || !integrator.same_for_all())
    throw Error(
        fmt::format("shear: particles of ensemble '{}' are fixed, but their images would flow", ensemble.name()));
  if (integrator.has_groups())
    throw Error(fmt::format(
        "shear: the bonds of ensemble '{}' are kept rigid with no regard to the velocities of images that flow; use "
        "springs",
        ensemble.name()));
  if (method == Method::reversible_leap_frog || method == Method::gauss_radau)
    throw Error(fmt::format("shear: ensemble '{}' moves by {}, which knows no images that flow; use leap-frog",
                            ensemble.name(), to_string(method)));
}

}  // namespace

void Simulation::check_shear() {
  Box const& box = schemes_.front()->box();
  Shear const& shear = box.shear();
  for (auto const* scheme : schemes_) {
    Shear const& other = scheme->box().shear();
    bool const alike = other.flow == shear.flow && other.gradient == shear.gradient && other.rate == shear.rate;
    if ((box.sheared() || scheme->box().sheared()) && !alike)
      throw Error("shear: the boxes of all schemes of a simulation are sheared alike, or none is");
  }
  if (!box.sheared()) return;
  for (auto const* scheme : schemes_)
    if (auto const why = scheme->shear_refused(); !why.empty())
      throw Error(fmt::format("shear: {} {}", scheme->summary().empty() ? "a scheme" : scheme->summary(), why));
  for (auto const* ensemble : ensembles_) check_method(*ensemble, *part_of(*ensemble)->integrator);
  if (!barostats_.empty()) throw Error("shear: a barostat stretches the box, and one that is sheared is not stretched");
  if (!changes_.empty()) throw Error("shear: adaptations, which know their box, don't go with it");
  if (std::any_of(events_.begin(), events_.end(), [](Event const& event) { return !event.lasting; }))
    throw Error(
        "shear: events that change velocities, or add particles with velocities, which are not those relative to the "
        "flow, don't go with it");
  for (auto* dissipation : dissipations_) dissipation->act_in_flow(box);
  for (auto const& equilibration : equilibrations_) equilibration.dissipation->act_in_flow(box);
}

/// A fluid with a common velocity along the gradient would carry the plane of zero flow out of the middle.
void Simulation::establish_flow() {
  Box const& box = schemes_.front()->box();
  if (!box.sheared()) return;
  auto const total = momentum(ensembles_);
  double const mass = total_mass(ensembles_);
  int const flow = box.shear().flow, gradient = box.shear().gradient;
  for (auto* ensemble : ensembles_) {
    int const velocity = ensemble->field("velocity").offset;
    for (std::size_t i = 0; i < ensemble->size(); ++i) {
      double* const row = ensemble->row(i);
      for (int const a : {flow, gradient}) row[velocity + a] -= total[static_cast<std::size_t>(a)] / mass;
      if (box.shear().established) row[velocity + flow] += box.flow_velocity(row);
    }
  }
  take_particles();
}

}  // namespace boltzmann
