// The kernel of noise of single particles.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/dissipation/noise_kernels.hpp>

namespace boltzmann {
namespace detail {

template <int W>
[[gnu::flatten]] void draw_noise(NoiseTask const& task) {
  auto const store = [&](int column, std::size_t k, Pack<double, W> x) {
    store_pack<W>(task.columns + column * noise_block + k, x);
  };
  Words<W> lane{};
  for (int l = 0; l < W; ++l) lane[l] = static_cast<std::uint64_t>(l);
  for (std::size_t k = 0; k < task.count; k += W) {
    RandomWords<W> counter;
    counter.word[0] = lane + (task.first + k);
    for (int w = 0; w < 3; ++w) counter.word[1 + w] = Words<W>{} + task.tag[w];
    auto const words = philox4x32<W>(counter, task.key);
    auto const low = normals<W>(words.word[0], words.word[1]);
    store(0, k, low[0]);
    store(1, k, low[1]);
    if (task.each < 3) continue;
    auto const high = normals<W>(words.word[2], words.word[3]);
    store(2, k, high[0]);
    store(3, k, high[1]);
  }
}

}  // namespace detail

template <>
NoiseKernel noise_kernel<this_set>() {
  return detail::draw_noise<native_width<double>>;
}

}  // namespace boltzmann
