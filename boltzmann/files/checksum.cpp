// CRC-64 with eight tables: eight bytes at a time.
#include <boltzmann/files/checksum.hpp>

#include <array>

namespace boltzmann {
namespace {

using Tables = std::array<std::array<std::uint64_t, 256>, 8>;

// tables[k][b]: the CRC of byte b followed by k zero bytes.
constexpr Tables make_tables() {
  constexpr std::uint64_t polynomial = 0xC96C5795D7870F42;  // ECMA-182, reflected
  Tables tables{};
  for (std::uint64_t byte = 0; byte < 256; ++byte) {
    std::uint64_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1) ^ ((rest & 1) != 0 ? polynomial : 0);
    tables[0][byte] = rest;
  }
  for (std::size_t k = 1; k < 8; ++k)
    for (std::size_t byte = 0; byte < 256; ++byte)
      tables[k][byte] = (tables[k - 1][byte] >> 8) ^ tables[0][tables[k - 1][byte] & 0xFF];
  return tables;
}

constexpr Tables tables = make_tables();

}  // namespace

std::uint64_t crc64(void const* bytes, std::size_t size, std::uint64_t before) {
  auto const* at = static_cast<unsigned char const*>(bytes);
  std::uint64_t rest = ~before;
  for (; size >= 8; size -= 8, at += 8) {
    std::uint64_t word = 0;
    for (unsigned k = 0; k < 8; ++k) word |= static_cast<std::uint64_t>(at[k]) << (8 * k);
    word ^= rest;
    rest = 0;
    for (unsigned k = 0; k < 8; ++k) rest ^= tables[7 - k][(word >> (8 * k)) & 0xFF];
  }
  for (; size > 0; --size, ++at) rest = (rest >> 8) ^ tables[0][(rest ^ *at) & 0xFF];
  return ~rest;
}

}  // namespace boltzmann
