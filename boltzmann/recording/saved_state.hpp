// Saved state: parts of a checkpoint by name. Private to this module.
#pragma once

#include <boltzmann/core/error.hpp>
#include <boltzmann/files/checkpoint.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace boltzmann {

/// Stores 64 bits as two numbers of a checkpoint, and restores them.
inline std::vector<double> halves(std::uint64_t bits) {
  return {static_cast<double>(bits >> 32U), static_cast<double>(bits & 0xffffffffU)};
}
inline std::uint64_t whole(std::vector<double> const& halves) {
  return static_cast<std::uint64_t>(halves.at(0)) << 32U | static_cast<std::uint64_t>(halves.at(1));
}

/// Throws Error, naming the file, if the part is missing.
inline std::vector<double> const& saved_part(Checkpoint const& saved, std::string const& name,
                                             std::string const& path) {
  auto const found = saved.state.find(name);
  if (found == saved.state.end())
    throw Error("'" + path + "' does not fit this simulation: it has no state of " + name);
  return found->second;
}

}  // namespace boltzmann
