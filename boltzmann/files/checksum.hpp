// Checksums: CRC-64, which tells a damaged file from a good one.
#pragma once

#include <cstddef>
#include <cstdint>

namespace boltzmann {

/// CRC-64 of the ECMA-182 polynomial in its reflected form, as xz uses it ("123456789" gives 995DC9BBDF1939FA). Give
/// the result of one call to the next to sum up a long text in pieces; start with 0.
std::uint64_t crc64(void const* bytes, std::size_t size, std::uint64_t before = 0);

}  // namespace boltzmann
