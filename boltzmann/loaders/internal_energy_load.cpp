// Draws internal energies, for each particle from its own stream.
#include <boltzmann/core/random.hpp>
#include <boltzmann/laws/invariant_law.hpp>
#include <boltzmann/loaders/ensemble_seed.hpp>
#include <boltzmann/loaders/internal_energy_load.hpp>

namespace boltzmann {

void internal_energy_load(AnyEnsemble& ensemble, StateLaw const& law, InternalEnergyOptions const& options) {
  int const internal_energy = ensemble.field("internal_energy").offset;
  Field const* const own_temperature = ensemble.find_field("temperature");
  InvariantLaw const invariant(law, options.temperature, options.boltzmann_constant);
  std::uint64_t const key = ensemble_seed(options.seed, ensemble.name(), "internal energy");
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    Stream stream(key, 0, i, Purpose::internal_energy);
    double const drawn = invariant.quantile(stream.uniform());
    ensemble.row(i)[internal_energy] = drawn;
    if (own_temperature) ensemble.row(i)[own_temperature->offset] = law.temperature(drawn);
  }
}

}  // namespace boltzmann
