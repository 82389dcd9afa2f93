// List building: cells of the source, one pass over the targets.
#include <boltzmann/neighbours/neighbour_list.hpp>

#include <boltzmann/core/threads.hpp>
#include <boltzmann/neighbours/cells.hpp>

#include <algorithm>

namespace boltzmann {
namespace {

constexpr std::size_t grain = 1024;

struct Part {
  std::vector<std::uint32_t> index;  // its size is room, not content
  std::size_t used = 0;
  std::vector<std::uint32_t> count;
};

template <int D>
NeighbourList build(Mirror const& target, Mirror const& source, double reach, int threads) {
  Cells const cells(D, source.rows(), source.stride(), source.total(), reach);
  auto const& items = cells.items();
  // Positions in cell order: candidates are read one after the other.
  std::vector<double> near(items.size() * D);
  for (std::size_t k = 0; k < items.size(); ++k)
    for (int a = 0; a < D; ++a) near[k * D + a] = source.rows()[items[k] * source.stride() + a];

  bool const same = &target == &source;
  double const reach2 = reach * reach;
  auto const sentinel = static_cast<std::uint32_t>(source.total());
  std::vector<Part> parts((target.owned() + grain - 1) / grain);
  for_ranges(target.owned(), grain, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t begin = first; begin < last; begin += grain) {
      Part& part = parts[begin / grain];
      for (std::size_t i = begin; i < std::min(begin + grain, last); ++i) {
        double const* x = target.rows() + i * target.stride();
        std::size_t const before = part.used;
        auto const self = same ? static_cast<std::uint32_t>(i) : sentinel;
        cells.near(x, [&](std::size_t from, std::size_t to) {
          if (part.index.size() < part.used + (to - from) + NeighbourList::padding)
            part.index.resize(2 * (part.used + (to - from)) + 1024);
          // Every candidate is written, and stays if it is near: no branch to mispredict.
          std::uint32_t* next = part.index.data() + part.used;
          for (std::size_t k = from; k < to; ++k) {
            double square = 0;
            for (int a = 0; a < D; ++a) square += (near[k * D + a] - x[a]) * (near[k * D + a] - x[a]);
            *next = items[k];
            next += static_cast<int>(square < reach2) & static_cast<int>(items[k] != self);
          }
          part.used = static_cast<std::size_t>(next - part.index.data());
        });
        while ((part.used - before) % NeighbourList::padding != 0) part.index[part.used++] = sentinel;
        part.count.push_back(static_cast<std::uint32_t>(part.used - before));
      }
    }
  });

  NeighbourList list;
  list.start.reserve(target.owned() + 1);
  list.start.push_back(0);
  std::size_t entries = 0;
  for (auto const& part : parts) entries += part.used;
  list.index.reserve(entries);
  for (auto const& part : parts) {
    list.index.insert(list.index.end(), part.index.begin(),
                      part.index.begin() + static_cast<std::ptrdiff_t>(part.used));
    for (auto const count : part.count) list.start.push_back(list.start.back() + count);
  }
  return list;
}

}  // namespace

NeighbourList near_pairs(Mirror const& target, Mirror const& source, double reach, int threads) {
  switch (target.ensemble().dimension()) {
    case 1:
      return build<1>(target, source, reach, threads);
    case 2:
      return build<2>(target, source, reach, threads);
    default:
      return build<3>(target, source, reach, threads);
  }
}

}  // namespace boltzmann
