// The order of pairs: chunks, edges between them, colours.
#include <boltzmann/core/threads.hpp>
#include <boltzmann/dissipation/splitting.hpp>

#include <algorithm>
#include <map>

namespace boltzmann {

void PairDissipation::Splitting::take_pairs(Neighbourhood const& neighbourhood,
                                            std::vector<std::unique_ptr<Member>>& members,
                                            std::vector<std::unique_ptr<Coupling>> const& couplings, int threads) {
  if (builds == neighbourhood.version() && moves == neighbourhood.moves()) return;
  builds = neighbourhood.version();
  moves = neighbourhood.moves();
  std::size_t chunks = 0;
  for (auto& member : members) {
    member->first_chunk = chunks;
    if (member->dissipates) chunks += member->chunks();
  }
  // Every pair belongs to one chunk: that of the lower row, or of the first ensemble.
  std::vector<std::map<std::size_t, std::vector<Part>>> found(chunks);
  for (auto const& coupling : couplings) {
    Coupling const& c = *coupling;
    if (!c.first) continue;
    Member const &m = *c.target, &other = *c.source;
    NeighbourList const& list = neighbourhood.list(c.list);
    for_ranges(m.chunks(), 1, threads_for(m.owned(), 4, threads), [&](std::size_t first, std::size_t last) {
      for (std::size_t chunk = first; chunk < last; ++chunk) {
        auto& edges_from = found[m.first_chunk + chunk];
        std::size_t const end = std::min((chunk + 1) * dissipation_chunk, m.owned());
        for (std::size_t k = chunk * dissipation_chunk; k < end; ++k) {
          std::uint32_t const* j = list.rows()[k];
          for (std::uint32_t const* const stop = j + list.lengths(list_rings - 1)[k]; j < stop; ++j) {
            std::uint32_t const seen = *j / 4;
            if (seen == other.copy->sentinel()) continue;
            std::uint32_t const second = other.copy->owner(seen);
            if (c.same() && second <= k) continue;
            auto& parts = edges_from[other.first_chunk + second / dissipation_chunk];
            if (parts.empty() || parts.back().coupling != &c) parts.push_back({&c, {}});
            parts.back().pairs.push_back({static_cast<std::uint32_t>(k), second, seen});
          }
        }
      }
    });
  }
  edges.clear();
  colours.clear();
  std::vector<std::vector<bool>> used(chunks);  // colours of each chunk
  auto const uses = [&](std::size_t chunk, std::size_t colour) {
    return colour < used[chunk].size() && used[chunk][colour];
  };
  auto const use = [&](std::size_t chunk, std::size_t colour) {
    if (used[chunk].size() <= colour) used[chunk].resize(colour + 1, false);
    used[chunk][colour] = true;
  };
  for (std::size_t from = 0; from < chunks; ++from)
    for (auto& [to, parts] : found[from]) {
      std::size_t colour = 0;
      while (uses(from, colour) || uses(to, colour)) ++colour;
      use(from, colour);
      use(to, colour);
      if (colours.size() <= colour) colours.resize(colour + 1);
      colours[colour].push_back(edges.size());
      edges.push_back({from, to, std::move(parts)});
    }
}

std::size_t PairDissipation::Splitting::bytes() const {
  std::size_t bytes = 0;
  for (auto const& edge : edges)
    for (auto const& part : edge.parts) bytes += part.pairs.capacity() * sizeof(DissipationPair);
  return bytes;
}

}  // namespace boltzmann
