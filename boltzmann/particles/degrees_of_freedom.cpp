// Counting degrees of freedom.
#include <boltzmann/particles/degrees_of_freedom.hpp>

#include <boltzmann/core/exact_sum.hpp>

#include <algorithm>

namespace boltzmann {

bool carries_momentum(AnyEnsemble const& ensemble) {
  Field const* velocity = ensemble.find_field("velocity");
  return velocity != nullptr && velocity->components == ensemble.dimension() && ensemble.find_field("mass") != nullptr;
}

std::size_t number_moving(AnyEnsemble const& ensemble) {
  Mobility const& mobility = ensemble.mobility;
  if (mobility.all_rest) return 0;
  return ensemble.size() - static_cast<std::size_t>(std::count(mobility.rests.begin(), mobility.rests.end(), 1));
}

double freedom_of(AnyEnsemble const& ensemble) {
  if (!carries_momentum(ensemble)) return 0;
  if (ensemble.mobility.taken.empty())
    return static_cast<double>(ensemble.dimension()) * static_cast<double>(number_moving(ensemble));
  ExactSum sum;
  for (std::size_t i = 0; i < ensemble.size(); ++i) sum += freedom_of(ensemble, i);
  return sum.value();
}

double freedom_of(ChosenParticles const& chosen) {
  if (!carries_momentum(*chosen.ensemble)) return 0;
  ExactSum sum;
  for (auto const i : chosen.which) sum += freedom_of(*chosen.ensemble, i);
  return sum.value();
}

std::array<double, 3> freedom_along(double freedom, int dimension, KeptMomentum const& kept, double mass) {
  std::array<double, 3> along{};
  for (int a = 0; a < dimension; ++a)
    along[static_cast<std::size_t>(a)] =
        freedom / dimension - (kept.along[static_cast<std::size_t>(a)] && kept.mass > 0 ? mass / kept.mass : 0);
  return along;
}

double freedom_left(double freedom, int dimension, KeptMomentum const& kept, double mass) {
  auto const along = freedom_along(freedom, dimension, kept, mass);
  return along[0] + along[1] + along[2];
}

}  // namespace boltzmann
