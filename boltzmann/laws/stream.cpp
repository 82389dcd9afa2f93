// Rejects invalid streams.
#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/stream.hpp>

#include <fmt/format.h>

namespace boltzmann::detail {

void check_divergence(char const* law, char const* what, double divergence, double change) {
  if (!(std::abs(divergence) <= 1e-12 * change))
    throw Error(fmt::format("{}: {} is {:.6g}, and has to be 0: the fluid can't be compressed", law, what, divergence));
}

}  // namespace boltzmann::detail
