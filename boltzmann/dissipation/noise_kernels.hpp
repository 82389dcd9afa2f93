// Noise of single particles: normals of many at once, as plain memory and a function pointer.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/core/pack_random.hpp>

#include <cstddef>
#include <cstdint>

namespace boltzmann {

inline constexpr std::size_t noise_block = 64;

/// Normals of the particles first, first + 1, ...: they depend only on the particle's number, the key and the tags.
struct NoiseTask {
  PhiloxKey key;
  std::uint32_t tag[3] = {};  ///< words of the counter besides the number
  std::uint64_t first = 0;    ///< only the low half is used
  std::size_t count = 0;      ///< at most noise_block
  int each = 1;               ///< normals per particle, 1 to 4
  double* columns = nullptr;  ///< `each` (rounded up to an even number) columns of noise_block
};

using NoiseKernel = void (*)(NoiseTask const& task);

template <InstructionSet set>
NoiseKernel noise_kernel();

}  // namespace boltzmann
