// A checksum of numbers by their bits: plain memory and a function pointer.
#pragma once

#include <boltzmann/core/instruction_set.hpp>

#include <cstddef>
#include <cstdint>

namespace boltzmann {

/// The same for every instruction set. It tells changes of any number of bits, signs and order with all but certainty,
/// but is no guard against somebody who looks for two alike.
using ChecksumKernel = std::uint64_t (*)(double const* numbers, std::size_t count);

template <InstructionSet set>
ChecksumKernel checksum_kernel();

}  // namespace boltzmann
