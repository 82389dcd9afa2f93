// Layers and columns of space for ranks.
#include <boltzmann/neighbours/shares_of_space.hpp>

#include <boltzmann/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace boltzmann {
namespace {

/// Assigns lines in order to ranks [first, first + count), with equal work as far as whole lines allow. A line belongs
/// to the rank in whose part of all work its middle is.
template <class Lines, class Give>
void share_lines(Lines const& lines, std::vector<std::int64_t> const& work, int first, int count, Give const& give) {
  double all = 0, before = 0;
  for (auto const line : lines) all += static_cast<double>(work[line]);
  for (auto const line : lines) {
    auto const of_line = static_cast<double>(work[line]);
    double const part = all > 0 ? (before + 0.5 * of_line) / all : 0;
    give(line, first + std::min(count - 1, static_cast<int>(part * count)));
    before += of_line;
  }
}

/// The first rank of a layer.
int first_of(int layer, int layers, int ranks) { return static_cast<int>(std::int64_t{ranks} * layer / layers); }

}  // namespace

SharesOfSpace said_shares() {
  char const* const said = std::getenv("BOLTZMANN_SHARES");
  std::string_view const word = said ? said : "";
  if (word == "layers") return SharesOfSpace::layers;
  if (word == "columns") return SharesOfSpace::columns;
  if (word != "") throw Error(fmt::format("BOLTZMANN_SHARES is 'layers' or 'columns', not '{}'", quoted(word)));
  return SharesOfSpace::chosen;
}

int layers_for(PlaneOfLines const& plane, double reach, int ranks, double worth) {
  SharesOfSpace const said = said_shares();
  if (said == SharesOfSpace::layers || plane.count[1] == 1) return ranks;
  if (said == SharesOfSpace::columns) return static_cast<int>(std::sqrt(ranks));
  double const width = static_cast<double>(plane.count[0]) * plane.edge[0],
               height = static_cast<double>(plane.count[1]) * plane.edge[1];
  // The area that a rank has: its own part of the plane, and the ghosts around it.
  auto const known = [&](int layers) {
    double const columns = static_cast<double>(ranks) / layers;
    return std::min(width / columns + 2 * reach, width) * std::min(height / layers + 2 * reach, height);
  };
  int best = ranks;
  for (int layers = 1; layers < ranks; ++layers)
    if (known(layers) < (best == ranks ? worth : 1.0) * known(best)) best = layers;
  return best;
}

std::vector<std::uint16_t> columns_of(PlaneOfLines const& plane, std::vector<std::int64_t> const (&order)[2],
                                      std::vector<std::int64_t> const& work, int layers, int ranks) {
  std::vector<std::uint16_t> owner(plane.lines());
  // Layers get lines as if there were no columns, so that each layer has the work of all its ranks.
  std::vector<std::size_t> lines;
  for (auto const second : order[1])
    for (auto const first : order[0]) lines.push_back(static_cast<std::size_t>(first + plane.count[0] * second));
  std::vector<int> layer_of_rank(static_cast<std::size_t>(ranks));
  for (int layer = 0; layer < layers; ++layer)
    for (int r = first_of(layer, layers, ranks); r < first_of(layer + 1, layers, ranks); ++r)
      layer_of_rank[static_cast<std::size_t>(r)] = layer;
  std::vector<int> layer(plane.lines());
  share_lines(lines, work, 0, ranks,
              [&](std::size_t line, int rank) { layer[line] = layer_of_rank[static_cast<std::size_t>(rank)]; });
  lines.clear();
  for (auto const first : order[0])
    for (auto const second : order[1]) lines.push_back(static_cast<std::size_t>(first + plane.count[0] * second));
  std::vector<std::vector<std::size_t>> of_layer(static_cast<std::size_t>(layers));
  for (auto const line : lines) of_layer[static_cast<std::size_t>(layer[line])].push_back(line);
  for (int one = 0; one < layers; ++one) {
    int const first = first_of(one, layers, ranks), count = first_of(one + 1, layers, ranks) - first;
    share_lines(of_layer[static_cast<std::size_t>(one)], work, first, count,
                [&](std::size_t line, int rank) { owner[line] = static_cast<std::uint16_t>(rank); });
  }
  return owner;
}

}  // namespace boltzmann
