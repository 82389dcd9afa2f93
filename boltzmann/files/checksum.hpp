// Checksums: CRC-64, which detects damaged files.
#pragma once

#include <cstddef>
#include <cstdint>

namespace boltzmann {

/// CRC-64 of the ECMA-182 polynomial in its reflected form, as in xz ("123456789" gives 995DC9BBDF1939FA). For a long
/// text in pieces, pass the result of one call to the next; start with 0.
std::uint64_t crc64(void const* bytes, std::size_t size, std::uint64_t before = 0);

}  // namespace boltzmann
