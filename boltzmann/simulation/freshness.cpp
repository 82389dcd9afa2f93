// Changes are detected by the bits of the rows.
#include <boltzmann/simulation/freshness.hpp>

#include <boltzmann/core/checksum_kernels.hpp>
#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/core/threads.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

namespace boltzmann {
namespace {

constexpr std::size_t together = std::size_t{1} << 14U;  // numbers

std::uint64_t checksum(double const* numbers, std::size_t count, int threads) {
  ChecksumKernel const kernel = for_instruction_set([](auto set) { return checksum_kernel<decltype(set)::value>(); });
  if (count <= together) return kernel(numbers, count);
  std::vector<double> parts((count + together - 1) / together);
  for_ranges(parts.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      parts[k] = std::bit_cast<double>(kernel(numbers + k * together, std::min(together, count - k * together)));
  });
  return checksum(parts.data(), parts.size(), 1);
}

}  // namespace

std::uint64_t rows_checksum(std::span<AnyEnsemble* const> ensembles, int threads, bool with_influences) {
  std::uint64_t all = 0;
  auto const take = [&](double const* numbers, std::size_t count) {
    all = (std::rotl(all, 5) ^ checksum(numbers, count, threads)) * 0x9E3779B97F4A7C15U;
  };
  for (auto const* ensemble : ensembles) {
    take(ensemble->row(0), ensemble->size() * ensemble->stride());
    if (with_influences) take(ensemble->influences().data(), ensemble->influences().size());
  }
  return all;
}

}  // namespace boltzmann
