// The kernel of checksums; its speed is limited by memory.
//
// Each lane adds a number, as an integer, and rotates its sum by 29 bits. As 29 is odd, the changes of two numbers meet
// in no bit again before 64 others have been added. Finally the lanes are combined by multiplication.
#include <boltzmann/core/checksum_kernels.hpp>
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/core/pack.hpp>

namespace boltzmann {
namespace detail {

inline constexpr int checksum_lanes = 16;

template <int W>
struct ChecksumWords {
  typedef std::uint64_t Words __attribute__((vector_size(8 * W)));
  static constexpr int N = checksum_lanes / W;
  Words sums[N];

  [[gnu::always_inline]] void add(void const* numbers) {
    Words words[N];
    __builtin_memcpy(words, numbers, sizeof(words));
    for (int n = 0; n < N; ++n) {
      Words const sum = sums[n] + words[n];
      sums[n] = sum << 29 | sum >> 35;
    }
  }
};

[[gnu::always_inline]] inline std::uint64_t mixed(std::uint64_t sum, std::uint64_t word) {
  return ((sum << 5 | sum >> 59) ^ word) * 0x9E3779B97F4A7C15U;
}

template <int W>
std::uint64_t checksum(double const* numbers, std::size_t count) {
  std::uint64_t sum = count;
  std::size_t k = 0;
  if (count >= checksum_lanes) {
    ChecksumWords<W> words{};
    for (; k + checksum_lanes <= count; k += checksum_lanes) words.add(numbers + k);
    std::uint64_t lanes[checksum_lanes];
    __builtin_memcpy(lanes, words.sums, sizeof(lanes));
    for (int half = checksum_lanes / 2; half > 0; half /= 2)
      for (int lane = 0; lane < half; ++lane) lanes[lane] = mixed(lanes[lane], lanes[lane + half]);
    sum += lanes[0];
  }
  for (; k < count; ++k) {
    std::uint64_t word;
    __builtin_memcpy(&word, numbers + k, sizeof(word));
    sum = mixed(sum, word);
  }
  return sum;
}

}  // namespace detail

template <>
ChecksumKernel checksum_kernel<this_set>() {
  return detail::checksum<native_width<double>>;
}

}  // namespace boltzmann
