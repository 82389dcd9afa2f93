// The table of classes.
#include <boltzmann/scenario/classes.hpp>

namespace boltzmann {

ClassVariant const* ParticleClass::in(int dimension) const {
  for (auto const& variant : variants)
    if (variant.dimension == dimension) return &variant;
  return nullptr;
}

std::vector<ParticleClass> const& particle_classes() {
  static std::vector<ParticleClass> const all = [] {
    std::vector<ParticleClass> classes;
    for (auto const& family :
         {detail::newton_classes(), detail::laplace_classes(), detail::tracer_classes(), detail::smooth_classes()})
      classes.insert(classes.end(), family.begin(), family.end());
    return classes;
  }();
  return all;
}

ParticleClass const* find_class(std::string_view name) {
  for (auto const& entry : particle_classes())
    if (entry.name == name) return &entry;
  return nullptr;
}

}  // namespace boltzmann
