// Sums over vortices.
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/vector.hpp>
#include <boltzmann/diagnoses/vortex_measures.hpp>

namespace boltzmann {
namespace {

template <class Function>
void each_vortex(Ensembles of, Function const& function) {
  for (AnyEnsemble const* ensemble : of) {
    if (!has_vorticity(*ensemble) || ensemble->size() == 0) continue;
    auto const velocities = velocities_of(*ensemble);
    int const at = ensemble->field("vorticity").offset;
    for (std::size_t i = 0; i < ensemble->size(); ++i)
      function(ensemble->dimension(), ensemble->row(i), ensemble->row(i) + at, velocities[i]);
  }
}

Vector<3> vector_of(double const* numbers) { return {numbers[0], numbers[1], numbers[2]}; }

}  // namespace

bool has_vorticity(AnyEnsemble const& ensemble) { return ensemble.find_field("vorticity") != nullptr; }

VortexMeasures vortex_measures(Ensembles of) {
  ExactSum circulation[3], impulse[3], angular[3], helicity;
  each_vortex(of, [&](int dimension, double const* x, double const* vorticity, double const* velocity) {
    if (dimension == 2) {
      double const gamma = vorticity[0];
      circulation[0] += gamma;
      impulse[0] += gamma * x[1], impulse[1] += -gamma * x[0];
      angular[0] += -0.5 * gamma * (x[0] * x[0] + x[1] * x[1]);
    } else {
      Vector<3> const r = vector_of(x), alpha = vector_of(vorticity), turned = cross(r, alpha),
                      twice = cross(r, turned);
      for (int a = 0; a < 3; ++a) {
        circulation[a] += alpha[a];
        impulse[a] += 0.5 * turned[a];
        angular[a] += twice[a] / 3;
      }
      helicity += dot(alpha, vector_of(velocity));
    }
  });
  VortexMeasures measures;
  for (std::size_t a = 0; a < 3; ++a)
    measures.circulation[a] = circulation[a].value(), measures.impulse[a] = impulse[a].value(),
    measures.angular_impulse[a] = angular[a].value();
  measures.helicity = helicity.value();
  return measures;
}

}  // namespace boltzmann
