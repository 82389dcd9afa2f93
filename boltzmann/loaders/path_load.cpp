// A random walk through all sites of a lattice.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/loaders/ensemble_seed.hpp>
#include <boltzmann/loaders/path_load.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace boltzmann {
namespace {

constexpr std::size_t moves_a_site = 20;

class Path {
 public:
  Path(std::array<std::size_t, 3> const& counts, std::size_t size) : counts_(counts), sites_(size), place_(size) {
    // Boustrophedon along x, row by row; plane by plane.
    for (std::size_t k = 0; k < size; ++k) {
      std::size_t const row = k / counts[0], plane = row / counts[1];
      std::size_t const x = row % 2 == 0 ? k % counts[0] : counts[0] - 1 - k % counts[0];
      std::size_t const y = plane % 2 == 0 ? row % counts[1] : counts[1] - 1 - row % counts[1];
      put(k, x + counts[0] * (y + counts[1] * plane));
    }
  }

  /// Backbite: joins an end to one of its neighbours, and cuts the bond by which the path would reach it. The other end
  /// of that bond is the new end.
  void bite(Stream& stream) {
    std::size_t const size = sites_.size();
    bool const head = stream.below(2) == 0;
    auto const bitten = neighbour(head ? sites_.front() : sites_.back(), stream.below(6));
    if (bitten == size) return;
    std::size_t const k = place_[bitten];
    auto const begin = sites_.begin() + static_cast<std::ptrdiff_t>(head ? 0 : k + 1);
    auto const end = head ? sites_.begin() + static_cast<std::ptrdiff_t>(k) : sites_.end();
    std::reverse(begin, end);
    for (auto site = begin; site != end; ++site) place_[*site] = static_cast<std::size_t>(site - sites_.begin());
  }
  std::vector<std::size_t> const& sites() const { return sites_; }

 private:
  void put(std::size_t k, std::size_t site) {
    sites_[k] = site;
    place_[site] = k;
  }
  /// One of six; the number of sites if there is none.
  std::size_t neighbour(std::size_t site, std::uint64_t direction) const {
    std::size_t stride = 1;
    for (std::uint64_t a = 0; a < direction / 2; ++a) stride *= counts_[a];
    std::size_t const at = site / stride % counts_[direction / 2];
    if (direction % 2 == 0) return at > 0 ? site - stride : sites_.size();
    return at + 1 < counts_[direction / 2] ? site + stride : sites_.size();
  }

  std::array<std::size_t, 3> counts_;
  std::vector<std::size_t> sites_, place_;
};

}  // namespace

void path_load(AnyEnsemble& ensemble, Box const& box, PathOptions const& options) {
  std::size_t size = 1;
  for (int a = 0; a < 3; ++a) {
    std::size_t const count = options.counts[static_cast<std::size_t>(a)];
    if (count == 0 || (a >= box.dimension() && count != 1))
      throw Error(fmt::format("path load: counts are positive, one for each of {} axes", box.dimension()));
    size *= count;
  }
  if (ensemble.dimension() != box.dimension() || ensemble.size() != size)
    throw Error(fmt::format("path load: '{}' has {} particles, the path goes through {} sites", ensemble.name(),
                            ensemble.size(), size));
  Path path(options.counts, size);
  Stream stream(ensemble_seed(options.seed, ensemble.name(), "path"), 0, 0, Purpose::selection);
  for (std::size_t move = 0; move < moves_a_site * size; ++move) path.bite(stream);
  for (std::size_t i = 0; i < size; ++i) {
    std::size_t rest = path.sites()[i];
    for (int a = 0; a < box.dimension(); ++a) {
      std::size_t const count = options.counts[static_cast<std::size_t>(a)];
      double const part = (static_cast<double>(rest % count) + 0.5) / static_cast<double>(count);
      ensemble.row(i)[a] = box.low(a) + part * box.length(a);
      rest /= count;
    }
  }
}

}  // namespace boltzmann
