// Sums over vortices and panels.
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/diagnoses/flow_impulse.hpp>

namespace boltzmann {

bool is_body(AnyEnsemble const& ensemble) { return ensemble.class_name() == "Panel" && ensemble.find_field("sheet"); }

FlowImpulse flow_impulse(std::span<AnyEnsemble* const> ensembles) {
  ExactSum x, y, circulation;
  for (auto const* ensemble : ensembles) {
    bool const body = is_body(*ensemble);
    Field const* const strength = ensemble->find_field(body ? "sheet" : "vorticity");
    if (!strength || ensemble->dimension() != 2) continue;
    int const length = body ? ensemble->field("length").offset : 0;
    for (std::size_t i = 0; i < ensemble->size(); ++i) {
      double const* const row = ensemble->row(i);
      double const gamma = row[strength->offset] * (body ? row[length] : 1);
      x += gamma * row[1], y += -gamma * row[0], circulation += gamma;
    }
  }
  return {{x.value(), y.value()}, circulation.value()};
}

}  // namespace boltzmann
