// A checksum of numbers by their bits: plain memory and a function pointer.
#pragma once

#include <boltzmann/core/instruction_set.hpp>

#include <cstddef>
#include <cstdint>

namespace boltzmann {

/// Gives the same checksum on every instruction set. It detects accidental changes of bits, signs and order, but is not
/// a cryptographic hash.
using ChecksumKernel = std::uint64_t (*)(double const* numbers, std::size_t count);

template <InstructionSet set>
ChecksumKernel checksum_kernel();

}  // namespace boltzmann
