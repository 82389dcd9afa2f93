// Noise of single particles: normals of many at once, as plain memory and a function pointer.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/core/pack_random.hpp>

#include <cstddef>
#include <cstdint>

namespace boltzmann {

inline constexpr std::size_t noise_block = 64;

/// Normals of the particles first, first + 1, ...: what one gets depends on its number, the key and the tags alone.
struct NoiseTask {
  PhiloxKey key;
  std::uint32_t tag[3] = {};  ///< words of the counter beside the number
  std::uint64_t first = 0;    ///< the low half counts
  std::size_t count = 0;      ///< at most noise_block
  int each = 1;               ///< normals of a particle, 1 to 4
  double* columns = nullptr;  ///< `each` (of an odd number one more) columns of noise_block
};

using NoiseKernel = void (*)(NoiseTask const& task);

template <InstructionSet set>
NoiseKernel noise_kernel();

}  // namespace boltzmann
