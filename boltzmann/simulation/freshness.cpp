// Told by the bits of the rows.
#include <boltzmann/simulation/freshness.hpp>

#include <bit>

namespace boltzmann {

std::uint64_t rows_checksum(std::span<AnyEnsemble* const> ensembles, bool with_influences) {
  std::uint64_t sum = 0;
  auto const take = [&](double const* words, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k)
      sum = (std::rotl(sum, 5) ^ std::bit_cast<std::uint64_t>(words[k])) * 0x9E3779B97F4A7C15U;
  };
  for (auto const* ensemble : ensembles) {
    take(ensemble->row(0), ensemble->size() * ensemble->stride());
    if (with_influences) take(ensemble->influences().data(), ensemble->influences().size());
  }
  return sum;
}

}  // namespace boltzmann
