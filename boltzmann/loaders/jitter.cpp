// Jitter, from each particle's own stream.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/loaders/ensemble_seed.hpp>
#include <boltzmann/loaders/jitter.hpp>

#include <fmt/format.h>

#include <cmath>

namespace boltzmann {

void jitter(AnyEnsemble& particles, JitterOptions const& options) {
  double const most = options.most;
  if (!(most >= 0) || !std::isfinite(most))
    throw Error(fmt::format("jitter: the largest move must be a length of zero or more, not {}", most));
  std::uint64_t const own = ensemble_seed(options.seed, particles.name(), "jitter");
  for (std::size_t i = 0; i < particles.size(); ++i) {
    Stream stream(own, 0, i, Purpose::position);
    for (int a = 0; a < particles.dimension(); ++a) particles.row(i)[a] += most * (2 * stream.uniform() - 1);
  }
}

}  // namespace boltzmann
