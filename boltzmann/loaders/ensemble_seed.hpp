// The seed of one loader on one ensemble, so that two ensembles, or two loaders, don't draw the same numbers.
#pragma once

#include <boltzmann/core/random.hpp>

#include <cstdint>
#include <string_view>

namespace boltzmann {

/// A seed that depends on the user's seed, the ensemble's name and the loader's. Loaders draw for particle i from
/// Stream(ensemble_seed(...), 0, i, purpose). So a particle's numbers do not depend on the number of other particles,
/// nor on the order of loading. Changing this function changes every loaded state.
constexpr std::uint64_t ensemble_seed(std::uint64_t seed, std::string_view ensemble, std::string_view loader) {
  std::uint64_t hash = 0xcbf29ce484222325U;  // FNV-1a, 64 bits
  auto const add = [&](unsigned char byte) { hash = (hash ^ byte) * 0x100000001b3U; };
  for (char const c : ensemble) add(static_cast<unsigned char>(c));
  add(0);
  for (char const c : loader) add(static_cast<unsigned char>(c));
  return philox({hash, 0, 0, 0}, {seed, 0x6c6f61646572U})[0];
}

}  // namespace boltzmann
