// Told by the bits of the rows.
#include <boltzmann/simulation/freshness.hpp>

#include <array>
#include <bit>

namespace boltzmann {

std::uint64_t rows_checksum(std::span<AnyEnsemble* const> ensembles) {
  constexpr std::size_t lanes = 8;  // which do not wait for each other
  std::array<std::uint64_t, lanes> sums{};
  auto const mix = [](std::uint64_t& sum, double word) {
    sum = (std::rotl(sum, 5) ^ std::bit_cast<std::uint64_t>(word)) * 0x9E3779B97F4A7C15U;
  };
  auto const take = [&](double const* words, std::size_t count) {
    std::size_t k = 0;
    for (; k + lanes <= count; k += lanes)
      for (std::size_t lane = 0; lane < lanes; ++lane) mix(sums[lane], words[k + lane]);
    for (; k < count; ++k) mix(sums[0], words[k]);
  };
  for (auto const* ensemble : ensembles) {
    take(ensemble->row(0), ensemble->size() * ensemble->stride());
    take(ensemble->influences().data(), ensemble->influences().size());
    mix(sums[0], std::bit_cast<double>(std::uint64_t{ensemble->size()}));
  }
  for (std::size_t lane = 1; lane < lanes; ++lane) mix(sums[0], std::bit_cast<double>(sums[lane]));
  return sums[0];
}

}  // namespace boltzmann
