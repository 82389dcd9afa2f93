// Checksums against published check values.
#include <gtest/gtest.h>
#include <boltzmann/files/checksum.hpp>
#include <boltzmann/files/hdf5_driver.hpp>

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "temporary_folder.hpp"

namespace boltzmann::checksum_test {
namespace {

TEST(Checksum, HasThePublishedCheckValueOfCrc64) {
  EXPECT_EQ(boltzmann::crc64("123456789", 9), 0x995DC9BBDF1939FAU);  // catalogue of CRC algorithms, CRC-64/XZ
  EXPECT_EQ(boltzmann::crc64("", 0), 0U);
}

TEST(Checksum, IsTheSameInPieces) {
  std::string text;
  for (int k = 0; k < 1000; ++k) text += static_cast<char>(k * k);
  auto const whole = boltzmann::crc64(text.data(), text.size());
  for (std::size_t cut = 0; cut <= 40; ++cut)
    EXPECT_EQ(boltzmann::crc64(text.data() + cut, text.size() - cut, boltzmann::crc64(text.data(), cut)), whole);
}

TEST(Checksum, SeesTwoChangedSigns) {
  std::vector<double> numbers(16, 1.0);
  auto const sum = [&] { return boltzmann::crc64(numbers.data(), numbers.size() * sizeof(double)); };
  auto const before = sum();
  numbers[3] = -1;
  numbers[9] = -1;
  EXPECT_NE(sum(), before);
}

TEST(Checksum, AgreesWithWhatHdf5PutsBehindItsSuperblock) {
  TemporaryFolder const folder;
  std::string const path = folder / "plain.h5";
  hid_t const access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110);
  H5Fclose(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access));
  H5Pclose(access);
  std::ifstream file(path, std::ios::binary);
  std::vector<char> const bytes((std::istreambuf_iterator<char>(file)), {});
  ASSERT_GE(bytes.size(), 48U);
  std::uint32_t stored = 0;
  std::memcpy(&stored, bytes.data() + 44, 4);
  EXPECT_EQ(boltzmann::hdf5::lookup3(reinterpret_cast<unsigned char const*>(bytes.data()), 44), stored);
  // Jenkins' own examples (lookup3.c, driver5).
  EXPECT_EQ(boltzmann::hdf5::lookup3(nullptr, 0), 0xdeadbeefU);
  EXPECT_EQ(boltzmann::hdf5::lookup3(reinterpret_cast<unsigned char const*>("Four score and seven years ago"), 30),
            0x17770551U);
}

}  // namespace
}  // namespace boltzmann::checksum_test
